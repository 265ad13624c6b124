//! NURBS by de Boor and a step of the first order a period, in whole numbers: knots and u in 2^-32, points in 2^-q BLU.
//!
//! Every intermediate result must fit 127 bits, so that coordinates are small here.

/// What gives a curve, and how it is sampled.
#[derive(Clone, Debug)]
pub(crate) struct Sampled<'a> {
    pub(crate) degree: usize,
    /// Control points in BLU.
    pub(crate) points: &'a [[i64; 2]],
    /// Weights by 2^q, rounded.
    pub(crate) weights: &'a [i128],
    /// Knots by 2^32, the first 0.
    pub(crate) knots: &'a [i128],
    /// q.
    pub(crate) fraction: u32,
    /// Displacement of a period by 2^q.
    pub(crate) step: i128,
    /// Greatest chord error that is taken, in millionths of a BLU; none without a check.
    pub(crate) tolerance: Option<i128>,
}

/// The end of a period.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Row {
    /// By 2^32.
    pub(crate) u: i128,
    /// By 2^q.
    pub(crate) point: [i128; 2],
}

/// A place of the curve: the point by 2^q; x, y and w of d_(p-1) and d_p before the last level; w after it.
struct Place {
    point: [i128; 2],
    before: [[i128; 3]; 2],
    w: i128,
    span: usize,
}

impl Sampled<'_> {
    fn at(&self, u: i128) -> Place {
        let (p, n) = (self.degree, self.points.len() - 1);
        let k = (p..=n).rev().find(|&k| self.knots[k] <= u).unwrap();
        let mut d: Vec<[i128; 3]> = (k - p..=k)
            .map(|index| {
                let ([x, y], w) = (self.points[index].map(i128::from), self.weights[index]);
                [w * x, w * y, w]
            })
            .collect();
        let mut before = [[0; 3]; 2];
        for r in 1..=p {
            before = [d[p - 1], d[p]];
            for j in (r..=p).rev() {
                let (low, high) = (self.knots[j + k - p], self.knots[j + 1 + k - r]);
                let alpha = ((u - low) << 32) / (high - low);
                let from = d[j - 1];
                d[j] = [0, 1, 2].map(|axis| from[axis] + (((d[j][axis] - from[axis]) * alpha + (1 << 31)) >> 32));
            }
        }
        let [x, y, w] = d[p];
        // Rounded half upwards.
        let point = [x, y].map(|c| ((c << (self.fraction + 1)) + w).div_euclid(2 * w));
        Place { point, before, w, span: k }
    }

    /// The step of u: the displacement of a period by how fast the curve goes along u; none where it does not go at all.
    fn step(&self, place: &Place) -> Option<i128> {
        let [low, high] = place.before;
        let g = [0, 1, 2].map(|axis| self.degree as i128 * (high[axis] - low[axis]));
        let speed = [0, 1].map(|axis| (g[axis] << self.fraction) - g[2] * place.point[axis]);
        let length = (speed[0] * speed[0] + speed[1] * speed[1]).isqrt();
        let span = self.knots[place.span + 1] - self.knots[place.span];
        (length > 0).then(|| ((self.step * place.w * span) / length).max(1))
    }

    /// The chord of a period leaves the middle of its parameters by more than the tolerance.
    fn is_far(&self, from: [i128; 2], u: i128, step: i128) -> bool {
        let Some(tolerance) = self.tolerance else { return false };
        let (middle, to) = (self.at(u + (step >> 1)).point, self.at(u + step).point);
        let [x, y] = [0, 1].map(|axis| 2 * middle[axis] - from[axis] - to[axis]);
        let most = (2 * tolerance) << self.fraction;
        (x * x + y * y) * 1_000_000 * 1_000_000 > most * most
    }
}

/// The ends of all periods, from the start on; none where the curve rests somewhere.
pub(crate) fn sampled_nurbs(curve: &Sampled<'_>) -> Option<Vec<Row>> {
    let end = curve.knots[curve.knots.len() - 1];
    let mut u = 0;
    let mut rows = vec![Row { u, point: curve.at(u).point }];
    while u < end {
        let place = curve.at(u);
        let mut step = curve.step(&place)?.min(end - u);
        while step > 1 && curve.is_far(place.point, u, step) {
            step >>= 1;
        }
        u += step;
        rows.push(Row { u, point: curve.at(u).point });
    }
    Some(rows)
}
