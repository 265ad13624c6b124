//! Two waves in one VCD for the viewer: side A under the scope `a`, side B under `b`, their exclusive-or under `xor`.
//!
//! The signals are those that a [comparison](super::diverge) with the same options compares, under the names by which
//! it pairs them. Scope `xor` holds the bit vectors of equal width on both sides; a bit is 0 where the
//! comparison sees no difference, 1 where one side is 0 and the other 1, and `x` where only the states differ.
//!
//! By clock, the file has the times of A: the sample of a cycle is shown from the rising edge that begins the cycle, on
//! both sides, so that delays within a cycle are gone; A's clock is added to scope `a`. Cycles that A does not have are
//! left out. By time, each change is at its own time, in a unit that divides those of both sides. A side that has
//! ended keeps its last values, one that has not begun is `x`.

#[cfg(test)]
mod tests;
mod track;

use super::diverge::{CompareError, Frame, Frames, Options, pairs};
use super::read::{Signal, Timescale, ValueKind, Wave};
use std::cmp::Reverse;
use std::collections::binary_heap::{BinaryHeap, PeekMut};
use std::collections::{HashMap, HashSet};
use std::io::{self, BufWriter, Write};
use track::{Source, Track};
use vcd::{IdCode, ReferenceIndex, TimescaleUnit, VarType, Writer};

/// Why the merged wave is not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what the fields are")]
pub enum MergeError {
    /// The waves cannot be compared in the first place.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// The output fails.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// VCD counts in powers of ten from femtoseconds to seconds.
    #[error("a VCD cannot count in units of {unit}")]
    Unit { unit: Timescale },
    /// A 64-bit number of units.
    #[error("the times of the merged wave do not fit 64 bits")]
    TimeRange,
}

/// Writes both waves and their exclusive-or as one VCD.
///
/// # Errors
/// [`MergeError`]; the file written so far is incomplete.
pub fn write_merged(a: &Wave, b: &Wave, options: &Options, out: &mut dyn Write) -> Result<(), MergeError> {
    let frames = Frames::new(a, b, options.by)?;
    let mut entries = entries(&frames, options)?;
    entries.sort_by(|x, y| x.scopes.cmp(&y.scopes));

    let mut writer = Writer::new(BufWriter::with_capacity(1 << 16, out));
    let (unit, step) = unit(&frames)?;
    let sources = header(&mut writer, &entries, unit)?;
    let raw = Frame::raw(a);
    let tracks = sources.into_iter().map(|(source, id)| Track::new(source, id, &frames, &raw)).collect();
    body(&mut Times { out: writer.writer(), step }, tracks, &frames)?;
    Ok(writer.flush()?)
}

/// A variable of the file: its scopes and name, and what it shows.
struct Entry<'w> {
    scopes: Vec<String>,
    name: String,
    source: Source<'w>,
}

fn entries<'w>(frames: &Frames<'w>, options: &Options) -> Result<Vec<Entry<'w>>, CompareError> {
    let mut entries = Vec::new();
    let mut taken = HashSet::new();
    let mut next: HashMap<(Vec<String>, String), u64> = HashMap::new();
    let mut push = |top: &str, name: &str, source: Source<'w>| {
        // A vector without bits has nothing to show.
        if source.width() == 0 && matches!(source.kind(), ValueKind::Unsigned | ValueKind::Signed) {
            return;
        }
        let mut scopes: Vec<String> = std::iter::once(top).chain(name.split('.')).map(identifier).collect();
        let base = scopes.pop().unwrap_or_default();
        let mut name = base.clone();
        if taken.contains(&(scopes.clone(), name.clone())) {
            // The next number is kept, so that many names of one kind take no longer than others.
            let number = next.entry((scopes.clone(), base.clone())).or_insert(2);
            while taken.contains(&(scopes.clone(), name.clone())) {
                name = format!("{base}_{number}");
                *number += 1;
            }
        }
        taken.insert((scopes.clone(), name.clone()));
        entries.push(Entry { scopes, name, source });
    };
    if !frames.by_time {
        let wave = frames.a.wave;
        let clock = &wave.signals()[wave.clock()?.signal()];
        push("a", clock.leaf(), Source::Clock(clock));
    }
    for pair in pairs(frames, options)? {
        if let Some(a) = pair.a {
            push("a", &pair.name, Source::A(a));
        }
        if let Some(b) = pair.b {
            push("b", &pair.name, Source::B(b));
        }
        let bits = |signal: &Signal| matches!(signal.kind, ValueKind::Unsigned | ValueKind::Signed);
        if let (Some(a), Some(b)) = (pair.a, pair.b)
            && bits(a)
            && bits(b)
            && a.width == b.width
        {
            push("xor", &pair.name, Source::Xor(a, b));
        }
    }
    Ok(entries)
}

/// A name that every reader of VCD takes.
fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' };
    let mut plain: String = name.chars().map(plain).collect();
    if plain.is_empty() || plain.starts_with(|c: char| c.is_ascii_digit()) {
        plain.insert(0, '_');
    }
    plain
}

/// A time scale of VCD: a factor of 1, 10 or 100 and a unit.
type VcdScale = (u32, TimescaleUnit);

