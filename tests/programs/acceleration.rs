//! Programs with acceleration: the clocks of every move against a plan and a recurrence of its own.

use std::fmt::Write;

use proptest::prelude::*;
use stepwave::Simulation;
use stepwave::testbench::Ending;
use stepwave_models::events::Timed;
use stepwave_models::{Options, find};

use crate::reference::{Braking, RampBlock, ramp};

/// Clock in Hz, BLU in mm, acceleration in mm/s², and what these are in BLU.
const HZ: f64 = 20_000.0;
const BLU: f64 = 0.01;
const ACCEL: f64 = 500.0;
const GAIN: f64 = ACCEL / BLU;

/// How a corner is passed.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Corner {
    Exact,
    Continuous,
    Within(f64),
}

/// A straight move in BLU, with its feed in mm/min.
#[derive(Clone, Copy, Debug)]
struct Straight {
    by: [i64; 2],
    feed: f64,
    corner: Corner,
}

fn text(moves: &[Straight]) -> String {
    let mut text = "G21 G91\n".to_owned();
    for Straight { by: [x, y], feed, corner } in moves {
        let control = match corner {
            Corner::Exact => "G61".to_owned(),
            Corner::Continuous => "G64".to_owned(),
            Corner::Within(off) => format!("G64 P{}", off * BLU),
        };
        let [x, y] = [x, y].map(|c| *c as f64 * BLU);
        writeln!(text, "{control}\nG1 X{x:.2} Y{y:.2} F{feed}").unwrap();
    }
    text
}

/// One block of the machine.
struct Block {
    pulses: i128,
    /// Length that the source counts in BLU, and its pulses for a BLU.
    length: f64,
    scale: f64,
    cap: f64,
    unit: [f64; 2],
    corner: Corner,
}

fn block(of: &Straight, method: &str, bits: u32) -> Block {
    let [x, y] = of.by.map(i64::abs);
    let path = f64::hypot(x as f64, y as f64);
    let (pulses, scale) = match method {
        "ppc" => ((x + y).into(), 1.0),
        "bresenham" => (x.max(y).into(), x.max(y) as f64 / path),
        _ => (1_i128 << bits, 2f64.powi(bits.cast_signed()) / path),
    };
    let cap = (of.feed / 60.0 / BLU).min(HZ / 2.0 / scale);
    Block { pulses, length: pulses as f64 / scale, scale, cap, unit: of.by.map(|c| c as f64 / path), corner: of.corner }
}

/// The speeds at the joints: at the first and the last, and between two blocks each.
fn joints(blocks: &[Block], jump: f64) -> Vec<f64> {
    let mut squares = vec![jump * jump; blocks.len() + 1];
    for (index, pair) in blocks.windows(2).enumerate() {
        let [before, after] = [0, 1].map(|side| pair[side].unit);
        let by_axis = [0, 1]
            .map(|axis| (after[axis] - before[axis]).abs())
            .into_iter()
            .filter(|change| *change > 1e-9)
            .map(|change| jump / change)
            .fold(f64::INFINITY, f64::min);
        let inner = std::f64::consts::PI - (before[0] * after[0] + before[1] * after[1]).clamp(-1.0, 1.0).acos();
        let sine = (inner / 2.0).sin();
        let limit = match pair[0].corner {
            Corner::Exact => 0.0,
            Corner::Continuous => by_axis,
            Corner::Within(_) if 1.0 - sine < 1e-12 => by_axis,
            Corner::Within(off) => by_axis.min((GAIN * off * sine / (1.0 - sine)).sqrt()),
        };
        squares[index + 1] = limit.max(jump).min(pair[0].cap).min(pair[1].cap).powi(2);
    }
    for (index, block) in blocks.iter().enumerate().rev() {
        squares[index] = squares[index].min(squares[index + 1] + 2.0 * GAIN * block.length);
    }
    for (index, block) in blocks.iter().enumerate() {
        squares[index + 1] = squares[index + 1].min(squares[index] + 2.0 * GAIN * block.length);
    }
    squares.into_iter().map(f64::sqrt).collect()
}

