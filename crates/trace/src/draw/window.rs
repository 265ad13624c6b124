//! What is shown of a wave: rows of stretches of values, and the clocks or times of the cells.

use std::ops::{Range, RangeInclusive};

use super::{Drawing, LEAST_COLUMNS, Radix};
use crate::read::{Signal, Timescale, Value, ValueKind, Wave};

/// Most characters of a name of a signal.
const NAME: usize = 28;
/// Characters of a cell.
const CELL: RangeInclusive<usize> = 2..=8;

/// A window of a wave: which values its signals hold over which cells, and how they are written.
#[derive(Clone, PartialEq, Debug)]
pub struct Window {
    pub(super) rows: Vec<Row>,
    /// The clock or the time of each cell.
    pub(super) places: Vec<u64>,
    /// Clocks or times after the last cell that are left out.
    pub(super) more: u64,
    pub(super) by_time: bool,
    pub(super) unit: Option<Timescale>,
    /// Characters of the names.
    pub(super) name: usize,
    /// Characters of a cell, and cells of a line.
    pub(super) cell: usize,
    pub(super) fit: usize,
    /// The option that gives the first clock.
    pub(super) option: &'static str,
}

/// A signal.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Row {
    pub(super) name: String,
    pub(super) stretches: Vec<Stretch>,
}

/// A value over several cells.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Stretch {
    pub(super) cells: usize,
    /// The value as it is written.
    pub(super) text: String,
    pub(super) shape: Shape,
}

/// How a value looks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Shape {
    /// 0 of one bit.
    Low,
    /// 1 of one bit.
    High,
    /// Every bit is 0 or 1, or it is not of bits.
    Known,
    /// Every bit is x, or nothing was written yet.
    Unknown,
    /// Every bit is z.
    Floating,
    /// Some bits are neither 0 nor 1.
    Mixed,
}

/// The part of a stretch in a line.
pub(super) struct Piece<'w> {
    pub(super) stretch: &'w Stretch,
    /// What was held before, where the stretch begins in this line.
    pub(super) before: Option<&'w Stretch>,
    /// Cells, counted from the first one of the line.
    pub(super) cells: Range<usize>,
}

impl Window {
    pub(super) fn new(drawing: &Drawing, wave: &Wave, signals: &[usize]) -> Result<Window, String> {
        let mut places = drawing.places(wave)?;
        let all = places.len();
        let names = short_names(wave, signals);
        let name = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).min(NAME);
        let room = drawing.columns.max(LEAST_COLUMNS) - name - 1;
        // Without an end only what fits in a line counts.
        if drawing.to.is_none() {
            places.truncate(room / CELL.start());
        }
        let row =
            |(&signal, name): (&usize, String)| Row { name, stretches: stretches(drawing, wave, signal, &places) };
        let mut rows: Vec<Row> = signals.iter().zip(names).map(row).collect();
        let cell = rows.iter().flat_map(|row| &row.stretches).map(Stretch::least_cell).max().unwrap_or(0);
        let cell = cell.clamp(*CELL.start(), *CELL.end());
        let fit = room / cell;
        if drawing.to.is_none() && places.len() > fit {
            places.truncate(fit);
            rows.iter_mut().for_each(|row| row.truncate(fit));
        }
        let (by_time, unit) = (drawing.by_time, wave.timescale());
        let more = (all - places.len()) as u64 + drawing.beyond;
        Ok(Window { rows, places, more, by_time, unit, name, cell, fit, option: drawing.option })
    }

    /// Number of clocks or times that are shown.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.places.len()
    }

    /// The cells of each line.
    pub(super) fn lines(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let starts = (0..self.places.len()).step_by(self.fit.max(1));
        starts.map(|start| start..self.places.len().min(start + self.fit.max(1)))
    }

    /// The numbers of the cells of a line that have room above them, each with the character at which it begins.
    pub(super) fn numbers(&self, line: Range<usize>) -> Vec<(usize, u64)> {
        let places = &self.places[line];
        // Round numbers first, where clocks follow one another.
        let even = places.windows(2).all(|pair| pair[1] == pair[0] + 1);
        let (mut numbers, mut end) = (Vec::new(), 0);
        for (index, &place) in places.iter().enumerate() {
            let (at, length) = (index * self.cell, place.to_string().len());
            let step = ((length + 2).div_ceil(self.cell) as u64).next_multiple_of(5);
            if index > 0 && (at < end + 2 || (even && place % step != 0)) {
                continue;
            }
            if index > 0 && at + length > places.len() * self.cell {
                break;
            }
            end = at + length;
            numbers.push((at, place));
        }
        numbers
    }

    /// What the cells are: `clock`, or `time` and its unit.
    pub(super) fn heading(&self) -> String {
        match (self.by_time, self.unit) {
            (false, _) => "clock".to_owned(),
            (true, None) => "time".to_owned(),
            (true, Some(unit)) => format!("time, {unit}"),
        }
    }

    /// The first and the last clock or time, with the unit of times: `clock 0 to 9`.
    pub(super) fn extent(&self) -> String {
        let [first, last] = [self.places.first(), self.places.last()].map(|place| place.copied().unwrap_or(0));
        match (self.by_time, self.unit) {
            (false, _) => format!("clock {first} to {last}"),
            (true, None) => format!("time {first} to {last}"),
            (true, Some(unit)) => format!("time {first} to {last}, in units of {unit}"),
        }
    }
}

