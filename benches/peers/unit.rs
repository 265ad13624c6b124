//! What is simulated: a design with its ports, as Verilog for the peers and as it stands for us.

use stepwave::engine::{Engine, EngineKind, Rows, Stop, Watch};
use stepwave::export;
use stepwave::models::options::{PRESET, WIDTH};
use stepwave::models::{Model, Options, Preset, find};
use stepwave::nc::{Arc, Curve, Direction, Line};
use stepwave::netlist::{Design, Net, Width, bits};
use stepwave::testbench::Testbench;
use stepwave::trace::timescale::ClockTime;

use crate::Fallible;
use crate::rtl::{Rtl, Shown};

/// A machine of a model with a block, on one side as types, on the other as words of the command line.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) model: &'static Model,
    pub(crate) width: u32,
    pub(crate) curve: Curve,
    /// Remainders of the integrators before the first step; `None`: the model has none, or begins with its own.
    pub(crate) preset: Option<Preset>,
}

pub(crate) const MODELS: [&str; 4] = ["dda-line", "ppc-line", "dda-arc", "ppc-arc"];

impl Case {
    /// The block of `2^power` clocks or somewhat more that has `power`-bit registers: a line for lines, a quarter of a
    /// circle for arcs.
    pub(crate) fn new(model: &str, power: u32) -> Fallible<Case> {
        let all = 1i64 << power;
        let preset = (model == "dda-arc").then_some(Preset::Half);
        Ok(Case { model: find(model)?, width: power, curve: curve(model, all, 0)?, preset })
    }

    /// The `index`-th of many geometries for the same hardware.
    pub(crate) fn sibling(&self, index: usize) -> Fallible<Curve> {
        let all = 1i64 << self.width;
        let less = i64::try_from(index)? * 977 % (all / 4);
        curve(self.model.name, all, less)
    }

    fn choices(&self) -> Fallible<Options> {
        Ok(Options::default().with_all(&WIDTH, Width::new(u64::from(self.width))?).with_all(&PRESET, self.preset))
    }

    pub(crate) fn bench(&self) -> Fallible<Testbench> {
        Ok(Testbench::new(self.model, &self.curve, &self.choices()?)?)
    }

    /// Words for `stepwave run` and `stepwave export`.
    pub(crate) fn words(&self) -> Vec<String> {
        let point = |point: [i64; 2]| format!("{},{}", point[0], point[1]);
        let mut words = vec![self.model.name.to_owned()];
        match &self.curve {
            Curve::Line(line) => words.extend(["--to".to_owned(), point([line.to()[0], line.to()[1]])]),
            Curve::Arc(arc) => {
                words.extend(["--from".to_owned(), point(arc.from()), "--to".to_owned(), point(arc.to())]);
                words.push("--ccw".to_owned());
            }
            _ => {}
        }
        words.extend(["--width".to_owned(), self.width.to_string()]);
        if let Some(preset) = self.preset {
            words.extend(["--preset".to_owned(), preset.to_string()]);
        }
        words
    }
}

/// A curve of about `all - less` clocks in registers that hold less than `all`. Its slope is not a ratio of small
/// numbers, which would make the pulses cycle.
fn curve(model: &str, all: i64, less: i64) -> Fallible<Curve> {
    let golden = |value: i64| value * 618_034 / 1_000_000;
    let line = |to: [i64; 2]| Ok(Curve::Line(Line::new(vec![0, 0], to.to_vec())?));
    let quarter = |radius| Ok(Curve::Arc(Arc::new([radius, 0], [0, radius], [0, 0], Direction::CounterClockwise)?));
    let size = all * 927_051 / 1_000_000 - less;
    // Four beats a step; a quarter of a circle has two steps for each unit of its radius.
    let steps = (all - less) / 4;
    match model {
        "dda-line" => line([size, golden(size)]),
        "ppc-line" => line([golden(steps), steps - golden(steps)]),
        "dda-arc" => quarter(size),
        _ => quarter(steps / 2),
    }
}

/// A design with what a test bench must know of it.
pub(crate) struct Unit {
    pub(crate) design: Design,
    /// Nets that become outputs.
    pub(crate) outputs: Vec<Net>,
    /// 1 for the clock that loads the block.
    pub(crate) strobes: Vec<Net>,
    pub(crate) done: Net,
    /// What is printed at the end; two's complement where true.
    pub(crate) result: Vec<(Net, bool)>,
    /// The Verilog that it was imported from.
    pub(crate) source: Option<String>,
}

impl Unit {
    pub(crate) fn of(bench: &Testbench) -> Unit {
        let machine = bench.machine();
        Unit {
            design: bench.design().clone(),
            outputs: bench.outputs(),
            strobes: vec![machine.load.net, machine.preset_position.net],
            done: machine.done.net,
            result: machine.positions.iter().map(|port| (port.net, port.reading.is_signed())).collect(),
            source: None,
        }
    }

