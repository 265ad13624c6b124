//! Boxes of geometries: all that coordinates of so many bits can tell, or the points of a grid.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use stepwave_kernel::Width;
use stepwave_models::{Choices, CurveKind, Hardware, Model, Region};
use stepwave_nc::{Arc, Conic, Curve, Direction, Helix, Line, Opens};

use super::proof::ProofError;
use super::{Grid, Range};

/// Most bits of coordinates.
const MOST_BITS: u32 = 16;
/// Geometries that are listed at most; of more, so many are.
const MOST: usize = 1_000_000;
/// Points of a grid in which arcs are looked for, at most.
const MOST_POINTS: u64 = 1 << 22;
/// Most bits of semi-axes of which all conics are listed; fewer for integrators, whose blocks take 2^k times the clocks.
const WHOLE_CONICS: u32 = 8;
const WHOLE_INTEGRATED_CONICS: u32 = 6;
/// Most bits of coordinates of which all helices are.
const WHOLE_HELICES: u32 = 4;

/// Which geometries a box holds.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Extent {
    /// Coordinates, or semi-axes and parameters of conics, of so many bits.
    Bits(u32),
    /// End points of lines from the origin, or both ends of arcs about it, among these points.
    Grid(Grid),
}

impl FromStr for Extent {
    type Err = String;

    fn from_str(text: &str) -> Result<Extent, String> {
        if let Ok(bits) = text.parse::<u32>() {
            let fits = (1..=MOST_BITS).contains(&bits);
            return if fits { Ok(Extent::Bits(bits)) } else { Err(format!("a box has 1 to {MOST_BITS} bits")) };
        }
        let no_box =
            || format!("'{text}' is no box: give bits, such as 8, or a range for each axis, such as 0..255x0..255");
        let grid: Grid = text.parse().map_err(|error: super::StudyError| error.to_string())?;
        if grid.0.len() < 2 { Err(no_box()) } else { Ok(Extent::Grid(grid)) }
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Extent::Bits(bits) => write!(f, "{bits} bits"),
            Extent::Grid(Grid(ranges)) => {
                let ranges: Vec<String> = ranges.iter().map(Range::to_string).collect();
                f.write_str(&ranges.join("x"))
            }
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
    /// Choices with which a run of any of them is on such hardware, but for what the geometry tells.
    pub choices: Choices,
}

impl Geometries {
    /// The geometries of this box that a model takes.
    ///
    /// # Errors
    /// There is no such box for the model, there are none in it, or the hardware cannot be built.
    pub fn of(model: &'static Model, choices: &Choices, extent: &Extent) -> Result<Geometries, ProofError> {
        let region = match (model.claims, model.curve) {
            (Some(claims), _) => Some(claims.geometries),
            (None, CurveKind::Line { .. }) => Some(Region::Lines),
            (None, CurveKind::Arc) => Some(Region::QuadrantArcs),
            (None, CurveKind::Conic | CurveKind::Helix) => None,
        };
        match (region, extent) {
            (Some(region), Extent::Bits(k)) => {
                let all = region.is_whole(*k);
                Geometries::in_region(model, choices, region, region.curves(*k, MOST), all, *k, 2)
            }
            (Some(region), Extent::Grid(grid)) => {
                let k = bits(grid)?;
                let (curves, all) =
                    if region == Region::QuadrantArcs { (arcs(model, grid)?, true) } else { lines(model, grid)? };
                Geometries::in_region(model, choices, region, curves, all, k, grid.0.len())
            }
            (None, Extent::Bits(k)) => {
                let (curves, whole) = match model.curve {
                    CurveKind::Helix => (helices(*k), WHOLE_HELICES),
                    _ => {
                        let integrates = model.method == "digital differential analyser";
                        let whole = if integrates { WHOLE_INTEGRATED_CONICS } else { WHOLE_CONICS };
                        (conics(*k, whole), whole)
                    }
                };
                let hardware = widest(model, choices, &curves)?;
                Ok(Geometries { curves, all: *k <= whole, k: *k, hardware, choices: choices.clone() })
            }
            (None, Extent::Grid(_)) => Err(ProofError::Box(format!(
                "the box of {} is told in bits: give --box 4; `stepwave sweep` studies ranges of such curves",
                model.name
            ))),
        }
    }

