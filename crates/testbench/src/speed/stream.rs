//! Rows that are equally far apart, kept as a bit a step for each axis until there are enough for the
//! [kernel](super::kernel).

use super::Window;
use super::even::Even;
use super::kernel::{Bits, Kernel, STEPS, WORDS};
use super::windows::{WINDOW, Windows};

/// Most clocks from row to row.
const MOST_APART: u64 = 64;
/// One bit in four.
const FOURTH: u64 = 0x1111_1111_1111_1111;

/// Samples one after another, 1 to 64 of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span<'a> {
    /// Clock of the first.
    pub(super) clock: u64,
    /// How many they are.
    pub(super) samples: usize,
    /// A bit for each that completes a step, the first the lowest.
    pub(super) stepped: u64,
    /// For each axis a bit for each in which it pulses, and the direction of all of these, 1 or -1.
    pub(super) pulses: &'a [u64],
    pub(super) signs: &'a [i64],
}

/// Whole words of samples one after another, as those of a [`Span`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Many<'a> {
    /// Clock of the first sample.
    pub(super) clock: u64,
    pub(super) stepped: &'a [u64],
    /// Of all trains, those of the pulses of each axis.
    pub(super) trains: &'a [Vec<u64>],
    pub(super) axes: &'a [usize],
    pub(super) signs: &'a [i64],
}

impl Many<'_> {
    fn pulses(&self, axis: usize) -> &[u64] {
        &self.trains[self.axes[axis]]
    }
}

/// The last rows as steps. While it runs, slots of [`Windows`] are not up to date, and the place is that after the last
/// row that was handed to the kernel.
#[derive(Clone, Debug)]
pub(super) struct Stream {
    kernel: Kernel,
    even: Even,
    runs: bool,
    /// Clocks from row to row, and the bits in these distances.
    apart: u64,
    comb: u64,
    /// Clock of the last row.
    clock: u64,
    axes: Vec<Axis>,
    bits: Vec<Bits>,
    /// New steps in `bits`.
    steps: usize,
    /// Where the tool was at a row before.
    earlier: Vec<i64>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    /// Direction; 0 where it has not moved in the steps that are kept.
    sign: i64,
    /// 1 where it has pulsed since the last row.
    pending: u64,
    /// The same after a span that is being taken, and the bits of the span's steps.
    then: u64,
    word: u64,
}

impl Stream {
    pub(super) fn new(axes: usize) -> Stream {
        Stream {
            kernel: Kernel::new(),
            even: Even::default(),
            runs: false,
            apart: 0,
            comb: 0,
            clock: 0,
            axes: vec![Axis::default(); axes],
            bits: vec![[0; WORDS + 1]; axes],
            steps: 0,
            earlier: vec![0; axes],
        }
    }

    /// Takes a span whose rows are as far apart as those before, and whose steps are a BLU of an axis at most; false
    /// where it is of another kind: then nothing was taken, and `windows` and `place` are up to date.
    pub(super) fn take(&mut self, span: &Span<'_>, windows: &mut Windows, place: &mut [i64]) -> bool {
        if !self.runs && !self.begin(windows, place) {
            return false;
        }
        let expected = match (self.clock + self.apart).checked_sub(span.clock) {
            Some(next) if next < span.samples as u64 => self.comb << next & u64::MAX >> (64 - span.samples),
            Some(_) => 0,
            // A row that was due has not come.
            None => !span.stepped,
        };
        let fits = span.stepped == expected && self.has_one_a_step(span);
        if fits {
            self.append(span, windows, place);
        } else {
            self.end(windows, place);
        }
        fits
    }

