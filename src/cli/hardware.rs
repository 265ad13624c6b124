//! Hardware options on the command line: those of the table, and the feed in the units of a machine.

use crate::models::options::{AnyOption, Options, STEP, SYSTEM, Shape, TOLERANCE, Value, WIDTH, all};
use crate::models::{Millionths, ModelError};
use crate::program::ProgramFailure;
use crate::study::proof::ProofError;
use clap::builder::{PossibleValuesParser, TypedValueParser, ValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};

use super::names::{all_widths, listed};
use super::values::{parse_blu, parse_feed};
use crate::Error;

/// Hardware options of one machine.
#[derive(Debug)]
pub(crate) struct HardwareArgs {
    given: Options,
    feed: Option<f64>,
    /// One BLU in millimetres.
    pub(crate) blu: f64,
}

/// What gives a displacement and lengths their units.
#[derive(Debug, Args)]
struct UnitArgs {
    /// Feed in mm/min, which with --system and --blu gives the way of a period
    #[arg(long, value_name = "MM/MIN", value_parser = parse_feed, conflicts_with = STEP.name)]
    feed: Option<f64>,
    /// Length of one BLU, which gives --feed its way, and lengths of the report theirs
    #[arg(long, value_name = "LENGTH", default_value = "0.001mm", value_parser = parse_blu)]
    blu: f64,
}

/// The words that a shell proposes for an option: values, and registers where only these are given values.
pub(super) fn proposals(option: &dyn AnyOption) -> Vec<String> {
    match option.shape() {
        Shape::Words(words) => words.into_iter().map(str::to_owned).collect(),
        Shape::PerRegister { words: [], .. } => all_widths(),
        Shape::PerRegister { words, .. } => words.iter().map(|&word| word.to_owned()).collect(),
        _ => Vec::new(),
    }
}

fn arg(option: &'static dyn AnyOption) -> Arg {
    let arg = Arg::new(option.name()).long(option.name()).help(option.help());
    let arg = if option.name() == WIDTH.name { arg.short('w') } else { arg };
    if option.value_name().is_empty() {
        return arg.action(ArgAction::SetTrue);
    }
    let parse = move |text: &str| option.parse(text);
    let (parser, several) = match option.shape() {
        Shape::Words(words) => {
            (ValueParser::new(PossibleValuesParser::new(words).try_map(move |word| option.parse(&word))), false)
        }
        Shape::PerRegister { .. } => (ValueParser::new(listed(parse, proposals(option))), true),
        _ => (ValueParser::new(parse), false),
    };
    arg.value_name(option.value_name()).value_parser(parser).hide_possible_values(several).action(if several {
        ArgAction::Append
    } else {
        ArgAction::Set
    })
}

impl Args for HardwareArgs {
    fn augment_args(command: Command) -> Command {
        let heading = "Hardware (each model takes some; `stepwave list` shows which)";
        let command = command.next_help_heading(heading).args(all().iter().map(|option| arg(*option)));
        UnitArgs::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        HardwareArgs::augment_args(command)
    }
}

impl FromArgMatches for HardwareArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<HardwareArgs, clap::Error> {
        let UnitArgs { feed, blu } = UnitArgs::from_arg_matches(matches)?;
        let mut given = Options::default();
        for option in all() {
            let text = if option.value_name().is_empty() {
                matches.get_flag(option.name()).then(|| "yes".to_owned())
            } else {
                // Of widths, each occurrence may give some registers.
                let values = matches.get_many::<Value>(option.name());
                values.map(|values| values.map(Value::text).collect::<Vec<_>>().join(","))
            };
            let value = text.map(|text| option.parse(&text)).transpose();
            let value = value.map_err(|reason| clap::Error::raw(clap::error::ErrorKind::ValueValidation, reason))?;
            value.into_iter().for_each(|value| given.set(value));
        }
        Ok(HardwareArgs { given, feed, blu })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = HardwareArgs::from_arg_matches(matches)?;
        Ok(())
    }
}

impl HardwareArgs {
    /// A model's error in the words of this command line: a feed gives the way of a period, which is an option of its own.
    pub(crate) fn explain(&self, error: impl Into<ProgramFailure>) -> Error {
        match error.into() {
            ProgramFailure::Model(ModelError::NotTaken { model, option, takes })
                if option == STEP.name && self.feed.is_some() =>
            {
                Error::Invalid(format!("{model} does not take --feed; it takes {takes}"))
            }
            ProgramFailure::Model(error @ ModelError::Value { option, .. }) if option == STEP.name => match self.feed {
                Some(feed) => {
                    Error::Invalid(format!("--feed {feed} gives the way of a period, as --step does: {error}"))
                }
                None => error.into(),
            },
            other => other.into(),
        }
    }

    /// As [`explain`](Self::explain), of a study of the model.
    pub(crate) fn explain_study(&self, error: ProofError) -> Error {
        match error {
            ProofError::Model(error) => self.explain(error),
            other => other.into(),
        }
    }

    /// The name of an option that is given, if one is.
    pub(crate) fn first_given(&self) -> Option<&'static str> {
        let given = self.given.given().first().map(|value| value.option().name());
        given.or(self.feed.map(|_| "feed"))
    }

    /// The options given, for a clock of this frequency in Hz.
    pub(crate) fn choices_at(&self, clock_hz: f64) -> Options {
        self.choices().at_clock(clock_hz).in_blu(self.blu)
    }

    /// How far the two radii of an arc may differ beyond what rounding makes, in BLU.
    pub(crate) fn radii(&self) -> f64 {
        self.given.value(&TOLERANCE).map_or(0.0, Millionths::units)
    }

    /// The options given.
    pub(crate) fn choices(&self) -> Options {
        let Some(feed) = self.feed else { return self.given.clone() };
        let travel = feed / 60.0 * self.given.value(&SYSTEM).period() / self.blu;
        // What is beyond all measure is refused by its length.
        self.given.clone().with(&STEP, Some(Millionths::nearest(travel).unwrap_or(Millionths(1 << 60))))
    }
}
