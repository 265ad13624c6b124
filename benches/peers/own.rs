//! stepwave: the program that users get, and, for what the program has no words for, this one as a child.

use std::path::Path;

use serde_json::Value;
use stepwave::engine::EngineKind;
use stepwave::engine::lanes::{LaneEnd, LaneProgram, LaneWatch, Observe};
use stepwave::models::Port;
use stepwave::nc::Curve;
use stepwave::netlist::bits::to_signed;
use stepwave::testbench::{LaneOutcome, Testbench};

use crate::Fallible;
use crate::contender::Wave;
use crate::measure::Job as Contender;
use crate::unit::{Case, Unit, block};
use crate::{cores, synthetic};

pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_stepwave");

/// Clocks and end point from the report.
fn says(text: &str) -> Fallible<String> {
    let report: Value = serde_json::from_str(text)?;
    let reached = report["end_point"]["reached"].as_array().into_iter().flatten();
    Ok(format!("{}{}", report["clocks"], reached.map(|value| format!(" {value}")).collect::<String>()))
}

/// `stepwave run`, with all that it looks at.
pub(crate) fn program(case: &Case, dir: &Path, wave: Wave) -> Contender {
    let words = case.words();
    let mut words: Vec<&str> = words.iter().map(String::as_str).collect();
    words.splice(0..0, [PROGRAM, "run"]);
    words.extend(["--json", "-"]);
    match wave {
        Wave::None => {}
        Wave::Vcd => words.extend(["--vcd", "own.vcd"]),
        Wave::Fst => words.extend(["--fst", "own.fst"]),
    }
    Contender::new("stepwave", dir, &words).says(says)
}

/// This program as a child.
fn child(name: &'static str, dir: &Path, words: &[String]) -> Fallible<Contender> {
    let this = std::env::current_exe()?.display().to_string();
    let mut all = vec![this.as_str()];
    all.extend(words.iter().map(String::as_str));
    Ok(Contender::new(name, dir, &all))
}

/// The engine `compiled` alone, watching nothing but `done`.
pub(crate) fn engine(case: &Case, dir: &Path) -> Fallible<Contender> {
    child("engine", dir, &["--engine".to_owned(), case.model.name.to_owned(), case.width.to_string()])
}

/// The same for a synthetic netlist.
pub(crate) fn cells(cells: usize, clocks: u64, dir: &Path) -> Fallible<Contender> {
    child("engine", dir, &["--cells".to_owned(), cells.to_string(), clocks.to_string()])
}

/// An engine alone for a core that was imported into `core.net`.
pub(crate) fn core(name: &'static str, kind: EngineKind, clocks: u64, dir: &Path) -> Fallible<Contender> {
    child(name, dir, &["--core".to_owned(), kind.name().to_owned(), clocks.to_string()])
}

/// Clocks that no geometry needs; a limit beyond 32 bits would make every lane twice as wide.
const LIMIT: u64 = 1 << 31;

/// Many geometries at once, with all that the test bench looks at.
pub(crate) fn lanes(case: &Case, geometries: usize, threads: usize, dir: &Path) -> Fallible<Contender> {
    let name = if threads == 1 { "lanes" } else { "lanes, all threads" };
    let numbers = [case.width.to_string(), geometries.to_string(), threads.to_string()];
    let words = ["--lanes".to_owned(), case.model.name.to_owned()].into_iter().chain(numbers);
    Ok(child(name, dir, &words.collect::<Vec<_>>())?.cores(Some(threads)))
}

/// Many geometries at once on one thread, watching nothing but `done` and where the machine ends.
pub(crate) fn bare_lanes(case: &Case, geometries: usize, dir: &Path) -> Fallible<Contender> {
    let words = ["--bare-lanes", case.model.name].map(str::to_owned);
    let numbers = [case.width.to_string(), geometries.to_string(), "1".to_owned()];
    child("bare lanes", dir, &[&words[..], &numbers].concat())
}

/// What such a child does; its result.
pub(crate) fn as_child(kind: &str, words: &[String]) -> Fallible<String> {
    let number = |index: usize| -> Fallible<usize> { Ok(words.get(index).ok_or("a word is missing")?.parse()?) };
    match kind {
        "--engine" => {
            let bench = Case::new(&words[0], u32::try_from(number(1)?)?)?.bench()?;
            Unit::of(&bench).run(EngineKind::Compiled, &block(&bench))
        }
        "--cells" => {
            let unit = synthetic::chain(number(0)?)?;
            let words = synthetic::block(&unit, number(1)? as u64);
            unit.run(EngineKind::Compiled, &words)
        }
        "--core" => {
            let unit = cores::imported(Path::new("core.net"))?;
            let kind = EngineKind::ALL.into_iter().find(|kind| kind.name() == words[0]).ok_or("no such engine")?;
            unit.run(kind, &cores::block(&unit, number(1)? as u64))
        }
        _ => {
            let case = Case::new(&words[0], u32::try_from(number(1)?)?)?;
            let curves = (0..number(2)?).map(|index| case.sibling(index)).collect::<Fallible<Vec<_>>>()?;
            let pool = rayon::ThreadPoolBuilder::new().num_threads(number(3)?).build()?;
            let bench = case.bench()?;
            if kind == "--bare-lanes" {
                return pool.install(|| run_bare(&bench, &curves));
            }
            let outcomes = pool.install(|| bench.run_many(&curves, LIMIT))?;
            let outcomes = outcomes.into_iter().map(|outcome| {
                let LaneOutcome { clocks, reached, .. } = outcome?;
                Ok(line(clocks, reached.into_iter()))
            });
            outcomes.collect()
        }
    }
}

/// As the peers do: each geometry is loaded and runs until `done`.
fn run_bare(bench: &Testbench, curves: &[Curve]) -> Fallible<String> {
    let machine = bench.machine();
    let watch = LaneWatch {
        rest: vec![(machine.load.net, 0), (machine.preset_position.net, 0)],
        observe: machine.positions.iter().map(|port| Observe::Last(port.net)).collect(),
        limit: LIMIT,
        ..LaneWatch::new(machine.done.net)
    };
    let lanes = bench.lanes(LIMIT)?;
    let mut ends = Vec::with_capacity(curves.len());
    LaneProgram::new(bench.design(), &watch).run(curves.iter(), |curve| lanes.job(curve), |end| ends.push(end));
    let position = |(port, bits): (&Port, &u64)| to_signed(port.width, *bits);
    let outcomes = ends.into_iter().map(|end| {
        let LaneEnd { clock, values, .. } = end?;
        Ok(line(clock, machine.positions.iter().zip(&values).map(position)))
    });
    outcomes.collect()
}

fn line(clocks: u64, reached: impl Iterator<Item = i64>) -> String {
    format!("{clocks}{}\n", reached.map(|value| format!(" {value}")).collect::<String>())
}
