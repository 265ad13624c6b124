//! The end of the process that it does not choose: by a signal, or because nobody reads any more. Temporary files go,
//! and one line says what was left.

use std::io::{self, IsTerminal, Write};

use crate::output::temporary;

/// Takes up the signals that end a process, so that they leave no temporary files: SIGINT, SIGTERM, and SIGHUP unless
/// it is ignored, as `nohup` does. A file that may not grow any more is an error like any other.
///
/// # Errors
/// The system refuses.
#[cfg(unix)]
pub(crate) fn watch() -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};

    signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default())?;
    let mut taken = vec![SIGINT, SIGTERM];
    if !is_ignored(SIGHUP) {
        taken.push(SIGHUP);
    }
    let mut signals = signal_hook::iterator::Signals::new(taken)?;
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            let name = signal_hook::low_level::signal_name(signal).unwrap_or("a signal");
            temporary::abandon(|kept| {
                say(&format!("stopped by {name}: {}", kept.unwrap_or("no output was written")));
                signal_hook::low_level::exit(128 + signal);
            });
        }
    });
    Ok(())
}

#[cfg(not(unix))]
pub(crate) fn watch() -> io::Result<()> {
    Ok(())
}

/// The process was started with this signal ignored.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Ends the process as the system ends one whose output nobody reads: by SIGPIPE, without a word unless something is
/// kept.
pub(crate) fn reader_left() -> ! {
    temporary::abandon(|kept| {
        if let Some(kept) = kept {
            say(&format!("the reader of the output has left: {kept}"));
        }
        #[cfg(unix)]
        {
            // Does not come back unless the signal is blocked.
            let _ = signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGPIPE);
            signal_hook::low_level::exit(128 + signal_hook::consts::SIGPIPE);
        }
    });
    std::process::exit(141)
}

/// Ends the process as soon as the reader of a pipe on standard output leaves, for work of which nothing else comes: it
/// would continue for a result that nobody reads.
#[cfg(unix)]
pub(crate) fn watch_reader() {
    use rustix::event::{PollFd, PollFlags, poll};
    use std::os::fd::AsFd;
    use std::os::unix::fs::FileTypeExt;

    let Ok(out) = io::stdout().as_fd().try_clone_to_owned() else { return };
    let out = std::fs::File::from(out);
    if !out.metadata().is_ok_and(|found| found.file_type().is_fifo() || found.file_type().is_socket()) {
        return;
    }
    // Without a thread it is noticed at the next write.
    let _ = std::thread::Builder::new().spawn(move || {
        loop {
            // An error is reported even if no event is asked for: here, that the reader has left.
            let mut asked = [PollFd::new(&out, PollFlags::empty())];
            match poll(&mut asked, None) {
                Ok(_) if asked[0].revents().contains(PollFlags::ERR) => reader_left(),
                Err(rustix::io::Errno::INTR) => {}
                _ => return,
            }
        }
    });
}

#[cfg(not(unix))]
pub(crate) fn watch_reader() {}

/// One line on standard error, over a progress bar if there is one.
fn say(sentence: &str) {
    let mut err = io::stderr();
    let clear = if err.is_terminal() { "\r\x1b[2K" } else { "" };
    // Nothing is left to be done where standard error is gone too.
    let _ = writeln!(err, "{clear}stepwave: {sentence}");
}
