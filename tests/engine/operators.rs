//! The meaning of every operator, against exact integers: all operands of up to four bits, and edge values of all
//! widths up to 64, on every engine.

use stepwave_engine::EngineKind;
use stepwave_netlist::Net;

use crate::netlist::{Probe, decode, design, design_of_text, encode, net, outputs, values};

/// Two operands of equal width in both readings.
struct Operands {
    bits: u32,
    /// Unsigned.
    a: i128,
    b: i128,
    /// Two's complement.
    sa: i128,
    sb: i128,
}

impl Operands {
    fn new(bits: u32, a: u64, b: u64) -> Operands {
        let (sa, sb) = (decode(a, bits, true), decode(b, bits, true));
        Operands { bits, a: i128::from(a), b: i128::from(b), sa, sb }
    }

    fn in_signed_range(&self, number: i128) -> bool {
        (-(1 << (self.bits - 1))..1 << (self.bits - 1)).contains(&number)
    }
}

/// What an operator's result is as an exact integer; of a word it keeps the low bits.
type Meaning = fn(&Operands) -> i128;

/// Operators whose result is as wide as their operands, by their word in the text form.
const WORDS: [(&str, Meaning); 11] = [
    ("and", |o| o.a & o.b),
    ("or", |o| o.a | o.b),
    ("xor", |o| o.a ^ o.b),
    ("add", |o| o.a + o.b),
    ("sub", |o| o.a - o.b),
    ("mul", |o| o.a.wrapping_mul(o.b)),
    ("div", |o| if o.b == 0 { 0 } else { o.a / o.b }),
    ("rem", |o| if o.b == 0 { 0 } else { o.a % o.b }),
    ("shift-left", |o| o.a << o.b.min(64)),
    ("shift-right", |o| o.a >> o.b.min(64)),
    ("shift-arithmetic", |o| o.sa >> o.b.min(64)),
];

/// Operators whose result is one bit.
const FLAGS: [(&str, Meaning); 6] = [
    ("carry", |o| i128::from(o.a + o.b >= 1 << o.bits)),
    ("borrow", |o| i128::from(o.a - o.b < 0)),
    ("add-overflow", |o| i128::from(!o.in_signed_range(o.sa + o.sb))),
    ("sub-overflow", |o| i128::from(!o.in_signed_range(o.sa - o.sb))),
    ("equal", |o| i128::from(o.a == o.b)),
    ("less-signed", |o| i128::from(o.sa < o.sb)),
];

/// A netlist with every operator on the inputs a and b.
fn all_operators(bits: u32) -> String {
    let mut text = format!("netlist m\n%0:{bits} = input\n%1:{bits} = input\n");
    let words = WORDS.iter().map(|(word, _)| (word, bits));
    let flags = FLAGS.iter().map(|(word, _)| (word, 1));
    for (index, (word, width)) in words.chain(flags).enumerate() {
        text += &format!("%{}:{width} = {word} %0 %1\n", index + 2);
    }
    for net in 0..2 + WORDS.len() + FLAGS.len() {
        text += &format!("name %{net} in 0 \"n{net}\" unsigned\n");
    }
    text
}

/// Runs every operator on these operand pairs.
fn check_operators(bits: u32, pairs: &[(u64, u64)]) {
    let design = design_of_text(&all_operators(bits));
    let nets: Vec<Net> = design.netlist().nets().collect();
    for kind in EngineKind::ALL {
        let mut probe = Probe::new(&design, kind);
        for &(a, b) in pairs {
            probe.clock(&[(nets[0], a), (nets[1], b)]);
            let operands = Operands::new(bits, a, b);
            for ((word, meaning), net) in WORDS.iter().chain(&FLAGS).zip(&nets[2..]) {
                let want = encode(meaning(&operands), bits);
                assert_eq!(probe.value(*net), want, "{a:#x} {word} {b:#x} in {bits} bits on {}", kind.name());
            }
        }
    }
}

