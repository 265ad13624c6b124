//! Arcs and their centres.

use super::*;
use Direction::{Clockwise, CounterClockwise};

/// The shapes of the moves of a program that is run at a feed, with centres rounded to a millionth of a BLU.
fn shapes(text: &str) -> Vec<SegmentShape> {
    let shapes = moves(&format!("F100\n{text}")).into_iter().map(|one| match one.segment.shape {
        other @ (SegmentShape::Line | SegmentShape::Bezier(_)) => other,
        SegmentShape::Arc { plane, center, direction } => {
            SegmentShape::Arc { plane, center: center.map(rounded), direction }
        }
    });
    shapes.collect()
}

fn arc(plane: Plane, center: [f64; 2], direction: Direction) -> SegmentShape {
    SegmentShape::Arc { plane, center, direction }
}

#[test]
fn centres_are_relative_to_the_start_of_the_arc_and_absolute_under_g90_1() {
    let center = arc(Plane::Xy, [300.0, 200.0], CounterClockwise);
    assert_eq!(shapes("G0 X2 Y2\nG3 X3 Y3 I1 J0")[1], center);
    assert_eq!(shapes("G0 X2 Y2\nG3 X3 Y3 I1")[1], center, "J is 0");
    assert_eq!(shapes("G0 X2 Y2\nG91 G3 X1 Y1 I1")[1], center, "the same under G91");
    assert_eq!(shapes("G0 X2 Y2\nG90.1 G3 X3 Y3 I3 J2")[1], center);
    assert_eq!(shapes("G0 X2 Y2 G90.1\nG91.1 G3 X3 Y3 I1 J0")[1], center);
}

#[test]
fn the_third_word_of_a_centre_may_be_0() {
    assert_eq!(shapes("G17 G2 X1 Y1 I1 K0.000")[0], arc(Plane::Xy, [100.0, 0.0], Clockwise));
    assert_eq!(shapes("G18 G2 Z1 X1 K1 J0")[0], arc(Plane::Zx, [100.0, 0.0], Clockwise));
    assert_eq!(shapes("G19 G2 Y1 Z1 J1 I-0.0")[0], arc(Plane::Yz, [100.0, 0.0], Clockwise));
    assert!(fault("F1 G17 G2 X1 Y1 I1 K0.001").2.starts_with("K0.001 is no centre word of the plane G17"));
    assert!(fault("F1 G17 G2 X1 Y1 K0").2.starts_with("the arc has no centre"));
}

#[test]
fn p_counts_the_turns_of_an_arc_and_its_third_axis_goes_evenly_over_all() {
    // LinuxCNC: the last of the turns is the arc as it would be without P.
    let of = |text: &str| {
        let ends = moves(&format!("F100\n{text}"));
        ends.iter().map(|one| (one.segment.from.map(rounded), one.segment.to.map(rounded))).collect::<Vec<_>>()
    };
    let at = |x, y, z| [x, y, z];
    assert_eq!(
        of("G0 Y8\nG2 Z-6 I0 J-8 P2")[1..],
        [(at(0.0, 800.0, 0.0), at(0.0, 800.0, -300.0)), (at(0.0, 800.0, -300.0), at(0.0, 800.0, -600.0))]
    );
    // A quarter, and one and two whole turns before it: Z goes 1/5 and 1/9 of its travel in the quarter.
    assert_eq!(
        of("G3 X1 Y1 Z5 I0 J1 P2"),
        [(at(0.0, 0.0, 0.0), at(0.0, 0.0, 400.0)), (at(0.0, 0.0, 400.0), at(100.0, 100.0, 500.0))]
    );
    assert_eq!(of("G3 X1 Y1 Z9 R1 P3").iter().map(|(_, to)| to[2]).collect::<Vec<_>>(), [400.0, 800.0, 900.0]);
    assert_eq!(of("G2 X1 Y1 I1 P1"), of("G2 X1 Y1 I1"));
    for (text, word) in [("P0", "P0"), ("P-1", "P-1"), ("P1.5", "P1.5"), ("P10001", "P10001")] {
        let message = fault(format!("F1 G2 X1 Y1 I1 {text}")).2;
        let wanted =
            format!("{word} is the number of turns of the arc, of which the last may be a part: give a whole number");
        assert!(message.starts_with(&wanted), "{message}");
    }
    // The time of the block is divided by the length of its turns, of a quarter and one turn 4 : 1.
    let feeds = moves("G93 G3 X1 Y1 I0 J1 P2 F6").iter().map(|one| one.feed).collect::<Vec<_>>();
    let [Feed::Inverse(whole), Feed::Inverse(quarter)] = feeds[..] else { panic!("{feeds:?}") };
    assert!((whole - 7.5).abs() < 1e-9 && (quarter - 30.0).abs() < 1e-9, "{feeds:?}");
    // Of a dwell P is the time.
    assert_eq!(moves("F1 G4 P3 G2 X1 Y1 I1").len(), 1);
}

