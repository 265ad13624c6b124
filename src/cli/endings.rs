//! File names on the command line: the ending and the option that writes the file must agree. One table of both.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Command, Error};

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
