//! How fast lanes run: `cargo bench --bench lanes`, with a part of a line's name to run only those.
//!
//! Prints, for one thread and for all, millions of clocks a second summed over all lanes, by the clock on the wall and by
//! the time computed (of all threads together: a busy machine does not change it); `bare` watches nothing but
//! `done` and the positions, `watched` also traps, counts pulses and steps, and looks for stalls; `short` runs every 7-bit geometry of a
//! box from its words to its outcome, and prints geometries a second as well.

#![allow(missing_docs, clippy::print_stdout, clippy::unwrap_used)]

use std::time::Instant;

use stepwave::testbench::Testbench;
use stepwave_engine::lanes::{Job, LaneProgram, LaneWatch, Observe};
use stepwave_models::options::WIDTH;
use stepwave_models::{Options, find};
use stepwave_nc::{Arc, Curve, Direction, Line};
use stepwave_netlist::Width;

const MODELS: [&str; 4] = ["dda-line", "ppc-line", "dda-arc", "ppc-arc"];
/// Enough for every lane of both threads, twice.
const JOBS: usize = 1024;
const CLOCKS: u64 = 500_000;

fn line(to: [i64; 2]) -> Curve {
    Curve::Line(Line::new(vec![0, 0], to.to_vec()).unwrap())
}

fn arc(from: [i64; 2], to: [i64; 2]) -> Curve {
    Curve::Arc(Arc::new(from, to, [0, 0], Direction::CounterClockwise).unwrap())
}

/// A curve that needs `bits` bits and changes with `index`.
fn curve(model: &str, bits: u32, index: usize) -> Curve {
    let index = i64::try_from(index).unwrap();
    let large = (1i64 << bits) - 1;
    if model.ends_with("line") {
        line([large - index % 7 * (large / 8), (large / 3 + index * 977) % large + 1])
    } else {
        // A full circle, from a start that moves around its first quadrant.
        let x = large / 2 + index * (large / 4096).max(1) % (large / 4);
        let start = [x, large / 3];
        arc(start, start)
    }
}

fn bench(model: &str, bits: u32) -> Testbench {
    let width = Width::new(u64::from(bits)).unwrap();
    let choices = Options::default().with_all(&WIDTH, width);
    let widest = if model.ends_with("line") {
        let large = (1i64 << bits) - 1;
        line([large, large])
    } else {
        let large = (1i64 << bits) - 1;
        arc([large, 0], [large, 0])
    };
    Testbench::new(find(model).unwrap(), &widest, &choices).unwrap()
}

/// Seconds that this process has computed, on all threads together; the clock on the wall where that is not known.
fn computed(start: Instant) -> f64 {
    let ticks = || -> Option<f64> {
        let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
        // User time is the 14th field; the second, in parentheses, may hold spaces.
        stat.rsplit(')').next()?.split_whitespace().nth(11)?.parse().ok()
    };
    ticks().map_or_else(|| start.elapsed().as_secs_f64(), |ticks| ticks / 100.0)
}

/// A measurement: start on the wall and in seconds computed.
struct Watch(Instant, f64);

impl Watch {
    fn start() -> Watch {
        let now = Instant::now();
        Watch(now, computed(now))
    }

    #[allow(clippy::cast_precision_loss)]
    fn print(&self, name: &str, threads: usize, clocks: u64, geometries: usize) {
        let (wall, computed) = (self.0.elapsed().as_secs_f64(), computed(self.0) - self.1);
        let (clocks, geometries) = (clocks as f64 / 1e6, geometries as f64 / 1e3);
        println!(
            "{name:<28} {threads} threads {:>8.0} Mlane-clocks/s on the wall {:>8.0} per second computed \
             {:>8.1} k geometries/s",
            clocks / wall,
            clocks / computed,
            geometries / wall,
        );
    }
}

fn bare(model: &str, name: &str, threads: usize) {
    let bench = bench(model, 24);
    let machine = bench.machine();
    let watch = LaneWatch {
        rest: vec![(machine.load.net, 0), (machine.preset_position.net, 0)],
        observe: machine.positions.iter().map(|port| Observe::Last(port.net)).collect(),
        limit: CLOCKS,
        ..LaneWatch::new(machine.done.net)
    };
    let program = LaneProgram::new(bench.design(), &watch);
    let lanes = bench.lanes(CLOCKS).unwrap();
    let jobs: Vec<Job> = (0..JOBS).map(|index| lanes.job(&curve(model, 24, index)).unwrap()).collect();
    let watch = Watch::start();
    let ends = program.run_all(jobs);
    let name = format!("{name} ({} operations)", program.operations());
    watch.print(&name, threads, ends.iter().map(|end| end.clock).sum(), JOBS);
}

fn watched(model: &str, name: &str, threads: usize) {
    let bench = bench(model, 24);
    let curves: Vec<Curve> = (0..JOBS).map(|index| curve(model, 24, index)).collect();
    let lanes = bench.lanes(CLOCKS).unwrap();
    let (mut clocks, watch) = (0, Watch::start());
    lanes.run(curves.iter(), |outcome| clocks += outcome.unwrap().clocks);
    let name = format!("{name} ({} operations)", lanes.program().operations());
    watch.print(&name, threads, clocks, JOBS);
}

fn short(model: &str, name: &str, threads: usize) {
    let bench = bench(model, 7);
    let mut curves = Vec::new();
    for x in 1..=127 {
        for y in 1..=127 {
            curves.push(if model.ends_with("line") { line([x, y]) } else { arc([x, y / 2], [x, y / 2]) });
        }
    }
    let lanes = bench.lanes(1_000_000).unwrap();
    let (mut clocks, watch) = (0, Watch::start());
    lanes.run(curves.iter(), |outcome| clocks += outcome.map_or(0, |outcome| outcome.clocks));
    watch.print(name, threads, clocks, curves.len());
}

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).collect();
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    for (kind, measure) in [("bare", bare as fn(&str, &str, usize)), ("watched", watched), ("short", short)] {
        for model in MODELS {
            let name = format!("{kind} {model}");
            if !wanted.is_empty() && !wanted.iter().any(|wanted| name.contains(wanted.as_str())) {
                continue;
            }
            for threads in [1, all] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| measure(model, &name, threads));
            }
        }
    }
}
