//! Hardware: a model's options with nothing left open. One hardware may run many geometries.

use std::collections::BTreeMap;

use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use crate::options::{
    ADDER, Adder, AnyOption, CASCADE, NORMALIZE, OptionDef, Options, PRESET, Preset, RADIX, Radix, WIDTH,
};
use crate::parts::{Block, DownCounter, JR, JV, POSITION, axis_counter};
use crate::registers::{AXES, Reg, Rule};
use crate::sampling::Sampling;

/// How many steps a line takes by its method: the pulses of each axis are to be spread over them evenly.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Pace {
    /// The axes have no constant rates.
    #[default]
    Varying,
    /// A step is a pulse of one axis.
    Total,
    /// A step is a pulse of the longest axis.
    Longest,
    /// Once through all numbers of the register of this name; normalised, through those that the longest travel needs.
    Cycle(Reg),
}

/// All that fixes a netlist.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardware {
    /// Name of the model.
    pub model: &'static str,
    /// Number of axes.
    pub axes: usize,
    /// Width of every register that has a choice of it, by name.
    pub widths: BTreeMap<&'static str, Width>,
    /// Preset of each axis's remainder register.
    pub presets: Vec<Preset>,
    /// The options given, with what the model has by default for those that are not.
    pub options: Options,
    /// The coarse stage of data sampling, if there is one.
    pub sampling: Option<Sampling>,
    /// Registers that a step table shows, in order.
    pub table: Vec<&'static str>,
    /// No pulse for this many clocks while a block runs means that none will come; `u64::MAX` where that is not known.
    pub stall_clocks: u64,
    /// Clocks of a step that nothing delays, if they are known; of data sampling those of a step of the coarse stage are
    /// in `sampling`.
    pub step_clocks: Option<u64>,
    /// Greatest path error in BLU that the method promises, if it promises one.
    pub error_bound: Option<f64>,
    /// Steps of a line.
    pub pace: Pace,
    /// Greatest deviation of an axis from its uniform rate, in pulses, that the method promises, if it promises one.
    pub rate_bound: Option<f64>,
    /// Registers that share one scale and are widened together.
    pub scale: Vec<&'static str>,
    /// Registers that are as wide as another, each with that one.
    pub leaders: Vec<(&'static str, &'static str)>,
    /// Numbers that the plan fixes besides widths and options, such as the modulus of remainders.
    pub constants: Vec<(&'static str, i128)>,
    /// What to do where a component overflows that no width helps, by its name: `give a greater --divisions`.
    pub remedies: Vec<(&'static str, String)>,
}

impl Hardware {
    /// Width of a register in bits; 0, of which no netlist can be made, for one that the model does not list.
    #[must_use]
    pub fn bits(&self, register: Reg) -> u32 {
        match (self.bits_of(register.name()), register.declaration().rule) {
            (0, Rule::Bits(bits)) => bits,
            (bits, _) => bits,
        }
    }

    /// Width in bits of the register of this name; 0 if there is none whose width the user may choose.
    #[must_use]
    pub fn bits_of(&self, register: &str) -> u32 {
        self.widths.get(register).map_or(0, |width| width.get())
    }

    /// A number that the plan fixed; 0 for one that it did not.
    #[must_use]
    pub fn constant(&self, name: &str) -> i128 {
        self.constants.iter().find(|(known, _)| *known == name).map_or(0, |(_, value)| *value)
    }

    /// A register in this scope, by its declaration.
    pub fn reg<'m>(&self, m: Scope<'m>, register: Reg) -> Register<'m> {
        let (name, bits) = (register.name(), self.bits(register));
        if register.declaration().signed { m.reg_signed(name, bits) } else { m.reg(name, bits) }
    }

    /// The load word of a register.
    #[must_use]
    pub fn word<'m>(&self, block: &Block<'m>, register: Reg) -> Signal<'m> {
        let (name, bits) = (register.name(), self.bits(register));
        if register.declaration().signed { block.word_signed(name, bits) } else { block.word(name, bits) }
    }

    /// A register that is loaded with its word and holds it for the whole block.
    #[must_use]
    pub fn held<'m>(&self, m: Scope<'m>, block: &Block<'m>, register: Reg) -> Signal<'m> {
        let (name, bits) = (register.name(), self.bits(register));
        if register.declaration().signed { block.held_signed(m, name, bits) } else { block.held(m, name, bits) }
    }

    /// A register that is loaded with a number of steps and counts them down.
    #[must_use]
    pub fn counter<'m>(&self, m: Scope<'m>, block: &Block<'m>, register: Reg) -> DownCounter<'m> {
        DownCounter::new(m, block, register.name(), self.bits(register))
    }

    /// The pulse and the position of an axis: see [`axis_counter`]; with `--ramp after` also what its pulses go through after
    /// that.
    pub fn axis<'m>(&self, m: Scope<'m>, block: &Block<'m>, axis: usize, pulse: Signal<'m>, negative: Signal<'m>) {
        let (position, bits) = (POSITION.of(axis), self.bits(POSITION.of(axis)));
        let preset = axis_counter(m, block, position.name(), bits, pulse, negative);
        if let Some(after) = block.after(axis) {
            after.close([pulse, negative], bits, [block.preset_position, preset]);
        }
    }

    /// The value of an option: as given, or else by default.
    #[must_use]
    pub fn get<T: Clone + 'static>(&self, option: &OptionDef<T>) -> T {
        self.options.value(option)
    }

    /// The value of an option as one would give it for this hardware: every width, and every preset where they differ.
    #[must_use]
    pub fn text(&self, option: &dyn AnyOption) -> String {
        if option.name() == WIDTH.name {
            let widths = self.widths.iter().map(|(name, width)| format!("{name}={}", width.get()));
            return widths.collect::<Vec<_>>().join(",");
        }
        if option.name() == PRESET.name {
            let all: Vec<_> = self.presets.iter().map(ToString::to_string).collect();
            let one = all.first().filter(|first| all.iter().all(|preset| preset == *first));
            return one.cloned().unwrap_or_else(|| all.join(","));
        }
        let given = self.options.given().iter().find(|value| value.option().name() == option.name());
        given.map_or_else(|| option.default_text(), |value| value.text().to_owned())
    }

    /// One more than the greatest number in an integrator's register of `bits` bits: 2^bits, or 10 to the number of
    /// digits.
    #[must_use]
    pub fn modulus(&self, bits: u32) -> u128 {
        modulus(self.get(&RADIX), bits)
    }

    /// Steps that a line of these ways, in BLU, takes by the method; `None` where the axes have no constant rates.
    #[must_use]
    pub fn steps(&self, travels: &[u64]) -> Option<u128> {
        let longest = travels.iter().copied().max().unwrap_or(0);
        match self.pace {
            Pace::Varying => None,
            Pace::Total => Some(travels.iter().map(|&travel| u128::from(travel)).sum()),
            Pace::Longest => Some(longest.into()),
            Pace::Cycle(_) if self.get(&NORMALIZE) => Some(1 << Width::needed_unsigned(longest.into())),
            Pace::Cycle(register) => Some(self.modulus(self.bits(register))),
        }
    }

    /// Preset of an axis's remainder register, in that register. A value that does not fit is kept, so that loading it
    /// is refused with its name.
    pub(crate) fn preset(&self, register: Reg) -> i128 {
        let preset = self.presets.get(register.axis()).copied().unwrap_or(Preset::Zero);
        match (preset, preset.value(self.modulus(self.bits(register)))) {
            (Preset::Value(value), None) => i128::from(value),
            (_, value) => i128::try_from(value.unwrap_or(0)).unwrap_or(0),
        }
    }

    /// What to do where this component overflows and no width helps.
    #[must_use]
    pub fn remedy(&self, component: &str) -> Option<&str> {
        self.remedies.iter().find(|(known, _)| *known == component).map(|(_, remedy)| remedy.as_str())
    }

    /// The register is widened together with others.
    #[must_use]
    pub fn shares_a_scale(&self, register: &str) -> bool {
        self.scale.contains(&register)
    }

    /// Bits of the fraction in a register of an integrator: those that the remainder of its axis has beyond `jrx`.
    pub(crate) fn fraction(&self, register: &str) -> u32 {
        let axis = AXES.iter().position(|axis| register.get(2..) == Some(*axis));
        axis.map_or(0, |axis| self.bits(JR.of(axis)).saturating_sub(self.bits(JR.of(0))))
    }

    /// What to give as `--width` for a register to have `bits`. Registers of one scale are widened together, to the
    /// `all` bits that the widest of them needs, where one alone would no longer fit the others; and the buffer of a register,
    /// `…_next`, with it.
    #[must_use]
    pub fn widening(&self, register: &str, bits: u32, all: u32) -> String {
        let leader = self.leaders.iter().find(|(follower, _)| *follower == register);
        let register = leader.map_or(register, |(_, leader)| leader);
        let buffered = register.strip_suffix("_next").filter(|own| self.widths.contains_key(own));
        let register = buffered.unwrap_or(register);
        let axis = (0..AXES.len()).find(|&axis| JV.of(axis).name() == register);
        let room = axis.map(|axis| self.bits(JR.of(axis)));
        let fits =
            room.is_some_and(|room| bits <= room) && !self.get(&NORMALIZE) && self.get(&ADDER) == Adder::Parallel;
        // Whole units of a pulse multiplier.
        let all = self.get(&CASCADE).map_or(all, |unit| all.next_multiple_of(unit.get()));
        if self.shares_a_scale(register) && !fits { all.to_string() } else { format!("{register}={bits}") }
    }

    /// How long it may be without a pulse is known.
    #[must_use]
    pub fn has_stall_clocks(&self) -> bool {
        self.stall_clocks < u64::MAX
    }

    /// Clocks of a step of at most one pulse of each axis that nothing delays, in the mean: the beats of a step, or the
    /// clocks from one pulse of a pulse source, or one addition of the fine stage of data sampling, to the next. `None`
    /// where they are not known.
    #[must_use]
    pub fn clocks_of_step(&self) -> Option<f64> {
        let Some(sampling) = &self.sampling else { return self.step_clocks.map(|clocks| clocks as f64) };
        Some(sampling.period_clocks() / self.modulus(self.bits(JR.of(0))) as f64)
    }

    /// Letters of the axes.
    #[must_use]
    pub fn letters(&self) -> &'static [&'static str] {
        &AXES[..self.axes]
    }
}

/// One more than the greatest number in `bits` bits.
pub(crate) fn modulus(radix: Radix, bits: u32) -> u128 {
    match radix {
        Radix::Binary => 1 << bits,
        Radix::Decimal => 10u128.pow(bits / radix.digit_bits()),
    }
}
