//! The violations of a component, counted.

use super::OverflowEvent;

/// The violations of all properties of one component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverflowTally {
    /// How many.
    pub count: u64,
    /// The first.
    pub first: OverflowEvent,
    /// Width that would have held every exact result, if one would.
    pub needed: Option<u32>,
    /// `file:line` of the source of the first, of imported hardware.
    pub source: Option<String>,
    /// The line of the program whose block ran at the first; 0 of a curve, and before the first block.
    pub line: u64,
}

impl OverflowTally {
    /// The first with the lines of the program and of its source, how often there were others, and what would have held all of them.
    #[must_use]
    pub fn sentence(&self) -> String {
        let times = if self.count == 1 { "once".to_owned() } else { format!("{} times", self.count) };
        let needed = self.needed.filter(|_| self.count > 1);
        let all = needed.map_or_else(String::new, |bits| format!(", {bits} bits would hold all"));
        let line = if self.line == 0 { String::new() } else { format!("line {}: ", self.line) };
        format!("{line}{} ({times}{all})", self.placed())
    }

    /// It is of an assertion, and not of a result that did not fit.
    #[must_use]
    pub fn is_assertion(&self) -> bool {
        matches!(self.first, OverflowEvent::Invariant { .. })
    }

    /// The first, with the line of its source.
    #[must_use]
    pub fn placed(&self) -> String {
        match &self.source {
            Some(source) => format!("{source}: {}", self.first),
            None => self.first.to_string(),
        }
    }
}
