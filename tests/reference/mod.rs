//! The interpolators as plain integer recurrences: the judge of the netlists.
//!
//! Nothing here knows of a net, a clock or a register width. Each function writes down what one
//! *step* of the method does to a handful of integers, and records the integers after every step.
//! Lengths are BLU (basic length units). Row 0 of a [`Table`] is the state after the block was
//! loaded, row `k` the state after step `k`.
//!
//! - [`ppc_line`], [`ppc_arc`], [`ppc_conic`]: point-by-point comparison, one axis per step, steered by the sign of
//!   a deviation `f`.
//! - [`dda_line`], [`dda_line_decimal`], [`dda_arc`], [`dda_conic`], [`dda_helix`]: digital
//!   differential analyser, one accumulation per axis per step, the overflow of the accumulator is
//!   the pulse.
//! - [`dpm_line`], [`dpm_line_cascade`], [`dpm_line_decade`], [`dpm_line_override`]: digital pulse multiplier, a counter
//!   whose stages pass pulses as the bits of a coefficient say.
//! - [`cim_line`], [`cim_arc`], [`cim_conic`]: comparison-integral method, one axis steps every time
//!   and the sign of `f` says whether the other does.
//! - [`mindev_line`], [`mindev_arc`], [`vector_line`], [`vector_arc`]: eight-direction methods, a
//!   step is X, Y or both.
//! - [`ppc_space_line`], [`cim_space_line`], [`mindev_space_line`]: the same for lines of 3 axes and more, each axis against
//!   the longest one.
//! - [`sampled_line`], [`sampled_arc`]: data sampling, the points of the coarse stage in real numbers.
//! - [`sampled_nurbs`]: data sampling of a NURBS, the points of the coarse stage in whole numbers.
//! - [`spline_dda`], [`spline_dda_fraction`]: free curves in whole numbers, and by rounded forward differences.
//! - [`ramp`], [`smooth`]: acceleration and deceleration of a pulse source, and after an interpolator.
//! - [`stepgen`], [`stepgen_clocks`], [`bresenham`]: what motion cards and firmware of today do.
//!
//! A call outside a method's domain (a register too narrow, an end point that the arc cannot reach)
//! is a mistake of the test that makes it, and panics.

mod arc_geometry;
mod bresenham;
mod cim;
mod conic_geometry;
mod dda;
mod dda_conic;
mod dda_decimal;
mod dda_helix;
mod dpm;
mod eight_arcs;
mod eight_lines;
mod nurbs;
mod ppc;
mod ppc_conic;
mod ramp;
mod sampled;
mod smooth;
mod space_lines;
mod spline;
mod stepgen;
#[cfg(test)]
mod tests;

pub(crate) use bresenham::bresenham;
pub(crate) use cim::{Weights, cim_arc, cim_conic, cim_line};
pub(crate) use conic_geometry::{Opens, Shape};
pub(crate) use dda::{dda_arc, dda_line};
pub(crate) use dda_conic::dda_conic;
pub(crate) use dda_decimal::dda_line_decimal;
pub(crate) use dda_helix::{dda_helix, helix_words};
pub(crate) use dpm::{dpm_line, dpm_line_cascade, dpm_line_decade, dpm_line_override};
pub(crate) use eight_arcs::{mindev_arc, vector_arc};
pub(crate) use eight_lines::{mindev_line, vector_line};
pub(crate) use nurbs::{Row, Sampled, sampled_nurbs};
pub(crate) use ppc::{ppc_arc, ppc_line};
pub(crate) use ppc_conic::ppc_conic;
#[cfg(test)]
use ramp::speeds_up as ramp_speeds_up;
pub(crate) use ramp::{Braking, InForce, RampBlock, plan as ramp_plan, ramp};
pub(crate) use sampled::{System, sampled_arc, sampled_line, step_factor_points};
pub(crate) use smooth::{Filter, smooth, smoothed};
pub(crate) use space_lines::{cim_space_line, mindev_space_line, ppc_space_line};
pub(crate) use spline::{Basis, Segment, spline_dda, spline_dda_fraction, spline_owes};
pub(crate) use stepgen::{StepOutput, Timing, stepgen, stepgen_clocks};

/// The names of up to nine axes, in the order of the columns.
pub(crate) const AXES: [&str; 9] = ["x", "y", "z", "a", "b", "c", "u", "v", "w"];

/// How a block knows that it is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EndPoint {
    /// One counter `e` of all pulses of all axes.
    Total,
    /// One counter per axis, `ex`, `ey`, …; the block is done when all are 0.
    PerAxis,
    /// One counter `e` of the pulses of the longest axis.
    Longest,
    /// One counter `e` of the iterations; only for the DDA line.
    Iterations,
}

/// Which deviation a point-by-point line keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// F = a·|y| - b·|x| with a = |dx|, b = |dy|: every quadrant is treated as the first.
    Magnitude,
    /// F = dx·y - dy·x, with the signs of the line.
    Signed,
}

/// A step table: row 0 is the state after load, row `k` every register after step `k`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Table {
    /// The names of the columns.
    pub(crate) columns: Vec<String>,
    /// The rows; each holds one value per column.
    pub(crate) rows: Vec<Vec<i64>>,
    /// True when the end counters reached 0; false when the motion hung or overflowed.
    pub(crate) finished: bool,
    /// True when the step after the last row would take an integrand or an accumulator out of its
    /// register.
    pub(crate) overflow: bool,
}

impl Table {
    /// An empty, unfinished table with these columns.
    fn new(columns: Vec<String>) -> Self {
        Table { columns, rows: Vec::new(), finished: false, overflow: false }
    }

    /// Appends the state after one step; the groups of values follow the order of the columns.
    fn push(&mut self, groups: &[&[i64]]) {
        let row = groups.concat();
        assert_eq!(row.len(), self.columns.len(), "one value per column");
        self.rows.push(row);
    }

    /// All values of one column, row 0 first.
    ///
    /// # Panics
    /// When there is no such column.
    pub(crate) fn column(&self, name: &str) -> Vec<i64> {
        let index = self
            .columns
            .iter()
            .position(|column| column == name)
            .unwrap_or_else(|| panic!("no column `{name}` in {:?}", self.columns));
        self.rows.iter().map(|row| row[index]).collect()
    }

    /// The number of steps, that is, of rows after row 0.
    pub(crate) fn steps(&self) -> usize {
        self.rows.len() - 1
    }

    /// The machine position of every row: x and y in BLU.
    pub(crate) fn path(&self) -> Vec<[i64; 2]> {
        let (x, y) = (self.column("x"), self.column("y"));
        x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
    }
}

/// The columns of the end counters: `e`, or one per axis.
fn counter_columns(end: EndPoint, axes: usize) -> Vec<String> {
    match end {
        EndPoint::PerAxis => per_axis_columns("e", axes),
        EndPoint::Total | EndPoint::Longest | EndPoint::Iterations => vec!["e".to_owned()],
    }
}

/// One column per axis: the prefix and the axis letter.
fn per_axis_columns(prefix: &str, axes: usize) -> Vec<String> {
    AXES[..axes].iter().map(|axis| format!("{prefix}{axis}")).collect()
}
