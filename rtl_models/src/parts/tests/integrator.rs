//! The DDA integrator.

use stepwave_nc::{Curve, Line};
use stepwave_netlist::Width;
use stepwave_netlist::bits::Reading;
use stepwave_netlist::dsl::Scope;

use super::super::{Iteration, JV, digits, integrator, rotated};
use super::bench::{Bench, loader, numbers, on_every_engine};
use crate::options::{ADDER, RADIX, WIDTH};
use crate::{Adder, Hardware, Options, Radix, find};

/// Integrators of `bits` bits, the integrand of x of `jv_bits`.
fn hardware(bits: u32, jv_bits: u32, radix: Radix, adder: Adder) -> Hardware {
    let line = Curve::Line(Line::new(vec![0, 0], vec![1, 1]).unwrap());
    let width = |bits: u32| Width::new(bits.into()).unwrap();
    let options = Options::default()
        .with_all(&WIDTH, width(bits))
        .with_single(&WIDTH, [("jvx".to_owned(), width(jv_bits))].into())
        .with(&RADIX, radix)
        .with(&ADDER, adder);
    find("dda-line").unwrap().plan(&line, &options).unwrap()
}

/// Remainder `jrx`, integrand `jv`, and the pulse; one clock an iteration.
fn axis(m: Scope<'_>, hardware: &Hardware) {
    let block = loader(m);
    let step = m.input("step", 1);
    let jv = m.input("jv", hardware.bits(JV.of(0)));
    let step = Iteration::new(m, &block, hardware, step);
    m.name("pulse", integrator(m, &block, hardware, 0, jv, step));
}

/// The same, serial: the integrand `jv` rotates.
fn serial_axis(m: Scope<'_>, hardware: &Hardware) {
    let block = loader(m);
    let jv = m.reg("jv", hardware.bits(JV.of(0))).shown(digits(hardware));
    let word = block.word_in(hardware.get(&RADIX), "jv", hardware.bits(JV.of(0)));
    let step = Iteration::new(m, &block, hardware, m.input("step", 1));
    jv.when(block.load, word).when(step.add, rotated(hardware, jv.q)).else_hold();
    m.name("complete", step.complete);
    m.name("sent", integrator(m, &block, hardware, 0, jv.q, step));
}

/// One more than the greatest number in `bits` bits, and the bits of a number.
fn scale(radix: Radix, bits: u32) -> (i128, impl Fn(i128) -> i128) {
    let reading = if radix == Radix::Decimal { Reading::Decimal } else { Reading::Unsigned };
    let full = if radix == Radix::Decimal { 10i128.pow(bits / 4) } else { 1 << bits };
    let width = Width::new(bits.into()).unwrap();
    (full, move |number| i128::from(reading.bits(width, number).unwrap().value()))
}

