//! The compiled engine: native code for long runs, the word engine for everything else.
//!
//! A run begins in the word engine. Once it has proved long, the clock loop is compiled (a millisecond or so) with
//! what is known by then folded in: inputs of one bit (`load` = 0), and registers of few bits that have cycled with a
//! short period all the time (a beat ring, `busy`). Guards leave the native loop where such a register does something
//! else; the word engine then takes over, and a loop for the new circumstances is compiled, or one without assumptions
//! after some tries. Every sample is recorded, so the outside sees no difference; or, where that is asked for, every
//! sample in which a machine driven by a pulse source is not idle.
//!
//! When inputs have changed (a block was loaded), a loop that was compiled for such inputs is entered at once. A
//! [large] machine is compiled much earlier, into code of another kind.

mod ahead;
mod branching;
mod codegen;
mod digesting;
mod large;
mod layout;
mod memory;
mod native;
mod operation;
mod passing;
mod placing;
mod regions;
mod scan;
mod specialise;
mod steps;

use rustc_hash::FxHashMap as HashMap;

use super::word::WordEngine;
use super::{Ahead, Digest, Engine, Extremes, Idle, Rows, Stop, Wanted, Watch};
use ahead::{Digests, LookedAt};
use large::Large;
#[cfg(target_arch = "x86_64")]
pub(crate) use native::LaneLoop;
use native::Native;
use specialise::{History, Periodic, Specialised};
use stepwave_netlist::Design;
use stepwave_netlist::cells::{Net, Op};

/// Clocks in the word engine before anything is compiled: they take about as long as compiling.
const WARM_UP: u64 = 16 * 1024;
/// Clocks looked back on when a loop is compiled.
const LOOK_BACK: u64 = 1024;
/// A run that is said to take as many clocks is compiled as soon as there is enough to look back on.
const LONG: u64 = 2 * WARM_UP;
/// Clocks that inputs must have stayed before a loop is compiled for them that assumes nothing else.
const STEADY: u64 = 16;
/// Loops compiled with assumptions on registers before one without is used.
const TRIES: usize = 6;
/// Loops of a large machine from which on one is compiled that takes no inputs for granted.
const MANY: usize = 8;

/// A compiled loop and what it takes for granted.
struct Variant {
    native: Native,
    /// Values of the folded inputs.
    inputs: HashMap<Net, u64>,
    /// Values of the fixed registers in the last phase: a call may begin after it.
    last_phase: HashMap<Net, u64>,
    assumes_registers: bool,
    /// Times that a guard was left through.
    guards: u64,
    /// Clocks run.
    clocks: u64,
    /// The same without recording, where digests are wanted.
    digests: Option<Digests>,
}

impl Variant {
    /// It leaves through its guards too often to pay.
    fn is_poor(&self, patience: u64) -> bool {
        self.guards >= 4 && self.clocks / self.guards < patience
    }
}

pub(super) struct Compiled {
    word: WordEngine,
    design: Design,
    watch: Watch,
    /// Samples that are passed over.
    idle: Option<Idle>,
    /// What digests are to hold.
    wanted: Option<Wanted>,
    /// The digest that was looked at last.
    ahead: Option<LookedAt>,
    registers: Vec<(Net, Net)>,
    history: History,
    warm_up: u64,
    /// Clocks between two guards from which on a loop pays.
    patience: u64,
    /// Clocks since an input changed or a guard failed.
    quiet: u64,
    /// Inputs have changed since a loop was left, and there is one for them.
    known: bool,
    /// Rows may be given before they are full.
    ends_early: bool,
    variants: Vec<Variant>,
    /// A large machine, and what is known of its registers.
    large: Option<Large>,
    /// No code generator for this machine, or its rows or memories are too large for one.
    unavailable: bool,
    state: Vec<u64>,
}

impl Compiled {
    pub(super) fn new(design: &Design, watch: &Watch) -> Compiled {
        Compiled::after(design, watch, WARM_UP)
    }

    /// Compiles once `warm_up` clocks were alike.
    pub(super) fn after(design: &Design, watch: &Watch, warm_up: u64) -> Compiled {
        let netlist = design.netlist();
        let registers: Vec<(Net, Net)> = design
            .registers()
            .iter()
            .filter_map(|&register| match netlist.cell(register).op {
                Op::Register { next: Some(next), .. } => Some((register, next)),
                _ => None,
            })
            .collect();
        let words = registers.len() + design.inputs().len() + 1;
        let is_large = large::is_large(design);
        let engine = Compiled {
            word: WordEngine::new(design, watch),
            design: design.clone(),
            watch: watch.clone(),
            idle: None,
            wanted: None,
            ahead: None,
            history: if is_large { History::none() } else { History::new(netlist, &registers, LOOK_BACK.min(warm_up)) },
            warm_up,
            patience: warm_up,
            registers,
            quiet: 0,
            known: false,
            ends_early: false,
            variants: Vec::new(),
            large: None,
            unavailable: false,
            state: vec![0; words],
        };
        if is_large { engine.branching(large::WORTH) } else { engine }
    }

