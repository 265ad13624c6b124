use super::*;
use crate::{PathControl, Side};

mod curves;
mod tiny;

fn moved(from: Point, to: Point, shape: SegmentShape) -> ToolMove {
    let segment = Segment { from, to, shape };
    let place = Place { line: 1, number: None };
    ToolMove {
        place,
        segment,
        feed: Feed::Rapid,
        cause: Cause::Programmed,
        programmed: segment,
        side: Side::On,
        path: PathControl::default(),
        others: Others::default(),
        chord: false,
    }
}

fn blocks(moves: &[ToolMove], chords: Option<f64>) -> Vec<PulseBlock> {
    let (mut rounder, mut out) = (Rounder::new(chords), Vec::new());
    moves.iter().for_each(|of| {
        rounder.blocks(of, &mut out).unwrap_or_else(|error| panic!("{error}"));
    });
    out
}

fn circle(center: [f64; 2], direction: Direction) -> SegmentShape {
    SegmentShape::Arc { plane: Plane::Xy, center, direction }
}

#[test]
fn roundings_do_not_add_up() {
    let moves: Vec<ToolMove> = (0..10)
        .map(|i| moved([f64::from(i) * 0.4, 0.0, 0.0], [f64::from(i + 1) * 0.4, 0.0, 0.0], SegmentShape::Line))
        .collect();
    let blocks = blocks(&moves, None);
    assert_eq!(blocks.last().map(|block| block.to), Some([4, 0, 0, 0, 0, 0, 0, 0, 0]));
    assert!(blocks.windows(2).all(|pair| pair[0].to == pair[1].from));
    assert_eq!(blocks.len(), 4); // the others are shorter than a pulse
}

#[test]
fn a_line_lies_in_the_plane_of_its_two_longest_travels() {
    let axes = |to: Point| blocks(&[moved([0.0; 3], to, SegmentShape::Line)], None)[0].axes.clone();
    assert_eq!(axes([9.0, 5.0, 1.0]), [0, 1, 2]);
    assert_eq!(axes([9.0, 1.0, 5.0]), [2, 0, 1]);
    assert_eq!(axes([1.0, 9.0, 5.0]), [1, 2, 0]);
}

#[test]
fn an_arc_of_rounded_ends_gets_a_centre_about_which_they_are_on_one_circle_within_a_pulse() {
    let (radius, center) = (1234.567, [10.3, -7.8]);
    for degrees in (5..360).step_by(7) {
        let at = |angle: f64| [center[0] + radius * angle.cos(), center[1] + radius * angle.sin(), 0.0];
        let (from, to) = (at(0.3), at(0.3 + f64::from(degrees).to_radians()));
        let moves =
            [moved([0.0; 3], from, SegmentShape::Line), moved(from, to, circle(center, Direction::CounterClockwise))];
        let blocks = blocks(&moves, None);
        let Curve::Arc(arc) = &blocks[1].curve else { panic!("no arc at {degrees}") };
        let difference = f64::hypot(arc.end()[0] as f64, arc.end()[1] as f64) - arc.radius();
        assert!(difference.abs() < 1.0, "{degrees}: {difference}");
        assert!((arc.sweep() - f64::from(degrees).to_radians()).abs() < 0.01);
        // A flat arc says little of its radius: its rise counts.
        let rise = 1.0 - (f64::from(degrees).to_radians() / 2.0).cos();
        assert!((arc.radius() - radius).abs() * rise < 1.5);
    }
}

