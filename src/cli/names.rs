//! Names that shells complete: models, registers, and the values of lists. What is given is judged elsewhere, so that a
//! wrong name has the sentence of the table with the right ones.

use std::collections::BTreeSet;
use std::ffi::OsStr;

use crate::models::registers::{RegisterGroup, Rule};
use crate::models::{AXES, Model, ModelError, installed};
use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Command, Error};

/// A parser whose values a shell can propose.
#[derive(Clone)]
pub(crate) struct Listed<P> {
    inner: P,
    words: Vec<String>,
}

impl<P: TypedValueParser> TypedValueParser for Listed<P> {
    type Value = P::Value;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<P::Value, Error> {
        self.inner.parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.words.iter().map(PossibleValue::new)))
    }
}

/// What a parser takes, with words to propose.
pub(crate) fn listed<P: TypedValueParser>(inner: P, words: Vec<String>) -> Listed<P> {
    Listed { inner, words }
}

/// The name of a model.
pub(crate) fn model_name() -> Listed<StringValueParser> {
    let names = installed().iter().map(|model| model.name.to_owned());
    listed(StringValueParser::new(), names.collect())
}

/// Which registers are meant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Registers {
    All,
    /// Those whose width is a choice.
    Resizable,
}

/// Registers of a model: those of each axis for every axis that it takes.
pub(crate) fn registers(model: &Model, which: Registers) -> Vec<String> {
    let fixed = |row: &RegisterGroup| matches!(row.declaration.rule, Rule::Bits(_));
    let rows = model.rows().filter(|row| which == Registers::All || !fixed(row));
    // Of the many units of a cascade the first are enough.
    let few = |names: &'static [&'static str]| if names.len() > 2 * AXES.len() { &names[..2] } else { names };
    let names = rows.flat_map(|row| few(row.names(model.curve().max_axes())));
    names.map(|name| (*name).to_owned()).collect()
}

/// Registers of all models, as patterns of signals.
pub(crate) fn all_registers() -> Vec<String> {
    of_all_models(Registers::All, "")
}

/// Registers of all models whose width is a choice, with the sign that follows them there.
pub(crate) fn all_widths() -> Vec<String> {
    of_all_models(Registers::Resizable, "=")
}

fn of_all_models(which: Registers, suffix: &str) -> Vec<String> {
    let names: BTreeSet<String> = installed().iter().flat_map(|model| registers(model, which)).collect();
    names.into_iter().map(|name| name + suffix).collect()
}

/// Refuses the name of a register that a model has for no geometry; a name without its axis letter or number stands for
/// several.
pub(crate) fn known_register(model: &Model, option: &'static str, given: &str) -> Result<(), ModelError> {
    let kind = |name: &str| name.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
    let of_axes = |name: &str| AXES.iter().any(|axis| name.strip_suffix(axis) == Some(given));
    let known = registers(model, Registers::Resizable);
    if known.iter().any(|name| name == given || of_axes(name) || kind(name) == kind(given)) {
        return Ok(());
    }
    Err(ModelError::UnknownRegister { model: model.name, option, register: given.to_owned(), known: known.join(", ") })
}
