//! Boxes of geometries: all that coordinates of this many bits can express, or the points of a grid; whole, or the
//! extreme ones.

mod conics;
mod helices;
mod plane;
mod splines;

use std::fmt;
use std::str::FromStr;

use rayon::prelude::*;
use stepwave_models::options::{CASCADE, NORMALIZE, RADIX, WIDTH};
use stepwave_models::{CurveKind, Hardware, Model, ModelError, Options, Region};
use stepwave_nc::{Curve, Line};
use stepwave_netlist::Width;

use super::proof::ProofError;
use super::{Grid, Range};

/// Most bits of coordinates where every width is proved at once.
pub(super) const MOST_BITS: u32 = 52;
/// Most bits of coordinates where geometries are simulated to their ends.
pub(super) const MOST_SIMULATED_BITS: u32 = 16;
/// Geometries that are listed at most; of more, the extreme ones.
const MOST: usize = 1_000_000;
/// Most bits of semi-axes of which all conics are listed; fewer for integrators, whose blocks take 2^k times the
/// clocks.
const WHOLE_CONICS: u32 = 8;
const WHOLE_INTEGRATED_CONICS: u32 = 6;
/// Most bits of coordinates of which all helices are.
const WHOLE_HELICES: u32 = 4;
/// Most bits of coordinates of which all fours are, as one axis of a cubic Bézier curve has them.
const WHOLE_SPLINES: u32 = 3;

/// Which geometries a box holds.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Extent {
    /// Coordinates, or semi-axes and parameters of conics, of this many bits.
    Bits(u32),
    /// End points of lines from the origin, or both ends of arcs about it, among these points.
    Grid(Grid),
}

impl FromStr for Extent {
    type Err = String;

    fn from_str(text: &str) -> Result<Extent, String> {
        if let Ok(bits) = text.parse::<i64>() {
            let fits = u32::try_from(bits).ok().filter(|bits| (1..=MOST_BITS).contains(bits));
            return fits.map(Extent::Bits).ok_or_else(|| format!("a box has 1 to {MOST_BITS} bits, not {bits}"));
        }
        let no_box =
            || format!("invalid box '{text}': give bits, such as 8, or a range for each axis, such as 0..255x0..255");
        let grid: Grid = text.parse().map_err(|error: super::StudyError| error.to_string())?;
        if grid.0.is_empty() { Err(no_box()) } else { Ok(Extent::Grid(grid)) }
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Extent::Bits(1) => f.write_str("1 bit"),
            Extent::Bits(bits) => write!(f, "{bits} bits"),
            // One number alone would be bits.
            Extent::Grid(Grid(ranges)) if ranges.len() == 1 && ranges[0].count() == 1 => {
                write!(f, "{place}..{place}", place = ranges[0].at(0))
            }
            Extent::Grid(grid) => grid.fmt(f),
        }
    }
}

impl Extent {
    /// Bits of the coordinates in it.
    ///
    /// # Errors
    /// A coordinate needs more than 52 bits.
    pub fn bits(&self) -> Result<u32, ProofError> {
        let Grid(ranges) = match self {
            Extent::Bits(bits) => return Ok(*bits),
            Extent::Grid(grid) => grid,
        };
        let ends = ranges.iter().flat_map(|range| [range.at(0), range.at(range.count() - 1)]);
        let most = ends.map(i64::unsigned_abs).max().unwrap_or(0);
        match Width::needed_unsigned(most.into()) {
            bits if bits <= MOST_BITS => Ok(bits),
            bits => Err(ProofError::Box(format!(
                "a coordinate of {most} needs {bits} bits, but a box has at most {MOST_BITS}: give ranges within ±{}",
                (1_i64 << MOST_BITS) - 1
            ))),
        }
    }

    /// Axes of the geometries in it of this model.
    #[must_use]
    pub fn axes(&self, model: &Model) -> usize {
        match self {
            Extent::Bits(_) => model.curve().max_axes().min(2),
            Extent::Grid(Grid(ranges)) => ranges.len(),
        }
    }
}

/// The geometries of a box, with one hardware that takes all of them.
#[derive(Clone, Debug)]
pub struct Geometries {
    /// They.
    pub curves: Vec<Curve>,
    /// They are all of the box.
    pub all: bool,
    /// Bits of their coordinates.
    pub k: u32,
    /// The hardware.
    pub hardware: Hardware,
    /// Options with which a run of any of them is on such hardware, but for what the geometry decides.
    pub choices: Options,
}

/// Which geometries a model's box is made of: the region over which something is claimed of it, or that of its curves.
fn region(model: &Model) -> Option<Region> {
    match (model.claims, model.curve()) {
        (Some(claims), _) => Some(claims.geometries),
        (None, CurveKind::Axis) => Some(Region::Travels),
        (None, CurveKind::Line { .. }) => Some(Region::Lines),
        (None, CurveKind::Arc) => Some(Region::QuadrantArcs),
        (None, CurveKind::Move) => Some(Region::LinesAndArcs),
        (None, _) => None,
    }
}

