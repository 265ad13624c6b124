//! The sequential multiplier, divider and square root, and the microprogram that starts them.

use super::super::Task::{Multiply, Start, Wait};
use super::super::{Microprogram, SerialDivider, SerialMultiplier, SerialRoot, row, states};
use super::bench::{Bench, numbers, on_every_engine};

/// Starts a unit, and waits for it as many clocks as it may take.
fn wait(bench: &mut Bench, inputs: &[(&str, i128)], clocks: u32) {
    bench.clock(&[&[("start", 1)], inputs].concat());
    bench.clock(&[("start", 0)]);
    for clock in 0..clocks {
        assert_eq!(bench.value("running"), 1, "clock {clock} of {clocks}");
        bench.clock(&[]);
    }
    assert_eq!(bench.value("running"), 0);
}

#[test]
fn every_two_numbers_of_up_to_four_bits_are_multiplied_in_as_many_clocks_as_the_multiplier_has_bits() {
    for (a_bits, b_bits) in [(1, 1), (1, 4), (4, 1), (3, 2), (4, 4)] {
        on_every_engine(
            |m| {
                let unit = SerialMultiplier::new(m, a_bits, b_bits);
                m.name("running", unit.running());
                unit.close(&[(m.input("start", 1), m.input("a", a_bits), m.input("b", b_bits))]);
            },
            |bench| {
                for a in numbers(a_bits, false) {
                    for b in numbers(b_bits, false) {
                        wait(bench, &[("a", a), ("b", b)], b_bits);
                        assert_eq!(bench.value("product"), a * b, "{a} · {b}");
                        bench.clock(&[("a", 0), ("b", 1)]);
                        assert_eq!(bench.value("product"), a * b, "it is valid");
                    }
                }
            },
        );
    }
}

#[test]
fn every_number_of_up_to_five_bits_is_divided_with_its_remainder() {
    for (n, d) in [(1, 1), (5, 3), (3, 5), (4, 4)] {
        on_every_engine(
            |m| {
                let unit = SerialDivider::new(m, n, d);
                m.name("running", unit.running());
                unit.close(&[(m.input("start", 1), m.input("a", n), m.input("b", d))]);
            },
            |bench| {
                for a in numbers(n, false) {
                    for b in numbers(d, false) {
                        wait(bench, &[("a", a), ("b", b)], n);
                        let (quotient, rest) = (a.checked_div(b), a.checked_rem(b));
                        assert_eq!(bench.value("quotient"), quotient.unwrap_or((1 << n) - 1), "{a} / {b}");
                        if let Some(rest) = rest {
                            assert_eq!(bench.value("remainder"), rest, "{a} mod {b}");
                        }
                    }
                }
            },
        );
    }
}

#[test]
fn every_number_of_up_to_eight_bits_has_the_whole_part_of_its_root() {
    for k in 1..=4 {
        on_every_engine(
            |m| {
                let unit = SerialRoot::new(m, k);
                m.name("running", unit.running());
                unit.close(&[(m.input("start", 1), m.input("a", 2 * k))]);
            },
            |bench| {
                for a in numbers(2 * k, false) {
                    wait(bench, &[("a", a)], k);
                    let root = bench.value("root");
                    assert!(root * root <= a && a < (root + 1) * (root + 1), "root of {a}: {root}");
                }
            },
        );
    }
}

states! { mod at { IDLE = 0, FIRST = 1, SECOND = 2 } }

#[test]
fn a_microprogram_begins_each_state_once_waits_for_its_result_and_goes_on() {
    on_every_engine(
        |m| {
            let [load, mark, ready, more] = ["load", "mark", "ready", "more"].map(|name| m.input(name, 1));
            let program = Microprogram::new(m, [2, 3], [1, 1], 1);
            let [total, kept] = [("total", 5), ("kept", 1)].map(|(name, bits)| m.reg(name, bits));
            let product = program.multiplier.product();
            program.close(&[
                row(at::IDLE, Start(load), [], at::FIRST).clearing(m, &[total]),
                row(at::FIRST, Multiply(m.lit(2, 3), m.lit(2, 2)), [(total, product)], at::SECOND)
                    .keeping([(kept, mark)]),
                row(at::SECOND, Wait(ready), [], at::IDLE).unless(more, at::FIRST),
            ]);
        },
        |bench| {
            bench.play(&[
                ("load", "1000_0000_0000_0000_1010"),
                ("mark", "0100_0000_0000_0000_0001"),
                ("ready", "0000_0000_1000_0010_0000"),
                ("more", "0000_0000_1000_0000_0000"),
            ]);
            assert_eq!(bench.row("state"), "0111_1122_2111_1120_0111");
            assert_eq!(bench.row("waits"), "0011_1101_1011_1100_0010");
            assert_eq!(bench.row("total"), "0000_0066_6666_6666_6000");
            assert_eq!(bench.row("kept"), "0011_1111_1100_0000_0000");
        },
    );
}
