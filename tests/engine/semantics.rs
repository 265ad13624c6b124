//! Clocks and samples: what an engine shows, and when. Each test says one sentence of the engine's contract.

use stepwave_engine::{Engine, EngineKind, Rows, Stop, Watch};
use stepwave_netlist::Design;

use crate::netlist::{design, net};

/// An engine that records some nets of a design and stops at some, with its rows.
struct Recorder {
    design: Design,
    engine: Box<dyn Engine>,
    rows: Rows,
}

impl Recorder {
    /// After the reset; the rows hold sample 0.
    fn new(kind: EngineKind, design: &Design, columns: &[&str], stops: &[&str], room: usize) -> Recorder {
        let nets = |names: &[&str]| names.iter().map(|name| net(design, name)).collect();
        let watch = Watch { columns: nets(columns), stops: nets(stops) };
        let mut rows = Rows::new(columns.len(), room);
        let mut engine = kind.build(design, &watch);
        engine.reset(&mut rows);
        Recorder { design: design.clone(), engine, rows }
    }

    fn set(&mut self, input: &str, value: u64) {
        self.engine.set_input(net(&self.design, input), value);
    }

    fn run(&mut self, clocks: u64) -> Stop {
        self.engine.run(clocks, &mut self.rows)
    }

    fn reset(&mut self) {
        self.rows.clear();
        self.engine.reset(&mut self.rows);
    }

    fn value(&self, name: &str) -> u64 {
        self.engine.value(net(&self.design, name))
    }

    /// A recorded column.
    fn column(&self, column: usize) -> Vec<u64> {
        self.rows.iter().map(|(_, row)| row[column]).collect()
    }

    fn clocks(&self) -> Vec<u64> {
        self.rows.iter().map(|(clock, _)| clock).collect()
    }
}

fn on_every_engine(check: impl Fn(EngineKind)) {
    for kind in EngineKind::ALL {
        // Seen only with a failure.
        println!("on the engine '{}':", kind.name());
        check(kind);
    }
}

/// A counter of `bits` bits that starts at `reset`, counts where `enable` is 1, and shows that it is 5.
fn counter(bits: u32, reset: u64) -> Design {
    design(|m| {
        let enable = m.input("enable", 1);
        let count = m.reg("count", bits).reset(reset);
        let next = m.name("next", count.q.wrapping_add(m.lit(bits, 1)));
        count.when(enable, next).else_hold();
        m.name("at_5", count.q.equals(m.lit(bits, 5)));
        m.name("odd", count.q.bit(0));
    })
}

#[test]
fn sample_k_shows_every_net_settled_after_edge_k() {
    let design = counter(4, 0);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["count", "next", "at_5"], &[], 9);
        run.set("enable", 1);
        run.reset();
        assert_eq!(run.run(8), Stop::Clocks);
        assert_eq!(run.clocks(), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
        // In each sample the combinational nets belong to the register's value of that sample, not to the one before.
        assert_eq!(run.column(0), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(run.column(1), [1, 2, 3, 4, 5, 6, 7, 8, 9]);
        assert_eq!(run.column(2), [0, 0, 0, 0, 0, 1, 0, 0, 0]);
    });
}

#[test]
fn all_registers_take_their_next_values_at_once_so_two_of_them_can_swap() {
    let design = design(|m| {
        let (a, b) = (m.reg("a", 4).reset(3), m.reg("b", 4).reset(12));
        a.set(b.q);
        b.set(a.q);
        let chain = ["c", "d", "e"].map(|name| m.reg(name, 4));
        chain[0].set(a.q);
        chain[1].set(chain[0].q);
        chain[2].set(chain[1].q);
    });
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["a", "b", "c", "d", "e"], &[], 5);
        run.run(4);
        assert_eq!(run.column(0), [3, 12, 3, 12, 3]);
        assert_eq!(run.column(1), [12, 3, 12, 3, 12]);
        assert_eq!(run.column(2), [0, 3, 12, 3, 12]);
        assert_eq!(run.column(3), [0, 0, 3, 12, 3]);
        assert_eq!(run.column(4), [0, 0, 0, 3, 12]);
    });
}

#[test]
fn of_the_conditions_of_a_register_the_first_that_is_1_wins_and_none_means_hold_or_otherwise() {
    let design = design(|m| {
        let conditions = m.input("conditions", 2);
        let (first, second) = (conditions.bit(0), conditions.bit(1));
        m.reg("holds", 4).reset(7).when(first, m.lit(4, 1)).when(second, m.lit(4, 2)).else_hold();
        m.reg("else", 4).when(first, m.lit(4, 1)).when(second, m.lit(4, 2)).otherwise(m.lit(4, 9));
    });
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["holds", "else"], &[], 8);
        for conditions in [2, 0, 3, 1, 2] {
            run.set("conditions", conditions);
            run.run(1);
        }
        run.run(1);
        assert_eq!(run.column(0), [7, 7, 2, 2, 1, 1, 2]);
        assert_eq!(run.column(1), [0, 9, 2, 9, 1, 1, 2]);
    });
}

