//! When native code is made for lanes, and how it is called: not before as many samples have run without it as take as long
//! as making it.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use super::avx::{self, Compiled};
use super::code::Code;
use super::lane::{GROUP, Lane, LaneRow};
#[cfg(all(feature = "jit", target_arch = "x86_64"))]
use crate::compiled::LaneLoop;

/// Samples of lanes run by the interpreter before code is made.
pub(super) const WARM_UP: u64 = 20_000;

/// The native code of a program, shared by its workers.
#[derive(Clone, Debug)]
pub(super) struct Native {
    after: u64,
    /// Samples of lanes that have run without it.
    done: Arc<AtomicU64>,
    /// The code, or none where there can be none.
    code: Arc<OnceLock<Option<Loop>>>,
}

impl Native {
    pub(super) fn after(samples: u64) -> Native {
        Native { after: samples, done: Arc::default(), code: Arc::default() }
    }

    /// The code, if it is worth having.
    pub(super) fn code<T: Lane>(&self, of: &Code) -> Option<&Loop> {
        if self.left() > 0 {
            return None;
        }
        self.code.get_or_init(|| Loop::compile(of, T::BITS)).as_ref()
    }

    /// Samples of lanes until code is worth having.
    fn left(&self) -> u64 {
        self.after.saturating_sub(self.done.load(Ordering::Relaxed))
    }

    /// Samples that this many lanes may run before the next question for code.
    pub(super) fn most(&self, lanes: usize) -> u64 {
        match self.left() {
            0 => u64::MAX,
            left => left.div_ceil(words(lanes)),
        }
    }

    /// Lanes have run this many samples without native code.
    pub(super) fn interpreted(&self, lanes: usize, samples: u64) {
        if self.left() > 0 {
            self.done.fetch_add(words(lanes).saturating_mul(samples), Ordering::Relaxed);
        }
    }

    pub(super) fn is_compiled(&self) -> bool {
        self.code.get().is_some_and(Option::is_some)
    }
}

/// The interpreter runs whole groups.
fn words(lanes: usize) -> u64 {
    lanes.next_multiple_of(GROUP) as u64
}

/// Code for vectors of lanes.
#[derive(Debug)]
pub(super) struct Loop {
    code: LaneLoop,
    plan: Compiled,
    lanes: usize,
}

impl Loop {
    fn compile(program: &Code, bits: u32) -> Option<Loop> {
        let plan = avx::compile(program, bits)?;
        let code = LaneLoop::of(&plan)?;
        Some(Loop { code, plan, lanes: avx::lanes(bits) })
    }

    /// Lanes of a vector.
    pub(super) fn lanes(&self) -> usize {
        self.lanes
    }
}

/// The cells in which native code works.
pub(super) struct Frame<T> {
    words: Vec<T>,
    /// The first word of the first cell: no cell crosses a cache line.
    start: usize,
}

impl<T: Lane> Frame<T> {
    pub(super) fn new(code: &Loop) -> Frame<T> {
        let lanes = code.lanes;
        let words = vec![T::default(); (code.plan.cells() + 1) * lanes];
        let start = words.as_ptr().align_offset(avx::BYTES).min(lanes);
        let mut frame = Frame { words, start };
        for &(cell, word) in &code.plan.constants {
            for (lane, part) in frame.cell(cell, lanes).iter_mut().enumerate() {
                // Where lanes are narrower than the constant it takes two of them.
                *part = T::number(word >> (if lane % 2 == 1 { 64 - T::BITS } else { 0 }));
            }
        }
        frame
    }

    fn cell(&mut self, cell: usize, lanes: usize) -> &mut [T] {
        &mut self.words[self.start + cell * lanes..][..lanes]
    }

    /// Runs the vector of this index in the rows, whose first `used` lanes may stop it: up to `samples` samples, each with
    /// its edge, but none in which a lane stops. Gives their number.
    pub(super) fn run(
        &mut self,
        code: &Loop,
        rows: &mut [Box<LaneRow<T>>],
        vector: usize,
        used: usize,
        samples: u64,
    ) -> u64 {
        if samples == 0 {
            return 0;
        }
        let (lanes, place) = (code.lanes, vector * code.lanes);
        for &row in &code.plan.enter {
            self.cell(row, lanes).copy_from_slice(&rows[row].0.as_flattened()[place..][..lanes]);
        }
        for (lane, mask) in self.cell(code.plan.mask, lanes).iter_mut().enumerate() {
            *mask = T::mask(lane < used);
        }
        let start = self.start;
        let done = code.code.call(&mut self.words[start..], samples);
        for &row in &code.plan.leave {
            rows[row].0.as_flattened_mut()[place..][..lanes].copy_from_slice(self.cell(row, lanes));
        }
        done
    }
}

/// This processor has no native code.
#[cfg(not(all(feature = "jit", target_arch = "x86_64")))]
#[derive(Debug)]
enum LaneLoop {}

#[cfg(not(all(feature = "jit", target_arch = "x86_64")))]
impl LaneLoop {
    fn of(_plan: &Compiled) -> Option<LaneLoop> {
        None
    }

    fn call<T: Lane>(&self, _frame: &mut [T], _samples: u64) -> u64 {
        match *self {}
    }
}
