//! File names on the command line: the ending and the option that writes the file must agree. One table of both.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Args, Command, Error};

use crate::output::is_stream;

/// What a file may hold.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Format {
    Vcd,
    Fst,
    Csv,
    Parquet,
    Json,
    Svg,
    Html,
    Png,
    Netlist,
    Verilog,
    Btor2,
    SmtLib,
    NcProgram,
}

/// A format: its name, the endings of its files, the one to propose first, and the options that write it.
struct Entry(Format, &'static str, &'static [&'static str], &'static [&'static str]);

const TABLE: [Entry; 13] = [
    Entry(Format::Vcd, "VCD", &["vcd"], &["vcd", "merged"]),
    Entry(Format::Fst, "FST", &["fst"], &["fst"]),
    Entry(Format::Csv, "CSV", &["csv"], &["steps", "csv", "stimulus-out"]),
    Entry(Format::Parquet, "Parquet", &["parquet"], &["parquet"]),
    Entry(Format::Json, "JSON", &["json"], &["json", "wavedrom"]),
    Entry(Format::Svg, "SVG", &["svg"], &["plot", "svg", "schematic"]),
    Entry(Format::Html, "HTML", &["html", "htm"], &["html"]),
    Entry(Format::Png, "PNG", &["png"], &["plot"]),
    Entry(Format::Netlist, "a netlist", &["net"], &["output", "netlist"]),
    Entry(Format::Verilog, "Verilog", &["v", "sv"], &["verilog", "testbench", "harness"]),
    Entry(Format::Btor2, "BTOR2", &["btor2", "btor"], &["btor2"]),
    Entry(Format::SmtLib, "SMT-LIB", &["smt2"], &["smt2"]),
    Entry(Format::NcProgram, "an NC program", &["ngc", "nc", "tap", "gcode"], &[]),
];

fn entry(format: Format) -> &'static Entry {
    TABLE.iter().find(|entry| entry.0 == format).unwrap_or(&TABLE[0])
}

/// The format that an ending says; nothing where it says nothing.
fn said(ending: &OsStr) -> Option<&'static Entry> {
    TABLE.iter().find(|entry| entry.2.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

/// A file that an option writes in one of these formats. Endings that no format has are left to the user, and so are
/// standard output and devices.
pub(crate) fn file_of(writes: &'static [Format]) -> impl TypedValueParser<Value = PathBuf> {
    FileParser { writes }
}

#[derive(Clone)]
struct FileParser {
    writes: &'static [Format],
}

impl TypedValueParser for FileParser {
    type Value = PathBuf;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<PathBuf, Error> {
        let path = PathBufValueParser::new().parse_ref(command, arg, value)?;
        match path.extension().and_then(said).filter(|_| !is_stream(&path)) {
            Some(entry) if !self.writes.contains(&entry.0) => Err(self.refusal(command, arg, &path, entry)),
            _ => Ok(path),
        }
    }
}

/// Files whose option follows from the ending of their name, and what is printed.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Outputs (- is standard output)")]
pub(crate) struct OutputArgs {
    /// Write what the ending of the name says, as the option for such files does (may be repeated)
    #[arg(short = 'o', long = "output", value_name = "FILE", value_parser = UnknownEnding, allow_hyphen_values = true)]
    output: Vec<PathBuf>,
    /// Print nothing but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// What comes of the outputs of a run.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Outputs (- is standard output)")]
pub(crate) struct ShownArgs {
    #[command(flatten)]
    pub(crate) outputs: OutputArgs,
    /// Open what was written: a wave in its viewer, a page or a picture as the system does
    #[arg(long)]
    pub(crate) open: bool,
}

/// What reads a name of `-o` that [`by_ending`] has left: one whose ending says nothing.
#[derive(Clone)]
struct UnknownEnding;

impl TypedValueParser for UnknownEnding {
    type Value = PathBuf;

    fn parse_ref(&self, command: &Command, _: Option<&Arg>, value: &OsStr) -> Result<PathBuf, Error> {
        let path = Path::new(value).display();
        let endings: Vec<String> = writers(command).map(|(entry, _)| format!(".{}", entry.2[0])).collect();
        let message =
            format!("the ending of {path} does not say what -o is to write: give one of {}", endings.join(", "));
        Err(Error::raw(ErrorKind::ValueValidation, message).with_cmd(command))
    }
}

/// The formats that a command writes, with their options.
fn writers(command: &Command) -> impl Iterator<Item = (&'static Entry, &'static str)> {
    // Only heat maps are images of points.
    let written = |entry: &&Entry| entry.0 != Format::Png || command.get_name() == "sweep";
    TABLE.iter().filter(written).filter_map(|entry| {
        let known = |writer: &&&str| command.get_arguments().any(|arg| arg.get_long() == Some(**writer));
        Some((entry, *entry.3.iter().filter(|writer| **writer != "output").find(known)?))
    })
}

/// The name in `-oNAME` or `--output=NAME`, or nothing of `-o` alone, whose name is the next word; `None` of other words.
fn output_name(word: &OsStr) -> Option<Option<&str>> {
    let word = word.to_str()?;
    let name = word.strip_prefix("--output=").or_else(|| word.strip_prefix("-o").filter(|name| !name.is_empty()));
    (name.is_some() || word == "-o" || word == "--output").then_some(name)
}

/// The words of a command line with the option for files of such a name in the place of `-o`. Names whose ending says
/// nothing are left, and refused when they are read.
pub(crate) fn by_ending(words: Vec<OsString>, program: impl FnOnce() -> Command) -> Vec<OsString> {
    if words.iter().all(|word| output_name(word).is_none()) {
        return words;
    }
    let mut program = program();
    program.build();
    // `import` writes nothing else, and has its own.
    let command = words.get(1).and_then(|word| program.find_subcommand(word)).filter(|own| own.get_name() != "import");
    let Some(command) = command else { return words };
    let option = |name: &OsStr| {
        let said = Path::new(name).extension().and_then(said)?;
        writers(command).find(|(entry, _)| entry.0 == said.0).map(|(_, writer)| OsString::from(format!("--{writer}")))
    };
    let mut all = words.iter().peekable();
    let mut expanded = Vec::new();
    while let Some(word) = all.next() {
        match output_name(word) {
            Some(Some(name)) => match option(name.as_ref()) {
                Some(writer) => expanded.extend([writer, name.into()]),
                None => expanded.push(word.clone()),
            },
            Some(None) => {
                expanded.push(all.peek().and_then(|name| option(name)).unwrap_or_else(|| word.clone()));
                // Its name, whatever it looks like.
                expanded.extend(all.next().cloned());
            }
            None => expanded.push(word.clone()),
        }
    }
    expanded
}

impl FileParser {
    fn refusal(&self, command: &Command, arg: Option<&Arg>, path: &Path, said: &Entry) -> Error {
        let option = arg.map(Arg::to_string).unwrap_or_default();
        let option = option.split(' ').next().unwrap_or_default();
        let names: Vec<&str> = self.writes.iter().map(|format| entry(*format).1).collect();
        let proposed = self.writes.first().map_or("", |format| entry(*format).2[0]);
        let own = path.with_extension(proposed);
        let Entry(_, name, _, writers) = said;
        let known = |writer: &&&str| command.get_arguments().any(|arg| arg.get_long() == Some(**writer));
        // The option of the same command that writes such a file, unless it is this very one.
        let other = writers.iter().find(known).filter(|writer| option != format!("--{writer}"));
        let other = other.map_or_else(String::new, |writer| format!("--{writer} {}, or ", path.display()));
        let what = match names.as_slice() {
            [] => format!("{option} writes none of the known formats"),
            names => format!("{option} writes {}", names.join(" or ")),
        };
        let own = if names.is_empty() { "a name with another ending".to_owned() } else { own.display().to_string() };
        let message = format!("{what}, but {} has the ending of {name}: give {other}{own}", path.display());
        Error::raw(ErrorKind::ValueValidation, message).with_cmd(command)
    }
}
