//! Spacing of pulses and deviation from a uniform rate, against what the samples say one by one.

use proptest::prelude::*;
use stepwave::testbench::{Observer, ObserverError, PulseTrain, RateDeviation, SpacingWatch, Testbench};
use stepwave_engine::{EngineKind, Rows};
use stepwave_models::options::{BEATS, END_POINT, NORMALIZE, OVERRIDE, PRESET, WIDTH};
use stepwave_models::{Beats, EndPoint, Options, Preset};
use stepwave_nc::Curve;

use super::{arc, bench, line};

/// Keeps, for every sample, its clock, the strobes `loaded` and `stepped`, and whether each axis pulses.
struct Samples<'b>(&'b Testbench, Vec<(u64, bool, bool, Vec<bool>)>);

impl Observer for Samples<'_> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let machine = self.0.machine();
        for row in 0..rows.len() {
            let is = |net| rows.value(self.0.columns().index(net), row) != 0;
            let pulses = machine.pulses.iter().map(|port| is(port.net)).collect();
            self.1.push((rows.first_clock() + row as u64, is(machine.loaded.net), is(machine.stepped.net), pulses));
        }
        Ok(())
    }
}

/// What the watch says of a run, and what the samples say of it; `steps` are those of the whole line by its method.
fn both(model: &str, curve: &Curve, choices: &Options, engine: EngineKind, steps: Option<u64>) -> [Vec<PulseTrain>; 2] {
    let bench = bench(model, curve, choices);
    let (mut watch, mut samples) = (SpacingWatch::new(&bench, curve), Samples(&bench, Vec::new()));
    bench.run(engine, &mut [&mut watch, &mut samples]).unwrap();
    let travels = curve.from().iter().zip(curve.to()).map(|(from, to)| from.abs_diff(*to));
    let trains = travels.enumerate().map(|(axis, travel)| plain(&samples.1, axis, travel, steps)).collect();
    [watch.finish(), trains]
}

#[allow(clippy::cast_precision_loss)]
fn plain(samples: &[(u64, bool, bool, Vec<bool>)], axis: usize, travel: u64, steps: Option<u64>) -> PulseTrain {
    let clocks: Vec<u64> = samples.iter().filter(|sample| sample.3[axis]).map(|sample| sample.0).collect();
    let gaps: Vec<u64> = clocks.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let stepped: Vec<u64> = samples.iter().filter(|sample| sample.2).map(|sample| sample.0).collect();
    let loaded = samples.iter().find(|sample| sample.1).unwrap().0;
    let clocks_of_run = stepped.last().unwrap() - loaded;
    // After step t, at this clock, this many pulses have been made.
    let made = |clock: &u64| clocks.iter().filter(|pulse| *pulse <= clock).count() as u64;
    let mut worst = (0, 0);
    for (t, clock) in (1..).zip(&stepped) {
        let off = u64::abs_diff(made(clock) * steps.unwrap_or(0), t * travel);
        worst = if off > worst.0 { (off, t) } else { worst };
    }
    PulseTrain {
        spacing: gaps.iter().min().map(|least| [*least, *gaps.iter().max().unwrap()]),
        ideal_spacing: steps
            .filter(|_| travel > 0)
            .map(|steps| clocks_of_run as f64 * steps as f64 / (stepped.len() as f64 * travel as f64)),
        deviation: steps.map(|steps| RateDeviation { pulses: worst.0 as f64 / steps as f64, step: worst.1 }),
    }
}

fn check(model: &str, curve: &Curve, choices: &Options, engine: EngineKind, steps: Option<u64>) {
    let [watch, plain] = both(model, curve, choices, engine, steps);
    assert_eq!(watch, plain, "{model} {curve:?} {choices:?} on {}", engine.name());
}

