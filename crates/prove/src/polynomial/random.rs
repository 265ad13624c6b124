//! Random netlists for tests.

use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Cell, Net, Netlist, Op};

/// Numbers that look random.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// The next, from 0 to below a limit.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit
    }
}

/// Four registers of each width from 1 to 4, and cells of every operator on them.
pub(crate) fn netlist(dice: &mut Dice) -> Netlist {
    let mut netlist = Netlist::new("random");
    let mut add = |op, bits: usize| {
        netlist.cells.push(Cell { op, width: Width::new(bits as u64).unwrap() });
        (Net(u32::try_from(netlist.cells.len() - 1).unwrap()), bits)
    };
    let mut nets: Vec<(Net, usize)> = Vec::new();
    for place in 0..16 {
        nets.push(add(Op::Register { next: None, reset: 0 }, place / 4 + 1));
    }
    let constant = dice.below(16) as u64;
    nets.push(add(Op::Const(constant), 4));
    for _ in 0..40 {
        let (a, bits) = nets[dice.below(nets.len())];
        let alike: Vec<Net> = nets.iter().filter(|(_, other)| *other == bits).map(|(net, _)| *net).collect();
        let narrow: Vec<Net> = nets.iter().filter(|(_, bits)| *bits == 1).map(|(net, _)| *net).collect();
        let (b, select) = (alike[dice.below(alike.len())], narrow[dice.below(narrow.len())]);
        let (other, others) = nets[dice.below(nets.len())];
        let low = dice.below(bits);
        let (op, bits) = match dice.below(23) {
            0 => (Op::Not(a), bits),
            1 => (Op::And(a, b), bits),
            2 => (Op::Or(a, b), bits),
            3 => (Op::Xor(a, b), bits),
            4 => (Op::Mux { select, high: a, low: b }, bits),
            5 => (Op::Add(a, b), bits),
            6 => (Op::Sub(a, b), bits),
            7 => (Op::Carry(a, b), 1),
            8 => (Op::Borrow(a, b), 1),
            9 => (Op::AddOverflow(a, b), 1),
            10 => (Op::SubOverflow(a, b), 1),
            11 => (Op::Equal(a, b), 1),
            12 => (Op::LessSigned(a, b), 1),
            13 => (Op::Slice { of: a, low: u8::try_from(low).unwrap() }, 1 + dice.below(bits - low)),
            14 if bits + others <= 6 => (Op::Concat { high: a, low: other }, bits + others),
            15 if bits < 6 => (Op::ZeroExtend(a), bits + 1),
            16 if bits < 6 => (Op::SignExtend(a), bits + 1),
            17 => (Op::Mul(a, b), bits),
            18 => (Op::Div(a, b), bits),
            19 => (Op::Rem(a, b), bits),
            20 => (Op::ShiftLeft(a, other), bits),
            21 => (Op::ShiftRight(a, other), bits),
            22 => (Op::ShiftArithmetic(a, other), bits),
            _ => continue,
        };
        nets.push(add(op, bits));
    }
    for place in 0..16 {
        let alike: Vec<Net> = nets.iter().filter(|(_, bits)| *bits == place / 4 + 1).map(|(net, _)| *net).collect();
        let next = Some(alike[dice.below(alike.len())]);
        netlist.cells[place].op = Op::Register { next, reset: 0 };
    }
    netlist
}
