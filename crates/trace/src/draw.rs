//! A wave as text, for a terminal or a test: a line for each signal, a cell for each clock or for each time at which something
//! changes.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::RangeInclusive;

use crate::read::{Signal, Value, ValueKind, Wave};

/// How vectors are written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Radix {
    /// Decimal, with a sign where the signal is declared with one.
    #[default]
    Declared,
    /// Binary.
    Binary,
    /// Hexadecimal.
    Hex,
    /// Decimal in two's complement.
    Signed,
    /// Decimal without a sign.
    Unsigned,
}

/// How a wave is drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct Drawing {
    /// Characters of a line, at least [`LEAST_COLUMNS`].
    pub columns: usize,
    /// With the characters of ASCII alone.
    pub ascii: bool,
    /// With the escape sequences of a terminal.
    pub colour: bool,
    /// How vectors are written.
    pub radix: Radix,
    /// The first clock, or time of the wave, that is drawn.
    pub from: u64,
    /// The last one; as many as fit in a line where it is not given.
    pub to: Option<u64>,
    /// Cells are times at which something changes, in units of the wave, and not clocks.
    pub by_time: bool,
    /// Names of values by signal: those of states, by the bits of a value.
    pub names: BTreeMap<String, BTreeMap<String, String>>,
}

/// The narrowest line.
pub const LEAST_COLUMNS: usize = 40;
/// Most characters of a name of a signal.
const NAME: usize = 28;
/// Characters of a cell.
const CELL: RangeInclusive<usize> = 2..=8;

/// What is drawn with which characters.
struct Characters {
    low: char,
    high: char,
    rise: char,
    fall: char,
    bound: char,
    cut: char,
}

const ASCII: Characters = Characters { low: '_', high: '-', rise: '/', fall: '\\', bound: '|', cut: '~' };
const UNICODE: Characters = Characters { low: '▁', high: '▔', rise: '╱', fall: '╲', bound: '│', cut: '…' };

/// A value over several cells.
struct Stretch {
    cells: usize,
    text: String,
    /// Every bit is 0 or 1.
    known: bool,
}

/// The rows of a signal.
struct Row<'w> {
    name: String,
    signal: &'w Signal,
    stretches: Vec<Stretch>,
}

impl Default for Drawing {
    /// 80 columns from clock 0.
    fn default() -> Drawing {
        let (ascii, colour, by_time) = (false, false, false);
        let (radix, from, to, names) = (Radix::default(), 0, None, BTreeMap::new());
        Drawing { columns: 80, ascii, colour, radix, from, to, by_time, names }
    }
}

