//! Random netlists of so few bits that all their runs can be explored.

use proptest::prelude::*;
use stepwave::netlist::cells::{Cell, Claim, Memory, Op, Property, ScopeId, WritePort};
use stepwave::netlist::{Design, Net, Netlist, Width};
use stepwave::prove::sat::{Inputs, Question};

/// A netlist and what is asked of it.
#[derive(Clone, Debug)]
pub(super) struct Asked {
    pub(super) netlist: Netlist,
    goals: usize,
    pub(super) inputs: Inputs,
}

impl Asked {
    pub(super) fn question<'d>(&self, design: &'d Design) -> Question<'d> {
        let goals = (0..self.goals).collect();
        let assumptions = (self.goals..design.netlist().properties.len()).collect();
        Question { design, goals, assumptions, inputs: self.inputs.clone() }
    }
}

type Numbers = [u16; 4];

pub(super) fn asked() -> impl Strategy<Value = Asked> {
    let numbers = || any::<Numbers>();
    let registers = prop::collection::vec((1u32..=3, numbers()), 1..=3);
    let cells = prop::collection::vec(numbers(), 3..14);
    let properties = (1usize..=3, prop::collection::vec(numbers(), 4), 0usize..=1);
    let rows = prop::collection::vec(any::<[u8; 2]>(), 0..3);
    (
        prop::collection::vec(1u32..=2, 0..=2),
        registers,
        prop::option::of(numbers()),
        cells,
        properties,
        rows,
        any::<u8>(),
    )
        .prop_map(|(inputs, registers, memory, cells, properties, rows, fixed)| {
            let mut build = Build { netlist: Netlist::new("m"), pool: Vec::new() };
            let inputs: Vec<Net> = inputs.iter().map(|&bits| build.cell(Op::Input, bits)).collect();
            build.describe(&registers, memory, &cells);
            let (goals, numbers, assumptions) = properties;
            for numbers in &numbers[..goals + assumptions] {
                build.property(numbers);
            }
            Asked { inputs: build.fixed(&inputs, &rows, fixed), netlist: build.netlist, goals }
        })
}

struct Build {
    netlist: Netlist,
    pool: Vec<Net>,
}

fn width(bits: u32) -> Width {
    Width::new(u64::from(bits)).expect("a width")
}

impl Build {
    fn cell(&mut self, op: Op, bits: u32) -> Net {
        let net = Net(u32::try_from(self.netlist.cells.len()).expect("few cells"));
        self.netlist.cells.push(Cell { op, width: width(bits) });
        self.netlist.sources.push(None);
        self.pool.push(net);
        net
    }

    fn bits(&self, net: Net) -> u32 {
        self.netlist.width(net).get()
    }

    fn pick(&self, number: u16) -> Net {
        // Mostly what came last, so that chains grow long.
        let number = usize::from(number);
        let near = self.pool.len().min(6);
        if number.is_multiple_of(3) {
            self.pool[number / 3 % self.pool.len()]
        } else {
            self.pool[self.pool.len() - 1 - number / 3 % near]
        }
    }

    /// A net cut or extended to some bits.
    fn fit(&mut self, number: u16, bits: u32) -> Net {
        let net = self.pick(number);
        let own = self.bits(net);
        match own.cmp(&bits) {
            std::cmp::Ordering::Equal => net,
            std::cmp::Ordering::Less if number.is_multiple_of(2) => self.cell(Op::SignExtend(net), bits),
            std::cmp::Ordering::Less => self.cell(Op::ZeroExtend(net), bits),
            std::cmp::Ordering::Greater => {
                let low = u8::try_from(u32::from(number) % (own - bits + 1)).expect("a bit");
                self.cell(Op::Slice { of: net, low }, bits)
            }
        }
    }

