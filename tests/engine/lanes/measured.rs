//! What is measured in lanes is what is measured of each run alone, to the bit.

use proptest::prelude::*;
use stepwave::testbench::{Ending, Measured, Observer, ObserverError, Step, Testbench};
use stepwave_engine::{EngineKind, Rows};
use stepwave_models::options::{NORMALIZE, ON_OVERFLOW, PRESET};
use stepwave_models::{CurveKind, Model, Options, Preset, catalogue, find};
use stepwave_nc::{Arc, Curve, Direction, Line};
use stepwave_netlist::OnOverflow;

use super::geometry::widths;

use crate::engine::random::config;

const LIMIT: u64 = 1 << 20;
/// Far more than what is not endless takes in 7 bits.
const SHORT: u64 = 1 << 14;

/// The models of this kind of curve.
fn models(kind: fn(&CurveKind) -> bool) -> impl Iterator<Item = &'static Model> {
    catalogue().iter().collect::<Vec<_>>().into_iter().filter(move |model| kind(&model.curve()))
}

/// Runs all curves of one hardware in lanes, and wants of each what it comes to alone; gives how many had to be run
/// alone anyway.
fn assert_measured_as_alone(model: &Model, curves: &[Curve], choices: &Options, limit: u64) -> usize {
    let Ok(hardware) = model.plan(&curves[0], choices) else { return 0 };
    let bench = Testbench::of_hardware(model, hardware).unwrap();
    let lanes = bench.measuring_lanes(limit).unwrap();
    // A machine with a buffer takes its geometry by a handshake, which lanes do not have.
    assert_eq!(lanes.is_none(), bench.machine().buffer.is_some(), "{}", model.name);
    let Some(lanes) = lanes else { return 0 };
    let mut all = Vec::new();
    lanes.measure(curves.iter(), |measured| all.push(measured));
    assert_eq!(all.len(), curves.len());
    let mut alone = 0;
    for (curve, measured) in curves.iter().zip(all) {
        let single = bench.of(model, curve).and_then(|single| {
            measured.clone()?;
            Ok(single)
        });
        match (measured, single) {
            (Ok(Some(measured)), Ok(single)) => {
                let expected = single.measure(curve, limit).unwrap();
                assert_eq!(measured, expected, "{} {curve:?} {choices:?}", model.name);
            }
            (Ok(None), Ok(_)) => alone += 1,
            (Err(_), Err(_)) => {}
            (measured, single) => panic!("{} {curve:?}: {measured:?}, alone {:?}", model.name, single.err()),
        }
    }
    alone
}

fn line(from: [i64; 2], to: [i64; 2]) -> Option<Curve> {
    Line::new(from.to_vec(), to.to_vec()).ok().map(Into::into)
}

/// Options of which each model takes what it has.
fn choices_of(model: &Model, seed: u8, bits: u64, position: u64) -> Options {
    let mut choices = widths(bits, position);
    if model.takes(&PRESET) {
        let preset = [None, Some(Preset::Half), Some(Preset::Full)][usize::from(seed) % 3];
        choices = choices.with_all(&PRESET, preset);
    }
    let modes = [OnOverflow::Trap, OnOverflow::Wrap, OnOverflow::Saturate];
    choices
        .with(&NORMALIZE, model.takes(&NORMALIZE) && seed % 2 == 1)
        .with(&ON_OVERFLOW, modes.get(usize::from(seed / 6)).copied())
}

proptest! {
    #![proptest_config(config(4))]

    #[test]
    fn random_lines_of_every_model_are_measured_as_alone(
        ends in prop::collection::vec((prop::array::uniform2(-60i64..60), prop::array::uniform2(-60i64..60)), 1..60),
        seed in 0u8..18,
    ) {
        let lines: Vec<Curve> = ends.into_iter().filter_map(|(from, to)| line(from, to)).collect();
        prop_assume!(!lines.is_empty());
        for model in models(|kind| matches!(kind, CurveKind::Line { .. })) {
            let alone = assert_measured_as_alone(model, &lines, &choices_of(model, seed, 7, 8), SHORT);
            prop_assert_eq!(alone, 0, "{}", model.name);
            // Positions that leave their counters: what wraps or saturates must be run alone, and says so.
            assert_measured_as_alone(model, &lines, &choices_of(model, seed, 7, 6), SHORT);
        }
    }

    #[test]
    fn random_arcs_of_every_model_are_measured_as_alone(
        starts in prop::collection::vec((prop::array::uniform2(-20i64..20), prop::array::uniform2(-9i64..9), 0usize..200), 1..60),
        seed in 0u8..18,
    ) {
        let arc = |([x, y], center, end): ([i64; 2], [i64; 2], usize)| {
            let near: Vec<[i64; 2]> = (-21..=21)
                .flat_map(|x| (-21..=21).map(move |y| [x, y]))
                .filter(|[p, q]| ((p * p + q * q) as f64).sqrt() - ((x * x + y * y) as f64).sqrt() <= 1.0)
                .filter(|[p, q]| ((p * p + q * q) as f64).sqrt() - ((x * x + y * y) as f64).sqrt() >= -1.0)
                .collect();
            let place = |[x, y]: [i64; 2]| [x + center[0], y + center[1]];
            let to = near[end % near.len()];
            let direction = if end % 2 == 0 { Direction::Clockwise } else { Direction::CounterClockwise };
            Arc::new(place([x, y]), place(to), center, direction).ok().map(Into::into)
        };
        let arcs: Vec<Curve> = starts.into_iter().filter_map(arc).collect();
        prop_assume!(!arcs.is_empty());
        for model in models(|kind| *kind == CurveKind::Arc) {
            let choices = choices_of(model, seed, 6, 8);
            let alone = assert_measured_as_alone(model, &arcs, &choices, SHORT);
            let traps = choices.get(&ON_OVERFLOW).copied().is_none_or(|mode| mode == OnOverflow::Trap);
            prop_assert!(alone == 0 || !traps, "{}: {alone}", model.name);
            assert_measured_as_alone(model, &arcs, &choices_of(model, seed, 6, 5), SHORT);
        }
    }
}

