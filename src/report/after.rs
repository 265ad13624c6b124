//! What a report says of acceleration after the interpolator: what went out, how far off the contour, and the radius that arcs lost.

use std::fmt::Write as _;

use serde_json::{Value, json};
use stepwave_models::options::Smooth;
use stepwave_models::program::After;

use super::Report;
use super::program::of_axes;
use crate::testbench::{ArcLoss, Ending, Sent, point};

/// What the radius of an arc loses by.
fn formula(smooth: Smooth) -> &'static str {
    match smooth {
        Smooth::Sum(_) => "(k²-1)·f²/(24·R)",
        Smooth::Exponential(_) => "(4^s-2^s)·f²/(2·R)",
    }
}

fn arc_json(arc: &ArcLoss) -> Value {
    json!({
        "line": arc.line,
        "radius": arc.radius,
        "displacement": arc.displacement,
        "expected": arc.expected,
        "measured": arc.measured,
    })
}

impl Report {
    /// What went out, and the filter that it went through.
    fn after(&self) -> Option<(&Sent, After)> {
        Some((self.sent.as_ref()?, After::of(&self.hardware)?))
    }

    /// For the summary; nothing without such an output.
    pub(super) fn after_text(&self) -> String {
        let Some((sent, After { smooth, period })) = self.after() else { return String::new() };
        let (ms, um) = (period as f64 / self.clock_hz * 1e3, self.blu_mm * 1e3);
        let axes = self.hardware.letters().iter().zip(sent.pulses.iter().zip(&self.outcome.pulses));
        let pulses = axes.map(|(axis, (out, given))| match out == given {
            true => format!("{axis} {out}"),
            false => format!("{axis} {out} of {given}"),
        });
        let pulses = pulses.collect::<Vec<_>>().join(", ");
        let mut text =
            format!("after the interpolator: {smooth}, periods of {period} clocks ({ms:.3} ms); pulses out {pulses}");
        // Writing to a string cannot fail.
        let _ =
            writeln!(text, "{}", if sent.reached == self.outcome.reached { ", where all of them lead" } else { "" });
        if let Some(off) = &sent.off {
            let _ = writeln!(
                text,
                "greatest output off the contour: {:.3} BLU ({:.3} µm) at {}, clock {}, line {}",
                off.distance,
                off.distance * um,
                point(&off.place),
                off.clock,
                off.line
            );
        }
        if let Some(ArcLoss { line, radius, displacement, expected, measured }) = sent.worst {
            let measured =
                measured.map_or_else(|| "too short to be measured".to_owned(), |loss| format!("measured {loss:.3}"));
            // Only the first term of a series: beyond the radius it says nothing.
            let expected = if expected < radius { format!("{expected:.3} BLU") } else { "all of it".to_owned() };
            let _ = writeln!(
                text,
                "most radius lost by an arc: {expected} by {}, {measured}; line {line}, R {radius:.1}, f {displacement:.3}",
                formula(smooth)
            );
        }
        text
    }

    /// For the JSON report.
    pub(super) fn after_json(&self) -> Option<Value> {
        let (sent, After { smooth, period }) = self.after()?;
        let um = self.blu_mm * 1e3;
        let off = sent.off.as_ref().map(|off| {
            json!({
                "blu": off.distance,
                "um": off.distance * um,
                "place": off.place,
                "clock": off.clock,
                "line": off.line,
            })
        });
        Some(json!({
            "smooth": smooth.to_string(),
            "period": period,
            "pulses": of_axes(&sent.pulses),
            "reached": sent.reached,
            "position_counters": sent.counters,
            "contour_error": off,
            "radius_loss": {
                "formula": formula(smooth),
                "worst": sent.worst.as_ref().map(arc_json),
                "arcs": sent.arcs.iter().map(arc_json).collect::<Vec<_>>(),
            },
        }))
    }

    /// What is wrong with it.
    pub(super) fn after_failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        let Some(sent) = &self.sent else { return failures };
        if self.outcome.ending == Ending::Done && sent.reached != self.outcome.reached {
            failures.push(format!(
                "pulses were lost after the interpolator: it led to {}, what went out to {}",
                point(&self.outcome.reached),
                point(&sent.reached)
            ));
        }
        if sent.counters != sent.reached {
            let (shown, reached) = (point(&sent.counters), point(&sent.reached));
            failures.push(format!("the counters of the outputs show {shown}, but their pulses led to {reached}"));
        }
        failures
    }
}
