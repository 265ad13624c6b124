//! `show --follow`: a wave in the terminal, moved by keys.

use std::io::{self, IsTerminal, Read, Write};

use crate::Error;
use crate::trace::draw::Drawing;
use crate::trace::read::Wave;

/// What a key does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Key {
    Later,
    Earlier,
    PageLater,
    PageEarlier,
    First,
    Last,
    Quit,
}

const HELP: &str = "← → clock   PgUp PgDn page   Home End   q";

/// Keys as a terminal sends them; what is none of them is left out.
const KEYS: [(&[u8], Key); 21] = [
    (b"\x1b[C", Key::Later),
    (b"\x1bOC", Key::Later),
    (b"l", Key::Later),
    (b"\x1b[D", Key::Earlier),
    (b"\x1bOD", Key::Earlier),
    (b"h", Key::Earlier),
    (b"\x1b[6~", Key::PageLater),
    (b" ", Key::PageLater),
    (b"\x1b[5~", Key::PageEarlier),
    (b"b", Key::PageEarlier),
    (b"\x1b[H", Key::First),
    (b"\x1bOH", Key::First),
    (b"\x1b[1~", Key::First),
    (b"g", Key::First),
    (b"\x1b[F", Key::Last),
    (b"\x1bOF", Key::Last),
    (b"\x1b[4~", Key::Last),
    (b"G", Key::Last),
    (b"q", Key::Quit),
    // Ctrl-C and Ctrl-D, which do not reach the process as signals here.
    (b"\x03", Key::Quit),
    (b"\x04", Key::Quit),
];

fn keys(mut bytes: &[u8]) -> Vec<Key> {
    let mut found = Vec::new();
    // Escape alone.
    if bytes == b"\x1b" {
        return vec![Key::Quit];
    }
    while !bytes.is_empty() {
        match KEYS.iter().find(|(sent, _)| bytes.starts_with(sent)) {
            Some((sent, key)) => {
                found.push(*key);
                bytes = &bytes[sent.len()..];
            }
            // Another sequence ends with a letter or `~`.
            None if bytes.starts_with(b"\x1b[") => {
                let end =
                    bytes[2..].iter().position(|byte| (0x40..=0x7e).contains(byte)).map_or(bytes.len(), |at| at + 3);
                bytes = &bytes[end..];
            }
            None => bytes = &bytes[1..],
        }
    }
    found
}

/// The first place that is shown after a key, of `count`, `page` of which fit; `None` ends.
fn moved(place: usize, key: Key, page: usize, count: usize) -> Option<usize> {
    let last = count.saturating_sub(page.max(1));
    Some(match key {
        Key::Later => (place + 1).min(last.max(place)),
        Key::Earlier => place.saturating_sub(1),
        Key::PageLater => (place + page.max(1)).min(last.max(place)),
        Key::PageEarlier => place.saturating_sub(page.max(1)),
        Key::First => 0,
        Key::Last => last,
        Key::Quit => return None,
    })
}

/// Shows as much as fits in a line from the first place on, and moves by keys.
///
/// # Errors
/// Standard input or output is not a terminal, or nothing of the wave is to be shown.
pub(super) fn follow(
    mut drawing: Drawing,
    wave: &Wave,
    signals: &[usize],
    trouble: impl Fn(String) -> Error,
) -> Result<(), Error> {
    let (stdin, mut stdout) = (io::stdin(), io::stdout());
    if !(stdin.is_terminal() && stdout.is_terminal()) {
        return Err(Error::Invalid(
            "--follow takes keys from a terminal and draws in it: leave it out where there is none".to_owned(),
        ));
    }
    let places = drawing.places(wave).map_err(&trouble)?;
    let raw = Raw::new()?;
    let (mut place, mut bytes) = (0, [0; 64]);
    loop {
        let end = places.last().copied().unwrap_or_default();
        (drawing.from, drawing.to) = (places.get(place).copied().unwrap_or(end), None);
        let mut window = drawing.window(wave, signals).map_err(&trouble)?;
        let page = window.cells();
        if place + page > places.len() {
            drawing.to = Some(end);
            window = drawing.window(wave, signals).map_err(&trouble)?;
        }
        let text = window.text(drawing.ascii, drawing.colour);
        let what = if drawing.by_time { "time" } else { "clock" };
        write!(stdout, "\x1b[H\x1b[2J{text}\n{what} {} of {end}   {HELP}", drawing.from)?;
        stdout.flush()?;
        let read = stdin.lock().read(&mut bytes)?;
        let pressed = if read == 0 { vec![Key::Quit] } else { keys(&bytes[..read]) };
        for key in pressed {
            match moved(place, key, page, places.len()) {
                Some(next) => place = next,
                None => {
                    drop(raw);
                    return Ok(writeln!(stdout)?);
                }
            }
        }
    }
}

/// A terminal that hands over every key at once and does not show it, until this is dropped.
struct Raw(rustix::termios::Termios);

impl Raw {
    fn new() -> Result<Raw, Error> {
        use rustix::termios::{LocalModes, OptionalActions, SpecialCodeIndex, tcgetattr, tcsetattr};
        let before = tcgetattr(io::stdin()).map_err(io::Error::from)?;
        let mut own = before.clone();
        own.local_modes.remove(LocalModes::ICANON | LocalModes::ECHO | LocalModes::ISIG);
        own.special_codes[SpecialCodeIndex::VMIN] = 1;
        own.special_codes[SpecialCodeIndex::VTIME] = 0;
        tcsetattr(io::stdin(), OptionalActions::Now, &own).map_err(io::Error::from)?;
        Ok(Raw(before))
    }
}

impl Drop for Raw {
    fn drop(&mut self) {
        // Where the terminal is gone nothing is left to restore.
        let _ = rustix::termios::tcsetattr(io::stdin(), rustix::termios::OptionalActions::Now, &self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_one_after_another_and_others_are_left_out() {
        use Key::{Earlier, First, Last, Later, PageEarlier, PageLater, Quit};
        assert_eq!(keys(b"\x1b[C\x1b[C\x1b[D"), [Later, Later, Earlier]);
        assert_eq!(
            keys(b"\x1b[6~ \x1b[5~b\x1b[H\x1bOHg\x1b[FGq"),
            [PageLater, PageLater, PageEarlier, PageEarlier, First, First, First, Last, Last, Quit]
        );
        // F5, a mouse report and letters that mean nothing.
        assert_eq!(keys(b"\x1b[15~\x1b[<0;3;4Mxyz\x1b[C"), [Later]);
        assert_eq!((keys(b"\x1b"), keys(b"\x03"), keys(b"")), (vec![Quit], vec![Quit], vec![]));
    }

    #[test]
    fn the_window_stays_within_the_wave() {
        let at = |place, key| moved(place, key, 10, 25);
        assert_eq!(at(0, Key::Earlier), Some(0));
        assert_eq!((at(14, Key::Later), at(15, Key::Later)), (Some(15), Some(15)));
        assert_eq!((at(3, Key::PageLater), at(13, Key::PageLater)), (Some(13), Some(15)));
        assert_eq!((at(13, Key::PageEarlier), at(3, Key::PageEarlier)), (Some(3), Some(0)));
        assert_eq!((at(7, Key::First), at(7, Key::Last), at(7, Key::Quit)), (Some(0), Some(15), None));
        // A wave of fewer clocks than fit.
        assert_eq!((moved(0, Key::Later, 10, 4), moved(0, Key::Last, 10, 4)), (Some(0), Some(0)));
    }
}
