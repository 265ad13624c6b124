//! Many geometries at once come to what each comes to alone.

use stepwave::testbench::{Ending, Testbench};
use stepwave_kernel::Width;
use stepwave_kernel::engine::EngineKind;
use stepwave_models::{Choices, Preset, find};
use stepwave_nc::{Arc, Curve, Direction, Line};

fn lines(reach: i64) -> Vec<Curve> {
    let ends = (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| vec![x, y]));
    ends.filter_map(|to| Line::new(vec![0, 0], to).ok()).map(Curve::Line).collect()
}

fn circles(reach: i64) -> Vec<Curve> {
    let starts = (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| [x, y]));
    let directions = [Direction::Clockwise, Direction::CounterClockwise];
    let arcs = starts.flat_map(|start| directions.map(|direction| Arc::new(start, start, [0, 0], direction)));
    arcs.filter_map(Result::ok).map(Curve::Arc).collect()
}

/// Runs all curves in lanes and each alone, on hardware wide enough for the largest.
fn assert_lanes_equal_single_runs(model: &str, curves: &[Curve], choices: &Choices) {
    let model = find(model).unwrap();
    let widest = Testbench::new(model, curves.last().unwrap(), choices).unwrap();
    let together = widest.run_many(curves, 1 << 20).unwrap();
    assert_eq!(together.len(), curves.len());
    for (curve, lane) in curves.iter().zip(together) {
        let lane = lane.unwrap();
        let alone = widest.of(model, curve).unwrap().run(EngineKind::Word, &mut []).unwrap();
        let what = format!("{} {curve:?}", model.name);
        assert_eq!((lane.ending, lane.clocks), (Some(alone.ending), alone.clocks), "{what}");
        assert_eq!((lane.steps, lane.pulses), (alone.steps, alone.pulses), "{what}");
        assert_eq!(lane.reached, alone.reached, "{what}");
    }
}

fn width(bits: u64) -> Choices {
    Choices { width: Some(Width::new(bits).unwrap()), ..Choices::default() }
}

#[test]
fn lines_in_lanes_end_as_each_alone() {
    for model in ["ppc-line", "dda-line"] {
        assert_lanes_equal_single_runs(model, &lines(15), &width(4));
    }
}

#[test]
fn full_circles_of_several_blocks_in_lanes_end_as_each_alone() {
    let half = Choices { preset: Some(Preset::Half), ..width(5) };
    assert_lanes_equal_single_runs("dda-arc", &circles(9), &half);
    assert_lanes_equal_single_runs("ppc-arc", &circles(9), &width(5));
}

#[test]
fn lanes_stop_at_an_overflow_as_each_alone() {
    let narrow = Choices { widths: [("f".to_owned(), Width::new(4).unwrap())].into(), ..width(4) };
    assert_lanes_equal_single_runs("ppc-line", &lines(15), &narrow);
}

#[test]
fn lanes_that_come_to_rest_are_given_up_as_each_alone() {
    // In 11 bits a motion that has come to a stand is at rest long before 2^11 clocks are over.
    let arcs = circles(8);
    assert_lanes_equal_single_runs("dda-arc", &arcs, &width(11));
    let bench = Testbench::new(find("dda-arc").unwrap(), arcs.last().unwrap(), &width(11)).unwrap();
    let stalled = |bench: &Testbench| bench.run(EngineKind::Word, &mut []).unwrap().ending;
    let endings = arcs.iter().map(|arc| stalled(&bench.of(find("dda-arc").unwrap(), arc).unwrap()));
    let given_up = endings.filter(|ending| matches!(ending, Ending::Stalled { clocks } if *clocks < 1 << 11)).count();
    assert!(given_up > 0 && given_up < arcs.len(), "{given_up} of {}", arcs.len());
}
