//! Recipes of random netlists: plain data that shrinks well, and the description that follows them.
//!
//! An operand is a number that picks a signal among those made so far; a second operand is cut or extended to the width
//! of the first, so that every recipe describes a netlist without mistakes.

use proptest::prelude::*;
use stepwave_netlist::cells::{Format, NamedNet, Net, ScopeId};
use stepwave_netlist::dsl::{Memory, Module, Register, Scope, Signal};
use stepwave_netlist::{Netlist, OnOverflow, Width};

/// A random netlist.
#[derive(Clone, Debug)]
pub(crate) struct Recipe {
    on_overflow: OnOverflow,
    inputs: Vec<Shape>,
    registers: Vec<RegisterRecipe>,
    memories: Vec<MemoryRecipe>,
    cells: Vec<CellRecipe>,
    invariants: Vec<u16>,
}

#[derive(Clone, Copy, Debug)]
struct Shape {
    bits: u32,
    signed: bool,
}

#[derive(Clone, Debug)]
struct RegisterRecipe {
    shape: Shape,
    reset: u64,
    format: Format,
    /// Arms of the chain: condition and value.
    arms: Vec<(u16, u16)>,
    /// The value where no arm is taken; `None` holds.
    otherwise: Option<u16>,
}

#[derive(Clone, Debug)]
struct MemoryRecipe {
    bits: u32,
    words: u64,
    initial: Vec<u64>,
    /// Addresses of cells that read it, in front of all other cells.
    reads: Vec<u16>,
    /// Ports: enable, address, data, mask.
    ports: Vec<(u16, u16, u16, Option<u16>)>,
}

#[derive(Clone, Debug)]
struct CellRecipe {
    operator: Operator,
    operands: [u16; 3],
    /// A width, a position or a constant, as the operator needs it.
    parameter: u64,
    named: bool,
}

#[derive(Clone, Copy, Debug)]
enum Operator {
    Not,
    And,
    Or,
    Xor,
    Mux,
    WrappingAdd,
    WrappingSub,
    WrappingMul,
    DivOrZero,
    RemOrZero,
    ShiftLeft,
    ShiftRight,
    CarryingAdd,
    BorrowingSub,
    SaturatingAdd,
    SaturatingSub,
    StrictAdd,
    StrictSub,
    Equals,
    IsNonzero,
    LessThan,
    Msb,
    Slice,
    Concat,
    Extend,
    Reread,
    Literal,
    Read,
}

const OPERATORS: [Operator; 28] = [
    Operator::Not,
    Operator::And,
    Operator::Or,
    Operator::Xor,
    Operator::Mux,
    Operator::WrappingAdd,
    Operator::WrappingSub,
    Operator::WrappingMul,
    Operator::DivOrZero,
    Operator::RemOrZero,
    Operator::ShiftLeft,
    Operator::ShiftRight,
    Operator::CarryingAdd,
    Operator::BorrowingSub,
    Operator::SaturatingAdd,
    Operator::SaturatingSub,
    Operator::StrictAdd,
    Operator::StrictSub,
    Operator::Equals,
    Operator::IsNonzero,
    Operator::LessThan,
    Operator::Msb,
    Operator::Slice,
    Operator::Concat,
    Operator::Extend,
    Operator::Reread,
    Operator::Literal,
    Operator::Read,
];

