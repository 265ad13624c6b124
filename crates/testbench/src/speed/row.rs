//! The speed as one more row of a wave: not a net of the design, but what the test bench sees of it.

use stepwave_engine::Rows;
use stepwave_netlist::cells::Format;
use stepwave_trace::probe::{Probe, Role};

use super::SpeedTrack;
use crate::tool::signed;
use crate::{StepColumns, Testbench};

/// Parts of v_max that are counted.
const PARTS: f64 = 1e4;
/// Bits of the row.
const BITS: u32 = 16;

/// Adds to the samples of a run along a curve a column with the speed over the last 32 steps, from the sample that completes
/// the last of them: v/v_max in 10^-4, or 10^-4 BLU a clock where v_max is not known. Before the first 32 steps it is 0.
#[derive(Clone, Debug)]
pub struct SpeedRow {
    columns: StepColumns,
    track: SpeedTrack,
    /// Where the pulses led from the place of row 0, in BLU; `None` before that row.
    place: Option<Vec<i64>>,
    /// From BLU a clock.
    unit: f64,
    value: u64,
    /// The values of the samples, and the samples with them.
    values: Vec<u64>,
    rows: Rows,
}

impl SpeedRow {
    /// Scope and name of the row.
    pub const NAME: [&str; 2] = ["testbench", "speed_e4"];

    /// Of a machine.
    #[must_use]
    pub fn new(bench: &Testbench) -> SpeedRow {
        let columns = StepColumns::of(bench);
        SpeedRow {
            track: SpeedTrack::new(columns.pulses.len()),
            columns,
            place: None,
            unit: PARTS * bench.hardware().clocks_of_step().unwrap_or(1.0),
            value: 0,
            values: Vec::new(),
            rows: Rows::new(0, 0),
        }
    }

    /// The row in a wave of this design, whose samples have this many columns.
    #[must_use]
    pub fn probe(design: &str, columns: usize) -> Probe {
        let [scope, name] = SpeedRow::NAME.map(str::to_owned);
        let (scopes, columns) = (vec![design.to_owned(), scope], vec![columns]);
        Probe { scopes, name, width: BITS, format: Format::Level, role: Role::Wire, columns }
    }

    /// The same samples with one more column.
    pub(crate) fn widened(&mut self, rows: &Rows) -> &Rows {
        let columns = rows.columns();
        if self.rows.columns() != columns + 1 || self.rows.room() + (self.rows.len() as u64) < rows.len() as u64 {
            self.rows = Rows::new(columns + 1, rows.len());
        }
        self.values.clear();
        for row in 0..rows.len() {
            let value = self.after(rows, row);
            self.values.push(value);
        }
        self.rows.clear();
        for (row, &speed) in self.values.iter().enumerate() {
            self.rows.push(rows.clock(row), |column| if column < columns { rows.value(column, row) } else { speed });
        }
        &self.rows
    }

    /// The value in a sample.
    fn after(&mut self, rows: &Rows, row: usize) -> u64 {
        let is_row = self.columns.completes(rows, row, self.place.is_none());
        let is_first = self.place.is_none();
        if is_first && !is_row {
            return 0;
        }
        let place = self.place.get_or_insert_with(|| vec![0; self.columns.pulses.len()]);
        if !is_first {
            for (place, &column) in place.iter_mut().zip(&self.columns.pulses) {
                *place += signed(rows.value(column, row));
            }
        }
        let window = if is_row { self.track.row(place, rows.clock(row)) } else { None };
        if let Some(window) = window {
            // What is beyond the row has its greatest value.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let value = (self.unit * window.speed()).round() as u64;
            self.value = value.min((1 << BITS) - 1);
        }
        self.value
    }
}
