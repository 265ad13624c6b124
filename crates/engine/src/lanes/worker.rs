//! A worker: a block of lanes that takes jobs, loads them, runs its lanes, and gives ends.

use std::collections::VecDeque;

use super::LaneProgram;
use super::code::{Code, RegisterRow, Slot};
use super::feed::Feed;
use super::lane::{GROUP, LANES};
use super::lane_machine::{LaneMachine, Loops};
use super::lane_memory::LaneMemories;
use super::native::Frame;
use super::watch::{Job, LaneEnd, LaneStop, Observe};
use stepwave_netlist::bits::Width;

/// A lane in use.
struct Busy {
    number: u64,
    job: Job,
    /// Blocks loaded so far.
    loaded: usize,
    /// Present values of all inputs.
    inputs: Vec<u64>,
    /// Clock of the last sample.
    clock: u64,
    /// The clock at which it is examined, regardless of its nets.
    due: u64,
}

/// What becomes of a lane that was looked at.
enum Verdict {
    Goes,
    Loads,
    Ends(LaneStop),
}

pub(super) struct Worker<'p, T> {
    program: &'p LaneProgram,
    /// All lanes, running.
    lanes: LaneMachine<T>,
    /// A few lanes, loading or being read.
    loader: LaneMachine<T>,
    memories: LaneMemories<T>,
    /// Where native code works.
    frame: Option<Frame<T>>,
    /// Lanes that run at once.
    most: usize,
    busy: Vec<Busy>,
    queue: VecDeque<(u64, Job)>,
    ends: Vec<(u64, LaneEnd)>,
}

