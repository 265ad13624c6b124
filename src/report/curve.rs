//! What a report has of a curve alone: path, coarse stage and pulse trains.

use std::fmt::Write as _;

use serde_json::{Map, Value, json};
use stepwave_models::{Named, Promise};
use stepwave_nc::Curve;

use super::geometry;
use super::json::cut_words;
use super::speed;
use super::{RelativeSpeed, Report};
use crate::testbench::{CoarseError, Ending, PulseTrain, Speed, WorstError, missed, point};

/// What is known of a run along a curve, beyond what every [`Report`] has.
#[derive(Debug)]
#[non_exhaustive]
pub struct OfCurve {
    /// What was to be interpolated.
    pub curve: Curve,
    /// Greatest path error.
    pub worst: Option<WorstError>,
    /// How far coarse points lie off the curve, of a machine that has such.
    pub coarse: Option<CoarseError>,
    /// The pulses of each axis.
    pub trains: Vec<PulseTrain>,
    /// How fast it was; `None` without a step.
    pub speed: Option<Speed>,
    /// Blocks that the curve was loaded in.
    pub blocks: usize,
}

impl OfCurve {
    /// Before its run.
    pub(crate) fn new(curve: Curve, blocks: usize) -> OfCurve {
        OfCurve { curve, worst: None, coarse: None, trains: Vec::new(), speed: None, blocks }
    }

    /// What the method promises of the path, if it promises anything.
    #[must_use]
    pub fn promise(&self, report: &Report) -> Option<Promise> {
        Promise::of(report.hardware.error_bound, &self.curve)
    }

    /// The path error stayed within what the method promises.
    #[must_use]
    pub fn path_within_bound(&self, report: &Report) -> bool {
        self.worst.as_ref().zip(self.promise(report)).is_none_or(|(worst, promise)| promise.is_kept(worst.error))
    }

    /// Sentences about the end point and the path.
    pub(super) fn failures(&self, report: &Report) -> Vec<String> {
        let mut failures = Vec::new();
        if !report.end_exact() {
            failures.push(missed(self.curve.to(), &report.outcome.reached));
        }
        if let (false, Some(worst), Some(promise)) = (self.path_within_bound(report), &self.worst, self.promise(report))
        {
            let curve = self.curve.description().drawn.name();
            failures.push(format!(
                "the path left the {curve}: {:.3} BLU off at {} after step {}, where the method promises at most {promise}",
                worst.error,
                point(&worst.position),
                worst.step,
            ));
        }
        failures
    }

    /// What the summary says first: how far it came, and how well.
    pub(super) fn summary(&self, report: &Report) -> String {
        let mut text = String::new();
        let outcome = &report.outcome;
        let letters = report.hardware.letters();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", report.headline());
        let pulses: Vec<_> =
            outcome.pulses.iter().zip(letters).map(|(count, axis)| format!("{axis} {count}")).collect();
        let _ = writeln!(text, "{} steps in {} clocks; pulses {}", outcome.steps, outcome.clocks, pulses.join(", "));
        let exact = if report.end_exact() {
            "reached exactly".to_owned()
        } else {
            match outcome.reached == self.curve.to() {
                true => "missed: no pulse was given".to_owned(),
                false => format!("missed: {}", point(&outcome.reached)),
            }
        };
        let _ = match outcome.ending {
            Ending::Done => writeln!(text, "end point {} {exact}", point(self.curve.to())),
            Ending::Trapped => writeln!(text, "stopped by an overflow at {}", point(&outcome.reached)),
            Ending::Stalled { .. } => writeln!(text, "stalled at {}", point(&outcome.reached)),
            Ending::Endless { .. } | Ending::Limit => {
                writeln!(text, "was still under way at {}", point(&outcome.reached))
            }
        };
        for sentence in report.wrong_counters() {
            let _ = writeln!(text, "{sentence}");
        }
        if let Some(worst) = &self.worst {
            let at = point(&worst.position);
            let _ = writeln!(text, "greatest path error {:.3} BLU at {at} after step {}", worst.error, worst.step);
        }
        if let Some(speed) = self.relative_speed(report) {
            let _ = writeln!(text, "speed over v_max: {}", speed::words(&speed));
        }
        text + &self.coarse_stage(report) + &self.pulse_trains(report)
    }

    /// What the JSON report says of the curve before the run.
    pub(super) fn head(&self, report: &Report) -> Value {
        json!({ "model": report.model.name, "geometry": geometry::json(&self.curve) })
    }

