//! The changes of nets as streams of small numbers, net by net, for readers without a library: the page of a run.
//!
//! A net has two streams of [numbers](crate::numbers). The first has, for its value in the first sample and for each
//! change after it, the clocks since the one before. The second has the differences of the values, modulo 2^width and read
//! as two's complement, from 0; of a net of one bit, which can only alternate, its first value alone.
//!
//! An accumulator changes by the same number again and again, and one that adds what another one holds by numbers that
//! change so. Where differences of differences take fewer bytes they are kept instead, up to the fourth [order](Net::order).

use std::io;
use std::ops::Range;

use stepwave_netlist::bits::to_signed;
use stepwave_netlist::{Rows, Width};

use super::WaveBody;
use super::moves::{Moves, SPAN};
use super::numbers::{pull_signed, push, push_signed};

/// A net that is recorded.
#[derive(Clone, Debug)]
struct Stream {
    column: usize,
    width: Width,
    /// Clock and value of its last change.
    clock: u64,
    value: u64,
    times: Vec<u8>,
    values: Vec<u8>,
}

/// Takes samples, one after another.
pub struct Changes {
    streams: Vec<Stream>,
    moves: Moves,
    /// First and last clock taken.
    taken: Option<(u64, u64)>,
    most: usize,
}

/// What was recorded.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Recorded {
    /// First and last clock; `None` without a sample.
    pub clocks: Option<(u64, u64)>,
    /// The nets, in their order.
    pub nets: Vec<Net>,
}

/// A net that was recorded.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Net {
    /// Clocks between changes.
    pub times: Vec<u8>,
    /// Differences of its values.
    pub values: Vec<u8>,
    /// How often sums of these, modulo 2^width, give its values: 1 to [`MOST_ORDER`].
    pub order: u32,
}

/// The highest order of differences.
pub const MOST_ORDER: u32 = 4;

impl Changes {
    /// Of the nets in these columns, in this order, in at most this many bytes.
    #[must_use]
    pub fn new(columns: &[(usize, Width)], most: usize) -> Changes {
        let stream = |&(column, width): &(usize, Width)| Stream {
            column,
            width,
            clock: 0,
            value: 0,
            times: Vec::new(),
            values: Vec::new(),
        };
        let moves = Moves::new(columns.iter().map(|(column, _)| *column).collect());
        Changes { streams: columns.iter().map(stream).collect(), moves, taken: None, most }
    }

    fn bytes(&self) -> usize {
        self.streams.iter().map(|stream| stream.times.len() + stream.values.len()).sum()
    }

    fn first(&mut self, clock: u64, rows: &Rows, row: usize) {
        self.moves.start(rows, row);
        for stream in &mut self.streams {
            stream.clock = clock;
            stream.take(clock, rows.value(stream.column, row));
        }
    }

    fn span(&mut self, rows: &Rows, range: Range<usize>) {
        self.moves.scan_nets(rows, range.clone());
        for (net, stream) in self.streams.iter_mut().enumerate() {
            let mut changes = self.moves.net(net);
            while changes != 0 {
                let row = range.start + changes.trailing_zeros() as usize;
                changes &= changes - 1;
                stream.take(rows.clock(row), rows.value(stream.column, row));
            }
        }
    }
}

impl WaveBody for Changes {
    type Output = Recorded;

    /// Samples in which no net changes may be missing.
    ///
    /// # Errors
    /// What changes takes more bytes than are allowed; nothing is taken then.
    fn rows(&mut self, rows: &Rows, mut range: Range<usize>) -> io::Result<()> {
        if range.is_empty() {
            return Ok(());
        }
        let (first, last) = (rows.clock(range.start), rows.clock(range.end - 1));
        if self.bytes() > self.most {
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("at clock {first}")));
        }
        if self.taken.is_none() {
            self.first(first, rows, range.start);
            range.start += 1;
        }
        for start in range.clone().step_by(SPAN) {
            self.span(rows, start..range.end.min(start + SPAN));
        }
        self.taken = Some((self.taken.map_or(first, |(first, _)| first), last));
        Ok(())
    }

    fn rest(&mut self, clock: u64) {
        self.taken = self.taken.map(|(first, _)| (first, clock));
    }

    fn finish(self) -> io::Result<Recorded> {
        Ok(Recorded { clocks: self.taken, nets: self.streams.into_iter().map(Stream::finish).collect() })
    }
}

