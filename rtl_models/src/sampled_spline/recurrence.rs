//! What the coarse stage will come to, period by period, in whole numbers: for the plan, which needs to know the
//! longest period, the most halvings and the chords before there is hardware.

use num_bigint::BigUint;
use stepwave_nc::{NURBS_UNIT, Nurbs};
use stepwave_netlist::Width;

use crate::options::Millionths;

/// Bits of the fraction of knots and of u.
pub(super) const PLACE_FRACTION: u32 = 32;

/// A NURBS as the hardware holds it.
pub(super) struct Control {
    pub(super) degree: usize,
    /// x·W and y·W of each control point, and its weight W, all by 2^q.
    pub(super) points: Vec<[i128; 3]>,
    /// By 2^32, the first 0.
    pub(super) knots: Vec<i128>,
    pub(super) fraction: u32,
}

/// What happens in all periods.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Course {
    /// Most pulses of an axis in a period.
    pub(super) widest: u64,
    /// Most periods without a pulse one after another.
    pub(super) still: u64,
    /// Most halvings of a step.
    pub(super) halvings: u32,
    /// Greatest chord error that is left, in BLU.
    pub(super) chord_error: f64,
}

/// Why the coarse stage does not come to the end.
pub(super) enum Stuck {
    /// The curve rests at this u.
    Rests(f64),
    /// It would take more than this many periods.
    Periods(u64),
}

/// Most periods of a curve.
const MOST_PERIODS: u64 = 1 << 20;

struct Place {
    point: [i128; 2],
    /// d_(p-1) and d_p before the last level.
    before: [[i128; 3]; 2],
    weight: i128,
    span: usize,
}

impl Control {
    /// The curve with q bits of fraction.
    pub(super) fn new(nurbs: &Nurbs, fraction: u32) -> Control {
        let scaled = |value: i64, bits: u32| {
            let unit = i128::from(NURBS_UNIT);
            ((i128::from(value) << (bits + 1)) + unit) / (2 * unit)
        };
        let point = |point: &stepwave_nc::ControlPoint| {
            let weight = scaled(point.weight, fraction);
            let [x, y] = point.at.map(|c| weight * i128::from(c));
            [x, y, weight]
        };
        let first = nurbs.knots().first().copied().unwrap_or(0);
        let knots = nurbs.knots().iter().map(|&knot| scaled(knot - first, PLACE_FRACTION)).collect();
        Control { degree: nurbs.degree(), points: nurbs.points().iter().map(point).collect(), knots, fraction }
    }

    /// u of the end.
    pub(super) fn end(&self) -> i128 {
        self.knots.last().copied().unwrap_or(0)
    }

    fn at(&self, u: i128, from: usize) -> Place {
        let p = self.degree;
        let mut k = from;
        while k + 1 < self.points.len() && self.knots[k + 1] <= u {
            k += 1;
        }
        let mut d = self.points[k - p..=k].to_vec();
        let mut before = [[0; 3]; 2];
        for r in 1..=p {
            before = [d[p - 1], d[p]];
            for j in (r..=p).rev() {
                let (low, high) = (self.knots[j + k - p], self.knots[j + 1 + k - r]);
                let alpha = ((u - low) << PLACE_FRACTION) / (high - low);
                let half = 1 << (PLACE_FRACTION - 1);
                d[j] = std::array::from_fn(|axis| {
                    d[j - 1][axis] + (((d[j][axis] - d[j - 1][axis]) * alpha + half) >> PLACE_FRACTION)
                });
            }
        }
        let [x, y, weight] = d[p];
        let point = [x, y].map(|c| ((c << (self.fraction + 1)) + weight).div_euclid(2 * weight));
        Place { point, before, weight, span: k }
    }

    /// The step of u for a displacement of `word`; none where the curve rests.
    fn step(&self, place: &Place, word: u64) -> Option<i128> {
        let [low, high] = place.before;
        let g: [i128; 3] = std::array::from_fn(|axis| self.degree as i128 * (high[axis] - low[axis]));
        let square = |axis: usize| {
            let speed = (g[axis] << self.fraction) - g[2] * place.point[axis];
            BigUint::from(speed.unsigned_abs()).pow(2)
        };
        // As many bits as a speed has, and one more.
        let length = i128::try_from((square(0) + square(1)).sqrt()).unwrap_or(i128::MAX);
        let span = self.knots[place.span + 1] - self.knots[place.span];
        // The product may have more bits than a number here; the step is cut to what is left.
        let product =
            BigUint::from(word) * BigUint::from(place.weight.unsigned_abs()) * BigUint::from(span.unsigned_abs());
        (length > 0).then(|| i128::try_from(product / BigUint::from(length.unsigned_abs())).unwrap_or(i128::MAX).max(1))
    }

    /// All periods of this displacement, whose chords leave the curve by less than `limit` says.
    pub(super) fn course(&self, word: u64, limit: u128) -> Result<Course, Stuck> {
        let (mut course, end) = (Course::default(), self.end());
        let (mut u, mut place, mut periods, mut still) = (0, self.at(0, self.degree), 0, 0);
        while u < end {
            let rests = || Stuck::Rests(u as f64 / f64::from(PLACE_FRACTION).exp2());
            let mut step = self.step(&place, word).ok_or_else(rests)?.min(end - u);
            let mut halvings = 0;
            let (next, off) = loop {
                let [middle, next] = [u + (step >> 1), u + step].map(|u| self.at(u, place.span));
                let off = [0, 1].map(|axis| 2 * middle.point[axis] - place.point[axis] - next.point[axis]);
                let off: u128 = off.into_iter().map(|c| c.unsigned_abs().pow(2)).sum();
                if step == 1 || off <= limit {
                    break (next, off);
                }
                step >>= 1;
                halvings += 1;
            };
            course.halvings = course.halvings.max(halvings);
            course.chord_error = course.chord_error.max((off as f64).sqrt() / 2.0 / f64::from(self.fraction).exp2());
            let whole = |c: i128| (c + (1 << (self.fraction - 1))) >> self.fraction;
            let travel = [0, 1].map(|axis| (whole(next.point[axis]) - whole(place.point[axis])).unsigned_abs());
            let travel = u64::try_from(travel[0].max(travel[1])).unwrap_or(u64::MAX);
            course.widest = course.widest.max(travel);
            still = if travel == 0 { still + 1 } else { 0 };
            course.still = course.still.max(still);
            (u, place, periods) = (u + step, next, periods + 1);
            if periods > MOST_PERIODS {
                return Err(Stuck::Periods(MOST_PERIODS));
            }
        }
        Ok(course)
    }
}

/// The square of twice a tolerance with q bits of fraction, rounded down, in as many bits as are compared.
pub(super) fn chord_limit(tolerance: Millionths, fraction: u32, bits: u32) -> u128 {
    const MILLION: u128 = 1_000_000;
    let twice = u128::from(tolerance.0) << (fraction + 1);
    let (whole, rest) = (twice / MILLION, twice % MILLION);
    let most = u128::MAX >> (128 - 2 * bits);
    if Width::needed_unsigned(whole) > bits {
        return most;
    }
    (whole * whole).saturating_add((2 * whole * rest + rest * rest / MILLION) / MILLION).min(most)
}