/// The clocks of every block.
fn clocks(blocks: &[Block], jump: f64) -> Vec<u64> {
    let bits = (1..).find(|bits| (GAIN * 2f64.powi(*bits) / HZ / HZ).round() >= 128.0).unwrap();
    let unit = 2f64.powi(bits) / HZ;
    #[allow(clippy::cast_possible_truncation)]
    let word = |number: f64| number.round() as i128;
    let joints = joints(blocks, jump);
    let (mut phase, mut speed) = (0, 0);
    let run = |(index, block): (usize, &Block)| {
        let of = |speed: f64| word(speed.min(block.cap) * block.scale * unit);
        let gain = word(GAIN * block.scale * unit / HZ);
        let ramped = ramp(&RampBlock {
            bits: bits.cast_unsigned(),
            pulses: block.pulses,
            start: of(joints[index]),
            drive: of(block.cap),
            stop: of(joints[index + 1]),
            up: gain,
            down: gain,
            // The edge that loads still adds the speed of the block before.
            preset: (phase + speed) % (1 << bits),
            braking: Braking::Square,
            events: vec![],
        });
        phase = (*ramped.column("phase").last().unwrap()).into();
        speed = (*ramped.column("v").last().unwrap()).into();
        ramped.steps() as u64
    };
    blocks.iter().enumerate().map(run).collect()
}

fn simulation(folder: &tempfile::TempDir, method: &str, text: &str, jerk: &str) -> Simulation {
    let file = folder.path().join("part.ngc");
    std::fs::write(&file, text).unwrap();
    let accel = format!("{ACCEL}mm/s2");
    let options = Options::parse(["--accel", &accel, "--jerk", jerk]).unwrap();
    Simulation::program(find(&format!("{method}-machine")).unwrap(), file).options(options).clock_hz(HZ).blu_mm(BLU)
}

fn straights() -> impl Strategy<Value = Vec<Straight>> {
    let by = [-300..300i64, -300..300i64];
    let corner = prop_oneof![
        Just(Corner::Exact),
        Just(Corner::Continuous),
        // Below about a BLU such a limit is narrower than that of the axes.
        (0..200u8).prop_map(|off| Corner::Within(f64::from(off) / 100.0))
    ];
    let one = (by, 100.0..6000.0f64, corner, 0..4u8).prop_map(|(by, feed, corner, kind)| {
        // Some along an axis, some short.
        let by = match kind {
            0 => [by[0], 0],
            1 => by.map(|c| c / 20),
            _ => by,
        };
        Straight { by, feed: feed.round(), corner }
    });
    prop::collection::vec(one.prop_filter("it moves", |of| of.by != [0, 0]), 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(12) })]

    #[test]
    fn moves_take_the_clocks_of_the_plan_and_the_recurrence(moves in straights(), doubled: bool) {
        // The same direction again: nothing slows the machine down there.
        let moves: Vec<Straight> = if doubled { moves.iter().flat_map(|of| [*of; 2]).collect() } else { moves };
        let folder = tempfile::tempdir().unwrap();
        for method in ["ppc", "bresenham", "dpm"] {
            let simulation = simulation(&folder, method, &text(&moves), "none");
            let report = simulation.json(folder.path().join("r.json")).run().unwrap();
            prop_assert!(report.failures().is_empty(), "{:?}", report.failures());
            let json: serde_json::Value =
                serde_json::from_slice(&std::fs::read(folder.path().join("r.json")).unwrap()).unwrap();
            let bits = report.hardware.bits_of("q");
            let blocks: Vec<Block> = moves.iter().map(|of| block(of, method, bits)).collect();
            let wanted = clocks(&blocks, GAIN.sqrt());
            for (index, (clocks, block)) in wanted.iter().zip(json["blocks"].as_array().unwrap()).enumerate() {
                // A word that is rounded the other way changes little.
                let got = block["clocks"].as_u64().unwrap();
                prop_assert!(got.abs_diff(*clocks) <= 2 + clocks / 50_000, "{method} {index}: {got}, not {clocks}: {moves:?}");
            }
        }
    }

    /// Whatever the operator does, every end point is reached and no pulse is lost.
    #[test]
    fn events_lose_no_pulse(
        moves in straights(),
        events in prop::collection::vec((1..20_000u64, 0..5u8, 0..=200u32), 0..6),
        jerk: bool,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut timed: Vec<Timed> = Vec::new();
        let mut add = |clock: u64, word: &str| timed.push(Timed::parse(&format!("{clock}:{word}")).unwrap());
        for (clock, kind, percent) in events {
            match kind {
                0 => add(clock, "hold"),
                1 => add(clock, "resume"),
                2 => add(clock, "single"),
                3 => add(clock, "start"),
                _ => add(clock, &format!("override={percent}")),
            }
        }
        ["resume", "continuous", "override=100"].iter().for_each(|word| add(20_001, word));
        for method in ["ppc", "dda", "cim", "stepgen"] {
            let jerk = if jerk { "20000mm/s3" } else { "none" };
            let report = simulation(&folder, method, &text(&moves), jerk).events(timed.clone()).run().unwrap();
            prop_assert_eq!(report.outcome.ending, Ending::Done);
            prop_assert!(report.failures().is_empty(), "{} {:?}", method, report.failures());
            let wanted = moves.iter().fold([0, 0], |at, of| [at[0] + of.by[0], at[1] + of.by[1]]);
            prop_assert_eq!(&report.outcome.reached[..2], &wanted[..], "{}", method);
            let pulses: u64 = moves.iter().map(|of| of.by[0].unsigned_abs()).sum();
            prop_assert_eq!(report.outcome.pulses[0], pulses);
        }
    }
}

