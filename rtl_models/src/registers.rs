//! Registers. Each is declared once, as a constant of the model or of the part that it belongs to, and a model lists
//! those that it has. Widths, columns of the step table, `stepwave list`, the names of `--width` and those of the
//! netlist follow from the declaration.
//!
//! ```
//! use stepwave_models::registers::{N, PerAxis, Reg};
//! use stepwave_models::per_axis;
//!
//! /// One register of n + 2 bits in two's complement.
//! const F: Reg = Reg::new("f", N.plus(2), "deviation F, from 0").signed();
//! /// One of n bits for each axis: `countx`, `county`, …
//! const COUNT: PerAxis = Reg::each(per_axis!("count"), N, "pulses of each axis");
//! assert_eq!((F.name(), COUNT.of(1).name()), ("f", "county"));
//! ```

use std::fmt;

use stepwave_netlist::formula::{Formula, name};

use crate::options::{OptionDef, Takes, Values};
use crate::plan::Plan;

/// Letters of up to nine axes.
pub const AXES: [&str; 9] = crate::per_axis!("");

/// The names of what every axis has one of: the letter of the axis between these two texts.
#[macro_export]
macro_rules! per_axis {
    ($before:literal) => {
        $crate::per_axis!($before, "")
    };
    ($before:literal, $after:literal) => {
        [
            concat!($before, "x", $after),
            concat!($before, "y", $after),
            concat!($before, "z", $after),
            concat!($before, "a", $after),
            concat!($before, "b", $after),
            concat!($before, "c", $after),
            concat!($before, "u", $after),
            concat!($before, "v", $after),
            concat!($before, "w", $after),
        ]
    };
}

/// Default width of a register.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Rule {
    /// This many bits more than a magnitude, which has n.
    Magnitude(u32),
    /// A number of bits that the user cannot change.
    Bits(u32),
    /// What the plan of the model [sets](Plan::set), in words: `as they need`.
    Planned(&'static str),
}

/// The n bits of a magnitude.
pub const N: Rule = Rule::Magnitude(0);

/// As many bits as what it holds needs.
pub(crate) const AS_NEEDED: Rule = Rule::Planned("as they need");

impl Rule {
    /// This many bits more; a planned width stays what the plan says.
    #[must_use]
    pub const fn plus(self, more: u32) -> Rule {
        match self {
            Rule::Magnitude(bits) => Rule::Magnitude(bits + more),
            Rule::Bits(bits) => Rule::Bits(bits + more),
            Rule::Planned(_) => self,
        }
    }
}

/// `n+2`
impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rule::Magnitude(0) => f.write_str("n"),
            Rule::Magnitude(more) => write!(f, "n+{more}"),
            Rule::Bits(bits) => write!(f, "{bits}"),
            Rule::Planned(words) => f.write_str(words),
        }
    }
}

/// When hardware has a register.
pub trait Condition: Sync {
    /// This hardware has it.
    fn holds(&self, plan: &Plan) -> bool;

    /// In words, by the values that a model takes: `--end-point total or longest`; empty where it always has it.
    fn words(&self, options: &'static [&'static dyn Takes]) -> String;
}

impl fmt::Debug for dyn Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&[]))
    }
}

/// With the values of an option of which this is true.
pub struct With<T: 'static>(pub &'static OptionDef<T>, pub fn(&T) -> bool);

impl<T: Clone + PartialEq + Send + Sync + 'static> Condition for With<T> {
    fn holds(&self, plan: &Plan) -> bool {
        (self.1)(&plan.get(self.0))
    }

    fn words(&self, options: &'static [&'static dyn Takes]) -> String {
        let With(option, is_so) = self;
        let Some(taken) = options.iter().find(|takes| takes.name() == option.name) else { return String::new() };
        let taken = taken.words();
        let known = match option.values {
            Values::Words(known) if !option.value_name.is_empty() => known,
            _ => return format!("--{}", option.name),
        };
        let so = known.iter().filter(|(word, value)| is_so(value) && taken.iter().any(|(taken, _)| taken == word));
        format!("--{} {}", option.name, so.map(|(word, _)| *word).collect::<Vec<_>>().join(" or "))
    }
}

