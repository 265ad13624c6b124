//! Free curves: G5, G5.1, and NURBS between G5.2 and G5.3.

use super::*;

/// The ends of all chords from the start of the first on, in mm.
fn path(text: &str) -> Vec<Point> {
    let moves = moves(&format!("F100\n{text}"));
    for pair in moves.windows(2) {
        assert_eq!(pair[0].segment.to, pair[1].segment.from, "{text}");
    }
    let all = moves.iter().map(|one| {
        assert_eq!((one.segment.shape, one.side), (SegmentShape::Line, Side::On), "{text}");
        one.segment.to
    });
    std::iter::once(moves[0].segment.from).chain(all).map(|at| at.map(|c| c * 0.01)).collect()
}

/// How far places of a curve, in mm, are from the nearest chord at most, in BLU.
fn farthest(path: &[Point], curve: impl Fn(f64) -> [f64; 2]) -> f64 {
    let from_chord = |[x, y]: [f64; 2], a: Point, b: Point| {
        let along = [b[0] - a[0], b[1] - a[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let share = (((x - a[0]) * along[0] + (y - a[1]) * along[1]) / square).clamp(0.0, 1.0);
        (x - a[0] - share * along[0]).hypot(y - a[1] - share * along[1])
    };
    let least = |at: [f64; 2]| path.windows(2).map(|pair| from_chord(at, pair[0], pair[1])).fold(f64::MAX, f64::min);
    (0..=2000).map(|step| least(curve(f64::from(step) / 2000.0))).fold(0.0, f64::max) * 100.0
}

fn cubic(points: [[f64; 2]; 4], u: f64) -> [f64; 2] {
    let v = 1.0 - u;
    let weights = [v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u];
    [0, 1].map(|axis| (0..4).map(|index| weights[index] * points[index][axis]).sum())
}

#[test]
fn a_cubic_curve_by_both_its_control_points() {
    let path = path("G5 I0 J3 P0 Q-3 X1 Y1");
    let off = farthest(&path, |u| cubic([[0.0, 0.0], [0.0, 3.0], [1.0, -2.0], [1.0, 1.0]], u));
    // 0.25 BLU is what the reading allows.
    assert!(off <= 0.25 && off > 0.02, "{off}");
    assert_eq!((path[0], path.last()), ([0.0; 3], Some(&[1.0, 1.0, 0.0])));
    // Its ends lie on it.
    assert!((16..=64).contains(&path.len()), "{}", path.len());
}

#[test]
fn a_cubic_curve_continues_as_the_one_before_it_ended() {
    let first = "G5 I0 J3 P0 Q-3 X1 Y1\n";
    let implied = path(&format!("{first}P0 Q-3 X2 Y2"));
    assert_eq!(implied, path(&format!("{first}G5 I0 J3 P0 Q-3 X2 Y2")));
    assert_eq!(implied, path(&format!("{first}G91 X1 Y1 P0 Q-3")), "P and Q count from the end");
    // Blocks without a motion between them change nothing.
    assert_eq!(implied, path(&format!("{first}S100\nP0 Q-3 X2 Y2")));
    let text = format!("F100\n{first}G1 X2\nG5 X3 Y3 P0 Q1");
    assert!(fault(text).2.contains("needs I and J"));
    assert!(fault(format!("F100\n{first}G5.1 X2 Y3 I1\nG5 X3 Y3 P0 Q1")).2.contains("needs I and J"));
}

#[test]
fn a_quadratic_curve_is_the_parabola_of_its_control_point() {
    let path = path("G1 X-2 Y4\nG5.1 X2 I2 J-8");
    // y = x², from (-2, 4) to (2, 4).
    for [x, y, _] in &path[1..] {
        assert!((y - x * x).abs() < 1e-9, "({x}, {y})");
    }
    let off = farthest(&path[1..], |u| [4.0 * u - 2.0, (4.0 * u - 2.0) * (4.0 * u - 2.0)]);
    assert!(off <= 0.25 && off > 0.02, "{off}");
    // One of both is enough.
    assert_eq!(super::moves("F1 G5.1 X2 Y0 J1").len(), super::moves("F1 G5.1 X2 Y0 I0 J1").len());
}

#[test]
fn a_nurbs_of_three_points_is_a_quarter_of_a_circle() {
    let path = path("G1 X10\nG5.2 P1 L3\nX10 Y10 P0.7071067811865476\nX0 Y10 P1\nG5.3");
    let arc = &path[1..];
    assert!(arc.iter().all(|[x, y, _]| (x.hypot(*y) - 10.0).abs() < 1e-9));
    assert_eq!(arc.last(), Some(&[0.0, 10.0, 0.0]));
    // A chord of 1000 BLU radius that is 0.25 BLU off has 44.7 BLU; the curve has 1571.
    assert!((36..=128).contains(&arc.len()), "{}", arc.len());
    let off = farthest(arc, |u| {
        [10.0 * (u * std::f64::consts::FRAC_PI_2).cos(), 10.0 * (u * std::f64::consts::FRAC_PI_2).sin()]
    });
    assert!(off <= 0.25, "{off}");
}

#[test]
fn a_nurbs_begins_at_the_tool_with_the_weight_of_a_block_without_a_point() {
    // Four points of degree 2 have the knots 0 0 0 1 2 2 2, and u = 1 is the middle of the second and third, by weights.
    let middle = |first: &str| {
        let path = path(&format!("{first}\nX0 Y8 P3\nX8 Y8\nX8 Y0 P1\nG5.3"));
        assert!(path.iter().any(|at| (at[0] - 2.0).abs() < 1e-9 && (at[1] - 8.0).abs() < 1e-9), "{path:?}");
        path.len()
    };
    assert_ne!(middle("G5.2 P1"), middle("G5.2 P40"));
    assert_eq!(middle("G5.2 P1"), middle("G5.2 L3"));
    // The first block may have a point too: the start then has the weight 1.
    assert_eq!(path("G5.2 X0 Y8 P3\nX8 Y8\nX8 Y0\nG5.3"), path("G5.2\nX0 Y8 P3\nG5.2 X8 Y8 P1\nX8 Y0 P1\nG5.3"));
    // Under G91 every point counts from the start, where the tool still is.
    assert_eq!(path("G1 X1\nG91 G5.2 X0 Y8\nX8 Y8\nX8 Y0\nG5.3"), path("G1 X1\nG5.2 X1 Y8\nX9 Y8\nX9 Y0\nG5.3"));
}

#[test]
fn a_higher_order_is_a_smoother_curve_through_both_ends() {
    let points = "X0 Y8 P1\nX8 Y8 P1\nX8 Y0 P1\nX16 Y0 P1\nG5.3";
    let tops: Vec<f64> = (3..=5)
        .map(|order| {
            let path = path(&format!("G5.2 L{order}\n{points}"));
            assert_eq!(path.last(), Some(&[16.0, 0.0, 0.0]));
            path.iter().map(|at| at[1]).fold(0.0, f64::max)
        })
        .collect();
    assert!(tops[0] > tops[1] && tops[1] > tops[2], "{tops:?}");
}

#[test]
fn a_nurbs_lies_in_the_plane_that_is_chosen() {
    let turned = |plane: &str, points: &str| {
        let path = path(&format!("{plane} G5.2\n{points}\nG5.3"));
        path.iter().map(|at| at.map(rounded)).collect::<Vec<_>>()
    };
    let xy = turned("G17", "X0 Y8 P2\nX8 Y8");
    let zx: Vec<Point> = xy.iter().map(|[x, y, _]| [*y, 0.0, *x]).collect();
    let yz: Vec<Point> = xy.iter().map(|[x, y, _]| [0.0, *x, *y]).collect();
    assert_eq!((turned("G18", "Z0 X8 P2\nZ8 X8"), turned("G19", "Y0 Z8 P2\nY8 Z8")), (zx, yz));
}

#[test]
fn inches_pulses_and_inverse_time_count_for_curves_too() {
    let mm = ends("F1 G5 X25.4 Y0 I0 J25.4 P0 Q25.4");
    assert_eq!(ends("F1 G20 G5 X1 Y0 I0 J1 P0 Q1"), mm);
    let pulses = Reading { integers: Integers::Pulses, ..reading() };
    let by_pulses = moves_of(&run_with("F1 G5 X2540 Y0 I0 J2540 P0 Q2540", pulses).unwrap());
    assert_eq!(by_pulses.iter().map(|one| one.segment.to.map(rounded)).collect::<Vec<_>>(), mm);
    let timed = moves("G93 G5 X1 Y1 I0 J3 P0 Q-3 F2");
    let minutes: f64 = timed
        .iter()
        .map(|one| match one.feed {
            Feed::Inverse(number) => 1.0 / number,
            other => panic!("{other:?}"),
        })
        .sum();
    assert!((minutes - 0.5).abs() < 1e-9, "{minutes}");
}

#[test]
fn no_motion_is_in_force_after_a_nurbs() {
    let text = "F1 G5.2 X1 Y2\nX3 Y3\nG5.3\n";
    assert!(fault(format!("{text}X9")).2.contains("X9 is given, but no G00"));
    assert_eq!(ends(&format!("{text}G1 X9")).last(), Some(&[900.0, 300.0, 0.0]));
}

#[test]
fn wrong_words_of_a_curve_are_refused_where_they_are() {
    for (text, column, wanted) in [
        ("F1 G5 X1 Y1 I1 P0 Q1", 4, "needs I and J"),
        ("F1 G5 X1 Y1 P0 Q1", 4, "needs I and J"),
        ("F1 G5 X1 Y1 I1 J1 Q1", 4, "needs both P and Q"),
        ("F1 G5 X1 Y1 I1 J1 P1", 4, "needs both P and Q"),
        ("F1 G5 I1 J1 P1 Q1", 4, "needs its end point"),
        ("F1 G5 X1 Z1 I1 J1 P1 Q1", 10, "Z1 has nothing that uses it"),
        ("F1 G18 G5 X1 I1 J1 P1 Q1", 8, "write G17"),
        ("F1 G5.1 X1 Y1", 4, "one that is not 0"),
        ("F1 G5.1 X1 Y1 I0 J0", 4, "one that is not 0"),
        ("F1 G5.1 X1 Y1 I1 Q1", 18, "Q1 has nothing that uses it"),
        ("F1 G5.1 X1 Y1 I1 P1", 18, "P1 has nothing that uses it"),
        ("F1 G41 D1 G5.1 X1 Y1 I1", 11, "write G40"),
        ("F1 G41 D1 G5.2 X1 Y1", 11, "write G40"),
        ("G5 X1 Y1 I1 J1 P1 Q1", 1, "no F word"),
        ("F1 G1 X1 L3", 10, "L3 has nothing that uses it in this block: it belongs to G05.2"),
        ("F1 G1 X1 Q3", 10, "it belongs to G05 or G64"),
        ("F1 G5.2 X1", 4, "needs both X and Y"),
        ("F1 G18 G5.2 X1 Y1", 16, "Y1 has nothing that uses it"),
        ("F1 G5.2 X1 Y1 P0", 15, "from 0.000001 to 1000000"),
        ("F1 G5.2 X1 Y1 P-1", 15, "from 0.000001 to 1000000"),
        ("F1 G5.2 L2", 9, "a whole number from 3 to 8"),
        ("F1 G5.2 L9", 9, "a whole number from 3 to 8"),
        ("F1 G5.2 X1 Y1 R1", 15, "R1 has nothing that uses it"),
        ("F1 G5.3", 4, "none was begun"),
    ] {
        let (line, at, message) = fault(text);
        assert!(message.contains(wanted) && (line, at) == (1, column), "{text}: {line}, {at}: {message}");
    }
    for (text, line, wanted) in [
        ("F1 G5.2\nX1 Y1\nG5.3", 3, "2 control points, its start among them, but of the order 3"),
        ("F1 G5.2\nX1 Y1\nX2 Y1\nP2", 4, "a weight without X and Y"),
        ("F1 G5.2\nX1 Y1\nX2 Y1\nG5.3 X1", 4, "it belongs to G05.2"),
        ("F1 G5.2\nX1 Y1\nG1 X2", 3, "write G05.3 in front of"),
        ("F1 G5.2\nX1 Y1\nG18", 3, "write G05.3 in front of"),
        ("F1 G5.2\nX1 Y1\nG28", 3, "write G05.3 in front of"),
        ("F1 G5.2\nX1 Y1\nM2", 3, "write G05.3 in front of"),
        ("F1 G5.2\nX1 Y1\n", 2, "write G05.3 in front of"),
        ("F1 G5.1 X1 I1\nG53 X2 I1", 2, "no G00 or G01 is in force"),
    ] {
        let (at, _, message) = fault(text);
        assert!(message.contains(wanted) && at == line, "{text}: {at}: {message}");
    }
    let error = run_with("F1 G5.1 X1 Y1 I1", Reading { blu: 1e-9, chords: 1e-6, ..reading() }).unwrap_err();
    assert!(error.to_string().contains("1048576 chords or more: choose a larger BLU"), "{error}");
}

#[test]
fn p_and_q_still_belong_to_a_dwell_and_to_g64_where_a_curve_is_in_force() {
    let text = "F1 G5 X1 Y1 I0 J3 P0 Q-3\nG4 P2\nG64 P0.1 Q0.2\nX2 Y2 P0 Q-3";
    assert_eq!(ends(text).last(), Some(&[200.0, 200.0, 0.0]));
}

#[test]
fn a_word_of_another_code_in_the_block_of_a_curve_keeps_its_own_meaning() {
    let run = |text: &str| run_with(text, reading());
    let event = |text: &str| run(text).map(|events| events.len());
    assert!(event("F1 G5.1 G64 P0.1 Q0.2 X1 Y1 I0.5 J0").is_ok_and(|events| events > 2));
    assert!(event("F1 G5.1 G4 P0.1 X1 Y1 I0.5 J0").is_ok_and(|events| events > 3));
    for text in ["F1 G5 G64 X1 Y1 I0 J3 P1 Q-3", "F1 G5 G4 X1 Y1 I0 J3 P1 Q-3"] {
        let said = run(text).unwrap_err().to_string();
        assert!(said.contains("P1 would belong to G05 and to G04 or G64 as well"), "{said}");
    }
    assert!(run("F1 G5.1 X1 Y1 I0.5 J0 P3").unwrap_err().to_string().contains("P3 has nothing that uses it"));
}

#[test]
fn a_curve_that_stays_whole_is_one_move_with_the_control_points_of_its_words() {
    let text = "F100 G1 X1\nG5 X2 Y1 I0.5 J0.25 P-0.1 Q-1\nX3 P0 Q1\nG5.1 X0 Y0 J-2\nG5 X0 Y0 I0 J0 P0 Q0\nG93 G5.1 F7 X1 Y0 I1\n\
                G94 F1 G5.2 X1 Y1\nX2 Y0\nG5.3\nM2";
    let moves = moves_of(&run_with(text, Reading { whole: true, ..reading() }).unwrap());
    let (curves, chords) = moves[1..].split_at(4);
    let of = |one: &Move| (one.segment.from, one.segment.to, one.segment.shape);
    let two = |points| SegmentShape::Bezier(Controls::Two(points));
    let one = |point| SegmentShape::Bezier(Controls::One(point));
    // The fourth G5 goes nowhere.
    assert_eq!(of(&curves[0]), ([100.0, 0.0, 0.0], [200.0, 100.0, 0.0], two([[150.0, 25.0], [190.0, 0.0]])));
    assert_eq!(of(&curves[1]), ([200.0, 100.0, 0.0], [300.0, 100.0, 0.0], two([[210.0, 200.0], [300.0, 200.0]])));
    assert_eq!(of(&curves[2]), ([300.0, 100.0, 0.0], [0.0; 3], one([300.0, -100.0])));
    assert_eq!(of(&curves[3]), ([0.0; 3], [100.0, 0.0, 0.0], one([100.0, 0.0])));
    assert_eq!(
        curves.iter().map(|one| one.feed).collect::<Vec<_>>()[2..],
        [Feed::PerMinute(100.0), Feed::Inverse(7.0)]
    );
    assert!(chords.len() > 4 && chords.iter().all(|one| one.segment.shape == SegmentShape::Line), "{chords:?}");
    // Its ends are those of the chords.
    let ends = |moves: &[Move]| moves.last().map(|one| one.segment.to);
    assert_eq!(ends(&moves), ends(&super::moves(text)));
}
