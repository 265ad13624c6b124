//! What is to be proved of a model: over which geometries, and what is to come of them.
//!
//! The hardware is the model's own, its load words are those of its loader; said here is only how a geometry is
//! described by a few numbers, and where the machine is in the end.

mod arc;
pub(crate) mod crossing;
pub mod extremes;
mod line;
mod travel;

use stepwave_nc::{Crossing, Curve};
use stepwave_netlist::formula::{ByMode, Clause, Formula, Symbol, name, number};

use crate::hardware::Hardware;
use crate::options::{END_POINT, EndPoint};
use crate::parts::{E, END};
use crate::registers::Reg;

/// Which geometries are meant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Region {
    /// Every line of two axes from the origin, by |dx| and |dy|.
    Lines,
    /// The same, those of either long axis by themselves.
    LinesByLength,
    /// The same, those of either longer axis and those at 45 degrees by themselves.
    LinesByLonger,
    /// The same, with half of the long travel, rounded down.
    LinesHalved,
    /// Every arc about the origin inside one quadrant, with both ends on one circle: from (xs, ys) to (xt, yt),
    /// magnitudes.
    QuadrantArcs,
    /// Every arc about the origin that crosses an axis, full circles too, with both ends on one circle.
    CrossingArcs(Crossing),
    /// Every arc about the origin with both ends on one circle.
    Arcs(Crossing),
    /// Every line from the origin, and every such arc.
    LinesAndArcs,
    /// Every travel of one axis from the origin, by |dx|.
    Travels,
}

/// What a model claims over a box of geometries.
#[derive(Clone, Copy, Debug)]
pub struct Claims {
    /// Which geometries are meant, and what a box of them holds.
    pub geometries: Region,
    /// More of them, of which this hardware is proved for every k.
    pub everywhere: fn(&Hardware) -> Option<Region>,
    /// The same in finer kinds, where this hardware needs them.
    pub refined: fn(&Hardware) -> Option<Region>,
    /// Never below 0 while a block runs, and less after every step: why it ends. `None` where that is not claimed.
    pub rank: fn(&Hardware) -> Option<Formula>,
    /// What may hold between two steps of a geometry of this kind, the place and `steps`, the number of steps that the
    /// block has taken; left out where a step does not keep it.
    pub guesses: fn(&Hardware, &Kind) -> Vec<Clause>,
    /// The same, where only the rank wants it.
    pub ends: fn(&Hardware) -> Vec<Clause>,
    /// Registers that change what the others mean.
    pub modes: &'static [Reg],
    /// They come to the same values again, where the others mean something else: how often they have changed matters too.
    pub counts_changes: bool,
    /// Whether a register of this name may be loaded with any word: what is proved holds whatever the loader gives it.
    pub loaded_any: fn(&Hardware, &str) -> bool,
    /// Inputs that may change at any clock: what is proved holds whatever they are.
    pub free: &'static [&'static str],
    /// Registers that are held bit by bit, at one width at a time.
    pub bitwise: &'static [Reg],
    /// Registers that are loaded with |dx|, |dy|, … while nothing else depends on these: a block takes its clocks
    /// whatever they are, and is proved at one width at a time by following them. Empty where the proof is by steps.
    pub counted: &'static [Reg],
}

impl Claims {
    /// Over these geometries; with any end counters, one of them counts at every step.
    #[must_use]
    pub const fn of(geometries: Region) -> Claims {
        Claims {
            geometries,
            everywhere: |_| None,
            refined: |_| None,
            rank: steps_left,
            guesses: |_, _| Vec::new(),
            ends: |_| Vec::new(),
            modes: &[],
            counts_changes: false,
            loaded_any: |_, _| false,
            free: &[],
            bitwise: &[],
            counted: &[],
        }
    }

    /// What is claimed of this hardware for every k.
    #[must_use]
    pub fn for_every_k(self, hardware: &Hardware) -> Claims {
        match (self.everywhere)(hardware) {
            Some(geometries) => Claims { geometries, ..self },
            None => self.of_hardware(hardware),
        }
    }

    /// What is claimed of this hardware over a box.
    #[must_use]
    pub fn of_hardware(self, hardware: &Hardware) -> Claims {
        Claims { geometries: (self.refined)(hardware).unwrap_or(self.geometries), ..self }
    }
}

