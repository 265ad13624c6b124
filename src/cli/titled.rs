//! The options of a command whose help begins with the line that lists it.

use std::ops::Deref;

use clap::{ArgMatches, Args, Command, FromArgMatches};

/// Options that leave the command its own title: those that are shared have a description of their own, which would take
/// its place.
#[derive(Debug)]
pub(crate) struct Titled<T>(T);

impl<T> Deref for Titled<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: Args> Args for Titled<T> {
    fn augment_args(command: Command) -> Command {
        let title = command.get_about().cloned().unwrap_or_default();
        T::augment_args(command).about(title).long_about(None)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Titled::<T>::augment_args(command)
    }
}

impl<T: FromArgMatches> FromArgMatches for Titled<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Titled<T>, clap::Error> {
        T::from_arg_matches(matches).map(Titled)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        self.0.update_from_arg_matches(matches)
    }
}
