//! `stepwave machine`: what a machine of a given size takes by each method, side by side.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use rayon::prelude::*;
use serde_json::json;

use super::columns::{aligned, markdown};
use super::progress::Progress;
use super::widths::{evidence, one_bit_below, registers_json};
use crate::Error;
use crate::cli::{BenchArgs, MachineArgs};
use crate::models::{Model, installed};
use crate::nc::COORDINATE_LIMIT;
use crate::output;
use crate::report::run_command;
use crate::study::machine::{Dimensions, dimensions, takes};
use crate::study::proof::ProofError;
use crate::testbench::Ending;

/// A machine as it is asked for.
struct Size {
    /// Travel of each axis in BLU.
    travel: Vec<i64>,
    /// BLU/s.
    feed: f64,
    blu_mm: f64,
}

impl Size {
    /// mm/min of a speed in BLU/s.
    fn feed_of(&self, speed: f64) -> f64 {
        speed * self.blu_mm * 60.0
    }
}

/// Prints a row for each method, and what its registers need.
pub(crate) fn run(args: &MachineArgs) -> Result<(), Error> {
    let size = size(args)?;
    let models = models(args, &size.travel)?;
    let progress = Progress::new("geometries");
    let tick = |more| progress.add(more);
    let one = |model: &'static Model| (model, dimensions(model, &size.travel, size.feed, args.clock_hz, &tick));
    let all: Vec<_> = models.into_par_iter().map(one).collect();
    let (mut rows, mut left_out) = (Vec::new(), Vec::new());
    for (model, found) in all {
        match found {
            Ok(found) => rows.push(found),
            Err(error @ (ProofError::Model(_) | ProofError::Box(_))) => left_out.push((model.name, error.to_string())),
            Err(error) => return Err(error.into()),
        }
    }
    progress.finish();
    if let (true, Some((_, reason))) = (rows.is_empty(), left_out.first()) {
        return Err(Error::Invalid(format!("no method can be had for such a machine; the first: {reason}")));
    }
    if args.json {
        return output::print_data(&as_json(&size, &rows, &left_out));
    }
    let mut text = heading(&size) + "\n" + &table(&size, &rows, args.markdown);
    for found in &rows {
        text += "\n";
        text += &registers(found, args.markdown);
    }
    for (_, reason) in left_out {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "\nleft out: {reason}");
    }
    output::print(&text)
}

/// The travel in whole BLU, rounded up, so that the machine is never too small.
#[allow(clippy::cast_possible_truncation)]
fn size(args: &MachineArgs) -> Result<Size, Error> {
    let blu = |mm: &f64| {
        // What a quotient of decimal numbers is too much.
        let units = (mm / args.blu - 1e-6).ceil().max(1.0);
        if units > COORDINATE_LIMIT as f64 {
            let sentence = format!("a travel of {mm} mm is {units} BLU, beyond 2^52: give a greater --blu");
            return Err(Error::Invalid(sentence));
        }
        Ok(units as i64)
    };
    let clock = args.clock_hz;
    if !(1e-3..=1e15).contains(&clock) {
        return Err(Error::Invalid(format!("--clock-hz {clock} is not a clock: give 0.001 to 1e15 Hz, such as 1e6")));
    }
    if !(1e-6..=1e9).contains(&args.feed) {
        return Err(Error::Invalid(format!("a feed of {} mm/min is out of range: give 1e-6 to 1e9 mm/min", args.feed)));
    }
    let travel: Vec<i64> = args.travel.0.iter().map(blu).collect::<Result<_, _>>()?;
    Ok(Size { travel, feed: args.feed / 60.0 / args.blu, blu_mm: args.blu })
}

/// The methods that are named, or all that take such a travel.
fn models(args: &MachineArgs, travel: &[i64]) -> Result<Vec<&'static Model>, Error> {
    if args.models.is_empty() {
        return Ok(installed().iter().filter(|model| takes(model, travel)).collect());
    }
    let bench = BenchArgs::default();
    let mut named = args.models.iter().map(|word| bench.model(word)).collect::<Result<Vec<_>, _>>()?;
    let mut seen = BTreeSet::new();
    named.retain(|model| seen.insert(model.name));
    match named.iter().find(|model| !takes(model, travel)) {
        Some(model) => Err(Error::Invalid(format!(
            "{} is not a method of lines of {} axes or of arcs alone: leave it out",
            model.name,
            travel.len()
        ))),
        None => Ok(named),
    }
}

fn heading(size: &Size) -> String {
    let travel: Vec<String> = size.travel.iter().map(ToString::to_string).collect();
    format!(
        "travel ±{} BLU of {} mm, feed {} mm/min\n",
        travel.join(", ±"),
        size.blu_mm,
        rounded(size.feed_of(size.feed))
    )
}