#[test]
fn radii_may_differ_by_the_tolerance_beyond_what_rounding_makes() {
    // At 0.01 mm 2 BLU are always allowed. The radii are 100 and 104 BLU.
    let text = "F1 G2 X2.04 Y0 I1 J0";
    let message = fault(text).2;
    assert!(
        message.contains("100.000 BLU at the start point but 104.000")
            && message.ends_with("or accept it with --tolerance 2"),
        "{message}"
    );
    let with = |tolerance| run_with(text, Reading { tolerance, ..reading() });
    assert!(with(2.0).is_ok());
    let message = with(1.5).unwrap_err().to_string();
    assert!(message.ends_with("or accept it with --tolerance 2"), "{message}");
    // Never by more than half of the radius, and then no tolerance is named.
    assert!(!fault("F1 G2 X2.6 Y0 I1 J0").2.contains("--tolerance"));
}

#[test]
fn arcs_turn_in_the_plane_that_is_chosen() {
    // In xy, zx and yz, counted along the first and second axis of the plane.
    assert_eq!(shapes("G17 G2 X1 Y1 I1")[0], arc(Plane::Xy, [100.0, 0.0], Clockwise));
    assert_eq!(shapes("G18 G2 Z1 X1 K1")[0], arc(Plane::Zx, [100.0, 0.0], Clockwise));
    assert_eq!(shapes("G18 G3 Z1 X1 I1")[0], arc(Plane::Zx, [0.0, 100.0], CounterClockwise));
    assert_eq!(shapes("G19 G2 Y1 Z1 J1")[0], arc(Plane::Yz, [100.0, 0.0], Clockwise));
    assert_eq!(shapes("G19 G2 Y1 Z1 K1")[0], arc(Plane::Yz, [0.0, 100.0], Clockwise));
}

#[test]
fn a_radius_gives_the_short_arc_and_a_negative_one_the_long_arc() {
    // A quarter from (0, 0) to (1, 1): about (1, 0) with the clock, about (0, 1) against it.
    for (text, center, direction) in [
        ("G2 X1 Y1 R1", [100.0, 0.0], Clockwise),
        ("G3 X1 Y1 R1", [0.0, 100.0], CounterClockwise),
        ("G2 X1 Y1 R-1", [0.0, 100.0], Clockwise),
        ("G3 X1 Y1 R-1", [100.0, 0.0], CounterClockwise),
        // Chord 6, radius 5, so that the centre is 4 next to it.
        ("G2 X6 R5", [300.0, -400.0], Clockwise),
        ("G3 Y-6 R5", [400.0, -300.0], CounterClockwise),
        ("G3 Y-6 R-5", [-400.0, -300.0], CounterClockwise),
        ("G2 X6 R3", [300.0, 0.0], Clockwise),
    ] {
        assert_eq!(shapes(text), [arc(Plane::Xy, center, direction)], "{text}");
    }
    assert_eq!(shapes("G18 G2 Z1 X1 R1"), [arc(Plane::Zx, [100.0, 0.0], Clockwise)]);
}

#[test]
fn a_radius_a_little_too_small_is_half_a_turn() {
    let half_turn = [arc(Plane::Xy, [1000.0, 0.0], Clockwise)];
    // Half of the chord is 1000 BLU; 2 BLU may be missing.
    assert_eq!(shapes("G2 X20 R9.98"), half_turn);
    let (line, column, message) = fault("F1\nG2 X20 R9.97");
    assert_eq!((line, column), (2, 8));
    assert_eq!(
        message,
        "the radius 997.000 BLU is less than half of the chord, 1000.000 BLU, by more than 2.000 BLU: \
         give a larger R or a nearer end point, or accept it with --tolerance 1"
    );
    // 0.1 % of a radius of 10,000 BLU.
    assert_eq!(shapes("G2 X200 R99.91"), [arc(Plane::Xy, [10_000.0, 0.0], Clockwise)]);
}

