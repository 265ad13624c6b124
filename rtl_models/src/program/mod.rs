//! Machines that run whole NC programs: one netlist a family of methods, for lines and arcs in three planes.
//!
//! The host loads the next block into a buffer while the present one runs ([`Buffer`](crate::parts::Buffer)); a rate
//! generator on the clock paces the interpolator ([`pulse_source`](crate::parts::pulse_source)); line and arc share its
//! registers; a distributor hands the pulses of the plane's axes to x, y and z; a third axis follows those of the plane.
//! Every step is one clock, and the clock behind the last step of a block loads the next, while the phase of the pulse
//! source goes on: pulses keep their distance across blocks.

mod bresenham;
mod cim;
mod dda;
mod dpm;
mod frame;
mod mindev;
mod planar;
mod ppc;
mod stepgen;

use stepwave_nc::{Crossing, Curve, PulseBlock};
use stepwave_netlist::dsl::{Module, Scope};

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::{Machine, Words};
use crate::options::{ON_OVERFLOW, Options, Takes, chosen};
use crate::parts::{SHARE, WHOLE};
use crate::plan::Plan;
use crate::promise::Promise;
use crate::registers::{Reg, Registers, Rule};

/// Words of every machine that only people read, and their bits: the number of the block, which a program has up to 2^40,
/// and its feed in mm/min.
pub const PROGRAM_WORDS: [Reg; 2] = [
    Reg::new("block", Rule::Bits(41), "N number of the block, or its line where it has none"),
    Reg::new("feed", Rule::Bits(32), "speed that it is to have, in whole mm/min"),
];

/// What the registers of a machine must hold for all blocks of a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Size {
    /// The longest way of an axis in a line, the largest coordinate of an arc about its centre, and the radius of one whose
    /// end lies off its circle, in BLU.
    pub magnitude: u64,
    /// Least and greatest position of each axis, in BLU.
    pub positions: [[i64; 2]; 3],
}

impl Size {
    /// Takes one more block in.
    pub fn add(&mut self, family: &Family, block: &PulseBlock) {
        for (all, [low, high]) in self.positions.iter_mut().zip(block.reach()) {
            *all = [all[0].min(low), all[1].max(high)];
        }
        let arc = match &block.curve {
            Curve::Arc(arc) => Some(arc),
            Curve::Helix(helix) => Some(helix.arc()),
            Curve::Line(_) | Curve::Conic(_) => None,
        };
        let ways = (0..3).map(|axis| block.from[axis].abs_diff(block.to[axis]));
        let sectors = arc.map(|arc| arc.sectors(family.crossing)).unwrap_or_default();
        let radius = arc.map_or(0, crate::sizes::off_circle_radius);
        let magnitude = crate::sizes::largest_coordinate(&sectors).max(radius).max(ways.max().unwrap_or(0));
        self.magnitude = self.magnitude.max(magnitude);
    }
}

/// What a machine is loaded with once: a line, or a sector of an arc.
#[derive(Clone, Debug, PartialEq)]
pub struct HardwareBlock {
    /// The words, but the rate of the pulse source.
    pub words: Words,
    /// Steps that the interpolator takes, as its method has them: those of the pulse source in the block.
    pub steps: f64,
    /// The way of the tool, in BLU.
    pub length: f64,
}

impl HardwareBlock {
    fn has_pulses(&self) -> bool {
        self.words.get(WHOLE).is_some_and(|pulses| pulses > 0)
    }
}

/// A family of methods whose machine runs whole programs.
#[derive(Debug)]
pub struct Family {
    /// Name on the command line.
    pub name: &'static str,
    /// One line.
    pub title: &'static str,
    /// It interpolates arcs; else the control gives it chords.
    pub arcs: bool,
    /// Where arcs are split.
    pub crossing: Crossing,
    /// A commanded feed sets the frequency of the pulse source, f_g = v / (60 δ), whatever the direction of the block;
    /// else it is a feed rate number: f_g makes the block take the time that the feed wants.
    pub direct: bool,
    /// Its registers, in the order of the step table.
    pub registers: Registers,
    /// The options that it takes.
    pub options: &'static [&'static dyn Takes],
    plan: fn(&Size, &mut Plan) -> Result<(), ModelError>,
    hardware: fn(Scope<'_>, &Hardware),
    words: fn(&Hardware, &PulseBlock) -> Vec<HardwareBlock>,
    /// Greatest distance from a curve whose ends lie on it that the method promises, in BLU, if it promises one.
    error_bound: fn(&Hardware, &PulseBlock) -> Option<f64>,
}

/// Every family with a machine.
pub const FAMILIES: [&Family; 7] =
    [&ppc::FAMILY, &dda::FAMILY, &dpm::FAMILY, &cim::FAMILY, &mindev::FAMILY, &stepgen::FAMILY, &bresenham::FAMILY];

impl Family {
    /// Fixes every option for a program of this size.
    ///
    /// # Errors
    /// The family does not take an option, or a width is impossible.
    pub fn plan(&self, size: &Size, options: &Options) -> Result<Hardware, ModelError> {
        let mut plan = Plan::new(self.name, 3, self.registers, chosen(self.name, self.options, options)?);
        (self.plan)(size, &mut plan)?;
        plan.finish()
    }

    /// The netlist of this hardware, elaborated.
    ///
    /// # Errors
    /// The machine itself is wrong.
    pub fn machine(&self, hardware: &Hardware) -> Result<Machine, ModelError> {
        let module = Module::with_overflow(&format!("{}_machine", self.name), hardware.get(&ON_OVERFLOW));
        (self.hardware)(module.top(), hardware);
        Machine::new(module.finish()?, hardware)
    }

    /// Whether a helix is so steep that its third axis cannot follow: in one of its sectors it has more than half as many
    /// pulses as the plane.
    #[must_use]
    pub fn too_steep(&self, block: &PulseBlock) -> bool {
        let Curve::Helix(_) = block.curve else { return false };
        let word = |sector: &HardwareBlock, wanted| sector.words.get(wanted).unwrap_or(0);
        let sectors = planar::blocks(self, block, |_| (Words::new(), 0.0));
        sectors.iter().any(|sector| 2 * word(sector, SHARE) > word(sector, WHOLE))
    }

    /// What the method promises of a block, if it promises anything.
    #[must_use]
    pub fn promise(&self, hardware: &Hardware, block: &PulseBlock) -> Option<Promise> {
        Promise::of((self.error_bound)(hardware, block), &block.curve)
    }

    /// What the machine is loaded with for a block of the program, in order.
    #[must_use]
    pub fn words(&self, hardware: &Hardware, block: &PulseBlock) -> Vec<HardwareBlock> {
        (self.words)(hardware, block)
    }
}
