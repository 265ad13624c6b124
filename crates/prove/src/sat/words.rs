//! The operators of the kernel on words of literals, the least significant bit first.

use stepwave_netlist::Width;
use stepwave_netlist::cells::{Net, Op};

use super::aig::{Graph, Literal};

/// A word, the least significant bit first.
pub(super) type Word = Vec<Literal>;

fn bits_of(value: u64) -> impl Iterator<Item = Literal> {
    (0..64).map(move |bit| Literal::constant(value >> bit & 1 == 1))
}

/// A constant of some bits.
pub(super) fn constant(width: Width, value: u64) -> Word {
    bits_of(value).take(width.get() as usize).collect()
}

/// What an addition gives: the sum, and the carry out of its top.
fn sum(graph: &mut Graph, a: &[Literal], b: &[Literal], mut carry: Literal) -> (Word, Literal) {
    let mut word = Vec::with_capacity(a.len());
    for (&a, &b) in a.iter().zip(b) {
        let differ = graph.xor(a, b);
        word.push(graph.xor(differ, carry));
        carry = graph.mux(differ, carry, a);
    }
    (word, carry)
}

fn inverted(a: &[Literal]) -> Word {
    a.iter().map(|&bit| !bit).collect()
}

/// The difference, and whether it borrows.
pub(super) fn difference(graph: &mut Graph, a: &[Literal], b: &[Literal]) -> (Word, Literal) {
    let (word, carry) = sum(graph, a, &inverted(b), Literal::TRUE);
    (word, !carry)
}

fn masked(graph: &mut Graph, word: &[Literal], by: Literal) -> Word {
    word.iter().map(|&bit| graph.and(bit, by)).collect()
}

pub(super) fn select(graph: &mut Graph, by: Literal, high: &[Literal], low: &[Literal]) -> Word {
    high.iter().zip(low).map(|(&high, &low)| graph.mux(by, high, low)).collect()
}

/// Some bit differs.
pub(super) fn differs(graph: &mut Graph, a: &[Literal], b: &[Literal]) -> Literal {
    let pairs: Word = a.iter().zip(b).map(|(&a, &b)| graph.xor(a, b)).collect();
    graph.any(pairs)
}

fn product(graph: &mut Graph, a: &[Literal], b: &[Literal]) -> Word {
    let width = a.len();
    let mut word = vec![Literal::FALSE; width];
    for (low, &bit) in b.iter().enumerate() {
        let row = masked(graph, &a[..width - low], bit);
        let (above, _) = sum(graph, &word[low..], &row, Literal::FALSE);
        word.splice(low.., above);
    }
    word
}

/// Quotient and remainder of unsigned numbers, digit by digit; both are 0 where the divisor is.
fn quotient(graph: &mut Graph, a: &[Literal], b: &[Literal]) -> (Word, Word) {
    let width = a.len();
    let divisor: Word = b.iter().copied().chain([Literal::FALSE]).collect();
    let mut rest = vec![Literal::FALSE; width];
    let mut quotient = vec![Literal::FALSE; width];
    for place in (0..width).rev() {
        // Twice the rest and the next digit: one bit more than the divisor has.
        let row: Word = [a[place]].into_iter().chain(rest).collect();
        let (less, borrow) = difference(graph, &row, &divisor);
        quotient[place] = !borrow;
        rest = select(graph, borrow, &row, &less);
        rest.truncate(width);
    }
    let valid = graph.any(b.iter().copied());
    (masked(graph, &quotient, valid), masked(graph, &rest, valid))
}

/// A shift to the right with this bit entering; a shift to the left is one of the mirrored word.
fn shifted_right(graph: &mut Graph, a: &[Literal], by: &[Literal], entering: Literal) -> Word {
    let mut word = a.to_vec();
    for (place, &bit) in by.iter().enumerate() {
        let distance = 1usize.checked_shl(u32::try_from(place).unwrap_or(u32::MAX)).unwrap_or(usize::MAX);
        let moved: Word = (0..a.len())
            .map(|to| to.checked_add(distance).and_then(|from| word.get(from).copied()).unwrap_or(entering))
            .collect();
        word = select(graph, bit, &moved, &word);
    }
    word
}

fn mirrored(word: &[Literal]) -> Word {
    word.iter().rev().copied().collect()
}

fn top(word: &[Literal]) -> Literal {
    word.last().copied().unwrap_or(Literal::FALSE)
}

