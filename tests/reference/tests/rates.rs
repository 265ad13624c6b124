//! Rate multiplier, decimal and helical integration: worked tables and claims.

use super::super::{
    AXES, EndPoint, Table, dda_arc, dda_helix, dda_line, dda_line_decimal, dpm_line, dpm_line_cascade, dpm_line_decade,
    dpm_line_override, helix_words,
};
use super::{assert_pulses_make_the_path, end_of, lattice_arcs, pulse_steps};

#[test]
fn the_worked_line_of_the_rate_multiplier_is_reproduced_to_the_digit() {
    let table = dpm_line(3, &[0, 0], &[5, 3]);
    assert_eq!(pulse_steps(&table, "dx"), [1, 3, 4, 5, 7]);
    assert_eq!(pulse_steps(&table, "dy"), [2, 4, 6]);
    assert_eq!(table.column("q"), [0, 1, 2, 3, 4, 5, 6, 7, 0]);
}

#[test]
fn every_axis_gets_its_coefficient_in_pulses_and_no_clock_two() {
    for n in 1..=5 {
        let modulus = 1_i64 << n;
        for dx in 1 - modulus..modulus {
            for dy in 0..modulus {
                let table = dpm_line(n, &[3, -2], &[3 + dx, dy - 2]);
                assert_eq!(end_of(&table), [3 + dx, dy - 2]);
                assert_pulses_make_the_path(&table);
                assert_eq!(table.steps(), 1 << n);
                // The carry gives no pulse.
                assert_eq!(table.rows[1 << n][1..3], [0, 0]);
            }
        }
    }
    let (from, to) = ([0; 6], [9, -14, 0, 1, 15, -7]);
    let table = dpm_line(4, &from, &to);
    for (axis, to) in AXES.into_iter().zip(to) {
        assert_eq!(table.column(axis).last(), Some(&to));
    }
}

#[test]
fn each_clock_but_the_last_fires_one_stage() {
    // Coefficients of one bit share the clocks among them.
    let n = 6;
    let mut fired = vec![0; 1 << n];
    for bit in 0..n {
        let table = dpm_line(n, &[0, 0], &[1 << bit, 0]);
        for clock in pulse_steps(&table, "dx") {
            fired[clock - 1] += 1;
        }
    }
    assert_eq!(fired.pop(), Some(0));
    assert!(fired.into_iter().all(|count| count == 1));
}

/// The greatest |pulses - c·t/T| after a clock t = 0 ..= T, in units of 1/T, over all coefficients c below T, of which
/// `table` takes two at once.
fn worst_deviation(clocks: i64, table: impl Fn(&[i64]) -> Table) -> i64 {
    let mut worst = 0;
    for c in (0..clocks).step_by(2) {
        let table = table(&[c, c + 1]);
        for (axis, c) in [("x", c), ("y", c + 1)] {
            for (t, pulses) in (0..).zip(table.column(axis)) {
                worst = worst.max((pulses * clocks - c * t).abs());
            }
        }
    }
    worst
}

#[test]
fn the_worst_deviation_is_that_of_the_closed_form() {
    for n in 1..=10 {
        let modulus = 1_i64 << n;
        let sign = if n % 2 == 0 { 1 } else { -1 };
        // 18·2^n·((3n + 7)/18 + sign/(9·2^n)).
        let closed = (3 * i64::from(n) + 7) * modulus + 2 * sign;
        assert_eq!(18 * worst_deviation(modulus, |to| dpm_line(n, &[0, 0], to)), closed, "n = {n}");
    }
}

#[test]
fn cascaded_units_give_the_pulses_of_one_unit_of_all_their_bits() {
    for (units, bits) in [(1, 3), (2, 1), (2, 2), (3, 1), (2, 3), (3, 2), (4, 2), (6, 1)] {
        let limit = 1_i64 << (units * bits);
        for c in 0..limit {
            let to = [c, 1 - limit + c / 3];
            let (cascade, one) = (dpm_line_cascade(units, bits, &[0, 0], &to), dpm_line(units * bits, &[0, 0], &to));
            assert_eq!(cascade.path(), one.path());
            assert_pulses_make_the_path(&cascade);
            // The units hold the count of the one, the first its lowest bits.
            for (row, q) in cascade.rows.iter().zip(one.column("q")) {
                let counters = row[..usize::try_from(units).expect("small")].iter().rev();
                assert_eq!(counters.fold(0, |whole, unit| (whole << bits) + unit), q);
            }
        }
    }
}

#[test]
fn a_decade_has_the_slots_of_its_bits() {
    let slots = [(8, vec![0, 1, 2, 3, 5, 6, 7, 8]), (4, vec![1, 3, 5, 7]), (2, vec![2, 6]), (1, vec![4])];
    for (digit, slots) in slots {
        let table = dpm_line_decade(1, &[0, 0], &[digit, 0]);
        // The slot is the count before the clock, so one less than the row.
        let clocks: Vec<usize> = slots.into_iter().map(|slot: usize| slot + 1).collect();
        assert_eq!(pulse_steps(&table, "dx"), clocks);
        assert_eq!(table.column("q"), [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0]);
    }
}

