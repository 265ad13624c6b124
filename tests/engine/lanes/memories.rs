//! Memories in lanes: every lane has its own, and every job begins with the first words.

use stepwave_engine::EngineKind;
use stepwave_engine::lanes::{Job, LaneStop, LaneWatch, Observe};
use stepwave_netlist::{Design, Net};

use super::assert_each_as_alone;
use crate::netlist::{design, net};

/// Counts what each of `clocks` values leaves in a table of `words` words, where a second table, which nothing writes,
/// says what is added at each place; `sum` reads the place that was written last.
fn histogram(words: u64, bits: u32) -> Design {
    design(|m| {
        let load = m.input("load", 1);
        let [start, clocks] = ["start", "clocks"].map(|name| m.input(name, 8));
        let at = m.reg("at", 8);
        at.when(load, start).otherwise(at.q.wrapping_mul(m.lit(8, 5)).wrapping_add(m.lit(8, 3)));
        let left = m.reg("left", 8);
        left.when(load, clocks).when(left.q.is_nonzero(), left.q.wrapping_sub(m.lit(8, 1))).else_hold();
        let table = m.memory("table", bits, words).initial([9, 8, 7]);
        let steps = m.memory("steps", bits, 5).initial([1, 2, 3, 4, 5]);
        let place = at.q.slice(0, 6).extend(20);
        let step = steps.read(at.q.slice(0, 3));
        table.write(left.q.is_nonzero(), place, table.read(place).wrapping_add(step), None);
        m.name("read", table.read(place));
        m.name("last", table.read(m.lit(20, 3)));
        m.name("done", left.q.is_zero());
    })
}

fn jobs(design: &Design, count: u64) -> Vec<Job> {
    let of = |name: &str| net(design, name);
    let block = |job: u64| vec![(of("load"), 1), (of("start"), 37 * job), (of("clocks"), 1 + job * job % 90)];
    (0..count).map(|job| Job { blocks: (0..1 + job % 3).map(|more| block(job + more)).collect() }).collect()
}

fn watch(design: &Design) -> LaneWatch {
    let nets: Vec<Net> = ["read", "last", "at"].map(|name| net(design, name)).to_vec();
    let observe = nets.iter().flat_map(|&net| [Observe::Last(net), Observe::Max { net, signed: false }]).collect();
    LaneWatch { observe, rest: vec![(net(design, "load"), 0)], ..LaneWatch::new(net(design, "done")) }
}

#[test]
fn every_lane_has_its_own_memory_and_every_job_the_first_words() {
    for (words, bits) in [(64, 12), (50, 4), (33, 40)] {
        let design = histogram(words, bits);
        let ends = assert_each_as_alone(&design, &watch(&design), &jobs(&design, 900), EngineKind::Word);
        assert!(ends.iter().all(|end| end.stop == LaneStop::Done));
        let last = |end: &stepwave_engine::lanes::LaneEnd| end.values[2];
        assert!(ends.iter().any(|end| last(end) != last(&ends[0])), "{words} words");
    }
}

#[test]
fn lanes_with_large_memories_are_fewer_and_come_to_the_same() {
    // Eight megabytes a lane: 64 of them.
    let design = histogram(1 << 20, 40);
    assert_each_as_alone(&design, &watch(&design), &jobs(&design, 150), EngineKind::Word);
}