    fn describe(&mut self, registers: &[(u32, Numbers)], memory: Option<Numbers>, cells: &[Numbers]) {
        let made: Vec<(Net, u32)> = registers
            .iter()
            .map(|&(bits, numbers)| {
                let reset = u64::from(numbers[0]) & width(bits).mask();
                (self.cell(Op::Register { next: None, reset }, bits), bits)
            })
            .collect();
        let constant = u64::from(registers[0].1[1]) & 7;
        self.cell(Op::Const(constant), 3);
        if memory.is_some() {
            // Three words, so that one address is outside.
            let (scope, name, writes) = (ScopeId::TOP, "ram".to_owned(), Vec::new());
            self.netlist.memories.push(Memory { scope, name, width: Width::ONE, size: 3, initial: vec![0, 1], writes });
        }
        for numbers in cells {
            self.operator(numbers, memory.is_some());
        }
        for ((net, bits), (_, numbers)) in made.into_iter().zip(registers) {
            let next = self.fit(numbers[2], bits);
            let Op::Register { reset, .. } = self.netlist.cell(net).op else { continue };
            self.netlist.cells[net.index()].op = Op::Register { next: Some(next), reset };
        }
        for numbers in memory.into_iter().flat_map(|numbers| [numbers, numbers.map(|number| number.rotate_left(5))]) {
            let [enable, address, data] = [(0, 1), (1, 2), (2, 1)].map(|(at, bits)| self.fit(numbers[at], bits));
            let mask = numbers[3].is_multiple_of(2).then(|| self.fit(numbers[3], 1));
            self.netlist.memories[0].writes.push(WritePort { enable, address, data, mask });
        }
    }

    fn operator(&mut self, &[operator, a, b, c]: &Numbers, memory: bool) {
        let left = self.pick(a);
        let bits = self.bits(left);
        let right = self.fit(b, bits);
        let two: [fn(Net, Net) -> Op; 8] = [Op::And, Op::Or, Op::Xor, Op::Add, Op::Sub, Op::Mul, Op::Div, Op::Rem];
        let flags: [fn(Net, Net) -> Op; 6] =
            [Op::Carry, Op::Borrow, Op::AddOverflow, Op::SubOverflow, Op::Equal, Op::LessSigned];
        let shifts: [fn(Net, Net) -> Op; 3] = [Op::ShiftLeft, Op::ShiftRight, Op::ShiftArithmetic];
        let operator = usize::from(operator) % 26;
        match operator {
            0..8 => _ = self.cell(two[operator](left, right), bits),
            8..14 => _ = self.cell(flags[operator - 8](left, right), 1),
            14..17 => {
                let by = self.pick(c);
                self.cell(shifts[operator - 14](left, by), bits);
            }
            17 => _ = self.cell(Op::Not(left), bits),
            18..22 => {
                let select = self.fit(c, 1);
                self.cell(Op::Mux { select, high: left, low: right }, bits);
            }
            22 => {
                let high = self.fit(c, 1);
                self.cell(Op::Concat { high, low: left }, bits + 1);
            }
            23 => _ = self.cell(Op::Const(u64::from(c) & width(bits).mask()), bits),
            _ if memory => _ = self.cell(Op::Read { memory: 0, address: left }, 1),
            _ => _ = self.cell(Op::Add(left, right), bits),
        }
    }

    /// A net is not a constant, or two nets are not equal.
    fn property(&mut self, numbers: &Numbers) {
        let net = self.pick(numbers[0]);
        let bits = self.bits(net);
        let other = match numbers[1] % 3 {
            0 => self.fit(numbers[2], bits),
            _ => self.cell(Op::Const(u64::from(numbers[2]) & width(bits).mask()), bits),
        };
        let never = self.cell(Op::Equal(net, other), 1);
        let name = format!("p{}", self.netlist.properties.len());
        self.netlist.properties.push(Property { name, never, claim: Claim::Invariant });
    }

    fn fixed(&self, inputs: &[Net], rows: &[[u8; 2]], fixed: u8) -> Inputs {
        let row = |values: &[u8], chosen: u8| {
            let all = inputs.iter().zip(values).enumerate().filter(|(index, _)| chosen >> index & 1 == 1);
            all.map(|(_, (&net, &value))| (net, u64::from(value) & self.netlist.width(net).mask())).collect()
        };
        let rows = rows.iter().map(|values| row(values, fixed)).collect();
        Inputs { rows, later: row(&[fixed >> 6, fixed >> 4 & 3], fixed >> 2 & fixed >> 3 & fixed) }
    }
}
