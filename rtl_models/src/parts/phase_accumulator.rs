//! The phase accumulator of a step generator.

use stepwave_netlist::OnOverflow;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::Block;
use crate::per_axis;
use crate::registers::{PerAxis, Reg, Rule};

/// Rates.
pub const RATE: PerAxis = Reg::each(per_axis!("rate"), Rule::Planned("n+1+p-k"), "rate, d·2^(p-k), signed").signed();
/// Accumulators.
pub const ACC: PerAxis =
    Reg::each(per_axis!("acc"), Rule::Planned("n+1+p"), "phase accumulator, signed, from the preset").signed().preset();

/// A signed phase accumulator: every accumulation adds the rate, and a change of the picked-off bit is a step in the
/// direction of the rate.
///
/// - `rate` + axis, two's complement: held for the whole block.
/// - `acc` + axis, two's complement. What it takes must fit.
///
/// The sum is ready one clock before it is taken, so that an accumulation whose step may not be sent yet can wait.
#[derive(Clone, Copy, Debug)]
pub struct PhaseAccumulator<'m> {
    acc: Register<'m>,
    rate: Signal<'m>,
    word: Signal<'m>,
    steps: Signal<'m>,
}

impl<'m> PhaseAccumulator<'m> {
    /// The registers, of this many bits. Where the accumulator has no bit `pick_off`, its sign is picked off. The sum
    /// that is looked at ahead leaves its range as strict cells do, `on_overflow`.
    #[must_use]
    pub fn new(
        m: Scope<'m>,
        block: &Block<'m>,
        axis: usize,
        [acc_bits, rate_bits]: [u32; 2],
        pick_off: u64,
        on_overflow: OnOverflow,
    ) -> PhaseAccumulator<'m> {
        let rate = block.held_signed(m, RATE.of(axis).name(), rate_bits);
        let name = ACC.of(axis).name();
        let acc = m.reg_signed(name, acc_bits);
        let next = match on_overflow {
            OnOverflow::Saturate => acc.q.saturating_add(rate),
            OnOverflow::Trap | OnOverflow::Wrap => {
                let wide = acc_bits.max(rate_bits);
                acc.q.extend(wide).wrapping_add(rate.extend(wide)).slice(0, acc_bits)
            }
        };
        let picked = u32::try_from(pick_off).unwrap_or(u32::MAX).min(acc_bits - 1);
        let steps = next.bit(picked) ^ acc.q.bit(picked);
        PhaseAccumulator { acc, rate, word: block.word_signed(name, acc_bits), steps }
    }

    /// 1 bit: the rate is negative.
    #[must_use]
    pub fn negative(&self) -> Signal<'m> {
        self.rate.msb()
    }

    /// 1 bit: the next accumulation is a step.
    #[must_use]
    pub fn steps(&self) -> Signal<'m> {
        self.steps
    }

    /// Closes it: loaded with its word; at an edge with `accumulate` = 1 the rate is added. A load wins.
    pub fn close(self, block: &Block<'m>, accumulate: Signal<'m>) {
        let sum = self.acc.q.strict_add(self.rate, accumulate & !block.load);
        self.acc.when(block.load, self.word).when(accumulate, sum).else_hold();
    }
}
