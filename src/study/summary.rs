//! What a sweep came to as a whole.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use stepwave_models::{AXES, Model};

use super::columns::words;
use super::table::{Column, Row, Value};

/// Gathers rows, and says in some lines what they came to.
#[derive(Debug, Default)]
pub struct Summary {
    rows: u64,
    /// Those with a mean speed.
    timed: u64,
    endings: BTreeMap<String, u64>,
    missed: u64,
    clocks: u64,
    /// The first row of the greatest path error.
    worst: Option<(f64, Row)>,
    /// The first row of the least and of the greatest mean speed over v_max.
    slowest: Option<(f64, Row)>,
    fastest: Option<(f64, Row)>,
    /// Least and greatest length of those lines, in BLU; `None` before the first, and where curves are not lines.
    lengths: Option<[f64; 2]>,
    /// The first reason of a refusal.
    refusal: Option<String>,
    place: BTreeMap<&'static str, usize>,
    /// Columns of the ends of each axis; none of curves that are not lines.
    ends: Vec<[usize; 2]>,
}

impl Summary {
    /// Of a table with these columns.
    #[must_use]
    pub fn new(columns: &[Column]) -> Summary {
        let names = ["ending", "exact", "clocks", "error_max", "v_mean", "reason"];
        let find =
            |name: &'static str| columns.iter().position(|column| column.name == name).map(|place| (name, place));
        let named = |name: &str| columns.iter().position(|column| column.name == name);
        let is_line = named("center_x").is_none() && named("curve").is_none();
        let ends = AXES.iter().map_while(|axis| named(&format!("from_{axis}")).zip(named(&format!("to_{axis}"))));
        let ends = ends.map(|(from, to)| [from, to]).filter(|_| is_line).collect();
        Summary { place: names.into_iter().filter_map(find).collect(), ends, ..Summary::default() }
    }

    /// Takes a row.
    pub fn row(&mut self, row: &Row) {
        let value = |name: &str| self.place.get(name).and_then(|&place| row.get(place)).unwrap_or(&Value::None);
        let speed = value("v_mean").number();
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
        if let Some(speed) = speed {
            self.speed(speed, row);
        }
    }

    fn speed(&mut self, speed: f64, row: &Row) {
        self.timed += 1;
        if self.slowest.as_ref().is_none_or(|(least, _)| speed < *least) {
            self.slowest = Some((speed, row.clone()));
        }
        if self.fastest.as_ref().is_none_or(|(greatest, _)| speed > *greatest) {
            self.fastest = Some((speed, row.clone()));
        }
        let number = |place: usize| row.get(place).and_then(Value::number).unwrap_or(0.0);
        let length = self.ends.iter().map(|&[from, to]| (number(to) - number(from)).powi(2)).sum::<f64>().sqrt();
        let [least, greatest] = self.lengths.unwrap_or([length; 2]);
        self.lengths = Some([least.min(length), greatest.max(length)]);
    }

    /// k_v of a method: the greatest mean speed over the least, of lines of about one length in several directions; `None`
    /// of others.
    #[must_use]
    pub fn k_v(&self) -> Option<f64> {
        let (slowest, fastest) = (self.slowest.as_ref()?, self.fastest.as_ref()?);
        let [least, greatest] = self.lengths.filter(|_| !self.ends.is_empty())?;
        (greatest - least <= 1.0 && self.rows > 1).then(|| fastest.0 / slowest.0)
    }

    /// Which of the runs have a mean speed, where these are not all.
    fn share(&self) -> String {
        if self.timed == self.rows { String::new() } else { format!("{} of {} ", self.timed, self.rows) }
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
        if let (Some((least, slow)), Some((greatest, fast))) = (&self.slowest, &self.fastest) {
            let [slow, fast] = [slow, fast].map(|row| words(model, columns, row));
            let _ = writeln!(text, "mean speed over v_max: least {least:.4}: {slow}\n  greatest {greatest:.4}: {fast}");
            if let Some(k_v) = self.k_v() {
                let _ =
                    writeln!(text, "k_v {k_v:.4}, the greatest over the least, of {}lines of one length", self.share());
            }
        }
        if let Some(reason) = &self.refusal {
            let _ = writeln!(text, "the first that came to nothing: {reason}");
        }
        text
    }
}
