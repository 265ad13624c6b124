//! Digital differential analyser: worked tables and claims.

use super::super::arc_geometry::{ArcKind, nearest_radius};
use super::super::{AXES, EndPoint, Table, dda_arc, dda_line};
use super::{assert_pulses_make_the_path, end_of, lattice_arcs, moves, pulse_steps, radial_error, turned};

/// The presets zero, half and full of an n-bit remainder.
fn presets(n: u32) -> [i64; 3] {
    [0, 1 << (n - 1), (1 << n) - 1]
}

/// The smallest n with 2^n > `largest`.
fn bits_for(largest: i64) -> u32 {
    (1..).find(|&n| (1 << n) > largest).expect("some n")
}

/// The bits that every coordinate of an arc with this R² needs.
fn arc_bits(radius_squared: i64) -> u32 {
    bits_for(nearest_radius(radius_squared))
}

/// True when the arc crosses an axis, at a coordinate that is not on its circle.
fn crosses_off_the_circle(table: &Table, radius_squared: i64) -> bool {
    let quad = table.column("quad");
    let root = radius_squared.isqrt();
    root * root != radius_squared && quad.iter().any(|&q| q != quad[0])
}

#[test]
fn the_worked_lines_are_reproduced_to_the_digit() {
    let table = dda_line(4, &[0, 0], &[8, 6], &[0, 0], false, EndPoint::Iterations);
    assert_eq!(table.steps(), 16);
    assert_eq!(pulse_steps(&table, "dx"), [2, 4, 6, 8, 10, 12, 14, 16]);
    assert_eq!(pulse_steps(&table, "dy"), [3, 6, 8, 11, 14, 16]);
    let jry = [0, 6, 12, 2, 8, 14, 4, 10, 0, 6, 12, 2, 8, 14, 4, 10, 0];
    assert_eq!(table.column("jry"), jry);
    assert_eq!(table.column("e")[0], 16);

    let table = dda_line(3, &[0, 0], &[-3, 4], &[0, 0], false, EndPoint::Iterations);
    assert_eq!(pulse_steps(&table, "dx"), [3, 6, 8]);
    assert_eq!(pulse_steps(&table, "dy"), [2, 4, 6, 8]);
    assert_eq!(end_of(&table), [-3, 4]);

    let table = dda_line(3, &[0, 0], &[7, 5], &[0, 0], false, EndPoint::Iterations);
    assert_eq!(pulse_steps(&table, "dx"), [2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(pulse_steps(&table, "dy"), [2, 4, 5, 7, 8]);
}

#[test]
fn the_worked_arc_nr1_is_reproduced_to_the_digit() {
    let table = dda_arc(3, [5, 0], [0, 5], [0, 0], false, [0, 0], false, EndPoint::PerAxis);
    assert_eq!(table.steps(), 14);
    assert_eq!(pulse_steps(&table, "dy"), [2, 4, 5, 7, 9]);
    assert_eq!(pulse_steps(&table, "dx"), [7, 9, 11, 12, 14]);
    let jvx = [0, 0, 1, 1, 2, 3, 3, 4, 4, 5, 5, 5, 5, 5, 5];
    assert_eq!(table.column("jvx"), jvx);
    let jvy = [5, 5, 5, 5, 5, 5, 5, 4, 4, 3, 3, 2, 1, 1, 0];
    assert_eq!(table.column("jvy"), jvy);
    assert_eq!(table.path()[6..11], [[5, 3], [4, 4], [4, 4], [3, 5], [3, 5]]);
    // Y is done after step 9: its remainder freezes.
    let jry = table.column("jry");
    assert!(jry[9..].iter().all(|&jr| jr == jry[9]));
}

#[test]
fn the_worked_arc_sr_across_an_axis_is_reproduced_to_the_digit() {
    let table = dda_arc(3, [-3, -4], [-4, 3], [0, 0], true, [0, 0], false, EndPoint::PerAxis);
    assert_eq!(table.steps(), 8 + 7);
    assert_eq!(pulse_steps(&table, "dx"), [2, 5, 8 + 7]);
    assert_eq!(pulse_steps(&table, "dy"), [3, 5, 7, 8, 8 + 2, 8 + 4, 8 + 5]);
    assert_eq!(table.column("dx")[15], 1);
    assert_eq!(table.path()[8], [-5, 0]);
    let quadrants = [2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1];
    assert_eq!(table.column("quad"), quadrants);
    assert_eq!([table.column("ex")[8], table.column("ey")[8]], [0, 0]);
    // The reload and the first iteration of Q2 are one row: remainders 0 + J_V.
    assert_eq!([table.column("ex")[9], table.column("ey")[9]], [1, 3]);
    assert_eq!([table.column("jrx")[9], table.column("jry")[9]], [0, 5]);
}

#[test]
fn the_correction_table_of_the_eight_arc_kinds_follows_from_the_tangent() {
    // J_VX on a Y pulse, J_VY on an X pulse, direction of X, of Y; SR1..4, then NR1..4.
    let rows = [
        [-1, 1, -1, 1, 1, -1, 1, -1],
        [1, -1, 1, -1, -1, 1, -1, 1],
        [1, 1, -1, -1, -1, -1, 1, 1],
        [-1, 1, 1, -1, 1, -1, -1, 1],
    ];
    for (column, quadrant) in [0, 1, 2, 3, 0, 1, 2, 3].into_iter().enumerate() {
        let clockwise = column < 4;
        let kind = ArcKind { quadrant, clockwise };
        let correction = |axis| if kind.growing() == axis { 1 } else { -1 };
        let [x, y] = kind.travel();
        let shown = [correction(1), correction(0), x, y];
        assert_eq!(shown, rows.map(|row| row[column]), "{kind:?}");
    }
}

/// Floor((t·|d|·2^Q + P) / 2^n), the closed form of the position, with the sign of d.
fn closed_form(t: i64, d: i64, unit: i64, preset: i64, modulus: i64) -> i64 {
    d.signum() * ((t * d.abs() * unit + preset) / modulus)
}

#[test]
fn every_line_follows_the_closed_form_and_returns_its_remainder_to_the_preset() {
    for n in 1..=4 {
        let modulus = 1 << n;
        for dx in 1 - modulus..modulus {
            for dy in 0..modulus {
                for px in 0..modulus {
                    let preset = [px, modulus - 1 - px];
                    for normalize in [false, true] {
                        let end = EndPoint::Iterations;
                        let table = dda_line(n, &[0, 5], &[dx, 5 + dy], &preset, normalize, end);
                        let largest = dx.abs().max(dy);
                        let mut unit = 1;
                        while normalize && largest > 0 && largest * unit < modulus / 2 {
                            unit *= 2;
                        }
                        let expected: Vec<[i64; 2]> = (0..=modulus / unit)
                            .map(|t| {
                                [
                                    closed_form(t, dx, unit, preset[0], modulus),
                                    5 + closed_form(t, dy, unit, preset[1], modulus),
                                ]
                            })
                            .collect();
                        assert_eq!(table.path(), expected, "({dx},{dy}) n = {n}");
                        assert_eq!(end_of(&table), [dx, 5 + dy]);
                        assert_eq!(table.column("jrx").last(), Some(&preset[0]));
                        assert_eq!(table.column("jry").last(), Some(&preset[1]));
                        assert_eq!(table.column("jvx")[0], dx.abs() * unit);
                        let countdown: Vec<i64> = (0..=modulus / unit).rev().collect();
                        assert_eq!(table.column("e"), countdown);
                        assert!(table.finished);
                    }
                }
            }
        }
    }
}

#[test]
fn every_line_ends_exactly_for_every_preset_by_pulse_counters_too() {
    let n = 3;
    for dx in -7..=7_i64 {
        for dy in -7..=7_i64 {
            for presets in 0..64 {
                let preset = [presets % 8, presets / 8];
                for normalize in [false, true] {
                    for end in [EndPoint::Total, EndPoint::PerAxis] {
                        let table = dda_line(n, &[0, 0], &[dx, dy], &preset, normalize, end);
                        assert!(table.finished);
                        assert_eq!(end_of(&table), [dx, dy], "{end:?} {preset:?}");
                        assert_pulses_make_the_path(&table);
                    }
                    if preset[0] == preset[1] {
                        let end = EndPoint::Longest;
                        let table = dda_line(n, &[0, 0], &[dx, dy], &preset, normalize, end);
                        assert!(table.finished);
                        assert_eq!(end_of(&table), [dx, dy], "{preset:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_counter_on_the_longest_axis_needs_equal_presets() {
    let table = dda_line(2, &[0, 0], &[1, 1], &[3, 0], false, EndPoint::Longest);
    assert_eq!(end_of(&table), [1, 0]);
}

#[test]
fn an_axis_of_a_line_that_is_done_freezes_its_remainder() {
    let table = dda_line(3, &[0, 0], &[5, 3], &[0, 7], false, EndPoint::PerAxis);
    assert_eq!(table.column("jry"), [7, 2, 5, 0, 3, 6, 1, 1, 1]);
    assert_eq!(table.column("ey"), [3, 2, 2, 1, 1, 1, 0, 0, 0]);
}

#[test]
fn up_to_six_axes_each_follow_their_own_closed_form() {
    let to = [9, -14, 0, 1, 15, -7];
    let preset = [0, 8, 15, 3, 1, 12];
    for axes in 2..=6 {
        let (to, preset) = (&to[..axes], &preset[..axes]);
        let from = vec![0; axes];
        for end in [EndPoint::Iterations, EndPoint::Total, EndPoint::PerAxis] {
            let table = dda_line(4, &from, to, preset, false, end);
            for axis in 0..axes {
                let column = table.column(AXES[axis]);
                assert_eq!(column.last(), Some(&to[axis]));
                for (t, position) in (0..).zip(column) {
                    let expected = closed_form(t, to[axis], 1, preset[axis], 16);
                    assert_eq!(position, expected, "{} at {t}", AXES[axis]);
                }
            }
        }
    }
}

#[test]
fn arcs_cross_the_axes_at_the_nearest_integer_to_r() {
    for r2 in 1..10_000 {
        let nearest = (r2 as f64).sqrt().round();
        assert_eq!(nearest_radius(r2) as f64, nearest, "R² = {r2}");
    }
}

#[test]
fn an_arc_ends_exactly_or_hangs_before_a_rounded_crossing() {
    let mut hung = [0; 3];
    for (r2, from, to, clockwise) in lattice_arcs(200) {
        let n = arc_bits(r2);
        for (which, p) in presets(n).into_iter().enumerate() {
            for normalize in [false, true] {
                let end = EndPoint::PerAxis;
                let table = dda_arc(n, from, to, [0, 0], clockwise, [p, p], normalize, end);
                assert!(!table.overflow);
                assert_pulses_make_the_path(&table);
                if table.finished {
                    assert_eq!(end_of(&table), to, "from {from:?}");
                    continue;
                }
                // On the axis, one pulse short of the crossing, and the integrand of that pulse
                // is 0.
                hung[which] += 1;
                let crossing = nearest_radius(r2);
                let [x, y] = end_of(&table).map(i64::abs);
                assert!(crossing * crossing > r2, "{from:?} to {to:?}");
                assert_eq!([x.max(y), x.min(y)], [crossing - 1, 0], "{from:?} to {to:?}");
            }
        }
    }
    // The half preset fires the last pulse in time.
    assert!(hung[0] > 0 && hung[1] == 0, "{hung:?}");
}

#[test]
fn an_arc_with_zero_preset_can_hang_before_the_axis() {
    // R² = 58, R = 7.6: the crossing is (0,8), but X is done at (0,7) with J_VY = 0.
    let table = dda_arc(4, [3, 7], [0, 8], [0, 0], false, [0, 0], false, EndPoint::PerAxis);
    assert!(!table.finished && !table.overflow);
    assert_eq!(end_of(&table), [0, 7]);
    assert_eq!(table.column("jvy").last(), Some(&0));
    assert_eq!(table.column("ey").last(), Some(&1));
    let idle = table.steps() - pulse_steps(&table, "dx")[2];
    assert_eq!(idle, 17, "2^4 + 1 steps without a pulse");
    let half = dda_arc(4, [3, 7], [0, 8], [0, 0], false, [8, 8], false, EndPoint::PerAxis);
    assert!(half.finished);
}

#[test]
fn the_integrands_are_the_coordinates_and_every_pulse_is_2_to_the_n_of_them() {
    for (r2, from, to, clockwise) in lattice_arcs(200) {
        let n = arc_bits(r2) + 2;
        let modulus = 1 << n;
        let preset = [modulus / 2, modulus - 1];
        for normalize in [false, true] {
            let end = EndPoint::PerAxis;
            let table = dda_arc(n, from, to, [0, 0], clockwise, preset, normalize, end);
            let path = table.path();
            let (unit, quad) = (table.column("unit"), table.column("quad"));
            let jv = [table.column("jvx"), table.column("jvy")];
            let jr = [table.column("jrx"), table.column("jry")];
            let left = [table.column("ex"), table.column("ey")];
            let pulses = [table.column("dx"), table.column("dy")];
            assert_eq!([jr[0][0], jr[1][0]], preset);
            for k in 0..path.len() {
                for axis in 0..2 {
                    assert_eq!(jv[axis][k], path[k][1 - axis].abs() * unit[k]);
                    assert!((0..modulus).contains(&jv[axis][k]));
                }
                if k == 0 || quad[k] != quad[k - 1] {
                    // Loaded: the larger integrand has its top or its second highest bit set, as
                    // it was before this step.
                    let point = path[k.saturating_sub(1)].map(i64::abs);
                    let largest = point[0].max(point[1]) * unit[k];
                    let shifted = largest >= modulus / 4 && largest < modulus / 2;
                    assert!(if normalize { shifted } else { unit[k] == 1 });
                } else {
                    assert_eq!(unit[k], unit[k - 1]);
                    for axis in 0..2 {
                        let adds = i64::from(left[axis][k - 1] > 0);
                        let sum = jr[axis][k - 1] + adds * jv[axis][k - 1];
                        assert_eq!(jr[axis][k] + modulus * pulses[axis][k].abs(), sum);
                    }
                }
            }
        }
    }
}

#[test]
fn quarter_circles_keep_the_error_that_each_preset_buys() {
    let mut worst = [0.0_f64; 3];
    for r in 1..=255 {
        let n = bits_for(r);
        for (which, p) in presets(n).into_iter().enumerate() {
            for normalize in [false, true] {
                let end = EndPoint::PerAxis;
                let table = dda_arc(n, [r, 0], [0, r], [0, 0], false, [p, p], normalize, end);
                assert!(table.finished);
                worst[which] = worst[which].max(radial_error(&table, r * r));
            }
        }
    }
    let [zero, half, full] = worst;
    assert!(zero > 1.76 && zero < 1.77, "zero: {zero}");
    assert!(half > 1.24 && half < 1.25, "half: {half}");
    assert!(full > 1.04 && full < 1.19, "full: {full}");
}

#[test]
fn arcs_that_cross_off_their_circle_err_more_than_quarter_circles() {
    let mut worst = [0.0_f64; 2];
    for (r2, from, to, clockwise) in lattice_arcs(220) {
        let n = arc_bits(r2);
        let half = presets(n)[1];
        let end = EndPoint::PerAxis;
        let table = dda_arc(n, from, to, [0, 0], clockwise, [half; 2], false, end);
        let which = usize::from(crosses_off_the_circle(&table, r2));
        worst[which] = worst[which].max(radial_error(&table, r2));
    }
    let [on, off] = worst;
    assert!(on < 1.25, "{on}");
    assert!(off > 1.25 && off < 1.6, "{off}");
}

#[test]
fn an_arc_turned_by_90_degrees_makes_the_same_steps_there() {
    for (r2, from, to, clockwise) in lattice_arcs(60) {
        let n = arc_bits(r2) + 1;
        for normalize in [false, true] {
            let end = EndPoint::PerAxis;
            let [px, py] = [3, 1];
            let table = dda_arc(n, from, to, [0, 0], clockwise, [px, py], normalize, end);
            let (from, to) = (turned(from), turned(to));
            let moved = |[x, y]: [i64; 2]| [x + 5, y - 8];
            let (from, to) = (moved(from), moved(to));
            let other = dda_arc(n, from, to, [5, -8], clockwise, [py, px], normalize, end);
            let path: Vec<_> = table.path().into_iter().map(turned).map(moved).collect();
            assert_eq!(other.path(), path);
            assert_eq!(other.column("jrx"), table.column("jry"));
        }
    }
}

#[test]
fn with_a_total_counter_both_integrators_add_until_all_pulses_are_counted() {
    // X overtakes: the tenth pulse comes before Y is at the end point.
    let table = dda_arc(3, [4, 0], [0, 4], [0, 0], false, [0, 0], false, EndPoint::Total);
    assert!(table.finished);
    assert_eq!(table.column("e")[0], 8);
    assert_eq!(table.column("e").last(), Some(&0));
    assert_eq!(end_of(&table), [1, 5]);
    // Up to the step in which one axis is done the path is that of the counters per axis.
    let split = dda_arc(3, [4, 0], [0, 4], [0, 0], false, [0, 0], false, EndPoint::PerAxis);
    let done = pulse_steps(&split, "dy")[3];
    assert_eq!(table.path()[..=done], split.path()[..=done]);
    assert!(moves(&table).contains("+Y"));
}

#[test]
fn a_total_counter_can_drive_an_integrand_out_of_its_register() {
    // R = 1 in one bit: the second Y pulse would make J_VX 2.
    let table = dda_arc(1, [1, 0], [0, 1], [0, 0], false, [0, 0], false, EndPoint::Total);
    assert!(table.overflow && !table.finished);
    assert_eq!(end_of(&table), [1, 1]);
    assert_eq!(table.column("e").last(), Some(&1));
}
