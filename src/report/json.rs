//! The JSON report.

use serde_json::{Map, Value, json};
use stepwave_models::{CutWord, Named, Promise};
use stepwave_nc::{Curve, Shape};
use stepwave_netlist::bits::Reading;
use stepwave_netlist::cells::Arithmetic;

use super::{Report, summary};
use crate::testbench::{Ending, OverflowEvent, OverflowTally};

/// Version of the report's form; a change of meaning raises it.
const SCHEMA: u32 = 1;

/// A number as JSON; one beyond 64 bits to the 53 bits that a real number holds.
pub(super) fn number(value: i128) -> Value {
    if let Ok(value) = i64::try_from(value) {
        return json!(value);
    }
    u64::try_from(value).map_or_else(|_| json!(value as f64), |value| json!(value))
}

/// The word of a choice as JSON: a number where it is one.
pub(super) fn choice(name: &str, word: &str) -> Value {
    // The systems of data sampling are names.
    if name == "system" {
        return json!(word);
    }
    let whole = word.parse::<i64>().map(|number| json!(number));
    whole.or_else(|_| word.parse::<f64>().map(|number| json!(number))).unwrap_or_else(|_| json!(word))
}

fn geometry(curve: &Curve) -> Value {
    match curve {
        Curve::Line(_) => json!({ "curve": "line", "from": curve.from(), "to": curve.to() }),
        Curve::Arc(arc) => json!({
            "curve": "arc",
            "from": curve.from(),
            "to": curve.to(),
            "center": arc.center(),
            "direction": arc.direction().to_string(),
            "radius": arc.radius(),
        }),
        Curve::Conic(conic) => {
            let (shape, sizes) = match conic.shape() {
                Shape::Ellipse { semi_axes } => ("ellipse", json!(semi_axes)),
                Shape::Parabola { c, .. } => ("parabola", json!([c])),
                Shape::Hyperbola { semi_axes, .. } => ("hyperbola", json!(semi_axes)),
            };
            json!({
                "curve": shape,
                "from": curve.from(),
                "to": curve.to(),
                "center": conic.center(),
                "sizes": sizes,
                "opens": conic.opens().map(|opens| opens.to_string()),
                "direction": conic.direction().map(|direction| direction.to_string()),
            })
        }
        Curve::Helix(helix) => json!({
            "curve": "helix",
            "from": curve.from(),
            "to": curve.to(),
            "center": helix.arc().center(),
            "direction": helix.arc().direction().to_string(),
            "radius": helix.arc().radius(),
        }),
    }
}

pub(super) fn event(event: &OverflowEvent) -> Value {
    match event {
        OverflowEvent::Overflow { component, width, signed, operation, left, right, clock } => {
            let (exact, needed) = event.exact().unwrap_or_default();
            let operation = match operation {
                Arithmetic::Add => "add",
                Arithmetic::Sub => "sub",
            };
            json!({
                "component": component,
                "clock": clock,
                "width": width.get(),
                "signed": signed,
                "operation": operation,
                "left": number(*left),
                "right": number(*right),
                "exact": number(exact),
                "needed_width": if exact < 0 && !signed { Value::Null } else { json!(needed) },
            })
        }
        OverflowEvent::Invariant { component, clock } => json!({ "component": component, "clock": clock }),
    }
}

pub(super) fn cut_word(word: &CutWord) -> Value {
    json!({
        "register": word.register,
        "block": word.block,
        "value": number(word.value),
        "loaded": number(word.loaded),
        "width": word.width.get(),
    })
}

pub(super) fn tally(tally: &OverflowTally) -> Value {
    json!({
        "component": tally.first.component(),
        "count": tally.count,
        "first_clock": tally.first.clock(),
        "needed_width": tally.needed,
    })
}

