//! Joining the parts of a sweep to the file that the whole sweep would have written, byte for byte.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use super::StudyError;
use super::parquet::{ParquetPart, ParquetTable};
use super::parts::{Check, PartHead, Remark};
use super::table::{Column, Row, Value, heading, read_line, write_line};

/// Most bytes of a line of a part.
const LONGEST: u64 = 1 << 24;

/// The lines of a text, one at a time.
struct Lines {
    text: BufReader<File>,
    /// The last that was read, with its line feed.
    line: String,
    /// Its number, from 1.
    number: u64,
}

impl Lines {
    /// Reads the next line; gives whether there is one.
    fn read(&mut self) -> Result<bool, String> {
        self.line.clear();
        self.number += 1;
        let read = (&mut self.text).take(LONGEST).read_line(&mut self.line);
        match read.map_err(|error| format!("line {} cannot be read: {error}", self.number))? {
            0 => Ok(false),
            _ if self.line.len() as u64 == LONGEST => {
                Err(format!("line {} has more than {LONGEST} bytes", self.number))
            }
            _ => Ok(true),
        }
    }
}

/// A part in CSV being read.
struct CsvPart {
    head: PartHead,
    columns: Vec<Column>,
    lines: Lines,
    rows: u64,
    ended: bool,
    /// Of the lines from this number on.
    check: Check,
    since: u64,
}

impl CsvPart {
    fn open(path: &Path) -> Result<CsvPart, String> {
        let file = File::open(path).map_err(|error| error.to_string())?;
        let mut lines = Lines { text: BufReader::with_capacity(1 << 16, file), line: String::new(), number: 0 };
        let mut check = Check::default();
        lines.read()?;
        let head = PartHead::of_line(&lines.line)?;
        check.add(lines.line.as_bytes());
        let columns = head.columns().ok_or("its columns are not named")?;
        lines.read()?;
        check.add(lines.line.as_bytes());
        if lines.line.trim_end() != heading(&columns) {
            return Err("line 2, its heading, does not name its columns".to_owned());
        }
        Ok(CsvPart { head, columns, lines, rows: 0, ended: false, check, since: 1 })
    }

    fn next(&mut self) -> Option<Result<Row, String>> {
        self.try_next().transpose()
    }

    fn try_next(&mut self) -> Result<Option<Row>, String> {
        loop {
            match (self.lines.read()?, self.ended) {
                (false, true) => return Ok(None),
                (true, true) => return Err(format!("line {} follows its end", self.lines.number)),
                (false, false) => return Err("its end is missing: copy it anew, or do this part again".to_owned()),
                (true, false) => {}
            }
            match Remark::of(&self.lines.line) {
                None => break,
                Some(Remark::Check(check)) => self.compare(&check)?,
                Some(Remark::End(rows, _)) if rows != self.rows => {
                    return Err(format!("it has {} of its {rows} rows", self.rows));
                }
                Some(Remark::End(_, check)) => {
                    self.compare(&check)?;
                    self.ended = true;
                }
            }
        }
        self.rows += 1;
        self.check.add(self.lines.line.as_bytes());
        let row = read_line(&self.columns, self.lines.line.trim_end_matches('\n'));
        // The last line of a file that was cut, or one that was changed.
        row.map(Some).ok_or_else(|| format!("line {} is not as it was written", self.lines.number))
    }

    /// Compares the lines since the last check with what was written.
    fn compare(&mut self, written: &str) -> Result<(), String> {
        let (first, last) = (self.since, self.lines.number - 1);
        self.since = self.lines.number + 1;
        if self.check.take() == written {
            return Ok(());
        }
        Err(format!(
            "lines {first} to {last} are not as they were written, or line {}, which holds their check: copy the file \
             anew, or do this part again",
            self.lines.number
        ))
    }
}

enum Reader {
    Csv(Box<CsvPart>),
    Parquet(Box<ParquetPart>),
}

/// A part, and its next row.
struct Source {
    path: PathBuf,
    reader: Reader,
    next: Option<(i64, Row)>,
}

impl Source {
    fn open(path: &Path) -> Result<Source, StudyError> {
        let parquet = is_parquet(path).map_err(|error| StudyError::reading(path, error))?;
        let reader = if parquet {
            ParquetPart::open(path).map(|part| Reader::Parquet(Box::new(part)))
        } else {
            CsvPart::open(path).map(|part| Reader::Csv(Box::new(part)))
        };
        let reader = reader.map_err(|what| StudyError::Merge { file: path.display().to_string(), what })?;
        Ok(Source { path: path.to_owned(), reader, next: None })
    }

