//! Acceleration and deceleration of a pulse source.

use proptest::prelude::*;
use stepwave::testbench::{Ending, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::events::{Action, Timed};
use stepwave_models::{Options, find};

use super::{assert_equal, line, run_on};
use crate::reference::{Braking, InForce, RampBlock, ramp, ramp_plan};

const NAME: &str = "ramp";

/// The options that give such a block.
fn options(block: &RampBlock) -> Options {
    let RampBlock { bits, start, drive, stop, up, down, preset, braking, .. } = block;
    let speeds = format!("vs={start},vc={drive},ve={stop}");
    let (width, preset, gains) = (bits.to_string(), preset.to_string(), format!("{up},{down}"));
    let mut words = vec!["--width", &width, "--preset", &preset, "--speed", &speeds, "--accel", &gains];
    let jerk = if let Braking::Jerk(jerk) = braking { jerk.to_string() } else { "none".to_owned() };
    words.extend(["--jerk", &jerk, "--brake", if *braking == Braking::Count { "count" } else { "square" }]);
    Options::parse(words).unwrap()
}

/// The events of an operator that are in force from these ticks on: the load takes the first clock.
fn events(block: &RampBlock) -> Vec<Timed> {
    let one = |event: &InForce| {
        let hold = if event.hold { Action::Hold } else { Action::Resume };
        let share = Action::Override(u32::try_from(event.percent).unwrap());
        [hold, share].map(|action| Timed { clock: event.tick, action })
    };
    block.events.iter().flat_map(one).collect()
}

fn check(block: &RampBlock, engine: EngineKind) {
    let curve = line(&[0], &[i64::try_from(block.pulses).unwrap()]);
    let bench = Testbench::new(find(NAME).unwrap(), &curve, &options(block)).unwrap();
    let bench = bench.with_events(&events(block)).unwrap();
    let ran = run_on(&bench, engine);
    assert_equal(|| format!("{block:?} on {}", engine.name()), &ran, &ramp(block));
    assert_eq!(ran.outcome.ending, Ending::Done);
    assert_eq!(ran.outcome.reached, curve.to());
}

fn block(bits: u32, pulses: i128, speeds: [i128; 3], gains: [i128; 2]) -> RampBlock {
    let ([start, drive, stop], [up, down]) = (speeds, gains);
    let (preset, braking, events) = (0, Braking::Square, vec![]);
    RampBlock { bits, pulses, start, drive, stop, up, down, preset, braking, events }
}

/// Every block of a small machine, whatever its speeds and accelerations.
#[test]
fn every_small_trapezoid() {
    for pulses in 1..6 {
        for (start, stop) in (1..=7).flat_map(|start| (1..=7).map(move |stop| (start, stop))) {
            for gains in [[1, 1], [2, 1], [1, 3], [4, 2], [9, 9]] {
                for drive in [start.max(stop), 7] {
                    check(&block(3, pulses, [start, drive, stop], gains), EngineKind::Word);
                }
            }
        }
    }
}

#[test]
fn every_small_ramp_that_counts_or_goes_along_an_s() {
    for (pulses, start) in (1..7).flat_map(|pulses| (1..=14).map(move |start| (pulses, start))) {
        for (drive, gain) in [start, 11.max(start), 15].into_iter().flat_map(|drive| [1, 2, 5].map(|a| (drive, a))) {
            let plain = block(4, pulses, [start, drive, start], [gain; 2]);
            for braking in [Braking::Count, Braking::Jerk(1), Braking::Jerk(3)] {
                check(&RampBlock { braking, ..plain.clone() }, EngineKind::Word);
            }
        }
    }
}

#[test]
fn the_worked_blocks_on_every_engine() {
    let worked = block(8, 12, [64, 144, 64], [16; 2]);
    let event = |tick, hold, percent| InForce { tick, hold, percent };
    for engine in EngineKind::ALL {
        check(&worked, engine);
        check(&RampBlock { braking: Braking::Count, ..worked.clone() }, engine);
        check(&RampBlock { up: 12, down: 12, braking: Braking::Jerk(4), ..worked.clone() }, engine);
        let held = vec![event(9, true, 100), event(17, false, 100)];
        check(&RampBlock { events: held, ..worked.clone() }, engine);
        let slower = vec![event(1, false, 50), event(5, false, 200), event(12, true, 0), event(40, false, 31)];
        check(&RampBlock { events: slower, pulses: 60, ..worked.clone() }, engine);
    }
}

/// Registers so wide that the square of the speed has more than 64 bits.
#[test]
fn wide_registers_on_every_engine() {
    for bits in [31, 32, 33, 47, 54] {
        let one = 1_i128 << bits;
        let fast = block(bits, 60, [one / 90, one / 3, one / 70], [one / 901, one / 703]);
        for engine in EngineKind::ALL {
            check(&fast, engine);
            let alike = RampBlock { stop: fast.start, down: fast.up, ..fast.clone() };
            check(&RampBlock { braking: Braking::Count, ..alike.clone() }, engine);
            check(&RampBlock { braking: Braking::Jerk(one / 9001), ..alike }, engine);
        }
    }
}

/// Until the drive speed or braking, t ticks make floor((P + v·t + a·t(t-1)/2 + j·t(t-1)(t-2)/6) / 2^n) pulses.
#[test]
fn pulses_follow_the_closed_forms() {
    let plain = RampBlock { preset: 777, ..block(20, 5000, [1000, 500_000, 1000], [250; 2]) };
    let t = |block: &RampBlock, t: i128, start: i128, a: i128, j: i128| {
        (block.preset + start * t + a * t * (t - 1) / 2 + j * t * (t - 1) * (t - 2) / 6) >> block.bits
    };
    let ran = |block: &RampBlock| {
        let bench = Testbench::new(find(NAME).unwrap(), &line(&[0], &[5000]), &options(block)).unwrap();
        let ran = run_on(&bench, EngineKind::Compiled);
        let x = ran.columns.iter().position(|name| name == "x").unwrap();
        ran.rows.iter().map(|row| i128::from(row[x])).collect::<Vec<_>>()
    };
    let rises = (500_000 - 1000) / 250;
    for (tick, x) in (0..=rises).zip(ran(&plain)) {
        assert_eq!(x, t(&plain, tick, 1000, 250, 0), "tick {tick}");
    }
    let curve = RampBlock { braking: Braking::Jerk(1), ..plain };
    let plan = ramp_plan(1000, 500_000, 1, 250);
    for (tick, x) in (0..=plan.m).zip(ran(&curve)) {
        assert_eq!(x, t(&curve, tick, 1000 + plan.rest, 0, plan.j), "tick {tick}");
    }
}

/// Blocks in registers of up to 40 bits, some with events.
fn blocks() -> impl Strategy<Value = RampBlock> {
    let speeds = prop::array::uniform3(0.0..1.0f64);
    let event = (1..800u64, any::<bool>(), 0..=200i128);
    let events = prop::collection::vec(event, 0..5);
    let gains = prop::array::uniform2(1..400i128);
    (4..=40u32, 1..40i128, speeds, gains, 0.0..1.0f64, 0..4u32, events).prop_map(
        |(bits, pulses, speeds, gains, preset, kind, events)| {
            let one = 1_i128 << bits;
            #[allow(clippy::cast_possible_truncation)]
            let of = |share: f64| ((share.powi(3) * one as f64) as i128).clamp(1 + one / 60, one - 1);
            let [a, b, drive] = speeds.map(of);
            let (start, stop) = (a.min(drive), b.min(drive));
            // Ramps of a few to some thousand ticks.
            let gains = gains.map(|gain| (gain * one / 40_000).max(1));
            #[allow(clippy::cast_possible_truncation)]
            let preset = (preset * one as f64) as i128 % one;
            let mut events: Vec<_> =
                events.into_iter().map(|(tick, hold, percent)| InForce { tick, hold, percent }).collect();
            events.sort_by_key(|event| event.tick);
            events.dedup_by_key(|event| event.tick);
            // An operator who leaves the machine holding, or nearly, is another matter.
            if let Some(last) = events.last_mut() {
                (last.hold, last.percent) = (false, last.percent.max(100));
            }
            let plain = block(bits, pulses, [start, drive, stop], gains);
            let plain = RampBlock { preset, events, ..plain };
            let alike = |braking| RampBlock { stop: start, down: gains[0], braking, ..plain.clone() };
            match kind {
                0 => alike(Braking::Count),
                1 => alike(Braking::Jerk(1 + gains[0] / 50)),
                _ => plain,
            }
        },
    )
}

proptest! {
    #[test]
    fn any_ramp_follows_the_recurrence(block in blocks()) {
        check(&block, EngineKind::Compiled);
        check(&block, EngineKind::Word);
    }
}
