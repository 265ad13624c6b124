//! The answer of `machine` as JSON.

use serde_json::{Value, json};

use super::{Answer, RampCost, Row};
use crate::commands::widths::registers_json;
use crate::report::{export_command, run_command};
use crate::study::ramp::{Part, Ramped};
use crate::study::synth::{Cost, Tools};
use crate::testbench::Ending;

/// Everything that is printed.
pub(super) fn all(answer: &Answer) -> String {
    let Answer { size, rows, left_out, accelerates, tools, ramp_cost, beaten } = answer;
    let mut all = json!({
        "travel": size.travel,
        "blu_mm": size.blu_mm,
        "feed": size.feed_of(size.feed),
        "machines": rows.iter().map(|row| machine(row, answer)).collect::<Vec<_>>(),
        "left_out": left_out.iter().map(|(model, reason)| json!({ "model": model, "reason": reason })).collect::<Vec<_>>(),
    });
    if let Some((options, clock_hz)) = accelerates {
        all["accelerates"] = json!({ "options": options, "clock_hz": clock_hz });
    }
    if let Some(Tools { yosys, nextpnr }) = tools {
        all["synth"] = json!({ "device": Tools::device(), "yosys": yosys, "nextpnr": nextpnr });
    }
    if let Some(RampCost { machine, without, with }) = ramp_cost {
        all["ramp_cost"] = json!({ "machine": machine.name, "without": cost(*without), "with": cost(*with) });
    }
    if let Some(beaten) = beaten {
        let row = |beaten: &super::Beaten| json!({ "model": beaten.model, "by": beaten.by });
        all["beaten"] = beaten.iter().map(row).collect();
    }
    format!("{all:#}\n")
}

fn ends(feeds: Option<[f64; 2]>) -> Value {
    json!({ "least": feeds.map(|feeds| feeds[0]), "greatest": feeds.map(|feeds| feeds[1]) })
}

/// What a ramp was seen to do; null of a method that does not run programs.
fn ramp(ramp: &Ramped, answer: &Answer) -> Value {
    let part = |part: Part| json!({ "seconds": part.seconds, "mm": part.mm });
    let options = answer.accelerates.as_ref().map_or("", |(options, _)| options);
    let hz = answer.accelerates.as_ref().map_or(0.0, |(_, hz)| *hz);
    let Ramped { family, program, registers, feed, is_short, ramps: [up, down], clocks, seconds } = ramp;
    json!({
        "program": program,
        "run": format!("stepwave program FILE --method {family} {options} --blu {}mm --clock-hz {hz}", answer.size.blu_mm),
        "registers": registers.iter().map(|(name, bits)| json!({ "name": name, "bits": bits })).collect::<Vec<_>>(),
        "feed": feed,
        "too_short": is_short,
        "up": part(*up),
        "down": part(*down),
        "clocks": clocks,
        "seconds": seconds,
    })
}

fn machine(row: &Row, answer: &Answer) -> Value {
    let (found, size) = (&row.found, &answer.size);
    let clock = found.clock_hz(size.feed);
    let corners = found.corners.iter().map(|corner| {
        json!({
            "run": run_command(found.model, &corner.curve, &found.choices),
            "done": corner.ending == Ending::Done,
            "clocks": corner.clocks,
            "length": corner.curve.length(),
            "feed": clock.map(|clock| size.feed_of(corner.speed() * clock)),
            "path_error": corner.error,
        })
    });
    let mut all = json!({
        "model": found.model.name,
        "method": found.model.method,
        "registers": registers_json(found.model, &found.registers),
        "register_bits": found.register_bits,
        "clock_hz": clock,
        "feed": ends(clock.and_then(|clock| row.feeds(size, clock))),
        "path_error": {
            "greatest": found.worst().map(|worst| worst.error),
            "um": found.worst().map(|worst| worst.error * size.blu_mm * 1000.0),
            "bound": found.bound,
        },
        "corners": corners.collect::<Vec<_>>(),
    });
    if answer.accelerates.is_some() {
        all["ramp"] = json!(row.ramp.as_ref().map(|own| ramp(own, answer)));
    }
    if let Some(own) = row.cost {
        let mut own_cost = cost(own);
        let export = export_command(found.model, &found.largest().curve, &found.choices) + " --no-flags";
        own_cost["export"] = json!(export);
        own_cost["feed"] = ends(own.clock_hz.and_then(|clock| row.feeds(size, clock)));
        all["cost"] = own_cost;
        all["program_cost"] = json!(row.whole.as_ref().map(|own| {
            let mut whole = cost(own.cost);
            whole["machine"] = json!(own.machine.name);
            let left_out: &[&str] = if own.lacks_curves() { &["integrators of free curves"] } else { &[] };
            whole["not_counted"] = json!(left_out);
            whole
        }));
    }
    all
}

fn cost(Cost { luts, flip_flops, carries, rams, fits, seed, clock_hz }: Cost) -> Value {
    json!({
        "luts": luts,
        "flip_flops": flip_flops,
        "carries": carries,
        "block_rams": rams,
        "fits": fits,
        "seed": seed,
        "clock_hz": clock_hz,
    })
}
