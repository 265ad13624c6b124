//! Machines that run whole NC programs: one netlist a method, for lines and arcs in three planes, and by `dda` for free curves.
//!
//! The host loads the next block into a buffer while the present one runs ([`Buffer`](crate::parts::Buffer)); a rate
//! generator on the clock paces the interpolator ([`pulse_source`](crate::parts::pulse_source)); line and arc share its
//! registers; a distributor hands the pulses of the plane's axes to x, y and z; a third axis follows those of the plane.
//! Every step is one clock, and the clock after the last step of a block loads the next, while the phase of the pulse
//! source continues: pulses keep their distance across blocks.

/// The options of a machine with our pulse source: its own after the width, and those that all have.
macro_rules! machine_options {
    ($($own:expr),* $(,)?) => {
        &[
            &crate::options::WIDTH,
            $($own,)*
            &crate::options::ON_OVERFLOW,
            &crate::program::after::PATH_ACCEL,
            &crate::program::after::PATH_JERK,
            &crate::options::RAMP,
            &crate::program::after::OUTPUT_SMOOTH,
            &crate::program::after::OUTPUT_PERIOD,
        ]
    };
}

mod acceleration;
mod after;
pub mod bresenham;
pub mod cim;
mod curve;
pub mod dda;
pub mod dpm;
mod frame;
pub mod mindev;
mod planar;
pub mod ppc;
pub mod stepgen;

pub use acceleration::{Acceleration, Profile};
pub use after::After;
pub use curve::CurveSize;

use std::fmt;

use stepwave_nc::{AXES_MAX, Crossing, Curve, PulseBlock};

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::Interpolates;
use crate::machine::Words;
use crate::model::Model;
use crate::options::{Options, chosen};
use crate::parts::{FASTEST_RATE, POSITION, PULSE_RATE, RATE_BITS, SETTLE};
use crate::plan::Plan;
use crate::promise::Promise;
use crate::registers::{Reg, Rule};

/// Words of every machine that only people read, and their bits: the number of the block, which a program has up to 2^40,
/// and its feed in mm/min.
pub const PROGRAM_WORDS: [Reg; 2] = [
    Reg::new("block", Rule::Bits(41), "N number of the block, or its line where it has none"),
    Reg::new("feed", Rule::Bits(32), "speed that it is to have, in whole mm/min"),
];

/// What the registers of a machine must hold for all blocks of a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Size {
    /// The longest displacement of an axis in a line, the largest coordinate of an arc about its centre, and the radius of one whose
    /// end lies off its circle, in BLU.
    pub magnitude: u64,
    /// Least and greatest position of each axis, in BLU.
    pub positions: [[i64; 2]; AXES_MAX],
    /// Axes that the blocks need: x, y, z, and all up to the last that moves.
    pub axes: usize,
    /// Of free curves, if there are any.
    pub curves: Option<CurveSize>,
}

impl Size {
    /// Takes in one more block of a machine that splits arcs there.
    pub fn add(&mut self, crossing: Crossing, block: &PulseBlock) {
        let own = Size::of(crossing, block);
        for (all, [low, high]) in self.positions.iter_mut().zip(own.positions) {
            *all = [all[0].min(low), all[1].max(high)];
        }
        self.magnitude = self.magnitude.max(own.magnitude);
        self.axes = self.axes.max(own.axes);
        self.curves = match (self.curves, own.curves) {
            (Some(all), Some(own)) => Some(all.with(own)),
            (all, own) => all.or(own),
        };
    }

    /// Of one block alone.
    fn of(crossing: Crossing, block: &PulseBlock) -> Size {
        let arc = block.curve.arc();
        let travels = (0..AXES_MAX).map(|axis| block.travel(axis).unsigned_abs());
        let sectors = arc.map(|arc| arc.sectors(crossing)).unwrap_or_default();
        let radius = arc.map_or(0, crate::sizes::off_circle_radius);
        let curves = if let Curve::Spline(spline) = &block.curve { CurveSize::of(spline) } else { None };
        // A curve that is not cut has registers of its own.
        let travel = if curves.is_some() { 0 } else { travels.max().unwrap_or(0) };
        let magnitude = crate::sizes::largest_coordinate(&sectors).max(radius).max(travel);
        let axes = (3..AXES_MAX).filter(|axis| block.travel(*axis) != 0).max().map_or(3, |last| last + 1);
        Size { magnitude, positions: block.reach(), axes, curves }
    }
}

/// What a machine is loaded with once: a line, or a sector of an arc.
#[derive(Clone, Debug, PartialEq)]
pub struct HardwareBlock {
    /// The words, but the rate of the pulse source.
    pub words: Words,
    /// Steps that the interpolator takes, as its method has them: those of our pulse source in the block, 0 without one.
    pub steps: f64,
    /// The path length of the tool, in BLU.
    pub length: f64,
}

