//! `stepwave show`: a wave in the terminal.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use crate::Error;
use crate::output;
use crate::trace::draw::{Drawing, LEAST_COLUMNS, Radix};
use crate::trace::pattern::{Glob, glob};
use crate::trace::read::{Wave, WaveError};

/// Draw a wave in the terminal
///
/// Reads VCD and FST, of stepwave or of any other simulator. Each signal has a line, each clock a cell: sample k is what
/// the hardware has settled to after edge k. Values of one state have its name where the file F.SIGNAL.states lies next to the
/// wave, as `run --vcd` writes it. In a terminal levels are green and unknown values red, unless NO_COLOR is set.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    stepwave run ppc-line --to 6,4 --vcd line.vcd && stepwave show line.vcd\n  \
    stepwave run dda-line --to 8,6 --vcd - | stepwave show -\n  \
    stepwave show line.vcd --from 8 --to 20 --signals f --signals 'x*' --radix binary\n  \
    stepwave show other.fst --by-time --ascii --columns 132")]
pub(crate) struct ShowArgs {
    /// The wave: VCD or FST; - is standard input
    #[arg(value_name = "WAVE")]
    wave: PathBuf,

    /// First clock, or time with --by-time
    #[arg(long, value_name = "N", default_value_t = 0)]
    from: u64,

    /// Last clock, or time with --by-time [default: as many as fit in a line]
    #[arg(long, value_name = "N")]
    to: Option<u64>,

    /// Only signals whose path or name matches; `*` matches dots too (repeatable)
    #[arg(long, value_name = "GLOB")]
    signals: Vec<String>,

    /// Leave out signals whose path or name matches (repeatable)
    #[arg(long, value_name = "GLOB")]
    ignore: Vec<String>,

    /// How vectors are written; as declared is decimal, with a sign where the file says so
    #[arg(long, value_enum, default_value_t = Base::Declared)]
    radix: Base,

    /// A cell for each time at which something changes, in units of the wave, in place of each clock
    #[arg(long)]
    by_time: bool,

    /// The clock: a dotted path, or the end of one [default: the 1-bit `clk` or `clock` nearest the top]
    #[arg(long, value_name = "NAME", conflicts_with = "by_time")]
    clock: Option<String>,

    /// With the characters of ASCII alone
    #[arg(long)]
    ascii: bool,

    /// Characters of a line [default: those of the terminal, else 80]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(LEAST_COLUMNS as i64..=1000))]
    columns: Option<u16>,
}

/// [`Radix`], for the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Base {
    Declared,
    Binary,
    Hex,
    Signed,
    Unsigned,
}

impl From<Base> for Radix {
    fn from(base: Base) -> Radix {
        match base {
            Base::Declared => Radix::Declared,
            Base::Binary => Radix::Binary,
            Base::Hex => Radix::Hex,
            Base::Signed => Radix::Signed,
            Base::Unsigned => Radix::Unsigned,
        }
    }
}

/// Draws a wave on standard output.
pub(crate) fn run(args: &ShowArgs) -> Result<(), Error> {
    if let Some(to) = args.to.filter(|to| *to < args.from) {
        return Err(Error::Invalid(format!("--to {to} is before --from {}: exchange them", args.from)));
    }
    let mut wave = Wave::open(&args.wave)?;
    if let Some(clock) = &args.clock {
        wave = wave.with_clock(clock).map_err(WaveError::from)?;
    }
    let signals = signals(&wave, args)?;
    let drawing = Drawing {
        columns: args.columns.map_or_else(columns, usize::from),
        ascii: args.ascii,
        colour: coloured(),
        radix: args.radix.into(),
        from: args.from,
        to: args.to,
        by_time: args.by_time,
        names: states(&args.wave, &wave, &signals),
    };
    let text = drawing.text(&wave, &signals).map_err(|reason| {
        let remedy = if args.by_time { "" } else { ", or --by-time" };
        Error::Invalid(format!("{}: {reason}: give other clocks{remedy}", args.wave.display()))
    })?;
    output::print(&text)
}

/// The signals that are asked for, in the order of the file; without the clock, unless it is named.
fn signals(wave: &Wave, args: &ShowArgs) -> Result<Vec<usize>, Error> {
    let compiled = |patterns: &[String]| {
        let one = |pattern: &String| {
            glob(pattern).map_err(|reason| Error::Invalid(format!("invalid name pattern '{pattern}' ({reason})")))
        };
        patterns.iter().map(one).collect::<Result<Vec<_>, Error>>()
    };
    let (wanted, ignored) = (compiled(&args.signals)?, compiled(&args.ignore)?);
    let mut used = vec![false; wanted.len()];
    let mut shown = Vec::new();
    for (index, signal) in wave.signals().iter().enumerate() {
        let fits = |glob: &Glob| glob.is_match(&signal.path) || glob.is_match(signal.leaf());
        let mut hit = wanted.is_empty() && (args.by_time || !wave.is_clock(index));
        for (glob, used) in wanted.iter().zip(&mut used) {
            if fits(glob) {
                (hit, *used) = (true, true);
            }
        }
        if hit && !ignored.iter().any(fits) {
            shown.push(index);
        }
    }
    if let Some((pattern, _)) = args.signals.iter().zip(used).find(|(_, used)| !used) {
        return Err(Error::Invalid(format!(
            "no signal of {} is called '{pattern}': without --signals all are shown with their names",
            args.wave.display()
        )));
    }
    if shown.is_empty() {
        return Err(Error::Invalid(format!("no signal of {} is left to show", args.wave.display())));
    }
    Ok(shown)
}

/// Names of states next to the wave, by signal and bits.
fn states(path: &Path, wave: &Wave, signals: &[usize]) -> BTreeMap<String, BTreeMap<String, String>> {
    let mut all = BTreeMap::new();
    for &signal in signals {
        let leaf = wave.signals()[signal].leaf();
        let file = path.with_extension(format!("{leaf}.states"));
        // Names are an extra: a wave of another program has no such file.
        let Ok(text) = std::fs::read_to_string(file) else { continue };
        let names = text.lines().filter_map(|line| line.split_once(' '));
        let printable = |name: &str| name.chars().filter(|c| !c.is_control()).collect();
        all.insert(leaf.to_owned(), names.map(|(bits, name)| (bits.to_owned(), printable(name))).collect());
    }
    all
}

/// Characters of a line of the terminal, or of `COLUMNS`; 80 where there is none.
fn columns() -> usize {
    let given = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let terminal = || rustix::termios::tcgetwinsize(std::io::stdout()).ok().map(|size| usize::from(size.ws_col));
    let columns = if std::io::stdout().is_terminal() { terminal() } else { None };
    columns.filter(|columns| *columns > 0).or(given).unwrap_or(80).clamp(LEAST_COLUMNS, 1000)
}

/// Standard output is a terminal that shows colours, and nobody has forbidden them.
fn coloured() -> bool {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    std::io::stdout().is_terminal() && set("NO_COLOR").is_none() && set("TERM").is_none_or(|term| term != "dumb")
}