impl Stream {
    fn take(&mut self, clock: u64, value: u64) {
        let first = self.times.is_empty();
        push(clock - self.clock, &mut self.times);
        if first || self.width.get() > 1 {
            push_signed(to_signed(self.width, value.wrapping_sub(self.value)), &mut self.values);
        }
        (self.clock, self.value) = (clock, value);
    }

    /// Takes the order of differences that needs the fewest bytes; a higher one only where it saves a twentieth.
    fn finish(self) -> Net {
        let (mut best, mut order) = (self.values, 1);
        if self.width.get() > 1 {
            let mut last = best.clone();
            for higher in 2..=MOST_ORDER {
                last = differences(&last, self.width);
                if last.len() * 20 < best.len() * 19 {
                    (best, order) = (last.clone(), higher);
                }
            }
        }
        Net { times: self.times, values: best, order }
    }
}

/// The differences of numbers, from 0, modulo 2^width and read as two's complement.
fn differences(mut numbers: &[u8], width: Width) -> Vec<u8> {
    let (mut before, mut out) = (0_i64, Vec::with_capacity(numbers.len()));
    while let Some(number) = pull_signed(&mut numbers) {
        push_signed(to_signed(width, number.wrapping_sub(before).cast_unsigned()), &mut out);
        before = number;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Reads a number, and for a signed one extends its sign; written without the module that writes them.
    fn read(bytes: &mut &[u8], signed: bool) -> u64 {
        let (mut number, mut shift) = (0_u64, 0);
        loop {
            let byte = bytes[0];
            *bytes = &bytes[1..];
            number |= u64::from(byte & 0x7F).checked_shl(shift).unwrap_or(0);
            shift += 7;
            if byte & 0x80 == 0 {
                let negative = signed && byte & 0x40 != 0 && shift < 64;
                return if negative { number | u64::MAX << shift } else { number };
            }
        }
    }

    /// The value of a net at every clock of a recording.
    fn decoded(recorded: &Recorded, net: usize, width: Width) -> Vec<u64> {
        let (first, last) = recorded.clocks.unwrap();
        let Net { times, values, order } = &recorded.nets[net];
        let (mut times, mut values) = (&times[..], &values[..]);
        let mask = u64::MAX >> (64 - width.get());
        let (mut clock, mut value, mut shown) = (first, 0_u64, Vec::new());
        let mut sums = [0_u64; MOST_ORDER as usize];
        while !times.is_empty() {
            clock += read(&mut times, false);
            let before = value;
            shown.resize(usize::try_from(clock - first).unwrap(), before);
            value = match (width.get(), values.is_empty()) {
                (1, true) => 1 - value,
                _ => {
                    let mut sum = read(&mut values, true);
                    for total in &mut sums[..*order as usize] {
                        sum = total.wrapping_add(sum);
                        *total = sum;
                    }
                    sum & mask
                }
            };
        }
        shown.resize(usize::try_from(last - first + 1).unwrap(), value);
        assert!(values.is_empty());
        shown
    }

    /// Samples of nets of these widths that rest, alternate, count, and jump.
    fn samples(widths: &[u32], seeds: &[u64]) -> Vec<Vec<u64>> {
        let column = |(net, &bits): (usize, &u32)| {
            let mask = u64::MAX >> (64 - bits);
            let value = |(clock, &seed): (usize, &u64)| match net % 5 {
                4 => (clock as u64).wrapping_pow(3).wrapping_mul(0x0123_4567) & mask,
                0 => seed & mask,
                1 => (clock as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) & mask,
                2 => {
                    if seed % 7 == 0 {
                        seed & mask
                    } else {
                        mask
                    }
                }
                _ => clock as u64 & mask,
            };
            seeds.iter().enumerate().map(value).collect()
        };
        widths.iter().enumerate().map(column).collect()
    }

    proptest! {
        #[test]
        fn what_is_read_back_is_what_was_taken(
            widths in prop::collection::vec(1..=64_u32, 1..80),
            seeds in prop::collection::vec(any::<u64>(), 1..300),
            from in 0..1000_u64,
            block in 1..130_usize,
        ) {
            let columns = samples(&widths, &seeds);
            let width = |bits: u32| Width::new(u64::from(bits)).unwrap();
            let nets: Vec<(usize, Width)> = widths.iter().enumerate().map(|(net, &bits)| (net, width(bits))).collect();
            let mut changes = Changes::new(&nets, usize::MAX);
            let mut rows = Rows::new(widths.len(), block);
            for start in (0..seeds.len()).step_by(block) {
                rows.clear();
                let end = seeds.len().min(start + block);
                (start..end).for_each(|at| rows.push(from + at as u64, |net| columns[net][at]));
                changes.rows(&rows, 0..rows.len()).unwrap();
            }
            let recorded = changes.finish().unwrap();
            prop_assert_eq!(recorded.clocks, Some((from, from + seeds.len() as u64 - 1)));
            for (net, column) in columns.iter().enumerate() {
                prop_assert_eq!(&decoded(&recorded, net, nets[net].1), column);
            }
        }
    }

    #[test]
    fn an_accumulator_takes_two_bytes_a_change_and_a_flag_one() {
        let width = |bits| Width::new(bits).unwrap();
        let mut changes = Changes::new(&[(0, width(24)), (1, width(1))], usize::MAX);
        let mut rows = Rows::new(2, 64);
        for clock in 0..64_u64 {
            rows.push(clock, |net| if net == 0 { (clock * 16_777_200) & 0xFF_FFFF } else { clock & 1 });
        }
        changes.rows(&rows, 0..64).unwrap();
        let recorded = changes.finish().unwrap();
        let bytes = |net: &Net| [net.times.len(), net.values.len()];
        assert_eq!((bytes(&recorded.nets[0]), recorded.nets[0].order), ([64, 64], 1));
        assert_eq!(bytes(&recorded.nets[1]), [64, 1]);
    }

    #[test]
    fn what_grows_as_a_cubic_takes_a_byte_a_change_by_its_fourth_differences() {
        let width = Width::new(60).unwrap();
        let mut changes = Changes::new(&[(0, width)], usize::MAX);
        let mut rows = Rows::new(1, 1000);
        (0..1000_u64).for_each(|clock| rows.push(clock, |_| clock.pow(3) * 0x0123_4567));
        changes.rows(&rows, 0..1000).unwrap();
        let recorded = changes.finish().unwrap();
        assert_eq!(recorded.nets[0].order, 4);
        assert!(recorded.nets[0].values.len() < 1030, "{} bytes", recorded.nets[0].values.len());
        assert_eq!(decoded(&recorded, 0, width)[777], 777_u64.pow(3) * 0x0123_4567);
    }

    #[test]
    fn what_is_passed_over_keeps_its_clocks_and_what_is_too_much_is_refused() {
        let width = Width::new(8).unwrap();
        let mut changes = Changes::new(&[(0, width)], 5);
        let mut rows = Rows::sparse(1, 8);
        for (clock, value) in [(3, 7), (900, 8), (1000, 8), (70_000, 0)] {
            rows.push(clock, |_| value);
        }
        changes.rows(&rows, 0..4).unwrap();
        let full = changes.rows(&rows, 0..1).unwrap_err();
        assert_eq!(full.kind(), io::ErrorKind::FileTooLarge);
        changes.rest(80_000);
        let recorded = changes.finish().unwrap();
        assert_eq!(recorded.clocks, Some((3, 80_000)));
        assert_eq!(recorded.nets[0].values, [7, 1, 0x78]);
        let shown = decoded(&recorded, 0, width);
        assert_eq!([0, 896, 897, 69_996, 69_997, 79_997].map(|at| shown[at]), [7, 7, 8, 8, 0, 0]);
    }
}
