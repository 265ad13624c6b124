//! A block diagram read from its SVG: frames, texts and wires, and what keeps a reader from reading them.

use std::collections::BTreeMap;

/// A rectangle, in pixels.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) class: String,
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Frame {
    /// Another one is inside, or on its border.
    pub(super) fn holds(&self, other: &Frame) -> bool {
        self.left <= other.left && self.top <= other.top && self.right >= other.right && self.bottom >= other.bottom
    }

    fn overlaps(&self, other: &Frame) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }
}

/// A text, with the rectangle of its letters.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub(super) text: String,
    class: String,
    frame: Frame,
}

/// A line of a net.
#[derive(Clone, Copy, Debug)]
struct Line {
    net: usize,
    ends: [f64; 4],
}

impl Line {
    fn is_flat(&self) -> bool {
        self.ends[1] == self.ends[3]
    }

    /// Its extent along its direction.
    fn span(&self) -> (f64, f64) {
        let [x0, y0, x1, y1] = self.ends;
        if self.is_flat() { (x0.min(x1), x0.max(x1)) } else { (y0.min(y1), y0.max(y1)) }
    }

    fn frame(&self) -> Frame {
        let [x0, y0, x1, y1] = self.ends;
        let class = String::new();
        Frame { class, left: x0.min(x1), top: y0.min(y1), right: x0.max(x1), bottom: y0.max(y1) }
    }
}

/// A scope whose inside is not shown.
#[derive(Debug)]
pub(super) struct Closed {
    pub(super) path: String,
    pub(super) cells: Vec<usize>,
    /// What it says to a reader who points at it.
    about: String,
}

impl Closed {
    pub(super) fn holds(&self, net: stepwave::netlist::Net) -> bool {
        self.cells.contains(&net.index())
    }

    /// The nets without a wire of a line that begins so.
    pub(super) fn names(&self, verb: &str) -> Vec<&str> {
        let head = format!("{verb} without a wire: ");
        self.about.lines().filter_map(|line| line.strip_prefix(&head)).flat_map(|names| names.split(", ")).collect()
    }
}

#[derive(Debug, Default)]
pub(super) struct Figure {
    size: [f64; 4],
    pub(super) frames: Vec<Frame>,
    pub(super) texts: Vec<Text>,
    lines: Vec<Line>,
    pub(super) closed: Vec<Closed>,
    /// The frame that each cell is drawn in.
    pub(super) cells: BTreeMap<usize, Frame>,
}

impl Figure {
    pub(super) fn read(svg: &str) -> Figure {
        let document = roxmltree::Document::parse(svg).unwrap();
        let mut figure = Figure::default();
        let view: Vec<f64> = document.root_element().attribute("viewBox").unwrap().split(' ').map(number).collect();
        figure.size = [view[0], view[1], view[0] + view[2], view[1] + view[3]];
        for node in document.descendants() {
            let of = |name: &str| number(node.attribute(name).unwrap());
            let class = node.attribute("class").unwrap_or_default().to_owned();
            match node.tag_name().name() {
                "rect" => {
                    let (left, top) = (of("x"), of("y"));
                    let frame = Frame { class, left, top, right: left + of("width"), bottom: top + of("height") };
                    let cells = node.attribute("data-cells").unwrap_or_default().split_whitespace();
                    cells.for_each(|cell| assert!(figure.cells.insert(cell.parse().unwrap(), frame.clone()).is_none()));
                    figure.frames.push(frame);
                    figure.closed.extend(closed(&node));
                }
                "text" => figure.texts.extend(text(&node, class)),
                "path" if class.starts_with("wire") => {
                    let net = node.attribute("data-net").unwrap().parse().unwrap();
                    let lines = node.attribute("d").unwrap().split('M').skip(1);
                    figure.lines.extend(lines.map(|line| Line { net, ends: ends(line) }));
                }
                _ => {}
            }
        }
        figure
    }

    pub(super) fn has_wire(&self, net: usize) -> bool {
        self.lines.iter().any(|line| line.net == net)
    }

    /// Nets with a wire.
    pub(super) fn nets(&self) -> usize {
        self.lines.iter().map(|line| line.net).collect::<std::collections::BTreeSet<_>>().len()
    }

    /// Texts whose middle is in a frame.
    pub(super) fn texts_in(&self, frame: &Frame) -> Vec<&str> {
        let inside = self.texts.iter().filter(|text| frame.overlaps(&text.frame));
        inside.map(|text| text.text.as_str()).collect()
    }

