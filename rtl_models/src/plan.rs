//! What the plans of several models need: the size of a geometry, and the values that a choice may have.

use stepwave_kernel::Width;
use stepwave_kernel::bits::Reading;
use stepwave_nc::{Arc, Conic, ConicSector, Crossing, Curve, Helix, Line, Sector, Weight};

use crate::choices::{Choice, Choices, EndPoint, Named, Radix};
use crate::error::ModelError;
use crate::hardware::{Hardware, Pace};
use crate::registers::Registers;

/// The line of a curve; `Model::plan` has checked that it is one.
pub(crate) fn line(curve: &Curve) -> Option<&Line> {
    match curve {
        Curve::Line(line) => Some(line),
        _ => None,
    }
}

/// The arc of a curve; `Model::plan` has checked that it is one.
pub(crate) fn arc(curve: &Curve) -> Option<&Arc> {
    match curve {
        Curve::Arc(arc) => Some(arc),
        _ => None,
    }
}

/// The conic of a curve; `Model::plan` has checked that it is one.
pub(crate) fn conic(curve: &Curve) -> Option<&Conic> {
    match curve {
        Curve::Conic(conic) => Some(conic),
        _ => None,
    }
}

/// The helix of a curve; `Model::plan` has checked that it is one.
pub(crate) fn helix(curve: &Curve) -> Option<&Helix> {
    match curve {
        Curve::Helix(helix) => Some(helix),
        _ => None,
    }
}

/// Bits of a magnitude register: as chosen, or the least that hold `largest`.
pub(crate) fn magnitude_bits(choices: &Choices, largest: u64) -> u32 {
    let reading = match choices.radix.unwrap_or_default() {
        Radix::Binary => Reading::Unsigned,
        Radix::Decimal => Reading::Decimal,
    };
    choices.width.map_or_else(|| reading.needed(i128::from(largest)), Width::get)
}

/// Bits that a weight needs.
pub(crate) fn needed(weight: i128) -> u32 {
    Width::needed_unsigned(weight.unsigned_abs())
}

/// What the registers of a conic must hold.
pub(crate) struct ConicSize {
    /// Greatest value of the function given, at the ends of all sectors and on both axes.
    pub(crate) greatest: i128,
    /// Bits of the slopes of the weights of x and y.
    pub(crate) slopes: [u32; 2],
    /// Bits of the steps of one axis in a sector.
    pub(crate) steps: u32,
    /// Positions of each axis.
    pub(crate) positions: [Vec<i64>; 2],
}

impl ConicSize {
    /// Of a curve; `value` tells what a register holds at a magnitude on an axis of this weight.
    pub(crate) fn of(curve: &Curve, value: impl Fn(Weight, i64) -> i128) -> ConicSize {
        let sectors = conic(curve).map(Conic::sectors).unwrap_or_default();
        let weights = conic(curve).map_or([Weight { slope: 0, constant: 0 }; 2], Conic::weights);
        let center = conic(curve).map_or([0, 0], Conic::center);
        let ends = || sectors.iter().flat_map(|sector| [sector.start, sector.end]);
        let values = ends().flat_map(|end| [0, 1].map(|axis| value(weights[axis], end[axis].abs())));
        let steps = sectors.iter().flat_map(ConicSector::steps).max().unwrap_or(0);
        ConicSize {
            greatest: values.max().unwrap_or(0),
            slopes: weights.map(|weight| needed(weight.slope)),
            steps: needed(steps.into()),
            positions: [0, 1].map(|axis| ends().map(|end| center[axis] + end[axis]).collect()),
        }
    }
}

/// Largest coordinate relative to the centre on the sectors of an arc.
pub(crate) fn largest_coordinate(sectors: &[Sector]) -> u64 {
    sectors
        .iter()
        .flat_map(|sector| sector.start.into_iter().chain(sector.end))
        .map(i64::unsigned_abs)
        .max()
        .unwrap_or(0)
}

/// Way of the longest axis of a line; 0 if the curve is none.
pub(crate) fn longest(curve: &Curve) -> u64 {
    let delta = line(curve).map(Line::delta).unwrap_or_default();
    delta.iter().map(|d| d.unsigned_abs()).max().unwrap_or(0)
}

/// Positions of each axis at the ends of a curve.
pub(crate) fn end_positions(curve: &Curve) -> impl Iterator<Item = Vec<i64>> {
    curve.from().iter().zip(curve.to()).map(|(&from, &to)| vec![from, to])
}

