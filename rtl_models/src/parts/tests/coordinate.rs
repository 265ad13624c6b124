//! The up/down counter.

use stepwave_netlist::OnOverflow;
use stepwave_netlist::dsl::Scope;

use super::super::up_down_counter;
use super::bench::{Bench, input, numbers, on_every_engine, on_every_engine_with, wrapped};

/// A counter `c` with one load arm; register and unit of any width and reading.
fn counter(m: Scope<'_>, bits: u32, signed: bool, unit: (u32, bool)) {
    let register = if signed { m.reg_signed("c", bits) } else { m.reg("c", bits) };
    let loads = [(m.input("load", 1), input(m, "c_in", bits, signed))];
    up_down_counter(register, &loads, m.input("up", 1), m.input("down", 1), input(m, "unit", unit.0, unit.1));
}

/// Every count from every number by every unit, against exact integers.
fn check_every_count(bench: &mut Bench, bits: u32, signed: bool, unit: (u32, bool)) {
    for from in numbers(bits, signed) {
        for by in numbers(unit.0, unit.1) {
            for (up, down) in [(0, 0), (1, 0), (0, 1)] {
                bench.clock(&[("load", 1), ("c_in", from), ("up", 0), ("down", 0)]);
                bench.clock(&[("load", 0), ("up", up), ("down", down), ("unit", by)]);
                let exact = from + (up - down) * by;
                let lost = i128::from(!numbers(bits, signed).contains(&exact));
                let what = format!("{from} {up}/{down} {by} of {unit:?} in {bits} bits, signed {signed}");
                assert_eq!(bench.value("c"), from, "{what}");
                assert_eq!(bench.value("c_add_overflow"), up * lost, "{what}");
                assert_eq!(bench.value("c_sub_overflow"), down * lost, "{what}");
                bench.clock(&[("up", 0), ("down", 0)]);
                assert_eq!(bench.value("c"), wrapped(exact, bits, signed), "{what}");
            }
        }
    }
}

#[test]
fn every_count_of_up_to_four_bits_is_exact_or_flagged() {
    for bits in 1..=4 {
        for unit_bits in 1..=bits {
            for (signed, unit_signed) in [(false, false), (false, true), (true, false), (true, true)] {
                let unit = (unit_bits, unit_signed);
                on_every_engine(
                    |m| counter(m, bits, signed, unit),
                    |bench| check_every_count(bench, bits, signed, unit),
                );
            }
        }
    }
}

#[test]
fn a_magnitude_is_flagged_where_it_would_leave_either_end() {
    on_every_engine(
        |m| counter(m, 2, false, (1, false)),
        |bench| {
            let loads = [("load", "0000_0000_0000"), ("c_in", "0000_0000_0000"), ("unit", "1111_1111_1111")];
            bench.play(&[&[("up", "0111_1000_0000"), ("down", "0000_0011_0000")], &loads[..]].concat());
            assert_eq!(bench.row("c"), "0012_3003_2222");
            assert_eq!(bench.row("c_add_overflow"), "0000_1000_0000");
            assert_eq!(bench.row("c_sub_overflow"), "0000_0010_0000");
        },
    );
}

#[test]
fn a_signed_coordinate_is_flagged_where_it_would_leave_either_end() {
    on_every_engine(
        |m| counter(m, 2, true, (1, false)),
        |bench| {
            let loads = [("load", "0000_0000"), ("c_in", "0000_0000"), ("unit", "1111_1111")];
            bench.play(&[&[("up", "0110_0000"), ("down", "0000_1000")], &loads[..]].concat());
            assert_eq!(bench.numbers("c"), [0, 0, 1, -2, -2, 1, 1, 1]);
            assert_eq!(bench.row("c_add_overflow"), "0010_0000");
            assert_eq!(bench.row("c_sub_overflow"), "0000_1000");
        },
    );
}

#[test]
fn a_saturating_machine_stops_at_its_ends_and_flags_all_the_same() {
    on_every_engine_with(
        OnOverflow::Saturate,
        |m| counter(m, 2, false, (2, false)),
        |bench| {
            let loads = [("load", "0000_0000"), ("c_in", "0000_0000"), ("unit", "2222_2222")];
            bench.play(&[&[("up", "0111_0000"), ("down", "0000_1110")], &loads[..]].concat());
            assert_eq!(bench.row("c"), "0023_3100");
            assert_eq!(bench.row("c_add_overflow"), "0011_0000");
            assert_eq!(bench.row("c_sub_overflow"), "0000_0110");
        },
    );
}

#[test]
fn the_first_load_wins_over_the_second_and_either_over_the_count() {
    on_every_engine(
        |m| {
            let register = m.reg("c", 4);
            let loads = [(m.input("first", 1), m.lit(4, 9)), (m.input("second", 1), m.lit(4, 6))];
            up_down_counter(register, &loads, m.input("up", 1), m.lit(1, 0), m.lit(1, 1));
        },
        |bench| {
            bench.play(&[("up", "1111_1111"), ("first", "0010_0010"), ("second", "0010_1000")]);
            assert_eq!(bench.row("c"), "0129_a679");
        },
    );
}

#[test]
fn a_count_is_flagged_only_where_the_register_takes_it() {
    on_every_engine(
        |m| {
            let register = m.reg("c", 2);
            let loads = [(m.input("first", 1), m.lit(2, 3)), (m.input("second", 1), m.lit(2, 0))];
            up_down_counter(register, &loads, m.input("up", 1), m.input("down", 1), m.lit(1, 1));
        },
        |bench| {
            // At 3, then at 0, a load wins over the count that would not fit; then the count itself.
            bench.play(&[
                ("first", "1100_0000_0"),
                ("second", "0010_0110_0"),
                ("up", "0111_0000_0"),
                ("down", "0000_1111_0"),
            ]);
            assert_eq!(bench.row("c"), "0330_1000_3");
            assert_eq!(bench.row("c_add_overflow"), "0000_0000_0");
            assert_eq!(bench.row("c_sub_overflow"), "0000_0001_0");
        },
    );
}

#[test]
fn a_counter_without_loads_counts_from_reset() {
    on_every_engine(
        |m| up_down_counter(m.reg("c", 3), &[], m.input("up", 1), m.input("down", 1), m.lit(2, 3)),
        |bench| {
            bench.play(&[("up", "1100_0"), ("down", "0001_0")]);
            assert_eq!(bench.row("c"), "0366_3");
        },
    );
}
