//! Reading a wave, VCD or FST, of this program or of any other.
//!
//! A [`Wave`] is the file in memory: its signals by dotted path, every change of their values, and, if the file has a
//! clock, the grid of clock cycles that samples them. Cycle *k* is what the hardware settles to after rising edge *k*
//! of the clock:
//!
//! - cycle 0 is the time before the first rising edge;
//! - the sample of cycle *k* is the value held just before rising edge *k* + 1: a change at the very time of an edge
//!   belongs to the cycle that the edge begins;
//! - the last cycle is sampled at the end of the file.
//!
//! So the samples depend neither on the time unit, nor on the period of the clock, nor on delays within a cycle. A
//! rising edge is a change to 1 from 0, `x` or `z`; the first value of the clock is not an edge. Where a signal changes
//! several times at one time, the last counts. Values before the first time of a VCD are those at time 0.
//!
//! ```
//! use stepwave_trace::read::Wave;
//!
//! let text = "$timescale 1 ns $end $scope module m $end $var wire 1 ! clk $end $var integer 4 \" e $end \
//!     $upscope $end $enddefinitions $end\n#0\n0!\nb0 \"\n#5\n1!\n#6\nb1110 \"\n#10\n0!\n";
//! let wave = Wave::from_bytes(text.into())?;
//! let e = wave.find("m.e").unwrap();
//! assert_eq!(wave.cycles()?, 2);
//! assert_eq!(wave.value_at_cycle(e, 1)?.unwrap().to_string(), "1110 (-2)");
//! # Ok::<(), stepwave_trace::read::WaveError>(())
//! ```

mod blocks;
mod clock;
mod decode;
mod fst;
mod limits;
mod names;
mod store;
#[cfg(test)]
pub(crate) mod tests;
mod timescale;
mod value;
mod vcd;

pub use clock::{Clock, ClockError};
pub(crate) use value::extension;
pub use value::{Value, Vector};

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::fs::{File, FileType};
use std::io::{self, BufReader, Cursor, Read, Seek};
use std::path::Path;

/// A wave in memory.
pub struct Wave {
    name: String,
    timescale: Option<Timescale>,
    times: Vec<u64>,
    signals: Vec<Signal>,
    stored: Vec<store::Changes>,
    states: States,
    clock: Result<Clock, ClockError>,
}

/// Names of states by the leaf name of a signal and the bits of a value.
pub type States = BTreeMap<String, BTreeMap<String, String>>;

/// What a reader makes of a file.
struct Content {
    signals: Vec<Signal>,
    stored: Vec<store::Changes>,
    times: Vec<u64>,
    timescale: Option<Timescale>,
    states: States,
}

/// A named signal of a wave. Two names of one signal are two of these that share their stored changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signal {
    /// The scopes and the name, joined by dots, without a bit range.
    pub path: String,
    /// Number of bits; 64 for a real, 0 for a text or an event.
    pub width: u32,
    /// How its values read.
    pub kind: ValueKind,
    pub(crate) stored: usize,
}

impl Signal {
    /// The name without its scopes.
    #[must_use]
    pub fn leaf(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or_default()
    }

    /// What it counts as before its first change.
    pub(crate) fn first_value(&self) -> Value<'static> {
        if self.kind == ValueKind::Event { Value::Count(0) } else { Value::Unset }
    }
}

/// How the values of a signal read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ValueKind {
    /// Bits; the number has no sign.
    Unsigned,
    /// Bits in two's complement: an `integer` or one of SystemVerilog's signed types.
    Signed,
    /// A 64-bit floating-point number.
    Real,
    /// A string.
    Text,
    /// An event: it has times, but no values.
    Event,
}

/// The unit of a wave's times: `factor` times ten to the power of `exponent` seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timescale {
    /// 1, 10 or 100 in a file by the book.
    pub factor: u32,
    /// Of ten; a multiple of three from -21 (zs) to 0 (s).
    pub exponent: i8,
}

impl Timescale {
    /// `count` units as a person writes it: `1750 ns`.
    #[must_use]
    pub fn show(self, count: u128) -> String {
        let unit = match self.exponent {
            -21 => "zs",
            -18 => "as",
            -15 => "fs",
            -12 => "ps",
            -9 => "ns",
            -6 => "us",
            -3 => "ms",
            0 => "s",
            other => return format!("{} * 10^{other} s", count.saturating_mul(self.factor.into())),
        };
        format!("{} {unit}", count.saturating_mul(self.factor.into()))
    }
}

impl Display for Timescale {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.show(1))
    }
}

