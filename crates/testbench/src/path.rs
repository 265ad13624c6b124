//! Path error: the distance of each position from the ideal curve.

use fearless_simd::{Level, dispatch};
use serde_json::json;
use stepwave_engine::{Digest, Form, Rows, Term, Wanted};
use stepwave_models::Port;
use stepwave_nc::{BatchGauge, Curve, Gauge};
use stepwave_netlist::bits::to_signed;

use super::checkpoint::{GREATEST, Memory, recalled};
use super::tool::Tool;
use super::{Observer, ObserverError, StepColumns, Testbench, ahead};

/// The greatest path error of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstError {
    /// Distance from the ideal curve in BLU.
    pub error: f64,
    /// Step after which it was seen.
    pub step: u64,
    /// Position there, in BLU.
    pub position: Vec<i64>,
}

/// Finds the greatest path error after all steps, and after all pulses where a step has many.
pub struct PathWatch<'a> {
    gauge: Gauge<'a>,
    columns: StepColumns,
    ports: Vec<Port>,
    /// Rows of the step table so far.
    rows: u64,
    /// The tool after the last sample.
    tool: Tool,
    /// It moved since the last place that was judged.
    moved: bool,
    /// A step has many pulses, and each is judged.
    every_pulse: bool,
    /// Sorts out blocks of samples in which no greater error is.
    batch: Option<BatchGauge>,
    level: Level,
    /// Indices in a digest: the number that the deviation follows from, and the completed steps.
    form: usize,
    stepped: usize,
    /// The first greatest so far.
    pub worst: Option<WorstError>,
}

impl<'a> PathWatch<'a> {
    /// Of a machine against this curve.
    #[must_use]
    pub fn new(bench: &Testbench, curve: &'a Curve) -> PathWatch<'a> {
        let ports = bench.machine().positions.clone();
        let tool = Tool::of(bench);
        let gauge = curve.gauge();
        let batch = batch(bench, &gauge);
        let (columns, level) = (StepColumns::of(bench), Level::new());
        let every_pulse = bench.hardware().sampling.is_some();
        let (rows, moved, form, stepped, worst) = (0, false, 0, 0, None);
        PathWatch { gauge, every_pulse, columns, ports, rows, tool, moved, batch, level, form, stepped, worst }
    }

    /// No sample of the block lies farther off than the worst so far.
    fn is_no_worse(&self, rows: &Rows) -> bool {
        let (Some(batch), Some(worst), [x, y]) = (self.batch, &self.worst, &self.columns.positions[..]) else {
            return false;
        };
        let (xs, ys) = (rows.column(*x), rows.column(*y));
        let [wx, wy] = [self.ports[0].width, self.ports[1].width];
        let positions = xs.iter().zip(ys).map(|(x, y)| [to_signed(wx, *x), to_signed(wy, *y)]);
        let greatest = dispatch!(self.level, _simd => batch.greatest(positions));
        greatest <= worst.error
    }
}

/// What sorts out many positions of a machine; `None` where its counters may not say where the tool is.
pub(super) fn batch(bench: &Testbench, gauge: &Gauge<'_>) -> Option<BatchGauge> {
    let ports = &bench.machine().positions;
    let widest = ports.iter().map(|port| port.width.get()).max().unwrap_or(64);
    gauge.batch(1 << (widest - 1)).filter(|_| ports.len() == 2 && Tool::of(bench).is_trusted())
}

/// The number that the deviation of a position follows from.
pub(super) fn form(bench: &Testbench, batch: &BatchGauge) -> Option<Form> {
    let terms = bench.machine().positions.iter().zip(batch.factors());
    let terms = terms.map(|(port, [linear, square])| Term { net: port.net, linear, square }).collect();
    Form::new(bench.design().netlist(), terms)
}

/// What a watch writes down: rows, position, and step and position of the worst error.
type Gathered = (u64, Vec<i64>, Option<(u64, Vec<i64>)>);

impl Observer for PathWatch<'_> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn remember(&self, memory: &mut Memory) {
        let worst = self.worst.as_ref().map(|worst| (worst.step, &worst.position));
        memory.insert("path".to_owned(), json!([self.rows, self.tool.place, worst]));
    }

    fn recall(&mut self, memory: &Memory) {
        let gathered: Option<Gathered> = recalled(memory, "path");
        let axes = self.tool.place.len();
        let fits = |(rows, position, worst): &Gathered| {
            *rows <= GREATEST && position.len() == axes && worst.as_ref().is_none_or(|(_, at)| at.len() == axes)
        };
        if let Some((rows, position, worst)) = gathered.filter(fits) {
            let known = |(step, position): (u64, Vec<i64>)| WorstError {
                error: self.gauge.deviation(&position),
                step,
                position,
            };
            (self.rows, self.tool.place, self.worst) = (rows, position, worst.map(known));
        }
    }

    fn want(&mut self, bench: &Testbench, wanted: &mut Wanted) -> bool {
        let Some(form) = self.batch.and_then(|batch| form(bench, &batch)) else { return false };
        self.form = wanted.form(form);
        self.stepped = wanted.train(bench.machine().stepped.net);
        true
    }

    fn suffices(&self, digest: &Digest) -> bool {
        let [least, greatest] = digest.forms[self.form];
        let within = |worst: &WorstError| {
            least > greatest || self.batch.is_some_and(|batch| batch.within([least, greatest]) <= worst.error)
        };
        self.rows > 0 && self.worst.as_ref().is_some_and(within)
    }

    fn digest(&mut self, digest: &Digest, last: &[u64]) {
        self.rows += ahead::count(&digest.trains[self.stepped]);
        self.tool.jump(last);
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        if self.is_no_worse(rows) {
            self.rows += self.columns.count(rows);
            let counts = |&row: &usize| self.every_pulse || self.columns.completes(rows, row, false);
            if let Some(last) = (0..rows.len()).rev().find(counts) {
                self.tool.sample(rows, last);
            }
            return Ok(());
        }
        for row in 0..rows.len() {
            let first = self.rows == 0;
            let complete = self.columns.completes(rows, row, first);
            if !self.tool.is_trusted() {
                self.moved |= self.tool.sample(rows, row);
            }
            if !complete && (first || !self.every_pulse) {
                continue;
            }
            self.rows += u64::from(complete);
            if self.tool.is_trusted() {
                self.moved = self.tool.sample(rows, row);
            }
            if !std::mem::take(&mut self.moved) && !first {
                continue;
            }
            let error = self.gauge.deviation(&self.tool.place);
            if self.worst.as_ref().is_none_or(|worst| error > worst.error) {
                self.worst = Some(WorstError {
                    error,
                    step: self.rows - u64::from(complete),
                    position: self.tool.place.clone(),
                });
            }
        }
        Ok(())
    }
}
