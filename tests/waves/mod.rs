//! Waves read back by readers that are not this project's, and compared with what the engine did, sample by sample.

mod cases;
mod fst;
mod header;
mod idle;
mod own_designs;
mod pane;
mod save_file;
mod second_reader;
mod trace;
mod window;
mod written;

use std::collections::HashMap;

use stepwave::testbench::{Observer, ObserverError, Testbench, WaveWriter, Window};
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_models::find;
use stepwave_netlist::cells::{NamedNet, Netlist, Op};
use stepwave_netlist::{Design, Net};
use stepwave_trace::probe::Selection;
use stepwave_trace::timescale::ClockTime;
use stepwave_trace::vcd::VcdHeader;

use crate::cli::Folder;
use cases::{Case, cases, line};
pub(crate) use written::read;

/// Ticks of one clock at 1 MHz, in units of 100 ns.
const TICKS: u64 = 10;

/// Keeps every sample.
#[derive(Default)]
struct Keep(Vec<Vec<u64>>);

impl Observer for Keep {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for (clock, row) in rows.iter() {
            assert_eq!(clock, self.0.len() as u64, "samples come one by one");
            self.0.push(row.to_vec());
        }
        Ok(())
    }
}

/// A named signal and its true values.
struct Truth {
    path: String,
    width: u32,
    signed: bool,
    register: bool,
    constant: bool,
    /// Its value in every sample, as bits.
    samples: Vec<String>,
}

impl Truth {
    fn of(netlist: &Netlist, named: &NamedNet, column: impl Fn(Net) -> usize, rows: &[Vec<u64>]) -> Truth {
        let all = |of_kind: fn(&Op) -> bool| named.nets().all(|net| of_kind(&netlist.cell(net).op));
        let digits = |row: &Vec<u64>| {
            let part = |net| format!("{:01$b}", row[column(net)], netlist.width(net).get() as usize);
            named.nets().collect::<Vec<_>>().into_iter().rev().map(part).collect()
        };
        Truth {
            path: netlist.path(named),
            width: named.nets().map(|net| netlist.width(net).get()).sum(),
            signed: named.format.is_signed(),
            register: all(|op| matches!(op, Op::Register { .. })),
            constant: all(|op| matches!(op, Op::Const(_))),
            samples: rows.iter().map(digits).collect(),
        }
    }

    /// The type that viewers show rightly by default.
    fn variable_type(&self) -> &'static str {
        match self {
            Truth { constant: true, .. } => "parameter",
            Truth { signed: true, .. } => "integer",
            Truth { register: true, .. } => "reg",
            _ => "wire",
        }
    }

    /// The bit range that belongs after the name.
    fn range(&self) -> Option<(i64, i64)> {
        let ranged = self.width > 1 && ["reg", "wire"].contains(&self.variable_type());
        ranged.then(|| (i64::from(self.width) - 1, 0))
    }
}

/// What an engine did, and the wave of it.
struct Recording {
    /// Every name of the design.
    signals: Vec<Truth>,
    /// Number of samples.
    samples: u64,
    vcd: Vec<u8>,
}

/// What a helper of these tests takes for granted.
const GOOD: &str = "a good case";

fn record(case: &Case, engine: EngineKind) -> Recording {
    let bench = Testbench::new(find(case.model).expect(GOOD), &case.curve, &case.choices).expect(GOOD);
    let run = |keep: &mut Keep, wave: &mut dyn Observer| {
        bench.run(engine, &mut [keep, wave]).expect(GOOD);
    };
    recording(case.what, bench.design(), bench.columns().nets(), run)
}

/// Runs a design without inputs for this many clocks, in blocks of 100 samples.
fn record_design(design: &Design, clocks: u64, engine: EngineKind) -> Recording {
    let mut columns: Vec<Net> = design.netlist().names.iter().flat_map(NamedNet::nets).collect();
    columns.sort();
    columns.dedup();
    let mut rows = Rows::new(columns.len(), 100);
    let mut engine = engine.build(design, &Watch { columns: columns.clone(), stops: Vec::new() });
    recording("a design of its own", design, &columns, |keep, wave| {
        engine.reset(&mut rows);
        loop {
            engine.run(clocks - engine.clock(), &mut rows);
            for observer in [&mut *keep, &mut *wave] as [&mut dyn Observer; 2] {
                observer.samples(&rows).expect(GOOD);
            }
            rows.clear();
            if engine.clock() == clocks {
                break;
            }
        }
    })
}

