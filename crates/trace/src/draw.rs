//! A window of a wave for people: a line for each signal, a cell for each clock or for each time at which something
//! changes.
//!
//! A [`Window`] says once which values are held over which cells, and how they are written; the text of a terminal, the
//! SVG for a document and the WaveJSON are views of it and cannot differ in what they show.

mod svg;
mod text;
mod wavedrom;
mod window;

use std::collections::BTreeMap;

use crate::read::Wave;
pub use window::Window;

/// How vectors are written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Radix {
    /// Decimal, with a sign where the signal is declared with one.
    #[default]
    Declared,
    /// Binary.
    Binary,
    /// Hexadecimal.
    Hex,
    /// Decimal in two's complement.
    Signed,
    /// Decimal without a sign.
    Unsigned,
}

/// How a wave is drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct Drawing {
    /// Characters of a line, at least [`LEAST_COLUMNS`].
    pub columns: usize,
    /// Text with the characters of ASCII alone.
    pub ascii: bool,
    /// Text with the escape sequences of a terminal.
    pub colour: bool,
    /// How vectors are written.
    pub radix: Radix,
    /// The clock of the first sample of the wave: 0, but where clocks before it were left out.
    pub first: u64,
    /// The first clock, or time of the wave, that is drawn.
    pub from: u64,
    /// The last one; as many as fit in a line where it is not given.
    pub to: Option<u64>,
    /// Clocks that there were after the last one of the wave, which the text counts among those that are left out.
    pub beyond: u64,
    /// Cells are times at which something changes, in units of the wave, and not clocks.
    pub by_time: bool,
    /// Names of values by signal: those of states, by the bits of a value.
    pub names: BTreeMap<String, BTreeMap<String, String>>,
    /// The option that gives the first clock, which the text names where more follows.
    pub option: &'static str,
}

/// The narrowest line.
pub const LEAST_COLUMNS: usize = 40;

impl Default for Drawing {
    /// 80 columns from clock 0.
    fn default() -> Drawing {
        let (ascii, colour, by_time) = (false, false, false);
        let (radix, first, from, to, beyond, names) = (Radix::default(), 0, 0, None, 0, BTreeMap::new());
        Drawing { columns: 80, ascii, colour, radix, first, from, to, beyond, by_time, names, option: "--from" }
    }
}

impl Drawing {
    /// What is shown of these signals of a wave, in this order.
    ///
    /// Clocks count from that of the first sample, where the wave has a clock.
    ///
    /// # Errors
    /// There is nothing from the first clock or time on, or no clock.
    pub fn window(&self, wave: &Wave, signals: &[usize]) -> Result<Window, String> {
        Window::new(self, wave, signals)
    }

    /// The clocks or times from the first to the last that is to be drawn, however many fit in a line.
    ///
    /// # Errors
    /// As [`window`](Self::window).
    pub fn places(&self, wave: &Wave) -> Result<Vec<u64>, String> {
        window::places(self, wave)
    }

    /// The [window](Self::window) as text; a line at the end says what is left out.
    ///
    /// # Errors
    /// As [`window`](Self::window).
    pub fn text(&self, wave: &Wave, signals: &[usize]) -> Result<String, String> {
        Ok(self.window(wave, signals)?.text(self.ascii, self.colour))
    }
}

/// A text of at most `most` characters, with a mark where it was cut.
fn cut(text: &str, most: usize, mark: char) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain((most > 0).then_some(mark)).collect()
}

#[cfg(test)]
mod tests;
