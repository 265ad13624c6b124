//! Forward differences of polynomial curves: what cascaded integrators are loaded with, and in how many steps.

use stepwave_nc::{Spline, SplineSegment};
use stepwave_netlist::Width;

use crate::machine::Words;
use crate::parts::{FIRST_DIFFERENCE, SECOND_DIFFERENCE, THIRD_DIFFERENCE};

/// Most steps of a segment, as a power of two: p has 3s+2 bits.
pub(crate) const MOST_DIVISIONS: u32 = 20;

/// The differences of one axis at the start of a segment, in 1/M BLU.
#[derive(Clone, Copy)]
pub(crate) struct Differences {
    /// M times the start point.
    pub(crate) start: i128,
    pub(crate) p: i128,
    pub(crate) q: i128,
    pub(crate) r: i128,
}

impl Differences {
    /// Of an axis of a segment of 2^s steps, where M is D·2^(3s).
    pub(crate) fn exact([c0, c1, c2, c3]: [i64; 4], s: u32) -> Differences {
        let [c0, c1, c2, c3] = [c0, c1, c2, c3].map(i128::from);
        Differences {
            start: c0 << (3 * s),
            p: (c1 << (2 * s)) + (c2 << s) + c3,
            q: ((2 * c2) << s) + 6 * c3,
            r: 6 * c3,
        }
    }

    /// The same in units of another M, rounded half upwards.
    fn rounded(self, of: i128, modulus: i128) -> Differences {
        // Above 2^63 only where a register would not fit, which is found out below.
        let round = |value: i128| (2 * value.saturating_mul(modulus) + of).div_euclid(2 * of);
        Differences { start: round(self.start), p: round(self.p), q: round(self.q), r: round(self.r) }
    }

    /// The same in units of 1/M of a greater M, 2^bits times as great.
    pub(crate) fn raised(self, bits: u32) -> Differences {
        let Differences { start, p, q, r } = self;
        Differences { start: start << bits, p: p << bits, q: q << bits, r: r << bits }
    }

    /// The words of the cascade of this axis, but its remainder.
    pub(crate) fn words(&self, words: Words, axis: usize) -> Words {
        let Differences { p, q, r, .. } = *self;
        words.set(FIRST_DIFFERENCE.of(axis), p).set(SECOND_DIFFERENCE.of(axis), q).set(THIRD_DIFFERENCE.of(axis), r)
    }

    /// Least and greatest p, q and r in all rows of 2^s steps, the last too, though no step uses it.
    pub(crate) fn ranges(&self, s: u32) -> [[i128; 2]; 3] {
        let steps = 1_i128 << s;
        let last = self.q + steps * self.r;
        [self.p_extremes(steps), [self.q.min(last), self.q.max(last)], [self.r; 2]]
    }

    /// p after i steps.
    fn p_at(&self, i: i128) -> i128 {
        self.p + i * self.q + i * (i - 1) / 2 * self.r
    }

    /// The greatest abs(p) from row 0 to this one, and the extremes of p themselves.
    pub(crate) fn p_extremes(&self, last: i128) -> [i128; 2] {
        // A parabola in i, with its vertex at 1/2 - q/r, less than a row from the quotient.
        let vertex = if self.r == 0 { 0 } else { (self.r - 2 * self.q) / (2 * self.r) };
        let rows = [0, vertex - 1, vertex, vertex + 1, last].map(|row| self.p_at(row.clamp(0, last)));
        rows.into_iter().fold([rows[0]; 2], |[least, most], p| [least.min(p), most.max(p)])
    }
}

/// The least s from 1 on with which no axis of a segment is faster than a pulse a step, at any place and not only at those where
/// steps end: so no detour between them is lost, and every greater s is enough too. `None` beyond `most`.
pub(crate) fn followed_divisions(segment: &SplineSegment, most: u32) -> Option<u32> {
    let slow = |&[_, c1, c2, c3]: &[i64; 4], s: u32| {
        let [c1, c2, c3] = [c1, c2, c3].map(i128::from);
        let limit = i128::from(segment.divisor) << s;
        // The speed is a parabola in u, whose vertex is at -c2/(3·c3).
        let inside = (1..3 * c3.abs()).contains(&(-c2 * c3.signum()));
        let vertex = !inside || (3 * c1 * c3 - c2 * c2).abs() <= limit * 3 * c3.abs();
        vertex && [c1, c1 + 2 * c2 + 3 * c3].iter().all(|speed| speed.abs() <= limit)
    };
    (1..=most).find(|&s| segment.coefficients.iter().all(|axis| slow(axis, s)))
}

/// Bits of the numbers between these two in two's complement.
pub(crate) fn bits([least, most]: [i128; 2]) -> u32 {
    Width::needed_signed(least).max(Width::needed_signed(most))
}

/// D·2^(3s): all segments of a curve have one D.
pub(crate) fn exact_modulus(spline: &Spline, s: u32) -> i128 {
    i128::from(spline.segments().first().map_or(1, |segment| segment.divisor)) << (3 * s)
}

/// The differences of every axis of every segment in 2^s steps, in units of 1/`modulus` BLU.
pub(crate) fn differences(spline: &Spline, s: u32, modulus: i128) -> impl Iterator<Item = [Differences; 2]> {
    let exact = exact_modulus(spline, s);
    let of = move |segment: &SplineSegment| {
        segment.coefficients.map(|c| {
            let differences = Differences::exact(c, s);
            if modulus == exact { differences } else { differences.rounded(exact, modulus) }
        })
    };
    spline.segments().iter().map(of)
}

/// The least s from 1 on with one pulse of an axis a step at most.
pub(crate) fn least_divisions(spline: &Spline) -> Option<u32> {
    (1..=MOST_DIVISIONS).find(|&s| {
        let modulus = exact_modulus(spline, s);
        let fits = |axis: &Differences| axis.p_extremes((1 << s) - 1).into_iter().all(|p| p.abs() <= modulus);
        differences(spline, s, modulus).all(|axes| axes.iter().all(fits))
    })
}
