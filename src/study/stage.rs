//! The rows of a sweep on their way to the final file, so that a killed sweep can go on.
//!
//! Beside the final `F` stand `.F.sweep.part`, the rows so far as CSV, and `.F.sweep.journal`: its first line tells the
//! sweep, each further one how far the part was when a chunk had been written whole. What stands behind the last of them
//! in the part is cut off when the sweep goes on.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::parts::{PartHead, end_line};
use super::table::{Column, Row, heading, read_line};
use super::{Part, StudyError, Sweep};

/// How far a part is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
struct Mark {
    /// Geometries done.
    geometries: u64,
    rows: u64,
    bytes: u64,
}

/// Rows being written.
pub struct Stage {
    target: PathBuf,
    part: File,
    journal: File,
    mark: Mark,
    /// Bytes before the first row.
    begin: u64,
    columns: Vec<Column>,
    shard: bool,
}

fn beside(target: &Path, what: &str) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy().into_owned();
    target.with_file_name(format!(".{name}.sweep.{what}"))
}

impl Stage {
    /// Begins, or goes on with what a killed sweep has left if `resume` and there is something. `target` is the final
    /// file, which this does not touch before [`finish`](Self::finish).
    ///
    /// # Errors
    /// A file cannot be written, another sweep is writing it, or what is left is of another sweep.
    pub fn open(target: &Path, sweep: &Sweep, resume: bool) -> Result<Stage, StudyError> {
        let open = |what| {
            let path = beside(target, what);
            let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
            file.map_err(|error| StudyError::writing(target, error))
        };
        let head = PartHead::new(sweep.part(), sweep.identity());
        let journal = open("journal")?;
        match journal.try_lock() {
            Err(TryLockError::WouldBlock) => {
                return Err(StudyError::writing(target, "another sweep is writing it: wait, or name another file"));
            }
            // Where files cannot be locked, two sweeps of one name are the user's to avoid.
            Err(TryLockError::Error(_)) | Ok(()) => {}
        }
        let columns = sweep.columns().to_vec();
        let shard = sweep.part() != Part::WHOLE;
        let begin = format!("{}{}\n", if shard { head.line() } else { String::new() }, heading(&columns));
        let left = if resume { left(&journal, &head, target)? } else { None };
        let part = open("part")?;
        let mark = left.unwrap_or(Mark { bytes: begin.len() as u64, ..Mark::default() });
        let begun = begin.len() as u64;
        let mut stage = Stage { target: target.to_owned(), part, journal, mark, begin: begun, columns, shard };
        stage.prepare(left.is_some(), &head, &begin).map_err(|error| StudyError::writing(target, error))?;
        Ok(stage)
    }

    fn prepare(&mut self, goes_on: bool, head: &PartHead, begin: &str) -> std::io::Result<()> {
        if !goes_on {
            self.part.set_len(0)?;
            self.part.write_all(begin.as_bytes())?;
            self.journal.set_len(0)?;
            self.journal.seek(SeekFrom::Start(0))?;
            return self.journal.write_all(format!("{}\n", head.text()).as_bytes());
        }
        if self.part.metadata()?.len() < self.mark.bytes {
            let message = "the rows that were written are gone: leave --resume out to begin anew";
            return Err(std::io::Error::other(message));
        }
        self.part.set_len(self.mark.bytes)?;
        self.part.seek(SeekFrom::End(0))?;
        // A line that was cut off in the middle must not run into the next.
        self.journal.seek(SeekFrom::End(0))?;
        self.journal.write_all(b"\n")
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
        let failed = |error: std::io::Error| E::from(StudyError::reading(&target, error));
        self.part.seek(SeekFrom::Start(self.begin)).map_err(failed)?;
        let columns = self.columns.clone();
        for line in BufReader::new((&self.part).take(self.mark.bytes - self.begin)).lines() {
            let line = line.map_err(failed)?;
            let row = read_line(&columns, &line)
                .ok_or_else(|| failed(std::io::Error::other(format!("'{line}' is no row of this sweep"))))?;
            each(row)?;
        }
        self.part.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(())
    }

    /// Appends the rows of some geometries, as lines. Behind this call a kill loses none of them.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn append(&mut self, geometries: u64, rows: u64, lines: &[String]) -> Result<(), StudyError> {
        let mut write = || {
            for lines in lines {
                self.part.write_all(lines.as_bytes())?;
                self.mark.bytes += lines.len() as u64;
            }
            self.part.sync_data()?;
            self.mark.geometries += geometries;
            self.mark.rows += rows;
            let mark = serde_json::to_string(&self.mark)?;
            self.journal.write_all(format!("{mark}\n").as_bytes())
        };
        write().map_err(|error| StudyError::writing(&self.target, error))
    }

    /// Takes everything away.
    ///
    /// # Errors
    /// A file cannot be taken away.
    pub fn discard(self) -> Result<(), StudyError> {
        self.finish(false)
    }

    /// All rows are there: gives them their final name if they are wanted as CSV, and takes away what stands beside it.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(mut self, as_csv: bool) -> Result<(), StudyError> {
        let mut close = || {
            let part = beside(&self.target, "part");
            if as_csv {
                if self.shard {
                    self.part.write_all(end_line(self.mark.rows).as_bytes())?;
                }
                self.part.sync_data()?;
                fs::rename(&part, &self.target)?;
            } else {
                fs::remove_file(&part)?;
            }
            fs::remove_file(beside(&self.target, "journal"))
        };
        close().map_err(|error| StudyError::writing(&self.target, error))
    }
}

/// How far the part that is left had come; none if none is left.
fn left(journal: &File, head: &PartHead, target: &Path) -> Result<Option<Mark>, StudyError> {
    let mut text = String::new();
    let mut journal = journal;
    journal.read_to_string(&mut text).map_err(|error| StudyError::reading(target, error))?;
    let mut lines = text.lines();
    // Killed before its first line: nothing is left.
    let Some(first) = lines.next().filter(|_| text.contains('\n')) else { return Ok(None) };
    let refused = |what: String| {
        let what = format!("{what}: give the same options as then, or leave --resume out to begin anew");
        StudyError::Resume { file: target.display().to_string(), what }
    };
    let Some(known) = PartHead::read(first) else {
        return Err(refused("what is left beside it is of another version".to_owned()));
    };
    if known != *head {
        return Err(refused(format!("it was begun with {}", difference(&known, head))));
    }
    Ok(lines.rev().find_map(|line| serde_json::from_str(line).ok()))
}

/// The first thing in which two sweeps differ, as the one that was begun has it.
fn difference(begun: &PartHead, now: &PartHead) -> String {
    if (begun.number, begun.of) != (now.number, now.of) {
        return format!("--shard {}/{}", begun.number, begun.of);
    }
    let names = begun.sweep.as_object().into_iter().flat_map(|object| object.iter());
    let other = names.filter(|(name, value)| now.sweep.get(name.as_str()) != Some(value)).map(|(name, value)| {
        let mut text = format!("{name} {value}");
        if let Some((end, _)) = text.char_indices().nth(200) {
            text.truncate(end);
            text.push('…');
        }
        text
    });
    other.into_iter().next().unwrap_or_else(|| "other options".to_owned())
}
