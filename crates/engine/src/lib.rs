//! Engines: what runs a [`Design`] clock by clock. They know nets and values, no names, no files, no methods.
//!
//! One clock is an edge, at which all registers take their next values at once from the old ones, and the settling of
//! the combinational nets after it. *Sample k* is the value of every net settled after edge k; sample 0 is the state
//! after reset. An input set between two calls changes right after the next edge, as the output of a register outside
//! would: the edge itself still sees the old value.
//!
//! A counter of four bits, in every sample of 18 clocks:
//!
//! ```
//! use stepwave_engine::{EngineKind, Rows, Watch};
//! use stepwave_netlist::{dsl::Module, elaborate};
//!
//! let module = Module::new("counter");
//! let m = module.top();
//! let enable = m.input("enable", 1);
//! let count = m.reg("count", 4);
//! count.when(enable, count.q.wrapping_add(m.lit(4, 1))).else_hold();
//! let (enable, count) = (enable.net(), count.q.net());
//!
//! let design = elaborate(module.finish().unwrap()).unwrap();
//! let watch = Watch { columns: vec![count], stops: vec![] };
//! let mut engine = EngineKind::Gates.build(&design, &watch);
//! let mut rows = Rows::new(1, 32);
//! engine.set_input(enable, 1);
//! engine.reset(&mut rows);
//! engine.run(18, &mut rows);
//! assert_eq!(rows.row(18), [2]); // 18 modulo 16
//! ```

#[cfg(feature = "jit")]
mod compiled;
mod digest;
mod gates;
pub mod lanes;
mod memories;
mod word;

use stepwave_netlist::Design;
use stepwave_netlist::cells::{Memory, Net, Op};

pub use digest::{Digest, Form, Term, Wanted};
pub use stepwave_netlist::{Extremes, Rows};

/// What an engine is to observe, fixed before it is built so that it can be compiled in.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// Nets recorded in every row; where there are none, nothing is recorded and rows never fill.
    pub columns: Vec<Net>,
    /// Nets (1 bit) that stop a run as soon as one of them is 1 in a sample.
    pub stops: Vec<Net>,
}

/// When a machine is idle: in a sample in which no register but the running ones has just changed or is about to, and
/// no flag or stop is 1 or was just before. An engine [built to pass over idle samples](EngineKind::build_passing) may skip such a sample,
/// recording only what the running registers reached.
#[derive(Clone, Debug)]
pub struct Idle {
    /// Registers that change at every clock, read as unsigned numbers: the phase of a pulse source.
    pub running: Vec<Net>,
    /// Nets (1 bit) whose 1 is always recorded, with the sample after it.
    pub flags: Vec<Net>,
}

/// Why a run ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stop {
    /// The clocks asked for are done.
    Clocks,
    /// No room for a further row; where it was said what to [expect](Engine::expect), or for a round of at most eight.
    RowsFull,
    /// The net `Watch::stops[_]` of this index is 1 in the last sample.
    Net(usize),
}

/// What came of looking ahead.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ahead {
    /// Nobody can tell yet: [run](Engine::run) on.
    NotNow,
    /// Something happens in these samples that has to be seen: [run](Engine::run) them.
    Eventful,
    /// The digest holds what they came to.
    Digest,
}

/// A machine that runs one design.
pub trait Engine: Send {
    /// Sets an input from after the next edge (or from reset) on. Bits above its width are ignored, and so is a net
    /// that is not an input.
    fn set_input(&mut self, input: Net, value: u64);

    /// Registers take their reset values, clock 0; `rows` forgets what it holds, whose clocks end here, and sample 0 is
    /// recorded if there is room for a row.
    fn reset(&mut self, rows: &mut Rows);

    /// Takes the state that an engine of the same design had in the sample of `clock`: the values of all registers and
    /// of all inputs, and the [`contents`] of all memories, in the order of the design; memories that are missing have
    /// their first words. Records nothing.
    ///
    /// # Panics
    /// If there are not as many values.
    fn restore(&mut self, clock: u64, registers: &[u64], inputs: &[u64], memories: &[Vec<u64>]);

    /// Runs until `clocks` clocks are done, `rows` is full, or a stop net is 1 in a sample; at least one clock is done
    /// unless `clocks` is 0 or there is no room for a row, or, after [`expect`](Engine::expect), for a round. Every sample is recorded that is not passed over; what
    /// `rows` holds already must be the samples right before.
    fn run(&mut self, clocks: u64, rows: &mut Rows) -> Stop;

    /// Says that at least as many clocks will be run, if nothing goes wrong: what pays only in long runs need not wait until this
    /// one has proved long. Samples do not depend on it; rows may be given a few before they are full.
    fn expect(&mut self, clocks: u64) {
        let _ = clocks;
    }

    /// What the next samples come to, at most as many as `clocks`, if the engine was
    /// [built to tell](EngineKind::build_digesting). The engine stays in the present sample.
    fn look_ahead(&mut self, clocks: u64, digest: &mut Digest) -> Ahead {
        let _ = (clocks, digest);
        Ahead::NotNow
    }

    /// Continues to the last sample of the digest that was [looked at](Engine::look_ahead) right before.
    fn skip_ahead(&mut self) {}

    /// Number of edges since reset.
    fn clock(&self) -> u64;

