//! The rows of a sweep as a Parquet file: a column chunk for each column, in groups of rows of one size, so that the
//! same rows give the same bytes.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::{Field, reader::RowIter};
use parquet::schema::types::Type;

use stepwave_trace::guard::guarded;

use super::parts::{Check, NOT_A_PART, PartHead};
use super::table::{Column, ColumnType, Row, Value, write_line};
use super::{StudyError, Sweep};

/// Rows of a group.
const GROUP: usize = 1 << 16;
/// Key of the metadata that describes a part.
const PART: &str = "stepwave.part";

fn physical(kind: ColumnType) -> Physical {
    match kind {
        ColumnType::Whole => Physical::INT64,
        ColumnType::Real => Physical::DOUBLE,
        ColumnType::Flag => Physical::BOOLEAN,
        ColumnType::Word => Physical::BYTE_ARRAY,
    }
}

fn schema(columns: &[Column]) -> Result<Type, ParquetError> {
    let field = |column: &Column| {
        let field = Type::primitive_type_builder(&column.name, physical(column.kind));
        let logical = (column.kind == ColumnType::Word).then_some(LogicalType::String);
        field.with_repetition(Repetition::OPTIONAL).with_logical_type(logical).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    Type::group_type_builder("sweep").with_fields(fields).build()
}

/// A Parquet file being written.
pub struct ParquetTable<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    columns: Vec<Column>,
    rows: Vec<Row>,
    total: u64,
    part: Option<PartHead>,
    /// Of the groups of a part.
    checks: Vec<String>,
}

/// The check of rows, which is that of their lines in CSV.
fn check(rows: &[Row]) -> String {
    let (mut check, mut line) = (Check::default(), String::new());
    for row in rows {
        line.clear();
        write_line(row, &mut line);
        check.add(line.as_bytes());
    }
    check.take()
}

fn failed(error: impl ToString) -> StudyError {
    StudyError::Run(error.to_string())
}

impl<W: Write + Send> ParquetTable<W> {
    /// For the rows of a sweep.
    ///
    /// # Errors
    /// The sink cannot be written.
    pub fn new(sweep: &Sweep, sink: W) -> Result<ParquetTable<W>, StudyError> {
        let part = (sweep.part() != super::SweepPart::WHOLE).then(|| PartHead::new(sweep.part(), sweep.identity()));
        ParquetTable::of(sweep.columns().to_vec(), part, sink)
    }

    pub(super) fn of(columns: Vec<Column>, part: Option<PartHead>, sink: W) -> Result<ParquetTable<W>, StudyError> {
        let properties = WriterProperties::builder().set_created_by("stepwave".to_owned()).build();
        let schema = Arc::new(schema(&columns).map_err(failed)?);
        let writer = SerializedFileWriter::new(sink, schema, Arc::new(properties)).map_err(failed)?;
        Ok(ParquetTable { writer, columns, rows: Vec::new(), total: 0, part, checks: Vec::new() })
    }

    /// Appends a row.
    ///
    /// # Errors
    /// The sink cannot be written.
    pub fn row(&mut self, row: Row) -> Result<(), StudyError> {
        self.rows.push(row);
        self.total += 1;
        if self.rows.len() == GROUP { self.write_group().map_err(failed) } else { Ok(()) }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let rows = std::mem::take(&mut self.rows);
        if self.part.is_some() {
            self.checks.push(check(&rows));
        }
        let mut group = self.writer.next_row_group()?;
        for (place, column) in self.columns.iter().enumerate() {
            let values = rows.iter().map(|row| row.get(place).unwrap_or(&Value::None));
            match column.kind {
                ColumnType::Whole => {
                    let number = |value: &Value| if let Value::Whole(number) = value { Some(*number) } else { None };
                    write_column::<Int64Type>(&mut group, values, number)?;
                }
                ColumnType::Real => {
                    let number = |value: &Value| if let Value::Real(number) = value { Some(*number) } else { None };
                    write_column::<DoubleType>(&mut group, values, number)?;
                }
                ColumnType::Flag => {
                    let flag = |value: &Value| if let Value::Flag(flag) = value { Some(*flag) } else { None };
                    write_column::<BoolType>(&mut group, values, flag)?;
                }
                ColumnType::Word => {
                    let word =
                        |value: &Value| if let Value::Word(word) = value { Some(word.as_str().into()) } else { None };
                    write_column::<ByteArrayType>(&mut group, values, word)?;
                }
            }
        }
        group.close()?;
        Ok(())
    }

    /// Writes what is left and the end of the file; gives the sink, all flushed to it.
    ///
    /// # Errors
    /// The sink cannot be written.
    pub fn finish(mut self) -> Result<W, StudyError> {
        if !self.rows.is_empty() {
            self.write_group().map_err(failed)?;
        }
        if let Some(part) = self.part {
            let text =
                serde_json::json!({ "head": part.text(), "rows": self.total, "checks": self.checks }).to_string();
            self.writer.append_key_value_metadata(KeyValue::new(PART.to_owned(), text));
        }
        self.writer.into_inner().map_err(failed)
    }
}

