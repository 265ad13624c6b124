//! Large machines: compiled at once, without anything taken for granted, and once more when it has been seen which
//! registers stay as they are.
//!
//! A clock of a large machine takes the word engine so long that a few hundred of them are worth compiling. Its native
//! code then runs a few clocks at a time until enough clocks have been looked at; a register that stayed what it was is a
//! constant in the second loop, which a guard leaves where it changes.

use super::codegen::Branches;
use super::specialise::{History, Periodic};
use super::{Compiled, Rows, Stop};
use crate::Engine;
use stepwave_netlist::Design;
use stepwave_netlist::cells::{Net, Op};

/// Cells that are evaluated in each clock, from which on a machine is large.
const LARGE: usize = 250;
/// Work in the branches of a select from which on a branch is better than the evaluation of both.
pub(super) const WORTH: u32 = 8;
/// Clocks in the word engine before anything is compiled.
const WARM_UP: u64 = 64;
/// Clocks after which registers that have not changed are taken for constants; four times as many after each that was wrong.
const LOOK_AT: u64 = 4 * 1024;
/// Loops that take registers for constants, at most.
const TRIES: u32 = 4;
/// Numbers of clocks run at a time while registers are watched.
const STRIDES: [u64; 5] = [1, 2, 3, 5, 7];

/// What is known of the registers of a large machine.
pub(super) struct Large {
    /// By index: has changed, or nothing would come of knowing that it does not.
    changes: Vec<bool>,
    /// Clocks to look at registers for, and those that are left.
    look_at: u64,
    left: u64,
    /// Times that a loop was compiled that takes registers for constants.
    tries: u32,
    /// Nothing more is to be found out.
    settled: bool,
    worth: u32,
    /// What is compiled now will run for long: it is made with care.
    lasting: bool,
    /// Times that native code ran while registers were watched.
    strides: usize,
}

impl Large {
    /// What is compiled now is made with care; other code runs already.
    pub(super) fn is_lasting(&self) -> bool {
        self.lasting
    }

    /// How a loop is compiled now.
    pub(super) fn branches(&self) -> Branches {
        Branches { worth: self.worth, lasting: self.lasting }
    }
}

/// Whether a machine is large.
pub(super) fn is_large(design: &Design) -> bool {
    let evaluated = |net: &&Net| !matches!(design.netlist().cell(**net).op, Op::Input | Op::Const(_));
    design.order().iter().filter(evaluated).count() >= LARGE
}

impl Compiled {
    /// Takes the machine for a large one.
    pub(crate) fn branching(mut self, worth: u32) -> Compiled {
        let netlist = self.design.netlist();
        let mut readers = vec![0u32; netlist.cells.len()];
        for cell in &netlist.cells {
            cell.op.visit_inputs(|input| readers[input.index()] += 1);
        }
        // Of a register that only keeps its own value nothing else depends on.
        let keeps = |&(register, next): &(Net, Net)| match netlist.cell(next).op {
            Op::Mux { high, low, .. } => u32::from(high == register || low == register),
            _ => 0,
        };
        let unread = |register: &(Net, Net)| readers[register.0.index()] <= keeps(register);
        let changes = self.registers.iter().map(unread).collect();
        let look_at = self.warm_up.min(LOOK_AT);
        self.warm_up = look_at.min(WARM_UP);
        self.history = History::none();
        self.large = Some(Large {
            changes,
            look_at,
            left: look_at,
            tries: 0,
            settled: false,
            worth,
            lasting: false,
            strides: 0,
        });
        self
    }

    /// Does not take the machine for a large one.
    pub(super) fn unbranched(mut self) -> Compiled {
        if let Some(large) = self.large.take() {
            self.warm_up = large.look_at;
            self.history = History::new(self.design.netlist(), &self.registers, super::LOOK_BACK.min(self.warm_up));
        }
        self
    }

