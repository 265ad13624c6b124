//! How fast each engine runs each model on one thread: `cargo bench --bench engines [NAME…]`, with parts of lines'
//! names to run only those.
//!
//! `bare` watches nothing but `done`, `rows` records every net that a run looks at, as the observers get them. The
//! compiled engine has the clocks that it waits before it compiles, and compiling, in its figure.

use std::io::{self, Write};
use std::time::{Duration, Instant};

use stepwave::engine::{EngineKind, Rows, Stop, Watch};
use stepwave::models::{Options, find};
use stepwave::nc::{Arc, Curve, Direction, Line};
use stepwave::testbench::Testbench;

#[path = "shared/time.rs"]
mod time;

use time::own_time;

type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// Clocks of a run: none of the machines comes to its end before.
fn clocks(kind: EngineKind) -> u64 {
    match kind {
        EngineKind::Gates => 1 << 13,
        EngineKind::Word => 1 << 20,
        EngineKind::Compiled => 1 << 25,
    }
}

/// Runs a machine for this many clocks; returns the time taken.
fn run(bench: &Testbench, kind: EngineKind, columns: bool) -> Outcome<Duration> {
    let machine = bench.machine();
    let columns = if columns { bench.columns().nets().to_vec() } else { Vec::new() };
    let mut rows = Rows::new(columns.len(), 256);
    let start = Instant::now();
    let before = own_time(start);
    let mut engine = kind.build(bench.design(), &Watch { columns, stops: vec![machine.done.net] });
    let stimulus = bench.stimulus();
    let mut steps = stimulus.steps.iter();
    let mut set = |engine: &mut dyn stepwave::engine::Engine| {
        for &(net, value) in steps.next().map_or(&[][..], |step| &step.set) {
            engine.set_input(net, value);
        }
    };
    set(&mut *engine);
    engine.reset(&mut rows);
    set(&mut *engine);
    while engine.clock() < clocks(kind) {
        rows.clear();
        if engine.run(clocks(kind) - engine.clock(), &mut rows) == Stop::Net(0) {
            return Err(format!("{} is done at clock {}", bench.hardware().model, engine.clock()).into());
        }
    }
    Ok(own_time(start).saturating_sub(before))
}

#[allow(clippy::cast_precision_loss)]
fn measure(model: &str, curve: &Curve, wanted: &[String]) -> Outcome<()> {
    let bench = Testbench::new(find(model)?, curve, &Options::default())?;
    for kind in EngineKind::ALL {
        for (what, columns) in [("bare", false), ("rows", true)] {
            let name = format!("{model} {} {what}", kind.name());
            if !wanted.is_empty() && !wanted.iter().any(|wanted| name.contains(wanted.as_str())) {
                continue;
            }
            let mut times = (0..5).map(|_| run(&bench, kind, columns)).collect::<Outcome<Vec<_>>>()?;
            times.sort();
            let rate = |time: Duration| clocks(kind) as f64 / 1e6 / time.as_secs_f64();
            let (best, median) = (rate(times[0]), rate(times[2]));
            writeln!(io::stdout(), "{name:24} {best:9.2} Mclk/s of this thread's time, median {median:9.2}")?;
        }
    }
    Ok(())
}

fn main() -> Outcome<()> {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let line = |to: [i64; 2]| {
        Ok::<_, Box<dyn std::error::Error + Send + Sync>>(Curve::Line(Line::new(vec![0, 0], to.to_vec())?))
    };
    let arc = |r: i64| Arc::new([r, 0], [0, r], [0, 0], Direction::CounterClockwise).map(Curve::Arc);
    measure("dda-line", &line([60_000_000, 45_000_001])?, &wanted)?;
    measure("ppc-line", &line([12_000_000, 9_000_001])?, &wanted)?;
    measure("dda-arc", &arc(50_000_000)?, &wanted)?;
    measure("ppc-arc", &arc(10_000_000)?, &wanted)
}
