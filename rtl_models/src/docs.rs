//! Sentences of the documentation that several models share.

use stepwave_netlist::Width;

use crate::model::RegisterDoc;
use crate::options::{END_POINT, EndPoint, PerRegister, SYSTEM, System, Taken, WIDTH};

impl RegisterDoc {
    pub(crate) const XI_YI: RegisterDoc =
        RegisterDoc { name: "xi, yi", width: "n", about: "|x|, |y| relative to the centre" };
    pub(crate) const QUAD: RegisterDoc =
        RegisterDoc { name: "quad", width: "2", about: "quadrant of the step, Q1 = 0 … Q4 = 3" };
    pub(crate) const EX_EY: RegisterDoc =
        RegisterDoc { name: "ex, ey", width: "n", about: "end-point down-counter of each axis (per-axis)" };
    pub(crate) const EX_EY_NEEDED: RegisterDoc =
        RegisterDoc { name: "ex, ey", width: "as they need", about: "end-point down-counter of each axis" };
    pub(crate) const BASE: RegisterDoc = RegisterDoc { name: "base", width: "1", about: "base axis, X = 0, Y = 1" };
    pub(crate) const SAMPLED_POINT: RegisterDoc =
        RegisterDoc { name: "cx, cy", width: "n+2+q", about: "coarse point of the period, in 2^-q BLU, signed" };
    pub(crate) const SAMPLED_JV: RegisterDoc =
        RegisterDoc { name: "jvx, jvy", width: "as f needs", about: "whole pulses of the period, double buffered" };
    pub(crate) const SAMPLED_JR: RegisterDoc =
        RegisterDoc { name: "jrx, jry", width: "as jv", about: "remainder of the fine stage, from the preset" };
    pub(crate) const POSITIONS: RegisterDoc =
        RegisterDoc { name: "x, y", width: "as the path needs, + 1", about: "machine position, signed" };
    pub(crate) const AXIS_POSITIONS: RegisterDoc =
        RegisterDoc { name: "x, y, …", width: "as the path needs, + 1", about: "machine position, signed" };
}

const ARC_LONGEST: &str =
    "the longest axis of an arc may arrive while the other still has steps to go, and iterations are not counted";

/// End points of an arc whose every step is judged.
pub(crate) static ARC_END_POINT: Taken<EndPoint> = END_POINT.only(
    None,
    &[(EndPoint::Total, " (default where the end point is on the curve)"), (EndPoint::PerAxis, " (default elsewhere)")],
    ARC_LONGEST,
);
/// End points of a curve that a pair of integrators draws.
pub(crate) static INTEGRATED_END_POINT: Taken<EndPoint> = END_POINT.only(
    Some(EndPoint::PerAxis),
    &[(EndPoint::PerAxis, ""), (EndPoint::Total, "")],
    "the longest axis of an arc may arrive while the other still has steps to go, and iterations say nothing of \
     where an arc stands",
);
/// Widths of a fine stage.
pub(crate) static SAMPLED_WIDTH: Taken<PerRegister<Width>> =
    WIDTH.about("N of jv and jr, or REGISTER=N,… (default: the least for a period)");
/// Systems of data sampling.
pub(crate) static SAMPLED_SYSTEM: Taken<System> = SYSTEM.only(
    Some(System::Direction),
    &[(System::Direction, ", by the direction, T = 8 ms"), (System::StepFactor, ", by the step factor, T = 10.24 ms")],
    "",
);