#[test]
fn an_input_changes_right_after_the_next_edge_which_still_sees_the_old_value() {
    let design = design(|m| {
        let a = m.input("a", 4);
        m.name("combinational", !a);
        m.reg("registered", 4).set(a);
    });
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["a", "combinational", "registered"], &[], 8);
        run.set("a", 7);
        assert_eq!(run.value("a"), 0, "nothing changes between two edges");
        assert_eq!(run.value("combinational"), 15);
        run.run(2);
        run.set("a", 9);
        run.run(2);
        assert_eq!(run.column(0), [0, 7, 7, 9, 9]);
        assert_eq!(run.column(1), [15, 8, 8, 6, 6]);
        assert_eq!(run.column(2), [0, 0, 7, 7, 9]);
    });
}

#[test]
fn of_several_values_set_between_two_edges_the_last_counts() {
    let design = counter(4, 0);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["enable", "count"], &[], 8);
        run.set("enable", 1);
        run.set("enable", 0);
        run.run(2);
        run.set("enable", 0);
        run.set("enable", 1);
        run.run(2);
        assert_eq!(run.column(0), [0, 0, 0, 1, 1]);
        assert_eq!(run.column(1), [0, 0, 0, 0, 1]);
    });
}

#[test]
fn bits_above_the_width_of_an_input_are_ignored() {
    let design = design(|m| {
        let a = m.input("a", 4);
        m.name("b", a.concat(m.lit(1, 0)));
    });
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["a", "b"], &[], 8);
        run.set("a", 0xffff_fff6);
        run.run(1);
        assert_eq!(run.rows.row(1), [6, 12]);
        run.set("a", u64::MAX);
        run.reset();
        assert_eq!(run.rows.row(0), [15, 30]);
    });
}

#[test]
fn a_net_that_is_no_input_cannot_be_set() {
    let design = design(|m| {
        let a = m.input("a", 4);
        let constant = m.name("constant", m.lit(4, 3));
        m.name("sum", a.wrapping_add(constant));
        let register = m.reg("register", 4);
        register.set(register.q);
    });
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["constant", "sum", "register"], &[], 8);
        for name in ["constant", "sum", "register"] {
            run.set(name, 9);
        }
        run.run(1);
        assert_eq!(run.rows.row(1), [3, 3, 0]);
    });
}

#[test]
fn sample_0_is_the_state_after_reset_with_the_inputs_set_before_it() {
    let design = counter(4, 4);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["enable", "count", "next"], &[], 4);
        assert_eq!((run.clocks(), run.rows.row(0)), (vec![0], vec![0, 4, 5]));
        run.set("enable", 1);
        run.reset();
        assert_eq!((run.clocks(), run.rows.row(0)), (vec![0], vec![1, 4, 5]));
        run.run(1);
        assert_eq!(run.rows.row(1), [1, 5, 6]);
    });
}

#[test]
fn an_engine_is_built_reset_with_all_inputs_0() {
    let design = counter(4, 9);
    on_every_engine(|kind| {
        let engine = kind.build(&design, &Watch::default());
        assert_eq!(engine.clock(), 0);
        let values = ["enable", "count", "next", "odd"].map(|name| engine.value(net(&design, name)));
        assert_eq!(values, [0, 9, 10, 1]);
    });
}

#[test]
fn a_reset_in_the_middle_takes_registers_and_clock_back_but_leaves_the_inputs() {
    let design = counter(4, 2);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["enable", "count"], &[], 8);
        run.set("enable", 1);
        run.run(4);
        assert_eq!((run.engine.clock(), run.value("count")), (4, 5));
        run.reset();
        assert_eq!((run.engine.clock(), run.value("count"), run.value("next")), (0, 2, 3));
        run.run(2);
        assert_eq!(run.clocks(), [0, 1, 2]);
        assert_eq!(run.column(0), [1, 1, 1]);
        assert_eq!(run.column(1), [2, 3, 4]);
    });
}

#[test]
fn a_reset_forgets_the_rows_held_so_that_every_row_keeps_its_clock() {
    let design = counter(4, 2);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["count"], &[], 4);
        run.set("enable", 1);
        run.run(3);
        assert_eq!((run.clocks(), run.rows.is_full()), (vec![0, 1, 2, 3], true));
        // Not cleared before.
        run.engine.reset(&mut run.rows);
        run.run(2);
        assert_eq!((run.clocks(), run.column(0)), (vec![0, 1, 2], vec![2, 3, 4]));
    });
}

