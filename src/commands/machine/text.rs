//! The answer of `machine` as text and in Markdown.

use std::fmt::Write as _;

use super::{Answer, RampCost, Row, Whole};
use crate::commands::columns::{aligned, markdown};
use crate::commands::widths::{evidence, one_bit_below};
use crate::study::machine::Dimensions;
use crate::study::machine::Size;
use crate::study::ramp::Part;
use crate::study::synth::{Cost, Tools};
use crate::testbench::Ending;

/// Everything that is printed.
pub(super) fn all(answer: &Answer, is_markdown: bool) -> String {
    let mut text = heading(answer) + "\n" + &table(answer, is_markdown);
    text += &answer.ramp_cost.as_ref().map_or_else(String::new, ramp_cost);
    for row in &answer.rows {
        text += "\n";
        text += &registers(&row.found, is_markdown);
    }
    if let Some(beaten) = &answer.beaten {
        let all = beaten.len() + answer.rows.len();
        // Writing to a string cannot fail.
        let _ = write!(text, "\nleft out by --pareto: {} of {all}", beaten.len());
        let by = beaten.iter().map(|beaten| format!("{}, beaten by {}", beaten.model, beaten.by));
        text += &by.map(|line| format!("\n  {line}")).collect::<String>();
        text += "\n";
    }
    for (_, reason) in &answer.left_out {
        let _ = writeln!(text, "\nleft out: {reason}");
    }
    text
}

fn heading(answer: &Answer) -> String {
    let size = &answer.size;
    let travel: Vec<String> = size.travel.iter().map(ToString::to_string).collect();
    let mut text = format!(
        "travel ±{} BLU of {} mm, feed {} mm/min\n",
        travel.join(", ±"),
        size.blu_mm,
        rounded(size.feed_of(size.feed))
    );
    if let Some(Tools { yosys, nextpnr }) = &answer.tools {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "LUTs and flip-flops by Yosys {yosys}, highest clock by nextpnr {nextpnr} in an {}",
            Tools::device()
        );
    }
    if let Some((options, hz)) = &answer.accelerates {
        let _ = writeln!(text, "one move across the travel by `stepwave program {options}` at {}", frequency(*hz));
    }
    text
}

