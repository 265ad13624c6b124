//! Random waves, read back by two readers that are not this project's.

use std::io::Cursor;

use fst_reader::{FstFilter, FstHierarchyEntry, FstReader, FstSignalValue};
use proptest::prelude::*;

use super::*;
use crate::probe::Role;
use stepwave_netlist::cells::Format;

/// What a signal does.
#[derive(Clone, Copy, Debug)]
enum Habit {
    /// Never changes.
    Rests,
    /// Changes in every sample.
    Runs,
    /// Changes in one of this many samples.
    Moves(u64),
    /// Is as the signal before it.
    Copies,
}

#[derive(Clone, Debug)]
struct Case {
    signals: Vec<(u32, Habit)>,
    clk: bool,
    first_clock: u64,
    /// Samples of each block, and those that are left out after it.
    blocks: Vec<(usize, usize)>,
    /// Bytes of a section.
    section: usize,
    seed: u64,
}

fn habit() -> impl Strategy<Value = Habit> {
    prop_oneof![Just(Habit::Rests), Just(Habit::Runs), (2..400_u64).prop_map(Habit::Moves), Just(Habit::Copies)]
}

fn case() -> impl Strategy<Value = Case> {
    let width = prop_oneof![Just(1_u32), Just(64), 2..=64_u32, 1..=200_u32];
    let signals = proptest::collection::vec((width, habit()), 1..12);
    let blocks = proptest::collection::vec((1..500_usize, prop_oneof![Just(0_usize), 0..70_usize]), 1..6);
    let first_clock = prop_oneof![Just(0_u64), 1..5_000_000_u64];
    let section = prop_oneof![Just(SECTION), 1..20_000_usize];
    (signals, any::<bool>(), first_clock, blocks, section, any::<u64>()).prop_map(
        |(signals, clk, first_clock, blocks, section, seed)| Case { signals, clk, first_clock, blocks, section, seed },
    )
}

/// Numbers without a pattern.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        self.0 ^ self.0 >> 29
    }
}

/// The changes of a signal: times and digits.
type Changes = Vec<(u64, String)>;

impl Case {
    fn parts(width: u32) -> usize {
        width.div_ceil(64) as usize
    }

    fn probes(&self) -> Vec<Probe> {
        let mut column = 0;
        let mut probe = |(index, &(width, _)): (usize, &(u32, Habit))| {
            let columns: Vec<usize> = (column..column + Case::parts(width)).collect();
            column += columns.len();
            let scopes = vec!["top".to_owned(), format!("s{}", index / 3)];
            let (format, role) = (Format::Unsigned, Role::Register);
            Probe { scopes, name: format!("n{index}"), width, format, role, columns }
        };
        self.signals.iter().enumerate().map(&mut probe).collect()
    }

    /// The next sample, from the one before.
    fn step(&self, values: &mut [Vec<u64>], noise: &mut Noise) {
        for (index, &(width, habit)) in self.signals.iter().enumerate() {
            let moves = match habit {
                Habit::Rests => false,
                Habit::Runs => true,
                Habit::Moves(seldom) => noise.next() >> 8 & 0xFFFF < 0x10000 / seldom,
                Habit::Copies => {
                    if index > 0 && self.signals[index - 1].0 == width {
                        values[index] = values[index - 1].clone();
                    }
                    false
                }
            };
            if moves {
                values[index][0] ^= 1;
                let other = noise.next() & noise.next();
                values[index].iter_mut().for_each(|part| *part ^= other & !1);
                let top = values[index].last_mut().expect("a part");
                *top &= u64::MAX >> (63 - (width - 1) % 64);
            }
        }
    }

    fn digits(width: u32, value: &[u64]) -> String {
        let all: String = value.iter().rev().map(|part| format!("{part:064b}")).collect();
        all[all.len() - width as usize..].to_owned()
    }

    /// The file, and what it must hold.
    fn write(&self) -> (Vec<u8>, Vec<Changes>, u64) {
        let (probes, time) = (self.probes(), ClockTime::from_hz(1e6).expect("a usual clock"));
        let ticks = time.ticks();
        let header = FstHeader { probes: &probes, time, clk: self.clk };
        let mut body = header.write(Cursor::new(Vec::new())).expect("memory");
        body.sections.limit = self.section;
        let columns = self.signals.iter().map(|&(width, _)| Case::parts(width)).sum();
        let mut values: Vec<Vec<u64>> = self.signals.iter().map(|&(width, _)| vec![0; Case::parts(width)]).collect();
        let mut noise = Noise(self.seed);
        let mut clock = self.first_clock;
        let mut expected: Vec<Changes> = vec![Vec::new(); self.signals.len()];
        for &(samples, pause) in &self.blocks {
            let mut rows = Rows::new(columns, samples + pause);
            for index in 0..samples + pause {
                let flat: Vec<u64> = values.iter().flatten().copied().collect();
                rows.push(clock, |column| flat[column]);
                for (changes, (&(width, _), value)) in expected.iter_mut().zip(self.signals.iter().zip(&values)) {
                    let now = Case::digits(width, value);
                    if index < samples && changes.last().is_none_or(|(_, before)| *before != now) {
                        changes.push((clock * ticks, now));
                    }
                }
                clock += 1;
                self.step(&mut values, &mut noise);
            }
            body.rows(&rows, 0..samples).expect("memory");
        }
        let last = clock - 1 - self.blocks.last().map_or(0, |(_, pause)| *pause) as u64;
        (body.finish().expect("memory").into_inner(), expected, (last + 1) * ticks)
    }
}

