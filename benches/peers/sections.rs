//! What is measured, section by section.

use std::borrow::Cow;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use crate::choice::Choice;
use crate::contender::{Wave, first_line};
use crate::measure::{Job, Measurement, race};
use crate::rtl::Rtl;
use crate::table::{Table, median, number, times};
use crate::unit::{Case, MODELS, Unit, block};
use crate::{Fallible, cores, cxxrtl, growth, icarus, lean, own, verilator};

/// How much of everything; powers of two of clocks.
pub(crate) struct Sizes {
    pub(crate) models: Cow<'static, [&'static str]>,
    pub(crate) rounds: usize,
    /// A run without a wave, one with, one of Icarus, which is slow, one of many lanes.
    pub(crate) run: u32,
    pub(crate) wave: u32,
    pub(crate) icarus: u32,
    pub(crate) lane: u32,
    pub(crate) geometries: usize,
    /// The longest run, the longest with a wave, and the largest netlist.
    pub(crate) longest: u32,
    pub(crate) longest_wave: u32,
    pub(crate) cells: usize,
    /// Where the section `growth` draws its curves.
    pub(crate) svg: Option<PathBuf>,
}

/// The largest netlist with `--large`: Verilator builds it for minutes.
pub(crate) const MOST_CELLS: usize = 100_000;

pub(crate) const FULL: Sizes = Sizes {
    models: Cow::Borrowed(&MODELS),
    rounds: 3,
    run: 25,
    wave: 20,
    icarus: 16,
    lane: 16,
    geometries: 4096,
    longest: 26,
    longest_wave: 22,
    cells: 10_000,
    svg: None,
};
pub(crate) const QUICK: Sizes = Sizes {
    models: Cow::Borrowed(&["dda-line", "ppc-arc"]),
    rounds: 1,
    run: 24,
    wave: 18,
    icarus: 14,
    lane: 12,
    geometries: 1024,
    longest: 20,
    longest_wave: 20,
    cells: 100,
    svg: None,
};

/// What is measured together.
pub(crate) struct Section {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    /// It has a row for each model that is asked for.
    pub(crate) by_model: bool,
    /// Names of the other simulators that it starts.
    pub(crate) peers: &'static [&'static str],
    measure: fn(&Sizes, &Path) -> Fallible<String>,
}

const ALL_PEERS: &[&str] = &["Icarus", "Verilator", "CXXRTL"];

pub(crate) const SECTIONS: [Section; 6] = [
    Section {
        name: "first-wave",
        about: "16 clocks from the source to a VCD, compilers included",
        by_model: true,
        peers: ALL_PEERS,
        measure: first_wave,
    },
    Section {
        name: "no-trace",
        about: "long runs without a wave, of exported and of lean hand-written RTL",
        by_model: true,
        peers: ALL_PEERS,
        measure: no_trace,
    },
    Section {
        name: "waves",
        about: "full VCD and FST to a file: speed, size, memory",
        by_model: true,
        peers: ALL_PEERS,
        measure: waves,
    },
    Section {
        name: "lanes",
        about: "thousands of geometries of one hardware",
        by_model: true,
        peers: &["Verilator"],
        measure: lanes,
    },
    Section {
        name: "growth",
        about: "longer runs, more lanes, larger netlists",
        by_model: false,
        peers: &["Verilator", "CXXRTL"],
        measure: growth::growth,
    },
    Section {
        name: "cores",
        about: "processors that others wrote, imported; `.ci/import` fetches their sources",
        by_model: false,
        peers: ALL_PEERS,
        measure: cores::cores,
    },
];

/// Measures what is asked for, and prints it.
pub(crate) fn all(words: &[String]) -> Fallible<()> {
    let choice = Choice::of(words)?;
    choice.check_tools()?;
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("peers");
    if dir.exists() {
        fs::remove_dir_all(&dir)?;
    }
    println!("{}", machine());
    for note in &choice.notes {
        println!("{note}");
    }
    for section in &choice.sections {
        let start = Instant::now();
        eprintln!("{}", section.name);
        println!("{}", (section.measure)(&choice.sizes, &dir.join(section.name))?);
        eprintln!("{}: {:.0} s", section.name, start.elapsed().as_secs_f64());
    }
    Ok(())
}

