//! The oracle: every net a slice of one bit vector, every adder a chain of full adders, every multiplexer a gate pair
//! per bit. Slow on purpose; each function is the textbook drawing and nothing else. It shares no arithmetic with the
//! other engines and evaluates the cells in creation order, not in the levelled order. As in any event-driven simulator
//! a cell is evaluated where one of its operands has changed.

use std::ops::Range;

use bitvec::prelude::{BitSlice, BitVec, Lsb0};

use super::{Engine, Rows, Stop, Watch};
use stepwave_netlist::Design;
use stepwave_netlist::cells::{Net, Op};

type Slice = BitSlice<u64, Lsb0>;

/// One full adder: sum and carry of three bits.
fn full_adder(a: bool, b: bool, carry: bool) -> (bool, bool) {
    (a ^ b ^ carry, (a & b) | (a & carry) | (b & carry))
}

/// Ripple-carry addition. Returns the sum, the carry into the sign bit and the carry out of it.
fn ripple(a: &Slice, b: impl Iterator<Item = bool>, carry_in: bool) -> (BitVec<u64>, bool, bool) {
    let mut sum = BitVec::with_capacity(a.len());
    let (mut into_sign, mut carry) = (carry_in, carry_in);
    for (a, b) in a.iter().by_vals().zip(b) {
        into_sign = carry;
        let (s, c) = full_adder(a, b, carry);
        sum.push(s);
        carry = c;
    }
    (sum, into_sign, carry)
}

fn add(a: &Slice, b: &Slice) -> (BitVec<u64>, bool, bool) {
    ripple(a, b.iter().by_vals(), false)
}

/// a - b as a + complement of b + 1: the borrow is the missing carry.
fn sub(a: &Slice, b: &Slice) -> (BitVec<u64>, bool, bool) {
    ripple(a, b.iter().by_vals().map(|bit| !bit), true)
}

/// Shift and add: a, shifted under each bit of b, where that bit is 1.
fn mul(a: &Slice, b: &Slice) -> BitVec<u64> {
    let mut sum: BitVec<u64> = BitVec::repeat(false, a.len());
    for (place, bit) in b.iter().by_vals().enumerate() {
        let shifted = (0..a.len()).map(|index| bit & (index >= place && a[index - place]));
        sum = ripple(&sum, shifted, false).0;
    }
    sum
}

/// Restoring division: quotient and remainder, both 0 where b is 0.
fn divide(a: &Slice, b: &Slice) -> (BitVec<u64>, BitVec<u64>) {
    let wide = extended(b, b.len() + 1, false);
    let mut quotient: BitVec<u64> = BitVec::repeat(false, a.len());
    let mut rest: BitVec<u64> = BitVec::repeat(false, wide.len());
    for place in (0..a.len()).rev() {
        rest.pop();
        rest.insert(0, a[place]);
        let (difference, _, fits) = sub(&rest, &wide);
        quotient.set(place, fits);
        rest = zip(&difference, &rest, |difference, rest| (difference & fits) | (rest & !fits));
    }
    rest.pop();
    let divisible = b.any();
    (
        quotient.iter().by_vals().map(|bit| bit & divisible).collect(),
        rest.iter().by_vals().map(|bit| bit & divisible).collect(),
    )
}

/// One stage of multiplexers for each bit of the amount. `fill` enters.
fn shift(a: &Slice, by: &Slice, left: bool, fill: bool) -> BitVec<u64> {
    let mut shifted = a.to_bitvec();
    for (stage, select) in by.iter().by_vals().enumerate() {
        let distance = if stage < 7 { 1 << stage } else { a.len() };
        let from = |place: usize| if left { place.checked_sub(distance) } else { Some(place + distance) };
        let bit = |place: usize| from(place).and_then(|from| shifted.get(from)).map_or(fill, |bit| *bit);
        shifted = (0..a.len()).map(|place| (bit(place) & select) | (shifted[place] & !select)).collect();
    }
    shifted
}

fn bit(value: bool) -> BitVec<u64> {
    BitVec::repeat(value, 1)
}

/// The low `width` bits of a number.
fn word(value: u64, width: usize) -> BitVec<u64> {
    (0..width).map(|index| value >> index & 1 == 1).collect()
}

fn zip(a: &Slice, b: &Slice, gate: impl Fn(bool, bool) -> bool) -> BitVec<u64> {
    a.iter().by_vals().zip(b.iter().by_vals()).map(|(a, b)| gate(a, b)).collect()
}

fn extended(a: &Slice, width: usize, fill: bool) -> BitVec<u64> {
    let mut wide = a.to_bitvec();
    wide.resize(width, fill);
    wide
}

