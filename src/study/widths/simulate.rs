//! Runs that show how wide registers must be: many in lanes, and single ones one bit below.

use std::collections::BTreeMap;

use rayon::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_engine::lanes::{LaneProgram, LaneStop, LaneWatch, Observe};
use stepwave_models::options::WIDTH;
use stepwave_models::{Model, ModelError, Options, find};
use stepwave_nc::Curve;
use stepwave_netlist::bits::to_signed;
use stepwave_netlist::{Net, Width};

use super::{Tick, Witness};
use crate::testbench::{Ending, RangeWatch, Testbench};

/// Clocks after which a run is given up.
pub(in crate::study) const LIMIT: u64 = 1 << 24;
/// Clocks of a single run one bit below, at most, where a proof says how it ends.
const SHOWN: u64 = 1 << 20;
/// Single runs whose ranges are kept at once.
const CHUNK: usize = 1 << 12;

/// What was seen of a register: least and greatest value, and where.
#[derive(Clone)]
pub(super) struct Seen {
    pub(super) least: (i128, usize),
    pub(super) greatest: (i128, usize),
}

impl Seen {
    pub(super) fn take(&mut self, value: i128, place: usize) {
        if value < self.least.0 {
            self.least = (value, place);
        }
        if value > self.greatest.0 {
            self.greatest = (value, place);
        }
    }

    /// The bits that hold all of it, and the run that needs them.
    pub(super) fn needs(&self, signed: bool) -> (u32, usize) {
        let [least, greatest] = [self.least, self.greatest].map(|(value, at)| (Width::needed(value, signed), at));
        if least.0 > greatest.0 { least } else { greatest }
    }
}

/// What many runs came to.
#[derive(Default)]
pub(super) struct Runs {
    /// Every register with a width to choose, by name.
    pub(super) seen: BTreeMap<String, Seen>,
    /// Runs that ended in a fault.
    pub(super) faults: usize,
    /// Runs that were cut off at the limit; what they showed until then counts.
    pub(super) cut: usize,
    /// Runs that were done, but not where their curve ends; what they showed counts.
    pub(super) missed: usize,
}

/// Least and greatest value of every register with a width to choose, by name, in runs of at most `limit` clocks.
pub(super) fn simulate(bench: &Testbench, curves: &[Curve], limit: u64, tick: Tick<'_>) -> Result<Runs, ModelError> {
    let (machine, netlist) = (bench.machine(), bench.design().netlist());
    let names = bench.hardware().widths.keys();
    let registers: Vec<(String, Net, bool)> = names
        .filter_map(|name| netlist.find(name).map(|named| ((*name).to_owned(), named.net, named.format.is_signed())))
        .collect();
    if machine.buffer.is_some() {
        return simulate_alone(bench, curves, limit, &registers, tick);
    }
    let ends =
        registers.iter().flat_map(|&(_, net, signed)| [Observe::Min { net, signed }, Observe::Max { net, signed }]);
    let watch = LaneWatch {
        traps: netlist.properties.iter().map(|property| property.never).collect(),
        rest: vec![(machine.load.net, 0), (machine.preset_position.net, 0)],
        observe: ends.chain(machine.positions.iter().map(|port| Observe::Last(port.net))).collect(),
        limit,
        ..LaneWatch::new(machine.done.net)
    };
    let program = LaneProgram::new(bench.design(), &watch);
    let lanes = bench.lanes(limit)?;
    let (mut runs, mut place) = (Runs::default(), 0);
    program.run(
        curves.iter(),
        |curve: &Curve| lanes.job(curve),
        |end: Result<_, ModelError>| {
            match end {
                Ok(end) if matches!(end.stop, LaneStop::Done | LaneStop::Limit) => {
                    let (ranges, last) = end.values.split_at(2 * registers.len());
                    let at = machine.positions.iter().zip(last).map(|(port, &bits)| to_signed(port.width, bits));
                    let is_at_end = at.eq(curves[place].to().iter().copied());
                    runs.cut += usize::from(end.stop == LaneStop::Limit);
                    runs.missed += usize::from(end.stop == LaneStop::Done && !is_at_end);
                    for ((name, net, signed), pair) in registers.iter().zip(ranges.chunks(2)) {
                        let width = netlist.width(*net);
                        let number =
                            |bits: u64| if *signed { i128::from(to_signed(width, bits)) } else { i128::from(bits) };
                        let (least, greatest) = (number(pair[0]), number(pair[1]));
                        let first = Seen { least: (least, place), greatest: (greatest, place) };
                        let own = runs.seen.entry(name.clone()).or_insert(first);
                        own.take(least, place);
                        own.take(greatest, place);
                    }
                }
                _ => runs.faults += 1,
            }
            place += 1;
            tick(1);
        },
    );
    Ok(runs)
}

