//! `stepwave show`: a wave in the terminal, and as a picture for documents.

#[cfg(unix)]
mod follow;

use std::collections::BTreeMap;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use crate::Error;
use crate::cli::{Format, file_of, one_of};
use crate::output::{Outputs, Screen};
use crate::trace::draw::{Drawing, LEAST_COLUMNS, Radix, Window};
use crate::trace::pattern::{Glob, fits_an_end, glob};
use crate::trace::read::{Wave, WaveError};

/// Draw a wave in the terminal
///
/// Reads VCD and FST, of stepwave or of any other simulator. Each signal has a line, each clock a cell: sample k is what
/// the hardware has settled to after edge k. Values of one state have its name where the file F.SIGNAL.states lies next to the
/// wave, as `run --vcd` writes it. In a terminal levels are green and unknown values red, unless NO_COLOR is set. The same
/// lines go into a picture for documents, or as WaveJSON to WaveDrom.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    stepwave run ppc-line --to 6,4 --vcd line.vcd && stepwave show line.vcd\n  \
    stepwave run dda-line --to 8,6 --vcd - | stepwave show -\n  \
    stepwave show line.vcd --from 8 --to 20 --signals f --signals 'x*' --radix binary\n  \
    stepwave show line.vcd --to 19 --svg line.svg --wavedrom line.json\n  \
    stepwave show line.vcd --follow\n  \
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

    /// Only signals whose name matches, or their path from some scope on; `*` matches dots too (repeatable)
    #[arg(long, value_name = "GLOB")]
    signals: Vec<String>,

    /// Leave out signals by their names, or their paths from some scope on (repeatable)
    #[arg(long, value_name = "GLOB")]
    ignore: Vec<String>,

    /// How vectors are written; as declared is decimal, with a sign where the file says so
    #[arg(long, default_value = "declared", value_parser = one_of(&RADICES))]
    radix: Radix,

    /// A cell for each time at which something changes, in units of the wave, in place of each clock
    #[arg(long)]
    by_time: bool,

    /// The clock: a dotted path, or the end of one [default: the 1-bit `clk` or `clock` nearest the top]
    #[arg(long, value_name = "NAME", conflicts_with = "by_time")]
    clock: Option<String>,

    /// Step through the wave with keys, in a terminal: ← → a clock, PgUp PgDn what fits in a line, Home, End, q
    #[cfg(unix)]
    #[arg(long, conflicts_with_all = ["svg", "wavedrom"])]
    follow: bool,

    /// With the characters of ASCII alone
    #[arg(long)]
    ascii: bool,

    /// Characters of a line [default: those of the terminal, else 80]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(LEAST_COLUMNS as i64..=1000))]
    columns: Option<u16>,

    /// Write the same lines as SVG
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Svg]), help_heading = OUTPUTS)]
    svg: Option<PathBuf>,

    /// Write the same clocks and signals as WaveJSON, which WaveDrom draws
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Json]), help_heading = OUTPUTS)]
    wavedrom: Option<PathBuf>,
}

const OUTPUTS: &str = "Outputs (- is standard output)";
/// Most clocks or times of a picture: a page of paper shows a few dozen of them in a line.
const MOST_PICTURED: usize = 10_000;

/// How vectors may be written.
const RADICES: [(&str, Radix); 5] = [
    ("declared", Radix::Declared),
    ("binary", Radix::Binary),
    ("hex", Radix::Hex),
    ("signed", Radix::Signed),
    ("unsigned", Radix::Unsigned),
];

/// Draws a wave on standard output, or on standard error where an output has that, and into the files asked for.
pub(crate) fn run(args: &ShowArgs) -> Result<(), Error> {
    if let Some(to) = args.to.filter(|to| *to < args.from) {
        return Err(Error::Invalid(format!("--to {to} is before --from {}: exchange them", args.from)));
    }
    let mut wave = Wave::open(&args.wave)?;
    if let Some(clock) = &args.clock {
        wave = wave.with_clock(clock).map_err(WaveError::from)?;
    }
    let signals = signals(&wave, args)?;
    let States { names, files } = States::next_to(&args.wave, &wave, &signals);
    let drawing = Drawing {
        columns: args.columns.map_or_else(columns, usize::from),
        ascii: args.ascii,
        colour: coloured(),
        radix: args.radix,
        from: args.from,
        to: args.to,
        by_time: args.by_time,
        names,
    };
    let trouble = |reason: String| {
        let remedy = if args.by_time { "" } else { ", or --by-time" };
        Error::Invalid(format!("{}: {reason}: give other clocks{remedy}", args.wave.display()))
    };
    #[cfg(unix)]
    if args.follow {
        return follow::follow(drawing, &wave, &signals, trouble);
    }
    let window = drawing.window(&wave, &signals).map_err(trouble)?;
    let mut outputs = Outputs::reading(files.iter().chain([&args.wave]));
    let views = [(&args.svg, Window::svg as fn(&Window) -> String), (&args.wavedrom, Window::wavedrom)];
    let views = views.into_iter().filter_map(|(path, view)| Some((path.as_ref()?, view)));
    let mut pictures = Vec::new();
    for (path, view) in views {
        if window.cells() > MOST_PICTURED {
            return Err(Error::Invalid(format!(
                "{}: a picture of {} clocks or times: at most {MOST_PICTURED} can be read; give --from and --to",
                path.display(),
                window.cells()
            )));
        }
        pictures.push((outputs.open(path)?, view));
    }
    // Only when all can be opened something is written.
    for (mut sink, view) in pictures {
        sink.write_all(view(&window).as_bytes())?;
        sink.flush()?;
    }
    let on_error = outputs.uses_stdout();
    outputs.commit()?;
    let mut screen = Screen::new(on_error);
    write!(screen, "{}", window.text(drawing.ascii, drawing.colour && !on_error))?;
    Ok(screen.flush()?)
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
        let fits = |glob: &Glob| fits_an_end(glob, &signal.path);
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

/// Names of states next to a wave.
struct States {
    /// By signal and bits.
    names: BTreeMap<String, BTreeMap<String, String>>,
    /// From which they were read.
    files: Vec<PathBuf>,
}

impl States {
    fn next_to(path: &Path, wave: &Wave, signals: &[usize]) -> States {
        let mut all = States { names: BTreeMap::new(), files: Vec::new() };
        for &signal in signals {
            let leaf = wave.signals()[signal].leaf();
            let file = path.with_extension(format!("{leaf}.states"));
            // Names are an extra: a wave of another program has no such file.
            let Ok(text) = std::fs::read_to_string(&file) else { continue };
            let names = text.lines().filter_map(|line| line.split_once(' '));
            let printable = |name: &str| name.chars().filter(|c| !c.is_control()).collect();
            let names = names.map(|(bits, name)| (bits.to_owned(), printable(name))).collect();
            all.names.insert(leaf.to_owned(), names);
            all.files.push(file);
        }
        all
    }
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
