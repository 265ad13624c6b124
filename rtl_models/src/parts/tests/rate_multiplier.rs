//! The digital pulse multiplier.

use std::cell::RefCell;

use stepwave_netlist::dsl::Scope;

use super::super::{RateMultiplier, Units};
use super::bench::{Bench, loader, numbers, on_every_engine};
use crate::options::Radix;

fn binary(bits: u32, count: u32) -> Units {
    Units { radix: Radix::Binary, bits, count }
}

fn decades(count: u32) -> Units {
    Units { radix: Radix::Decimal, bits: 4, count }
}

/// The counter `q` and the pulses of one coefficient, `m`, the digits of which have 4 bits each if it is decimal.
fn multiplier(m: Scope<'_>, units: Units) {
    let counter = RateMultiplier::new(m, &loader(m), "q", units, m.input("step", 1));
    let pulse = counter.gated(m, m.input("m", units.bits * units.count));
    m.name("pulse", pulse);
    m.name("last", counter.carry);
}

#[test]
fn each_stage_pulses_where_it_rises_and_the_carry_gives_none() {
    on_every_engine(
        |m| multiplier(m, binary(3, 1)),
        |bench| {
            let waves = [("load", "1000_0000_000"), ("step", "0111_1111_111"), ("m", "5555_5555_555")];
            bench.play(&waves);
            assert_eq!(bench.row("q"), "0012_3456_701");
            assert_eq!(bench.row("p0"), "0101_0101_010");
            assert_eq!(bench.row("p1"), "0010_0010_001");
            assert_eq!(bench.row("p2"), "0000_1000_000");
            assert_eq!(bench.row("carry"), "0000_0000_100");
            assert_eq!(bench.row("last"), "0000_0000_100");
            // 5 = 101 lets the fastest stage through and the slowest: clocks 1, 3, 4, 5, 7.
            assert_eq!(bench.row("g0"), bench.row("p0"));
            assert_eq!(bench.row("g1"), "0000_0000_000");
            assert_eq!(bench.row("g2"), bench.row("p2"));
            assert_eq!(bench.row("pulse"), "0101_1101_010");
        },
    );
}

#[test]
fn a_counter_that_does_not_step_holds_and_no_stage_pulses() {
    on_every_engine(
        |m| multiplier(m, binary(2, 1)),
        |bench| {
            bench.play(&[("load", "1000_0100_0"), ("step", "0101_1011_1"), ("m", "3333_3333_3")]);
            assert_eq!(bench.row("q"), "0011_2301_2");
            // A load wins, and starts from 0 again.
            assert_eq!(bench.row("pulse"), "0101_1011_1");
            assert_eq!(bench.row("last"), "0000_0000_0");
        },
    );
}

/// Pulses of a whole cycle, and the number of stages that pulsed at each of its clocks.
fn cycle(bench: &mut Bench, word: i128, stages: &[&str], clocks: u32) -> (i128, Vec<i128>) {
    bench.clock(&[("load", 1), ("step", 0), ("m", word)]);
    bench.clock(&[("load", 0), ("step", 1)]);
    let (mut pulses, mut fired) = (0, Vec::new());
    for clock in 1..=clocks {
        pulses += bench.value("pulse");
        fired.push(stages.iter().map(|stage| bench.value(stage)).sum());
        assert_eq!(bench.value("last"), i128::from(clock == clocks), "the carry, clock {clock}");
        bench.clock(&[]);
    }
    assert_eq!(bench.value("q"), 0, "the counter is back at 0");
    (pulses, fired)
}

#[test]
fn every_coefficient_gets_its_pulses_and_every_clock_one_stage() {
    for units in [binary(1, 1), binary(2, 1), binary(4, 1), binary(1, 4), binary(2, 2), binary(3, 2)] {
        let bits = units.bits * units.count;
        let names: Vec<String> = (0..bits).map(|stage| format!("p{stage}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        on_every_engine(
            |m| multiplier(m, units),
            |bench| {
                for word in numbers(bits, false) {
                    let (pulses, mut fired) = cycle(bench, word, &names, 1 << bits);
                    assert_eq!(pulses, word, "{units:?}");
                    assert_eq!(fired.pop(), Some(0), "the carry gives no pulse");
                    assert!(fired.iter().all(|&count| count == 1), "{units:?}: {fired:?}");
                }
            },
        );
    }
}

#[test]
fn cascaded_units_count_and_pulse_as_one_counter_with_pauses_too() {
    let (load, step) = ("1000_0000_0000_0000_0000_0000", "0111_1011_1110_1111_1111_0111");
    for word in numbers(4, false) {
        let coefficient = format!("{word:x}").repeat(24);
        let played = RefCell::new(Vec::new());
        for units in [binary(4, 1), binary(2, 2), binary(1, 4)] {
            on_every_engine(
                |m| multiplier(m, units),
                |bench| {
                    bench.play(&[("load", load), ("step", step), ("m", &coefficient)]);
                    played.borrow_mut().push(["q", "pulse", "last"].map(|name| bench.row(name)));
                },
            );
        }
        let played = played.into_inner();
        assert_eq!(played[0][0], "0012_3445_6789_9abc_def0_1123");
        assert!(played.windows(2).all(|pair| pair[0] == pair[1]), "{word}: {played:?}");
    }
}

#[test]
fn further_units_count_in_the_last_state_of_those_before_only() {
    on_every_engine(
        |m| multiplier(m, binary(2, 2)),
        |bench| {
            bench.play(&[
                ("load", "1_0000_0000_0000_0000_0"),
                ("step", "0_1111_1111_1111_1111_1"),
                ("m", "6_6666_6666_6666_6666_6"),
            ]);
            assert_eq!(bench.row("q1"), "0012_3012_3012_3012_30");
            assert_eq!(bench.row("q2"), "0000_0111_1222_2333_30");
            assert_eq!(bench.row("p2"), "0000_1000_0000_1000_00");
            assert_eq!(bench.row("p3"), "0000_0000_1000_0000_00");
            // 6 = 01|10: the second stage, and the third.
            assert_eq!(bench.row("pulse"), "0010_1010_0010_1010_00");
        },
    );
}

#[test]
fn a_decade_has_the_trains_of_its_bits() {
    on_every_engine(
        |m| multiplier(m, decades(1)),
        |bench| {
            bench.play(&[("load", "1000_0000_0000"), ("step", "0111_1111_1111"), ("m", "7777_7777_7777")]);
            assert_eq!(bench.row("q"), "0012_3456_7890");
            assert_eq!(bench.row("p8"), "0111_1011_1101");
            assert_eq!(bench.row("p4"), "0010_1010_1000");
            assert_eq!(bench.row("p2"), "0001_0001_0000");
            assert_eq!(bench.row("p1"), "0000_0100_0000");
            assert_eq!(bench.row("carry"), "0000_0000_0010");
            assert_eq!(bench.row("pulse"), "0011_1111_1000");
        },
    );
}

#[test]
fn decades_give_every_number_of_their_digits() {
    on_every_engine(
        |m| multiplier(m, decades(1)),
        |bench| {
            for digit in 0..=9 {
                assert_eq!(cycle(bench, digit, &[], 10).0, digit);
            }
        },
    );
    on_every_engine(
        |m| multiplier(m, decades(2)),
        |bench| {
            for number in 0..=99 {
                let digits = number / 10 * 16 + number % 10;
                assert_eq!(cycle(bench, digits, &[], 100).0, number);
            }
        },
    );
}
