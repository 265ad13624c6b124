//! Promises of path errors on arcs and conics whose ends lie off the ideal curve: an exact end is never blamed for where
//! it was asked for, and a path that is worse is.

use proptest::prelude::*;
use stepwave::testbench::{Ending, PathWatch, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::options::{END_POINT, FORM, ON_OVERFLOW};
use stepwave_models::{EndPoint, Form, OnOverflow, Options, Promise, catalogue, find};
use stepwave_nc::{Arc, Curve, Direction};

use super::{bench, widths};

/// How far a point about the origin is off the circle of this start, in BLU.
fn off(start: [i64; 2], point: [i64; 2]) -> f64 {
    let radius = |[x, y]: [i64; 2]| (x as f64).hypot(y as f64);
    (radius(point) - radius(start)).abs()
}

/// The path error of a run that must end at its end point.
fn error(bench: &Testbench, curve: &Curve) -> f64 {
    let mut path = PathWatch::new(bench, curve);
    let outcome = bench.run(EngineKind::Word, &mut [&mut path]).unwrap();
    assert_eq!((outcome.ending, &outcome.reached[..]), (Ending::Done, curve.to()), "{curve:?}");
    path.worst.unwrap().error
}

/// What the methods promise of arcs whose ends lie on the circle, from the literature.
const ARCS: [(&str, f64); 4] = [("ppc-arc", 1.0), ("mindev-arc", 0.5), ("vector-arc", 1.0), ("cim-arc", 1.0)];

/// Every arc from these starts to every point up to a BLU off the circle, both ways.
fn every_arc(starts: impl Iterator<Item = [i64; 2]>, mut check: impl FnMut(&Curve, f64)) {
    for from in starts {
        let reach = from[0].abs() + from[1].abs() + 2;
        for to in (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| [x, y])) {
            for direction in [Direction::Clockwise, Direction::CounterClockwise] {
                if let Ok(arc) = Arc::new(from, to, [0, 0], direction) {
                    check(&arc.into(), off(from, to));
                }
            }
        }
    }
}

#[test]
fn no_arc_that_ends_where_it_should_is_blamed_for_an_end_off_the_circle() {
    let [arcs, widened] = check_arcs(4);
    assert!(arcs > 500 && widened > 30, "{arcs} {widened}");
}

#[test]
#[ignore = "exhaustive"]
fn no_arc_from_up_to_8_is_blamed_for_an_end_off_the_circle() {
    let [arcs, widened] = check_arcs(8);
    assert!(arcs > 10_000 && widened > 300, "{arcs} {widened}");
}

/// Arcs from starts no farther out than this along an axis, in BLU: their number, and that of paths farther off than the method's bound.
fn check_arcs(reach: i64) -> [u32; 2] {
    let (mut arcs, mut widened) = (0, 0);
    let starts = (1..=reach).flat_map(|x| (0..=reach).map(move |y| [x, -y]));
    every_arc(starts, |curve, off| {
        for (model, method) in ARCS {
            let bench = bench(model, curve, &Options::default());
            let promise = Promise::of(bench.hardware().error_bound, curve).unwrap();
            assert!((promise.bound() - method - off).abs() < 1e-12, "{model} {curve:?}");
            let error = error(&bench, curve);
            assert!(promise.is_kept(error), "{model} {curve:?}: {error} for {promise}");
            arcs += 1;
            widened += u32::from(error > method + 1e-9);
        }
    });
    [arcs, widened]
}

proptest! {
    #[test]
    fn nor_are_great_ones(x in -900i64..900, y in -900i64..900, turn in 0.0f64..6.2, aside in -0.99f64..0.99, ccw: bool) {
        let radius = (x as f64).hypot(y as f64);
        let place = turn + (y as f64).atan2(x as f64);
        // Within a thousand.
        #[allow(clippy::cast_possible_truncation)]
        let to = [(radius + aside) * place.cos(), (radius + aside) * place.sin()].map(|c| c.round() as i64);
        let direction = if ccw { Direction::CounterClockwise } else { Direction::Clockwise };
        let Ok(arc) = Arc::new([x, y], to, [0, 0], direction) else { return Ok(()) };
        let curve = arc.into();
        for (model, method) in ARCS {
            let error = error(&bench(model, &curve, &Options::default()), &curve);
            prop_assert!(error <= method + off([x, y], to) + 1e-9, "{model} {curve:?}: {error}");
        }
    }
}

/// An end off the circle excuses that distance and nothing more: a deviation register that is too narrow and wraps.
#[test]
fn a_path_that_is_farther_off_than_its_end_is_blamed() {
    let mut blamed = 0;
    every_arc([[9, 0], [8, -3], [7, 6]].into_iter(), |curve, _| {
        let narrow = widths(&[("f", 4)]).with(&ON_OVERFLOW, OnOverflow::Wrap);
        let bench = Testbench::loading(find("mindev-arc").unwrap(), curve, &narrow).unwrap().limited(100_000);
        let mut path = PathWatch::new(&bench, curve);
        bench.run(EngineKind::Word, &mut [&mut path]).unwrap();
        let promise = Promise::of(bench.hardware().error_bound, curve).unwrap();
        let error = path.worst.unwrap().error;
        assert_eq!(
            promise.is_kept(error),
            error <= 0.5 + off([curve.from()[0], curve.from()[1]], [curve.to()[0], curve.to()[1]]) + 1e-9
        );
        blamed += u32::from(!promise.is_kept(error));
    });
    assert!(blamed > 20, "{blamed}");
}

#[test]
fn a_curve_whose_ends_lie_on_it_has_the_bound_of_its_method() {
    let curve: Curve = Arc::new([3, 4], [-5, 0], [0, 0], Direction::Clockwise).unwrap().into();
    for (model, method) in ARCS {
        let hardware = find(model).unwrap().plan(&curve, &Options::default()).unwrap();
        let promise = Promise::of(hardware.error_bound, &curve).unwrap();
        assert_eq!((promise.bound(), promise.ends()), (method, 0.0), "{model}");
    }
    let off: Curve = Arc::new([4, 0], [1, -3], [0, 0], Direction::Clockwise).unwrap().into();
    let promise = Promise::of(Some(0.5), &off).unwrap();
    assert_eq!(promise.to_string(), "1.338 BLU (0.5 and the 0.838 that an end is off the curve)");
    assert_eq!(Promise::of(None, &off), None);
}

/// Both schemes of the end point: the total counter misses some of these ends, the others keep the promise.
#[test]
fn the_end_point_scheme_changes_nothing() {
    let models = catalogue();
    let known = models.iter().filter(|model| ["ppc-arc", "mindev-arc", "vector-arc"].contains(&model.name));
    for model in known {
        every_arc([[5, 0], [4, -2]].into_iter(), |curve, _| {
            let choices = Options::default().with(&END_POINT, EndPoint::Total).with(&FORM, None::<Form>);
            let bench = bench(model.name, curve, &choices).limited(10_000);
            let mut path = PathWatch::new(&bench, curve);
            let outcome = bench.run(EngineKind::Word, &mut [&mut path]).unwrap();
            let promise = Promise::of(bench.hardware().error_bound, curve).unwrap();
            let exact = outcome.reached == curve.to();
            assert!(!exact || promise.is_kept(path.worst.unwrap().error), "{} {curve:?}", model.name);
        });
    }
}