    /// Takes many whole words of samples, as [`take`](Self::take) does each, if there is a step in every sample, or in one
    /// of four with pulses in one of four; false where it is not so, and nothing was taken.
    #[inline(always)]
    pub(super) fn take_many(&mut self, many: &Many<'_>, windows: &mut Windows, place: &mut [i64]) -> bool {
        let Some(phase) = (self.clock + self.apart).checked_sub(many.clock).filter(|_| self.runs) else { return false };
        let expected = match (self.apart, phase) {
            (1, 0) => u64::MAX,
            (4, 0..4) => FOURTH << phase,
            _ => return false,
        };
        let words = many.stepped.len();
        let regular = many.stepped.iter().fold(true, |regular, &word| regular & (word == expected));
        if !regular || self.apart == 4 && !words.is_multiple_of(4) {
            return false;
        }
        for axis in 0..self.axes.len() {
            let any = many.pulses(axis).iter().fold(0, |any, word| any | word);
            let (pulse, of) = (u64::from(any.trailing_zeros() % 4), &mut self.axes[axis]);
            let is_turned = any != 0 && of.sign != 0 && of.sign != many.signs[axis];
            let is_late = self.apart == 4 && any != 0 && pulse > phase;
            if is_turned || self.apart == 4 && any & !(FOURTH << pulse) != 0 || of.pending != 0 && !is_late {
                return false;
            }
            // The pulses of a round are of the step after it.
            (of.then, of.word) = (u64::from(is_late), pulse);
        }
        if !self.steps.is_multiple_of(64) {
            self.flush(windows, place);
        }
        for (axis, &sign) in self.axes.iter_mut().zip(many.signs) {
            // A direction that no pulse has is of no matter.
            axis.sign = if axis.sign == 0 { sign } else { axis.sign };
        }
        let each = if self.apart == 1 { 1 } else { 4 };
        for first in (0..words).step_by(each) {
            if self.steps == STEPS {
                self.flush(windows, place);
            }
            let word = 1 + self.steps / 64;
            for (number, axis) in self.axes.iter_mut().enumerate() {
                let pulses = &many.pulses(number)[first..first + each];
                self.bits[number][word] = match *pulses {
                    [a, b, c, d] => {
                        let (a, b) = (gathered(a >> axis.word), gathered(b >> axis.word));
                        let (c, d) = (gathered(c >> axis.word), gathered(d >> axis.word));
                        let steps = a | b << 16 | c << 32 | d << 48;
                        let late = steps << 1 | axis.pending;
                        axis.pending = if axis.then == 1 { steps >> 63 } else { 0 };
                        if axis.then == 1 { late } else { steps }
                    }
                    _ => pulses[0],
                };
            }
            self.steps += 64;
        }
        self.clock += many.stepped.len() as u64 * 64;
        true
    }

    /// Every step of the span is a pulse of each axis at most, in the direction that the axis has; then `word` and `then`
    /// are those of the span.
    #[inline(always)]
    fn has_one_a_step(&mut self, span: &Span<'_>) -> bool {
        let each = self.axes.iter_mut().zip(span.pulses.iter().zip(span.signs));
        each.fold(true, |fits, (axis, (&pulses, &sign))| {
            let is_turned = pulses != 0 && axis.sign != 0 && axis.sign != sign;
            let found =
                if self.apart == 1 { Some((pulses, 0)) } else { one_a_step(pulses, span.stepped, axis.pending) };
            (axis.word, axis.then) = found.unwrap_or_default();
            fits && found.is_some() && !is_turned
        })
    }

    /// Appends the steps of a span.
    #[inline(always)]
    fn append(&mut self, span: &Span<'_>, windows: &mut Windows, place: &mut [i64]) {
        let steps = span.stepped.count_ones() as usize;
        if self.steps + steps > STEPS {
            self.flush(windows, place);
        }
        let (word, shift) = (1 + self.steps / 64, self.steps % 64);
        for ((axis, bits), (&pulses, &sign)) in
            self.axes.iter_mut().zip(&mut self.bits).zip(span.pulses.iter().zip(span.signs))
        {
            if pulses != 0 {
                axis.sign = sign;
            }
            axis.pending = axis.then;
            if steps > 0 {
                bits[word] |= axis.word << shift;
                if shift + steps > 64 {
                    bits[word + 1] |= axis.word >> (64 - shift);
                }
            }
        }
        self.steps += steps;
        self.clock += self.apart * steps as u64;
    }

    /// Looks at the windows of the new steps.
    #[inline(always)]
    fn flush(&mut self, windows: &mut Windows, place: &mut [i64]) {
        let Some(row) = windows.row.filter(|_| self.steps > 0) else { return };
        let clocks = self.apart * WINDOW as u64;
        let window = |square: u32, step: usize| Window { square: square.into(), clocks, step: row + 1 + step as u64 };
        let is_even = match &self.bits[..] {
            [x, y] => self.even.look([x, y], self.steps, |square, step| windows.see(window(square, step))),
            _ => false,
        };
        if !is_even {
            for square in self.kernel.extremes(&self.bits, self.steps) {
                if windows.is_extreme(window(square.into(), 0)) {
                    windows.see(window(square.into(), self.kernel.first(square)));
                }
            }
        }
        windows.row = Some(row + self.steps as u64);
        for ((axis, bits), place) in self.axes.iter().zip(&mut self.bits).zip(place) {
            let moved: u32 = bits[1..].iter().map(|word| word.count_ones()).sum();
            *place += axis.sign * i64::from(moved);
            // The last 32 steps.
            let (word, shift) = ((WINDOW + self.steps) / 64, (WINDOW + self.steps) % 64);
            let low = bits[word] >> shift;
            let high = if shift > WINDOW { bits[word + 1] << (64 - shift) } else { 0 };
            *bits = [0; WORDS + 1];
            bits[0] = (low | high) << 32;
        }
        self.steps = 0;
    }

