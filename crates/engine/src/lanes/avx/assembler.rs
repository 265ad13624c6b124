//! Machine code of the instructions that lanes need, all on vectors of 256 bits.

/// A vector register.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Register(pub(super) u8);

/// The last operand of an instruction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Operand {
    Register(Register),
    /// A cell of the frame, by its index.
    Cell(usize),
}

/// Bytes of a vector.
pub(in crate::lanes) const BYTES: usize = 32;

/// An instruction's place in the maps of opcodes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Opcode {
    /// The map: 1 for 0F, 2 for 0F 38, 3 for 0F 3A.
    pub(super) map: u8,
    /// The prefix: 0 for none, 1 for 66, 2 for F3.
    pub(super) prefix: u8,
    /// The bit W.
    pub(super) wide: bool,
    pub(super) byte: u8,
    /// The operands may change places.
    pub(super) commutes: bool,
    /// A byte after the operands.
    pub(super) last: Option<u8>,
}

const fn plain(map: u8, byte: u8) -> Opcode {
    Opcode { map, prefix: 1, wide: false, byte, commutes: false, last: None }
}

const fn commuting(map: u8, byte: u8) -> Opcode {
    Opcode { commutes: true, ..plain(map, byte) }
}

pub(super) const AND: Opcode = commuting(1, 0xdb);
/// !a & b
pub(super) const AND_NOT: Opcode = plain(1, 0xdf);
pub(super) const OR: Opcode = commuting(1, 0xeb);
pub(super) const XOR: Opcode = commuting(1, 0xef);
pub(super) const ADD_32: Opcode = commuting(1, 0xfe);
pub(super) const ADD_64: Opcode = commuting(1, 0xd4);
pub(super) const SUB_32: Opcode = plain(1, 0xfa);
pub(super) const SUB_64: Opcode = plain(1, 0xfb);
pub(super) const EQUAL_32: Opcode = commuting(1, 0x76);
pub(super) const EQUAL_64: Opcode = commuting(2, 0x29);
pub(super) const GREATER_32: Opcode = plain(1, 0x66);
pub(super) const GREATER_64: Opcode = plain(2, 0x37);
pub(super) const LEAST_32: Opcode = commuting(2, 0x3b);
pub(super) const GREATEST_32: Opcode = commuting(2, 0x3f);
pub(super) const LEAST_SIGNED_32: Opcode = commuting(2, 0x39);
pub(super) const GREATEST_SIGNED_32: Opcode = commuting(2, 0x3d);
pub(super) const MUL_32: Opcode = commuting(2, 0x40);
pub(super) const LEFT_EACH_32: Opcode = plain(2, 0x47);
pub(super) const RIGHT_EACH_32: Opcode = plain(2, 0x45);
pub(super) const RIGHT_SIGNED_EACH_32: Opcode = plain(2, 0x46);
pub(super) const LEFT_EACH_64: Opcode = Opcode { wide: true, ..LEFT_EACH_32 };
pub(super) const RIGHT_EACH_64: Opcode = Opcode { wide: true, ..RIGHT_EACH_32 };

/// Numbers of 64 bits in floating point; of their greatest the second where one is not a number.
pub(super) const ADD_REAL: Opcode = plain(1, 0x58);
pub(super) const SUB_REAL: Opcode = plain(1, 0x5c);
pub(super) const MUL_REAL: Opcode = plain(1, 0x59);
pub(super) const DIV_REAL: Opcode = plain(1, 0x5e);
pub(super) const GREATEST_REAL: Opcode = plain(1, 0x5f);
/// Of one operand.
pub(super) const ROOT: Opcode = plain(1, 0x51);
/// Of one operand: without its fraction.
pub(super) const TRUNCATE: Opcode = Opcode { last: Some(3), ..plain(3, 0x09) };
/// The low half of a vector, its words of 32 bits with zeros above each.
pub(super) const EXTEND: Opcode = plain(2, 0x35);
/// The same with the signs above each.
pub(super) const EXTEND_SIGNED: Opcode = plain(2, 0x25);
/// The halves of a vector change places.
pub(super) const SWAP_HALVES: Opcode = Opcode { wide: true, last: Some(0x4e), ..plain(3, 0x00) };
/// Of each half, the even words of 32 bits of two vectors.
pub(super) const EVEN: Opcode = Opcode { prefix: 0, last: Some(0x88), ..plain(1, 0xc6) };
/// The two quarters in the middle change places.
pub(super) const SWAP_MIDDLE: Opcode = Opcode { last: Some(0xd8), ..SWAP_HALVES };

const LOAD: Opcode = Opcode { prefix: 2, ..plain(1, 0x6f) };
const STORE: Opcode = Opcode { prefix: 2, ..plain(1, 0x7f) };
const TEST: Opcode = plain(2, 0x17);
const BLEND: Opcode = plain(3, 0x4c);

