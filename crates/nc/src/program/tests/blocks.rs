//! What is in force from block to block.

use super::*;

#[test]
fn a_textbook_program_counts_pulses_in_coordinates_without_a_point_and_feeds_in_mm_per_minute() {
    let text = "N1G91\nN2G00X5Y-5.5\nN3G01X-45000Y-75000F150\nN4G20\nN5X1.Y1F1\nM02";
    let pulses = Reading { integers: Integers::Pulses, ..reading() };
    let moves = moves_of(&run_with(text, pulses).unwrap());
    // 5.5 mm are 550 BLU, and 1 inch is 2540 BLU.
    assert_eq!(moves[0].segment.to, [5.0, -550.0, 0.0]);
    assert_eq!(moves[1].segment.from, [5.0, -550.0, 0.0]);
    assert_eq!(moves[1].segment.to, [-44995.0, -75550.0, 0.0]);
    assert_eq!(moves[1].feed, Feed::PerMinute(150.0));
    assert_eq!(moves[1].place, place(3, Some(3)));
    assert_eq!(moves[2].segment.to, [-42455.0, -75549.0, 0.0], "Y1 is a pulse in inches too");
    assert_eq!(moves[2].feed, Feed::PerMinute(25.4));
}

#[test]
fn centres_and_radii_count_pulses_too() {
    let pulses = Reading { integers: Integers::Pulses, ..reading() };
    let moves = moves_of(&run_with("G17 F10 G02 X100 Y100 I100 J0\nG03 X0 Y0 R-100.", pulses).unwrap());
    assert_eq!(moves[0].segment.shape, arc_about([100.0, 0.0], Direction::Clockwise));
    let SegmentShape::Arc { center: [x, y], .. } = moves[1].segment.shape else { panic!("no arc") };
    // is 10,000 BLU, so that the centre is that far from both ends.
    assert!((f64::hypot(x, y) - 10_000.0).abs() < 1e-6 && (f64::hypot(x - 100.0, y - 100.0) - 10_000.0).abs() < 1e-6);
}

fn arc_about(center: [f64; 2], direction: Direction) -> SegmentShape {
    SegmentShape::Arc { plane: Plane::Xy, center, direction }
}

#[test]
fn motion_stays_in_force_until_another_or_g80() {
    let moves = moves("G0 X1\nY1\nG1 F60 X2\nZ-1\nG0 Z0 G90");
    let rapid: Vec<bool> = moves.iter().map(|one| one.feed == Feed::Rapid).collect();
    assert_eq!(rapid, [true, true, false, false, true]);
    assert_eq!(moves[3].segment.to, [200.0, 100.0, -100.0]);
    assert_eq!(fault("G0 X1\nG80\nX2").0, 3);
    // A line of many programs: everything off, and a rapid move after it.
    assert_eq!(ends("G00 G17 G40 G49 G80 G90\nX1\nG80 G0 X2"), [[100.0, 0.0, 0.0], [200.0, 0.0, 0.0]]);
    assert_eq!(ends("F1 G2\nX1 I.5"), [[100.0, 0.0, 0.0]]);
}

#[test]
fn increments_add_up_and_absolute_coordinates_do_not() {
    let ends = ends("G91 G0 X1 Y2\nX1\nZ-3 Y-1\nG90 X1\nG91 X-0.5");
    assert_eq!(
        ends,
        [
            [100.0, 200.0, 0.0],
            [200.0, 200.0, 0.0],
            [200.0, 100.0, -300.0],
            [100.0, 100.0, -300.0],
            [50.0, 100.0, -300.0]
        ]
    );
}

#[test]
fn inches_and_millimetres_may_alternate() {
    let moves = moves("G20 G1 X1 F10\nF10 X2\nG21 X10 F10\nG20 F10 Y1");
    let feeds: Vec<Feed> = moves.iter().map(|one| one.feed).collect();
    // F is executed before G20 and G21: in the first and the last block 10 mm/min, in the third 10 inch/min.
    assert_eq!(feeds, [10.0, 254.0, 254.0, 10.0].map(Feed::PerMinute));
    assert_eq!(moves[0].segment.to, [2540.0, 0.0, 0.0]);
    assert_eq!(moves[2].segment.to, [1000.0, 0.0, 0.0]);
    assert_eq!(moves[3].segment.to, [1000.0, 2540.0, 0.0]);
}