/// The values at which carries and signs turn.
fn edges(bits: u32) -> Vec<u64> {
    let mask = u64::MAX >> (64 - bits);
    let sign = 1 << (bits - 1);
    let mut edges =
        vec![0, 1, sign - 1, sign, mask - 1, mask, 0x5555_5555_5555_5555 & mask, 0xaaaa_aaaa_aaaa_aaaa & mask];
    edges.extend([(sign + 1) & mask, 0x0123_4567_89ab_cdef & mask]);
    edges
}

fn pairs(values: &[u64]) -> Vec<(u64, u64)> {
    values.iter().flat_map(|&a| values.iter().map(move |&b| (a, b))).collect()
}

#[test]
fn every_operator_is_exact_for_all_operands_of_up_to_four_bits() {
    for bits in 1..=4 {
        check_operators(bits, &pairs(&values(bits).collect::<Vec<u64>>()));
    }
}

#[test]
fn every_operator_is_exact_at_the_edge_values_of_every_width() {
    for bits in 5..=64 {
        check_operators(bits, &pairs(&edges(bits)));
    }
}

#[test]
fn a_shift_takes_an_amount_of_any_width_and_loses_all_from_the_width_on() {
    for (bits, by_bits) in [
        (1, 1),
        (1, 2),
        (1, 64),
        (2, 1),
        (3, 5),
        (5, 3),
        (8, 4),
        (13, 64),
        (32, 6),
        (33, 64),
        (64, 6),
        (64, 7),
        (64, 64),
    ] {
        let text = format!(
            "netlist m\n%0:{bits} = input\n%1:{by_bits} = input\n%2:{bits} = shift-left %0 %1\n\
             %3:{bits} = shift-right %0 %1\n%4:{bits} = shift-arithmetic %0 %1\n"
        );
        let design = design_of_text(&text);
        let nets: Vec<Net> = design.netlist().nets().collect();
        let most = u64::MAX >> (64 - by_bits);
        let around = [bits - 1, bits, bits + 1, 31, 32, 63, 64, 65].map(u64::from);
        let amounts: Vec<u64> =
            (0..8).chain(around).chain([1 << 32, 1 << 63, most - 1, most]).filter(|by| *by <= most).collect();
        for kind in EngineKind::ALL {
            let mut probe = Probe::new(&design, kind);
            for a in if bits <= 4 { values(bits).collect() } else { edges(bits) } {
                for &by in &amounts {
                    probe.clock(&[(nets[0], a), (nets[1], by)]);
                    let beyond = by >= u64::from(bits);
                    let (o, by) = (Operands::new(bits, a, 0), by.min(64));
                    let left = if beyond { 0 } else { o.a << by };
                    for (net, want) in nets[2..].iter().zip([left, o.a >> by, o.sa >> by]) {
                        let what = design.netlist().cell(*net).op;
                        assert_eq!(probe.value(*net), encode(want, bits), "{what}: {a:#x} by {by} on {}", kind.name());
                    }
                }
            }
        }
    }
}

