//! The phase accumulator.

use stepwave_netlist::OnOverflow;
use stepwave_netlist::dsl::Scope;

use super::super::PhaseAccumulator;
use super::bench::{loader, numbers, on_every_engine, on_every_engine_with, wrapped};

/// Registers `accx` and `ratex` of this many bits; the bit `pick_off` is watched.
fn accumulator(m: Scope<'_>, bits: [u32; 2], pick_off: u64, on_overflow: OnOverflow) {
    let block = loader(m);
    let acc = PhaseAccumulator::new(m, &block, 0, bits, pick_off, on_overflow);
    m.name("steps", acc.steps());
    m.name("negative", acc.negative());
    acc.close(&block, m.input("accumulate", 1));
}

#[test]
fn every_sum_is_exact_or_flagged_and_a_change_of_its_pick_off_bit_is_a_step() {
    for on_overflow in [OnOverflow::Wrap, OnOverflow::Saturate] {
        for (acc_bits, rate_bits, pick_off) in [(1, 1, 0), (3, 2, 1), (4, 3, 2), (4, 4, 3), (3, 4, 1), (3, 3, 5)] {
            on_every_engine_with(
                on_overflow,
                |m| accumulator(m, [acc_bits, rate_bits], pick_off, on_overflow),
                |bench| {
                    for acc in numbers(acc_bits, true) {
                        for rate in numbers(rate_bits, true) {
                            bench.clock(&[("load", 1), ("accx_in", acc), ("ratex_in", rate), ("accumulate", 0)]);
                            bench.clock(&[("load", 0), ("accumulate", 1)]);
                            let exact = acc + rate;
                            let lost = !numbers(acc_bits, true).contains(&exact);
                            let (least, most) = numbers(acc_bits, true).into_inner();
                            let next = match on_overflow {
                                OnOverflow::Saturate => exact.clamp(least, most),
                                _ => wrapped(exact, acc_bits, true),
                            };
                            // Numbers of any size have their sign in every bit above them.
                            let changes = (acc >> pick_off) & 1 != (next >> pick_off) & 1;
                            let what = format!("{acc} + {rate} in {acc_bits} bits, bit {pick_off}, {on_overflow:?}");
                            assert_eq!(bench.value("steps"), i128::from(changes), "{what}");
                            assert_eq!(bench.value("negative"), i128::from(rate < 0), "{what}");
                            assert_eq!(bench.value("accx_add_overflow"), i128::from(lost), "{what}");
                            bench.clock(&[("accumulate", 0)]);
                            assert_eq!(bench.value("accx"), next, "{what}");
                        }
                    }
                },
            );
        }
    }
}

#[test]
fn a_rate_of_three_quarters_steps_three_times_in_four_accumulations_in_both_directions() {
    on_every_engine(
        |m| accumulator(m, [6, 4], 2, OnOverflow::Trap),
        |bench| {
            let waves = [("load", "1000_0000_00"), ("accumulate", "0111_1111_10")];
            bench.play(&[&waves[..], &[("ratex_in", "3333_3333_33"), ("accx_in", "0000_0000_00")]].concat());
            assert_eq!(bench.numbers("accx"), [0, 0, 3, 6, 9, 12, 15, 18, 21, 24]);
            // The step comes with the accumulation that makes it.
            assert_eq!(bench.row("steps"), "0011_1011_10");
            bench.play(&[&waves[..], &[("ratex_in", "----_----_--"), ("accx_in", "1111_1111_11")]].concat());
            assert_eq!(bench.numbers("accx"), [0, 1, 0, -1, -2, -3, -4, -5, -6, -7]);
            assert_eq!(bench.row("steps"), "0010_0010_00");
        },
    );
}

#[test]
fn an_accumulation_that_waits_keeps_its_sum_and_raises_no_flag_and_a_load_wins() {
    on_every_engine(
        |m| accumulator(m, [3, 3], 1, OnOverflow::Trap),
        |bench| {
            // 3 + 2 does not fit; it is taken at the last edge only.
            bench.play(&[
                ("load", "1000_1000_0"),
                ("accx_in", "1000_3000_0"),
                ("ratex_in", "2000_2000_0"),
                ("accumulate", "0010_1010_0"),
            ]);
            assert_eq!(bench.numbers("accx"), [0, 1, 1, 3, 3, 3, 3, -3, -3]);
            assert_eq!(bench.row("accx_add_overflow"), "0000_0010_0");
        },
    );
}