impl Drawing {
    /// Draws these signals of a wave, in this order; a line at the end says what is left out.
    ///
    /// Clocks count from 0, the first sample, where the wave has a clock.
    ///
    /// # Errors
    /// There is nothing from the first clock or time on, or no clock.
    pub fn text(&self, wave: &Wave, signals: &[usize]) -> Result<String, String> {
        let places = self.places(wave)?;
        let names = short_names(wave, signals);
        let name = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).min(NAME);
        let room = self.columns.max(LEAST_COLUMNS) - name - 1;
        let most = room / CELL.start();
        // Without an end only what fits in a line counts.
        let shown = if self.to.is_some() { &places[..] } else { &places[..places.len().min(most)] };
        let rows: Vec<Row<'_>> =
            signals.iter().zip(names).map(|(&signal, name)| self.row(wave, signal, name, shown)).collect();
        let cell = rows.iter().flat_map(|row| &row.stretches).map(|stretch| stretch.least_cell()).max().unwrap_or(0);
        let cell = cell.clamp(*CELL.start(), *CELL.end());
        let fit = room / cell;
        let last = if self.to.is_some() { shown.len() } else { shown.len().min(fit) };
        let mut text = String::new();
        let mut first = 0;
        while first < last {
            let end = last.min(first + fit);
            if first > 0 {
                text.push('\n');
            }
            self.panel(&mut text, (&rows, name), &shown[first..end], first, cell);
            first = end;
        }
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", self.account(wave, &shown[..last], places.len()));
        Ok(text)
    }

    /// The clocks or times that may be drawn.
    fn places(&self, wave: &Wave) -> Result<Vec<u64>, String> {
        let to = self.to.unwrap_or(u64::MAX);
        let (what, all): (_, Vec<u64>) = if self.by_time {
            ("time", wave.times().to_vec())
        } else {
            ("clock", (0..wave.cycles().map_err(|error| error.to_string())?).collect())
        };
        let last = all.last().copied();
        let places: Vec<u64> = all.into_iter().filter(|place| (self.from..=to).contains(place)).collect();
        if !places.is_empty() {
            return Ok(places);
        }
        let end = last.map_or_else(|| "is empty".to_owned(), |last| format!("ends at {what} {last}"));
        Err(format!("nothing is left from {what} {} on: the wave {end}", self.from))
    }

    fn row<'w>(&self, wave: &'w Wave, index: usize, name: String, places: &[u64]) -> Row<'w> {
        let signal = &wave.signals()[index];
        let at = |place: u64| {
            if self.by_time {
                return wave.value_at_time(index, place);
            }
            wave.value_at_cycle(index, place).ok().flatten()
        };
        let mut stretches: Vec<Stretch> = Vec::new();
        let mut before: Option<Value<'_>> = None;
        for &place in places {
            let value = at(place).unwrap_or(Value::Unset);
            match stretches.last_mut() {
                Some(stretch) if before.is_some_and(|before| before.same(value)) => stretch.cells += 1,
                _ => {
                    let known = !matches!(value, Value::Unset)
                        && !matches!(value, Value::Bits(bits) if bits.width() > 0 && bits.digits().any(|bit| !"01".contains(bit)));
                    stretches.push(Stretch { cells: 1, text: self.value(signal, value), known });
                }
            }
            before = Some(value);
        }
        Row { name, signal, stretches }
    }

    /// A value as it is written into its cells; control characters of a file do not get through.
    fn value(&self, signal: &Signal, value: Value<'_>) -> String {
        let Value::Bits(bits) = value else {
            return match value {
                Value::Text(text) => text.escape_debug().to_string(),
                other => other.cell(),
            };
        };
        let binary: String = match bits.shortest() {
            Some(digit @ (b"x" | b"z")) => String::from_utf8_lossy(digit).into_owned(),
            _ => bits.digits().collect(),
        };
        if let Some(name) = self.names.get(signal.leaf()).and_then(|names| names.get(&binary)) {
            return name.clone();
        }
        let number = bits.to_u128().filter(|_| bits.width() > 1);
        let signed = |number: u128| {
            let unused = 128 - bits.width();
            ((number << unused).cast_signed() >> unused).to_string()
        };
        match (self.radix, number) {
            (_, None) | (Radix::Binary, _) => binary,
            (Radix::Declared, Some(_)) => bits.decimal().unwrap_or(binary),
            (Radix::Hex, Some(number)) => format!("{number:0digits$x}", digits = bits.width().div_ceil(4) as usize),
            (Radix::Signed, Some(number)) => signed(number),
            (Radix::Unsigned, Some(number)) => number.to_string(),
        }
    }

    fn panel(&self, text: &mut String, (rows, name): (&[Row<'_>], usize), places: &[u64], first: usize, cell: usize) {
        text.push_str(&self.dim(format!("{:name$} {}", "", scale(places, cell)).trim_end()));
        text.push('\n');
        for row in rows {
            let _ = write!(text, "{:name$} ", cut(&row.name, name, self.characters().cut));
            text.push_str(&self.cells(row, first..first + places.len(), cell));
            text.push('\n');
        }
    }

    /// The cells of a signal in a range of places.
    fn cells(&self, row: &Row<'_>, range: std::ops::Range<usize>, cell: usize) -> String {
        let Characters { low, high, rise, fall, bound, cut: dots } = self.characters();
        let line = row.signal.width == 1 && matches!(row.signal.kind, ValueKind::Unsigned | ValueKind::Signed);
        let (mut out, mut start, mut before) = (String::new(), 0, None);
        for stretch in &row.stretches {
            let [from, to] = [start.max(range.start), (start + stretch.cells).min(range.end)];
            // What began in the part before has no edge here.
            if start < range.start {
                before = None;
            }
            start += stretch.cells;
            if from >= to {
                before = Some(&stretch.text);
                continue;
            }
            let wide = (to - from) * cell;
            let drawn = match stretch.text.as_str() {
                level @ ("0" | "1") if line => {
                    let level = if level == "1" { high } else { low };
                    let edge = match before.map(String::as_str) {
                        Some("0") if level == high => rise,
                        Some("1") if level == low => fall,
                        _ => level,
                    };
                    let levels: String = std::iter::once(edge).chain(std::iter::repeat_n(level, wide - 1)).collect();
                    self.painted("32", &levels)
                }
                text => {
                    let text = format!("{bound}{:wide$}", cut(text, wide - 1, dots), wide = wide - 1);
                    if stretch.known { text } else { self.painted("31", &text) }
                }
            };
            out.push_str(&drawn);
            before = Some(&stretch.text);
        }
        out.trim_end().to_owned()
    }

    fn characters(&self) -> Characters {
        if self.ascii { ASCII } else { UNICODE }
    }

    fn dim(&self, text: &str) -> String {
        self.painted("2", text)
    }

    fn painted(&self, code: &str, text: &str) -> String {
        if self.colour { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
    }

    /// What was drawn, and how the next part is.
    fn account(&self, wave: &Wave, shown: &[u64], all: usize) -> String {
        let (Some(first), Some(last)) = (shown.first(), shown.last()) else { return String::new() };
        let (what, unit) = match (self.by_time, wave.timescale()) {
            (false, _) => ("clock", String::new()),
            (true, None) => ("time", String::new()),
            (true, Some(unit)) => ("time", format!(", in units of {}", unit.show(1))),
        };
        let rest = all - shown.len();
        let next = if rest == 0 {
            String::new()
        } else {
            let from = last.saturating_add(1);
            format!("; {rest} more: --from {from} shows the next")
        };
        self.dim(&format!("{what} {first} to {last}{unit}{next}"))
    }
}

impl Stretch {
    /// The characters of a cell with which its text is whole.
    fn least_cell(&self) -> usize {
        (self.text.chars().count() + 1).div_ceil(self.cells)
    }
}

/// The numbers above the cells, as many as have room.
fn scale(places: &[u64], cell: usize) -> String {
    let mut line = String::new();
    let mut written = 0;
    for (index, place) in places.iter().enumerate() {
        let at = index * cell;
        if index > 0 && at < written + 2 {
            continue;
        }
        // Round numbers first, where clocks follow one another.
        let step = ((place.to_string().len() + 2).div_ceil(cell) as u64).next_multiple_of(5);
        let even = places.windows(2).all(|pair| pair[1] == pair[0] + 1);
        if even && index > 0 && place % step != 0 {
            continue;
        }
        let number = place.to_string();
        if index > 0 && at + number.len() > places.len() * cell {
            break;
        }
        line.extend(std::iter::repeat_n(' ', at - written));
        written = at + number.len();
        line.push_str(&number);
    }
    line
}

/// A text of at most `most` characters, with a mark where it was cut.
fn cut(text: &str, most: usize, mark: char) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain((most > 0).then_some(mark)).collect()
}

/// Paths without the scopes that all share.
fn short_names(wave: &Wave, signals: &[usize]) -> Vec<String> {
    let paths: Vec<&str> = signals.iter().map(|&signal| wave.signals()[signal].path.as_str()).collect();
    let shared = |length: usize| paths.iter().all(|path| path.get(..length) == paths[0].get(..length));
    let bounds = paths.first().map(|path| path.match_indices('.').map(|(at, _)| at + 1).collect::<Vec<_>>());
    let common = bounds.unwrap_or_default().into_iter().take_while(|&length| shared(length)).last().unwrap_or(0);
    paths.iter().map(|path| path[common..].escape_debug().to_string()).collect()
}

#[cfg(test)]
mod tests;
