//! Reading an FST file, through the crate `fst-reader`, which panics on broken files: that is caught here.

use super::names::{Names, Var};
use super::store::{Changes, Misfit};
use super::{Content, States, Timescale, ValueKind, WaveError, blocks, limits};
use crate::guard::guarded;
use fst_reader::{
    FstFilter, FstHierarchyEntry, FstReader, FstSignalHandle, FstSignalValue, FstVarType, FstVhdlDataType,
    ReadSignalsError,
};
use std::collections::HashMap;
use std::io::{BufRead, Cursor, Seek};

/// Reads a whole file of `length` bytes.
pub(super) fn read(mut input: impl BufRead + Seek, name: &str, length: u64) -> Result<Content, WaveError> {
    match blocks::unwrapped(&mut input, name, length)? {
        Some(bytes) => plain(Cursor::new(bytes), name, length),
        None => plain(input, name, length),
    }
}

fn plain(mut input: impl BufRead + Seek, name: &str, length: u64) -> Result<Content, WaveError> {
    blocks::check(&mut input, name, length)?;
    input.rewind().map_err(|source| WaveError::Io { name: name.into(), source })?;
    guarded(|| decode(input, name, length)).unwrap_or_else(|reason| Err(malformed(name, reason)))
}

fn malformed(name: &str, reason: impl ToString) -> WaveError {
    WaveError::Malformed { name: name.into(), reason: reason.to_string() }
}

fn decode(input: impl BufRead + Seek, name: &str, length: u64) -> Result<Content, WaveError> {
    let mut reader = FstReader::open_and_read_time_table(input).map_err(|error| malformed(name, error))?;
    let timescale = timescale(reader.get_header().timescale_exponent).map_err(|reason| malformed(name, reason))?;
    let mut declarations = Declarations::new(length);
    let mut problem = None;
    reader
        .read_hierarchy(|entry| {
            if problem.is_none() {
                problem = declarations.entry(entry).err();
            }
        })
        .map_err(|error| malformed(name, error))?;
    if let Some(reason) = problem {
        return Err(malformed(name, reason));
    }
    let mut times = reader.get_time_table().unwrap_or_default().to_vec();
    if !times.is_sorted() {
        return Err(malformed(name, "its times go back"));
    }
    times.dedup();
    let mut values = Values { declarations: &mut declarations, times, at: 0, room: limits::inflated(length) };
    let read = reader.read_signals(&FstFilter::all(), |time, handle, value| values.change(time, &handle, &value));
    let times = values.times;
    read.map_err(|error| match error {
        ReadSignalsError::CallbackError(Trouble::Values(reason)) => malformed(name, reason),
        ReadSignalsError::CallbackError(Trouble::TooMuch) => {
            let limit = limits::mebibytes(limits::inflated(length));
            WaveError::TooMuch { name: name.into(), what: "the changes of its signals".into(), limit }
        }
        ReadSignalsError::ReadError(error) => malformed(name, error),
    })?;
    let Declarations { names, mut stored, .. } = declarations;
    let signals = names.signals(&mut stored).map_err(|reason| malformed(name, reason))?;
    Ok(Content { signals, stored, times, timescale: Some(timescale), states: States::new() })
}

fn timescale(exponent: i8) -> Result<Timescale, String> {
    let third = (exponent.div_euclid(3) * 3).min(0);
    let factor = 10u32.checked_pow(u32::from(exponent.abs_diff(third)));
    match factor {
        Some(factor) if third >= -21 => Ok(Timescale { factor, exponent: third }),
        _ => Err(format!("a time scale of 10^{exponent} seconds")),
    }
}

struct Declarations {
    names: Names,
    /// The place of each handle among the stored changes.
    places: HashMap<usize, usize>,
    stored: Vec<Changes>,
    /// An attribute says that the next variable is signed.
    signed: bool,
}

impl Declarations {
    fn new(length: u64) -> Self {
        Self { names: Names::new(length), places: HashMap::new(), stored: Vec::new(), signed: false }
    }

    fn entry(&mut self, entry: FstHierarchyEntry) -> Result<(), String> {
        match entry {
            FstHierarchyEntry::Scope { name, .. } => self.names.scope(&name),
            FstHierarchyEntry::UpScope => self.names.upscope(),
            FstHierarchyEntry::VhdlVarInfo { data_type, .. } => {
                use FstVhdlDataType::{Integer, Natural, Positive, Signed};
                self.signed = matches!(data_type, Signed | Integer | Natural | Positive);
                Ok(())
            }
            FstHierarchyEntry::Var { tpe, name, length, handle, .. } => self.var(&tpe, &name, length, &handle),
            _ => Ok(()),
        }
    }