#[test]
fn inverse_time_needs_an_f_in_every_feed_block_and_a_change_of_mode_clears_f() {
    let timed = moves("G93 G1 X1 F2\nX2 F.5\nG0 X3\nG94 F100 G1 X4");
    let feeds: Vec<Feed> = timed.iter().map(|one| one.feed).collect();
    assert_eq!(feeds, [Feed::Inverse(2.0), Feed::Inverse(0.5), Feed::Rapid, Feed::PerMinute(100.0)]);
    assert_eq!(moves("G20 G93\nG1 X1 F2")[0].feed, Feed::Inverse(2.0), "an inverse time is no length");
    let missing =
        "under G93 every block with G01, G02, G03, G05 or G05.1 needs its own F word: write one, or go back to G94";
    assert_eq!(fault("G93 G1 X1 F2\n X2"), (2, 2, missing.into()));
    let none =
        "the block moves at a feed, but no F word has been given: write one into this block or one in front of it";
    assert_eq!(fault("F100 G1 X1\nG93\nG94\nX2"), (4, 1, none.into()));
    assert_eq!(moves("F100 G1 X1\nG94\nX2").len(), 2, "G94 under G94 clears nothing");
}

#[test]
fn the_words_of_a_block_are_executed_in_the_order_of_rs_274_however_they_are_written() {
    let here = place(1, Some(7));
    let events = run("N7 M01 X1 G1 G21 G4 P0.25 M8 M3 M6 T2 S500 F60 G94");
    let auxiliary = |function| Event::Auxiliary { place: here, function };
    assert_eq!(
        events[..6],
        [
            auxiliary(Auxiliary::Speed(500.0)),
            auxiliary(Auxiliary::Tool(2)),
            auxiliary(Auxiliary::ToolChange),
            auxiliary(Auxiliary::Spindle(Spindle::Clockwise)),
            auxiliary(Auxiliary::Coolant(Coolant::Flood)),
            Event::Dwell { place: here, seconds: 0.25 },
        ]
    );
    assert!(matches!(events[6], Event::Move(Move { feed: Feed::PerMinute(60.0), .. })));
    assert_eq!(events[7], Event::Stop { place: here, optional: true });
    assert_eq!(events[8], Event::End { place: place(1, None) });
    assert_eq!(events.len(), 9);
}

#[test]
fn the_side_of_a_move_is_that_at_the_end_of_its_block() {
    let text = "G0 X1\nG41 D1 X2\nX3\nG42 D2 X4\nG40 X5\nG41 D0 X6\nG42.1 D3 X7\nG20 G41.1 D.5\nX8";
    let sides: Vec<Side> = moves(text).iter().map(|one| one.side).collect();
    // In BLU of 0.01 mm: tools of 4 mm and 2.5 mm, then diameters of 3 mm and half an inch.
    assert_eq!(
        sides,
        [
            Side::On,
            Side::Left(400.0),
            Side::Left(400.0),
            Side::Right(250.0),
            Side::On,
            Side::Left(0.0),
            Side::Right(150.0),
            Side::Left(635.0),
        ]
    );
}

#[test]
fn a_line_of_no_length_is_no_move_but_its_words_stay_in_force() {
    let moves = moves("G1 X0 Y0 F50 G91\nX0\nG20 X1\nX0.\nG90 Y0 G21\nX25.4\nX25.400005\nX30");
    assert_eq!(moves.len(), 2, "1 inch is 25.4 mm, and 0.0005 BLU is nothing");
    assert_eq!((moves[0].place.line, moves[0].segment.to), (3, [2540.0, 0.0, 0.0]));
    assert_eq!((moves[1].place.line, moves[1].feed), (8, Feed::PerMinute(50.0)));
    assert_eq!(moves[1].segment.from, [2540.0, 0.0, 0.0]);
}

#[test]
fn words_that_do_not_change_the_path_are_accepted() {
    let ends = ends("G17 G21 G40 G49 G54 G80 G90 G94 G98\nG61 G99\nG61.1\nG64\nG64 P0.1 Q.05\nG0 X1 G91.1 M5 M9");
    assert_eq!(ends, [[100.0, 0.0, 0.0]]);
}

#[test]
fn a_program_ends_at_m02_m30_a_per_cent_sign_or_its_last_line() {
    for (text, line, number) in [
        ("G0 X1\nN9 M2\nthis is not read", 2, Some(9)),
        ("G0 X1\nM30\n\u{1}", 2, None),
        ("%\nO1\nG0 X1\n%\n((", 4, None),
        ("G0 X1\n%\n((", 2, None),
        ("G0 X1\n\n", 2, None),
        ("N1 G0 X1", 1, None),
        ("N1 G0 X1 M2", 1, Some(1)),
    ] {
        let events = run(text);
        assert_eq!(events.len(), 2, "{text}");
        assert_eq!(events[1], Event::End { place: place(line, number) }, "{text}");
    }
}

#[test]
fn a_program_is_a_stream_and_stops_at_its_first_error() {
    let mut program = Program::new("G0 X1\nM0\nX\nX3".as_bytes(), reading()).unwrap();
    assert!(matches!(program.next(), Some(Ok(Event::Move(_)))));
    assert!(matches!(program.next(), Some(Ok(Event::Stop { optional: false, .. }))));
    assert!(matches!(program.next(), Some(Err(ProgramError { line: 3, column: 1, .. }))));
    assert!(program.next().is_none() && program.next().is_none());
}