    fn in_region(
        model: &'static Model,
        choices: &Choices,
        region: Region,
        mut curves: Vec<Curve>,
        all: bool,
        k: u32,
        axes: usize,
    ) -> Result<Geometries, ProofError> {
        let kinds = region.kinds();
        if axes == 2 {
            curves.retain(|curve| kinds.iter().any(|kind| region.symbols(kind, curve).is_some()));
        }
        let all = all && curves.len() < MOST;
        let most = (1_i64 << k) - 1;
        let largest = if axes == 2 { region.largest(k) } else { line(vec![most; axes]) };
        let (Some(largest), false) = (largest, curves.is_empty()) else {
            return Err(ProofError::Box(format!(
                "the box holds nothing for {}, which takes {}: give a larger one",
                model.name,
                region.describe()
            )));
        };
        let choices = Choices { width: Width::new(u64::from(k)).ok(), ..choices.clone() };
        Ok(Geometries { curves, all, k, hardware: model.plan(&largest, &choices)?, choices })
    }
}

/// Bits of the coordinates of a grid.
fn bits(Grid(ranges): &Grid) -> Result<u32, ProofError> {
    let ends = ranges.iter().flat_map(|range| [range.at(0), range.at(range.count() - 1)]);
    let most = ends.map(i64::unsigned_abs).max().unwrap_or(0);
    match Width::needed_unsigned(most.into()) {
        bits if bits <= MOST_BITS => Ok(bits),
        bits => Err(ProofError::Box(format!(
            "a coordinate of {most} needs {bits} bits, but a box has at most {MOST_BITS}: give ranges within ±{}",
            (1 << MOST_BITS) - 1
        ))),
    }
}

fn line(to: Vec<i64>) -> Option<Curve> {
    Line::new(vec![0; to.len()], to).ok().map(Curve::Line)
}

/// The lines from the origin to the points of a grid, and whether they are all: of a large grid its corners and others
/// spread over it.
fn lines(model: &Model, Grid(ranges): &Grid) -> Result<(Vec<Curve>, bool), ProofError> {
    let (axes, most) = (ranges.len(), model.curve.max_axes());
    if axes > most {
        let takes = model.curve.describe();
        let ranges = vec!["0..9"; most].join("x");
        return Err(ProofError::Box(format!(
            "the box has {axes} ranges, but {} interpolates {takes}: give --box {ranges}",
            model.name
        )));
    }
    let count = ranges.iter().fold(1_u128, |count, range| count.saturating_mul(range.count().into()));
    let point = |mut place: u128| {
        let digit = |range: &Range| {
            let count = u128::from(range.count());
            let digit = place % count;
            place /= count;
            range.at(u64::try_from(digit).unwrap_or(0))
        };
        ranges.iter().map(digit).collect::<Vec<i64>>()
    };
    let corners = (0..1_u32 << axes).map(|corner| {
        let end =
            |(axis, range): (usize, &Range)| range.at(if corner >> axis & 1 == 1 { range.count() - 1 } else { 0 });
        ranges.iter().enumerate().map(end).collect::<Vec<i64>>()
    });
    let all = count < MOST as u128;
    let points: Vec<Vec<i64>> = if all {
        (0..count).map(point).collect()
    } else {
        // By the golden section, so that no pattern of the grid is met.
        let stride = (count / 1000 * 618) | 1;
        corners.chain((0..MOST as u128 / 50).map(|place| point(place * stride % count))).collect()
    };
    Ok((points.into_iter().filter_map(line).collect(), all))
}

/// The arcs about the origin whose ends are points of a grid, on one circle; those inside one quadrant are chosen later.
fn arcs(model: &Model, Grid(ranges): &Grid) -> Result<Vec<Curve>, ProofError> {
    let [x, y] = ranges[..] else {
        return Err(ProofError::Box(format!(
            "the box has {} ranges, but {} interpolates arcs in the plane: give --box 0..9x0..9",
            ranges.len(),
            model.name
        )));
    };
    let count = x.count().saturating_mul(y.count());
    if count > MOST_POINTS {
        return Err(ProofError::Box(format!(
            "a grid of {count} points is too large to look for arcs in: give one of at most {MOST_POINTS}, such as \
             0..2047x0..2047"
        )));
    }
    let mut circles: BTreeMap<i64, Vec<[i64; 2]>> = BTreeMap::new();
    for x in x.numbers() {
        y.numbers().for_each(|y| circles.entry(x * x + y * y).or_default().push([x, y]));
    }
    let mut arcs = Vec::new();
    for points in circles.values() {
        let side = |axis: usize, point: &[i64; 2]| point[axis].signum();
        for from in points {
            // The ends of an arc inside a quadrant are on no two sides of an axis.
            let near =
                |to: &&[i64; 2]| *to != from && [0, 1].iter().all(|&axis| side(axis, from) * side(axis, to) >= 0);
            for to in points.iter().filter(near) {
                let ways = [Direction::Clockwise, Direction::CounterClockwise];
                arcs.extend(ways.into_iter().filter_map(|way| Arc::new(*from, *to, [0, 0], way).ok()).map(Curve::Arc));
                if arcs.len() > 4 * MOST {
                    return Err(ProofError::Box(format!(
                        "the box holds more than {MOST} arcs: give a smaller or coarser one, such as 0..255/5x0..255/5"
                    )));
                }
            }
        }
    }
    Ok(arcs)
}

/// The sizes of a box: all, or some of them.
fn sizes(k: u32, whole: u32) -> Vec<i64> {
    let greatest = (1_i64 << k) - 1;
    if k <= whole {
        return (1..=greatest).collect();
    }
    vec![1, 2, 3, 5, greatest / 3, greatest / 2, greatest / 2 + 1, greatest - 2, greatest - 1, greatest]
}

/// Quarters of ellipses with semi-axes of k bits, and arcs of parabolas and hyperbolas from or to the vertex, whose other
/// end has coordinates of k bits and lies on the curve exactly.
fn conics(k: u32, whole: u32) -> Vec<Curve> {
    let greatest = (1_i64 << k) - 1;
    let sizes = sizes(k, whole);
    let mut all: Vec<Conic> = Vec::new();
    let square_root = |square: i64| Some(square.isqrt()).filter(|root| root * root == square);
    for &a in &sizes {
        for opens in [Opens::PlusX, Opens::MinusX, Opens::PlusY, Opens::MinusY] {
            // Along the axis to which the curve opens, and beside it on either side.
            let place = |along: i64, beside: i64| {
                let along = along * opens.sign();
                if opens.axis() == 0 { [along, beside] } else { [beside, along] }
            };
            let both_ways = |vertex: [i64; 2], end: [i64; 2]| [(vertex, end), (end, vertex)];
            for beside in (1..=greatest).filter(|y| y * y % a == 0 && y * y / a <= greatest) {
                for side in [1, -1] {
                    let ends = both_ways([0, 0], place(beside * beside / a, side * beside));
                    all.extend(
                        ends.iter().filter_map(|&(from, to)| Conic::parabola(a, Some(opens), from, to, [0, 0]).ok()),
                    );
                }
            }
            for &b in &sizes {
                let [real, other] = if opens.axis() == 0 { [a, b] } else { [b, a] };
                // (x/real)² - (y/other)² = 1.
                for along in real + 1..=greatest {
                    let square = other * other * (along * along - real * real);
                    let beside = (square % (real * real) == 0).then_some(square / (real * real));
                    let Some(beside) = beside.and_then(square_root).filter(|beside| *beside <= greatest) else {
                        continue;
                    };
                    for side in [1, -1] {
                        let ends = both_ways(place(real, 0), place(along, side * beside));
                        let branch = |&(from, to)| Conic::hyperbola([a, b], Some(opens), from, to, [0, 0]).ok();
                        all.extend(ends.iter().filter_map(branch));
                    }
                }
            }
        }
        for &b in &sizes {
            let corners = [[a, 0], [0, b], [-a, 0], [0, -b]];
            for place in 0..4 {
                let [from, to] = [corners[place], corners[(place + 1) % 4]];
                let ways = [(from, to, Direction::CounterClockwise), (to, from, Direction::Clockwise)];
                all.extend(
                    ways.iter().filter_map(|&(from, to, way)| Conic::ellipse([a, b], from, to, [0, 0], way).ok()),
                );
            }
        }
    }
    all.into_iter().map(Curve::Conic).collect()
}

/// The arcs inside a quadrant of k-bit coordinates, each with every way in z that has k bits.
fn helices(k: u32) -> Vec<Curve> {
    let region = Region::QuadrantArcs;
    let kinds = region.kinds();
    let mut arcs = region.curves(k.min(WHOLE_HELICES + 2), if k <= WHOLE_HELICES { usize::MAX } else { 600 });
    if k > WHOLE_HELICES {
        arcs.extend(region.largest(k));
    }
    arcs.retain(|arc| kinds.iter().any(|kind| region.symbols(kind, arc).is_some()));
    let mut all = Vec::new();
    for arc in &arcs {
        let Curve::Arc(arc) = arc else { continue };
        for z in sizes(k, WHOLE_HELICES).into_iter().flat_map(|z| [z, -z]).chain([0]) {
            let [[x, y], [to_x, to_y]] = [arc.from(), arc.to()];
            all.extend(Helix::new([x, y, 0], [to_x, to_y, z], [0, 0], arc.direction()).ok().map(Curve::Helix));
        }
    }
    all
}

/// The hardware whose registers are as wide as any of these curves needs them.
fn widest(model: &Model, choices: &Choices, curves: &[Curve]) -> Result<Hardware, ProofError> {
    let mut plans = curves.iter().map(|curve| model.plan(curve, choices));
    let Some(first) = plans.next() else { return Err(ProofError::NoClaims { model: model.name }) };
    let mut widest = first?;
    for plan in plans {
        let plan = plan?;
        for (name, width) in plan.widths {
            let own = widest.widths.entry(name).or_insert(width);
            *own = (*own).max(width);
        }
        widest.stall_clocks = widest.stall_clocks.max(plan.stall_clocks);
    }
    Ok(widest)
}
