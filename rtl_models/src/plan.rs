//! The plan of a model for a curve: the widths of its registers by their rules, and what the user says instead.

use std::collections::BTreeMap;

use stepwave_netlist::Width;
use stepwave_netlist::bits::Reading;

use crate::error::ModelError;
use crate::hardware::{Hardware, Pace};
use crate::options::{ADDER, Adder, NORMALIZE, OptionDef, Options, PRESET, PerRegister, Preset, RADIX, Radix, WIDTH};
use crate::parts::{JR, JV, POSITION};
use crate::registers::{AXES, Declaration, Reg, RegisterGroup, Registers, Rule};
use crate::sampling::Sampling;

/// What a model says of its hardware for a curve: widths that follow no rule, and promises.
///
/// It begins without any; the method promises no path error, and may be without a pulse for 16 clocks.
#[derive(Clone, Debug)]
pub struct Plan {
    model: &'static str,
    axes: usize,
    registers: Registers,
    options: Options,
    /// Widths that do not follow the rule of their register.
    set: Vec<(&'static str, u32)>,
    /// Bits n of a magnitude register: [as chosen, or the least](Plan::magnitude_bits) for this curve.
    pub n: u32,
    /// Greatest path error in BLU that the method promises, if it promises one.
    pub error_bound: Option<f64>,
    /// Steps of a line.
    pub pace: Pace,
    /// Greatest deviation of an axis from its uniform rate, in pulses, that the method promises, if it promises one.
    pub rate_bound: Option<f64>,
    /// No pulse for this many clocks while a block runs means that none will come; `u64::MAX` where that is not known.
    pub stall_clocks: u64,
    /// Clocks of a step that nothing delays, if they are known: 1, or in a model that takes the option `beats` as many.
    pub step_clocks: Option<u64>,
    /// Numbers that the hardware is built with besides widths and options.
    pub constants: Vec<(&'static str, i128)>,
    /// What to do where a component overflows that no width helps, by its name.
    pub remedies: Vec<(&'static str, String)>,
    pub(crate) sampling: Option<Sampling>,
}

impl Plan {
    /// For a curve of `axes` axes.
    pub(crate) fn new(model: &'static str, axes: usize, registers: Registers, options: Options) -> Plan {
        Plan {
            model,
            axes,
            registers,
            options,
            set: Vec::with_capacity(8),
            n: 0,
            error_bound: None,
            pace: Pace::default(),
            rate_bound: None,
            stall_clocks: 16,
            step_clocks: Some(1),
            constants: Vec::new(),
            remedies: Vec::new(),
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

    /// Sets the value of an option, overriding what was given.
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

    /// Gives a register another default width than its rule says.
    pub fn set(&mut self, register: Reg, bits: u32) -> &mut Self {
        self.set.push((register.name(), bits));
        self
    }

    /// The same for several registers.
    pub fn set_each<const K: usize>(&mut self, registers: Reg<K>, bits: u32) -> &mut Self {
        (0..K).fold(self, |plan, index| plan.set(registers.of(index), bits))
    }

    /// The position counters, each for the positions of its axis that must fit. They get one bit more, so that an
    /// erring path stays visible.
    pub fn positions(&mut self, axes: impl IntoIterator<Item = impl IntoIterator<Item = i64>>) -> &mut Self {
        for (axis, positions) in (0..self.axes).zip(axes) {
            let needed = positions.into_iter().map(|position| Width::needed_signed(i128::from(position)));
            self.set(POSITION.of(axis), needed.max().unwrap_or(1) + 1);
        }
        self
    }

    /// Calls with every register that the hardware has, in the order of the model's list; two rows of one entry take
    /// turns.
    fn each(&self, mut visit: impl FnMut(&'static str, &'static Declaration)) {
        for declared in self.registers {
            let (first, second) = declared.rows();
            let names = |RegisterGroup { names, declaration }: RegisterGroup| match declaration.when.holds(self) {
                true => &names[..(declaration.count)(self).min(names.len())],
                false => &[],
            };
            let (own, other) = (names(first), second.map_or(&[][..], names));
            for index in 0..own.len().max(other.len()) {
                if let Some(name) = own.get(index) {
                    visit(name, first.declaration);
                }
                if let Some((name, row)) = other.get(index).zip(second) {
                    visit(name, row.declaration);
                }
            }
        }
    }

    /// The user may choose the width of these registers.
    fn is_free(&self, declaration: &Declaration) -> bool {
        !matches!(declaration.rule, Rule::Bits(_)) && !(declaration.follows)(self)
    }

    /// Registers with a choice of width.
    fn names(&self) -> Vec<&'static str> {
        let mut names = Vec::new();
        self.each(|name, declaration| names.extend(self.is_free(declaration).then_some(name)));
        names
    }

    /// Default width in bits of a register that is declared so; 0 if it has none.
    fn default(&self, name: &str, declaration: &Declaration) -> u32 {
        let set = self.set.iter().rev().find(|(known, _)| *known == name).map(|(_, bits)| *bits);
        set.unwrap_or(match declaration.rule {
            Rule::Magnitude(_) if self.n == 0 => 0,
            Rule::Magnitude(more) => self.n.saturating_add(more),
            Rule::Bits(bits) => bits,
            Rule::Planned(_) => 0,
        })
    }

    /// Width in bits of a register of the model: the user's, or its default so far; 0 for one that it does not list.
    #[must_use]
    pub fn bits(&self, register: Reg) -> u32 {
        if let Some(width) = self.chosen(register.name()) {
            return width.get();
        }
        let mut bits = 0;
        self.each(|name, declaration| {
            if name == register.name() {
                bits = self.default(name, declaration);
            }
        });
        bits
    }

    /// The width that the user gave this register, by its name or by its kind.
    fn chosen(&self, name: &str) -> Option<Width> {
        let single = &self.options.get(&WIDTH)?.single;
        if single.is_empty() {
            return None;
        }
        single.get(name).or_else(|| single.get(kind(&self.names(), name)?)).copied()
    }

    /// Calls with every register that the hardware has: its name, its width if the user may choose it, and its
    /// declaration.
    fn resolve(
        &self,
        mut take: impl FnMut(&'static str, Option<Width>, &'static Declaration),
    ) -> Result<(), ModelError> {
        let single = self.options.get(&WIDTH).map(|widths| &widths.single).filter(|single| !single.is_empty());
        let known = if single.is_some() { self.names() } else { Vec::new() };
        for given in single.into_iter().flat_map(BTreeMap::keys) {
            if !known.iter().any(|name| name == given || kind(&known, name) == Some(given)) {
                return Err(self.unknown(WIDTH.name, given, &known));
            }
        }
        let mut result = Ok(());
        self.each(|name, declaration| {
            let default = || match self.default(name, declaration) {
                0 => Err(ModelError::defect(self.model, format!("its plan gives no width to the register {name}"))),
                bits => Width::new(u64::from(bits)).map_err(|_| ModelError::TooWide {
                    register: name.to_owned(),
                    bits: u64::from(bits),
                    remedy: "give a smaller --width or a smaller geometry".to_owned(),
                }),
            };
            let width = self.is_free(declaration).then(|| {
                let single = single.and_then(|single| single.get(name).or_else(|| single.get(kind(&known, name)?)));
                single.map_or_else(default, |width| Ok(*width))
            });
            match width.transpose() {
                Ok(width) => take(name, width, declaration),
                Err(error) if result.is_ok() => result = Err(error),
                Err(_) => {}
            }
        });
        result
    }

    /// Checks the widths so far.
    ///
    /// # Errors
    /// A width is given for a register that does not exist, or one is impossible.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        self.resolve(|_, _, _| {})
    }

    fn unknown(&self, option: &'static str, given: &str, known: &[&str]) -> ModelError {
        ModelError::UnknownRegister { model: self.model, option, register: given.to_owned(), known: known.join(", ") }
    }

    /// The preset of each axis.
    ///
    /// # Errors
    /// One is given for a register that is not a remainder register.
    pub fn presets(&self) -> Result<Vec<Preset>, ModelError> {
        let all = self.options.of_all(&PRESET).unwrap_or_default();
        let single = self.options.get(&PRESET).map(|presets| &presets.single).filter(|single| !single.is_empty());
        let mut presets = vec![all; self.axes];
        let Some(single) = single else { return Ok(presets) };
        // Of a third axis that follows the others there is none.
        let mut known = Vec::new();
        self.each(|name, declaration| known.extend(declaration.preset.then_some(name)));
        if let Some(unknown) = single.keys().find(|given| !known.contains(&given.as_str())) {
            return Err(self.unknown(PRESET.name, unknown, &known));
        }
        for (preset, name) in presets.iter_mut().zip(known) {
            *preset = single.get(name).copied().unwrap_or(all);
        }
        Ok(presets)
    }

    /// The hardware: widths and all options as given or by default.
    pub(crate) fn finish(self) -> Result<Hardware, ModelError> {
        let presets = self.presets()?;
        let (mut widths, mut table) = (Vec::with_capacity(16), Vec::with_capacity(16));
        let (mut scale, mut leaders) = (Vec::new(), Vec::new());
        self.resolve(|name, width, declaration| {
            widths.extend(width.map(|width| (name, width)));
            table.extend(declaration.shown.then_some(name));
            scale.extend(declaration.scaled.then_some(name));
            leaders.extend(declaration.leader.map(|leader| (name, leader)));
        })?;
        let count = widths.len();
        let widths: BTreeMap<_, _> = widths.into_iter().collect();
        if widths.len() < count {
            return Err(ModelError::defect(self.model, "two of its registers have one name".to_owned()));
        }
        Ok(Hardware {
            presets,
            widths,
            model: self.model,
            axes: self.axes,
            // Both are resolved, register by register.
            options: self.options.without(&WIDTH).without(&PRESET),
            sampling: self.sampling,
            table,
            stall_clocks: self.stall_clocks,
            step_clocks: self.step_clocks,
            error_bound: self.error_bound,
            pace: self.pace,
            rate_bound: self.rate_bound,
            scale,
            leaders,
            constants: self.constants,
            remedies: self.remedies,
        })
    }

    /// The integrators (`jr…`, `jv…`) share one scale: equally wide remainders, and integrands that fit in them. An
    /// iteration takes `clocks` clocks.
    ///
    /// # Errors
    /// The widths chosen are of several scales.
    pub fn integrators(&mut self, clocks: u64) -> Result<(), ModelError> {
        self.integrators_with_fraction(self.axes, clocks)
    }

    /// As [`integrators`](Plan::integrators), but only the first `whole` of the axes count whole steps. The integrands
    /// of the others have a fraction: as many bits as their remainders are wider than `jrx`.
    ///
    /// # Errors
    /// The widths chosen are of several scales.
    pub fn integrators_with_fraction(&mut self, whole: usize, clocks: u64) -> Result<(), ModelError> {
        self.check()?;
        let (model, radix) = (self.model, self.get(&RADIX));
        // All of them are in range.
        let width = |register| Width::new(self.bits(register).into()).unwrap_or(Width::MAX);
        let first = width(JR.of(0));
        let mut n = 1;
        for (index, axis) in AXES[..self.axes].iter().enumerate() {
            let (jr, jv) = (width(JR.of(index)), width(JV.of(index)));
            n = n.max(jr.get());
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
        // An integrator that has not pulsed in this many additions never will; and as many clocks of normalisation as
        // bits, and those of loading.
        let additions = u64::try_from(crate::hardware::modulus(radix, n)).unwrap_or(u64::MAX);
        self.step_clocks = Some(clocks);
        self.stall_clocks = additions.saturating_mul(clocks).saturating_add(u64::from(n) + 8);
        Ok(())
    }
}

/// `jr` for `jrx`: the name without the axis letter, where several of these registers have such a name.
fn kind<'n>(registers: &[&str], name: &'n str) -> Option<&'n str> {
    let of_axis = |name: &'_ str| AXES.iter().any(|axis| name.len() > 1 && name.ends_with(axis));
    let kind = of_axis(name).then(|| &name[..name.len() - 1])?;
    let alike = |other: &&&str| of_axis(other) && other[..other.len() - 1] == *kind;
    (registers.iter().filter(alike).count() > 1).then_some(kind)
}
