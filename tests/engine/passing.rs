//! Samples in which a machine is idle are passed over, and nothing is lost by it.

use proptest::prelude::*;
use stepwave_engine::{Engine, EngineKind, Idle, Rows, Stop, Watch, passing_after};
use stepwave_netlist::dsl::Module;
use stepwave_netlist::{Design, Net, elaborate};

/// A phase that steps a counter, which wraps and is kept in a copy at every second step; and a flag.
struct Stepper {
    design: Design,
    rate: Net,
    phase: Net,
    watch: Watch,
    idle: Idle,
}

fn stepper() -> Stepper {
    let module = Module::new("stepper");
    let m = module.top();
    let rate = m.input("rate", 17);
    let phase = m.reg("phase", 16);
    let sum = m.name("sum", phase.q.extend(17).wrapping_add(rate));
    phase.set(sum.slice(0, 16));
    let step = m.name("step", sum.msb());
    let count = m.reg("count", 5);
    count.when(step, count.q.wrapping_add(m.lit(5, 1))).else_hold();
    let copy = m.reg("copy", 5);
    copy.when(step & count.q.bit(0), count.q).else_hold();
    // A memory that is written at some steps, long after registers have changed, and read in others.
    let phases = m.memory("phases", 16, 21).initial([5, 6]);
    phases.write(step & count.q.bit(1), count.q, phase.q, None);
    let last = m.name("last", phases.read(copy.q));
    phases.write(phase.q.equals(last), copy.q, last.wrapping_add(m.lit(16, 77)), None);
    // One that holds nothing: it changes with a step and after it.
    let stepped = m.reg("stepped", 1);
    stepped.set(step);
    // One that changes in clocks that only the phase determines.
    let flag = m.name("flag", phase.q.slice(0, 9).is_zero());
    let stop = m.name("stop", count.q.is_zero() & stepped.q);
    let nets = [phase.q, count.q, copy.q, stepped.q, flag, stop, last].map(|signal| signal.net());
    let (rate, phase) = (rate.net(), phase.q.net());
    let watch = Watch { columns: nets.to_vec(), stops: vec![nets[5]] };
    let idle = Idle { running: vec![phase], flags: vec![nets[4]] };
    Stepper { design: elaborate(module.finish().unwrap()).unwrap(), rate, phase, watch, idle }
}

/// What was recorded: clock and values; and the least and greatest phase and the bits of it that toggled.
#[derive(Default)]
struct Seen {
    rows: Vec<(u64, Vec<u64>)>,
    phase: Option<stepwave_engine::Extremes>,
}

impl Seen {
    fn take(&mut self, rows: &mut Rows) {
        self.rows.extend(rows.iter());
        if let Some(later) = rows.extremes(0, 0) {
            self.phase = Some(self.phase.map_or(later, |before| before.and(later)));
        }
        rows.clear();
    }
}

/// Runs with each of the rates for this many clocks, and returns the clocks at which it stopped.
fn run(of: &Stepper, engine: &mut dyn Engine, mut rows: Rows, rates: &[(u64, u64)]) -> (Seen, Vec<u64>) {
    let (mut seen, mut stops) = (Seen::default(), Vec::new());
    engine.reset(&mut rows);
    for &(rate, clocks) in rates {
        engine.set_input(of.rate, rate);
        let end = engine.clock() + clocks;
        while engine.clock() < end {
            match engine.run(end - engine.clock(), &mut rows) {
                Stop::Net(_) => stops.push(engine.clock()),
                Stop::RowsFull => seen.take(&mut rows),
                Stop::Clocks => {}
            }
            if rows.is_full() {
                seen.take(&mut rows);
            }
        }
    }
    seen.take(&mut rows);
    (seen, stops)
}

/// That no sample is lost in which anything but the phase changes.
fn assert_as_whole(rates: &[(u64, u64)], warm_up: u64, room: usize) -> (usize, usize) {
    let of = stepper();
    let columns = of.watch.columns.len();
    let mut word = EngineKind::Word.build(&of.design, &of.watch);
    let (whole, stops) = run(&of, word.as_mut(), Rows::new(columns, room), rates);
    let mut passing = passing_after(&of.design, &of.watch, &of.idle, warm_up);
    let (seen, seen_stops) = run(&of, passing.as_mut(), Rows::sparse(columns, room), rates);
    assert_eq!(stops, seen_stops);
    assert_eq!((passing.clock(), passing.value(of.phase)), (word.clock(), word.value(of.phase)));
    let extremes = |seen: &Seen| seen.phase.map(|phase| (phase.least, phase.greatest, phase.toggled));
    assert_eq!(extremes(&seen), extremes(&whole));
    let mut recorded = seen.rows.iter().peekable();
    let mut last: Option<&Vec<u64>> = None;
    for (clock, values) in &whole.rows {
        match recorded.next_if(|(at, _)| at == clock) {
            Some((_, row)) => assert_eq!(row, values, "clock {clock}"),
            None => {
                assert_eq!(last.map(|row| &row[1..4]), Some(&values[1..4]), "clock {clock} was passed over");
                assert_eq!(values[4..6], [0, 0], "clock {clock} was passed over");
                assert_eq!(last.map(|row| &row[4..]), Some(&values[4..]), "clock {clock} was passed over");
            }
        }
        last = Some(values);
    }
    assert_eq!(recorded.next(), None);
    (seen.rows.len(), whole.rows.len())
}

#[test]
fn a_slow_machine_is_recorded_where_it_steps_alone() {
    // A step every 512 clocks, the flag every 4; then a step every 4096 clocks and never the flag.
    let (recorded, all) = assert_as_whole(&[(128, 20_000), (16 + 1, 200_000)], 100, 64);
    assert!(recorded < all / 10, "{recorded} of {all} samples");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(40) })]

    #[test]
    fn no_sample_is_lost_in_which_anything_but_the_phase_changes(
        rates in prop::collection::vec((prop_oneof![0u64..40, 0u64..=1 << 16], 1u64..3000), 1..8),
        warm_up in 1u64..200,
        room in 1usize..100,
    ) {
        assert_as_whole(&rates, warm_up, room);
    }
}
