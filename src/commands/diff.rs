//! `stepwave diff`: where two waves part.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::thread;

use super::clockless::clockless;
use crate::trace::diverge::{self, By, CompareError, Options};
use crate::trace::merge::write_merged;
use crate::trace::read::{ClockError, Wave};

use crate::Error;
use crate::cli::{Format, file_of, whole};
use crate::output::{self, Outputs};
use crate::waves::Viewer;

/// Compare two waves and show where they part
///
/// Reads VCD and FST, of stepwave or of any other simulator. By default both are sampled at the rising edges of their
/// clocks, so that time units, clock periods and delays within a cycle play no part: sample k is what the hardware has
/// settled to after edge k. Shows the first clock at which a signal differs, its values, and every other signal that
/// differs anywhere. A signal that one side lacks, another width and another length are differences too.
///
/// Signals are matched by their dotted paths without bit ranges. If no path is common to both, the leading scopes
/// that all signals of a file share are taken off first, on each side.
///
/// Nothing in a file is guessed: what is unclear or contradicts itself is refused with its line or signal. Limits: vectors
/// of 1048576 bits, 256 scopes within one another, paths of 4096 bytes, lines of 32 MiB, 256 MiB from a pipe; an FST may
/// inflate to 64 MiB and 32 times its size.
///
/// Exit code: 0 same, 1 different, 2 trouble.
#[derive(Debug, clap::Args)]
pub(crate) struct DiffArgs {
    /// The first wave, side A; - is standard input
    #[arg(value_name = "A")]
    a: PathBuf,

    /// The second wave, side B; - is standard input
    #[arg(value_name = "B")]
    b: PathBuf,

    /// What stands beside what: samples at the clock edges, or values at equal times
    #[arg(long, value_enum, default_value_t = Axis::Clock)]
    by: Axis,

    /// The clock: a dotted path, or the end of one [default: the 1-bit `clk` or `clock` nearest the top]
    #[arg(long, value_name = "NAME")]
    clock: Option<String>,

    /// Compare sample k of A with sample k+CLOCKS of B; negative if A starts late
    #[arg(long, value_name = "CLOCKS", default_value_t = 0, allow_negative_numbers = true)]
    offset: i64,

    /// Compare only signals whose path or name matches; `*` matches dots too (repeatable)
    #[arg(long, value_name = "GLOB")]
    signals: Vec<String>,

    /// Leave out signals whose path or name matches (repeatable)
    #[arg(long, value_name = "GLOB")]
    ignore: Vec<String>,

    /// The signal or scope `a` of A is `b` in B; an empty side is the root (repeatable, the first that fits counts)
    #[arg(long, value_name = "a=b", value_parser = parse_map)]
    map: Vec<(String, String)>,

    /// Lines of context before and after the first divergence
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = whole::<usize>(0..))]
    context: usize,

    /// Also write both sides and their exclusive-or as one VCD for the viewer (`-`: to standard output, instead of the
    /// report)
    #[arg(long, value_name = "F.vcd", value_parser = file_of(&[Format::Vcd]))]
    pub(super) merged: Option<PathBuf>,

    /// Refused: a merged wave has no rows or formats of its own
    #[arg(long, hide = true)]
    viewer: Option<Viewer>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Axis {
    /// Sample k of A beside sample k of B
    Clock,
    /// Every change at its time, units converted
    Time,
}

fn parse_map(rule: &str) -> Result<(String, String), String> {
    let (a, b) =
        rule.split_once('=').ok_or_else(|| format!("`{rule}` has no `=`; write a=b, as in tb.dut=dda_line"))?;
    Ok((a.into(), b.into()))
}

/// Compares two waves and prints where they part.
pub(crate) fn run(args: &DiffArgs) -> Result<(), Error> {
    let trouble = |sentence: &str| Err(Error::Invalid(sentence.to_owned()));
    if args.viewer.is_some() {
        return trouble(
            "a merged wave has no files for a viewer next to it: leave --viewer out; any viewer opens the VCD",
        );
    }
    let by = match args.by {
        Axis::Clock => By::Clock { offset: args.offset },
        Axis::Time if args.offset != 0 => return trouble("--offset counts clocks, which --by time does without"),
        Axis::Time if args.clock.is_some() => return trouble("--clock names a clock, which --by time does without"),
        Axis::Time => By::Time,
    };
    if [&args.a, &args.b].iter().all(|path| path.as_path() == Path::new("-")) {
        return trouble("standard input is one wave: give the other one as a file");
    }
    let options = Options {
        by,
        signals: args.signals.clone(),
        ignore: args.ignore.clone(),
        map: args.map.clone(),
        context: args.context,
    };
    let by_time = |error: &ClockError| clockless(error, "compare with --by time");
    let open = |path: &Path| -> Result<Wave, Error> {
        let wave = Wave::open(path)?;
        match &args.clock {
            Some(clock) => wave.with_clock(clock).map_err(|error| by_time(&error)),
            None => Ok(wave),
        }
    };
    let (a, b) = thread::scope(|scope| {
        let a = scope.spawn(|| open(&args.a));
        let b = open(&args.b);
        (a.join(), b)
    });
    let Ok(a) = a else { return trouble("the first wave cannot be read: the reader stopped") };
    let (a, b) = (a?, b?);

    let comparison = diverge::compare(&a, &b, &options).map_err(|error| match error {
        CompareError::Clock(error) => by_time(&error),
        other => other.into(),
    })?;
    let mut outputs = Outputs::reading([&args.a, &args.b]);
    if let Some(path) = &args.merged {
        let mut sink = outputs.open(path)?;
        write_merged(&a, &b, &options, &mut sink)?;
        sink.flush()?;
    }
    let quiet = outputs.uses_stdout();
    outputs.commit()?;
    if !quiet {
        output::print(&format!("{comparison}\n"))?;
    }
    match comparison.divergence {
        None => Ok(()),
        Some(_) => Err(Error::Check(vec![format!("{} and {} differ", args.a.display(), args.b.display())])),
    }
}
