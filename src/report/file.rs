//! The files of a run: each looks on while it lasts, and is ended with the report.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::plot::Plot;
use super::program::{Units, move_json};
use super::{OfCurve, Report};
use crate::engine::Wanted;
use crate::testbench::{BlockReport, Observer, ObserverError, Step, Testbench};

/// A file that a run writes, but for its waves.
pub trait RunFile: Observer {
    /// Writes what is known only when the run is over.
    ///
    /// # Errors
    /// The output cannot be written.
    fn finish(&mut self, report: &Report) -> io::Result<()>;
}

/// The report as JSON. That of a program is written move by move, so that its length takes no memory.
pub struct JsonFile<W: Write> {
    out: W,
    units: Units,
    moves: u64,
}

impl<W: Write> JsonFile<W> {
    /// Writes what is known of a program before it runs.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn new(report: &Report, mut out: W) -> io::Result<JsonFile<W>> {
        if report.program().is_some() {
            writeln!(out, "{{")?;
            write_fields(&mut out, &report.json_head())?;
            write!(out, "  \"blocks\": [")?;
        }
        let units = Units::of(report);
        Ok(JsonFile { out, units, moves: 0 })
    }
}

/// The fields of an object, a line each, with a comma after the last.
fn write_fields(out: &mut impl Write, fields: &Value) -> io::Result<()> {
    let mut fields = fields.as_object().into_iter().flatten();
    fields.try_for_each(|(name, value)| writeln!(out, "  {}: {value},", json!(name)))
}

impl<W: Write> RunFile for JsonFile<W> {
    fn finish(&mut self, report: &Report) -> io::Result<()> {
        if report.program().is_some() {
            writeln!(self.out, "\n  ],")?;
            write_fields(&mut self.out, &report.json_results())?;
            writeln!(self.out, "  \"failures\": {}\n}}", json!(report.failures()))?;
        } else {
            writeln!(self.out, "{:#}", report.json())?;
        }
        self.out.flush()
    }
}

impl<W: Write> Observer for JsonFile<W> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn want(&mut self, _: &Testbench, _: &mut Wanted) -> bool {
        true
    }

    fn block_ended(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        let comma = if self.moves == 0 { "" } else { "," };
        self.moves += 1;
        write!(self.out, "{comma}\n    {}", move_json(block, self.units))?;
        Ok(())
    }
}

/// The path of a run along a curve, as SVG.
pub struct PathPicture<W> {
    out: W,
    plot: Plot,
}

impl<W> PathPicture<W> {
    /// Still without points, of hardware whose steps take so long, in clocks, where that is known.
    #[must_use]
    pub fn new(of: &OfCurve, step_clocks: Option<f64>, out: W) -> PathPicture<W> {
        PathPicture { out, plot: Plot::new(&of.curve, step_clocks) }
    }
}

impl<W: Write> RunFile for PathPicture<W> {
    fn finish(&mut self, report: &Report) -> io::Result<()> {
        if let Some(event) = report.overflows.first() {
            self.plot.mark(&format!("overflow of {}", event.component()));
        }
        if let Some(worst) = report.curve().and_then(|of| of.worst.as_ref()) {
            self.plot.between_steps(worst.error);
        }
        self.out.write_all(self.plot.svg(&report.headline()).as_bytes())?;
        self.out.flush()
    }
}

impl<W> Observer for PathPicture<W> {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        self.plot.point(&step.position, step.clock);
        Ok(())
    }
}
