//! Sentences of the documentation that several models share.

use stepwave_netlist::Width;

use crate::options::{END_POINT, EndPoint, PerRegister, SYSTEM, System, Taken, WIDTH};

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
