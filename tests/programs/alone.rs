//! The machines of whole programs with one move alone: over a line, an arc or a helix they are models like any other.

use proptest::prelude::*;
use stepwave::testbench::{Ending, Observer, ObserverError, Outcome, OverflowWatch, PathWatch, Step, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::options::{NORMALIZE, WIDTH};
use stepwave_models::{Model, OnOverflow, Options, catalogue, find, options::ON_OVERFLOW};
use stepwave_nc::{Arc, Curve, Direction, Helix, Line, PulseBlock};

use super::machines::reference;

/// Where a machine is after each step, and when.
#[derive(Default, PartialEq, Debug)]
struct Path {
    at: Vec<Vec<i64>>,
    clocks: Vec<u64>,
}

impl Observer for Path {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        self.at.push(step.position.clone());
        self.clocks.push(step.clock);
        Ok(())
    }
}

/// The run of a curve, the same on every engine: its path with the start, what it came to, its greatest path error.
fn run(model: &Model, curve: &Curve, options: &Options) -> (Testbench, Path, Outcome, f64) {
    let bench = Testbench::new(model, curve, options).unwrap();
    let ran = [EngineKind::Gates, EngineKind::Word, EngineKind::Compiled].map(|engine| {
        let (mut path, mut error, mut overflow) =
            (Path::default(), PathWatch::new(&bench, curve), OverflowWatch::new(&bench));
        let outcome = bench.run(engine, &mut [&mut path, &mut error, &mut overflow]).unwrap();
        (path, outcome, error.worst.map_or(0.0, |worst| worst.error), overflow.count)
    });
    assert!(ran[0] == ran[1] && ran[1] == ran[2], "{} {curve:?}", model.name);
    let [(path, outcome, error, _), ..] = ran;
    (bench, path, outcome, error)
}

fn arc_of(center: [i64; 2], radius: i64, [axis, quarters]: [usize; 2], clockwise: bool) -> Arc {
    let about = |axis: usize| [[radius, 0], [0, radius], [-radius, 0], [0, -radius]][axis % 4];
    let at = |place: [i64; 2]| [center[0] + place[0], center[1] + place[1]];
    let end = about(if clockwise { axis + 4 - quarters } else { axis + quarters });
    let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
    Arc::new(at(about(axis)), at(end), center, direction).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    #[test]
    fn a_move_alone_follows_the_recurrence_of_its_method(
        from in [-50i64..50, -50..50],
        travel in [-40i64..40, -40..40],
        radius in 1i64..30,
        turn in [0usize..4, 1..5],
        clockwise: bool,
        normalize: bool,
    ) {
        let line = Line::new(from.to_vec(), vec![from[0] + travel[0], from[1] + travel[1]]).ok().map(Curve::Line);
        let arc = Curve::Arc(arc_of(from, radius, turn, clockwise));
        for model in catalogue().machines() {
            let normalize = normalize && model.takes(&NORMALIZE);
            let options = Options::default().with(&NORMALIZE, normalize.then_some(true));
            let curves = line.iter().chain(model.moves().unwrap().arcs().then_some(&arc));
            for curve in curves {
                let (bench, path, outcome, error) = run(model, curve, &options);
                prop_assert_eq!(outcome.ending, Ending::Done);
                prop_assert_eq!(&outcome.reached[..], curve.to(), "{} {:?}", model.name, curve);
                prop_assert_eq!(&outcome.counters[..], curve.to());
                prop_assert_eq!(&path.at[0][..], curve.from());
                if let Some(bound) = bench.hardware().error_bound {
                    prop_assert!(error <= bound + 1e-9, "{}: {error} of {curve:?}", model.name);
                }
                let bits = ["xi", "a", "jvx", "q", "events", "accx"].map(|name| bench.hardware().bits_of(name));
                let bits = bits.into_iter().max().unwrap();
                let block = PulseBlock::alone(curve).unwrap();
                let wanted = reference(model.method_name(), &block, bits, normalize, path.at.len() - 1);
                let steps: Vec<[i64; 2]> =
                    path.at[1..].iter().map(|at| <[i64; 2]>::try_from(at.as_slice()).unwrap()).collect();
                prop_assert_eq!(steps, wanted, "{} {:?}", model.name, curve);
            }
        }
    }

    #[test]
    fn a_third_axis_follows_a_line_and_a_helix_alone(
        from in [-50i64..50, -50..50, -50..50],
        travel in [-40i64..40, -40..40, -40..40],
        radius in 5i64..60,
        turn in [0usize..4, 1..5],
        part in -90i64..90,
    ) {
        let end: Vec<i64> = from.iter().zip(travel).map(|(from, travel)| from + travel).collect();
        let line = Line::new(from.to_vec(), end).ok().map(Curve::Line);
        let arc = arc_of([from[0], from[1]], radius, turn, false);
        let [[x, y], [to_x, to_y]] = [arc.start(), arc.end()].map(|[x, y]| [x + from[0], y + from[1]]);
        // Up to nine tenths of what a third axis can follow.
        let climb = part * radius * turn[1] as i64 / 100;
        let helix = Helix::new([x, y, from[2]], [to_x, to_y, from[2] + climb], arc.center(), Direction::CounterClockwise);
        let helix = helix.ok().map(Curve::Helix);
        for model in catalogue().machines() {
            let arcs = model.moves().unwrap().arcs();
            for curve in line.iter().chain(helix.as_ref().filter(|_| arcs)) {
                let (bench, path, outcome, error) = run(model, curve, &Options::default());
                prop_assert_eq!(outcome.ending, Ending::Done);
                prop_assert_eq!(&outcome.reached[..], curve.to(), "{} {:?}", model.name, curve);
                prop_assert_eq!(&path.at[0][..], curve.from());
                // A program has a steep helix in pieces; alone it is one, of which nothing is promised.
                let bound = bench.hardware().error_bound.unwrap_or(if curve.axes() == 2 { 2.5 } else { f64::INFINITY });
                prop_assert!(error <= bound + 1e-9, "{}: {error} of {curve:?}", model.name);
            }
        }
    }
}

