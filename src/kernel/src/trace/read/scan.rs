//! A quick look at a file before it is decoded: what `wellen` would panic on, drop in silence or never finish reading
//! is found here, with its place.

use super::WaveError;
use std::collections::HashSet;
use std::io::{self, BufRead, ErrorKind, Read, Seek, SeekFrom};

/// The file formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Vcd,
    Fst,
}

/// An FST header block: type 0, then its length of 329 bytes.
const FST_HEADER: [u8; 9] = [0, 0, 0, 0, 0, 0, 0, 1, 73];
/// A block of type 254 holds a whole FST compressed by gzip, whose magic number follows two lengths.
const FST_WRAPPER: u8 = 254;
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Recognises a file by its first bytes.
pub(super) fn format(head: &[u8]) -> Option<Format> {
    let text = head.trim_ascii_start();
    if text.first() == Some(&b'$') {
        Some(Format::Vcd)
    } else if head.starts_with(&FST_HEADER) || (head.first() == Some(&FST_WRAPPER) && head.get(17..19) == Some(&GZIP)) {
        Some(Format::Fst)
    } else {
        None
    }
}

/// Walks the blocks of an FST file: each must end inside the file and claim no more content than its bytes can hold.
pub(super) fn fst(input: &mut (impl Read + Seek), name: &str) -> Result<(), WaveError> {
    let cut = |at: u64| WaveError::CutOff { name: name.into(), place: format!("byte {at}"), what: "a block" };
    let io = |source| WaveError::Io { name: name.into(), source };
    let end = input.seek(SeekFrom::End(0)).map_err(io)?;
    let mut at = 0;
    while at < end {
        let (kind, length) = match u64s(input, at + 1) {
            Ok([length]) => (first_byte(input, at).map_err(io)?, length),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Err(cut(at)),
            Err(error) => return Err(io(error)),
        };
        if kind == FST_WRAPPER {
            return Ok(());
        }
        let next = at.checked_add(length).and_then(|sum| sum.checked_add(1));
        let next = next.filter(|next| length >= 8 && *next <= end).ok_or_else(|| cut(at))?;
        if !plausible(input, kind, at + 1, length).map_err(io)? {
            let reason = format!("the FST block at byte {at} claims more content than it can hold");
            return Err(WaveError::Malformed { name: name.into(), reason });
        }
        at = next;
    }
    Ok(())
}

/// Whether the sizes written in the block of this kind, whose length field is at `at`, can be true. The decoder
/// reserves memory by them before it looks any further, and running out of memory is no error that can be caught.
fn plausible(input: &mut (impl Read + Seek), kind: u8, at: u64, length: u64) -> io::Result<bool> {
    // The most that deflate makes of a byte; LZ4 stays below.
    let expanded = |bytes: u64| bytes.saturating_mul(1032);
    Ok(match kind {
        // Changes of values. At the end the size of the table of places, then the table of times, then its sizes.
        1 | 5 | 8 if length >= 56 => {
            let [bytes, packed, times] = u64s(input, at + length - 24)?;
            input.seek(SeekFrom::Start(at + 32))?;
            let [_, frame, handles] = [varint(input)?, varint(input)?, varint(input)?];
            let changes = input.stream_position()?.saturating_add(frame);
            let inside = changes < at + length && packed <= length && bytes <= expanded(packed) && times <= bytes;
            inside && packed + 32 <= length && {
                let [places] = u64s(input, at + length - packed - 32)?;
                input.seek(SeekFrom::Start(changes))?;
                places <= length && varint(input)? == handles && handles <= expanded(length)
            }
        }
        2 => {
            input.seek(SeekFrom::Start(at + 8))?;
            varint(input)? <= length
        }
        3 if length >= 24 => {
            let [bytes, handles] = u64s(input, at + 8)?;
            bytes <= expanded(length) && handles <= bytes
        }
        4 | 6 if length >= 16 => u64s(input, at + 8).map(|[bytes]| bytes <= expanded(length))?,
        // Packed twice.
        7 if length >= 17 => {
            let [bytes] = u64s(input, at + 8)?;
            varint(input)? <= expanded(length) && bytes <= expanded(expanded(length))
        }
        1 | 3..=8 => false,
        _ => true,
    })
}

fn first_byte(input: &mut (impl Read + Seek), at: u64) -> io::Result<u8> {
    let mut byte = [0];
    input.seek(SeekFrom::Start(at))?;
    input.read_exact(&mut byte)?;
    Ok(byte[0])
}

fn u64s<const N: usize>(input: &mut (impl Read + Seek), at: u64) -> io::Result<[u64; N]> {
    let mut words = [0; N];
    input.seek(SeekFrom::Start(at))?;
    for word in &mut words {
        let mut bytes = [0; 8];
        input.read_exact(&mut bytes)?;
        *word = u64::from_be_bytes(bytes);
    }
    Ok(words)
}

