//! Travels of one axis from the origin.

use stepwave_nc::{Curve, Line};
use stepwave_netlist::formula::{Clause, name};

use super::extremes::Reach;
use super::{Kind, coordinate, spread};
use crate::parts::POSITION;

const SIGNS: [(&str, i128); 2] = [("+X", 1), ("-X", -1)];

/// Most bits of coordinates of which all travels are listed; of more, the extreme ones.
pub(super) const WHOLE: u32 = 12;

pub(super) fn kinds() -> Vec<Kind> {
    let kind = |(direction, sign): (&str, i128)| Kind {
        name: direction.to_owned(),
        symbols: vec![coordinate("|dx|")],
        constants: vec![("sx".to_owned(), i128::from(sign < 0))],
        by_mode: Vec::new(),
        premises: vec![Clause::at_least_zero("the axis moves", name("|dx|") - 1)],
        goals: Clause::zero("x ends", POSITION.of(0).value() - sign * name("|dx|")).to_vec(),
    };
    SIGNS.into_iter().map(kind).collect()
}

pub(super) fn symbols(kind: &str, curve: &Curve) -> Option<Vec<i128>> {
    let Curve::Line(line) = curve else { return None };
    let [dx] = <[i64; 1]>::try_from(line.delta()).ok()?;
    let direction = if dx < 0 { "-X" } else { "+X" };
    (kind == direction && line.from() == [0]).then(|| vec![i128::from(dx).abs()])
}

/// The travel from the origin to a coordinate.
pub(super) fn to(end: i64) -> Option<Curve> {
    Line::new(vec![0], vec![end]).ok().map(Curve::Line)
}

/// The ends that are looked at: all up to a number of bits, and the extreme ones.
fn ends(k: u32, all_to: u32) -> Vec<i64> {
    let greatest = (1_i64 << k.min(52)) - 1;
    let least = greatest.min((1 << all_to) - 1);
    let mut ends: Vec<i64> = (-least..=least).filter(|end| *end != 0).collect();
    ends.extend(Reach::within(greatest).marks().into_iter().filter(|end| end.abs() > least));
    ends
}

/// Travels of which some need the widest registers: all up to 8 bits and the extreme ones.
pub(super) fn demanding(k: u32) -> Vec<Curve> {
    ends(k, if k <= WHOLE { WHOLE } else { 8 }).into_iter().filter_map(to).collect()
}

pub(super) fn curves(k: u32, most: usize) -> Vec<Curve> {
    spread(ends(k, WHOLE), most).into_iter().filter_map(to).collect()
}
