//! End-point counters of two axes.

use stepwave_nc::{Arc, Curve, Direction};
use stepwave_netlist::dsl::Scope;

use super::super::EndCounters;
use super::bench::{loader, on_every_engine};
use crate::options::END_POINT;
use crate::{EndPoint, Hardware, Options, find};

/// Hardware of an arc whose counters hold up to 7 pulses an axis.
fn hardware(end_point: EndPoint) -> Hardware {
    let arc = Curve::Arc(Arc::new([7, 0], [0, 7], [0, 0], Direction::CounterClockwise).unwrap());
    let options = Options::default().with(&END_POINT, end_point);
    find("ppc-arc").unwrap().plan(&arc, &options).unwrap()
}

fn counters(m: Scope<'_>, end_point: EndPoint) {
    let block = loader(m);
    let end = EndCounters::new(m, &block, &hardware(end_point));
    let [x, y] = end.redirected([m.input("x", 1), m.input("y", 1)]);
    let taken = [m.name("take_x", x), m.name("take_y", y)];
    m.name("last", end.count(m.input("step", 1), taken));
}

#[test]
fn one_counter_takes_the_pulses_of_both_axes_and_redirects_none() {
    on_every_engine(
        |m| counters(m, EndPoint::Total),
        |bench| {
            bench.play(&[
                ("load", "1000_0000"),
                ("e_in", "5555_5555"),
                ("step", "0111_0100"),
                ("x", "0110_1110"),
                ("y", "0011_1010"),
            ]);
            assert_eq!(bench.row("take_x"), "0110_1110");
            assert_eq!(bench.row("take_y"), "0011_1010");
            assert_eq!(bench.row("e"), "0542_1100");
            // The pulse that takes it to 0, and all that are 0.
            assert_eq!(bench.row("last"), "0000_0111");
            assert_eq!(bench.row("e_sub_overflow"), "0000_0000");
            // Two pulses where one is left.
            bench.play(&[("load", "100"), ("e_in", "111"), ("step", "010"), ("x", "010"), ("y", "010")]);
            assert_eq!(bench.row("e_sub_overflow"), "010");
        },
    );
}

#[test]
fn an_exhausted_axis_hands_its_step_to_the_other() {
    on_every_engine(
        |m| counters(m, EndPoint::PerAxis),
        |bench| {
            bench.play(&[
                ("load", "1000_0000"),
                ("ex_in", "1111_1111"),
                ("ey_in", "3333_3333"),
                ("step", "0101_1110"),
                ("x", "0111_0010"),
                ("y", "0110_0110"),
            ]);
            // From sample 2 on x has no pulse left: y steps whatever was judged.
            assert_eq!(bench.row("ex"), "0100_0000");
            assert_eq!(bench.row("ey"), "0322_1000");
            assert_eq!(bench.row("take_x"), "0100_0000");
            assert_eq!(bench.row("take_y"), "0111_1000");
            assert_eq!(bench.row("last"), "0000_1111");
        },
    );
    on_every_engine(
        |m| counters(m, EndPoint::PerAxis),
        |bench| {
            bench.play(&[
                ("load", "1000_00"),
                ("ex_in", "3333_33"),
                ("ey_in", "1111_11"),
                ("step", "0111_10"),
                ("x", "0000_00"),
                ("y", "0111_10"),
            ]);
            assert_eq!(bench.row("take_x"), "0011_10");
            assert_eq!(bench.row("take_y"), "0100_00");
        },
    );
}