#[test]
fn a_step_is_every_second_clock_also_from_one_sector_to_the_next() {
    let circle = Curve::Arc(arc_of([3, -4], 20, [0, 4], false));
    for model in ["ppc-machine", "cim-machine", "mindev-machine"] {
        let (_, path, ..) = run(find(model).unwrap(), &circle, &Options::default());
        assert!(path.clocks[1..].windows(2).all(|pair| pair[1] - pair[0] == 2), "{model}: {:?}", path.clocks);
    }
}

#[test]
fn a_trap_at_the_clock_that_loads_the_next_sector_ends_the_run_there() {
    // The first step of a block overflows x, at the clock at which the buffer takes the block after it.
    let arc = Curve::Arc(arc_of([0, 0], 7, [1, 4], false));
    let model = find("ppc-machine").unwrap();
    for bits in 2..5 {
        let width = stepwave_netlist::Width::new(bits).unwrap();
        let narrow = Options::default().with_one(&WIDTH, "x", width);
        let Ok(bench) = Testbench::new(model, &arc, &narrow) else { continue };
        for engine in [EngineKind::Gates, EngineKind::Word, EngineKind::Compiled] {
            let mut overflow = OverflowWatch::new(&bench);
            let outcome = bench.run(engine, &mut [&mut overflow]).unwrap();
            let first = overflow.events().first().map(|event| event.clock());
            if let Some(first) = first {
                assert_eq!((outcome.ending, outcome.clocks), (Ending::Trapped, first), "{bits} bits");
            }
        }
    }
}

#[test]
fn a_run_alone_that_comes_to_no_end_is_reported() {
    // Without room for the coordinates the end counters never come to 0.
    let arc = Curve::Arc(arc_of([0, 0], 12, [0, 1], false));
    for model in ["ppc-machine", "cim-machine", "mindev-machine", "dda-machine"] {
        let narrow = Options::default().with(&ON_OVERFLOW, OnOverflow::Wrap);
        let narrow = narrow.with_all(&WIDTH, stepwave_netlist::Width::new(3).ok());
        let bench = Testbench::loading(find(model).unwrap(), &arc, &narrow).unwrap().limited_to(None);
        let outcome = bench.run(EngineKind::Compiled, &mut []).unwrap();
        assert!(outcome.clocks < 1 << 20, "{model}: {outcome:?}");
    }
}