/// A shift by a constant.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Shift {
    byte: u8,
    /// What is in the field of a register.
    extension: u8,
}

pub(super) const LEFT_32: Shift = Shift { byte: 0x72, extension: 6 };
pub(super) const RIGHT_32: Shift = Shift { byte: 0x72, extension: 2 };
pub(super) const RIGHT_SIGNED_32: Shift = Shift { byte: 0x72, extension: 4 };
pub(super) const LEFT_64: Shift = Shift { byte: 0x73, extension: 6 };
pub(super) const RIGHT_64: Shift = Shift { byte: 0x73, extension: 2 };

/// The function `fn(frame: rdi, samples: rsi) -> samples done` as it grows: a loop that may be left in its middle.
#[derive(Default)]
pub(super) struct Assembler {
    pub(super) code: Vec<u8>,
    start: usize,
    /// Where the distance to the end is to be written.
    exits: Vec<usize>,
}

impl Assembler {
    pub(super) fn new() -> Assembler {
        // mov rax, rsi
        let code = vec![0x48, 0x89, 0xf0];
        Assembler { start: code.len(), code, exits: Vec::new() }
    }

    /// Three operands: `target` and `a` in their fields of the prefix, `b` a register or a cell.
    fn encode(&mut self, opcode: Opcode, target: u8, a: u8, b: Operand) {
        let beyond = |register: u8| register >> 3;
        let extended = match b {
            Operand::Register(Register(b)) => beyond(b),
            Operand::Cell(_) => 0,
        };
        let second = (1 - beyond(target)) << 7 | 1 << 6 | (1 - extended) << 5 | opcode.map;
        let third = u8::from(opcode.wide) << 7 | (15 - a) << 3 | 1 << 2 | opcode.prefix;
        self.code.extend([0xc4, second, third, opcode.byte]);
        let field = (target & 7) << 3;
        match b {
            Operand::Register(Register(b)) => self.code.push(0b1100_0000 | field | b & 7),
            Operand::Cell(cell) => {
                let place = i32::try_from(cell * BYTES).unwrap_or(i32::MAX);
                // Relative to rdi.
                match i8::try_from(place) {
                    Ok(place) => self.code.extend([0b0100_0111 | field, place.cast_unsigned()]),
                    Err(_) => {
                        self.code.push(0b1000_0111 | field);
                        self.code.extend(place.to_le_bytes());
                    }
                }
            }
        }
    }

    pub(super) fn one(&mut self, opcode: Opcode, target: Register, a: Operand) {
        self.encode(opcode, target.0, 0, a);
        self.code.extend(opcode.last);
    }

    pub(super) fn two(&mut self, opcode: Opcode, target: Register, a: Register, b: Operand) {
        self.encode(opcode, target.0, a.0, b);
        self.code.extend(opcode.last);
    }

    pub(super) fn shift(&mut self, shift: Shift, target: Register, a: Register, by: u8) {
        // The target is where the first operand usually is.
        self.encode(plain(1, shift.byte), shift.extension, target.0, Operand::Register(a));
        self.code.push(by);
    }

    /// `high` where the top bit of each byte of `condition` is 1, else `low`.
    pub(super) fn blend(&mut self, target: Register, low: Register, high: Operand, condition: Register) {
        self.encode(BLEND, target.0, low.0, high);
        self.code.push(condition.0 << 4);
    }

    pub(super) fn load(&mut self, target: Register, from: Operand) {
        self.encode(LOAD, target.0, 0, from);
    }

    pub(super) fn store(&mut self, from: Register, cell: usize) {
        self.encode(STORE, from.0, 0, Operand::Cell(cell));
    }

    /// Leaves where a register and an operand have a bit in common.
    pub(super) fn leave_if(&mut self, a: Register, b: Operand) {
        self.encode(TEST, a.0, 0, b);
        self.code.extend([0x0f, 0x85]);
        self.exits.push(self.code.len());
        self.code.extend([0; 4]);
    }

    /// The end of the loop, and the way out.
    pub(super) fn finish(mut self) -> Vec<u8> {
        // dec rsi; jnz start
        self.code.extend([0x48, 0xff, 0xce, 0x0f, 0x85]);
        let start = distance(self.code.len() + 4, self.start);
        self.code.extend(start);
        for at in std::mem::take(&mut self.exits) {
            let exit = distance(at + 4, self.code.len());
            self.code[at..at + 4].copy_from_slice(&exit);
        }
        // sub rax, rsi; vzeroupper; ret
        self.code.extend([0x48, 0x29, 0xf0, 0xc5, 0xf8, 0x77, 0xc3]);
        self.code
    }
}

fn distance(from: usize, to: usize) -> [u8; 4] {
    let signed = |place: usize| i32::try_from(place).unwrap_or(i32::MAX);
    (signed(to) - signed(from)).to_le_bytes()
}
