//! A machine of a given size by one method: what every register needs, and what runs at the corners of the travel come to.

use std::collections::BTreeMap;

use stepwave_engine::EngineKind;
use stepwave_models::options::{STEP, SYSTEM, WIDTH};
use stepwave_models::{AXES, CurveKind, Millionths, Model, ModelError, Options};
use stepwave_nc::{Arc, Curve, Direction, Line};
use stepwave_netlist::Width;

use super::boxes::{Extent, Geometries};
use super::proof::ProofError;
use super::widths::{RegisterWidth, Tick, simulated, widths};
use super::{Grid, Range};
use crate::testbench::{Ending, PathWatch, Testbench};

/// Clocks after which a run at a corner is given up.
const LIMIT: u64 = 1 << 26;

/// A machine as it is asked for.
#[derive(Clone, PartialEq, Debug)]
pub struct Size {
    /// Travel of each axis in BLU.
    pub travel: Vec<i64>,
    /// Feed along the path in BLU/s.
    pub feed: f64,
    /// One BLU in mm.
    pub blu_mm: f64,
}

impl Size {
    /// mm/min of a speed in BLU/s.
    #[must_use]
    pub fn feed_of(&self, speed: f64) -> f64 {
        speed * self.blu_mm * 60.0
    }
}

/// A run at a corner of the travel.
#[derive(Clone, Debug)]
pub struct Corner {
    /// The geometry, in BLU.
    pub curve: Curve,
    /// How the run ended.
    pub ending: Ending,
    /// Clocks from the loaded block to the last step.
    pub clocks: u64,
    /// Greatest path error in BLU.
    pub error: f64,
}

impl Corner {
    /// BLU a clock on the average: the length of the curve by its clocks.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.curve.length() / self.clocks.max(1) as f64
    }
}

/// A machine by one method.
#[derive(Clone, Debug)]
pub struct Dimensions {
    /// The method.
    pub model: &'static Model,
    /// What every register needs, and how that is known.
    pub registers: Vec<RegisterWidth>,
    /// The options of the runs at the corners: these widths.
    pub choices: Options,
    /// The runs.
    pub corners: Vec<Corner>,
    /// Bits of all its registers together, those of signs, states and the coarse stage of data sampling too, at the corner
    /// that has the most.
    pub register_bits: u32,
    /// The index of that corner.
    largest: usize,
    /// Greatest path error in BLU that the method promises, if it promises one.
    pub bound: Option<f64>,
    /// The clock in Hz by which a period is divided, of data sampling: its feed does not follow from the clock.
    pub sampled_at: Option<f64>,
}

impl Dimensions {
    /// The least clock in Hz with which the slowest corner is as fast as this, in BLU/s; that of the period for data sampling.
    /// `None` where a run did not come to its end.
    #[must_use]
    pub fn clock_hz(&self, feed: f64) -> Option<f64> {
        let [least, _] = self.speeds()?;
        Some(self.sampled_at.unwrap_or(feed / least))
    }

    /// Least and greatest speed at the corners, in BLU a clock; `None` where a run did not come to its end.
    #[must_use]
    pub fn speeds(&self) -> Option<[f64; 2]> {
        if self.corners.is_empty() || self.corners.iter().any(|corner| corner.ending != Ending::Done) {
            return None;
        }
        let speeds = self.corners.iter().map(Corner::speed);
        Some(speeds.fold([f64::INFINITY, 0.0], |[least, greatest], speed| [least.min(speed), greatest.max(speed)]))
    }

    /// The run whose hardware has the most bits of registers.
    #[must_use]
    pub fn largest(&self) -> &Corner {
        &self.corners[self.largest]
    }

    /// That hardware.
    ///
    /// # Errors
    /// It cannot be built: not where these dimensions come from runs.
    pub fn bench(&self) -> Result<Testbench, ModelError> {
        Testbench::new(self.model, &self.largest().curve, &self.choices)
    }

    /// The corner with the greatest path error.
    #[must_use]
    pub fn worst(&self) -> Option<&Corner> {
        self.corners.iter().max_by(|a, b| a.error.total_cmp(&b.error))
    }
}

/// What a model can be asked for a machine of this travel: it runs lines of that many axes, or arcs in the plane.
#[must_use]
pub fn takes(model: &Model, travel: &[i64]) -> bool {
    let kind = model.curve();
    let line = matches!(kind, CurveKind::Line { .. }) && kind.max_axes() >= travel.len();
    !model.is_buffered() && (line || kind == CurveKind::Arc)
}