fn write_column<'v, T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, impl Write + Send>,
    values: impl Iterator<Item = &'v Value>,
    of: impl Fn(&'v Value) -> Option<T::T>,
) -> Result<(), ParquetError> {
    let values: Vec<Option<T::T>> = values.map(of).collect();
    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    let values: Vec<T::T> = values.into_iter().flatten().collect();
    let Some(mut column) = group.next_column()? else { return Ok(()) };
    column.typed::<T>().write_batch(&values, Some(&levels), None)?;
    column.close()
}

/// The crate panics on some files that were changed.
fn broken(reason: &str) -> String {
    format!("its Parquet is broken ({reason}): copy the file anew, or do this part again")
}

/// A part in Parquet being read.
pub(super) struct ParquetPart {
    pub(super) head: PartHead,
    rows: RowIter<'static>,
    checks: Vec<String>,
    /// Rows of the group so far, and those of the groups before.
    group: Vec<Row>,
    before: u64,
}

impl ParquetPart {
    /// Opens a part; inside, why it is none.
    pub(super) fn open(path: &Path) -> Result<ParquetPart, String> {
        guarded(|| ParquetPart::opened(path)).unwrap_or_else(|reason| Err(broken(&reason)))
    }

    fn opened(path: &Path) -> Result<ParquetPart, String> {
        let file = std::fs::File::open(path).map_err(|error| error.to_string())?;
        let reader = SerializedFileReader::new(file).map_err(|error| error.to_string())?;
        let file = reader.metadata().file_metadata();
        let metadata = file.key_value_metadata().into_iter().flatten().find(|pair| pair.key == PART);
        let metadata = metadata.and_then(|pair| serde_json::from_str::<serde_json::Value>(pair.value.as_deref()?).ok());
        let head = metadata.as_ref().and_then(|metadata| metadata.get("head")?.as_str()).ok_or(NOT_A_PART)?;
        let head = PartHead::read(head)?;
        let count = metadata.as_ref().and_then(|metadata| metadata.get("rows")?.as_u64());
        let checks: Option<Vec<String>> =
            metadata.as_ref().and_then(|metadata| serde_json::from_value(metadata.get("checks")?.clone()).ok());
        let (Some(count), Some(checks)) = (count, checks) else {
            return Err(NOT_A_PART.to_owned());
        };
        let rows = u64::try_from(file.num_rows()).unwrap_or(0);
        if rows != count {
            return Err(format!("it has {rows} of its {count} rows"));
        }
        let columns = head.columns().ok_or("its columns are not named")?;
        let names = file.schema_descr().columns().iter().map(|column| column.name());
        if names.ne(columns.iter().map(|column| column.name.as_str())) {
            return Err("its columns are not those of its sweep".to_owned());
        }
        let rows = RowIter::from_file_into(Box::new(reader));
        Ok(ParquetPart { head, rows, checks, group: Vec::new(), before: 0 })
    }

    /// The next row. After one that cannot be read there is none.
    pub(super) fn next(&mut self) -> Option<Result<Row, String>> {
        guarded(|| self.step()).unwrap_or_else(|reason| Some(Err(broken(&reason))))
    }

    fn step(&mut self) -> Option<Result<Row, String>> {
        match self.rows.next() {
            Some(Ok(row)) => {
                let row: Row = row.get_column_iter().map(|(_, field)| field).map(value).collect();
                self.group.push(row.clone());
                let whole = self.group.len() == GROUP;
                Some(if whole { self.compare().map(|()| row) } else { Ok(row) })
            }
            Some(Err(error)) => Some(Err(error.to_string())),
            None if self.group.is_empty() => None,
            None => self.compare().err().map(Err),
        }
    }

    /// Compares a group of rows with what was written.
    fn compare(&mut self) -> Result<(), String> {
        let rows = std::mem::take(&mut self.group);
        let place = usize::try_from(self.before).unwrap_or(usize::MAX) / GROUP;
        let (first, last) = (self.before + 1, self.before + rows.len() as u64);
        self.before = last;
        if self.checks.get(place) == Some(&check(&rows)) {
            return Ok(());
        }
        Err(format!("rows {first} to {last} are not as they were written: copy the file anew, or do this part again"))
    }
}

fn value(field: &Field) -> Value {
    match field {
        Field::Long(number) => Value::Whole(*number),
        Field::Double(number) => Value::Real(*number),
        Field::Bool(flag) => Value::Flag(*flag),
        Field::Str(word) => Value::Word(word.clone()),
        _ => Value::None,
    }
}
