//! Two waves laid over one another: a common axis of positions, and the changes of each signal along it.

use super::{By, CompareError, Lengths, Moment};
use crate::read::{Clock, Signal, Timescale, Value, Wave};
use std::iter::Peekable;
use std::ops::Range;

/// A wave on the common axis: clock cycles of side A, or times in a unit that divides both units.
pub(crate) struct Frame<'w> {
    pub(crate) wave: &'w Wave,
    axis: Axis<'w>,
}

enum Axis<'w> {
    Cycles { clock: &'w Clock, shift: i128 },
    Times { scale: i128 },
}

/// Both waves and what they share.
pub(crate) struct Frames<'w> {
    pub(crate) a: Frame<'w>,
    pub(crate) b: Frame<'w>,
    /// The positions at which both have a value.
    pub(crate) common: Range<i128>,
    /// Whether the positions are times.
    pub(crate) by_time: bool,
    /// The unit of the positions if they are times, and if the files name one.
    pub(crate) unit: Option<Timescale>,
    /// Set if one side lasts longer.
    pub(crate) lengths: Option<Lengths>,
}

impl<'w> Frames<'w> {
    pub(crate) fn new(a: &'w Wave, b: &'w Wave, by: By) -> Result<Self, CompareError> {
        match by {
            By::Clock { offset } => Self::by_clock(a, b, offset),
            By::Time => Self::by_time(a, b),
        }
    }

    fn by_clock(a: &'w Wave, b: &'w Wave, offset: i64) -> Result<Self, CompareError> {
        let shift = -i128::from(offset);
        let (cycles_a, cycles_b) = (a.cycles()?, b.cycles()?);
        let end_b = i128::from(cycles_b) + shift;
        let common = shift.max(0)..end_b.min(cycles_a.into());
        if common.is_empty() {
            return Err(CompareError::NoOverlap { offset, a: cycles_a, b: cycles_b });
        }
        // With an offset, waves of one length end apart, and waves that end together differ in length.
        let even = cycles_a == cycles_b || end_b == cycles_a.into();
        let lengths = (!even).then_some(Lengths { a: Moment::Clock(cycles_a), b: Moment::Clock(cycles_b) });
        let a = Frame { wave: a, axis: Axis::Cycles { clock: a.clock()?, shift: 0 } };
        let b = Frame { wave: b, axis: Axis::Cycles { clock: b.clock()?, shift } };
        Ok(Self { a, b, common, by_time: false, unit: None, lengths })
    }

    fn by_time(a: &'w Wave, b: &'w Wave) -> Result<Self, CompareError> {
        let (unit, [step_a, step_b]) = match (a.timescale(), b.timescale()) {
            (Some(scale_a), Some(scale_b)) => {
                let (unit, steps) = common_unit(scale_a, scale_b)?;
                (Some(unit), steps)
            }
            (None, None) => (None, [1, 1]),
            // Any unit would be a guess.
            (Some(unit), None) => return Err(CompareError::no_timescale(b, a, unit)),
            (None, Some(unit)) => return Err(CompareError::no_timescale(a, b, unit)),
        };
        let ends = |wave: &Wave, step: i128| {
            let at = |time: Option<&u64>| step.checked_mul(time.copied().unwrap_or(0).into());
            at(wave.times().first()).zip(at(wave.times().last())).ok_or(CompareError::TimeRange)
        };
        let ((first_a, last_a), (first_b, last_b)) = (ends(a, step_a)?, ends(b, step_b)?);
        let lengths =
            (last_a != last_b).then(|| Lengths { a: Moment::time(last_a, unit), b: Moment::time(last_b, unit) });
        let a = Frame { wave: a, axis: Axis::Times { scale: step_a } };
        let b = Frame { wave: b, axis: Axis::Times { scale: step_b } };
        let common = first_a.min(first_b)..last_a.min(last_b).saturating_add(1);
        Ok(Self { a, b, common, by_time: true, unit, lengths })
    }

    /// A position in the words of the report.
    pub(crate) fn moment(&self, position: i128) -> Moment {
        if self.by_time {
            Moment::time(position, self.unit)
        } else {
            Moment::Clock(u64::try_from(position).unwrap_or(0))
        }
    }

    /// The first common position at which the two signals do not have the same value.
    pub(crate) fn first_difference(&self, a: &'w Signal, b: &'w Signal) -> Option<i128> {
        let (mut a, mut b) = (self.a.walk(a), self.b.walk(b));
        let mut position = self.common.start;
        while position < self.common.end {
            if !a.value_at(position).same(b.value_at(position)) {
                return Some(position);
            }
            position = a.next_change().into_iter().chain(b.next_change()).min()?;
        }
        None
    }
}

