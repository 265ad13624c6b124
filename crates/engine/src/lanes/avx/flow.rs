//! Values and the vector instructions that make them, each once; a value may also be known by its complement.

use rustc_hash::FxHashMap as HashMap;

use super::assembler::{AND, AND_NOT, OR, Opcode, Shift, XOR};

/// A value: an index into [`Flow::makers`].
pub(super) type Value = usize;

/// What makes a value.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Maker {
    /// The cell with this index, as it is at the beginning of a sample.
    Cell(usize),
    One(Opcode, Value),
    Two(Opcode, Value, Value),
    Shift(Shift, Value, u8),
    /// Condition, high, low.
    Blend(Value, Value, Value),
}

impl Maker {
    pub(super) fn operands(self) -> impl Iterator<Item = Value> {
        let operands = match self {
            Maker::Cell(_) => [None; 3],
            Maker::One(_, a) | Maker::Shift(_, a, _) => [Some(a), None, None],
            Maker::Two(_, a, b) => [Some(a), Some(b), None],
            Maker::Blend(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        operands.into_iter().flatten()
    }
}

/// A value or its complement.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Bits {
    pub(super) value: Value,
    pub(super) inverted: bool,
}

impl Bits {
    pub(super) fn not(self) -> Bits {
        Bits { inverted: !self.inverted, ..self }
    }
}

pub(super) fn bits(value: Value) -> Bits {
    Bits { value, inverted: false }
}

#[derive(Default)]
pub(super) struct Flow {
    pub(super) makers: Vec<Maker>,
    made: HashMap<Maker, Value>,
    /// Constants, 64 bits that a vector repeats, and their cells.
    pub(super) constants: HashMap<u64, usize>,
    /// Cells given out.
    pub(super) cells: usize,
}

impl Flow {
    /// This many cells are given out already.
    pub(super) fn new(cells: usize) -> Flow {
        Flow { cells, ..Flow::default() }
    }

    pub(super) fn make(&mut self, maker: Maker) -> Value {
        let makers = &mut self.makers;
        *self.made.entry(maker).or_insert_with(|| {
            makers.push(maker);
            makers.len() - 1
        })
    }

    pub(super) fn cell(&mut self) -> usize {
        self.cells += 1;
        self.cells - 1
    }

    /// 64 bits that a vector repeats.
    pub(super) fn constant(&mut self, word: u64) -> Value {
        let cells = &mut self.cells;
        let cell = *self.constants.entry(word).or_insert_with(|| {
            *cells += 1;
            *cells - 1
        });
        self.make(Maker::Cell(cell))
    }

    pub(super) fn one(&mut self, opcode: Opcode, a: Value) -> Value {
        self.make(Maker::One(opcode, a))
    }

    pub(super) fn two(&mut self, opcode: Opcode, a: Value, b: Value) -> Value {
        let (a, b) = if opcode.commutes && b < a { (b, a) } else { (a, b) };
        self.make(Maker::Two(opcode, a, b))
    }

    pub(super) fn and(&mut self, a: Bits, b: Bits) -> Bits {
        match (a.inverted, b.inverted) {
            (false, false) => bits(self.two(AND, a.value, b.value)),
            (true, false) => bits(self.two(AND_NOT, a.value, b.value)),
            (false, true) => bits(self.two(AND_NOT, b.value, a.value)),
            (true, true) => bits(self.two(OR, a.value, b.value)).not(),
        }
    }

    pub(super) fn or(&mut self, a: Bits, b: Bits) -> Bits {
        self.and(a.not(), b.not()).not()
    }

    pub(super) fn xor(&mut self, a: Bits, b: Bits) -> Bits {
        Bits { value: self.two(XOR, a.value, b.value), inverted: a.inverted != b.inverted }
    }

    /// The value itself.
    pub(super) fn plain(&mut self, of: Bits) -> Value {
        if !of.inverted {
            return of.value;
        }
        let ones = self.constant(u64::MAX);
        self.two(XOR, of.value, ones)
    }
}
