//! What takes the place of `parquet` in a build without that feature: the same functions, each of which says so.

use std::io::Write;
use std::marker::PhantomData;
use std::path::Path;

use super::parts::PartHead;
use super::table::{Column, Row};
use super::{StudyError, Sweep};

const MISSING: &str =
    "this stepwave was built without Parquet: give a CSV file, or build it with the feature `parquet`";

/// A Parquet file being written, which cannot be.
pub struct ParquetTable<W: Write + Send>(PhantomData<W>);

impl<W: Write + Send> ParquetTable<W> {
    /// Begins a file for the rows of a sweep.
    ///
    /// # Errors
    /// Always: there is no Parquet in this build.
    pub fn new(_: &Sweep, _: W) -> Result<ParquetTable<W>, StudyError> {
        Err(StudyError::Run(MISSING.to_owned()))
    }

    pub(super) fn of(_: Vec<Column>, _: Option<PartHead>, _: W) -> Result<ParquetTable<W>, StudyError> {
        Err(StudyError::Run(MISSING.to_owned()))
    }

    /// Takes the next row.
    ///
    /// # Errors
    /// Always.
    pub fn row(&mut self, _: Row) -> Result<(), StudyError> {
        Err(StudyError::Run(MISSING.to_owned()))
    }

    /// Ends the file.
    ///
    /// # Errors
    /// Always.
    pub fn finish(self) -> Result<W, StudyError> {
        Err(StudyError::Run(MISSING.to_owned()))
    }
}

pub(super) struct ParquetPart {
    pub(super) head: PartHead,
}

impl ParquetPart {
    pub(super) fn open(_: &Path) -> Result<ParquetPart, String> {
        Err(MISSING.to_owned())
    }

    #[expect(clippy::unused_self, reason = "the face of the reader that is not there")]
    pub(super) fn next(&mut self) -> Option<Result<Row, String>> {
        None
    }
}
