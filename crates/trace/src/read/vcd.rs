//! Reading a VCD file, word by word and only once: what cannot be read without a guess is refused with its line.

mod header;
mod ids;

use super::names::Names;
use super::store::{Changes, Misfit};
use super::{Content, States, Timescale, ValueKind, WaveError, limits};
use ids::Ids;
use std::io::{BufRead, Read};

/// Reads a whole file of `length` bytes, or of as many as limit it.
pub(super) fn read(input: &mut impl BufRead, name: &str, length: u64) -> Result<Content, WaveError> {
    let mut vcd = Vcd {
        name,
        line: 0,
        state: ParserState::Header,
        command: Command::default(),
        ids: Ids::default(),
        names: Names::new(length),
        declared: Vec::new(),
        stored: Vec::new(),
        times: Vec::new(),
        value: Vec::new(),
        timescale: None,
        states: States::new(),
        signed: false,
    };
    let mut line = Vec::with_capacity(256);
    loop {
        line.clear();
        let io = |source| WaveError::Io { name: name.into(), source };
        let read = input.by_ref().take(limits::MAX_LINE + 1).read_until(b'\n', &mut line).map_err(io)?;
        if read == 0 {
            break;
        }
        vcd.line += 1;
        if read as u64 > limits::MAX_LINE {
            let limit = limits::mebibytes(limits::MAX_LINE);
            return Err(vcd.refused(format!("a line of more than {limit} cannot be read; break it at any blank")));
        }
        for word in line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
            vcd.word(word)?;
        }
    }
    vcd.finish()
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum ParserState {
    Header,
    /// In a header command.
    Command,
    Body,
    /// After a vector, real or string: its id code is next.
    Id,
    Comment,
}

/// A header command being read.
#[derive(Default)]
struct Command {
    keyword: String,
    line: u64,
    words: Vec<String>,
}

/// What a `$var` says of an id code.
#[derive(Clone, Copy)]
struct Declared {
    line: u64,
    kind: ValueKind,
    width: u32,
    /// Its type does not say what its values are: they do.
    open: bool,
}

struct Vcd<'a> {
    name: &'a str,
    line: u64,
    state: ParserState,
    command: Command,
    ids: Ids,
    names: Names,
    declared: Vec<Declared>,
    stored: Vec<Changes>,
    times: Vec<u64>,
    /// The value whose id code is next.
    value: Vec<u8>,
    timescale: Option<(Timescale, u64)>,
    states: States,
    /// An attribute says that the next variable is signed.
    signed: bool,
}