#[test]
fn the_worked_line_of_the_pulse_multiplier() {
    for engine in EngineKind::ALL {
        let [watch, _] = both("dpm-line", &line(&[0, 0], &[5, 3]), &Options::default(), engine, Some(8));
        // X at 1, 3, 4, 5, 7: after clock 5 there are four pulses, where 5·5/8 = 3.125 should be. Y at 2, 4, 6: after
        // clock 6 there are three, where 6·3/8 = 2.25 should be.
        let x = PulseTrain {
            spacing: Some([1, 2]),
            ideal_spacing: Some(1.6),
            deviation: Some(RateDeviation { pulses: 0.875, step: 5 }),
        };
        let y = PulseTrain {
            spacing: Some([2, 2]),
            ideal_spacing: Some(8.0 / 3.0),
            deviation: Some(RateDeviation { pulses: 0.75, step: 6 }),
        };
        assert_eq!(watch, [x, y]);
    }
}

#[test]
fn every_line_model_takes_the_steps_of_its_method() {
    let half = |normalize| Options::default().with_all(&PRESET, Preset::Half).with(&NORMALIZE, normalize);
    let ends = |end_point| Options::default().with(&END_POINT, end_point);
    let usual = Options::default();
    for (from, to) in [([0, 0], [5, 3]), ([0, 0], [-40, 97]), ([7, -3], [7, 20]), ([1, 1], [0, 2]), ([0, 0], [-3, 0])] {
        let [a, b] = [0, 1].map(|axis| i64::abs_diff(from[axis], to[axis]));
        let cycle = (a.max(b) + 1).next_power_of_two();
        for engine in EngineKind::ALL {
            for beats in [Beats::Four, Beats::One] {
                let choices = usual.clone().with(&BEATS, beats);
                check("ppc-line", &line(&from, &to), &choices, engine, Some(a + b));
                for model in ["cim-line", "mindev-line", "vector-line"] {
                    check(model, &line(&from, &to), &choices, engine, Some(a.max(b)));
                }
            }
            let all = [usual.clone(), half(false), half(true), ends(EndPoint::Total), ends(EndPoint::Longest)];
            for choices in all {
                check("dda-line", &line(&from, &to), &choices, engine, Some(cycle));
            }
            check("bresenham", &line(&from, &to), &usual, engine, Some(a.max(b)));
            check("dpm-line", &line(&from, &to), &usual, engine, Some(cycle));
        }
    }
}

#[test]
fn arcs_have_a_spacing_but_no_uniform_rate() {
    for model in ["ppc-arc", "dda-arc", "cim-arc", "mindev-arc", "vector-arc"] {
        for (from, to, clockwise) in [([5, 0], [0, 5], false), ([-30, 40], [-30, 40], true)] {
            let choices = if model == "dda-arc" {
                Options::default().with_all(&PRESET, Preset::Half)
            } else {
                Options::default()
            };
            let [watch, plain] = both(model, &arc(from, to, [0, 0], clockwise), &choices, EngineKind::Word, None);
            assert_eq!(watch, plain, "{model}");
            assert!(watch.iter().all(|train| train.spacing.is_some() && train.deviation.is_none()));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn lines_of_any_size_at_any_override(
        to in prop::array::uniform3(-700i64..700),
        wider in 0u32..3,
        percent in prop::option::of(1u64..100),
    ) {
        prop_assume!(to != [0, 0, 0]);
        let longest = to.iter().map(|travel| travel.unsigned_abs()).max().unwrap();
        let cycle = (longest + 1).next_power_of_two() << wider;
        let width = stepwave_netlist::Width::new(u64::from(cycle.ilog2())).unwrap();
        let choices = Options::default().with_all(&WIDTH, width);
        check("dda-line", &line(&[0; 3], &to), &choices, EngineKind::Compiled, Some(cycle));
        let choices = choices.with(&OVERRIDE, percent);
        check("dpm-line", &line(&[0; 3], &to), &choices, EngineKind::Compiled, Some(cycle));
    }
}
