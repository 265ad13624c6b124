//! Lanes: many jobs of one netlist at once come to what each comes to alone.

mod arithmetic;
mod geometry;
mod measured;
mod memories;
mod programs;
mod random;

use stepwave_engine::lanes::{Job, LaneEnd, LaneProgram, LaneStop, LaneWatch, Observe, root_gap};
use stepwave_engine::{Engine, EngineKind, Rows, Watch};
use stepwave_netlist::bits::to_signed;
use stepwave_netlist::cells::Op;
use stepwave_netlist::{Design, Net};

/// One job on an engine of its own, clock by clock, as the documentation of lanes says.
struct Alone<'d> {
    design: &'d Design,
    watch: &'d LaneWatch,
    engine: Box<dyn Engine>,
    /// Registers that what is observed depends on, and memories, by index.
    registers: Vec<(Net, Net)>,
    memories: Vec<usize>,
    values: Vec<u64>,
    /// The clock at which the net of a gap was not 0 last.
    last_set: Vec<Option<u64>>,
    last_alive: u64,
}

impl<'d> Alone<'d> {
    fn new(design: &'d Design, watch: &'d LaneWatch, kind: EngineKind) -> Alone<'d> {
        let start = |observe: &Observe| match observe {
            Observe::Min { net, signed } => design.netlist().width(*net).mask() >> u32::from(*signed),
            Observe::Max { net, signed: true } => design.netlist().width(*net).sign_bit(),
            _ => 0,
        };
        let (registers, memories) = needed(design, watch);
        Alone {
            design,
            watch,
            engine: kind.build(design, &Watch::default()),
            registers,
            memories,
            values: watch.observe.iter().map(start).collect(),
            last_set: vec![None; watch.observe.len()],
            last_alive: 0,
        }
    }

    fn is(&self, net: Net) -> bool {
        self.engine.value(net) != 0
    }

    fn sample(&mut self) {
        let netlist = self.design.netlist();
        let mut values = std::mem::take(&mut self.values);
        let clock = self.engine.clock();
        for ((value, observe), last_set) in values.iter_mut().zip(&self.watch.observe).zip(&mut self.last_set) {
            let now = |net: &Net| self.engine.value(*net);
            let key =
                |net: &Net, signed: bool, bits: u64| if signed { bits ^ netlist.width(*net).sign_bit() } else { bits };
            match observe {
                Observe::Last(net) => *value = now(net),
                Observe::Min { net, signed } => *value = (*value).min_by_key(now(net), |bits| key(net, *signed, *bits)),
                Observe::Max { net, signed } => *value = (*value).max_by_key(now(net), |bits| key(net, *signed, *bits)),
                Observe::Count(nets) => *value += u64::from(nets.iter().any(|net| now(net) != 0)),
                Observe::Sum { net, .. } => *value = value.wrapping_add(now(net)),
                Observe::RootGaps { base, offset, .. } => {
                    let offset = to_signed(netlist.width(*offset), now(offset));
                    *value = value.wrapping_add(root_gap(now(base) as f64, offset as f64));
                }
                Observe::Since(net) => {
                    let last = if now(net) != 0 { last_set.insert(clock) } else { last_set.get_or_insert(u64::MAX) };
                    *value = if *last == u64::MAX { u64::MAX } else { clock - *last };
                }
                Observe::LeastGap(net) | Observe::GreatestGap(net) => {
                    if now(net) != 0 {
                        let gap = last_set.replace(clock).map_or(0, |last| clock - last);
                        let least = matches!(observe, Observe::LeastGap(_)) && *value > 0 && gap > 0;
                        *value = if least { gap.min(*value) } else { gap.max(*value) };
                    }
                }
            }
        }
        self.values = values;
        if self.watch.quiet.as_ref().is_some_and(|quiet| quiet.nets.iter().any(|&net| self.is(net))) {
            self.last_alive = self.engine.clock();
        }
    }

    fn clock(&mut self) {
        self.engine.run(1, &mut Rows::new(0, 0));
        self.sample();
    }

    fn set(&mut self, inputs: &[(Net, u64)]) {
        inputs.iter().for_each(|&(net, value)| self.engine.set_input(net, value));
    }

    fn run(mut self, job: &Job) -> LaneEnd {
        let mut blocks = job.blocks.iter();
        self.set(blocks.next().map_or(&[], Vec::as_slice));
        self.engine.reset(&mut Rows::new(0, 0));
        self.sample();
        let rest = self.watch.rest.clone();
        self.set(&rest);
        loop {
            self.clock();
            let clock = self.engine.clock();
            let done = self.is(self.watch.done);
            if done && blocks.len() == 0 {
                return self.end(LaneStop::Done);
            }
            if done && clock < self.watch.limit {
                let block = blocks.next().cloned().unwrap_or_default();
                self.set(&block);
                self.clock();
                self.set(&rest);
                continue;
            }
            if let (false, Some(trap)) = (done, self.watch.traps.iter().position(|&net| self.is(net))) {
                return self.end(LaneStop::Trap(trap));
            }
            if clock >= self.watch.limit {
                return self.end(LaneStop::Limit);
            }
            if let Some(quiet) = self.watch.quiet.as_ref().filter(|quiet| (clock + 1).is_multiple_of(quiet.every)) {
                let idle = clock - self.last_alive;
                let value = |net: Net| self.engine.value(net);
                let at_rest = || self.registers.iter().all(|&(register, next)| value(register) == value(next));
                let at_rest = || at_rest() && !self.memories.iter().any(|&memory| self.writes(memory));
                if idle > quiet.clocks || idle >= quiet.every && at_rest() {
                    return self.end(LaneStop::Quiet { clocks: idle });
                }
            }
        }
    }

    /// A port of a memory is about to change a word.
    fn writes(&self, memory: usize) -> bool {
        let of = &self.design.netlist().memories[memory];
        of.writes.iter().any(|port| {
            let [enable, address, data] = [port.enable, port.address, port.data].map(|net| self.engine.value(net));
            let mask = port.mask.map_or(u64::MAX, |mask| self.engine.value(mask));
            enable == 1 && address < of.size && (data ^ self.engine.word(memory, address)) & mask != 0
        })
    }

    fn end(self, stop: LaneStop) -> LaneEnd {
        LaneEnd { stop, clock: self.engine.clock(), values: self.values }
    }
}

