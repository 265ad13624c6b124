//! Parts of a sweep as files: a part tells in itself what it is part of, and whether it is whole.
//!
//! In CSV a part begins with a line `# part of a stepwave sweep: {…}` and ends with `# end of the part: N rows`; in
//! Parquet both stand in the metadata. A whole sweep has neither.

use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use super::space::Part;
use super::table::Column;

/// Beginning of a part's first line.
const HEAD: &str = "# part of a stepwave sweep: ";
/// Beginning of a part's last line.
const END: &str = "# end of the part: ";
/// Form of what is written; a change of meaning raises it.
const SCHEMA: u32 = 1;

/// What a part says of itself.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub(super) struct PartHead {
    schema: u32,
    /// From 1.
    pub(super) number: u64,
    pub(super) of: u64,
    /// What the rows of the whole sweep follow from.
    pub(super) sweep: Json,
}

impl PartHead {
    pub(super) fn new(part: Part, sweep: Json) -> PartHead {
        PartHead { schema: SCHEMA, number: part.number, of: part.of, sweep }
    }

    /// As text.
    pub(super) fn text(&self) -> String {
        // Numbers and words, which JSON always holds.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// From text.
    pub(super) fn read(text: &str) -> Option<PartHead> {
        serde_json::from_str(text).ok().filter(|head: &PartHead| head.schema == SCHEMA)
    }

    /// The first line of a CSV part.
    pub(super) fn line(&self) -> String {
        format!("{HEAD}{}\n", self.text())
    }

    /// From the first line of a CSV part.
    pub(super) fn of_line(line: &str) -> Option<PartHead> {
        PartHead::read(line.trim_end().strip_prefix(HEAD)?)
    }

    /// The columns of the rows.
    pub(super) fn columns(&self) -> Option<Vec<Column>> {
        serde_json::from_value(self.sweep.get("columns")?.clone()).ok()
    }
}

/// The last line of a CSV part.
pub(super) fn end_line(rows: u64) -> String {
    format!("{END}{rows} rows\n")
}

/// Rows that the last line of a CSV part tells.
pub(super) fn rows_of(line: &str) -> Option<u64> {
    line.trim_end().strip_prefix(END)?.strip_suffix(" rows")?.parse().ok()
}
