//! A window of a wave as text, for a terminal or a test.

use std::fmt::Write;
use std::ops::Range;

use super::cut;
use super::window::{Piece, Row, Shape, Window};

/// What is drawn with which characters.
struct Characters {
    low: char,
    high: char,
    rise: char,
    fall: char,
    bound: char,
    cut: char,
}

const ASCII: Characters = Characters { low: '_', high: '-', rise: '/', fall: '\\', bound: '|', cut: '~' };
const UNICODE: Characters = Characters { low: '▁', high: '▔', rise: '╱', fall: '╲', bound: '│', cut: '…' };

/// Text with the escape sequences of a terminal, or without.
#[derive(Clone, Copy)]
struct Paint(bool);

impl Paint {
    const DIM: &'static str = "2";
    const RED: &'static str = "31";
    const GREEN: &'static str = "32";

    fn on(self, code: &str, text: &str) -> String {
        if self.0 { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
    }
}

impl Window {
    /// The window as text, with the characters of ASCII alone or not, with the colours of a terminal or not; a line at the
    /// end says what is left out.
    #[must_use]
    pub fn text(&self, ascii: bool, colour: bool) -> String {
        let (characters, paint) = (if ascii { ASCII } else { UNICODE }, Paint(colour));
        let mut text = String::new();
        for line in self.lines() {
            if line.start > 0 {
                text.push('\n');
            }
            let scale = format!("{:name$} {}", "", self.scale(line.clone()), name = self.name);
            text.push_str(&paint.on(Paint::DIM, scale.trim_end()));
            text.push('\n');
            for row in &self.rows {
                let name = cut(&row.name, self.name, characters.cut);
                // Writing to a string cannot fail.
                let _ = writeln!(
                    text,
                    "{name:width$} {}",
                    self.cells_of(row, line.clone(), &characters, paint),
                    width = self.name
                );
            }
        }
        text.push_str(&paint.on(Paint::DIM, &self.footer()));
        text.push('\n');
        text
    }

    /// The numbers above the cells of a line.
    fn scale(&self, line: Range<usize>) -> String {
        let mut scale = String::new();
        for (at, number) in self.numbers(line) {
            scale.extend(std::iter::repeat_n(' ', at - scale.len()));
            scale.push_str(&number.to_string());
        }
        scale
    }

    fn cells_of(&self, row: &Row, line: Range<usize>, characters: &Characters, paint: Paint) -> String {
        let Characters { low, high, rise, fall, bound, cut: dots } = *characters;
        let mut out = String::new();
        for Piece { stretch, before, cells } in row.pieces(line) {
            let wide = cells.len() * self.cell;
            let shape = stretch.shape;
            out.push_str(&match shape {
                Shape::Low | Shape::High => {
                    let level = if shape == Shape::High { high } else { low };
                    let edge = match before.map(|before| before.shape) {
                        Some(Shape::Low) if shape == Shape::High => rise,
                        Some(Shape::High) if shape == Shape::Low => fall,
                        _ => level,
                    };
                    let levels: String = std::iter::once(edge).chain(std::iter::repeat_n(level, wide - 1)).collect();
                    paint.on(Paint::GREEN, &levels)
                }
                _ => {
                    let text = format!("{bound}{:wide$}", cut(&stretch.text, wide - 1, dots), wide = wide - 1);
                    if shape.is_known() { text } else { paint.on(Paint::RED, &text) }
                }
            });
        }
        out.trim_end().to_owned()
    }

    /// What was drawn, and the option that shows the rest.
    fn footer(&self) -> String {
        let next = match (self.more, self.places.last()) {
            (1.., Some(last)) => {
                format!("; {} more: {} {} shows the next", self.more, self.option, last.saturating_add(1))
            }
            _ => String::new(),
        };
        format!("{}{next}", self.extent())
    }
}
