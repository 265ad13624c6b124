//! Many geometries of one netlist at once: every lane of a block runs the same design with inputs of its own.
//!
//! A net is a row of words, one a lane; an operation runs over all lanes in one loop without a branch. A lane whose job
//! has ended takes the next one, so that short jobs do not wait for long ones. Every lane behaves exactly as an
//! [`Engine`](super::Engine) that runs its job alone:
//!
//! 1. The inputs of the job's first block are set, and the machine is reset: sample 0.
//! 2. The inputs [`LaneWatch::rest`] take their values after the next edge, and the job runs, at least one clock, until
//!    `done` or a trap is 1 in a sample, the limit is reached, or nothing happens any more.
//! 3. If it was `done` and there is a further block, its inputs change after the next edge, one clock is done
//!    regardless of the sample, and 2. follows.
//!
//! A lane has a copy of each memory that is written, with its first words again for every job; a memory that nothing
//! writes is there once. Where the copies of all lanes would take more than half a gigabyte, fewer lanes run at once.
//!
//! Long runs go over to native code where the processor has AVX2 (`native`, `avx`): a loop for one vector of lanes, each of
//! which runs until one of its own lanes is to be looked at.
//!
//! What is loaded only while the inputs do not rest is folded away from the code that runs the lanes (`lower`,
//! `fuse`, `build`); a second code for the whole design loads blocks and reads the last sample (`worker`).

mod avx;
mod build;
mod code;
mod feed;
mod fuse;
mod lane;
mod lane_machine;
mod lane_memory;
mod lower;
mod native;
mod watch;
mod worker;

use rustc_hash::FxHashMap as HashMap;

use build::LaneRequest;
use code::Code;
use feed::Feed;
use lane_memory::{fitting, own_words};
use native::Native;
use stepwave_netlist::Design;
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Memory, Net, Op};
use stepwave_netlist::passes::simplify;
use watch::Reduce;
pub use watch::{Job, LaneEnd, LaneStop, LaneWatch, Observe, Quiet, ROOT_GAP_UNIT, root_gap};
use worker::Worker;
#[cfg(all(feature = "jit", target_arch = "x86_64"))]
pub(crate) use {avx::Compiled, lane::Lane};

/// Code that runs one design in many lanes.
#[derive(Clone, Debug)]
pub struct LaneProgram {
    watch: LaneWatch,
    /// Width of the net of each number asked for.
    widths: Vec<Width>,
    /// The design's memories; `None` is one that nothing observed depends on.
    memories: Vec<Option<Memory>>,
    /// All inputs with their widths.
    inputs: Vec<(Net, Width)>,
    reduce: Vec<Reduce>,
    /// With the inputs at rest: registers, accumulators, and whether to stop.
    running: Code,
    /// With any inputs: the same registers and accumulators, and `done`, the traps and the last values.
    whole: Code,
    /// A net is wider than 32 bits, or a count may be.
    wide: bool,
    /// Native code of `running`, once it is worth it.
    native: Native,
}

impl LaneProgram {
    /// Code for a design.
    ///
    /// # Panics
    /// If a net of the watch is not in the design.
    #[must_use]
    pub fn new(design: &Design, watch: &LaneWatch) -> LaneProgram {
        let netlist = design.netlist();
        let ends: Vec<Net> = [watch.done].into_iter().chain(watch.traps.iter().copied()).collect();
        let (accumulators, last) = accumulators(watch);
        let observed = accumulators.iter().flat_map(|(_, nets)| nets).chain(&last).chain(&ends);
        let Needed { registers, memories, widest } = needed(design, observed.copied().collect());

        let code = |fixed: &HashMap<Net, u64>, outputs: &[Net], any: &[Net]| {
            let simple = simplify(netlist, fixed);
            let go = |nets: &[Net]| nets.iter().map(|&net| simple.net(net)).collect::<Vec<_>>();
            let accumulators: Vec<_> = accumulators.iter().map(|(reduce, nets)| (*reduce, go(nets))).collect();
            LaneRequest {
                netlist: &simple.netlist,
                inputs: &go(design.inputs()),
                registers: &go(&registers),
                memories: &memories,
                accumulators: &accumulators,
                outputs: &go(outputs),
                any: &go(any),
            }
            .build()
        };
        let rest = watch.rest.iter().map(|&(net, value)| (net, value & netlist.width(net).mask())).collect();
        let running = code(&rest, &[], &ends);
        let whole = code(&HashMap::default(), &[&ends[..], &last].concat(), &[]);
        let width = |observe: &Observe| match observe {
            Observe::Last(net) | Observe::Min { net, .. } | Observe::Max { net, .. } => netlist.width(*net),
            _ => Width::MAX,
        };
        let all = netlist.memories.iter().enumerate();
        LaneProgram {
            widths: watch.observe.iter().map(width).collect(),
            memories: all.map(|(index, memory)| memories.contains(&index).then(|| memory.clone())).collect(),
            inputs: design.inputs().iter().map(|&net| (net, netlist.width(net))).collect(),
            reduce: accumulators.iter().map(|(reduce, _)| *reduce).collect(),
            wide: widest > 32
                || watch.limit >= u64::from(u32::MAX)
                || watch.observe.iter().any(|observe| is_wide(observe, watch.limit)),
            watch: watch.clone(),
            running,
            whole,
            native: Native::after(native::WARM_UP),
        }
    }

