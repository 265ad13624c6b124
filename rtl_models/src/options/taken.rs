//! An option as a model takes it: with all of its values, or with some.

use std::fmt;

use super::{AnyOption, OptionDef, Options, Shape, Value, Values};
use crate::error::ModelError;

/// An option in a model's list.
pub trait Takes: Sync {
    /// Name of the option, without its dashes.
    fn name(&self) -> &'static str;
    /// The option.
    fn option(&'static self) -> &'static dyn AnyOption;
    /// The values that the model takes, if they are words: each with what is to be said of it.
    fn words(&'static self) -> Vec<(&'static str, &'static str)>;
    /// The value where none is given; `None` where it depends on the curve.
    fn default_value(&'static self) -> Option<Value>;
    /// The default of the model, where it is not that of the option.
    fn own_default(&'static self) -> Option<Value>;
    /// What values there are, and the default, for people: `4 (default) | 1`.
    fn about(&'static self) -> String;
    /// Why the model does not take this value, if it does not.
    fn refusal(&'static self, value: &Value) -> Option<String>;
    /// Why it does nothing with these other options, if it does not.
    fn idle(&'static self, others: &Options) -> Option<&'static str>;
}

/// Whether an option does something with these others.
pub type With = fn(&Options) -> bool;

/// Some values of an option, or all with a text of the model's own.
pub struct Taken<T: 'static> {
    option: &'static OptionDef<T>,
    default: Option<T>,
    /// Those taken, each with what is to be said of it.
    words: &'static [(T, &'static str)],
    /// For people, where the values are not words.
    about: &'static str,
    /// Why not the others.
    why_not: &'static str,
    /// With which other options it does something, and what to do else.
    counts: Option<(With, &'static str)>,
}

impl<T> OptionDef<T> {
    /// Only these values, each with what is to be said of it; the default, unless it depends on the curve; and why not
    /// the others.
    #[must_use]
    pub const fn only(
        &'static self,
        default: Option<T>,
        words: &'static [(T, &'static str)],
        why_not: &'static str,
    ) -> Taken<T> {
        Taken { option: self, default, words, about: "", why_not, counts: None }
    }

    /// All values, with what they are here in `about`, and the default.
    #[must_use]
    pub const fn about(&'static self, about: &'static str) -> Taken<T> {
        Taken { option: self, default: None, words: &[], about, why_not: "", counts: None }
    }

    /// All values, where other options are so that it does something; given else it is refused with this reason.
    #[must_use]
    pub const fn counts(&'static self, with: With, reason: &'static str) -> Taken<T> {
        Taken { option: self, default: None, words: &[], about: "", why_not: "", counts: Some((with, reason)) }
    }
}

/// `4 (default) | 1`
fn listed(words: Vec<(&'static str, &'static str)>, default: Option<Value>) -> String {
    let default = default.map(|value| value.text);
    let word = |(word, note): &(&str, &str)| {
        let mark = if default.as_deref() == Some(*word) { " (default)" } else { "" };
        format!("{word}{mark}{note}")
    };
    words.iter().map(word).collect::<Vec<_>>().join(" | ")
}

impl fmt::Debug for dyn Takes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "--{}", self.name())
    }
}

impl<T: Clone + PartialEq + Send + Sync + 'static> Takes for OptionDef<T> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn option(&'static self) -> &'static dyn AnyOption {
        self
    }

    fn words(&'static self) -> Vec<(&'static str, &'static str)> {
        match self.shape() {
            Shape::Words(words) => words.into_iter().map(|word| (word, "")).collect(),
            _ => Vec::new(),
        }
    }

    fn default_value(&'static self) -> Option<Value> {
        matches!(self.values, Values::Words(_)).then(|| self.value(self.default.clone()))
    }

    fn own_default(&'static self) -> Option<Value> {
        None
    }

    fn about(&'static self) -> String {
        if self.about.is_empty() { listed(self.words(), self.default_value()) } else { self.about.to_owned() }
    }

    fn refusal(&'static self, _: &Value) -> Option<String> {
        None
    }

    fn idle(&'static self, _: &Options) -> Option<&'static str> {
        None
    }
}

impl<T: Clone + PartialEq + Send + Sync + 'static> Takes for Taken<T> {
    fn name(&self) -> &'static str {
        self.option.name
    }

    fn option(&'static self) -> &'static dyn AnyOption {
        self.option
    }

    fn words(&'static self) -> Vec<(&'static str, &'static str)> {
        if self.words.is_empty() {
            return self.option.words();
        }
        let Values::Words(all) = self.option.values else { return Vec::new() };
        let named = |(value, note): &(T, &'static str)| {
            let word = all.iter().find(|(_, known)| known == value);
            word.map(|(word, _)| (*word, *note))
        };
        self.words.iter().filter_map(named).collect()
    }

    fn default_value(&'static self) -> Option<Value> {
        if self.words.is_empty() {
            return self.option.default_value();
        }
        self.default.clone().map(|value| self.option.value(value))
    }

    fn own_default(&'static self) -> Option<Value> {
        self.default.clone().filter(|value| *value != self.option.default).map(|value| self.option.value(value))
    }

    fn about(&'static self) -> String {
        match (self.about, self.words) {
            ("", []) => Takes::about(self.option),
            ("", _) => listed(self.words(), self.default_value()),
            (about, _) => about.to_owned(),
        }
    }

    fn idle(&'static self, others: &Options) -> Option<&'static str> {
        self.counts.filter(|(with, _)| !with(others)).map(|(_, reason)| reason)
    }

    fn refusal(&'static self, value: &Value) -> Option<String> {
        let words = self.words();
        if words.is_empty() || words.iter().any(|(word, _)| **word == *value.text) {
            return None;
        }
        let list: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        Some(format!("{}; it takes {}", self.why_not, list.join(", ")))
    }
}

/// The entry of an option in a model's list.
///
/// # Errors
/// The model does not take it.
pub(crate) fn taken(
    model: &'static str,
    list: &'static [&'static dyn Takes],
    option: &'static dyn AnyOption,
) -> Result<&'static dyn Takes, ModelError> {
    list.iter().copied().find(|takes| takes.name() == option.name()).ok_or_else(|| {
        let takes: Vec<_> = list.iter().map(|takes| format!("--{}", takes.name())).collect();
        ModelError::NotTaken { model, option: option.name(), takes: takes.join(", ") }
    })
}

/// The options given to a model, with its own defaults for those that are not.
///
/// # Errors
/// The model does not take an option, or not this value of it.
pub(crate) fn chosen(
    model: &'static str,
    list: &'static [&'static dyn Takes],
    given: &Options,
) -> Result<Options, ModelError> {
    let mut chosen = given.clone();
    for value in given.given() {
        let option = value.option();
        let takes = taken(model, list, option)?;
        if let Some(reason) = takes.refusal(value).or_else(|| takes.idle(given).map(str::to_owned)) {
            return Err(ModelError::Value { model, option: option.name(), value: value.text().to_owned(), reason });
        }
    }
    let missing = |value: &Value| given.given().iter().all(|given| given.option().name() != value.option().name());
    list.iter().filter_map(|takes| takes.own_default()).filter(missing).for_each(|value| chosen.set(value));
    Ok(chosen)
}