/// A long straight move takes the seconds of its trapezoid, and along an S those and J/A more for each ramp.
#[test]
fn a_straight_move_takes_the_time_of_its_closed_form() {
    let folder = tempfile::tempdir().unwrap();
    let moves = [Straight { by: [8000, 0], feed: 2400.0, corner: Corner::Exact }];
    let (drive, jump) = (40.0 / BLU, GAIN.sqrt());
    let ramp = (drive - jump) / GAIN;
    let plain = 2.0 * ramp + (8000.0 - (drive + jump) * ramp) / drive;
    let jerk = 20_000.0 / BLU;
    let longer = ramp + GAIN / jerk;
    let s = 2.0 * longer + (8000.0 - (drive + jump) * longer) / drive;
    for (words, seconds) in [("none", plain), ("20000mm/s3", s)] {
        let report = simulation(&folder, "bresenham", &text(&moves), words).run().unwrap();
        let got = report.outcome.clocks as f64 / HZ;
        assert!((got - seconds).abs() < 0.002 * seconds, "{words}: {got} s, not {seconds} s");
    }
}

/// With a stop after each block an operator has to start it.
#[test]
fn single_blocks_wait_for_the_operator() {
    let folder = tempfile::tempdir().unwrap();
    let moves = [Straight { by: [100, 0], feed: 2400.0, corner: Corner::Continuous }; 3];
    let ran = |events: &[&str]| {
        let events: Vec<Timed> = events.iter().map(|event| Timed::parse(event).unwrap()).collect();
        simulation(&folder, "bresenham", &text(&moves), "none").events(events).run().unwrap()
    };
    let started = ran(&["0:single", "1000:start", "5000:start", "9000:start"]);
    assert_eq!((started.outcome.ending, started.outcome.reached[0]), (Ending::Done, 300));
    assert!(started.outcome.clocks > 9000 && started.outcome.clocks < 12_000, "{}", started.outcome.clocks);
    let waits = ran(&["0:single", "1000:start"]);
    assert!(matches!(waits.outcome.ending, Ending::Stalled { .. }));
    assert_eq!(waits.outcome.reached[0], 100);
}