#[test]
fn the_methods_of_a_signal_mean_what_their_names_say() {
    for bits in 1..=3 {
        let design = design(|m| {
            let (a, b) = (m.input("a", bits), m.input("b", bits));
            let (carry, sum) = a.carrying_add(b);
            let (borrow, difference) = a.borrowing_sub(b);
            for (name, signal) in [
                ("and", a & b),
                ("or", a | b),
                ("xor", a ^ b),
                ("not", !a),
                ("wrapping_add", a.wrapping_add(b)),
                ("wrapping_sub", a.wrapping_sub(b)),
                ("wrapping_mul", a.wrapping_mul(b)),
                ("div_or_zero", a.div_or_zero(b)),
                ("rem_or_zero", a.as_signed().rem_or_zero(b)),
                ("shift_left", a.shift_left(b)),
                ("shift_right", a.shift_right(b.as_signed())),
                ("shift_right_signed", a.as_signed().shift_right(b)),
                ("carry", carry),
                ("sum", sum),
                ("borrow", borrow),
                ("difference", difference),
                ("equals", a.equals(b)),
                ("is_zero", a.is_zero()),
                ("is_nonzero", a.is_nonzero()),
                ("less_unsigned", a.less_than(b)),
                ("less_signed", a.as_signed().less_than(b)),
                ("less_unsigned_again", a.as_signed().as_unsigned().less_than(b.as_signed())),
                ("msb", a.msb()),
                ("bit", a.bit(0)),
            ] {
                m.name(name, signal);
            }
        });
        let (a_net, b_net) = (net(&design, "a"), net(&design, "b"));
        for kind in EngineKind::ALL {
            let mut probe = Probe::new(&design, kind);
            for (a, b) in pairs(&values(bits).collect::<Vec<u64>>()) {
                probe.clock(&[(a_net, a), (b_net, b)]);
                let o = Operands::new(bits, a, b);
                for (name, net) in outputs(&design) {
                    let want = match name.as_str() {
                        "and" => o.a & o.b,
                        "or" => o.a | o.b,
                        "xor" => o.a ^ o.b,
                        "not" => -1 - o.a,
                        "wrapping_add" | "sum" => o.a + o.b,
                        "wrapping_sub" | "difference" => o.a - o.b,
                        "wrapping_mul" => o.a * o.b,
                        "div_or_zero" => o.a.checked_div(o.b).unwrap_or(0),
                        "rem_or_zero" => o.a.checked_rem(o.b).unwrap_or(0),
                        "shift_left" => o.a << o.b,
                        "shift_right" => o.a >> o.b,
                        "shift_right_signed" => o.sa >> o.b,
                        "carry" => i128::from(o.a + o.b >= 1 << bits),
                        "borrow" | "less_unsigned" | "less_unsigned_again" => i128::from(o.a < o.b),
                        "equals" => i128::from(o.a == o.b),
                        "is_zero" => i128::from(o.a == 0),
                        "is_nonzero" => i128::from(o.a != 0),
                        "less_signed" => i128::from(o.sa < o.sb),
                        "msb" => i128::from(o.sa < 0),
                        "bit" => o.a % 2,
                        _ => panic!("{name}"),
                    };
                    let got = probe.value(net);
                    assert_eq!(got, encode(want, bits), "{name} of {a} and {b} in {bits} bits on {}", kind.name());
                }
            }
        }
    }
}

#[test]
fn a_multiplexer_gives_high_at_1_and_low_at_0_in_every_width() {
    for bits in (1..=4).chain([31, 32, 33, 63, 64]) {
        let design = design(|m| {
            let select = m.input("select", 1);
            m.name("out", select.mux(m.input("high", bits), m.input("low", bits)));
        });
        let [select, high, low, out] = ["select", "high", "low", "out"].map(|name| net(&design, name));
        let operands = if bits <= 4 { values(bits).collect() } else { edges(bits) };
        for kind in EngineKind::ALL {
            let mut probe = Probe::new(&design, kind);
            for (h, l) in pairs(&operands) {
                probe.clock(&[(select, 1), (high, h), (low, l)]);
                assert_eq!(probe.value(out), h, "{bits} bits on {}", kind.name());
                probe.clock(&[(select, 0)]);
                assert_eq!(probe.value(out), l, "{bits} bits on {}", kind.name());
            }
        }
    }
}

