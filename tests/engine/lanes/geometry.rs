//! The models: many geometries of one hardware against the test bench, one geometry at a time.

use std::collections::BTreeMap;

use stepwave::testbench::{Ending, LaneOutcome, Observer, ObserverError, Testbench};
use stepwave_engine::{EngineKind, Rows};
use stepwave_models::options::{BEATS, CASCADE, END_POINT, NORMALIZE, ON_OVERFLOW, OVERRIDE, PRESET, RADIX, WIDTH};
use stepwave_models::{Beats, EndPoint, ModelError, Options, Preset, Radix, find};
use stepwave_nc::{Arc, Conic, Curve, Direction, Line};
use stepwave_netlist::{OnOverflow, Width};

const LIMIT: u64 = 1 << 20;

fn width(bits: u64) -> Width {
    Width::new(bits).unwrap()
}

/// The same hardware for every geometry: all widths are given.
pub(super) fn widths(bits: u64, position: u64) -> Options {
    let positions = ["x", "y"].map(|axis| (axis.to_owned(), width(position)));
    Options::default().with_all(&WIDTH, width(bits)).with_single(&WIDTH, BTreeMap::from(positions))
}

fn line(to: [i64; 2]) -> Curve {
    Curve::Line(Line::new(vec![0, 0], to.to_vec()).unwrap())
}

/// All lines of up to `bits` bits, in every quadrant.
fn lines(bits: u32) -> Vec<Curve> {
    let most = (1i64 << bits) - 1;
    let ends = (-most..=most).flat_map(|x| (-most..=most).map(move |y| [x, y]));
    ends.filter(|end| *end != [0, 0]).map(line).collect()
}

/// All arcs between points of the lattice on circles of up to this radius, in both directions.
fn arcs(radius: i64) -> Vec<Curve> {
    let mut arcs = Vec::new();
    for squared in 1..=radius * radius {
        let on = |[x, y]: &[i64; 2]| x * x + y * y == squared;
        let points: Vec<[i64; 2]> =
            (-radius..=radius).flat_map(|x| (-radius..=radius).map(move |y| [x, y])).filter(on).collect();
        for &from in &points {
            for &to in &points {
                for direction in [Direction::Clockwise, Direction::CounterClockwise] {
                    arcs.push(Curve::Arc(Arc::new(from, to, [0, 0], direction).unwrap()));
                }
            }
        }
    }
    arcs
}

/// Counts the samples in which a property does not hold.
struct Violations<'b> {
    bench: &'b Testbench,
    clocks: u64,
}

impl Observer for Violations<'_> {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let properties = &self.bench.design().netlist().properties;
        for row in 0..rows.len() {
            let mut columns = properties.iter().map(|property| self.bench.columns().index(property.never));
            self.clocks += u64::from(columns.any(|column| rows.value(column, row) == 1));
        }
        Ok(())
    }
}

fn alone(bench: &Testbench) -> LaneOutcome {
    let mut violations = Violations { bench, clocks: 0 };
    let outcome = bench.run(EngineKind::Word, &mut [&mut violations]).unwrap();
    LaneOutcome {
        ending: Some(outcome.ending),
        clocks: outcome.clocks,
        steps: outcome.steps,
        pulses: outcome.pulses,
        reached: outcome.reached,
        overflows: violations.clocks,
    }
}

/// Runs all at once and each alone; gives what they came to.
fn assert_each_as_alone(model: &str, curves: &[Curve], choices: &Options) -> Vec<LaneOutcome> {
    let model = find(model).unwrap();
    let bench = Testbench::new(model, &curves[0], choices).unwrap();
    let outcomes = bench.run_many(curves, LIMIT).unwrap();
    assert_eq!(outcomes.len(), curves.len());
    let compare = |(curve, outcome): (&Curve, Result<LaneOutcome, ModelError>)| {
        let single = Testbench::new(model, curve, choices).unwrap();
        assert_eq!(single.hardware().widths, bench.hardware().widths, "{curve:?}");
        let outcome = outcome.unwrap();
        assert_eq!(outcome, alone(&single), "{} {curve:?} {choices:?}", model.name);
        outcome
    };
    curves.iter().zip(outcomes).map(compare).collect()
}

fn all_done(outcomes: &[LaneOutcome]) -> bool {
    outcomes.iter().all(|outcome| outcome.ending == Some(Ending::Done) && outcome.overflows == 0)
}

#[test]
fn every_line_of_up_to_five_bits_in_all_quadrants_ends_as_alone() {
    let curves = lines(5);
    assert!(all_done(&assert_each_as_alone("dda-line", &curves, &widths(5, 7))));
    assert!(all_done(&assert_each_as_alone("ppc-line", &curves, &widths(5, 7))));
}

#[test]
fn every_line_of_the_pulse_multiplier_ends_as_alone() {
    let units = [
        widths(4, 6),
        widths(4, 6).with(&CASCADE, Some(width(2))),
        widths(8, 6).with(&RADIX, Radix::Decimal),
        widths(5, 6).with(&OVERRIDE, Some(35)),
    ];
    for choices in units {
        assert!(all_done(&assert_each_as_alone("dpm-line", &lines(4), &choices)), "{choices:?}");
    }
}

