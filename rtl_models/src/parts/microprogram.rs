//! A microprogram: the states of a calculation as a table, and the serial components that they put to work.

use std::collections::HashSet;

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{Long, SerialDivider, SerialMultiplier, SerialRoot};
use crate::registers::{Reg, Rule};

/// The step of a calculation.
pub const STATE: Reg = Reg::new("state", Rule::Bits(STATE_BITS), "step of the coarse calculation").hidden();
/// Bits of the state register.
const STATE_BITS: u32 = 4;

/// A state: its number in the register `state`, and its name in waves. 0 is the idle one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct State {
    /// As many as the register has bits for.
    pub number: u64,
    /// In capitals.
    pub name: &'static str,
}

/// A module of states: `states! { mod at { IDLE = 0, ROOT = 1 } }`.
macro_rules! states {
    (mod $module:ident { $($name:ident = $number:literal),* $(,)? }) => {
        mod $module {
            $(pub(super) const $name: $crate::parts::State =
                $crate::parts::State { number: $number, name: stringify!($name) };)*
        }
    };
}
pub(crate) use states;

/// What a state does; its result is valid at the edge that ends it. The first clock of a serial calculation takes the
/// operands, which are extended to the width of the component.
#[derive(Clone, Copy, Debug)]
pub enum Task<'m> {
    /// Multiplicand and multiplier.
    Multiply(Long<'m>, Long<'m>),
    /// Dividend and divisor.
    Divide(Long<'m>, Long<'m>),
    /// Radicand.
    Root(Long<'m>),
    /// Nothing, until this is 1 (1 bit).
    Wait(Signal<'m>),
    /// Nothing. At an edge with 1 (1 bit) the row applies in every state.
    Start(Signal<'m>),
}

/// Multiplies these.
pub fn multiply<'m>(a: impl Into<Long<'m>>, b: impl Into<Long<'m>>) -> Task<'m> {
    Task::Multiply(a.into(), b.into())
}

/// Divides the first by the second.
pub fn divide<'m>(dividend: impl Into<Long<'m>>, divisor: impl Into<Long<'m>>) -> Task<'m> {
    Task::Divide(dividend.into(), divisor.into())
}

/// Takes the root of this.
pub fn square_root<'m>(radicand: impl Into<Long<'m>>) -> Task<'m> {
    Task::Root(radicand.into())
}

/// A register and the value that it takes.
pub(super) type Write<'m> = (Register<'m>, Signal<'m>);

/// One row of a microprogram.
#[derive(Clone, Debug)]
pub struct Row<'m> {
    state: State,
    task: Task<'m>,
    /// At the edge that begins the task.
    first: Vec<Write<'m>>,
    /// At the edge that ends the state.
    last: Vec<Write<'m>>,
    next: State,
    /// The state after it where the signal (1 bit) is 1; the first that is counts.
    exits: Vec<(Signal<'m>, State)>,
}

