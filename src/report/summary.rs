//! The summary that a run prints, and the words for geometry and choices that waves and pictures bear.

use std::fmt::Write as _;

use stepwave_models::{Hardware, Model, Named, Takes};
use stepwave_nc::{Curve, Shape};

use super::Report;
use crate::testbench::{Ending, RegisterRange};

/// `(8, 6)`
pub(super) fn point(coordinates: &[i64]) -> String {
    let list: Vec<_> = coordinates.iter().map(ToString::to_string).collect();
    format!("({})", list.join(", "))
}

/// The geometry in words: `line (0, 0) → (8, 6)`.
#[must_use]
pub fn geometry(curve: &Curve) -> String {
    let (from, to) = (point(curve.from()), point(curve.to()));
    match curve {
        Curve::Line(_) => format!("line {from} to {to}"),
        Curve::Arc(arc) => {
            let kind = if arc.is_full_circle() { "full circle" } else { "arc" };
            format!("{kind} {from} to {to} {} about {}", arc.direction(), point(&arc.center()))
        }
        Curve::Helix(helix) => {
            let arc = helix.arc();
            format!("helix {from} to {to} {} about {}", arc.direction(), point(&arc.center()))
        }
        Curve::Conic(conic) => {
            let center = point(&conic.center());
            let towards = conic.opens().map(|opens| format!("opening to {opens} ")).unwrap_or_default();
            match conic.shape() {
                Shape::Ellipse { semi_axes } => {
                    let direction = conic.direction().map(|direction| format!("{direction} ")).unwrap_or_default();
                    format!("ellipse {} {from} to {to} {direction}about {center}", point(&semi_axes))
                }
                Shape::Parabola { c, .. } => format!("parabola {c} {towards}{from} to {to} from the vertex {center}"),
                Shape::Hyperbola { semi_axes, .. } => {
                    format!("hyperbola {} {towards}{from} to {to} about {center}", point(&semi_axes))
                }
            }
        }
    }
}

/// The choices that the model takes, as an option line would give them.
#[must_use]
pub fn choices(model: &Model, hardware: &Hardware) -> Vec<(&'static str, String)> {
    let value = |takes: &&'static dyn Takes| (takes.name(), hardware.text(takes.option()));
    model.options.iter().map(value).collect()
}

/// One line for wave headers: model, geometry, choices.
#[must_use]
pub fn title(model: &Model, hardware: &Hardware, curve: &Curve) -> String {
    let choices: Vec<_> = choices(model, hardware).into_iter().map(|(name, value)| format!("{name} {value}")).collect();
    format!("{}; {}; {}", model.name, geometry(curve), choices.join("; "))
}

