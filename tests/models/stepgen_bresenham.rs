//! Modern step generators: the phase accumulators of motion cards, and the counters of firmware.

use proptest::prelude::*;
use stepwave::testbench::{Ending, Observer, ObserverError};
use stepwave_engine::{EngineKind, Rows};
use stepwave_models::options::{COMPARE, FORM, ON_OVERFLOW, PICK_OFF, PRESET, TIMING, WIDTH};
use stepwave_models::{Compare, Form, ModelError, Options, Preset, StepTiming, find};
use stepwave_netlist::{OnOverflow, Width};

use super::{Ran, assert_equal, bench, check, every_line, line, run, widths};
use crate::reference::{self, Table, Timing, bresenham, stepgen, stepgen_clocks};

const TESTS: [(Compare, bool); 2] = [(Compare::AtLeast, false), (Compare::Greater, true)];
const FORMS: [(Form, reference::Form); 2] =
    [(Form::Magnitude, reference::Form::Magnitude), (Form::Signed, reference::Form::Signed)];

fn width(bits: u32) -> Width {
    Width::new(u64::from(bits)).unwrap()
}

/// Every form and test; but the wrong test of a form misses blocks of one step, as the recurrence does.
fn check_counters(from: &[i64], to: &[i64], engine: EngineKind) {
    for (form, form_reference) in FORMS {
        for (compare, strictly_greater) in TESTS {
            let choices = Options::default().with(&FORM, form).with(&COMPARE, compare);
            let table = bresenham(from, to, form_reference, strictly_greater);
            let travel = |axis: usize| (to[axis] - from[axis]).abs();
            let right = strictly_greater == (form == Form::Signed);
            let idle = (0..from.len()).any(|axis| travel(axis) == 0);
            let misses = (0..from.len()).all(|axis| travel(axis) <= 1) && !right && (form == Form::Magnitude || idle);
            if misses {
                let ran = run("bresenham", &line(from, to), &choices, engine);
                assert_equal(|| format!("{from:?} {to:?} {choices:?}"), &ran, &table);
                assert_eq!(ran.outcome.ending, Ending::Done);
                assert_ne!(ran.outcome.reached, to);
            } else {
                check("bresenham", &line(from, to), &choices, engine, &table);
            }
        }
    }
}

#[test]
fn every_line_of_up_to_four_bits_by_counters_of_both_forms_and_tests() {
    every_line(4, |to| check_counters(&[0, 0], &to, EngineKind::Word));
}

#[test]
#[ignore = "exhaustive"]
fn every_line_of_five_bits_by_counters_and_by_accumulators() {
    every_line(5, |to| check_counters(&[0, 0], &to, EngineKind::Word));
    every_line(5, |to| check_generator(5, &[0, 0], &to, EngineKind::Word));
}

#[test]
fn counters_of_up_to_six_axes_on_every_engine_from_a_translated_start() {
    for engine in EngineKind::ALL {
        for to in [[5, 3], [-3, 7], [-6, -6], [4, 0], [0, -5], [1, 0], [-1, 1]] {
            check_counters(&[3, -2], &[3 + to[0], to[1] - 2], engine);
        }
        check_counters(&[1, -1, 5], &[4, -8, 5], engine);
        check_counters(&[0; 6], &[3, -7, 0, 1, 7, -2], engine);
    }
}

#[test]
fn a_form_has_its_right_test_by_default() {
    for (form, compare) in [(None, Compare::AtLeast), (Some(Form::Signed), Compare::Greater)] {
        let choices = Options::default().with(&FORM, form);
        let hardware = find("bresenham").unwrap().plan(&line(&[0, 0], &[1, 0]), &choices).unwrap();
        assert_eq!(hardware.get(&COMPARE), compare);
        let ran = run("bresenham", &line(&[0, 0], &[1, 0]), &choices, EngineKind::Word);
        assert_eq!(ran.outcome.reached, [1, 0]);
    }
}