/// Why a file cannot be read as a wave. Every variant carries the name of the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what the fields are")]
pub enum WaveError {
    /// The operating system refuses.
    #[error("{name}: cannot be read: {source}")]
    Io { name: String, source: io::Error },
    /// Nothing in it.
    #[error("{name}: the file is empty")]
    Empty { name: String },
    /// Another kind of file.
    #[error("{name}: neither VCD (which begins with a `$` command) nor FST (which begins with its header block)")]
    NotAWave { name: String },
    /// An unfinished or truncated file.
    #[error("{name}: {place}: the file ends inside {what}; it was cut off or is still being written")]
    CutOff { name: String, place: String, what: &'static str },
    /// What a reader would have to guess.
    #[error("{name}: {place}: {reason}")]
    Refused { name: String, place: String, reason: String },
    /// The VCD of ports with strengths.
    #[error("{name}: line {line}: extended VCD ($dumpports) is not supported: dump with $dumpvars")]
    Extended { name: String, line: u64 },
    /// A small file that inflates.
    #[error(
        "{name}: {what} take more than {limit}, the limit for a file of its size; convert it to VCD, which has none"
    )]
    TooMuch { name: String, what: String, limit: String },
    /// A pipe that gives and gives.
    #[error(
        "{name}: it gives more than {}, the limit for a pipe; write it to a file first",
        limits::mebibytes(limits::MAX_PIPE)
    )]
    Endless { name: String },
    /// Such as a disk or a terminal.
    #[error("{name}: it is a device, not a wave: name a file or a pipe")]
    Device { name: String },
    /// The format demands that times never decrease.
    #[error("{name}: line {line}: the time goes back from #{from} to #{to}")]
    TimeDecreases { name: String, line: u64, from: u64, to: u64 },
    /// Not a whole number from 0 up, or one too large.
    #[error("{name}: line {line}: `#{time}` is not a time, a whole number from 0 to {}", u64::MAX)]
    BadTime { name: String, line: u64, time: String },
    /// A value that belongs to no variable.
    #[error("{name}: line {line}: a value for the id code `{id}`, which no $var declares")]
    UndeclaredId { name: String, line: u64, id: String },
    /// A width that no hardware has, but that would fill the memory.
    #[error("{name}: `{path}` is declared {width} bits wide; at most {} can be read", limits::MAX_WIDTH)]
    TooWide { name: String, path: String, width: u32 },
    /// Anything else; the reason is the decoder's.
    #[error("{name}: broken wave file: {reason}")]
    Malformed { name: String, reason: String },
    /// The file is a wave, but has no clock of that name.
    #[error(transparent)]
    Clock(#[from] ClockError),
}