/// The machine and the versions.
fn machine() -> String {
    let cpu = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "{}, {cores} cores. stepwave {}; {}; {}; {}; {}.",
        model.map_or("unknown processor", |(_, model)| model),
        env!("CARGO_PKG_VERSION"),
        first_line("verilator", &["--version"]),
        first_line("yosys", &["-V"]),
        first_line("iverilog", &["-V"]).trim_end_matches(" ()"),
        first_line("g++", &["--version"]),
    )
}

/// Millions of clocks a second of processor time.
pub(crate) fn rate(runs: &[Measurement]) -> f64 {
    median(runs, |run| run.clocks() / run.computed / 1e6)
}

/// Seconds on the clock.
fn wall(runs: &[Measurement]) -> f64 {
    median(runs, |run| run.wall)
}

pub(crate) fn peak(runs: &[Measurement]) -> String {
    number(median(runs, |run| run.peak_mb))
}

fn first_wave(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let head = ["16 clocks", "stepwave, ms", "Icarus, ms", "CXXRTL, ms", "Verilator, ms", "to Icarus", "to CXXRTL"];
    let head = [&head[..], &["to Verilator"]].concat();
    let mut table = Table::new("From source to first wave: time on the clock, all cores, compilers included", &head);
    for &model in sizes.models.iter() {
        let dir = dir.join(model);
        let (case, bench) = (Case::new(model, 4)?, Case::new(model, 4)?.bench()?);
        let unit = Unit::of(&bench);
        let blocks = unit.line(&block(&bench));
        let peers = [
            icarus::first_wave(&unit, &bench, &dir.join("icarus"))?,
            cxxrtl::first_wave(&unit.rtl(), &dir.join("cxxrtl"), &blocks)?,
            verilator::first_wave(&unit.rtl(), &dir.join("verilator"), &blocks)?,
        ];
        // The slow ones need fewer rounds: what disturbs is milliseconds long.
        let rounds = [4 * sizes.rounds, 4 * sizes.rounds, sizes.rounds.min(2), sizes.rounds.min(2)];
        let own = own::program(&case, &dir, Wave::Vcd).wave("own.vcd");
        let jobs = [own].into_iter().chain(peers.map(|job| job.wave("wave.vcd"))).zip(rounds);
        let jobs: Vec<Job> = jobs.map(|(job, rounds)| job.cores(None).rounds(rounds)).collect();
        same_waves(&unit, &jobs)?;
        let runs = race(4 * sizes.rounds, &jobs)?;
        let walls: Vec<f64> = runs.iter().map(|runs| wall(runs)).collect();
        let ratios = walls[1..].iter().map(|peer| times(peer / walls[0]));
        table.row(model, walls.iter().map(|wall| number(wall * 1e3)).chain(ratios));
    }
    Ok(table.text())
}

/// Long runs without a wave in Verilator and in CXXRTL, both built at once.
pub(crate) fn built(rtl: &Rtl, dir: &Path, blocks: &str) -> (Fallible<Job>, Fallible<Job>) {
    rayon::join(
        || verilator::run(rtl, &dir.join("verilator"), Wave::None, blocks),
        || cxxrtl::run(rtl, &dir.join("cxxrtl"), Wave::None, blocks),
    )
}

/// Whether all waves show the same, by `stepwave diff`.
fn same_waves(unit: &Unit, jobs: &[Job]) -> Fallible<()> {
    let stepwave = env!("CARGO_BIN_EXE_stepwave");
    for job in jobs {
        let output = Command::new(&job.words[0]).args(&job.words[1..]).current_dir(&job.dir).output()?;
        let wave = job.wave.as_ref().filter(|wave| output.status.success() && wave.exists());
        let wave = wave.ok_or_else(|| format!("{} makes no wave: {:?}", job.name, job.words))?;
        if job.name != jobs[0].name {
            let scope = if job.name == "Icarus" { format!("{}_tb", unit.name()) } else { "TOP".to_owned() };
            let mut diff = Command::new(stepwave);
            diff.arg("diff").args(jobs[0].wave.iter()).arg(wave);
            diff.args(["--map", &format!("{0}={scope}.{0}", unit.name())]);
            // Verilator shows the ports of the top once more, in a scope around it.
            for net in &unit.outputs {
                diff.args(["--ignore", &format!("TOP.{}", unit.port(*net))]);
            }
            let output = diff.output()?;
            if !output.status.success() {
                let said = String::from_utf8_lossy(&output.stdout).into_owned();
                return Err(format!("the wave of {} differs: {said}", job.name).into());
            }
        }
    }
    Ok(())
}