/// Positions of x and y at the ends of all sectors of an arc, in machine coordinates.
pub(crate) fn arc_positions(curve: &Curve, sectors: &[Sector]) -> [Vec<i64>; 2] {
    let center = arc(curve).map_or([0, 0], Arc::center);
    let ends = || sectors.iter().flat_map(|sector| [sector.start, sector.end]);
    [0, 1].map(|axis| ends().map(|end| center[axis] + end[axis]).collect())
}

/// The n of a deviation register, where magnitudes have `n` bits. Forced steps lead to an end off the circle, where F is up
/// to twice the radius, which may need a bit more than the coordinates between both ends.
pub(crate) fn off_circle_bits(curve: &Curve, choices: &Choices, n: u32) -> u32 {
    arc(curve).map_or(n, |arc| n.max(magnitude_bits(choices, off_circle_radius(arc))))
}

/// The radius of an arc whose end lies off the circle, in whole BLU, rounded up; 0 of others.
pub(crate) fn off_circle_radius(arc: &Arc) -> u64 {
    // Within 2^53.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    if arc.ends_on_circle() { 0 } else { arc.radius().ceil() as u64 }
}

/// Hardware that judges every step of an arc by its deviation: registers `f` of so many more bits than the largest
/// coordinate (where the end point is on the circle, and where it lies beside it), `xi`, `yi`, `quad`, and `e` or `ex`, `ey`.
pub(crate) fn judged_arc(
    model: &'static str,
    curve: &Curve,
    choices: &Choices,
    crossing: Crossing,
    deviation: [u32; 2],
) -> Result<Hardware, ModelError> {
    let on_circle = arc(curve).is_some_and(Arc::ends_on_circle);
    let end_point = end_point(
        model,
        choices,
        if on_circle { EndPoint::Total } else { EndPoint::PerAxis },
        &[EndPoint::Total, EndPoint::PerAxis],
        "the longest axis of an arc may arrive while the other still has steps to go, and iterations are not counted",
    )?;
    let sectors = arc(curve).map(|arc| arc.sectors(crossing)).unwrap_or_default();
    let n = magnitude_bits(choices, largest_coordinate(&sectors));
    let mut registers = Registers::new(model, choices);
    registers
        .register("f", off_circle_bits(curve, choices, n) + deviation[usize::from(!on_circle)])
        .register("xi", n)
        .register("yi", n)
        .shown("quad");
    match end_point {
        EndPoint::PerAxis => registers.end_counters(2, n),
        _ => registers.register("e", n + 3),
    };
    registers.positions(arc_positions(curve, &sectors));
    registers.hardware(2, end_point)
}

/// Hardware that decides at every step of a line whether it takes the long axis alone: registers `f` of `deviation`
/// more bits than the long axis needs, `e`, and those of `held`.
pub(crate) fn judged_line(
    model: &'static str,
    curve: &Curve,
    choices: &Choices,
    held: [&str; 2],
    deviation: u32,
) -> Result<Hardware, ModelError> {
    let n = magnitude_bits(choices, longest(curve));
    let mut registers = Registers::new(model, choices);
    for name in held {
        registers.register(name, n);
    }
    registers.register("f", n + deviation).register("e", n);
    registers.positions(end_positions(curve));
    Ok(Hardware { pace: Pace::Longest, ..registers.hardware(2, EndPoint::Longest)? })
}

/// The end-point scheme chosen, which must be among those that the model takes.
pub(crate) fn end_point(
    model: &'static str,
    choices: &Choices,
    default: EndPoint,
    taken: &[EndPoint],
    why_not: &str,
) -> Result<EndPoint, ModelError> {
    let chosen = choices.end_point.unwrap_or(default);
    if taken.contains(&chosen) {
        return Ok(chosen);
    }
    let list: Vec<&str> = taken.iter().map(|scheme| scheme.word()).collect();
    Err(ModelError::Value {
        model,
        choice: Choice::EndPoint,
        value: chosen.word().to_owned(),
        reason: format!("{why_not}; it takes {}", list.join(", ")),
    })
}

/// The end-point scheme of a curve that a pair of integrators draws.
pub(crate) fn integrated_end_point(model: &'static str, choices: &Choices) -> Result<EndPoint, ModelError> {
    end_point(
        model,
        choices,
        EndPoint::PerAxis,
        &[EndPoint::PerAxis, EndPoint::Total],
        "the longest axis of an arc may arrive while the other still has steps to go, and iterations say nothing of \
         where an arc stands",
    )
}