/// The changes by the crate `fst-reader`, the clock first.
fn by_fst_reader(file: &[u8]) -> (Vec<Changes>, Vec<u64>) {
    let mut reader = FstReader::open_and_read_time_table(Cursor::new(file)).expect("an FST");
    let mut signals = 0;
    reader
        .read_hierarchy(|entry| signals += usize::from(matches!(entry, FstHierarchyEntry::Var { is_alias: false, .. })))
        .expect("names");
    let mut changes: Vec<Changes> = vec![Vec::new(); signals];
    let take = |time, handle: fst_reader::FstSignalHandle, value: FstSignalValue<'_>| {
        let FstSignalValue::String(digits) = value else { return Err(()) };
        changes[handle.get_index()].push((time, String::from_utf8_lossy(digits).into_owned()));
        Ok(())
    };
    reader.read_signals(&FstFilter::all(), take).expect("changes");
    (changes, reader.get_time_table().expect("times").to_vec())
}

/// The changes by the crate `wellen`, in the order of the names.
fn by_wellen(file: &[u8]) -> Vec<Changes> {
    let mut wave = wellen::simple::read_from_reader(Cursor::new(file.to_vec())).expect("an FST");
    let signals: Vec<_> = wave.hierarchy().signals().collect();
    wave.load_signals(&signals);
    let variables: Vec<_> = wave.hierarchy().all_vars().collect();
    let times = wave.time_table();
    let of = |variable: wellen::VarRef| {
        let signal = wave.hierarchy()[variable].signal_ref();
        let changes = wave.get_signal(signal).expect("a loaded signal").iter_changes();
        changes.map(|(time, value)| (times[time as usize], value.to_bit_string().expect("bits"))).collect()
    };
    variables.into_iter().map(of).collect()
}

/// The edges of a clock, if there is one.
fn check_clock(case: &Case, clock: &Changes) {
    let ticks = 10;
    let mut edges = Vec::new();
    let mut at = case.first_clock;
    for &(samples, pause) in &case.blocks {
        for _ in 0..samples {
            if at > 0 {
                edges.extend([(at * ticks, "1".to_owned()), (at * ticks + ticks / 2, "0".to_owned())]);
            } else {
                edges.push((0, "0".to_owned()));
            }
            at += 1;
        }
        at += pause as u64;
    }
    assert_eq!(*clock, edges);
}

fn check(case: &Case) {
    let (file, expected, end) = case.write();
    assert!(file == case.write().0, "the same wave gives the same bytes");
    let (mut changes, times) = by_fst_reader(&file);
    assert_eq!(times.last(), Some(&end));
    let mut others = by_wellen(&file);
    if case.clk {
        check_clock(case, &changes.remove(0));
        check_clock(case, &others.remove(0));
    }
    assert_eq!(changes, expected, "fst-reader");
    assert_eq!(others, expected, "wellen");
}

proptest! {
    #[test]
    fn random_waves_read_back_as_they_were(case in case()) {
        check(&case);
    }
}

#[test]
fn every_width_reads_back_in_any_number_of_sections() {
    for section in [1, 5_000, SECTION] {
        let signals: Vec<(u32, Habit)> =
            (1..=200).map(|width| (width, [Habit::Runs, Habit::Moves(9)][width as usize % 2])).collect();
        let case = Case {
            signals,
            clk: section > 1,
            first_clock: 3,
            blocks: vec![(200, 0), (3, 64), (130, 0)],
            section,
            seed: 5,
        };
        check(&case);
    }
}

#[test]
fn a_wave_without_a_sample_is_a_file() {
    let probes =
        Case { signals: vec![(3, Habit::Rests)], clk: true, first_clock: 0, blocks: vec![], section: 1, seed: 1 }
            .probes();
    let header = FstHeader { probes: &probes, time: ClockTime::from_hz(1e6).expect("a usual clock"), clk: true };
    let file = header.write(Cursor::new(Vec::new())).and_then(FstBody::finish).expect("memory").into_inner();
    let (changes, times) = by_fst_reader(&file);
    assert_eq!(changes, [vec![(0, "x".to_owned())], vec![(0, "xxx".to_owned())]]);
    assert_eq!(times, [0, 10]);
}

#[test]
fn signals_of_the_same_changes_are_written_once() {
    let of = |habit| Case {
        signals: vec![(24, Habit::Runs), (24, habit)],
        clk: true,
        first_clock: 1,
        blocks: vec![(5000, 0)],
        section: SECTION,
        seed: 3,
    };
    let (alone, copied, twice) = (of(Habit::Rests), of(Habit::Copies), of(Habit::Runs));
    check(&copied);
    let [alone, copied, twice] = [alone, copied, twice].map(|case| case.write().0.len());
    assert!(copied < alone + 100 && copied + 10_000 < twice, "{alone} {copied} {twice}");
}