    /// Runs native code from the present sample on up to a clock: `None` where it cannot, or the stop net, if any, that
    /// ended it.
    pub(super) fn run_large(&mut self, end: u64, rows: &mut Rows) -> Option<Option<Stop>> {
        if self.unavailable || self.word.input_pending() {
            return None;
        }
        let left = end - self.word.clock();
        let room = if self.watch.columns.is_empty() { left.min(i64::MAX as u64) } else { rows.room().min(left) };
        let fitting = self.fitting_large(rows.stride());
        if fitting.is_none() && self.quiet < self.warm_up {
            return None;
        }
        let Some(variant) = fitting else {
            if let Some(large) = &mut self.large {
                large.lasting = false;
            }
            self.compile(rows.stride(), None);
            return None;
        };
        if self.variants[variant].assumes_registers {
            let stop = self.run_native(variant, room, rows);
            if self.state[self.registers.len() + self.design.inputs().len()] == 1 {
                self.learn(variant);
            }
            return Some(stop);
        }
        if self.large.as_ref().is_some_and(|large| large.left == 0 && !large.settled) {
            self.specialise(rows.stride());
            return Some(None);
        }
        let looks_on = self.large.as_ref().is_some_and(|large| large.left > 0);
        Some(if looks_on { self.look_on(variant, room, rows) } else { self.run_native(variant, room, rows) })
    }

    /// Enough clocks were looked at: compiles a loop that takes registers for constants, or the last one, without.
    fn specialise(&mut self, stride: usize) {
        let constants = self.constants();
        let Some(large) = &mut self.large else { return };
        large.tries += 1;
        let constant = large.tries <= TRIES && !constants.is_empty();
        large.left = if constant { large.look_at << (2 * large.tries) } else { 0 };
        (large.settled, large.lasting) = (!constant, true);
        self.compile(stride, constant.then_some(constants));
    }

    /// The loop for the present sample, one with constants before one without.
    fn fitting_large(&self, stride: usize) -> Option<usize> {
        let fits = |index: &usize| {
            let variant = &self.variants[*index];
            variant.native.stride() == stride && self.holds(&variant.inputs) && self.holds(&variant.last_phase)
        };
        (0..self.variants.len()).filter(fits).max_by_key(|&index| self.variants[index].assumes_registers)
    }

    /// Registers that have not changed, and their values.
    fn constants(&self) -> Periodic {
        let Some(large) = &self.large else { return Vec::new() };
        let all = self.registers.iter().zip(&large.changes).filter(|(_, changes)| !**changes);
        all.map(|(&(register, _), _)| (register, vec![self.word.value(register)])).collect()
    }

    /// Runs a few clocks at a time, and looks which registers change.
    fn look_on(&mut self, variant: usize, room: u64, rows: &mut Rows) -> Option<Stop> {
        let count = self.registers.len();
        let flag = count + self.design.inputs().len();
        self.load_state();
        self.state[flag + 1] = 0;
        let before = self.state[..count].to_vec();
        let Some(large) = &mut self.large else { return None };
        let room = room.min(large.left);
        let (values, first) = rows.spare(self.variants[variant].native.resting());
        let memories = self.word.memories().words_mut();
        let mut done = 0;
        while done < room && self.state[flag + 1] == 0 {
            let stride = STRIDES[large.strides % STRIDES.len()].min(room - done);
            large.strides += 1;
            let at =
                if self.watch.columns.is_empty() { first } else { first + usize::try_from(done).unwrap_or(usize::MAX) };
            done += self.variants[variant].native.call(&mut self.state, values, at, stride, memories);
            for ((changes, now), before) in large.changes.iter_mut().zip(&self.state).zip(&before) {
                *changes |= now != before;
            }
        }
        large.left -= done;
        for &column in self.variants[variant].native.resting() {
            rows.fill(column, done, self.word.value(self.watch.columns[column]));
        }
        rows.grow(self.word.clock() + 1, done);
        self.word.continue_from(done, &self.state[..count]);
        self.variants[variant].clocks += done;
        self.word.stopped()
    }

    /// A guard was left through: the registers that are not what they were taken for change after all.
    fn learn(&mut self, variant: usize) {
        let variant = self.variants.remove(variant);
        if let Some(large) = &mut self.large {
            for (changes, (register, _)) in large.changes.iter_mut().zip(&self.registers) {
                let fixed = variant.last_phase.get(register);
                *changes |= fixed.is_some_and(|&value| self.word.value(*register) != value);
            }
        }
        // The native code goes on.
        self.quiet = self.warm_up;
    }
}