impl Vcd<'_> {
    fn refused(&self, reason: impl Into<String>) -> WaveError {
        WaveError::Refused { name: self.name.into(), place: format!("line {}", self.line), reason: reason.into() }
    }

    fn word(&mut self, word: &[u8]) -> Result<(), WaveError> {
        match (self.state, word) {
            (ParserState::Header | ParserState::Command, _) => self.header(word)?,
            (ParserState::Comment, b"$end") => self.state = ParserState::Body,
            (ParserState::Comment, _) => {}
            (ParserState::Id, id) => {
                self.state = ParserState::Body;
                let value = std::mem::take(&mut self.value);
                self.change(&value, id)?;
                self.value = value;
            }
            (_, [b'#', time @ ..]) => self.time(time)?,
            (_, [b'b' | b'B' | b'r' | b'R' | b's' | b'S', ..]) => {
                self.value.clear();
                self.value.extend_from_slice(word);
                self.state = ParserState::Id;
            }
            (_, [b'$', ..]) => self.keyword(word)?,
            (_, [state, id @ ..]) if is_state(*state) => self.change(&word[..1], id)?,
            (_, [b'p', ..]) => return Err(WaveError::Extended { name: self.name.into(), line: self.line }),
            _ => return Err(self.refused(format!("`{}` is not a change of a value", quoted(word)))),
        }
        Ok(())
    }

    /// A command among the changes.
    fn keyword(&mut self, word: &[u8]) -> Result<(), WaveError> {
        match word {
            b"$comment" => self.state = ParserState::Comment,
            b"$dumpvars" | b"$dumpall" | b"$dumpon" | b"$dumpoff" | b"$end" => {}
            b"$vcdclose" => return Err(WaveError::Extended { name: self.name.into(), line: self.line }),
            _ if word.starts_with(b"$dumpports") => {
                return Err(WaveError::Extended { name: self.name.into(), line: self.line });
            }
            _ => return Err(self.refused(format!("`{}` is not a command among changes of values", quoted(word)))),
        }
        Ok(())
    }

    fn time(&mut self, digits: &[u8]) -> Result<(), WaveError> {
        let text = quoted(digits);
        let (name, line) = (self.name.to_owned(), self.line);
        let Some(time) = whole(&text) else { return Err(WaveError::BadTime { name, line, time: text }) };
        match self.times.last() {
            Some(from) if time < *from => Err(WaveError::TimeDecreases { name, line, from: *from, to: time }),
            Some(last) if time == *last => Ok(()),
            _ => {
                self.times.push(time);
                Ok(())
            }
        }
    }

    /// The index of the time it is. Values before any time are those at time 0.
    fn now(&mut self) -> Result<u32, WaveError> {
        if self.times.is_empty() {
            self.times.push(0);
        }
        u32::try_from(self.times.len() - 1).map_err(|_| self.refused("more than 4294967296 times cannot be read"))
    }

    fn change(&mut self, value: &[u8], id: &[u8]) -> Result<(), WaveError> {
        let Some(place) = self.ids.get(id) else {
            let id = quoted(id);
            return Err(WaveError::UndeclaredId { name: self.name.into(), line: self.line, id });
        };
        let now = self.now()?;
        let (Some(changes), Some(declared)) = (self.stored.get_mut(place), self.declared.get(place)) else {
            return Err(self.refused("a value of no variable"));
        };
        let first = value.first().copied().unwrap_or_default().to_ascii_lowercase();
        if declared.open && changes.times().is_empty() {
            match first {
                b's' => changes.becomes(ValueKind::Text),
                b'r' => changes.becomes(ValueKind::Real),
                _ => {}
            }
        }
        let stored = match (first, changes.kind().0) {
            (_, ValueKind::Event) => changes.event(now),
            (b's', _) => changes.text(now, &text(&value[1..])),
            (b'r', ValueKind::Real) => match std::str::from_utf8(&value[1..]).ok().and_then(|real| real.parse().ok()) {
                Some(real) => changes.real(now, real),
                None => Err(Misfit::Empty),
            },
            (b'r', _) => Err(Misfit::Kind),
            (b'b', _) => changes.bits(now, &value[1..]),
            _ => changes.bits(now, value),
        };
        stored.map_err(|misfit| self.misfit(value, place, misfit))
    }

    fn misfit(&self, value: &[u8], place: usize, misfit: Misfit) -> WaveError {
        let (kind, width) = self.stored.get(place).map_or((ValueKind::Event, 0), Changes::kind);
        let what = match kind {
            ValueKind::Real => "a real".to_owned(),
            ValueKind::Text => "a string".to_owned(),
            ValueKind::Event => "an event".to_owned(),
            _ if width == 1 => "1 bit".to_owned(),
            _ => format!("{width} bits"),
        };
        let why = match misfit {
            Misfit::Digit(digit) => format!("`{}` is not a state of a bit", char::from(digit).escape_default()),
            Misfit::Empty if kind == ValueKind::Real => "it is not a number".to_owned(),
            Misfit::Empty => "it has no digit".to_owned(),
            Misfit::TooLong => "it has more digits".to_owned(),
            Misfit::NotExtended(digit) => {
                format!("it has fewer digits, and no rule extends a leading `{}`", char::from(digit))
            }
            Misfit::Kind => "it is of another kind".to_owned(),
        };
        let path = self.names.path_of(place);
        self.refused(format!("`{}` is not a value of `{path}`, which is {what}: {why}", quoted(value)))
    }

    fn finish(self) -> Result<Content, WaveError> {
        let what = match self.state {
            ParserState::Header | ParserState::Command => "the header",
            ParserState::Id => "a value",
            ParserState::Body | ParserState::Comment => {
                let Self { name, names, mut stored, times, timescale, states, .. } = self;
                let signals = names.signals(&mut stored).map_err(|reason| WaveError::Refused {
                    name: name.into(),
                    place: "header".into(),
                    reason,
                })?;
                return Ok(Content { signals, stored, times, timescale: timescale.map(|(scale, _)| scale), states });
            }
        };
        Err(WaveError::CutOff { name: self.name.into(), place: format!("line {}", self.line), what })
    }
}

fn is_state(byte: u8) -> bool {
    b"01xXzZhHuUwWlL-".contains(&byte)
}

/// Words of a file in a message: not more than a line's worth.
fn quoted(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(word);
    if text.chars().count() <= 60 { text.into_owned() } else { text.chars().take(57).chain("...".chars()).collect() }
}

/// A time. Some programs write times as reals; an inexact number is not a time.
fn whole(text: &str) -> Option<u64> {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let (digits, fraction) = text.split_once('.').unwrap_or((text, ""));
    if fraction.bytes().all(|digit| digit == b'0')
        && let Ok(time) = digits.parse()
    {
        return Some(time);
    }
    let real = text.parse().ok().filter(|real: &f64| real.fract() == 0.0 && (0.0..EXACT).contains(real))?;
    format!("{real:.0}").parse().ok()
}

/// A string value without the escapes of libfst (`\n`, `\012`) and pyvcd (`\x0a`).
fn text(written: &[u8]) -> String {
    let mut bytes = Vec::with_capacity(written.len());
    let mut rest = written;
    while let [first, after @ ..] = rest {
        let digits = |count: usize, radix: u32, from: &[u8]| {
            let digits = std::str::from_utf8(from.get(..count)?).ok()?;
            let plain = digits.bytes().all(|digit| char::from(digit).is_digit(radix));
            u8::from_str_radix(digits, radix).ok().filter(|_| plain)
        };
        let (byte, length) = match (*first, after) {
            (b'\\', [b'x', hex @ ..]) if let Some(byte) = digits(2, 16, hex) => (byte, 4),
            (b'\\', octal) if let Some(byte) = digits(3, 8, octal) => (byte, 4),
            (b'\\', [letter, ..]) if let Some(byte) = escaped(*letter) => (byte, 2),
            (byte, _) => (byte, 1),
        };
        bytes.push(byte);
        rest = &rest[length..];
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn escaped(letter: u8) -> Option<u8> {
    Some(match letter {
        b'a' => 7,
        b'b' => 8,
        b't' => 9,
        b'n' => 10,
        b'v' => 11,
        b'f' => 12,
        b'r' => 13,
        b'"' | b'\'' | b'\\' | b'?' => letter,
        _ => return None,
    })
}
