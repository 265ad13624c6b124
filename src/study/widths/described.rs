//! What the registers of hardware hold whose widths are its author's: simulated, with the results that did not fit.

use std::collections::BTreeMap;

use rayon::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::options::STRICT;
use stepwave_models::{Model, Options};
use stepwave_nc::Curve;

use super::simulate::LIMIT;
use super::{Known, RegisterWidth, Tick, Widths, Witness, by_simulation};
use crate::study::boxes::{Extent, Geometries};
use crate::study::proof::ProofError;
use crate::testbench::{Ending, OverflowWatch, RangeWatch, Testbench};

/// Runs that are kept at once.
const CHUNK: usize = 1 << 10;

/// Values of a register in a run, and the bits that they and the results for it need.
#[derive(Clone, Copy)]
struct Held {
    least: i128,
    greatest: i128,
    needed: u32,
    /// A result did not fit.
    lost: bool,
}

/// What a run came to: each register by name; nothing where it cannot be loaded.
struct Ran {
    held: Vec<(&'static str, Held)>,
    ended: bool,
    cut: bool,
    missed: bool,
}

/// The widths that all geometries of a box need, or the extreme ones: no register is given another width.
///
/// # Errors
/// There is no such box for the model, or the hardware cannot be built.
pub(super) fn widths(
    model: &'static Model,
    choices: &Options,
    extent: &Extent,
    tick: Tick<'_>,
) -> Result<Widths, ProofError> {
    let choices = choices.clone().without(&STRICT);
    let Geometries { curves, all, k, hardware, .. } = Geometries::of(model, &choices, extent)?;
    let bench = Testbench::of_hardware(model, hardware)?;
    let (mut faults, mut cut, mut missed) = (0, 0, 0);
    let mut found: BTreeMap<&'static str, (Held, usize)> = BTreeMap::new();
    for (chunk, first) in curves.chunks(CHUNK).zip((0..).step_by(CHUNK)) {
        let runs: Vec<Option<Ran>> = chunk.par_iter().map(|curve| run(model, &bench, curve, tick)).collect();
        for (place, ran) in (first..).zip(runs) {
            let Some(ran) = ran else {
                faults += 1;
                continue;
            };
            faults += usize::from(!ran.ended && !ran.cut);
            cut += usize::from(ran.cut);
            missed += usize::from(ran.missed);
            for (name, held) in ran.held {
                let (all, worst) = found.entry(name).or_insert((held, place));
                if held.needed > all.needed {
                    (all.needed, *worst) = (held.needed, place);
                }
                all.lost |= held.lost;
                (all.least, all.greatest) = (all.least.min(held.least), all.greatest.max(held.greatest));
            }
        }
    }
    let known = by_simulation(curves.len(), all, faults + cut);
    let registers = found.into_iter().map(|(name, (held, worst))| {
        let given = bench.hardware().bits_of(name);
        let witness = Witness { curve: curves[worst].clone(), choices: choices.clone(), ran: true };
        RegisterWidth {
            name: name.to_owned(),
            given,
            needed: held.needed,
            shown: held.needed,
            range: (held.least, held.greatest),
            known: if held.lost { Known::AtLeast } else { known },
            fault: (held.needed > given).then(|| witness.clone()),
            witness: (held.needed > 1).then_some(witness),
        }
    });
    let registers = registers.collect();
    Ok(Widths { extent: extent.clone(), k, simulated: curves.len(), all, faults, cut, limit: LIMIT, missed, registers })
}

fn run(model: &Model, bench: &Testbench, curve: &Curve, tick: Tick<'_>) -> Option<Ran> {
    let bench = bench.of(model, curve).ok()?.limited(LIMIT);
    let (mut ranges, mut overflows) = (RangeWatch::new(&bench), OverflowWatch::new(&bench));
    let outcome = bench.run(EngineKind::Word, &mut [&mut ranges, &mut overflows]).ok()?;
    tick(1);
    let (tallies, widths) = (overflows.tallies(), &bench.hardware().widths);
    let held = ranges.finish().into_iter().filter_map(|range| {
        let name = widths.get_key_value(range.name.as_str());
        let of_range = tallies.iter().find(|tally| tally.first.component() == range.path && !tally.is_assertion());
        // What no unsigned width holds needs a sign at least.
        let results = of_range.map_or(1, |tally| tally.needed.unwrap_or(range.width.get() + 1));
        let needed = range.needed().max(results);
        let held = Held { least: range.least, greatest: range.greatest, needed, lost: of_range.is_some() };
        name.map(|(name, _)| (*name, held))
    });
    let (ended, cut) = (outcome.ending == Ending::Done, outcome.ending == Ending::Limit);
    Some(Ran { held: held.collect(), ended, cut, missed: ended && !outcome.ends(curve) })
}