impl Geometries {
    /// The geometries of this box that a model takes: all of them, or where these are too many the
    /// [extreme ones](Geometries::extremes).
    ///
    /// # Errors
    /// There is no such box for the model, there are none in it, or the hardware cannot be built.
    pub fn of(model: &'static Model, choices: &Options, extent: &Extent) -> Result<Geometries, ProofError> {
        Geometries::made(model, choices, extent, true)
    }

    /// The extreme geometries of this box: at its corners, on and next to its axes, of its greatest radii and its
    /// largest and smallest weights, both ways round.
    ///
    /// # Errors
    /// See [`of`](Geometries::of).
    pub fn extremes(model: &'static Model, choices: &Options, extent: &Extent) -> Result<Geometries, ProofError> {
        Geometries::made(model, choices, extent, false)
    }

    fn made(model: &'static Model, choices: &Options, extent: &Extent, wanted: bool) -> Result<Geometries, ProofError> {
        let k = extent.bits()?;
        let Some(region) = region(model) else { return Geometries::in_space(model, choices, extent, k, wanted) };
        let arcs = region == Region::QuadrantArcs;
        let sides = match extent {
            Extent::Bits(k) => {
                let most = (1_i64 << k) - 1;
                let range = Range::new(-most, most, 1).map_err(|error| ProofError::Box(error.to_string()))?;
                Grid(vec![range; region.axes()])
            }
            Extent::Grid(grid) => grid.clone(),
        };
        plane::check(model, &sides, arcs)?;
        let axes = sides.0.len();
        let (mut curves, mut all) = (Vec::new(), true);
        // Arcs are in the plane.
        for part in region.parts().iter().filter(|part| arcs || axes == 2 || **part != Region::QuadrantArcs) {
            let (own, whole) = curves_of(*part, extent, &sides, wanted);
            curves.extend(own);
            all &= whole;
        }
        let kinds = region.kinds();
        if axes == region.axes() {
            curves.retain(|curve| kinds.iter().any(|kind| region.symbols(kind, curve).is_some()));
        }
        let largest = if axes == region.axes() { region.largest(k) } else { line(vec![(1_i64 << k) - 1; axes]) };
        if curves.is_empty() && arcs && plane::all_arcs(&sides).is_none() {
            return Err(ProofError::Box(format!(
                "no two points next to the corners of the box are ends of one arc, and its {} points are too many to look at \
                 all: give a smaller one",
                plane::count(&sides)
            )));
        }
        let (Some(largest), false) = (largest, curves.is_empty()) else {
            return Err(ProofError::Box(format!(
                "the box holds nothing for {}, which takes {}: give a larger one",
                model.name,
                region.describe()
            )));
        };
        let choices = choices.clone().with_all(&WIDTH, choices.of_all(&WIDTH).or(width(model, choices, k)));
        let hardware = match region {
            Region::Travels => hardware_of(model, &choices, &curves)?,
            _ => model.plan(&largest, &choices)?,
        };
        Ok(Geometries { curves, all, k, hardware, choices })
    }

    /// These geometries, by hardware that holds all of them.
    ///
    /// # Errors
    /// There are none, or the hardware cannot be built.
    pub fn these(model: &'static Model, choices: &Options, curves: Vec<Curve>) -> Result<Geometries, ProofError> {
        let coordinates = curves.iter().flat_map(|curve| curve.from().iter().chain(curve.to()));
        let greatest = coordinates.map(|coordinate| coordinate.unsigned_abs()).max().unwrap_or(0);
        let (k, hardware) = (Width::needed_unsigned(greatest.into()), hardware_of(model, choices, &curves)?);
        Ok(Geometries { curves, all: false, k, hardware, choices: choices.clone() })
    }

    /// Conics, helices and Bézier curves.
    fn in_space(
        model: &'static Model,
        choices: &Options,
        extent: &Extent,
        k: u32,
        wanted: bool,
    ) -> Result<Geometries, ProofError> {
        if matches!(extent, Extent::Grid(_)) {
            return Err(ProofError::Box(format!(
                "the box of {} is given in bits: give --box 4; `stepwave sweep` studies ranges of such curves",
                model.name
            )));
        }
        check_simulated(model, k)?;
        let integrates = model.method == "digital differential analyser";
        let (whole, of): (_, fn(u32, bool) -> Vec<Curve>) = match model.curve() {
            CurveKind::Helix => (WHOLE_HELICES, helices::helices),
            CurveKind::Conic if integrates => (WHOLE_INTEGRATED_CONICS, conics::conics),
            CurveKind::Conic => (WHOLE_CONICS, conics::conics),
            CurveKind::Spline => (WHOLE_SPLINES, splines::curves),
            CurveKind::Nurbs => (0, splines::nurbs),
            other => return Err(ProofError::Box(format!("there are no boxes of such curves: {}", other.describe()))),
        };
        let all = wanted && k <= whole;
        let mut curves = of(k, all);
        let choices = match model.curve() {
            CurveKind::Spline => splines::divided(choices, k),
            CurveKind::Nurbs => splines::fractioned(choices, k),
            _ => choices.clone(),
        };
        if model.curve() == CurveKind::Nurbs {
            // One that rests somewhere is refused; where all are, the first says why.
            let taken =
                curves.par_iter().filter(|curve| model.plan(curve, &choices).is_ok()).cloned().collect::<Vec<_>>();
            curves = if taken.is_empty() { curves } else { taken };
        }
        let hardware = hardware_of(model, &choices, &curves)?;
        Ok(Geometries { curves, all, k, hardware, choices })
    }
}

