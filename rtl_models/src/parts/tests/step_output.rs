//! Step and direction outputs, and their timers.

use stepwave_netlist::dsl::Scope;

use super::super::{StepOutput, Timer};
use super::bench::{Bench, numbers, on_every_engine};
use crate::options::StepTiming;

#[test]
fn a_timer_runs_for_its_clocks_and_begins_anew_when_it_is_started() {
    for clocks in 0..=9 {
        on_every_engine(
            |m| {
                let timer = Timer::new(m, "timer", clocks);
                m.name("running", timer.running());
                timer.close(m.input("start", 1));
            },
            |bench| {
                for again in 1..=11 {
                    bench.clock(&[("start", 1)]);
                    for t in 0..30 {
                        bench.clock(&[("start", i128::from(t + 1 == again))]);
                        let since = if t >= again { t - again } else { t };
                        let left = i128::from(clocks) - since;
                        assert_eq!(bench.value("timer"), left.max(0), "{clocks}, {t} clocks after");
                        assert_eq!(bench.value("running"), i128::from(left > 0));
                    }
                }
            },
        );
    }
}

/// Outputs `stepx` and `dirx` that send whenever they are ready and `want` is 1.
fn output(m: Scope<'_>, timing: StepTiming) {
    let output = StepOutput::new(m, "x", timing, m.input("negative", 1));
    m.name("ready", output.ready());
    let send = m.name("send", output.ready() & m.input("want", 1));
    m.name("over", output.close(send));
}

fn timing([length, space, setup, hold]: [u64; 4]) -> StepTiming {
    StepTiming { length, space, setup, hold }
}

#[test]
fn steps_wanted_at_every_clock_have_their_length_and_space() {
    let pulses = |timing, wave| {
        on_every_engine(
            |m| output(m, timing),
            |bench: &mut Bench| {
                bench.play(&[("want", "0111_1111_1111_1"), ("negative", "0000_0000_0000_0")]);
                assert_eq!(bench.row("stepx"), wave, "{timing}");
            },
        );
    };
    pulses(timing([1, 1, 0, 0]), "0010_1010_1010_1");
    pulses(timing([2, 2, 4, 4]), "0011_0011_0011_0");
    pulses(timing([1, 3, 0, 0]), "0010_0010_0010_0");
    pulses(timing([3, 1, 9, 9]), "0011_1011_1011_1");
}

#[test]
fn a_direction_waits_for_its_hold_time_and_a_step_for_the_set_up() {
    on_every_engine(
        |m| output(m, timing([2, 1, 3, 2])),
        |bench| {
            bench.play(&[("want", "1111_1111_1111_1111"), ("negative", "0011_1111_1111_1000")]);
            // The step of clock 1 ends at 3; held to 5; set up to 8.
            assert_eq!(bench.row("stepx"), "0110_0000_1101_1000");
            assert_eq!(bench.row("dirx"), "0000_0111_1111_1110");
            // From clock 13 on positive is wanted again; the step of clock 11 ends there.
            assert_eq!(bench.row("send"), "1000_0001_0010_0000");
            assert_eq!(bench.row("over"), "0001_1110_0000_0111");
        },
    );
}

#[test]
fn without_set_up_and_hold_a_turn_still_takes_the_clock_in_front_of_the_step() {
    on_every_engine(
        |m| output(m, timing([1, 1, 0, 0])),
        |bench| {
            bench.play(&[("want", "1111_1111_1"), ("negative", "0011_1000_0")]);
            assert_eq!(bench.row("stepx"), "0100_1001_0");
            assert_eq!(bench.row("dirx"), "0001_1100_0");
        },
    );
}

/// Times of the last step and the last turn, in clocks.
#[derive(Clone, Copy, Default)]
struct Last {
    sent: Option<i128>,
    turned: Option<i128>,
    negative: bool,
}

#[test]
fn wishes_of_any_pattern_keep_to_every_time() {
    for times in [[1, 1, 0, 0], [1, 1, 1, 1], [2, 3, 5, 0], [3, 1, 0, 6], [4, 4, 2, 3]] {
        let [length, space, setup, hold] = times.map(i128::from);
        on_every_engine(
            |m| output(m, timing(times)),
            |bench| {
                let mut last = Last::default();
                let mut pattern = 0x1234_5678_u32;
                bench.clock(&[("want", 0), ("negative", 0)]);
                for t in 1..400 {
                    // A step is wanted often, another direction now and then.
                    pattern = pattern.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let (want, negative) = (pattern >> 30 != 0, (pattern >> 20) % 23 < 11);
                    let settled = (t / 17) % 2 == 0;
                    let negative = if settled { last.negative } else { negative };
                    bench.clock(&[("want", i128::from(want)), ("negative", i128::from(negative))]);
                    let over = last.sent.is_none_or(|sent| t >= sent + length + space);
                    let ready = last.negative == negative
                        && over
                        && last.turned.is_none_or(|turned| t >= turned + setup.max(1));
                    let what = format!("{times:?}, clock {t}");
                    assert_eq!(bench.value("ready"), i128::from(ready), "{what}");
                    let out = last.sent.is_some_and(|sent| t - 1 < sent + length);
                    assert_eq!(bench.value("stepx"), i128::from(out), "{what}");
                    assert_eq!(bench.value("dirx"), i128::from(last.negative), "{what}");
                    assert_eq!(bench.value("over"), i128::from(over && !(ready && want)), "{what}");
                    if last.negative != negative && last.sent.is_none_or(|sent| t >= sent + length + hold) {
                        (last.negative, last.turned) = (negative, Some(t));
                    }
                    if ready && want {
                        last.sent = Some(t);
                    }
                }
            },
        );
    }
}

#[test]
fn timers_are_as_wide_as_their_times_need() {
    for times in [[1, 1, 0, 0], [2, 2, 4, 4], [5, 11, 16, 4], [5, 12, 18, 4]] {
        on_every_engine(
            |m| output(m, timing(times)),
            |bench| {
                let bits = |name: &str| {
                    let netlist = bench.design().netlist();
                    netlist.width(netlist.find(name).unwrap().net).get()
                };
                let holds = |name: &str, clocks: u64| {
                    let clocks = i128::from(clocks);
                    numbers(bits(name), false).contains(&clocks) && (bits(name) == 1 || clocks >= 1 << (bits(name) - 1))
                };
                let [length, space, setup, hold] = times;
                assert!(holds("pulse_timer", length + space - 1), "{times:?}");
                assert!(holds("hold_timer", length + hold - 1), "{times:?}");
                assert!(holds("setup_timer", setup.saturating_sub(1)), "{times:?}");
            },
        );
    }
}
