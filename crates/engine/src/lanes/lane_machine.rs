//! A block of lanes: its rows, and the loops that run over them.

use std::mem::swap;

use fearless_simd::{Level, dispatch};

use super::code::{Code, LaneOp, Operation, Slot};
use super::lane::{GROUP, GROUPS, Lane, LaneRow};
use super::lane_memory::{LaneMemories, View};
use super::watch::root_gap;

/// A machine that runs the same code in every lane.
pub(super) struct LaneMachine<T> {
    rows: Vec<Box<LaneRow<T>>>,
    /// Takes the result of an operation, then changes places with the row that it is for.
    spare: Box<LaneRow<T>>,
    level: Level,
}

impl<T: Lane> LaneMachine<T> {
    pub(super) fn new(code: &Code) -> LaneMachine<T> {
        let mut rows = vec![LaneRow::filled(T::default()); code.rows];
        for &(slot, pattern) in &code.constants {
            rows[slot] = LaneRow::filled(T::top(pattern));
        }
        LaneMachine { rows, spare: LaneRow::filled(T::default()), level: Level::new() }
    }

    pub(super) fn rows(&self) -> &[Box<LaneRow<T>>] {
        &self.rows
    }

    pub(super) fn rows_mut(&mut self) -> &mut [Box<LaneRow<T>>] {
        &mut self.rows
    }

    pub(super) fn get(&self, slot: Slot, lane: usize) -> T {
        self.rows[slot].get(lane)
    }

    pub(super) fn set(&mut self, slot: Slot, lane: usize, word: T) {
        self.rows[slot].set(lane, word);
    }

    /// Every register takes its next value.
    pub(super) fn edge(&mut self, code: &Code) {
        for register in &code.registers {
            if let Some(next) = register.next {
                self.rows.swap(register.row, next);
            }
        }
    }
}

/// The loops over the lanes of a machine. They belong to a word, so that they are compiled once and with this crate,
/// and not with each that calls `LaneProgram::run`.
pub(super) trait Loops: Lane {
    /// The operations, in the first `groups` groups.
    fn settle(machine: &mut LaneMachine<Self>, operations: &[Operation], groups: usize, memories: View<'_, Self>);

    /// Settles sample after sample, with an edge between them, until one of the first `lanes` lanes is not 0 in the row
    /// `stop`, or `samples` of them are settled. Gives their number, at least 1.
    fn run(
        machine: &mut LaneMachine<Self>,
        code: &Code,
        lanes: usize,
        stop: Slot,
        samples: u64,
        memories: &mut LaneMemories<Self>,
    ) -> u64 {
        let groups = lanes.div_ceil(GROUP);
        let mut done = 0;
        loop {
            Self::settle(machine, &code.operations, groups, memories.all());
            done += 1;
            if done >= samples || any(&machine.rows[stop], lanes) {
                return done;
            }
            memories.edge(code, &machine.rows, lanes, None);
            machine.edge(code);
        }
    }
}

// Every operation once for a word and a kind of processor: a large part of what the crate takes to compile.
macro_rules! loops {
    ($word:ty) => {
        impl Loops for $word {
            fn settle(on: &mut LaneMachine<Self>, operations: &[Operation], groups: usize, memories: View<'_, Self>) {
                dispatch!(on.level, _simd => settle(&mut on.rows, &mut on.spare, operations, groups, memories));
            }
        }
    };
}

loops!(u32);
loops!(u64);

/// One of the first lanes is not 0.
fn any<T: Lane>(row: &LaneRow<T>, lanes: usize) -> bool {
    let mut seen = [T::default(); GROUP];
    let whole = (lanes / GROUP).min(GROUPS);
    for group in &row.0[..whole] {
        for (seen, &word) in seen.iter_mut().zip(group) {
            *seen = seen.or(word);
        }
    }
    if let Some(group) = row.0.get(whole) {
        for (seen, &word) in seen.iter_mut().zip(&group[..lanes % GROUP]) {
            *seen = seen.or(word);
        }
    }
    seen.iter().fold(T::default(), |any, &word| any.or(word)) != T::default()
}

/// The rows that operations read. Operands are copied a group at a time: so the compiler knows that writing the result
/// does not change them: it uses vectors, and keeps the copies in registers.
struct Operands<'a, T> {
    rows: &'a [Box<LaneRow<T>>],
    groups: usize,
    memories: View<'a, T>,
}