fn no_trace(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let head = ["model", "clocks", "engine", "`stepwave run`", "Verilator", "CXXRTL", "Icarus", "engine to Verilator"];
    let head = [&head[..], &["to CXXRTL", "to Icarus", "`run` to Verilator"]].concat();
    let mut speed = Table::new("Without a wave: million clocks a second, one core", &head);
    let head = ["model", "engine", "`stepwave run`", "Verilator", "CXXRTL", "Icarus"];
    let mut memory = Table::new("Without a wave: peak memory, MB", &head);
    for &model in sizes.models.iter() {
        let dir = dir.join(model);
        let case = Case::new(model, sizes.run)?;
        let bench = case.bench()?;
        let unit = Unit::of(&bench);
        let blocks = unit.line(&block(&bench));
        let (verilator, cxxrtl) = built(&unit.rtl(), &dir, &blocks);
        let own = own::program(&case, &dir, Wave::None).rounds(2);
        let jobs = [own::engine(&case, &dir)?, own, verilator?, cxxrtl?];
        let mut runs = race(sizes.rounds, &jobs)?;
        // Icarus is so slow that a shorter block must do.
        let case = Case::new(model, sizes.icarus)?;
        let bench = case.bench()?;
        let icarus = icarus::run(&Unit::of(&bench), &bench, &dir.join("icarus"), Wave::None)?;
        runs.extend(race(1, &[icarus, own::engine(&case, &dir)?])?.into_iter().take(1));
        let rates: Vec<f64> = runs.iter().map(|runs| rate(runs)).collect();
        let ratios = rates[2..].iter().map(|peer| rates[0] / peer).chain([rates[1] / rates[2]]);
        let clocks = format!("{:.0}", runs[0][0].clocks());
        speed.row(model, [clocks].into_iter().chain(rates.iter().copied().map(number)).chain(ratios.map(times)));
        memory.row(model, runs.iter().map(|runs| peak(runs)));
    }
    Ok(speed.text() + &lean::no_trace(sizes, dir)? + &memory.text())
}

fn waves(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let head = ["model", "stepwave", "Verilator", "CXXRTL", "Icarus", "to Verilator", "to CXXRTL", "to Icarus"];
    let mut vcd = Table::new("Full VCD to a file: million clocks a second, one core", &head);
    let mut fst = Table::new("FST to a file: million clocks a second, one core", &head);
    let mut cores = Table::new("Full VCD to a file: million clocks a second on the clock, all cores", &head);
    let head = ["model", "VCD stepwave", "Verilator", "CXXRTL", "Icarus", "FST stepwave", "Verilator", "Icarus"];
    let mut bytes = Table::new("Wave files: bytes a clock", &head);
    let mut memory = Table::new("Writing waves: peak memory, MB", &head);
    for &model in sizes.models.iter() {
        let dir = dir.join(model);
        let case = Case::new(model, sizes.wave)?;
        let bench = case.bench()?;
        let unit = Unit::of(&bench);
        let blocks = unit.line(&block(&bench));
        let own = |wave, name: &str| own::program(&case, &dir, wave).wave(name);
        let rtl = unit.rtl();
        let verilated = |wave, name| Ok(verilator::run(&rtl, &dir.join(name), wave, &blocks)?.wave("wave.vcd"));
        let cxxrtl = || Ok(cxxrtl::run(&rtl, &dir.join("cxxrtl"), Wave::Vcd, &blocks)?.wave("wave.vcd"));
        let (to_vcd, (to_fst, cxxrtl)): (Fallible<Job>, (Fallible<Job>, Fallible<Job>)) =
            rayon::join(|| verilated(Wave::Vcd, "vcd"), || rayon::join(|| verilated(Wave::Fst, "fst"), cxxrtl));
        let jobs = [own(Wave::Vcd, "own.vcd"), to_vcd?, cxxrtl?, own(Wave::Fst, "own.fst"), to_fst?];
        fs::create_dir_all(&dir)?;
        let mut runs = race(sizes.rounds, &jobs)?;
        let [to_vcd, to_fst] = icarus_waves(model, sizes, &dir)?;
        runs.insert(3, to_vcd);
        runs.push(to_fst);
        let free: Vec<Job> = jobs.into_iter().take(3).map(|job| job.cores(None)).collect();
        let free = race(sizes.rounds, &free)?;
        let row = |rates: &[f64]| {
            let ratios: Vec<String> = rates[1..].iter().map(|peer| times(rates[0] / peer)).collect();
            rates.iter().copied().map(number).chain(ratios).collect::<Vec<_>>()
        };
        let rates: Vec<f64> = runs.iter().map(|runs| rate(runs)).collect();
        vcd.row(model, row(&rates[..4]));
        fst.row(model, row(&[rates[4], rates[5], f64::NAN, rates[6]]));
        let mut walls: Vec<f64> = free.iter().map(|runs| median(runs, |run| run.clocks() / run.wall / 1e6)).collect();
        walls.push(f64::NAN);
        cores.row(model, row(&walls));
        bytes.row(model, runs.iter().map(|runs| number(median(runs, |run| run.wave_bytes / run.clocks()))));
        memory.row(model, runs.iter().map(|runs| peak(runs)));
    }
    Ok([vcd, cores, fst, bytes, memory].map(Table::text).concat())
}