#[test]
fn every_line_of_the_methods_that_judge_both_axes_ends_as_alone() {
    for model in ["cim-line", "mindev-line", "vector-line"] {
        assert!(all_done(&assert_each_as_alone(model, &lines(4), &widths(4, 6))), "{model}");
        let one_beat = widths(5, 7).with(&BEATS, Beats::One);
        assert!(all_done(&assert_each_as_alone(model, &lines(4), &one_beat)), "{model}");
    }
}

#[test]
fn every_line_in_space_of_up_to_two_bits_ends_as_alone() {
    check_lines_in_space(2);
}

#[test]
#[ignore = "exhaustive"]
fn every_line_in_space_of_up_to_three_bits_ends_as_alone() {
    check_lines_in_space(3);
}

fn check_lines_in_space(bits: u64) {
    let most = (1i64 << bits) - 1;
    let sides = || -most..=most;
    let ends = sides().flat_map(|x| sides().flat_map(move |y| sides().map(move |z| vec![x, y, z])));
    let lines: Vec<_> = ends.filter_map(|to| Line::new(vec![0; 3], to).ok().map(Curve::Line)).collect();
    for model in ["ppc-line", "cim-line", "mindev-line"] {
        for beats in [Beats::One, Beats::Four] {
            let positions = ["x", "y", "z"].map(|axis| (axis.to_owned(), width(bits + 2)));
            let choices =
                Options::default().with_all(&WIDTH, width(bits)).with_single(&WIDTH, BTreeMap::from(positions));
            let choices = choices.with(&BEATS, beats);
            assert!(all_done(&assert_each_as_alone(model, &lines, &choices)), "{model}");
        }
    }
}

#[test]
fn every_lattice_arc_of_the_methods_that_judge_both_axes_ends_as_alone() {
    for model in ["cim-arc", "mindev-arc", "vector-arc"] {
        assert!(all_done(&assert_each_as_alone(model, &arcs(5), &widths(4, 8))), "{model}");
    }
}

#[test]
fn quarters_of_ellipses_of_one_hardware_end_as_alone() {
    let corners = |[a, b]: [i64; 2]| [[a, 0], [0, b], [-a, 0], [0, -b]];
    let quarters = (1..8).flat_map(|a| (1..8).map(move |b| [a, b])).flat_map(|axes| {
        let corners = corners(axes);
        (0..4).map(move |quarter| {
            let (from, to) = (corners[quarter], corners[(quarter + 1) % 4]);
            Curve::Conic(Conic::ellipse(axes, from, to, [0, 0], Direction::CounterClockwise).unwrap())
        })
    });
    let quarters: Vec<Curve> = quarters.collect();
    let wide = |names: &[&str], bits| names.iter().map(|name| ((*name).to_owned(), width(bits))).collect::<Vec<_>>();
    let with = |names: &[&str]| {
        let choices = widths(12, 6);
        let single = choices.of_single(&WIDTH).into_iter().chain(wide(names, 6)).collect();
        choices.with_single(&WIDTH, single)
    };
    assert!(all_done(&assert_each_as_alone("ppc-conic", &quarters, &with(&["ux", "uy", "e"]))));
    assert!(all_done(&assert_each_as_alone("cim-conic", &quarters, &with(&["alpha", "beta", "ex", "ey"]))));
}

#[test]
fn lines_with_other_choices_end_as_alone() {
    let curves = lines(3);
    for end_point in [EndPoint::Total, EndPoint::PerAxis, EndPoint::Longest] {
        let choices = widths(4, 6).with(&END_POINT, end_point);
        let normalized = choices.clone().with(&NORMALIZE, true).with_all(&PRESET, Preset::Half);
        assert_each_as_alone("dda-line", &curves, &normalized);
        let one_beat = choices.with(&BEATS, Beats::One);
        assert!(all_done(&assert_each_as_alone("ppc-line", &curves, &one_beat)));
    }
}

#[test]
fn every_lattice_arc_of_one_or_many_blocks_ends_as_alone() {
    let curves = arcs(5);
    assert!(all_done(&assert_each_as_alone("ppc-arc", &curves, &widths(5, 8))));
    for end_point in [EndPoint::PerAxis, EndPoint::Total] {
        let choices = widths(5, 8).with(&END_POINT, end_point);
        assert_each_as_alone("ppc-arc", &curves, &choices);
        assert_each_as_alone("dda-arc", &curves, &choices);
    }
}

#[test]
fn arcs_that_stall_are_given_up_at_the_clock_at_which_one_alone_is() {
    let stalls = widths(4, 8).with_all(&PRESET, Preset::Zero);
    let outcomes = assert_each_as_alone("dda-arc", &arcs(8), &stalls);
    let stalled = |outcome: &&LaneOutcome| matches!(outcome.ending, Some(Ending::Stalled { .. }));
    let count = outcomes.iter().filter(stalled).count();
    assert!(count > 0 && count < outcomes.len(), "{count} of {}", outcomes.len());
}

