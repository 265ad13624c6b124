//! Free curves in a sweep: they have no ends but their points, so each coordinate of each point has a column of its own.

use stepwave_models::CurveKind;
use stepwave_nc::{ControlPoint, Curve, Description, Direction, Drawn, NURBS_MOST, NURBS_UNIT, Nurbs, SplineForm};

use super::Range;
use super::points::whole;
use super::space::Geometry;
use super::table::{Column, ColumnType, Value};

/// Numbers of a NURBS before its points: its degree, and how many points it has.
const HEAD: usize = 2;

/// Every free curve with its word in the column `curve`, and the option of `stepwave run` that takes its points.
const WORDS: [(Drawn, &str, &str); 5] = [
    (Drawn::Spline(SplineForm::Bezier), "bezier", "bezier"),
    (Drawn::Spline(SplineForm::Hermite), "hermite", "hermite"),
    (Drawn::Spline(SplineForm::CatmullRom), "catmull-rom", "points"),
    (Drawn::Spline(SplineForm::BSpline), "b-spline", "points"),
    (Drawn::Nurbs, "nurbs", "nurbs"),
];

/// Its word in the column `curve`.
pub(super) fn word(drawn: Drawn) -> &'static str {
    WORDS.iter().find(|(known, ..)| *known == drawn).map_or("", |(_, word, _)| word)
}

/// The numbers of its points, and how many each has: x, y, and of a NURBS the weight.
fn points(drawn: Drawn, numbers: &[i64]) -> impl Iterator<Item = &[i64]> {
    let (size, own) = match drawn {
        Drawn::Nurbs => (3, numbers.get(HEAD..HEAD + 3 * count(drawn, numbers)).unwrap_or_default()),
        _ => (2, numbers),
    };
    own.chunks_exact(size)
}

/// How many points give it; none of other curves.
pub(super) fn count(drawn: Drawn, numbers: &[i64]) -> usize {
    match drawn {
        Drawn::Nurbs => numbers.get(1).and_then(|&count| usize::try_from(count).ok()).unwrap_or(0),
        Drawn::Spline(_) => numbers.len() / 2,
        _ => 0,
    }
}

/// The curve of these numbers, and its ends; of a single point, of which there can be none, this point.
pub(super) fn site(drawn: Drawn, sizes: Vec<i64>) -> (Description, Geometry) {
    let direction = Direction::CounterClockwise;
    let (from, to) = (Vec::new(), Vec::new());
    let mut site = Description { drawn, sizes, from, to, center: [0, 0], direction, radii: 0.0 };
    let geometry = site.curve();
    let first = || points(drawn, &site.sizes).next().map_or_else(|| vec![0; 2], |point| point[..2].to_vec());
    (site.from, site.to) = match &geometry {
        Ok(curve) => (curve.from().to_vec(), curve.to().to_vec()),
        Err(_) => (first(), first()),
    };
    (site, geometry)
}

/// The first point of which a coordinate varies, and its ranges.
pub(super) fn map(drawn: Drawn, sizes: &[Range]) -> Option<(String, [Range; 2])> {
    let (head, size) = if drawn == Drawn::Nurbs { (HEAD, 3) } else { (0, 2) };
    let place = sizes.get(head..)?.iter().position(|range| range.count() > 1)? / size;
    let first = head + place * size;
    Some((format!("p{place}"), [*sizes.get(first)?, *sizes.get(first + 1)?]))
}

/// Columns of curves of this many points or fewer.
pub(super) fn columns(drawn: Drawn, points: usize, mut add: impl FnMut(&str, ColumnType)) {
    add("curve", ColumnType::Word);
    for point in 0..points {
        add(&format!("p{point}_x"), ColumnType::Whole);
        add(&format!("p{point}_y"), ColumnType::Whole);
        if drawn == Drawn::Nurbs {
            add(&format!("p{point}_w"), ColumnType::Word);
        }
    }
    if drawn == Drawn::Nurbs {
        add("degree", ColumnType::Whole);
        add("knots", ColumnType::Word);
    }
}