impl Report {
    /// Some lines for a terminal.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::new();
        let outcome = &self.outcome;
        let letters = self.hardware.letters();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}: {}", self.model.name, geometry(&self.curve));
        let pulses: Vec<_> =
            outcome.pulses.iter().zip(letters).map(|(count, axis)| format!("{axis} {count}")).collect();
        let _ = writeln!(text, "{} steps in {} clocks; pulses {}", outcome.steps, outcome.clocks, pulses.join(", "));
        let exact = if self.end_exact() {
            "reached exactly".to_owned()
        } else {
            format!("missed: {}", point(&outcome.reached))
        };
        let _ = match outcome.ending {
            Ending::Done => writeln!(text, "end point {} {exact}", point(self.curve.to())),
            Ending::Trapped => writeln!(text, "stopped by an overflow at {}", point(&outcome.reached)),
            Ending::Stalled { .. } => writeln!(text, "stalled at {}", point(&outcome.reached)),
            Ending::Endless { .. } | Ending::Limit => {
                writeln!(text, "was still under way at {}", point(&outcome.reached))
            }
        };
        for sentence in self.wrong_counters() {
            let _ = writeln!(text, "{sentence}");
        }
        if let Some(worst) = &self.worst {
            let at = point(&worst.position);
            let _ = writeln!(text, "greatest path error {:.3} BLU at {at} after step {}", worst.error, worst.step);
        }
        text += &self.coarse_stage();
        text += &self.pulse_trains();
        if self.overflow_count > 0 {
            let first = self.overflows.first().map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(text, "{} overflow(s), the first: {first}", self.overflow_count);
        }
        text += &self.registers();
        for warning in self.warnings() {
            let _ = writeln!(text, "warning: {warning}");
        }
        text
    }

    /// What the registers with a choice of width needed of it.
    fn registers(&self) -> String {
        let chosen = || self.ranges.iter().filter(|range| self.hardware.widths.contains_key(range.name.as_str()));
        let spare = chosen().map(|range| format!("{} {}/{}", range.name, self.needed_bits(range), range.width.get()));
        // The bits of an operand say nothing of the motion.
        let moving = chosen().filter(|range| !range.held);
        let stuck = moving.flat_map(|range| {
            // That the bits above did not move is told by those needed, and a sign may well stay.
            let magnitude = range.needed() - u32::from(range.reading.is_signed());
            range.stuck_below(magnitude).into_iter().map(|bits| format!("{}{bits}", range.name))
        });
        // What went beyond its range is told by itself.
        let held = |range: &&RegisterRange| self.tallies.iter().all(|tally| tally.first.component() != range.path);
        let full =
            chosen().filter(held).flat_map(|range| range.limits.iter().map(|end| format!("{} at {end}", range.name)));
        let mut text = format!("bits needed/given: {}\n", spare.collect::<Vec<_>>().join(", "));
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

    /// What the coarse stage of data sampling costs.
    fn coarse_stage(&self) -> String {
        let (Some(sampling), Some(coarse)) = (&self.hardware.sampling, &self.coarse) else { return String::new() };
        let micrometres = |length: f64| format!("{length:.6} BLU ({:.6} µm)", length * self.blu_mm * 1e3);
        let period = sampling.system.period();
        let mut text = format!(
            "coarse stage {}: {} BLU in {} ms, {:.3} mm/min; {} clocks a period\n",
            sampling.system.word(),
            sampling.step,
            period * 1e3,
            sampling.step.units() * self.blu_mm * 60.0 / period,
            sampling.period_clocks(),
        );
        if self.outcome.ending == Ending::Done {
            let _ = writeln!(
                text,
                "mean feed {:.3} mm/min over {} period(s): the last goes what is left of the way",
                self.mean_feed(),
                self.outcome.steps
            );
        }
        let _ = writeln!(
            text,
            "coarse points with {} bits of fraction: up to {} off the curve, period {}",
            sampling.fraction,
            micrometres(coarse.error),
            coarse.period
        );
        if sampling.chord_error > 0.0 {
            let _ = writeln!(text, "chord error f²/8R: {}", micrometres(sampling.chord_error));
        }
        text
    }

    /// How even the pulses of each axis are.
    fn pulse_trains(&self) -> String {
        let axes = || {
            let pulsing = |&axis: &usize| self.outcome.pulses[axis] > 0;
            (0..self.trains.len()).filter(pulsing).map(|axis| (&self.trains[axis], self.hardware.letters()[axis]))
        };
        let apart = axes().filter_map(|(train, axis)| {
            let [least, greatest] = train.spacing?;
            let ideal = train.ideal_spacing.map(|ideal| format!(" (evenly {ideal:.3})")).unwrap_or_default();
            let range = if least == greatest { least.to_string() } else { format!("{least} to {greatest}") };
            Some(format!("{axis} {range}{ideal}"))
        });
        let off = axes().filter_map(|(train, axis)| {
            let deviation = train.deviation?;
            Some(format!("{axis} {:.3} after step {}", deviation.pulses, deviation.step))
        });
        let (apart, off): (Vec<_>, Vec<_>) = (apart.collect(), off.collect());
        let mut text = String::new();
        if !apart.is_empty() {
            text += &format!("clocks from pulse to pulse: {}\n", apart.join(", "));
        }
        if !off.is_empty() {
            let bound =
                self.hardware.rate_bound.map(|bound| format!("; never more than {bound:.3}")).unwrap_or_default();
            text += &format!("pulses off an even rate: {}{bound}\n", off.join(", "));
        }
        text
    }
}
