//! The axis: pulse and position.

use stepwave_netlist::dsl::Scope;

use super::super::axis_counter;
use super::bench::{loader, numbers, on_every_engine, wrapped};

fn axis(m: Scope<'_>, bits: u32) {
    let block = loader(m);
    axis_counter(m.scope("axis"), &block, "x", bits, m.input("pulse", 1), m.input("negative", 1));
}

#[test]
fn a_pulse_shows_its_sign_for_one_clock_and_moves_the_position_by_one() {
    on_every_engine(
        |m| axis(m, 4),
        |bench| {
            bench.play(&[
                ("load", "0000_0000_0000"),
                ("preset_position", "0000_0000_0000"),
                ("pulse", "0101_1001_1000"),
                ("negative", "0000_1110_1000"),
            ]);
            assert_eq!(bench.row("dx"), "0010_1-00_1-00");
            assert_eq!(bench.row("x"), "0011_2111_2111");
        },
    );
}

#[test]
fn below_zero_the_position_is_twos_complement() {
    on_every_engine(
        |m| axis(m, 4),
        |bench| {
            bench.play(&[
                ("load", "0000_0"),
                ("preset_position", "0000_0"),
                ("pulse", "1111_0"),
                ("negative", "1101_0"),
            ]);
            assert_eq!(bench.numbers("dx"), [0, -1, -1, 1, -1]);
            assert_eq!(bench.numbers("x"), [0, -1, -2, -1, -2]);
        },
    );
}

#[test]
fn only_a_first_block_presets_the_position() {
    on_every_engine(
        |m| axis(m, 4),
        |bench| {
            bench.play(&[
                ("load", "0100_0101"),
                ("preset_position", "0101_0001"),
                ("x_in", "5555_3333"),
                // A preset wins over a pulse; a load alone does not.
                ("pulse", "0100_0101"),
                ("negative", "0000_0000"),
            ]);
            assert_eq!(bench.row("x"), "0055_5566");
            assert_eq!(bench.row("dx"), "0010_0010");
            bench.clock(&[]);
            assert_eq!(bench.value("x"), 3);
        },
    );
}

#[test]
fn every_pulse_from_every_position_is_exact_or_flagged() {
    for bits in 1..=4 {
        on_every_engine(
            |m| axis(m, bits),
            |bench| {
                for from in numbers(bits, true) {
                    for (pulse, negative) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        bench.clock(&[("load", 1), ("preset_position", 1), ("x_in", from), ("pulse", 0)]);
                        bench.clock(&[("load", 0), ("pulse", pulse), ("negative", negative)]);
                        let moved = pulse * (1 - 2 * negative);
                        let lost = i128::from(!numbers(bits, true).contains(&(from + moved)));
                        assert_eq!(bench.value("x_add_overflow"), lost * (1 - negative), "{from} {moved:+}");
                        assert_eq!(bench.value("x_sub_overflow"), lost * negative, "{from} {moved:+}");
                        bench.clock(&[("pulse", 0)]);
                        assert_eq!(bench.value("dx"), moved);
                        assert_eq!(bench.value("x"), wrapped(from + moved, bits, true), "{from} {moved:+}");
                    }
                }
            },
        );
    }
}
