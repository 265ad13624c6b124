//! Step generator with its outputs, and the counters of firmware: worked tables and claims.

use super::super::{Form, StepOutput, Timing, bresenham, stepgen, stepgen_clocks};
use super::{assert_pulses_make_the_path, end_of, pulse_steps};

#[test]
fn a_step_generator_makes_every_step_of_its_line() {
    for d in -8..=8_i64 {
        for preset in [0, 5, 15] {
            let table = stepgen(9, 4, 3, &[2, 0], &[2 + d, 3], &[preset, 0]);
            assert!(table.finished && !table.overflow);
            assert_eq!(end_of(&table), [2 + d, 3]);
            assert_pulses_make_the_path(&table);
            for (t, acc) in (0..).zip(table.column("accx")) {
                assert_eq!(acc, preset + 2 * d * t);
            }
            // A rate of the other sign steps at its own carries: down to -1 already steps.
            if d == -1 && preset == 0 {
                assert_eq!(pulse_steps(&table, "dx"), [1]);
            }
        }
    }
    // d = 3 in 4 iterations, rate 12 of 16: acc 12, 24, 36, 48.
    let table = stepgen(8, 4, 2, &[0, 0], &[3, -2], &[0, 8]);
    assert_eq!(table.column("accx"), [0, 12, 24, 36, 48]);
    assert_eq!(pulse_steps(&table, "dx"), [2, 3, 4]);
    assert_eq!(table.column("accy"), [8, 0, -8, -16, -24]);
    assert_eq!(pulse_steps(&table, "dy"), [2, 4]);
    assert_eq!(table.column("e"), [4, 3, 2, 1, 0]);
}

#[test]
fn an_accumulator_that_outgrows_its_register_is_reported() {
    let table = stepgen(6, 4, 2, &[0, 0], &[3, 0], &[0, 0]);
    assert!(table.overflow && !table.finished);
    assert_eq!(table.column("accx"), [0, 12, 24]);
    let table = stepgen(6, 4, 2, &[0, 0], &[-2, 0], &[0, 0]);
    assert!(table.finished && !table.overflow);
    assert_eq!(table.column("accx").last(), Some(&-32));
}

#[test]
fn outputs_keep_to_every_time_through_steps_and_turns() {
    // Both outputs after every clock, with a step wanted always, in directions that change at odd clocks.
    let wants = |t: i64| (t / 13 + t / 37) % 2 == 1;
    let run = |timing: Timing| {
        let mut output = StepOutput::new(timing);
        let mut rows = vec![(false, false)];
        for t in 1..6000 {
            let send = output.may_send(t, wants(t));
            output.clock(t, wants(t), send);
            rows.push((output.step(t), output.negative));
        }
        rows
    };
    for length in [1, 3] {
        for space in [1, 2, 5] {
            for setup in [0, 1, 4, 20] {
                for hold in [0, 1, 6] {
                    let rows = run(Timing { length, space, setup, hold });
                    assert_times(&rows, Timing { length, space, setup, hold });
                }
            }
        }
    }
}

/// Reads off the rows that steps and turns keep their distances, and that some have the least one.
fn assert_times(rows: &[(bool, bool)], timing: Timing) {
    let edges = |of: fn(&(bool, bool), &(bool, bool)) -> bool| -> Vec<i64> {
        let pairs = (1..).zip(rows.windows(2));
        pairs.filter(|(_, pair)| of(&pair[0], &pair[1])).map(|(t, _)| t).collect()
    };
    let rising = edges(|a, b| !a.0 && b.0);
    let falling = edges(|a, b| a.0 && !b.0);
    let turns = edges(|a, b| a.1 != b.1);
    let lengths = rising.iter().zip(&falling).map(|(rise, fall)| fall - rise);
    assert!(lengths.into_iter().all(|length| length == timing.length), "{timing:?}");
    // The least distance from one of `first` to the next of `second`.
    let least = |first: &[i64], second: &[i64]| {
        let gaps = first.iter().filter_map(|a| second.iter().map(|b| b - a).filter(|gap| *gap >= 0).min());
        gaps.min().expect("there are both")
    };
    assert_eq!(least(&falling, &rising), timing.space, "{timing:?}");
    assert_eq!(least(&turns, &rising), timing.setup.max(1), "{timing:?}");
    assert!(least(&falling, &turns) >= timing.hold, "{timing:?}");
    assert!(rising.len() > 10 && turns.len() > 5, "{timing:?}");
    // No turn while a step is out.
    assert!(rows.windows(2).all(|pair| pair[0].1 == pair[1].1 || !pair[1].0), "{timing:?}");
}

#[test]
fn a_turn_waits_for_the_hold_time_to_the_clock() {
    let timing = Timing { length: 2, space: 2, setup: 3, hold: 4 };
    let mut output = StepOutput::new(timing);
    output.clock(1, false, true);
    let mut turned = Vec::new();
    let mut may = Vec::new();
    for t in 2..14 {
        if output.may_send(t, true) {
            may.push(t);
        }
        output.clock(t, true, false);
        turned.push(output.negative);
    }
    // Sent at 1, over at 3, held to 7; then three clocks of set-up.
    assert_eq!(turned.iter().position(|turned| *turned), Some(7 - 2));
    assert_eq!(may.first(), Some(&10));
}

