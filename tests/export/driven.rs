//! A design with a loader next to it is the design under its test bench, sample by sample.

use std::collections::BTreeMap;

use stepwave::models::{Options, catalogue, find};
use stepwave::nc::{Arc, Corner, Curve, Direction, Integers, Line, Reading, Scheme};
use stepwave::program::{Control, Pace, Preparation, Stream, Survey};
use stepwave::testbench::{Ending, Observer, ObserverError, Testbench};
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_export::{Step, Stimulus, driven};
use stepwave_netlist::{Design, Net};

use super::design;
use crate::cli::Folder;
use crate::import::bench::{netlist, written};

/// Keeps every sample.
struct Samples(Vec<Vec<u64>>);

impl Observer for Samples {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        self.0.extend(rows.iter().map(|(_, row)| row));
        Ok(())
    }
}

/// Samples of a design that nobody drives.
fn samples(design: &Design, columns: Vec<Net>, clocks: usize) -> Vec<Vec<u64>> {
    let mut rows = Rows::new(columns.len(), clocks);
    let mut engine = EngineKind::Word.build(design, &Watch { columns, stops: Vec::new() });
    engine.reset(&mut rows);
    engine.run(clocks as u64 - 1, &mut rows);
    rows.iter().map(|(_, row)| row).collect()
}

#[test]
fn a_machine_with_a_loader_runs_as_on_the_bench() {
    let line = Curve::Line(Line::new(vec![1, 2], vec![-7, 5]).unwrap());
    // Three quadrants: three blocks, one after another.
    let arc = Curve::Arc(Arc::new([5, -3], [-5, 3], [0, 0], Direction::CounterClockwise).unwrap());
    let models = ["ppc-line", "dda-line", "stepgen-machine", "bresenham-machine", "dpm-machine", "cim-machine"];
    let lines = models.map(|model| (model, &line));
    let arcs = ["ppc-arc", "dda-arc", "ppc-machine", "dda-machine", "mindev-machine"].map(|model| (model, &arc));
    for (model, curve) in lines.into_iter().chain(arcs) {
        let bench = Testbench::new(find(model).unwrap(), curve, &Options::default()).unwrap();
        let mut seen = Samples(Vec::new());
        bench.run(EngineKind::Gates, &mut [&mut seen]).unwrap();
        as_on_the_bench(model, &bench, &bench.driven().unwrap(), &seen);
    }
}

/// Every named net of a driven design is in every sample what was seen of it on the bench.
fn as_on_the_bench(what: &str, bench: &Testbench, driven: &Design, seen: &Samples) {
    assert_eq!(driven.inputs(), []);
    let netlist = bench.design().netlist();
    let columns = netlist.names.iter().map(|named| driven.netlist().find(&netlist.path(named)).unwrap().net);
    let found = samples(driven, columns.collect(), seen.0.len());
    for (clock, (found, seen)) in found.iter().zip(&seen.0).enumerate() {
        for (value, named) in found.iter().zip(&netlist.names) {
            let wanted = seen[bench.columns().index(named.net)];
            assert_eq!(*value, wanted, "{what}: {} at clock {clock}", named.name);
        }
    }
}