/// Four digits or all of a whole number.
fn rounded(number: f64) -> String {
    if number >= 1000.0 {
        format!("{number:.0}")
    } else {
        format!("{number:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

/// What is not known, as a run did not come to its end or the device does not hold the hardware.
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

/// How many runs at the corners did not come to their ends.
fn unfinished(found: &Dimensions) -> usize {
    found.corners.iter().filter(|corner| corner.ending != Ending::Done).count()
}

/// Feeds at a clock, if both are known.
fn feeds(row: &Row, size: &Size, clock: Option<f64>) -> String {
    let feeds = clock.and_then(|clock| row.feeds(size, clock)).map(|feeds| feeds.map(rounded));
    feeds.map_or_else(unknown, |[least, most]| if least == most { least } else { format!("{least} to {most}") })
}

const HEADING: [&str; 6] = [
    "method",
    "registers, bits",
    "bits of all",
    "clock",
    "feed at that clock, mm/min",
    "greatest error at the corners",
];
/// With `--synth`.
const COSTS: [&str; 4] = ["LUTs", "flip-flops", "highest clock", "feed at the highest clock, mm/min"];

/// With `--synth`, of the machine that runs programs.
const WHOLE: [&str; 3] = ["LUTs with pulse source", "flip-flops with it", "highest clock with it"];

/// With `--accel`.
const RAMPS: [&str; 5] = ["ramp, bits", "greatest feed, mm/min", "ramp up", "ramp down", "move"];

/// What they say of a row.
fn ramp(row: &Row) -> [String; 5] {
    let Some(ramp) = &row.ramp else { return std::array::from_fn(|_| unknown()) };
    let bits: Vec<String> = ramp.registers.iter().map(|(name, bits)| format!("{name} {bits}")).collect();
    let part = |part: Part| format!("{:.3} ms, {:.3} mm", part.seconds * 1000.0, part.mm);
    let [up, down] = ramp.ramps.map(part);
    let short = if ramp.is_short { ", too short for more" } else { "" };
    [bits.join(", "), rounded(ramp.feed) + short, up, down, format!("{:.6} s", ramp.seconds)]
}

/// What the machine that runs programs costs.
fn whole(Whole { cost, .. }: &Whole) -> [String; 3] {
    let clock = cost.clock_hz.map_or_else(unknown, frequency);
    [cost.luts.to_string(), cost.flip_flops.to_string(), clock]
}

fn table(answer: &Answer, is_markdown: bool) -> String {
    let size = &answer.size;
    let row = |row: &Row| {
        let found = &row.found;
        let bits: Vec<String> = found.registers.iter().map(|own| format!("{} {}", own.name, own.needed)).collect();
        let clock = found.clock_hz(size.feed);
        let error = found.worst().map_or(0.0, |worst| worst.error);
        let mut cells = vec![
            format!("{}{}", found.model.name, "*".repeat(unfinished(found).min(1))),
            bits.join(", "),
            found.register_bits.to_string(),
            clock.map_or_else(unknown, frequency),
            feeds(row, size, clock),
            format!("{error:.3} BLU, {} µm", rounded(error * size.blu_mm * 1000.0)),
        ];
        if answer.accelerates.is_some() {
            cells.extend(ramp(row));
        }
        if let Some(cost) = &row.cost {
            let clock = cost.clock_hz;
            cells.extend([cost.luts.to_string(), cost.flip_flops.to_string()]);
            cells.extend([clock.map_or_else(unknown, frequency), feeds(row, size, clock)]);
            cells.extend(row.whole.as_ref().map_or_else(|| std::array::from_fn(|_| unknown()), whole));
        }
        cells
    };
    let (costs, wholes) = if answer.tools.is_some() { (&COSTS[..], &WHOLE[..]) } else { (&[][..], &[][..]) };
    let ramps = if answer.accelerates.is_some() { &RAMPS[..] } else { &[] };
    let heading: Vec<String> =
        HEADING.iter().chain(ramps).chain(costs).chain(wholes).map(ToString::to_string).collect();
    let right: Vec<usize> = (2..heading.len()).filter(|&column| heading[column] != RAMPS[0]).collect();
    let all: Vec<Vec<String>> = std::iter::once(heading).chain(answer.rows.iter().map(row)).collect();
    let mut text = if is_markdown { markdown(&all, &right) } else { aligned(&all, &right) };
    if answer.rows.iter().any(|row| unfinished(&row.found) > 0) {
        text += "\n* not all runs at the corners came to their end: clock and feed are not known\n";
    }
    // Lines and arcs of a method have one machine.
    let lacks = answer.rows.iter().find_map(|row| row.whole.filter(Whole::lacks_curves));
    if let Some(Whole { machine, .. }) = lacks {
        text += &format!(
            "\n{} is counted without the integrators of free curves, which a program with G5 or G5.1 adds\n",
            machine.name
        );
    }
    let alone = answer.rows.iter().filter_map(|row| Some((row.found.model.name, row.cost?)));
    let whole = answer.rows.iter().filter_map(|row| row.whole.as_ref().map(|whole| (whole.machine.name, whole.cost)));
    let mut named = Vec::new();
    for (name, Cost { fits, seed, .. }) in alone.chain(whole) {
        // Lines and arcs of a method have one machine.
        if named.contains(&(name, seed)) {
            continue;
        }
        named.push((name, seed));
        // Writing to a string cannot fail.
        let _ = match seed {
            Some(1) => Ok(()),
            Some(seed) => writeln!(text, "\n{name} is placed with seed {seed}: before it the router comes to no end"),
            None if fits => writeln!(text, "\n{name} is not routed: its highest clock is not known"),
            None => writeln!(text, "\n{name} does not fit into the device: its highest clock is not known"),
        };
    }
    text
}

/// What a ramp takes that is put in front of a machine.
fn ramp_cost(RampCost { machine, without, with }: &RampCost) -> String {
    let more = |with: u64, without: u64| with.saturating_sub(without);
    let fits = if with.fits { "" } else { ", which the device does not hold" };
    format!(
        "\nthe ramp takes {} LUTs and {} flip-flops more, in {}: {} and {} with it{fits}\n",
        more(with.luts, without.luts),
        more(with.flip_flops, without.flip_flops),
        machine.name,
        with.luts,
        with.flip_flops
    )
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
