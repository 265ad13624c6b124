//! Lean RTL: the machines as an engineer writes them by hand (`lean/*.v`), for one quadrant, with what the method needs
//! and nothing to look at. It is what a user would simulate instead of calling `stepwave run`.
//!
//! Clock for clock they are the machines of the catalogue. Their registers load at an edge with `rst` = 1, ours at one
//! with `load` = 1: that is clock 1 of both, and step k of a DDA ends at the edge of clock 1 + k, of point-by-point
//! comparison at that of clock 1 + 4 k. `done` of a lean DDA is logic after its down-counters, and ours a register that
//! is set together with them, so both rise at the edge of the last step. A run counts the clocks up to that edge.

use std::path::Path;

use stepwave::models::Preset;
use stepwave::nc::{Arc, Curve, Direction};

use crate::Fallible;
use crate::contender::Wave;
use crate::measure::race;
use crate::own;
use crate::rtl::{Rtl, Shown};
use crate::sections::{Sizes, built, peak, rate};
use crate::table::{Table, number, times};
use crate::unit::Case;

/// Bits of their registers; a deviation has two more.
const BITS: u32 = 24;

/// A block of about `2^power` clocks in the lean machine of a model: `stepwave run` of the same, and the load words.
fn case(model: &str, power: u32) -> Fallible<(Case, Vec<i64>)> {
    let case = Case { width: BITS, ..Case::new(model, power)? };
    // Integrators that begin with remainders of 0 would not end on an axis.
    let unit = (1i64 << power) * 185_410 / 1_000_000;
    let arc = Arc::new([5 * unit, 0], [3 * unit, 4 * unit], [0, 0], Direction::CounterClockwise)?;
    let case = match case.preset {
        Some(_) => Case { curve: Curve::Arc(arc), preset: Some(Preset::Zero), ..case },
        None => case,
    };
    let words = match &case.curve {
        Curve::Arc(arc) => [arc.from(), arc.to()].concat(),
        Curve::Line(line) => line.to().to_vec(),
        _ => return Err(format!("no lean {model}").into()),
    };
    Ok((case, words))
}

fn rtl(model: &str) -> Fallible<Rtl> {
    let text = match model {
        "dda-line" => include_str!("lean/dda_line.v"),
        "dda-arc" => include_str!("lean/dda_arc.v"),
        "ppc-line" => include_str!("lean/ppc_line.v"),
        "ppc-arc" => include_str!("lean/ppc_arc.v"),
        _ => return Err(format!("no lean {model}").into()),
    };
    let inputs: &[&str] =
        if model.ends_with("-line") { &["end_x", "end_y"] } else { &["start_x", "start_y", "end_x", "end_y"] };
    Ok(Rtl {
        name: model.replace('-', "_"),
        text: text.to_owned(),
        inputs: inputs.iter().map(|&port| port.to_owned()).collect(),
        strobes: vec!["rst".to_owned()],
        done: "done".to_owned(),
        done_register: None,
        result: ["x", "y"].map(|port| Shown { port: port.to_owned(), width: BITS, signed: false }).to_vec(),
        waved: Vec::new(),
    })
}

/// `stepwave run`, with all that it looks at, and the lean machines of the peers.
pub(crate) fn no_trace(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let head = ["model", "clocks", "`stepwave run`", "Verilator", "CXXRTL", "`run` to Verilator", "to CXXRTL"];
    let head = [&head[..], &["MB, `run`", "Verilator", "CXXRTL"]].concat();
    let title = format!("Lean RTL by hand, {BITS}-bit registers, without a wave: million clocks a second, one core");
    let mut table = Table::new(&title, &head);
    for &model in sizes.models.iter() {
        let dir = dir.join("lean").join(model);
        let (case, words) = case(model, BITS)?;
        let blocks = words.iter().map(i64::to_string).collect::<Vec<_>>().join(" ") + "\n";
        let rtl = rtl(model)?;
        let (verilator, cxxrtl) = built(&rtl, &dir, &blocks);
        let jobs = [own::program(&case, &dir, Wave::None), verilator?, cxxrtl?];
        // These runs are short.
        let runs = race(3 * sizes.rounds, &jobs)?;
        let rates: Vec<f64> = runs.iter().map(|runs| rate(runs)).collect();
        let ratios = rates[1..].iter().map(|peer| times(rates[0] / peer));
        let clocks = format!("{:.0}", runs[0][0].clocks());
        let cells = [clocks].into_iter().chain(rates.iter().copied().map(number)).chain(ratios);
        table.row(model, cells.chain(runs.iter().map(|runs| peak(runs))));
    }
    Ok(table.text())
}
