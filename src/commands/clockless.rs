//! Why a wave has no clocks, with the options that help.

use crate::Error;
use crate::trace::read::ClockError;

/// What is wrong; `otherwise` says what the command can do without clocks: `compare with --by time`.
pub(super) fn clockless(error: &ClockError, otherwise: &str) -> Error {
    let remedy = match error {
        ClockError::None { .. } => "name the clock with --clock",
        _ => "name another with --clock",
    };
    Error::Invalid(format!("{error}: {remedy}, or {otherwise}"))
}
