//! The plan of a model for a curve: its registers in the order of the step table, with their default widths, and what the
//! user says instead.

use std::collections::BTreeMap;

use stepwave_netlist::Width;
use stepwave_netlist::bits::Reading;

use crate::error::ModelError;
use crate::hardware::{AXES, Hardware, Pace};
use crate::options::{ADDER, Adder, NORMALIZE, OptionDef, Options, PRESET, PerRegister, Preset, RADIX, Radix, WIDTH};
use crate::sampling::Sampling;

/// What a model says of its hardware for a curve: registers and widths, in the order of the step table, and promises.
///
/// It begins without registers; the method promises no path error, and may be without a pulse for 16 clocks.
#[derive(Clone, Debug)]
pub struct Plan {
    model: &'static str,
    axes: usize,
    options: Options,
    /// Those with a choice of width, and the width that they have unless the user says otherwise.
    default: Vec<(String, u32)>,
    table: Vec<String>,
    /// Greatest path error in BLU that the method promises, if it promises one.
    pub error_bound: Option<f64>,
    /// Steps of a line.
    pub pace: Pace,
    /// Greatest deviation of an axis from its uniform rate, in pulses, that the method promises, if it promises one.
    pub rate_bound: Option<f64>,
    /// No pulse for this many clocks while a block runs means that none will come.
    pub stall_clocks: u64,
    /// Beginnings of the names of registers that share one scale and are widened together.
    pub scale: &'static [&'static str],
    pub(crate) sampling: Option<Sampling>,
}

impl Plan {
    /// For a curve of `axes` axes.
    pub(crate) fn new(model: &'static str, axes: usize, options: Options) -> Plan {
        Plan {
            model,
            axes,
            options,
            default: Vec::new(),
            table: Vec::new(),
            error_bound: None,
            pace: Pace::default(),
            rate_bound: None,
            stall_clocks: 16,
            scale: &[],
            sampling: None,
        }
    }

