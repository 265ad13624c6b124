//! Which value is in which register: instructions in their order, each value loaded where it is first used and kept as
//! long as there is room; what is used again farthest ahead makes room.

use super::assembler::{Assembler, Operand, Register};
use super::flow::{Flow, Maker, Value};

const REGISTERS: u8 = 16;

/// What is to be done in one sample, in this order.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    Make(Value),
    /// Leaves where the value has a bit in common with a cell.
    Leave(Value, usize),
    /// A cell takes a value; nobody needs what was there.
    Store(Value, usize),
}

/// Within this many steps a value is used again soon.
const SOON: usize = 16;

pub(super) struct Placing<'f> {
    flow: &'f mut Flow,
    pub(super) assembler: Assembler,
    /// Steps in which each value is used, the next one last.
    uses: Vec<Vec<usize>>,
    /// Where each value is.
    register: Vec<Option<Register>>,
    cell: Vec<Option<usize>>,
    holds: [Option<Value>; REGISTERS as usize],
}

impl<'f> Placing<'f> {
    pub(super) fn new(flow: &'f mut Flow, steps: &[Step]) -> Placing<'f> {
        let mut uses = vec![Vec::new(); flow.makers.len()];
        for (index, step) in steps.iter().enumerate().rev() {
            match *step {
                Step::Make(value) => flow.makers[value].operands().for_each(|operand| uses[operand].push(index)),
                Step::Leave(value, _) | Step::Store(value, _) => uses[value].push(index),
            }
        }
        let own = |maker: &Maker| if let Maker::Cell(cell) = maker { Some(*cell) } else { None };
        let cell = flow.makers.iter().map(own).collect();
        let (register, holds) = (vec![None; flow.makers.len()], [None; REGISTERS as usize]);
        Placing { flow, assembler: Assembler::new(), uses, register, cell, holds }
    }

    pub(super) fn step(&mut self, step: Step) {
        match step {
            Step::Make(value) => self.make(value),
            Step::Leave(value, cell) => {
                let a = self.in_register(value, &[]);
                self.assembler.leave_if(a, Operand::Cell(cell));
                self.used(value);
            }
            Step::Store(value, cell) => {
                let a = self.in_register(value, &[]);
                self.assembler.store(a, cell);
                // From here on it is there too.
                self.cell[value] = Some(cell);
                self.used(value);
            }
        }
    }

    fn make(&mut self, value: Value) {
        match self.flow.makers[value] {
            Maker::Cell(_) => {}
            Maker::One(opcode, a) => {
                let from = self.operand(a, &[]);
                self.used(a);
                let target = self.room(&[]);
                self.assembler.one(opcode, target, from);
                self.put(value, target);
            }
            Maker::Two(opcode, a, b) => {
                let swap = opcode.commutes && self.register[a].is_none() && self.register[b].is_some();
                let (a, b) = if swap { (b, a) } else { (a, b) };
                let first = self.in_register(a, &[b]);
                let second = self.operand(b, &[a]);
                self.used(a);
                self.used(b);
                let target = self.room(&[]);
                self.assembler.two(opcode, target, first, second);
                self.put(value, target);
            }
            Maker::Shift(shift, a, by) => {
                let from = self.in_register(a, &[]);
                self.used(a);
                let target = self.room(&[]);
                self.assembler.shift(shift, target, from, by);
                self.put(value, target);
            }
            Maker::Blend(condition, high, low) => {
                let chosen = self.in_register(condition, &[high, low]);
                let below = self.in_register(low, &[condition, high]);
                let above = self.operand(high, &[condition, low]);
                [condition, high, low].into_iter().for_each(|operand| self.used(operand));
                let target = self.room(&[]);
                self.assembler.blend(target, below, above, chosen);
                self.put(value, target);
            }
        }
    }

    fn put(&mut self, value: Value, register: Register) {
        if !self.uses[value].is_empty() {
            self.holds[usize::from(register.0)] = Some(value);
            self.register[value] = Some(register);
        }
    }

    /// One use less; after the last one its register is free.
    fn used(&mut self, value: Value) {
        self.uses[value].pop();
        if let (true, Some(register)) = (self.uses[value].is_empty(), self.register[value]) {
            self.register[value] = None;
            self.holds[usize::from(register.0)] = None;
        }
    }

    /// A value in a register; those that are needed with it stay where they are.
    fn in_register(&mut self, value: Value, stay: &[Value]) -> Register {
        if let Some(register) = self.register[value] {
            return register;
        }
        let register = self.room(stay);
        if let Some(cell) = self.cell[value] {
            self.assembler.load(register, Operand::Cell(cell));
        }
        self.put(value, register);
        register
    }

    /// A value where it is, or in a register if it is used again soon.
    fn operand(&mut self, value: Value, stay: &[Value]) -> Operand {
        if let Some(register) = self.register[value] {
            return Operand::Register(register);
        }
        let again = match self.uses[value][..] {
            [.., next, now] => next < now + SOON && self.holds.contains(&None),
            _ => false,
        };
        match self.cell[value] {
            Some(cell) if !again => Operand::Cell(cell),
            _ => Operand::Register(self.in_register(value, stay)),
        }
    }

    /// A free register.
    fn room(&mut self, stay: &[Value]) -> Register {
        let next = |holds: &Option<Value>| match holds {
            None => usize::MAX,
            Some(value) if stay.contains(value) => 0,
            Some(value) => self.uses[*value].last().map_or(usize::MAX - 1, |&step| step + 1),
        };
        let farthest = (0..REGISTERS).max_by_key(|&register| next(&self.holds[usize::from(register)]));
        let register = Register(farthest.unwrap_or(0));
        if let Some(value) = self.holds[usize::from(register.0)].take() {
            self.register[value] = None;
            if self.cell[value].is_none() {
                let cell = self.flow.cell();
                self.assembler.store(register, cell);
                self.cell[value] = Some(cell);
            }
        }
        register
    }
}
