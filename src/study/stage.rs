//! The rows of a sweep before they get to the final file, so that a sweep that was stopped can continue.
//!
//! Next to the final `F` are `.F.sweep.part`, the rows so far as CSV, and `.F.sweep.journal`: its first line says which
//! sweep it is, each further one how far the part was when a chunk had been written whole, and the check of all bytes
//! up to there. What follows the last of them in the part is cut off when the sweep goes on.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::parts::{Blocks, Check, PartHead};
use super::table::{Column, Row, heading, read_line};
use super::{StudyError, Sweep, SweepPart};

mod journal;
mod left;

use self::journal::{Journal, Mark};

/// Rows being written.
pub struct Stage {
    target: PathBuf,
    part: File,
    journal: Journal,
    mark: Mark,
    /// Of all bytes of the part.
    check: Check,
    /// The checks between the rows, where the file is a part of several.
    blocks: Option<Blocks>,
    columns: Vec<Column>,
}

fn next_to(target: &Path, what: &str) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(target.file_name().unwrap_or_default());
    name.push(format!(".sweep.{what}"));
    target.with_file_name(name)
}

impl Stage {
    /// The files next to a final one: the rows, and the journal.
    #[must_use]
    pub fn files(target: &Path) -> [PathBuf; 2] {
        ["part", "journal"].map(|what| next_to(target, what))
    }

    /// Begins, or continues from what a stopped sweep has left, if `resume` and there is something. `target` is the
    /// final file, which this does not touch before [`finish`](Self::finish).
    ///
    /// # Errors
    /// A file cannot be written, another sweep is writing it, what is left is of another sweep or is not as it was
    /// written, or something else has the names of the files.
    pub fn open(target: &Path, sweep: &Sweep, resume: bool) -> Result<Stage, StudyError> {
        let writing = |error: io::Error| StudyError::writing(target, error);
        let [_, notes] = Stage::files(target);
        let (journal, is_new) = Journal::open(&notes).map_err(writing)?;
        let stage = Stage::opened(target, sweep, resume, journal);
        if stage.is_err() && is_new {
            // What stays does no harm.
            let _ = fs::remove_file(&notes);
        }
        stage
    }

    fn opened(target: &Path, sweep: &Sweep, resume: bool, mut journal: Journal) -> Result<Stage, StudyError> {
        let writing = |error: io::Error| StudyError::writing(target, error);
        let refused = |what: String| StudyError::Resume { file: target.display().to_string(), what };
        let [rows, notes] = Stage::files(target);
        let head = PartHead::new(sweep.part(), sweep.identity());
        let left = left::open(&rows).map_err(writing)?;
        if left.is_some() && !journal.is_begun() {
            return Err(writing(left::occupied(&rows, "no sweep has left it there")));
        }
        let marks = if resume { journal.marks(&head).map_err(refused)? } else { Vec::new() };
        if let Some(mark) = marks.last() {
            let part = left.ok_or_else(|| refused(GONE.to_owned()))?;
            let shard = sweep.part() != SweepPart::WHOLE;
            let mut stage = Stage::of(target, part, journal, sweep);
            stage.verify(&marks, shard).map_err(refused)?;
            stage.mark = mark.clone();
            stage.cut().map_err(writing)?;
            return Ok(stage);
        }
        let begun = journal.begin(&head).and_then(|()| left::anew(&rows)).and_then(|part| {
            let mut stage = Stage::of(target, part, journal, sweep);
            stage.begin(&head, sweep.part()).map(|()| stage)
        });
        begun.map_err(|error| {
            // Nothing is done that could be continued; what stays does no harm.
            let _ = fs::remove_file(&rows).and_then(|()| fs::remove_file(&notes));
            writing(error)
        })
    }

    fn of(target: &Path, part: File, journal: Journal, sweep: &Sweep) -> Stage {
        let (mark, check, columns) = (Mark::default(), Check::default(), sweep.columns().to_vec());
        Stage { target: target.to_owned(), part, journal, mark, check, blocks: None, columns }
    }

    /// Writes what comes before the first row.
    fn begin(&mut self, head: &PartHead, part: SweepPart) -> io::Result<()> {
        self.blocks = (part != SweepPart::WHOLE).then(Blocks::default);
        let first = if part == SweepPart::WHOLE { None } else { Some(head.line()) };
        for line in first.into_iter().chain([heading(&self.columns) + "\n"]) {
            if let Some(blocks) = &mut self.blocks {
                blocks.line(line.as_bytes());
            }
            self.write(line.as_bytes())?;
        }
        Ok(())
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.part.write_all(bytes)?;
        self.check.add(bytes);
        self.mark.bytes += bytes.len() as u64;
        Ok(())
    }