pub(super) struct Gates {
    design: Design,
    watch: Watch,
    clock: u64,
    /// Index of each net's bits in `state`.
    place: Vec<Range<usize>>,
    state: BitVec<u64>,
    /// What each cell reads.
    operands: Vec<Vec<Net>>,
    /// Nets that have another value than in the sample before.
    changed: BitVec<u64>,
    /// Every cell is evaluated: nets have been set in another manner than by an edge.
    afresh: bool,
    /// Words of each memory, one after another.
    memories: Vec<BitVec<u64>>,
    /// Inputs as the test bench wants them from after the next edge on; same index as the design's inputs.
    pending: Vec<u64>,
}

impl Gates {
    pub(super) fn new(design: &Design, watch: &Watch) -> Gates {
        let (mut place, mut operands) = (Vec::new(), Vec::new());
        let mut total = 0;
        for cell in &design.netlist().cells {
            let width = cell.width.get() as usize;
            place.push(total..total + width);
            total += width;
            let mut reads = Vec::new();
            cell.op.visit_inputs(|operand| reads.push(operand));
            operands.push(reads);
        }
        let mut gates = Gates {
            design: design.clone(),
            watch: watch.clone(),
            clock: 0,
            place,
            state: BitVec::repeat(false, total),
            operands,
            changed: BitVec::repeat(false, design.netlist().cells.len()),
            afresh: true,
            memories: Vec::new(),
            pending: vec![0; design.inputs().len()],
        };
        gates.reset(&mut Rows::new(0, 0));
        gates
    }

    fn bits(&self, net: Net) -> &Slice {
        &self.state[self.place[net.index()].clone()]
    }

    fn put(&mut self, net: Net, bits: &Slice) {
        let place = self.place[net.index()].clone();
        let held = &mut self.state[place];
        if *held != *bits {
            held.copy_from_bitslice(bits);
            self.changed.set(net.index(), true);
        }
    }

    /// An operand has changed since the cell was evaluated. Any write at the edge may be to the word that is read.
    fn is_due(&self, net: Net, op: Op) -> bool {
        self.afresh
            || matches!(op, Op::Read { .. })
            || self.operands[net.index()].iter().any(|operand| self.changed[operand.index()])
    }

    /// What a combinational cell gives; `None` for a cell that is not one.
    fn evaluate(&self, net: Net, op: Op) -> Option<BitVec<u64>> {
        let at = |net: Net| self.bits(net);
        let width = self.place[net.index()].len();
        Some(match op {
            Op::Input | Op::Register { .. } => return None,
            Op::Const(value) => word(value, width),
            Op::Not(a) => !at(a).to_bitvec(),
            Op::And(a, b) => zip(at(a), at(b), |a, b| a & b),
            Op::Or(a, b) => zip(at(a), at(b), |a, b| a | b),
            Op::Xor(a, b) => zip(at(a), at(b), |a, b| a ^ b),
            Op::Mux { select, high, low } => {
                let select = at(select)[0];
                zip(at(high), at(low), |high, low| (high & select) | (low & !select))
            }
            Op::Add(a, b) => add(at(a), at(b)).0,
            Op::Sub(a, b) => sub(at(a), at(b)).0,
            Op::Mul(a, b) => mul(at(a), at(b)),
            Op::Div(a, b) => divide(at(a), at(b)).0,
            Op::Rem(a, b) => divide(at(a), at(b)).1,
            Op::ShiftLeft(a, by) => shift(at(a), at(by), true, false),
            Op::ShiftRight(a, by) => shift(at(a), at(by), false, false),
            Op::ShiftArithmetic(a, by) => shift(at(a), at(by), false, at(a)[width_of(at(a)) - 1]),
            Op::Carry(a, b) => bit(add(at(a), at(b)).2),
            Op::Borrow(a, b) => bit(!sub(at(a), at(b)).2),
            Op::AddOverflow(a, b) => {
                let (_, into_sign, out_of_sign) = add(at(a), at(b));
                bit(into_sign ^ out_of_sign)
            }
            Op::SubOverflow(a, b) => {
                let (_, into_sign, out_of_sign) = sub(at(a), at(b));
                bit(into_sign ^ out_of_sign)
            }
            Op::Equal(a, b) => bit(zip(at(a), at(b), |a, b| a ^ b).not_any()),
            Op::LessSigned(a, b) => {
                // Negative difference, or positive by overflow.
                let (difference, into_sign, out_of_sign) = sub(at(a), at(b));
                bit(difference[width_of(at(a)) - 1] ^ into_sign ^ out_of_sign)
            }
            Op::Slice { of, low } => at(of)[usize::from(low)..usize::from(low) + width].to_bitvec(),
            Op::Concat { high, low } => {
                let mut whole = at(low).to_bitvec();
                whole.extend_from_bitslice(at(high));
                whole
            }
            Op::ZeroExtend(a) => extended(at(a), width, false),
            Op::SignExtend(a) => extended(at(a), width, at(a)[width_of(at(a)) - 1]),
            Op::Read { memory, address } => match self.place_in(memory as usize, self.value(address)) {
                Some(place) => self.memories[memory as usize][place].to_bitvec(),
                None => BitVec::repeat(false, width),
            },
        })
    }

