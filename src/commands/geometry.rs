//! The curve that the options of several commands give.

use crate::models::options::TOLERANCE;
use crate::models::{CurveKind, Model, Options};
use crate::nc::{Curve, Description, Direction, Drawn, Spline, SplineForm};

use crate::Error;
use crate::cli::{GeometryArgs, HardwareArgs, Point, parse_point};

mod nurbs;

/// The curve of this kind that the options give, for a model or a command; the radii of an arc may differ by this many
/// BLU beyond what rounding makes.
///
/// # Errors
/// Something is missing, or the model does not interpolate such a curve.
pub(crate) fn curve(who: &str, kind: CurveKind, args: &GeometryArgs, radii: f64) -> Result<Curve, Error> {
    let kind = if kind == CurveKind::Move { move_kind(args) } else { kind };
    if let Some(Drawn::Spline(form)) = args.drawn().filter(|drawn| kind.has(*drawn)) {
        return spline(who, kind, form, args);
    }
    if kind == CurveKind::Nurbs && (args.bezier.is_some() || args.nurbs.is_some()) {
        return nurbs::curve(who, args);
    }
    if matches!(kind, CurveKind::Spline | CurveKind::Nurbs) {
        return invalid(format!("the curve is missing: {who} takes {}", kind.describe()));
    }
    for (given, option) in superfluous(kind, args) {
        if given {
            let takes = kind.describe();
            return invalid(format!("{} interpolates {takes}, which have no {option}: leave it out", who));
        }
    }
    let Some(to) = &args.to else {
        return invalid(format!("the end point is missing: {} takes {}", who, kind.describe()));
    };
    let (drawn, sizes) = match (kind.drawn(), args.drawn()) {
        ([one], None) if one.sizes() == 0 => (*one, Vec::new()),
        (_, Some(drawn)) => (drawn, sizes(args)),
        (_, None) => return invalid(format!("the curve is missing: {who} takes {}", kind.describe())),
    };
    let what = drawn.noun();
    if args.opens.is_some() && !drawn.is_open() {
        return invalid(format!("{what} does not open: leave --opens out"));
    }
    if (args.cw || args.ccw) && !drawn.turns() {
        return invalid(format!("{what} has no direction but from its start to its end: leave --cw or --ccw out"));
    }
    let direction = match (args.cw, args.ccw) {
        (true, _) => Direction::Clockwise,
        (false, false) if drawn.turns() => {
            return invalid(format!("the direction of the arc is missing: give {who} --cw or --ccw"));
        }
        _ => Direction::CounterClockwise,
    };
    let ends = |name, end: Option<&Point>| match (drawn, end) {
        (Drawn::Line, Some(Point(end))) => Ok(end.clone()),
        (Drawn::Line, None) => Ok(vec![0; to.0.len()]),
        _ => point(what, name, end, drawn.axes()),
    };
    let (from, to) = (ends("--from", args.from.as_ref())?, ends("--to", Some(to))?);
    let center = plane(what, args)?;
    Ok(Description { drawn, sizes, from, to, center, direction, radii }.curve()?)
}

/// The sizes of a conic.
fn sizes(args: &GeometryArgs) -> Vec<i64> {
    let semi_axes = args.ellipse.or(args.hyperbola).map(|semi_axes| semi_axes.to_vec());
    semi_axes.or(args.parabola.map(|c| vec![c])).unwrap_or_default()
}

/// The free curve that the options give.
fn spline(who: &str, kind: CurveKind, form: SplineForm, args: &GeometryArgs) -> Result<Curve, Error> {
    by_points_alone(who, args, superfluous(kind, args))?;
    let option = Drawn::Spline(form).option();
    let read = |text: &String| points(text);
    let given = [&args.bezier, &args.hermite].into_iter().flatten().map(|Point(numbers)| Ok(numbers.clone()));
    let numbers = given.chain(args.points.iter().map(read)).next().unwrap_or_else(|| Ok(Vec::new()))?;
    let (points, rest) = numbers.as_chunks();
    if !rest.is_empty() {
        return invalid(format!("{option} has {} numbers: give X,Y of each point", numbers.len()));
    }
    Ok(Spline::new(form, points)?.into())
}

