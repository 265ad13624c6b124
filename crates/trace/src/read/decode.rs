//! From the bytes of a file to a [`Wave`].

use super::blocks::Format;
use super::{Clock, ClockError, Content, Wave, WaveError, fst, limits, vcd};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};

/// Decodes a file whose format is known.
pub(super) fn wave(mut input: impl BufRead + Seek, format: Format, name: String) -> Result<Wave, WaveError> {
    let io = |source| WaveError::Io { name: name.clone(), source };
    let length = input.seek(SeekFrom::End(0)).map_err(io)?;
    input.rewind().map_err(io)?;
    let content = match format {
        Format::Vcd => vcd::read(&mut input, &name, length)?,
        Format::Fst => fst::read(input, &name, length)?,
    };
    Ok(finished(content, name))
}

/// Decodes what a pipe gives; `head` has been read already.
pub(super) fn piped(head: Vec<u8>, rest: impl Read, format: Format, name: String) -> Result<Wave, WaveError> {
    let mut all = head.as_slice().chain(rest).take(limits::MAX_PIPE + 1);
    let content = match format {
        Format::Vcd => {
            let mut input = BufReader::with_capacity(1 << 16, &mut all);
            vcd::read(&mut input, &name, 0)
        }
        Format::Fst => {
            let mut bytes = Vec::new();
            all.read_to_end(&mut bytes).map_err(|source| WaveError::Io { name: name.clone(), source })?;
            let length = bytes.len() as u64;
            if all.limit() == 0 {
                Err(WaveError::Endless { name: name.clone() })
            } else {
                fst::read(std::io::Cursor::new(bytes), &name, length)
            }
        }
    };
    if all.limit() == 0 {
        return Err(WaveError::Endless { name });
    }
    Ok(finished(content?, name))
}

fn finished(content: Content, name: String) -> Wave {
    let Content { signals, stored, times, timescale, states } = content;
    let clock = Err(ClockError::None { name: name.clone(), candidates: Vec::new() });
    let mut wave = Wave { name, timescale, times, signals, stored, states, clock };
    wave.clock = Clock::found(&wave);
    wave
}
