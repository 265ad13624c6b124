//! The least width of every register over all geometries of a box, and a geometry that one bit less does not hold.
//!
//! A width is known to be enough by a proof for every k, or because every geometry of the box was simulated. It is
//! known to be least by a run of the box that one bit less does not hold. Where neither is to be had, it is only
//! sampled, by the extreme geometries.

mod bounds;
mod described;
mod judge;
mod simulate;

use std::collections::BTreeSet;

use rayon::prelude::*;
use stepwave_models::{AXES, Claims, Hardware, Model, ModelError, Options};
use stepwave_nc::Curve;
use stepwave_netlist::Width;

use super::Grid;
use super::boxes::{Extent, Geometries, check_simulated, has_widths};
use super::kform::KForm;
use super::proof::{Narrower, ProofError, Subject};
use crate::testbench::Testbench;
pub(super) use simulate::LIMIT;
pub use simulate::ranges_alone;
use simulate::{Runs, Seen, loaded, simulate, too_narrow};

/// How the width of a register is known to be enough, and to be least.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Known {
    /// Proved for every k, and a run needs it.
    Proved,
    /// Proved at this k alone, and a run needs it.
    ProvedHere,
    /// Every geometry of the box was simulated, to its end.
    Exhaustive,
    /// Every one was, but only the first number of the second ran to their end: of the others nothing is known.
    Part(usize, usize),
    /// The extreme ones were.
    Sampled,
    /// Proved to be enough, but no run is known that needs it.
    Enough,
    /// Results did not fit, and what the register held after the first says nothing of a wider one: more may be needed.
    AtLeast,
}

/// A run that a register is too narrow for.
#[derive(Clone, Debug, PartialEq)]
pub struct Witness {
    /// The geometry.
    pub curve: Curve,
    /// The choices of the run.
    pub choices: Options,
    /// The run was made. Otherwise it takes too long: the position comes to where it does not fit at the end.
    pub ran: bool,
}

/// What a register needs.
#[derive(Clone, Debug, PartialEq)]
pub struct RegisterWidth {
    /// Its name.
    pub name: String,
    /// Its width as given, or else by default.
    pub given: u32,
    /// The bits that are enough for the box.
    pub needed: u32,
    /// The bits that runs of the box were seen to need; `needed`, unless that is only known to be
    /// [enough](Known::Enough).
    pub shown: u32,
    /// Least and greatest value seen.
    pub range: (i128, i128),
    /// How that is known.
    pub known: Known,
    /// A run that one bit less does not hold.
    pub witness: Option<Witness>,
    /// A run that the width as given does not hold, where it is less than needed.
    pub fault: Option<Witness>,
}

/// Least widths over a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Widths {
    /// The box.
    pub extent: Extent,
    /// Bits of coordinates.
    pub k: u32,
    /// Geometries that were simulated.
    pub simulated: usize,
    /// They are all of the box, whether or not each of them ran to its end.
    pub all: bool,
    /// Geometries that end in a fault at the default widths.
    pub faults: usize,
    /// Geometries that had not ended after [these clocks](Self::limit), as they stall or are longer.
    pub cut: usize,
    /// Clocks for which each was followed at most.
    pub limit: u64,
    /// Geometries that were done, but not at their end points.
    pub missed: usize,
    /// Every register with a width to choose, by name.
    pub registers: Vec<RegisterWidth>,
}

impl Widths {
    /// Geometries that ran to their end.
    #[must_use]
    pub fn ran(&self) -> usize {
        self.simulated - self.faults - self.cut
    }
}

/// Is called with a number of runs that are done.
pub type Tick<'a> = &'a (dyn Fn(u64) + Sync);

/// Clocks for which an extreme geometry is followed where a proof says what comes later.
const FOLLOWED: u64 = 1 << 12;
/// Points of a grid, and bits of coordinates, up to which all geometries are simulated even if widths are proved.
const SMALL: (u128, u32) = (20_000, 9);
const SMALL_BITS: u32 = 8;
/// Clocks that are simulated at most where a proof leaves something open.
const MOST_CLOCKS: u64 = 1 << 32;
/// The least k that a proof covers.
const LEAST_PROVED: u32 = 3;

/// The least widths of a model's registers over a box of geometries: every line from the origin, every arc inside a
/// quadrant with both ends on the circle, every quarter of an ellipse and every arc of a parabola or hyperbola from or
/// to its vertex, every helix over such an arc, or cubic Bézier curves. Widths among the choices are those of the hardware that is judged;
/// what is needed does not depend on them, but for the integrators of one scale, which are never taken narrower than
/// the box needs. Nor does it depend on what is done on an overflow: the widths are those at which there is none.
///
/// # Errors
/// There is no such box for the model, or the hardware cannot be built.
pub fn widths(model: &'static Model, choices: &Options, extent: &Extent, tick: Tick<'_>) -> Result<Widths, ProofError> {
    if model.is_described() {
        return described::widths(model, choices, extent, tick);
    }
    let ample = judge::ample(model, choices, extent)?;
    let mut found = needed(model, &ample, extent, tick)?;
    judge::judge(model, choices, &ample, &mut found)?;
    Ok(found)
}

