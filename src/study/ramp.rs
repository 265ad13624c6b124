//! A machine that accelerates: one move across the travel, run as `stepwave program` runs it, and what its ramp was seen to do.

use crate::Error;
use crate::engine::Rows;
use crate::models::{CurveKind, Model, Options, installed};
use crate::netlist::bits::to_signed;
use crate::netlist::cells::Netlist;
use crate::netlist::{Net, Width};
use crate::output::temporary::Folder;
use crate::simulation::{Onlookers, Prepared, Simulation};
use crate::testbench::{BlockReport, Ending, Observer, ObserverError, Testbench};

use super::machine::{Dimensions, Size};

/// Clocks after which the move is given up.
const LIMIT: u64 = 1 << 28;

/// The registers of a ramp, in the order in which they are named; those of the S curve last.
const REGISTERS: [&str; 7] = ["phase", "v", "accel", "decel", "av", "ju", "jd"];

/// Part of a move.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Part {
    /// How long it takes.
    pub seconds: f64,
    /// How far it goes.
    pub mm: f64,
}

/// A move with acceleration.
#[derive(Clone, Debug)]
pub struct Ramped {
    /// The family, as `--method` takes it.
    pub family: &'static str,
    /// The program with the move.
    pub program: String,
    /// Registers of the ramp, with their bits.
    pub registers: Vec<(&'static str, u32)>,
    /// The greatest feed that was reached, in mm/min.
    pub feed: f64,
    /// That is less than what was asked of the ramp: it has to brake before.
    pub is_short: bool,
    /// From the start to the end of the ramp up, and from the beginning of the ramp down to the last step.
    pub ramps: [Part; 2],
    /// Clocks of the move.
    pub clocks: u64,
    /// The time that these take.
    pub seconds: f64,
}

/// The machine for whole programs of the family of a method.
#[must_use]
pub fn machine_of(model: &Model) -> Option<&'static Model> {
    let family = model.name.split('-').next().unwrap_or_default();
    installed().machines().find(|machine| machine.is_buffered() && machine.method_name() == family)
}

/// A number as programs take it: mm, without what a product of decimal numbers is too much.
fn word(axis: char, blu: i64, blu_mm: f64) -> String {
    let digits = format!("{:.12}", blu as f64 * blu_mm);
    format!(" {axis}{}", digits.trim_end_matches('0').trim_end_matches('.'))
}

/// One move with this feed: to the end of the travel, or of an arc a quarter of the greatest circle.
fn program(kind: CurveKind, size: &Size) -> String {
    let word = |axis: char, blu: i64| word(axis, blu, size.blu_mm);
    let feed = format!(" F{}", size.feed_of(size.feed));
    if kind == CurveKind::Arc {
        let r = radius(size);
        return format!("G21 G90 G3{}{}{}{}{feed}\nM2\n", word('X', -r), word('Y', r), word('I', -r), word('J', 0));
    }
    let ends: String = ['X', 'Y', 'Z'].into_iter().zip(&size.travel).map(|(axis, blu)| word(axis, *blu)).collect();
    format!("G21 G90 G1{ends}{feed}\nM2\n")
}

/// Of the greatest circle, in BLU.
fn radius(size: &Size) -> i64 {
    size.travel[0].min(size.travel[1])
}

/// The move across the travel, ready to be run as a program.
struct Across {
    machine: &'static Model,
    text: String,
    simulation: Simulation,
    bench: Testbench,
    /// Holds the text.
    _folder: Folder,
}

/// The move by the machine of a method. `None` where the method has no machine for programs.
fn across(found: &Dimensions, size: &Size, options: &Options, hz: f64) -> Result<Option<Across>, Error> {
    let Some(machine) = machine_of(found.model) else { return Ok(None) };
    let text = program(found.model.curve(), size);
    let folder = Folder::new()?;
    let file = folder.path().join("move.ngc");
    std::fs::write(&file, &text)?;
    let simulation = Simulation::program(machine, &file).options(options.clone()).clock_hz(hz).blu_mm(size.blu_mm);
    let simulation = simulation.max_clocks(LIMIT);
    let Prepared { bench, .. } = simulation.prepare()?;
    Ok(Some(Across { machine, text, simulation, bench, _folder: folder }))
}

/// The machine that runs programs by a method, as wide as a move across the travel needs it, with pulse source, block buffer, and
/// the ramp that the options ask for, if they do. `None` where there is none.
///
/// # Errors
/// The acceleration cannot be had: in words.
pub fn whole(
    found: &Dimensions,
    size: &Size,
    options: &Options,
    hz: f64,
) -> Result<Option<(&'static Model, Testbench)>, Error> {
    Ok(across(found, size, options, hz)?.map(|across| (across.machine, across.bench)))
}