/// What the end counters still have to count, less the current step.
pub(crate) fn steps_left(hardware: &Hardware) -> Option<Formula> {
    match hardware.get(&END_POINT) {
        EndPoint::PerAxis => Some(END.of(0).value() + END.of(1).value() - 1),
        EndPoint::Total | EndPoint::Iterations | EndPoint::Longest => Some(E.value() - 1),
    }
}

/// A kind of geometry within a box, without the words of the loader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kind {
    /// What distinguishes it from the others.
    pub name: String,
    /// Numbers that describe a geometry.
    pub symbols: Vec<Symbol>,
    /// Names for numbers that all of them share; such a name is one of the netlist too.
    pub constants: Vec<(String, i128)>,
    /// Names for numbers that are others in other modes.
    pub by_mode: Vec<ByMode>,
    /// What else is true of them.
    pub premises: Vec<Clause>,
    /// Where the machine is in the end.
    pub goals: Vec<Clause>,
}

impl Region {
    /// Axes of its geometries: 1 or 2.
    #[must_use]
    pub fn axes(self) -> usize {
        if self == Region::Travels { 1 } else { 2 }
    }

    /// In words.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Region::Lines | Region::LinesByLength | Region::LinesByLonger | Region::LinesHalved => {
                "every line from the origin to coordinates of k bits"
            }
            Region::QuadrantArcs => {
                "every arc about the origin inside a quadrant, with coordinates of k bits and both ends on the circle"
            }
            Region::CrossingArcs(_) => {
                "every arc about the origin over one axis or more, with both ends on the circle and a path within \
                 coordinates of k bits"
            }
            Region::Arcs(_) => {
                "every arc about the origin, full circles too, with both ends on the circle and a path within \
                 coordinates of k bits"
            }
            Region::LinesAndArcs => {
                "every line from the origin, and every arc about it inside a quadrant with both ends on the circle, to \
                 coordinates of k bits"
            }
            Region::Travels => "every travel of one axis from the origin to a coordinate of k bits",
        }
    }

    /// The regions of one kind of curve that it is made of.
    #[must_use]
    pub fn parts(self) -> Vec<Region> {
        match self {
            Region::Arcs(crossing) => vec![Region::QuadrantArcs, Region::CrossingArcs(crossing)],
            Region::LinesAndArcs => vec![Region::Lines, Region::QuadrantArcs],
            _ => vec![self],
        }
    }

    /// Every kind of geometry; together they are the box.
    #[must_use]
    pub fn kinds(self) -> Vec<Kind> {
        match self {
            Region::LinesAndArcs | Region::Arcs(_) => self.parts().iter().flat_map(|part| part.kinds()).collect(),
            Region::Lines => line::kinds(line::ANY, false),
            Region::LinesByLength => line::kinds(line::LONG, false),
            Region::LinesByLonger => line::kinds(line::LONGER, false),
            Region::LinesHalved => line::kinds(line::LONG, true),
            Region::QuadrantArcs => arc::kinds(),
            Region::CrossingArcs(crossing) => crossing::kinds(crossing),
            Region::Travels => travel::kinds(),
        }
    }

    /// The numbers that describe a curve of this kind, or `None` if it is of another.
    #[must_use]
    pub fn symbols(self, kind: &Kind, curve: &Curve) -> Option<Vec<i128>> {
        let symbols = match self {
            Region::LinesAndArcs | Region::Arcs(_) => {
                return self.parts().iter().find_map(|part| part.symbols(kind, curve));
            }
            Region::Lines | Region::LinesByLength | Region::LinesByLonger => line::symbols(&kind.name, curve, false),
            Region::LinesHalved => line::symbols(&kind.name, curve, true),
            Region::QuadrantArcs => arc::symbols(&kind.name, curve),
            Region::CrossingArcs(crossing) => crossing::symbols(crossing, &kind.name, curve),
            Region::Travels => travel::symbols(&kind.name, curve),
        }?;
        let value = |name: &str| {
            let place = kind.symbols.iter().position(|symbol| symbol.name == name)?;
            symbols.get(place).copied()
        };
        kind.premises.iter().all(|clause| clause.holds(value) == Some(true)).then_some(symbols)
    }

    /// The curve that needs the widest registers among those of k-bit coordinates.
    #[must_use]
    pub fn largest(self, k: u32) -> Option<Curve> {
        let most = (1_i64 << k.min(52)) - 1;
        match self {
            Region::Lines | Region::LinesByLength | Region::LinesByLonger | Region::LinesHalved => {
                line::to([most, most])
            }
            Region::QuadrantArcs | Region::LinesAndArcs => arc::quarter(most),
            Region::CrossingArcs(_) | Region::Arcs(_) => crossing::whole(most),
            Region::Travels => travel::to(most),
        }
    }

    /// The curves that together need the widest registers among those of k-bit coordinates: the largest, and shorter
    /// travels, whose ramps have parts of their own.
    #[must_use]
    pub fn demanding(self, k: u32) -> Vec<Curve> {
        let shorter = if self == Region::Travels { travel::demanding(k) } else { Vec::new() };
        self.largest(k).into_iter().chain(shorter).collect()
    }

    /// [`curves`](Region::curves) has all geometries of k-bit coordinates, if `most` allows.
    #[must_use]
    pub fn is_whole(self, k: u32) -> bool {
        match self {
            Region::Lines | Region::LinesByLength | Region::LinesByLonger | Region::LinesHalved => k <= line::WHOLE,
            Region::QuadrantArcs => k <= arc::WHOLE,
            Region::CrossingArcs(_) => k <= crossing::WHOLE,
            Region::Travels => k <= travel::WHOLE,
            Region::LinesAndArcs | Region::Arcs(_) => self.parts().iter().all(|part| part.is_whole(k)),
        }
    }

    /// Curves of k-bit coordinates: all where they are at most `most`, else that many, spread evenly.
    #[must_use]
    pub fn curves(self, k: u32, most: usize) -> Vec<Curve> {
        match self {
            Region::Lines | Region::LinesByLength | Region::LinesByLonger | Region::LinesHalved => {
                line::curves(k, most)
            }
            Region::QuadrantArcs => arc::curves(k, most),
            Region::CrossingArcs(crossing) => crossing::curves(crossing, k, most),
            Region::Travels => travel::curves(k, most),
            Region::LinesAndArcs | Region::Arcs(_) => {
                let all = self.parts().iter().flat_map(|part| part.curves(k, most)).collect();
                spread(all, most)
            }
        }
    }

    /// Curves of this kind among those of k-bit coordinates of which some thousands are looked at, with the numbers that describe
    /// each.
    #[must_use]
    pub fn curves_of(self, kind: &Kind, k: u32) -> Box<dyn Iterator<Item = (Curve, Vec<i128>)>> {
        let own = kind.clone();
        let is_own = |other: &Kind| other.name == kind.name;
        match self {
            Region::CrossingArcs(crossing) => Box::new(crossing::curves_of(crossing, &kind.name, k).into_iter()),
            Region::Arcs(_) => match self.parts().iter().find(|part| part.kinds().iter().any(is_own)) {
                Some(part) => part.curves_of(kind, k),
                None => Box::new(std::iter::empty()),
            },
            _ => Box::new(self.curves(k, LISTED).into_iter().filter_map(move |curve| {
                let symbols = self.symbols(&own, &curve)?;
                Some((curve, symbols))
            })),
        }
    }
}

/// Curves of which those of a kind are taken.
const LISTED: usize = 4000;

/// A symbol from 0 to 2^k - 1.
fn coordinate(letter: &str) -> Symbol {
    Symbol { name: letter.to_owned(), least: number(0), greatest: name("2^k") - 1 }
}

/// This many of some, spread evenly over them.
fn spread<T>(all: Vec<T>, most: usize) -> Vec<T> {
    let (count, most) = (all.len(), most.max(1));
    if count <= most {
        return all;
    }
    // A stride that shares no factor with most counts, so that no pattern of the list is met by it.
    let mut all: Vec<Option<T>> = all.into_iter().map(Some).collect();
    let stride = (count * 618 / 1000) | 1;
    (0..count).filter_map(|place| all[place * stride % count].take()).take(most).collect()
}