#[test]
fn every_integrand_from_every_preset_gives_the_floor_of_its_sum() {
    for bits in 1..=4 {
        for jv_bits in 1..=bits {
            let hardware = hardware(bits, jv_bits, Radix::Binary, Adder::Parallel);
            on_every_engine(
                |m| axis(m, &hardware),
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
fn a_decimal_integrator_counts_from_9_to_0_in_every_digit() {
    for (bits, integrands) in [(4, (0..10).collect::<Vec<i128>>()), (8, vec![0, 1, 9, 10, 37, 50, 90, 99])] {
        let hardware = hardware(bits, bits, Radix::Decimal, Adder::Parallel);
        let (full, coded) = scale(Radix::Decimal, bits);
        on_every_engine(
            |m| axis(m, &hardware),
            |bench| {
                for &jv in &integrands {
                    for preset in [0, full / 2, full - 1] {
                        bench.clock(&[("load", 1), ("jrx_in", coded(preset)), ("step", 0), ("jv", coded(jv))]);
                        bench.clock(&[("load", 0), ("step", 1)]);
                        let mut pulses = 0;
                        for t in 1..=full {
                            pulses += bench.value("pulse");
                            bench.clock(&[]);
                            let sum = t * jv + preset;
                            assert_eq!(pulses, sum / full, "J_V = {jv}, preset {preset}, step {t}");
                            assert_eq!(bench.value("jrx"), coded(sum % full), "J_V = {jv}, preset {preset}, step {t}");
                        }
                    }
                }
            },
        );
    }
}

/// Adds every pair once, digit by digit, and looks at every clock.
fn check_serial(bench: &mut Bench, radix: Radix, bits: u32) {
    let (full, coded) = scale(radix, bits);
    let clocks = bits / radix.digit_bits();
    for preset in 0..full {
        for jv in 0..full {
            bench.clock(&[("load", 1), ("jrx_in", coded(preset)), ("jv_in", coded(jv)), ("step", 0)]);
            bench.clock(&[("load", 0), ("step", 1)]);
            // Twice, so that a carry left over from the first would be seen.
            for before in [preset, (preset + jv) % full] {
                for place in 0..clocks {
                    let last = place + 1 == clocks;
                    assert_eq!(bench.value("place"), i128::from(place), "{preset} + {jv}");
                    assert_eq!(bench.value("complete"), i128::from(last));
                    let pulse = i128::from(last && before + jv >= full);
                    assert_eq!(bench.value("sent"), pulse, "{preset} + {jv} at place {place}");
                    bench.clock(&[]);
                }
                assert_eq!(bench.value("jrx"), coded((before + jv) % full), "{before} + {jv}");
                assert_eq!(bench.value("jv"), coded(jv), "the integrand is back");
                assert_eq!(bench.value("carry"), 0);
            }
        }
    }
}

#[test]
fn a_serial_integrator_adds_as_the_parallel_one_does_and_its_integrand_comes_back() {
    for bits in 1..=4 {
        let hardware = hardware(bits, bits, Radix::Binary, Adder::Serial);
        on_every_engine(|m| serial_axis(m, &hardware), |bench| check_serial(bench, Radix::Binary, bits));
    }
}

#[test]
fn a_serial_integrator_in_radix_10_adds_a_digit_a_clock() {
    let one_digit = hardware(4, 4, Radix::Decimal, Adder::Serial);
    on_every_engine(|m| serial_axis(m, &one_digit), |bench| check_serial(bench, Radix::Decimal, 4));
    let two_digits = hardware(8, 8, Radix::Decimal, Adder::Serial);
    on_every_engine(
        |m| serial_axis(m, &two_digits),
        |bench| {
            // 57 + 68 = 125: 7 + 8 leave 5 and a carry, 5 + 6 + 1 leave 2 and the pulse.
            bench.play(&[("load", "1000_00"), ("jrx_in", "0000_00"), ("jv_in", "0000_00"), ("step", "0111_11")]);
            assert_eq!(bench.row("place"), "0010_10");
            bench.clock(&[("load", 1), ("jrx_in", 0x57), ("jv_in", 0x68), ("step", 0)]);
            let mut seen = Vec::new();
            for step in [1, 1, 0] {
                bench.clock(&[("load", 0), ("step", step)]);
                seen.push(["jrx", "jv", "carry", "sum_low", "sent"].map(|name| bench.value(name)));
            }
            assert_eq!(seen, [[0x57, 0x68, 0, 5, 0], [0x55, 0x86, 1, 2, 1], [0x25, 0x68, 0, 3, 0]]);
        },
    );
}

#[test]
fn six_of_sixteen_pulses_where_the_textbook_table_has_them() {
    let hardware = hardware(4, 4, Radix::Binary, Adder::Parallel);
    on_every_engine(
        |m| axis(m, &hardware),
        |bench| {
            bench.play(&[
                ("load", "1_0000_0000_0000_0000"),
                ("step", "0_1111_1111_1111_1111"),
                ("jv", "6_6666_6666_6666_6666"),
            ]);
            // Steps 3, 6, 8, 11, 14 and 16; the remainder is read before each of them.
            assert_eq!(bench.row("pulse"), "0001_0010_1001_0010_1");
            assert_eq!(bench.row("carry"), bench.row("pulse"));
            assert_eq!(bench.row("jrx"), "006c_28e4_a06c_28e4_a");
        },
    );
}

#[test]
fn an_axis_that_does_not_step_freezes_its_remainder_and_sends_no_pulse() {
    let hardware = hardware(3, 3, Radix::Binary, Adder::Parallel);
    on_every_engine(
        |m| axis(m, &hardware),
        |bench| {
            bench.play(&[("load", "1000_0000_0000"), ("step", "0110_0101_1000"), ("jv", "0555_5550_5000")]);
            assert_eq!(bench.row("jrx"), "0052_2277_7444");
            assert_eq!(bench.row("pulse"), "0010_0000_1000");
        },
    );
}

#[test]
fn a_load_wins_over_a_step() {
    let parallel = hardware(3, 3, Radix::Binary, Adder::Parallel);
    on_every_engine(
        |m| axis(m, &parallel),
        |bench| {
            bench.play(&[("load", "0010_00"), ("jrx_in", "0040_00"), ("step", "1111_00"), ("jv", "3333_33")]);
            assert_eq!(bench.row("jrx"), "0364_77");
        },
    );
    let serial = hardware(3, 3, Radix::Binary, Adder::Serial);
    on_every_engine(
        |m| serial_axis(m, &serial),
        |bench| {
            // A load in the middle of an iteration drops the carry and begins at the lowest bit.
            bench.play(&[
                ("load", "1001_0000"),
                ("jrx_in", "3003_0000"),
                ("jv_in", "1001_0000"),
                ("step", "0111_1111"),
            ]);
            assert_eq!(bench.row("place"), "0012_0120");
            assert_eq!(bench.row("carry"), "0011_0110");
            assert_eq!(bench.row("jrx"), "0310_3104");
        },
    );
}
