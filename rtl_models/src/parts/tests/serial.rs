//! The sequential multiplier, divider and square root, and the sequence that starts them.

use super::super::{Sequencer, SerialDivider, SerialMultiplier, SerialRoot};
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
                        assert_eq!(bench.value("product"), a * b, "it stands");
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

#[test]
fn a_sequence_begins_each_state_once_waits_for_its_result_and_goes_on() {
    on_every_engine(
        |m| {
            let sequence = Sequencer::new(m, &[(0, "IDLE"), (1, "FIRST"), (2, "SECOND")]);
            let busy = m.input("busy", 1);
            m.name("begins", sequence.begins(1) | sequence.begins(2));
            let [first, second] = [1, 2].map(|state| sequence.ends(state, busy));
            sequence.close(m.input("load", 1), &[(first, 2), (second, 0)]);
        },
        |bench| {
            bench.play(&[("load", "1000_0000_0010"), ("busy", "0010_0110_0000")]);
            assert_eq!(bench.row("state"), "0111_2222_0001");
            assert_eq!(bench.row("begins"), "0100_1000_0001");
        },
    );
}
