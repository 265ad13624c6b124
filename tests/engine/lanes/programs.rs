//! Jobs, lanes and threads.

use std::convert::Infallible;

use stepwave_engine::EngineKind;
use stepwave_engine::lanes::{Job, LaneEnd, LaneProgram, LaneStop, LaneWatch, Observe};
use stepwave_netlist::dsl::Module;
use stepwave_netlist::{Design, elaborate};

use super::assert_each_as_alone;

/// A counter that is loaded with a number and counts it down to 0, and how to run it.
fn countdown(bits: u32) -> (Design, LaneWatch, impl Fn(u64) -> Job) {
    let module = Module::new("countdown");
    let m = module.top();
    let (load, word) = (m.input("load", 1), m.input("word", bits));
    let count = m.reg("count", bits);
    count.when(load, word).otherwise(count.q.wrapping_sub(m.lit(bits, 1)));
    let done = m.name("done", count.q.is_zero());
    let [load, word, count, done] = [load, word, count.q, done].map(|signal| signal.net());
    let watch = LaneWatch {
        rest: vec![(load, 0)],
        observe: vec![Observe::Last(count), Observe::Max { net: count, signed: false }, Observe::Count(vec![count])],
        ..LaneWatch::new(done)
    };
    let design = elaborate(module.finish().unwrap()).unwrap();
    (design, watch, move |number| Job { blocks: vec![vec![(load, 1), (word, number)]] })
}

fn done(clock: u64, values: [u64; 3]) -> LaneEnd {
    LaneEnd { stop: LaneStop::Done, clock, values: values.to_vec() }
}

#[test]
fn a_lane_stops_at_its_own_clock_with_its_own_numbers() {
    let (design, watch, job) = countdown(8);
    let ends = LaneProgram::new(&design, &watch).run_all([0, 5, 200].map(&job).to_vec());
    assert_eq!(ends, [done(1, [0, 0, 0]), done(6, [0, 5, 5]), done(201, [0, 200, 200])]);
}

#[test]
fn no_job_one_job_and_any_number_of_jobs_around_full_blocks_each_end_as_alone() {
    for bits in [8, 33, 64] {
        let (design, watch, job) = countdown(bits);
        for jobs in [0, 1, 2, 31, 32, 33, 255, 256, 257, 300, 600] {
            // Long ones among short ones, so that lanes are free at unlike times and take further jobs.
            let jobs: Vec<Job> =
                (0..jobs).map(|index| job(index * 37 % 53 + if index % 64 == 3 { 150 } else { 0 })).collect();
            assert_each_as_alone(&design, &watch, &jobs, EngineKind::Word);
        }
    }
}

#[test]
fn the_results_come_in_the_order_of_the_jobs_whatever_the_number_of_threads() {
    let (design, watch, job) = countdown(12);
    let program = LaneProgram::new(&design, &watch);
    let length = |index: u64| index * 7919 % 301 + if index.is_multiple_of(500) { 3500 } else { 0 };
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut clocks = Vec::new();
        pool.install(|| {
            program.run(
                0..5000,
                |index| Ok::<_, Infallible>(job(length(index))),
                |end| {
                    let Ok(end) = end;
                    clocks.push(end.clock);
                },
            );
        });
        let want: Vec<u64> = (0..5000).map(|index| length(index) + 1).collect();
        assert_eq!(clocks, want, "{threads} threads");
    }
}

#[test]
fn an_item_that_makes_no_job_gives_its_error_in_its_place() {
    let (design, watch, job) = countdown(8);
    let mut got = Vec::new();
    LaneProgram::new(&design, &watch).run(
        0..1000u64,
        |index| if index % 3 == 1 { Err(index) } else { Ok(job(index % 100)) },
        |end| got.push(end.map(|end| end.clock)),
    );
    let want = (0..1000).map(|index| if index % 3 == 1 { Err(index) } else { Ok(index % 100 + 1) });
    assert!(got.into_iter().eq(want));
}

#[test]
fn jobs_are_taken_no_further_ahead_than_a_window() {
    let (design, watch, job) = countdown(20);
    let (taken, given) = (std::sync::atomic::AtomicUsize::new(0), std::sync::atomic::AtomicUsize::new(0));
    let mut farthest = 0;
    let order = std::sync::atomic::Ordering::Relaxed;
    // The first job takes longer than all others together.
    let items = (0..200_000u64).inspect(|_| _ = taken.fetch_add(1, order));
    LaneProgram::new(&design, &watch).run(
        items,
        |index| Ok::<_, Infallible>(job(if index == 0 { 100_000 } else { 1 })),
        |_| {
            let before = given.fetch_add(1, order);
            farthest = farthest.max(taken.load(order) - before);
        },
    );
    assert_eq!(given.load(order), 200_000);
    assert!(farthest <= 1 << 16, "{farthest} jobs ahead");
}

#[test]
fn a_run_that_is_not_done_ends_at_the_limit() {
    let (design, mut watch, job) = countdown(16);
    watch.limit = 100;
    let ends = LaneProgram::new(&design, &watch).run_all([99, 100, 50_000].map(&job).to_vec());
    let limit = |left| LaneEnd { stop: LaneStop::Limit, clock: 100, values: vec![left, left + 99, 100] };
    assert_eq!(ends, [done(100, [0, 99, 99]), limit(1), limit(49_901)]);
}

#[test]
fn a_panic_while_jobs_are_made_comes_out_and_leaves_no_thread_waiting() {
    let (design, watch, job) = countdown(8);
    let program = LaneProgram::new(&design, &watch);
    let run = || {
        program.run(
            0..10_000u64,
            |index| if index == 700 { panic!("no job") } else { Ok::<_, Infallible>(job(index % 50)) },
            |_| {},
        );
    };
    assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(run)).is_err());
}

#[test]
fn what_nothing_observes_costs_no_operation() {
    let (design, watch, _) = countdown(8);
    // The counter, its comparison, and two numbers: the load multiplexer is folded away.
    assert_eq!(LaneProgram::new(&design, &watch).operations(), 4);
    let few = LaneWatch { observe: Vec::new(), ..watch };
    assert_eq!(LaneProgram::new(&design, &few).operations(), 2);
}