    fn var(&mut self, tpe: &FstVarType, name: &str, width: u32, handle: &FstSignalHandle) -> Result<(), String> {
        let mut kind = match tpe {
            FstVarType::GenericString => ValueKind::Text,
            FstVarType::Event => ValueKind::Event,
            tpe if tpe.is_real() => ValueKind::Real,
            FstVarType::Integer | FstVarType::Int | FstVarType::ShortInt | FstVarType::LongInt | FstVarType::Byte => {
                ValueKind::Signed
            }
            _ => ValueKind::Unsigned,
        };
        let bits = matches!(kind, ValueKind::Unsigned | ValueKind::Signed);
        if std::mem::take(&mut self.signed) && bits {
            kind = ValueKind::Signed;
        }
        let path = self.names.quoted(name);
        if bits && width > limits::MAX_WIDTH {
            return Err(format!("`{path}` is declared {width} bits wide; at most {} can be read", limits::MAX_WIDTH));
        }
        let new = Changes::new(if bits { ValueKind::Unsigned } else { kind }, width);
        let place = *self.places.entry(handle.get_index()).or_insert(self.stored.len());
        match self.stored.get(place) {
            Some(old) if old.kind() != new.kind() => {
                let other = self.names.path_of(place);
                return Err(format!("`{path}` shares its values with `{other}`, but has another kind or width"));
            }
            Some(_) => {}
            None => self.stored.push(new),
        }
        self.names.var(&Var { name, kind, width, stored: place }).map_err(|reason| format!("`{path}`: {reason}"))
    }
}

/// Why the reading of values ends early.
enum Trouble {
    Values(String),
    TooMuch,
}

struct Values<'a> {
    declarations: &'a mut Declarations,
    times: Vec<u64>,
    /// The index of the time of the last change.
    at: usize,
    /// Bytes that changes may still take.
    room: u64,
}

impl Values<'_> {
    fn change(&mut self, time: u64, handle: &FstSignalHandle, value: &FstSignalValue<'_>) -> Result<(), Trouble> {
        // The values that a file begins with may come before its first time.
        if self.at == 0 && self.times.first().is_none_or(|first| time < *first) {
            self.times.insert(0, time);
        }
        while self.times.get(self.at).is_some_and(|at| *at < time) {
            self.at += 1;
        }
        let Some(now) = self.times.get(self.at).filter(|at| **at == time).and_then(|_| u32::try_from(self.at).ok())
        else {
            return Err(Trouble::Values(format!("a change at time {time}, which is not among its times in order")));
        };
        let Declarations { places, stored, names, .. } = &mut *self.declarations;
        let Some(place) = places.get(&handle.get_index()).copied() else { return Ok(()) };
        let Some(changes) = stored.get_mut(place) else { return Ok(()) };
        let before = changes.size();
        let (kind, width) = changes.kind();
        let result = match value {
            // A constant may be a real.
            FstSignalValue::Real(_) if kind == ValueKind::Unsigned && width == 64 && changes.times().is_empty() => {
                changes.becomes(ValueKind::Real);
                put(changes, now, value)
            }
            _ => put(changes, now, value),
        };
        result.map_err(|_| {
            Trouble::Values(format!("a value of `{}` does not fit its kind or width", names.path_of(place)))
        })?;
        self.room = self.room.checked_sub(changes.size().saturating_sub(before)).ok_or(Trouble::TooMuch)?;
        Ok(())
    }
}

fn put(changes: &mut Changes, now: u32, value: &FstSignalValue<'_>) -> Result<(), Misfit> {
    match (value, changes.kind()) {
        (FstSignalValue::Real(real), _) => changes.real(now, *real),
        (FstSignalValue::String(_), (ValueKind::Event, _)) => changes.event(now),
        // Strings are in ISO 8859-1.
        (FstSignalValue::String(text), (ValueKind::Text, _)) => {
            changes.text(now, &text.iter().map(|byte| char::from(*byte)).collect::<String>())
        }
        (FstSignalValue::String(digits), (_, width)) if digits.len() == width as usize => changes.bits(now, digits),
        (FstSignalValue::String(_), _) => Err(Misfit::Kind),
    }
}