/// Lets a run be seen by an observer that keeps every sample and by a wave writer.
fn recording(
    what: &str,
    design: &Design,
    columns: &[Net],
    run: impl FnOnce(&mut Keep, &mut dyn Observer),
) -> Recording {
    let probes = Selection::default().probes(design, columns).expect(GOOD);
    let header = VcdHeader {
        comment: what,
        probes: &probes,
        time: ClockTime::from_hz(1e6).expect(GOOD),
        clk: true,
        states: false,
    };
    let mut wave = WaveWriter::new(header.write(Vec::new()).expect(GOOD), Window::default());
    let mut keep = Keep::default();
    run(&mut keep, &mut wave);
    let netlist = design.netlist();
    let column = |net| columns.iter().position(|column| *column == net).expect(GOOD);
    let truth = |named: &NamedNet| Truth::of(netlist, named, column, &keep.0);
    Recording {
        signals: netlist.names.iter().map(truth).collect(),
        samples: keep.0.len() as u64,
        vcd: wave.finish().expect(GOOD),
    }
}

/// A variable as a reader shows it.
pub(crate) struct Variable {
    pub(crate) kind: String,
    pub(crate) width: u32,
    pub(crate) range: Option<(i64, i64)>,
    /// Times and values, as bits.
    pub(crate) changes: Vec<(u64, String)>,
}

impl Variable {
    /// The value at a time, changes at this very time included.
    pub(crate) fn at(&self, time: u64) -> Option<&str> {
        let count = self.changes.partition_point(|(changed, _)| *changed <= time);
        Some(self.changes[count.checked_sub(1)?].1.as_str())
    }
}

/// A wave as a reader shows it: variables by path.
pub(crate) struct Shown {
    pub(crate) variables: HashMap<String, Variable>,
    last_time: u64,
}

/// Compares the samples from clock `first` on: every named signal of `truth` must be there with its type, width, range
/// and value at every clock, and change at edges only.
fn compare<'a>(what: &str, shown: &Shown, truth: impl IntoIterator<Item = &'a Truth>, first: u64, last: u64) {
    let mut compared = 0;
    for signal in truth {
        let path = &signal.path;
        let variable = shown.variables.get(path).unwrap_or_else(|| panic!("{what}: {path} is missing"));
        assert_eq!(variable.kind, signal.variable_type(), "{what}: type of {path}");
        assert_eq!((variable.width, variable.range), (signal.width, signal.range()), "{what}: width of {path}");
        for (clock, expected) in (0..=last).zip(&signal.samples).skip_while(|(clock, _)| *clock < first) {
            assert_eq!(variable.at(clock * TICKS), Some(expected.as_str()), "{what}: {path} at clock {clock}");
        }
        assert!(last < signal.samples.len() as u64, "{what}: more clocks than the run has");
        let early = first * TICKS;
        assert!(
            variable.changes.iter().all(|(time, _)| *time >= early && time % TICKS == 0),
            "{what}: {path} off the edges"
        );
        compared += 1;
    }
    let clk = usize::from(shown.variables.keys().any(|path| path.ends_with(".clk")));
    assert_eq!(shown.variables.len(), compared + clk, "{what}: variables that nobody knows");
    assert_eq!(shown.last_time, (last + 1) * TICKS, "{what}: the last cycle must be visible");
}

/// The clock of a wave that shows samples `first` to `last`.
fn compare_clock(what: &str, shown: &Shown, first: u64, last: u64) {
    let path = shown.variables.keys().find(|path| path.ends_with(".clk")).unwrap_or_else(|| panic!("{what}: no clk"));
    let clk = &shown.variables[path];
    assert_eq!((clk.kind.as_str(), clk.width, clk.range), ("wire", 1, None), "{what}");
    for clock in first..=last {
        let high = if clock == 0 { "0" } else { "1" };
        let halves =
            [0, TICKS / 2 - 1, TICKS / 2, TICKS - 1].map(|later| clk.at(clock * TICKS + later).unwrap_or("nothing"));
        assert_eq!(halves, [high, high, "0", "0"], "{what}: cycle {clock}");
    }
}
