//! The free curves of a sweep: ranges of their points.

use super::super::geometry::invalid;
use crate::Error;
use crate::cli::{SpaceArgs, parse_decimals};
use crate::models::{CurveKind, Millionths, Model};
use crate::nc::{ControlPoint, Curve, Drawn, GeometryError, NURBS_UNIT, Nurbs};
use crate::study::{Cells, Grid, Range, units, usual_degree};

/// Most points of a curve, each of which has its columns.
const MOST_POINTS: usize = 64;

/// The grid of a model's free curves; `None` of a model that has others.
///
/// # Errors
/// Something is missing, or has no meaning for the model.
pub(super) fn cells(model: &Model, args: &SpaceArgs) -> Result<Option<Cells>, Error> {
    let (kind, who, free) = (model.curve(), model.name, &args.free);
    let takes = kind.describe();
    if !matches!(kind, CurveKind::Spline | CurveKind::Nurbs) {
        return match free.drawn() {
            None => Ok(None),
            Some(drawn) => {
                let option = drawn.option();
                invalid(format!("{who} interpolates {takes}, which have no {option}: leave it out"))
            }
        };
    }
    let superfluous = [
        (args.from.is_some() || args.from_grid.is_some(), "--from or --from-grid"),
        (args.to.is_some() || args.to_grid.is_some(), "--to or --to-grid"),
        (args.radius.is_some(), "--radius"),
        (args.height.is_some(), "--height"),
        (args.center.is_some(), "--center"),
        (args.cw || args.ccw, "--cw or --ccw"),
        (args.opens.is_some(), "--opens"),
        (args.sized().is_some(), "sizes of conics"),
    ];
    if let Some((_, option)) = superfluous.into_iter().find(|(given, _)| *given) {
        return invalid(format!("{who} takes free curves by their points alone: leave {option} out"));
    }
    let Some(given) = free.drawn() else {
        return invalid(format!("the curves are missing: {who} takes {takes}, each number also as a range"));
    };
    let ranges = [&free.bezier, &free.hermite, &free.points].into_iter().flatten().next();
    let ranges = ranges.map(|Grid(ranges)| ranges.clone()).unwrap_or_default();
    let (drawn, sizes) = match (kind, &free.nurbs) {
        (CurveKind::Spline, None) => (given, pairs(given, ranges)?),
        (CurveKind::Nurbs, Some(text)) => (Drawn::Nurbs, nurbs(points(text)?, free.degree, free.knots.as_deref())?),
        (CurveKind::Nurbs, None) if free.bezier.is_some() => {
            let ranges = pairs(given, ranges)?;
            if !(3..=4).contains(&(ranges.len() / 2)) {
                return invalid(format!("--bezier has {} numbers: give X,Y of three or four points", ranges.len()));
            }
            let weighted = ranges.as_chunks::<2>().0.iter().map(|[x, y]| [*x, *y, Range::one(NURBS_UNIT)]);
            (Drawn::Nurbs, nurbs(weighted.collect(), u32::try_from(ranges.len() / 2 - 1).ok(), None)?)
        }
        _ => {
            let option = given.option();
            return invalid(format!("{who} interpolates {takes}, which have no {option}: leave it out"));
        }
    };
    let (from, to, center, directions) = (None, None, [0, 0], Vec::new());
    let cells = Cells { drawn, sizes, from, to, center, directions, radii: Millionths(0) };
    match cells.site(0) {
        // The first may be a single point, which is a row of its own.
        Some((_, Err(error))) if !matches!(error, GeometryError::SplineIsPoint { .. }) => Err(error.into()),
        _ => Ok(Some(cells)),
    }
}

/// Checks that these are two of each point.
fn pairs(drawn: Drawn, ranges: Vec<Range>) -> Result<Vec<Range>, Error> {
    let (option, count) = (drawn.option(), ranges.len());
    if !count.is_multiple_of(2) {
        return invalid(format!("{option} has {count} numbers: give X,Y of each point, each a number or a range"));
    }
    few(count / 2)?;
    Ok(ranges)
}

fn few(points: usize) -> Result<(), Error> {
    if points <= MOST_POINTS {
        return Ok(());
    }
    invalid(format!(
        "curves of a sweep have at most {MOST_POINTS} points, {points} were given: give such a curve to `stepwave run`"
    ))
}

/// x, y and weight of each control point.
fn points(text: &str) -> Result<Vec<[Range; 3]>, Error> {
    let words: Vec<&str> = text.split(',').collect();
    let (triples, rest) = words.as_chunks::<3>();
    if !rest.is_empty() {
        return invalid(format!(
            "--nurbs has {} numbers: give X,Y,W of each point, each a number or a range",
            words.len()
        ));
    }
    few(triples.len())?;
    triples.iter().map(|[x, y, weight]| Ok([x.trim().parse()?, y.trim().parse()?, weights(weight)?])).collect()
}

/// Weights: `1`, `0.707106781` or `0.5..2/0.25`, in steps of 1 where none is given.
fn weights(text: &str) -> Result<Range, Error> {
    let unit = |word: &str| {
        let sentence = "give a number, such as 0.707106781, or 0.5..2/0.25";
        units(word).map_or_else(|| invalid(format!("invalid weight '{text}' of --nurbs: {sentence}")), Ok)
    };
    let (ends, step) = text.split_once('/').unwrap_or((text, "1"));
    let Some((first, last)) = ends.split_once("..") else { return Ok(Range::one(unit(text)?)) };
    let (first, last, step) = (unit(first)?, unit(last)?, unit(step)?);
    if last < first || step <= 0 {
        let sentence = "a range goes up in steps of more than 0: give one such as 0.5..2/0.25";
        return invalid(format!("invalid weight '{text}' of --nurbs: {sentence}"));
    }
    Ok(Range::new(first, last, step.unsigned_abs())?)
}

/// All numbers of a NURBS with these points, as a description has them.
fn nurbs(points: Vec<[Range; 3]>, degree: Option<u32>, knots: Option<&str>) -> Result<Vec<Range>, Error> {
    let degree = degree.map_or(usual_degree(points.len()), |degree| usize::try_from(degree).unwrap_or(usize::MAX));
    let knots = knots.map(|text| parse_decimals(text).map_err(|what| Error::Invalid(format!("--knots: {what}"))));
    // Two points apart from each other, so that what is wrong with the numbers shows whatever the ranges begin with.
    let control =
        |(index, [_, _, weight]): (usize, &[Range; 3])| ControlPoint { at: [index as i64, 0], weight: weight.at(0) };
    let control: Vec<ControlPoint> = points.iter().enumerate().map(control).collect();
    let curve: Curve = Nurbs::new(degree, &control, knots.transpose()?.as_deref())?.into();
    let numbers = curve.description().sizes;
    let (head, rest) = numbers.split_at(2);
    let knots = &rest[3 * points.len()..];
    let one = |numbers: &[i64]| numbers.iter().map(|&number| Range::one(number)).collect::<Vec<_>>();
    Ok([one(head), points.concat(), one(knots)].concat())
}