impl Row {
    /// Ends the row after this number of cells.
    fn truncate(&mut self, cells: usize) {
        let mut left = cells;
        self.stretches.retain_mut(|stretch| {
            stretch.cells = stretch.cells.min(left);
            left -= stretch.cells;
            stretch.cells > 0
        });
    }

    /// What the row shows in a line.
    pub(super) fn pieces(&self, line: Range<usize>) -> impl Iterator<Item = Piece<'_>> {
        let mut start = 0;
        let mut last = None;
        self.stretches.iter().filter_map(move |stretch| {
            let begins = start;
            start += stretch.cells;
            let before = last.replace(stretch).filter(|_| begins >= line.start);
            let [from, to] = [begins.max(line.start), start.min(line.end)];
            (from < to).then(|| Piece { stretch, before, cells: from - line.start..to - line.start })
        })
    }
}

impl Stretch {
    /// The characters of a cell with which its text is whole.
    pub(super) fn least_cell(&self) -> usize {
        (self.text.chars().count() + 1).div_ceil(self.cells)
    }
}

impl Shape {
    fn of(signal: &Signal, value: Value<'_>) -> Shape {
        let bits = match value {
            Value::Unset => return Shape::Unknown,
            Value::Bits(bits) if bits.width() > 0 => bits,
            _ => return Shape::Known,
        };
        let all = |wanted: char| bits.digits().all(|digit| digit == wanted);
        let line = signal.width == 1 && matches!(signal.kind, ValueKind::Unsigned | ValueKind::Signed);
        match () {
            () if line && all('0') => Shape::Low,
            () if line && all('1') => Shape::High,
            () if all('x') => Shape::Unknown,
            () if all('z') => Shape::Floating,
            () if bits.digits().all(|digit| "01".contains(digit)) => Shape::Known,
            () => Shape::Mixed,
        }
    }

    /// Every bit is 0 or 1.
    pub(super) fn is_known(self) -> bool {
        matches!(self, Shape::Low | Shape::High | Shape::Known)
    }
}

/// The clocks or times that may be shown.
pub(super) fn places(drawing: &Drawing, wave: &Wave) -> Result<Vec<u64>, String> {
    let to = drawing.to.unwrap_or(u64::MAX);
    let (what, all): (_, Vec<u64>) = if drawing.by_time {
        ("time", wave.times().to_vec())
    } else {
        ("clock", (0..wave.cycles().map_err(|error| error.to_string())?).map(|cycle| drawing.first + cycle).collect())
    };
    let last = all.last().copied();
    let places: Vec<u64> = all.into_iter().filter(|place| (drawing.from..=to).contains(place)).collect();
    if !places.is_empty() {
        return Ok(places);
    }
    let end = last.map_or_else(|| "is empty".to_owned(), |last| format!("ends at {what} {last}"));
    Err(format!("nothing is left from {what} {} on: the wave {end}", drawing.from))
}

fn stretches(drawing: &Drawing, wave: &Wave, index: usize, places: &[u64]) -> Vec<Stretch> {
    let signal = &wave.signals()[index];
    let at = |place: u64| {
        if drawing.by_time {
            return wave.value_at_time(index, place);
        }
        wave.value_at_cycle(index, place - drawing.first).ok().flatten()
    };
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut before: Option<Value<'_>> = None;
    for &place in places {
        let value = at(place).unwrap_or(Value::Unset);
        match stretches.last_mut() {
            Some(stretch) if before.is_some_and(|before| before.same(value)) => stretch.cells += 1,
            _ => {
                let (text, shape) = (written(drawing, signal, value), Shape::of(signal, value));
                stretches.push(Stretch { cells: 1, text, shape });
            }
        }
        before = Some(value);
    }
    stretches
}

/// A value as it is written into its cells; control characters of a file do not get through.
fn written(drawing: &Drawing, signal: &Signal, value: Value<'_>) -> String {
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
    if let Some(name) = drawing.names.get(signal.leaf()).and_then(|names| names.get(&binary)) {
        return name.clone();
    }
    let hex = |number: u128| format!("{number:0digits$x}", digits = bits.width().div_ceil(4) as usize);
    let number = match drawing.radix {
        // One bit is its own number.
        _ if bits.width() == 1 => None,
        Radix::Binary => None,
        Radix::Declared => bits.decimal(),
        Radix::Hex => bits.to_u128().map(hex),
        Radix::Signed => bits.decimal_as(true),
        Radix::Unsigned => bits.decimal_as(false),
    };
    number.unwrap_or(binary)
}

/// Paths without the scopes that all share.
fn short_names(wave: &Wave, signals: &[usize]) -> Vec<String> {
    let paths: Vec<&str> = signals.iter().map(|&signal| wave.signals()[signal].path.as_str()).collect();
    let shared = |length: usize| paths.iter().all(|path| path.get(..length) == paths[0].get(..length));
    let bounds = paths.first().map(|path| path.match_indices('.').map(|(at, _)| at + 1).collect::<Vec<_>>());
    let common = bounds.unwrap_or_default().into_iter().take_while(|&length| shared(length)).last().unwrap_or(0);
    paths.iter().map(|path| path[common..].escape_debug().to_string()).collect()
}
