//! Proofs at one width: a block whose clocks do not depend on its coefficients is followed with all their bits unknown.

use std::fmt;
use std::ops::Range;

use rayon::prelude::*;
use stepwave_models::{AXES, Claims, Kind, Model, Options, Reg};
use stepwave_nc::Curve;
use stepwave_netlist::bits::Reading;
use stepwave_prove::{AxisNets, Followed, LoadWord, Sum, follow, recount};

use super::{Narrower, ProofError, choices_at, hardware_at};

/// Curves of a kind whose words are compared.
const COMPARED: usize = 400;

/// A block of one kind of geometry, followed to its end without an overflow.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Bits of coordinates.
    pub k: u32,
    /// The kind of geometry.
    pub kind: String,
    /// Clocks from the load to the end.
    pub clocks: u64,
    /// The place of each axis in the end, by the bits of its coefficient; `None` where it is not a sum of them.
    pub ends: Vec<Option<Sum>>,
    /// Where it should be.
    pub wanted: Vec<Sum>,
    /// Each unknown bit by its register.
    names: Vec<String>,
}

impl Block {
    /// Every axis ends where it should, whatever its coefficient.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.ends.iter().eq(self.wanted.iter().map(|sum| Some(sum.clone())).collect::<Vec<_>>().iter())
    }
}

/// Width, kind, clocks, and how often each bit of a coefficient was counted.
impl fmt::Display for Block {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} clocks={}", self.k, self.kind, self.clocks)?;
        for (letter, end) in AXES.iter().zip(&self.ends) {
            write!(f, " {letter}=")?;
            let Some(Sum { constant, factors }) = end else {
                write!(f, "?")?;
                continue;
            };
            write!(f, "{constant}")?;
            for (name, factor) in self.names.iter().zip(factors).filter(|(_, factor)| **factor != 0) {
                write!(f, "{factor:+}*{name}")?;
            }
        }
        Ok(())
    }
}

/// How a block is gone through. The first two share nothing but the question.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CountMethod {
    /// By sums of unknown bits: [`follow`].
    Follow,
    /// Pulse by pulse, gate by gate: [`recount`].
    Recount,
    /// Not at all: every axis is said to end where it should, after no clock.
    Wanted,
}

/// Goes through a block of each kind of geometry with coordinates of `k` bits.
///
/// # Errors
/// The hardware cannot be built, a register may overflow, or the end depends on the coefficients.
pub fn blocks(
    model: &'static Model,
    claims: &Claims,
    choices: &Options,
    narrower: &Narrower,
    k: u32,
    method: CountMethod,
) -> Result<Vec<Block>, ProofError> {
    let kinds = claims.geometries.kinds();
    kinds.into_par_iter().map(|kind| block(model, claims, choices, narrower, (k, &kind), method)).collect()
}

fn block(
    model: &'static Model,
    claims: &Claims,
    choices: &Options,
    narrower: &Narrower,
    (k, kind): (u32, &Kind),
    method: CountMethod,
) -> Result<Block, ProofError> {
    let hardware = hardware_at(model, claims, &choices_at(model, claims, choices, narrower, k)?, k)?;
    let machine = model.machine(&hardware)?;
    let all = claims.geometries.curves(k, usize::MAX);
    let own = all.iter().filter(|curve| claims.geometries.symbols(kind, curve).is_some()).take(COMPARED);
    let own: Vec<&Curve> = own.collect();
    let first = own.first().ok_or_else(|| ProofError::NoCurves { kind: kind.name.clone() })?;
    let wrong = |register: &str| ProofError::Counted { register: register.to_owned() };

    // Counted registers hold the travel of their axis, all others the same for every curve.
    let words = |curve: &Curve| -> Result<_, crate::models::ModelError> {
        Ok(model.words(&hardware, curve)?.into_iter().next().unwrap_or_default())
    };
    let common = words(first)?;
    for curve in &own {
        for ((register, value), (_, usual)) in words(curve)?.into_iter().zip(common.iter()) {
            let axis = claims.counted.iter().position(|counted| counted.name() == register);
            let expected = axis.map_or(*usual, |axis| i128::from(curve.to()[axis]).abs());
            if value != expected {
                return Err(wrong(register));
            }
        }
    }
    // Before the words are encoded, so that the answer is the same for every kind, whichever comes first.
    let in_binary =
        |register: &&Reg| machine.inputs.get(register.name()).is_some_and(|port| port.reading == Reading::Unsigned);
    if let Some(register) = claims.counted.iter().find(|register| !in_binary(register)) {
        return Err(wrong(register.name()));
    }
    let encoded = machine.encode(&hardware, &model.words(&hardware, first)?)?.into_iter().next().unwrap_or_default();
    let (mut given, mut names, mut bounds) = (Vec::new(), Vec::new(), vec![0..0; claims.counted.len()]);
    for ((register, _), (net, bits)) in common.iter().zip(encoded) {
        let Some(axis) = claims.counted.iter().position(|counted| counted.name() == *register) else {
            given.push((net, LoadWord::Known(bits)));
            continue;
        };
        let width = machine.inputs.get(*register).ok_or_else(|| wrong(register))?.width.get();
        bounds[axis] = names.len()..names.len() + width as usize;
        names.extend((0..width).map(|bit| format!("{register}.{bit}")));
        given.push((net, LoadWord::Unknown));
    }
    let strobes = super::strobes(&machine);
    let (design, limit) = (&machine.design, hardware.stall_clocks);
    let ends: Vec<_> = machine.positions.iter().map(|port| port.net).collect();
    let axes = machine.pulses.iter().zip(&ends).map(|(pulse, end)| AxisNets { pulse: pulse.net, position: *end });
    let wanted = wanted(&own, &bounds, names.len());
    let followed = match method {
        CountMethod::Wanted => Ok(Followed { clocks: 0, ends: wanted.iter().cloned().map(Some).collect() }),
        CountMethod::Follow => follow(design, strobes, &given, &ends, limit, |_, _| {}),
        CountMethod::Recount => recount(design, strobes, &given, &axes.collect::<Vec<_>>(), limit),
    };
    let followed = followed.map_err(|lost| ProofError::Lost { model: model.name, k, kind: kind.name.clone(), lost })?;
    Ok(Block { k, kind: kind.name.clone(), clocks: followed.clocks, ends: followed.ends, wanted, names })
}

/// Where each axis should end: at the sum of the bits of its coefficient, in the direction in which these curves go.
fn wanted(curves: &[&Curve], bounds: &[Range<usize>], unknowns: usize) -> Vec<Sum> {
    let moves = |axis: usize| curves.iter().find_map(|curve| Some(curve.to()[axis].signum()).filter(|sign| *sign != 0));
    let end = |(axis, bounds): (usize, &Range<usize>)| {
        let mut factors = vec![0; unknowns];
        for (bit, place) in bounds.clone().enumerate() {
            factors[place] = i128::from(moves(axis).unwrap_or(1)) << bit;
        }
        Sum { constant: 0, factors }
    };
    bounds.iter().enumerate().map(end).collect()
}
