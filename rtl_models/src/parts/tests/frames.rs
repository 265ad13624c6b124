//! The frames of judged arcs and judged lines.

use stepwave_nc::{Arc, Curve, Direction, Line};
use stepwave_netlist::dsl::Scope;

use super::super::{ArcFrame, BeatRing, Block, LineFrame};
use super::bench::{Bench, loader, on_every_engine};
use crate::options::{BEATS, END_POINT};
use crate::{Beats, EndPoint, Hardware, Options, find};

fn arc_hardware(end_point: EndPoint) -> Hardware {
    let arc = Curve::Arc(Arc::new([7, 0], [0, 7], [0, 0], Direction::CounterClockwise).unwrap());
    let options = Options::default().with(&END_POINT, end_point);
    find("ppc-arc").unwrap().plan(&arc, &options).unwrap()
}

fn arc(m: Scope<'_>, end_point: EndPoint) {
    let block = loader(m);
    let hardware = arc_hardware(end_point);
    let frame = ArcFrame::new(m, &block, &hardware, m.input("judge", 1));
    for (name, gain) in ["gain_x", "gain_y"].into_iter().zip(frame.gains(6)) {
        m.name(name, gain);
    }
    let taken = [m.input("take_x", 1), m.input("take_y", 1)];
    frame.feed(&hardware, m.input("feed", 1), taken);
    frame.compute(m.input("compute", 1), taken);
    m.name("last", frame.compare(m.input("compare", 1), taken));
}

/// Loads a point of a quadrant.
fn load(bench: &mut Bench, [x, y]: [i128; 2], quad: i128, ccw: i128) {
    bench.clock(&[("load", 1), ("xi_in", x), ("yi_in", y), ("quad_in", quad), ("ccw_in", ccw), ("judge", 0)]);
    bench.clock(&[("load", 0)]);
}

#[test]
fn gains_are_what_the_steps_of_each_kind_add_to_the_square_of_the_radius() {
    on_every_engine(
        |m| arc(m, EndPoint::Total),
        |bench| {
            for (quad, ccw) in (0..4).flat_map(|quad| [(quad, 0), (quad, 1)]) {
                // Clockwise |x| grows in Q1 and Q3.
                let x_grows = (quad % 2 == 0) == (ccw == 0);
                load(bench, [3, 4], quad, ccw);
                let [dx, dy] = if x_grows { [1, -1] } else { [-1, 1] };
                assert_eq!(bench.value("gain_x"), (3i128 + dx).pow(2) - 9, "Q{} {ccw}", quad + 1);
                assert_eq!(bench.value("gain_y"), (4i128 + dy).pow(2) - 16, "Q{} {ccw}", quad + 1);
            }
        },
    );
}

#[test]
fn the_judge_beat_turns_to_the_next_quadrant_where_the_shrinking_coordinate_is_0() {
    on_every_engine(
        |m| arc(m, EndPoint::Total),
        |bench| {
            for (quad, ccw) in (0..4).flat_map(|quad| [(quad, 0), (quad, 1)]) {
                let x_grows = (quad % 2 == 0) == (ccw == 0);
                let (on_axis, before) = if x_grows { ([7, 0], [0, 7]) } else { ([0, 7], [7, 0]) };
                for (point, turns) in [(on_axis, true), (before, false), ([0, 0], false), ([3, 4], false)] {
                    load(bench, point, quad, ccw);
                    bench.clock(&[("judge", 1)]);
                    bench.clock(&[("judge", 0)]);
                    let next = (quad + if ccw == 1 { 1 } else { 3 }) % 4;
                    assert_eq!(bench.value("quad"), if turns { next } else { quad }, "{point:?} in Q{}", quad + 1);
                }
            }
        },
    );
    on_every_engine(
        |m| arc(m, EndPoint::PerAxis),
        |bench| {
            load(bench, [0, 7], 0, 1);
            bench.clock(&[("judge", 1)]);
            bench.clock(&[("judge", 0)]);
            assert_eq!(bench.value("quad"), 0, "the loader splits the arc");
        },
    );
}

#[test]
fn a_step_moves_the_axes_taken_and_their_coordinates() {
    on_every_engine(
        |m| arc(m, EndPoint::Total),
        |bench| {
            // NR1: -x, +y.
            bench.play(&[
                ("load", "1000_0000"),
                ("xi_in", "5555_5555"),
                ("ccw_in", "1111_1111"),
                ("e_in", "7777_7777"),
                ("feed", "0010_0100"),
                ("compute", "0001_0010"),
                ("compare", "0001_0010"),
                ("take_x", "0000_1111"),
                ("take_y", "0011_1110"),
            ]);
            assert_eq!(bench.row("xi"), "0555_5554");
            assert_eq!(bench.row("yi"), "0000_1112");
            assert_eq!(bench.row("e"), "0777_6664");
            assert_eq!(bench.row("dx"), "0000_00-0");
            assert_eq!(bench.row("dy"), "0001_0010");
        },
    );
}

#[test]
fn a_judged_line_steps_its_long_axis_always_and_the_short_one_on_the_diagonal() {
    let hardware = {
        let line = Curve::Line(Line::new(vec![0, 0], vec![7, 3]).unwrap());
        let options = Options::default().with(&BEATS, Beats::One);
        find("mindev-line").unwrap().plan(&line, &options).unwrap()
    };
    let describe = |m: Scope<'_>| {
        let block = Block::new(m);
        let beat = BeatRing::new(m, Beats::One, block.busy);
        LineFrame::new(m, &block, &hardware).close(&hardware, beat, m.input("diagonal", 1));
    };
    on_every_engine(describe, |bench| {
        for (x_is_longest, long, short) in [("1111_1111", "dx", "dy"), ("0000_0000", "dy", "dx")] {
            bench.play(&[
                ("load", "1000_0000"),
                ("x_is_longest_in", x_is_longest),
                ("sx_in", "0000_0000"),
                ("sy_in", "0000_0000"),
                ("e_in", "4444_4444"),
                ("diagonal", "0101_0111"),
            ]);
            assert_eq!(bench.row("e"), "0432_1000");
            assert_eq!(bench.row(long), "0011_1100");
            assert_eq!(bench.row(short), "0010_1000");
            assert_eq!(bench.row("done"), "0000_0111");
        }
    });
}