    /// Reads what is left; fails where it is not as the marks say.
    fn verify(&mut self, marks: &[Mark], shard: bool) -> Result<(), String> {
        let [rows, _] = Stage::files(&self.target);
        let name = rows.display();
        let mut blocks = shard.then(Blocks::default);
        let before_rows = if shard { 2 } else { 1 };
        let mut reader = BufReader::with_capacity(1 << 16, &self.part);
        let (mut bytes, mut number, mut since, mut line) = (0, 0_u64, 1, Vec::new());
        for mark in marks {
            while bytes < mark.bytes {
                line.clear();
                let read = reader.read_until(b'\n', &mut line);
                bytes += match read.map_err(|error| format!("{name}: {error}"))? {
                    0 => return Err(GONE.to_owned()),
                    read => read as u64,
                };
                number += 1;
                self.check.add(&line);
                match &mut blocks {
                    Some(blocks) if number <= before_rows => blocks.line(&line),
                    // The checks between the rows are not lines of a block.
                    Some(blocks) if !line.starts_with(b"#") => drop(blocks.row(&line)),
                    _ => {}
                }
            }
            if bytes != mark.bytes || self.check.text() != mark.check {
                return Err(format!(
                    "{name}: lines {since} to {number} are not as they were written: leave --resume out to begin anew"
                ));
            }
            since = number + 1;
        }
        self.blocks = blocks;
        Ok(())
    }

    /// Cuts off what follows the mark.
    fn cut(&mut self) -> io::Result<()> {
        self.part.set_len(self.mark.bytes)?;
        self.part.seek(SeekFrom::End(0)).map(drop)
    }

    /// Geometries done already, and their rows.
    #[must_use]
    pub fn done(&self) -> [u64; 2] {
        [self.mark.geometries, self.mark.rows]
    }

    /// Hands over the rows written so far, and leaves the stage where it was.
    ///
    /// # Errors
    /// They cannot be read, or `each` fails.
    pub fn replay<E: From<StudyError>>(&mut self, mut each: impl FnMut(Row) -> Result<(), E>) -> Result<(), E> {
        let target = self.target.clone();
        let failed = |error: io::Error| E::from(StudyError::reading(&target, error));
        self.part.seek(SeekFrom::Start(0)).map_err(failed)?;
        let columns = self.columns.clone();
        let begin = heading(&columns);
        let lines = BufReader::new((&self.part).take(self.mark.bytes)).lines();
        for line in lines.filter(|line| !line.as_ref().is_ok_and(|line| line.starts_with('#') || *line == begin)) {
            let line = line.map_err(failed)?;
            let row = read_line(&columns, &line)
                .ok_or_else(|| failed(io::Error::other(format!("invalid row '{line}' of this sweep"))))?;
            each(row)?;
        }
        self.part.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(())
    }

    /// Appends the rows of some geometries, as lines. After this call a kill loses none of them.
    ///
    /// # Errors
    /// They cannot be written; those that were are kept.
    pub fn append(&mut self, geometries: u64, rows: u64, texts: &[String]) -> Result<(), StudyError> {
        let whole = self.mark.clone();
        let result = self.try_append(geometries, rows, texts);
        if result.is_err() {
            self.mark = whole;
        }
        result.map_err(|error| StudyError::writing(&self.target, error))
    }

    fn try_append(&mut self, geometries: u64, rows: u64, texts: &[String]) -> io::Result<()> {
        for text in texts {
            let Some(blocks) = &mut self.blocks else {
                self.write(text.as_bytes())?;
                continue;
            };
            let mut all = String::with_capacity(text.len());
            for line in text.split_inclusive('\n') {
                all += line;
                all += &blocks.row(line.as_bytes()).unwrap_or_default();
            }
            self.write(all.as_bytes())?;
        }
        self.part.sync_data()?;
        self.mark.geometries += geometries;
        self.mark.rows += rows;
        self.mark.check = self.check.text();
        self.journal.append(&self.mark)
    }

    /// Removes everything.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn discard(self) -> Result<(), StudyError> {
        self.finish(false)
    }

    /// All rows are there: gives them their final name if they are wanted as CSV, and removes what is next to it.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(mut self, as_csv: bool) -> Result<(), StudyError> {
        let mut close = || {
            let [rows, notes] = Stage::files(&self.target);
            if as_csv {
                if let Some(blocks) = &mut self.blocks {
                    let end = blocks.end_line();
                    self.part.write_all(end.as_bytes())?;
                }
                self.part.sync_data()?;
                fs::rename(&rows, &self.target)?;
            } else {
                fs::remove_file(&rows)?;
            }
            fs::remove_file(notes)
        };
        close().map_err(|error| StudyError::writing(&self.target, error))
    }
}

/// What is said where the part is shorter than its journal says.
const GONE: &str = "the rows that were written are gone: leave --resume out to begin anew";
