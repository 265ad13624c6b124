//! The arithmetic unit of a coarse stage: serial components that a sequencer puts to work one after another.

use stepwave_netlist::dsl::{Scope, Signal};

use super::{Sequencer, SerialDivider, SerialMultiplier, SerialRoot};

/// Multiplier, divider and root, with the sequencer whose states give each its operands and wait for its result.
#[derive(Clone, Copy, Debug)]
pub struct ArithmeticUnit<'m> {
    /// Its states.
    pub sequence: Sequencer<'m>,
    /// Shift and add.
    pub multiplier: SerialMultiplier<'m>,
    /// Restoring.
    pub divider: SerialDivider<'m>,
    /// Restoring.
    pub root: SerialRoot<'m>,
}

impl<'m> ArithmeticUnit<'m> {
    /// The registers, with the numbers and names of the states: for factors, for a dividend and a divisor, and for a root
    /// of so many bits.
    #[must_use]
    pub fn new(
        m: Scope<'m>,
        states: &[(u64, &str)],
        [a, b]: [u32; 2],
        [dividend, divisor]: [u32; 2],
        root: u32,
    ) -> ArithmeticUnit<'m> {
        ArithmeticUnit {
            sequence: Sequencer::new(m, states),
            multiplier: SerialMultiplier::new(m, a, b),
            divider: SerialDivider::new(m, dividend, divisor),
            root: SerialRoot::new(m, root),
        }
    }

    /// 1 bit: the first clock of this state.
    #[must_use]
    pub fn begins(&self, state: u64) -> Signal<'m> {
        self.sequence.begins(state)
    }

    /// 1 bit: the product of this state stands.
    #[must_use]
    pub fn multiplied(&self, state: u64) -> Signal<'m> {
        self.sequence.ends(state, self.multiplier.running())
    }

    /// 1 bit: the quotient of this state stands.
    #[must_use]
    pub fn divided(&self, state: u64) -> Signal<'m> {
        self.sequence.ends(state, self.divider.running())
    }

    /// 1 bit: the root of this state stands.
    #[must_use]
    pub fn rooted(&self, state: u64) -> Signal<'m> {
        self.sequence.ends(state, self.root.running())
    }
}
