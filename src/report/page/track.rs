//! Pulses and rows of the step table as streams of small numbers.

use stepwave_models::Port;
use stepwave_netlist::Rows;
use stepwave_trace::numbers::{push, push_signed};

use crate::testbench::{Step, Testbench};

/// Where the tool goes: a clock for each sample with a pulse, and the pulse of each axis.
#[derive(Debug, Default)]
pub(super) struct Track {
    axes: Vec<(usize, Port)>,
    /// Before the first pulse that is kept.
    pub(super) start: Vec<i64>,
    /// First and last clock of which pulses are kept.
    window: (u64, u64),
    last: u64,
    pub(super) count: u64,
    pub(super) clocks: Vec<u8>,
    pub(super) pulses: Vec<Vec<u8>>,
}

impl Track {
    /// Of the pulses of a machine between two clocks.
    pub(super) fn new(bench: &Testbench, window: (u64, u64)) -> Track {
        let ports = &bench.machine().pulses;
        let axes = ports.iter().map(|port| (bench.columns().index(port.net), *port)).collect();
        let (start, pulses) = (bench.start().to_vec(), vec![Vec::new(); ports.len()]);
        Track { axes, start, window, last: 0, count: 0, clocks: Vec::new(), pulses }
    }

    pub(super) fn bytes(&self) -> usize {
        self.clocks.len() + self.pulses.iter().map(Vec::len).sum::<usize>()
    }

    pub(super) fn samples(&mut self, rows: &Rows) {
        for first in (0..rows.len()).step_by(64) {
            let mut pulsing = self.axes.iter().fold(0, |seen, &(column, _)| seen | rows.nonzero(column, first));
            while pulsing != 0 {
                self.pulse(rows, first + pulsing.trailing_zeros() as usize);
                pulsing &= pulsing - 1;
            }
        }
    }

    fn pulse(&mut self, rows: &Rows, row: usize) {
        let clock = rows.clock(row);
        if clock > self.window.1 {
            return;
        }
        let is_kept = clock >= self.window.0;
        if is_kept {
            push(clock - self.last, &mut self.clocks);
            (self.last, self.count) = (clock, self.count + 1);
        }
        for ((&(column, port), place), pulses) in self.axes.iter().zip(&mut self.start).zip(&mut self.pulses) {
            // A pulse is -1, 0 or +1.
            let pulse = i64::try_from(port.reading.number(port.width, rows.value(column, row))).unwrap_or(0);
            if is_kept {
                push_signed(pulse, pulses);
            } else {
                *place = place.saturating_add(pulse);
            }
        }
    }
}

/// The rows of the step table: the clock of each, its number, its block and its pulses. Its registers are in the wave.
#[derive(Debug, Default)]
pub(super) struct StepRows {
    last: (u64, u64, u64),
    pub(super) count: u64,
    pub(super) clocks: Vec<u8>,
    pub(super) numbers: Vec<u8>,
    pub(super) blocks: Vec<u8>,
    /// Of each axis.
    pub(super) pulses: Vec<Vec<u8>>,
}

impl StepRows {
    pub(super) fn bytes(&self) -> usize {
        let pulses: usize = self.pulses.iter().map(Vec::len).sum();
        self.clocks.len() + self.numbers.len() + self.blocks.len() + pulses
    }

    /// Takes a row of a block, counted from 0.
    pub(super) fn push(&mut self, step: &Step, block: u64) {
        let (clock, number, before) = self.last;
        let difference = |now: u64, before: u64| now.wrapping_sub(before).cast_signed();
        push(step.clock - clock, &mut self.clocks);
        push_signed(difference(step.number, number), &mut self.numbers);
        push_signed(difference(block, before), &mut self.blocks);
        self.pulses.resize_with(step.pulses.len(), Vec::new);
        step.pulses.iter().zip(&mut self.pulses).for_each(|(&pulses, stream)| push_signed(pulses, stream));
        self.last = (step.clock, step.number, block);
        self.count += 1;
    }
}