/// The curves of a region of one kind in a box, all if these are `wanted` and not too many, or the extreme ones; and whether
/// they are all.
fn curves_of(region: Region, extent: &Extent, sides: &Grid, wanted: bool) -> (Vec<Curve>, bool) {
    let arcs = region == Region::QuadrantArcs;
    let listed = match extent {
        _ if !wanted => None,
        Extent::Bits(k) => region.is_whole(*k).then(|| region.curves(*k, usize::MAX)),
        Extent::Grid(grid) if arcs => plane::all_arcs(grid),
        Extent::Grid(grid) => plane::all_lines(grid),
    };
    if let Some(listed) = listed {
        return (listed, true);
    }
    let extremes = match plane::extremes(sides, arcs) {
        // No two of its extreme points are on one circle; others may be.
        none if none.is_empty() && arcs => {
            plane::all_arcs(sides).or_else(|| plane::corner_arcs(sides)).unwrap_or_default()
        }
        some => some,
    };
    (extremes, false)
}

/// By how many bits registers that hold every number of `k` bits are wider than these: a machine that normalises keeps one
/// bit free.
pub(super) fn spare_bits(model: &Model, choices: &Options) -> u32 {
    u32::from(model.is_buffered() && choices.value(&NORMALIZE))
}

/// The width of registers that hold every number of `k` bits, in whole digits and whole units; `None` where --width is not
/// the width of coordinates.
fn width(model: &Model, choices: &Options, k: u32) -> Option<Width> {
    if !model.width_is_of_coordinates() {
        return None;
    }
    let bits = choices.value(&RADIX).reading().needed((1_i128 << k) - 1) + spare_bits(model, choices);
    let bits = bits.next_multiple_of(choices.value(&CASCADE).map_or(1, Width::get));
    Width::new(u64::from(bits)).ok()
}

/// Choices with the widths that a box decides by default: all but that of a phase.
pub(super) fn without_widths(model: &Model, choices: &Options) -> Options {
    let phase = choices.of_all(&WIDTH).filter(|_| model.width_is_of_phase());
    choices.clone().with(&WIDTH, None).with_all(&WIDTH, phase)
}

/// Widths are given that a box decides by default.
pub(super) fn has_widths(model: &Model, choices: &Options) -> bool {
    choices.of_all(&WIDTH).is_some_and(|_| !model.width_is_of_phase()) || !choices.of_single(&WIDTH).is_empty()
}

/// Checks that runs of geometries of this many bits end within a reasonable time.
///
/// # Errors
/// They do not.
pub(super) fn check_simulated(model: &Model, k: u32) -> Result<(), ProofError> {
    if k <= MOST_SIMULATED_BITS {
        return Ok(());
    }
    Err(ProofError::Box(format!(
        "no proof for every width covers {} with these choices, so that a box of {k} bits would have to be simulated: \
         give one of at most {MOST_SIMULATED_BITS} bits",
        model.name
    )))
}

fn line(to: Vec<i64>) -> Option<Curve> {
    Line::new(vec![0; to.len()], to).ok().map(Curve::Line)
}

/// The sizes of a box: all, or the extreme ones.
fn sizes(k: u32, all: bool) -> Vec<i64> {
    let greatest = (1_i64 << k) - 1;
    if all {
        return (1..=greatest).collect();
    }
    let mut sizes =
        vec![1, 2, 3, 5, greatest / 3, greatest / 2, greatest / 2 + 1, greatest - 2, greatest - 1, greatest];
    sizes.retain(|size| (1..=greatest).contains(size));
    sizes.sort_unstable();
    sizes.dedup();
    sizes
}

/// The hardware whose registers are as wide as any of these curves needs them; `None` of no curve.
pub(super) fn widest(model: &Model, choices: &Options, curves: &[Curve]) -> Result<Option<Hardware>, ModelError> {
    let mut plans = curves.iter().map(|curve| model.plan(curve, choices));
    let Some(first) = plans.next() else { return Ok(None) };
    let mut widest = first?;
    for plan in plans {
        let plan = plan?;
        for (name, width) in plan.widths {
            let own = widest.widths.entry(name).or_insert(width);
            *own = (*own).max(width);
        }
        widest.stall_clocks = widest.stall_clocks.max(plan.stall_clocks);
    }
    Ok(Some(widest))
}

/// The hardware of a box.
fn hardware_of(model: &Model, choices: &Options, curves: &[Curve]) -> Result<Hardware, ProofError> {
    let nothing = || ProofError::Box(format!("the box holds nothing for {}: give a larger one", model.name));
    widest(model, choices, curves)?.ok_or_else(nothing)
}
