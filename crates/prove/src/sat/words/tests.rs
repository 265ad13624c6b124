use stepwave_netlist::cells::{Net, Op};
use stepwave_netlist::{Width, bits};

use super::{Word, blast, decoded};
use crate::sat::aig::{Graph, Literal};

type Make = fn(Net, Net) -> Op;

/// An operator, and its value of two words.
type Known<T> = (Make, fn(Width, u64, u64) -> T);

/// Operators of two equally wide operands with a result of that width, and their values.
const WORDS: [Known<u64>; 8] = [
    (Op::And, |_, a, b| a & b),
    (Op::Or, |_, a, b| a | b),
    (Op::Xor, |_, a, b| a ^ b),
    (Op::Add, bits::add),
    (Op::Sub, bits::sub),
    (Op::Mul, bits::mul),
    (Op::Div, |_, a, b| bits::div(a, b)),
    (Op::Rem, |_, a, b| bits::rem(a, b)),
];

/// Operators of two equally wide operands with a result of one bit.
const FLAGS: [Known<bool>; 6] = [
    (Op::Carry, bits::carry),
    (Op::Borrow, |_, a, b| bits::borrow(a, b)),
    (Op::AddOverflow, bits::add_overflow),
    (Op::SubOverflow, bits::sub_overflow),
    (Op::Equal, |_, a, b| a == b),
    (Op::LessSigned, bits::less_signed),
];

/// Shifts, whose second operand has any width.
const SHIFTS: [Known<u64>; 3] = [
    (Op::ShiftLeft, bits::shift_left),
    (Op::ShiftRight, |_, a, by| bits::shift_right(a, by)),
    (Op::ShiftArithmetic, bits::shift_arithmetic),
];

fn width(bits: u32) -> Width {
    Width::new(u64::from(bits)).expect("a width")
}

/// A result of variables, to be looked at under many values of them.
struct Made {
    graph: Graph,
    operands: Vec<Word>,
    result: Word,
}

impl Made {
    fn new(op: Op, result: u32, operands: &[u32]) -> Made {
        let mut graph = Graph::new();
        let operands: Vec<Word> = operands.iter().map(|&bits| graph.variables(bits)).collect();
        let words = operands.clone();
        let result = blast(&mut graph, op, width(result), &|net| words[net.index()].clone(), &[]);
        Made { graph, operands, result }
    }

    fn value(&self, values: &[u64]) -> u64 {
        let mut inputs = vec![false; self.graph.len()];
        for (word, value) in self.operands.iter().zip(values) {
            word.iter().enumerate().for_each(|(bit, literal)| inputs[literal.node()] = value >> bit & 1 == 1);
        }
        let nodes = self.graph.evaluate(|node| inputs[node]);
        let bit = |literal: &Literal| u64::from(nodes[literal.node()] != literal.is_negated());
        self.result.iter().enumerate().fold(0, |value, (place, literal)| value | bit(literal) << place)
    }
}

/// The same with constants as operands: all is folded.
fn folded(op: Op, result: u32, operands: &[(u32, u64)]) -> u64 {
    let mut graph = Graph::new();
    let words: Vec<Word> = operands.iter().map(|&(bits, value)| super::constant(width(bits), value)).collect();
    let result = blast(&mut graph, op, width(result), &|net| words[net.index()].clone(), &[]);
    assert!(result.iter().all(|&bit| bit == Literal::TRUE || bit == Literal::FALSE), "{op} of constants");
    result.iter().enumerate().fold(0, |value, (place, &bit)| value | u64::from(bit == Literal::TRUE) << place)
}

/// Words that carry far, and random ones.
fn samples(bits: u32, count: usize) -> Vec<u64> {
    let mask = width(bits).mask();
    let mut seed = u64::from(bits);
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed ^ seed >> 31) >> (seed >> 59)
    };
    let edges = [0, 1, 2, mask, mask - 1, mask >> 1, (mask >> 1) + 1];
    edges.into_iter().chain((0..count).map(|_| random())).map(|value| value & mask).collect()
}

fn check(op: Op, result: u32, operands: [u32; 2], values: [&[u64]; 2], want: &dyn Fn(u64, u64) -> u64) {
    let made = Made::new(op, result, &operands);
    for &a in values[0] {
        for &b in values[1] {
            assert_eq!(made.value(&[a, b]), want(a, b), "{op} of {a}, {b} in {operands:?} bits");
            assert_eq!(
                folded(op, result, &[(operands[0], a), (operands[1], b)]),
                want(a, b),
                "folded {op} of {a}, {b}"
            );
        }
    }
}