/// The coarsest unit that divides both time scales, and the number of these units in each.
fn common_unit(a: Timescale, b: Timescale) -> Result<(Timescale, [i128; 2]), CompareError> {
    let exponent = a.exponent.min(b.exponent);
    let whole = |scale: Timescale| {
        let ten = 10i128.checked_pow(scale.exponent.abs_diff(exponent).into());
        ten.and_then(|ten| ten.checked_mul(scale.factor.into())).ok_or(CompareError::TimeRange)
    };
    let steps = [whole(a)?, whole(b)?];
    let divides = |factor: &u32| steps.iter().all(|step| step % i128::from(*factor) == 0);
    let unit = Timescale { factor: [100, 10].into_iter().find(divides).unwrap_or(1), exponent };
    Ok((unit, steps.map(|step| step / i128::from(unit.factor))))
}

impl<'w> Frame<'w> {
    fn position(&self, time_index: u32) -> i128 {
        match &self.axis {
            Axis::Cycles { clock, shift } => i128::from(clock.cycle_of(time_index)) + shift,
            Axis::Times { scale } => i128::from(self.wave.times()[time_index as usize]) * scale,
        }
    }

    /// The wave in its own times, unscaled.
    pub(crate) fn raw(wave: &'w Wave) -> Self {
        Self { wave, axis: Axis::Times { scale: 1 } }
    }

    /// The position of the last time of the wave; 0 if it has none.
    pub(crate) fn last_position(&self) -> i128 {
        let last = self.wave.times().len().checked_sub(1);
        last.and_then(|last| u32::try_from(last).ok()).map_or(0, |last| self.position(last))
    }

    /// The value at a position, independent of any walk.
    pub(crate) fn value_at(&self, signal: &Signal, position: i128) -> Value<'w> {
        self.wave.value_before(signal, |time| self.position(time) <= position)
    }

    /// Whether this is the clock that makes the axis, or another name of it.
    pub(crate) fn is_clock(&self, signal: &Signal) -> bool {
        match &self.axis {
            Axis::Cycles { clock, .. } => self.wave.signals()[clock.signal()].stored == signal.stored,
            Axis::Times { .. } => false,
        }
    }

    /// The time, in units of the wave, at which a position begins; nothing outside the wave.
    pub(crate) fn time_of(&self, position: i128) -> Option<u64> {
        match &self.axis {
            Axis::Cycles { clock, shift } => {
                let index = match usize::try_from(position - shift).ok()? {
                    0 => 0,
                    cycle => *clock.edges().get(cycle - 1)? as usize,
                };
                self.wave.times().get(index).copied()
            }
            Axis::Times { scale } => u64::try_from(position / scale).ok(),
        }
    }

    /// The positions at which the signal's sample may change, increasing, each with the number of the change that
    /// counts.
    pub(crate) fn changes<'f>(&'f self, signal: &Signal) -> Changes<'f, 'w> {
        Changes { frame: self, times: self.wave.change_times(signal), next: 0 }
    }

    /// The signal's value, to be followed along the axis.
    pub(crate) fn walk<'f>(&'f self, signal: &'w Signal) -> Walk<'f, 'w> {
        Walk { wave: self.wave, signal, value: signal.first_value(), changes: self.changes(signal).peekable() }
    }
}

/// See [`Frame::changes`].
pub(crate) struct Changes<'f, 'w> {
    frame: &'f Frame<'w>,
    times: &'w [u32],
    next: usize,
}

impl Iterator for Changes<'_, '_> {
    type Item = (i128, usize);

    fn next(&mut self) -> Option<(i128, usize)> {
        let position = self.frame.position(*self.times.get(self.next)?);
        while self.times.get(self.next + 1).is_some_and(|time| self.frame.position(*time) == position) {
            self.next += 1;
        }
        self.next += 1;
        Some((position, self.next - 1))
    }
}

/// See [`Frame::walk`].
pub(crate) struct Walk<'f, 'w> {
    wave: &'w Wave,
    signal: &'w Signal,
    value: Value<'w>,
    changes: Peekable<Changes<'f, 'w>>,
}

impl<'w> Walk<'_, 'w> {
    /// The value at this position, which must not be before that of an earlier call.
    pub(crate) fn value_at(&mut self, position: i128) -> Value<'w> {
        let mut last = None;
        while let Some((_, change)) = self.changes.next_if(|(at, _)| *at <= position) {
            last = Some(change);
        }
        if let Some(change) = last {
            self.value = self.wave.value(self.signal, change);
        }
        self.value
    }

    /// The position of the next change.
    pub(crate) fn next_change(&mut self) -> Option<i128> {
        self.changes.peek().map(|(position, _)| *position)
    }
}
