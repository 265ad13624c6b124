//! Shapes of a drawing, in pixels, and how large texts are.

use stepwave_netlist::Net;
use stepwave_netlist::cells::ScopeId;

/// Pixels of a character, in tenths: of the font, and of the small font.
const CHARACTER: usize = 67;
const SMALL: usize = 55;

/// Pixels that a text takes.
pub(crate) fn width(text: &str, small: bool) -> i32 {
    let tenths = text.chars().count() * if small { SMALL } else { CHARACTER };
    pixels(tenths.div_ceil(10))
}

/// A count as pixels.
pub(crate) fn pixels(count: usize) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX / 4)
}

/// The next even number: heights are even, so that wires can be straight.
pub(crate) fn even(length: i32) -> i32 {
    length + (length & 1)
}

/// What a shape is, for its style.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Style {
    Register,
    Logic,
    Choice,
    Operator,
    Memory,
    Scope,
    Port,
}

/// How a text is set.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Font {
    Title,
    Text,
    /// Widths of wires.
    Small,
    /// The value of a net at the cursor; empty until there is one.
    Value,
}

/// A shape.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// A box: left, top, width and height.
    Frame { at: [i32; 4], style: Style, cells: Vec<Net>, flags: Vec<String> },
    /// A box for a scope whose inside is not shown: its path, and what it says to a reader who points at it.
    Closed { at: [i32; 4], path: String, about: String, cells: Vec<Net>, flags: Vec<String> },
    /// A text that begins here, on this line.
    Text { at: [i32; 2], font: Font, text: String, net: Option<Net> },
    /// A text in the middle of a symbol.
    Sign { at: [i32; 2], text: String },
    /// The mark of a clock at the left of a box.
    Clock { at: [i32; 2] },
    /// A slash through a wire, at the number of its bits.
    Slash { at: [i32; 2] },
    /// A net: lines, dots, and the ends with an arrow.
    Wire { net: Net, bits: u32, lines: Vec<[i32; 4]>, dots: Vec<[i32; 2]>, ends: Vec<[i32; 2]> },
}

impl Shape {
    /// The same elsewhere.
    pub(crate) fn moved(mut self, [right, down]: [i32; 2]) -> Shape {
        let go = |at: &mut [i32; 2]| *at = [at[0] + right, at[1] + down];
        match &mut self {
            Shape::Frame { at, .. } | Shape::Closed { at, .. } => *at = [at[0] + right, at[1] + down, at[2], at[3]],
            Shape::Text { at, .. } | Shape::Sign { at, .. } | Shape::Clock { at } | Shape::Slash { at } => go(at),
            Shape::Wire { lines, dots, ends, .. } => {
                lines.iter_mut().for_each(|[a, b, c, d]| {
                    (*a, *b, *c, *d) = (*a + right, *b + down, *c + right, *d + down);
                });
                dots.iter_mut().chain(ends).for_each(go);
            }
        }
        self
    }
}

/// A part of a drawing that is placed as a box: its pins are where nets enter and leave.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figure {
    pub(crate) size: [i32; 2],
    pub(crate) shapes: Vec<Shape>,
    /// Nets that enter at the left, and how far down.
    pub(crate) left: Vec<(Net, i32)>,
    /// Nets that leave at the right.
    pub(crate) right: Vec<(Net, i32)>,
    /// Its outputs change at edges alone.
    pub(crate) holds: bool,
    /// It is the box of this scope, whose pins may be in any order.
    pub(crate) closed: Option<ScopeId>,
}

impl Figure {
    /// Draws the beginnings of wires on to the right of the whole, which the last of them may have moved.
    pub(crate) fn reached(mut self) -> Figure {
        let leaving: Vec<Net> = self.right.iter().map(|&(net, _)| net).collect();
        for shape in &mut self.shapes {
            if let Shape::Wire { net, lines, .. } = shape
                && leaving.contains(net)
            {
                lines.iter_mut().for_each(|line| line[2] = self.size[0]);
            }
        }
        self
    }

    pub(crate) fn text(&mut self, at: [i32; 2], font: Font, text: impl Into<String>) {
        self.shapes.push(Shape::Text { at, font, text: text.into(), net: None });
    }
}
