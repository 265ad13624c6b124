//! Hardware: a model's choices with nothing left open. One hardware may run many geometries.

use std::collections::BTreeMap;

use stepwave_kernel::{OnOverflow, Width};

use crate::choices::{Beats, Choice, Choices, EndPoint, Form, Preset};
use crate::error::ModelError;

/// Letters of up to six axes.
pub const AXES: [&str; 6] = ["x", "y", "z", "a", "b", "c"];

/// All that fixes a netlist.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardware {
    /// Name of the model.
    pub model: &'static str,
    /// Number of axes.
    pub axes: usize,
    /// Width of every register that has a choice of it, by name.
    pub widths: BTreeMap<String, Width>,
    /// Preset of each axis's remainder register.
    pub presets: Vec<Preset>,
    /// Left-shift normalisation.
    pub normalize: bool,
    /// End-point scheme.
    pub end_point: EndPoint,
    /// Form of the line's deviation.
    pub form: Form,
    /// Clocks a step.
    pub beats: Beats,
    /// What a strict cell does on overflow.
    pub on_overflow: OnOverflow,
    /// Registers that a step table shows, in order.
    pub table: Vec<String>,
    /// No pulse for this many clocks while a block runs means that none will come.
    pub stall_clocks: u64,
    /// Greatest path error in BLU that the method promises, if it promises one.
    pub error_bound: Option<f64>,
}

impl Hardware {
    /// Width of a register in bits; 1 for one that does not exist.
    #[must_use]
    pub fn bits(&self, register: &str) -> u32 {
        self.widths.get(register).map_or(1, |width| width.get())
    }

    /// Preset of an axis's remainder register, in that register. A value that does not fit is kept, so that loading it
    /// is refused with its name.
    pub(crate) fn preset(&self, axis: usize, register: &str) -> i128 {
        let preset = self.presets.get(axis).copied().unwrap_or(Preset::Zero);
        match (preset, self.widths.get(register).and_then(|&width| preset.value(width))) {
            (Preset::Value(value), None) => i128::from(value),
            (_, value) => i128::from(value.unwrap_or(0)),
        }
    }

    /// What to give as `--width` for a register to have `bits`. Integrators are widened together, to the `all` bits that
    /// the widest of them needs, where one alone would no longer fit the others.
    #[must_use]
    pub fn widening(&self, register: &str, bits: u32, all: u32) -> String {
        let room = register.strip_prefix("jv").map(|axis| self.bits(&format!("jr{axis}")));
        let fits = room.is_some_and(|room| bits <= room) && !self.normalize;
        if is_integrator(register) && !fits { all.to_string() } else { format!("{register}={bits}") }
    }

    /// Letters of the axes.
    #[must_use]
    pub fn letters(&self) -> &'static [&'static str] {
        &AXES[..self.axes]
    }
}

/// Default widths of a model's registers, to be overridden by the user's.
pub(crate) struct Widths<'a> {
    model: &'static str,
    choices: &'a Choices,
    default: Vec<(String, u32)>,
}

impl<'a> Widths<'a> {
    pub(crate) fn new(model: &'static str, choices: &'a Choices) -> Widths<'a> {
        Widths { model, choices, default: Vec::new() }
    }

    /// A register and the width that it has unless the user says otherwise, in the order of the step table.
    pub(crate) fn register(&mut self, name: impl Into<String>, bits: u32) -> &mut Self {
        self.default.push((name.into(), bits));
        self
    }

    /// Width of a register given so far: the user's, or its default.
    pub(crate) fn bits(&self, name: &str) -> u32 {
        let default = self.default.iter().find(|(known, _)| known == name).map_or(1, |(_, bits)| *bits);
        self.chosen(name).map_or(default, Width::get)
    }

    /// The width that the user gave this register, by its name or by its kind.
    fn chosen(&self, name: &str) -> Option<Width> {
        let single = self.choices.widths.get(name);
        single.or_else(|| self.choices.widths.get(kind(name)?)).copied()
    }

    /// Names of the registers given so far, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        self.default.iter().map(|(name, _)| name.clone()).collect()
    }

    /// The width of all registers.
    pub(crate) fn resolve(&self) -> Result<BTreeMap<String, Width>, ModelError> {
        let names = || self.default.iter().map(|(name, _)| name.as_str());
        for given in self.choices.widths.keys() {
            if !names().any(|name| name == given || kind(name) == Some(given)) {
                return Err(ModelError::UnknownRegister {
                    model: self.model,
                    choice: Choice::Width,
                    register: given.clone(),
                    known: names().collect::<Vec<_>>().join(", "),
                });
            }
        }
        let resolved = self.default.iter().map(|(name, bits)| {
            let width = match self.chosen(name) {
                Some(width) => width,
                None => Width::new(u64::from(*bits)).map_err(|_| ModelError::TooWide {
                    register: name.clone(),
                    bits: u64::from(*bits),
                    way_out: "give a smaller --width or a smaller geometry".to_owned(),
                })?,
            };
            Ok((name.clone(), width))
        });
        resolved.collect()
    }
}

/// An integrand or a remainder: registers that share one scale (see [`check_integrators`]).
pub(crate) fn is_integrator(register: &str) -> bool {
    register.starts_with("jv") || register.starts_with("jr")
}

/// `jr` for `jrx`: the name without the axis letter, for registers that each axis has.
fn kind(name: &str) -> Option<&str> {
    let kind = AXES.iter().find_map(|axis| name.strip_suffix(axis))?;
    ["jv", "jr", "e"].contains(&kind).then_some(kind)
}

/// The preset of each axis.
pub(crate) fn presets(model: &'static str, choices: &Choices, axes: usize) -> Result<Vec<Preset>, ModelError> {
    let names: Vec<String> = AXES[..axes].iter().map(|axis| format!("jr{axis}")).collect();
    if let Some(unknown) = choices.presets.keys().find(|given| !names.contains(given)) {
        return Err(ModelError::UnknownRegister {
            model,
            choice: Choice::Preset,
            register: unknown.clone(),
            known: names.join(", "),
        });
    }
    let all = choices.preset.unwrap_or(Preset::Zero);
    Ok(names.iter().map(|name| choices.presets.get(name).copied().unwrap_or(all)).collect())
}

/// Integrators share one scale: equally wide remainders, and integrands that fit in them.
pub(crate) fn check_integrators(
    model: &'static str,
    widths: &BTreeMap<String, Width>,
    axes: usize,
    normalize: bool,
) -> Result<(), ModelError> {
    let first = widths["jrx"];
    for axis in &AXES[..axes] {
        let (jr, jv) = (widths[&format!("jr{axis}")], widths[&format!("jv{axis}")]);
        if jr != first {
            return Err(ModelError::Widths(format!(
                "{model}: jr{axis} of {jr} and jrx of {first} would count at unequal rates: give all jr the same width"
            )));
        }
        if jv > jr || normalize && jv != jr {
            let rule = if normalize { "must be as wide as" } else { "must not be wider than" };
            return Err(ModelError::Widths(format!(
                "{model}: the integrand jv{axis} of {jv} {rule} its remainder jr{axis} of {jr}: change --width"
            )));
        }
    }
    Ok(())
}

/// Clocks after which an integrator of `n` bits that has not pulsed never will: 2^n additions, and as many clocks of
/// normalisation as bits, and those of loading.
pub(crate) fn integrator_stall(n: u32) -> u64 {
    1u64.checked_shl(n).map_or(u64::MAX, |additions| additions.saturating_add(u64::from(n) + 8))
}
