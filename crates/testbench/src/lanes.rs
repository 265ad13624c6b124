//! Many geometries of one hardware at once.

use rayon::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_engine::lanes::{Job, LaneEnd, LaneProgram, LaneStop, LaneWatch, Observe, Quiet};
use stepwave_models::options::ON_OVERFLOW;
use stepwave_models::{Loaded, Machine, Model, ModelError, find};
use stepwave_nc::Curve;
use stepwave_netlist::bits::to_signed;
use stepwave_netlist::{Net, OnOverflow};

use super::instruments::Instruments;
use super::measure::Measured;
use super::{CHUNK, Ending, Outcome, OverflowWatch, Testbench};

/// What one geometry came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaneOutcome {
    /// How it ended; `None` where the limit of clocks was reached.
    pub ending: Option<Ending>,
    /// Clocks since reset: the clock of the last sample.
    pub clocks: u64,
    /// Steps completed.
    pub steps: u64,
    /// Pulses of each axis, in either direction.
    pub pulses: Vec<u64>,
    /// Where the pulses led, in BLU.
    pub reached: Vec<i64>,
    /// Clocks at which a property did not hold.
    pub overflows: u64,
}

/// One hardware, ready to run many geometries.
#[derive(Debug)]
pub struct Lanes {
    bench: Testbench,
    model: &'static Model,
    program: LaneProgram,
    /// Numbers of which an outcome is made; after them come those of the instruments.
    own: usize,
    /// An overflow ends a run, so that the position counters can be believed.
    trusted: bool,
    instruments: Option<Instruments>,
}

impl Testbench {
    /// Makes this hardware ready to run many geometries, each for about `limit` clocks at most: the limit counts in the
    /// samples in which a block runs.
    ///
    /// # Errors
    /// The hardware is of no known model.
    pub fn lanes(&self, limit: u64) -> Result<Lanes, ModelError> {
        self.lanes_with(limit, None)
    }

    /// As [`lanes`](Self::lanes), and ready to measure what [`Lanes::measure`] gives; `None` where the path of this
    /// hardware cannot be measured in lanes.
    ///
    /// # Errors
    /// The hardware is of no known model.
    pub fn measuring_lanes(&self, limit: u64) -> Result<Option<Lanes>, ModelError> {
        let model = find(self.hardware.model)?;
        let instruments = if self.machine.buffer.is_some() { None } else { Instruments::new(self, model.curve()) };
        instruments.map(|instruments| self.lanes_with(limit, Some(instruments))).transpose()
    }

    fn lanes_with(&self, limit: u64, instruments: Option<Instruments>) -> Result<Lanes, ModelError> {
        let model = find(self.hardware.model)?;
        let machine = &self.machine;
        let reported = self.design().netlist().properties.iter().filter(|property| !property.claim.is_announced());
        let never: Vec<Net> = reported.map(|property| property.never).collect();
        let pulses: Vec<Net> = machine.pulses.iter().map(|port| port.net).collect();
        let traps =
            if self.hardware.get(&ON_OVERFLOW) == OnOverflow::Trap { machine.traps.clone() } else { Vec::new() };
        let mut observe: Vec<Observe> = machine.positions.iter().map(|port| Observe::Last(port.net)).collect();
        observe.extend(pulses.iter().map(|&net| Observe::Count(vec![net])));
        let trusted = never.iter().all(|flag| traps.contains(flag));
        if !trusted {
            // +1 counts as 1 and -1 as 3: with the number of pulses this gives their sum.
            observe.extend(pulses.iter().map(|&net| Observe::Sum { net, bits: 64 }));
        }
        observe.push(Observe::Count(vec![machine.stepped.net]));
        if !trusted {
            observe.push(Observe::Count(never));
        }
        let own = observe.len();
        observe.extend(instruments.iter().flat_map(Instruments::observe));
        let watch = LaneWatch {
            traps,
            rest: vec![(machine.load.net, 0), (machine.preset_position.net, 0)],
            observe,
            // A run of one geometry looks for rest when its rows are full.
            quiet: Some(Quiet { nets: pulses, clocks: self.hardware.stall_clocks, every: CHUNK as u64 }),
            limit,
            ..LaneWatch::new(machine.done.net)
        };
        let design = instruments.as_ref().map_or(self.design(), Instruments::design);
        Ok(Lanes { bench: self.clone(), model, program: LaneProgram::new(design, &watch), own, trusted, instruments })
    }

    /// Runs many geometries of this hardware and gives what each came to, in their order, exactly as
    /// [`run`](Testbench::run) does for each alone.
    ///
    /// # Errors
    /// The hardware is of no known model; and for each geometry, that the hardware does not take it.
    pub fn run_many(&self, curves: &[Curve], limit: u64) -> Result<Vec<Result<LaneOutcome, ModelError>>, ModelError> {
        if self.machine.buffer.is_some() {
            let model = find(self.hardware.model)?;
            return Ok(curves.par_iter().map(|curve| self.run_alone(model, curve, limit)).collect());
        }
        let mut outcomes = Vec::with_capacity(curves.len());
        self.lanes(limit)?.run(curves.iter(), |outcome| outcomes.push(outcome));
        Ok(outcomes)
    }

