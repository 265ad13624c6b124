//! How large a wave becomes: estimated before a program runs, and counted while any wave is written.

use std::io::{self, Write};

use crate::models::parts::RATE_BITS;
use crate::models::program::After;
use crate::program::Estimate;
use crate::testbench::Testbench;
use crate::trace::probe::Probe;
use crate::trace::timescale::ClockTime;

use crate::Error;
use crate::waves::limited::{LARGE, REMEDIES};
use crate::waves::{WaveOptions, probes};

/// Bytes above which a program reports the size of its wave before it writes it.
const NOTED: f64 = 1e8;

/// Bytes of VCD that a bit of a vector takes at a step that moves the machine on the average, as measured on machines
/// of every family.
const BIT: f64 = 0.14;
/// Registers that change with every step, also where it moves nothing.
const COUNTING: [&str; 6] = ["q", "jrx", "jry", "accx", "accy", "accz"];
/// Bytes of the three flags that come and go with each step.
const FLAGS: f64 = 18.0;
/// Times at which something changes around a step: its pulse comes, it is taken, and its flags go.
const STAMPS: f64 = 3.0;
/// Bytes of VCD that a bit of a filter after the interpolator takes in a period on the average, as measured.
const FILTERED: f64 = 0.45;
/// Times at which its output changes around a pulse, and its period ends.
const OUTPUTS: f64 = 4.0;
/// Bytes of FST that a clock takes where the pulse source is shown, less where its phase comes round; and what changes
/// at a step, and counts at every step, as parts of what they take as VCD; all as measured.
const FST_CLOCK: f64 = 12.0;
const FST_ROUND: f64 = 0.1;
const FST_STEP: f64 = 0.25;
const FST_COUNT: f64 = 0.1;

/// What the samples of a wave take, in bytes.
pub(super) struct Size {
    /// Signals that change with every clock: the pulse source adds to its phase.
    clock: f64,
    /// What changes at a step that moves the machine.
    step: f64,
    /// What changes at every step.
    count: f64,
    /// What changes with every period after the interpolator, and its clocks.
    filter: Option<(f64, f64)>,
    /// The clock itself is shown.
    clk: bool,
    ticks: f64,
}

impl Size {
    /// Of a machine that runs programs, with the signals chosen.
    ///
    /// # Errors
    /// The options name no signal.
    pub(super) fn of(bench: &Testbench, args: &WaveOptions, time: ClockTime) -> Result<Size, Error> {
        let mut probes = probes(bench, args)?;
        probes.sort_by(|a, b| a.columns.cmp(&b.columns));
        probes.dedup_by(|a, b| a.columns == b.columns);
        let (mut clock, mut step, mut count) = (0.0, 0.0, 0.0);
        let running = bench.machine().running();
        let after = After::of(bench.hardware());
        let mut filtered = 0.0;
        let in_filter =
            |probe: &Probe| after.is_some() && probe.scopes.get(1).is_some_and(|scope| scope.starts_with("after_"));
        let runs = |columns: &[usize]| running.iter().any(|&net| columns == [bench.columns().index(net)]);
        for probe in probes {
            let width = f64::from(probe.width);
            let of_source = probe.name == "sum" && probe.width >= RATE_BITS;
            if of_source || runs(&probe.columns) {
                // A b, a blank, a name of one character and the end of the line.
                clock += width + 4.0;
            } else if COUNTING.contains(&probe.name.as_str()) {
                count += width + 4.0;
            } else if in_filter(&probe) && !probe.name.ends_with("_out") {
                filtered += if width > 1.0 { width + 4.0 } else { 0.0 };
            } else if width > 1.0 {
                step += width * BIT;
            }
        }
        let clk = args.clk && bench.running().is_none();
        let filter = after.map(|after| (filtered, after.period as f64));
        Ok(Size { clock, step, count, filter, clk, ticks: time.ticks() as f64 })
    }

    /// Bytes of the VCD and of the FST that are asked for, 0 where they are not.
    fn bytes(&self, args: &WaveOptions, limit: Option<u64>, estimate: &Estimate) -> [f64; 2] {
        let clocks = limit.map_or(estimate.clocks, |limit| estimate.clocks.min(limit as f64));
        let end = args.to.map_or(clocks, |to| clocks.min(to as f64 + 1.0));
        let shown = (end - args.from as f64).max(0.0);
        let of_window = |all: f64| all * shown / estimate.clocks.max(1.0);
        let [steps, moving, drifting] = [estimate.steps, estimate.moving, estimate.drifting].map(of_window);
        let samples = if args.steps { steps } else { shown };
        // A #, the time and the end of the line.
        let stamp = 2.0 + (end * self.ticks).max(1.0).log10().floor() + 1.0;
        let edges = if self.clk { 2.0 * stamp + 6.0 } else { stamp };
        let edges = match (self.clk || self.clock > 0.0, args.steps) {
            (true, _) => edges * samples,
            (false, true) => edges * steps,
            (false, false) => edges * STAMPS * steps,
        };
        // At steps alone the flags of a step stay up, and of the source only the phase between two steps is seen.
        let (changing, flags) = if args.steps { (drifting, 0.0) } else { (samples, FLAGS) };
        // Of steps alone no more than one change is seen between two.
        let filtered = self.filter.map_or([0.0; 2], |(bits, clocks)| {
            let periods = if args.steps { (shown / clocks).min(steps) } else { shown / clocks };
            let times = if self.clk || self.clock > 0.0 || args.steps { 0.0 } else { OUTPUTS * moving + periods };
            [FILTERED * bits * periods, stamp * times + if args.steps { 0.0 } else { FLAGS * moving }]
        });
        let vcd = edges + self.clock * changing + (self.count + flags) * steps + self.step * moving;
        let vcd = vcd + filtered[0] + filtered[1];
        let round = if args.steps { 1.0 } else { FST_ROUND + drifting / steps.max(1.0) };
        let source = if self.clock > 0.0 { FST_CLOCK * changing * round } else { 0.0 };
        let fst = source + FST_COUNT * self.count * steps + FST_STEP * (self.step * moving + filtered[0]);
        [(&args.vcd, vcd), (&args.fst, fst)].map(|(path, bytes)| if path.is_some() { bytes } else { 0.0 })
    }

    /// Reports a large wave of a program before it is written.
    ///
    /// # Errors
    /// It would have more than 1 GB, and `--large` is not given.
    pub(super) fn check(&self, args: &WaveOptions, limit: Option<u64>, estimate: &Estimate) -> Result<(), Error> {
        let most = self.bytes(args, limit, estimate).into_iter().fold(0.0, f64::max);
        let (size, clocks) = (readable(most), estimate.clocks);
        // Where a signal opens the window nobody knows how much of the run is left.
        if most > LARGE as f64 && !args.large && args.on.is_none() {
            return Err(Error::Invalid(format!(
                "the wave would have about {size}, as the program runs for about {clocks:.0} clocks: {REMEDIES}"
            )));
        }
        if most > NOTED {
            let less = if args.every_clock { "no --every-clock, " } else { "" };
            // If nobody listens, the wave is still written.
            let _ = writeln!(
                io::stderr(),
                "stepwave: the wave will have about {size}; {less}--trace-steps, a window or --fst make it small"
            );
        }
        Ok(())
    }
}

fn readable(bytes: f64) -> String {
    if bytes < 1e9 { format!("{:.0} MB", bytes / 1e6) } else { format!("{:.1} GB", bytes / 1e9) }
}

#[cfg(test)]
mod tests;