#[test]
fn wide_machines_are_measured_as_alone() {
    let lines: Vec<Curve> =
        [[60_000, 41_113], [-8_191, 65_535], [1, -1]].into_iter().filter_map(|to| line([0, 0], to)).collect();
    let circle = |radius: i64, clockwise: bool| {
        let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
        Arc::new([radius, 0], [radius, 0], [0, 0], direction).ok().map(Into::into)
    };
    let circles: Vec<Curve> = [(8_000, true), (30_000, false), (5, true)]
        .into_iter()
        .filter_map(|(r, clockwise)| circle(r, clockwise))
        .collect();
    for (name, curves) in [("dda-line", &lines), ("mindev-line", &lines), ("dda-arc", &circles), ("ppc-arc", &circles)]
    {
        assert_eq!(assert_measured_as_alone(find(name).unwrap(), curves, &widths(17, 19), LIMIT), 0, "{name}");
    }
    // Sums that 32 bits might not hold.
    for (name, curves) in [("ppc-arc", &circles[..1]), ("mindev-arc", &circles[..1])] {
        assert_eq!(assert_measured_as_alone(find(name).unwrap(), curves, &widths(14, 15), LIMIT), 0, "{name}");
    }
}

/// Measures by itself, row by row of the step table and sample by sample.
#[derive(Default)]
struct Plain {
    curve: Option<Curve>,
    pulses: Vec<usize>,
    errors: Vec<f64>,
    at: Vec<Vec<u64>>,
}

impl Observer for Plain {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        self.at.resize(self.pulses.len(), Vec::new());
        for row in 0..rows.len() {
            for (axis, &column) in self.pulses.iter().enumerate() {
                if rows.value(column, row) != 0 {
                    self.at[axis].push(rows.first_clock() + row as u64);
                }
            }
        }
        Ok(())
    }

    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        let curve = self.curve.as_ref().unwrap();
        self.errors.extend((step.number > 0).then(|| curve.deviation(&step.position)));
        Ok(())
    }
}

#[test]
fn mean_error_and_spacing_are_those_of_the_step_table_and_the_pulses() {
    let arc = Arc::new([9, 4], [-4, 9], [0, 0], Direction::CounterClockwise).unwrap();
    for (name, curve) in [
        ("dda-line", line([3, -2], [-20, 11]).unwrap()),
        ("ppc-line", line([0, 0], [13, 21]).unwrap()),
        ("dda-line", Line::new(vec![0; 3], vec![9, 5, 3]).unwrap().into()),
        ("ppc-arc", arc.into()),
        ("dda-arc", arc.into()),
    ] {
        let bench = Testbench::new(find(name).unwrap(), &curve, &Options::default()).unwrap();
        let Measured { ending, greatest, mean, spacing, .. } = bench.measure(&curve, LIMIT).unwrap();
        let pulses = bench.machine().pulses.iter().map(|port| bench.columns().index(port.net)).collect();
        let mut plain = Plain { curve: Some(curve.clone()), pulses, ..Plain::default() };
        bench.run(EngineKind::Gates, &mut [&mut plain]).unwrap();
        assert_eq!(ending, Some(Ending::Done));
        let sum: f64 = plain.errors.iter().sum();
        assert!((mean.unwrap() - sum / plain.errors.len() as f64).abs() < 1e-5, "{name}");
        assert_eq!(greatest, plain.errors.iter().copied().reduce(f64::max), "{name}");
        for (spacing, at) in spacing.iter().zip(&plain.at) {
            let gaps: Vec<u64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let expected = gaps.iter().min().zip(gaps.iter().max()).map(|(least, most)| [*least, *most]);
            assert_eq!(*spacing, expected, "{name} {at:?}");
        }
    }
}

#[test]
fn a_run_that_takes_too_long_is_reported_in_lanes_and_alone() {
    let curve = line([0, 0], [100, 77]).unwrap();
    let model = find("dda-line").unwrap();
    let hardware = model.plan(&curve, &Options::default()).unwrap();
    let bench = Testbench::of_hardware(model, hardware).unwrap();
    for (limit, ends) in [(128, false), (129, true), (130, true), (5, false)] {
        let alone = bench.of(model, &curve).unwrap().measure(&curve, limit).unwrap();
        let lanes = bench.measuring_lanes(limit).unwrap().unwrap();
        lanes.measure([&curve].into_iter(), |measured| {
            assert_eq!(measured.unwrap().unwrap().ending, alone.ending, "{limit}");
        });
        assert_eq!(alone.ending.is_some(), ends, "{limit}");
    }
}