    /// Name of the model.
    #[must_use]
    pub fn model(&self) -> &'static str {
        self.model
    }

    /// Number of axes of the curve.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.axes
    }

    /// The options given, with the model's defaults that depend on nothing.
    #[must_use]
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The value of an option: as given, or by default.
    #[must_use]
    pub fn get<T: Clone + 'static>(&self, option: &OptionDef<T>) -> T {
        self.options.value(option)
    }

    /// The value of an option: as given, or else this one, which the model chooses for the curve.
    pub fn decide<T: Clone + PartialEq + Send + Sync + 'static>(
        &mut self,
        option: &'static OptionDef<T>,
        usual: T,
    ) -> T {
        if self.options.get(option).is_none() {
            self.fix(option, usual);
        }
        self.get(option)
    }

    /// Sets the value of an option, whatever was given.
    pub fn fix<T: Clone + PartialEq + Send + Sync + 'static>(&mut self, option: &'static OptionDef<T>, value: T) {
        self.options.set(option.value(value));
    }

    /// The preset of remainder registers for which none is given.
    pub fn usual_preset(&mut self, usual: Preset) {
        let single = self.options.of_single(&PRESET);
        let all = self.options.of_all(&PRESET).or(Some(usual));
        self.fix(&PRESET, PerRegister { all, single });
    }

    /// Bits n of a magnitude register: as chosen, or the least that hold `largest`.
    #[must_use]
    pub fn magnitude_bits(&self, largest: u64) -> u32 {
        let reading = match self.get(&RADIX) {
            Radix::Binary => Reading::Unsigned,
            Radix::Decimal => Reading::Decimal,
        };
        self.bits_or(reading.needed(i128::from(largest)))
    }

    /// The width chosen for all magnitude registers, or else these bits.
    #[must_use]
    pub fn bits_or(&self, bits: u32) -> u32 {
        self.options.of_all(&WIDTH).map_or(bits, Width::get)
    }

    /// A register of the step table and its default width in bits.
    pub fn register(&mut self, name: impl Into<String>, bits: u32) -> &mut Self {
        let name = name.into();
        self.shown(&name).hidden(name, bits)
    }

    /// A column of the step table without a choice of width.
    pub fn shown(&mut self, name: &str) -> &mut Self {
        self.table.push(name.to_owned());
        self
    }

    /// A register with a choice of width that the step table does not show.
    pub fn hidden(&mut self, name: impl Into<String>, bits: u32) -> &mut Self {
        self.default.push((name.into(), bits));
        self
    }

    /// The end-point counters of `axes` axes, each of `bits` bits.
    pub fn end_counters(&mut self, axes: usize, bits: u32) -> &mut Self {
        AXES[..axes].iter().fold(self, |plan, axis| plan.register(format!("e{axis}"), bits))
    }

    /// The position counters, each for the positions of its axis that must fit. They get one bit more, so that an
    /// erring path stays visible.
    pub fn positions(&mut self, axes: impl IntoIterator<Item = Vec<i64>>) -> &mut Self {
        for (letter, positions) in AXES.iter().zip(axes) {
            let needed = positions.iter().map(|&position| Width::needed_signed(i128::from(position)));
            self.hidden(*letter, needed.max().unwrap_or(1) + 1);
        }
        self
    }

    /// Width in bits of a register given so far: the user's, or its default; 0 for one that was not.
    #[must_use]
    pub fn bits(&self, name: &str) -> u32 {
        let default = self.default.iter().find(|(known, _)| known == name).map_or(0, |(_, bits)| *bits);
        self.chosen(name).map_or(default, Width::get)
    }

    /// The width that the user gave this register, by its name or by its kind.
    fn chosen(&self, name: &str) -> Option<Width> {
        let single = &self.options.get(&WIDTH)?.single;
        single.get(name).or_else(|| single.get(self.kind(name)?)).copied()
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

    /// The widths of all registers that have a choice of it, by name.
    pub(crate) fn widths(&self) -> Result<BTreeMap<String, Width>, ModelError> {
        let given = self.options.get(&WIDTH).map(|widths| widths.single.keys()).into_iter().flatten();
        for given in given {
            if !self.names().any(|name| name == given || self.kind(name) == Some(given)) {
                return Err(self.unknown(WIDTH.name, given, self.names().collect::<Vec<_>>().join(", ")));
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

    fn unknown(&self, option: &'static str, given: &str, known: String) -> ModelError {
        ModelError::UnknownRegister { model: self.model, option, register: given.to_owned(), known }
    }

    /// The preset of each axis.
    ///
    /// # Errors
    /// One is given for a register that is not a remainder register.
    pub fn presets(&self) -> Result<Vec<Preset>, ModelError> {
        // What an axis accumulates in.
        let kind = if self.names().any(|name| name == "accx") { "acc" } else { "jr" };
        let remainders: Vec<String> = AXES[..self.axes].iter().map(|axis| format!("{kind}{axis}")).collect();
        let single = self.options.of_single(&PRESET);
        // Of a third axis that follows the others there is none.
        let known: Vec<&str> = self.names().filter(|name| remainders.iter().any(|known| known == name)).collect();
        if let Some(unknown) = single.keys().find(|given| !known.contains(&given.as_str())) {
            return Err(self.unknown(PRESET.name, unknown, known.join(", ")));
        }
        let all = self.options.of_all(&PRESET).unwrap_or_default();
        Ok(remainders.iter().map(|name| single.get(name).copied().unwrap_or(all)).collect())
    }

    /// The hardware: widths and all options as given or by default.
    pub(crate) fn finish(self) -> Result<Hardware, ModelError> {
        Ok(Hardware {
            presets: self.presets()?,
            widths: self.widths()?,
            model: self.model,
            axes: self.axes,
            // Both are resolved, register by register.
            options: self.options.without(&WIDTH).without(&PRESET),
            sampling: self.sampling,
            table: self.table,
            stall_clocks: self.stall_clocks,
            error_bound: self.error_bound,
            pace: self.pace,
            rate_bound: self.rate_bound,
            scale: self.scale,
        })
    }

    /// The integrators (`jr…`, `jv…`) share one scale: equally wide remainders, and integrands that fit in them. An
    /// iteration takes so many `clocks`.
    ///
    /// # Errors
    /// The widths chosen are of several scales.
    pub fn integrators(&mut self, clocks: u64) -> Result<(), ModelError> {
        self.integrators_with_fraction(self.axes, clocks)
    }

    /// As [`integrators`](Plan::integrators), but only the first `whole` of the axes count whole steps. The integrands of
    /// the others have a fraction: as many bits as their remainders are wider than `jrx`.
    ///
    /// # Errors
    /// The widths chosen are of several scales.
    pub fn integrators_with_fraction(&mut self, whole: usize, clocks: u64) -> Result<(), ModelError> {
        self.scale = &["jv", "jr"];
        let (model, widths, radix) = (self.model, self.widths()?, self.get(&RADIX));
        let first = widths["jrx"];
        for (index, axis) in AXES[..self.axes].iter().enumerate() {
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
            let equal = self.get(&NORMALIZE) || self.get(&ADDER) == Adder::Serial;
            if jv > jr || equal && jv != jr {
                let rule = if equal { "must be as wide as" } else { "must not be wider than" };
                return Err(ModelError::Widths(format!(
                    "{model}: the integrand jv{axis} of {jv} {rule} its remainder jr{axis} of {jr}: change --width"
                )));
            }
            if radix == Radix::Decimal && (jr.get() % 4 != 0 || jv.get() % 4 != 0) {
                return Err(ModelError::Widths(format!(
                    "{model}: jv{axis} of {jv} and jr{axis} of {jr} hold no whole decimal digits of 4 bits: give a \
                     --width that is a multiple of 4"
                )));
            }
        }
        // An integrator that has not pulsed in so many additions never will; and as many clocks of normalisation as
        // bits, and those of loading.
        let n = widths.iter().filter(|(name, _)| name.starts_with("jr")).map(|(_, jr)| jr.get()).max().unwrap_or(1);
        let additions = u64::try_from(crate::hardware::modulus(radix, n)).unwrap_or(u64::MAX);
        self.stall_clocks = additions.saturating_mul(clocks).saturating_add(u64::from(n) + 8);
        Ok(())
    }
}