#[test]
fn decades_give_every_word_exactly() {
    for digits in 1..=2_u32 {
        let limit = 10_i64.pow(digits);
        for c in 0..limit {
            let table = dpm_line_decade(digits, &[1, 1], &[1 + c, 1 - c]);
            assert_eq!(end_of(&table), [1 + c, 1 - c]);
            assert_pulses_make_the_path(&table);
            assert_eq!(table.steps(), 10_usize.pow(digits));
        }
    }
    for c in (0..1000).step_by(37) {
        assert_eq!(end_of(&dpm_line_decade(3, &[0, 0], &[c, 999 - c])), [c, 999 - c]);
    }
    // 42: the tens are in the fast decade, each ten clocks 4; the units fill slots 9 of it.
    let table = dpm_line_decade(2, &[0, 0], &[42, 0]);
    assert_eq!(pulse_steps(&table, "dx")[..10], [2, 4, 6, 8, 12, 14, 16, 18, 22, 24]);
    let units: Vec<usize> = pulse_steps(&table, "dx").into_iter().filter(|clock| clock % 10 == 0).collect();
    assert_eq!(units, [30, 70]);
}

#[test]
fn the_worst_deviation_of_decades_is_that_of_the_closed_form() {
    for digits in 1..=2 {
        let clocks = 10_i64.pow(digits);
        // 81·10^k·(7k/9 + 56/81·(1 - 10^(-k))).
        let closed = 63 * i64::from(digits) * clocks + 56 * (clocks - 1);
        assert_eq!(81 * worst_deviation(clocks, |to| dpm_line_decade(digits, &[0, 0], to)), closed, "{digits}");
    }
}

#[test]
fn the_override_makes_the_steps_of_the_line_at_its_own_pulses() {
    let line = dpm_line(4, &[0, 0], &[11, -6]);
    for percent in 1..=99 {
        let table = dpm_line_override(4, &[0, 0], &[11, -6], percent);
        assert_eq!(table.path(), line.path());
        assert_eq!(table.column("q"), line.column("q"));
        let clocks = table.column("clock");
        let pulses = pulse_steps(&dpm_line_decade(2, &[0, 0], &[percent, 0]), "dx");
        let expected = (0..).flat_map(|round| pulses.iter().map(move |&clock| 100 * round + clock));
        let expected: Vec<i64> = expected.take(16).map(|clock| i64::try_from(clock).expect("small")).collect();
        assert_eq!(clocks[1..], expected);
        let o: Vec<i64> = clocks.iter().map(|clock| clock % 100).collect();
        assert_eq!(table.column("o"), o);
    }
}

#[test]
fn the_worked_decimal_line_is_reproduced_to_the_digit() {
    let table = dda_line_decimal(1, &[0, 0], &[8, 6], &[0, 0], EndPoint::Iterations);
    assert_eq!(table.column("jrx")[1..], [8, 6, 4, 2, 0, 8, 6, 4, 2, 0]);
    assert_eq!(pulse_steps(&table, "dx"), [2, 3, 4, 5, 7, 8, 9, 10]);
    assert_eq!(pulse_steps(&table, "dy"), [2, 4, 5, 7, 9, 10]);
    assert_eq!(table.column("e"), [10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0]);
}

#[test]
fn every_decimal_line_follows_the_closed_form() {
    for (digits, words) in [(1, (-9..=9).collect::<Vec<i64>>()), (2, vec![-99, -50, -8, 0, 1, 37, 99])] {
        let modulus = 10_i64.pow(digits);
        for &dx in &words {
            for &dy in &words {
                for preset in [[0, modulus / 2], [modulus - 1, 3]] {
                    let table = dda_line_decimal(digits, &[5, 0], &[5 + dx, dy], &preset, EndPoint::Iterations);
                    assert_eq!(end_of(&table), [5 + dx, dy]);
                    for (t, [x, y]) in (0..).zip(table.path()) {
                        let place = |d: i64, p| d.signum() * ((t * d.abs() + p) / modulus);
                        assert_eq!([x - 5, y], [place(dx, preset[0]), place(dy, preset[1])]);
                    }
                    let last = table.rows.last().expect("row 0");
                    assert_eq!([last[1], last[3]], preset);
                    assert_eq!(
                        table.columns,
                        dda_line(1, &[0; 2], &[0; 2], &[0; 2], false, EndPoint::Iterations).columns
                    );
                }
            }
        }
    }
}

