//! The program: parse, dispatch, print the error, set the exit code.

use std::ffi::OsString;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};

use clap::CommandFactory;

use crate::Error;
use crate::cli::{Cli, by_ending, by_value, help_of_model, usage, with_signs};
use crate::models::Catalogue;
use crate::{commands, output, stop};

/// Most threads of a computation for each core.
const MOST_THREADS_A_CORE: usize = 8;

/// The program `stepwave` over these models: parses the command line, does what it says, prints an error.
///
/// Exit codes: 0 done and good; 1 the simulated hardware failed a check or a comparison differs; 2 bad input, a model
/// that does not work, or a file that cannot be read or written.
///
/// ```no_run
/// # use stepwave::models::Model;
/// fn commands(own: &'static Model) -> std::process::ExitCode {
///     stepwave::main_with(stepwave::models::catalogue().with(own))
/// }
/// ```
#[must_use]
pub fn main_with(models: Catalogue) -> ExitCode {
    match unless_at_fault(|| run(models)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // Nothing is left to be done where standard error is gone too.
            let _ = writeln!(std::io::stderr(), "{failure}");
            ExitCode::from(failure.code())
        }
    }
}

/// Does the work of the program. A panic, also one of a thread that it waits for, is a mistake of our own: it ends as
/// any failure does, with its temporary files removed, in one sentence with its place.
fn unless_at_fault(work: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
    let place = Arc::new(Mutex::new(None));
    let seen = Arc::clone(&place);
    std::panic::set_hook(Box::new(move |panic| {
        // The first is the cause of the others.
        let mut place = seen.lock().unwrap_or_else(PoisonError::into_inner);
        place.get_or_insert_with(|| panic.to_string());
    }));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        let place = place.lock().unwrap_or_else(PoisonError::into_inner).take();
        Err(Error::Invalid(format!(
            "a mistake of stepwave itself, not of what it was given: {}; please report it with the command and its files",
            place.unwrap_or_else(|| "unknown reason".to_owned())
        )))
    })
}

fn run(models: Catalogue) -> Result<(), Error> {
    stop::watch()?;
    models.install()?;
    bound_threads()?;
    let words: Vec<OsString> = std::env::args_os().collect();
    if let Some(help) = help_of_model(&words) {
        return output::print(&help);
    }
    match Cli::of(&with_signs(by_ending(by_value(words), Cli::command), Cli::command)) {
        Ok(cli) => commands::dispatch(&cli),
        Err(error) if error.use_stderr() => Err(usage(error)),
        Err(help) => output::print(&help.render().to_string()),
    }
}

/// More threads than MOST_THREADS_A_CORE that RAYON_NUM_THREADS asks for are not made: each costs memory, and more than
/// one for each core make nothing faster.
fn bound_threads() -> Result<(), Error> {
    let most = MOST_THREADS_A_CORE * std::thread::available_parallelism().map_or(1, usize::from);
    let asked = std::env::var("RAYON_NUM_THREADS").ok().and_then(|word| word.parse().ok());
    if asked.is_some_and(|threads: u128| threads > most as u128) {
        rayon::ThreadPoolBuilder::new().num_threads(most).build_global()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Error, unless_at_fault};

    #[test]
    fn a_panic_ends_as_a_failure_does_in_one_line_with_its_place() {
        let before = std::panic::take_hook();
        let own = unless_at_fault(|| panic!("no\n{}", 7));
        let of_thread = unless_at_fault(|| {
            rayon::join(|| (), || assert_eq!(1 + 1, 3));
            Ok(())
        });
        let none = unless_at_fault(|| Err(Error::Invalid("bad".to_owned())));
        std::panic::set_hook(before);
        for failed in [own, of_thread] {
            let failure = failed.expect_err("a panic");
            let words = failure.to_string();
            assert_eq!((failure.code(), words.lines().count()), (2, 1), "{words}");
            let begin = "stepwave: a mistake of stepwave itself, not of what it was given: panicked at src/app.rs:";
            assert!(words.starts_with(begin) && words.ends_with("with the command and its files"), "{words}");
        }
        assert_eq!(none.expect_err("a failure").to_string(), "stepwave: bad");
    }
}