impl<'p, T: Loops> Worker<'p, T> {
    pub(super) fn new(program: &'p LaneProgram, most: usize) -> Worker<'p, T> {
        Worker {
            program,
            lanes: LaneMachine::new(&program.running),
            loader: LaneMachine::new(&program.whole),
            memories: LaneMemories::new(program.memories.iter().map(Option::as_ref), most),
            frame: None,
            most,
            busy: Vec::with_capacity(LANES),
            queue: VecDeque::new(),
            ends: Vec::new(),
        }
    }

    /// Takes and runs jobs until there are no more.
    pub(super) fn work<J, E, I, S>(
        mut self,
        feed: &Feed<I, Result<LaneEnd, E>, S>,
        share: usize,
        prepare: &impl Fn(J) -> Result<Job, E>,
    ) where
        I: Iterator<Item = J>,
        S: FnMut(Result<LaneEnd, E>),
    {
        let abort = AbortOnPanic(|| feed.abort());
        let mut taken = VecDeque::new();
        let mut room = self.most.min(share);
        loop {
            feed.take(room, &mut taken);
            let mut failed = Vec::new();
            for (number, item) in taken.drain(..) {
                match prepare(item) {
                    Ok(job) => self.queue.push_back((number, job)),
                    Err(error) => failed.push((number, Err(error))),
                }
            }
            feed.give(failed.into_iter());
            self.fill();
            if self.busy.is_empty() {
                if !feed.wait() {
                    break;
                }
                continue;
            }
            while self.ends.len() < GROUP && !self.busy.is_empty() {
                self.run();
            }
            room = self.most - self.busy.len() + 2 * GROUP - self.queue.len().min(2 * GROUP);
            feed.give(self.ends.drain(..).map(|(number, end)| (number, Ok(end))));
        }
        std::mem::forget(abort);
    }

    /// Puts waiting jobs into free lanes.
    fn fill(&mut self) {
        let first = self.busy.len();
        while self.busy.len() < self.most
            && let Some(job) = self.queue.pop_front()
        {
            self.busy.push(self.fresh(job));
        }
        let new: Vec<usize> = (first..self.busy.len()).collect();
        for lanes in new.chunks(GROUP) {
            self.load(lanes);
        }
    }

    fn fresh(&self, (number, job): (u64, Job)) -> Busy {
        Busy { number, job, loaded: 0, inputs: vec![0; self.program.inputs.len()], clock: 0, due: 0 }
    }

    /// Runs lanes until some of them are to be looked at, and looks.
    fn run(&mut self) {
        self.settle();
        let mut seen = Vec::new();
        for lane in 0..self.busy.len() {
            if self.may_end(lane) {
                seen.push(lane);
            } else if self.busy[lane].due <= self.busy[lane].clock {
                self.set_due(lane);
            }
        }
        self.lanes.edge(&self.program.running);
        let (mut free, mut loading) = (Vec::new(), Vec::new());
        for lanes in seen.chunks(GROUP) {
            self.look(lanes, &mut free, &mut loading);
        }
        // Until here the memories are those of the sample.
        self.memories.edge(&self.program.running, self.lanes.rows(), self.busy.len(), None);
        for lanes in loading.chunks(GROUP) {
            self.load(lanes);
        }
        for lane in free.into_iter().rev() {
            self.busy.swap_remove(lane);
            self.move_lane(self.busy.len(), lane);
            self.memories.swap(self.busy.len(), lane);
        }
    }

    /// Settles sample after sample, until one of the lanes is to be looked at; with native code each vector of lanes until
    /// one of its own is.
    fn settle(&mut self) {
        let program = self.program;
        let (running, lanes) = (&program.running, self.busy.len());
        let most = match program.native.code::<T>(running) {
            Some(code) => {
                let frame = self.frame.get_or_insert_with(|| Frame::new(code));
                for (index, busy) in self.busy.chunks_mut(code.lanes()).enumerate() {
                    let done = frame.run(code, self.lanes.rows_mut(), index, busy.len(), samples(busy) - 1);
                    busy.iter_mut().for_each(|busy| busy.clock += done);
                }
                1
            }
            None => samples(&self.busy).min(program.native.most(lanes)),
        };
        let done = T::run(&mut self.lanes, running, lanes, running.outputs[0], most, &mut self.memories);
        program.native.interpreted(lanes, done);
        self.busy.iter_mut().for_each(|busy| busy.clock += done);
    }

    /// Reads the sample before the last edge in up to a group of lanes: they end, are to load, or continue.
    fn look(&mut self, lanes: &[usize], free: &mut Vec<usize>, loading: &mut Vec<usize>) {
        let (running, whole) = (&self.program.running, &self.program.whole);
        for (place, &lane) in lanes.iter().enumerate() {
            for (from, to) in running.registers.iter().zip(&whole.registers) {
                // The edge has put the old value where the next one was.
                let old = self.lanes.get(from.next.unwrap_or(from.row), lane);
                self.loader.set(to.row, place, old);
            }
            self.set_inputs(place, lane);
        }
        let copies = self.memories.copies(lanes);
        T::settle(&mut self.loader, &whole.operations[..whole.observers], 1, self.memories.of(&copies));
        let verdicts: Vec<Verdict> = lanes.iter().enumerate().map(|(place, &lane)| self.verdict(place, lane)).collect();
        for (place, (&lane, verdict)) in lanes.iter().zip(verdicts).enumerate() {
            match verdict {
                Verdict::Goes => self.set_due(lane),
                Verdict::Loads => loading.push(lane),
                Verdict::Ends(stop) => {
                    let end = self.end(place, lane, stop);
                    self.ends.push((self.busy[lane].number, end));
                    match self.queue.pop_front() {
                        Some(job) => {
                            self.busy[lane] = self.fresh(job);
                            loading.push(lane);
                        }
                        None => free.push(lane),
                    }
                }
            }
        }
    }

    fn verdict(&self, place: usize, lane: usize) -> Verdict {
        let (watch, busy) = (&self.program.watch, &self.busy[lane]);
        let clock = busy.clock;
        let ends = &self.program.whole.outputs[..=watch.traps.len()];
        match ends.iter().position(|&row| self.loader.get(row, place) != T::default()) {
            Some(0) if busy.loaded >= busy.job.blocks.len() => return Verdict::Ends(LaneStop::Done),
            Some(0) if clock < watch.limit => return Verdict::Loads,
            Some(0) | None => {}
            Some(index) => return Verdict::Ends(LaneStop::Trap(index - 1)),
        }
        if clock >= watch.limit {
            return Verdict::Ends(LaneStop::Limit);
        }
        let idle = self.idle(lane);
        match &watch.quiet {
            Some(quiet)
                if (clock + 1).is_multiple_of(quiet.every)
                    && (idle > quiet.clocks || idle >= quiet.every && self.at_rest(lane)) =>
            {
                Verdict::Ends(LaneStop::Quiet { clocks: idle })
            }
            _ => Verdict::Goes,
        }
    }

    /// The last edge changed no register and no memory.
    fn at_rest(&self, lane: usize) -> bool {
        let row = |row| self.lanes.get(row, lane);
        let running = &self.program.running;
        let kept = !self.memories.changes(running, self.lanes.rows(), lane);
        kept && running.registers.iter().all(|register| register.next.is_none_or(|old| row(old) == row(register.row)))
    }

    /// The last sample may be the end of a block: only a look at all nets shows which.
    fn may_end(&self, lane: usize) -> bool {
        let (clock, watch) = (self.busy[lane].clock, &self.program.watch);
        let quiet = || watch.quiet.as_ref().is_some_and(|quiet| self.idle(lane) >= quiet.every.min(quiet.clocks));
        self.lanes.get(self.program.running.outputs[0], lane) != T::default()
            || self.busy[lane].due <= clock && (clock >= watch.limit || quiet())
    }

    /// Clocks since one of the quiet nets was not 0.
    fn idle(&self, lane: usize) -> u64 {
        self.program.running.accumulators.last().map_or(0, |&row| self.lanes.get(row, lane).get())
    }

    fn end(&self, place: usize, lane: usize, stop: LaneStop) -> LaneEnd {
        let program = self.program;
        let mut last = program.whole.outputs[1 + program.watch.traps.len()..].iter();
        let mut accumulators = program.running.accumulators.iter();
        let word =
            |row: Option<&Slot>, block: &LaneMachine<T>, at: usize| row.map_or(T::default(), |&row| block.get(row, at));
        let value = |(observe, width): (&Observe, &Width)| match observe {
            Observe::Last(_) => word(last.next(), &self.loader, place).decode(*width),
            Observe::Count(_) | Observe::Sum { .. } | Observe::RootGaps { .. } | Observe::GreatestGap(_) => {
                word(accumulators.next(), &self.lanes, lane).get()
            }
            Observe::LeastGap(_) => {
                let least = word(accumulators.next(), &self.lanes, lane);
                // With fewer than two it is negative.
                if least.less_signed(T::default()) { 0 } else { least.get() }
            }
            Observe::Since(_) => {
                let since = word(accumulators.next(), &self.lanes, lane);
                // Counted up to the sample after the last.
                if since.less_signed(T::default()) { u64::MAX } else { since.get() - 1 }
            }
            Observe::Min { .. } | Observe::Max { .. } => word(accumulators.next(), &self.lanes, lane).decode(*width),
        };
        let values = program.watch.observe.iter().zip(&program.widths).map(value).collect();
        LaneEnd { stop, clock: self.busy[lane].clock, values }
    }

    /// Loads the next block of up to a group of lanes, after the last edge: one sample and the next edge.
    fn load(&mut self, lanes: &[usize]) {
        if lanes.is_empty() {
            return;
        }
        let (running, whole) = (&self.program.running, &self.program.whole);
        for (place, &lane) in lanes.iter().enumerate() {
            let first = self.busy[lane].loaded == 0;
            let word = |from: &RegisterRow, block: &LaneMachine<T>| {
                if first { T::encode(from.width, from.reset) } else { block.get(from.row, lane) }
            };
            for (from, to) in running.registers.iter().zip(&whole.registers) {
                self.loader.set(to.row, place, word(from, &self.lanes));
            }
            for ((&from, &to), reduce) in running.accumulators.iter().zip(&whole.accumulators).zip(&self.program.reduce)
            {
                let word = if first { reduce.start() } else { self.lanes.get(from, lane) };
                self.loader.set(to, place, word);
            }
            if first {
                self.memories.reset(lane);
            }
            self.next_block(lane);
            self.set_inputs(place, lane);
        }
        let copies = self.memories.copies(lanes);
        T::settle(&mut self.loader, &whole.operations, 1, self.memories.of(&copies));
        self.memories.edge(whole, self.loader.rows(), lanes.len(), Some(&copies));
        self.loader.edge(whole);
        for (place, &lane) in lanes.iter().enumerate() {
            for (to, from) in running.registers.iter().zip(&whole.registers) {
                self.lanes.set(to.row, lane, self.loader.get(from.row, place));
            }
            for (&to, &from) in running.accumulators.iter().zip(&whole.accumulators) {
                self.lanes.set(to, lane, self.loader.get(from, place));
            }
            self.rest(lane);
            self.set_due(lane);
        }
    }

    /// The inputs of the next block, and the clock after its load.
    fn next_block(&mut self, lane: usize) {
        let busy = &mut self.busy[lane];
        busy.clock = if busy.loaded == 0 { 0 } else { busy.clock + 1 };
        if let Some(block) = busy.job.blocks.get(busy.loaded) {
            set(&self.program.inputs, &mut busy.inputs, block);
        }
        busy.loaded += 1;
    }

    /// The inputs come to rest.
    fn rest(&mut self, lane: usize) {
        let busy = &mut self.busy[lane];
        set(&self.program.inputs, &mut busy.inputs, &self.program.watch.rest);
        for &(index, row) in &self.program.running.inputs {
            let word = T::encode(self.program.inputs[index].1, busy.inputs[index]);
            self.lanes.set(row, lane, word);
        }
    }

    /// The present inputs of a lane, in the loader.
    fn set_inputs(&mut self, place: usize, lane: usize) {
        for &(index, row) in &self.program.whole.inputs {
            let word = T::encode(self.program.inputs[index].1, self.busy[lane].inputs[index]);
            self.loader.set(row, place, word);
        }
    }

    /// When a lane is to be looked at next: at the limit, or where it may have been quiet for too long.
    fn set_due(&mut self, lane: usize) {
        let watch = &self.program.watch;
        // Clock of the next sample of this lane.
        let next = self.busy[lane].clock + 1;
        let mut clock = watch.limit;
        if let Some(quiet) = &watch.quiet {
            let since = (next - 1).saturating_sub(self.idle(lane));
            let borne = quiet.clocks.min(quiet.every - 1);
            let least = since.saturating_add(borne).saturating_add(1).max(next);
            clock = clock.min(least.saturating_add(1).div_ceil(quiet.every).saturating_mul(quiet.every) - 1);
        }
        self.busy[lane].due = clock.max(next);
    }

    /// Another lane's state, into a lane that has ended.
    fn move_lane(&mut self, from: usize, to: usize) {
        let Code { registers, accumulators, inputs, .. } = &self.program.running;
        let registers = registers.iter().map(|register| register.row);
        for row in registers.chain(accumulators.iter().copied()).chain(inputs.iter().map(|&(_, row)| row)) {
            let word = self.lanes.get(row, from);
            self.lanes.set(row, to, word);
        }
    }
}

/// Samples until the first of these lanes is to be examined; at least 1.
fn samples(busy: &[Busy]) -> u64 {
    busy.iter().map(|busy| busy.due.saturating_sub(busy.clock)).min().unwrap_or(1).max(1)
}

/// Sets inputs, cut to their widths.
fn set(
    inputs: &[(stepwave_netlist::cells::Net, Width)],
    values: &mut [u64],
    new: &[(stepwave_netlist::cells::Net, u64)],
) {
    for &(net, value) in new {
        if let Some(index) = inputs.iter().position(|&(input, _)| input == net) {
            values[index] = value & inputs[index].1.mask();
        }
    }
}

/// Runs when a worker unwinds.
struct AbortOnPanic<F: FnMut()>(F);

impl<F: FnMut()> Drop for AbortOnPanic<F> {
    fn drop(&mut self) {
        (self.0)();
    }
}
