use std::io::{self, Write};
use std::sync::{Arc, Mutex};

use stepwave_netlist::Rows;
use stepwave_netlist::cells::Format;

use super::VcdHeader;
use super::buffer::BUFFER;
use crate::WaveBody;
use crate::gtkw::tests::probe;
use crate::probe::{Probe, Role};
use crate::timescale::ClockTime;

/// Keeps what is written, and the length of each write.
#[derive(Clone, Default)]
struct Kept(Arc<Mutex<(Vec<u8>, Vec<usize>)>>);

impl Write for Kept {
    fn write(&mut self, part: &[u8]) -> io::Result<usize> {
        let (text, lengths) = &mut *self.0.lock().unwrap();
        text.extend_from_slice(part);
        lengths.push(part.len());
        Ok(part.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The wave of some rows in which all signals change, with a comment of this length; the lengths of the writes.
fn wave(signals: usize, rows: usize, comment: usize) -> (String, Vec<usize>) {
    let one = |index: usize| Probe {
        columns: vec![index],
        ..probe(&["top"], &format!("signal{index}"), 64, Format::Unsigned, Role::Register)
    };
    let probes: Vec<Probe> = (0..signals).map(one).collect();
    let time = ClockTime::from_hz(1e6).unwrap();
    let header = VcdHeader { comment: &"c".repeat(comment), probes: &probes, time, clk: true, states: false };
    let kept = Kept::default();
    let mut body = header.write(kept.clone()).unwrap();
    let mut block = Rows::new(signals, rows);
    for clock in 0..rows as u64 {
        block.push(clock, |column| (clock + column as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    }
    body.rows(&block, 0..rows).unwrap();
    body.finish().unwrap();
    let (text, lengths) = std::mem::take(&mut *kept.0.lock().unwrap());
    (String::from_utf8(text).unwrap(), lengths)
}

/// The same text as with a short comment, in writes of whole parts.
fn assert_whole_parts(signals: usize, rows: usize, comments: impl Iterator<Item = usize>) {
    let (short, _) = wave(signals, rows, 1);
    for comment in comments {
        let (text, lengths) = wave(signals, rows, comment);
        assert!(text == short.replacen(" c $end", &format!(" {} $end", "c".repeat(comment)), 1), "{comment}");
        let (_, whole) = lengths.split_last().unwrap();
        assert!(whole.iter().all(|length| length % BUFFER == 0), "{comment}: {lengths:?}");
    }
}

#[test]
fn a_header_of_any_length_is_followed_by_the_samples() {
    let rows = wave(20, 600, 1).0.len();
    assert!(rows > BUFFER);
    assert_whole_parts(20, 600, [0, 1, 100_000].into_iter().chain((BUFFER - 4000..BUFFER + 200).step_by(97)));
    assert_whole_parts(3, 2, BUFFER - 600..BUFFER - 200);
}

#[test]
fn a_row_may_be_longer_than_several_parts() {
    let signals = BUFFER / 25;
    assert_whole_parts(signals, 3, [1, 5000, BUFFER - 1].into_iter());
}
