//! What `show` draws: the wave in a file, or that of a run, which stays in memory.

use std::path::{Path, PathBuf};

use crate::Error;
use crate::cli::{ShowArgs, one_axis};
use crate::commands::progress::RunProgress;
use crate::commands::run;
use crate::models::find;
use crate::output::{Kept, Outputs};
use crate::own::is_netlist;
use crate::trace::read::{Wave, WaveError};
use crate::waves::{Remarks, WaveOptions};

/// The wave of a run among what it leaves in memory.
pub(super) const RUN: &str = "run.vcd";

/// A wave, and where it comes from.
pub(super) struct Source {
    pub(super) wave: Wave,
    /// Of a run, the files that would be next to its wave.
    pub(super) side: Option<Kept>,
    /// Files that are read.
    pub(super) reads: Vec<PathBuf>,
    /// What the hardware of a run did wrong.
    pub(super) failures: Vec<String>,
    /// The clock of the first sample of the wave.
    pub(super) first: u64,
    /// Clocks of a run after the last one of the wave.
    pub(super) beyond: u64,
}

/// Reads the wave, or simulates the model: of a run only those clocks are recorded that fit in this many columns.
///
/// # Errors
/// There is neither, the file holds something else, or what is given does not go with it.
pub(super) fn open(args: &ShowArgs, columns: usize) -> Result<Source, Error> {
    let word = args.wave.to_string_lossy();
    if !is_wave(&args.wave) {
        if !is_netlist(&word)
            && let Err(error) = find(&word)
        {
            return Err(Error::Invalid(format!(
                "{word} is neither the file of a wave nor a model: {error}; give the path of a VCD or FST, or the name of a model"
            )));
        }
        return simulated(args, &word, columns);
    }
    if let Some(option) = args.run.given.first() {
        let clocks = if ["--from", "--to"].contains(&&**option) { ": of a wave give a clock, one number" } else { "" };
        return Err(Error::Invalid(format!(
            "{option} is of the run of a model, and {word} is the file of a wave: leave it out{clocks}"
        )));
    }
    let wave = Wave::open(&args.wave)?;
    Ok(Source { wave, side: None, reads: vec![args.wave.clone()], failures: Vec::new(), first: 0, beyond: 0 })
}

/// A file that exists, or a name that only a wave has. A netlist is to be run.
fn is_wave(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default();
    let named = |endings: &[&str]| endings.iter().any(|known| ending.eq_ignore_ascii_case(known));
    let exists = || path.metadata().is_ok_and(|found| !found.is_dir());
    path == Path::new("-") || named(&["vcd", "fst"]) || (!named(&["net"]) && exists())
}

fn simulated(args: &ShowArgs, model: &str, columns: usize) -> Result<Source, Error> {
    let of = &args.run.args;
    let reads = of.files(model);
    let (kept, mut outputs) = Outputs::in_memory();
    #[cfg(unix)]
    let follow = args.follow;
    #[cfg(not(unix))]
    let follow = false;
    // Keys go to any clock, and times and edges of another signal are counted from the first clock on.
    let counted = args.by_time || args.clock.is_some();
    let whole = counted || follow;
    // A clock has a character of a line at least.
    let fits = args.from.saturating_add(columns as u64);
    let to = args.to.or(Some(fits).filter(|_| !whole)).filter(|_| !counted);
    let first = if whole { 0 } else { args.from };
    let last = if one_axis(&args.wave) { "--trace-to" } else { "--to" };
    let remedies = match (args.by_time, counted) {
        (true, _) => "leave --by-time out".to_owned(),
        (_, true) => "leave --clock out".to_owned(),
        _ => format!("give the last clock, {last} N"),
    };
    let remarks = Remarks { empty: format!("{model}: nothing is left from clock {first} on"), remedies };
    let waves = WaveOptions { vcd: Some(RUN.into()), from: first, to, remarks, ..WaveOptions::default() };
    let (simulation, curve) = run::simulation(model, of)?;
    let simulation = simulation.waves(waves);
    let bench = simulation.prepare().map_err(|error| of.hardware.explain(error))?.bench;
    let ran = simulation.run_on(bench, &mut outputs, |bench, _| Ok(RunProgress::new(bench, &curve)))?;
    let wave = Wave::from_bytes(kept.take(Path::new(RUN)).unwrap_or_default())?;
    let samples = ran.report.outcome.clocks.saturating_add(1);
    let beyond = match args.to {
        None if !whole => samples.saturating_sub(first + wave.cycles().map_err(WaveError::from)?),
        _ => 0,
    };
    Ok(Source { wave, side: Some(kept), reads, failures: ran.report.failures(), first, beyond })
}
