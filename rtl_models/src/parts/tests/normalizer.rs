//! Left-shift normalisation.

use stepwave_netlist::Code;
use stepwave_netlist::dsl::{Module, Scope};

use super::super::{Block, Normalizer, shifted_left, shifted_right};
use super::bench::{Bench, numbers, on_every_engine};

/// Two integrands `a` and `b` that are normalised after their load.
fn normalized(m: Scope<'_>, bits: u32, top: u32, normalize: bool) {
    let block = Block::new(m);
    let normalizer = Normalizer::new(m, &block, normalize);
    let integrands = ["a", "b"].map(|name| m.reg(name, bits));
    let signals = normalizer.close(&integrands.map(|integrand| integrand.q), top);
    for (integrand, name) in integrands.into_iter().zip(["a", "b"]) {
        let loads = integrand.when(block.load, block.word(name, bits));
        loads.when(signals.shift, shifted_left(m, integrand.q)).else_hold();
    }
    m.name("shift", signals.shift);
    m.name("ready", signals.ready);
    m.name("run", signals.run);
    block.close(signals.ready, m.lit(1, 0), m.lit(1, 0));
}

#[test]
fn integrands_shift_until_one_has_its_top_bit_set_and_then_the_block_is_ready() {
    on_every_engine(
        |m| normalized(m, 4, 1, true),
        |bench| {
            bench.play(&[("load", "0100_0000"), ("a_in", "1111_1111"), ("b_in", "0000_0000")]);
            assert_eq!(bench.row("a"), "0012_4888");
            assert_eq!(bench.row("shift"), "0011_1000");
            assert_eq!(bench.row("normalizing"), "0011_1100");
            assert_eq!(bench.row("ready"), "0000_0100");
            assert_eq!(bench.row("loaded"), "0000_0010");
            assert_eq!(bench.row("run"), "0000_0011");
            assert_eq!(bench.row("busy"), "0011_1111");
        },
    );
}

/// Loads two integrands, follows them until they run, and counts the clocks.
fn check(bench: &mut Bench, bits: u32, top: u32, [a, b]: [i128; 2]) {
    let what = format!("{a} and {b} in {bits} bits, top {top}");
    let shifts = (0..).find(|q| (a | b) << q >> (bits - top) != 0).unwrap();
    bench.clock(&[("load", 1), ("a_in", a), ("b_in", b)]);
    bench.clock(&[("load", 0)]);
    for q in 0..shifts {
        assert_eq!([bench.value("shift"), bench.value("ready"), bench.value("run")], [1, 0, 0], "{what}, clock {q}");
        bench.clock(&[]);
    }
    assert_eq!([bench.value("shift"), bench.value("ready"), bench.value("run")], [0, 1, 0], "{what}");
    for _ in 0..2 {
        bench.clock(&[]);
        assert_eq!([bench.value("shift"), bench.value("ready"), bench.value("run")], [0, 0, 1], "{what}");
        assert_eq!([bench.value("a"), bench.value("b")], [a << shifts, b << shifts], "{what}");
    }
}

#[test]
fn every_pair_of_integrands_takes_as_many_clocks_as_it_has_leading_zeros_and_one_more() {
    for bits in 1..=4 {
        for top in 1..=bits.min(2) {
            on_every_engine(
                |m| normalized(m, bits, top, true),
                |bench| {
                    for a in numbers(bits, false) {
                        for b in numbers(bits, false).filter(|b| a | b != 0) {
                            check(bench, bits, top, [a, b]);
                        }
                    }
                },
            );
        }
    }
}

#[test]
fn more_top_bits_than_the_integrands_have_is_a_mistake_of_who_asks_for_them() {
    for (bits, top) in [(4, 5), (1, 2), (4, u32::MAX)] {
        let module = Module::new("m");
        normalized(module.top(), bits, top, true);
        let said = module.finish().unwrap_err().0;
        let codes: Vec<Code> = said.iter().map(|diagnostic| diagnostic.code).collect();
        assert_eq!(codes, [if top > 64 { Code::BadWidth } else { Code::OutOfRange }], "{said:?}");
        assert!(said[0].place.to_string().contains("tests/normalizer.rs:"), "{}", said[0]);
    }
    // None at all.
    let module = Module::new("m");
    normalized(module.top(), 4, 0, true);
    assert_eq!(module.finish().unwrap_err().0.len(), 1);
}

#[test]
fn without_normalisation_a_block_is_ready_at_its_load_and_runs_while_it_is_busy() {
    on_every_engine(
        |m| normalized(m, 4, 1, false),
        |bench| {
            bench.play(&[("load", "0100_0000"), ("a_in", "1111_1111"), ("b_in", "0000_0000")]);
            assert_eq!(bench.row("a"), "0011_1111");
            assert_eq!(bench.row("shift"), "0000_0000");
            assert_eq!(bench.row("ready"), "0100_0000");
            assert_eq!(bench.row("loaded"), "0010_0000");
            assert_eq!(bench.row("run"), "0011_1111");
            assert!(bench.design().netlist().find("normalizing").is_none());
        },
    );
}

#[test]
fn a_shift_by_one_doubles_or_halves_and_loses_what_falls_out() {
    for bits in 1..=4 {
        on_every_engine(
            |m| {
                let value = m.input("value", bits);
                m.name("left", shifted_left(m, value));
                m.name("right", shifted_right(m, value));
            },
            |bench| {
                for value in numbers(bits, false) {
                    bench.clock(&[("value", value)]);
                    assert_eq!(bench.value("left"), 2 * value % (1 << bits));
                    assert_eq!(bench.value("right"), value / 2);
                }
            },
        );
    }
}