impl<T: Lane> Operands<'_, T> {
    #[inline(always)]
    fn one(&self, out: &mut LaneRow<T>, a: Slot, of: impl Fn(T) -> T) {
        for (out, a) in out.0.iter_mut().zip(&self.rows[a].0).take(self.groups) {
            let a = *a;
            for lane in 0..GROUP {
                out[lane] = of(a[lane]);
            }
        }
    }

    #[inline(always)]
    fn read(&self, out: &mut LaneRow<T>, address: Slot, bits: u32, memory: usize) {
        for lane in 0..self.groups * GROUP {
            out.set(lane, self.memories.word(memory, lane, self.rows[address].get(lane), bits));
        }
    }

    #[inline(always)]
    fn two(&self, out: &mut LaneRow<T>, a: Slot, b: Slot, of: impl Fn(T, T) -> T) {
        let operands = self.rows[a].0.iter().zip(&self.rows[b].0);
        for (out, (a, b)) in out.0.iter_mut().zip(operands).take(self.groups) {
            let (a, b) = (*a, *b);
            for lane in 0..GROUP {
                out[lane] = of(a[lane], b[lane]);
            }
        }
    }

    #[inline(always)]
    fn three(&self, out: &mut LaneRow<T>, [a, b, c]: [Slot; 3], of: impl Fn(T, T, T) -> T) {
        let operands = self.rows[a].0.iter().zip(&self.rows[b].0).zip(&self.rows[c].0);
        for (out, ((a, b), c)) in out.0.iter_mut().zip(operands).take(self.groups) {
            let (a, b, c) = (*a, *b, *c);
            for lane in 0..GROUP {
                out[lane] = of(a[lane], b[lane], c[lane]);
            }
        }
    }

    #[inline(always)]
    fn four(&self, out: &mut LaneRow<T>, [a, b, c, d]: [Slot; 4], of: impl Fn(T, T, T, T) -> T) {
        let operands = self.rows[a].0.iter().zip(&self.rows[b].0).zip(&self.rows[c].0).zip(&self.rows[d].0);
        for (out, (((a, b), c), d)) in out.0.iter_mut().zip(operands).take(self.groups) {
            let (a, b, c, d) = (*a, *b, *c, *d);
            for lane in 0..GROUP {
                out[lane] = of(a[lane], b[lane], c[lane], d[lane]);
            }
        }
    }
}

#[inline(always)]
fn settle<T: Lane>(
    rows: &mut [Box<LaneRow<T>>],
    spare: &mut Box<LaneRow<T>>,
    operations: &[Operation],
    groups: usize,
    memories: View<'_, T>,
) {
    for operation in operations {
        perform(Operands { rows, groups, memories }, spare, operation.what);
        swap(&mut rows[operation.target], spare);
    }
}

