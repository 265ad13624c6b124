//! Writes the samples of a run into a wave file, within a window of clocks.

use std::io;
use std::ops::Range;

use stepwave_engine::Rows;
use stepwave_netlist::Width;
use stepwave_netlist::bits::to_signed;
use stepwave_trace::WaveBody;

use super::{Observer, ObserverError, SpeedRow};

/// When a window opens.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Trigger {
    /// At its first clock.
    #[default]
    Immediately,
    /// At the first clock, not before the window's first, on which the net in this column is 1.
    Column(usize),
}

/// Clocks that a wave shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Window {
    /// First clock.
    pub from: u64,
    /// Last clock, if there is one.
    pub to: Option<u64>,
    /// What opens it.
    pub trigger: Trigger,
    /// Columns of which one is 1 in a sample that is written; `None` for every sample. The first of all is always
    /// written.
    pub steps: Option<[usize; 2]>,
}

impl Window {
    /// The rows of a block that fall between its first and last clock.
    fn rows(&self, rows: &Rows) -> Range<usize> {
        let end = self.to.map_or(rows.len(), |to| rows.before(to.saturating_add(1)));
        rows.before(self.from).min(end)..end
    }
}

/// What a column of signed numbers took in the samples that were written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Taken {
    /// The column.
    pub column: usize,
    width: Width,
    /// Its value at reset, where that was written.
    pub reset: Option<i64>,
    /// Its value in the first sample after the reset.
    pub first: Option<i64>,
    /// Least and greatest value in the samples after the reset.
    pub range: Option<[i64; 2]>,
}

impl Taken {
    /// Nothing yet.
    #[must_use]
    pub fn nothing(column: usize, width: Width) -> Taken {
        Taken { column, width, reset: None, first: None, range: None }
    }

    fn take(&mut self, rows: &Rows, mut range: Range<usize>) {
        if rows.clock(range.start) == 0 {
            self.reset = Some(to_signed(self.width, rows.value(self.column, range.start)));
            range.start += 1;
        }
        // With the sign bit inverted, two's complement sorts as unsigned numbers do.
        let turned = self.width.sign_bit();
        let Some(seen) = rows.extremes_within(self.column, range, turned) else { return };
        let [first, least, greatest] =
            [seen.first, seen.least, seen.greatest].map(|value| to_signed(self.width, value ^ turned));
        self.first.get_or_insert(first);
        let range = self.range.get_or_insert([least, greatest]);
        *range = [range[0].min(least), range[1].max(greatest)];
    }
}

/// A wave file that is being written.
pub struct WaveWriter<B> {
    body: B,
    window: Window,
    open: bool,
    /// Samples are passed over.
    sparse: bool,
    /// The row before the window, as the sample of its first clock, while nothing is written.
    held: Option<Rows>,
    /// Adds a column with the speed.
    speed: Option<Box<SpeedRow>>,
    /// What the columns took that are looked at.
    pub taken: Vec<Taken>,
    /// First and last clock written.
    pub written: Option<(u64, u64)>,
}

impl<B: WaveBody> WaveWriter<B> {
    /// Writes what falls into the window.
    #[must_use]
    pub fn new(body: B, window: Window) -> WaveWriter<B> {
        let open = window.trigger == Trigger::Immediately;
        WaveWriter { body, window, open, sparse: false, held: None, speed: None, taken: Vec::new(), written: None }
    }

    /// Looks at what these columns take, too.
    #[must_use]
    pub fn looking_at(self, columns: impl IntoIterator<Item = (usize, Width)>) -> WaveWriter<B> {
        let taken = columns.into_iter().map(|(column, width)| Taken::nothing(column, width)).collect();
        WaveWriter { taken, ..self }
    }

    /// With the speed in the column after those of the samples; of a run in which none is passed over.
    #[must_use]
    pub fn with_speed(self, speed: Option<SpeedRow>) -> WaveWriter<B> {
        WaveWriter { speed: speed.map(Box::new), ..self }
    }

    fn write(&mut self, rows: &Rows, range: Range<usize>) -> io::Result<()> {
        let (first, last) = (rows.clock(range.start), rows.clock(range.end - 1));
        self.taken.iter_mut().for_each(|taken| taken.take(rows, range.clone()));
        self.body.rows(rows, range)?;
        self.written = Some((self.written.map_or(first, |(first, _)| first), last));
        Ok(())
    }

    /// Holds the row before the window, and writes it once it is known that its first sample was passed over.
    fn begin(&mut self, rows: &Rows) -> io::Result<()> {
        let first = rows.before(self.window.from);
        if first > 0 {
            let held = self.held.get_or_insert_with(|| Rows::sparse(rows.columns(), 1));
            held.clear();
            held.push(self.window.from, |column| rows.value(column, first - 1));
        }
        if first == rows.len() {
            return Ok(());
        }
        if rows.clock(first) > self.window.from {
            return self.begin_between();
        }
        self.held = None;
        Ok(())
    }

    /// Begins the window with the row that is held, where that opens it.
    fn begin_between(&mut self) -> io::Result<()> {
        let Some(held) = self.held.take() else { return Ok(()) };
        self.open |= matches!(self.window.trigger, Trigger::Column(column) if held.value(column, 0) == 1);
        let shown = self.open && self.window.to.is_none_or(|to| to >= self.window.from);
        if shown { self.write(&held, 0..1) } else { Ok(()) }
    }

    /// The last sample of the run is that of `clock`: those passed over after the last row belong to the wave too.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn end(&mut self, clock: u64) -> io::Result<()> {
        if self.written.is_none() && clock >= self.window.from {
            self.begin_between()?;
        }
        if let (true, None, Some((_, last))) = (self.sparse, self.window.steps, &mut self.written) {
            *last = clock.min(self.window.to.unwrap_or(u64::MAX));
            self.body.rest(*last);
        }
        Ok(())
    }

    /// Ends the wave.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish(self) -> io::Result<B::Output> {
        self.body.finish()
    }
}

impl<B: WaveBody> Observer for WaveWriter<B> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let Some(mut speed) = self.speed.take() else { return self.take(rows) };
        let taken = self.take(speed.widened(rows));
        self.speed = Some(speed);
        taken
    }
}

impl<B: WaveBody> WaveWriter<B> {
    /// Takes samples.
    fn take(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        self.sparse = rows.is_sparse();
        if self.sparse && self.written.is_none() {
            self.begin(rows)?;
        }
        let mut range = self.window.rows(rows);
        if let (Trigger::Column(column), false) = (self.window.trigger, self.open) {
            match rows.column(column)[range.clone()].iter().position(|&value| value == 1) {
                Some(index) => range.start += index,
                None => return Ok(()),
            }
        }
        if range.is_empty() {
            return Ok(());
        }
        self.open = true;
        let Some(columns) = self.window.steps else {
            return self.write(rows, range).map_err(Into::into);
        };
        let begun = self.written.is_none().then_some(range.start);
        let wanted = |row: usize| Some(row) == begun || columns.iter().any(|&column| rows.value(column, row) == 1);
        let mut row = range.start;
        while let Some(start) = (row..range.end).find(|&row| wanted(row)) {
            let end = (start..range.end).find(|&row| !wanted(row)).unwrap_or(range.end);
            self.write(rows, start..end)?;
            row = end;
        }
        Ok(())
    }
}
