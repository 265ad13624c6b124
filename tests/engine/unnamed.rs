//! Nets without a name, and nets that nothing depends on: they are worth as much as any other to who watches them.

use stepwave_engine::lanes::{Job, LaneProgram, LaneStop, LaneWatch, Observe};
use stepwave_engine::{Engine, EngineKind, Rows, Stop, Watch, compiled_after};
use stepwave_netlist::{Design, Net};

use crate::netlist::{design, net};

/// A counter of 4 bits, and two nets that nothing depends on: its double, and that it is 5.
fn counter() -> (Design, [Net; 2]) {
    let mut loose = None;
    let design = design(|m| {
        let count = m.reg("count", 4);
        count.set(count.q.wrapping_add(m.lit(4, 1)));
        let (double, at_5) = (count.q.wrapping_add(count.q), count.q.equals(m.lit(4, 5)));
        loose = Some([double.net(), at_5.net()]);
    });
    (design, loose.unwrap())
}

/// Every engine, and native code from the start.
fn engines(design: &Design, watch: &Watch) -> Vec<(&'static str, Box<dyn Engine>)> {
    let kinds = EngineKind::ALL.map(|kind| (kind.name(), kind.build(design, watch)));
    kinds.into_iter().chain([("native", compiled_after(design, watch, 0))]).collect()
}

#[test]
fn a_net_that_nothing_depends_on_can_be_recorded() {
    let (design, [double, at_5]) = counter();
    for (name, mut engine) in engines(&design, &Watch { columns: vec![double, at_5], stops: vec![] }) {
        let mut rows = Rows::new(2, 32);
        engine.reset(&mut rows);
        engine.run(20, &mut rows);
        for (clock, row) in rows.iter() {
            assert_eq!(row, [2 * clock % 16, u64::from(clock % 16 == 5)], "{name}, clock {clock}");
        }
        assert_eq!(rows.len(), 21, "{name}");
    }
}

#[test]
fn a_net_that_nothing_depends_on_can_stop_a_run() {
    let (design, [_, at_5]) = counter();
    for (name, mut engine) in engines(&design, &Watch { columns: vec![], stops: vec![at_5] }) {
        let mut rows = Rows::new(0, 0);
        for clock in [5, 21, 37] {
            assert_eq!((engine.run(100, &mut rows), engine.clock()), (Stop::Net(0), clock), "{name}");
        }
    }
}

#[test]
fn the_value_of_a_net_that_nobody_watches_and_nothing_depends_on_is_right_all_the_same() {
    let (design, [double, at_5]) = counter();
    for (name, mut engine) in engines(&design, &Watch::default()) {
        let mut rows = Rows::new(0, 0);
        for clocks in [0, 1, 4, 5, 11] {
            engine.run(clocks, &mut rows);
            let count = engine.value(net(&design, "count"));
            assert_eq!(count, engine.clock() % 16, "{name}");
            assert_eq!(engine.value(double), 2 * count % 16, "{name} at {count}");
            assert_eq!(engine.value(at_5), u64::from(count == 5), "{name} at {count}");
        }
    }
}

#[test]
fn lanes_end_at_and_observe_nets_that_nothing_depends_on() {
    let (design, [double, at_5]) = counter();
    let observe = vec![Observe::Last(double), Observe::Count(vec![at_5]), Observe::Max { net: double, signed: false }];
    let watch = LaneWatch { observe, ..LaneWatch::new(at_5) };
    let ends = LaneProgram::new(&design, &watch).run_all(vec![Job { blocks: vec![vec![]] }]);
    assert_eq!((ends[0].stop, ends[0].clock, &ends[0].values[..]), (LaneStop::Done, 5, &[10, 1, 10][..]));
}
