//! `--html`: one page that shows a run, or several of one curve: path, wave, step table and moves under one cursor in time.
//!
//! A [`RunRecord`] looks on while a machine runs, and keeps changes, pulses and rows of the step table as streams of small
//! numbers; what is known when the run is over comes from its report, as [`Facts`]. `document` packs them into a file that
//! needs nothing else. The programs of the page are the other files of this folder; `docs/page.md` describes its data.

mod document;
mod facts;
mod record;
#[cfg(test)]
mod tests;
mod track;

use std::io::Write as _;

use crate::Error;
use crate::output::{Outputs, Sink};
use crate::waves::WaveOptions;

#[cfg(feature = "cli")]
pub(crate) use document::{Comparison, Packed, write as write_all};
pub(crate) use facts::Facts;
pub(crate) use record::{Limit, RunRecord};

/// What the page of one run may hold.
pub(crate) fn limit(args: &WaveOptions) -> Limit {
    let remedy = "show fewer signals (--trace) or a window (--trace-from, --trace-to), write --fst for a viewer, or give --large";
    Limit { bytes: if args.large { usize::MAX } else { 1 << 28 }, remedy }
}

/// Opens the output of a page, where one is asked for.
///
/// # Errors
/// The output cannot be written.
pub(crate) fn open(args: &WaveOptions, outputs: &mut Outputs) -> Result<Option<Sink>, Error> {
    args.html.as_deref().map(|path| outputs.open(path)).transpose()
}

/// Writes the page of one run.
///
/// # Errors
/// No sample is in its window, or the output cannot be written.
pub(crate) fn write(mut out: Sink, record: RunRecord, facts: &Facts) -> Result<(), Error> {
    let run = record.finish(facts)?;
    document::write(&mut out, &facts.headline, &[run], None)?;
    Ok(out.flush()?)
}