/// Runs the move by the machine of a method. `None` where the method has no machine for programs.
///
/// # Errors
/// The acceleration cannot be had, or the move does not come to its end: in words.
pub fn ramped(found: &Dimensions, size: &Size, options: &Options, hz: f64) -> Result<Option<Ramped>, Error> {
    let Some(across) = across(found, size, options, hz)? else { return Ok(None) };
    let Across { machine, text, simulation, bench, _folder } = across;
    let kind = found.model.curve();
    let netlist = bench.design().netlist();
    let bits = |name: &'static str| Some((name, netlist.width(register(netlist, name)?).get()));
    let registers = REGISTERS.into_iter().filter_map(bits).collect();
    let along = if kind == CurveKind::Arc { Along::Arc(radius(size)) } else { Along::Line };
    let watch = |bench: &Testbench| RampWatch::new(bench, along).ok_or_else(|| missing(machine));
    let mut outputs = simulation.outputs();
    let ran = simulation.run_on(simulation.lean(bench), &mut outputs, |bench, _| watch(bench))?;
    let RampWatch { top, drive, up, down, block, bits: n, .. } = ran.onlookers;
    let (true, Some(block)) = (ran.report.outcome.ending == Ending::Done, block) else {
        let sentence = format!(
            "{}: its move across the travel takes more than {LIMIT} clocks: give a greater --feed",
            machine.name
        );
        return Err(Error::Invalid(sentence));
    };
    let end = block.begun + block.clocks;
    let part = |from: u64, to: u64, blu: f64| Part { seconds: (to - from) as f64 / hz, mm: blu * size.blu_mm };
    let source_hz = top as f64 / 2f64.powi(n.cast_signed()) * hz;
    Ok(Some(Ramped {
        family: machine.method_name(),
        program: text,
        registers,
        feed: size.feed_of(source_hz * block.length / block.steps as f64),
        is_short: top < drive,
        ramps: [part(block.begun, up.to.0, up.to.1), part(down.from.0, end, block.length - down.from.1)],
        clocks: block.clocks,
        seconds: block.clocks as f64 / hz,
    }))
}

/// A register of the ramp.
fn register(netlist: &Netlist, name: &str) -> Option<Net> {
    let scopes = ["pulse_source", "pulse_source.s_curve"];
    let path = |scope: &str| format!("{}.{scope}.{name}", netlist.scopes.first().map_or("", |top| &top.name));
    scopes.into_iter().find_map(|scope| netlist.find(&path(scope))).map(|entry| entry.net)
}

fn missing(machine: &Model) -> Error {
    Error::Invalid(format!("{} has no ramp in front of its pulse source: leave --accel out", machine.name))
}

/// How a length along the move follows from where the machine is.
#[derive(Clone, Copy, Debug)]
enum Along {
    Line,
    /// Counter-clockwise from the origin about (-r, 0).
    Arc(i64),
}

impl Along {
    fn length(self, at: &[i64]) -> f64 {
        let float = |axis: usize| at.get(axis).copied().unwrap_or(0) as f64;
        match self {
            Along::Line => at.iter().map(|&blu| (blu as f64).powi(2)).sum::<f64>().sqrt(),
            Along::Arc(r) => r as f64 * float(1).atan2(float(0) + r as f64),
        }
    }
}

/// Clock, and length along the move in BLU.
type Place = (u64, f64);

/// Samples in which the speed grows, or falls, each time.
#[derive(Clone, Copy, Default)]
struct Slope {
    /// Where it begins, and its speed there; where it is now, or has ended.
    from: Place,
    start: u64,
    to: Place,
    /// By how much it has changed.
    change: u64,
}

/// Looks at the speed of a ramp.
struct RampWatch {
    along: Along,
    /// Columns of the speed and the greatest speed of the block, and of the position of each axis with its width.
    v: usize,
    vc: usize,
    axes: Vec<(usize, Width)>,
    /// Bits of the phase.
    bits: u32,
    /// The greatest speed, and what it was to be.
    top: u64,
    drive: u64,
    /// The speed of the sample before, whether it was a change, and upwards.
    before: u64,
    rises: Option<bool>,
    /// The present slope, and those with the greatest changes: parts of one move may have a scale of their own, from which a
    /// speed changes a little.
    slope: Slope,
    up: Slope,
    down: Slope,
    block: Option<BlockReport>,
}

impl RampWatch {
    fn new(bench: &Testbench, along: Along) -> Option<RampWatch> {
        let netlist = bench.design().netlist();
        let axes = bench.machine().positions.iter();
        let axes = axes.map(|port| (bench.columns().index(port.net), port.width)).collect();
        let column = |name: &str| Some(bench.columns().index(register(netlist, name)?));
        let slope = Slope::default();
        Some(RampWatch {
            along,
            v: column("v")?,
            vc: column("vc")?,
            axes,
            bits: netlist.width(register(netlist, "phase")?).get(),
            top: 0,
            drive: 0,
            before: 0,
            rises: None,
            slope,
            up: slope,
            down: slope,
            block: None,
        })
    }

    fn place(&self, rows: &Rows, row: usize) -> Place {
        let at = self.axes.iter().map(|&(column, width)| to_signed(width, rows.value(column, row)));
        let at: Vec<i64> = at.collect();
        (rows.first_clock() + row as u64, self.along.length(&at))
    }
}

impl Observer for RampWatch {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for (row, &v) in rows.column(self.v).iter().enumerate() {
            if v == self.before {
                self.rises = None;
                continue;
            }
            let (rises, place) = (v > self.before, self.place(rows, row));
            if self.rises.replace(rises) != Some(rises) {
                self.slope = Slope { from: place, start: self.before, ..Slope::default() };
            }
            (self.slope.to, self.slope.change) = (place, v.abs_diff(self.slope.start));
            let greatest = if rises { &mut self.up } else { &mut self.down };
            if self.slope.change > greatest.change {
                *greatest = self.slope;
            }
            if v > self.top {
                (self.top, self.drive) = (v, rows.column(self.vc)[row]);
            }
            self.before = v;
        }
        Ok(())
    }

    fn block_ended(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        self.block = Some(block.clone());
        Ok(())
    }
}

impl Onlookers for RampWatch {
    fn observers(&mut self) -> Vec<&mut dyn Observer> {
        vec![self]
    }
}
