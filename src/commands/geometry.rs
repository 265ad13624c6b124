//! The curve that the options of several commands give.

use stepwave::models::{CurveKind, Model};
use stepwave::nc::{Arc, Curve, Direction, Line};

use crate::cli::{GeometryArgs, Point};
use crate::failure::Failure;

/// The curve that the options give.
///
/// # Errors
/// Something is missing, or the model does not interpolate such a curve.
pub(crate) fn curve(model: &Model, args: &GeometryArgs) -> Result<Curve, Failure> {
    let trouble = |sentence: String| Err(Failure::Trouble(sentence));
    let Some(to) = &args.to else {
        return trouble(format!("the end point is missing: {} takes {}", model.name, model.curve.describe()));
    };
    let direction = match (args.cw, args.ccw) {
        (true, _) => Some(Direction::Clockwise),
        (_, true) => Some(Direction::CounterClockwise),
        _ => None,
    };
    let origin = |axes: usize| vec![0; axes];
    match model.curve {
        CurveKind::Line { .. } => {
            if direction.is_some() || args.center.is_some() {
                let what = if args.center.is_some() { "--center" } else { "--cw or --ccw" };
                return trouble(format!("{} interpolates lines, which have no {what}: leave it out", model.name));
            }
            let from = args.from.as_ref().map_or_else(|| origin(to.0.len()), |from| from.0.clone());
            Ok(Curve::Line(Line::new(from, to.0.clone())?))
        }
        CurveKind::Arc => {
            let Some(direction) = direction else {
                return trouble(format!("the direction of the arc is missing: give {} --cw or --ccw", model.name));
            };
            let plane = |name: &str, point: &[i64]| match *point {
                [x, y] => Ok([x, y]),
                _ => Err(Failure::Trouble(format!(
                    "{name} of an arc has {} coordinates, but {} works in the plane: give X,Y",
                    point.len(),
                    model.name
                ))),
            };
            let given = |name: &str, point: &Option<_>| match point {
                Some(Point(point)) => plane(name, point),
                None => Ok([0, 0]),
            };
            let (from, center) = (given("--from", &args.from)?, given("--center", &args.center)?);
            Ok(Curve::Arc(Arc::new(from, plane("--to", &to.0)?, center, direction)?))
        }
    }
}