    /// Results that a curve alone has, for the JSON report.
    pub(super) fn results(&self, report: &Report) -> Value {
        let outcome = &report.outcome;
        let letters = report.hardware.letters();
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
            (!deviations.is_empty()).then(|| json!({ "axes": deviations, "bound": report.hardware.rate_bound }));
        let path_error = self.worst.as_ref().map(|worst| {
            json!({
                "greatest": worst.error,
                "step": worst.step,
                "position": worst.position,
                "bound": self.promise(report).map(Promise::bound),
                "ends_off": self.promise(report).map(Promise::ends),
                "within_bound": self.path_within_bound(report),
            })
        });
        let mut results = json!({
            "steps": outcome.steps,
            "pulses": pulses,
            "end_point": {
                "wanted": self.curve.to(),
                "reached": outcome.reached,
                "exact": report.end_exact(),
            },
            "path_error": path_error,
            "sampling": self.sampling(report),
            "pulse_spacing": spacing,
            "rate_deviation": rate_deviation,
            "feed": self.feed(report),
            "warnings": report.warnings(),
        });
        // Only where the hardware did not do what it was given.
        if report.cut.count > 0 {
            results["cut_words"] = cut_words(&report.cut);
        }
        if outcome.counters != outcome.reached {
            results["position_counters"] = json!(outcome.counters);
        }
        results
    }

    /// What the coarse stage of data sampling costs.
    fn coarse_stage(&self, report: &Report) -> String {
        let (Some(sampling), Some(coarse)) = (&report.hardware.sampling, &self.coarse) else { return String::new() };
        let micrometres = |length: f64| format!("{length:.6} BLU ({:.6} µm)", length * report.blu_mm * 1e3);
        let period = sampling.system.period();
        let free = matches!(self.curve, Curve::Nurbs(_));
        let mut text = format!(
            "coarse stage {}: {} BLU in {} ms, {:.3} mm/min; {} clocks a period\n",
            if free { "by steps of the first order" } else { sampling.system.word() },
            sampling.step,
            period * 1e3,
            sampling.step.units() * report.blu_mm * 60.0 / period,
            sampling.period_clocks(),
        );
        if let Some(mean) = self.mean_feed(report) {
            let _ = writeln!(
                text,
                "mean feed {mean:.3} mm/min over {} period(s): the last goes what is left of the way",
                report.outcome.steps
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
            let how = if free { "at the middle of a period's parameters" } else { "f²/8R" };
            let _ = writeln!(text, "chord error {how}: {}", micrometres(sampling.chord_error));
        }
        text
    }

    /// How even the pulses of each axis are.
    fn pulse_trains(&self, report: &Report) -> String {
        let axes = || {
            let pulsing = |&axis: &usize| report.outcome.pulses[axis] > 0;
            (0..self.trains.len()).filter(pulsing).map(|axis| (&self.trains[axis], report.hardware.letters()[axis]))
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
                report.hardware.rate_bound.map(|bound| format!("; never more than {bound:.3}")).unwrap_or_default();
            text += &format!("pulses off an even rate: {}{bound}\n", off.join(", "));
        }
        text
    }

    /// The coarse stage, and what its fraction costs.
    fn sampling(&self, report: &Report) -> Option<Value> {
        let (sampling, coarse) = (report.hardware.sampling.as_ref()?, self.coarse.as_ref()?);
        let micrometres = |length: f64| length * report.blu_mm * 1e3;
        Some(json!({
            "system": sampling.system.word(),
            "period_seconds": sampling.system.period(),
            "period_clocks": sampling.period_clocks(),
            "fraction_bits": sampling.fraction,
            "step": sampling.step.units(),
            "feed_mm_per_min": sampling.step.units() * report.blu_mm * 60.0 / sampling.system.period(),
            "chord_error": sampling.chord_error,
            "chord_error_um": micrometres(sampling.chord_error),
            "tolerance": sampling.tolerance.units(),
            "coarse_error": coarse.error,
            "coarse_error_um": micrometres(coarse.error),
            "coarse_error_period": coarse.period,
        }))
    }

    /// Length of the curve in BLU, if it was run to its end.
    fn length_run(&self, report: &Report) -> Option<f64> {
        let is_run = report.outcome.ending == Ending::Done && report.outcome.ends(&self.curve);
        is_run.then(|| self.curve.length())
    }

    /// Its speed over v_max; `None` without a step, or where it is not known how many clocks a step of the hardware takes.
    #[must_use]
    pub fn relative_speed(&self, report: &Report) -> Option<RelativeSpeed> {
        let clocks = report.hardware.clocks_of_step()?;
        self.speed.as_ref().map(|speed| RelativeSpeed::new(speed, clocks, self.length_run(report)))
    }

    /// Mean speed along the curve, in mm/min at the clock and BLU chosen.
    fn mean_feed(&self, report: &Report) -> Option<f64> {
        let (speed, length) = (self.speed.as_ref()?, self.length_run(report)?);
        Some(60.0 * length * report.blu_mm * report.clock_hz / speed.clocks as f64)
    }

    /// Speed along the curve: over v_max, and in mm/min.
    fn feed(&self, report: &Report) -> Value {
        let mut feed = json!({
            "clock_hz": report.clock_hz,
            "blu_mm": report.blu_mm,
            "length": self.curve.length(),
            "clocks": self.speed.as_ref().map(|speed| speed.clocks),
            "step_clocks": report.hardware.clocks_of_step(),
            "mean_mm_per_min": self.mean_feed(report),
        });
        speed::put(self.relative_speed(report), &mut feed);
        feed["ripple"] = json!(self.speed.and_then(|speed| speed.ripple(self.length_run(report))));
        feed
    }
}