#[test]
fn a_decimal_line_ends_where_its_counter_says() {
    for end in [EndPoint::Total, EndPoint::Longest, EndPoint::PerAxis, EndPoint::Iterations] {
        for preset in [0, 50, 99] {
            for to in [[8, 6], [-40, 99], [7, 7], [0, 1]] {
                let table = dda_line_decimal(2, &[0, 0], &to, &[preset; 2], end);
                assert!(table.finished);
                assert_pulses_make_the_path(&table);
                if end == EndPoint::PerAxis || end == EndPoint::Total {
                    assert_eq!(table.path().last(), Some(&to));
                }
                let [first, last] = [0, table.steps()].map(|row| {
                    let names = if end == EndPoint::PerAxis { vec!["ex", "ey"] } else { vec!["e"] };
                    names.into_iter().map(|name| table.column(name)[row]).collect::<Vec<_>>()
                });
                assert!(last.iter().all(|&count| count == 0));
                let [a, b] = to.map(i64::abs);
                assert_eq!(
                    first,
                    match end {
                        EndPoint::Total => vec![a + b],
                        EndPoint::Longest => vec![a.max(b)],
                        EndPoint::PerAxis => vec![a, b],
                        EndPoint::Iterations => vec![100],
                    }
                );
            }
        }
    }
}

#[test]
fn a_helix_is_the_arc_with_z_shared_by_angle() {
    for (r2, from, to, clockwise) in lattice_arcs(60) {
        for rise in [-17, 0, 1, 40] {
            let fraction = 5;
            let ends = ([from[0], from[1], 6], [to[0], to[1], 6 + rise]);
            let words = helix_words(ends.0, ends.1, [0, 0], clockwise, fraction);
            assert_eq!(words.iter().map(|word| word.1).sum::<i64>(), rise.abs());
            // J_VZ has to fit as well as the coordinates: Z may be steeper than the circle.
            let n = (2..).find(|&n| 1_i64 << n > r2.isqrt() + 1 && 1_i64 << (n + fraction) > words[0].0);
            let n = n.expect("some n");
            let half = 1 << (n - 1);
            let table = dda_helix(n, fraction, ends.0, ends.1, [0, 0], clockwise, &words, [half, half, 0]);
            let arc = dda_arc(n, from, to, [0, 0], clockwise, [half, half], false, EndPoint::PerAxis);
            assert!(table.finished && arc.finished);
            assert_eq!(end_of(&table), to);
            assert_pulses_make_the_path(&table);
            assert_eq!(table.column("z").last(), Some(&(6 + rise)));
            let pulses = |columns: [Vec<i64>; 2]| -> Vec<[i64; 2]> {
                let [dx, dy] = columns;
                dx.into_iter().zip(dy).map(|(x, y)| [x, y]).filter(|pulse| *pulse != [0, 0]).collect()
            };
            assert_eq!(pulses([table.column("dx"), table.column("dy")]), pulses([arc.column("dx"), arc.column("dy")]),);
            if rise == 0 {
                assert_eq!(table.column("jrx"), arc.column("jrx"));
                assert_eq!(table.steps(), arc.steps());
            }
        }
    }
}

#[test]
fn the_words_of_a_helix_by_hand() {
    // A half circle and Z = 5: 2.5 of it, rounded up, in the first sector; 5/π·16 = 25.46.
    let words = helix_words([5, 0, 0], [-5, 0, 5], [0, 0], false, 4);
    assert_eq!(words, [(26, 3), (26, 2)]);
    // A full circle from (5,5): 1/8, 1/4, 1/4, 1/4, 1/8 of 10; 10/2π·256 = 407.4.
    let words = helix_words([5, 5, 10], [5, 5, 0], [0, 0], true, 8);
    assert_eq!(words.iter().map(|word| word.1).collect::<Vec<_>>(), [1, 3, 2, 3, 1]);
    assert!(words.iter().all(|word| word.0 == 408));
    assert_eq!(helix_words([5, 0, 3], [0, 5, 3], [0, 0], false, 8), [(0, 0)]);
}

#[test]
fn the_integrator_of_z_runs_along_with_the_arc() {
    // J_VZ = 3.5 in three bits and one of fraction.
    let table = dda_helix(3, 1, [5, 0, 0], [0, 5, -6], [0, 0], false, &[(7, 6)], [0, 0, 0]);
    assert_eq!(pulse_steps(&table, "dz"), [3, 5, 7, 10, 12, 14]);
    assert_eq!(table.column("jrz")[..5], [0, 7, 14, 5, 12]);
    assert_eq!(table.column("jvz"), [7; 15]);
    assert_eq!(table.column("ez").last(), Some(&0));
    assert_eq!(pulse_steps(&table, "dy"), [2, 4, 5, 7, 9]);
    let full = dda_helix(3, 1, [5, 0, 0], [0, 5, -6], [0, 0], false, &[(7, 6)], [0, 0, 15]);
    assert_eq!(pulse_steps(&full, "dz"), [1, 3, 5, 7, 10, 12]);
    // Z has pulses but no rate.
    let table = dda_helix(3, 1, [5, 0, 0], [0, 5, 1], [0, 0], false, &[(0, 1)], [0, 0, 0]);
    assert!(!table.finished);
    assert_eq!(end_of(&table), [0, 5]);
    assert_eq!(table.steps(), 14);
}