#[test]
fn a_machine_of_a_program_with_a_loader_runs_as_on_the_bench() {
    // Dwells first, one after another there and between blocks, and last; arcs, and three axes.
    let text =
        "G21 G90 G4 P0.01\nG4 P0.001\nG1 X0.3 Y0.09 F300\nX0.09 Y0.36 F500\nG4 P0.002\nG2 X0.24 Y0.21 I0.15 J0\n\
        G1 X0 Y0 Z0.03\nG0 X0.1\nG4 P0\nG4 P0.001\nG18 G2 X0.3 Z0.03 I0.1 K0\nG4 P0.001\nM30\n"
            .as_bytes();
    let reading = Reading {
        blu: 0.01,
        degrees: 0.01,
        integers: Integers::Units,
        tools: BTreeMap::new(),
        tolerance: 0.0,
        chords: 0.5,
        whole: true,
        home: None,
    };
    let preparation = Preparation { reading, scheme: Scheme::C, corner: Corner::Straight };
    let pace = Pace { clock_hz: 20_000.0, blu_mm: 0.01, blu_degrees: 0.01, rapid: None, jump: None };
    // Own hardware has no buffer, and takes arcs as chords.
    let line = Line::new(vec![0; 3], vec![127; 3]).unwrap().into();
    let folder = Folder::new();
    let words: String = ["x", "y", "z"].map(|a| format!("jv{a}_in = \"abs(d{a})\", s{a}_in = \"d{a} < 0\", ")).concat();
    let axes = ["x", "y", "z"].map(|axis| format!("[axis.{axis}]\npulse = \"d{axis}\"\n")).concat();
    let bench = format!("load = {{ {words}e_in = \"1 << 7\" }}\nstart = \"load\"\ndone = \"done\"\n{axes}");
    let own = written(&folder, &netlist("dda-line", &line, "", |_, _| {}), &bench);
    for model in catalogue().machines().chain([own]) {
        let moves = model.moves().unwrap();
        let survey = Survey::of(text, moves, &preparation).unwrap();
        let hardware = model.plan_program(&survey.size, &Options::default()).unwrap();
        let bench = Testbench::of_machine(hardware.clone(), model.machine(&hardware).unwrap());
        let control = || Control::new(Stream::new(text, moves, &preparation).unwrap(), moves, &bench, pace);
        let mut seen = Samples(Vec::new());
        let outcome = bench.run_fed(EngineKind::Word, &mut control(), &mut [&mut seen]).unwrap();
        assert_eq!((outcome.ending, outcome.reached), (Ending::Done, vec![30, 0, 3]), "{}", model.name);
        let driven = bench.driven_by(&bench.stimulus_fed(&mut control()).unwrap()).unwrap();
        as_on_the_bench(model.name, &bench, &driven, &seen);
    }
}

#[test]
fn steps_last_as_long_as_they_are_to_and_done_counts_from_their_second_sample_on() {
    let mut nets = Vec::new();
    let design = design("m", |m| {
        let (a, b) = (m.input("a", 4), m.input("loader", 2));
        let r = m.reg("r", 4);
        r.set(a);
        let done = m.name("done", r.q.is_nonzero());
        nets.extend([a, b, r.q, done].map(|signal| signal.net()));
    });
    let [a, b, r, done] = nets[..] else { unreachable!() };
    let step = |value, clocks| Step { set: vec![(a, value)], clocks };
    // Done in the first sample of the second step already, which does not end it; the last step has no end.
    let steps = vec![step(3, Some(2)), step(9, None), step(1, Some(1))];
    let stimulus = Stimulus { steps, done: vec![done], never: Vec::new(), always: false, stall: None };
    let driven = driven(&design, &stimulus, &[b]).unwrap();
    let rows = samples(&driven.design, vec![driven.net(a), driven.net(r)], 7);
    assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [3, 3, 9, 9, 1, 1, 1]);
    assert_eq!(rows.iter().map(|row| row[1]).collect::<Vec<_>>(), [0, 3, 3, 9, 9, 1, 1]);
    // What is open stays an input, and the loader takes a name that is free.
    assert_eq!(driven.design.inputs(), [driven.net(b)]);
    assert!(driven.design.netlist().find("m.loader_1.step").is_some());
}

#[test]
fn without_steps_all_inputs_are_0() {
    let design = design("m", |m| _ = m.input("a", 4));
    let stimulus = Stimulus { steps: Vec::new(), done: Vec::new(), never: Vec::new(), always: false, stall: None };
    let driven = driven(&design, &stimulus, &[]).unwrap();
    let a = driven.net(design.inputs()[0]);
    assert_eq!(samples(&driven.design, vec![a], 3), [[0], [0], [0]]);
}
