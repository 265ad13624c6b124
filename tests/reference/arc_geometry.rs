//! Quadrants, kinds and sectors of an arc about the origin.
//!
//! Quadrants are numbered 0 ..= 3 for Q1 ..= Q4, counter-clockwise from the positive X axis. Axes
//! are 0 for X and 1 for Y.

/// An arc kind SRi / NRi: a quadrant together with a sense of rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ArcKind {
    /// The quadrant, 0 ..= 3.
    pub(crate) quadrant: i64,
    /// True for SR (clockwise, G02), false for NR (counter-clockwise, G03).
    pub(crate) clockwise: bool,
}

impl ArcKind {
    /// The kind that the motion enters at a point: a point on an axis belongs to the quadrant that
    /// lies ahead of it (NR at (R,0) is in Q1, SR at (R,0) is in Q4).
    pub(crate) fn entered_at([x, y]: [i64; 2], clockwise: bool) -> Self {
        assert!([x, y] != [0, 0], "the centre belongs to no quadrant");
        let quadrant = match (x.signum(), y.signum()) {
            (1, 1) => 0,
            (-1, 1) => 1,
            (-1, -1) => 2,
            (1, -1) => 3,
            // On an axis: the quadrant ahead is one number lower when clockwise.
            (1, _) => 0 - i64::from(clockwise),
            (_, 1) => 1 - i64::from(clockwise),
            (-1, _) => 2 - i64::from(clockwise),
            _ => 3 - i64::from(clockwise),
        };
        ArcKind { quadrant: quadrant.rem_euclid(4), clockwise }
    }

    /// The kind that the motion comes from at a point: the reversed motion would enter it.
    pub(crate) fn left_at(point: [i64; 2], clockwise: bool) -> Self {
        let reversed = ArcKind::entered_at(point, !clockwise);
        ArcKind { clockwise, ..reversed }
    }

    /// The kind that follows in the sense of rotation.
    pub(crate) fn next(self) -> Self {
        let turn = if self.clockwise { -1 } else { 1 };
        ArcKind { quadrant: (self.quadrant + turn).rem_euclid(4), ..self }
    }

    /// The signs of x and y inside the quadrant.
    pub(crate) fn side(self) -> [i64; 2] {
        match self.quadrant {
            0 => [1, 1],
            1 => [-1, 1],
            2 => [-1, -1],
            _ => [1, -1],
        }
    }

    /// The direction of an X and of a Y pulse: the signs of the tangent, (y, -x) when clockwise and
    /// (-y, x) when counter-clockwise.
    pub(crate) fn travel(self) -> [i64; 2] {
        let [x, y] = self.side();
        if self.clockwise { [y, -x] } else { [-y, x] }
    }

    /// The axis whose magnitude grows: its pulses point away from the centre.
    pub(crate) fn growing(self) -> usize {
        usize::from(self.travel()[0] != self.side()[0])
    }

    /// The axis whose magnitude shrinks.
    pub(crate) fn shrinking(self) -> usize {
        1 - self.growing()
    }
}

/// A part of an arc that stays inside one quadrant; end points in BLU, relative to the centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sector {
    /// The kind that steers the whole sector.
    pub(crate) kind: ArcKind,
    /// Where it starts.
    pub(crate) from: [i64; 2],
    /// Where it ends.
    pub(crate) to: [i64; 2],
}

impl Sector {
    /// The pulses of each axis.
    pub(crate) fn distance(&self) -> [i64; 2] {
        [(self.to[0] - self.from[0]).abs(), (self.to[1] - self.from[1]).abs()]
    }
}

/// Splits an arc of a circle or of an ellipse at the axes; it crosses the axis X at the distance
/// `crossing[0]` from the centre and the axis Y at `crossing[1]`.
///
/// `from` and `to` are relative to the centre. An end point on the start point, or before it in the
/// same quadrant, means a full turn, or nearly. An end point on an axis belongs to the quadrant
/// that the motion comes from, so that no sector is empty.
pub(crate) fn sectors(from: [i64; 2], to: [i64; 2], clockwise: bool, crossing: [i64; 2]) -> Vec<Sector> {
    let last = ArcKind::left_at(to, clockwise);
    let mut kind = ArcKind::entered_at(from, clockwise);
    let mut point = from;
    let mut list = Vec::new();
    // Only in the first sector can the end point lie before the point that was reached.
    while kind != last || (list.is_empty() && !is_ahead(from, to, clockwise)) {
        // An axis is met no nearer to the centre than the point that was reached. The last one is met no nearer than
        // the end point, which may lie a little outside the curve: from there on this coordinate only shrinks.
        let growing = kind.growing();
        let beyond = if kind.next() == last { to[growing].abs() } else { 0 };
        let meets = crossing[growing].max(point[growing].abs()).max(beyond);
        let mut axis_point = [0, 0];
        axis_point[growing] = kind.side()[growing] * meets;
        list.push(sector(kind, point, axis_point));
        point = axis_point;
        kind = kind.next();
    }
    list.push(sector(kind, point, to));
    list
}

/// True when `to` lies ahead of `from`, both in one quadrant: the sign of their cross product.
fn is_ahead(from: [i64; 2], to: [i64; 2], clockwise: bool) -> bool {
    let cross = from[0] * to[1] - from[1] * to[0];
    if clockwise { cross < 0 } else { cross > 0 }
}

/// A sector whose end can be reached by the pulses of its kind.
fn sector(kind: ArcKind, from: [i64; 2], to: [i64; 2]) -> Sector {
    let travel = kind.travel();
    for axis in 0..2 {
        assert!(
            (to[axis] - from[axis]) * travel[axis] >= 0,
            "{to:?} is too far from the circle to be reached from {from:?} in {kind:?}"
        );
    }
    Sector { kind, from, to }
}

/// R² of a point relative to the centre, in BLU².
pub(crate) fn radius_squared([x, y]: [i64; 2]) -> i64 {
    x * x + y * y
}

/// Where the path of point-by-point comparison meets an axis: the smallest c >= 1 with
/// c² + 1 >= R².
///
/// One row before the axis the growing coordinate is stepped while c² + 1² < R²; then the other
/// coordinate steps to 0.
pub(crate) fn natural_extreme(radius_squared: i64) -> i64 {
    let root = (radius_squared - 1).isqrt();
    let ceiling = root + i64::from(root * root < radius_squared - 1);
    ceiling.max(1)
}

/// R rounded to the nearest integer: the smallest c with R < c + 1/2, that is 4R² < (2c + 1)².
pub(crate) fn nearest_radius(radius_squared: i64) -> i64 {
    let floor = radius_squared.isqrt();
    floor + i64::from(4 * radius_squared > (2 * floor + 1) * (2 * floor + 1))
}