    fn head(&self) -> &PartHead {
        match &self.reader {
            Reader::Csv(part) => &part.head,
            Reader::Parquet(part) => &part.head,
        }
    }

    fn wrong(&self, what: impl ToString) -> StudyError {
        StudyError::Merge { file: self.path.display().to_string(), what: what.to_string() }
    }

    /// Takes the next row, and reads the one after it.
    fn advance(&mut self) -> Result<Option<Row>, StudyError> {
        let row = match &mut self.reader {
            Reader::Csv(part) => part.next(),
            Reader::Parquet(part) => part.next(),
        };
        let next = match row.transpose().map_err(|what| self.wrong(what))? {
            None => None,
            Some(row) => match row.first() {
                Some(Value::Whole(index)) => Some((*index, row)),
                _ => return Err(self.wrong("a row has no index")),
            },
        };
        if let (Some((before, _)), Some((index, _))) = (&self.next, &next)
            && before >= index
        {
            return Err(self.wrong(format!("row {index} comes after row {before}")));
        }
        Ok(std::mem::replace(&mut self.next, next).map(|(_, row)| row))
    }
}

/// Joins all parts of a sweep, in any order, and writes the rows as Parquet or as CSV; gives their
/// number.
///
/// # Errors
/// A part cannot be read, is not whole, is of another sweep, is missing or is there twice; or `sink` cannot be written.
pub fn merge(inputs: &[PathBuf], sink: impl Write + Send, as_parquet: bool) -> Result<u64, StudyError> {
    let mut sources = in_order(inputs)?;
    let columns = sources[0].head().columns().unwrap_or_default();
    for source in &mut sources {
        source.advance()?;
    }
    let mut rows = 0;
    let mut each = |mut take: Box<dyn FnMut(Row) -> Result<(), StudyError> + '_>| {
        while let Some(source) = sources
            .iter_mut()
            .filter(|source| source.next.is_some())
            .min_by_key(|source| source.next.as_ref().map(|(index, _)| *index))
        {
            if let Some(row) = source.advance()? {
                take(row)?;
                rows += 1;
            }
        }
        Ok::<(), StudyError>(())
    };
    if as_parquet {
        let mut table = ParquetTable::of(columns, None, sink)?;
        each(Box::new(|row| table.row(row)))?;
        let mut sink = table.finish()?;
        sink.flush().map_err(|error| StudyError::Run(error.to_string()))?;
    } else {
        let mut sink = sink;
        let failed = |error: std::io::Error| StudyError::Run(error.to_string());
        sink.write_all(format!("{}\n", heading(&columns)).as_bytes()).map_err(failed)?;
        let mut line = String::new();
        each(Box::new(|row| {
            line.clear();
            write_line(&row, &mut line);
            sink.write_all(line.as_bytes()).map_err(failed)
        }))?;
        sink.flush().map_err(failed)?;
    }
    Ok(rows)
}

/// All parts of one sweep by their numbers, at least one, each there once.
fn in_order(inputs: &[PathBuf]) -> Result<Vec<Source>, StudyError> {
    let mut sources = inputs.iter().map(|path| Source::open(path)).collect::<Result<Vec<_>, _>>()?;
    sources.sort_by_key(|source| source.head().number);
    let Some(first) = sources.first().map(|source| source.head().clone()) else {
        return Err(StudyError::Geometries("there are no parts to merge: name them".to_owned()));
    };
    for source in &sources {
        let head = source.head();
        if (head.of, &head.sweep) != (first.of, &first.sweep) {
            return Err(source.wrong(format!("it is of another sweep than {}", sources[0].path.display())));
        }
    }
    for (source, number) in sources.iter().zip(1..) {
        if source.head().number < number {
            return Err(source.wrong(format!("part {}/{} is given twice", source.head().number, first.of)));
        }
        if source.head().number > number {
            return Err(source.wrong(format!("part {number}/{} is missing", first.of)));
        }
    }
    if (sources.len() as u64) < first.of {
        let last = &sources[sources.len() - 1];
        return Err(last.wrong(format!("part {}/{} is missing", sources.len() + 1, first.of)));
    }
    Ok(sources)
}

/// A file is in Parquet by its first bytes.
fn is_parquet(path: &Path) -> std::io::Result<bool> {
    let mut magic = Vec::new();
    std::fs::File::open(path)?.take(4).read_to_end(&mut magic)?;
    Ok(magic == b"PAR1")
}
