//! Acceleration after the interpolator of a machine: what the pulses of every axis go through on their way to its drive.
//!
//! ```text
//!   sample_clock ──► end of the period;  spread ──► 2^n additions a period
//!   pulse of an axis ──► count ──► moving sum, or exponential ──► fv ──► + ──► fr ──► carry: pulse ──► position
//! ```

use stepwave_nc::AXES_MAX;
use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::axis::{position_counter, signed};
use super::smoothing::{FilterBits, Taking, exponential, integrand, moving_sum};
use super::{fine_line, magnitude, up_down_counter};
use crate::hardware::Hardware;
use crate::options::Smooth;
use crate::program::After;
use crate::registers::{AXES, Reg, Rule};

/// The next block begins only after the filters are empty.
pub const SETTLE: Reg = Reg::new("settle", Rule::Bits(1), "the block begins only after the filters are empty");

/// The sampling period of a machine, and the filters of its axes.
///
/// - `sample_clock`: clock of the period, from 0 to C - 1, whatever the machine does. `ends`, 1 bit: the last one.
/// - `spread`: every clock adds 2^n, and C is taken away at each addition of the fine lines, of which a period has 2^n, the last
///   at its last clock. A period has at most (C+1)/2 pulses of an axis, and n bits hold them.
/// - `quiet` (of moving sums), up to k: periods without a pulse of any axis, up to now.
/// - `empty`, 1 bit: every pulse of the interpolator has come out.
#[derive(Clone, Copy, Debug)]
pub struct Period<'m> {
    empty: Signal<'m>,
    axes: [Option<AxisAfter<'m>>; AXES_MAX],
}

/// What the pulses of one axis go through; the scope of the first is `after_x`.
///
/// - `countx`, two's complement: pulses of the interpolator in this period, up to now.
/// - `sumx`, `remx` or `insidex`: the filter, in the scope `moving_sum` or `exponential`.
/// - `fvx`, n bits, `fsx`, 1 bit: pulses of this period, and their direction. `frx`, n bits: remainder of the fine line, 0 between
///   two periods.
/// - `dx_out`, `x_out`: the signed pulse and the position that go to the drive, as `dx` and `x` are those of the interpolator.
#[derive(Clone, Copy, Debug)]
pub struct AxisAfter<'m> {
    m: Scope<'m>,
    letter: &'static str,
    ends: Signal<'m>,
    count: Register<'m>,
    pulse: Signal<'m>,
    negative: Signal<'m>,
}

impl<'m> Period<'m> {
    /// The hardware, if the machine has its acceleration there; the counters of the axes are closed by
    /// [`AxisAfter::close`].
    pub(crate) fn new(top: Scope<'m>, hardware: &Hardware) -> Option<Period<'m>> {
        let by = After::of(hardware)?;
        let m = top.scope("period");
        let clock_bits = Width::needed_unsigned(u128::from(by.period) - 1);
        let clock = m.reg("sample_clock", clock_bits);
        let ends = m.name("ends", clock.q.equals(m.lit(clock_bits, by.period - 1)));
        let (zero, next) = (m.lit(clock_bits, 0), clock.q.wrapping_add(m.lit(clock_bits, 1)));
        clock.when(ends, zero).otherwise(next);
        let tick = spread(m, by);

        let mut axes = [None; AXES_MAX];
        let (mut still, mut quiet) = (Vec::new(), Vec::new());
        for (index, axis) in axes.iter_mut().enumerate().take(hardware.axes) {
            let (of, rests) = AxisAfter::new(top, by, index, [ends, tick]);
            *axis = Some(of);
            quiet.push(of.count.q.is_zero());
            still.extend(rests);
        }
        let all = |signals: Vec<Signal<'m>>| signals.into_iter().reduce(|a, b| a & b).unwrap_or_else(|| m.lit(1, 1));
        let quiet = all(quiet);
        let still = all(still);
        let emptied = match by.smooth {
            Smooth::Sum(k) => periods_without(m, k, ends, quiet),
            Smooth::Exponential(_) => m.lit(1, 1),
        };
        Some(Period { empty: m.name("empty", quiet & still & emptied), axes })
    }

    /// 1 bit: every pulse of the interpolator has come out.
    pub(crate) fn empty(&self) -> Signal<'m> {
        self.empty
    }

