//! Arguments of `show`: a wave, or the run of a model whose wave is shown. One number after `--from` and `--to` is a clock,
//! numbers with commas are points, so that what `run` and `show` take can be given together.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::error::{ContextKind, ContextValue};
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::values::whole;
use super::{Format, MachineRun, file_of, one_of};
use crate::models::find;
use crate::trace::draw::{LEAST_COLUMNS, Radix};

const OUTPUTS: &str = "Outputs (- is standard output)";
const SHOWN: &str = "What is shown";
const FIRST: &str = "trace-from";
const LAST: &str = "trace-to";
const VALUES: &str = "values";

/// Options of `show` that may be written as options of `run`: these, their own names, and the placeholders of their values.
const SHARED: [(&str, &str, &str); 3] = [("from", FIRST, "N"), ("to", LAST, "N"), ("radix", VALUES, "FORM")];

/// A usage error of `show` in the words of its user: an option has both of its names.
pub(super) fn as_given(error: &mut clap::Error) {
    let own = |argument: &str| {
        let (shared, name, value) =
            SHARED.into_iter().find(|(_, name, value)| argument == format!("--{name} <{value}>"))?;
        Some(format!("--{shared} <{value}> or --{name} <{value}>"))
    };
    for kind in [ContextKind::InvalidArg, ContextKind::PriorArg] {
        let renamed = match error.get(kind) {
            Some(ContextValue::String(argument)) => own(argument),
            _ => None,
        };
        if let Some(renamed) = renamed {
            error.insert(kind, ContextValue::String(renamed));
        }
    }
}

/// How vectors may be written.
const RADICES: [(&str, Radix); 5] = [
    ("declared", Radix::Declared),
    ("binary", Radix::Binary),
    ("hex", Radix::Hex),
    ("signed", Radix::Signed),
    ("unsigned", Radix::Unsigned),
];

/// Draw a wave in the terminal
///
/// Reads VCD and FST, of stepwave or of any other simulator, or simulates a model with the geometry and the hardware that
/// `run` takes and writes no wave. Of a model `--from` and `--to` with commas are points and a single number is a clock;
/// where the model has one axis it is a point too, and --trace-from and --trace-to give clocks. Each signal has a line, each clock a cell: sample k is what
/// the hardware has settled to after edge k. Values of one state have its name where the file F.SIGNAL.states lies next to the
/// wave, as `run --vcd` writes it, or comments of the wave have it, as `run --vcd -` writes them. In a terminal levels are green and unknown values red, unless NO_COLOR is set. The same
/// lines go into a picture for documents, or as WaveJSON to WaveDrom.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    stepwave run ppc-line --to 6,4 --vcd line.vcd && stepwave show line.vcd\n  \
    stepwave run dda-line --to 8,6 --vcd - | stepwave show -\n  \
    stepwave show dda-line --to 8,6 --width 4 --signals e --signals 'jr*' --to 12\n  \
    stepwave show line.vcd --from 8 --to 20 --signals f --signals 'x*' --values binary\n  \
    stepwave show line.vcd --to 19 --svg line.svg --wavedrom line.json\n  \
    stepwave show line.vcd --follow\n  \
    stepwave show other.fst --by-time --ascii --columns 132")]
pub(crate) struct ShowArgs {
    /// The wave: VCD or FST; - is standard input. Or a model, or a netlist of one's own (F.net), to be run
    #[arg(id = "model", value_name = "WAVE|MODEL")]
    pub(crate) wave: PathBuf,

    #[command(flatten)]
    pub(crate) run: Given<MachineRun>,

    /// First clock, or time with --by-time; --from N says the same
    #[arg(id = "first", long = FIRST, value_name = "N", default_value_t = 0, value_parser = whole::<u64>(0..), help_heading = SHOWN)]
    pub(crate) from: u64,

    /// Last clock, or time with --by-time; --to N says the same [default: as many as fit in a line]
    #[arg(id = "last", long = LAST, value_name = "N", value_parser = whole::<u64>(0..), help_heading = SHOWN)]
    pub(crate) to: Option<u64>,

    /// Only signals whose name matches, or their path from some scope on; `*` matches dots too (repeatable)
    #[arg(long, value_name = "GLOB", help_heading = SHOWN)]
    pub(crate) signals: Vec<String>,

    /// Leave out signals by their names, or their paths from some scope on (repeatable)
    #[arg(long, value_name = "GLOB", help_heading = SHOWN)]
    pub(crate) ignore: Vec<String>,