/// 2^bits.
fn power(bits: u32) -> u64 {
    1_u64.checked_shl(bits).unwrap_or(u64::MAX)
}

/// What sets the feed of a machine.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Pacing {
    /// Our pulse source: a commanded feed v in mm/min sets its frequency, f_g = v / (60 δ), whatever the direction of the block.
    Feed,
    /// Our pulse source: f_g makes the block take the time that the feed wants.
    Time,
    /// The hardware itself.
    Hardware {
        /// It takes the commanded speed as a word.
        reads_speed: bool,
    },
}

/// The greatest commanded speed, in 2^-32 BLU a clock: as fast as the hardware can.
pub const FASTEST_SPEED: u64 = (1 << 32) - 1;

/// How a machine takes the moves of a program, each as one or more blocks.
pub trait Moves: fmt::Debug + Sync {
    /// It interpolates arcs; else the control gives it chords.
    fn arcs(&self) -> bool;

    /// It interpolates curves of G5 and G5.1, where they are not too long; else the control gives it chords.
    fn curves(&self) -> bool {
        false
    }

    /// It interpolates this block; else the control gives it chords.
    fn takes(&self, block: &PulseBlock) -> bool;

    /// Refuses a block that it cannot run.
    ///
    /// # Errors
    /// The block goes along an axis that it does not have, or is a line or an arc that it does not take.
    fn check(&self, block: &PulseBlock) -> Result<(), ModelError> {
        let _ = block;
        Ok(())
    }

    /// Where arcs are split.
    fn crossing(&self) -> Crossing;

    /// Axes of a machine for blocks of this size.
    fn axes(&self, size: &Size) -> usize {
        size.axes.max(3)
    }

    /// What sets its feed.
    fn pacing(&self) -> Pacing;

    /// Fixes registers, widths and promises for blocks of this size.
    ///
    /// # Errors
    /// A width or a value that cannot be.
    fn plan(&self, size: &Size, plan: &mut Plan) -> Result<(), ModelError>;

    /// What the machine is loaded with for a block of the program, in order; all words but the rate of our pulse source.
    /// `speed` is the commanded one in 2^-32 BLU a clock, from 1 to [`FASTEST_SPEED`].
    ///
    /// # Errors
    /// Of hardware that data describe: a word cannot be computed, or the hardware cannot take it.
    fn words(&self, hardware: &Hardware, block: &PulseBlock, speed: u64) -> Result<Vec<HardwareBlock>, ModelError>;

    /// What the method promises of a block, if it promises anything.
    fn promise(&self, hardware: &Hardware, block: &PulseBlock) -> Option<Promise>;
}

/// How a machine with our pulse source takes moves: lines in three axes, arcs and helices.
#[derive(Debug)]
pub struct Paced {
    /// Where it splits the arcs that it interpolates; `None`: the control gives it chords.
    pub arcs: Option<Crossing>,
    /// It interpolates free curves.
    pub curves: bool,
    /// A commanded feed sets the frequency of the pulse source, f_g = v / (60 δ), whatever the direction of the block;
    /// else it is a feed rate number: f_g makes the block take the time that the feed wants.
    pub direct: bool,
    /// Fixes registers, widths and promises for blocks of this size.
    ///
    /// An error names a width or a value that cannot be.
    pub plan: fn(&Size, &mut Plan) -> Result<(), ModelError>,
    /// Most steps of a line or a sector, and for a BLU of its path.
    pub most_steps: fn(&Size, &Plan) -> [u64; 2],
    /// What the machine is loaded with for a block of the program, in order; all words but the rate of the pulse source.
    pub load: fn(&PulseBlock, &Hardware) -> Vec<HardwareBlock>,
    /// Greatest distance from a curve whose ends lie on it that the method promises, in BLU, if it promises one.
    pub error_bound: fn(&Hardware, &PulseBlock) -> Option<f64>,
}

impl Moves for Paced {
    fn arcs(&self) -> bool {
        self.arcs.is_some()
    }

    fn curves(&self) -> bool {
        self.curves
    }

    fn takes(&self, block: &PulseBlock) -> bool {
        match &block.curve {
            Curve::Spline(spline) => self.curves && CurveSize::of(spline).is_some(),
            _ => !self.too_steep(block),
        }
    }

    fn crossing(&self) -> Crossing {
        self.arcs.unwrap_or(Crossing::RoundedRadius)
    }

    fn pacing(&self) -> Pacing {
        if self.direct { Pacing::Feed } else { Pacing::Time }
    }

    fn plan(&self, size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
        (self.plan)(size, plan)?;
        after::plan(plan)?;
        acceleration::plan(plan, (self.most_steps)(size, plan))
    }

