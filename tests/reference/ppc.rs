//! Point-by-point comparison: the sign of a deviation F chooses the axis of every step.

use super::arc_geometry::{ArcKind, Sector, natural_extreme, radius_squared, sectors};
use super::{EndPoint, Form, Table, counter_columns, per_axis_columns};

/// The step table of a straight line, in BLU.
///
/// F = 0 at the start. `F >= 0` lies on or above the line and steps X, `F < 0` steps Y (magnitude
/// form). In the signed form F has the opposite sign in quadrants 2 and 4, so the tie `F = 0` steps
/// Y there. A line along an axis steps that axis only.
///
/// The columns are `xe`, `ye`, `f`, then `e` or `ex`, `ey`, then `dx`, `dy`, `x`, `y`.
///
/// `Longest` counts the longer axis; of two equal ones it counts the axis that loses ties, for that
/// one makes the last step.
///
/// Source: the method of point-by-point comparison, straight line, all quadrants.
///
/// # Panics
/// With [`EndPoint::Iterations`], which the method does not have.
pub(crate) fn ppc_line(from: [i64; 2], to: [i64; 2], form: Form, end: EndPoint) -> Table {
    let d = [to[0] - from[0], to[1] - from[1]];
    let sign = [d[0].signum(), d[1].signum()];
    let [a, b] = [d[0].abs(), d[1].abs()];

    // What one X step and one Y step add to F, and whether F < 0 is the X side.
    let (registers, gain, x_when_negative) = match form {
        Form::Magnitude => ([a, b], [-b, a], false),
        // F = dx·y - dy·x: an X step changes x by sign[0], a Y step changes y by sign[1].
        Form::Signed => (d, [-d[1] * sign[0], d[0] * sign[1]], sign[0] != sign[1]),
    };
    let ties_step_y = x_when_negative;
    let longest = usize::from(if ties_step_y { b > a } else { b >= a });
    let mut left = match end {
        EndPoint::Total => vec![a + b],
        EndPoint::PerAxis => vec![a, b],
        EndPoint::Longest => vec![d[longest].abs()],
        EndPoint::Iterations => panic!("point-by-point comparison counts steps, not iterations"),
    };

    let mut columns = vec!["xe".to_owned(), "ye".to_owned(), "f".to_owned()];
    columns.extend(counter_columns(end, 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut table = Table::new(columns);

    let mut f = 0;
    let mut position = from;
    table.push(&[&registers, &[f], &left, &[0, 0], &position]);
    while left.iter().any(|&count| count > 0) {
        // Judge.
        let steps_x = if a == 0 {
            false
        } else if b == 0 {
            true
        } else if end == EndPoint::PerAxis && left[0] == 0 {
            false
        } else if end == EndPoint::PerAxis && left[1] == 0 {
            true
        } else {
            (f < 0) == x_when_negative
        };
        let axis = if steps_x { 0 } else { 1 };
        // Feed.
        let mut pulse = [0, 0];
        pulse[axis] = sign[axis];
        position[axis] += sign[axis];
        // Compute.
        f += gain[axis];
        // Compare.
        match end {
            EndPoint::PerAxis => left[axis] -= 1,
            EndPoint::Longest => left[0] -= i64::from(axis == longest),
            EndPoint::Total | EndPoint::Iterations => left[0] -= 1,
        }
        table.push(&[&registers, &[f], &left, &pulse, &position]);
    }
    table.finished = true;
    table
}

/// The step table of a circular arc, in BLU; R² is that of the start point, and an end point equal
/// to the start point is a full circle.
///
/// F = x² + y² - R² relative to the centre, 0 at the start. `F >= 0` (on or outside) steps the
/// coordinate whose magnitude shrinks, `F < 0` the one whose magnitude grows; F follows by
/// (c ± 1)² - c² = ±2c + 1, with c the magnitude before the step.
///
/// The columns are `f`, `xi`, `yi` (magnitudes relative to the centre), `quad` (0 ..= 3, the
/// quadrant by whose kind the step was judged; in row 0 the one that the motion enters), then `e`
/// or `ex`, `ey`, then `dx`, `dy`, `x`, `y`.
///
/// - `Total` turns to the next quadrant when the shrinking magnitude is found to be 0 at the judge
///   of a step; in the centre itself, which only R = 1 passes, it holds the quadrant.
/// - `PerAxis` splits the arc at the axes where the path of the method meets them, and steps the
///   other axis when the wanted one has no pulses left. The row that finishes a sector shows
///   `ex = ey = 0`; the next row is the first step of the next sector.
///
/// Source: the method of point-by-point comparison, circular arc, kinds SR1–SR4 and NR1–NR4.
///
/// # Panics
/// With [`EndPoint::Longest`] (the longer axis of an arc can run out before the arc does) and
/// [`EndPoint::Iterations`]; with R = 0; with an end point that the last sector cannot reach.
pub(crate) fn ppc_arc(from: [i64; 2], to: [i64; 2], center: [i64; 2], clockwise: bool, end: EndPoint) -> Table {
    let start = [from[0] - center[0], from[1] - center[1]];
    let target = [to[0] - center[0], to[1] - center[1]];
    let extreme = natural_extreme(radius_squared(start));
    let list = sectors(start, target, clockwise, [extreme; 2]);

    let mut columns: Vec<String> = ["f", "xi", "yi", "quad"].map(str::to_owned).into();
    columns.extend(counter_columns(end, 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut arc = Arc { center, point: start, f: 0, table: Table::new(columns) };
    match end {
        EndPoint::Total => arc.run_total(list[0].kind, &list),
        EndPoint::PerAxis => arc.run_per_axis(&list, radius_squared(start)),
        EndPoint::Longest => panic!("the longest axis does not tell the end of an arc"),
        EndPoint::Iterations => panic!("point-by-point comparison counts steps, not iterations"),
    }
    arc.table.finished = true;
    arc.table
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
    /// One counter of all steps; the path itself finds the next quadrant.
    fn run_total(&mut self, first: ArcKind, list: &[Sector]) {
        let mut kind = first;
        let mut e: i64 = list.iter().flat_map(Sector::distance).sum();
        self.record(kind, &[e], [0, 0]);
        while e > 0 {
            let at_axis = self.point[kind.shrinking()] == 0;
            let at_centre = self.point == [0, 0];
            if at_axis && !at_centre {
                kind = kind.next();
            }
            let pulse = self.step(kind, self.wanted(kind));
            e -= 1;
            self.record(kind, &[e], pulse);
        }
    }

    /// One counter per axis and sector; the loader knows the next quadrant.
    fn run_per_axis(&mut self, list: &[Sector], r2: i64) {
        self.record(list[0].kind, &list[0].distance(), [0, 0]);
        for sector in list {
            let mut left = sector.distance();
            self.point = sector.from;
            self.f = radius_squared(sector.from) - r2;
            while left != [0, 0] {
                let wanted = self.wanted(sector.kind);
                let axis = if left[wanted] > 0 { wanted } else { 1 - wanted };
                let pulse = self.step(sector.kind, axis);
                left[axis] -= 1;
                self.record(sector.kind, &left, pulse);
            }
        }
    }

    /// The axis that the sign of F asks for.
    fn wanted(&self, kind: ArcKind) -> usize {
        if self.f >= 0 { kind.shrinking() } else { kind.growing() }
    }

    /// One step of one axis; returns the pulses.
    fn step(&mut self, kind: ArcKind, axis: usize) -> [i64; 2] {
        let magnitude = self.point[axis].abs();
        if axis == kind.shrinking() {
            self.f -= 2 * magnitude - 1;
        } else {
            self.f += 2 * magnitude + 1;
        }
        let mut pulse = [0, 0];
        pulse[axis] = kind.travel()[axis];
        self.point[axis] += pulse[axis];
        pulse
    }

    /// Writes a row.
    fn record(&mut self, kind: ArcKind, left: &[i64], pulse: [i64; 2]) {
        let [x, y] = self.point;
        let position = [self.center[0] + x, self.center[1] + y];
        self.table.push(&[&[self.f, x.abs(), y.abs(), kind.quadrant], left, &pulse, &position]);
    }
}