    /// Its name in Verilog.
    pub(crate) fn name(&self) -> &str {
        &self.design.netlist().scopes[0].name
    }

    /// Path of a net below the top.
    fn path(&self, net: Net) -> String {
        let netlist = self.design.netlist();
        let path = netlist.name_of(net).map(|named| netlist.path(named)).unwrap_or_default();
        path.split_once('.').map_or(path.clone(), |(_, below)| below.to_owned())
    }

    /// The port of a net.
    pub(crate) fn port(&self, net: Net) -> String {
        self.path(net).replace('.', "_")
    }

    /// Inputs that a block's words are put on, in the order of a line of the file of blocks.
    fn loaded(&self) -> impl Iterator<Item = Net> {
        self.design.inputs().iter().copied().filter(|net| !self.strobes.contains(net))
    }

    /// A line of the file of blocks.
    pub(crate) fn line(&self, words: &[(Net, u64)]) -> String {
        let value = |net| words.iter().find(|(input, _)| *input == net).map_or(0, |(_, value)| *value);
        self.loaded().map(|net| value(net).to_string()).collect::<Vec<_>>().join(" ") + "\n"
    }

    /// The Verilog module and its ports.
    pub(crate) fn rtl(&self) -> Rtl {
        let netlist = self.design.netlist();
        let ports = |nets: &mut dyn Iterator<Item = Net>| nets.map(|net| self.port(net)).collect();
        let mut waved: Vec<String> = netlist.names.iter().map(|named| self.path(named.net)).collect();
        waved.push("clk".to_owned());
        waved.sort();
        waved.dedup();
        let shown =
            |&(net, signed): &(Net, bool)| Shown { port: self.port(net), width: netlist.width(net).get(), signed };
        Rtl {
            name: self.name().to_owned(),
            text: self.verilog(),
            inputs: ports(&mut self.loaded()),
            strobes: ports(&mut self.strobes.iter().copied()),
            done: self.port(self.done),
            done_register: Some(self.path(self.done)),
            result: self.result.iter().map(shown).collect(),
            waved,
        }
    }

    pub(crate) fn verilog(&self) -> String {
        let exported = || export::verilog(&self.design, &export::Options { comment: &[], outputs: &self.outputs });
        self.source.clone().unwrap_or_else(exported)
    }

    /// The test bench of `stepwave export`, and a second top module that prints the result.
    pub(crate) fn testbench(&self, bench: &Testbench) -> Fallible<String> {
        let options = export::Options { comment: &[], outputs: &self.outputs };
        let time = ClockTime::from_hz(1e6)?;
        let text = export::testbench(&self.design, &options, &bench.stimulus(), time, "wave.vcd");
        let tb = format!("{}_tb", self.name());
        let results = self.result.iter().map(|&(net, signed)| {
            let port = format!("{tb}.{}", self.port(net));
            if signed { format!(", $signed({port})") } else { format!(", {port}") }
        });
        Ok(format!(
            "{text}\nmodule result;\n    always @(posedge {tb}.{}) #1 $display(\"%0d{}\", ($time + 4) / 10{});\nendmodule\n",
            self.port(self.done),
            " %0d".repeat(self.result.len()),
            results.collect::<String>()
        ))
    }

    /// Runs a block in an engine that watches nothing but `done`, and gives the line that the peers print.
    pub(crate) fn run(&self, kind: EngineKind, words: &[(Net, u64)]) -> Fallible<String> {
        let mut rows = Rows::new(0, 1);
        let watch = Watch { columns: Vec::new(), stops: vec![self.done] };
        let mut engine: Box<dyn Engine> = kind.build(&self.design, &watch);
        for &(input, value) in words {
            engine.set_input(input, value);
        }
        for &strobe in &self.strobes {
            engine.set_input(strobe, 1);
        }
        engine.reset(&mut rows);
        for &strobe in &self.strobes {
            engine.set_input(strobe, 0);
        }
        engine.run(1, &mut rows);
        if engine.run(u64::MAX, &mut rows) != Stop::Net(0) {
            return Err("the engine did not run to the end".into());
        }
        let show = |&(net, signed): &(Net, bool)| {
            format!(" {}", bits::number(self.design.netlist().width(net), engine.value(net), signed))
        };
        Ok(format!("{}{}\n", engine.clock(), self.result.iter().map(show).collect::<String>()))
    }
}

/// The words of the first block of a test bench.
pub(crate) fn block(bench: &Testbench) -> Vec<(Net, u64)> {
    bench.stimulus().steps.first().map(|step| step.set.clone()).unwrap_or_default()
}
