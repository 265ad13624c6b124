//! How far a position is from a NURBS.

use super::piece::{MOST, Piece};
use super::{NURBS_DEGREE, Nurbs};
use crate::foot::{Foot, beyond, nearest_first};

/// Most coefficients of the polynomial whose roots are the feet: it has the degree 3p-1.
const COEFFICIENTS: usize = 3 * NURBS_DEGREE;

/// n over k.
fn choose(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |all, i| all * (n - i) as f64 / (i + 1) as f64)
}

/// The product of two polynomials by their Bézier coefficients, of these degrees.
fn product(a: &[f64], b: &[f64]) -> [f64; COEFFICIENTS] {
    let (m, n) = (a.len() - 1, b.len() - 1);
    let mut all = [0.0; COEFFICIENTS];
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            all[i + j] += choose(m, i) * choose(n, j) / choose(m + n, i + j) * a * b;
        }
    }
    all
}

impl Piece<2> {
    /// The box of its Bézier points, in which it lies: no weight is negative.
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            let points = (0..=self.degree).map(|index| self.control[index][axis] / self.weights[index]);
            points.fold([f64::MAX, f64::MIN], |[least, most], at| [least.min(at), most.max(at)])
        })
    }

    /// What has the sign of the change of the distance along u, and its number of Bézier coefficients. With
    /// B = w·(C - position) that is the sum over the axes of B·(B'·w - B·w').
    fn growth(&self, position: [f64; 2]) -> ([f64; COEFFICIENTS], usize) {
        let p = self.degree;
        let mut growth = [0.0; COEFFICIENTS];
        for (axis, place) in position.into_iter().enumerate() {
            let away: [f64; MOST] =
                std::array::from_fn(|index| self.control[index][axis] - place * self.weights[index]);
            let (away, weights) = (&away[..=p], &self.weights[..=p]);
            let slope = |values: &[f64]| -> [f64; MOST] {
                std::array::from_fn(|index| if index < p { values[index + 1] - values[index] } else { 0.0 })
            };
            let (first, second) = (product(&slope(away)[..p], weights), product(away, &slope(weights)[..p]));
            let difference: [f64; COEFFICIENTS] = std::array::from_fn(|index| first[index] - second[index]);
            let all = product(away, &difference[..2 * p]);
            growth.iter_mut().zip(all).for_each(|(growth, own)| *growth += own);
        }
        (growth, 3 * p)
    }

    /// The place of the piece that is nearest.
    fn foot(&self, position: [f64; 2]) -> Foot {
        Foot::of_piece(position, |u| [self.at(u), self.tangent(u)], self.growth(position))
    }
}

impl Nurbs {
    fn foot(&self, position: [f64; 2]) -> Foot {
        let mut nearest = Foot::NONE;
        let of_piece = |index: usize| beyond(self.pieces[index].bounds(), position);
        nearest_first(&mut nearest, self.pieces.len(), of_piece, |index, nearest| {
            nearest.take(self.pieces[index].foot(position));
        });
        nearest
    }

    /// The distance of a place from the curve, in BLU.
    #[must_use]
    pub fn distance(&self, place: [f64; 2]) -> f64 {
        self.foot(place).distance
    }

    /// The distance of a position from the curve, in BLU; further coordinates are ignored; NaN with too few of them.
    ///
    /// Every minimum of the distance is found by halving, as exactly as `f64` rounds.
    #[must_use]
    pub fn deviation(&self, position: &[i64]) -> f64 {
        let [x, y, ..] = *position else { return f64::NAN };
        self.distance([x as f64, y as f64])
    }

    /// The distance with its side: positive on the left of the curve.
    #[must_use]
    pub fn signed_deviation(&self, position: &[i64]) -> f64 {
        let [x, y, ..] = *position else { return f64::NAN };
        self.foot([x as f64, y as f64]).signed()
    }
}
