//! Hardware options. Each is declared once, in the table of [`ALL`]; the command line, lists of models, sweeps, titles,
//! JSON and the command that repeats a run interpret the declaration.
//!
//! ```
//! use stepwave_models::Options;
//! use stepwave_models::options::{BEATS, Beats};
//!
//! let typed = Options::default().with(&BEATS, Beats::One);
//! assert_eq!(typed, Options::parse(["--beats", "1"])?);
//! assert_eq!(typed.words(), ["--beats", "1"]);
//! # Ok::<(), String>(())
//! ```

mod choices;
mod given;
mod table;
mod taken;
mod values;

use std::any::Any;
use std::fmt;
use std::sync::Arc;

pub use choices::{Adder, Beats, Brake, Compare, EndPoint, Form, Radix, RampAt, Smooth, System, Weights};
pub use given::{Options, Value};
pub use table::{
    ACCEL, ADDER, ALL, BEATS, BRAKE, CASCADE, COMPARE, DIVISIONS, END_POINT, FORM, FRACTION, JERK, NORMALIZE,
    ON_OVERFLOW, OVERRIDE, PERIOD, PICK_OFF, PRESET, RADIX, RAMP, SMOOTH, SPEED, STEP, STRICT, SYSTEM, TIMING,
    TOLERANCE, WEIGHTS, WIDTH, WRAPS,
};
pub use taken::{Taken, Takes, With};
pub(crate) use taken::{chosen, taken};
pub use values::{Gains, Millionths, Named, PerRegister, Preset, Quantity, StepTiming};

/// One hardware option with values of the type T.
pub struct OptionDef<T: 'static> {
    /// Name on the command line, without its dashes: `end-point`.
    pub name: &'static str,
    /// What it is, for `--help`: a line without a full stop.
    pub help: &'static str,
    /// Placeholder of a value in `--help`; empty where the option is given without one and means `yes`.
    pub value_name: &'static str,
    /// What may be given.
    pub values: Values<T>,
    /// What values there are, and the default, for people; empty where the words say it.
    pub about: &'static str,
    /// What holds where nothing is given and the model has no default of its own.
    pub default: T,
}

/// What may be given for an option.
pub enum Values<T: 'static> {
    /// One of these words.
    Words(&'static [(&'static str, T)]),
    /// Whatever `parse` takes.
    Parsed {
        /// What its values are like, for lists of them.
        shape: Shape,
        /// The value of a text, or a sentence that says what is wrong with it.
        parse: fn(&str) -> Result<T, String>,
        /// The text of a value, which `parse` takes.
        text: fn(&T) -> String,
    },
}

/// The shape of an option's values, by which a list of them is split.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Shape {
    /// Words.
    Words(Vec<&'static str>),
    /// Whole numbers, of which a range may be given.
    Numbers {
        /// Least number.
        least: u64,
        /// Greatest number.
        most: u64,
        /// `none` may be given too.
        none: bool,
        /// For a message: `percentages from 1 to 99`.
        values: &'static str,
    },
    /// Words or whole numbers, for all registers or, after `NAME=`, for one; of numbers a range may be given.
    PerRegister {
        /// Words that may be given.
        words: &'static [&'static str],
        /// Least number.
        least: u64,
        /// Greatest number.
        most: u64,
        /// For a message: `bits from 1 to 64, such as 8..12 or f=9..11`.
        values: &'static str,
    },
    /// Texts without a comma.
    Text {
        /// For a message: `lengths in BLU such as 8,102.4`.
        values: &'static str,
        /// Some of them, with which hardware has every register that it can have.
        some: &'static [&'static str],
    },
    /// Texts with commas of their own: a list gives the option several times, or a range of whole numbers.
    Commas,
}

/// An option, with values of any type.
pub trait AnyOption: Sync {
    /// Name on the command line, without its dashes.
    fn name(&self) -> &'static str;
    /// What it is: a line without a full stop.
    fn help(&self) -> &'static str;
    /// Placeholder of a value in `--help`; empty where the option is given without one.
    fn value_name(&self) -> &'static str;
    /// What its values are like.
    fn shape(&self) -> Shape;
    /// The text of the default.
    fn default_text(&self) -> String;
    /// The value of a text.
    ///
    /// # Errors
    /// A sentence that says what is wrong with it.
    fn parse(&'static self, text: &str) -> Result<Value, String>;
}

/// Every option of the [installed](crate::installed) models, in the order of the command line.
#[must_use]
pub fn all() -> &'static [&'static dyn AnyOption] {
    crate::installed().options()
}

impl fmt::Debug for dyn AnyOption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "--{}", self.name())
    }
}

impl<T: Clone + PartialEq + Send + Sync + 'static> OptionDef<T> {
    /// A value with its text.
    #[must_use]
    pub fn value(&'static self, value: T) -> Value {
        let text = self.text(&value);
        Value { option: self, text: text.into(), typed: Arc::new(value) as Arc<dyn Any + Send + Sync> }
    }

    /// The text of a value.
    #[must_use]
    pub fn text(&self, value: &T) -> String {
        match &self.values {
            Values::Words(words) => {
                let word = words.iter().find(|(_, known)| known == value);
                word.map_or_else(String::new, |(word, _)| (*word).to_owned())
            }
            Values::Parsed { text, .. } => text(value),
        }
    }
}

impl<T: Clone + PartialEq + Send + Sync + 'static> AnyOption for OptionDef<T> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn help(&self) -> &'static str {
        self.help
    }

    fn value_name(&self) -> &'static str {
        self.value_name
    }

    fn shape(&self) -> Shape {
        match &self.values {
            Values::Words(words) => Shape::Words(words.iter().map(|(word, _)| *word).collect()),
            Values::Parsed { shape, .. } => shape.clone(),
        }
    }

    fn default_text(&self) -> String {
        self.text(&self.default)
    }

    fn parse(&'static self, text: &str) -> Result<Value, String> {
        match &self.values {
            Values::Words(words) => {
                let known = words.iter().find(|(word, _)| *word == text).map(|(_, value)| value.clone());
                let list = || words.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
                known.map(|value| self.value(value)).ok_or_else(|| format!("'{text}' is not a value: give {}", list()))
            }
            Values::Parsed { parse, .. } => parse(text).map(|value| self.value(value)),
        }
    }
}
