//! What a model is: a description for people, and three functions that make it run.

use stepwave_kernel::Netlist;
use stepwave_nc::Curve;

use crate::choices::{Choice, Choices};
use crate::claims::Claims;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::{Machine, Words};

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
    /// Circular arcs in the plane with a way in z.
    Helix,
}

impl CurveKind {
    /// In words, with the options that give it.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            CurveKind::Line { max_axes: 2 } => "lines of 2 axes (--from X,Y --to X,Y)",
            CurveKind::Line { .. } => "lines of 2 to 6 axes (--from X,Y,… --to X,Y,…)",
            CurveKind::Arc => "arcs (--from X,Y --to X,Y --center X,Y --cw|--ccw)",
            CurveKind::Conic => {
                "conics (--ellipse A,B --cw|--ccw, --parabola C or --hyperbola A,B; --from X,Y --to X,Y --center X,Y)"
            }
            CurveKind::Helix => "helices (--from X,Y,Z --to X,Y,Z --center X,Y --cw|--ccw)",
        }
    }

    /// Most axes of such a curve.
    #[must_use]
    pub fn max_axes(self) -> usize {
        match self {
            CurveKind::Line { max_axes } => max_axes,
            CurveKind::Arc | CurveKind::Conic => 2,
            CurveKind::Helix => 3,
        }
    }

    /// The curve is of this kind.
    #[must_use]
    pub fn fits(self, curve: &Curve) -> bool {
        match (self, curve) {
            (CurveKind::Line { max_axes }, Curve::Line(line)) => line.axes() <= max_axes,
            (CurveKind::Arc, Curve::Arc(_))
            | (CurveKind::Conic, Curve::Conic(_))
            | (CurveKind::Helix, Curve::Helix(_)) => true,
            _ => false,
        }
    }
}

/// A register in a model's documentation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RegisterDoc {
    /// Name in waves and tables; `jvx …` stands for one per axis.
    pub name: &'static str,
    /// Default width in terms of n, the width of a magnitude.
    pub width: &'static str,
    /// What it holds and what it is loaded with.
    pub about: &'static str,
}

/// A choice in a model's documentation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ChoiceDoc {
    /// The choice.
    pub choice: Choice,
    /// Values and default.
    pub values: &'static str,
}

/// An interpolator: its documentation, and how it is sized, wired and loaded.
#[derive(Debug)]
pub struct Model {
    /// Name on the command line.
    pub name: &'static str,
    /// One line.
    pub title: &'static str,
    /// Family of methods.
    pub method: &'static str,
    /// What it interpolates.
    pub curve: CurveKind,
    /// Its registers, in the order of the step table.
    pub registers: &'static [RegisterDoc],
    /// The choices that it takes.
    pub choices: &'static [ChoiceDoc],
    /// Literature.
    pub source: &'static str,
    /// What can be proved of it; `None` where nothing is claimed.
    pub claims: Option<Claims>,
    pub(crate) plan: fn(&Curve, &Choices) -> Result<Hardware, ModelError>,
    pub(crate) netlist: fn(&Hardware) -> Result<Netlist, ModelError>,
    pub(crate) words: fn(&Hardware, &Curve) -> Vec<Words>,
}

impl Model {
    /// Fixes every choice for a geometry: widths as given, or else the least that hold it.
    ///
    /// # Errors
    /// The model does not interpolate this curve, does not take a choice, or a width is impossible.
    pub fn plan(&self, curve: &Curve, choices: &Choices) -> Result<Hardware, ModelError> {
        if !self.curve.fits(curve) {
            let given = match curve {
                Curve::Line(line) => format!("a line of {} axes", line.axes()),
                Curve::Arc(_) => "an arc".to_owned(),
                Curve::Conic(_) => "a conic".to_owned(),
                Curve::Helix(_) => "a helix".to_owned(),
            };
            return Err(ModelError::Curve { model: self.name, takes: self.curve.describe(), given });
        }
        let taken = |choice: &Choice| self.choices.iter().any(|doc| doc.choice == *choice);
        if let Some(choice) = choices.given().into_iter().find(|choice| !taken(choice)) {
            let options: Vec<_> = self.choices.iter().map(|doc| doc.choice.option()).collect();
            return Err(ModelError::NotTaken { model: self.name, choice, takes: options.join(", ") });
        }
        (self.plan)(curve, choices)
    }

    /// The netlist of this hardware, elaborated.
    ///
    /// # Errors
    /// The model itself is wrong.
    pub fn machine(&self, hardware: &Hardware) -> Result<Machine, ModelError> {
        Machine::new((self.netlist)(hardware)?, hardware)
    }

    /// The words of every block of a geometry: one for a line, one for each sector of an arc where the loader has to
    /// reload the registers.
    #[must_use]
    pub fn words(&self, hardware: &Hardware, curve: &Curve) -> Vec<Words> {
        (self.words)(hardware, curve)
    }
}
