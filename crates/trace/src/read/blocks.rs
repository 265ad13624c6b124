//! A quick look at the blocks of an FST file before it is decoded: what is cut off, and sizes that cannot be true or
//! that would fill the memory.

use super::{WaveError, limits};
use std::collections::HashMap;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};

/// The file formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Vcd,
    Fst,
}

/// An FST header block: type 0, then its length of 329 bytes.
const FST_HEADER: [u8; 9] = [0, 0, 0, 0, 0, 0, 0, 1, 73];
/// The type of the header, and where after its length it says how many blocks of changes there are.
const HEADER: u8 = 0;
const CHANGE_BLOCKS: u64 = 56 + 8;
/// The types of blocks of changes.
const CHANGES: u8 = 1;
const CHANGES_ALIASED: u8 = 5;
const CHANGES_ALIASED_SIGNED: u8 = 8;
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

/// The FST inside a file that is one compressed as a whole; nothing for any other.
pub(super) fn unwrapped(input: &mut (impl Read + Seek), name: &str, length: u64) -> Result<Option<Vec<u8>>, WaveError> {
    let io = |source| WaveError::Io { name: name.into(), source };
    if length == 0 || first_byte(input, 0).map_err(io)? != FST_WRAPPER {
        input.rewind().map_err(io)?;
        return Ok(None);
    }
    let cut = || WaveError::CutOff { name: name.into(), place: "byte 1".into(), what: "a block" };
    let malformed = |reason: &str| WaveError::Malformed { name: name.into(), reason: reason.into() };
    // Two lengths, and a gzip header without fields of its own.
    let [_, claimed] = u64s(input, 1).map_err(|_| cut())?;
    let mut packed = Vec::new();
    input.read_to_end(&mut packed).map_err(io)?;
    let packed = match packed.get(..10) {
        Some([0x1f, 0x8b, 8, 0, ..]) => &packed[10..],
        _ => return Err(malformed("its gzip header is another one than FST writers make")),
    };
    let limit = limits::inflated(length);
    if claimed > limit {
        return Err(too_much(name, "the FST that it holds in gzip", limit));
    }
    // Not more than claimed, and some memory that is reserved in advance.
    let limit = usize::try_from(claimed).unwrap_or(usize::MAX);
    let bytes = miniz_oxide::inflate::decompress_to_vec_with_limit(packed, limit)
        .map_err(|_| malformed("the FST that it holds in gzip is broken or cut off"))?;
    Ok(Some(bytes))
}

fn too_much(name: &str, what: &str, limit: u64) -> WaveError {
    WaveError::TooMuch { name: name.into(), what: what.into(), limit: limits::mebibytes(limit) }
}

/// Walks the blocks of an FST file: each must end inside the file, claim no more content than its bytes can hold, and
/// all together no more than the [limit](limits::inflated).
pub(super) fn check(input: &mut (impl Read + Seek), name: &str, length: u64) -> Result<(), WaveError> {
    let cut = |at: u64| WaveError::CutOff { name: name.into(), place: format!("byte {at}"), what: "a block" };
    let io = |source| WaveError::Io { name: name.into(), source };
    let end = input.seek(SeekFrom::End(0)).map_err(io)?;
    let limit = limits::inflated(length);
    let mut room = limit;
    let (mut at, mut found, mut said) = (0, 0, 0);
    while at < end {
        let (kind, length) = match u64s(input, at + 1) {
            Ok([length]) => (first_byte(input, at).map_err(io)?, length),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Err(cut(at)),
            Err(error) => return Err(io(error)),
        };
        let next = at.checked_add(length).and_then(|sum| sum.checked_add(1));
        let next = next.filter(|next| length >= 8 && *next <= end).ok_or_else(|| cut(at))?;
        let Some(claimed) = plausible(input, kind, at + 1, length).map_err(io)? else {
            let reason = format!("the FST block at byte {at} claims more content than it can hold");
            return Err(WaveError::Malformed { name: name.into(), reason });
        };
        room = room.checked_sub(claimed).ok_or_else(|| too_much(name, "the content of its blocks", limit))?;
        match kind {
            HEADER if length >= CHANGE_BLOCKS + 8 => [said] = u64s(input, at + 1 + CHANGE_BLOCKS).map_err(io)?,
            CHANGES | CHANGES_ALIASED | CHANGES_ALIASED_SIGNED => found += 1,
            _ => {}
        }
        at = next;
    }
    // A file that is cut off between two blocks looks whole but for their number. While one is written the header says
    // 0.
    if found < said {
        return Err(WaveError::CutOff {
            name: name.into(),
            place: format!("byte {end}"),
            what: "its blocks of changes",
        });
    }
    Ok(())
}

