//! How time grows: with the clocks of a run, with the lanes, with the cells of a netlist.

use std::fs;
use std::path::Path;
use std::time::Instant;

use crate::contender::Wave;
use crate::measure::{Job, Measurement, race};
use crate::plot::{self, Panel, Series};
use crate::sections::{Sizes, rate};
use crate::table::{Table, median, number, times};
use crate::unit::{Case, Unit};
use crate::{Fallible, cxxrtl, own, synthetic, verilator};

/// Clocks of a run of a synthetic netlist.
const CLOCKS: u64 = 1 << 20;

pub(crate) fn growth(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    fs::create_dir_all(dir)?;
    let (clocks, over_clocks) = clocks(sizes, dir)?;
    let lanes = lanes(sizes, dir)?;
    let (cells, over_cells) = cells(sizes, dir)?;
    if let Some(path) = &sizes.svg {
        fs::write(path, plot::svg(&[over_cells, over_clocks]))?;
    }
    Ok(clocks + &lanes + &cells)
}

/// A line of ever more clocks.
fn clocks(sizes: &Sizes, dir: &Path) -> Fallible<(String, Panel)> {
    let head = ["clocks", "engine", "`stepwave run`", "with VCD", "MB, no wave", "MB, VCD"];
    let mut table = Table::new("dda-line, longer and longer: million clocks a second of processor time", &head);
    let mut series =
        ["engine alone", "stepwave run", "stepwave run --vcd"].map(|name| Series { name, points: Vec::new() });
    for power in (16..=sizes.longest).step_by(2) {
        let case = Case::new("dda-line", power)?;
        let mut jobs = vec![own::engine(&case, dir)?, own::program(&case, dir, Wave::None)];
        // A longer one fills disks, and measures them.
        if power <= sizes.longest_wave {
            jobs.push(own::program(&case, dir, Wave::Vcd).wave("own.vcd"));
        }
        let mut runs = race(if power > 22 { 1 } else { sizes.rounds.min(3) }, &jobs)?;
        runs.resize(3, Vec::new());
        for (series, runs) in series.iter_mut().zip(&runs).filter(|(_, runs)| !runs.is_empty()) {
            series.points.push([median(runs, Measurement::clocks), rate(runs)]);
        }
        let rates = runs.iter().map(|runs| number(rate(runs)));
        let peaks = runs[1..].iter().map(|runs| number(median(runs, |run| run.peak_mb)));
        table.row(&format!("2^{power}"), rates.chain(peaks));
    }
    let panel = Panel { title: "dda-line: longer and longer", across: "clocks of the run", series: series.into() };
    Ok((table.text(), panel))
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

/// Seconds after which Verilator's build of a netlist is given up.
const BUILD_LIMIT: u64 = 600;

/// Larger and larger netlists. Ours compiles as it runs, theirs before.
fn cells(sizes: &Sizes, dir: &Path) -> Fallible<(String, Panel)> {
    let head = ["cells", "engine, compiling included", "Verilator", "CXXRTL", "to Verilator", "to CXXRTL"];
    let head = [&head[..], &["Verilator builds, s", "CXXRTL builds, s"]].concat();
    let mut table = Table::new("Chains of integrators, 2^20 clocks: million clocks a second, one core", &head);
    let mut series = ["stepwave, compiling included", "Verilator, built before", "CXXRTL, built before"]
        .map(|name| Series { name, points: Vec::new() });
    let mut cells = 10;
    while cells <= sizes.cells {
        let unit = synthetic::chain(cells)?;
        let dir = dir.join(cells.to_string());
        let (verilator, verilated) = verilated(&unit, &dir)?;
        let mut jobs = vec![own::cells(cells, CLOCKS, &dir)?];
        let mut columns = vec![0];
        let mut builds = [verilated, number(f64::NAN)];
        if let Some(job) = verilator {
            jobs.push(job);
            columns.push(1);
        }
        if cells <= CXXRTL_CELLS {
            let start = Instant::now();
            let blocks = unit.line(&synthetic::block(&unit, CLOCKS));
            jobs.push(cxxrtl::run(&unit.rtl(), &dir.join("cxxrtl"), Wave::None, &blocks)?);
            columns.push(2);
            builds[1] = number(start.elapsed().as_secs_f64());
        }
        // A round of the largest takes minutes.
        let runs = race(if cells > 10_000 { 1 } else { sizes.rounds.min(3) }, &jobs)?;
        let count = unit.design.netlist().cells.len();
        let mut rates = [f64::NAN; 3];
        for (&column, runs) in columns.iter().zip(&runs) {
            rates[column] = rate(runs);
            // Far fewer than 2^52.
            series[column].points.push([f64::from(u32::try_from(count)?), rates[column]]);
        }
        let ratios = rates[1..].iter().map(|peer| times(rates[0] / peer));
        table.row(&count.to_string(), rates.into_iter().map(number).chain(ratios).chain(builds));
        cells *= 10;
    }
    let panel =
        Panel { title: "Chains of integrators, 2^20 clocks", across: "cells of the netlist", series: series.into() };
    Ok((table.text(), panel))
}

/// The job of Verilator and the seconds that it was built in; without the job where that takes too long.
fn verilated(unit: &Unit, dir: &Path) -> Fallible<(Option<Job>, String)> {
    let start = Instant::now();
    let blocks = unit.line(&synthetic::block(unit, CLOCKS));
    let built = verilator::run_within(&unit.rtl(), unit.design.netlist().cells.len(), dir, &blocks, BUILD_LIMIT);
    let seconds = start.elapsed().as_secs();
    match built {
        Ok(job) => Ok((Some(job), number(start.elapsed().as_secs_f64()))),
        Err(_) if seconds >= BUILD_LIMIT => Ok((None, format!("given up after {BUILD_LIMIT}"))),
        Err(error) => Err(error),
    }
}