    /// What keeps a reader from reading it.
    pub(super) fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let boxes = || self.frames.iter().filter(|frame| frame.class != "scope");
        for (at, text) in self.texts.iter().enumerate() {
            for other in self.texts[at + 1..].iter().filter(|other| text.frame.overlaps(&other.frame)) {
                faults.push(format!("'{}' overlaps '{}'", text.text, other.text));
            }
            let around = self.frames.iter().any(|frame| frame.holds(&text.frame));
            // The width of a wire is next to it: in a box it is the note of a title, and is all in that.
            let partly = boxes().any(|frame| frame.overlaps(&text.frame) && !frame.holds(&text.frame));
            if partly || !around && text.class != "width" && text.class != "title" {
                faults.push(format!("'{}' is not in a box", text.text));
            }
            let crossed = self.lines.iter().find(|line| text.frame.overlaps(&line.frame()));
            faults.extend(crossed.map(|line| format!("net {} is drawn through '{}'", line.net, text.text)));
            let [left, top, right, bottom] = self.size;
            let whole = Frame { class: String::new(), left, top, right, bottom };
            if !whole.holds(&text.frame) {
                faults.push(format!("'{}' is outside of the picture", text.text));
            }
        }
        for (at, frame) in self.frames.iter().enumerate() {
            for other in &self.frames[at + 1..] {
                let nested =
                    frame.class == "scope" && frame.holds(other) || other.class == "scope" && other.holds(frame);
                if frame.overlaps(other) && !nested {
                    faults.push(format!("{frame:?} overlaps {other:?}"));
                }
            }
        }
        for line in &self.lines {
            if let Some(frame) = boxes().find(|frame| frame.overlaps(&line.frame())) {
                faults.push(format!("net {} is drawn through {frame:?}: {:?}", line.net, line.ends));
            }
        }
        faults.extend(self.shared());
        faults.extend(self.torn());
        faults
    }

    /// Nets whose lines are in several pieces.
    fn torn(&self) -> Vec<String> {
        let mut nets: BTreeMap<usize, Vec<Line>> = BTreeMap::new();
        self.lines.iter().for_each(|line| nets.entry(line.net).or_default().push(*line));
        let touches = |a: &Line, b: &Line| {
            let (a, b) = (a.frame(), b.frame());
            a.left <= b.right && b.left <= a.right && a.top <= b.bottom && b.top <= a.bottom
        };
        let mut torn = Vec::new();
        for (net, mut left) in nets {
            let mut piece = vec![left.remove(0)];
            while let Some(next) = left.iter().position(|line| piece.iter().any(|of| touches(of, line))) {
                piece.push(left.remove(next));
            }
            torn.extend(left.first().map(|line| format!("net {net} is in pieces at {:?}", line.ends)));
        }
        torn
    }

    /// Lines of two nets on one another.
    fn shared(&self) -> Vec<String> {
        let mut shared = Vec::new();
        for (at, line) in self.lines.iter().enumerate() {
            for other in self.lines[at + 1..].iter().filter(|other| other.net != line.net) {
                let across = if line.is_flat() { line.ends[1] - other.ends[1] } else { line.ends[0] - other.ends[0] };
                let ((a, b), (c, d)) = (line.span(), other.span());
                if line.is_flat() == other.is_flat() && across.abs() < 3.0 && a < d && c < b {
                    shared.push(format!("nets {} and {} share a line: {:?}", line.net, other.net, line.ends));
                }
            }
        }
        shared
    }

    /// How often two nets cross.
    pub(super) fn crossings(&self) -> usize {
        let flat = self.lines.iter().filter(|line| line.is_flat());
        let crossed = |flat: &Line| {
            let (left, right) = flat.span();
            let upright = self.lines.iter().filter(|line| !line.is_flat() && line.net != flat.net);
            upright
                .filter(|line| {
                    let (top, bottom) = line.span();
                    let (x, y) = (line.ends[0], flat.ends[1]);
                    left < x && x < right && top < y && y < bottom
                })
                .count()
        };
        flat.map(crossed).sum()
    }
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// The ends of a line: `x yHx` or `x yVy`.
fn ends(line: &str) -> [f64; 4] {
    let (start, end) = line.split_once(['H', 'V']).unwrap();
    let (x, y) = start.split_once(' ').unwrap();
    let (x, y, end) = (number(x), number(y), number(end));
    if line.contains('H') { [x, y, end, y] } else { [x, y, x, end] }
}

fn closed(node: &roxmltree::Node<'_, '_>) -> Option<Closed> {
    let path = node.attribute("data-scope")?.to_owned();
    let cells = node.attribute("data-cells").unwrap_or_default().split_whitespace();
    let about = node.children().find_map(|child| child.text()).unwrap_or_default().to_owned();
    Some(Closed { path, cells: cells.map(|cell| cell.parse().unwrap()).collect(), about })
}

/// A text that is not empty, as large as letters of a fixed width are: 0.602 of the size of the font.
fn text(node: &roxmltree::Node<'_, '_>, class: String) -> Option<Text> {
    let text = node.text().filter(|text| !text.is_empty())?.to_owned();
    let of = |name: &str| number(node.attribute(name).unwrap());
    let size = node.attribute("font-size").map_or(11.0, number);
    let wide = text.chars().count() as f64 * size * 0.602;
    let left = if node.attribute("text-anchor") == Some("middle") { of("x") - wide / 2.0 } else { of("x") };
    let frame = Frame {
        class: class.clone(),
        left,
        top: of("y") - size * 0.73,
        right: left + wide,
        bottom: of("y") + size * 0.2,
    };
    Some(Text { text, class, frame })
}