/// All words of few bits, some of many.
fn each_width(go: impl Fn(u32, &[u64])) {
    for bits in 1..=4 {
        go(bits, &(0..1 << bits).collect::<Vec<_>>());
    }
    for bits in [5, 8, 13, 31, 32, 33, 63, 64] {
        go(bits, &samples(bits, 5));
    }
}

#[test]
fn operators_of_two_words_give_what_their_definitions_give() {
    let (a, b) = (Net(0), Net(1));
    each_width(|bits, values| {
        for (make, want) in WORDS {
            check(make(a, b), bits, [bits; 2], [values; 2], &|a, b| want(width(bits), a, b));
        }
        for (make, want) in FLAGS {
            check(make(a, b), 1, [bits; 2], [values; 2], &|a, b| u64::from(want(width(bits), a, b)));
        }
    });
}

#[test]
fn shifts_by_words_of_any_width_give_what_their_definitions_give() {
    let (a, b) = (Net(0), Net(1));
    each_width(|bits, values| {
        for by in [1, 2, 3, 4, 7, 64] {
            let amounts = if by < 5 { (0..1 << by).collect() } else { samples(by, 6) };
            for (make, want) in SHIFTS {
                check(make(a, b), bits, [bits, by], [values, &amounts], &|a, b| want(width(bits), a, b));
            }
        }
    });
}

#[test]
fn words_are_complemented_cut_joined_extended_and_chosen_as_defined() {
    let (a, b) = (Net(0), Net(1));
    for bits in 1..=5u32 {
        let values: Vec<u64> = (0..1 << bits).collect();
        let one: &[u64] = &[0, 1];
        check(Op::Not(a), bits, [bits, 1], [&values, &[0]], &|a, _| !a & width(bits).mask());
        for low in 0..bits {
            let (op, left) = (Op::Slice { of: a, low: u8::try_from(low).unwrap() }, bits - low);
            check(op, left, [bits, 1], [&values, &[0]], &|a, _| a >> low);
            check(op, 1, [bits, 1], [&values, &[0]], &|a, _| a >> low & 1);
        }
        check(Op::Concat { high: b, low: a }, bits + 1, [bits, 1], [&values, one], &|a, b| b << bits | a);
        for wide in [bits, bits + 1, 64] {
            check(Op::ZeroExtend(a), wide, [bits, 1], [&values, &[0]], &|a, _| a);
            let extended = |a, _| bits::sign_extend(width(bits), width(wide), a);
            check(Op::SignExtend(a), wide, [bits, 1], [&values, &[0]], &extended);
        }
        let mux = Made::new(Op::Mux { select: b, high: a, low: Net(2) }, bits, &[bits, 1, bits]);
        for (&high, &low) in values.iter().zip(values.iter().rev()) {
            assert_eq!([mux.value(&[high, 1, low]), mux.value(&[high, 0, low])], [high, low]);
        }
    }
}

#[test]
fn memories_are_read_and_their_addresses_decoded_within_their_size_alone() {
    for (size, bits) in [(1usize, 1u32), (1, 3), (2, 1), (3, 2), (5, 3), (5, 2), (6, 5), (8, 3), (4, 64)] {
        let mut graph = Graph::new();
        let address = graph.variables(bits);
        let enable = graph.variable();
        let words: Vec<Word> = (0..size).map(|_| graph.variables(2)).collect();
        let op = Op::Read { memory: 0, address: Net(0) };
        let word = blast(&mut graph, op, width(2), &|_| address.clone(), std::slice::from_ref(&words));
        let lines = decoded(&mut graph, enable, &address, size);
        for at in samples(bits, 4).into_iter().chain(0..8).filter(|&at| at <= width(bits).mask()) {
            for on in [false, true] {
                let mut inputs = vec![false; graph.len()];
                inputs[enable.node()] = on;
                for (bit, literal) in address.iter().enumerate() {
                    inputs[literal.node()] = at >> bit & 1 == 1;
                }
                // Word n holds n + 1 modulo 4.
                for (number, word) in words.iter().enumerate() {
                    inputs[word[0].node()] = (number + 1) & 1 == 1;
                    inputs[word[1].node()] = (number + 1) & 2 == 2;
                }
                let nodes = graph.evaluate(|node| inputs[node]);
                let value = |literal: Literal| nodes[literal.node()] != literal.is_negated();
                let read = u64::from(value(word[0])) | u64::from(value(word[1])) << 1;
                let inside = at < size as u64;
                assert_eq!(read, if inside { (at + 1) % 4 } else { 0 }, "word {at} of {size}");
                for (number, &line) in lines.iter().enumerate() {
                    assert_eq!(value(line), on && at == number as u64, "line {number} at {at} of {size}");
                }
                assert!(lines.len() <= size && (!inside || lines.len() as u64 > at));
            }
        }
    }
}
