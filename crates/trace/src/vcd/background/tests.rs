//! With a thread that has too little, enough, or now one and now the other to do, the bytes are those of no thread.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use stepwave_netlist::cells::Format;

use super::*;
use crate::WaveBody;
use crate::gtkw::tests::probe;
use crate::probe::{Probe, Role};
use crate::timescale::ClockTime;
use crate::vcd::{VcdBody, VcdHeader};

/// Keeps what is written, at most this many bytes, and waits after some of the writes.
#[derive(Clone)]
struct Disk {
    text: Arc<Mutex<Vec<u8>>>,
    room: usize,
    /// Writes are numbered; whether to wait after one.
    slow: fn(usize) -> bool,
    writes: usize,
}

impl Write for Disk {
    fn write(&mut self, part: &[u8]) -> io::Result<usize> {
        let mut text = self.text.lock().unwrap();
        if text.len() + part.len() > self.room {
            return Err(io::Error::new(io::ErrorKind::StorageFull, "cannot write w.vcd: no space"));
        }
        text.extend_from_slice(part);
        drop(text);
        self.writes += 1;
        if (self.slow)(self.writes) {
            thread::sleep(Duration::from_millis(4));
        }
        Ok(part.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn disk(room: usize, slow: fn(usize) -> bool) -> Disk {
    Disk { text: Arc::default(), room, slow, writes: 0 }
}

/// Nets of 1 to 64 bits, more than a group of them, and words of more in between.
fn probes() -> Vec<Probe> {
    let mut column = 0;
    let one = |(index, width): (usize, u32)| {
        let columns: Vec<usize> = (column..column + width.div_ceil(64) as usize).collect();
        column = columns[columns.len() - 1] + 1;
        let names = (["top"], format!("signal{index}"));
        Probe { columns, ..probe(&names.0, &names.1, width, Format::Unsigned, Role::Register) }
    };
    (1..=80)
        .map(|index| if index % 20 == 7 { 60 + index } else { index % 65 })
        .map(|width| width.max(1))
        .enumerate()
        .map(one)
        .collect()
}

/// A value of this many bits that rests, counts, or jumps.
fn value(column: usize, width: u32, clock: u64) -> u64 {
    let jumping = (clock + column as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 3;
    let value = match column % 5 {
        0 => clock / 700,
        1 => clock,
        2 => jumping,
        3 if clock % 11 < 8 => 3,
        _ => jumping >> (clock % 50),
    };
    value & (u64::MAX >> (64 - width))
}

struct Job {
    probes: Vec<Probe>,
    clk: bool,
    sparse: bool,
    blocks: u64,
}

impl Job {
    fn body(&self, disk: Disk) -> VcdBody<Disk> {
        let time = ClockTime::from_hz(1e6).unwrap();
        VcdHeader { comment: "c", probes: &self.probes, time, clk: self.clk, states: false }.write(disk).unwrap()
    }

    /// Shows blocks of different lengths, their first rows left out at times; `after` is called after each with its number.
    fn show(
        &self,
        body: &mut VcdBody<Disk>,
        blocks: Range<u64>,
        mut after: impl FnMut(u64, &mut VcdBody<Disk>),
    ) -> io::Result<()> {
        let widths: Vec<u32> = self.probes.iter().flat_map(|probe| parts(probe.width)).collect();
        let columns = widths.len();
        let mut rows = if self.sparse { Rows::sparse(columns, 200) } else { Rows::new(columns, 200) };
        let mut clock = 5 + 2000 * blocks.start;
        for block in blocks {
            rows.clear();
            for row in 0..block * 37 % 200 + 1 {
                rows.push(clock, |column| value(column, widths[column], clock));
                clock += if self.sparse && row % 3 == 0 { 1 + clock % 9 } else { 1 };
            }
            // Where clocks are missing the stamps are set anew.
            clock += block / 50 % 2;
            let from = if block % 7 == 3 { rows.len() / 3 } else { 0 };
            body.rows(&rows, from..rows.len())?;
            after(block, body);
        }
        body.rest(clock + 3);
        Ok(())
    }

    fn text(&self, disk: &Disk, prepare: fn(&mut VcdBody<Disk>)) -> io::Result<Vec<u8>> {
        let mut body = self.body(disk.clone());
        self.show(&mut body, 0..self.blocks, first(prepare))?;
        body.finish()?;
        Ok(std::mem::take(&mut *disk.text.lock().unwrap()))
    }
}

/// Done after the first block.
fn first(prepare: fn(&mut VcdBody<Disk>)) -> impl FnMut(u64, &mut VcdBody<Disk>) {
    move |block, body| {
        if block == 0 {
            prepare(body);
        }
    }
}

fn worker(body: &mut VcdBody<Disk>) -> &mut Worker<Disk> {
    let State::Thread(worker) = &mut body.out.state else { panic!("it has ended") };
    worker
}

/// Bits of every column of a word.
fn parts(width: u32) -> impl Iterator<Item = u32> {
    (0..width.div_ceil(64)).map(move |part| (width - 64 * part).min(64))
}

/// No thread is started.
fn alone(body: &mut VcdBody<Disk>) {
    let State::Direct { may_start, .. } = &mut body.out.state else { panic!("it has begun") };
    *may_start = false;
}

/// One is started at once, whatever the cores.
fn threaded(body: &mut VcdBody<Disk>) {
    let writer = body.out.writer().unwrap();
    body.out.state = State::Thread(Box::new(Worker::start(writer).unwrap()));
}

#[test]
fn the_bytes_are_those_of_no_thread_however_fast_the_output_is() {
    for (clk, sparse) in [(true, false), (false, false), (false, true), (true, true)] {
        let job = Job { probes: probes(), clk, sparse, blocks: 60 };
        let expected = job.text(&disk(usize::MAX, |_| false), alone).unwrap();
        assert!(expected.len() > 6 * BATCHES, "{}", expected.len());
        for slow in [|_| false, |_| true, |write| write / 4 % 2 == 0] {
            assert!(job.text(&disk(usize::MAX, slow), threaded).unwrap() == expected, "{clk} {sparse}");
        }
        assert!(job.text(&disk(usize::MAX, |_| false), |_| ()).unwrap() == expected, "{clk} {sparse}");
    }
}

/// Bytes of text that a batch may come to, about.
const BATCHES: usize = 1 << 20;

#[test]
fn the_run_makes_text_while_the_thread_has_enough_to_do_and_not_after_it() {
    let job = Job { probes: probes(), clk: true, sparse: false, blocks: 0 };
    let disk = disk(usize::MAX, |_| false);
    let mut body = job.body(disk.clone());
    // Nothing is written while the text is held here. The first part, which the thread cannot end, is one of those in flight.
    let held = disk.text.lock().unwrap();
    job.show(&mut body, 0..1, first(threaded)).unwrap();
    let mut block = 1;
    while !worker(&mut body).is_text {
        job.show(&mut body, block..block + 1, |_, _| ()).unwrap();
        block += 1;
        assert!(worker(&mut body).link.in_flight <= ENOUGH);
    }
    assert_eq!(worker(&mut body).link.in_flight, ENOUGH);
    drop(held);
    while worker(&mut body).link.in_flight > 0 {
        worker(&mut body).link.is_busy();
        thread::yield_now();
    }
    // With the next part of text it is seen that the thread waits.
    let busy = block;
    while worker(&mut body).is_text {
        job.show(&mut body, block..block + 1, |_, _| ()).unwrap();
        block += 1;
        assert!(block < busy + 100, "it makes text for ever");
    }
    body.finish().unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn the_thread_leaves_a_core_to_the_run() {
    use std::sync::atomic::{AtomicU32, Ordering};

    use rustix::thread::sched_getaffinity;

    static ALLOWED: AtomicU32 = AtomicU32::new(0);
    let note = |_| {
        if thread::current().name() == Some("wave writer") {
            ALLOWED.store(sched_getaffinity(None).unwrap().count(), Ordering::Relaxed);
        }
        false
    };
    let job = Job { probes: probes(), clk: true, sparse: false, blocks: 60 };
    job.text(&disk(usize::MAX, note), threaded).unwrap();
    let all = sched_getaffinity(None).unwrap().count();
    assert_eq!(ALLOWED.load(Ordering::Relaxed), (all - 1).max(1));
}

#[test]
fn a_full_disk_is_reported_in_its_own_words_wherever_it_happens() {
    let job = Job { probes: probes(), clk: true, sparse: false, blocks: 60 };
    let all = job.text(&disk(usize::MAX, |_| false), alone).unwrap().len();
    for slow in [|_| false, |_| true] {
        for room in [0, SMALL + 50_000, all / 2, all / 4 * 3, all - 1] {
            for prepare in [alone, threaded] {
                let error = job.text(&disk(room, slow), prepare).err().map(|error| error.to_string());
                assert_eq!(error.as_deref(), Some("cannot write w.vcd: no space"), "{room} of {all}");
            }
        }
    }
}

#[test]
fn what_is_dropped_unfinished_neither_waits_for_ever_nor_panics() {
    let job = Job { probes: probes(), clk: true, sparse: false, blocks: 60 };
    for room in [SMALL, usize::MAX] {
        let mut body = job.body(disk(room, |_| true));
        let _ = job.show(&mut body, 0..60, first(threaded));
        drop(body);
    }
}