/// The time scale of the file, if one is known, and how many of it make a unit of the frames.
fn unit(frames: &Frames<'_>) -> Result<(Option<VcdScale>, u64), MergeError> {
    let unit = if frames.by_time { frames.unit } else { frames.a.wave.timescale() };
    let Some(unit) = unit else { return Ok((None, 1)) };
    let name = match unit.exponent {
        -15 => TimescaleUnit::FS,
        -12 => TimescaleUnit::PS,
        -9 => TimescaleUnit::NS,
        -6 => TimescaleUnit::US,
        -3 => TimescaleUnit::MS,
        0 => TimescaleUnit::S,
        _ => return Err(MergeError::Unit { unit }),
    };
    let factor = [100, 10].into_iter().find(|factor| unit.factor.is_multiple_of(*factor)).unwrap_or(1);
    Ok((Some((factor, name)), (unit.factor / factor).into()))
}

/// Writes the header and gives each distinct source its id code: an alias costs nothing.
fn header<'w>(
    writer: &mut Writer<impl Write>,
    entries: &[Entry<'w>],
    scale: Option<VcdScale>,
) -> io::Result<Vec<(Source<'w>, IdCode)>> {
    let mut sources = Vec::new();
    let mut ids: HashMap<_, IdCode> = HashMap::new();
    let mut open: &[String] = &[];
    writeln!(writer.writer(), "$version stepwave $end")?;
    writeln!(writer.writer(), "$comment two waves a and b; xor is 0 where they agree $end")?;
    if let Some((factor, unit)) = scale {
        writer.timescale(factor, unit)?;
    }
    for Entry { scopes, name, source } in entries {
        let common = open.iter().zip(scopes).take_while(|(x, y)| x == y).count();
        for _ in common..open.len() {
            writer.upscope()?;
        }
        scopes[common..].iter().try_for_each(|scope| writer.add_module(scope))?;
        open = scopes;
        let (var, width) = match (source.kind(), source.width()) {
            (ValueKind::Unsigned, width) => (VarType::Wire, width),
            (ValueKind::Signed, width) => (VarType::Integer, width),
            (ValueKind::Real, width) => (VarType::Real, width),
            (ValueKind::Text, _) => (VarType::String, 1),
            (ValueKind::Event, _) => (VarType::Event, 1),
        };
        let range = match (var, i32::try_from(width)) {
            (VarType::Wire, Ok(width @ 2..)) => Some(ReferenceIndex::Range(width - 1, 0)),
            _ => None,
        };
        match ids.get(&source.key()) {
            Some(id) => writer.var_def(var, width, *id, name, range)?,
            None => {
                let id = writer.add_var(var, width, name, range)?;
                ids.insert(source.key(), id);
                sources.push((*source, id));
            }
        }
    }
    for _ in open {
        writer.upscope()?;
    }
    writer.enddefinitions()?;
    Ok(sources)
}

/// Where times are written in the time scale of the file.
struct Times<'o, W> {
    out: &'o mut W,
    step: u64,
}

impl<W: Write> Times<'_, W> {
    fn write(&mut self, time: u64) -> io::Result<()> {
        let scaled = u128::from(time) * u128::from(self.step);
        writeln!(self.out, "#{scaled}")
    }
}

fn body(
    times: &mut Times<'_, impl Write>,
    mut tracks: Vec<Track<'_, '_>>,
    frames: &Frames<'_>,
) -> Result<(), MergeError> {
    let time_of = |track: &Track<'_, '_>, position: i128| match frames.by_time {
        // Positions are times already.
        true => u64::try_from(position).map(Some).map_err(|_| MergeError::TimeRange),
        false if track.is_clock() => Ok(u64::try_from(position).ok()),
        false => Ok(frames.a.time_of(position)),
    };
    let (start, mut now, end) = match frames.by_time {
        true => {
            let whole = |time: i128| u64::try_from(time).map_err(|_| MergeError::TimeRange);
            let last = frames.a.last_position().max(frames.b.last_position());
            (frames.common.start, whole(frames.common.start)?, whole(last)?)
        }
        false => {
            let all = frames.a.wave.times();
            (0, all.first().copied().unwrap_or(0), all.last().copied().unwrap_or(0))
        }
    };
    if end.checked_mul(times.step).is_none() {
        return Err(MergeError::TimeRange);
    }
    // The time of the next change, with its position; a track ends with the wave.
    let upcoming = |track: &mut Track<'_, '_>| -> Result<Option<(u64, i128)>, MergeError> {
        let Some(next) = track.next_change() else { return Ok(None) };
        Ok(time_of(track, next)?.map(|time| (time, next)))
    };
    times.write(now)?;
    writeln!(times.out, "$dumpvars")?;
    let mut queue = BinaryHeap::new();
    for (number, track) in tracks.iter_mut().enumerate() {
        let start = if track.is_clock() { now.into() } else { start };
        track.write(start, &mut |bytes| times.out.write_all(bytes))?;
        queue.extend(upcoming(track)?.map(|(time, next)| Reverse((time, number, next))));
    }
    writeln!(times.out, "$end")?;
    while let Some(mut top) = queue.peek_mut() {
        let Reverse((time, number, position)) = *top;
        let track = &mut tracks[number];
        track.write(position, &mut |bytes| {
            if time > now {
                now = time;
                times.write(now)?;
            }
            times.out.write_all(bytes)
        })?;
        match upcoming(track)? {
            Some((time, next)) => *top = Reverse((time, number, next)),
            None => drop(PeekMut::pop(top)),
        }
    }
    if end > now {
        times.write(end)?;
    }
    Ok(())
}