/// Whatever the operator does, the speed changes by the acceleration and no more, also from block to block; to a stop and
/// from one by what an axis can start at.
#[test]
fn the_speed_never_jumps() {
    let folder = tempfile::tempdir().unwrap();
    let moves: Vec<Straight> =
        [300, 40, 200, 500, 5, 100].map(|x| Straight { by: [x, 0], feed: 2400.0, corner: Corner::Continuous }).to_vec();
    let scripts: [&[&str]; 4] = [
        &[],
        &["1000:override=50", "4000:override=170", "5500:override=100"],
        &["900:hold", "1900:resume", "2400:hold", "2500:resume"],
        &["700:single", "2500:start", "3000:override=30", "4000:start", "6000:start", "8000:continuous"],
    ];
    for (events, jerk) in scripts.into_iter().flat_map(|events| [(events, "none"), (events, "20000mm/s3")]) {
        let events: Vec<Timed> = events.iter().map(|event| Timed::parse(event).unwrap()).collect();
        let simulation = simulation(&folder, "bresenham", &text(&moves), jerk).events(events.clone());
        let (report, trace) = simulation.run_traced().unwrap();
        assert!(report.failures().is_empty(), "{events:?} {:?}", report.failures());
        let bits = trace.bits("pulse_source.phase").map(|_| trace.bits("pulse_source.v").unwrap()).unwrap();
        // The least with which the acceleration, or the jerk, is 128.
        let n = if jerk == "none" { 20 } else { 29 };
        let [drive, start] = [4000.0, GAIN.sqrt()].map(|speed| speed * 2f64.powi(n) / HZ);
        // What the ticks of an S leave of a difference is in neither speed.
        let rest = if jerk == "none" { 0.0 } else { 0.005 * drive };
        let gain = drive * GAIN / HZ / 4000.0 * 1.05 + 1.0 + rest;
        for (clock, pair) in bits.windows(2).enumerate() {
            let [before, after] = [pair[0] as f64, pair[1] as f64];
            let low = before.min(after) <= 2.0 * start && before.max(after) <= 2.0 * start + gain;
            assert!((after - before).abs() <= gain || low, "{events:?} {jerk}: {before} to {after} at clock {clock}");
        }
    }
}

/// A straight way in many blocks takes the time that it takes in one, also along an S, which no short block could have for
/// itself; and the acceleration is carried from block to block.
#[test]
fn blocks_of_one_direction_have_one_ramp() {
    let folder = tempfile::tempdir().unwrap();
    let (drive, jump, jerk) = (40.0 / BLU, GAIN.sqrt(), 20_000.0 / BLU);
    let ramp = (drive - jump) / GAIN + GAIN / jerk;
    let wanted = 2.0 * ramp + (2000.0 - (drive + jump) * ramp) / drive;
    for method in ["bresenham", "ppc", "mindev", "cim", "dda", "dpm"] {
        for parts in [1, 20, 200] {
            let one = Straight { by: [2000 / parts, 0], feed: 2400.0, corner: Corner::Continuous };
            let moves = vec![one; usize::try_from(parts).unwrap()];
            let (report, trace) = simulation(&folder, method, &text(&moves), "20000mm/s3").run_traced().unwrap();
            assert!(report.failures().is_empty(), "{method} {parts}: {:?}", report.failures());
            assert_eq!(report.outcome.reached[0], 2000, "{method} {parts}");
            // Its phase rests while a block is taken over.
            let rests = if method == "bresenham" { parts } else { 0 };
            let got = (report.outcome.clocks as i64 - rests) as f64 / HZ;
            assert!((got - wanted).abs() < 0.002 * wanted, "{method} in {parts} blocks: {got} s, not {wanted} s");
            let av = trace.bits("pulse_source.s_curve.av").unwrap();
            let loaded = trace.bits("block.loaded").unwrap();
            let carried = (1..av.len()).filter(|&clock| loaded[clock] == 1 && av[clock] > 0).count();
            assert_eq!(carried > 0, parts > 1, "{method} in {parts} blocks: {carried}");
        }
    }
}