/// A shorter block in Icarus, to VCD and to FST, one round each: enough for a ratio of a hundred.
fn icarus_waves(model: &str, sizes: &Sizes, dir: &Path) -> Fallible<[Vec<Measurement>; 2]> {
    let case = Case::new(model, sizes.icarus)?;
    let bench = case.bench()?;
    let (unit, folder) = (Unit::of(&bench), dir.join("icarus"));
    let run = |wave| Ok::<_, Box<dyn Error + Send + Sync>>(icarus::run(&unit, &bench, &folder, wave)?.wave("wave.vcd"));
    let jobs = [run(Wave::Vcd)?, run(Wave::Fst)?, own::program(&case, dir, Wave::None)];
    let [to_vcd, to_fst, _] = <[Vec<Measurement>; 3]>::try_from(race(1, &jobs)?).map_err(|_| "three jobs")?;
    Ok([to_vcd, to_fst])
}

fn lanes(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let title = format!("{} geometries of one hardware: million lane-clocks a second", sizes.geometries);
    let threads = format!("{all} threads, on the clock");
    let one = ["one thread", "with all checks", "Verilator, one after another", "to Verilator", "with all checks"];
    let many = ["1 thread, on the clock", &threads, "gain"];
    let mut table = Table::new(&title, &[&["model"][..], &one, &many].concat());
    for &model in sizes.models.iter() {
        let dir = dir.join(model);
        let case = Case::new(model, sizes.lane)?;
        let (unit, blocks) = many_blocks(&case, sizes.geometries)?;
        let jobs = [
            own::lanes(&case, sizes.geometries, 1, &dir)?,
            own::lanes(&case, sizes.geometries, all, &dir)?,
            own::bare_lanes(&case, sizes.geometries, &dir)?,
            verilator::run(&unit.rtl(), &dir, Wave::None, &blocks)?.rounds(1),
        ];
        let runs = race(sizes.rounds, &jobs)?;
        let computed = |runs: &Vec<Measurement>| median(runs, |run| run.all_clocks() / run.computed / 1e6);
        let wall = |runs: &Vec<Measurement>| median(runs, |run| run.all_clocks() / run.wall / 1e6);
        let (checked, bare, peer) = (computed(&runs[0]), computed(&runs[2]), computed(&runs[3]));
        let (single, multiple) = (wall(&runs[0]), wall(&runs[1]));
        let rates = [bare, checked, peer].map(number).into_iter().chain([bare, checked].map(|own| times(own / peer)));
        let cores = [number(single), number(multiple), times(multiple / single)];
        table.row(model, rates.chain(cores));
    }
    Ok(table.text())
}

/// Hardware, and the file of blocks of many geometries for it.
fn many_blocks(case: &Case, geometries: usize) -> Fallible<(Unit, String)> {
    let bench = case.bench()?;
    let unit = Unit::of(&bench);
    let mut blocks = String::new();
    for index in 0..geometries {
        blocks += &unit.line(&block(&bench.of(case.model, &case.sibling(index)?)?));
    }
    Ok((unit, blocks))
}