/// Names that a text form must escape.
const ODD_NAMES: [&str; 6] =
    ["two words", r#"a "quote""#, r"back\slash\", "line\nfeed\ttab\0", "第一拍", "\u{301}\u{200b} it's {u}"];

fn bits() -> impl Strategy<Value = u32> {
    prop_oneof![3 => 1u32..=8, 3 => 1u32..=64, 1 => Just(1u32), 1 => 62u32..=64]
}

/// A word whose low bits are often all ones, all zeros, or a sign bit.
pub(crate) fn value() -> impl Strategy<Value = u64> {
    let edge = (0u32..64, -1i64..=1).prop_map(|(bit, beside)| (1u64 << bit).wrapping_add_signed(beside));
    prop_oneof![any::<u64>(), 0u64..16, edge, Just(0), Just(u64::MAX)]
}

fn shape() -> impl Strategy<Value = Shape> {
    (bits(), any::<bool>()).prop_map(|(bits, signed)| Shape { bits, signed })
}

fn format() -> impl Strategy<Value = Format> {
    let odd = prop::sample::select(&ODD_NAMES[..]).prop_map(str::to_owned);
    let state_name = prop_oneof!["[A-Z]{1,6}", odd];
    let states = prop::collection::vec((value(), state_name), 0..4).prop_map(Format::States);
    prop_oneof![
        Just(Format::Unsigned),
        Just(Format::Signed),
        Just(Format::Analog),
        Just(Format::Level),
        Just(Format::Binary),
        states
    ]
}

fn register() -> impl Strategy<Value = RegisterRecipe> {
    let arms = prop::collection::vec(any::<(u16, u16)>(), 0..3);
    (shape(), value(), format(), arms, any::<Option<u16>>())
        .prop_map(|(shape, reset, format, arms, otherwise)| RegisterRecipe { shape, reset, format, arms, otherwise })
}

fn memory() -> impl Strategy<Value = MemoryRecipe> {
    let port = any::<(u16, u16, u16, Option<u16>)>();
    let words = prop_oneof![1u64..=5, Just(8u64), Just(16u64), 1u64..300];
    let reads = prop::collection::vec(any::<u16>(), 1..4);
    (bits(), words, prop::collection::vec(value(), 0..20), reads, prop::collection::vec(port, 0..3))
        .prop_map(|(bits, words, initial, reads, ports)| MemoryRecipe { bits, words, initial, reads, ports })
}

fn cell() -> impl Strategy<Value = CellRecipe> {
    (prop::sample::select(&OPERATORS[..]), any::<[u16; 3]>(), value(), prop::bool::weighted(0.4))
        .prop_map(|(operator, operands, parameter, named)| CellRecipe { operator, operands, parameter, named })
}

/// The same with many multiplexers and gates, so that what most cells come to is not needed in every clock.
#[allow(dead_code, reason = "the example that writes random netlists takes them as they come")]
pub(crate) fn choosing(mut recipe: Recipe) -> Recipe {
    for cell in &mut recipe.cells {
        cell.operator = match cell.parameter % 5 {
            0 | 1 => Operator::Mux,
            2 if cell.operands[0] % 2 == 0 => Operator::And,
            2 => Operator::Or,
            _ => cell.operator,
        };
    }
    recipe
}

/// Random netlists.
pub(crate) fn recipe() -> impl Strategy<Value = Recipe> {
    recipe_of(1..40)
}

/// Random netlists of about this many cells.
pub(crate) fn recipe_of(cells: std::ops::Range<usize>) -> impl Strategy<Value = Recipe> {
    (
        prop::sample::select(&[OnOverflow::Trap, OnOverflow::Saturate, OnOverflow::Wrap][..]),
        prop::collection::vec(shape(), 1..4),
        prop::collection::vec(register(), 1..5),
        prop_oneof![3 => Just(Vec::new()), 2 => prop::collection::vec(memory(), 1..3)],
        prop::collection::vec(cell(), cells),
        prop::collection::vec(any::<u16>(), 0..3),
    )
        .prop_map(|(on_overflow, inputs, registers, memories, cells, invariants)| Recipe {
            on_overflow,
            inputs,
            registers,
            memories,
            cells,
            invariants,
        })
}

/// The netlist of a recipe.
pub(crate) fn build(recipe: &Recipe) -> Netlist {
    let module = Module::with_overflow("random", recipe.on_overflow);
    let top = module.top();
    let outer = top.scope("outer");
    let mut kitchen = Kitchen { scopes: [top, outer, outer.scope("inner")], memories: Vec::new(), pool: Vec::new() };
    for (index, shape) in recipe.inputs.iter().enumerate() {
        let (scope, name) = (kitchen.scope(index), format!("in{index}"));
        let Shape { bits, signed } = *shape;
        kitchen.pool.push(if signed { scope.input_signed(&name, bits) } else { scope.input(&name, bits) });
    }
    let registers: Vec<Register<'_>> =
        recipe.registers.iter().enumerate().map(|(i, r)| kitchen.register(i, r)).collect();
    for (index, memory) in recipe.memories.iter().enumerate() {
        let made = kitchen.scope(index).memory(&format!("m{index}"), memory.bits, memory.words);
        let words = memory.initial.iter().map(|word| word & (u64::MAX >> (64 - memory.bits)));
        let made = made.initial(words.take(usize::try_from(memory.words).unwrap()));
        kitchen.memories.push((made, memory.bits));
        for &address in &memory.reads {
            let read = made.read(kitchen.address(address));
            kitchen.pool.push(read);
        }
    }
    for (index, cell) in recipe.cells.iter().enumerate() {
        let made = kitchen.cook(index, cell);
        if cell.named {
            kitchen.scope(usize::from(cell.operands[2])).name(&format!("n{index}"), made);
        }
        kitchen.pool.push(made);
    }
    for (register, recipe) in registers.into_iter().zip(&recipe.registers) {
        kitchen.close(register, recipe);
    }
    for ((memory, bits), recipe) in kitchen.memories.iter().zip(&recipe.memories) {
        for &(enable, address, data, mask) in &recipe.ports {
            let mask = mask.map(|mask| kitchen.fit(mask, *bits));
            memory.write(kitchen.flag(enable), kitchen.address(address), kitchen.fit(data, *bits), mask);
        }
    }
    for (index, &holds) in recipe.invariants.iter().enumerate() {
        kitchen.scope(index).invariant(ODD_NAMES[usize::from(holds) % ODD_NAMES.len()], kitchen.flag(holds));
    }
    with_words(module.finish().unwrap())
}

/// The netlist with names of words of more than 64 bits, where it has nets of 64 bits: of two of them and of the last net.
fn with_words(mut netlist: Netlist) -> Netlist {
    let parts: Vec<Net> = netlist.nets().filter(|&net| netlist.width(net) == Width::MAX).collect();
    let Some((&first, &last)) = parts.first().zip(parts.last()) else { return netlist };
    let Some(top) = netlist.nets().last() else { return netlist };
    let scopes = u32::try_from(netlist.scopes.len()).unwrap();
    for (index, above, format) in [(0, vec![top], Format::Signed), (1, vec![last, top], Format::Unsigned)] {
        let scope = ScopeId((index + top.0) % scopes);
        let output = index == 1;
        netlist.names.push(NamedNet { above, output, ..NamedNet::new(first, scope, &format!("w{index}"), format) });
    }
    netlist
}

/// Signals made so far, and the scopes that they are spread over.
struct Kitchen<'m> {
    scopes: [Scope<'m>; 3],
    /// With the width of a word.
    memories: Vec<(Memory<'m>, u32)>,
    pool: Vec<Signal<'m>>,
}

impl<'m> Kitchen<'m> {
    fn scope(&self, index: usize) -> Scope<'m> {
        self.scopes[index % self.scopes.len()]
    }

    fn pick(&self, index: u16) -> Signal<'m> {
        self.pool[usize::from(index) % self.pool.len()]
    }

    /// One bit of a signal.
    fn flag(&self, index: u16) -> Signal<'m> {
        let signal = self.pick(index);
        signal.bit(u32::from(index >> 8) % signal.bits())
    }

    /// Mostly of few bits, as most memories are small.
    fn address(&self, index: u16) -> Signal<'m> {
        if index.is_multiple_of(4) { self.pick(index) } else { narrowed(self.pick(index), 1 + u32::from(index % 9)) }
    }

    /// A signal cut or extended to a width.
    fn fit(&self, index: u16, bits: u32) -> Signal<'m> {
        narrowed(self.pick(index), bits).extend(bits)
    }

    fn register(&mut self, index: usize, recipe: &RegisterRecipe) -> Register<'m> {
        let (scope, name) = (self.scope(index), format!("r{index}"));
        let Shape { bits, signed } = recipe.shape;
        let register = if signed { scope.reg_signed(&name, bits) } else { scope.reg(&name, bits) };
        let register = register.reset(recipe.reset & (u64::MAX >> (64 - bits))).shown(recipe.format.clone());
        self.pool.push(register.q);
        register
    }

    fn close(&self, register: Register<'m>, recipe: &RegisterRecipe) {
        let bits = register.q.bits();
        let value = |index| self.fit(index, bits);
        let Some((&(condition, first), rest)) = recipe.arms.split_first() else {
            return register.set(recipe.otherwise.map_or(!register.q, value));
        };
        let mut chain = register.when(self.flag(condition), value(first));
        for &(condition, arm) in rest {
            chain = chain.when(self.flag(condition), value(arm));
        }
        match recipe.otherwise {
            Some(otherwise) => chain.otherwise(value(otherwise)),
            None => chain.else_hold(),
        }
    }

    /// Makes one signal; by-products go to the pool.
    fn cook(&mut self, index: usize, cell: &CellRecipe) -> Signal<'m> {
        let CellRecipe { operator, operands: [a, b, c], parameter, .. } = *cell;
        let left = self.pick(a);
        let right = self.fit(b, left.bits());
        // A number from 0 to below the limit.
        let below = |limit: u32| u32::try_from(parameter % u64::from(limit)).unwrap();
        match operator {
            Operator::Not => !left,
            Operator::Read => match self.memories.get(usize::from(c) % self.memories.len().max(1)) {
                Some((memory, _)) => memory.read(self.address(a)),
                None => left,
            },
            Operator::And => left & right,
            Operator::Or => left | right,
            Operator::Xor => left ^ right,
            Operator::Mux => self.flag(c).mux(left, right),
            Operator::WrappingAdd => left.wrapping_add(right),
            Operator::WrappingSub => left.wrapping_sub(right),
            Operator::WrappingMul => left.wrapping_mul(right),
            Operator::DivOrZero => left.div_or_zero(right),
            Operator::RemOrZero => left.rem_or_zero(right),
            Operator::ShiftLeft | Operator::ShiftRight => {
                // Mostly less than the width.
                let amount = if c % 4 == 0 { self.pick(b) } else { narrowed(self.pick(b), 1 + below(7)) };
                if matches!(operator, Operator::ShiftLeft) { left.shift_left(amount) } else { left.shift_right(amount) }
            }
            Operator::CarryingAdd | Operator::BorrowingSub => {
                let adds = matches!(operator, Operator::CarryingAdd);
                let (flag, result) = if adds { left.carrying_add(right) } else { left.borrowing_sub(right) };
                self.pool.push(flag);
                result
            }
            Operator::SaturatingAdd => left.saturating_add(self.addend(left, b)),
            Operator::SaturatingSub => left.saturating_sub(self.addend(left, b)),
            Operator::StrictAdd | Operator::StrictSub => {
                // A net of its own, so that no other strict operator has its name.
                let left = self.scope(usize::from(c)).name(&format!("s{index}"), !left);
                let (right, enable) = (self.addend(left, b), self.flag(c));
                let adds = matches!(operator, Operator::StrictAdd);
                if adds { left.strict_add(right, enable) } else { left.strict_sub(right, enable) }
            }
            Operator::Equals => left.equals(right),
            Operator::IsNonzero => left.is_nonzero(),
            Operator::LessThan => left.less_than(right),
            Operator::Msb => left.msb(),
            Operator::Slice => {
                let low = below(left.bits());
                left.slice(low, 1 + u32::from(c) % (left.bits() - low))
            }
            Operator::Concat => {
                let high = narrowed(left, 63);
                high.concat(narrowed(self.pick(b), 64 - high.bits()))
            }
            Operator::Extend => left.extend(left.bits() + below(65 - left.bits())),
            Operator::Reread => {
                if left.is_signed() {
                    left.as_unsigned()
                } else {
                    left.as_signed()
                }
            }
            Operator::Literal => self.scope(index).lit(1 + u32::from(a) % 64, parameter & (u64::MAX >> (63 - a % 64))),
        }
    }

    /// A right operand of any width and reading that a sum of at most 64 bits holds exactly.
    fn addend(&self, left: Signal<'m>, index: u16) -> Signal<'m> {
        let right = self.pick(index);
        if left.bits() > 62 {
            if left.is_signed() && !right.is_signed() {
                return narrowed(right, left.bits() - 1);
            }
            let right = narrowed(right, left.bits());
            return if left.is_signed() { right.as_signed() } else { right.as_unsigned() };
        }
        if right.bits() > 62 { right.slice(0, 62) } else { right }
    }
}

/// At most this many bits of a signal.
fn narrowed(signal: Signal<'_>, bits: u32) -> Signal<'_> {
    if signal.bits() > bits { signal.slice(0, bits) } else { signal }
}
