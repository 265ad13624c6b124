//! The journal of a sweep: which it is, and how far it had come when a chunk had been written whole.

use std::fs::{File, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::left;
use crate::study::parts::{Check, PartHead};

/// Opened again where another sweep has just ended.
const TRIES: usize = 100;

/// How far a part is.
#[derive(Clone, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
pub(super) struct Mark {
    /// Geometries done.
    pub(super) geometries: u64,
    pub(super) rows: u64,
    pub(super) bytes: u64,
    /// Of all these bytes.
    pub(super) check: String,
}

/// A line of the journal.
#[derive(Serialize, Deserialize)]
struct Line {
    #[serde(flatten)]
    mark: Mark,
    /// Of the mark itself.
    line_check: String,
}

impl Mark {
    /// The check of the line that holds it.
    fn line_check(&self) -> String {
        let mut check = Check::default();
        let Mark { geometries, rows, bytes, check: of_bytes } = self;
        check.add(format!("{geometries} {rows} {bytes} {of_bytes}").as_bytes());
        check.take()
    }
}

/// A journal, locked as long as it is open.
pub(super) struct Journal {
    path: PathBuf,
    file: File,
    /// What was in it.
    text: String,
}

impl Journal {
    /// Opens what is left, or makes a new one; gives whether it is new.
    ///
    /// # Errors
    /// Another sweep holds it, it is not a journal, or it cannot be opened.
    pub(super) fn open(path: &Path) -> io::Result<(Journal, bool)> {
        for _ in 0..TRIES {
            let (mut file, is_new) = match left::open(path)? {
                Some(file) => (file, false),
                None => match File::options().read(true).write(true).create_new(true).open(path) {
                    Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                    file => (file?, true),
                },
            };
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => {
                    return Err(io::Error::other("another sweep is writing it: wait, or name another file"));
                }
                // Where files cannot be locked, two sweeps of one name are the user's to avoid.
                Err(TryLockError::Error(_)) | Ok(()) => {}
            }
            // Another sweep may have ended and removed it.
            if !left::is_at(&file, path)? {
                continue;
            }
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes)?;
            let text = String::from_utf8_lossy(&bytes).into_owned();
            let own = text.is_empty() || text.lines().next().is_some_and(PartHead::is_one);
            if !own {
                return Err(left::occupied(path, "no sweep has left it there"));
            }
            return Ok((Journal { path: path.to_owned(), file, text }, is_new));
        }
        Err(io::Error::other("other sweeps of this name begin and end all the time"))
    }

    /// There is something in it.
    pub(super) fn is_begun(&self) -> bool {
        !self.text.is_empty()
    }

    /// What it says of this sweep, and cuts off a line that was not written whole.
    ///
    /// # Errors
    /// Why the sweep cannot go on: it is of another, or was changed.
    pub(super) fn marks(&mut self, head: &PartHead) -> Result<Vec<Mark>, String> {
        let mut lines = self.text.split_inclusive('\n').filter(|line| line.ends_with('\n'));
        // Killed before its first line: nothing is left.
        let Some(first) = lines.next() else { return Ok(Vec::new()) };
        let remedy = "give the same options as then, or leave --resume out to begin anew";
        let Ok(known) = PartHead::read(first.trim_end()) else {
            return Err(format!("what is left next to it is of another version: {remedy}"));
        };
        if known != *head {
            return Err(format!("it was begun with {}: {remedy}", difference(&known, head)));
        }
        let mut whole = first.len() as u64;
        let mut marks = Vec::new();
        for (line, number) in lines.zip(2..) {
            let read = serde_json::from_str(line).ok();
            let Some(Line { mark, .. }) = read.filter(|read: &Line| read.mark.line_check() == read.line_check) else {
                return Err(format!(
                    "{}: line {number} is not as it was written: leave --resume out to begin anew",
                    self.path.display()
                ));
            };
            whole += line.len() as u64;
            marks.push(mark);
        }
        let cut = self.file.set_len(whole).and_then(|()| self.file.seek(SeekFrom::End(0)));
        cut.map_err(|error| format!("{}: {error}", self.path.display()))?;
        Ok(marks)
    }

    /// Begins anew.
    pub(super) fn begin(&mut self, head: &PartHead) -> io::Result<()> {
        self.file.set_len(0)?;
        self.file.seek(SeekFrom::Start(0))?;
        self.file.write_all(format!("{}\n", head.text()).as_bytes())
    }

    /// Appends how far the part is.
    pub(super) fn append(&mut self, mark: &Mark) -> io::Result<()> {
        let line = Line { mark: mark.clone(), line_check: mark.line_check() };
        self.file.write_all(format!("{}\n", serde_json::to_string(&line)?).as_bytes())
    }
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
