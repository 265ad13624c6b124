//! The NURBS that the options give.

use super::{by_points_alone, invalid, superfluous};
use crate::Error;
use crate::cli::{GeometryArgs, Point, parse_decimals};
use crate::models::CurveKind;
use crate::nc::{ControlPoint, Curve, NURBS_UNIT, Nurbs};
use crate::study::usual_degree;

/// The curve of `--nurbs`, or the one span that `--bezier` makes.
pub(super) fn curve(who: &str, args: &GeometryArgs) -> Result<Curve, Error> {
    let others = superfluous(CurveKind::Nurbs, args).into_iter().filter(|(_, option)| *option != "--bezier");
    by_points_alone(who, args, others.collect())?;
    if let Some(Point(numbers)) = &args.bezier {
        return match numbers.as_chunks() {
            (points @ [_, _, _] | points @ [_, _, _, _], []) => Ok(Nurbs::bezier(points)?.into()),
            _ => invalid(format!("--bezier has {} numbers: give X,Y of three or four points", numbers.len())),
        };
    }
    let given = args.nurbs.as_deref().unwrap_or_default();
    let numbers = numbers(given)?;
    let (triples, rest) = numbers.as_chunks::<3>();
    if !rest.is_empty() {
        return invalid(format!("--nurbs has {} numbers: give X,Y,W of each point", numbers.len()));
    }
    let mut points = Vec::with_capacity(triples.len());
    for &[x, y, weight] in triples {
        if let Some(odd) = [x, y].into_iter().find(|c| c % NURBS_UNIT != 0) {
            let odd = odd as f64 / NURBS_UNIT as f64;
            return invalid(format!("the coordinate {odd} of --nurbs is not whole: give whole numbers of BLU"));
        }
        points.push(ControlPoint { at: [x, y].map(|c| c / NURBS_UNIT), weight });
    }
    let degree = args.degree.map_or(usual_degree(points.len()), |degree| usize::try_from(degree).unwrap_or(usize::MAX));
    let knots = args
        .knots
        .as_deref()
        .map(|text| parse_decimals(text).map_err(|what| Error::Invalid(format!("--knots: {what}"))));
    Ok(Nurbs::new(degree, &points, knots.transpose()?.as_deref())?.into())
}

/// The numbers themselves, or those of a CSV file of this name: x,y,w in each line, below a heading if there is one.
fn numbers(given: &str) -> Result<Vec<i64>, Error> {
    if let Ok(numbers) = parse_decimals(given) {
        return Ok(numbers);
    }
    let text = std::fs::read_to_string(given).map_err(|error| {
        Error::Invalid(format!("--nurbs {given} cannot be read: {error}; give a CSV file of x,y,w"))
    })?;
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let mut numbers = Vec::new();
    for (index, line) in lines {
        match parse_decimals(line.trim()) {
            Ok(point) if point.len() == 3 => numbers.extend(point),
            // A heading.
            _ if numbers.is_empty() && line.trim().replace(' ', "").eq_ignore_ascii_case("x,y,w") => {}
            Ok(_) => return invalid(format!("{given}, line {}: '{line}' is not one point: give x,y,w", index + 1)),
            Err(what) => return invalid(format!("{given}, line {}: {what}", index + 1)),
        }
    }
    Ok(numbers)
}
