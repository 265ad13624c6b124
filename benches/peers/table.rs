//! Medians, and tables in Markdown.

use std::fmt::Write as _;

use crate::measure::Measurement;

/// The middle one of what `of` takes from the runs.
pub(crate) fn median(runs: &[Measurement], of: impl Fn(&Measurement) -> f64) -> f64 {
    let mut values: Vec<f64> = runs.iter().map(of).collect();
    values.sort_by(f64::total_cmp);
    if values.is_empty() {
        return f64::NAN;
    }
    f64::midpoint(values[(values.len() - 1) / 2], values[values.len() / 2])
}

/// Three digits, as far as there are so many; a line for what was not measured.
pub(crate) fn number(value: f64) -> String {
    match value {
        value if value.is_nan() => "–".to_owned(),
        value if value >= 99.95 => format!("{value:.0}"),
        value if value >= 9.995 => format!("{value:.1}"),
        value => format!("{value:.2}"),
    }
}

/// A ratio.
pub(crate) fn times(value: f64) -> String {
    if value.is_nan() { number(value) } else { format!("{}×", number(value)) }
}

/// A table that grows row by row.
pub(crate) struct Table {
    text: String,
}

impl Table {
    pub(crate) fn new(title: &str, head: &[&str]) -> Table {
        let mut text = format!("\n### {title}\n\n| {} |\n|", head.join(" | "));
        for column in 0..head.len() {
            text += if column == 0 { "---|" } else { "---:|" };
        }
        text.push('\n');
        Table { text }
    }

    pub(crate) fn row(&mut self, name: &str, cells: impl IntoIterator<Item = String>) {
        let cells: Vec<String> = cells.into_iter().collect();
        // Writing into a string does not fail.
        _ = writeln!(self.text, "| {name} | {} |", cells.join(" | "));
    }

    pub(crate) fn text(self) -> String {
        self.text
    }
}
