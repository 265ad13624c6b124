//! The one place at which panics of other crates are caught: several of them panic on what a file or a user says.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

/// Does work that may panic on broken input, and gives the panic's message instead, in one line.
///
/// The panic hook stays silent for panics of this thread meanwhile; every other panic goes to the hook that was there
/// before. All of the work must stay on this thread.
///
/// # Errors
/// The message of the panic.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    thread_local! {
        static QUIET: Cell<bool> = const { Cell::new(false) };
    }
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                before(panic);
            }
        }));
    });
    let outer = QUIET.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    QUIET.set(outer);
    result.map_err(|panic: Box<dyn Any + Send>| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("unknown reason");
        text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::guarded;

    #[test]
    fn a_panic_becomes_its_message_and_the_next_work_goes_on() {
        assert_eq!(guarded(|| 3), Ok(3));
        assert_eq!(guarded(|| -> u8 { panic!("no\n{}", 7) }), Err("no 7".into()));
        let inner = guarded(|| (guarded(|| -> u8 { panic!("inner") }), 4));
        assert_eq!(inner, Ok((Err("inner".into()), 4)));
    }
}
