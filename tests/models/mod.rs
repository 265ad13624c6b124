//! Every register of every model at every step, compared with the recurrences in `reference`.

mod any_size;
mod bounds;
mod cim;
mod conics;
mod cut_words;
mod dda;
mod dda_conic;
mod dda_decimal;
mod dda_helix;
mod dda_serial;
mod digests;
mod dpm;
mod mindev_vector;
mod ppc;
mod promises;
mod ramp;
mod registers;
mod sampled;
mod sampled_spline;
mod smooth;
mod space_lines;
mod spacing;
mod speed;
mod spline;
mod stepgen_bresenham;
mod widths;

use std::cell::RefCell;
use std::collections::HashMap;

use rayon::prelude::*;
use stepwave::testbench::{Ending, Observer, ObserverError, Outcome, Step, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::options::WIDTH;
use stepwave_models::{Options, find};
use stepwave_nc::{Arc, Curve, Direction, Line};
use stepwave_netlist::Width;

use crate::reference::Table;

/// Keeps the whole step table: clocks since the block was loaded, registers, pulses, position.
struct Keep(Vec<Vec<i64>>);

impl Observer for Keep {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        let mut row = Vec::with_capacity(1 + step.registers.len() + 2 * step.pulses.len());
        row.push(i64::try_from(step.clock).unwrap() - 1);
        for &value in &step.registers {
            row.push(i64::try_from(value).unwrap());
        }
        row.extend_from_slice(&step.pulses);
        row.extend_from_slice(&step.position);
        self.0.push(row);
        Ok(())
    }
}

/// A run: its step table with named columns, and how it ended.
struct Ran {
    columns: Vec<String>,
    rows: Vec<Vec<i64>>,
    outcome: Outcome,
}

pub(crate) fn line(from: &[i64], to: &[i64]) -> Curve {
    Curve::Line(Line::new(from.to_vec(), to.to_vec()).unwrap())
}

pub(crate) fn arc(from: [i64; 2], to: [i64; 2], center: [i64; 2], clockwise: bool) -> Curve {
    let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
    Curve::Arc(Arc::new(from, to, center, direction).unwrap())
}

/// Widths of single registers.
pub(crate) fn widths(given: &[(&str, u32)]) -> Options {
    let width = |bits: u32| Width::new(u64::from(bits)).unwrap();
    Options::default()
        .with_single(&WIDTH, given.iter().map(|(name, bits)| ((*name).to_owned(), width(*bits))).collect())
}

/// Every line from the origin of up to five bits.
fn every_line(bits: u32, check: impl Fn([i64; 2]) + Sync) {
    let most = (1i64 << bits) - 1;
    (-most..=most).into_par_iter().for_each(|x| {
        (-most..=most).filter(|&y| [x, y] != [0, 0]).for_each(|y| check([x, y]));
    });
}

/// All points with x² + y² = r2.
fn lattice(r2: i64) -> Vec<[i64; 2]> {
    let r = r2.isqrt();
    let square = (-r..=r).flat_map(|x| (-r..=r).map(move |y| [x, y]));
    square.filter(|[x, y]| x * x + y * y == r2).collect()
}

/// R² below this limit.
fn squares_below(limit: i64) -> Vec<i64> {
    (1..limit).collect()
}

/// Those of all radii below 14, and every seventh of the greater ones.
fn some_below_30() -> Vec<i64> {
    (1..196).chain((196..900).step_by(7)).collect()
}

/// Every arc and full circle about the origin between lattice points with these R², in both directions.
fn every_lattice_arc(squares: &[i64], check: impl Fn([i64; 2], [i64; 2], bool) + Sync) {
    squares.par_iter().for_each(|&r2| {
        let points = lattice(r2);
        for &from in &points {
            for &to in &points {
                [true, false].into_iter().for_each(|clockwise| check(from, to, clockwise));
            }
        }
    });
}

thread_local! {
    /// Benches of each model, the last one used first, for the next geometries that plan the same hardware.
    static BENCHES: RefCell<HashMap<&'static str, Vec<Testbench>>> = RefCell::default();
}

fn bench(model: &str, curve: &Curve, choices: &Options) -> Testbench {
    let model = find(model).unwrap();
    let hardware = model.plan(curve, choices).unwrap_or_else(|error| panic!("{curve:?} {choices:?}: {error}"));
    BENCHES.with_borrow_mut(|benches| {
        let known = benches.entry(model.name).or_default();
        match known.iter().position(|bench| *bench.hardware() == hardware) {
            Some(place) => known[..=place].rotate_right(1),
            None => known.insert(0, Testbench::of_hardware(model, hardware).unwrap()),
        }
        known[0].of(model, curve).unwrap()
    })
}

fn run(model: &str, curve: &Curve, choices: &Options, engine: EngineKind) -> Ran {
    run_on(&bench(model, curve, choices), engine)
}

fn run_on(bench: &Testbench, engine: EngineKind) -> Ran {
    let mut keep = Keep(Vec::new());
    let outcome = bench.run(engine, &mut [&mut keep]).unwrap();
    let letters = bench.hardware().letters();
    // As `Keep` has them.
    let mut columns = vec!["clock".to_owned()];
    columns.extend(bench.machine().table.iter().map(|(name, _)| (*name).to_owned()));
    columns.extend(letters.iter().map(|axis| format!("d{axis}")));
    columns.extend(letters.iter().map(|axis| (*axis).to_owned()));
    Ran { columns, rows: keep.0, outcome }
}

/// Compares every column of the reference, row by row.
fn assert_equal(what: impl Fn() -> String, ran: &Ran, reference: &Table) {
    let place = |name: &String| ran.columns.iter().position(|column| column == name);
    let places: Vec<usize> = reference
        .columns
        .iter()
        .map(|name| place(name).unwrap_or_else(|| panic!("{}: no column {name}", what())))
        .collect();
    let differs = |got: &[i64], want: &[i64]| (0..places.len()).find(|&index| got[places[index]] != want[index]);
    for (step, (got, want)) in ran.rows.iter().zip(&reference.rows).enumerate() {
        assert_eq!(want.len(), places.len());
        if let Some(index) = differs(got, want) {
            assert_eq!(got[places[index]], want[index], "{}: {} after step {step}", what(), reference.columns[index]);
        }
    }
    assert_eq!(ran.rows.len(), reference.rows.len(), "{}: number of steps", what());
}

/// Runs on one engine, compares with the reference, and expects a clean end.
fn check(model: &str, curve: &Curve, choices: &Options, engine: EngineKind, reference: &Table) {
    let what = || format!("{model} {curve:?} {choices:?} on {}", engine.name());
    let ran = run(model, curve, choices, engine);
    assert_equal(what, &ran, reference);
    assert_eq!(ran.outcome.ending, Ending::Done, "{}", what());
    assert_eq!(ran.outcome.reached, curve.to(), "{}: end point", what());
}
