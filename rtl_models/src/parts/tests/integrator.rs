//! The DDA integrator.

use stepwave_kernel::dsl::Scope;

use super::super::integrator;
use super::bench::{loader, numbers, on_every_engine};

/// Remainder `jrx` of `bits` bits, integrand `jv` of `jv_bits`, and the pulse.
fn axis(m: Scope<'_>, bits: u32, jv_bits: u32) {
    let block = loader(m);
    let pulse = integrator(m, &block, "x", bits, m.input("jv", jv_bits), m.input("step", 1));
    m.name("pulse", pulse);
}

#[test]
fn every_integrand_from_every_preset_gives_the_floor_of_its_sum() {
    for bits in 1..=4 {
        for jv_bits in 1..=bits {
            on_every_engine(
                |m| axis(m, bits, jv_bits),
                |bench| {
                    let full = 1 << bits;
                    for preset in numbers(bits, false) {
                        for jv in numbers(jv_bits, false) {
                            bench.clock(&[("load", 1), ("jrx_in", preset), ("step", 0), ("jv", jv)]);
                            bench.clock(&[("load", 0), ("step", 1)]);
                            let mut pulses = 0;
                            for t in 1..=full {
                                pulses += bench.value("pulse");
                                bench.clock(&[]);
                                let sum = t * jv + preset;
                                let what = format!("n = {bits}, J_V = {jv}, preset {preset}, step {t}");
                                assert_eq!(pulses, sum / full, "{what}");
                                assert_eq!(bench.value("jrx"), sum % full, "{what}");
                            }
                            assert_eq!(pulses, jv, "the end point is exact");
                            assert_eq!(bench.value("jrx"), preset, "the remainder is back at its preset");
                        }
                    }
                },
            );
        }
    }
}

#[test]
fn six_of_sixteen_pulses_where_the_textbook_table_has_them() {
    on_every_engine(
        |m| axis(m, 4, 4),
        |bench| {
            bench.play(&[
                ("load", "1_0000_0000_0000_0000"),
                ("step", "0_1111_1111_1111_1111"),
                ("jv", "6_6666_6666_6666_6666"),
            ]);
            // Steps 3, 6, 8, 11, 14 and 16; the remainder stands before each of them.
            assert_eq!(bench.row("pulse"), "0001_0010_1001_0010_1");
            assert_eq!(bench.row("carry"), bench.row("pulse"));
            assert_eq!(bench.row("jrx"), "006c_28e4_a06c_28e4_a");
        },
    );
}

#[test]
fn an_axis_that_does_not_step_freezes_its_remainder_and_sends_no_pulse() {
    on_every_engine(
        |m| axis(m, 3, 3),
        |bench| {
            bench.play(&[("load", "1000_0000_0000"), ("step", "0110_0101_1000"), ("jv", "0555_5550_5000")]);
            assert_eq!(bench.row("jrx"), "0052_2277_7444");
            assert_eq!(bench.row("pulse"), "0010_0000_1000");
        },
    );
}

#[test]
fn a_load_wins_over_a_step() {
    on_every_engine(
        |m| axis(m, 3, 3),
        |bench| {
            bench.play(&[("load", "0010_00"), ("jrx_in", "0040_00"), ("step", "1111_00"), ("jv", "3333_33")]);
            assert_eq!(bench.row("jrx"), "0364_77");
        },
    );
}
