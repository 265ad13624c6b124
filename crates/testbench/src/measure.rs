//! What is measured of one run: the numbers of a row of a study.

use std::fmt;

use stepwave_engine::lanes::{ROOT_GAP_UNIT, root_gap};
use stepwave_engine::{EngineKind, Rows};
use stepwave_models::CutWord;
use stepwave_nc::Curve;

use super::instruments::{cross, offset};
use super::tool::Tool;
use super::{
    Ending, LaneOutcome, Observer, ObserverError, Outcome, OverflowWatch, PathWatch, RelativeSpeed, SpeedWatch,
    StepColumns, Testbench, is_ended,
};

/// What one geometry came to, and how well its path kept to the ideal curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// How it ended; `None` where the limit of clocks was reached: then nothing else of it is reported.
    pub ending: Option<Ending>,
    /// Clocks since reset: the clock of the last sample.
    pub clocks: u64,
    /// Steps completed.
    pub steps: u64,
    /// Pulses of each axis, in either direction.
    pub pulses: Vec<u64>,
    /// Where the pulses led, in BLU.
    pub reached: Vec<i64>,
    /// Greatest path error after a step, in BLU: that of [`WorstError`](super::WorstError).
    pub greatest: Option<f64>,
    /// Mean of the path errors after all steps, in BLU; of an arc each to 2^-17 BLU. None without a step.
    pub mean: Option<f64>,
    /// Mean speed over v_max, as [`Speed`](super::Speed) defines it; `None` where the curve was not run to its end, or it is
    /// not known how many clocks a step of the hardware takes.
    pub speed: Option<f64>,
    /// Least and greatest speed over v_max, if they were asked for; `None` without a step, or where v_max is not known.
    pub extremes: Option<[f64; 2]>,
    /// The greatest less the least speed over the mean, if it was asked for; `None` where the curve was not run to its end.
    pub ripple: Option<f64>,
    /// Violations of properties, as [`OverflowWatch`] counts them.
    pub overflows: u64,
    /// Path of the component of the first.
    pub component: Option<String>,
    /// Load words that did not fit in their registers, and what these took.
    pub cut: Vec<CutWord>,
    /// Fewest and most clocks between two pulses of each axis; none where it had no two.
    pub spacing: Vec<Option<[u64; 2]>>,
}

impl Measured {
    /// An outcome of which nothing is measured yet.
    pub(super) fn unfinished(outcome: LaneOutcome) -> Measured {
        let LaneOutcome { ending, clocks, steps, pulses, reached, .. } = outcome;
        let spacing = vec![None; pulses.len()];
        Measured {
            ending,
            clocks,
            steps,
            pulses,
            reached,
            greatest: None,
            mean: None,
            speed: None,
            extremes: None,
            ripple: None,
            overflows: 0,
            component: None,
            cut: Vec::new(),
            spacing,
        }
    }

    /// The curve was run to its end.
    fn is_run(&self, curve: &Curve) -> bool {
        self.ending == Some(Ending::Done) && is_ended(&curve.description(), &self.reached, &self.pulses)
    }

    /// Takes the clocks from row 0 of the step table to its last row, if the curve was run.
    pub(super) fn take_speed(&mut self, bench: &Testbench, curve: &Curve, clocks: u64) {
        let step = bench.hardware().clocks_of_step().filter(|_| clocks > 0 && self.is_run(curve));
        self.speed = step.map(|step| step * curve.length() / clocks as f64);
    }

    /// A run of this many axes that was not done after `clocks` clocks.
    pub(super) fn given_up(axes: usize, clocks: u64) -> Measured {
        let (pulses, reached) = (vec![0; axes], vec![0; axes]);
        Measured::unfinished(LaneOutcome { ending: None, clocks, steps: 0, pulses, reached, overflows: 0 })
    }
}

impl Testbench {
    /// Runs the blocks of this bench alone, along this curve, for `limit` clocks at most.
    ///
    /// # Errors
    /// None that an observer here would give.
    pub fn measure(&self, curve: &Curve, limit: u64) -> Result<Measured, ObserverError> {
        self.measured(curve, limit, None)
    }

    /// As [`measure`](Self::measure), with the extremes of the speed and its ripple.
    ///
    /// # Errors
    /// None that an observer here would give.
    pub fn measure_ripple(&self, curve: &Curve, limit: u64) -> Result<Measured, ObserverError> {
        self.measured(curve, limit, Some(SpeedWatch::new(self)))
    }