/// A row: the state, its task, the registers that take a result at its end, and the state after it.
#[must_use]
pub fn row<'m, const N: usize>(state: State, task: Task<'m>, last: [Write<'m>; N], next: State) -> Row<'m> {
    Row { state, task, first: Vec::new(), last: last.to_vec(), next, exits: Vec::new() }
}

/// Rows that leave a² + b² of two magnitudes in the register `square`, twice as wide: both states, and the one after them.
#[must_use]
pub fn squares<'m>(
    program: &Microprogram<'m>,
    square: Register<'m>,
    [a, b]: [Signal<'m>; 2],
    [first, second, next]: [State; 3],
) -> [Row<'m>; 2] {
    let product = program.multiplier.product().slice(0, square.q.bits());
    let sum = square.q.wrapping_add(product);
    [row(first, multiply(a, a), [(square, product)], second), row(second, multiply(b, b), [(square, sum)], next)]
}

impl<'m> Row<'m> {
    /// Registers that take a value as soon as the task takes its operands.
    #[must_use]
    pub fn keeping<const N: usize>(self, first: [Write<'m>; N]) -> Row<'m> {
        Row { first: first.to_vec(), ..self }
    }

    /// Further registers that become 0 at the end of the state.
    #[must_use]
    pub fn clearing(mut self, m: Scope<'m>, registers: &[Register<'m>]) -> Row<'m> {
        self.last.extend(registers.iter().map(|&register| (register, m.lit(register.q.bits(), 0))));
        self
    }

    /// Further registers that take a value at the end of the state.
    #[must_use]
    pub fn taking(mut self, last: impl IntoIterator<Item = Write<'m>>) -> Row<'m> {
        self.last.extend(last);
        self
    }

    /// Where the condition (1 bit) is 1 at the end of the state, and none given before it, another state comes after it.
    #[must_use]
    pub fn unless(mut self, condition: Signal<'m>, state: State) -> Row<'m> {
        self.exits.push((condition, state));
        self
    }
}

/// Multiplier, divider and root, and the state register that gives each its operands and waits for its result.
///
/// - `state`, 4 bits or as many as given. `waits`, 1 bit: the state has lasted for a clock or more.
#[derive(Clone, Copy, Debug)]
pub struct Microprogram<'m> {
    /// Where it is.
    pub m: Scope<'m>,
    state: Register<'m>,
    waits: Register<'m>,
    /// Shift and add.
    pub multiplier: SerialMultiplier<'m>,
    /// Restoring.
    pub divider: SerialDivider<'m>,
    /// Restoring.
    pub root: SerialRoot<'m>,
}

impl<'m> Microprogram<'m> {
    /// The registers, for factors of `a` and `b` bits, for a dividend and a divisor, and for a root of these bits.
    #[must_use]
    pub fn new(m: Scope<'m>, factors: [u32; 2], division: [u32; 2], root: u32) -> Microprogram<'m> {
        Microprogram::of_states(m, STATE_BITS, factors, division, root)
    }

    /// The same with a state register of this many bits.
    #[must_use]
    pub fn of_states(
        m: Scope<'m>,
        bits: u32,
        [a, b]: [u32; 2],
        [dividend, divisor]: [u32; 2],
        root: u32,
    ) -> Microprogram<'m> {
        Microprogram {
            m,
            state: m.reg(STATE.name(), bits),
            waits: m.reg("waits", 1),
            multiplier: SerialMultiplier::new(m, a, b),
            divider: SerialDivider::new(m, dividend, divisor),
            root: SerialRoot::new(m, root),
        }
    }

    /// 1 bit: it is in this state.
    #[must_use]
    pub fn at(&self, state: State) -> Signal<'m> {
        self.state.q.equals(self.number(state))
    }

    fn number(&self, state: State) -> Signal<'m> {
        self.m.lit(self.state.q.bits(), state.number)
    }

    /// Wires what the rows say: the operands, the state, and every register that a row writes. The row that starts is
    /// the first.
    pub fn close(self, rows: &[Row<'m>]) {
        let mut states: Vec<_> = rows.iter().map(|row| (row.state.number, row.state.name.to_owned())).collect();
        states.sort();
        let state = self.state.shown(Format::States(states));

        let (mut products, mut quotients, mut roots) = (Vec::new(), Vec::new(), Vec::new());
        let (mut writes, mut moves) = (Vec::new(), self.m.lit(1, 0));
        for row in rows {
            let at = self.at(row.state);
            let begins = at & !self.waits.q;
            let after = |running: Signal<'m>| at & self.waits.q & !running;
            let ends = match row.task {
                Task::Multiply(a, b) => {
                    products.push((begins, a, b));
                    after(self.multiplier.running())
                }
                Task::Divide(dividend, divisor) => {
                    quotients.push((begins, dividend, divisor));
                    after(self.divider.running())
                }
                Task::Root(radicand) => {
                    roots.push((begins, radicand));
                    after(self.root.running())
                }
                Task::Wait(ready) => at & ready,
                Task::Start(start) => start,
            };
            let next = self.number(row.next);
            let exits = row.exits.iter().rev();
            let next = exits.fold(next, |next, &(condition, state)| condition.mux(self.number(state), next));
            moves = moves | ends;
            writes.extend(row.first.iter().map(|&write| (begins, write)));
            writes.extend(row.last.iter().chain(&[(state, next)]).map(|&write| (ends, write)));
        }
        self.multiplier.close(&products);
        self.divider.close(&quotients);
        self.root.close(&roots);
        close_registers(&writes);
        self.waits.set(state.q.is_nonzero() & !moves);
    }
}

/// Gives every register its next value: of the writes whose condition (1 bit) is 1 the first wins.
fn close_registers<'m>(writes: &[(Signal<'m>, Write<'m>)]) {
    let mut closed = HashSet::new();
    for &(condition, (register, value)) in writes {
        if !closed.insert(register.q.net()) {
            continue;
        }
        let all = writes.iter().filter(|(_, (other, _))| other.q.net() == register.q.net());
        let chain = register.when(condition, value);
        all.skip(1).fold(chain, |chain, &(condition, (_, value))| chain.when(condition, value)).else_hold();
    }
}

/// That any of the conditions is 1 (1 bit), and its value, extended to `bits` bits; 0 where none is.
#[must_use]
pub(super) fn operand<'m>(m: Scope<'m>, bits: u32, values: &[(Signal<'m>, Long<'m>)]) -> (Signal<'m>, Long<'m>) {
    values.iter().fold((m.lit(1, 0), Long::zero(m, bits)), |(any, value), &(condition, own)| {
        (any | condition, Long::select(condition, own.extend(m, bits), value))
    })
}
