//! In what recorded files differ from simulated ones, in words.

use crate::trace::diverge::{self, By, Options};
use crate::trace::read::Wave;

/// Clocks shown before a divergence.
const CONTEXT: usize = 5;

/// The first thing in which a file differs.
pub(super) fn first(name: &str, recorded: &[u8], made: &[u8]) -> String {
    let wave = if name.ends_with(".vcd") { first_divergence(recorded, made) } else { None };
    wave.unwrap_or_else(|| {
        let (recorded, made) = (String::from_utf8_lossy(recorded), String::from_utf8_lossy(made));
        let place = recorded.lines().zip(made.lines()).take_while(|(a, b)| a == b).count();
        if place == recorded.lines().count().max(made.lines().count()) {
            return format!("recorded are {}, simulated {}", line_ends(&recorded), line_ends(&made));
        }
        let at = |text: &str| text.lines().nth(place).unwrap_or("the end of the file").to_owned();
        let mut words = format!("line {}: recorded '{}', simulated '{}'", place + 1, at(&recorded), at(&made));
        if name.ends_with(".csv") {
            words += &columns(&recorded, &made, place);
        }
        words
    })
}

/// Where two waves part, in words; `None` if they agree in all values and differ only as text.
fn first_divergence(recorded: &[u8], made: &[u8]) -> Option<String> {
    let (recorded, made) = (Wave::from_bytes(recorded.to_vec()).ok()?, Wave::from_bytes(made.to_vec()).ok()?);
    // Waves of programs are without their clock.
    let clockless = recorded.clock().is_err() && made.clock().is_err();
    let by = if clockless { By::Time } else { Options::default().by };
    let options = Options { by, context: CONTEXT, ..Options::default() };
    let divergence = diverge::first_divergence(&recorded, &made, &options).ok()??;
    Some(format!("recorded is A, simulated is B\n{divergence}"))
}

/// What the lines of a text end with.
fn line_ends(text: &str) -> &'static str {
    match (text.contains("\r\n"), text.ends_with('\n')) {
        (true, true) => "lines that end with CR and LF",
        (false, true) => "lines that end with LF",
        (_, false) => "lines of which the last has no end",
    }
}

/// The columns in which two tables differ in this line, and the step there.
fn columns(recorded: &str, made: &str, place: usize) -> String {
    let fields = |text: &str, line: usize| -> Vec<String> {
        text.lines().nth(line).map(|line| line.split(',').map(str::to_owned).collect()).unwrap_or_default()
    };
    let (heading, other) = (fields(recorded, 0), fields(made, 0));
    if place == 0 {
        let only = |one: &[String], other: &[String]| -> Vec<String> {
            one.iter().filter(|name| !other.contains(name)).cloned().collect()
        };
        return match (only(&heading, &other), only(&other, &heading)) {
            (gone, new) if gone.is_empty() && new.is_empty() => "; the columns are in another order".to_owned(),
            (gone, new) => {
                let list = |names: Vec<String>| if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                format!("; columns only recorded: {}, only simulated: {}", list(gone), list(new))
            }
        };
    }
    let (before, now) = (fields(recorded, place), fields(made, place));
    if before.is_empty() || now.is_empty() {
        let rows = |text: &str| text.lines().count().saturating_sub(1);
        return format!("; recorded are {} rows, simulated {}", rows(recorded), rows(made));
    }
    if before.len() != now.len() {
        return format!("; recorded are {} columns, simulated {}", before.len(), now.len());
    }
    let row = ["block", "step"].into_iter().filter_map(|name| {
        let column = heading.iter().position(|heading| heading == name)?;
        Some(format!("{name} {}", now.get(column)?))
    });
    let row = row.collect::<Vec<_>>().join(", ");
    let differing = heading.iter().enumerate().filter_map(|(column, name)| {
        let (before, now) = (before.get(column)?, now.get(column)?);
        (before != now).then(|| format!("column {name}: recorded {before}, simulated {now}"))
    });
    let differing = differing.collect::<Vec<_>>().join("; ");
    if differing.is_empty() { String::new() } else { format!("; {row}: {differing}") }
}
