//! The summary that a run prints.

use std::fmt::Write as _;

use super::{Report, Subject};
use crate::testbench::RegisterRange;

impl Report {
    /// Some lines for a terminal.
    #[must_use]
    pub fn summary(&self) -> String {
        match &self.subject {
            Subject::Program(of) => of.summary(self) + &self.after_text() + &self.bits_needed(),
            Subject::Curve(of) => {
                let mut text = of.summary(self);
                if let Some(first) = self.overflows.first() {
                    text += &format!("{} overflow(s), the first: {first}\n", self.overflow_count);
                }
                text += &self.after_text();
                text += &self.bits_needed();
                text += &self.bits_unused();
                self.warnings().iter().fold(text, |text, warning| format!("{text}warning: {warning}\n"))
            }
        }
    }

    /// The registers with a choice of width.
    fn chosen(&self) -> impl Iterator<Item = &RegisterRange> {
        self.ranges.iter().filter(|range| self.hardware.widths.contains_key(range.name.as_str()))
    }

    /// What they needed of it.
    fn bits_needed(&self) -> String {
        let spare =
            self.chosen().map(|range| format!("{} {}/{}", range.name, self.needed_bits(range), range.width.get()));
        format!("bits needed/given: {}\n", spare.collect::<Vec<_>>().join(", "))
    }

    /// What they did not need, and where they were at an end of their range.
    fn bits_unused(&self) -> String {
        // The bits of an operand say nothing of the motion.
        let moving = self.chosen().filter(|range| !range.held);
        let stuck = moving.flat_map(|range| {
            // That the bits above did not move is shown by those needed, and a sign may well stay.
            let magnitude = range.needed() - u32::from(range.reading.is_signed());
            range.stuck_below(magnitude).into_iter().map(|bits| format!("{}{bits}", range.name))
        });
        // What went beyond its range is reported by itself.
        let held = |range: &&RegisterRange| self.tallies.iter().all(|tally| tally.first.component() != range.path);
        let full = self
            .chosen()
            .filter(held)
            .flat_map(|range| range.limits.iter().map(|end| format!("{} at {end}", range.name)));
        let mut text = String::new();
        for (what, list) in [
            ("needed bits that never toggled", stuck.collect::<Vec<_>>()),
            ("one unit from an overflow", full.collect()),
        ] {
            if !list.is_empty() {
                let _ = writeln!(text, "{what}: {}", list.join(", "));
            }
        }
        text
    }
}