/// The word at an address; 0 outside of the memory.
fn read(graph: &mut Graph, words: &[Word], address: &[Literal]) -> Word {
    let zero = vec![Literal::FALSE; words.first().map_or(0, Vec::len)];
    let mut level: Vec<Word> = words.to_vec();
    for &bit in address {
        level = level.chunks(2).map(|pair| select(graph, bit, pair.get(1).unwrap_or(&zero), &pair[0])).collect();
    }
    // Words that no address reaches are left over after the first.
    level.into_iter().next().unwrap_or(zero)
}

/// Whether an address is 0, 1, …
pub(super) fn decoded(graph: &mut Graph, enable: Literal, address: &[Literal], size: usize) -> Vec<Literal> {
    let mut lines = vec![enable];
    // From the top bit on, each line splits in two; those beyond the memory are left out.
    for (place, &bit) in address.iter().enumerate().rev() {
        let most = u32::try_from(place).ok().and_then(|place| (size - 1).checked_shr(place)).unwrap_or(0);
        let split: Vec<Literal> =
            lines.iter().flat_map(|&line| [graph.and(line, !bit), graph.and(line, bit)]).collect();
        lines = split;
        lines.truncate(most + 1);
    }
    lines
}

/// The word that a cell gives. Inputs and registers are variables of their own.
pub(super) fn blast(
    graph: &mut Graph,
    op: Op,
    width: Width,
    word: &impl Fn(Net) -> Word,
    memories: &[Vec<Word>],
) -> Word {
    let bits = width.get() as usize;
    match op {
        Op::Input | Op::Register { .. } => graph.variables(width.get()),
        Op::Const(value) => constant(width, value),
        Op::Not(a) => inverted(&word(a)),
        Op::And(a, b) => word(a).into_iter().zip(word(b)).map(|(a, b)| graph.and(a, b)).collect(),
        Op::Or(a, b) => word(a).into_iter().zip(word(b)).map(|(a, b)| graph.or(a, b)).collect(),
        Op::Xor(a, b) => word(a).into_iter().zip(word(b)).map(|(a, b)| graph.xor(a, b)).collect(),
        Op::Mux { select: by, high, low } => select(graph, word(by)[0], &word(high), &word(low)),
        Op::Add(a, b) => sum(graph, &word(a), &word(b), Literal::FALSE).0,
        Op::Sub(a, b) => difference(graph, &word(a), &word(b)).0,
        Op::Mul(a, b) => product(graph, &word(a), &word(b)),
        Op::Div(a, b) => quotient(graph, &word(a), &word(b)).0,
        Op::Rem(a, b) => quotient(graph, &word(a), &word(b)).1,
        Op::ShiftLeft(a, by) => mirrored(&shifted_right(graph, &mirrored(&word(a)), &word(by), Literal::FALSE)),
        Op::ShiftRight(a, by) => shifted_right(graph, &word(a), &word(by), Literal::FALSE),
        Op::ShiftArithmetic(a, by) => {
            let a = word(a);
            shifted_right(graph, &a, &word(by), top(&a))
        }
        Op::Carry(a, b) => vec![sum(graph, &word(a), &word(b), Literal::FALSE).1],
        Op::Borrow(a, b) => vec![difference(graph, &word(a), &word(b)).1],
        Op::AddOverflow(a, b) | Op::SubOverflow(a, b) => {
            let (a, b) = (word(a), word(b));
            let (added, carry) =
                if matches!(op, Op::SubOverflow(..)) { (inverted(&b), Literal::TRUE) } else { (b, Literal::FALSE) };
            let result = top(&sum(graph, &a, &added, carry).0);
            // Both operands of the sum have the sign that the result has not.
            let (first, second) = (graph.xor(top(&a), result), graph.xor(top(&added), result));
            vec![graph.and(first, second)]
        }
        Op::Equal(a, b) => vec![!differs(graph, &word(a), &word(b))],
        Op::LessSigned(a, b) => {
            // With the signs exchanged, two's complement orders as unsigned numbers do.
            let turned = |mut word: Word| {
                if let Some(sign) = word.last_mut() {
                    *sign = !*sign;
                }
                word
            };
            vec![difference(graph, &turned(word(a)), &turned(word(b))).1]
        }
        Op::Slice { of, low } => word(of)[usize::from(low)..][..bits].to_vec(),
        Op::Concat { high, low } => word(low).into_iter().chain(word(high)).collect(),
        Op::ZeroExtend(a) => word(a).into_iter().chain(std::iter::repeat(Literal::FALSE)).take(bits).collect(),
        Op::SignExtend(a) => {
            let a = word(a);
            let sign = top(&a);
            a.into_iter().chain(std::iter::repeat(sign)).take(bits).collect()
        }
        Op::Read { memory, address } => read(graph, &memories[memory as usize], &word(address)),
    }
}

#[cfg(test)]
mod tests;
