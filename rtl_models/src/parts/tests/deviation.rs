//! The deviation accumulator.

use stepwave_netlist::dsl::Scope;

use super::super::DeviationAccumulator;
use super::bench::{Bench, input, loader, numbers, on_every_engine, wrapped};

fn accumulator(m: Scope<'_>, bits: u32, operand: (u32, bool)) {
    let block = loader(m);
    let f = DeviationAccumulator::new(m, bits);
    m.name("not_negative", f.not_negative());
    f.close(&block, m.input("compute", 1), m.input("subtract", 1), input(m, "operand", operand.0, operand.1));
}

/// Every deviation with every operand, against exact integers.
fn check_all(bench: &mut Bench, bits: u32, operand: (u32, bool)) {
    for f in numbers(bits, true) {
        for by in numbers(operand.0, operand.1) {
            for (compute, subtract) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                bench.clock(&[("load", 1), ("f_in", f), ("compute", 0)]);
                bench.clock(&[("load", 0), ("compute", compute), ("subtract", subtract), ("operand", by)]);
                let what = format!("{f} in {bits} bits, operand {by} of {operand:?}, subtract {subtract}");
                let exact = f + compute * if subtract == 1 { -by } else { by };
                let lost = i128::from(!numbers(bits, true).contains(&exact));
                assert_eq!(bench.value("f"), f, "{what}");
                assert_eq!(bench.value("not_negative"), i128::from(f >= 0), "{what}");
                assert_eq!(bench.value("f_add_overflow"), lost * (1 - subtract), "{what}");
                assert_eq!(bench.value("f_sub_overflow"), lost * subtract, "{what}");
                bench.clock(&[("compute", 0)]);
                assert_eq!(bench.value("f"), wrapped(exact, bits, true), "{what}");
            }
        }
    }
}

#[test]
fn every_operand_of_up_to_five_bits_and_either_reading_is_exact_or_flagged() {
    for bits in 1..=4 {
        for operand_bits in 1..=5 {
            for signed in [false, true] {
                let operand = (operand_bits, signed);
                on_every_engine(|m| accumulator(m, bits, operand), |bench| check_all(bench, bits, operand));
            }
        }
    }
}

#[test]
fn the_worked_line_to_6_4_shows_its_column_of_deviations() {
    on_every_engine(
        |m| accumulator(m, 4, (3, false)),
        |bench| {
            // F >= 0 subtracts b = 4, F < 0 adds a = 6.
            bench.play(&[
                ("load", "1000_0000_0000"),
                ("compute", "0111_1111_1110"),
                ("subtract", "0101_0110_1010"),
                ("operand", "0464_6446_4640"),
            ]);
            assert_eq!(bench.numbers("f"), [0, 0, -4, 2, -2, 4, 0, -4, 2, -2, 4, 0]);
            assert_eq!(bench.row("not_negative"), "1101_0110_1011");
            assert_eq!(bench.row("f_add_overflow"), "0000_0000_0000");
            assert_eq!(bench.row("f_sub_overflow"), "0000_0000_0000");
        },
    );
}

#[test]
fn the_deviation_holds_without_compute_and_a_load_wins_over_it() {
    on_every_engine(
        |m| accumulator(m, 4, (2, false)),
        |bench| {
            bench.play(&[
                ("load", "0000_1000"),
                ("f_in", "5555_5555"),
                ("compute", "0110_1000"),
                ("subtract", "0001_0000"),
                ("operand", "1111_1111"),
            ]);
            assert_eq!(bench.row("f"), "0012_2555");
        },
    );
}

#[test]
fn a_deviation_is_flagged_only_where_the_register_takes_it() {
    on_every_engine(
        |m| accumulator(m, 3, (3, false)),
        |bench| {
            // 3 + 7 and -1 - 7 at a load, then 0 + 7 and -1 - 7 where they are taken.
            bench.play(&[
                ("load", "0101_0100_0"),
                ("f_in", "030-_0000_0"),
                ("compute", "0001_0111_0"),
                ("subtract", "0000_0101_0"),
                ("operand", "0007_0777_0"),
            ]);
            assert_eq!(bench.numbers("f"), [0, 0, 3, 3, -1, -1, 0, -1, 0]);
            assert_eq!(bench.row("f_add_overflow"), "0000_0010_0");
            assert_eq!(bench.row("f_sub_overflow"), "0000_0001_0");
        },
    );
}
