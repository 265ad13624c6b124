//! The hardware of a model for each k.

use std::collections::BTreeMap;

use stepwave_models::options::WIDTH;
use stepwave_models::{AXES, Claims, Hardware, Model, ModelError, Options};
use stepwave_nc::Curve;
use stepwave_netlist::{Width, did_you_mean};

use crate::study::boxes::{spare_bits, widest};

/// Bits by which registers are narrower than by default, by name.
pub type Narrower = BTreeMap<String, u32>;

/// Bits by which registers are wider than by default (narrower below 0), by name.
pub(super) type Offsets = BTreeMap<String, i64>;

pub(super) fn offsets(narrower: &Narrower) -> Offsets {
    narrower.iter().map(|(register, bits)| (register.clone(), -i64::from(*bits))).collect()
}

/// The choices that make hardware for k-bit coordinates, some registers narrower than by default.
///
/// # Errors
/// There are no such geometries, or a register cannot be so narrow.
pub fn choices_at(
    model: &Model,
    claims: &Claims,
    choices: &Options,
    narrower: &Narrower,
    k: u32,
) -> Result<Options, ModelError> {
    choices_with(model, claims, choices, &offsets(narrower), k)
}

/// As [`choices_at`], some registers narrower or wider.
pub(super) fn choices_with(
    model: &Model,
    claims: &Claims,
    choices: &Options,
    offsets: &Offsets,
    k: u32,
) -> Result<Options, ModelError> {
    let bits = k + spare_bits(model, choices);
    let width = Width::new(u64::from(bits)).ok().filter(|_| model.width_is_of_coordinates());
    let wide = choices.clone().with_all(&WIDTH, width.or(choices.of_all(&WIDTH)));
    if offsets.is_empty() {
        return Ok(wide);
    }
    let default = hardware_at(model, claims, &wide, k)?;
    let mut widths = wide.of_single(&WIDTH);
    for (given, bits) in offsets {
        for (register, own) in registers_named(model, &default, given)? {
            let other = u64::try_from(i64::from(own.get()) + bits).ok().and_then(|bits| Width::new(bits).ok());
            let other = other.ok_or_else(|| {
                let (bits, how) = (bits.unsigned_abs(), if *bits < 0 { "narrower" } else { "wider" });
                ModelError::Widths(format!("{}: {register} of {own} cannot be {bits} bits {how}", model.name))
            })?;
            widths.insert(register, other);
        }
    }
    Ok(wide.with_single(&WIDTH, widths))
}

/// The registers of this name with their widths: one, or those of each axis (`jr` for `jrx`, `jry`, …).
pub(super) fn registers_named(
    model: &Model,
    hardware: &Hardware,
    name: &str,
) -> Result<Vec<(String, Width)>, ModelError> {
    let of_axis = |register: &str| AXES.iter().any(|axis| register.strip_suffix(axis) == Some(name));
    let exact = hardware.widths.contains_key(name);
    let meant =
        hardware.widths.iter().filter(|(register, _)| if exact { **register == name } else { of_axis(register) });
    let meant: Vec<_> = meant.map(|(register, width)| ((*register).to_owned(), *width)).collect();
    if meant.is_empty() {
        let known: Vec<&str> = hardware.widths.keys().copied().collect();
        return Err(ModelError::Widths(format!(
            "{} has no register {name} with a width to choose{}: give one of {}",
            model.name,
            did_you_mean(name, known.iter().copied()),
            known.join(", ")
        )));
    }
    Ok(meant)
}

/// The hardware for all geometries of k-bit coordinates.
pub(in crate::study) fn hardware_at(
    model: &Model,
    claims: &Claims,
    choices: &Options,
    k: u32,
) -> Result<Hardware, ModelError> {
    widest(model, choices, &claims.geometries.demanding(k))?
        .ok_or_else(|| ModelError::Widths(format!("there are no geometries of {k} bits")))
}

/// The geometry of k-bit coordinates that needs the widest registers.
pub(super) fn largest(claims: &Claims, k: u32) -> Result<Curve, ModelError> {
    claims.geometries.largest(k).ok_or_else(|| ModelError::Widths(format!("there are no geometries of {k} bits")))
}
