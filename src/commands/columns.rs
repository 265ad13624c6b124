//! Tables of some commands, as text and in Markdown.

/// A table, its heading first, with columns as wide as their widest cell; those of these indices are aligned to the right.
pub(super) fn aligned<R: AsRef<[String]>>(rows: &[R], right: &[usize]) -> String {
    let width = |column: usize| rows.iter().map(|row| row.as_ref()[column].chars().count()).max().unwrap_or(0);
    let line = |row: &R| {
        let cells = row.as_ref().iter().enumerate().map(|(column, cell)| match right.contains(&column) {
            true => format!("{cell:>width$}", width = width(column)),
            false => format!("{cell:<width$}", width = width(column)),
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

/// The same in Markdown, the first column as code.
pub(super) fn markdown<R: AsRef<[String]>>(rows: &[R], right: &[usize]) -> String {
    let line = |row: &R| format!("| `{}` | {} |\n", row.as_ref()[0], row.as_ref()[1..].join(" | "));
    let columns = rows.first().map_or(0, |row| row.as_ref().len());
    let rule = (0..columns).map(|column| if right.contains(&column) { "---:|" } else { "---|" });
    let rule = format!("|{}\n", rule.collect::<String>());
    let heading = rows.first().map_or_else(String::new, line).replace('`', "");
    heading + &rule + &rows.iter().skip(1).map(line).collect::<String>()
}