    /// How vectors are written; as declared is decimal, with a sign where the file says so
    #[arg(long = VALUES, value_name = "FORM", default_value = "declared", value_parser = one_of(&RADICES), help_heading = SHOWN)]
    pub(crate) values: Radix,

    /// A cell for each time at which something changes, in units of the wave, in place of each clock
    #[arg(long, help_heading = SHOWN)]
    pub(crate) by_time: bool,

    /// The clock: a dotted path, or the end of one [default: the 1-bit `clk` or `clock` nearest the top]
    #[arg(id = "clock", long, value_name = "NAME", conflicts_with = "by_time", help_heading = SHOWN)]
    pub(crate) clock: Option<String>,

    /// Step through the wave with keys, in a terminal: ← → a clock, PgUp PgDn what fits in a line, Home, End, q
    #[cfg(unix)]
    #[arg(long, conflicts_with_all = ["svg", "wavedrom"], help_heading = SHOWN)]
    pub(crate) follow: bool,

    /// With the characters of ASCII alone
    #[arg(long, help_heading = SHOWN)]
    pub(crate) ascii: bool,

    /// Characters of a line [default: those of the terminal, else 80]
    #[arg(long, value_name = "N", value_parser = whole::<u16>(LEAST_COLUMNS as u64..=1000), help_heading = SHOWN)]
    pub(crate) columns: Option<u16>,

    /// Write the same lines as SVG
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Svg]), help_heading = OUTPUTS)]
    pub(crate) svg: Option<PathBuf>,

    /// Write the same clocks and signals as WaveJSON, which WaveDrom draws
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Json]), help_heading = OUTPUTS)]
    pub(crate) wavedrom: Option<PathBuf>,
}

/// Options, with the names of those that are given.
#[derive(Debug)]
pub(crate) struct Given<T> {
    pub(crate) args: T,
    /// With the dashes, in the order of the help.
    pub(crate) given: Vec<String>,
}

impl<T: Args> Args for Given<T> {
    fn augment_args(command: Command) -> Command {
        T::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        T::augment_args_for_update(command)
    }
}

impl<T: Args> FromArgMatches for Given<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Given<T>, clap::Error> {
        let own = T::augment_args(Command::new("own"));
        let said = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
        let given = own.get_arguments().filter(|argument| said(argument.get_id().as_str()));
        let given = given.filter_map(|argument| Some(format!("--{}", argument.get_long()?))).collect();
        Ok(Given { args: T::from_arg_matches(matches)?, given })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Given::from_arg_matches(matches)?;
        Ok(())
    }
}

/// A model of one axis has this name, of which one number is a point.
pub(crate) fn one_axis(name: &Path) -> bool {
    name.to_str().and_then(|name| find(name).ok()).is_some_and(|model| model.curve().max_axes() == 1)
}

/// The words of a `show` in which the values of the options that it shares with `run` say which are its own: one number is a
/// clock, the name of a form no radix of the hardware. Of a model of one axis one number is a point.
pub(crate) fn by_value(mut words: Vec<OsString>) -> Vec<OsString> {
    if words.get(1).is_none_or(|command| command != "show") {
        return words;
    }
    let model = words.iter().skip(2).find(|word| word.to_str().is_some_and(|word| find(word).is_ok()));
    let lone = model.is_some_and(|model| one_axis(Path::new(model)));
    let clock = |value: &str| {
        let digits = value.strip_prefix('-').unwrap_or(value);
        !lone && !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
    };
    let form = |value: &str| RADICES.iter().any(|(name, _)| *name == value);
    let other = |option: &str, value: &str| {
        let (_, name, _) = SHARED.into_iter().find(|(shared, ..)| option.strip_prefix("--") == Some(*shared))?;
        (if name == VALUES { form(value) } else { clock(value) }).then_some(name)
    };
    for index in 2..words.len() {
        let (word, next) = (words[index].to_str(), words.get(index + 1).and_then(|next| next.to_str()));
        let Some(word) = word else { continue };
        let renamed = match word.split_once('=') {
            Some((option, value)) => other(option, value).map(|name| format!("--{name}={value}")),
            None => next.and_then(|value| other(word, value)).map(|name| format!("--{name}")),
        };
        if let Some(renamed) = renamed {
            words[index] = renamed.into();
        }
    }
    words
}
