//! What a sweep came to as a whole.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use stepwave_models::Model;

use super::columns::words;
use super::table::{Column, Row, Value};

/// Gathers rows, and says in some lines what they came to.
#[derive(Debug, Default)]
pub struct Summary {
    rows: u64,
    endings: BTreeMap<String, u64>,
    missed: u64,
    clocks: u64,
    /// The first row of the greatest path error.
    worst: Option<(f64, Row)>,
    /// The first reason of a refusal.
    refusal: Option<String>,
    place: BTreeMap<&'static str, usize>,
}

impl Summary {
    /// Of a table with these columns.
    #[must_use]
    pub fn new(columns: &[Column]) -> Summary {
        let names = ["ending", "exact", "clocks", "error_max", "reason"];
        let find =
            |name: &'static str| columns.iter().position(|column| column.name == name).map(|place| (name, place));
        Summary { place: names.into_iter().filter_map(find).collect(), ..Summary::default() }
    }

    /// Takes a row.
    pub fn row(&mut self, row: &Row) {
        let value = |name: &str| self.place.get(name).and_then(|&place| row.get(place)).unwrap_or(&Value::None);
        self.rows += 1;
        let done = match value("ending") {
            Value::Word(ending) => {
                *self.endings.entry(ending.clone()).or_default() += 1;
                ending == "done"
            }
            _ => false,
        };
        self.missed += u64::from(done && *value("exact") == Value::Flag(false));
        if let Value::Whole(clocks) = value("clocks") {
            self.clocks += clocks.unsigned_abs();
        }
        if let Value::Real(error) = value("error_max")
            && self.worst.as_ref().is_none_or(|(worst, _)| error > worst)
        {
            self.worst = Some((*error, row.clone()));
        }
        if let (None, Value::Word(reason)) = (&self.refusal, value("reason")) {
            self.refusal = Some(reason.clone());
        }
    }

    /// Rows so far.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Some lines for a terminal.
    #[must_use]
    pub fn text(&self, model: &Model, columns: &[Column]) -> String {
        let counted: Vec<String> = self.endings.iter().map(|(ending, count)| format!("{count} {ending}")).collect();
        let mut text = format!("{}: {} runs, {} clocks; {}\n", model.name, self.rows, self.clocks, counted.join(", "));
        // Writing to a string cannot fail.
        if self.missed > 0 {
            let _ = writeln!(text, "{} of those done missed their end point", self.missed);
        }
        if let Some((error, row)) = &self.worst {
            let _ = writeln!(text, "greatest path error {error:.3} BLU: {}", words(model, columns, row));
        }
        if let Some(reason) = &self.refusal {
            let _ = writeln!(text, "the first that came to nothing: {reason}");
        }
        text
    }
}