fn needed(model: &'static Model, ample: &Options, extent: &Extent, tick: Tick<'_>) -> Result<Widths, ProofError> {
    let k = extent.bits()?;
    let proved = if is_small(extent, k) { None } else { by_proof(model, ample, extent, tick)? };
    let Some(found) = proved else {
        check_simulated(model, k)?;
        return simulated(model, ample, extent, Geometries::of(model, ample, extent)?, tick);
    };
    let is_decided = found.registers.iter().all(|register| register.known != Known::Enough);
    if is_decided || matches!(extent, Extent::Bits(_)) {
        return Ok(found);
    }
    // The box itself may need less than is proved of its bits.
    let whole = Geometries::of(model, ample, extent)?;
    let bearable = whole.all && clocks(model, &whole) <= MOST_CLOCKS;
    if bearable { simulated(model, ample, extent, whole, tick) } else { Ok(found) }
}

/// About how many clocks all of these take.
fn clocks(model: &Model, set: &Geometries) -> u64 {
    let integrates = model.method == "digital differential analyser" || model.method == "digital pulse multiplier";
    let pulses =
        |curve: &Curve| curve.from().iter().zip(curve.to()).map(|(from, to)| 4 * from.abs_diff(*to)).sum::<u64>();
    let clocks = |curve: &Curve| if integrates { 1 << set.k } else { pulses(curve) };
    set.curves.iter().map(clocks).fold(0, u64::saturating_add)
}

/// The widths that a proof for every k gives for this box, with the runs of its extreme geometries that need them;
/// `None` where there is no such proof.
///
/// # Errors
/// See [`widths`].
pub fn by_proof(
    model: &'static Model,
    choices: &Options,
    extent: &Extent,
    tick: Tick<'_>,
) -> Result<Option<Widths>, ProofError> {
    let k = extent.bits()?;
    let axes = model.claims.map(|claims| claims.geometries.axes());
    if has_widths(model, choices) || model.is_buffered() || Some(extent.axes(model)) != axes || k < LEAST_PROVED {
        return Ok(None);
    }
    let Some(form) = KForm::of(model, choices)? else { return Ok(None) };
    let Some(narrow) = form.hardware(k)? else { return Ok(None) };
    by_form(model, choices, extent, (&form, &narrow), tick).map(Some)
}

/// All geometries are simulated in a moment.
fn is_small(extent: &Extent, k: u32) -> bool {
    match extent {
        Extent::Bits(bits) => *bits <= SMALL_BITS,
        Extent::Grid(Grid(ranges)) => {
            let count = ranges.iter().fold(1_u128, |count, range| count.saturating_mul(range.count().into()));
            count <= SMALL.0 && k <= SMALL.1
        }
    }
}

/// What simulated geometries need: all, or the extreme ones.
///
/// # Errors
/// See [`widths`].
pub fn simulated(
    model: &'static Model,
    ample: &Options,
    extent: &Extent,
    set: Geometries,
    tick: Tick<'_>,
) -> Result<Widths, ProofError> {
    let Geometries { curves, all, k, hardware, choices: wide } = set;
    let bench = Testbench::of_hardware(model, hardware)?;
    let Runs { seen, faults, cut, missed } = simulate(&bench, &curves, LIMIT, tick)?;
    let known = by_simulation(curves.len(), all, faults + cut);
    let extreme: BTreeSet<usize> = seen.values().flat_map(|seen| [seen.least.1, seen.greatest.1]).collect();
    let row = |(name, seen): (String, Seen)| {
        let (needed, worst) = seen.needs(is_signed(&bench, &name));
        let needed = loaded(model, &wide, &name, needed, &curves[worst]);
        let below = needed.checked_sub(1)?;
        // Alone a geometry may be run otherwise than by the hardware of the box: then that of another register may show it.
        let mut shown = [worst].into_iter().chain(extreme.iter().copied());
        Some(RegisterWidth {
            witness: shown.find_map(|place| too_narrow(model, &wide, (&name, below), &curves[place], false)),
            range: (seen.least.0, seen.greatest.0),
            given: bench.hardware().bits_of(&name),
            shown: needed,
            fault: None,
            known,
            name,
            needed,
        })
    };
    let mut registers: Vec<RegisterWidth> = seen.into_iter().filter_map(row).collect();
    if let Some(claims) = model.claims.filter(|_| bench.hardware().axes == 2 && k >= LEAST_PROVED && faults == 0) {
        mark_proved(model, &claims, ample, k, &mut registers);
    }
    Ok(Widths { extent: extent.clone(), k, simulated: curves.len(), all, faults, cut, limit: LIMIT, missed, registers })
}

/// How widths are known of `simulated` geometries, `lost` of which did not run to their end.
fn by_simulation(simulated: usize, all: bool, lost: usize) -> Known {
    match (all, lost) {
        (false, _) => Known::Sampled,
        (true, 0) => Known::Exhaustive,
        (true, lost) => Known::Part(simulated - lost, simulated),
    }
}