    /// Passes over the samples in which the machine is idle, in sparse rows.
    pub(super) fn passing(self, idle: &Idle) -> Compiled {
        let mut this = self.unbranched();
        // Of what no cell drives by itself nothing is known while samples are passed over.
        let registers: Vec<Net> = this.registers.iter().map(|&(net, _)| net).collect();
        let running: Vec<Net> = idle.running.iter().copied().filter(|net| registers.contains(net)).collect();
        let words = passing::HEAD + passing::EXTREMES * running.len();
        this.state.resize(registers.len() + this.design.inputs().len() + words, 0);
        this.history = History::new(this.design.netlist(), &this.registers, STEADY.min(this.warm_up));
        this.idle = (!running.is_empty() && !this.watch.columns.is_empty())
            .then(|| Idle { running, flags: idle.flags.clone() });
        this
    }

    /// Looks ahead for what is wanted, unless the machine is large: its digests would take longer to compile than most runs.
    /// Runs that nobody sees clock by clock are many, and often short: it is compiled no earlier than others.
    pub(super) fn digesting_unless_large(self, wanted: Option<&Wanted>) -> Compiled {
        match wanted {
            Some(_) if self.large.is_some() => Compiled { warm_up: self.warm_up.max(WARM_UP), ..self },
            wanted => self.digesting(wanted.cloned()),
        }
    }

    /// Looks ahead for what is wanted.
    pub(super) fn digesting(self, wanted: Option<Wanted>) -> Compiled {
        // What digests are made of are short loops.
        let engine = if wanted.is_some() { self.unbranched() } else { self };
        Compiled { wanted, ..engine }
    }

    /// One clock in the word engine, remembered.
    fn step(&mut self, rows: &mut Rows) -> Stop {
        let changes = self.word.input_pending();
        if changes {
            // A loop that passes over samples takes nothing for granted but inputs: they need not stay for long.
            let kept = self.idle.as_ref().map_or(0, |_| self.warm_up.saturating_sub(self.history.window()));
            self.quiet = self.quiet.min(kept);
        }
        let stop = self.word.run(1, rows);
        if changes {
            self.known =
                self.variants.iter().any(|variant| !variant.is_poor(self.patience) && self.holds(&variant.inputs));
        }
        self.quiet += 1;
        if self.quiet + self.history.window() > self.warm_up {
            self.history.remember(|net| self.word.value(net));
        }
        stop
    }

    /// These nets have these values.
    fn holds(&self, values: &HashMap<Net, u64>) -> bool {
        values.iter().all(|(&net, &value)| self.word.value(net) == value)
    }

    /// The loop that may be entered after the present sample and fills this many rows.
    fn fitting(&self, stride: usize) -> Option<usize> {
        let fits = |variant: &Variant| {
            variant.native.stride() == stride && self.holds(&variant.inputs) && self.holds(&variant.last_phase)
        };
        self.variants.iter().position(|variant| !variant.is_poor(self.patience) && fits(variant))
    }

    /// The registers that have cycled in the recent clocks, unless it was of no use to assume that.
    fn period(&self) -> Option<Periodic> {
        let assumes_registers = self.variants.iter().filter(|variant| variant.assumes_registers).count() < TRIES;
        if assumes_registers && self.idle.is_none() { self.history.period() } else { None }
    }

    /// Compiles a loop in which these registers cycle.
    fn compile(&mut self, stride: usize, period: Option<Periodic>) {
        let value = |net: Net| self.word.value(net);
        let any_inputs = self.large.is_some() && self.variants.len() >= MANY;
        let inputs = if any_inputs { &[] } else { self.design.inputs() };
        let specialised = Specialised::new(self.design.netlist(), inputs, &self.registers, period, value, |nets| {
            nets.extend(&self.watch.columns);
            nets.extend(&self.watch.stops);
            nets.extend(self.idle.iter().flat_map(|idle| &idle.flags));
        });
        let memories = self.word.memories().places().to_vec();
        let plan = codegen::Plan {
            entry: &specialised.entry,
            phases: &specialised.phases,
            registers: &self.registers,
            memories: &memories,
            inputs: self.design.inputs(),
            columns: &self.watch.columns,
            stride,
            stops: &self.watch.stops,
            running: self.idle.as_ref().map_or(&[], |idle| &idle.running),
            flags: self.idle.as_ref().map_or(&[], |idle| &idle.flags),
            branches: self.large.as_ref().map(Large::branches),
        };
        match Native::compile(&plan) {
            Some(native) => {
                self.state.resize(native.state_words().max(self.state.len()), 0);
                let last_phase = specialised.phases.last().map(|phase| phase.fixed.clone()).unwrap_or_default();
                let assumes_registers = !last_phase.is_empty();
                let inputs = specialised.inputs.clone();
                let digests = self.wanted.as_ref().map(|wanted| {
                    let never = [&wanted.never[..], &self.watch.stops].concat();
                    Digests::of(specialised, self.design.netlist(), &self.registers, &never)
                });
                let (guards, clocks) = (0, 0);
                self.variants.push(Variant { native, inputs, last_phase, assumes_registers, guards, clocks, digests });
            }
            // The frame of code made with care can be too large where that of the code that runs now is not.
            None => self.unavailable = !self.large.as_ref().is_some_and(Large::is_lasting),
        }
    }