    /// Value of any net in the present sample, watched or not, named or not.
    fn value(&self, net: Net) -> u64;

    /// A word of a memory, by its index in the netlist, in the present sample; 0 outside of the memory.
    fn word(&self, memory: usize, address: u64) -> u64;
}

/// All words of all memories in the present sample.
#[must_use]
pub fn contents(engine: &dyn Engine, design: &Design) -> Vec<Vec<u64>> {
    let memories = design.netlist().memories.iter().enumerate();
    memories.map(|(index, memory)| (0..memory.size).map(|address| engine.word(index, address)).collect()).collect()
}

/// No register and no word of a memory will change any more, as long as no input does: the present sample is how it stays. The
/// registers `but` these may, of which the others are known not to depend.
#[must_use]
pub fn at_rest(engine: &dyn Engine, design: &Design, but: &[Net]) -> bool {
    let holds = |&register: &Net| match design.netlist().cell(register).op {
        Op::Register { next: Some(next), .. } => engine.value(next) == engine.value(register),
        _ => true,
    };
    let kept = |(index, memory): (usize, &Memory)| {
        memory.writes.iter().all(|port| {
            let address = engine.value(port.address);
            let old = engine.word(index, address);
            engine.value(port.enable) == 0
                || address >= memory.size
                || port.written(old, |net| engine.value(net)) == old
        })
    };
    design.registers().iter().filter(|register| !but.contains(register)).all(holds)
        && design.netlist().memories.iter().enumerate().all(kept)
}

/// The engines, for a choice at run time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EngineKind {
    /// Bit by bit through full adders: slow, and obviously right. The judge of the others.
    Gates,
    /// Word by word from a flat array of operations.
    Word,
    /// Native code for long runs; without the feature `jit` it is the word engine.
    Compiled,
}

impl EngineKind {
    /// Every engine; tests loop over it.
    pub const ALL: [EngineKind; 3] = [EngineKind::Gates, EngineKind::Word, EngineKind::Compiled];

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            EngineKind::Gates => "gates",
            EngineKind::Word => "word",
            EngineKind::Compiled => "compiled",
        }
    }

    /// An engine of this kind for a design, reset, all inputs 0.
    #[must_use]
    pub fn build(self, design: &Design, watch: &Watch) -> Box<dyn Engine> {
        match self {
            EngineKind::Gates => Box::new(gates::Gates::new(design, watch)),
            #[cfg(feature = "jit")]
            EngineKind::Compiled => Box::new(compiled::Compiled::new(design, watch)),
            _ => Box::new(word::WordEngine::new(design, watch)),
        }
    }

    /// As [`build`](Self::build), an engine that can [look ahead](Engine::look_ahead) for what is wanted, if anything is.
    #[must_use]
    #[cfg_attr(not(feature = "jit"), expect(unused_variables, reason = "only native code looks ahead"))]
    pub fn build_digesting(self, design: &Design, watch: &Watch, wanted: Option<&Wanted>) -> Box<dyn Engine> {
        match self {
            #[cfg(feature = "jit")]
            EngineKind::Compiled => Box::new(compiled::Compiled::new(design, watch).digesting_unless_large(wanted)),
            _ => self.build(design, watch),
        }
    }

    /// As [`build`](Self::build), an engine that may pass over idle samples where it gets [sparse rows](Rows::sparse).
    #[must_use]
    #[cfg_attr(not(feature = "jit"), expect(unused_variables, reason = "only native code passes over samples"))]
    pub fn build_passing(self, design: &Design, watch: &Watch, idle: &Idle) -> Box<dyn Engine> {
        match self {
            #[cfg(feature = "jit")]
            EngineKind::Compiled => Box::new(compiled::Compiled::new(design, watch).passing(idle)),
            _ => self.build(design, watch),
        }
    }
}

/// The compiled engine, but compiling as soon as `warm_up` clocks were alike: for tests and measurements.
#[cfg(feature = "jit")]
#[must_use]
pub fn compiled_after(design: &Design, watch: &Watch, warm_up: u64) -> Box<dyn Engine> {
    Box::new(compiled::Compiled::after(design, watch, warm_up))
}

/// As [`compiled_after`], as if the machine were large: with a branch for every select in whose branches there is as
/// much to do as `worth`, in cells.
#[cfg(feature = "jit")]
#[must_use]
pub fn branching_after(design: &Design, watch: &Watch, warm_up: u64, worth: u32) -> Box<dyn Engine> {
    Box::new(compiled::Compiled::after(design, watch, warm_up).branching(worth))
}

/// As [`compiled_after`], looking ahead.
#[cfg(feature = "jit")]
#[must_use]
pub fn digesting_after(design: &Design, watch: &Watch, wanted: &Wanted, warm_up: u64) -> Box<dyn Engine> {
    Box::new(compiled::Compiled::after(design, watch, warm_up).digesting(Some(wanted.clone())))
}

/// As [`compiled_after`], passing over idle samples.
#[cfg(feature = "jit")]
#[must_use]
pub fn passing_after(design: &Design, watch: &Watch, idle: &Idle, warm_up: u64) -> Box<dyn Engine> {
    Box::new(compiled::Compiled::after(design, watch, warm_up).passing(idle))
}
