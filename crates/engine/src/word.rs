//! The word-level engine: one `u64` per net, and a flat array of operations in levelled order. A clock walks the array
//! once; nothing is allocated, hashed or chased through a tree.

use super::memories::Memories;
use super::{Engine, Rows, Stop, Watch};
use stepwave_netlist::Design;
use stepwave_netlist::bits::{self, Width};
use stepwave_netlist::cells::{Net, Op};

/// One operation: where its result goes, and the operator with its operands.
struct Operation {
    target: u32,
    /// Width of the result, or of the operands where the result is a flag.
    width: Width,
    kind: WordOp,
}

/// Operators on indices into the array of values. Those that need a second width or constant carry it.
enum WordOp {
    Not(u32),
    And(u32, u32),
    Or(u32, u32),
    Xor(u32, u32),
    Mux(u32, u32, u32),
    Add(u32, u32),
    Sub(u32, u32),
    Mul(u32, u32),
    Div(u32, u32),
    Rem(u32, u32),
    ShiftLeft(u32, u32),
    ShiftRight(u32, u32),
    ShiftArithmetic(u32, u32),
    Carry(u32, u32),
    Borrow(u32, u32),
    AddOverflow(u32, u32),
    SubOverflow(u32, u32),
    Equal(u32, u32),
    LessSigned(u32, u32),
    Slice(u32, u8),
    Concat(u32, u32, u8),
    Copy(u32),
    SignExtend(u32, Width),
    /// Memory and address.
    Read(u32, u32),
}

pub(super) struct WordEngine {
    design: Design,
    clock: u64,
    values: Vec<u64>,
    memories: Memories,
    /// Of every cell, so that any net can be watched.
    operations: Vec<Operation>,
    /// Each register and the net of its next value.
    registers: Vec<(u32, u32)>,
    /// Next values between the two phases of an edge; same index as `registers`.
    next: Vec<u64>,
    columns: Vec<u32>,
    stops: Vec<u32>,
    /// Inputs that change after the next edge.
    pending: Vec<(u32, u64)>,
}

fn lower(design: &Design, net: Net) -> Option<Operation> {
    let netlist = design.netlist();
    let cell = netlist.cell(net);
    let of = |net: Net| netlist.width(net);
    let (kind, width) = match cell.op {
        Op::Input | Op::Const(_) | Op::Register { .. } => return None,
        Op::Not(a) => (WordOp::Not(a.0), cell.width),
        Op::And(a, b) => (WordOp::And(a.0, b.0), cell.width),
        Op::Or(a, b) => (WordOp::Or(a.0, b.0), cell.width),
        Op::Xor(a, b) => (WordOp::Xor(a.0, b.0), cell.width),
        Op::Mux { select, high, low } => (WordOp::Mux(select.0, high.0, low.0), cell.width),
        Op::Add(a, b) => (WordOp::Add(a.0, b.0), cell.width),
        Op::Sub(a, b) => (WordOp::Sub(a.0, b.0), cell.width),
        Op::Mul(a, b) => (WordOp::Mul(a.0, b.0), cell.width),
        Op::Div(a, b) => (WordOp::Div(a.0, b.0), cell.width),
        Op::Rem(a, b) => (WordOp::Rem(a.0, b.0), cell.width),
        Op::ShiftLeft(a, by) => (WordOp::ShiftLeft(a.0, by.0), cell.width),
        Op::ShiftRight(a, by) => (WordOp::ShiftRight(a.0, by.0), cell.width),
        Op::ShiftArithmetic(a, by) => (WordOp::ShiftArithmetic(a.0, by.0), cell.width),
        Op::Carry(a, b) => (WordOp::Carry(a.0, b.0), of(a)),
        Op::Borrow(a, b) => (WordOp::Borrow(a.0, b.0), of(a)),
        Op::AddOverflow(a, b) => (WordOp::AddOverflow(a.0, b.0), of(a)),
        Op::SubOverflow(a, b) => (WordOp::SubOverflow(a.0, b.0), of(a)),
        Op::Equal(a, b) => (WordOp::Equal(a.0, b.0), of(a)),
        Op::LessSigned(a, b) => (WordOp::LessSigned(a.0, b.0), of(a)),
        Op::Slice { of, low } => (WordOp::Slice(of.0, low), cell.width),
        Op::Concat { high, low } => {
            // A part is at least 1 bit, so the shift is at most 63.
            (WordOp::Concat(high.0, low.0, u8::try_from(of(low).get()).unwrap_or(63)), cell.width)
        }
        Op::ZeroExtend(a) => (WordOp::Copy(a.0), cell.width),
        Op::SignExtend(a) => (WordOp::SignExtend(a.0, of(a)), cell.width),
        Op::Read { memory, address } => (WordOp::Read(memory, address.0), cell.width),
    };
    Some(Operation { target: net.0, width, kind })
}