#[test]
fn a_run_of_0_clocks_changes_and_records_nothing() {
    let design = counter(4, 5);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["count"], &["at_5"], 1);
        run.set("enable", 1);
        // Neither the stop net, which is 1, nor the full rows are the reason.
        assert_eq!(run.run(0), Stop::Clocks);
        assert_eq!((run.engine.clock(), run.rows.len()), (0, 1));
        assert_eq!((run.value("enable"), run.value("count")), (0, 5));
    });
}

#[test]
fn a_run_ends_in_the_sample_where_a_stop_net_is_1_and_the_next_goes_on_from_there() {
    let design = counter(3, 0);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["count"], &["at_5"], 32);
        run.set("enable", 1);
        run.reset();
        assert_eq!(run.run(u64::MAX), Stop::Net(0));
        assert_eq!((run.engine.clock(), run.value("count")), (5, 5));
        assert_eq!(run.column(0), [0, 1, 2, 3, 4, 5], "the sample that stops is recorded");
        assert_eq!(run.run(7), Stop::Clocks);
        assert_eq!(run.run(1), Stop::Net(0));
        assert_eq!(run.engine.clock(), 13);
    });
}

#[test]
fn of_two_stop_nets_that_are_1_the_first_in_the_list_is_named() {
    let design = counter(4, 0);
    on_every_engine(|kind| {
        for (stops, reasons) in [
            (["at_5", "odd"], [(1, Stop::Net(1)), (3, Stop::Net(1)), (5, Stop::Net(0)), (7, Stop::Net(1))]),
            (["odd", "at_5"], [(1, Stop::Net(0)), (3, Stop::Net(0)), (5, Stop::Net(0)), (7, Stop::Net(0))]),
        ] {
            let mut run = Recorder::new(kind, &design, &["count"], &stops, 32);
            run.set("enable", 1);
            run.reset();
            for (clock, reason) in reasons {
                assert_eq!(run.run(10), reason, "{stops:?}");
                assert_eq!(run.engine.clock(), clock, "{stops:?}");
            }
        }
    });
}

#[test]
fn a_run_ends_where_the_rows_are_full_and_goes_on_when_there_is_room() {
    let design = counter(4, 0);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["count"], &[], 3);
        run.set("enable", 1);
        run.reset();
        assert_eq!(run.run(100), Stop::RowsFull);
        assert_eq!(run.run(100), Stop::RowsFull, "no room, no clock");
        assert_eq!((run.engine.clock(), run.clocks()), (2, vec![0, 1, 2]));
        run.rows.clear();
        assert_eq!(run.run(3), Stop::Clocks, "the clocks asked for just fit");
        assert_eq!((run.rows.first_clock(), run.column(0)), (3, vec![3, 4, 5]));
        assert!(run.rows.is_full());
    });
}

#[test]
fn a_sample_that_fills_the_rows_and_stops_is_a_stop() {
    let design = counter(4, 0);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &["count"], &["at_5"], 6);
        run.set("enable", 1);
        run.reset();
        assert_eq!(run.run(100), Stop::Net(0));
        assert!(run.rows.is_full());
        assert_eq!(run.run(100), Stop::RowsFull);
    });
}

#[test]
fn without_columns_nothing_is_recorded_and_no_run_ends_for_want_of_room() {
    let design = counter(4, 0);
    on_every_engine(|kind| {
        let mut run = Recorder::new(kind, &design, &[], &["at_5"], 2);
        run.set("enable", 1);
        run.reset();
        assert_eq!(run.run(100), Stop::Net(0));
        assert_eq!(run.run(15), Stop::Clocks);
        assert_eq!((run.engine.clock(), run.value("count")), (20, 4));
        assert!(run.rows.is_empty());
    });
}

#[test]
fn columns_stand_in_the_order_asked_for_and_a_net_may_be_asked_for_twice() {
    let design = counter(4, 3);
    on_every_engine(|kind| {
        let run = Recorder::new(kind, &design, &["next", "count", "next", "enable"], &[], 1);
        assert_eq!(run.rows.row(0), [4, 3, 4, 0]);
    });
}

#[test]
fn two_engines_of_one_design_do_not_disturb_each_other() {
    let design = counter(4, 0);
    on_every_engine(|kind| {
        let mut first = Recorder::new(kind, &design, &["count"], &[], 8);
        let second = Recorder::new(kind, &design, &["count"], &[], 8);
        first.set("enable", 1);
        first.run(3);
        assert_eq!((first.value("count"), second.value("count")), (2, 0));
        assert_eq!((first.engine.clock(), second.engine.clock()), (3, 0));
    });
}
