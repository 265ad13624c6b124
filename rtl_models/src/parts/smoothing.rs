//! Smoothing of displacements, period by period: a moving sum or an exponential, and the fine line that makes pulses of what
//! comes out.

use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use crate::options::Smooth;

/// The net that is 0, to which the pulses of a period are added.
pub(crate) const NONE: &str = "none";
/// The net that is the sum without the oldest.
pub(crate) const YOUNGER: &str = "younger";

/// When registers take the next displacement; 1 bit each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taking<'m> {
    /// A block is loaded, which clears them, where one does.
    pub(crate) clear: Option<Signal<'m>>,
    /// A period begins.
    pub(crate) begins: Signal<'m>,
}

impl<'m> Taking<'m> {
    /// Closes a register: cleared, or with the next value at the beginning of a period.
    pub(crate) fn close(self, m: Scope<'m>, register: Register<'m>, next: Signal<'m>) {
        let zero = |_| m.lit(register.q.bits(), 0);
        match self.clear.map(|clear| (clear, zero(clear))) {
            Some((clear, zero)) => register.when(clear, zero).when(self.begins, next).else_hold(),
            None => register.when(self.begins, next).else_hold(),
        }
    }
}

/// The bits of the registers of a filter for displacements of at most this magnitude, of either sign or not.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct FilterBits {
    /// A displacement.
    pub(crate) displacement: u32,
    /// The sum of the last k, or what is inside of an exponential.
    pub(crate) held: u32,
    /// The remainder of the sum.
    pub(crate) remainder: u32,
}

impl FilterBits {
    /// For displacements of `most` at most, in either direction.
    pub(crate) fn signed(smooth: Smooth, most: u64) -> FilterBits {
        let bits = |most: u64| Width::needed_unsigned(most.into()) + 1;
        let (held, remainder) = match smooth {
            Smooth::Sum(k) => (bits(most.saturating_mul(k)), Width::needed_unsigned(u128::from(k) - 1)),
            Smooth::Exponential(s) => (bits(most.saturating_mul((1 << s) - 1)), 0),
        };
        FilterBits { displacement: bits(most), held, remainder }
    }
}

/// The mean of the last k displacements, with its remainder: S += in - in of k periods ago, {out, rem} := (S + rem) div, mod k.
///
/// `registers` makes sum and remainder. The sum and `input` are both unsigned or both in two's complement; div and mod go towards minus infinity. |S| <= k·max|in|,
/// 0 <= rem < k. After k periods without a displacement S and rem are 0: all of it is out. Returns out, in the bits and the
/// reading of the input where these are two's complement.
pub(crate) fn moving_sum<'m>(
    m: Scope<'m>,
    registers: impl FnOnce() -> [Register<'m>; 2],
    at: Taking<'m>,
    input: Signal<'m>,
    k: u64,
) -> Signal<'m> {
    let is_signed = input.is_signed();
    let read = |signal: Signal<'m>| if is_signed { signal.as_signed() } else { signal };
    let mut oldest = input;
    for place in 0..k {
        let (name, bits) = (format!("delay{place}"), input.bits());
        let delay = if is_signed { m.reg_signed(&name, bits) } else { m.reg(&name, bits) };
        at.close(m, delay, oldest);
        oldest = delay.q;
    }
    let [sum, remainder] = registers();
    // The oldest one is in the sum.
    let wide = sum.q.bits().max(input.bits());
    let younger = read(sum.q.extend(wide).wrapping_sub(oldest.extend(wide)).slice(0, sum.q.bits()));
    let fits = m.name(YOUNGER, younger).strict_add(input, at.begins);
    at.close(m, sum, fits);
    if !is_signed {
        let bits = sum.q.bits().max(remainder.q.bits()) + 1;
        let all = m.name("all", fits.extend(bits).wrapping_add(remainder.q.extend(bits)));
        let by = m.lit(bits, k);
        at.close(m, remainder, all.rem_or_zero(by).slice(0, remainder.q.bits()));
        return m.name("out", all.div_or_zero(by));
    }
    // A dividend from 0 on: k·2^(w-1) more, which is 2^(w-1) more of the quotient, w the bits of a displacement.
    let more = 1_u64 << (input.bits() - 1);
    let most = u128::from(k) * (2 * u128::from(more) + 1);
    let bits = Width::needed_unsigned(most).max(sum.q.bits()).max(remainder.q.bits()) + 1;
    let all = fits
        .extend(bits)
        .wrapping_add(remainder.q.extend(bits).as_signed())
        .wrapping_add(m.lit(bits, k * more).as_signed());
    let (all, by) = (all.as_unsigned(), m.lit(bits, k));
    at.close(m, remainder, all.rem_or_zero(by).slice(0, remainder.q.bits()));
    let out = all.div_or_zero(by).wrapping_sub(m.lit(bits, more)).slice(0, input.bits());
    m.name("out", out.as_signed())
}

/// The share 1/2^s of what is inside, rounded away from 0: acc += in, out = acc/2^s, acc -= out.
///
/// `inside` and `input` are both unsigned or both in two's complement; |acc| <= (2^s - 1)·max|in|.
pub(crate) fn exponential<'m>(
    m: Scope<'m>,
    inside: Register<'m>,
    at: Taking<'m>,
    input: Signal<'m>,
    s: u64,
) -> Signal<'m> {
    let is_signed = input.is_signed();
    let read = |signal: Signal<'m>| if is_signed { signal.as_signed() } else { signal };
    let s = u32::try_from(s).unwrap_or(0);
    // As wide as it needs: acc holds what is left after out is taken off.
    let wide = inside.q.bits().max(input.bits()) + 1;
    let all = read(read(inside.q.extend(wide)).wrapping_add(read(input.extend(wide))));
    let bits = wide.max(s) + 1;
    let up = m.lit(bits, (1 << s) - 1);
    // Below 0 the shift rounds away from it by itself.
    let up = if is_signed { all.msb().mux(m.lit(bits, 0), up).as_signed() } else { up };
    let out = m.name("out", read(all.extend(bits).wrapping_add(up).slice(s, bits - s)));
    let change = out.bits().max(input.bits()) + 1;
    let [input, taken] = [input, out].map(|signal| read(signal.extend(change)));
    let rest = if is_signed {
        inside.q.strict_add(input.wrapping_sub(taken), at.begins)
    } else {
        let grows = !input.less_than(taken);
        let more = inside.q.strict_add(input.wrapping_sub(taken), at.begins & grows);
        let less = inside.q.strict_sub(taken.wrapping_sub(input), at.begins & !grows);
        grows.mux(more, less)
    };
    at.close(m, inside, rest);
    out
}

/// Closes the integrand of a fine line: the pulses of the next period, which must fit in it.
pub(crate) fn integrand<'m>(m: Scope<'m>, axis: Scope<'m>, jv: Register<'m>, at: Taking<'m>, pulses: Signal<'m>) {
    let none = axis.name(NONE, m.lit(jv.q.bits(), 0));
    let fits = none.strict_add(pulses, at.begins);
    at.close(m, jv, fits);
}