impl WordEngine {
    pub(super) fn new(design: &Design, watch: &Watch) -> WordEngine {
        let netlist = design.netlist();
        let registers: Vec<(u32, u32)> = design
            .registers()
            .iter()
            .filter_map(|&register| match netlist.cell(register).op {
                Op::Register { next: Some(next), .. } => Some((register.0, next.0)),
                _ => None,
            })
            .collect();
        let mut values = vec![0; netlist.cells.len()];
        for (value, cell) in values.iter_mut().zip(&netlist.cells) {
            if let Op::Const(constant) = cell.op {
                *value = constant;
            }
        }
        // Cells that nothing depends on come after all others; a description leaves hardly any.
        let mut seen = vec![false; netlist.cells.len()];
        design.order().iter().for_each(|net| seen[net.index()] = true);
        let order = design.order().iter().copied().chain(netlist.nets().filter(|net| !seen[net.index()]));
        let indices = |nets: &[Net]| nets.iter().map(|net| net.0).collect();
        let mut engine = WordEngine {
            design: design.clone(),
            clock: 0,
            values,
            memories: Memories::new(netlist),
            operations: order.filter_map(|net| lower(design, net)).collect(),
            next: vec![0; registers.len()],
            registers,
            columns: indices(&watch.columns),
            stops: indices(&watch.stops),
            pending: Vec::with_capacity(design.inputs().len()),
        };
        engine.reset(&mut Rows::new(0, 0));
        engine
    }

    #[inline]
    fn settle(&mut self) {
        let v = &mut self.values[..];
        for Operation { target, width, kind } in &self.operations {
            let w = *width;
            let at = |index: u32| v[index as usize];
            let result = match *kind {
                WordOp::Not(a) => !at(a) & w.mask(),
                WordOp::And(a, b) => at(a) & at(b),
                WordOp::Or(a, b) => at(a) | at(b),
                WordOp::Xor(a, b) => at(a) ^ at(b),
                WordOp::Mux(select, high, low) => {
                    if at(select) == 1 {
                        at(high)
                    } else {
                        at(low)
                    }
                }
                WordOp::Add(a, b) => bits::add(w, at(a), at(b)),
                WordOp::Sub(a, b) => bits::sub(w, at(a), at(b)),
                WordOp::Mul(a, b) => bits::mul(w, at(a), at(b)),
                WordOp::Div(a, b) => bits::div(at(a), at(b)),
                WordOp::Rem(a, b) => bits::rem(at(a), at(b)),
                WordOp::ShiftLeft(a, by) => bits::shift_left(w, at(a), at(by)),
                WordOp::ShiftRight(a, by) => bits::shift_right(at(a), at(by)),
                WordOp::ShiftArithmetic(a, by) => bits::shift_arithmetic(w, at(a), at(by)),
                WordOp::Carry(a, b) => u64::from(bits::carry(w, at(a), at(b))),
                WordOp::Borrow(a, b) => u64::from(bits::borrow(at(a), at(b))),
                WordOp::AddOverflow(a, b) => u64::from(bits::add_overflow(w, at(a), at(b))),
                WordOp::SubOverflow(a, b) => u64::from(bits::sub_overflow(w, at(a), at(b))),
                WordOp::Equal(a, b) => u64::from(at(a) == at(b)),
                WordOp::LessSigned(a, b) => u64::from(bits::less_signed(w, at(a), at(b))),
                WordOp::Slice(of, low) => at(of) >> low & w.mask(),
                WordOp::Concat(high, low, shift) => at(high) << shift | at(low),
                WordOp::Copy(a) => at(a),
                WordOp::SignExtend(a, from) => bits::sign_extend(from, w, at(a)),
                WordOp::Read(memory, address) => self.memories.word(memory as usize, at(address)),
            };
            v[*target as usize] = result;
        }
    }