    /// The same, with native code once this many samples of lanes have run without it; for tests. Usually that is after as
    /// many as take about as long as compiling does.
    #[doc(hidden)]
    #[must_use]
    pub fn compiled_after(self, samples: u64) -> LaneProgram {
        LaneProgram { native: Native::after(samples), ..self }
    }

    /// Native code runs the lanes now.
    #[doc(hidden)]
    #[must_use]
    pub fn is_native(&self) -> bool {
        self.native.is_compiled()
    }

    /// Runs jobs on all threads of the present `rayon` pool. `prepare` makes a job of an item, in parallel; `sink` gets
    /// the ends, or what `prepare` failed with, in the order of the items, one at a time. Neither the number of items
    /// nor that of threads changes what it gets; memory does not grow with the number of items.
    pub fn run<J: Send, E: Send>(
        &self,
        items: impl Iterator<Item = J> + Send,
        prepare: impl Fn(J) -> Result<Job, E> + Sync,
        sink: impl FnMut(Result<LaneEnd, E>) + Send,
    ) {
        let words = own_words(self.memories.iter().flatten());
        let (threads, lanes) =
            fitting(rayon::current_num_threads(), words.saturating_mul(if self.wide { 8 } else { 4 }));
        // Few jobs are spread over all threads.
        let share = match items.size_hint() {
            (0, _) => usize::MAX,
            (least, _) => least.div_ceil(threads),
        };
        let feed = Feed::new(items, sink);
        rayon::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|_| {
                    if self.wide {
                        Worker::<u64>::new(self, lanes).work(&feed, share, &prepare);
                    } else {
                        Worker::<u32>::new(self, lanes).work(&feed, share, &prepare);
                    }
                });
            }
        });
    }

    /// Runs jobs as [`run`](LaneProgram::run) and collects their ends.
    #[must_use]
    pub fn run_all(&self, jobs: Vec<Job>) -> Vec<LaneEnd> {
        let mut ends = Vec::with_capacity(jobs.len());
        self.run(jobs.into_iter(), Ok::<Job, std::convert::Infallible>, |end| {
            let Ok(end) = end;
            ends.push(end);
        });
        ends
    }

    /// Operations done for every lane and clock.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.running.operations.len()
    }
}

/// The accumulators, in the order of what is observed and then those that others read, the quiet one last; and the nets
/// whose last values are wanted.
fn accumulators(watch: &LaneWatch) -> (Vec<(Reduce, Vec<Net>)>, Vec<Net>) {
    let mut last = Vec::new();
    let mut since: Vec<Net> = Vec::new();
    let mut accumulators: Vec<(Reduce, Vec<Net>)> = Vec::new();
    // Where the clocks since a net was not 0 will be counted: after all that is observed.
    let observed = watch.observe.iter().filter(|observe| !matches!(observe, Observe::Last(_))).count();
    let mut counted = |net: Net| {
        let known = since.iter().position(|&known| known == net);
        observed
            + known.unwrap_or_else(|| {
                since.push(net);
                since.len() - 1
            })
    };
    for observe in &watch.observe {
        let reduce = match observe {
            Observe::Last(net) => {
                last.push(*net);
                continue;
            }
            Observe::Min { signed, .. } => Reduce::Least { signed: *signed },
            Observe::Max { signed, .. } => Reduce::Greatest { signed: *signed },
            Observe::Count(_) => Reduce::Count,
            Observe::Sum { .. } => Reduce::Sum,
            Observe::RootGaps { .. } => Reduce::RootGaps,
            Observe::LeastGap(net) => Reduce::LeastGap { since: counted(*net) },
            Observe::GreatestGap(net) => Reduce::GreatestGap { since: counted(*net) },
            Observe::Since(_) => Reduce::Since,
        };
        accumulators.push((reduce, observe.nets().collect()));
    }
    accumulators.extend(since.into_iter().map(|net| (Reduce::Since, vec![net])));
    accumulators.extend(watch.quiet.iter().map(|quiet| (Reduce::Idle, quiet.nets.clone())));
    (accumulators, last)
}

/// What is gathered may not fit in 32 bits.
fn is_wide(observe: &Observe, limit: u64) -> bool {
    match observe {
        Observe::Sum { bits, .. } | Observe::RootGaps { bits, .. } => *bits > 32,
        // Clocks are counted with a sign.
        Observe::LeastGap(_) | Observe::GreatestGap(_) | Observe::Since(_) => limit >= 1 << 31,
        _ => false,
    }
}

/// What some nets depend on, through any number of edges.
struct Needed {
    registers: Vec<Net>,
    /// By their index in the netlist.
    memories: Vec<usize>,
    /// Bits of the widest net on these paths.
    widest: u32,
}

fn needed(design: &Design, mut pending: Vec<Net>) -> Needed {
    let netlist = design.netlist();
    let mut seen = vec![false; netlist.cells.len()];
    let (mut widest, mut memories) = (1, Vec::new());
    while let Some(net) = pending.pop() {
        if std::mem::replace(&mut seen[net.index()], true) {
            continue;
        }
        let cell = netlist.cell(net);
        widest = widest.max(cell.width.get());
        cell.op.visit_inputs(|input| pending.push(input));
        if let Op::Register { next: Some(next), .. } = cell.op {
            pending.push(next);
        }
        if let Op::Read { memory, .. } = cell.op
            && !memories.contains(&(memory as usize))
        {
            memories.push(memory as usize);
            pending.extend(netlist.memories[memory as usize].writes.iter().flat_map(|port| port.nets()));
        }
    }
    let registers = design.registers().iter().copied().filter(|net| seen[net.index()]).collect();
    Needed { registers, memories, widest }
}
