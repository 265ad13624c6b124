//! Parts of a sweep as files: a part says in itself what it is part of, whether it is whole, and whether it is as it
//! was written.
//!
//! In CSV a part begins with a line `# part of a stepwave sweep: {…}`; a line `# check of the lines since the last: …`
//! follows each block of rows, and `# end of the part: N rows, check …` the last. The checks are CRC-32 of the bytes of
//! all lines from the beginning, or from the check before. In Parquet all of that is in the metadata. A whole sweep has
//! none of it.

use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use super::space::SweepPart;
use super::table::Column;

/// Beginning of a part's first line.
const HEAD: &str = "# part of a stepwave sweep: ";
/// Beginning of a part's last line.
const END: &str = "# end of the part: ";
/// Beginning of the line after a block of rows.
const CHECK: &str = "# check of the lines since the last: ";
/// Rows of a block in CSV.
pub(super) const BLOCK: u64 = 1000;
/// Why a file cannot be merged.
pub(super) const NOT_A_PART: &str = "it is not a part of a sweep: --shard makes them";
/// Form of what is written; a change of meaning raises it.
const SCHEMA: u32 = 2;

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
    pub(super) fn new(part: SweepPart, sweep: Json) -> PartHead {
        PartHead { schema: SCHEMA, number: part.number, of: part.of, sweep }
    }

    /// As text.
    pub(super) fn text(&self) -> String {
        // Numbers and words, which JSON always holds.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// From text.
    ///
    /// # Errors
    /// It is not the head of a part, or one of another form.
    pub(super) fn read(text: &str) -> Result<PartHead, String> {
        let head: PartHead = serde_json::from_str(text).map_err(|_| NOT_A_PART.to_owned())?;
        if head.schema == SCHEMA {
            return Ok(head);
        }
        Err(format!("it is a part in form {}, but form {SCHEMA} is needed: make it anew with --shard", head.schema))
    }

    /// Whether a text is one, of any version.
    pub(super) fn is_one(text: &str) -> bool {
        serde_json::from_str::<PartHead>(text).is_ok()
    }

    /// The first line of a CSV part.
    pub(super) fn line(&self) -> String {
        format!("{HEAD}{}\n", self.text())
    }

    /// From the first line of a CSV part.
    ///
    /// # Errors
    /// See [`read`](PartHead::read).
    pub(super) fn of_line(line: &str) -> Result<PartHead, String> {
        PartHead::read(line.trim_end().strip_prefix(HEAD).ok_or(NOT_A_PART)?)
    }

    /// The columns of the rows.
    pub(super) fn columns(&self) -> Option<Vec<Column>> {
        serde_json::from_value(self.sweep.get("columns")?.clone()).ok()
    }
}

/// A checksum of what passes.
#[derive(Clone, Default)]
pub(super) struct Check(crc32fast::Hasher);

impl Check {
    pub(super) fn add(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Of all so far, as text.
    pub(super) fn text(&self) -> String {
        format!("{:08x}", self.0.clone().finalize())
    }

    /// Of all since the last, as text; begins anew.
    pub(super) fn take(&mut self) -> String {
        std::mem::take(self).text()
    }
}

/// The lines of a CSV part with their checks, as they are written or read.
#[derive(Default)]
pub(super) struct Blocks {
    check: Check,
    rows: u64,
}

impl Blocks {
    /// Takes a line, with its line feed.
    pub(super) fn line(&mut self, line: &[u8]) {
        self.check.add(line);
    }

    /// Takes a row, with its line feed; gives the line that follows where a block ends.
    pub(super) fn row(&mut self, line: &[u8]) -> Option<String> {
        self.check.add(line);
        self.rows += 1;
        self.rows.is_multiple_of(BLOCK).then(|| format!("{CHECK}{}\n", self.check.take()))
    }

    /// The last line of a CSV part.
    pub(super) fn end_line(&mut self) -> String {
        format!("{END}{} rows, check {}\n", self.rows, self.check.take())
    }
}

/// What a line that begins with `#` says in a CSV part.
pub(super) enum Remark {
    /// The check of the lines before it.
    Check(String),
    /// The number of all rows, and the check of the last lines.
    End(u64, String),
}

impl Remark {
    /// From a line.
    pub(super) fn of(line: &str) -> Option<Remark> {
        let line = line.trim_end();
        if let Some(check) = line.strip_prefix(CHECK) {
            return Some(Remark::Check(check.to_owned()));
        }
        let (rows, check) = line.strip_prefix(END)?.split_once(" rows, check ")?;
        Some(Remark::End(rows.parse().ok()?, check.to_owned()))
    }
}
