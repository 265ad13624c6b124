//! Coarse points of data sampling: how far they lie off the ideal curve, fractions and all.

use serde_json::json;
use stepwave_engine::Rows;
use stepwave_models::Port;
use stepwave_nc::Curve;

use super::checkpoint::{GREATEST, Memory, recalled};
use super::{Observer, ObserverError, StepColumns, Testbench};

/// The greatest distance of a coarse point from the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoarseError {
    /// Distance in BLU.
    pub error: f64,
    /// Period at whose end it was seen.
    pub period: u64,
}

/// Finds the greatest distance of the coarse points at the ends of all periods, in the registers `cx` and `cy`.
pub struct CoarseWatch<'a> {
    curve: &'a Curve,
    steps: StepColumns,
    points: [(usize, Port); 2],
    /// One BLU in the registers.
    unit: i128,
    /// Rows of the step table so far.
    rows: u64,
    /// The coarse point at the end of the worst period.
    at: [i64; 2],
    /// The first greatest so far.
    pub worst: Option<CoarseError>,
}

impl<'a> CoarseWatch<'a> {
    /// Of a machine against this curve; `None` where it has no coarse stage.
    #[must_use]
    pub fn new(bench: &Testbench, curve: &'a Curve) -> Option<CoarseWatch<'a>> {
        let sampling = bench.hardware().sampling?;
        let port = |name: &str| bench.machine().table.iter().find(|(known, _)| *known == name).map(|(_, port)| *port);
        let points = [port("cx")?, port("cy")?].map(|port| (bench.columns().index(port.net), port));
        let (steps, unit) = (StepColumns::of(bench), 1 << sampling.fraction);
        Some(CoarseWatch { curve, steps, points, unit, rows: 0, at: [0, 0], worst: None })
    }

    /// The distance of a coarse point, relative to the start of a line or the centre of an arc, whose numerators are exact;
    /// of a NURBS it is the place itself.
    fn distance(&self, at: [i64; 2]) -> f64 {
        let [x, y] = at.map(i128::from);
        let unit = self.unit as f64;
        match self.curve {
            Curve::Line(line) => match line.delta()[..] {
                [dx, dy, ..] => (i128::from(dx) * y - i128::from(dy) * x).abs() as f64 / line.length() / unit,
                _ => f64::NAN,
            },
            Curve::Arc(arc) => {
                let (reached, wanted) = (x * x + y * y, arc.radius_squared() * self.unit * self.unit);
                (reached - wanted).abs() as f64 / ((reached as f64).sqrt() + (wanted as f64).sqrt()) / unit
            }
            Curve::Nurbs(nurbs) => nurbs.distance(at.map(|c| c as f64 / unit)),
            _ => f64::NAN,
        }
    }

    fn judge(&mut self, at: [i64; 2], period: u64) {
        let error = self.distance(at);
        if self.worst.is_none_or(|worst| error > worst.error) {
            (self.worst, self.at) = (Some(CoarseError { error, period }), at);
        }
    }
}

/// What a watch writes down: rows, and period and coarse point of the worst error.
type Gathered = (u64, Option<(u64, [i64; 2])>);

impl Observer for CoarseWatch<'_> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn remember(&self, memory: &mut Memory) {
        let worst = self.worst.map(|worst| (worst.period, self.at));
        memory.insert("coarse".to_owned(), json!([self.rows, worst]));
    }

    fn recall(&mut self, memory: &Memory) {
        let gathered: Option<Gathered> = recalled(memory, "coarse");
        if let Some((rows, worst)) = gathered.filter(|(rows, _)| *rows <= GREATEST) {
            self.rows = rows;
            if let Some((period, at)) = worst {
                self.judge(at, period);
            }
        }
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for row in 0..rows.len() {
            if self.steps.completes(rows, row, self.rows == 0) {
                self.rows += 1;
                let at = self.points.map(|(column, port)| {
                    i64::try_from(port.reading.number(port.width, rows.value(column, row))).unwrap_or(0)
                });
                self.judge(at, self.rows - 1);
            }
        }
        Ok(())
    }
}