/// The bytes of memory that the block of this kind, whose length field is at `at`, claims; nothing if its sizes cannot
/// be true. The decoder reserves memory by them before it looks any further, and running out of memory is not an error
/// that can be caught.
fn plausible(input: &mut (impl Read + Seek), kind: u8, at: u64, length: u64) -> io::Result<Option<u64>> {
    // The most that deflate makes of a byte; LZ4 stays below.
    let expanded = |bytes: u64| bytes.saturating_mul(1032);
    let claim = |bytes: u64, most: u64| (bytes <= most).then_some(bytes);
    Ok(match kind {
        CHANGES | CHANGES_ALIASED | CHANGES_ALIASED_SIGNED if length >= 56 => changes(input, kind, at, length)?,
        2 => {
            input.seek(SeekFrom::Start(at + 8))?;
            claim(varint(input)?, length).map(|blackouts| blackouts.saturating_mul(16))
        }
        3 if length >= 24 => {
            let [bytes, handles] = u64s(input, at + 8)?;
            claim(bytes, expanded(length)).and_then(|_| claim(handles, bytes)).map(|all| all.saturating_mul(16))
        }
        4 | 6 if length >= 16 => u64s(input, at + 8).map(|[bytes]| claim(bytes, expanded(length)))?,
        // Packed twice.
        7 if length >= 17 => {
            let [bytes] = u64s(input, at + 8)?;
            let middle = varint(input)?;
            claim(middle, expanded(length)).and_then(|_| claim(bytes, expanded(middle)))
        }
        CHANGES | 3..=CHANGES_ALIASED_SIGNED => None,
        _ => Some(0),
    })
}

/// As [`plausible`], of a block of changes. At its end are the size of the table of places, the table of times, and the
/// sizes of the latter.
fn changes(input: &mut (impl Read + Seek), kind: u8, at: u64, length: u64) -> io::Result<Option<u64>> {
    let expanded = |bytes: u64| bytes.saturating_mul(1032);
    let [bytes, packed, times] = u64s(input, at + length - 24)?;
    input.seek(SeekFrom::Start(at + 32))?;
    let [frame, packed_frame, handles] = [varint(input)?, varint(input)?, varint(input)?];
    let start = input.stream_position()?.saturating_add(packed_frame);
    let inside = start < at + length && packed <= length && bytes <= expanded(packed) && times <= bytes;
    if !inside || packed + 32 > length || frame > expanded(packed_frame) {
        return Ok(None);
    }
    let table_end = at + length - packed - 32;
    let [places] = u64s(input, table_end)?;
    input.seek(SeekFrom::Start(start))?;
    if places > length || varint(input)? != handles || handles > expanded(length) {
        return Ok(None);
    }
    let first = input.stream_position()?;
    let Some(table) = table_end.checked_sub(places).filter(|table| *table > first) else { return Ok(None) };
    input.seek(SeekFrom::Start(table))?;
    let mut written = Vec::new();
    input.by_ref().take(places).read_to_end(&mut written)?;
    let Some(uses) = chains(&written, kind == CHANGES_ALIASED_SIGNED) else { return Ok(None) };
    let mut claimed = times.saturating_mul(TIME).saturating_add(frame).saturating_add(handles.saturating_mul(HANDLE));
    let fastlz = first_byte(input, first)? == b'F';
    for (number, (offset, used)) in uses.iter().enumerate() {
        let end = uses.get(number + 1).map_or(table - first, |(next, _)| *next);
        let length = end.saturating_sub(*offset);
        input.seek(SeekFrom::Start(first.saturating_add(*offset)))?;
        // A chain that is not packed says 0.
        let size = match varint(input)? {
            0 => length,
            size => size,
        };
        // Unpacking of FastLZ continues beyond the claimed size.
        let beyond = if fastlz { length.saturating_mul(255).saturating_mul(used - 1) } else { 0 };
        claimed = claimed.saturating_add(size.saturating_mul(*used)).saturating_add(beyond);
    }
    Ok(Some(claimed))
}

/// Bytes that the decoder takes for each time and each handle of a block.
const TIME: u64 = 24;
const HANDLE: u64 = 300;

/// The offsets of the chains of changes in a table of places, and how many handles use each; nothing if an alias points
/// nowhere.
fn chains(mut table: &[u8], signed: bool) -> Option<Vec<(u64, u64)>> {
    let mut uses: Vec<(u64, u64)> = Vec::new();
    // By handle, the place in `uses`.
    let mut handles: HashMap<u64, usize> = HashMap::new();
    let (mut handle, mut offset, mut alias) = (0u64, 0u64, 0u64);
    while !table.is_empty() {
        let aliased = if signed && table[0] & 1 == 1 {
            match signed_varint(&mut table).ok()? >> 1 {
                step @ 1.. => {
                    offset = offset.checked_add(step.unsigned_abs())?;
                    None
                }
                0 => Some(alias),
                back => {
                    alias = back.unsigned_abs() - 1;
                    Some(alias)
                }
            }
        } else {
            match varint(&mut table).ok()? {
                0 if !signed => Some(varint(&mut table).ok()?.checked_sub(1)?),
                step if !signed && step & 1 == 1 => {
                    offset = offset.checked_add(step >> 1)?;
                    None
                }
                empty => {
                    handle = handle.checked_add(empty >> 1)?;
                    continue;
                }
            }
        };
        match aliased {
            Some(other) => uses.get_mut(*handles.get(&other)?)?.1 += 1,
            None => {
                handles.insert(handle, uses.len());
                uses.push((offset, 1));
            }
        }
        handle = handle.checked_add(1)?;
    }
    Some(uses)
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

/// The same with a sign, which is the highest bit of the last group.
fn signed_varint(input: &mut impl Read) -> io::Result<i64> {
    let mut number = 0i64;
    for shift in (0..63).step_by(7) {
        let mut byte = [0];
        input.read_exact(&mut byte)?;
        number |= i64::from(byte[0] & 0x7f) << shift;
        if byte[0] < 0x80 {
            let unused = 64 - (shift + 7).min(64);
            return Ok(number << unused >> unused);
        }
    }
    Err(io::Error::from(ErrorKind::InvalidData))
}