/// A number in groups of seven bits, the least first; one too large for 64 bits reads as the largest.
fn varint(input: &mut impl Read) -> io::Result<u64> {
    let mut number = 0u64;
    for shift in (0..70).step_by(7) {
        let mut byte = [0];
        input.read_exact(&mut byte)?;
        let group = u64::from(byte[0] & 0x7f);
        number |= if group.leading_zeros() < shift { return Ok(u64::MAX) } else { group << shift };
        if byte[0] < 0x80 {
            return Ok(number);
        }
    }
    Ok(u64::MAX)
}

/// Reads a VCD file token by token: the header is closed, every value has a declared id code, times never decrease, and
/// the file does not end inside a value.
pub(super) fn vcd(input: &mut impl BufRead, name: &str) -> Result<(), WaveError> {
    let mut scan = Vcd { name, line: 0, state: State::Header, ids: Ids::default(), time: 0 };
    let mut line = Vec::with_capacity(256);
    loop {
        line.clear();
        let length =
            input.read_until(b'\n', &mut line).map_err(|source| WaveError::Io { name: name.into(), source })?;
        if length == 0 {
            break;
        }
        scan.line += 1;
        for token in line.split(u8::is_ascii_whitespace).filter(|token| !token.is_empty()) {
            scan.token(token)?;
        }
    }
    let what = match scan.state {
        State::Header | State::Command(_) | State::LastCommand => "the header",
        State::Id => "a value",
        State::Body | State::Comment => return Ok(()),
    };
    Err(WaveError::CutOff { name: name.into(), place: format!("line {}", scan.line), what })
}

#[derive(Clone, Copy)]
enum State {
    Header,
    /// In a header command; for a `$var`, the number of tokens until its id code.
    Command(u32),
    LastCommand,
    Body,
    /// After a vector, real or string: its id code is next.
    Id,
    Comment,
}

struct Vcd<'a> {
    name: &'a str,
    line: u64,
    state: State,
    ids: Ids,
    time: u64,
}

impl Vcd<'_> {
    fn token(&mut self, token: &[u8]) -> Result<(), WaveError> {
        self.state = match (self.state, token) {
            (State::Header, b"$enddefinitions") => State::LastCommand,
            (State::Header, b"$var") => State::Command(3),
            (State::Header, _) => State::Command(0),
            (State::LastCommand, token) if token.ends_with(b"$end") => State::Body,
            (State::Command(_), token) if token.ends_with(b"$end") => State::Header,
            (State::Command(1), id) => {
                self.ids.insert(id);
                State::Command(0)
            }
            (State::Command(left), _) => State::Command(left.saturating_sub(1)),
            (State::LastCommand, _) => State::LastCommand,
            (State::Comment, b"$end") => State::Body,
            (State::Comment, _) => State::Comment,
            (State::Id, id) => self.declared(id)?,
            (State::Body, b"$comment") => State::Comment,
            (State::Body, [b'#', time @ ..]) => self.time(time)?,
            (State::Body, [b'b' | b'B' | b'r' | b'R' | b's' | b'S', ..]) => State::Id,
            (State::Body, [b'$', ..]) => State::Body,
            (State::Body, [_, id @ ..]) => self.declared(id)?,
            (State::Body, []) => State::Body,
        };
        Ok(())
    }

    fn declared(&self, id: &[u8]) -> Result<State, WaveError> {
        if self.ids.contains(id) {
            return Ok(State::Body);
        }
        let id = String::from_utf8_lossy(id).into_owned();
        Err(WaveError::UndeclaredId { name: self.name.into(), line: self.line, id })
    }

    fn time(&mut self, digits: &[u8]) -> Result<State, WaveError> {
        let text = String::from_utf8_lossy(digits);
        // Some programs write times as reals.
        let real = || text.parse().ok().filter(|real: &f64| real.fract() == 0.0).map(|real| format!("{real:.0}"));
        let time = text.parse().ok().or_else(|| real()?.parse().ok());
        let (name, line, from) = (self.name.to_string(), self.line, self.time);
        match time {
            Some(to) if to < from => Err(WaveError::TimeDecreases { name, line, from, to }),
            Some(time) => {
                self.time = time;
                Ok(State::Body)
            }
            None => Err(WaveError::BadTime { name, line, time: text.into_owned() }),
        }
    }
}

/// The declared id codes. Those of up to three characters, nearly all, are looked up without hashing.
#[derive(Default)]
struct Ids {
    short: Vec<bool>,
    long: HashSet<Box<[u8]>>,
}

impl Ids {
    fn index(id: &[u8]) -> Option<usize> {
        let digit = |byte: &u8| byte.checked_sub(b' ').filter(|digit| *digit < 95).map(usize::from);
        (id.len() <= 3).then_some(())?;
        id.iter().try_fold(0, |index, byte| Some(index * 95 + digit(byte)?))
    }

    fn insert(&mut self, id: &[u8]) {
        match Self::index(id) {
            Some(index) => {
                self.short.resize(self.short.len().max(index + 1), false);
                self.short[index] = true;
            }
            None => drop(self.long.insert(id.into())),
        }
    }

    fn contains(&self, id: &[u8]) -> bool {
        match Self::index(id) {
            Some(index) => self.short.get(index).copied().unwrap_or(false),
            None => self.long.contains(id),
        }
    }
}