    /// Begins after these rows, if they are of the kind.
    fn begin(&mut self, windows: &Windows, place: &mut [i64]) -> bool {
        let Some(row) = windows.row.filter(|&row| row + 1 >= WINDOW as u64) else { return false };
        let (last, clock) = windows.at(row);
        let apart = clock - windows.at(row - 1).1;
        if apart > MOST_APART {
            return false;
        }
        self.axes.fill(Axis::default());
        self.bits.fill([0; WORDS + 1]);
        for (axis, (place, last)) in self.axes.iter_mut().zip(place.iter().zip(last)) {
            match place - last {
                0 => {}
                sign @ (-1 | 1) => (axis.sign, axis.pending) = (sign, 1),
                _ => return false,
            }
        }
        for back in 0..WINDOW as u64 - 1 {
            let ((to, after), (from, before)) = (windows.at(row - back), windows.at(row - back - 1));
            if after - before != apart {
                return false;
            }
            for ((axis, bits), (to, from)) in self.axes.iter_mut().zip(&mut self.bits).zip(to.iter().zip(from)) {
                match to - from {
                    0 => {}
                    sign @ (-1 | 1) if axis.sign == 0 || axis.sign == sign => {
                        axis.sign = sign;
                        bits[0] |= 1 << (63 - back);
                    }
                    _ => return false,
                }
            }
        }
        place.copy_from_slice(last);
        self.even = Even::default();
        self.comb = (0..64).step_by(usize::try_from(apart).unwrap_or(64)).fold(0, |comb, bit| comb | 1 << bit);
        (self.runs, self.apart, self.clock, self.steps) = (true, apart, clock, 0);
        true
    }

    /// Brings `windows` and `place` up to date.
    pub(super) fn end(&mut self, windows: &mut Windows, place: &mut [i64]) {
        if !std::mem::take(&mut self.runs) {
            return;
        }
        self.flush(windows, place);
        let row = windows.row.unwrap_or(0);
        self.earlier.copy_from_slice(place);
        for back in 0..(WINDOW as u64).min(row + 1) {
            windows.put(row - back, &self.earlier, self.clock - back * self.apart);
            for (earlier, (axis, bits)) in self.earlier.iter_mut().zip(self.axes.iter().zip(&self.bits)) {
                *earlier -= axis.sign * (bits[0] >> (63 - back) & 1).cast_signed();
            }
        }
        for (place, axis) in place.iter_mut().zip(&self.axes) {
            *place += axis.sign * axis.pending.cast_signed();
        }
    }
}

/// A bit for each completed step of these samples, the first the lowest: 1 where an axis pulsed since the step before,
/// `pending` times before the first sample; and pulses after the last step. `None` where there is a step with more.
#[inline(always)]
fn one_a_step(pulses: u64, stepped: u64, pending: u64) -> Option<(u64, u64)> {
    if pulses == 0 {
        return Some(if stepped == 0 { (0, pending) } else { (pending, 0) });
    }
    let (step, pulse) = (stepped.trailing_zeros(), pulses.trailing_zeros() % 4);
    if step < 4 && stepped == FOURTH << step && pulses & !(FOURTH << pulse) == 0 {
        let steps = gathered(pulses >> pulse);
        return match step < pulse {
            true => Some(((steps << 1 | pending) & 0xffff, steps >> 15)),
            false => (steps & pending == 0).then_some((steps | pending, 0)),
        };
    }
    let (mut word, mut number, mut before, mut rest, mut pending) = (0, 0, 0, stepped, pending);
    while rest != 0 {
        let so_far = rest ^ (rest - 1) | before;
        pending += u64::from((pulses & so_far & !before).count_ones());
        if pending > 1 {
            return None;
        }
        word |= pending << number;
        (number, before, pending, rest) = (number + 1, so_far, 0, rest & (rest - 1));
    }
    pending += u64::from((pulses & !before).count_ones());
    (pending <= 1).then_some((word, pending))
}

/// The bits 0, 4, 8 … side by side.
#[inline(always)]
fn gathered(bits: u64) -> u64 {
    let mut bits = bits & FOURTH;
    bits = (bits | bits >> 3) & 0x0303_0303_0303_0303;
    bits = (bits | bits >> 6) & 0x000f_000f_000f_000f;
    bits = (bits | bits >> 12) & 0x0000_00ff_0000_00ff;
    (bits | bits >> 24) & 0xffff
}
