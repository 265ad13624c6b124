//! Widths of the coarse stage, from the numbers that it holds, and the clocks that it takes.

use stepwave_netlist::Width;

use super::recurrence::{Control, PLACE_FRACTION};
use crate::hardware::Hardware;
use crate::parts::MOST_BITS;

/// Widths in bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Widths {
    /// f.
    pub(super) word: u32,
    /// W·X and W·Y, in two's complement.
    pub(super) homogeneous: u32,
    /// W.
    pub(super) weight: u32,
    /// u and knots.
    pub(super) place: u32,
    /// A coordinate of a coarse point, in two's complement.
    pub(super) point: u32,
    /// |N| of an axis.
    pub(super) speed: u32,
    /// Twice the distance of the middle of a chord from the curve, along an axis, without its sign.
    pub(super) chord: u32,
}

/// Most bits of what has to be one net.
const MOST_NET: u32 = 60;

/// Their names among the constants of the hardware.
const NAMES: [&str; 7] =
    ["word bits", "homogeneous bits", "weight bits", "place bits", "point bits", "speed bits", "chord bits"];

impl Widths {
    /// For this curve, magnitudes of `whole` bits before the point, and a displacement of `word` a period.
    pub(super) fn of(control: &Control, whole: u32, word: u64) -> Widths {
        let most = |axis: usize| control.points.iter().map(|point| point[axis].unsigned_abs()).max().unwrap_or(0);
        let weight = Width::needed_unsigned(most(2));
        let homogeneous = Width::needed_unsigned(most(0).max(most(1))) + 1;
        let q = control.fraction;
        // p is 7 at most, so that g has three bits more than a difference.
        let speed = (homogeneous + 3 + q).max(weight + 3 + whole + q) + 1;
        Widths {
            word: Width::needed_unsigned(word.into()),
            homogeneous,
            weight,
            place: Width::needed_unsigned(control.end().unsigned_abs()),
            point: whole + q + 1,
            speed,
            chord: whole + q + 2,
        }
    }

    /// What is too wide, in words.
    pub(super) fn too_wide(&self) -> Option<String> {
        let nets = [
            (self.homogeneous, "a control point times its weight"),
            (self.chord, "a coarse point"),
            (self.place, "a knot"),
            (self.word, "the displacement of a period"),
        ];
        let net = nets.into_iter().find(|(bits, _)| *bits > MOST_NET);
        if let Some((bits, what)) = net {
            return Some(format!("{what} would have {bits} bits, but {MOST_NET} fit"));
        }
        // A sum has a carry, and a remainder a bit more than its divisor. q is less than a point has.
        let [[first, second], [dividend, divisor]] = [self.factors(), self.division(self.point)];
        let long = [
            (2 * self.root(), "the square root"),
            (first + second + 2, "a product"),
            (dividend.max(divisor) + 2, "a dividend"),
        ];
        let long = long.into_iter().find(|(bits, _)| *bits > MOST_BITS);
        long.map(|(bits, what)| format!("{what} would have {bits} bits, but {MOST_BITS} fit"))
    }

    fn all(&self) -> [u32; 7] {
        [self.word, self.homogeneous, self.weight, self.place, self.point, self.speed, self.chord]
    }

    /// As constants of the hardware.
    pub(super) fn constants(&self) -> impl Iterator<Item = (&'static str, i128)> {
        NAMES.into_iter().zip(self.all().map(i128::from))
    }

    /// Of hardware that has them as constants.
    pub(super) fn built(hardware: &Hardware) -> Widths {
        let bits = NAMES.map(|name| u32::try_from(hardware.constant(name)).unwrap_or(1));
        let [word, homogeneous, weight, place, point, speed, chord] = bits;
        Widths { word, homogeneous, weight, place, point, speed, chord }
    }

    /// The root of the squares of both speeds.
    pub(super) fn root(&self) -> u32 {
        self.speed + 1
    }

    /// Both factors of the multiplier, the second a bit a clock.
    pub(super) fn factors(&self) -> [u32; 2] {
        let first = [self.homogeneous + 1, self.point, self.speed, self.word + self.weight, self.chord];
        let second = [PLACE_FRACTION + 1, self.weight + 4, self.speed, self.place, self.chord];
        [first, second].map(|factors| factors.into_iter().max().unwrap_or(1))
    }

    /// Dividend, a bit a clock, and divisor. `fraction` is q.
    pub(super) fn division(&self, fraction: u32) -> [u32; 2] {
        let dividends =
            [self.place + PLACE_FRACTION, self.homogeneous + fraction, self.word + self.weight + self.place];
        let divisors = [self.place, self.weight, self.root()];
        [dividends.into_iter().max().unwrap_or(1), divisors.into_iter().max().unwrap_or(1)]
    }

    /// Most clocks from one hand-over to the next, for `tries` steps: a component takes a bit a clock, and its state two
    /// more.
    pub(super) fn clocks(&self, fraction: u32, degree: usize, spans: usize, tries: u32) -> u32 {
        let [multiply, divide, root] = [self.factors()[1] + 2, self.division(fraction)[0] + 2, self.root() + 2];
        // The degree is 7 at most, and there are 1024 points.
        #[allow(clippy::cast_possible_truncation)]
        let (p, spans) = (degree as u32, spans as u32);
        let place = spans + 1 + p + 1 + p * (p + 1) / 2 * (divide + 3 * multiply) + 2 * divide;
        let step = 6 * multiply + root + divide;
        step + tries * (2 * place + 2 * multiply) + 1
    }
}