/// Refuses the ends of a free curve, and what else has no meaning for it.
fn by_points_alone(who: &str, args: &GeometryArgs, others: Vec<(bool, &'static str)>) -> Result<(), Error> {
    let ends = [(args.from.is_some(), "--from"), (args.to.is_some(), "--to")];
    match others.into_iter().chain(ends).find(|(given, _)| *given) {
        Some((_, option)) => invalid(format!("{who} takes a free curve by its points alone: leave {option} out")),
        None => Ok(()),
    }
}

/// The points X,Y,… themselves, or those of a CSV file of this name: x,y in each line, below a heading if there is one.
fn points(given: &str) -> Result<Vec<i64>, Error> {
    if let Ok(Point(numbers)) = parse_point(given) {
        return Ok(numbers);
    }
    let text = std::fs::read_to_string(given)
        .map_err(|error| Error::Invalid(format!("--points {given} cannot be read: {error}; give a CSV file of x,y")))?;
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let mut numbers = Vec::new();
    for (index, line) in lines {
        match parse_point(line.trim()) {
            Ok(Point(point)) if point.len() == 2 => numbers.extend(point),
            // A heading.
            _ if numbers.is_empty() && line.trim().replace(' ', "").eq_ignore_ascii_case("x,y") => {}
            Ok(_) => return invalid(format!("{given}, line {}: '{line}' is not one point: give x,y", index + 1)),
            Err(what) => return invalid(format!("{given}, line {}: {what}", index + 1)),
        }
    }
    Ok(numbers)
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
    let none = |has: fn(Drawn) -> bool| !kind.drawn().iter().copied().any(has);
    let mut options = vec![
        (args.center.is_some() && none(Drawn::is_centered), "--center"),
        ((args.cw || args.ccw) && none(Drawn::turns), "--cw or --ccw"),
        (args.opens.is_some() && none(Drawn::is_open), "--opens"),
    ];
    if let Some(drawn) = args.drawn() {
        options.push((!kind.has(drawn), drawn.option()));
    }
    options
}

/// An option that says something of a geometry, if one is given.
pub(super) fn given(args: &GeometryArgs) -> Option<&'static str> {
    let ends = [(args.from.is_some(), "--from"), (args.to.is_some(), "--to")];
    let options = ends.into_iter().chain(superfluous(CurveKind::Line { max_axes: 2 }, args));
    options.into_iter().find(|(given, _)| *given).map(|(_, option)| option)
}

/// The coordinates of a point of this many axes of such a curve; the origin if none is given.
fn point(what: &str, name: &str, given: Option<&Point>, axes: usize) -> Result<Vec<i64>, Error> {
    let Some(Point(point)) = given else { return Ok(vec![0; axes]) };
    if point.len() == axes {
        return Ok(point.clone());
    }
    let form = if axes == 2 { "X,Y" } else { "X,Y,Z" };
    invalid(format!("{name} of {what} has {} coordinates: give {form}", point.len()))
}

/// The centre that is given, or the origin.
fn plane(what: &str, args: &GeometryArgs) -> Result<[i64; 2], Error> {
    point(what, "--center", args.center.as_ref(), 2).map(|center| [0, 1].map(|axis| center[axis]))
}

/// The choices made for a model and a clock in Hz: the tolerance counts for the radii of an arc alone where the model
/// itself takes none.
pub(crate) fn choices(model: &Model, curve: &Curve, hardware: &HardwareArgs, clock_hz: f64) -> Options {
    let of_radii = curve.arc().is_some();
    let choices = hardware.choices_at(clock_hz);
    if model.takes(&TOLERANCE) || !of_radii { choices } else { choices.without(&TOLERANCE) }
}

/// What is to be reported where the radii of an arc are so different that its centre has moved.
pub(crate) fn moved_center(curve: &Curve, args: &GeometryArgs) -> Option<String> {
    let center = curve.arc()?.center();
    let given = plane("an arc", args).ok()?;
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