/// Where this is true of the plan, which these words say.
pub struct Where(pub &'static str, pub fn(&Plan) -> bool);

impl Condition for Where {
    fn holds(&self, plan: &Plan) -> bool {
        (self.1)(plan)
    }

    fn words(&self, _: &'static [&'static dyn Takes]) -> String {
        self.0.to_owned()
    }
}

static ALWAYS: Where = Where("", |_| true);

/// What is said of registers that are declared together.
#[derive(Clone, Copy, Debug)]
pub struct Declaration {
    /// Default width of each.
    pub rule: Rule,
    /// What they hold, for `stepwave list`.
    pub about: &'static str,
    /// They are in two's complement; else unsigned, or decimal where the hardware is.
    pub signed: bool,
    /// The step table has a column for each.
    pub shown: bool,
    /// They start from `--preset`.
    pub preset: bool,
    /// They share one scale with all others that do, and are widened together.
    pub scaled: bool,
    /// Which hardware has them.
    pub when: &'static dyn Condition,
    /// How many of them it has at most.
    pub count: fn(&Plan) -> usize,
    /// Whether their width follows from that of others, so that the user cannot change it.
    pub follows: fn(&Plan) -> bool,
    /// The register as whose value they are used, and as wide as which they are, if they follow one.
    pub leader: Option<&'static str>,
}

/// A register, or K registers that are declared together; 9 are those of each [axis](PerAxis).
#[derive(Clone, Copy)]
pub struct Reg<const K: usize = 1> {
    names: [&'static str; K],
    axis: usize,
    declaration: Declaration,
}

/// A register for each axis.
pub type PerAxis = Reg<9>;

impl Reg {
    /// One register, unsigned and in the step table.
    #[must_use]
    pub const fn new(name: &'static str, rule: Rule, about: &'static str) -> Reg {
        Reg::each([name], rule, about)
    }

    /// Its name in the netlist, in waves and for `--width`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.names[0]
    }

    /// The axis that it belongs to, from 0, if it is one of [several](Reg::each).
    #[must_use]
    pub const fn axis(self) -> usize {
        self.axis
    }

    /// Its value in a formula.
    #[must_use]
    pub fn value(self) -> Formula {
        name(self.name())
    }
}