    fn measured(&self, curve: &Curve, limit: u64, mut speed: Option<SpeedWatch>) -> Result<Measured, ObserverError> {
        let (mut overflow, mut path) = (OverflowWatch::new(self), PathWatch::new(self, curve));
        let (mut mean, mut spacing, mut end) = (Mean::new(self, curve), Spacing::new(self), Limit(limit));
        let mut motion = Motion::new(self);
        let mut observers: Vec<&mut dyn Observer> =
            vec![&mut end, &mut overflow, &mut path, &mut mean, &mut spacing, &mut motion];
        observers.extend(speed.iter_mut().map(|speed| speed as &mut dyn Observer));
        let run = self.run(EngineKind::Compiled, &mut observers);
        drop(observers);
        let outcome = match run {
            Err(error) if error.is::<Reached>() => None,
            Err(error) => return Err(error),
            // Lanes continue to the limit where a single run detects that it is endless.
            Ok(Outcome { ending: Ending::Endless { .. } | Ending::Limit, .. }) => None,
            Ok(outcome) => Some(outcome).filter(|outcome| {
                outcome.clocks < limit || outcome.clocks == limit && !matches!(outcome.ending, Ending::Stalled { .. })
            }),
        };
        let Some(Outcome { ending, clocks, steps, pulses, reached, .. }) = outcome else {
            let given_up = Measured::given_up(self.machine().pulses.len(), limit);
            return Ok(Measured { cut: self.cut.clone(), ..given_up });
        };
        let mut measured = Measured {
            ending: Some(ending),
            clocks,
            steps,
            pulses,
            reached,
            greatest: path.worst.map(|worst| worst.error),
            mean: (steps > 0).then(|| mean.sum() / steps as f64),
            speed: None,
            extremes: None,
            ripple: None,
            overflows: overflow.count,
            component: overflow.events().first().map(|event| event.component().to_owned()),
            cut: self.cut.clone(),
            spacing: spacing.axes.iter().map(|axis| axis.seen).collect(),
        };
        measured.take_speed(self, curve, motion.clocks());
        if let Some(speed) = speed.and_then(|speed| speed.finish()) {
            let length = measured.is_run(curve).then(|| curve.length());
            let over = |step| RelativeSpeed::new(&speed, step, length);
            let of = self.hardware().clocks_of_step().map(over);
            measured.extremes = of.map(|of| [of.least.0, of.greatest.0]);
            measured.ripple = speed.ripple(length);
        }
        Ok(measured)
    }
}

/// The limit of clocks was reached.
#[derive(Debug)]
struct Reached;

impl fmt::Display for Reached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the limit of clocks was reached")
    }
}

impl std::error::Error for Reached {}

/// Ends a run a little after this clock.
struct Limit(u64);

impl Observer for Limit {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        if rows.first_clock() > self.0 { Err(Box::new(Reached)) } else { Ok(()) }
    }
}

/// Sums the path errors after all steps.
struct Mean<'a> {
    curve: &'a Curve,
    columns: StepColumns,
    tool: Tool,
    /// |d| of a line, or units of a circle: see `instruments`.
    exact: u128,
    /// What has no such number.
    rest: f64,
}

impl<'a> Mean<'a> {
    fn new(bench: &Testbench, curve: &'a Curve) -> Mean<'a> {
        Mean { curve, columns: StepColumns::of(bench), tool: Tool::of(bench), exact: 0, rest: 0.0 }
    }

    fn add(&mut self) {
        let plane = <[i64; 2]>::try_from(self.tool.place.as_slice()).ok();
        let exact = match (self.curve, plane) {
            (Curve::Line(line), Some(at)) => cross(line, at).map(i128::unsigned_abs),
            (Curve::Arc(arc), Some(at)) => {
                let square = arc.radius_squared() as f64;
                offset(arc, at).map(|offset| u128::from(root_gap(square, offset as f64)))
            }
            _ => None,
        };
        match exact {
            Some(exact) => self.exact = self.exact.saturating_add(exact),
            None => self.rest += self.curve.deviation(&self.tool.place),
        }
    }

    fn sum(&self) -> f64 {
        let unit = match self.curve {
            Curve::Line(line) => line.length(),
            _ => ROOT_GAP_UNIT,
        };
        self.exact as f64 / unit + self.rest
    }
}

impl Observer for Mean<'_> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for row in 0..rows.len() {
            let completes = self.columns.completes(rows, row, false);
            if completes || !self.tool.is_trusted() {
                self.tool.sample(rows, row);
            }
            if completes {
                self.add();
            }
        }
        Ok(())
    }
}

/// Clocks between the pulses of one axis.
struct Pulses {
    column: usize,
    last: Option<u64>,
    seen: Option<[u64; 2]>,
}

/// Clocks between the pulses of each axis.
struct Spacing {
    axes: Vec<Pulses>,
}

impl Spacing {
    fn new(bench: &Testbench) -> Spacing {
        let columns = bench.machine().pulses.iter().map(|port| bench.columns().index(port.net));
        Spacing { axes: columns.map(|column| Pulses { column, last: None, seen: None }).collect() }
    }
}

impl Observer for Spacing {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for axis in &mut self.axes {
            let pulses = rows.column(axis.column).iter().zip(rows.first_clock()..);
            for (_, clock) in pulses.filter(|(pulse, _)| **pulse != 0) {
                if let Some(gap) = axis.last.replace(clock).map(|last| clock - last) {
                    let [least, most] = axis.seen.unwrap_or([gap, gap]);
                    axis.seen = Some([least.min(gap), most.max(gap)]);
                }
            }
        }
        Ok(())
    }
}

/// The rows of the step table, from the first to the last.
struct Motion {
    columns: StepColumns,
    /// Clocks of row 0 and of the last row.
    rows: Option<[u64; 2]>,
}

impl Motion {
    fn new(bench: &Testbench) -> Motion {
        Motion { columns: StepColumns::of(bench), rows: None }
    }

    fn clocks(&self) -> u64 {
        self.rows.map_or(0, |[first, last]| last - first)
    }
}

impl Observer for Motion {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        if self.rows.is_none() {
            let first = (0..rows.len()).find(|&row| self.columns.completes(rows, row, true));
            self.rows = first.map(|row| [rows.clock(row); 2]);
        }
        let stepped = rows.column(self.columns.stepped);
        let last = stepped.iter().rposition(|&stepped| stepped == 1);
        if let (Some(rows_so_far), Some(last)) = (&mut self.rows, last) {
            rows_so_far[1] = rows_so_far[1].max(rows.clock(last));
        }
        Ok(())
    }
}
