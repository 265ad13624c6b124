//! What a model is: a description for people, and the functions that make it run.

use stepwave_nc::{Arc, Conic, Curve, Helix, Line};
use stepwave_netlist::dsl::{Module, Scope};

use crate::claims::Claims;
use crate::described::Described;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::{Machine, Words};
use crate::options::{AnyOption, ON_OVERFLOW, Options, Takes, chosen, taken};
use crate::plan::Plan;
use crate::program::Paced;
use crate::registers::{RegisterGroup, Registers, rows};

/// What a model interpolates.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CurveKind {
    /// Lines of 2 up to this many axes.
    Line {
        /// Most axes.
        max_axes: usize,
    },
    /// Circular arcs in the plane.
    Arc,
    /// Arcs of ellipses, parabolas and hyperbolas in the plane.
    Conic,
    /// Circular arcs in the plane with a displacement in z.
    Helix,
    /// What a program is made of: lines of 2 or 3 axes, circular arcs in the plane, and helices.
    Move,
}

impl CurveKind {
    /// In words, with the options that give it.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            CurveKind::Line { max_axes: 2 } => "lines of 2 axes (--from X,Y --to X,Y)",
            CurveKind::Line { max_axes: 3 } => "lines of 2 or 3 axes (--from X,Y[,Z] --to X,Y[,Z])",
            CurveKind::Line { .. } => "lines of 2 to 6 axes (--from X,Y,… --to X,Y,…)",
            CurveKind::Arc => "arcs (--from X,Y --to X,Y --center X,Y --cw|--ccw)",
            CurveKind::Conic => {
                "conics (--ellipse A,B --cw|--ccw, --parabola C or --hyperbola A,B; --from X,Y --to X,Y --center X,Y)"
            }
            CurveKind::Helix => "helices (--from X,Y,Z --to X,Y,Z --center X,Y --cw|--ccw)",
            CurveKind::Move => {
                "lines of 2 or 3 axes, arcs and helices (--from X,Y[,Z] --to X,Y[,Z], of arcs --center X,Y --cw|--ccw)"
            }
        }
    }

    /// Most axes of such a curve.
    #[must_use]
    pub fn max_axes(self) -> usize {
        match self {
            CurveKind::Line { max_axes } => max_axes,
            CurveKind::Arc | CurveKind::Conic => 2,
            CurveKind::Helix | CurveKind::Move => 3,
        }
    }

    /// The kind of a curve, that of a line with its own axes.
    #[must_use]
    pub fn of(curve: &Curve) -> CurveKind {
        match curve {
            Curve::Line(line) => CurveKind::Line { max_axes: line.axes() },
            Curve::Arc(_) => CurveKind::Arc,
            Curve::Conic(_) => CurveKind::Conic,
            Curve::Helix(_) => CurveKind::Helix,
        }
    }

    /// The curve is of this kind.
    #[must_use]
    pub fn fits(self, curve: &Curve) -> bool {
        match (self, CurveKind::of(curve)) {
            (CurveKind::Line { max_axes }, CurveKind::Line { max_axes: axes }) => axes <= max_axes,
            (CurveKind::Move, CurveKind::Line { max_axes: axes }) => axes <= self.max_axes(),
            (CurveKind::Move, kind) => kind != CurveKind::Conic,
            (own, kind) => own == kind,
        }
    }
}

/// How a model plans its hardware for a curve of type C, and loads one.
#[derive(Debug)]
pub struct Method<C: 'static> {
    /// Fixes registers, widths and promises for a curve; all that the hardware depends on comes from here.
    ///
    /// An error names a width or a value that cannot be.
    pub plan: fn(&C, &mut Plan) -> Result<(), ModelError>,
    /// The words of every block of a curve: one for a line, one for each sector of an arc where the loader has to reload
    /// the registers.
    pub load: fn(&C, &Hardware) -> Vec<Words>,
}

/// What a model interpolates, and how it plans and loads it.
#[derive(Debug)]
pub enum Interpolates {
    /// Lines of 2 up to this many axes.
    Lines(usize, Method<Line>),
    /// Circular arcs in the plane.
    Arcs(Method<Arc>),
    /// Arcs of ellipses, parabolas and hyperbolas in the plane.
    Conics(Method<Conic>),
    /// Circular arcs in the plane with a displacement in z.
    Helices(Method<Helix>),
    /// The moves of a program, or one of them alone.
    Moves(Paced),
    /// What data describe, wiring included: [`Model::hardware`] is not called.
    Described(&'static dyn Described),
}

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
        match &self.interpolates {
            Interpolates::Lines(max_axes, _) => CurveKind::Line { max_axes: *max_axes },
            Interpolates::Arcs(_) => CurveKind::Arc,
            Interpolates::Conics(_) => CurveKind::Conic,
            Interpolates::Helices(_) => CurveKind::Helix,
            Interpolates::Moves(moves) if moves.arcs => CurveKind::Move,
            Interpolates::Moves(_) => CurveKind::Line { max_axes: 3 },
            Interpolates::Described(described) => described.curve(),
        }
    }

    /// It is hardware that data describe, whose widths are not to be chosen.
    #[must_use]
    pub fn is_described(&self) -> bool {
        matches!(self.interpolates, Interpolates::Described(_))
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
        if let Interpolates::Moves(moves) = &self.interpolates
            && let Some(block) = moves.block(curve)
        {
            return self.plan_alone(moves, &block, new()?);
        }
        let plan = match (&self.interpolates, curve) {
            (Interpolates::Lines(most, method), Curve::Line(line)) if line.axes() <= *most => {
                method.planned(line, new()?)
            }
            (Interpolates::Arcs(method), Curve::Arc(arc)) => method.planned(arc, new()?),
            (Interpolates::Conics(method), Curve::Conic(conic)) => method.planned(conic, new()?),
            (Interpolates::Helices(method), Curve::Helix(helix)) => method.planned(helix, new()?),
            (Interpolates::Described(described), _) if described.curve().fits(curve) => {
                let mut plan = new()?;
                described.plan(curve, &mut plan).map(|()| plan)
            }
            _ => {
                let given = match curve {
                    Curve::Line(line) => format!("a line of {} axes", line.axes()),
                    Curve::Arc(_) => "an arc".to_owned(),
                    Curve::Conic(_) => "a conic".to_owned(),
                    Curve::Helix(_) => "a helix".to_owned(),
                };
                return Err(ModelError::Curve { model: self.name, takes: self.curve().describe(), given });
            }
        };
        plan?.finish()
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
        if let Interpolates::Described(described) = &self.interpolates {
            return described.words(hardware, curve);
        }
        Ok(match (&self.interpolates, curve) {
            (Interpolates::Lines(_, method), Curve::Line(line)) => (method.load)(line, hardware),
            (Interpolates::Arcs(method), Curve::Arc(arc)) => (method.load)(arc, hardware),
            (Interpolates::Conics(method), Curve::Conic(conic)) => (method.load)(conic, hardware),
            (Interpolates::Helices(method), Curve::Helix(helix)) => (method.load)(helix, hardware),
            (Interpolates::Moves(moves), _) => moves.words_alone(hardware, curve),
            _ => Vec::new(),
        })
    }
}

impl<C> Method<C> {
    fn planned(&self, curve: &C, mut plan: Plan) -> Result<Plan, ModelError> {
        (self.plan)(curve, &mut plan)?;
        Ok(plan)
    }
}
