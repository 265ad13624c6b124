//! A window of a wave as SVG, for a document: black on a transparent ground, unknown values red and hatched.
//!
//! It has the lines of the text, on a grid of characters that are a little wider than those of the font, so that what fits
//! in its cells as text fits here too.

use std::fmt::Write;
use std::ops::Range;

use super::cut;
use super::window::{Piece, Shape, Window};

/// Pixels of a character of the grid; the widest of the fonts has 0.602 of its size.
const CHARACTER: f64 = 7.5;
const FONT: &str = r#"font-family="DejaVu Sans Mono, Menlo, Consolas, Liberation Mono, monospace" font-size="12""#;
/// Heights of the line of numbers, of a row, and between two lines of the wave.
const NUMBERS: f64 = 18.0;
const ROW: f64 = 24.0;
const BETWEEN: f64 = 14.0;
/// In a row: the levels, the height between, and the line on which text is written.
const HIGH: f64 = 4.0;
const LOW: f64 = 20.0;
const MIDDLE: f64 = 12.0;
const BASE: f64 = 16.0;
/// Pixels from a bound to the end of its slant: half a character, so that both slants take the place of one.
const SLANT: f64 = CHARACTER / 2.0;
const MARGIN: f64 = 4.0;
const RED: &str = "#b00020";

impl Window {
    /// The window as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let cells = self.lines().map(|line| line.len()).max().unwrap_or(0);
        let lines = self.lines().count();
        let line_height = NUMBERS + ROW * length(self.rows.len());
        let width = self.left() + length(cells * self.cell) * CHARACTER + 2.0 * MARGIN;
        let height = line_height * length(lines) + BETWEEN * length(lines.saturating_sub(1)) + 2.0 * MARGIN;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"{} {} {width} {height}\" \
             {FONT} fill=\"#000\">\n<title>{}</title>\n<defs><pattern id=\"hatch\" width=\"5\" height=\"5\" \
             patternUnits=\"userSpaceOnUse\"><path d=\"M-1 1L1 -1M0 5L5 0M4 6L6 4\" stroke=\"{RED}\" stroke-opacity=\"0.35\" \
             stroke-width=\"0.8\"/></pattern></defs>\n",
            -MARGIN,
            -MARGIN,
            self.extent()
        );
        for (number, line) in self.lines().enumerate() {
            // Writing to a string cannot fail.
            let _ = writeln!(svg, "<g transform=\"translate(0 {})\">", length(number) * (line_height + BETWEEN));
            self.numbers_of(&mut svg, line.clone());
            for (index, row) in self.rows.iter().enumerate() {
                let top = NUMBERS + ROW * length(index);
                let name = escaped(&cut(&row.name, self.name, '…'));
                let _ = writeln!(svg, "<g transform=\"translate(0 {top})\"><text x=\"0\" y=\"{BASE}\">{name}</text>");
                row.pieces(line.clone()).for_each(|piece| self.piece(&mut svg, &piece, line.len()));
                svg.push_str("</g>\n");
            }
            svg.push_str("</g>\n");
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// Pixels from the left to the first cell.
    fn left(&self) -> f64 {
        length(self.name.max(self.heading().chars().count()) + 1) * CHARACTER
    }

    /// Pixels from the left to the start of a cell of a line.
    fn at(&self, cell: usize) -> f64 {
        self.left() + length(cell * self.cell) * CHARACTER
    }

    /// The numbers above the cells of a line, and a thin line down from each.
    fn numbers_of(&self, svg: &mut String, line: Range<usize>) {
        let bottom = NUMBERS + ROW * length(self.rows.len());
        let _ = writeln!(svg, "<text x=\"0\" y=\"{MIDDLE}\">{}</text>", self.heading());
        for (at, number) in self.numbers(line) {
            let x = self.left() + length(at) * CHARACTER;
            let _ = writeln!(
                svg,
                "<text x=\"{x}\" y=\"{MIDDLE}\">{number}</text><path d=\"M{x} {NUMBERS}V{bottom}\" stroke=\"#bbb\" \
                 stroke-width=\"0.6\" stroke-dasharray=\"2 2\"/>"
            );
        }
    }

    /// A value over the cells in which it is held.
    fn piece(&self, svg: &mut String, piece: &Piece<'_>, cells: usize) {
        let Piece { stretch, before, cells: Range { start, end } } = piece;
        let [from, to] = [self.at(*start), self.at(*end)];
        let open = *end == cells;
        let joint = before.map(|before| joint(before.shape, from));
        let path = match stretch.shape {
            Shape::Low => level(LOW, joint, [from, to], open),
            Shape::High => level(HIGH, joint, [from, to], open),
            Shape::Floating => level(MIDDLE, joint, [from, to], open),
            Shape::Known | Shape::Unknown | Shape::Mixed => bus(joint, [from, to], open),
        };
        let shape = stretch.shape;
        let colour = if shape.is_known() { "#000" } else { RED };
        if matches!(shape, Shape::Unknown | Shape::Mixed) {
            let (x, width, high) = (from + SLANT, to - from - 2.0 * SLANT, LOW - HIGH);
            let _ =
                write!(svg, "<rect x=\"{x}\" y=\"{HIGH}\" width=\"{width}\" height=\"{high}\" fill=\"url(#hatch)\"/>");
        }
        let _ = write!(
            svg,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.2\" stroke-linejoin=\"round\"/>"
        );
        if matches!(shape, Shape::Low | Shape::High | Shape::Floating) {
            return;
        }
        let whole = &stretch.text;
        let text = cut(whole, (end - start) * self.cell - 1, '…');
        let title = if text == *whole { String::new() } else { format!("<title>{}</title>", escaped(whole)) };
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{BASE}\" text-anchor=\"middle\" fill=\"{colour}\">{title}{}</text>",
            f64::midpoint(from, to),
            escaped(&text)
        );
    }
}

