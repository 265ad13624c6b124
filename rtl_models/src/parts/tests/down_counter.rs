//! End-point down-counters and the count of pulses.

use stepwave_netlist::dsl::{Scope, Signal};

use super::super::{DownCounter, population_count};
use super::bench::{Bench, loader, numbers, on_every_engine};

/// A counter `e` closed by `close`, whose result is shown as `zero`.
fn counter(m: Scope<'_>, bits: u32, close: impl for<'m> FnOnce(Scope<'m>, DownCounter<'m>) -> Signal<'m>) {
    let counter = DownCounter::new(m, &loader(m), "e", bits);
    m.name("running", counter.running());
    m.name("zero", close(m, counter));
}

/// Loads `from`, lets one edge pass with these inputs, and compares the value after it.
fn check(bench: &mut Bench, from: i128, inputs: &[(&str, i128)], after: i128) {
    let idle: Vec<(&str, i128)> = inputs.iter().map(|(name, _)| (*name, 0)).collect();
    bench.clock(&[&[("load", 1), ("e_in", from)], &idle[..]].concat());
    bench.clock(&[&[("load", 0)], inputs].concat());
    assert_eq!(bench.value("running"), i128::from(from != 0), "{from} {inputs:?}");
    assert_eq!(bench.value("zero"), i128::from(after == 0), "{from} {inputs:?}");
    bench.clock(&idle);
    assert_eq!(bench.value("e"), after, "{from} {inputs:?}");
}

#[test]
fn a_counter_runs_from_its_word_to_zero_and_marks_the_last_count() {
    on_every_engine(
        |m| counter(m, 2, |m, e| e.count(m.input("count", 1))),
        |bench| {
            bench.play(&[("load", "0100_0000_00"), ("e_in", "3333_3333_33"), ("count", "0001_0110_00")]);
            assert_eq!(bench.row("e"), "0033_2210_00");
            assert_eq!(bench.row("running"), "0011_1110_00");
            // At the load the register takes its word, not the next count.
            assert_eq!(bench.row("zero"), "1000_0011_11");
            assert_eq!(bench.row("e_sub_overflow"), "0000_0000_00");
        },
    );
}

#[test]
fn a_count_below_zero_is_flagged_and_no_other() {
    for bits in 1..=4 {
        on_every_engine(
            |m| counter(m, bits, |m, e| e.count(m.input("count", 1))),
            |bench| {
                for from in numbers(bits, false) {
                    for count in [0, 1] {
                        check(bench, from, &[("count", count)], (from - count).rem_euclid(1 << bits));
                        bench.clock(&[("load", 1), ("e_in", from)]);
                        bench.clock(&[("load", 0), ("count", count)]);
                        assert_eq!(bench.value("e_sub_overflow"), i128::from(from < count));
                        bench.clock(&[("count", 0)]);
                    }
                }
            },
        );
    }
}

#[test]
fn a_load_wins_over_a_count() {
    on_every_engine(
        |m| counter(m, 3, |m, e| e.count(m.input("count", 1))),
        |bench| {
            bench.play(&[("load", "1001_00"), ("e_in", "5555_55"), ("count", "0011_00")]);
            assert_eq!(bench.row("e"), "0554_55");
        },
    );
}

#[test]
fn a_load_wins_over_what_a_count_would_say() {
    type Close = for<'m> fn(Scope<'m>, DownCounter<'m>) -> Signal<'m>;
    let closes: [Close; 3] = [
        |m, e| e.count(m.input("count", 1)),
        |m, e| e.count_pulses(m.input("count", 1)),
        |m, e| e.count_or_halve(m.input("count", 1), m.lit(1, 1)),
    ];
    for (index, close) in closes.into_iter().enumerate() {
        on_every_engine(
            |m| counter(m, 2, close),
            |bench| {
                // A count from 0 and one from 1, both at a load.
                bench.play(&[("load", "0110_00"), ("e_in", "0120_00"), ("count", "0111_00")]);
                assert_eq!(bench.row("e"), ["0012_11", "0012_11", "0012_10"][index]);
                assert_eq!(bench.row("zero"), ["1000_00", "1000_00", "1000_11"][index]);
                if bench.design().netlist().find("e_sub_overflow").is_some() {
                    assert_eq!(bench.row("e_sub_overflow"), "0000_00");
                }
            },
        );
    }
}

#[test]
fn several_pulses_at_once_stop_at_zero_without_a_flag() {
    for bits in 1..=4 {
        for pulse_bits in 1..=4 {
            on_every_engine(
                |m| counter(m, bits, |m, e| e.count_pulses(m.input("pulses", pulse_bits))),
                |bench| {
                    assert!(bench.design().netlist().properties.is_empty());
                    for from in numbers(bits, false) {
                        for pulses in numbers(pulse_bits, false) {
                            check(bench, from, &[("pulses", pulses)], (from - pulses).max(0));
                        }
                    }
                },
            );
        }
    }
}

#[test]
fn a_counter_is_halved_unless_it_counts() {
    for bits in 1..=4 {
        on_every_engine(
            |m| counter(m, bits, |m, e| e.count_or_halve(m.input("count", 1), m.input("halve", 1))),
            |bench| {
                for from in numbers(bits, false) {
                    check(bench, from, &[("count", 0), ("halve", 0)], from);
                    check(bench, from, &[("count", 0), ("halve", 1)], from / 2);
                    let less = (from - 1).rem_euclid(1 << bits);
                    check(bench, from, &[("count", 1), ("halve", 0)], less);
                    check(bench, from, &[("count", 1), ("halve", 1)], less);
                    bench.clock(&[("load", 1), ("e_in", from)]);
                    bench.clock(&[("load", 0), ("count", 1)]);
                    assert_eq!(bench.value("e_sub_overflow"), i128::from(from == 0));
                    bench.clock(&[("count", 0)]);
                }
            },
        );
    }
}

#[test]
fn the_count_of_pulses_is_the_number_of_ones() {
    const LINES: u32 = 5;
    on_every_engine(
        |m| {
            let all = m.input("all", LINES);
            let ones: Vec<_> = (0..LINES).map(|line| all.bit(line)).collect();
            m.name("count", population_count(m, 3, &ones));
            m.name("none", population_count(m, 2, &[]));
        },
        |bench| {
            for all in numbers(LINES, false) {
                bench.clock(&[("all", all)]);
                assert_eq!(bench.value("count"), i128::from(all.count_ones()), "{all:05b}");
                assert_eq!(bench.value("none"), 0);
            }
        },
    );
}