    fn words(&self, hardware: &Hardware, block: &PulseBlock, _: u64) -> Result<Vec<HardwareBlock>, ModelError> {
        Ok((self.load)(block, hardware))
    }

    fn promise(&self, hardware: &Hardware, block: &PulseBlock) -> Option<Promise> {
        Promise::of((self.error_bound)(hardware, block), &block.curve)
    }
}

impl Paced {
    /// Whether an arc is so steep that an axis cannot follow: in one of its sectors it has more than half as many pulses as the
    /// plane.
    fn too_steep(&self, block: &PulseBlock) -> bool {
        let follows = block.axes.len() > 2 || block.moves_others();
        let Some(arc) = block.curve.arc().filter(|_| self.arcs.is_some() && follows) else { return false };
        planar::pieces(self.crossing(), block, arc).iter().any(|sector| {
            let whole: i64 = sector.pulses.iter().sum();
            sector.travels.iter().any(|travel| 2 * travel.abs() > whole)
        })
    }

    /// The block of a curve that the machine runs alone; `None` of one that it does not interpolate.
    pub(crate) fn block(&self, curve: &Curve) -> Option<PulseBlock> {
        let takes = match curve {
            Curve::Line(_) => true,
            _ => self.arcs.is_some() && curve.arc().is_some(),
        };
        takes.then(|| PulseBlock::alone(curve)).flatten()
    }

    /// The words of every block of a curve that runs alone: from where it starts, as fast as the pulse source goes.
    pub(crate) fn words_alone(&self, hardware: &Hardware, curve: &Curve) -> Vec<Words> {
        let [number, feed] = PROGRAM_WORDS;
        let blocks = self.block(curve).map(|block| (self.load)(&block, hardware)).unwrap_or_default();
        let loaded = |(index, block): (i128, HardwareBlock)| {
            let words = match Acceleration::of(hardware) {
                None => block.words.set(PULSE_RATE, FASTEST_RATE),
                Some(by) => block.words.clone().and(by.alone(block.steps, block.length)),
            };
            let words = if After::of(hardware).is_some() { words.set(SETTLE, false) } else { words };
            let words = words.set(number, index).set(feed, 0);
            let from = curve.from().iter().enumerate();
            from.fold(words, |words, (axis, &from)| words.set(POSITION.of(axis), from))
        };
        (1..).zip(blocks).map(loaded).collect()
    }
}

/// What the name of a model that runs programs ends with, after the name of its method.
const MACHINE: &str = "-machine";

impl Model {
    /// How it takes the moves of a program.
    ///
    /// # Errors
    /// It does not run programs.
    pub fn moves(&self) -> Result<&dyn Moves, ModelError> {
        match &self.interpolates {
            Interpolates::Moves(paced) => Ok(paced),
            Interpolates::Described(described) => Ok(described.moves()),
            _ => Err(ModelError::Curve {
                model: self.name,
                takes: self.curve().describe(),
                given: "a program".to_owned(),
            }),
        }
    }

    /// It runs programs from a block buffer, with our pulse source.
    #[must_use]
    pub fn is_buffered(&self) -> bool {
        matches!(self.interpolates, Interpolates::Moves(_))
    }

    /// What a model that runs programs is called there: its name without `-machine`.
    #[must_use]
    pub fn method_name(&self) -> &'static str {
        match self.name.strip_suffix(MACHINE) {
            Some(method) if self.is_buffered() => method,
            _ => self.name,
        }
    }

    /// Fixes every option for a program of this size.
    ///
    /// # Errors
    /// The model does not run programs or does not take an option, or a width is impossible.
    pub fn plan_program(&self, size: &Size, options: &Options) -> Result<Hardware, ModelError> {
        let name = self.method_name();
        let moves = self.moves()?;
        let mut plan = Plan::new(name, moves.axes(size), self.registers, chosen(name, self.options, options)?);
        moves.plan(size, &mut plan)?;
        plan.finish()
    }

    /// Fixes every option for a block that runs alone, in as many axes as its curve has.
    pub(crate) fn plan_alone(&self, moves: &Paced, block: &PulseBlock, mut plan: Plan) -> Result<Hardware, ModelError> {
        if moves.too_steep(block) {
            return Err(ModelError::Widths(format!(
                "{}: z climbs more than half as many pulses as x and y have in a sector of the helix, so that it cannot \
                 follow: give a --to less far in z",
                self.name
            )));
        }
        moves.plan(&Size::of(moves.crossing(), block), &mut plan)?;
        plan.step_clocks = Some((1 << RATE_BITS) / FASTEST_RATE);
        let hardware = plan.finish()?;
        // A program divides a helix, so that its third axis strays by less than a pulse; alone it is not divided.
        let divided = !matches!(block.curve, Curve::Helix(_));
        Ok(Hardware { error_bound: (moves.error_bound)(&hardware, block).filter(|_| divided), ..hardware })
    }
}