impl Report {
    /// The report as JSON: see the README for its fields.
    #[must_use]
    pub fn json(&self) -> Value {
        let outcome = &self.outcome;
        let choices = summary::choices(self.model, &self.hardware);
        let choices: Map<String, Value> = choices
            .into_iter()
            .filter(|(name, _)| *name != "width")
            .map(|(name, value)| (name.replace('-', "_"), choice(name, &value)))
            .collect();
        let widths: Map<String, Value> =
            self.hardware.widths.iter().map(|(name, width)| ((*name).to_owned(), json!(width.get()))).collect();
        let registers: Vec<Value> = self
            .ranges
            .iter()
            .map(|range| {
                json!({
                    "name": range.name,
                    "path": range.path,
                    "width": range.width.get(),
                    "signed": range.reading.is_signed(),
                    "radix": if range.reading == Reading::Decimal { 10 } else { 2 },
                    "least": number(range.least),
                    "greatest": number(range.greatest),
                    "needed_width": self.needed_bits(range),
                    "stuck_bits": range.stuck_bits(),
                    "limits": range.limits.iter().copied().map(number).collect::<Vec<_>>(),
                })
            })
            .collect();
        let letters = self.hardware.letters();
        let pulses: Map<String, Value> =
            letters.iter().zip(&outcome.pulses).map(|(axis, count)| ((*axis).to_owned(), json!(count))).collect();
        let axes = || letters.iter().zip(&self.trains);
        let spacing: Map<String, Value> = axes()
            .map(|(axis, train)| {
                let [least, greatest] = [0, 1].map(|end| train.spacing.map(|spacing| spacing[end]));
                let spacing = json!({ "least": least, "greatest": greatest, "ideal": train.ideal_spacing });
                ((*axis).to_owned(), spacing)
            })
            .collect();
        let deviations: Map<String, Value> = axes()
            .filter_map(|(axis, train)| {
                let deviation = train.deviation?;
                Some(((*axis).to_owned(), json!({ "greatest": deviation.pulses, "step": deviation.step })))
            })
            .collect();
        let rate_deviation =
            (!deviations.is_empty()).then(|| json!({ "axes": deviations, "bound": self.hardware.rate_bound }));
        let path_error = self.worst.as_ref().map(|worst| {
            json!({
                "greatest": worst.error,
                "step": worst.step,
                "position": worst.position,
                "bound": self.promise().map(Promise::bound),
                "ends_off": self.promise().map(Promise::ends),
                "within_bound": self.path_within_bound(),
            })
        });
        let ending = match outcome.ending {
            Ending::Done => "done",
            Ending::Trapped => "trapped",
            Ending::Stalled { .. } => "stalled",
            Ending::Endless { .. } => "endless",
            Ending::Limit => "limit",
        };
        let mut report = json!({
            "schema": SCHEMA,
            "model": self.model.name,
            "geometry": geometry(&self.curve),
            "choices": choices,
            "widths": widths,
            "engine": self.engine.name(),
            "registers": registers,
            "clocks": outcome.clocks,
            "steps": outcome.steps,
            "pulses": pulses,
            "end_point": {
                "wanted": self.curve.to(),
                "reached": outcome.reached,
                "exact": self.end_exact(),
            },
            "path_error": path_error,
            "sampling": self.sampling(),
            "pulse_spacing": spacing,
            "rate_deviation": rate_deviation,
            "overflow": {
                "count": self.overflow_count,
                "events": self.overflows.iter().map(event).collect::<Vec<_>>(),
                "components": self.tallies.iter().map(tally).collect::<Vec<_>>(),
            },
            "feed": self.feed(),
            "ending": ending,
            "warnings": self.warnings(),
            "failures": self.failures(),
        });
        // Only where the hardware did not do what it was given.
        if !self.cut.is_empty() {
            report["cut_words"] = self.cut.iter().map(cut_word).collect();
        }
        if outcome.counters != outcome.reached {
            report["position_counters"] = json!(outcome.counters);
        }
        report
    }

    /// The coarse stage, and what its fraction costs.
    fn sampling(&self) -> Option<Value> {
        let (sampling, coarse) = (self.hardware.sampling.as_ref()?, self.coarse.as_ref()?);
        let micrometres = |length: f64| length * self.blu_mm * 1e3;
        Some(json!({
            "system": sampling.system.word(),
            "period_seconds": sampling.system.period(),
            "period_clocks": sampling.period_clocks(),
            "fraction_bits": sampling.fraction,
            "step": sampling.step.units(),
            "feed_mm_per_min": sampling.step.units() * self.blu_mm * 60.0 / sampling.system.period(),
            "chord_error": sampling.chord_error,
            "chord_error_um": micrometres(sampling.chord_error),
            "tolerance": sampling.tolerance.units(),
            "coarse_error": coarse.error,
            "coarse_error_um": micrometres(coarse.error),
            "coarse_error_period": coarse.period,
        }))
    }

    /// Clocks of the motion: those that load are none.
    fn moving_clocks(&self) -> u64 {
        self.outcome.clocks.saturating_sub(self.outcome.load_clocks)
    }

    /// Mean speed along the curve, in mm/min at the clock and BLU chosen.
    pub(super) fn mean_feed(&self) -> f64 {
        60.0 * self.curve.length() * self.blu_mm * self.clock_hz / self.moving_clocks().max(1) as f64
    }

    /// Mean speed along the curve: BLU per step, and mm/min.
    fn feed(&self) -> Value {
        let (steps, length) = (self.outcome.steps.max(1) as f64, self.curve.length());
        json!({
            "clock_hz": self.clock_hz,
            "blu_mm": self.blu_mm,
            "length": length,
            "clocks": self.moving_clocks(),
            "mean_per_step": length / steps,
            "mean_mm_per_min": self.mean_feed(),
        })
    }
}