/// A number of units of weights and knots, as it was given.
fn decimal(units: i64) -> String {
    let (sign, units) = (if units < 0 { "-" } else { "" }, units.unsigned_abs());
    let unit = NURBS_UNIT.unsigned_abs();
    let digits = format!("{sign}{}.{:09}", units / unit, units % unit);
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The values of these columns.
pub(super) fn values(site: &Description, most: usize) -> Vec<Value> {
    let mut values = vec![Value::Word(word(site.drawn).to_owned())];
    let nurbs = site.drawn == Drawn::Nurbs;
    for point in points(site.drawn, &site.sizes) {
        values.extend(point[..2].iter().map(|&coordinate| Value::Whole(coordinate)));
        values.extend(point.get(2).map(|&weight| Value::Word(decimal(weight))));
    }
    let size = if nurbs { 3 } else { 2 };
    values.resize(1 + most * size, Value::None);
    if nurbs {
        let knots = site.sizes.get(HEAD + 3 * count(site.drawn, &site.sizes)..).unwrap_or_default();
        values.push(site.sizes.first().map_or(Value::None, |&degree| Value::Whole(degree)));
        values.push(Value::Word(knots.iter().map(|&knot| decimal(knot)).collect::<Vec<_>>().join(",")));
    }
    values
}

/// The options of `stepwave run` that give the curve of a row with these values.
pub(super) fn options(columns: &[Column], value: impl Fn(&str) -> Option<String>) -> Option<Vec<(String, String)>> {
    let word = value("curve")?;
    let (drawn, _, option) = WORDS.iter().find(|(_, known, _)| *known == word)?;
    let of_points = |column: &&Column| column.name.starts_with('p') && column.name[1..].starts_with(char::is_numeric);
    let numbers = columns.iter().filter(of_points).filter_map(|column| value(&column.name));
    let mut options = vec![((*option).to_owned(), numbers.collect::<Vec<_>>().join(","))];
    if *drawn == Drawn::Spline(SplineForm::BSpline) {
        options.push(("b-spline".to_owned(), String::new()));
    }
    options.extend(["degree", "knots"].into_iter().filter_map(|name| Some((name.to_owned(), value(name)?))));
    Some(options)
}

/// Columns that such curves of this many points may have in a file.
pub(super) fn known(kind: CurveKind, points: usize) -> Vec<String> {
    let mut names = Vec::new();
    columns(if kind == CurveKind::Nurbs { Drawn::Nurbs } else { kind.drawn()[0] }, points, |name, _| {
        names.push(name.to_owned());
    });
    names
}

/// The curve of a line of a file, by the words in its columns; the columns of the last points may be empty.
pub(super) fn of_words<'a>(
    kind: CurveKind,
    most: usize,
    word: impl Fn(&str) -> Option<&'a str>,
) -> Result<Description, String> {
    let drawn = match word("curve") {
        None if kind == CurveKind::Nurbs => Drawn::Nurbs,
        name => {
            let of_kind = || WORDS.iter().filter(|(drawn, ..)| kind.has(*drawn));
            let named = of_kind().find(|(_, known, _)| Some(*known) == name).map(|(drawn, ..)| *drawn);
            let names = || of_kind().map(|(_, known, _)| *known).collect::<Vec<_>>().join(", ");
            named.ok_or_else(|| format!("curve is none of {}", names()))?
        }
    };
    let coordinate = |name: String| word(&name).map_or(Ok(0), |text| whole(&name, text));
    let given = |point: &usize| ["x", "y"].iter().any(|axis| word(&format!("p{point}_{axis}")).is_some());
    let count = (0..most).rev().find(given).map_or(0, |last| last + 1);
    let points = (0..count).map(|point| Ok([coordinate(format!("p{point}_x"))?, coordinate(format!("p{point}_y"))?]));
    let points: Vec<[i64; 2]> = points.collect::<Result<_, String>>()?;
    if drawn != Drawn::Nurbs {
        return Ok(site(drawn, points.concat()).0);
    }
    let decimal =
        |name: &str, text: &str| units(text).ok_or_else(|| format!("expected a number for {name}, not '{text}'"));
    let weight = |name: String| word(&name).map_or(Ok(NURBS_UNIT), |text| decimal(&name, text));
    let control =
        points.iter().enumerate().map(|(point, &at)| Ok(ControlPoint { at, weight: weight(format!("p{point}_w"))? }));
    let control: Vec<ControlPoint> = control.collect::<Result<_, String>>()?;
    let degree = match word("degree") {
        None => usual_degree(control.len()),
        Some(text) => text.parse().map_err(|_| format!("expected a whole number for degree, not '{text}'"))?,
    };
    let knots =
        word("knots").map(|text| text.split(',').map(|knot| decimal("knots", knot)).collect::<Result<Vec<_>, _>>());
    let curve = Nurbs::new(degree, &control, knots.transpose()?.as_deref()).map_err(|error| error.to_string())?;
    Ok(Into::<Curve>::into(curve).description())
}

/// The degree of a NURBS of this many points where none is given.
pub(crate) fn usual_degree(points: usize) -> usize {
    points.saturating_sub(1).min(3)
}

/// A decimal number in units of weights and knots, if it is one.
pub(crate) fn units(text: &str) -> Option<i64> {
    let value: f64 = text.trim().parse().ok().filter(|value: &f64| value.abs() <= NURBS_MOST as f64)?;
    // Below 2^53.
    #[allow(clippy::cast_possible_truncation)]
    Some((value * NURBS_UNIT as f64).round() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_written_as_they_were_given() {
        for (units, text) in [(707_106_781, "0.707106781"), (-1_500_000_000, "-1.5"), (0, "0"), (20_000_000_000, "20")]
        {
            assert_eq!(decimal(units), text);
        }
    }
}