    #[inline]
    fn edge(&mut self) {
        self.memories.edge(self.design.netlist(), |net| self.values[net.index()]);
        for (next, &(_, source)) in self.next.iter_mut().zip(&self.registers) {
            *next = self.values[source as usize];
        }
        for (&next, &(register, _)) in self.next.iter().zip(&self.registers) {
            self.values[register as usize] = next;
        }
        self.clock += 1;
    }

    #[inline]
    fn apply_inputs(&mut self) {
        for &(input, value) in &self.pending {
            self.values[input as usize] = value;
        }
        self.pending.clear();
    }

    #[inline]
    fn record(&self, rows: &mut Rows) {
        rows.push(self.clock, |column| self.values[self.columns[column] as usize]);
    }
}

/// What the compiled engine needs to hand a run over and take it back.
#[cfg(feature = "jit")]
impl WordEngine {
    /// An input changes after the next edge.
    pub(super) fn input_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    /// Takes the registers as they are `clocks` clocks later, and settles.
    pub(super) fn continue_from(&mut self, clocks: u64, registers: &[u64]) {
        self.clock += clocks;
        for (&(register, _), &value) in self.registers.iter().zip(registers) {
            self.values[register as usize] = value;
        }
        self.settle();
    }

    /// The memories, whose words native code changes.
    pub(super) fn memories(&mut self) -> &mut Memories {
        &mut self.memories
    }

    /// Counts and records the edge whose register values were taken over last.
    pub(super) fn finish_edge(&mut self, rows: &mut Rows) {
        self.clock += 1;
        self.record(rows);
    }
}

impl WordEngine {
    /// The stop net that is 1 in the present sample.
    pub(super) fn stopped(&self) -> Option<Stop> {
        self.stops.iter().position(|&net| self.values[net as usize] == 1).map(Stop::Net)
    }
}

impl Engine for WordEngine {
    fn set_input(&mut self, input: Net, value: u64) {
        let cell = self.design.netlist().cell(input);
        if cell.op == Op::Input {
            self.pending.push((input.0, value & cell.width.mask()));
        }
    }

    fn reset(&mut self, rows: &mut Rows) {
        rows.clear();
        self.clock = 0;
        for &(register, _) in &self.registers {
            if let Op::Register { reset, .. } = self.design.netlist().cell(Net(register)).op {
                self.values[register as usize] = reset;
            }
        }
        self.memories.fill(self.design.netlist(), &[]);
        self.apply_inputs();
        self.settle();
        self.record(rows);
    }

    fn restore(&mut self, clock: u64, registers: &[u64], inputs: &[u64], memories: &[Vec<u64>]) {
        let design = self.design.clone();
        assert_eq!((registers.len(), inputs.len()), (design.registers().len(), design.inputs().len()));
        for (&net, &value) in design.registers().iter().chain(design.inputs()).zip(registers.iter().chain(inputs)) {
            self.values[net.index()] = value;
        }
        self.memories.fill(design.netlist(), memories);
        self.pending.clear();
        self.clock = clock;
        self.settle();
    }

    fn run(&mut self, clocks: u64, rows: &mut Rows) -> Stop {
        let records = !self.columns.is_empty();
        for _ in 0..clocks {
            if records && rows.is_full() {
                return Stop::RowsFull;
            }
            self.edge();
            self.apply_inputs();
            self.settle();
            self.record(rows);
            if let Some(stop) = self.stopped() {
                return stop;
            }
        }
        Stop::Clocks
    }

    fn clock(&self) -> u64 {
        self.clock
    }

    fn value(&self, net: Net) -> u64 {
        self.values[net.index()]
    }

    fn word(&self, memory: usize, address: u64) -> u64 {
        self.memories.word(memory, address)
    }
}
