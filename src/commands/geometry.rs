//! The curve that the options of several commands give.

use crate::models::options::TOLERANCE;
use crate::models::{CurveKind, Model, Options};
use crate::nc::{Arc, Conic, Curve, Direction, Helix, Line};

use crate::Error;
use crate::cli::{GeometryArgs, HardwareArgs, Point};

/// The curve of this kind that the options give, for a model or a command; the radii of an arc may differ by this many
/// BLU beyond what rounding makes.
///
/// # Errors
/// Something is missing, or the model does not interpolate such a curve.
pub(crate) fn curve(who: &str, kind: CurveKind, args: &GeometryArgs, radii: f64) -> Result<Curve, Error> {
    let kind = if kind == CurveKind::Move { move_kind(args) } else { kind };
    let Some(to) = &args.to else {
        return invalid(format!("the end point is missing: {} takes {}", who, kind.describe()));
    };
    for (given, option) in superfluous(kind, args) {
        if given {
            let takes = kind.describe();
            return invalid(format!("{} interpolates {takes}, which have no {option}: leave it out", who));
        }
    }
    let direction = || match (args.cw, args.ccw) {
        (true, _) => Ok(Direction::Clockwise),
        (_, true) => Ok(Direction::CounterClockwise),
        _ => invalid(format!("the direction of the arc is missing: give {} --cw or --ccw", who)),
    };
    let what = match kind {
        CurveKind::Line { .. } | CurveKind::Move => "a line",
        CurveKind::Arc => "an arc",
        CurveKind::Conic => "a conic",
        CurveKind::Helix => "a helix",
    };
    let from = args.from.as_ref();
    let center = || point::<2>(what, "--center", args.center.as_ref());
    Ok(match kind {
        CurveKind::Line { .. } | CurveKind::Move => {
            let from = from.map_or_else(|| vec![0; to.0.len()], |from| from.0.clone());
            Line::new(from, to.0.clone())?.into()
        }
        CurveKind::Arc => {
            let direction = direction()?;
            let (from, to) = (point(what, "--from", from)?, point(what, "--to", Some(to))?);
            Arc::within(from, to, center()?, direction, radii)?.into()
        }
        CurveKind::Helix => {
            let direction = direction()?;
            let (from, to) = (point(what, "--from", from)?, point(what, "--to", Some(to))?);
            Helix::within(from, to, center()?, direction, radii)?.into()
        }
        CurveKind::Conic => {
            let (from, to, center) = (point(what, "--from", from)?, point(what, "--to", Some(to))?, center()?);
            match (args.ellipse, args.parabola, args.hyperbola) {
                (Some(_), ..) if args.opens.is_some() => {
                    return invalid("an ellipse does not open: leave --opens out".to_owned());
                }
                (Some(semi_axes), ..) => Conic::ellipse(semi_axes, from, to, center, direction()?)?,
                (_, Some(c), _) => Conic::parabola(c, args.opens, from, to, center)?,
                (.., Some(semi_axes)) => Conic::hyperbola(semi_axes, args.opens, from, to, center)?,
                (None, None, None) => {
                    let takes = kind.describe();
                    return invalid(format!("the curve is missing: {} takes {takes}", who));
                }
            }
            .into()
        }
    })
}

/// The kind of move that the options give: an arc or a helix where there is a centre or a direction, else a line.
pub(super) fn move_kind(args: &GeometryArgs) -> CurveKind {
    let axes = args.to.as_ref().map_or(2, |to| to.0.len());
    match args.cw || args.ccw || args.center.is_some() {
        false => CurveKind::Line { max_axes: axes },
        true if axes == 3 => CurveKind::Helix,
        true => CurveKind::Arc,
    }
}

/// The options that have no meaning for such curves: whether each is given, and its name.
fn superfluous(kind: CurveKind, args: &GeometryArgs) -> Vec<(bool, &'static str)> {
    let mut options = Vec::new();
    if matches!(kind, CurveKind::Line { .. }) {
        options.extend([(args.center.is_some(), "--center"), (args.cw || args.ccw, "--cw or --ccw")]);
    }
    if kind != CurveKind::Conic {
        options.extend([
            (args.ellipse.is_some(), "--ellipse"),
            (args.parabola.is_some(), "--parabola"),
            (args.hyperbola.is_some(), "--hyperbola"),
            (args.opens.is_some(), "--opens"),
        ]);
    }
    options
}

/// An option that says something of a geometry, if one is given.
pub(super) fn given(args: &GeometryArgs) -> Option<&'static str> {
    let ends = [(args.from.is_some(), "--from"), (args.to.is_some(), "--to")];
    let options = ends.into_iter().chain(superfluous(CurveKind::Line { max_axes: 2 }, args));
    options.into_iter().find(|(given, _)| *given).map(|(_, option)| option)
}

/// The coordinates of a point of `N` axes of such a curve; the origin if none is given.
fn point<const N: usize>(what: &str, name: &str, given: Option<&Point>) -> Result<[i64; N], Error> {
    let Some(Point(point)) = given else { return Ok([0; N]) };
    <[i64; N]>::try_from(point.as_slice()).or_else(|_| {
        let form = if N == 2 { "X,Y" } else { "X,Y,Z" };
        invalid(format!("{name} of {what} has {} coordinates: give {form}", point.len()))
    })
}

/// The choices made for a model and a clock in Hz: the tolerance counts for the radii of an arc alone where the model
/// itself takes none.
pub(crate) fn choices(model: &Model, curve: &Curve, hardware: &HardwareArgs, clock_hz: f64) -> Options {
    let of_radii = matches!(curve, Curve::Arc(_) | Curve::Helix(_));
    let choices = hardware.choices_at(clock_hz);
    if model.takes(&TOLERANCE) || !of_radii { choices } else { choices.without(&TOLERANCE) }
}

/// What is to be reported where the radii of an arc are so different that its centre has moved.
pub(crate) fn moved_center(curve: &Curve, args: &GeometryArgs) -> Option<String> {
    let center = match curve {
        Curve::Arc(arc) => arc.center(),
        Curve::Helix(helix) => helix.arc().center(),
        Curve::Line(_) | Curve::Conic(_) => return None,
    };
    let given: [i64; 2] = point("an arc", "--center", args.center.as_ref()).ok()?;
    (center != given).then(|| {
        let ([x, y], [to_x, to_y]) = (given, center);
        format!(
            "the two radii about ({x}, {y}) differ by more than 1 BLU: both ends stay, and the centre has moved to the whole \
             point ({to_x}, {to_y}), whose arc is nearest\n"
        )
    })
}

/// Refuses what a command was given.
pub(super) fn invalid<T>(sentence: String) -> Result<T, Error> {
    Err(Error::Invalid(sentence))
}
