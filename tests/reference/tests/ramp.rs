//! Ramps: the worked tables, and the closed forms.

use super::super::{Braking, InForce, RampBlock, ramp, ramp_plan, ramp_speeds_up};

fn block(braking: Braking, up: i128, events: Vec<InForce>) -> RampBlock {
    RampBlock { bits: 8, pulses: 12, start: 64, drive: 144, stop: 64, up, down: up, preset: 0, braking, events }
}

#[test]
fn the_worked_trapezoid_is_reproduced_to_the_digit() {
    let table = ramp(&block(Braking::Square, 16, vec![]));
    let phase = [
        0, 64, 144, 240, 96, 224, 112, 0, 144, 32, 176, 64, 208, 96, 240, 128, 16, 160, 48, 192, 64, 176, 16, 96, 160,
        224, 32,
    ];
    assert_eq!(table.column("phase"), phase);
    let mut v = vec![64, 80, 96, 112, 128];
    v.extend([144; 14]);
    v.extend([128, 112, 96, 80, 64, 64, 64, 64]);
    assert_eq!(table.column("v"), v);
    let e = [12, 12, 12, 12, 11, 11, 10, 9, 9, 8, 8, 7, 7, 6, 6, 5, 4, 4, 3, 3, 2, 2, 1, 1, 1, 1, 0];
    assert_eq!(table.column("e"), e);

    let counted = ramp(&block(Braking::Count, 16, vec![]));
    assert_eq!(counted.column("phase")[20..], [80, 224, 96, 208, 48]);
    assert_eq!(counted.column("v")[20..], [144, 128, 112, 96, 80]);
}

#[test]
fn the_worked_hold_is_reproduced_to_the_digit() {
    let event = |tick, hold| InForce { tick, hold, percent: 100 };
    let table = ramp(&block(Braking::Square, 16, vec![event(9, true), event(17, false)]));
    assert_eq!(table.column("v")[8..19], [144, 128, 112, 96, 80, 64, 0, 0, 0, 64, 80]);
    assert_eq!(table.steps(), 33);
}

#[test]
fn the_worked_s_curve_is_reproduced_to_the_digit() {
    let table = ramp(&block(Braking::Jerk(4), 12, vec![]));
    let mut v = vec![81, 81, 84, 90, 99, 108, 117, 126, 135, 141];
    v.extend([144; 7]);
    v.extend([141, 135, 126, 117, 108, 99, 90, 84, 81, 81, 81]);
    assert_eq!(table.column("v"), v);
    assert_eq!(table.column("av")[..11], [0, 3, 6, 9, 9, 9, 9, 9, 6, 3, 0]);
    assert_eq!(table.steps(), 27);
    let plan = ramp_plan(64, 144, 4, 12);
    assert_eq!((plan.m, plan.h, plan.j, plan.rest), (3, 4, 3, 17));
}

/// A ramp gains exactly j·m(m+h), and where it has no constant part and nothing is left it takes the 2·sqrt(D/J) ticks and
/// makes the (DV+SV)·sqrt((DV-SV)/J) of data sheets, less the difference of the speeds.
#[test]
fn s_curves_have_the_time_and_the_length_of_data_sheets() {
    for low in [1, 7, 64, 500] {
        for difference in 1..400 {
            for (jerk, most) in [(1, 1), (1, 9), (2, 100), (4, 12), (7, 1000)] {
                let plan = ramp_plan(low, low + difference, jerk, most);
                assert_eq!(plan.j * plan.m * (plan.m + plan.h) + plan.rest, difference);
                assert!(
                    plan.j <= jerk && plan.j * plan.m <= most.max(jerk),
                    "{plan:?} of {difference}, {jerk}, {most}"
                );
                let start = low + plan.rest;
                let sum: i128 = ramp_speeds_up(start, plan).iter().sum();
                let (ticks, top) = (2 * plan.m + plan.h, low + difference);
                assert_eq!(2 * sum, ticks * (start + top) - 2 * (top - start) * i128::from(ticks > 0));
                if plan.h == 0 && plan.rest == 0 && plan.j == jerk {
                    assert_eq!(ticks * ticks * jerk, 4 * difference);
                    let root = (difference / jerk).isqrt();
                    assert_eq!(sum, (top + low) * root - difference);
                }
            }
        }
    }
}
