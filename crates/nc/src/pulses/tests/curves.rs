//! Free curves.

use super::*;
use crate::Controls;

fn cubic(from: Point, to: Point, points: [[f64; 2]; 2]) -> ToolMove {
    moved(from, to, SegmentShape::Bezier(Controls::Two(points)))
}

fn points(block: &PulseBlock) -> &[[i64; 2]] {
    let Curve::Spline(spline) = &block.curve else { panic!("no curve: {block:?}") };
    spline.points()
}

#[test]
fn control_points_are_rounded_and_each_curve_starts_where_the_one_before_ends() {
    let (first, second) = ([10.4, -3.6, 7.0], [20.6, 0.2, 7.0]);
    let moves = [
        cubic([0.0, 0.0, 7.0], first, [[4.5, 90.4], [-5.4, 2.6]]),
        moved(first, second, SegmentShape::Bezier(Controls::One([15.2, -40.7]))),
    ];
    let (mut rounder, mut out) = (Rounder::new(None), Vec::new());
    rounder.blocks(&moved([0.0; 3], [0.0, 0.0, 7.0], SegmentShape::Line), &mut out).unwrap();
    let apart = moves.each_ref().map(|of| rounder.blocks(of, &mut out).unwrap());
    assert_eq!(points(&out[1]), [[0, 0], [5, 90], [-5, 3], [10, -4]]);
    assert_eq!(points(&out[2]), [[10, -4], [15, -41], [21, 0]]);
    assert_eq!((out[2].from, out[2].to), ([10, -4, 7, 0, 0, 0, 0, 0, 0], [21, 0, 7, 0, 0, 0, 0, 0, 0]));
    assert_eq!((&out[1].axes[..], out[1].reach()[..3].to_vec()), (&[0, 1][..], vec![[-5, 10], [-4, 90], [7, 7]]));
    // That of the control point that moved farthest.
    let off = [f64::hypot(0.5, 0.4), f64::hypot(0.4, 0.4)];
    assert!(apart.iter().zip(off).all(|(apart, off)| (apart - off).abs() < 1e-9), "{apart:?}");
}

#[test]
fn a_curve_smaller_than_a_pulse_is_left_out_and_a_closed_one_is_not() {
    let small = cubic([0.0; 3], [0.3, 0.0, 0.0], [[0.4, 0.2], [-0.2, 0.4]]);
    assert!(blocks(&[small], None).is_empty());
    let closed = blocks(&[cubic([0.0; 3], [0.0; 3], [[90.0, 0.0], [0.0, 90.0]])], None);
    assert_eq!(closed.iter().map(points).collect::<Vec<_>>(), [[[0, 0], [90, 0], [0, 90], [0, 0]]]);
}

/// Closed curves with control points next to their start: a half rounds upwards, so a bow of half a BLU takes pulses on one side only.
#[test]
fn a_closed_curve_that_never_rounds_to_another_place_is_left_out() {
    let start = [3.2, -5.1];
    let place = |[x, y]: [f64; 2]| [start[0] + x, start[1] + y];
    let of = |controls: &[[f64; 2]]| match *controls {
        [only] => Controls::One(place(only)),
        [first, second] => Controls::Two([first, second].map(place)),
        _ => unreachable!(),
    };
    let left_out = |controls: &[[f64; 2]]| {
        let (mut rounder, mut out) = (Rounder::new(None), Vec::new());
        let at = [start[0], start[1], 0.0];
        rounder.blocks(&moved([0.0; 3], at, SegmentShape::Line), &mut out).unwrap();
        let apart = rounder.blocks(&moved(at, at, SegmentShape::Bezier(of(controls))), &mut out).unwrap();
        (out.len() == 1).then_some(apart)
    };
    // From (3, -5) to the farthest place of the bow of (0.2, -0.1): its middle, half as far as the control point.
    let goes = left_out(&[[0.0, -1.0]]).unwrap();
    assert!((goes - f64::hypot(0.2, 0.6)).abs() < 1e-9, "{goes}");
    assert!(left_out(&[[-1.0, -1.0]]).is_some() && left_out(&[[0.0, 1.0], [0.0, -1.0]]).is_some());
    assert!(left_out(&[[1.0, 0.0], [0.0, 1.0]]).is_some());
    assert!(left_out(&[[0.0, 1.0]]).is_none() && left_out(&[[-2.0, 0.0]]).is_none());
    assert!(left_out(&[[1.0, 0.0], [1.0, 0.0]]).is_none() && left_out(&[[0.0, 2.0], [0.0, -2.0]]).is_none());
}

#[test]
fn chords_of_a_curve_end_on_it_and_are_as_near_as_they_are_to_be() {
    let of = cubic([0.0; 3], [500.0, 100.0, 0.0], [[700.0, 900.0], [-200.0, -300.0]]);
    let curve = of.segment.bezier().unwrap();
    for tolerance in [0.5, 5.0] {
        let mut out = Vec::new();
        Rounder::new(None).chords(&of, tolerance, &mut out).unwrap();
        assert_eq!(out.last().map(|block| block.to[..2].to_vec()), Some(vec![500, 100]));
        assert!(out.windows(2).all(|pair| pair[0].to == pair[1].from) && out.len() > 4);
        for part in 0..=1000 {
            let [x, y] = curve.at(f64::from(part) / 1000.0);
            let off = |block: &PulseBlock| {
                let [from, to] = [block.from, block.to].map(|end| [end[0] as f64, end[1] as f64]);
                let along = [to[0] - from[0], to[1] - from[1]];
                let share = ((x - from[0]) * along[0] + (y - from[1]) * along[1]) / along[0].hypot(along[1]).powi(2);
                let share = share.clamp(0.0, 1.0);
                (x - from[0] - share * along[0]).hypot(y - from[1] - share * along[1])
            };
            let off = out.iter().map(off).fold(f64::INFINITY, f64::min);
            assert!(off <= tolerance + 0.5_f64.sqrt(), "{tolerance}: {off} at {part}");
        }
    }
}

#[test]
fn a_curve_alone_is_the_block_of_its_move() {
    let curve: Curve = Spline::new(SplineForm::Bezier, &[[0, 0], [90, 5], [-7, 3], [20, 1]]).unwrap().into();
    let block = PulseBlock::alone(&curve).unwrap();
    let again = blocks(&[block.of], None);
    assert_eq!(
        (&again[0].curve, &again[0].axes, again[0].from, again[0].to),
        (&curve, &block.axes, block.from, block.to)
    );
    assert!((block.length() - block.of.segment.length()).abs() < 1e-2);
    let other: Curve = Spline::new(SplineForm::Hermite, &[[0, 0], [90, 5], [20, 1], [-7, 3]]).unwrap().into();
    assert!(PulseBlock::alone(&other).is_none());
}