#[test]
fn overflows_trap_at_their_clock_or_are_counted() {
    for (mode, traps) in [(OnOverflow::Trap, true), (OnOverflow::Wrap, false), (OnOverflow::Saturate, false)] {
        // Positions of four bits, and lines of up to 15 to either side.
        let choices = widths(4, 4).with(&ON_OVERFLOW, mode);
        for model in ["dda-line", "ppc-line"] {
            let outcomes = assert_each_as_alone(model, &lines(4), &choices);
            let overflows = outcomes.iter().filter(|outcome| outcome.overflows > 0).count();
            assert!(overflows > 100 && overflows < outcomes.len(), "{overflows}");
            let trapped = outcomes.iter().filter(|outcome| outcome.ending == Some(Ending::Trapped)).count();
            assert_eq!(trapped, if traps { overflows } else { 0 });
        }
    }
}

#[test]
fn a_machine_with_registers_of_more_than_32_bits_ends_as_alone() {
    assert!(all_done(&assert_each_as_alone("ppc-line", &lines(3), &widths(40, 50))));
    assert!(all_done(&assert_each_as_alone("ppc-arc", &arcs(3), &widths(31, 33))));
}

#[test]
fn a_geometry_that_the_hardware_does_not_take_is_refused_and_the_others_run() {
    let bench = Testbench::new(find("ppc-line").unwrap(), &line([5, 3]), &widths(4, 6)).unwrap();
    let other_axes = Curve::Line(Line::new(vec![0; 3], vec![1, 2, 3]).unwrap());
    let curves = [line([5, 3]), line([16, 0]), arcs(1)[0].clone(), other_axes, line([-15, 15])];
    let outcomes = bench.run_many(&curves, LIMIT).unwrap();
    assert_eq!(outcomes[0].as_ref().unwrap().reached, [5, 3]);
    assert!(matches!(outcomes[1], Err(ModelError::DoesNotFit { value: 16, .. })), "{:?}", outcomes[1]);
    assert!(matches!(outcomes[2], Err(ModelError::Curve { .. })), "{:?}", outcomes[2]);
    assert!(matches!(outcomes[3], Err(ModelError::Curve { .. })), "{:?}", outcomes[3]);
    assert_eq!(outcomes[4].as_ref().unwrap().reached, [-15, 15]);
}

#[test]
fn a_geometry_that_takes_too_long_ends_at_the_limit() {
    let bench = Testbench::new(find("dda-line").unwrap(), &line([5, 3]), &widths(10, 12)).unwrap();
    let outcomes = bench.run_many(&[line([5, 3])], 500).unwrap();
    let outcome = outcomes[0].as_ref().unwrap();
    assert_eq!((outcome.ending, outcome.clocks, outcome.steps), (None, 500, 499));
}

#[test]
#[ignore = "exhaustive"]
fn arcs_that_come_to_rest_are_given_up_as_alone() {
    // In 11 bits a motion that has stall is at rest long before 2^11 clocks are over.
    // With `half`, the default, arcs with both ends on their circle never do.
    let stalls = widths(11, 13).with_all(&PRESET, Preset::Zero);
    let outcomes = assert_each_as_alone("dda-arc", &arcs(8), &stalls);
    let early = |outcome: &&LaneOutcome| matches!(outcome.ending, Some(Ending::Stalled { clocks }) if clocks < 1 << 11);
    let given_up = outcomes.iter().filter(early).count();
    assert!(given_up > 0 && given_up < outcomes.len(), "{given_up} of {}", outcomes.len());
}

#[test]
#[cfg(target_arch = "x86_64")]
fn long_runs_of_every_model_of_lines_and_arcs_go_over_to_native_code() {
    for (model, curve) in [
        ("dda-line", line([1023, 700])),
        ("ppc-line", line([1023, 700])),
        ("dda-arc", Curve::Arc(Arc::new([600, 0], [0, 600], [0, 0], Direction::CounterClockwise).unwrap())),
        ("ppc-arc", Curve::Arc(Arc::new([600, 0], [0, 600], [0, 0], Direction::CounterClockwise).unwrap())),
    ] {
        let bench = Testbench::new(find(model).unwrap(), &curve, &widths(12, 16)).unwrap();
        let lanes = bench.lanes(LIMIT).unwrap();
        let run = |count: usize| lanes.run(vec![&curve; count].into_iter(), |outcome| assert!(outcome.is_ok()));
        run(1);
        run(99);
        assert_eq!(lanes.program().is_native(), std::is_x86_feature_detected!("avx2"), "{model}");
        let measuring = bench.measuring_lanes(LIMIT).unwrap().unwrap();
        measuring.measure(vec![&curve; 99].into_iter(), |measured| assert!(measured.is_ok()));
        assert_eq!(measuring.program().is_native(), std::is_x86_feature_detected!("avx2"), "{model}, measured");
    }
}