/// Greatest and least value that a column of the table would have held one clock earlier: after the addition.
fn sums(table: &Table, axis: &str, travel: i64) -> (i64, i64) {
    let counts = table.column(&format!("cnt{axis}"));
    let after = counts.iter().copied().chain(counts[..counts.len() - 1].iter().map(|count| count + travel));
    after.fold((i64::MIN, i64::MAX), |(most, least), value| (most.max(value), least.min(value)))
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[test]
fn a_counter_traps_exactly_where_one_bit_less_cannot_hold_a_sum() {
    every_line(5, |to| {
        for (form, form_reference) in FORMS {
            let choices = Options::default().with(&FORM, form);
            let table = bresenham(&[0, 0], &to, form_reference, form == Form::Signed);
            let usual = bench("bresenham", &line(&[0, 0], &to), &choices).hardware().widths["cntx"].get();
            let ranges = [("x", to[0].abs()), ("y", to[1].abs())].map(|(axis, travel)| sums(&table, axis, travel));
            let limit = if form == Form::Signed { 1 << (usual - 1) } else { 1 << usual };
            assert!(ranges.iter().all(|(most, _)| *most < limit), "n + 1 bits hold every sum");
            let narrow = widths(&[("cnt", usual - 1)]).with(&FORM, form);
            let (least, most) = match form {
                Form::Signed => (-limit / 2, limit / 2 - 1),
                Form::Magnitude | Form::Bare => (0, limit / 2 - 1),
            };
            let ran = run("bresenham", &line(&[0, 0], &to), &narrow, EngineKind::Word);
            let holds = ranges.iter().all(|range| range.0 <= most && range.1 >= least);
            let ending = if holds { Ending::Done } else { Ending::Trapped };
            assert_eq!(ran.outcome.ending, ending, "{to:?} {form:?} {ranges:?} {usual}");
            // What the documentation says of n bits.
            let [short, long] = [to[0].abs().min(to[1].abs()), to[0].abs().max(to[1].abs())];
            if form == Form::Magnitude && (1..long).contains(&short) && gcd(short, long) == 1 {
                assert_eq!(holds, long + long / 2 < 1 << (usual - 1) && long - 1 + short < 1 << (usual - 1), "{to:?}");
            }
        }
    });
}

#[test]
fn a_counter_that_wraps_around_loses_steps_on_long_moves_only() {
    // Counters as wide as the step counts, five bits: (31, 30) comes to 30 + 30; (16, 15) to 15 + 15, which fits.
    for (to, reached) in [([31, 30], false), ([16, 15], true)] {
        let choices = widths(&[("cnt", 5), ("steps", 5), ("events", 5)]).with(&ON_OVERFLOW, OnOverflow::Wrap);
        let ran = run("bresenham", &line(&[0, 0], &to), &choices, EngineKind::Word);
        assert_eq!(ran.outcome.ending, Ending::Done);
        assert_eq!(ran.outcome.reached == to, reached, "{to:?}: {:?}", ran.outcome.reached);
    }
}

/// What each form of a step generator is built with: k - n, p - k, the preset, the times of the outputs.
const GENERATORS: [(u32, u32, Preset, StepTiming); 5] = [
    (2, 0, Preset::Zero, StepTiming { length: 2, space: 2, setup: 4, hold: 4 }),
    (0, 0, Preset::Half, StepTiming { length: 1, space: 1, setup: 0, hold: 0 }),
    (1, 3, Preset::Full, StepTiming { length: 3, space: 1, setup: 0, hold: 7 }),
    (0, 1, Preset::Value(1), StepTiming { length: 1, space: 6, setup: 9, hold: 0 }),
    (1, 27, Preset::Half, StepTiming { length: 4, space: 3, setup: 1, hold: 1 }),
];

/// A step generator for lines of n bits, and the same for the recurrences: pick-off, k, preset, times.
fn generator(n: u32, form: (u32, u32, Preset, StepTiming)) -> (Options, (u32, u32, i64, Timing)) {
    let (more, fraction, preset, timing) = form;
    let (k, pick_off) = (n + more, n + more + fraction);
    let value = match preset {
        Preset::Zero => 0,
        Preset::Half => 1 << (pick_off - 1),
        Preset::Full => (1 << pick_off) - 1,
        Preset::Value(value) => i64::try_from(value).unwrap(),
    };
    let choices = widths(&[("e", k + 1)])
        .with_all(&WIDTH, width(n))
        .with_all(&PRESET, preset)
        .with(&PICK_OFF, Some(u64::from(pick_off)))
        .with(&TIMING, timing);
    let [length, space, setup, hold] =
        [timing.length, timing.space, timing.setup, timing.hold].map(|clocks| i64::try_from(clocks).unwrap());
    (choices, (pick_off, k, value, Timing { length, space, setup, hold }))
}

/// The nets of these names in every sample from the one after the load on.
struct Clocks {
    columns: Vec<usize>,
    rows: Vec<Vec<u64>>,
}

impl Observer for Clocks {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for row in (0..rows.len()).filter(|&row| rows.first_clock() + row as u64 >= 1) {
            self.rows.push(self.columns.iter().map(|&column| rows.value(column, row)).collect());
        }
        Ok(())
    }
}

