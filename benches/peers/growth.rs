//! How time grows: with the clocks of a run, with the lanes, with the cells of a netlist.

use std::fs;
use std::path::Path;
use std::time::Instant;

use crate::contender::Wave;
use crate::measure::race;
use crate::sections::{Sizes, rate};
use crate::table::{Table, median, number, times};
use crate::unit::Case;
use crate::{Fallible, cxxrtl, own, synthetic, verilator};

/// Clocks of a run of a synthetic netlist.
const CLOCKS: u64 = 1 << 20;

pub(crate) fn growth(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    fs::create_dir_all(dir)?;
    Ok(clocks(sizes, dir)? + &lanes(sizes, dir)? + &cells(sizes, dir)?)
}

/// A line of ever more clocks.
fn clocks(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let head = ["clocks", "engine", "`stepwave run`", "with VCD", "MB, no wave", "MB, VCD"];
    let mut table = Table::new("dda-line, longer and longer: million clocks a second of processor time", &head);
    for power in (16..=sizes.longest).step_by(2) {
        let case = Case::new("dda-line", power)?;
        let jobs = [
            own::engine(&case, dir)?,
            own::program(&case, dir, Wave::None),
            own::program(&case, dir, Wave::Vcd).wave("own.vcd"),
        ];
        let runs = race(if power > 22 { 1 } else { sizes.rounds.min(3) }, &jobs)?;
        let rates = runs.iter().map(|runs| number(rate(runs)));
        let peaks = runs[1..].iter().map(|runs| number(median(runs, |run| run.peak_mb)));
        table.row(&format!("2^{power}"), rates.chain(peaks));
    }
    Ok(table.text())
}

/// More and more lanes.
fn lanes(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let mut table = Table::new("Lanes: million lane-clocks a second of one thread", &["lanes", "dda-line", "ppc-line"]);
    let mut lanes = 1;
    while lanes <= sizes.geometries {
        let mut cells = Vec::new();
        for model in ["dda-line", "ppc-line"] {
            let runs = race(sizes.rounds.min(3), &[own::lanes(&Case::new(model, sizes.lane)?, lanes, 1, dir)?])?;
            cells.push(number(median(&runs[0], |run| run.all_clocks() / run.computed / 1e6)));
        }
        table.row(&lanes.to_string(), cells);
        lanes *= 4;
    }
    Ok(table.text())
}

/// Cells up to which a C++ compiler takes what CXXRTL writes, one function, in less than minutes.
const CXXRTL_CELLS: usize = 1000;

/// Larger and larger netlists. Ours compiles as it runs, theirs before.
fn cells(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let head = ["cells", "engine, compiling included", "Verilator", "CXXRTL", "to Verilator", "to CXXRTL"];
    let head = [&head[..], &["Verilator builds, s", "CXXRTL builds, s"]].concat();
    let mut table = Table::new("Chains of integrators, 2^20 clocks: million clocks a second, one core", &head);
    let mut cells = 10;
    while cells <= sizes.cells {
        let unit = synthetic::chain(cells)?;
        let blocks = unit.line(&synthetic::block(&unit, CLOCKS));
        let dir = dir.join(cells.to_string());
        let start = Instant::now();
        let verilator = verilator::run(&unit.rtl(), &dir, Wave::None, &blocks)?;
        let verilated = start.elapsed().as_secs_f64();
        let mut jobs = vec![own::cells(cells, CLOCKS, &dir)?, verilator];
        let mut builds = vec![number(verilated)];
        if cells <= CXXRTL_CELLS {
            let start = Instant::now();
            jobs.push(cxxrtl::run(&unit.rtl(), &dir.join("cxxrtl"), Wave::None, &blocks)?);
            builds.push(number(start.elapsed().as_secs_f64()));
        }
        let mut runs = race(sizes.rounds.min(3), &jobs)?;
        runs.resize(3, Vec::new());
        builds.resize(2, number(f64::NAN));
        let rates: Vec<f64> = runs.iter().map(|runs| rate(runs)).collect();
        let ratios = rates[1..].iter().map(|peer| times(rates[0] / peer));
        let count = unit.design.netlist().cells.len();
        table.row(&count.to_string(), rates.iter().copied().map(number).chain(ratios).chain(builds));
        cells *= 10;
    }
    Ok(table.text())
}
