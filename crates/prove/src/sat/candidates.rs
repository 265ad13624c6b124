//! Invariants that random runs suggest: bits that do not change, bounds of registers, orders of pairs of them. Goals may
//! rely on those that are proved along with them.

use super::aig::{Graph, Literal};
use super::template::Template;
use super::words::{Word, constant, difference};
use super::{Inputs, Question};
use stepwave_netlist::Width;

/// Samples of the runs, of which there are 64 at once.
const SAMPLES: usize = 300;
/// The most registers of which pairs are compared.
const MOST_REGISTERS: usize = 24;
/// The most invariants that are kept.
const MOST: usize = 300;
/// The most nodes of a step for which runs are tried.
const MOST_NODES: usize = 200_000;

/// Bits that are 1 where an invariant is violated, in no run that was tried.
pub(super) fn suggested(template: &mut Template, question: &Question<'_>, assumptions: &[Literal]) -> Vec<Literal> {
    if template.graph.len() > MOST_NODES {
        return Vec::new();
    }
    let registers: Vec<Word> = template.registers.iter().filter(|word| word.len() > 1).cloned().collect();
    let mut asked = unchanged(template);
    orders(&mut template.graph, &registers, &mut asked);
    let flags: Vec<Literal> = template.registers.iter().filter(|word| word.len() == 1).map(|word| word[0]).collect();
    exclusions(&mut template.graph, &flags, &mut asked);
    asked.sort_unstable();
    asked.dedup();
    let mut greatest = vec![0u64; registers.len()];
    let mut seen = vec![0u64; asked.len()];
    runs(template, &question.inputs, assumptions, |values, alive| {
        let of = |literal: Literal| values[literal.node()] ^ if literal.is_negated() { u64::MAX } else { 0 };
        for (seen, &literal) in seen.iter_mut().zip(&asked) {
            *seen |= of(literal) & alive;
        }
        for (greatest, word) in greatest.iter_mut().zip(&registers) {
            *greatest = (*greatest).max(largest(word.iter().map(|&bit| of(bit)), alive));
        }
    });
    let mut kept: Vec<Literal> =
        asked.into_iter().zip(seen).filter(|(_, seen)| *seen == 0).map(|(bit, _)| bit).collect();
    for (word, greatest) in registers.iter().zip(greatest) {
        if let Ok(width) = Width::new(word.len() as u64)
            && greatest < width.mask()
        {
            kept.push(difference(&mut template.graph, &constant(width, greatest), word).1);
        }
    }
    kept.retain(|&bit| bit != Literal::FALSE);
    kept.truncate(MOST);
    kept
}

/// The greatest number of 64 runs, given the bits of a word in all of them, the least significant first.
fn largest(bits: impl DoubleEndedIterator<Item = u64> + ExactSizeIterator, alive: u64) -> u64 {
    let mut among = alive;
    bits.enumerate().rev().fold(0, |value, (place, bit)| {
        if bit & among == 0 {
            return value;
        }
        among &= bit;
        value | 1 << place
    })
}

/// A bit has another value than before the first edge.
fn unchanged(template: &Template) -> Vec<Literal> {
    template.state.iter().map(|bit| bit.now.negated_if(bit.first)).collect()
}

/// Of each pair of registers: the first is not less, or is greater; as unsigned numbers and in two's complement.
fn orders(graph: &mut Graph, registers: &[Word], asked: &mut Vec<Literal>) {
    let few = &registers[..registers.len().min(MOST_REGISTERS)];
    for (first, a) in few.iter().enumerate() {
        for b in few.iter().enumerate().filter(|(second, _)| *second != first).map(|(_, b)| b) {
            let bits = a.len().max(b.len()) + 1;
            for signed in [false, true] {
                let wide = |word: &Word| -> Word {
                    let above = if signed { word[word.len() - 1] } else { Literal::FALSE };
                    word.iter().copied().chain(std::iter::repeat(above)).take(bits).collect()
                };
                // One bit more than both have: the sign of the difference is its order.
                let (a, b) = (wide(a), wide(b));
                let less = difference(graph, &a, &b).0[bits - 1];
                asked.push(!less);
                asked.push(difference(graph, &b, &a).0[bits - 1]);
            }
        }
    }
}

/// Of each pair of single bits: both are 1, one is, none is.
fn exclusions(graph: &mut Graph, flags: &[Literal], asked: &mut Vec<Literal>) {
    let few = &flags[..flags.len().min(MOST_REGISTERS)];
    for (second, &b) in few.iter().enumerate() {
        for &a in &few[..second] {
            asked.extend([(a, b), (a, !b), (!a, b), (!a, !b)].map(|(a, b)| graph.and(a, b)));
        }
    }
}

/// Runs the design 64 times at once by random inputs; `look` is given the value of each node, and the runs in which all
/// assumptions hold so far.
fn runs(template: &Template, inputs: &Inputs, assumptions: &[Literal], mut look: impl FnMut(&[u64], u64)) {
    let graph = &template.graph;
    let mut values = vec![0u64; graph.len()];
    let all = |bit: bool| if bit { u64::MAX } else { 0 };
    let mut state: Vec<u64> = template.state.iter().map(|bit| all(bit.first)).collect();
    let (mut random, mut alive) = (1u64, u64::MAX);
    let mut next = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        random.wrapping_mul(0x2545_f491_4f6c_dd1d)
    };
    for sample in 0..SAMPLES {
        template.state.iter().zip(&state).for_each(|(bit, &now)| values[bit.now.node()] = now);
        // In a quarter of the runs each, inputs change in every, every eighth, every 64th, or no sample after the first.
        let (mut change, often) = (u64::MAX, next() & next() & next());
        if sample > 0 {
            change = 0xffff | often & 0xffff_0000 | often & next() & next() & next() & 0xffff_0000_0000;
        }
        for (net, word) in &template.inputs {
            let given = inputs.at(sample).iter().find(|(input, _)| input == net).map(|&(_, value)| value);
            for (place, bit) in word.iter().enumerate() {
                let value = &mut values[bit.node()];
                *value = match given {
                    Some(value) => all(value >> place & 1 == 1),
                    None => *value & !change | next() & change,
                };
            }
        }
        for node in 1..graph.len() {
            if let Some(operands) = graph.operands(node) {
                let [a, b] = operands.map(|operand| values[operand.node()] ^ all(operand.is_negated()));
                values[node] = a & b;
            }
        }
        let of = |literal: Literal| values[literal.node()] ^ all(literal.is_negated());
        alive = assumptions.iter().fold(alive, |alive, &broken| alive & !of(broken));
        look(&values, alive);
        state = template.state.iter().map(|bit| of(bit.next)).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::largest;

    #[test]
    fn the_largest_number_of_all_runs_that_are_alive_is_found() {
        // Runs 0 to 3 have 5, 2, 6, 7 in three bits.
        let bits = [0b1001, 0b1110, 0b1101];
        assert_eq!(largest(bits.into_iter(), 0b1111), 7);
        assert_eq!(largest(bits.into_iter(), 0b0111), 6);
        assert_eq!(largest(bits.into_iter(), 0b0011), 5);
        assert_eq!(largest(bits.into_iter(), 0b0010), 2);
        assert_eq!(largest(bits.into_iter(), 0), 0);
    }
}