/// Compares the step table, and the outputs of every axis clock by clock.
fn check_generator(n: u32, from: &[i64], to: &[i64], engine: EngineKind) {
    for form in GENERATORS {
        let (choices, (pick_off, k, preset, timing)) = generator(n, form);
        let presets = vec![preset; from.len()];
        let curve = line(from, to);
        let acc_bits = n + 1 + pick_off;
        check("stepgen", &curve, &choices, engine, &stepgen(acc_bits, pick_off, k, from, to, &presets));

        let clocks = stepgen_clocks(pick_off, k, from, to, &presets, timing);
        let names: Vec<&String> =
            clocks.columns.iter().filter(|name| name.starts_with("step") || name.starts_with("dir")).collect();
        let bench = bench("stepgen", &curve, &choices);
        let net = |name: &str| bench.design().netlist().find(name).unwrap_or_else(|| panic!("{name}")).net;
        let columns = names.iter().map(|name| bench.columns().index(net(name))).collect();
        let mut seen = Clocks { columns, rows: Vec::new() };
        let outcome = bench.run(engine, &mut [&mut seen]).unwrap();
        let what = format!("{from:?} to {to:?} {choices:?} on {}", engine.name());
        for (index, name) in names.into_iter().enumerate() {
            let shown: Vec<i64> = seen.rows.iter().map(|row| i64::try_from(row[index]).unwrap()).collect();
            assert_eq!(shown, clocks.column(name), "{what}: {name}");
        }
        assert_eq!(usize::try_from(outcome.clocks).unwrap(), clocks.rows.len(), "{what}");
    }
}

#[test]
fn every_line_of_up_to_four_bits_by_accumulators_with_every_clock_of_their_outputs() {
    every_line(4, |to| check_generator(5, &[0, 0], &to, EngineKind::Word));
}

#[test]
fn accumulators_of_up_to_six_axes_on_every_engine_from_a_translated_start() {
    for engine in EngineKind::ALL {
        check_generator(3, &[3, -2], &[0, 2], engine);
        check_generator(3, &[1, -1, 5], &[4, -8, 5], engine);
        check_generator(4, &[0; 6], &[1, -2, 3, -14, 5, 0], engine);
    }
}

#[test]
fn the_card_of_today_makes_lines_of_less_than_2_15_steps() {
    let card = widths(&[("acc", 48), ("rate", 32)]).with(&PICK_OFF, Some(32));
    let ran = run("stepgen", &line(&[0, 0], &[1000, -999]), &card, EngineKind::Compiled);
    assert_eq!((ran.outcome.ending, ran.outcome.reached), (Ending::Done, vec![1000, -999]));
    // Of 2^18 accumulations 50000 make a step; the one that would end step 32768 does not fit.
    let ran = run("stepgen", &line(&[0, 0], &[50_000, 3]), &card, EngineKind::Compiled);
    assert_eq!(ran.outcome.ending, Ending::Trapped);
    assert_eq!(ran.outcome.reached[0], (1 << 15) - 1);
}

#[test]
fn without_choices_a_generator_is_the_least_that_holds_the_line_and_never_waits_for_a_step() {
    let bench = bench("stepgen", &line(&[0, 0], &[6, 4]), &Options::default());
    let bits = |name: &str| bench.hardware().bits_of(name);
    // n = 3, and 2 more for four clocks a step.
    assert_eq!((bits("e"), bits("ratex"), bits("accx"), bench.hardware().get(&PICK_OFF)), (6, 4, 9, Some(5)));
    let ran = run("stepgen", &line(&[0, 0], &[6, 4]), &Options::default(), EngineKind::Word);
    // The load, 2^5 accumulations, and the last step with its space: 4 clocks, of which the first is that of the step.
    assert_eq!(ran.outcome.clocks, 1 + 32 + 4);
}