/// Four digits or all of a whole number.
fn rounded(number: f64) -> String {
    if number >= 1000.0 {
        format!("{number:.0}")
    } else {
        format!("{number:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

/// What is not known, as a run did not come to its end.
fn unknown() -> String {
    "-".to_owned()
}

/// A clock with its unit.
fn frequency(hz: f64) -> String {
    match hz {
        hz if hz >= 1e6 => format!("{:.3} MHz", hz / 1e6),
        hz if hz >= 1e3 => format!("{:.3} kHz", hz / 1e3),
        hz => format!("{hz:.3} Hz"),
    }
}

/// How the runs at the corners ended, if not all at their ends.
fn unfinished(found: &Dimensions) -> usize {
    found.corners.iter().filter(|corner| corner.ending != Ending::Done).count()
}

const HEADING: [&str; 5] =
    ["method", "registers, bits", "clock", "feed at that clock, mm/min", "greatest error at the corners"];

fn table(size: &Size, rows: &[Dimensions], is_markdown: bool) -> String {
    let row = |found: &Dimensions| {
        let bits: Vec<String> = found.registers.iter().map(|own| format!("{} {}", own.name, own.needed)).collect();
        let clock = found.clock_hz(size.feed);
        let feeds = found.speeds().zip(clock).map_or_else(unknown, |(speeds, clock)| {
            let feeds = speeds.map(|speed| rounded(size.feed_of(speed * clock)));
            if feeds[0] == feeds[1] { feeds[0].clone() } else { feeds.join(" to ") }
        });
        let error = found.worst().map_or(0.0, |worst| worst.error);
        let error = format!("{error:.3} BLU, {} µm", rounded(error * size.blu_mm * 1000.0));
        [
            format!("{}{}", found.model.name, "*".repeat(unfinished(found).min(1))),
            bits.join(", "),
            clock.map_or_else(unknown, frequency),
            feeds,
            error,
        ]
    };
    let mut all = vec![HEADING.map(str::to_owned)];
    all.extend(rows.iter().map(row));
    let mut text = if is_markdown { markdown(&all, &[2, 3, 4]) } else { aligned(&all, &[2, 3, 4]) };
    if rows.iter().any(|found| unfinished(found) > 0) {
        text += "\n* not all runs at the corners came to their end: clock and feed are not known\n";
    }
    text
}

/// Every register of a method, how its width is known, and what happens one bit below.
fn registers(found: &Dimensions, is_markdown: bool) -> String {
    let mut text = if is_markdown {
        format!("### {}\n\n| register | bits | known | one bit below |\n|---|---:|---|---|\n", found.model.name)
    } else {
        format!("{}\n", found.model.name)
    };
    for own in &found.registers {
        let (name, bits, known, below) = (&own.name, own.needed, evidence(own), one_bit_below(found.model, own));
        // Writing to a string cannot fail.
        let _ = match is_markdown {
            true => writeln!(text, "| {name} | {bits} | {known} | {below} |"),
            false => writeln!(text, "  {name:<8} {bits:>3}  {known:<11}  {below}"),
        };
    }
    text
}

fn as_json(size: &Size, rows: &[Dimensions], left_out: &[(&str, String)]) -> String {
    let row = |found: &Dimensions| {
        let clock = found.clock_hz(size.feed);
        let feed = |speed: f64| clock.map(|clock| size.feed_of(speed * clock));
        let [least, greatest] = [0, 1].map(|end| found.speeds().and_then(|speeds| feed(speeds[end])));
        let corners = found.corners.iter().map(|corner| {
            json!({
                "run": run_command(found.model, &corner.curve, &found.choices),
                "done": corner.ending == Ending::Done,
                "clocks": corner.clocks,
                "length": corner.curve.length(),
                "feed": feed(corner.speed()),
                "path_error": corner.error,
            })
        });
        json!({
            "model": found.model.name,
            "method": found.model.method,
            "registers": registers_json(found.model, &found.registers),
            "clock_hz": clock,
            "feed": { "least": least, "greatest": greatest },
            "path_error": {
                "greatest": found.worst().map(|worst| worst.error),
                "um": found.worst().map(|worst| worst.error * size.blu_mm * 1000.0),
                "bound": found.bound,
            },
            "corners": corners.collect::<Vec<_>>(),
        })
    };
    let reason = |(model, reason): &(&str, String)| json!({ "model": model, "reason": reason });
    let all = json!({
        "travel": size.travel,
        "blu_mm": size.blu_mm,
        "feed": size.feed_of(size.feed),
        "machines": rows.iter().map(row).collect::<Vec<_>>(),
        "left_out": left_out.iter().map(reason).collect::<Vec<_>>(),
    });
    format!("{all:#}\n")
}