/// The meaning of every operation; the loops inside are unrolled and vectorised, and none of them branches but that which
/// reads memories.
#[inline(always)]
fn perform<T: Lane>(on: Operands<'_, T>, out: &mut LaneRow<T>, what: LaneOp<Slot>) {
    let top = T::BITS - 1;
    match what {
        LaneOp::Copy(a) => on.one(out, a, |a| a),
        LaneOp::Invert(a, p) => {
            let p = T::top(p);
            on.one(out, a, |a| a.xor(p));
        }
        LaneOp::Mask(a, p) => {
            let p = T::top(p);
            on.one(out, a, |a| a.and(p));
        }
        LaneOp::And(a, b) => on.two(out, a, b, T::and),
        LaneOp::AndNot(a, b) => on.two(out, a, b, |a, b| a.and(b.not())),
        LaneOp::Or(a, b) => on.two(out, a, b, T::or),
        LaneOp::Xor(a, b) => on.two(out, a, b, T::xor),
        LaneOp::Select(select, high, low) => {
            on.three(out, [select, high, low], |select, high, low| high.and(select).or(low.and(select.not())));
        }
        LaneOp::Add(a, b) => on.two(out, a, b, T::add),
        LaneOp::Sub(a, b) => on.two(out, a, b, T::sub),
        LaneOp::AddWhere(a, condition, p) => {
            let p = T::top(p);
            on.two(out, a, condition, |a, condition| a.add(condition.and(p)));
        }
        LaneOp::AddEither(a, b, p, c, q) => {
            let (p, q) = (T::top(p), T::top(q));
            on.three(out, [a, b, c], |a, b, c| a.add(b.and(p)).add(c.and(q)));
        }
        LaneOp::AddIf(a, b, condition) => on.three(out, [a, b, condition], |a, b, condition| a.add(b.and(condition))),
        LaneOp::SubIf(a, b, condition) => on.three(out, [a, b, condition], |a, b, condition| a.sub(b.and(condition))),
        LaneOp::Mul(a, b, bits) => on.two(out, a, b, |a, b| a.mul(b.right(T::BITS - bits))),
        LaneOp::Div(a, b, bits) => on.two(out, a, b, |a, b| a.div(b).left(T::BITS - bits)),
        LaneOp::Rem(a, b) => on.two(out, a, b, T::rem),
        LaneOp::ShiftLeft(a, by, bits) => on.two(out, a, by, |a, by| {
            let by = by.amount(bits, T::BITS);
            if by < T::BITS { a.left(by) } else { T::default() }
        }),
        LaneOp::ShiftRight(a, by, bits, p) => {
            let p = T::top(p);
            on.two(out, a, by, |a, by| {
                let by = by.amount(bits, T::BITS);
                if by < T::BITS { a.right(by).and(p) } else { T::default() }
            });
        }
        LaneOp::ShiftArithmetic(a, by, bits, p) => {
            let p = T::top(p);
            on.two(out, a, by, |a, by| a.right_signed(by.amount(bits, top)).and(p));
        }
        LaneOp::Carry(a, b) => on.two(out, a, b, |a, b| T::mask(a.add(b) < a)),
        LaneOp::Less(a, b) => on.two(out, a, b, |a, b| T::mask(a < b)),
        LaneOp::LessSigned(a, b) => on.two(out, a, b, |a, b| T::mask(a.less_signed(b))),
        LaneOp::LessIf(a, b, condition) => {
            on.three(out, [a, b, condition], |a, b, condition| T::mask(a < b.and(condition)));
        }
        LaneOp::Equal(a, b) => on.two(out, a, b, |a, b| T::mask(a == b)),
        LaneOp::EqualTo(a, p) => {
            let p = T::top(p);
            on.one(out, a, |a| T::mask(a == p));
        }
        LaneOp::EqualIf(a, p, condition) => {
            let p = T::top(p);
            on.two(out, a, condition, |a, condition| T::mask(a == p).and(condition));
        }
        LaneOp::EqualIfOr(a, p, condition, or) => {
            let p = T::top(p);
            on.three(out, [a, condition, or], |a, condition, or| T::mask(a == p).and(condition).or(or));
        }
        LaneOp::EqualEitherOr(a, [(p, first), (q, second)], or) => {
            let (p, q) = (T::top(p), T::top(q));
            on.four(out, [a, first, second, or], |a, first, second, or| {
                T::mask(a == p).and(first).or(T::mask(a == q).and(second)).or(or)
            });
        }
        LaneOp::AddOverflow(a, b) => on.two(out, a, b, |a, b| {
            let sum = a.add(b);
            a.xor(sum).and(b.xor(sum)).right_signed(top)
        }),
        LaneOp::SubOverflow(a, b) => {
            on.two(out, a, b, |a, b| a.xor(b).and(a.xor(a.sub(b))).right_signed(top));
        }
        LaneOp::Left(a, by, p) => {
            let p = T::top(p);
            on.one(out, a, |a| a.left(by).and(p));
        }
        LaneOp::Right(a, by) => on.one(out, a, |a| a.right(by)),
        LaneOp::RightSigned(a, by) => on.one(out, a, |a| a.right_signed(by)),
        LaneOp::Bit(a, by) => on.one(out, a, |a| a.left(by).right_signed(top)),
        LaneOp::Concat(high, low, by, p, q) => {
            let (p, q) = (T::top(p), T::top(q));
            on.two(out, high, low, |high, low| high.and(p).or(low.right(by).and(q)));
        }
        LaneOp::Fits(a, by) => on.one(out, a, |a| T::mask(a.left(by).right_signed(by) == a)),
        LaneOp::UnfitIfOr(a, by, condition, or) => on.three(out, [a, condition, or], |a, condition, or| {
            T::mask(a.left(by).right_signed(by) != a).and(condition).or(or)
        }),
        LaneOp::Read(address, bits, memory) => on.read(out, address, bits, memory),
        LaneOp::Count(sum, a) => on.two(out, sum, a, |sum, a| sum.sub(T::mask(a != T::default()))),
        LaneOp::Idle(clocks, a, b) => {
            let (zero, one) = (T::default(), T::number(1));
            on.three(out, [clocks, a, b], |clocks, a, b| clocks.add(one).and(T::mask(a.or(b) == zero)));
        }
        LaneOp::Least(a, b) => on.two(out, a, b, |a, b| if b < a { b } else { a }),
        LaneOp::Greatest(a, b) => on.two(out, a, b, |a, b| if a < b { b } else { a }),
        LaneOp::LeastSigned(a, b) => on.two(out, a, b, |a, b| if b.less_signed(a) { b } else { a }),
        LaneOp::GreatestSigned(a, b) => on.two(out, a, b, |a, b| if a.less_signed(b) { b } else { a }),
        LaneOp::Sum(sum, a, bits) => on.two(out, sum, a, |sum, a| sum.add(a.right(T::BITS - bits))),
        LaneOp::RootGaps(sum, [(base, p), (offset, q)]) => on.three(out, [sum, base, offset], |sum, base, offset| {
            let (base, offset) = (base.right(T::BITS - p).real(), offset.right_signed(T::BITS - q).real_signed());
            sum.add(T::number(root_gap(base, offset)))
        }),
        LaneOp::LeastWhere(least, a, at) => on.three(out, [least, a, at], |least, a, at| {
            let a = a.or(T::mask(at == T::default()));
            if a < least { a } else { least }
        }),
        LaneOp::GreatestWhere(greatest, a, at) => on.three(out, [greatest, a, at], |greatest, a, at| {
            let a = a.and(T::mask(at != T::default()));
            if greatest.less_signed(a) { a } else { greatest }
        }),
        LaneOp::Since(since, a) => {
            let one = T::number(1);
            on.two(out, since, a, |since, a| since.and(T::mask(a == T::default())).add(one));
        }
    }
}