    /// What one geometry came to in a run of its own.
    fn run_alone(&self, model: &Model, curve: &Curve, limit: u64) -> Result<LaneOutcome, ModelError> {
        let bench = self.of(model, curve)?.limited(limit);
        let mut overflow = OverflowWatch::new(&bench);
        // Nothing in it can fail.
        let outcome = bench.run(EngineKind::Word, &mut [&mut overflow]).ok();
        let ended = outcome.filter(|outcome| !matches!(outcome.ending, Ending::Limit | Ending::Endless { .. }));
        Ok(match ended {
            Some(Outcome { ending, clocks, steps, pulses, reached, .. }) => {
                LaneOutcome { ending: Some(ending), clocks, steps, pulses, reached, overflows: overflow.count }
            }
            None => {
                let axes = self.hardware.axes;
                let (pulses, reached) = (vec![0; axes], vec![0; axes]);
                LaneOutcome { ending: None, clocks: limit, steps: 0, pulses, reached, overflows: overflow.count }
            }
        })
    }
}

impl Lanes {
    /// Runs geometries on all threads; `sink` gets what each came to, in their order, one at a time. Memory does not
    /// grow with their number.
    pub fn run<C: std::borrow::Borrow<Curve> + Clone + Send>(
        &self,
        curves: impl Iterator<Item = C> + Clone + Send,
        mut sink: impl FnMut(Result<LaneOutcome, ModelError>) + Send,
    ) {
        let mut ran = curves.clone();
        self.program.run(
            curves,
            |curve| self.job(curve.borrow()),
            |end: Result<LaneEnd, ModelError>| {
                let curve = ran.next();
                let start = curve.as_ref().map_or(&[][..], |curve| curve.borrow().from());
                sink(end.map(|end| self.outcome(&end, start)));
            },
        );
    }

    /// Runs geometries as [`run`](Self::run) and gives what was measured of each, exactly as
    /// [`Testbench::measure`] does alone: `None` where the instruments cannot follow, so that it has to be run alone.
    /// Lanes that have no instruments give `None` always.
    pub fn measure<C: std::borrow::Borrow<Curve> + Clone + Send>(
        &self,
        curves: impl Iterator<Item = C> + Clone + Send,
        mut sink: impl FnMut(Result<Option<Measured>, ModelError>) + Send,
    ) {
        let prepare = |curve: C| {
            let mut job = self.job(curve.borrow())?;
            let words = self.instruments.as_ref().and_then(|instruments| instruments.words(curve.borrow()));
            if let (Some(first), Some(words)) = (job.blocks.first_mut(), words) {
                first.extend(words);
            }
            Ok(job)
        };
        let mut measured = curves.clone();
        self.program.run(curves, prepare, |end: Result<LaneEnd, ModelError>| {
            let curve = measured.next();
            sink(end.map(|end| {
                let (curve, instruments) = (curve?, self.instruments.as_ref()?);
                let outcome = self.outcome(&end, curve.borrow().from());
                let measured = instruments.read(&self.bench, curve.borrow(), outcome, end.values.get(self.own..)?)?;
                let cut = if self.trusted { Vec::new() } else { self.load(curve.borrow()).ok()?.cut };
                Some(Measured { cut, ..measured })
            }));
        });
    }

    /// The program that runs the lanes.
    #[must_use]
    pub fn program(&self) -> &LaneProgram {
        &self.program
    }

    /// The blocks of a geometry, with the strobes that load them.
    ///
    /// # Errors
    /// The hardware does not take it.
    pub fn job(&self, curve: &Curve) -> Result<Job, ModelError> {
        let machine = self.bench.machine();
        let mut blocks = self.load(curve)?.blocks;
        for (index, block) in blocks.iter_mut().enumerate() {
            block.push((machine.load.net, 1));
            block.push((machine.preset_position.net, u64::from(index == 0)));
        }
        Ok(Job { blocks })
    }

    /// What the inputs are set to for a geometry.
    fn load(&self, curve: &Curve) -> Result<Loaded, ModelError> {
        let hardware = self.bench.hardware();
        let words = if curve.axes() == hardware.axes { self.model.words(hardware, curve)? } else { Vec::new() };
        if words.is_empty() {
            let given = format!("a curve of {} axes in hardware for {}", curve.axes(), hardware.axes);
            return Err(ModelError::Curve { model: self.model.name, takes: self.model.curve().describe(), given });
        }
        self.bench.load(&words)
    }

    fn outcome(&self, end: &LaneEnd, start: &[i64]) -> LaneOutcome {
        let Machine { positions, pulses, .. } = self.bench.machine();
        let (last, counts) = end.values[..self.own].split_at(positions.len());
        let (pulse_counts, rest) = counts.split_at(pulses.len());
        let (sums, rest) = rest.split_at(if self.trusted { 0 } else { pulses.len() });
        let led = |(axis, sum): (usize, &u64)| {
            let travel = pulse_counts[axis].wrapping_mul(2).wrapping_sub(*sum).cast_signed();
            start.get(axis).copied().unwrap_or(0).saturating_add(travel)
        };
        let shown = || positions.iter().zip(last).map(|(port, &bits)| to_signed(port.width, bits)).collect();
        let ending = match end.stop {
            LaneStop::Done => Some(Ending::Done),
            LaneStop::Trap(_) => Some(Ending::Trapped),
            LaneStop::Quiet { clocks } => Some(Ending::Stalled { clocks }),
            LaneStop::Limit => None,
        };
        LaneOutcome {
            ending,
            clocks: end.clock,
            steps: rest[0],
            pulses: pulse_counts.to_vec(),
            reached: if self.trusted { shown() } else { sums.iter().enumerate().map(led).collect() },
            // A trap ends the run at the first.
            overflows: rest.get(1).copied().unwrap_or(u64::from(ending == Some(Ending::Trapped))),
        }
    }
}
