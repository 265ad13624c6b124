//! Joining the parts of a sweep to the file that the whole sweep would have written, byte for byte.

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use super::StudyError;
use super::parquet::{ParquetPart, ParquetTable, is_parquet};
use super::parts::{PartHead, rows_of};
use super::table::{Column, Row, Value, heading, read_line, write_line};

/// A part in CSV being read.
struct CsvPart {
    head: PartHead,
    columns: Vec<Column>,
    lines: std::io::Lines<BufReader<File>>,
    rows: u64,
    ended: bool,
}

impl CsvPart {
    fn open(path: &Path) -> Result<CsvPart, String> {
        let file = File::open(path).map_err(|error| error.to_string())?;
        let mut lines = BufReader::with_capacity(1 << 16, file).lines();
        let mut line = || lines.next().unwrap_or_else(|| Ok(String::new())).map_err(|error| error.to_string());
        let head = PartHead::of_line(&line()?).ok_or("it is no part of a sweep: --shard makes them")?;
        let columns = head.columns().ok_or("its columns are not told")?;
        if line()? != heading(&columns) {
            return Err("its heading does not name its columns".to_owned());
        }
        Ok(CsvPart { head, columns, lines, rows: 0, ended: false })
    }

    fn next(&mut self) -> Option<Result<Row, String>> {
        let cut = || Some(Err("its end is missing: copy it anew, or do this part again".to_owned()));
        let line = match self.lines.next() {
            None if self.ended => return None,
            None => return cut(),
            Some(Err(error)) => return Some(Err(error.to_string())),
            Some(Ok(line)) => line,
        };
        if let Some(rows) = rows_of(&line) {
            if rows != self.rows {
                return Some(Err(format!("it has {} of its {rows} rows", self.rows)));
            }
            self.ended = true;
            return self.lines.next().map(|_| Err("something stands behind its end".to_owned()));
        }
        self.rows += 1;
        match read_line(&self.columns, &line) {
            Some(row) => Some(Ok(row)),
            // The last line of a file that was cut.
            None => Some(Err(format!("its row {} cannot be read", self.rows))),
        }
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

    /// Takes the next row, and reads the one behind it.
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
            return Err(self.wrong(format!("row {index} stands behind row {before}")));
        }
        Ok(std::mem::replace(&mut self.next, next).map(|(_, row)| row))
    }
}

/// Joins all parts of a sweep, in whatever order they are given, and writes the rows as Parquet or as CSV; gives their
/// number.
///
/// # Errors
/// A part cannot be read, is not whole, is of another sweep, is missing or is there twice; or `sink` cannot be written.
pub fn merge(inputs: &[PathBuf], sink: impl Write + Send, as_parquet: bool) -> Result<u64, StudyError> {
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
    let columns = first.columns().unwrap_or_default();
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
