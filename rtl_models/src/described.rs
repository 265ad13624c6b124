//! Hardware that data describe, such as a netlist with a file about its ports, in place of the functions of a model.

use std::fmt;
use std::sync::{Mutex, PoisonError};

use stepwave_nc::Curve;

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::CurveKind;
use crate::machine::{Machine, Words};
use crate::model::Model;
use crate::plan::Plan;
use crate::program::Moves;

/// How hardware that data describe is planned, built and loaded.
pub trait Described: fmt::Debug + Sync {
    /// What it interpolates.
    fn curve(&self) -> CurveKind;

    /// As [`Method::plan`](crate::Method::plan).
    ///
    /// # Errors
    /// It does not interpolate this curve.
    fn plan(&self, curve: &Curve, plan: &mut Plan) -> Result<(), ModelError>;

    /// The design and its ports.
    ///
    /// # Errors
    /// The netlist that comes of it is wrong.
    fn machine(&self, hardware: &Hardware) -> Result<Machine, ModelError>;

    /// The words of every block of a curve.
    ///
    /// # Errors
    /// A word cannot be computed, or the hardware cannot take it.
    fn words(&self, hardware: &Hardware, curve: &Curve) -> Result<Vec<Words>, ModelError>;

    /// How it takes the moves of a program.
    fn moves(&self) -> &dyn Moves;
}

/// Models that are not of the catalogue.
static KNOWN: Mutex<Vec<&'static Model>> = Mutex::new(Vec::new());

/// Makes a model known to [`find`](crate::find) by its name; where one has this name already, that one stays.
pub fn know(model: Model) -> &'static Model {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(same) = known.iter().find(|same| same.name == model.name) {
        return same;
    }
    let model: &'static Model = Box::leak(Box::new(model));
    known.push(model);
    model
}

/// The model that is [known](know) by this name.
pub(crate) fn known(name: &str) -> Option<&'static Model> {
    let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.iter().find(|model| model.name == name).copied()
}
