//! `stepwave show`: a wave in the terminal, and as a picture for documents.

#[cfg(unix)]
mod follow;
mod source;

use std::collections::BTreeMap;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use self::source::Source;
use super::clockless::clockless;
use crate::Error;
use crate::cli::{ShowArgs, one_axis};
use crate::output::{Kept, Outputs, Screen};
use crate::trace::draw::{Drawing, LEAST_COLUMNS, Window};
use crate::trace::pattern::{Glob, fits_an_end, glob};
use crate::trace::read::{ClockError, Wave};

/// Most clocks or times of a picture: a page of paper shows a few dozen of them in a line.
const MOST_PICTURED: usize = 10_000;

/// Draws a wave on standard output, or on standard error where an output has that, and into the files asked for.
pub(crate) fn run(args: &ShowArgs) -> Result<(), Error> {
    if let Some(to) = args.to.filter(|to| *to < args.from) {
        return Err(Error::Invalid(format!("--to {to} is before --from {}: exchange them", args.from)));
    }
    let columns = args.columns.map_or_else(columns, usize::from);
    let Source { mut wave, side, reads, failures, first, beyond } = source::open(args, columns)?;
    let by_time = |error: ClockError| clockless(&error, "draw it with --by-time");
    if let Some(clock) = &args.clock {
        wave = wave.with_clock(clock).map_err(by_time)?;
    }
    if !args.by_time {
        wave.cycles().map_err(by_time)?;
    }
    let signals = signals(&wave, args)?;
    let States { names, files } = States::next_to(&args.wave, side.as_ref(), &wave, &signals);
    let drawing = Drawing {
        columns,
        ascii: args.ascii,
        colour: coloured(),
        radix: args.values,
        first,
        from: args.from,
        to: args.to,
        beyond,
        by_time: args.by_time,
        names,
        option: if one_axis(&args.wave) { "--trace-from" } else { "--from" },
    };
    let trouble = |reason: String| {
        let remedy = if args.by_time { "" } else { ", or --by-time" };
        Error::Invalid(format!("{}: {reason}: give other clocks{remedy}", args.wave.display()))
    };
    #[cfg(unix)]
    if args.follow {
        follow::follow(drawing, &wave, &signals, trouble)?;
        return checked(failures);
    }
    let window = drawing.window(&wave, &signals).map_err(trouble)?;
    let mut outputs = Outputs::reading(files.iter().chain(&reads));
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
    screen.flush()?;
    checked(failures)
}

/// What is wrong with the hardware that was run for its wave.
fn checked(failures: Vec<String>) -> Result<(), Error> {
    if failures.is_empty() { Ok(()) } else { Err(Error::Check(failures)) }
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
    /// From the files next to a wave, or from those that a run has left in memory.
    fn next_to(path: &Path, kept: Option<&Kept>, wave: &Wave, signals: &[usize]) -> States {
        let mut all = States { names: BTreeMap::new(), files: Vec::new() };
        for &signal in signals {
            let leaf = wave.signals()[signal].leaf();
            let file = path.with_extension(format!("{leaf}.states"));
            // Names are an extra: a wave of another program has no such file.
            let text = match kept {
                Some(kept) => kept.take(&file.with_file_name(source::RUN).with_extension(format!("{leaf}.states"))),
                None => std::fs::read(&file).ok(),
            };
            let Some(text) = text.and_then(|bytes| String::from_utf8(bytes).ok()) else {
                // Or in the wave itself, where it came through a pipe.
                all.names.extend(wave.states().get_key_value(leaf).map(|(leaf, names)| (leaf.clone(), names.clone())));
                continue;
            };
            let names = text.lines().filter_map(|line| line.split_once(' '));
            let printable = |name: &str| name.chars().filter(|c| !c.is_control()).collect();
            let names = names.map(|(bits, name)| (bits.to_owned(), printable(name))).collect();
            all.names.insert(leaf.to_owned(), names);
            all.files.extend(kept.is_none().then_some(file));
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