#[test]
fn every_slice_of_every_net_of_up_to_four_bits_and_of_64_gives_its_bits() {
    for bits in [1, 2, 3, 4, 64] {
        let slices: Vec<(u32, u32)> =
            (0..bits).flat_map(|low| (1..=bits - low).map(move |width| (low, width))).collect();
        let design = design(|m| {
            let of = m.input("of", bits);
            for &(low, width) in &slices {
                m.name(&format!("from_{low}_{width}"), of.slice(low, width));
            }
        });
        let of = net(&design, "of");
        for kind in EngineKind::ALL {
            let mut probe = Probe::new(&design, kind);
            for value in if bits <= 4 { values(bits).collect() } else { edges(bits) } {
                probe.clock(&[(of, value)]);
                for (&(low, width), (name, net)) in slices.iter().zip(outputs(&design)) {
                    let want = i128::from(value) / (1 << low) % (1 << width);
                    assert_eq!(i128::from(probe.value(net)), want, "{name} of {value:#x} on {}", kind.name());
                }
            }
        }
    }
}

#[test]
fn a_concatenation_puts_the_left_above_the_right() {
    let small = (1..=4).flat_map(|high| (1..=4).map(move |low| (high, low)));
    for (high_bits, low_bits) in small.chain([(1, 63), (63, 1), (32, 32), (31, 2)]) {
        let design = design(|m| {
            m.name("out", m.input("high", high_bits).concat(m.input("low", low_bits)));
        });
        let [high, low, out] = ["high", "low", "out"].map(|name| net(&design, name));
        let operands = |bits| if high_bits + low_bits <= 8 { values(bits).collect() } else { edges(bits) };
        for kind in EngineKind::ALL {
            let mut probe = Probe::new(&design, kind);
            for h in operands(high_bits) {
                for &l in &operands(low_bits) {
                    probe.clock(&[(high, h), (low, l)]);
                    let want = (i128::from(h) << low_bits) + i128::from(l);
                    assert_eq!(i128::from(probe.value(out)), want, "{high_bits}+{low_bits} on {}", kind.name());
                }
            }
        }
    }
}

#[test]
fn an_extension_keeps_the_number_in_either_reading() {
    for bits in (1..=4).chain([63]) {
        let wider: Vec<u32> = (bits..=8.max(bits)).chain([63, 64]).collect();
        let design = design(|m| {
            let a = m.input("a", bits);
            for (index, &to) in wider.iter().enumerate() {
                m.name(&format!("zero_{index}"), a.extend(to));
                m.name(&format!("sign_{index}"), a.as_signed().extend(to));
            }
        });
        let a = net(&design, "a");
        for kind in EngineKind::ALL {
            let mut probe = Probe::new(&design, kind);
            for value in if bits <= 4 { values(bits).collect() } else { edges(bits) } {
                probe.clock(&[(a, value)]);
                for (index, &to) in wider.iter().enumerate() {
                    for (name, signed) in [("zero", false), ("sign", true)] {
                        let got = probe.value(net(&design, &format!("{name}_{index}")));
                        let (got, want) = (decode(got, to, signed), decode(value, bits, signed));
                        assert_eq!(got, want, "{name}-extended from {bits} to {to} on {}", kind.name());
                    }
                }
            }
        }
    }
}

#[test]
fn constants_have_the_value_and_reading_that_they_were_given() {
    for bits in (1..=4).chain([63, 64]) {
        let mask = u64::MAX >> (64 - bits);
        let least = i64::MIN >> (64 - bits);
        let design = design(|m| {
            m.name("zero", m.lit(bits, 0));
            m.name("most", m.lit(bits, mask));
            m.name("least_signed", m.lit_signed(bits, least));
            m.name("most_signed", m.lit_signed(bits, -1 - least));
        });
        for kind in EngineKind::ALL {
            let probe = Probe::new(&design, kind);
            let value = |name| probe.value(net(&design, name));
            assert_eq!([value("zero"), value("most")], [0, mask], "{bits} bits on {}", kind.name());
            let signed = |name| decode(value(name), bits, crate::netlist::is_signed(&design, name));
            assert_eq!(signed("least_signed"), i128::from(least), "{bits} bits on {}", kind.name());
            assert_eq!(signed("most_signed"), i128::from(-1 - least), "{bits} bits on {}", kind.name());
        }
    }
}
