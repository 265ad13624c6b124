//! What a user gives: some options, each with a value.

use std::any::Any;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use super::{ALL, AnyOption, Millionths, OptionDef, PerRegister};

/// A value of an option, with its text.
#[derive(Clone)]
pub struct Value {
    pub(super) option: &'static dyn AnyOption,
    pub(super) text: Arc<str>,
    pub(super) typed: Arc<dyn Any + Send + Sync>,
}

impl Value {
    /// The option.
    #[must_use]
    pub fn option(&self) -> &'static dyn AnyOption {
        self.option
    }

    /// The value as one gives it on the command line; of an option without a value, `yes` or `no`.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The value says that there is nothing of the kind, which is as if it was not given.
    fn is_absence(&self) -> bool {
        matches!(&*self.text, "" | "no" | "none")
    }
}

/// `--beats 1`
impl fmt::Debug for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "--{} {}", self.option.name(), self.text)
    }
}

impl PartialEq for Value {
    fn eq(&self, other: &Value) -> bool {
        self.option.name() == other.option.name() && self.text == other.text
    }
}

impl Eq for Value {}

/// Hardware options as a user gives them; what is not given is as the model has it by default.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Options {
    /// In the order of [`ALL`]; options that are not in it come after those that are.
    given: Vec<Value>,
    /// Frequency of the clock in Hz, by which data sampling divides it; if none, the least with which it keeps its
    /// period.
    pub clock_hz: Option<Millionths>,
    /// Length of one BLU in mm, by which speeds get their units; if none, 0.001.
    pub blu_mm: Option<f64>,
}

/// Place in the order of the table.
fn rank(option: &dyn AnyOption) -> usize {
    ALL.iter().position(|known| known.name() == option.name()).unwrap_or(ALL.len())
}

impl Options {
    /// All by default, with the clock of 1 MHz that commands have where none is given.
    #[must_use]
    pub fn at_1_mhz() -> Options {
        Options::default().at_clock(1e6)
    }

    /// With a clock of this frequency in Hz.
    #[must_use]
    pub fn at_clock(self, hz: f64) -> Options {
        Options { clock_hz: Some(Millionths::saturating(hz)), ..self }
    }

    /// With a BLU of this many millimetres.
    #[must_use]
    pub fn in_blu(self, mm: f64) -> Options {
        Options { blu_mm: Some(mm), ..self }
    }

    /// The options of a command line: `["--beats", "1", "--normalize"]`.
    ///
    /// # Errors
    /// A sentence: a word is not an option of the installed models, or what comes after it is not a value of it.
    pub fn parse<'a>(words: impl IntoIterator<Item = &'a str>) -> Result<Options, String> {
        let mut options = Options::default();
        let mut words = words.into_iter();
        while let Some(word) = words.next() {
            let option =
                word.strip_prefix("--").and_then(|name| super::all().iter().find(|option| option.name() == name));
            let option = option.ok_or_else(|| format!("'{word}' is not a hardware option"))?;
            let text = if option.value_name().is_empty() { Some("yes") } else { words.next() };
            options.set(option.parse(text.ok_or_else(|| format!("{word} lacks its value"))?)?);
        }
        Ok(options)
    }

    /// With this value of an option, or without the option.
    #[must_use]
    pub fn with<T: Clone + PartialEq + Send + Sync + 'static>(
        mut self,
        option: &'static OptionDef<T>,
        value: impl Into<Option<T>>,
    ) -> Options {
        match value.into() {
            Some(value) => self.set(option.value(value)),
            None => return self.without(option),
        }
        self
    }

    /// Without an option.
    #[must_use]
    pub fn without(mut self, option: &dyn AnyOption) -> Options {
        self.given.retain(|value| value.option.name() != option.name());
        self
    }

    /// Sets the value of an option in place of one given before.
    pub fn set(&mut self, value: Value) {
        self.given.retain(|given| given.option.name() != value.option.name());
        if value.is_absence() {
            return;
        }
        let place = self.given.partition_point(|given| rank(given.option) <= rank(value.option));
        self.given.insert(place, value);
    }

    /// The value given for an option.
    #[must_use]
    pub fn get<T: 'static>(&self, option: &OptionDef<T>) -> Option<&T> {
        let value = self.given.iter().find(|value| value.option.name() == option.name)?;
        value.typed.downcast_ref()
    }

    /// The value given for an option, or its default.
    #[must_use]
    pub fn value<T: Clone + 'static>(&self, option: &OptionDef<T>) -> T {
        self.get(option).unwrap_or(&option.default).clone()
    }

    /// The values given, in the order of the table.
    #[must_use]
    pub fn given(&self) -> &[Value] {
        &self.given
    }

    /// The words that give these options on a command line, in the order of the table.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let words = self.given.iter().flat_map(|value| {
            let text = (!value.option.value_name().is_empty()).then(|| value.text.to_string());
            [Some(format!("--{}", value.option.name())), text]
        });
        words.flatten().collect()
    }

    /// What is given for all registers.
    #[must_use]
    pub fn of_all<T: Clone + 'static>(&self, option: &OptionDef<PerRegister<T>>) -> Option<T> {
        self.get(option).and_then(|given| given.all.clone())
    }

    /// What is given for single registers, or for all of a kind (`jr` is `jrx`, `jry`, …).
    #[must_use]
    pub fn of_single<T: Clone + 'static>(&self, option: &OptionDef<PerRegister<T>>) -> BTreeMap<String, T> {
        self.get(option).map(|given| given.single.clone()).unwrap_or_default()
    }

    /// With this value for all registers, or without one; those for single registers stay.
    #[must_use]
    pub fn with_all<T: Clone + PartialEq + Send + Sync + 'static>(
        self,
        option: &'static OptionDef<PerRegister<T>>,
        value: impl Into<Option<T>>,
    ) -> Options {
        let single = self.of_single(option);
        self.with(option, PerRegister { all: value.into(), single })
    }

    /// With these values for single registers in place of others; that for all stays.
    #[must_use]
    pub fn with_single<T: Clone + PartialEq + Send + Sync + 'static>(
        self,
        option: &'static OptionDef<PerRegister<T>>,
        single: BTreeMap<String, T>,
    ) -> Options {
        let all = self.of_all(option);
        self.with(option, PerRegister { all, single })
    }

    /// With this value for one register, or for all of a kind.
    #[must_use]
    pub fn with_one<T: Clone + PartialEq + Send + Sync + 'static>(
        self,
        option: &'static OptionDef<PerRegister<T>>,
        register: &str,
        value: T,
    ) -> Options {
        let mut single = self.of_single(option);
        single.insert(register.to_owned(), value);
        self.with_single(option, single)
    }
}