fn is_signed(bench: &Testbench, register: &str) -> bool {
    bench.design().netlist().find(register).is_some_and(|named| named.format.is_signed())
}

/// What a form that is proved gives at the k of the box, and whether runs of the box need it.
fn by_form(
    model: &'static Model,
    ample: &Options,
    extent: &Extent,
    (form, narrow): (&KForm, &Hardware),
    tick: Tick<'_>,
) -> Result<Widths, ProofError> {
    let set = Geometries::extremes(model, ample, extent)?;
    let bench = Testbench::of_hardware(model, set.hardware.clone())?;
    // Of a counted block, which is proved at one k, the counter comes round in 2^k clocks.
    let limit = if form.is_for_every_k() { FOLLOWED } else { LIMIT };
    let Runs { mut seen, faults, cut, missed } = simulate(&bench, &set.curves, limit, tick)?;
    // Every end is reached: that is proved.
    for (place, curve) in set.curves.iter().enumerate() {
        for (axis, (from, to)) in AXES.iter().zip(curve.from().iter().zip(curve.to())) {
            if let Some(own) = seen.get_mut(*axis) {
                own.take(i128::from(*from), place);
                own.take(i128::from(*to), place);
            }
        }
    }
    let bounds = bounds::bounds(model, bench.machine(), &set, extent);
    let proved = if form.is_for_every_k() { Known::Proved } else { Known::ProvedHere };
    let mut registers = Vec::new();
    for (name, seen) in seen {
        let signed = is_signed(&bench, &name);
        let (shown, worst) = seen.needs(signed);
        let shown = loaded(model, &set.choices, &name, shown, &set.curves[worst]);
        let concluded = bounds
            .get(&name)
            .map(|(least, greatest)| Width::needed(*least, signed).max(Width::needed(*greatest, signed)));
        let needed = concluded.into_iter().fold(narrow.bits_of(&name), u32::min).max(shown);
        let curve = &set.curves[worst];
        let certain = AXES.contains(&name.as_str());
        let witness =
            shown.checked_sub(1).and_then(|below| too_narrow(model, &set.choices, (&name, below), curve, certain));
        registers.push(RegisterWidth {
            range: (seen.least.0, seen.greatest.0),
            given: bench.hardware().bits_of(&name),
            known: if shown == needed { proved } else { Known::Enough },
            fault: None,
            name,
            needed,
            shown,
            witness,
        });
    }
    Ok(Widths {
        extent: extent.clone(),
        k: set.k,
        simulated: set.curves.len(),
        all: false,
        faults,
        cut,
        limit,
        missed,
        registers,
    })
}

/// What registers of these geometries need: name, width by default, bits needed.
///
/// # Errors
/// The hardware cannot be built, or a value does not fit in its register.
pub(super) fn least_seen(model: &'static Model, set: &Geometries) -> Result<Vec<(String, u32, u32)>, ModelError> {
    let bench = Testbench::of_hardware(model, set.hardware.clone())?;
    // The first geometry stands for the preset and whatever else every block is loaded with.
    set.curves.first().map(|curve| bench.of(model, curve)).transpose()?;
    let runs = simulate(&bench, &set.curves, LIMIT, &|_| {})?;
    let row = |(name, seen): (String, Seen)| {
        let (needed, worst) = seen.needs(is_signed(&bench, &name));
        let needed = loaded(model, &set.choices, &name, needed, &set.curves[worst]);
        let given = bench.hardware().bits_of(&name);
        (name, given, needed)
    };
    Ok(runs.seen.into_iter().map(row).collect())
}

/// Marks what a proof for every k, or for this one, shows: the widths needed here, as bits less than by default,
/// are enough.
fn mark_proved(model: &'static Model, claims: &Claims, choices: &Options, k: u32, registers: &mut [RegisterWidth]) {
    use super::proof::{Block, CountMethod, blocks};
    assert_eq!(model.claims.map(|own| own.geometries), Some(claims.geometries));
    let less = |register: &RegisterWidth| register.given.saturating_sub(register.needed);
    let narrower: Narrower =
        registers.iter().filter(|register| less(register) > 0).map(|r| (r.name.clone(), less(r))).collect();
    if !claims.counted.is_empty() {
        let exact = |block: &Block| block.is_exact();
        if blocks(model, claims, choices, &narrower, k, CountMethod::Follow)
            .is_ok_and(|blocks| blocks.iter().all(exact))
        {
            registers.iter_mut().for_each(|register| register.known = Known::ProvedHere);
        }
        return;
    }
    let Ok(subject) = Subject::new(model, choices, &narrower).map(Subject::of_widths) else { return };
    let safe = |kind| subject.prove(&kind).is_ok_and(|(proof, _)| proof.is_safe());
    if subject.kinds().into_par_iter().all(safe) {
        registers.iter_mut().for_each(|register| register.known = Known::Proved);
    }
}
