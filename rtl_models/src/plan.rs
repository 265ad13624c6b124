//! What the plans of several models need: the size of a geometry, and the values that a choice may have.

use stepwave_kernel::Width;
use stepwave_nc::{Arc, Curve, Line, Sector};

use crate::choices::{Choice, Choices, EndPoint};
use crate::error::ModelError;

/// The line of a curve; `Model::plan` has checked that it is one.
pub(crate) fn line(curve: &Curve) -> Option<&Line> {
    match curve {
        Curve::Line(line) => Some(line),
        Curve::Arc(_) => None,
    }
}

/// The arc of a curve; `Model::plan` has checked that it is one.
pub(crate) fn arc(curve: &Curve) -> Option<&Arc> {
    match curve {
        Curve::Arc(arc) => Some(arc),
        Curve::Line(_) => None,
    }
}

/// Bits of a magnitude register: as chosen, or the least that hold `largest`.
pub(crate) fn magnitude_bits(choices: &Choices, largest: u64) -> u32 {
    choices.width.map_or_else(|| Width::needed_unsigned(u128::from(largest)), Width::get)
}

/// Bits of a position counter: one more than the positions need, so that an erring path stays visible.
pub(crate) fn position_bits(positions: impl IntoIterator<Item = i64>) -> u32 {
    positions.into_iter().map(|position| Width::needed_signed(i128::from(position))).max().unwrap_or(1) + 1
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

/// Positions of one axis at the ends of all sectors, in machine coordinates.
pub(crate) fn sector_positions(arc: &Arc, sectors: &[Sector], axis: usize) -> Vec<i64> {
    let ends = sectors.iter().flat_map(|sector| [sector.start[axis], sector.end[axis]]);
    ends.map(|relative| arc.center()[axis] + relative).collect()
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
    let list: Vec<String> = taken.iter().map(ToString::to_string).collect();
    Err(ModelError::Value {
        model,
        choice: Choice::EndPoint,
        value: chosen.to_string(),
        reason: format!("{why_not}; it takes {}", list.join(", ")),
    })
}
