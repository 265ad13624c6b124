//! The pair of integrators that draws a curve.

use stepwave_nc::{Arc, Curve, Direction};
use stepwave_netlist::Width;
use stepwave_netlist::dsl::Scope;

use super::super::{Block, IntegratorPair, Normalizer, PairSide};
use super::bench::{Bench, on_every_engine};
use crate::options::{END_POINT, WIDTH};
use crate::{EndPoint, Hardware, Options, find};

fn hardware(end_point: EndPoint) -> Hardware {
    let arc = Curve::Arc(Arc::new([5, 0], [0, 5], [0, 0], Direction::CounterClockwise).unwrap());
    let options = Options::default().with(&END_POINT, end_point).with_all(&WIDTH, Width::new(4).unwrap());
    find("dda-arc").unwrap().plan(&arc, &options).unwrap()
}

/// A pair of 4 bits; how a pulse corrects are inputs.
fn pair(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let normalized = Normalizer::new(m, &block, false).close(&[], 1);
    let side = |axis: &str| PairSide {
        negative: m.input(&format!("negative_{axis}"), 1),
        raised: m.input(&format!("raised_{axis}"), 1),
        unit: m.input(&format!("unit_{axis}"), 3),
    };
    let sides = [side("x"), side("y")];
    let pair = IntegratorPair::new(m, &block, hardware);
    let last = pair.close(hardware, normalized, sides);
    block.close(normalized.ready, normalized.run, last);
}

/// Loads the words and lets `clocks` iterations pass.
fn run(bench: &mut Bench, words: &[(&str, i128)], clocks: usize) {
    bench.clock(&[words, &[("load", 1), ("preset_position", 1)]].concat());
    bench.clock(&[("load", 0)]);
    (0..clocks).for_each(|_| bench.clock(&[]));
}

#[test]
fn a_pulse_of_one_axis_corrects_the_integrand_of_the_other() {
    let hardware = hardware(EndPoint::PerAxis);
    on_every_engine(
        |m| pair(m, &hardware),
        |bench| {
            for (unit, raised) in (0..=5).flat_map(|unit| [(unit, 0), (unit, 1)]) {
                // 8 + 8 overflows, 8 + 0 does not; the other axis would be corrected by 7.
                for (x_pulses, corrected, kept) in [(true, "y", "x"), (false, "x", "y")] {
                    let [jrx, jry] = if x_pulses { [8, 0] } else { [0, 8] };
                    let (own_unit, own_raised) = (format!("unit_{corrected}"), format!("raised_{corrected}"));
                    let other_unit = format!("unit_{kept}");
                    let words = [
                        ("jvx_in", 8),
                        ("jvy_in", 8),
                        ("jrx_in", jrx),
                        ("jry_in", jry),
                        ("ex_in", 3),
                        ("ey_in", 3),
                        (&own_unit, unit),
                        (&own_raised, raised),
                        (&other_unit, 7),
                    ];
                    run(bench, &words, 1);
                    let by = if raised == 1 { unit } else { -unit };
                    assert_eq!(bench.value(&format!("jv{corrected}")), 8 + by);
                    assert_eq!(bench.value(&format!("jv{kept}")), 8);
                    assert_eq!([bench.value("dx"), bench.value("dy")], if x_pulses { [1, 0] } else { [0, 1] });
                }
            }
        },
    );
}

#[test]
fn an_exhausted_axis_freezes_and_the_other_goes_on_to_its_end() {
    let hardware = hardware(EndPoint::PerAxis);
    on_every_engine(
        |m| pair(m, &hardware),
        |bench| {
            let words = [("jvx_in", 12), ("jvy_in", 9), ("negative_y", 1), ("ex_in", 1), ("ey_in", 2)];
            for (clocks, [jrx, jry, ex, ey], done) in [
                (1, [12, 9, 1, 2], 0),
                (2, [8, 2, 0, 1], 0),
                (3, [8, 11, 0, 1], 0),
                (4, [8, 4, 0, 0], 1),
                (5, [8, 4, 0, 0], 1),
            ] {
                run(bench, &words, clocks);
                let values = ["jrx", "jry", "ex", "ey"].map(|name| bench.value(name));
                assert_eq!((values, bench.value("done")), ([jrx, jry, ex, ey], done), "after {clocks}");
            }
            assert_eq!([bench.value("x"), bench.value("y")], [1, -2]);
        },
    );
}

#[test]
fn one_counter_counts_the_pulses_of_both_and_stops_at_0() {
    let hardware = hardware(EndPoint::Total);
    on_every_engine(
        |m| pair(m, &hardware),
        |bench| {
            // Both overflow at every second iteration.
            let words = [("jvx_in", 8), ("jvy_in", 8), ("e_in", 3)];
            for (clocks, e, done) in [(1, 3, 0), (2, 1, 0), (3, 1, 0), (4, 0, 1)] {
                run(bench, &words, clocks);
                assert_eq!([bench.value("e"), bench.value("done")], [e, done], "after {clocks}");
            }
        },
    );
}