    /// Applies the inputs and lets the combinational nets settle.
    fn settle(&mut self) {
        let design = self.design.clone();
        for (index, &input) in design.inputs().iter().enumerate() {
            let bits = word(self.pending[index], self.bits(input).len());
            self.put(input, &bits);
        }
        for (net, cell) in design.netlist().nets().zip(&design.netlist().cells) {
            if self.is_due(net, cell.op)
                && let Some(bits) = self.evaluate(net, cell.op)
            {
                self.put(net, &bits);
            }
        }
        self.afresh = false;
    }

    fn edge(&mut self) {
        self.write_memories();
        self.changed.fill(false);
        let old = self.state.clone();
        let design = self.design.clone();
        for &register in design.registers() {
            if let Op::Register { next: Some(next), .. } = design.netlist().cell(register).op {
                self.put(register, &old[self.place[next.index()].clone()]);
            }
        }
        self.clock += 1;
    }

    /// Where the bits of a word are in its memory; nowhere outside of it.
    fn place_in(&self, memory: usize, address: u64) -> Option<Range<usize>> {
        let width = self.design.netlist().memories[memory].width.get() as usize;
        let first = usize::try_from(address).ok()?.checked_mul(width)?;
        (first < self.memories[memory].len()).then(|| first..first + width)
    }

    /// All ports write, one after another, what their nets were before the edge.
    fn write_memories(&mut self) {
        let design = self.design.clone();
        for (index, memory) in design.netlist().memories.iter().enumerate() {
            for port in &memory.writes {
                let place = self.place_in(index, self.value(port.address)).filter(|_| self.bits(port.enable)[0]);
                for (bit, target) in place.into_iter().flatten().enumerate() {
                    if port.mask.is_none_or(|mask| self.bits(mask)[bit]) {
                        let data = self.bits(port.data)[bit];
                        self.memories[index].set(target, data);
                    }
                }
            }
        }
    }

    /// The memories take these contents, and where there are none their first words.
    fn fill_memories(&mut self, contents: &[Vec<u64>]) {
        let design = self.design.clone();
        let memories = design.netlist().memories.iter().enumerate();
        let filled = memories.map(|(index, memory)| {
            let width = memory.width.get() as usize;
            let words = contents.get(index).unwrap_or(&memory.initial);
            let mut bits: BitVec<u64> = words.iter().flat_map(|&value| word(value, width)).collect();
            bits.resize(usize::try_from(memory.size).unwrap_or(usize::MAX).saturating_mul(width), false);
            bits
        });
        self.memories = filled.collect();
    }

    fn record(&self, rows: &mut Rows) {
        rows.push(self.clock, |column| self.value(self.watch.columns[column]));
    }
}

fn number(bits: &Slice) -> u64 {
    bits.iter().by_vals().rev().fold(0, |value, bit| value << 1 | u64::from(bit))
}

fn width_of(bits: &Slice) -> usize {
    bits.len()
}

impl Engine for Gates {
    fn set_input(&mut self, input: Net, value: u64) {
        if let Some(index) = self.design.inputs().iter().position(|&net| net == input) {
            self.pending[index] = value;
        }
    }

    fn reset(&mut self, rows: &mut Rows) {
        rows.clear();
        self.clock = 0;
        let design = self.design.clone();
        for &register in design.registers() {
            if let Op::Register { reset, .. } = design.netlist().cell(register).op {
                let bits = word(reset, self.bits(register).len());
                self.put(register, &bits);
            }
        }
        self.fill_memories(&[]);
        self.afresh = true;
        self.settle();
        self.record(rows);
    }

    fn restore(&mut self, clock: u64, registers: &[u64], inputs: &[u64], memories: &[Vec<u64>]) {
        let design = self.design.clone();
        assert_eq!((registers.len(), inputs.len()), (design.registers().len(), design.inputs().len()));
        for (&register, &value) in design.registers().iter().zip(registers) {
            let bits = word(value, self.bits(register).len());
            self.put(register, &bits);
        }
        self.fill_memories(memories);
        self.pending.copy_from_slice(inputs);
        self.clock = clock;
        self.afresh = true;
        self.settle();
    }

    fn run(&mut self, clocks: u64, rows: &mut Rows) -> Stop {
        for _ in 0..clocks {
            if rows.is_full() && !self.watch.columns.is_empty() {
                return Stop::RowsFull;
            }
            self.edge();
            self.settle();
            self.record(rows);
            if let Some(index) = self.watch.stops.iter().position(|&net| self.value(net) == 1) {
                return Stop::Net(index);
            }
        }
        Stop::Clocks
    }

    fn clock(&self) -> u64 {
        self.clock
    }

    fn value(&self, net: Net) -> u64 {
        number(self.bits(net))
    }

    fn word(&self, memory: usize, address: u64) -> u64 {
        self.place_in(memory, address).map_or(0, |place| number(&self.memories[memory][place]))
    }
}
