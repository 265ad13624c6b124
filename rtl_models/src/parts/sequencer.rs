//! The control sequence of a unit that works in several steps, and the choice among its operands.

use stepwave_netlist::Width;
use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

/// A state register whose states are steps of a calculation, 0 the idle one. In the first clock of a state its component
/// takes its operands; in those behind it the state waits for the result.
///
/// - `state`: as many bits as the states need. `waits`, 1 bit: the state has been for a clock or more.
#[derive(Clone, Copy, Debug)]
pub struct Sequencer<'m> {
    m: Scope<'m>,
    state: Register<'m>,
    waits: Register<'m>,
}

impl<'m> Sequencer<'m> {
    /// The registers, with the numbers and names of the states.
    #[must_use]
    pub fn new(m: Scope<'m>, states: &[(u64, &str)]) -> Sequencer<'m> {
        let bits = Width::needed_unsigned(states.iter().map(|(value, _)| u128::from(*value)).max().unwrap_or(0));
        let states = states.iter().map(|(value, name)| (*value, (*name).to_owned())).collect();
        let state = m.reg("state", bits).shown(Format::States(states));
        Sequencer { m, state, waits: m.reg("waits", 1) }
    }

    /// 1 bit: it is in this state.
    #[must_use]
    pub fn at(&self, state: u64) -> Signal<'m> {
        self.state.q.equals(self.m.lit(self.state.q.bits(), state))
    }

    /// 1 bit: the first clock of this state.
    #[must_use]
    pub fn begins(&self, state: u64) -> Signal<'m> {
        self.at(state) & !self.waits.q
    }

    /// 1 bit: the result of this state stands, where `running` (1 bit) tells that its component still works.
    #[must_use]
    pub fn ends(&self, state: u64, running: Signal<'m>) -> Signal<'m> {
        self.at(state) & self.waits.q & !running
    }

    /// Closes it: `load` leads to state 1; at an edge where a condition (1 bit) is 1 it goes on to that state.
    pub fn close(self, load: Signal<'m>, moves: &[(Signal<'m>, u64)]) {
        let literal = |state| self.m.lit(self.state.q.bits(), state);
        let mut next = self.state.when(load, literal(1));
        for &(condition, state) in moves {
            next = next.when(condition, literal(state));
        }
        next.else_hold();
        let moves = moves.iter().fold(load, |any, (condition, _)| any | *condition);
        self.waits.set(self.state.q.is_nonzero() & !moves);
    }
}

/// That any of the conditions is 1 (1 bit), and the value that stands beside it, extended to `bits` bits; 0 where none is.
#[must_use]
pub(super) fn operand<'m>(m: Scope<'m>, bits: u32, values: &[(Signal<'m>, Signal<'m>)]) -> (Signal<'m>, Signal<'m>) {
    values.iter().fold((m.lit(1, 0), m.lit(bits, 0)), |(any, value), &(condition, own)| {
        (any | condition, condition.mux(own.extend(bits), value))
    })
}
