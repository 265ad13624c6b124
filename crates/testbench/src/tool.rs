//! Where the tool is: at the start, and one BLU farther for each pulse.
//!
//! The position counters of a machine say the same as long as none overflows. A counter that wraps or is held shows
//! another place, though the drive was given every pulse.

use stepwave_engine::Rows;
use stepwave_models::Port;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_netlist::OnOverflow;
use stepwave_netlist::bits::to_signed;

use super::{StepColumns, Testbench};

/// The number that a pulse of two bits means: 0, +1 or -1.
#[inline]
pub(super) fn signed(pulse: u64) -> i64 {
    (pulse & 1).cast_signed() - (pulse & 2).cast_signed()
}

/// Follows the tool through samples.
#[derive(Clone, Debug)]
pub(super) struct Tool {
    pulses: Vec<usize>,
    counters: Vec<(usize, Port)>,
    /// An overflow ends the run, so that the counters can be believed, which is faster.
    trusted: bool,
    /// The place after the last sample, in BLU.
    pub(super) place: Vec<i64>,
}

impl Tool {
    pub(super) fn of(bench: &Testbench) -> Tool {
        let (columns, ports) = (StepColumns::of(bench), &bench.machine().positions);
        Tool {
            counters: columns.positions.into_iter().zip(ports.iter().copied()).collect(),
            pulses: columns.pulses,
            trusted: bench.hardware().get(&ON_OVERFLOW) == OnOverflow::Trap,
            place: bench.start.clone(),
        }
    }

    /// The counters of all axes say where the tool is, in every run.
    pub(super) fn is_trusted(&self) -> bool {
        self.trusted
    }

    /// The place that the counters have in a sample of these columns.
    pub(super) fn counted(&self, columns: &[u64]) -> impl Iterator<Item = i64> {
        self.counters.iter().map(|&(column, port)| to_signed(port.width, columns[column]))
    }

    /// Takes what the counters say in a sample of these columns, whatever came before.
    pub(super) fn jump(&mut self, columns: &[u64]) {
        for (place, &(column, port)) in self.place.iter_mut().zip(&self.counters) {
            *place = to_signed(port.width, columns[column]);
        }
    }

    /// Takes a sample, each in its order; true if the place is another than before.
    #[inline]
    pub(super) fn sample(&mut self, rows: &Rows, row: usize) -> bool {
        let mut moved = false;
        if self.trusted {
            for (place, &(column, port)) in self.place.iter_mut().zip(&self.counters) {
                let now = to_signed(port.width, rows.value(column, row));
                moved |= now != *place;
                *place = now;
            }
            return moved;
        }
        for (place, &column) in self.place.iter_mut().zip(&self.pulses) {
            let pulse = signed(rows.value(column, row));
            moved |= pulse != 0;
            *place = place.saturating_add(pulse);
        }
        moved
    }
}
