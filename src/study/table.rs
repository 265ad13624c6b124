//! The rows of a sweep as data: columns, values, and the lines of a CSV file.

use serde::{Deserialize, Serialize};

/// What a column holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ColumnType {
    /// Whole numbers.
    Whole,
    /// Real numbers.
    Real,
    /// `true` or `false`.
    Flag,
    /// Words.
    Word,
}

/// A column of a sweep's table.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Column {
    /// Its name in the heading.
    pub name: String,
    /// What it holds.
    pub kind: ColumnType,
}

/// A value in a row.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// Nothing: a run that was refused has no clocks.
    None,
    /// A whole number.
    Whole(i64),
    /// A real number.
    Real(f64),
    /// Yes or no.
    Flag(bool),
    /// A word.
    Word(String),
}

impl Value {
    /// As a number, where it is one; yes is 1.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            // Beyond 2^53 a picture does not show the difference.
            Value::Whole(number) => Some(*number as f64),
            Value::Real(number) => Some(*number),
            Value::Flag(flag) => Some(f64::from(u8::from(*flag))),
            Value::None | Value::Word(_) => None,
        }
    }
}

impl From<u64> for Value {
    fn from(number: u64) -> Value {
        Value::Whole(i64::try_from(number).unwrap_or(i64::MAX))
    }
}

impl<T: Into<Value>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Value {
        value.map_or(Value::None, Into::into)
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Value {
        Value::Real(number)
    }
}

impl From<String> for Value {
    fn from(word: String) -> Value {
        Value::Word(word)
    }
}

/// A row: a value for each column.
pub type Row = Vec<Value>;

/// A word as a field of a line.
fn field(word: &str, line: &mut String) {
    if word.contains(['"', ',', '\n', '\r', '#']) {
        *line += &format!("\"{}\"", word.replace('"', "\"\"").replace(['\n', '\r'], " "));
    } else {
        *line += word;
    }
}

/// The heading of a CSV file, without a line feed.
#[must_use]
pub fn heading(columns: &[Column]) -> String {
    columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>().join(",")
}

/// Appends a row as a line of a CSV file, with its line feed. Real numbers are written in as few digits as give the
/// same number again.
pub fn write_line(row: &[Value], line: &mut String) {
    for (place, value) in row.iter().enumerate() {
        if place > 0 {
            line.push(',');
        }
        match value {
            Value::None => {}
            Value::Whole(number) => *line += &number.to_string(),
            Value::Real(number) => *line += &number.to_string(),
            Value::Flag(flag) => *line += if *flag { "true" } else { "false" },
            Value::Word(word) => field(word, line),
        }
    }
    line.push('\n');
}

/// The fields of a line of a CSV file.
pub(super) fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let (mut quoted, mut chars) = (false, line.chars().peekable());
    while let Some(c) = chars.next() {
        // There is always a last field.
        let Some(last) = fields.last_mut() else { break };
        match (c, quoted) {
            ('"', true) if chars.peek() == Some(&'"') => {
                chars.next();
                last.push('"');
            }
            ('"', _) => quoted = !quoted,
            (',', false) => fields.push(String::new()),
            (c, _) => last.push(c),
        }
    }
    fields
}

/// The row that a line of a CSV file holds; none where it does not fit the columns.
#[must_use]
pub fn read_line(columns: &[Column], line: &str) -> Option<Row> {
    let fields = fields(line);
    let value = |(column, word): (&Column, String)| match column.kind {
        _ if word.is_empty() => Some(Value::None),
        ColumnType::Whole => word.parse().ok().map(Value::Whole),
        ColumnType::Real => word.parse().ok().map(Value::Real),
        ColumnType::Flag => word.parse().ok().map(Value::Flag),
        ColumnType::Word => Some(Value::Word(word)),
    };
    let fits = fields.len() == columns.len();
    columns.iter().zip(fields).map(value).collect::<Option<Row>>().filter(|_| fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_read_as_it_was_written() {
        let kinds = [ColumnType::Whole, ColumnType::Real, ColumnType::Flag, ColumnType::Word, ColumnType::Word];
        let columns = kinds.map(|kind| Column { name: "c".to_owned(), kind });
        let row = vec![
            Value::Whole(i64::MIN),
            Value::Real(0.1 + 0.2),
            Value::Flag(true),
            Value::Word("f = 9, \"not\" 8".to_owned()),
            Value::None,
        ];
        let mut line = String::new();
        write_line(&row, &mut line);
        assert_eq!(line, "-9223372036854775808,0.30000000000000004,true,\"f = 9, \"\"not\"\" 8\",\n");
        assert_eq!(read_line(&columns, line.trim_end()), Some(row));
        for wrong in ["1,2,true,a", "1,2,maybe,a,b", "1.5,2,true,a,b", ""] {
            assert_eq!(read_line(&columns, wrong), None, "{wrong}");
        }
    }
}