impl<const K: usize> Reg<K> {
    /// Several registers, unsigned and in the step table.
    #[must_use]
    pub const fn each(names: [&'static str; K], rule: Rule, about: &'static str) -> Reg<K> {
        let declaration = Declaration {
            rule,
            about,
            signed: false,
            shown: true,
            preset: false,
            scaled: false,
            when: &ALWAYS,
            count: if K == AXES.len() { Plan::axes } else { |_| K },
            follows: |_| false,
            leader: None,
        };
        Reg { names, axis: 0, declaration }
    }

    /// One of them, from 0.
    #[must_use]
    pub const fn of(self, index: usize) -> Reg {
        Reg { names: [self.names[index]], axis: index, declaration: self.declaration }
    }

    /// The first two of them: of the axes of a plane.
    #[must_use]
    pub const fn pair(self) -> Reg<2> {
        Reg { names: [self.names[0], self.names[1]], axis: 0, declaration: self.declaration }
    }

    /// With another default width.
    #[must_use]
    pub const fn width(mut self, rule: Rule) -> Reg<K> {
        self.declaration.rule = rule;
        self
    }

    /// With another text of what they hold.
    #[must_use]
    pub const fn about(mut self, about: &'static str) -> Reg<K> {
        self.declaration.about = about;
        self
    }

    /// In two's complement.
    #[must_use]
    pub const fn signed(mut self) -> Reg<K> {
        self.declaration.signed = true;
        self
    }

    /// Without a column in the step table.
    #[must_use]
    pub const fn hidden(mut self) -> Reg<K> {
        self.declaration.shown = false;
        self
    }

    /// Without a column in the step table, and as wide as other registers require.
    #[must_use]
    pub const fn inner(self) -> Reg<K> {
        self.hidden().follows(|_| true)
    }

    /// Started from `--preset`.
    #[must_use]
    pub const fn preset(mut self) -> Reg<K> {
        self.declaration.preset = true;
        self
    }

    /// On one scale with all others that are: they are widened together.
    #[must_use]
    pub const fn scaled(mut self) -> Reg<K> {
        self.declaration.scaled = true;
        self
    }

    /// Only in this hardware.
    #[must_use]
    pub const fn when(mut self, when: &'static dyn Condition) -> Reg<K> {
        self.declaration.when = when;
        self
    }

    /// Only the first of them, as many as this gives.
    #[must_use]
    pub const fn count(mut self, count: fn(&Plan) -> usize) -> Reg<K> {
        self.declaration.count = count;
        self
    }

    /// As wide as this register, which takes what they hold: without a choice of the user.
    #[must_use]
    pub const fn as_wide_as(mut self, leader: Reg) -> Reg<K> {
        self.declaration.leader = Some(leader.name());
        self.follows(|_| true)
    }

    /// As wide as other registers require, where this is true: without a choice of the user.
    #[must_use]
    pub const fn follows(mut self, follows: fn(&Plan) -> bool) -> Reg<K> {
        self.declaration.follows = follows;
        self
    }

    pub(crate) fn declaration(&self) -> &Declaration {
        &self.declaration
    }
}

impl PartialEq for Reg {
    fn eq(&self, other: &Reg) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Reg {}

/// `"jrx"`, or of several `["jrx", "jry"]`
impl<const K: usize> fmt::Debug for Reg<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [name] = &self.names[..] { fmt::Debug::fmt(name, f) } else { fmt::Debug::fmt(&self.names, f) }
    }
}

/// Registers that are declared together: a line of `stepwave list`.
#[derive(Clone, Copy, Debug)]
pub struct RegisterGroup {
    pub(crate) names: &'static [&'static str],
    /// What is said of them.
    pub declaration: &'static Declaration,
}

impl RegisterGroup {
    /// The names of those that hardware of this many axes has.
    #[must_use]
    pub fn names(self, axes: usize) -> &'static [&'static str] {
        if self.names.len() == AXES.len() { &self.names[..axes.min(AXES.len())] } else { self.names }
    }

    /// Their names in a list; where they are many, the first: `jvx, jvy, …`.
    #[must_use]
    pub fn label(self, axes: usize) -> String {
        match self.names(axes) {
            few if few.len() <= 3 => few.join(", "),
            many => format!("{}, …", many[..2].join(", ")),
        }
    }
}

/// What a model has in its list of registers: one, several that are declared together, or two of each axis, whose
/// columns take turns.
pub trait Declared: Sync {
    /// The registers that are declared together: `first` or, if there are two for each axis, `second`.
    fn rows(&'static self) -> (RegisterGroup, Option<RegisterGroup>);
}

impl<const K: usize> Declared for Reg<K> {
    fn rows(&'static self) -> (RegisterGroup, Option<RegisterGroup>) {
        (RegisterGroup { names: &self.names, declaration: &self.declaration }, None)
    }
}

impl<const K: usize> Declared for (Reg<K>, Reg<K>) {
    fn rows(&'static self) -> (RegisterGroup, Option<RegisterGroup>) {
        (self.0.rows().0, Some(self.1.rows().0))
    }
}

impl fmt::Debug for dyn Declared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("registers")
    }
}

/// The registers of a model.
pub type Registers = &'static [&'static dyn Declared];

/// The rows of a list.
pub(crate) fn rows(registers: Registers) -> impl Iterator<Item = RegisterGroup> {
    registers.iter().flat_map(|declared| {
        let (first, second) = declared.rows();
        [Some(first), second].into_iter().flatten()
    })
}