#[test]
fn rounding_moves_no_point_of_an_arc_by_two_pulses() {
    // Half a turn between rounded ends a little nearer than twice the radius: their bisector would lead far aside.
    let mut cases = vec![([2000.0, 2571.2], [2000.0, 2500.0], 180.0)];
    for degrees in [1.0, 10.0, 90.0, 170.0, 179.0, 181.0, 270.0, 359.0] {
        cases.extend((0..20).map(|i| ([0.31 * f64::from(i), 71.2], [3.7, 0.3 * f64::from(i)], degrees)));
    }
    for (from, center, degrees) in cases {
        let angle = f64::to_radians(degrees);
        let [dx, dy] = [from[0] - center[0], from[1] - center[1]];
        let at = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            [center[0] + dx * cos - dy * sin, center[1] + dx * sin + dy * cos, 0.0]
        };
        let shape = circle(center, Direction::CounterClockwise);
        let blocks = blocks(&[moved([0.0; 3], at(0.0), SegmentShape::Line), moved(at(0.0), at(angle), shape)], None);
        let Some(Curve::Arc(arc)) = blocks.get(1).map(|block| &block.curve) else { continue };
        for part in 0..=16 {
            let [x, y, _] = at(angle * f64::from(part) / 16.0);
            let [cx, cy] = arc.center().map(|c| c as f64);
            let off = f64::hypot(x - cx, y - cy) - arc.radius();
            assert!(off.abs() < 1.5, "{degrees} from {from:?}: {off}");
        }
    }
}

#[test]
fn an_arc_shorter_than_a_pulse_is_no_full_circle() {
    let to = [1000.0, 0.3, 0.0];
    let moves = [
        moved([0.0; 3], [1000.0, 0.0, 0.0], SegmentShape::Line),
        moved([1000.0, 0.0, 0.0], to, circle([0.0, 0.0], Direction::CounterClockwise)),
    ];
    assert_eq!(blocks(&moves, None).len(), 1);
}

#[test]
fn an_arc_that_ends_where_it_starts_is_a_full_circle() {
    let at = [50.0, 0.0, 0.0];
    let moves = [moved([0.0; 3], at, SegmentShape::Line), moved(at, at, circle([0.0, 0.0], Direction::Clockwise))];
    let blocks = blocks(&moves, None);
    assert!(matches!(&blocks[1].curve, Curve::Arc(arc) if arc.is_full_circle()));
    assert_eq!(blocks[1].reach()[0], [-51, 51]);
}

#[test]
fn chords_stay_within_their_tolerance() {
    let (from, to) = ([1000.0, 0.0, 0.0], [-1000.0, 0.0, 0.0]);
    let moves =
        [moved([0.0; 3], from, SegmentShape::Line), moved(from, to, circle([0.0, 0.0], Direction::CounterClockwise))];
    for tolerance in [0.5, 5.0, 50.0] {
        let blocks = blocks(&moves, Some(tolerance));
        for block in &blocks[1..] {
            let middle = [0, 1].map(|axis| (block.from[axis] + block.to[axis]) as f64 / 2.0);
            let off = 1000.0 - f64::hypot(middle[0], middle[1]);
            assert!(off < tolerance + 1.0, "{tolerance}: {off}"); // and a pulse for the rounding of the ends
        }
        assert_eq!(blocks.last().map(|block| block.to[..3].to_vec()), Some(vec![-1000, 0, 0]));
    }
    assert!(blocks(&moves, Some(0.5)).len() > blocks(&moves, Some(50.0)).len());
}

#[test]
fn a_helix_keeps_its_third_axis_in_every_plane() {
    for plane in [Plane::Xy, Plane::Zx, Plane::Yz] {
        let [from, to] = [plane.point([100.0, 0.0, 0.0]), plane.point([0.0, 100.0, 30.0])];
        let shape = SegmentShape::Arc { plane, center: [0.0, 0.0], direction: Direction::CounterClockwise };
        let blocks = blocks(&[moved([0.0; 3], from, SegmentShape::Line), moved(from, to, shape)], None);
        let climb: i64 = blocks[1..].iter().map(|block| block.to[plane.axes()[2]] - block.from[plane.axes()[2]]).sum();
        assert_eq!((climb, blocks.last().map(|block| split(block.to.map(|c| c as f64)).0)), (30, Some(to)));
        assert!(blocks[1..].iter().all(|block| matches!(&block.curve, Curve::Helix(_))));
    }
}

#[test]
fn what_is_beyond_all_measure_is_refused() {
    for to in [f64::NAN, f64::INFINITY, 1e300] {
        let mut out = Vec::new();
        assert!(Rounder::new(None).blocks(&moved([0.0; 3], [to, 0.0, 0.0], SegmentShape::Line), &mut out).is_err());
        assert!(out.is_empty());
    }
}
