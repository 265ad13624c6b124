//! Native code for lanes, made directly, in much less time than a compiler takes: a loop over samples for one vector of
//! 256 bits, of 8 or 4 lanes.
//!
//! It works in a frame of cells, one vector each, the first of which are the rows of the interpreter, then those of
//! constants and of values that no register has room for. In each sample it does first what says whether a lane stops, and
//! leaves before anything has changed where one does: so the interpreter settles the last sample of each run. After that
//! registers and accumulators take their next values where they are, as soon as nobody needs the old ones.

mod accumulators;
mod assembler;
mod flow;
mod operations;
mod placing;
mod reals;

use super::code::Code;
pub(super) use assembler::BYTES;
use flow::{Flow, Maker, Value};
use operations::Operations;
use placing::{Placing, Step};

/// Operations of the largest program that is compiled: code beyond it no longer fits in the first cache.
const MOST_OPERATIONS: usize = 4000;

/// Code and the cells that it needs.
#[derive(Debug)]
pub(crate) struct Compiled {
    code: Vec<u8>,
    cells: usize,
    /// The cell with ones in the lanes that may stop a run.
    pub(super) mask: usize,
    /// Cells of constants, and the 64 bits that each repeats.
    pub(super) constants: Vec<(usize, u64)>,
    /// Cells, the same as rows, that go in, and those that come out.
    pub(super) enter: Vec<usize>,
    pub(super) leave: Vec<usize>,
}

impl Compiled {
    /// A function of the address of a frame and the number of samples, at least 1, by the calling convention of System V:
    /// gives the number of samples done.
    #[cfg_attr(not(all(feature = "jit", target_arch = "x86_64")), expect(dead_code, reason = "nothing runs it"))]
    pub(crate) fn code(&self) -> &[u8] {
        &self.code
    }

    /// Cells of its frame.
    pub(super) fn cells(&self) -> usize {
        self.cells
    }

    /// Bytes of its frame, of which it touches no others.
    #[cfg_attr(not(all(feature = "jit", target_arch = "x86_64")), expect(dead_code, reason = "nothing runs it"))]
    pub(crate) fn frame(&self) -> usize {
        self.cells * BYTES
    }
}

/// Lanes of a vector, where words are of this many bits.
pub(super) fn lanes(bits: u32) -> usize {
    BYTES * 8 / bits as usize
}

/// Compiles a program on words of this many bits; `None` where it has memories, or operations for which there are no
/// vector instructions.
pub(super) fn compile(program: &Code, bits: u32) -> Option<Compiled> {
    if !program.writes.is_empty() || program.operations.len() > MOST_OPERATIONS {
        return None;
    }
    let mut operations = Operations::new(program, bits);
    operations.all(program)?;
    let stop = operations.plain(program.outputs[0]);
    let registers = program.registers.iter().filter_map(|register| Some((register.row, register.next?)));
    let carried: Vec<(usize, usize)> = registers.chain(program.accumulators.iter().map(|&row| (row, row))).collect();
    let next: Vec<Value> = carried.iter().map(|&(_, next)| operations.plain(next)).collect();
    let mut flow = operations.flow;
    // What another register held is copied before that one changes.
    let copied = |value: Value| match flow.makers[value] {
        Maker::Cell(_) => flow.two(assembler::OR, value, value),
        _ => value,
    };
    let next: Vec<Value> = next.into_iter().map(copied).collect();
    let next: Vec<(Value, usize)> = next.into_iter().zip(carried.iter().map(|&(row, _)| row)).collect();
    let mask = flow.cell();
    let steps = steps(&flow, stop, mask, &next);
    let mut placing = Placing::new(&mut flow, &steps);
    steps.into_iter().for_each(|step| placing.step(step));
    let code = placing.assembler.finish();
    let inputs = program.inputs.iter().map(|&(_, row)| row);
    let registers = program.registers.iter().map(|register| register.row);
    Some(Compiled {
        code,
        cells: flow.cells,
        mask,
        constants: flow.constants.iter().map(|(&word, &cell)| (cell, word)).collect(),
        enter: registers.chain(inputs).chain(program.accumulators.iter().copied()).collect(),
        leave: carried.iter().map(|&(row, _)| row).collect(),
    })
}

/// What is done in one sample: what the stop depends on, then the rest, with each cell taking its next value as soon as its old
/// one was used for the last time.
fn steps(flow: &Flow, stop: Value, mask: usize, next: &[(Value, usize)]) -> Vec<Step> {
    let count = flow.makers.len();
    let first = needed(flow, vec![stop]);
    let rest = needed(flow, next.iter().map(|&(value, _)| value).collect());
    let early = (0..count).filter(|&value| first[value]);
    let late = (0..count).filter(|&value| rest[value] && !first[value]);
    // When the old value of each cell that changes is used for the last time, and when each value is there.
    let order: Vec<Value> = early.clone().chain(late.clone()).collect();
    let before = early.count();
    let mut made = vec![0; count];
    let mut free = vec![before; count];
    for (index, &value) in order.iter().enumerate() {
        made[value] = index + 1;
        flow.makers[value].operands().for_each(|operand| free[operand] = free[operand].max(index + 1));
    }
    let old = |cell: usize| flow.makers.iter().position(|maker| *maker == Maker::Cell(cell));
    let at = |value: Value, cell: usize| old(cell).map_or(before, |old| free[old]).max(made[value]).max(before);
    let stores: Vec<(usize, Step)> =
        next.iter().map(|&(value, cell)| (at(value, cell), Step::Store(value, cell))).collect();
    let mut steps = Vec::with_capacity(count + next.len());
    for index in 0..=order.len() {
        if index == before {
            steps.push(Step::Leave(stop, mask));
        }
        steps.extend(stores.iter().filter(|&&(at, _)| at == index).map(|&(_, store)| store));
        steps.extend(order.get(index).map(|&value| Step::Make(value)));
    }
    steps
}

/// What some values depend on.
fn needed(flow: &Flow, mut pending: Vec<Value>) -> Vec<bool> {
    let mut needed = vec![false; flow.makers.len()];
    while let Some(value) = pending.pop() {
        if !std::mem::replace(&mut needed[value], true) {
            pending.extend(flow.makers[value].operands());
        }
    }
    needed
}
