//! One span of a NURBS as a rational Bézier curve, in as many axes as its points have.

use super::NURBS_DEGREE;

/// Most Bézier points of a piece.
pub(super) const MOST: usize = NURBS_DEGREE + 1;

/// A rational Bézier curve over u from 0 to 1, of N axes. A control point is given by the coordinates, each times the
/// weight, in BLU.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<const N: usize> {
    pub(super) degree: usize,
    /// By axis; those beyond the degree do not count.
    pub(crate) control: [[f64; N]; MOST],
    pub(super) weights: [f64; MOST],
}

/// Most halvings of a piece for its length: weights are up to 10^15 apart.
const HALVINGS: u32 = 50;

impl Piece<2> {
    /// The Bézier curve of these points, at least two and at most [`MOST`], whose weights are 1.
    pub(crate) fn polynomial(points: &[[f64; 2]]) -> Piece<2> {
        let mut piece =
            Piece { degree: points.len().saturating_sub(1), control: [[0.0; 2]; MOST], weights: [1.0; MOST] };
        piece.control.iter_mut().zip(points).for_each(|(control, point)| *control = *point);
        piece
    }

    /// The points of such a curve.
    pub(crate) fn points(&self) -> &[[f64; 2]] {
        &self.control[..=self.degree]
    }
}

impl<const N: usize> Piece<N> {
    /// The numerators and the denominator at u, and their derivatives by u.
    fn homogeneous(&self, u: f64) -> [([f64; N], f64); 2] {
        let (mut control, mut weights, p) = (self.control, self.weights, self.degree);
        for round in 0..p.saturating_sub(1) {
            for index in 0..p - round {
                let next = control[index + 1];
                control[index].iter_mut().zip(next).for_each(|(c, next)| *c += (next - *c) * u);
                weights[index] += (weights[index + 1] - weights[index]) * u;
            }
        }
        let [low, high] = [0, 1].map(|index| (control[index], weights[index]));
        let factor = p as f64;
        let slope = (std::array::from_fn(|axis| factor * (high.0[axis] - low.0[axis])), factor * (high.1 - low.1));
        let value = std::array::from_fn(|axis| low.0[axis] + (high.0[axis] - low.0[axis]) * u);
        [(value, low.1 + (high.1 - low.1) * u), slope]
    }

    /// The point at u, in BLU.
    pub(crate) fn at(&self, u: f64) -> [f64; N] {
        let [(value, weight), _] = self.homogeneous(u);
        value.map(|c| c / weight)
    }

    /// The first derivative by u, in BLU.
    pub(crate) fn tangent(&self, u: f64) -> [f64; N] {
        let [(value, weight), (slope, by)] = self.homogeneous(u);
        std::array::from_fn(|axis| (slope[axis] - value[axis] / weight * by) / weight)
    }

    /// Its length in BLU, by the formula of Gauss over 32 parts; weights far apart crowd the curve into a small share of u, so
    /// it is halved until both halves come to the same length.
    pub(crate) fn length(&self) -> f64 {
        self.refined(self.by_gauss(), HALVINGS)
    }

    fn by_gauss(&self) -> f64 {
        crate::spline::gauss(|u| self.tangent(u).iter().map(|c| c * c).sum::<f64>().sqrt())
    }

    fn refined(&self, whole: f64, halvings: u32) -> f64 {
        let halves = self.halves();
        let parts = halves.map(|half| half.by_gauss());
        let sum: f64 = parts.iter().sum();
        if halvings == 0 || (sum - whole).abs() <= 1e-9 * sum {
            return sum;
        }
        halves.iter().zip(parts).map(|(half, part)| half.refined(part, halvings - 1)).sum()
    }

    /// The point at its end, in BLU.
    fn end(&self) -> [f64; N] {
        self.control[self.degree].map(|c| c / self.weights[self.degree])
    }

    /// No Bézier point, and so no place of it, is farther from the chord than this, in BLU.
    fn is_flat(&self, tolerance: f64) -> bool {
        let (from, to) = (self.control[0].map(|c| c / self.weights[0]), self.end());
        let along: [f64; N] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let dot = |a: [f64; N], b: [f64; N]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let square = dot(along, along);
        (1..self.degree).all(|index| {
            let place = self.control[index].map(|c| c / self.weights[index]);
            let off: [f64; N] = std::array::from_fn(|axis| place[axis] - from[axis]);
            let share = if square > 0.0 { (dot(off, along) / square).clamp(0.0, 1.0) } else { 0.0 };
            let off: [f64; N] = std::array::from_fn(|axis| off[axis] - share * along[axis]);
            dot(off, off) <= tolerance * tolerance
        })
    }

    /// Both halves, by de Casteljau.
    fn halves(&self) -> [Piece<N>; 2] {
        let (mut left, mut right) = (*self, *self);
        for round in 1..=self.degree {
            for index in 0..=self.degree - round {
                let next = (right.control[index + 1], right.weights[index + 1]);
                right.control[index].iter_mut().zip(next.0).for_each(|(c, next)| *c = f64::midpoint(*c, next));
                right.weights[index] = f64::midpoint(right.weights[index], next.1);
            }
            (left.control[round], left.weights[round]) = (right.control[0], right.weights[0]);
        }
        [left, right]
    }

    /// Visits the ends of chords that no place of it is farther from than the tolerance, in BLU, one after another; with more
    /// chords than the limit the rest is left out.
    pub(crate) fn chords(&self, tolerance: f64, limit: usize, visit: &mut impl FnMut([f64; N])) {
        let (mut left, mut count) = (vec![*self], 0);
        while let Some(piece) = left.pop() {
            // Its halves have been halved as often as numbers allow.
            if left.len() > 60 || piece.is_flat(tolerance) {
                visit(piece.end());
                count += 1;
                if count >= limit {
                    return;
                }
            } else {
                let [first, second] = piece.halves();
                left.extend([second, first]);
            }
        }
    }
}

/// The pieces of a NURBS, one for each span of its knots that is not empty. A control point is the coordinates, each times
/// the weight, and the weight (M = N + 1 numbers).
pub(crate) fn pieces<const N: usize, const M: usize>(
    degree: usize,
    points: &[[f64; M]],
    knots: &[f64],
) -> Vec<Piece<N>> {
    let spans = (degree..points.len()).filter(|&k| knots[k] < knots[k + 1]);
    spans
        .map(|k| {
            let mut piece = Piece { degree, control: [[0.0; N]; MOST], weights: [0.0; MOST] };
            for index in 0..=degree {
                // The polar form, with its arguments `index` times at the end of the span, and else at its start.
                let mut d: [[f64; M]; MOST] = [[0.0; M]; MOST];
                d[..=degree].copy_from_slice(&points[k - degree..=k]);
                for r in 1..=degree {
                    let u = if r <= index { knots[k + 1] } else { knots[k] };
                    for j in (r..=degree).rev() {
                        let (low, high) = (knots[j + k - degree], knots[j + 1 + k - r]);
                        let alpha = (u - low) / (high - low);
                        d[j] = std::array::from_fn(|axis| d[j - 1][axis] + (d[j][axis] - d[j - 1][axis]) * alpha);
                    }
                }
                piece.control[index] = std::array::from_fn(|axis| d[degree][axis]);
                piece.weights[index] = d[degree][N];
            }
            piece
        })
        .collect()
}
