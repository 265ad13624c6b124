//! Circular arcs of the eight-direction methods: a step may move both axes.

use super::arc_geometry::{ArcKind, Sector, natural_extreme, nearest_radius, radius_squared, sectors};
use super::{EndPoint, Table, counter_columns, per_axis_columns};

/// The step table of a circular arc by minimum deviation, in BLU; R² is that of the start point, and
/// an end point equal to the start point is a full circle.
///
/// F = x² + y² - R² relative to the centre. Of the three steps X, Y and XY of the quadrant the one
/// with the smallest |F| after it is taken; of equal ones XY first, then Y, which never happens.
///
/// The columns are `f`, `xi`, `yi` (magnitudes relative to the centre), `quad` (0 ..= 3, the
/// quadrant by whose kind the step was judged; in row 0 the one that the motion enters), then `e`
/// or `ex`, `ey`, then `dx`, `dy`, `x`, `y`.
///
/// The path crosses the axes at R rounded to the nearest integer.
///
/// - `Total` counts the pulses of both axes, a diagonal step is two; it turns to the next quadrant
///   when the shrinking magnitude is found to be 0 at the judge of a step and the other is not.
/// - `PerAxis` splits the arc at the axes and loads F anew; when one axis has no pulses left the
///   other steps alone. The row that finishes a sector shows `ex = ey = 0`; the next row is the
///   first step of the next sector.
///
/// Source: the method of minimum deviation, circular arc.
///
/// # Panics
/// With [`EndPoint::Longest`] and [`EndPoint::Iterations`]; with R = 0; with an end point that the
/// last sector cannot reach.
pub(crate) fn mindev_arc(from: [i64; 2], to: [i64; 2], center: [i64; 2], clockwise: bool, end: EndPoint) -> Table {
    run(from, to, center, clockwise, end, nearest_radius, smallest_deviation)
}

/// The step table of a circular arc by vector discrimination, in BLU; arguments, columns and end
/// points as for [`mindev_arc`].
///
/// F = x² + y² - R². The octant fixes an axis vector, X where |x| < |y| or where |x| = |y| shrinks,
/// else Y, and a diagonal vector, XY. `F >= 0` takes the one of the two that leads farther inward,
/// `F < 0` the other. The path crosses the axes where point-by-point comparison does.
///
/// This is the project's own definition of the method.
///
/// # Panics
/// As [`mindev_arc`].
pub(crate) fn vector_arc(from: [i64; 2], to: [i64; 2], center: [i64; 2], clockwise: bool, end: EndPoint) -> Table {
    run(from, to, center, clockwise, end, natural_extreme, inward_or_outward)
}

/// Which axes step: the judge of a method.
type Judge = fn(&Arc, ArcKind) -> [bool; 2];

/// An arc by either method; `crossing` gives from R² where the axes are met.
fn run(
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    clockwise: bool,
    end: EndPoint,
    crossing: fn(i64) -> i64,
    judge: Judge,
) -> Table {
    let start = [from[0] - center[0], from[1] - center[1]];
    let target = [to[0] - center[0], to[1] - center[1]];
    let r2 = radius_squared(start);
    let list = sectors(start, target, clockwise, [crossing(r2); 2]);

    let mut columns: Vec<String> = ["f", "xi", "yi", "quad"].map(str::to_owned).into();
    columns.extend(counter_columns(end, 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut arc = Arc { center, point: start, f: 0, table: Table::new(columns) };
    match end {
        EndPoint::Total => arc.run_total(&list, judge),
        EndPoint::PerAxis => arc.run_per_axis(&list, r2, judge),
        EndPoint::Longest | EndPoint::Iterations => panic!("{end:?} does not tell the end of an arc"),
    }
    arc.table.finished = true;
    arc.table
}

/// Of X, Y and XY the step that leaves the smallest |F|.
fn smallest_deviation(arc: &Arc, kind: ArcKind) -> [bool; 2] {
    let mut best = [true, true];
    for candidate in [[false, true], [true, false]] {
        if arc.deviation_after(kind, candidate).abs() < arc.deviation_after(kind, best).abs() {
            best = candidate;
        }
    }
    best
}

/// The axis vector of the octant or the diagonal.
fn inward_or_outward(arc: &Arc, kind: ArcKind) -> [bool; 2] {
    let [x, y] = arc.point.map(i64::abs);
    let x_shrinks = kind.shrinking() == 0;
    let axis = if x < y || (x == y && x_shrinks) { 0 } else { 1 };
    // A step that moves the shrinking coordinate alone leads inward, and the growing one outward.
    let axis_is_inner = axis == kind.shrinking();
    if (arc.f >= 0) == axis_is_inner { [axis == 0, axis == 1] } else { [true, true] }
}

/// An arc in progress.
struct Arc {
    /// The centre in machine coordinates.
    center: [i64; 2],
    /// The present point relative to the centre.
    point: [i64; 2],
    /// The deviation.
    f: i64,
    /// The rows so far.
    table: Table,
}

impl Arc {
    /// One counter of all pulses; the path itself finds the next quadrant.
    fn run_total(&mut self, list: &[Sector], judge: Judge) {
        let mut kind = list[0].kind;
        let mut e: i64 = list.iter().flat_map(Sector::distance).sum();
        self.record(kind, &[e], [0, 0]);
        while e > 0 {
            if self.point[kind.shrinking()] == 0 && self.point[kind.growing()] != 0 {
                kind = kind.next();
            }
            let pulse = self.step(kind, judge(self, kind));
            e = (e - pulse[0].abs() - pulse[1].abs()).max(0);
            self.record(kind, &[e], pulse);
        }
    }

    /// One counter per axis and sector; the loader knows the next quadrant.
    fn run_per_axis(&mut self, list: &[Sector], r2: i64, judge: Judge) {
        self.record(list[0].kind, &list[0].distance(), [0, 0]);
        for sector in list {
            let mut left = sector.distance();
            self.point = sector.from;
            self.f = radius_squared(sector.from) - r2;
            while left != [0, 0] {
                let steps = match left {
                    [0, _] => [false, true],
                    [_, 0] => [true, false],
                    _ => judge(self, sector.kind),
                };
                let pulse = self.step(sector.kind, steps);
                left[0] -= pulse[0].abs();
                left[1] -= pulse[1].abs();
                self.record(sector.kind, &left, pulse);
            }
        }
    }

    /// F after a step of these axes: each adds 2|c| + 1 where its magnitude grows, -2|c| + 1 where
    /// it shrinks.
    fn deviation_after(&self, kind: ArcKind, steps: [bool; 2]) -> i64 {
        let mut f = self.f;
        for axis in (0..2).filter(|&axis| steps[axis]) {
            let magnitude = self.point[axis].abs();
            f += if axis == kind.growing() { 2 * magnitude } else { -2 * magnitude } + 1;
        }
        f
    }

    /// One step; returns the pulses.
    fn step(&mut self, kind: ArcKind, steps: [bool; 2]) -> [i64; 2] {
        self.f = self.deviation_after(kind, steps);
        let mut pulse = [0, 0];
        for axis in (0..2).filter(|&axis| steps[axis]) {
            pulse[axis] = kind.travel()[axis];
            self.point[axis] += pulse[axis];
        }
        pulse
    }

    /// Writes a row.
    fn record(&mut self, kind: ArcKind, left: &[i64], pulse: [i64; 2]) {
        let [x, y] = self.point;
        let position = [self.center[0] + x, self.center[1] + y];
        self.table.push(&[&[self.f, x.abs(), y.abs(), kind.quadrant], left, &pulse, &position]);
    }
}