/// Where a value ends that another one follows at this place.
fn joint(before: Shape, at: f64) -> [f64; 2] {
    match before {
        Shape::Low => [at - SLANT, LOW],
        Shape::High => [at - SLANT, HIGH],
        Shape::Floating => [at - SLANT, MIDDLE],
        Shape::Known | Shape::Unknown | Shape::Mixed => [at, MIDDLE],
    }
}

/// A line at a height, from where the value before ends.
fn level(height: f64, joint: Option<[f64; 2]>, [from, to]: [f64; 2], open: bool) -> String {
    let start = match joint {
        None => format!("M{from} {height}"),
        Some([x, y]) => format!("M{x} {y}L{} {height}", from + SLANT),
    };
    format!("{start}H{}", if open { to } else { to - SLANT })
}

/// Two lines that meet at the bounds; open where the line of the wave begins or ends.
fn bus(joint: Option<[f64; 2]>, [from, to]: [f64; 2], open: bool) -> String {
    let (left, right) = (from + SLANT, to - SLANT);
    let start = joint.map_or_else(String::new, |[x, y]| format!("M{x} {y}L{from} {MIDDLE}"));
    match (joint.is_some(), open) {
        (false, true) => format!("M{from} {HIGH}H{to}M{to} {LOW}H{from}"),
        (false, false) => format!("M{from} {HIGH}H{right}L{to} {MIDDLE}L{right} {LOW}H{from}"),
        (true, true) => format!("{start}L{left} {HIGH}H{to}M{from} {MIDDLE}L{left} {LOW}H{to}"),
        (true, false) => {
            format!("{start}L{left} {HIGH}H{right}L{to} {MIDDLE}L{right} {LOW}H{left}L{from} {MIDDLE}")
        }
    }
}

/// A number of things as a factor of lengths.
// Far below 2^52.
#[allow(clippy::cast_precision_loss)]
fn length(count: usize) -> f64 {
    count as f64
}

/// A text between tags; what XML cannot hold is replaced.
fn escaped(text: &str) -> String {
    let foreign = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.replace(foreign, "\u{fffd}").replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