    /// Puts the present sample into the state.
    fn load_state(&mut self) {
        let nets = self.registers.iter().map(|&(net, _)| net).chain(self.design.inputs().iter().copied());
        for (word, net) in self.state.iter_mut().zip(nets) {
            *word = self.word.value(net);
        }
        self.state[self.registers.len() + self.design.inputs().len()] = 0;
    }

    /// Runs a loop from the present sample on, at most `clocks` clocks.
    fn run_native(&mut self, variant: usize, clocks: u64, rows: &mut Rows) -> Option<Stop> {
        let count = self.registers.len();
        // Clocks between two calls do not show that a loop is missing, however often there are some.
        self.history.clear();
        self.load_state();
        if self.idle.is_some() {
            return self.run_passing(variant, clocks, rows);
        }
        let (values, first) = rows.spare(self.variants[variant].native.resting());
        let memories = self.word.memories().words_mut();
        let recorded = self.variants[variant].native.call(&mut self.state, values, first, clocks, memories);
        for &column in self.variants[variant].native.resting() {
            rows.fill(column, recorded, self.word.value(self.watch.columns[column]));
        }
        rows.grow(self.word.clock() + 1, recorded);
        let edge = self.state[count + self.design.inputs().len()] == 1;
        self.word.continue_from(recorded, &self.state[..count]);
        self.variants[variant].clocks += recorded;
        if edge {
            self.variants[variant].guards += 1;
            // The word engine records the sample after the edge that the loop left at.
            self.word.finish_edge(rows);
            self.quiet = self.warm_up.saturating_sub(self.history.window());
        }
        self.known = false;
        self.word.stopped()
    }

    /// The same, passing over idle samples: rows and clocks are counted apart.
    fn run_passing(&mut self, variant: usize, clocks: u64, rows: &mut Rows) -> Option<Stop> {
        let count = self.registers.len();
        let base = count + self.design.inputs().len();
        let clock = self.word.clock();
        (self.state[base + passing::ROOM], self.state[base + passing::CLOCK]) = (rows.room(), clock);
        let (values, first) = rows.spare(self.variants[variant].native.resting());
        let memories = self.word.memories().words_mut();
        let done = self.variants[variant].native.call(&mut self.state, values, first, clocks, memories);
        let recorded = self.state[base + passing::ROOM];
        for &column in self.variants[variant].native.resting() {
            rows.fill(column, recorded, self.word.value(self.watch.columns[column]));
        }
        rows.grow(clock + 1, recorded);
        let running = self.idle.iter().flat_map(|idle| &idle.running);
        let (words, _) = self.state[base + passing::HEAD..].as_chunks::<{ passing::EXTREMES }>();
        for (&net, &[least, greatest, any, all]) in running.zip(words) {
            // Some column, or nobody looks at it; and something was passed over, or the least is above the greatest.
            if let Some(column) = self.watch.columns.iter().position(|&column| column == net)
                && least <= greatest
            {
                rows.pass(column, Extremes { least, greatest, first: least, toggled: any & !all });
            }
        }
        self.word.continue_from(done, &self.state[..count]);
        self.variants[variant].clocks += done;
        self.word.stopped()
    }
}

impl Engine for Compiled {
    fn set_input(&mut self, input: Net, value: u64) {
        self.word.set_input(input, value);
    }

    fn reset(&mut self, rows: &mut Rows) {
        (self.quiet, self.known) = (0, false);
        self.history.clear();
        self.word.reset(rows);
    }

    fn restore(&mut self, clock: u64, registers: &[u64], inputs: &[u64], memories: &[Vec<u64>]) {
        (self.quiet, self.known) = (0, false);
        self.history.clear();
        self.word.restore(clock, registers, inputs, memories);
    }