/// The registers that what is observed depends on, with the nets of their next values, and the memories.
fn needed(design: &Design, watch: &LaneWatch) -> (Vec<(Net, Net)>, Vec<usize>) {
    let netlist = design.netlist();
    let mut pending = [&[watch.done], &watch.traps[..]].concat();
    pending.extend(watch.quiet.iter().flat_map(|quiet| &quiet.nets));
    pending.extend(watch.observe.iter().flat_map(Observe::nets));
    let (mut registers, mut memories) = (Vec::new(), Vec::new());
    let mut seen = vec![false; netlist.cells.len()];
    while let Some(net) = pending.pop() {
        if !std::mem::replace(&mut seen[net.index()], true) {
            let op = netlist.cell(net).op;
            op.visit_inputs(|input| pending.push(input));
            if let Op::Register { next: Some(next), .. } = op {
                registers.push((net, next));
                pending.push(next);
            }
            if let Op::Read { memory, .. } = op {
                memories.push(memory as usize);
                let ports = netlist.memories[memory as usize].writes.iter();
                pending.extend(ports.flat_map(|port| port.nets()));
            }
        }
    }
    (registers, memories)
}

/// Least and greatest by a key.
trait ByKey: Sized {
    fn min_by_key<K: Ord>(self, other: Self, key: impl Fn(&Self) -> K) -> Self {
        if key(&other) < key(&self) { other } else { self }
    }
    fn max_by_key<K: Ord>(self, other: Self, key: impl Fn(&Self) -> K) -> Self {
        if key(&other) > key(&self) { other } else { self }
    }
}

impl ByKey for u64 {}

/// Runs all jobs in lanes and each alone, and wants the same of both; and of lanes in native code from the first sample on,
/// and from some later one on.
fn assert_each_as_alone(design: &Design, watch: &LaneWatch, jobs: &[Job], kind: EngineKind) -> Vec<LaneEnd> {
    let program = LaneProgram::new(design, watch);
    let together = program.run_all(jobs.to_vec());
    for after in [0, 100] {
        let program = program.clone().compiled_after(after);
        let native = program.run_all(jobs.to_vec());
        for (index, (got, wanted)) in native.iter().zip(&together).enumerate() {
            assert_eq!(got, wanted, "native, job {index}, {:?}, {watch:?}\n{}", jobs[index], design.netlist());
        }
        assert_eq!(native.len(), together.len());
    }
    assert_eq!(together.len(), jobs.len());
    for (index, (job, end)) in jobs.iter().zip(&together).enumerate() {
        let alone = Alone::new(design, watch, kind).run(job);
        assert_eq!(*end, alone, "job {index}, {job:?}, {watch:?}\n{}", design.netlist());
    }
    together
}