#[test]
fn an_arc_that_ends_where_it_starts_is_a_full_circle() {
    for text in ["G2 I3 J4", "G2 X0 Y0 I3 J4", "G91 G2 X0 I3 J4", "G2 X0.000001 I3 J4"] {
        let one = moves(&format!("F1\n{text}"))[0];
        assert_eq!(one.segment.shape, arc(Plane::Xy, [300.0, 400.0], Clockwise), "{text}");
        assert_eq!(one.segment.from, one.segment.to, "{text}");
    }
    assert_eq!(moves("F1 G2 I3\nI4\n").len(), 2, "the motion stays in force");
}

#[test]
fn the_third_axis_makes_a_helix() {
    let one = moves("G0 Z1\nG3 X2 Y0 Z-1 I1 F10")[1];
    assert_eq!(one.segment.shape, arc(Plane::Xy, [100.0, 0.0], CounterClockwise));
    assert_eq!((one.segment.from, one.segment.to), ([0.0, 0.0, 100.0], [200.0, 0.0, -100.0]));
    let turn = moves("G18 G3 Y5 K1 F10")[0];
    assert_eq!(turn.segment.to, [0.0, 500.0, 0.0]);
    assert_eq!(turn.plane, Plane::Zx);
}

#[test]
fn an_end_may_lie_off_the_circle_by_2_blu_or_a_thousandth_of_the_radius_up_to_half_a_millimetre() {
    // About (r, 0), from (0, 0) to (2r + off, 0): the radii differ by off. In BLU of 0.01 mm.
    let program = |radius: f64, off: f64| format!("F1 G2 X{} I{}", (2.0 * radius + off) / 100.0, radius / 100.0);
    for (radius, allowed) in
        [(100.0, 2.0), (1999.0, 2.0), (5000.0, 5.0), (40_000.0, 40.0), (90_000.0, 50.0), (3.0, 1.5)]
    {
        for sign in [1.0, -1.0] {
            assert_eq!(moves(&program(radius, sign * (allowed - 0.1))).len(), 1, "{radius} {sign}");
            let (_, column, message) = fault(program(radius, sign * (allowed + 0.1)));
            let end = radius + sign * (allowed + 0.1);
            let start = format!(
                "the radius is {radius:.3} BLU at the start point but {end:.3} BLU at the end point, and they may \
                 differ by at most {allowed:.3} BLU "
            );
            assert!(message.starts_with(&start), "{message}");
            assert_eq!(column, 7 + program(radius, sign * (allowed + 0.1))[6..].find('I').unwrap() as u64);
        }
    }
}

#[test]
fn a_fine_blu_still_allows_what_rounding_to_micrometres_makes() {
    let fine = Reading { blu: 0.0001, ..reading() };
    // The radii differ by 0.0049 mm and by 0.0051 mm.
    assert!(run_with("F1 G2 X2.0049 I1", fine.clone()).is_ok());
    assert!(run_with("F1 G2 X2.0051 I1", fine).is_err());
}

#[test]
fn what_is_no_arc_is_an_error_at_its_word() {
    for (text, column, message) in [
        ("G2 X1 Y1 F1", 1, "the arc has no centre: give I and J or a radius R"),
        ("G18 F1 G2 X1", 8, "the arc has no centre: give I and K or a radius R"),
        (
            "F1 G2 X1 K1",
            10,
            "K1 is no centre word of the plane G17, which has I and J: choose the plane of the arc or correct the word",
        ),
        (
            "G19 F1 G2 Y2 J1 I2",
            17,
            "I2 is no centre word of the plane G19, which has J and K: choose the plane of the arc or correct the word",
        ),
        ("F1 G3 X2 I1 R1", 13, "the arc has both R1 and a centre by I, J or K: keep one of them"),
        ("F1 G3 X2 I0 J0", 10, "the arc has radius 0 and must have more: correct the centre or the R word"),
        ("F1 G3 X2 R0", 10, "the arc has radius 0 and must have more: correct the centre or the R word"),
        (
            "F1 G3 X0 R5",
            10,
            "the arc ends where it starts, and R5 does not say where its centre is: give a full circle by I, J or K",
        ),
        (
            "F1 G90.1 G3 X2 I1",
            16,
            "under G90.1 the centre needs both I and J: give the one that is missing, or go back to G91.1",
        ),
        (
            "F1 G1 X2 I1",
            10,
            "I1 has nothing that uses it in this block: it belongs to G02 or G03, give that too or remove the word",
        ),
    ] {
        assert_eq!(fault(text), (1, column, message.into()), "{text}");
    }
}
