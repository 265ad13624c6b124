//! Random netlists with random jobs.

use proptest::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_engine::lanes::{Job, LaneStop, LaneWatch, Observe, Quiet};
use stepwave_netlist::cells::Op;
use stepwave_netlist::{Design, Net, elaborate};

use super::assert_each_as_alone;
use crate::engine::random::config;
use crate::engine::random::recipe::{build, recipe, value};

/// Numbers that pick nets of any netlist.
#[derive(Clone, Debug)]
struct Plan {
    done: u16,
    traps: Vec<u16>,
    rest: Vec<(u16, u64)>,
    quiet: Option<(Vec<u16>, u64, u64)>,
    limit: u64,
    wide: bool,
    jobs: Vec<Vec<Vec<(u16, u64)>>>,
}

fn plan() -> impl Strategy<Value = Plan> {
    let inputs = || prop::collection::vec((any::<u16>(), value()), 0..4);
    let quiet = (prop::collection::vec(any::<u16>(), 0..4), 0u64..8, 1u64..6);
    (
        any::<u16>(),
        prop::collection::vec(any::<u16>(), 0..3),
        inputs(),
        prop::option::of(quiet),
        0u64..24,
        any::<bool>(),
        prop::collection::vec(prop::collection::vec(inputs(), 0..4), 0..40),
    )
        .prop_map(|(done, traps, rest, quiet, limit, wide, jobs)| Plan {
            done,
            traps,
            rest,
            quiet,
            limit,
            wide,
            jobs,
        })
}

/// The nets that every engine evaluates.
fn live(design: &Design) -> Vec<Net> {
    [design.inputs(), design.registers(), design.order()].concat()
}

fn watch(design: &Design, plan: &Plan) -> LaneWatch {
    let (nets, netlist) = (live(design), design.netlist());
    let flags: Vec<Net> = nets.iter().copied().filter(|&net| netlist.width(net).get() == 1).collect();
    let pick = |from: &[Net], which: u16| from[usize::from(which) % from.len()];
    let done = if flags.is_empty() { nets[0] } else { pick(&flags, plan.done) };
    let traps = plan.traps.iter().filter(|_| !flags.is_empty()).map(|&trap| pick(&flags, trap)).collect();
    let quiet = |(some, clocks, every): &(Vec<u16>, u64, u64)| Quiet {
        nets: some.iter().map(|&which| pick(&nets, which)).collect(),
        clocks: *clocks,
        every: *every,
    };
    let observe = nets.iter().enumerate().flat_map(|(index, &net)| {
        let signed = index % 2 == 0;
        let counted = nets[index..].iter().copied().take(1 + index % 3).collect();
        // Sums that 32 bits hold, for any number of clocks, so that narrow lanes are tried too.
        let bits = netlist.width(net).get();
        let sum = (bits <= 16).then_some(Observe::Sum { net, bits: 32 });
        let gaps = (bits <= 16).then_some(Observe::RootGaps { base: net, offset: nets[index / 2], bits: 32 });
        let gaps = gaps.filter(|_| netlist.width(nets[index / 2]).get() <= 16);
        [
            Observe::Last(net),
            Observe::Min { net, signed },
            Observe::Max { net, signed },
            Observe::Count(counted),
            Observe::Since(net),
            Observe::LeastGap(net),
            Observe::GreatestGap(net),
        ]
        .into_iter()
        .chain(sum)
        .chain(gaps)
    });
    // Sometimes little is observed, so that much of the netlist is dead.
    let observe: Vec<Observe> =
        if plan.limit.is_multiple_of(3) { observe.take(3).collect() } else { observe.collect() };
    let more = if plan.wide { 1 << 40 } else { 0 };
    LaneWatch {
        traps,
        rest: plan.rest.iter().map(|&(input, value)| (pick(design.inputs(), input), value)).collect(),
        observe,
        quiet: plan.quiet.as_ref().map(quiet),
        // A high limit makes lanes wide; a quiet net ends those runs.
        limit: if plan.quiet.as_ref().is_some_and(|(nets, ..)| nets.is_empty()) {
            plan.limit + more
        } else {
            plan.limit
        },
        ..LaneWatch::new(done)
    }
}

fn jobs(design: &Design, plan: &Plan) -> Vec<Job> {
    let inputs = design.inputs();
    let block = |block: &Vec<(u16, u64)>| {
        block.iter().map(|&(input, value)| (inputs[usize::from(input) % inputs.len()], value)).collect()
    };
    plan.jobs.iter().map(|blocks| Job { blocks: blocks.iter().map(block).collect() }).collect()
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn every_lane_of_a_random_netlist_ends_as_its_job_alone(recipe in recipe(), plan in plan()) {
        let design = elaborate(build(&recipe)).unwrap();
        // `done` of one bit: where there is none, nothing is to be run.
        let watch = watch(&design, &plan);
        prop_assume!(design.netlist().width(watch.done).get() == 1);
        let ends = assert_each_as_alone(&design, &watch, &jobs(&design, &plan), EngineKind::Gates);
        prop_assert!(ends.iter().all(|end| end.stop == LaneStop::Done || end.clock > 0));
        prop_assert!(design.inputs().iter().all(|&net| design.netlist().cell(net).op == Op::Input));
    }
}
