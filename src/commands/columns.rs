//! Tables of some commands, as text and in Markdown.

/// A table, its heading first, with columns as wide as their widest cell; those of these indices are aligned to the right.
pub(super) fn aligned<const N: usize>(rows: &[[String; N]], right: &[usize]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let line = |row: &[String; N]| {
        let cells = row.iter().enumerate().map(|(column, cell)| match right.contains(&column) {
            true => format!("{cell:>width$}", width = width(column)),
            false => format!("{cell:<width$}", width = width(column)),
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

/// The same in Markdown, the first column as code.
pub(super) fn markdown<const N: usize>(rows: &[[String; N]], right: &[usize]) -> String {
    let line = |row: &[String; N]| format!("| `{}` | {} |\n", row[0], row[1..].join(" | "));
    let rule = (0..N).map(|column| if right.contains(&column) { "---:|" } else { "---|" });
    let rule = format!("|{}\n", rule.collect::<String>());
    let heading = rows.first().map_or_else(String::new, line).replace('`', "");
    heading + &rule + &rows.iter().skip(1).map(line).collect::<String>()
}