impl Wave {
    /// Reads a whole file or pipe, or standard input where the path is `-`; the format is recognised by its content. The clock is the one found as [`Clock`]
    /// says; a file without a clock is an error only when cycles are asked for.
    ///
    /// # Errors
    /// [`WaveError`], if anything is wrong with the file.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, WaveError> {
        let path = path.as_ref();
        if path == Path::new("-") {
            return Self::piped(io::stdin().lock(), String::from("standard input"));
        }
        let name = path.display().to_string();
        let io = |source| WaveError::Io { name: name.clone(), source };
        let mut file = File::open(path).map_err(io)?;
        let kind = file.metadata().map_err(io)?.file_type();
        if is_device(kind) {
            return Err(WaveError::Device { name });
        }
        if !kind.is_file() {
            return Self::piped(file, name);
        }
        let mut head = Vec::with_capacity(HEAD);
        file.by_ref().take(HEAD as u64).read_to_end(&mut head).map_err(io)?;
        let format = Self::format(&head, &name)?;
        file.rewind().map_err(io)?;
        decode::wave(BufReader::with_capacity(1 << 16, file), format, name)
    }

    fn piped(mut input: impl Read, name: String) -> Result<Self, WaveError> {
        let mut head = Vec::with_capacity(HEAD);
        let read = input.by_ref().take(HEAD as u64).read_to_end(&mut head);
        read.map_err(|source| WaveError::Io { name: name.clone(), source })?;
        let format = Self::format(&head, &name)?;
        decode::piped(head, input, format, name)
    }

    /// Reads a wave that is in memory; messages call it `memory`.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, WaveError> {
        let name = String::from("memory");
        let format = Self::format(&bytes[..bytes.len().min(HEAD)], &name)?;
        decode::wave(Cursor::new(bytes), format, name)
    }

    fn format(head: &[u8], name: &str) -> Result<blocks::Format, WaveError> {
        if head.is_empty() {
            return Err(WaveError::Empty { name: name.into() });
        }
        blocks::format(head).ok_or_else(|| WaveError::NotAWave { name: name.into() })
    }

    /// The same wave sampled by the clock `wanted`: a full dotted path, or the last parts of one; of several that
    /// fit, the least deep, then the first.
    ///
    /// # Errors
    /// [`ClockError`] if there is no such signal, or it is not one bit wide, or never rises.
    pub fn with_clock(mut self, wanted: &str) -> Result<Self, ClockError> {
        self.clock = Ok(Clock::named(&self, wanted)?);
        Ok(self)
    }

    /// The file's path as given.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The unit of the times, if the file names one.
    #[must_use]
    pub fn timescale(&self) -> Option<Timescale> {
        self.timescale
    }

    /// Every time stamp of the file, increasing, in units of the timescale.
    #[must_use]
    pub fn times(&self) -> &[u64] {
        &self.times
    }

    /// The names of states that comments of a VCD give, as [`VcdHeader`](crate::vcd::VcdHeader) writes them.
    #[must_use]
    pub fn states(&self) -> &States {
        &self.states
    }

    /// Every signal, in the order of the file, scope by scope. No two have the same path.
    #[must_use]
    pub fn signals(&self) -> &[Signal] {
        &self.signals
    }

    /// The index of the signal with this full path.
    #[must_use]
    pub fn find(&self, path: &str) -> Option<usize> {
        self.signals.iter().position(|signal| signal.path == path)
    }

    /// Whether a signal is the clock, under this name or another.
    #[must_use]
    pub fn is_clock(&self, signal: usize) -> bool {
        let clock = self.clock.as_ref().ok().and_then(|clock| self.signals.get(clock.signal()));
        clock.is_some_and(|clock| self.signals.get(signal).is_some_and(|signal| signal.stored == clock.stored))
    }

    /// The clock that samples this wave.
    ///
    /// # Errors
    /// [`ClockError`] if the file has none.
    pub fn clock(&self) -> Result<&Clock, ClockError> {
        self.clock.as_ref().map_err(ClockError::clone)
    }

    /// Number of cycles: one more than the rising edges of the clock.
    ///
    /// # Errors
    /// As [`clock`](Self::clock).
    pub fn cycles(&self) -> Result<u64, ClockError> {
        Ok(self.clock()?.edges().len() as u64 + 1)
    }

    /// The sample of the signal with this index in [`signals`](Self::signals) in this cycle; nothing beyond the last.
    ///
    /// # Errors
    /// As [`clock`](Self::clock).
    pub fn value_at_cycle(&self, signal: usize, cycle: u64) -> Result<Option<Value<'_>>, ClockError> {
        let edges = self.clock()?.edges();
        let Some((signal, cycle)) = self.signals.get(signal).zip(usize::try_from(cycle).ok()) else { return Ok(None) };
        Ok((cycle <= edges.len()).then(|| {
            let end = edges.get(cycle).copied().unwrap_or(u32::MAX);
            self.value_before(signal, |time| time < end)
        }))
    }

    /// The value that the signal with this index has at this time, changes at this very time included.
    #[must_use]
    pub fn value_at_time(&self, signal: usize, time: u64) -> Option<Value<'_>> {
        let signal = self.signals.get(signal)?;
        Some(self.value_before(signal, |index| self.times[index as usize] <= time))
    }

    /// The value of a signal of this wave once all its changes are done whose time index fulfils `done`, which must be
    /// monotonic.
    pub(crate) fn value_before(&self, signal: &Signal, done: impl Fn(u32) -> bool) -> Value<'_> {
        let count = self.change_times(signal).partition_point(|index| done(*index));
        count.checked_sub(1).map_or_else(|| signal.first_value(), |change| self.value(signal, change))
    }

    /// The value of a signal of this wave after its change with this number.
    pub(crate) fn value(&self, signal: &Signal, change: usize) -> Value<'_> {
        self.stored[signal.stored].value(change, signal.kind == ValueKind::Signed)
    }

    /// The time indices of the changes of a signal of this wave, not decreasing.
    pub(crate) fn change_times(&self, signal: &Signal) -> &[u32] {
        self.stored[signal.stored].times()
    }
}

impl fmt::Debug for Wave {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, signals, times, .. } = self;
        write!(f, "Wave({name}, {} signals, {} times)", signals.len(), times.len())
    }
}

/// The bytes by which a format is recognised.
const HEAD: usize = 512;

/// Reading a device has no end, or waits for a person.
fn is_device(kind: FileType) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        kind.is_char_device() || kind.is_block_device()
    }
    #[cfg(not(unix))]
    false
}