/// The same of a machine with a buffer, in single runs.
fn simulate_alone(
    bench: &Testbench,
    curves: &[Curve],
    limit: u64,
    registers: &[(String, Net, bool)],
    tick: Tick<'_>,
) -> Result<Runs, ModelError> {
    let model = find(bench.hardware().model)?;
    // The ranges, whether the run was cut off, and whether it missed its end; none of a run that ends in a fault.
    let run = |curve: &Curve| {
        let bench = bench.of(model, curve).ok()?.limited(limit);
        let mut watch = RangeWatch::new(&bench);
        let outcome = bench.run(EngineKind::Word, &mut [&mut watch]).ok()?;
        let cut = outcome.ending == Ending::Limit;
        let missed = !cut && !outcome.ends(curve);
        let ranges = watch.finish();
        let range = |(name, ..): &(String, Net, bool)| {
            ranges.iter().find(|range| range.name == *name).map(|range| (range.least, range.greatest))
        };
        tick(1);
        (cut || outcome.ending == Ending::Done).then(|| (registers.iter().map(range).collect::<Vec<_>>(), cut, missed))
    };
    let mut runs = Runs::default();
    for (chunk, first) in curves.chunks(CHUNK).zip((0..).step_by(CHUNK)) {
        for (place, ran) in (first..).zip(chunk.par_iter().map(run).collect::<Vec<_>>()) {
            let Some((ranges, cut, missed)) = ran else {
                runs.faults += 1;
                continue;
            };
            runs.cut += usize::from(cut);
            runs.missed += usize::from(missed);
            for ((name, ..), range) in registers.iter().zip(ranges) {
                let Some((least, greatest)) = range else { continue };
                let first = Seen { least: (least, place), greatest: (greatest, place) };
                let own = runs.seen.entry(name.clone()).or_insert(first);
                own.take(least, place);
                own.take(greatest, place);
            }
        }
    }
    Ok(runs)
}

/// Least and greatest value of every register over single runs of these curves on one engine, one after another instead of
/// in lanes: what [`widths`](super::widths) is judged by. Runs that do not come to their end are left out.
///
/// # Errors
/// A value does not fit in its register.
pub fn ranges_alone(
    model: &Model,
    bench: &Testbench,
    curves: &[Curve],
    engine: EngineKind,
) -> Result<BTreeMap<String, (i128, i128)>, ModelError> {
    type Ranges = BTreeMap<String, (i128, i128)>;
    let joined = |mut all: Ranges, one: Ranges| {
        for (name, (least, greatest)) in one {
            let own = all.entry(name).or_insert((least, greatest));
            *own = (own.0.min(least), own.1.max(greatest));
        }
        Ok(all)
    };
    let alone = |curve: &Curve| {
        let bench = bench.of(model, curve)?.limited(LIMIT);
        let mut watch = RangeWatch::new(&bench);
        let outcome = bench.run(engine, &mut [&mut watch]);
        if outcome.is_ok_and(|outcome| outcome.ending != Ending::Done) {
            return Ok(Ranges::new());
        }
        Ok(watch.finish().into_iter().map(|range| (range.name, (range.least, range.greatest))).collect())
    };
    curves.par_iter().map(alone).try_reduce(Ranges::new, joined)
}

/// The run of this curve with a register of `bits` bits, fewer than the curve needs: it is refused, or traps. `None`
/// where it does neither within some clocks, unless a proof says that it will (`certain`).
pub(super) fn too_narrow(
    model: &Model,
    wide: &Options,
    (name, bits): (&str, u32),
    curve: &Curve,
    certain: bool,
) -> Option<Witness> {
    let choices = with_width(wide.clone(), name, bits)?;
    let ran = match Testbench::new(model, curve, &choices) {
        Err(ModelError::DoesNotFit { .. }) => true,
        // The registers do not fit each other, though they do with one bit more.
        Err(ModelError::Widths(_)) => {
            let more = with_width(wide.clone(), name, bits + 1)?;
            model.plan(curve, &more).is_ok().then_some(true)?
        }
        Err(_) => return None,
        Ok(bench) => {
            let outcome = bench.limited(if certain { SHOWN } else { LIMIT }).run(EngineKind::Word, &mut []).ok()?;
            match outcome.ending {
                Ending::Trapped => true,
                Ending::Limit if certain => false,
                _ => return None,
            }
        }
    };
    Some(Witness { curve: curve.clone(), choices, ran })
}

/// The bits of a register, of which its values need `needed`, that also hold what is loaded into registers as wide as it.
pub(super) fn loaded(model: &Model, wide: &Options, name: &str, needed: u32, curve: &Curve) -> u32 {
    let fits = |bits: &u32| {
        let Some(choices) = with_width(wide.clone(), name, *bits) else { return false };
        let Ok(hardware) = model.plan(curve, &choices) else { return false };
        let Ok(machine) = model.machine(&hardware) else { return false };
        let words = model.words(&hardware, curve).unwrap_or_default();
        !matches!(machine.encode(&hardware, &words), Err(ModelError::DoesNotFit { .. }))
    };
    match model.plan(curve, wide) {
        Ok(plan) if plan.leaders.iter().any(|(_, leader)| *leader == name) => {
            (needed..=plan.bits_of(name)).find(fits).unwrap_or(needed)
        }
        _ => needed,
    }
}

/// The same options with a register of this many bits.
fn with_width(choices: Options, name: &str, bits: u32) -> Option<Options> {
    Some(choices.with_one(&WIDTH, name, Width::new(u64::from(bits)).ok()?))
}
