//! Why a model cannot be built or loaded for a geometry.

use stepwave_netlist::diag::{Code, Diagnostic};
use stepwave_netlist::{Diagnostics, HasMemories, Width, did_you_mean};

/// A geometry or an option that a model does not take; every message names the value, the limit and the remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// No model has this name.
    #[error("there is no model '{name}'{}; the models are {known}", did_you_mean(.name, .known.split(", ")))]
    UnknownModel {
        /// Name asked for.
        name: String,
        /// Names that exist, with commas.
        known: String,
    },
    /// A line was given to a model of arcs, or vice versa.
    #[error("{model} interpolates {takes}; {given} was given")]
    Curve {
        /// The model.
        model: &'static str,
        /// What it takes, with the options that give it.
        takes: &'static str,
        /// What was given.
        given: String,
    },
    /// An option that the model does not have.
    #[error("{model} does not take --{option}; it takes {takes}")]
    NotTaken {
        /// The model.
        model: &'static str,
        /// The option, without its dashes.
        option: &'static str,
        /// Options that it takes.
        takes: String,
    },
    /// An event for which the hardware has no input.
    #[error(
        "{model} has no input for the event '{event}': hold, resume and override act on ramps, of `ramp` or of a \
             program with --accel or --ramp after, and single and start on such programs"
    )]
    NoEvents {
        /// The model.
        model: &'static str,
        /// The event.
        event: String,
    },
    /// A value of an option that the model does not have.
    #[error("{model} does not take --{option} {value}: {reason}")]
    Value {
        /// The model.
        model: &'static str,
        /// The option, without its dashes.
        option: &'static str,
        /// The value given.
        value: String,
        /// Why, and what it takes instead.
        reason: String,
    },
    /// `--width` or `--preset` names a register that does not exist here.
    #[error("{model} has no register '{register}' here for --{option}{}; it has {known}",
        did_you_mean(.register, .known.split(", ")))]
    UnknownRegister {
        /// The model.
        model: &'static str,
        /// The option that names it, without its dashes.
        option: &'static str,
        /// The name given.
        register: String,
        /// Names that exist, with commas.
        known: String,
    },
    /// A register would be wider than a netlist allows.
    #[error("register {register} would be {bits} bits wide, but a register holds 1 to 64 bits: {remedy}")]
    TooWide {
        /// The register.
        register: String,
        /// Bits that it would have.
        bits: u64,
        /// What to change.
        remedy: String,
    },
    /// A load value does not fit in its register.
    #[error("{register} = {value} does not fit in its {width}; {needed} bits would hold it: give --width {option}")]
    DoesNotFit {
        /// The register.
        register: String,
        /// Value to be loaded.
        value: i128,
        /// Width of the register.
        width: Width,
        /// Bits that would hold it.
        needed: u32,
        /// What to give as `--width`.
        option: String,
    },
    /// Registers that must be equally wide, or ordered, are not.
    #[error("{0}")]
    Widths(String),
    /// A model that cannot be installed: a defect of the model.
    #[error("the model {model} does not work: {what}")]
    Defect {
        /// The model.
        model: &'static str,
        /// What is wrong with it.
        what: String,
    },
    /// A model describes a netlist that does not elaborate: a defect of the model.
    #[error("the model's netlist is wrong; please report this:\n{0}")]
    Netlist(Diagnostics),
    /// The netlist has a memory, and what is asked for takes none.
    #[error(transparent)]
    Memories(#[from] HasMemories),
    /// A model lacks a port that every machine has: a defect of the model.
    #[error("the model has no net named {0}; please report this")]
    MissingPort(String),
}

impl ModelError {
    pub(crate) fn defect(model: &'static str, what: String) -> ModelError {
        ModelError::Defect { model, what }
    }
}

impl From<Diagnostics> for ModelError {
    fn from(diagnostics: Diagnostics) -> ModelError {
        // The widths chosen may lead to one that is too great, such as an exact sum of f in 4 bits and xe in 64; a
        // width of 0 is that of a register that the model did not plan.
        let too_wide = |diagnostic: &&Diagnostic| {
            diagnostic.code == Code::BadWidth && !diagnostic.message.contains("a width of 0 bits")
        };
        match diagnostics.0.iter().find(too_wide) {
            Some(diagnostic) => ModelError::Widths(format!(
                "these registers are too wide to be added: {}: change --width",
                diagnostic.message
            )),
            None => ModelError::Netlist(diagnostics),
        }
    }
}
