//! The bench: a part's design on one engine, played by waves and read back as waves.

use std::collections::HashMap;

use stepwave_engine::{Engine, EngineKind, Rows, Watch};
use stepwave_netlist::dsl::{Module, Scope, Signal};
use stepwave_netlist::{Bits, Design, Net, OnOverflow, elaborate};

use super::super::Block;

/// Samples that a played wave may have.
const ROOM: usize = 64;

/// A part on one engine, with every named net recorded.
pub(super) struct Bench {
    design: Design,
    nets: HashMap<String, (Net, bool)>,
    columns: HashMap<Net, usize>,
    engine: Box<dyn Engine>,
    rows: Rows,
}

/// Describes a part once and checks it on every engine.
pub(super) fn on_every_engine(describe: impl FnOnce(Scope<'_>), check: impl Fn(&mut Bench)) {
    on_every_engine_with(OnOverflow::Trap, describe, check);
}

/// As [`on_every_engine`], with strict cells that do as `on_overflow` says.
pub(super) fn on_every_engine_with(
    on_overflow: OnOverflow,
    describe: impl FnOnce(Scope<'_>),
    check: impl Fn(&mut Bench),
) {
    let module = Module::with_overflow("bench", on_overflow);
    describe(module.top());
    let design = elaborate(module.finish().unwrap()).unwrap();
    for kind in EngineKind::ALL {
        // Seen only with a failure.
        println!("on the engine '{}':", kind.name());
        check(&mut Bench::new(&design, kind));
    }
}

/// A block loader that is `ready` as soon as it is loaded and never steps, for parts that only need its words.
pub(super) fn loader(m: Scope<'_>) -> Block<'_> {
    let block = Block::new(m);
    let never = m.lit(1, 0);
    block.close(block.load, never, never);
    block
}

/// An input of either reading.
pub(super) fn input<'m>(m: Scope<'m>, name: &str, bits: u32, signed: bool) -> Signal<'m> {
    if signed { m.input_signed(name, bits) } else { m.input(name, bits) }
}

/// All numbers of a width and reading.
pub(super) fn numbers(bits: u32, signed: bool) -> std::ops::RangeInclusive<i128> {
    if signed { -(1 << (bits - 1))..=(1 << (bits - 1)) - 1 } else { 0..=(1 << bits) - 1 }
}

/// The number that the low bits of `exact` mean.
pub(super) fn wrapped(exact: i128, bits: u32, signed: bool) -> i128 {
    let low = exact.rem_euclid(1 << bits);
    if signed && low >= 1 << (bits - 1) { low - (1 << bits) } else { low }
}

impl Bench {
    fn new(design: &Design, kind: EngineKind) -> Bench {
        let netlist = design.netlist();
        let columns: Vec<Net> = netlist.names.iter().map(|named| named.net).collect();
        let nets = netlist.names.iter().rev().map(|named| (named.name.clone(), (named.net, named.format.is_signed())));
        let watch = Watch { columns: columns.clone(), stops: Vec::new() };
        let rows = Rows::new(columns.len(), ROOM);
        let engine = kind.build(design, &watch);
        let columns = columns.into_iter().enumerate().map(|(column, net)| (net, column)).collect();
        Bench { design: design.clone(), nets: nets.collect(), columns, engine, rows }
    }

    fn net(&self, name: &str) -> (Net, bool) {
        *self.nets.get(name).unwrap_or_else(|| panic!("there is no net '{name}'"))
    }

    /// The design, for what a wave does not show.
    pub(super) fn design(&self) -> &Design {
        &self.design
    }

    /// Sets an input from after the next edge on.
    pub(super) fn set(&mut self, name: &str, number: i128) {
        let (net, signed) = self.net(name);
        let width = self.design.netlist().width(net);
        let bits = Bits::exact(width, number, signed).unwrap_or_else(|| panic!("{name} = {number} in {width}"));
        self.engine.set_input(net, bits.value());
    }

    /// One clock; after its edge the inputs given have these values.
    pub(super) fn clock(&mut self, inputs: &[(&str, i128)]) {
        for (name, number) in inputs {
            self.set(name, *number);
        }
        self.rows.clear();
        self.engine.run(1, &mut self.rows);
    }

    /// Value of a net in the present sample.
    pub(super) fn value(&self, name: &str) -> i128 {
        let (net, signed) = self.net(name);
        self.number(net, signed, self.engine.value(net))
    }

    fn number(&self, net: Net, signed: bool, value: u64) -> i128 {
        Bits::truncated(self.design.netlist().width(net), value).number(signed)
    }

    /// Resets and plays the waves on the inputs; sample k shows their k-th characters.
    pub(super) fn play(&mut self, waves: &[(&str, &str)]) {
        let waves: Vec<(&str, Vec<i128>)> = waves.iter().map(|(name, wave)| (*name, read(wave))).collect();
        let samples = waves[0].1.len();
        assert!(waves.iter().all(|(_, wave)| wave.len() == samples), "all waves are equally long");
        self.rows.clear();
        for sample in 0..samples {
            for (name, wave) in &waves {
                self.set(name, wave[sample]);
            }
            if sample == 0 {
                self.engine.reset(&mut self.rows);
            } else {
                self.engine.run(1, &mut self.rows);
            }
        }
        assert_eq!(self.rows.len(), samples);
    }

    /// What a net was in every sample played, as numbers.
    pub(super) fn numbers(&self, name: &str) -> Vec<i128> {
        let (net, signed) = self.net(name);
        self.rows.iter().map(|(_, row)| self.number(net, signed, row[self.columns[&net]])).collect()
    }

    /// What a net was in every sample played, as a wave.
    pub(super) fn row(&self, name: &str) -> String {
        let digit = |number: i128| match u32::try_from(number) {
            Ok(number) => char::from_digit(number, 16).unwrap_or('*'),
            Err(_) if number == -1 => '-',
            Err(_) => '*',
        };
        let digits: Vec<char> = self.numbers(name).into_iter().map(digit).collect();
        digits.chunks(4).map(|group| group.iter().collect()).collect::<Vec<String>>().join("_")
    }
}

fn read(wave: &str) -> Vec<i128> {
    let number = |c: char| match c {
        '-' => -1,
        c => i128::from(c.to_digit(16).unwrap_or_else(|| panic!("'{c}' in the wave {wave}"))),
    };
    wave.chars().filter(|&c| c != '_').map(number).collect()
}
