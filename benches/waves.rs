//! What a wave costs: clocks a second through the writers, one model after another.
//!
//! `cargo bench --bench waves [MODEL]`. The samples are recorded before, and are handed over as in a run, block by
//! block; so the engine is not part of the figures.

use std::fs::File;
use std::hint::black_box;
use std::io::{self, Cursor, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use stepwave::engine::{EngineKind, Rows};
use stepwave::models::{Options, find};
use stepwave::nc::{Arc, Curve, Direction, Line};
use stepwave::testbench::{Observer, ObserverError, OverflowWatch, RangeWatch, Testbench, WaveWriter, Window};
use stepwave::trace::fst::FstHeader;
use stepwave::trace::probe::{Probe, Selection};
use stepwave::trace::timescale::ClockTime;
use stepwave::trace::vcd::VcdHeader;

#[path = "shared/time.rs"]
mod time;

use time::own_time;

type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// Clocks written in one round.
const CLOCKS: usize = 1 << 20;
/// Blocks that are written again and again: few, since an engine hands over a block that is still in the cache.
const BLOCKS: usize = 8;
/// Clock from which on they are recorded.
const FROM: u64 = 1_000_000;

/// Some blocks from the midst of a run.
#[derive(Default)]
struct Recorder {
    blocks: Vec<Rows>,
}

/// Ends the run.
#[derive(Debug)]
struct Enough;

impl std::fmt::Display for Enough {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("enough")
    }
}

impl std::error::Error for Enough {}

impl Observer for Recorder {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        if rows.first_clock() >= FROM {
            self.blocks.push(rows.clone());
        }
        if self.blocks.len() < BLOCKS { Ok(()) } else { Err(Box::new(Enough)) }
    }
}

/// Counts bytes.
struct Count(usize);

impl Write for Count {
    fn write(&mut self, part: &[u8]) -> io::Result<usize> {
        self.0 += black_box(part).len();
        Ok(part.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn header(probes: &[Probe]) -> VcdHeader<'_> {
    VcdHeader {
        comment: "speed",
        probes,
        time: ClockTime::from_hz(1e6).expect("a usual clock"),
        clk: true,
        states: false,
    }
}

/// What one round took and made.
#[derive(Clone, Copy)]
struct Round {
    wall: Duration,
    /// Time that this thread had a core, which other programs on the machine hardly disturb.
    own: Duration,
    bytes: usize,
}

/// The best of five.
fn best(mut work: impl FnMut() -> Outcome<usize>) -> Outcome<Round> {
    let mut best = Round { wall: Duration::MAX, own: Duration::MAX, bytes: 0 };
    for _ in 0..5 {
        let start = Instant::now();
        let before = own_time(start);
        best.bytes = work()?;
        best.own = best.own.min(own_time(start).saturating_sub(before));
        best.wall = best.wall.min(start.elapsed());
    }
    Ok(best)
}

#[allow(clippy::cast_precision_loss)]
fn report(model: &str, what: &str, clocks: usize, round: Round) -> io::Result<()> {
    let per_second = |count: usize, time: Duration| count as f64 / 1e6 / time.as_secs_f64();
    writeln!(
        io::stdout(),
        "{model:9} {what:22} {:8.1} Mclk/s of this thread's time {:8.1} Mclk/s {:6.0} MB/s on the clock {:6.1} B/clk",
        per_second(clocks, round.own),
        per_second(clocks, round.wall),
        per_second(round.bytes, round.wall),
        round.bytes as f64 / clocks as f64
    )
}

fn observe(observer: &mut impl Observer, blocks: &[Rows]) -> Outcome<usize> {
    let held: usize = blocks.iter().map(Rows::len).sum();
    for _ in 0..CLOCKS / held {
        blocks.iter().try_for_each(|rows| observer.samples(rows))?;
    }
    Ok(0)
}

fn measure(model: &str, curve: Curve) -> Outcome<()> {
    let bench = Testbench::new(find(model)?, &curve, &Options::default())?;
    let mut recorder = Recorder::default();
    let ended = bench.run(EngineKind::Word, &mut [&mut recorder]);
    assert!(ended.is_err_and(|error| error.is::<Enough>()), "{model}: the run is too short");
    let blocks = recorder.blocks;
    let clocks = CLOCKS / blocks.iter().map(Rows::len).sum::<usize>() * blocks.iter().map(Rows::len).sum::<usize>();
    let probes = Selection::default().probes(bench.design(), bench.columns().nets())?;

    let vcd = |out: Count, probes: &[Probe], window| {
        let mut wave = WaveWriter::new(header(probes).write(out)?, window);
        observe(&mut wave, &blocks)?;
        Outcome::Ok(wave.finish()?.0)
    };
    let few: Vec<Probe> = probes.iter().filter(|probe| probe.scopes.len() == 1).cloned().collect();
    let outside = Window { from: u64::MAX, ..Window::default() };
    report(model, "VCD", clocks, best(|| vcd(Count(0), &probes, Window::default()))?)?;
    report(model, "VCD of the top scope", clocks, best(|| vcd(Count(0), &few, Window::default()))?)?;
    report(model, "VCD outside its window", clocks, best(|| vcd(Count(0), &probes, outside))?)?;

    let folder = if Path::new("/dev/shm").is_dir() { tempfile::tempdir_in("/dev/shm")? } else { tempfile::tempdir()? };
    let path = folder.path().join("wave.vcd");
    let size = || Outcome::Ok(usize::try_from(path.metadata()?.len())?);
    let plain = || {
        let mut wave = WaveWriter::new(header(&probes).write(File::create(&path)?)?, Window::default());
        observe(&mut wave, &blocks)?;
        wave.finish()?;
        size()
    };
    report(model, "VCD to a file", clocks, best(plain)?)?;

    // The crate refuses times that go back, so each block is a wave of its own.
    let time = header(&probes).time;
    let fst = || {
        let held: usize = blocks.iter().map(Rows::len).sum();
        (0..CLOCKS / held / 64).try_fold(0, |_, _| {
            let fst = FstHeader { probes: &probes, time, clk: true }.write(Cursor::new(Vec::new()))?;
            let mut wave = WaveWriter::new(fst, Window::default());
            blocks.iter().try_for_each(|rows| wave.samples(rows))?;
            Ok(wave.finish()?.into_inner().len() * (CLOCKS / held / 64))
        })
    };
    report(model, "FST", clocks / 64, best(fst)?)?;

    report(model, "ranges", clocks, best(|| observe(&mut RangeWatch::new(&bench), &blocks))?)?;
    report(model, "overflow", clocks, best(|| observe(&mut OverflowWatch::new(&bench), &blocks))?)?;
    Ok(())
}

fn main() -> Outcome<()> {
    let wanted = std::env::args().skip(1).find(|word| !word.starts_with('-'));
    let line = |to: [i64; 2]| Curve::Line(Line::new(vec![0, 0], to.to_vec()).expect("a line"));
    let arc = |r: i64| Arc::new([r, 0], [0, r], [0, 0], Direction::CounterClockwise).map(Curve::Arc).expect("an arc");
    for (model, curve) in [
        ("dda-line", line([12_000_000, 9_000_001])),
        ("ppc-line", line([12_000_000, 9_000_001])),
        ("dda-arc", arc(10_000_000)),
        ("ppc-arc", arc(10_000_000)),
    ] {
        if wanted.as_deref().is_none_or(|wanted| wanted == model) {
            measure(model, curve)?;
        }
    }
    Ok(())
}
