//! Judges the reading of NC programs by LinuxCNC's interpreter: compares the moves of a program with the canonical calls
//! that the command `rs274 -g` of LinuxCNC writes for it.
//!
//! ```text
//! cargo run -p stepwave-nc --example linuxcnc -- PROGRAM CALLS
//! ```
//!
//! `.ci/linuxcnc` runs it on real programs. Where the program has an error, both must have read the same moves in front
//! of it. Moves of no length, which LinuxCNC writes and this crate does not, are passed.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs::File;
use std::io::{BufRead, BufReader};

use stepwave_nc::{Direction, Event, Feed, Integers, Move, Place, Plane, Program, Reading, SegmentShape};

/// 0.1 µm: what LinuxCNC writes of a length in mm.
const BLU: f64 = 1e-4;

/// A canonical call in mm and mm/min.
#[derive(Debug)]
struct Call {
    rapid: bool,
    /// End point; of an arc along the axes of its plane.
    end: [f64; 3],
    /// Centre and turns of an arc.
    arc: Option<[f64; 3]>,
    feed: Option<f64>,
    /// Half of the last digit that LinuxCNC writes, in mm.
    rounding: f64,
}

impl Call {
    fn is_like(&self, peer: &Call) -> bool {
        let near = |ours: &[f64], theirs: &[f64], margin: f64| {
            ours.iter().zip(theirs).all(|(ours, theirs)| (ours - theirs).abs() <= margin)
        };
        let feed = match (self.feed, peer.feed) {
            (Some(ours), Some(theirs)) => (ours - theirs).abs() <= peer.rounding * 2.0,
            _ => self.rapid,
        };
        let arc = match (&self.arc, &peer.arc) {
            (Some(ours), Some(theirs)) => near(ours, theirs, peer.rounding * 2.0),
            (ours, theirs) => ours.is_none() && theirs.is_none(),
        };
        self.rapid == peer.rapid && arc && feed && near(&self.end, &peer.end, peer.rounding * 2.0)
    }
}

fn of_move(one: &Move) -> Call {
    let to = one.segment.to.map(|value| value * BLU);
    let (end, arc) = match one.segment.shape {
        SegmentShape::Line | SegmentShape::Bezier(_) => (to, None),
        SegmentShape::Arc { plane, center: [x, y], direction } => {
            let turns = if direction == Direction::Clockwise { -1.0 } else { 1.0 };
            (plane.of(to), Some([x * BLU, y * BLU, turns]))
        }
    };
    let feed = match one.feed {
        Feed::PerMinute(feed) => Some(feed),
        Feed::Rapid | Feed::Inverse(_) => None,
    };
    Call { rapid: one.feed == Feed::Rapid, end, arc, feed, rounding: 0.0 }
}

/// The calls that move, without those of no length.
fn of_linuxcnc(text: impl BufRead) -> Result<Vec<Call>, Box<dyn Error>> {
    let mut calls: Vec<Call> = Vec::new();
    let (mut unit, mut plane, mut feed, mut position) = (1.0, Plane::Xy, None, [0.0; 3]);
    for line in text.lines() {
        let line = line?;
        let Some((head, rest)) = line.split_once('(') else { continue };
        let name = head.rsplit(' ').next().unwrap_or_default();
        let words = rest.split(')').next().unwrap_or_default().split(", ");
        if name == "USE_LENGTH_UNITS" {
            unit = if rest.starts_with("CANON_UNITS_INCHES") { 25.4 } else { 1.0 };
            continue;
        }
        if name == "SELECT_PLANE" {
            plane = match rest {
                rest if rest.starts_with("CANON_PLANE_XZ") => Plane::Zx,
                rest if rest.starts_with("CANON_PLANE_YZ") => Plane::Yz,
                _ => Plane::Xy,
            };
            continue;
        }
        if !matches!(name, "SET_FEED_RATE" | "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED" | "ARC_FEED") {
            continue;
        }
        let numbers: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>()?;
        let lengths: Vec<f64> = numbers.iter().map(|number| number * unit).collect();
        let rounding = 0.5e-4 * unit + 1e-6;
        match lengths[..] {
            [rate, ..] if name == "SET_FEED_RATE" => feed = Some(rate),
            [first, second, x, y, _, third, ..] if name == "ARC_FEED" => {
                let end = [first, second, third];
                position = plane.point(end);
                calls.push(Call { rapid: false, end, arc: Some([x, y, numbers[4]]), feed, rounding });
            }
            [x, y, z, ..] => {
                let end = [x, y, z];
                let still = end.iter().zip(position).all(|(new, old)| (new - old).abs() <= rounding * 2.0);
                position = end;
                if !still {
                    calls.push(Call { rapid: name == "STRAIGHT_TRAVERSE", end, arc: None, feed, rounding });
                }
            }
            _ => return Err(format!("{line} has too few numbers").into()),
        }
    }
    Ok(calls)
}

#[expect(clippy::print_stdout, reason = "a program, not the library")]
fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [program, calls] = &arguments[..] else {
        return Err("give the program and the calls that LinuxCNC made of it".into());
    };
    let theirs = of_linuxcnc(BufReader::new(File::open(calls)?))?;
    let reading = Reading {
        blu: BLU,
        degrees: BLU,
        integers: Integers::Units,
        tools: BTreeMap::new(),
        tolerance: 0.0,
        chords: 0.5,
        whole: false,
        home: None,
    };
    let mut ours: Vec<(Place, Call)> = Vec::new();
    let mut end = String::from("its end");
    for event in Program::new(BufReader::new(File::open(program)?), reading)? {
        match event {
            Ok(Event::Move(one)) => ours.push((one.place, of_move(&one))),
            Ok(_) => {}
            Err(error) => end = error.to_string(),
        }
    }
    for ((place, ours), theirs) in ours.iter().zip(&theirs) {
        if !ours.is_like(theirs) {
            return Err(format!("{program}:{}: {ours:?} is {theirs:?} in LinuxCNC", place.line).into());
        }
    }
    if ours.len() != theirs.len() || ours.is_empty() {
        return Err(format!("{program} has {} moves up to {end}, {} in LinuxCNC", ours.len(), theirs.len()).into());
    }
    let arcs = ours.iter().filter(|(_, call)| call.arc.is_some()).count();
    println!("{program}: {} moves, {arcs} of them arcs, up to {end}", ours.len());
    Ok(())
}