/// A line in a given number of bits of the accumulator; n = 3, k = p = 4, from 0.
fn with_accumulators_of(bits: u32, to: &[i64; 2], on_overflow: OnOverflow) -> Ran {
    let choices =
        widths(&[("e", 5), ("accx", bits), ("accy", bits)]).with_all(&WIDTH, width(3)).with(&ON_OVERFLOW, on_overflow);
    run("stepgen", &line(&[0, 0], to), &choices, EngineKind::Word)
}

#[test]
fn an_accumulator_too_narrow_traps_where_the_recurrence_leaves_it() {
    for x in -7..=7_i64 {
        for y in (-7..=7).filter(|y| [x, *y] != [0, 0]) {
            for bits in 5..=8 {
                let table = stepgen(bits, 4, 4, &[0, 0], &[x, y], &[0, 0]);
                let ran = with_accumulators_of(bits, &[x, y], OnOverflow::Trap);
                let what = format!("({x}, {y}) in {bits} bits");
                assert_equal(|| what.clone(), &ran, &table);
                let ending = if table.overflow { Ending::Trapped } else { Ending::Done };
                assert_eq!(ran.outcome.ending, ending, "{what}");
            }
        }
    }
}

#[test]
fn an_accumulator_that_wraps_around_makes_every_step_as_long_as_it_has_its_pick_off_bit() {
    for to in [[7, 5], [-7, 3], [6, -7], [-5, -5], [1, 0]] {
        for bits in 4..=8 {
            let ran = with_accumulators_of(bits, &to, OnOverflow::Wrap);
            assert_eq!(ran.outcome.ending, Ending::Done);
            // Four bits have no bit 4: their sign changes twice as often.
            let factor = if bits >= 5 { 1 } else { 2 };
            assert_eq!(ran.outcome.reached, to.map(|travel| factor * travel), "{to:?} in {bits} bits");
        }
    }
}

#[test]
fn an_accumulator_that_saturates_loses_the_steps_above_its_limit() {
    // Five bits end at 15, below the first change of bit 4 upwards; downwards bit 4 is the sign.
    let ran = with_accumulators_of(5, &[7, -7], OnOverflow::Saturate);
    assert_eq!((ran.outcome.ending, ran.outcome.reached), (Ending::Done, vec![0, -1]));
    let ran = with_accumulators_of(6, &[7, -7], OnOverflow::Saturate);
    assert_eq!(ran.outcome.reached, [1, -2]);
}

#[test]
fn rates_that_would_be_a_fraction_or_two_steps_are_refused_with_a_remedy() {
    let refusal = |choices: &Options| match find("stepgen").unwrap().plan(&line(&[0, 0], &[6, 4]), choices) {
        Err(ModelError::Widths(message)) => message,
        other => panic!("{other:?}"),
    };
    let message = refusal(&Options::default().with(&PICK_OFF, Some(2)));
    assert!(message.ends_with("give --pick-off 3 or more"), "{message}");
    let message = refusal(&widths(&[("e", 6)]).with(&PICK_OFF, Some(4)));
    assert!(message.ends_with("give --pick-off 5 or more, or --width e=5"), "{message}");
    let message = refusal(&widths(&[("e", 3)]));
    assert!(message.ends_with("give --width e=4 or more"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn counters_of_any_size(
        from in prop::collection::vec(-100_000i64..100_000, 3),
        d in prop::collection::vec(-3000i64..3000, 3),
    ) {
        prop_assume!(d.iter().any(|&d| d != 0));
        let to: Vec<i64> = from.iter().zip(&d).map(|(from, d)| from + d).collect();
        check_counters(&from, &to, EngineKind::Word);
    }

    #[test]
    fn accumulators_of_any_size(
        from in prop::collection::vec(-100_000i64..100_000, 3),
        d in prop::collection::vec(-1000i64..1000, 3),
    ) {
        prop_assume!(d.iter().any(|&d| d != 0));
        let to: Vec<i64> = from.iter().zip(&d).map(|(from, d)| from + d).collect();
        check_generator(10, &from, &to, EngineKind::Word);
    }
}
