//! Registers and their next-value chains.

use super::Signal;
use crate::cells::{Format, Op, Source};
use crate::diag::{Code, Place};

/// A clocked register. Its output is `q`; a chain of [`when`](Register::when)s says what it takes at the edge.
#[derive(Clone, Copy, Debug)]
#[must_use = "a register needs a next value"]
pub struct Register<'m> {
    /// The value held since the last edge.
    pub q: Signal<'m>,
}

impl<'m> Register<'m> {
    /// At an edge where `condition` (1 bit) is 1 the register takes `value`. Of several conditions the first wins.
    pub fn when(self, condition: Signal<'m>, value: Signal<'m>) -> Chain<'m> {
        Chain { register: self, arms: vec![(condition, value)] }
    }

    /// The register takes `value` at every edge.
    #[track_caller]
    pub fn set(self, value: Signal<'m>) {
        let module = self.q.scope().module;
        let net = self.q.net();
        let mut cell = module.state.borrow().netlist.cell(net);
        let Op::Register { next, reset } = cell.op else { return };
        if next.is_some() {
            let name = module.state.borrow().netlist.describe(net);
            let first =
                module.state.borrow().driven.get(&net).map_or_else(String::new, |at| format!(", given at {at}"));
            module.report(Code::DrivenTwice, format!("register {name} has a next value already{first}"));
            return;
        }
        module.state.borrow_mut().driven.insert(net, Place::Source(Source::here()));
        let value = self.q.own(value);
        cell.op = Op::Register { next: Some(value.net()), reset };
        let checked = module.state.borrow().netlist.check_cell(&cell);
        if let Err((code, message)) = checked {
            if !value.is_guess() {
                let name = module.state.borrow().netlist.describe(net);
                module.report(code, format!("next value of register {name}: {message}"));
            }
            // Closed with its own value, so that the same mistake is not reported as a missing value too.
            cell.op = Op::Register { next: Some(net), reset };
        }
        module.state.borrow_mut().netlist.cells[net.index()] = cell;
    }

    /// Shown in this format instead of that of its reading.
    pub fn shown(self, format: Format) -> Register<'m> {
        let mut state = self.q.scope().module.state.borrow_mut();
        if let Some(named) = state.netlist.names.iter_mut().find(|named| named.net == self.q.net()) {
            named.format = format;
        }
        self
    }

    /// Value before the first edge, instead of 0.
    #[track_caller]
    pub fn reset(self, value: u64) -> Register<'m> {
        let module = self.q.scope().module;
        let net = self.q.net();
        let mut cell = module.state.borrow().netlist.cell(net);
        if let Op::Register { next, .. } = cell.op {
            cell.op = Op::Register { next, reset: value };
            let checked = module.state.borrow().netlist.check_cell(&cell);
            match checked {
                Ok(()) => module.state.borrow_mut().netlist.cells[net.index()] = cell,
                Err((code, message)) => module.report(code, message),
            }
        }
        self
    }
}

/// A next-value chain; ended by [`else_hold`](Chain::else_hold) or [`otherwise`](Chain::otherwise).
#[derive(Debug)]
#[must_use = "end the chain with else_hold or otherwise"]
pub struct Chain<'m> {
    register: Register<'m>,
    arms: Vec<(Signal<'m>, Signal<'m>)>,
}

impl<'m> Chain<'m> {
    /// A further arm, taken where no earlier condition is 1.
    pub fn when(mut self, condition: Signal<'m>, value: Signal<'m>) -> Chain<'m> {
        self.arms.push((condition, value));
        self
    }

    /// Where no condition is 1 the register keeps its value.
    #[track_caller]
    pub fn else_hold(self) {
        let hold = self.register.q;
        self.otherwise(hold);
    }

    /// Where no condition is 1 the register takes `value`.
    #[track_caller]
    pub fn otherwise(self, value: Signal<'m>) {
        let q = self.register.q;
        let mut next = q.own(value);
        for (condition, value) in self.arms.into_iter().rev() {
            next = q.own(condition).mux(q.own(value), next);
        }
        self.register.set(next);
    }
}
