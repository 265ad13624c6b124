//! Path error: how far each position lies off the ideal curve.

use stepwave_nc::Curve;

use super::{Observer, ObserverError, Step};

/// The greatest path error of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstError {
    /// Distance from the ideal curve in BLU.
    pub error: f64,
    /// Step after which it was seen.
    pub step: u64,
    /// Position there, in BLU.
    pub position: Vec<i64>,
}

/// Finds the greatest path error.
pub struct PathWatch<'a> {
    curve: &'a Curve,
    /// The first greatest so far.
    pub worst: Option<WorstError>,
}

impl<'a> PathWatch<'a> {
    /// Against this curve.
    #[must_use]
    pub fn new(curve: &'a Curve) -> PathWatch<'a> {
        PathWatch { curve, worst: None }
    }
}

impl Observer for PathWatch<'_> {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        let error = self.curve.deviation(&step.position);
        if self.worst.as_ref().is_none_or(|worst| error > worst.error) {
            self.worst = Some(WorstError { error, step: step.number, position: step.position.clone() });
        }
        Ok(())
    }
}