    /// That of an axis.
    pub(crate) fn axis(&self, axis: usize) -> Option<AxisAfter<'m>> {
        self.axes.get(axis).copied().flatten()
    }
}

/// 1 bit: an addition of the fine lines at this edge, 2^n of them in every period.
fn spread(m: Scope<'_>, by: After) -> Signal<'_> {
    let bits = Width::needed_unsigned(u128::from(by.period) - 1 + (1 << by.bits()));
    let spread = m.reg("spread", bits);
    let sum = spread.q.wrapping_add(m.lit(bits, 1 << by.bits()));
    let all = m.lit(bits, by.period);
    // Without a name, as a wave would show its change at nearly every clock.
    let tick = !sum.less_than(all);
    spread.when(tick, sum.wrapping_sub(all)).otherwise(sum);
    tick
}

/// 1 bit: k periods or more, up to now, have had no pulse (`quiet`, 1 bit: none in the present one).
fn periods_without<'m>(m: Scope<'m>, k: u64, ends: Signal<'m>, quiet: Signal<'m>) -> Signal<'m> {
    let bits = Width::needed_unsigned(k.into());
    let periods = m.reg("quiet", bits).reset(k);
    let enough = periods.q.equals(m.lit(bits, k));
    let (zero, more) = (m.lit(bits, 0), periods.q.wrapping_add(m.lit(bits, 1)));
    periods.when(ends & !quiet, zero).when(ends & !enough, more).else_hold();
    enough
}

impl<'m> AxisAfter<'m> {
    /// The filter and the fine line; and, 1 bit each, what is 1 where nothing is in them.
    fn new(top: Scope<'m>, by: After, axis: usize, [ends, tick]: [Signal<'m>; 2]) -> (AxisAfter<'m>, Vec<Signal<'m>>) {
        let letter = AXES[axis];
        let m = top.scope(&format!("after_{letter}"));
        let bits = FilterBits::signed(by.smooth, by.most());
        let count = m.reg_signed(&format!("count{letter}"), bits.displacement);
        let at = Taking { clear: None, begins: ends };
        let mut still = Vec::new();
        let out = match by.smooth {
            Smooth::Sum(k) => {
                let m = m.scope("moving_sum");
                let sum = || m.reg_signed(&format!("sum{letter}"), bits.held);
                let remainder = || m.reg(&format!("rem{letter}"), bits.remainder);
                moving_sum(m, || [sum(), remainder()], at, count.q, k)
            }
            Smooth::Exponential(s) => {
                let m = m.scope("exponential");
                let inside = m.reg_signed(&format!("inside{letter}"), bits.held);
                still.push(inside.q.is_zero());
                exponential(m, inside, at, count.q, s)
            }
        };
        let [jv, jr] = ["fv", "fr"].map(|name| m.reg(&format!("{name}{letter}"), by.bits()));
        integrand(m, m, jv, at, magnitude(m, out));
        let sign = m.reg(&format!("fs{letter}"), 1);
        sign.when(ends, out.msb()).else_hold();
        let rests = jv.q.is_zero();
        still.push(rests);
        let pulse = fine_line(m, jr, jv.q, tick & !rests);
        (AxisAfter { m, letter, ends, count, pulse, negative: sign.q }, still)
    }

    /// Closes the counter of its pulses, and the position after the filter: `given` are the pulse of the interpolator and its
    /// direction, `preset` says when the position of `bits` bits is preset, and what with.
    pub(crate) fn close(self, given: [Signal<'m>; 2], bits: u32, [load, preset]: [Signal<'m>; 2]) {
        let AxisAfter { m, letter, ends, count, pulse, negative } = self;
        let [given, backward] = given;
        // The pulse of the last clock is the first of the next period.
        let first = signed(given, backward).extend(count.q.bits());
        up_down_counter(count, &[(ends, first)], given & !backward, given & backward, m.lit_signed(2, 1));
        let names = [&*format!("d{letter}_out"), &format!("{letter}_out")];
        position_counter(m, names, bits, [pulse, negative], load, || preset);
    }
}