/// The geometries at the corners: from the origin to them and next to them, those with two axes equally long, and quarters
/// of the greatest circle.
fn corners(model: &Model, travel: &[i64]) -> Vec<Curve> {
    if model.curve() == CurveKind::Arc {
        let r = travel[0].min(travel[1]);
        let quarters = [[[r, 0], [0, r]], [[0, r], [-r, 0]], [[-r, 0], [0, -r]], [[0, -r], [r, 0]]];
        let both = |[from, to]: [[i64; 2]; 2]| {
            let [ccw, cw] = [Direction::CounterClockwise, Direction::Clockwise];
            [Arc::new(from, to, [0, 0], ccw), Arc::new(to, from, [0, 0], cw)]
        };
        return quarters.into_iter().flat_map(both).filter_map(|arc| arc.ok().map(Curve::Arc)).collect();
    }
    let mut ends = vec![travel.to_vec(), travel.iter().map(|side| -side).collect()];
    for axis in 0..travel.len() {
        let alone = |others: i64| -> Vec<i64> {
            (0..travel.len()).map(|other| if other == axis { travel[axis] } else { others }).collect()
        };
        let mut mirrored = travel.to_vec();
        mirrored[axis] = -mirrored[axis];
        ends.extend([alone(0), alone(1), mirrored]);
        // Two axes equally long: the slowest direction of a method with a pulse a step.
        for other in 0..axis {
            let equal = travel[axis].min(travel[other]);
            let pair = (0..travel.len()).map(|own| if own == axis || own == other { equal } else { 1 }).collect();
            let level: Vec<i64> = (0..travel.len()).map(|own| travel[own].min(equal)).collect();
            ends.extend([level.iter().map(|side| -side).collect(), level, pair]);
        }
    }
    ends.into_iter().filter_map(|to| Line::new(vec![0; to.len()], to).ok().map(Curve::Line)).collect()
}

/// A machine whose axes travel as far as this, in BLU, each way from the origin, by one model. `feed` in BLU/s gives data
/// sampling its displacement of a period, at a clock of `clock_hz`.
///
/// Widths are those of [`widths`] over the box where a proof covers it or it is small; else what the runs at the corners
/// need.
///
/// # Errors
/// The hardware cannot be built for such a travel or feed.
pub fn dimensions(
    model: &'static Model,
    travel: &[i64],
    feed: f64,
    clock_hz: f64,
    tick: Tick<'_>,
) -> Result<Dimensions, ProofError> {
    let is_sampled = model.takes(&STEP);
    let mut choices = Options::default().at_clock(clock_hz);
    if is_sampled {
        let step = Millionths::nearest(feed * choices.value(&SYSTEM).period())
            .ok_or_else(|| ProofError::Box(format!("a feed of {feed} BLU/s is too great: give a greater --blu")))?;
        choices = choices.with(&STEP, Some(step));
    }
    let curves = corners(model, travel);
    let mut found = in_box(model, &choices, travel, tick).unwrap_or_else(|| {
        let set = Geometries::these(model, &choices, curves.clone())?;
        let extent = extent(travel)?;
        simulated(model, &choices, &extent, set, tick).map(|found| found.registers)
    })?;
    let width = |register: &RegisterWidth| Some((register.name.clone(), Width::new(register.needed.into()).ok()?));
    let widths: BTreeMap<String, Width> = found.iter().filter_map(width).collect();
    let least = choices.clone().with_single(&WIDTH, widths);
    // Registers of one scale may have to be equally wide.
    let choices = match curves.first().map(|curve| model.plan(curve, &least)) {
        Some(Err(ModelError::Widths(_))) => {
            let own = found.iter().filter(|register| !AXES.contains(&register.name.as_str()));
            let widest = own.map(|register| register.needed).max().unwrap_or(0);
            for register in found.iter_mut().filter(|register| !AXES.contains(&register.name.as_str())) {
                (register.needed, register.shown) = (widest, widest);
            }
            choices.with_all(&WIDTH, Width::new(widest.into()).ok())
        }
        _ => least,
    };
    let (mut runs, mut bound, mut most) = (Vec::new(), None, (0, 0));
    for curve in curves {
        let bench = Testbench::new(model, &curve, &choices)?.limited(LIMIT);
        let mut path = PathWatch::new(&bench, &curve);
        let outcome =
            bench.run(EngineKind::Compiled, &mut [&mut path]).map_err(|error| ProofError::Box(error.to_string()))?;
        let error = path.worst.map_or(0.0, |worst| worst.error);
        bound = bench.hardware().error_bound;
        // The first of those that have as many.
        most = most.max((bench.design().register_bits(), usize::MAX - runs.len()));
        tick(1);
        runs.push(Corner { ending: outcome.ending, clocks: outcome.clocks.saturating_sub(1), error, curve });
    }
    if runs.is_empty() {
        return Err(ProofError::Box("the travel has no corner: give each axis at least one BLU".to_owned()));
    }
    let sampled_at = is_sampled.then_some(clock_hz);
    let (register_bits, largest) = (most.0, usize::MAX - most.1);
    Ok(Dimensions { model, registers: found, choices, corners: runs, register_bits, largest, bound, sampled_at })
}

fn extent(travel: &[i64]) -> Result<Extent, ProofError> {
    let range = |side: &i64| Range::new(-side, *side, 1).map_err(|error| ProofError::Box(error.to_string()));
    Ok(Extent::Grid(Grid(travel.iter().map(range).collect::<Result<_, _>>()?)))
}

/// What the box needs; `None` where its geometries are too many to look at, and no proof covers them.
fn in_box(
    model: &'static Model,
    choices: &Options,
    travel: &[i64],
    tick: Tick<'_>,
) -> Option<Result<Vec<RegisterWidth>, ProofError>> {
    let plane = if model.curve() == CurveKind::Arc { &travel[..2] } else { travel };
    // A period of data sampling takes thousands of clocks.
    if plane.len() != 2 || model.takes(&STEP) {
        return None;
    }
    match extent(plane).and_then(|extent| widths(model, choices, &extent, tick)) {
        Ok(found) => Some(Ok(found.registers)),
        Err(ProofError::Box(_)) => None,
        Err(error) => Some(Err(error)),
    }
}