/// What an operator does ends a ramp over several blocks; each block after it still is what it is alone.
#[test]
fn a_chain_of_blocks_stops_at_every_block_and_holds_in_every_one() {
    let folder = tempfile::tempdir().unwrap();
    let moves = vec![Straight { by: [40, 0], feed: 2400.0, corner: Corner::Continuous }; 40];
    let plain = simulation(&folder, "ppc", &text(&moves), "20000mm/s3").run().unwrap().outcome.clocks;
    for clock in (10..plain).step_by(usize::try_from(plain / 12).unwrap()) {
        for script in [
            vec![format!("{clock}:hold"), format!("{}:resume", clock + 3000)],
            vec![
                format!("{clock}:override=200"),
                format!("{}:override=30", clock + 400),
                format!("{}:override=100", clock + 3000),
            ],
            vec![format!("{clock}:single"), format!("{}:start", clock + 4000), format!("{}:continuous", clock + 9000)],
        ] {
            let events: Vec<Timed> = script.iter().map(|event| Timed::parse(event).unwrap()).collect();
            let simulation = simulation(&folder, "ppc", &text(&moves), "20000mm/s3").events(events);
            let (report, trace) = simulation.run_traced().unwrap();
            assert_eq!(report.outcome.ending, Ending::Done, "{script:?}");
            assert!(report.failures().is_empty(), "{script:?} {:?}", report.failures());
            assert_eq!((report.outcome.reached[0], report.outcome.pulses[0]), (1600, 1600), "{script:?}");
            if script[0].ends_with("single") {
                // A block that is shorter than its braking distance ends faster.
                continue;
            }
            let v = trace.bits("pulse_source.v").unwrap();
            let [drive, start] = [4000.0, GAIN.sqrt()].map(|speed| speed * 2f64.powi(29) / HZ);
            let gain = drive * GAIN / HZ / 4000.0 * 1.05 + 1.0 + 0.005 * drive;
            for (at, pair) in v.windows(2).enumerate() {
                let [before, after] = [pair[0] as f64, pair[1] as f64];
                let low = before.min(after) <= 2.0 * start && before.max(after) <= 2.0 * start + gain;
                assert!((after - before).abs() <= gain || low, "{script:?}: {before} to {after} at clock {at}");
            }
        }
    }
}

#[test]
fn an_arc_is_no_faster_than_its_acceleration_towards_the_centre() {
    // Without a corner: from a line into half a circle of 100 BLU, and on.
    let program = "G21 G90 G64 G1 X40 F6000\nG3 X40 Y2 J1\nG1 X0\nM30\n";
    let folder = tempfile::tempdir().unwrap();
    for method in ["cim", "mindev", "ppc"] {
        let simulation = simulation(&folder, method, program, "none");
        let report = simulation.json(folder.path().join("r.json")).run().unwrap();
        assert!(report.failures().is_empty(), "{:?}", report.failures());
        let json: serde_json::Value =
            serde_json::from_slice(&std::fs::read(folder.path().join("r.json")).unwrap()).unwrap();
        let reached = |index: usize| json["blocks"][index]["feed"]["reached_mm_per_min"].as_f64().unwrap();
        // v² = A·R is 22.36 mm/s; cim and mindev have up to 1.41 BLU a pulse, in the mean of a circle 1.11, ppc down to 0.79.
        let most = 60.0 * (ACCEL * 1.0f64).sqrt();
        assert!(reached(1) < 1.13 * most, "{method}: {} of {most}", reached(1));
        assert!(reached(1) > 0.65 * most, "{method}: {} of {most}", reached(1));
        assert!(reached(0) > 1.3 * reached(1), "{method}: {} on the line", reached(0));
    }
}
