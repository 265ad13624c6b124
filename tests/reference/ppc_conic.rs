//! Point-by-point comparison along ellipses, parabolas and hyperbolas.

use super::conic_geometry::{Curve, Shape, pieces};
use super::{EndPoint, Table, counter_columns, per_axis_columns};

/// The step table of a conic, in BLU.
///
/// F is the implicit function G itself, also where a piece starts. `F >= 0` steps the axis whose
/// step lowers G (on an ellipse the one whose magnitude shrinks), `F < 0` the other. F follows by
/// w·((c ± 1)² - c²) where G is a square in c, by ±w where it is linear.
///
/// The columns are `f`, `gx`, `gy` (|∂G/∂x|, |∂G/∂y| at the present point), then `e` or `ex`, `ey`,
/// then `dx`, `dy`, `x`, `y`.
///
/// The curve is split at the axes. Each piece loads F, the slopes and the end counters; the row that
/// finishes a piece shows the old registers, the next row is the first step of the next piece.
///
/// - `Total`: `e` counts the pulses of both axes in the piece.
/// - `PerAxis`: an axis without pulses left hands its step to the other.
///
/// Source: the method of point-by-point comparison, curves of second order.
///
/// # Panics
/// With [`EndPoint::Longest`] and [`EndPoint::Iterations`]; with an end point that cannot be reached.
pub(crate) fn ppc_conic(
    shape: Shape,
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    clockwise: bool,
    end: EndPoint,
) -> Table {
    assert!(matches!(end, EndPoint::Total | EndPoint::PerAxis), "{end:?} does not tell the end of a conic");
    let curve = Curve::of(shape);
    let local = |[x, y]: [i64; 2]| [x - center[0], y - center[1]];
    let list = pieces(shape, local(from), local(to), clockwise);

    let mut columns: Vec<String> = ["f", "gx", "gy"].map(str::to_owned).into();
    columns.extend(counter_columns(end, 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut table = Table::new(columns);

    let mut position = from;
    for (index, piece) in list.iter().enumerate() {
        // Load.
        let mut point = piece.from;
        let mut f = curve.value(point);
        let slopes = |point: [i64; 2]| [curve.slope(0, point[0]), curve.slope(1, point[1])];
        let [nx, ny] = piece.distance();
        let mut left = if end == EndPoint::Total { vec![nx + ny] } else { vec![nx, ny] };
        if index == 0 {
            table.push(&[&[f], &slopes(point), &left, &[0, 0], &position]);
        }
        let lowering = usize::from(curve.raises(0, piece));
        while left.iter().any(|&count| count > 0) {
            // Judge.
            let wanted = if f >= 0 { lowering } else { 1 - lowering };
            let exhausted = end == EndPoint::PerAxis && left[wanted] == 0;
            let axis = if exhausted { 1 - wanted } else { wanted };
            // Compute, with the magnitude before the step.
            let change =
                curve.slope(axis, point[axis]) + curve.weight_gain(axis) / curve.scale * growth(piece.grows(axis));
            f += if axis == lowering { -change } else { change };
            // Feed.
            let mut pulse = [0, 0];
            pulse[axis] = piece.travel[axis];
            point[axis] += pulse[axis];
            position[axis] += pulse[axis];
            // Compare.
            left[if end == EndPoint::Total { 0 } else { axis }] -= 1;
            table.push(&[&[f], &slopes(point), &left, &pulse, &position]);
        }
    }
    table.finished = true;
    table
}

/// +1 when the magnitude grows, -1 when it shrinks.
fn growth(grows: bool) -> i64 {
    if grows { 1 } else { -1 }
}