    fn run(&mut self, clocks: u64, rows: &mut Rows) -> Stop {
        let end = self.word.clock().saturating_add(clocks);
        let records = !self.watch.columns.is_empty();
        while self.word.clock() < end {
            if records && rows.is_full() {
                return Stop::RowsFull;
            }
            if self.large.is_some() && (self.known || self.quiet >= self.warm_up) {
                match self.run_large(end, rows) {
                    Some(Some(stop)) => return stop,
                    Some(None) => continue,
                    None => {}
                }
            }
            let fills = self.idle.is_none() || rows.is_sparse();
            if self.large.is_none()
                && fills
                && (self.known || self.quiet >= self.warm_up)
                && !self.unavailable
                && !self.word.input_pending()
            {
                let left = end - self.word.clock();
                let bounded = records && self.idle.is_none();
                let room = if bounded { rows.room().min(left) } else { left.min(i64::MAX as u64) };
                match self.fitting(rows.stride()) {
                    Some(variant) if self.variants[variant].native.phases() <= room => {
                        if let Some(stop) = self.run_native(variant, room, rows) {
                            return stop;
                        }
                        continue;
                    }
                    // The next block begins with a round: its last clocks would be those of the word engine in each block.
                    Some(variant)
                        if self.ends_early && !rows.is_empty() && self.variants[variant].native.phases() <= left =>
                    {
                        return Stop::RowsFull;
                    }
                    None if self.quiet >= self.warm_up && self.history.is_full() => {
                        self.compile(rows.stride(), self.period());
                        self.history.clear();
                    }
                    _ => {}
                }
            }
            if let Stop::Net(index) = self.step(rows) {
                return Stop::Net(index);
            }
        }
        Stop::Clocks
    }

    fn expect(&mut self, clocks: u64) {
        self.ends_early = true;
        // Large machines are compiled earlier still, and loops that pass over samples by other rules.
        if clocks >= LONG && self.large.is_none() && self.idle.is_none() {
            self.warm_up = self.warm_up.min(LOOK_BACK);
        }
    }

    fn look_ahead(&mut self, clocks: u64, digest: &mut Digest) -> Ahead {
        self.digest(clocks, digest)
    }

    fn skip_ahead(&mut self) {
        self.accept();
    }

    fn clock(&self) -> u64 {
        self.word.clock()
    }

    fn value(&self, net: Net) -> u64 {
        self.word.value(net)
    }

    fn word(&self, memory: usize, address: u64) -> u64 {
        self.word.word(memory, address)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stepwave_netlist::dsl::Module;
    use stepwave_netlist::elaborate;

    #[test]
    fn a_run_that_will_be_long_is_compiled_early() {
        let module = Module::new("counter");
        let m = module.top();
        let count = m.reg("count", 16);
        count.set(count.q.wrapping_add(m.lit(16, 1)));
        let count = count.q.net();
        let design = elaborate(module.finish().unwrap()).unwrap();
        let native = |expected: u64| {
            let mut engine = Compiled::new(&design, &Watch { columns: vec![count], stops: Vec::new() });
            engine.expect(expected);
            let mut rows = Rows::new(1, 4096);
            engine.reset(&mut rows);
            engine.run(4000, &mut rows);
            assert!(rows.column(0).iter().copied().eq(0..=4000));
            engine.variants.iter().map(|variant| variant.clocks).sum::<u64>()
        };
        assert_eq!([0, LONG - 1].map(native), [0, 0]);
        assert!(native(LONG) > 2_000, "{}", native(LONG));
    }

    /// Every other test would pass too if nothing were ever compiled.
    #[test]
    fn a_long_run_is_in_native_code() {
        let module = Module::new("counter");
        let m = module.top();
        let count = m.reg("count", 16);
        count.set(count.q.wrapping_add(m.lit(16, 1)));
        let memory = m.memory("memory", 16, 1000);
        memory.write(m.lit(1, 1), count.q, !count.q, None);
        m.name("read", memory.read(count.q));
        let count = count.q.net();
        let design = elaborate(module.finish().unwrap()).unwrap();
        let watch = Watch { columns: vec![count], stops: Vec::new() };
        let mut engine = Compiled::after(&design, &watch, 100);
        engine.reset(&mut Rows::new(1, 0));
        for _ in 0..100 {
            engine.run(100, &mut Rows::new(1, 256));
        }
        assert!(!engine.unavailable);
        let native: u64 = engine.variants.iter().map(|variant| variant.clocks).sum();
        assert!(native > 9_000, "{native} of 10000 clocks in {} loops", engine.variants.len());
        assert_eq!((engine.clock(), engine.value(count)), (10_000, 10_000));
        assert_eq!([0, 1, 999, 1000].map(|address| engine.word(0, address)), [0xffff, 0xfffe, 0xffff - 999, 0]);
    }
}
