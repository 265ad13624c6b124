//! Native code against the word engine, on machines made for its assumptions: registers that cycle, that hold for a
//! long time and then do something else, and inputs that change once the loop takes them for constants.

use stepwave_engine::{Engine, EngineKind, Rows, Stop, Watch, compiled_after};
use stepwave_netlist::Design;

use crate::netlist::{design, net};

/// Toggles, a ring of four beats, registers that load in one beat only, a counter that now and then does something, and a
/// memory whose two ports write in different beats, some addresses being outside.
fn machine() -> Design {
    design(|m| {
        let [hold, load] = ["hold", "load"].map(|name| m.input(name, 1));
        let word = m.input("word", 8);
        let toggle = m.reg("toggle", 1);
        toggle.set(!toggle.q);
        let ring = m.reg("ring", 4).reset(1);
        ring.when(hold, ring.q).otherwise(ring.q.slice(0, 3).concat(ring.q.msb()));
        let count = m.reg("count", 8);
        count.when(load, word).when(ring.q.bit(1), count.q.wrapping_add(m.lit(8, 3))).else_hold();
        // Changes in the last beat of the ring only, and holds while the ring is in its other beats.
        let late = m.reg("late", 2);
        let full = count.q.slice(4, 4).equals(m.lit(4, 15));
        late.when(full & ring.q.bit(3), late.q.wrapping_add(m.lit(2, 1))).else_hold();
        let held = m.reg("held", 8).reset(9);
        held.when(load, word).else_hold();
        let log = m.memory("log", 8, 13).initial([7, 0, 9]);
        m.name("logged", log.read(count.q.slice(0, 4)));
        m.name("first", log.read(m.lit(1, 0)));
        log.write(ring.q.bit(1), count.q.slice(1, 4), count.q, None);
        log.write(full & toggle.q, late.q, word, Some(count.q));
        m.name("stop", full & ring.q.bit(2) & toggle.q);
    })
}

/// Runs of any length with changes of the inputs between them; all samples and stops.
fn play(design: &Design, mut engine: Box<dyn Engine>, stops: bool, room: usize) -> Vec<(Option<Stop>, Vec<u64>)> {
    let mut rows = Rows::new(design.netlist().names.len(), room);
    let mut seen = Vec::new();
    let mut show = |stop, rows: &mut Rows| {
        seen.extend(rows.iter().map(|(clock, row)| (stop, [vec![clock], row].concat())));
        rows.clear();
    };
    engine.reset(&mut rows);
    for (round, clocks) in [1, 2, 3, 50, 7, 100, 4, 5, 300, 6].into_iter().enumerate() {
        let round = round as u64;
        engine.set_input(net(design, "hold"), u64::from(round % 3 == 2));
        engine.set_input(net(design, "load"), u64::from(round % 4 == 1));
        engine.set_input(net(design, "word"), 40 * round);
        let end = engine.clock() + clocks;
        while engine.clock() < end {
            let stop = engine.run(end - engine.clock(), &mut rows);
            assert!(stops || !matches!(stop, Stop::Net(_)));
            show(Some(stop), &mut rows);
        }
    }
    seen
}

#[test]
fn loops_compiled_after_any_number_of_clocks_show_what_the_word_engine_shows() {
    let design = machine();
    let columns: Vec<_> = design.netlist().names.iter().map(|named| named.net).collect();
    for stops in [false, true] {
        let watch =
            Watch { columns: columns.clone(), stops: if stops { vec![net(&design, "stop")] } else { Vec::new() } };
        for room in [5, 64, 1000] {
            let want = play(&design, EngineKind::Word.build(&design, &watch), stops, room);
            for warm_up in (0..40).step_by(if room == 64 { 1 } else { 3 }) {
                let got = play(&design, compiled_after(&design, &watch, warm_up), stops, room);
                for (want, got) in want.iter().zip(&got) {
                    assert_eq!(want, got, "compiled after {warm_up} clocks, room for {room}");
                }
                assert_eq!(want.len(), got.len());
            }
        }
    }
}

#[test]
fn rows_may_end_before_they_are_full_and_no_clock_is_lost() {
    let design = machine();
    let columns: Vec<_> = design.netlist().names.iter().map(|named| named.net).collect();
    let watch = Watch { columns, stops: Vec::new() };
    let width = watch.columns.len();
    let mut wanted = Rows::new(width, 3000);
    let mut gates = EngineKind::Gates.build(&design, &watch);
    gates.reset(&mut wanted);
    gates.run(2999, &mut wanted);
    let wanted: Vec<_> = wanted.iter().collect();
    let mut early = 0;
    for room in [1, 2, 3, 9, 30, 255, 256] {
        // One clock alone now and then, wherever the block is; and calls of few clocks.
        for (alone, burst) in [(0, u64::MAX), (1, u64::MAX), (3, u64::MAX), (2, 7)] {
            let mut engine = compiled_after(&design, &watch, 20);
            engine.expect(3000);
            let mut rows = Rows::new(width, room);
            let mut seen = Vec::new();
            let mut show = |rows: &mut Rows| {
                seen.extend(rows.iter());
                rows.clear();
            };
            engine.reset(&mut rows);
            while engine.clock() < 2999 {
                for _ in 0..alone {
                    if rows.is_full() {
                        show(&mut rows);
                    }
                    let before = engine.clock();
                    engine.run(1, &mut rows);
                    assert_eq!(engine.clock(), before + 1, "room for {room}, {} rows held", rows.len());
                }
                let left = 2999_u64.saturating_sub(engine.clock());
                if engine.run(left.min(burst), &mut rows) == Stop::RowsFull {
                    early += usize::from(!rows.is_full());
                    show(&mut rows);
                }
            }
            show(&mut rows);
            assert!(seen[..3000] == wanted[..], "room for {room}, {alone} clocks alone, {burst} at once");
        }
    }
    assert!(early > 20, "{early}");
}
