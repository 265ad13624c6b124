//! The sequential multiplier, divider and square root, and the microprogram that starts them.

use super::super::Task::{Start, Wait};
use super::super::{Long, Microprogram, SerialDivider, SerialMultiplier, SerialRoot, multiply, row, states};
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
                unit.close(&[(m.input("start", 1), m.input("a", a_bits).into(), m.input("b", b_bits).into())]);
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
                unit.close(&[(m.input("start", 1), m.input("a", n).into(), m.input("b", d).into())]);
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
                unit.close(&[(m.input("start", 1), m.input("a", 2 * k).into())]);
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

/// The lowest 64 bits, and those above them.
fn halves(value: i128) -> [i128; 2] {
    [value & i128::from(u64::MAX), value >> 64]
}

/// Numbers whose carries and borrows reach the next part, and some others.
const WIDE: [i128; 6] = [0, 1, (1 << 64) - 1, 1 << 64, (1 << 70) - 3, 0x2A_5555_F0F0_1234_5678];

#[test]
fn numbers_of_more_than_64_bits_are_multiplied_and_divided_in_parts() {
    on_every_engine(
        |m| {
            let [low, high, by] = [("low", 64), ("high", 6), ("by", 50)].map(|(name, bits)| m.input(name, bits));
            let (start, wide) = (m.input("start", 1), Long::from(high).concat(low));
            let multiplier = SerialMultiplier::new(m, 70, 50);
            let divider = SerialDivider::new(m, 70, 50);
            let root = SerialRoot::new(m, 66);
            let radicand = wide.extend(m, 132);
            m.name("running", multiplier.running() | divider.running() | root.running());
            m.name("product_above", multiplier.long_product().slice(64, 56).net());
            m.name("divider_rest", divider.remainder());
            m.name("quotient_above", divider.long_quotient().slice(64, 6).net());
            multiplier.close(&[(start, wide, by.into())]);
            divider.close(&[(start, wide, by.into())]);
            root.close(&[(start, radicand)]);
        },
        |bench| {
            for a in WIDE {
                for b in [1, 7, (1 << 50) - 1, 0x2_AAAA_0000_1234] {
                    let [low, high] = halves(a);
                    wait(bench, &[("low", low), ("high", high), ("by", b)], 70);
                    let parts = |name: &str, above: &str| [bench.value(name), bench.value(above)];
                    assert_eq!(parts("product", "product_above"), halves(a * b), "{a} · {b}");
                    assert_eq!(parts("quotient", "quotient_above"), halves(a / b), "{a} / {b}");
                    assert_eq!((bench.value("divider_rest"), bench.value("root")), (a % b, a.isqrt()), "{a}");
                }
            }
        },
    );
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
                row(at::FIRST, multiply(m.lit(2, 3), m.lit(2, 2)), [(total, product)], at::SECOND)
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
