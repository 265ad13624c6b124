//! The registers of a model while it is planned: their order, their default widths, and what the user says instead.

use std::collections::BTreeMap;

use stepwave_kernel::Width;

use crate::choices::{Choice, Choices, EndPoint, Preset, Radix};
use crate::error::ModelError;
use crate::hardware::{AXES, Hardware, Pace};

/// Collects the registers of a model in the order of its step table.
pub(crate) struct Registers<'a> {
    model: &'static str,
    choices: &'a Choices,
    /// Those with a choice of width, and the width that they have unless the user says otherwise.
    default: Vec<(String, u32)>,
    table: Vec<String>,
}

impl<'a> Registers<'a> {
    pub(crate) fn new(model: &'static str, choices: &'a Choices) -> Registers<'a> {
        Registers { model, choices, default: Vec::new(), table: Vec::new() }
    }

    /// A register of the step table and its default width in bits.
    pub(crate) fn register(&mut self, name: impl Into<String>, bits: u32) -> &mut Self {
        let name = name.into();
        self.shown(&name).hidden(name, bits)
    }

    /// A column of the step table without a choice of width.
    pub(crate) fn shown(&mut self, name: &str) -> &mut Self {
        self.table.push(name.to_owned());
        self
    }

    /// A register with a choice of width that the step table does not show.
    pub(crate) fn hidden(&mut self, name: impl Into<String>, bits: u32) -> &mut Self {
        self.default.push((name.into(), bits));
        self
    }

    /// The end-point counters of `axes` axes, each of `bits` bits.
    pub(crate) fn end_counters(&mut self, axes: usize, bits: u32) -> &mut Self {
        AXES[..axes].iter().fold(self, |registers, axis| registers.register(format!("e{axis}"), bits))
    }

    /// The position counters, each for the positions of its axis that must fit. They get one bit more, so that an
    /// erring path stays visible.
    pub(crate) fn positions(&mut self, axes: impl IntoIterator<Item = Vec<i64>>) -> &mut Self {
        for (letter, positions) in AXES.iter().zip(axes) {
            let needed = positions.iter().map(|&position| Width::needed_signed(i128::from(position)));
            self.hidden(*letter, needed.max().unwrap_or(1) + 1);
        }
        self
    }

    /// The preset that the user gave all remainder registers.
    pub(crate) fn preset(&self) -> Option<Preset> {
        self.choices.preset
    }

    /// Width of a register given so far: the user's, or its default.
    pub(crate) fn bits(&self, name: &str) -> u32 {
        let default = self.default.iter().find(|(known, _)| known == name).map_or(1, |(_, bits)| *bits);
        self.chosen(name).map_or(default, Width::get)
    }

    /// The width that the user gave this register, by its name or by its kind.
    fn chosen(&self, name: &str) -> Option<Width> {
        let single = self.choices.widths.get(name);
        single.or_else(|| self.choices.widths.get(self.kind(name)?)).copied()
    }

    /// `jr` for `jrx`: the name without the axis letter, for registers that several axes have.
    fn kind<'n>(&self, name: &'n str) -> Option<&'n str> {
        let of = |name: &'n str| AXES.iter().find_map(|axis| name.strip_suffix(axis)).filter(|kind| !kind.is_empty());
        let kind = of(name)?;
        let alike = |(other, _): &&(String, u32)| {
            let other_kind = AXES.iter().find_map(|axis| other.strip_suffix(axis));
            other_kind == Some(kind)
        };
        (self.default.iter().filter(alike).count() > 1).then_some(kind)
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.default.iter().map(|(name, _)| name.as_str())
    }

    fn widths(&self) -> Result<BTreeMap<String, Width>, ModelError> {
        for given in self.choices.widths.keys() {
            if !self.names().any(|name| name == given || self.kind(name) == Some(given)) {
                return Err(self.unknown(Choice::Width, given, self.names().collect::<Vec<_>>().join(", ")));
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

    fn unknown(&self, choice: Choice, given: &str, known: String) -> ModelError {
        ModelError::UnknownRegister { model: self.model, choice, register: given.to_owned(), known }
    }

    /// The hardware of `axes` axes: widths and all other choices as given or by default. It promises no path error,
    /// and may be without a pulse for 16 clocks.
    pub(crate) fn hardware(&self, axes: usize, end_point: EndPoint) -> Result<Hardware, ModelError> {
        let choices = self.choices;
        // What an axis accumulates in.
        let kind = if self.names().any(|name| name == "accx") { "acc" } else { "jr" };
        let remainders: Vec<String> = AXES[..axes].iter().map(|axis| format!("{kind}{axis}")).collect();
        if let Some(unknown) = choices.presets.keys().find(|given| !remainders.contains(given)) {
            return Err(self.unknown(Choice::Preset, unknown, remainders.join(", ")));
        }
        let all = choices.preset.unwrap_or_default();
        Ok(Hardware {
            model: self.model,
            axes,
            widths: self.widths()?,
            presets: remainders.iter().map(|name| choices.presets.get(name).copied().unwrap_or(all)).collect(),
            normalize: choices.normalize,
            radix: choices.radix.unwrap_or_default(),
            adder: choices.adder.unwrap_or_default(),
            end_point,
            form: choices.form.unwrap_or_default(),
            weights: choices.weights.unwrap_or_default(),
            beats: choices.beats.unwrap_or_default(),
            feed_override: choices.feed_override,
            cascade: choices.cascade,
            compare: choices.compare.unwrap_or_default(),
            pick_off: choices.pick_off.unwrap_or(0),
            timing: choices.timing.unwrap_or_default(),
            sampling: None,
            on_overflow: choices.on_overflow.unwrap_or_default(),
            table: self.table.clone(),
            stall_clocks: 16,
            error_bound: None,
            pace: Pace::default(),
            rate_bound: None,
            scale: &[],
        })
    }

    /// Hardware whose integrators (`jr…`, `jv…`) share one scale: equally wide remainders, and integrands that fit in
    /// them. An iteration takes so many `clocks`.
    pub(crate) fn integrators(&self, axes: usize, end_point: EndPoint, clocks: u64) -> Result<Hardware, ModelError> {
        self.integrators_with_fraction(axes, axes, end_point, clocks)
    }

    /// As [`integrators`](Registers::integrators), but only the first `whole` of the axes count whole steps. The
    /// integrands of the others have a fraction: as many bits as their remainders are wider than `jrx`.
    pub(crate) fn integrators_with_fraction(
        &self,
        axes: usize,
        whole: usize,
        end_point: EndPoint,
        clocks: u64,
    ) -> Result<Hardware, ModelError> {
        let mut hardware = self.hardware(axes, end_point)?;
        hardware.scale = &["jv", "jr"];
        let (model, widths) = (self.model, &hardware.widths);
        let first = widths["jrx"];
        for (index, axis) in AXES[..axes].iter().enumerate() {
            let (jr, jv) = (widths[&format!("jr{axis}")], widths[&format!("jv{axis}")]);
            if index >= whole && jr < first {
                return Err(ModelError::Widths(format!(
                    "{model}: jr{axis} of {jr} is narrower than jrx of {first}, but its bits beyond those are the \
                     fraction of jv{axis}: change --width"
                )));
            }
            if index < whole && jr != first {
                return Err(ModelError::Widths(format!(
                    "{model}: jr{axis} of {jr} and jrx of {first} would count at unequal rates: give all jr the same \
                     width"
                )));
            }
            let equal = hardware.normalize || hardware.adder == crate::Adder::Serial;
            if jv > jr || equal && jv != jr {
                let rule = if equal { "must be as wide as" } else { "must not be wider than" };
                return Err(ModelError::Widths(format!(
                    "{model}: the integrand jv{axis} of {jv} {rule} its remainder jr{axis} of {jr}: change --width"
                )));
            }
            if hardware.radix == Radix::Decimal && (jr.get() % 4 != 0 || jv.get() % 4 != 0) {
                return Err(ModelError::Widths(format!(
                    "{model}: jv{axis} of {jv} and jr{axis} of {jr} hold no whole decimal digits of 4 bits: give a \
                     --width that is a multiple of 4"
                )));
            }
        }
        // An integrator that has not pulsed in so many additions never will; and as many clocks of normalisation as
        // bits, and those of loading.
        let n = widths.iter().filter(|(name, _)| name.starts_with("jr")).map(|(_, jr)| jr.get()).max().unwrap_or(1);
        let additions = u64::try_from(hardware.modulus(n)).unwrap_or(u64::MAX);
        hardware.stall_clocks = additions.saturating_mul(clocks).saturating_add(u64::from(n) + 8);
        Ok(hardware)
    }
}
