//! What a model is: a description for people, and the functions that make it run.

use stepwave_nc::Curve;
use stepwave_netlist::dsl::{Module, Scope};

use crate::claims::Claims;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{CurveKind, Interpolates};
use crate::machine::{Machine, Words};
use crate::options::{AnyOption, BEATS, ON_OVERFLOW, Options, Takes, chosen, taken};
use crate::plan::Plan;
use crate::registers::{RegisterGroup, Registers, rows};

/// An interpolator: its documentation, and how it is planned, wired and loaded.
#[derive(Debug)]
pub struct Model {
    /// Name on the command line.
    pub name: &'static str,
    /// One line.
    pub title: &'static str,
    /// Family of methods.
    pub method: &'static str,
    /// Literature.
    pub source: &'static str,
    /// Its registers, in the order of the step table.
    pub registers: Registers,
    /// The options that it takes.
    pub options: &'static [&'static dyn Takes],
    /// What can be proved of it; `None` where nothing is claimed.
    pub claims: Option<Claims>,
    /// What it interpolates, and how it is planned and loaded.
    pub interpolates: Interpolates,
    /// The wiring, from the top scope of a module that the caller makes.
    pub hardware: fn(Scope<'_>, &Hardware),
}

impl Model {
    /// What it interpolates.
    #[must_use]
    pub fn curve(&self) -> CurveKind {
        self.interpolates.of().0
    }

    /// It is hardware that data describe, whose widths are not to be chosen.
    #[must_use]
    pub fn is_described(&self) -> bool {
        matches!(self.interpolates, Interpolates::Described(_))
    }

    /// --width is the width of coordinates, and not of the ways of a period or of a phase.
    #[must_use]
    pub fn width_is_of_coordinates(&self) -> bool {
        self.method != "data sampling" && !self.is_described() && !self.width_is_of_phase()
    }

    /// --width is that of the phase of a pulse source, in whose units speeds are: it says nothing of coordinates.
    #[must_use]
    pub fn width_is_of_phase(&self) -> bool {
        self.curve() == CurveKind::Axis
    }

    /// Its registers by what is declared together, in the order of the step table.
    pub fn rows(&self) -> impl Iterator<Item = RegisterGroup> {
        rows(self.registers)
    }

    /// The model takes this option.
    #[must_use]
    pub fn takes(&self, option: &dyn AnyOption) -> bool {
        self.options.iter().any(|takes| takes.name() == option.name())
    }

    /// Refuses an option that the model does not take.
    ///
    /// # Errors
    /// The model does not take it; the message lists those that it does.
    pub fn require(&self, option: &'static dyn AnyOption) -> Result<(), ModelError> {
        taken(self.name, self.options, option).map(drop)
    }

    /// Fixes every option for a geometry: widths as given, or else the least that hold it.
    ///
    /// # Errors
    /// The model does not interpolate this curve, does not take an option, or a width is impossible.
    pub fn plan(&self, curve: &Curve, options: &Options) -> Result<Hardware, ModelError> {
        let new = || {
            chosen(self.name, self.options, options)
                .map(|options| Plan::new(self.name, curve.axes(), self.registers, options))
        };
        let other = || {
            let given = match curve {
                Curve::Line(line) if line.axes() == 1 => "a displacement of one axis".to_owned(),
                Curve::Line(line) => format!("a line of {} axes", line.axes()),
                other => other.description().drawn.noun().to_owned(),
            };
            ModelError::Curve { model: self.name, takes: self.curve().describe(), given }
        };
        if !self.curve().fits(curve) {
            return Err(other());
        }
        let mut plan = new()?;
        if self.takes(&BEATS) {
            plan.step_clocks = Some(plan.get(&BEATS).clocks());
        }
        let planned = match &self.interpolates {
            Interpolates::Moves(moves) => {
                return self.plan_alone(moves, &moves.block(curve).ok_or_else(other)?, plan);
            }
            Interpolates::Described(described) => Some(described.plan(curve, &mut plan)),
            typed => typed.of().1.and_then(|method| method.plan(curve, &mut plan)),
        };
        planned.ok_or_else(other)??;
        plan.finish()
    }

    /// The netlist of this hardware, elaborated.
    ///
    /// # Errors
    /// The model itself is wrong.
    pub fn machine(&self, hardware: &Hardware) -> Result<Machine, ModelError> {
        if let Interpolates::Described(described) = &self.interpolates {
            return described.machine(hardware);
        }
        let module = Module::with_overflow(&self.name.replace('-', "_"), hardware.get(&ON_OVERFLOW));
        (self.hardware)(module.top(), hardware);
        Machine::new(module.finish()?, hardware)
    }

    /// The words of every block of a geometry; none of a curve that the model does not interpolate.
    ///
    /// # Errors
    /// Of hardware that data describe: a word cannot be computed, or the hardware cannot take it.
    pub fn words(&self, hardware: &Hardware, curve: &Curve) -> Result<Vec<Words>, ModelError> {
        match &self.interpolates {
            Interpolates::Described(described) => described.words(hardware, curve),
            Interpolates::Moves(moves) => Ok(moves.words_alone(hardware, curve)),
            typed => Ok(typed.of().1.map_or_else(Vec::new, |method| method.load(curve, hardware))),
        }
    }
}
