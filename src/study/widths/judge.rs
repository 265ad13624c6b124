//! Hardware of given widths, judged by what a box needs.

use std::collections::BTreeMap;

use stepwave_models::options::{ON_OVERFLOW, WIDTH};
use stepwave_models::{Hardware, Model, Options};
use stepwave_netlist::Width;

use super::simulate::too_narrow;
use super::{Known, Widths};
use crate::study::boxes::{Extent, Geometries, has_widths, without_widths};
use crate::study::proof::ProofError;

/// The choices of hardware that is wide enough for a box: without the widths that are given, unless registers of one scale
/// are given more bits than the box needs. Those run otherwise on wider hardware, not only with room to spare.
pub(super) fn ample(model: &'static Model, choices: &Options, extent: &Extent) -> Result<Options, ProofError> {
    let default = without_widths(model, choices).with(&ON_OVERFLOW, None);
    if !has_widths(model, choices) {
        return Ok(default);
    }
    let least = Geometries::extremes(model, &default, extent)?;
    let given = given(model, choices, &least)?;
    let paces = paces(model, &least, &given);
    if !paces.is_empty() {
        return Ok(default.with_single(&WIDTH, paces));
    }
    let scaled = |hardware: &Hardware| {
        let own = hardware.widths.iter().filter(|(name, _)| hardware.shares_a_scale(name));
        own.map(|(name, width)| ((*name).to_owned(), *width)).collect::<BTreeMap<String, Width>>()
    };
    let (default_widths, own) = (scaled(&least.hardware), scaled(&given));
    let wider = own.iter().any(|(name, width)| default_widths.get(name).is_some_and(|default| width > default));
    if !wider {
        return Ok(default);
    }
    // All of the scale at once, as wide as the widest of them is wider.
    let more =
        own.iter().map(|(name, width)| width.get().saturating_sub(least.hardware.bits_of(name))).max().unwrap_or(0);
    let widths = default_widths.into_iter().map(|(name, width)| {
        let wide = own.get(&name).copied().unwrap_or(width).max(width);
        Ok((name, wide))
    });
    match choices.of_all(&WIDTH) {
        Some(width) => Ok(default.with_all(&WIDTH, width)),
        None if more > 0 => Ok(default.with_single(&WIDTH, widths.collect::<Result<_, ProofError>>()?)),
        None => Ok(default),
    }
}

/// Registers that are loaded with what their own width makes possible, so that all others count on another scale: the
/// accumulations of a step generator. Whatever width they are given is the hardware that is judged.
fn paces(model: &Model, least: &Geometries, given: &Hardware) -> BTreeMap<String, Width> {
    let Some(curve) = least.curves.first() else { return BTreeMap::new() };
    let word = |hardware: &Hardware, name: &str| {
        let words = model.words(hardware, curve).into_iter().flatten().flatten();
        words.filter(|(register, _)| *register == name).map(|(_, word)| word).collect::<Vec<_>>()
    };
    let is_pace = |name: &'static str, width: Width| {
        let mut alone = least.hardware.clone();
        let other = alone.widths.insert(name, width) != Some(width);
        other && !given.shares_a_scale(name) && word(&alone, name) != word(&least.hardware, name)
    };
    let own = given.widths.iter().filter(|(name, width)| is_pace(name, **width));
    own.map(|(name, width)| ((*name).to_owned(), *width)).collect()
}

/// The hardware with the widths that are given.
fn given(model: &'static Model, choices: &Options, least: &Geometries) -> Result<Hardware, ProofError> {
    // What the box decides beyond widths, such as the steps of all its curves, holds for this hardware too.
    let typed = least
        .choices
        .clone()
        .with_all(&WIDTH, choices.of_all(&WIDTH).or(least.choices.of_all(&WIDTH)))
        .with_single(&WIDTH, choices.of_single(&WIDTH));
    let mut widest: Option<Hardware> = None;
    for curve in &least.curves {
        let plan = model.plan(curve, &typed)?;
        let Some(own) = &mut widest else {
            widest = Some(plan);
            continue;
        };
        for (name, width) in plan.widths {
            let known = own.widths.entry(name).or_insert(width);
            *known = (*known).max(width);
        }
    }
    widest.ok_or_else(|| ProofError::Box(format!("the box holds nothing for {}: give a larger one", model.name)))
}

/// Puts the widths that are given in the place of those by default, and looks for a run where they are too narrow.
pub(super) fn judge(
    model: &'static Model,
    choices: &Options,
    ample: &Options,
    found: &mut Widths,
) -> Result<(), ProofError> {
    if !has_widths(model, choices) {
        return Ok(());
    }
    let set = Geometries::extremes(model, ample, &found.extent)?;
    let hardware = given(model, choices, &set)?;
    for register in &mut found.registers {
        register.given = hardware.bits_of(&register.name);
        if register.given >= register.needed {
            continue;
        }
        // What one bit less does not hold, fewer bits do not hold either.
        let Some(witness) = &register.witness else { continue };
        let certain = register.known != Known::Sampled;
        register.fault =
            too_narrow(model, &set.choices, (&register.name, register.given), &witness.curve, certain && !witness.ran);
    }
    Ok(())
}
