use super::*;
use crate::{Controls, Direction, Feed, Place, Plane, Point, SegmentShape, Side};

mod arcs;
mod blocks;
mod faults;
mod home;
mod language;
mod random;
mod splines;

/// A BLU of 0.01 mm, tool 1 of 4 mm and tool 2 of 2.5 mm.
fn reading() -> Reading {
    Reading {
        blu: 0.01,
        degrees: 0.01,
        integers: Integers::Units,
        tools: BTreeMap::from([(1, 4.0), (2, 2.5)]),
        tolerance: 0.0,
        chords: 0.25,
        whole: false,
        home: Some([0.0; 3]),
    }
}

fn run_with(text: impl AsRef<[u8]>, reading: Reading) -> Result<Vec<Event>, ProgramError> {
    Program::new(text.as_ref(), reading).unwrap().collect()
}

fn run(text: &str) -> Vec<Event> {
    run_with(text, reading()).unwrap_or_else(|error| panic!("{text:?}: {error}"))
}

fn moves(text: &str) -> Vec<Move> {
    moves_of(&run(text))
}

fn moves_of(events: &[Event]) -> Vec<Move> {
    let moves = events.iter().filter_map(|event| match event {
        Event::Move(one) => Some(*one),
        _ => None,
    });
    moves.collect()
}

/// The ends of the moves, rounded to a millionth of a BLU.
fn ends(text: &str) -> Vec<Point> {
    moves(text).iter().map(|one| one.segment.to.map(rounded)).collect()
}

fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// The error of a program without its line and column.
fn fault(text: impl AsRef<[u8]>) -> (u64, u64, String) {
    let error = run_with(text, reading()).expect_err("the program is wrong");
    (error.line, error.column, error.kind.to_string())
}

fn place(line: u64, number: Option<u64>) -> Place {
    Place { line, number }
}
