//! Netlists in files, in the text form.

use std::collections::HashSet;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use super::Stimulus;
use crate::Error;
use crate::netlist::{Design, Net, elaborate, text};

/// Most bytes of a netlist in a file.
const MOST_BYTES: u64 = 1 << 30;
/// Most bytes of a stimulus.
const MOST_CSV: u64 = 1 << 30;

/// Why a file gives no netlist.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// It cannot be read.
    #[error("cannot read {file}: {why}")]
    Unreadable {
        /// The file.
        file: String,
        /// Why.
        why: String,
    },
    /// Its text or its netlist has mistakes.
    #[error("{file} is not a netlist: {first}{}; `stepwave check {file}` lists every mistake", more(*others))]
    Wrong {
        /// The file.
        file: String,
        /// The first mistake.
        first: String,
        /// How many others there are.
        others: usize,
    },
}

fn more(others: usize) -> String {
    match others {
        0 => String::new(),
        1 => ", and one other mistake".to_owned(),
        others => format!(", and {others} other mistakes"),
    }
}

/// The text of a file, which is UTF-8 and not too long.
pub(crate) fn read_text(path: &Path, most: u64) -> Result<String, FileError> {
    let file = path.display().to_string();
    let wrong = |why: String| FileError::Unreadable { file: file.clone(), why };
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|open| open.take(most + 1).read_to_end(&mut bytes));
    read.map_err(|error| wrong(error.to_string()))?;
    if bytes.len() as u64 > most {
        return Err(wrong(format!("it has more than {} MiB, the most that is read", most >> 20)));
    }
    String::from_utf8(bytes).map_err(|error| {
        wrong(format!("it is not text in UTF-8: byte {} is not part of a character", error.utf8_error().valid_up_to()))
    })
}

/// The mistakes of a netlist in the text form, a line each, or the design.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn checked(path: &Path) -> Result<Result<Design, Vec<String>>, FileError> {
    let text = read_text(path, MOST_BYTES)?;
    let lines = |diagnostics: crate::netlist::Diagnostics| -> Vec<String> {
        diagnostics.0.iter().map(ToString::to_string).collect()
    };
    Ok(text::parse(&text).and_then(elaborate).map_err(lines))
}

/// The netlist in a file in the text form (`.net`), elaborated.
///
/// # Errors
/// The file cannot be read, or it holds something else.
pub fn read_netlist(path: &Path) -> Result<Design, FileError> {
    checked(path)?.map_err(|mistakes| {
        let first = mistakes.first().cloned().unwrap_or_default();
        FileError::Wrong { file: path.display().to_string(), first, others: mistakes.len().saturating_sub(1) }
    })
}

/// Constants on inputs, and a table in a file.
pub(crate) fn read_stimulus(
    design: &Design,
    set: &[(String, String)],
    table: Option<&Path>,
) -> Result<Stimulus, Error> {
    let constants = Stimulus::constants(design, set.iter().map(|(name, value)| (name.as_str(), value.as_str())))?;
    let Some(path) = table else { return Ok(constants) };
    let text = read_text(path, MOST_CSV)?;
    constants.table(design, &text).map_err(|error| Error::Invalid(format!("{}: {error}", path.display())))
}

/// Registers with their bits, inputs, cells. A word of more than 64 bits counts once.
pub(crate) fn summary(design: &Design) -> String {
    let netlist = design.netlist();
    let (wide, narrow): (Vec<_>, Vec<_>) = netlist.names.iter().partition(|named| named.is_wide());
    let mut upper: HashSet<Net> = wide.into_iter().flat_map(|named| &named.above).copied().collect();
    narrow.iter().for_each(|named| _ = upper.remove(&named.net));
    let count = |nets: &[Net]| nets.iter().filter(|net| !upper.contains(net)).count();
    format!(
        "{}: {} cells, {} registers of {} bits together, {} inputs, {} names, {} properties",
        netlist.scopes[0].name,
        netlist.cells.len(),
        count(design.registers()),
        design.register_bits(),
        count(design.inputs()),
        netlist.names.len(),
        netlist.properties.len()
    )
}
