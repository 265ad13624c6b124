//! Lines on which a step is a pulse of one of two axes: how far each axis is off a uniform rate is the cross product of line
//! and position, x·(X + Y) - X·(x + y) = x·Y - X·y, whose extremes a digest has.

use fearless_simd::{Level, dispatch};
use stepwave_engine::{Digest, Wanted};
use stepwave_models::Pace;
use stepwave_nc::{BatchGauge, Curve};

use crate::ahead::StepTrains;
use crate::tool::Tool;
use crate::{Testbench, path};

/// One sample in four.
const FIRST: u64 = 0x1111_1111_1111_1111;

/// What is known of such a line.
pub(super) struct Totals {
    batch: BatchGauge,
    /// Where it is at the start.
    tool: Tool,
    /// Where a digest has them; no form, no use.
    form: Option<usize>,
    digested: StepTrains,
}

impl Totals {
    /// `None` of another curve or method, or where the counters may not say where the tool is.
    pub(super) fn of(bench: &Testbench, curve: &Curve) -> Option<Totals> {
        if bench.hardware().pace != Pace::Total || !matches!(curve, Curve::Line(_)) {
            return None;
        }
        let batch = path::batch(bench, &curve.gauge())?;
        Some(Totals { batch, tool: Tool::of(bench), form: None, digested: StepTrains::default() })
    }

    pub(super) fn want(&mut self, bench: &Testbench, wanted: &mut Wanted, digested: &StepTrains) {
        self.form = path::form(bench, &self.batch).map(|form| wanted.form(form));
        self.digested = digested.clone();
    }

    /// In no sample of the digest is an axis farther off its rate than `greatest`, as a cross product. Before it there were
    /// `begun` steps and pulses of each axis; `last` has the columns of its last sample.
    pub(super) fn are_no_farther(&self, digest: &Digest, last: &[u64], begun: [u64; 3], greatest: u128) -> bool {
        let Some([least, most]) = self.form.map(|form| digest.forms[form]) else { return false };
        let within = least <= most && self.batch.crossed([least, most]).is_some_and(|crossed| crossed <= greatest);
        within && self.are_alone(digest, last, begun)
    }

    /// Each step is one pulse, that of one axis, which moves it farther from the start.
    fn are_alone(&self, digest: &Digest, last: &[u64], [steps, x, y]: [u64; 3]) -> bool {
        let train = |index: usize| &digest.trains[index][..];
        let [xs, ys] = [0, 1].map(|axis| train(self.digested.pulses[axis]));
        let stepped = train(self.digested.stepped);
        let firsts = [xs, ys, stepped].map(|train| train.first().copied());
        let ([Some(x_first), Some(y_first), Some(step)], 64) = (firsts, digest.span) else { return false };
        let first = x_first | y_first;
        // A pulse in every sample, or in one of four: its step is complete no earlier, at the beginning perhaps that of the
        // pulse before.
        let phase = |bits: u64| [0, 1, 2, 3].into_iter().find(|&phase| bits == FIRST << phase);
        let open = match phase(first).zip(phase(step)) {
            Some((pulse, step)) => u64::from(step < pulse),
            None if [first, step] == [u64::MAX; 2] => 0,
            None => return false,
        };
        if steps + open != x + y {
            return false;
        }
        let odd = dispatch!(Level::new(), _simd => {
            let mut odd = 0;
            for ((x, y), stepped) in xs.iter().zip(ys).zip(stepped) {
                odd |= (x & y) | ((x | y) ^ first) | (stepped ^ step);
            }
            odd
        });
        let reached = self.tool.counted(last).zip(&self.tool.place).map(|(now, start)| now.abs_diff(*start));
        let pulses = [(x, xs), (y, ys)].map(|(before, train)| before + crate::ahead::count(train));
        odd == 0 && reached.eq(pulses)
    }
}