#[test]
fn the_clocks_of_a_line_are_its_accumulations_and_what_they_wait() {
    let timing = Timing { length: 2, space: 2, setup: 4, hold: 4 };
    // d = 3 in 8 accumulations, no step sooner than 2 after another: two clocks of waiting for the one after.
    let clocks = stepgen_clocks(3, 3, &[0, 0], &[3, 0], &[0, 0], timing);
    let steps = stepgen(6, 3, 3, &[0, 0], &[3, 0], &[0, 0]);
    assert_eq!(pulse_steps(&steps, "dx"), [3, 6, 8]);
    // Steps at 3; 3 after it, waiting 1; 2 after that, waiting 2.
    let x = clocks.column("x");
    assert_eq!(x, [0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3]);
    assert_eq!(clocks.column("stepx"), [0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0]);
    assert_eq!(clocks.column("e"), [8, 7, 6, 5, 4, 3, 3, 2, 1, 1, 1, 0, 0, 0, 0, 0]);
    // A negative axis turns first: its first step, in the first accumulation, comes 1 + 4 clocks after the load.
    let clocks = stepgen_clocks(3, 3, &[0, 0], &[-1, 0], &[0, 0], timing);
    assert_eq!(clocks.column("dirx")[..3], [0, 1, 1]);
    assert_eq!(clocks.column("x")[..7], [0, 0, 0, 0, 0, -1, -1]);
    // Whatever the times, every row of the step table is passed through.
    for (dx, dy) in [(7, -4), (-3, 8), (1, 1), (-5, -5), (0, 6)] {
        for (length, setup) in [(1, 0), (5, 9)] {
            let timing = Timing { length, space: 3, setup, hold: 2 };
            let table = stepgen(12, 4, 3, &[0, 0], &[dx, dy], &[7, 0]);
            let clocks = stepgen_clocks(4, 3, &[0, 0], &[dx, dy], &[7, 0], timing);
            let states = |table: &super::Table| {
                let columns = ["e", "accx", "accy", "x", "y"].map(|name| table.column(name));
                let mut rows: Vec<Vec<i64>> = Vec::new();
                for t in 0..columns[0].len() {
                    rows.push(columns.iter().map(|column| column[t]).collect());
                }
                rows.dedup();
                rows
            };
            assert_eq!(states(&clocks), states(&table));
        }
    }
}

#[test]
fn a_rate_rounded_up_makes_every_step_in_any_number_of_accumulations_up_to_2_p() {
    let unit = 1_i64 << 6;
    for accumulations in 1..=unit {
        for d in -accumulations..=accumulations {
            let rate = -(-d * unit).div_euclid(accumulations);
            assert_eq!((accumulations * rate).div_euclid(unit), d, "{d} in {accumulations}");
        }
    }
    // One more, and what is rounded may come to a step.
    assert_eq!((65 * -(-unit).div_euclid(65)).div_euclid(unit), 1);
    assert_eq!((129 * -(-unit).div_euclid(129)).div_euclid(unit), 2);
}

/// The test with which a form makes every line.
fn right_test(form: Form) -> bool {
    form == Form::Signed
}

#[test]
fn counters_of_firmware_make_every_line() {
    let table = bresenham(&[0, 0], &[5, 3], Form::Magnitude, false);
    assert_eq!(table.column("cntx"), [2; 6]);
    assert_eq!(table.column("cnty"), [2, 0, 3, 1, 4, 2]);
    assert_eq!(pulse_steps(&table, "dy"), [1, 3, 5]);
    let strict = bresenham(&[0, 0], &[5, 3], Form::Magnitude, true);
    assert_eq!(strict.column("cnty"), [2, 5, 3, 1, 4, 2]);
    assert_eq!(pulse_steps(&strict, "dy"), [2, 3, 5]);
    let signed = bresenham(&[0, 0], &[5, 3], Form::Signed, true);
    assert_eq!(signed.column("cnty"), [-2, -4, -1, -3, 0, -2]);
    assert_eq!(pulse_steps(&signed, "dy"), [1, 3, 5]);
    for dx in -12..=12_i64 {
        for dy in -12..=12_i64 {
            let length = dx.abs().max(dy.abs());
            for form in [Form::Magnitude, Form::Signed] {
                for strictly_greater in [false, true] {
                    check_counters([dx, dy], length, form, strictly_greater);
                }
            }
        }
    }
    let table = bresenham(&[0; 6], &[3, -7, 0, 1, 7, -2], Form::Magnitude, false);
    assert_eq!(table.rows.last().expect("row 0")[13..], [3, -7, 0, 1, 7, -2]);
}

fn check_counters([dx, dy]: [i64; 2], length: i64, form: Form, strictly_greater: bool) {
    let table = bresenham(&[1, 9], &[1 + dx, 9 + dy], form, strictly_greater);
    assert_pulses_make_the_path(&table);
    assert_eq!(table.column("e"), (0..=length).rev().collect::<Vec<_>>());
    let right = strictly_greater == right_test(form);
    if length == 1 && !right {
        let end = match form {
            // A block of one step does not move.
            Form::Magnitude => [1, 9],
            // An axis without travel steps.
            Form::Signed => [1 + if dx == 0 { 1 } else { dx }, 9 + if dy == 0 { 1 } else { dy }],
        };
        assert_eq!(end_of(&table), end);
        return;
    }
    assert_eq!(end_of(&table), [1 + dx, 9 + dy]);
    for (t, [x, y]) in (0..).zip(table.path()) {
        // At most half a BLU along each axis; the other test adds 1/(2N).
        for (moved, d) in [(x - 1, dx), (y - 9, dy)] {
            assert!(2 * (moved * length - t * d).abs() <= length + i64::from(!right));
        }
    }
    // The counters stay among N numbers, and a sum never comes to more than N above them.
    let least = match (form, strictly_greater) {
        (Form::Magnitude, false) => 0,
        (Form::Magnitude, true) => 1,
        (Form::Signed, true) => 1 - length,
        (Form::Signed, false) => -length,
    };
    if length > 0 {
        let all = [table.column("cntx"), table.column("cnty")].concat();
        assert!(all.iter().all(|count| (least..least + length).contains(count)));
    }
}
