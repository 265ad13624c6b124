//! One hardware of given widths, over one box of geometries.

use std::collections::BTreeMap;

use stepwave_engine::EngineKind;
use stepwave_models::options::WIDTH;
use stepwave_models::{Claims, Hardware, Model, Options};
use stepwave_nc::Curve;
use stepwave_netlist::Width;

use super::counter::try_all;
use super::members::{Offsets, choices_with, hardware_at, registers_named};
use super::{Block, CountMethod, Counterexample, Narrower, ProofError, Subject, Tried, blocks};
use crate::study::boxes::{spare_bits, without_widths};
use crate::study::{Extent, Geometries, Grid, Range};
use crate::testbench::Testbench;

/// Most bits of coordinates at which a block is followed: it takes twice as long for each more.
const MOST_FOLLOWED: u32 = 16;
/// Clocks after which the longest run of a box is long enough to know that few can be simulated.
const LONG: u64 = 1 << 22;
/// Most bits of the coordinates of small geometries, and how many are a few.
const SMALL: u32 = 7;
const FEW: usize = 10_000;
/// Geometries that are simulated at least, however long they take.
const LEAST: usize = 64;

/// One hardware and its box.
#[derive(Clone, Debug)]
pub struct Fixed {
    model: &'static Model,
    claims: Claims,
    /// All that makes the hardware, the width for coordinates among it.
    choices: Options,
    /// Bits of coordinates that it is made for.
    k: u32,
    extent: Extent,
    /// Bits of the coordinates in it.
    bits: u32,
    hardware: Hardware,
    /// By how much its registers differ from those by default at this k.
    offsets: Offsets,
}

/// The box |x| <= X, |y| <= Y, of a travel for each axis in BLU.
///
/// # Errors
/// A travel is below 1.
pub fn symmetric_box(travel: &[i64]) -> Result<Extent, ProofError> {
    let range = |&most: &i64| {
        let range = most.checked_neg().filter(|_| most > 0).and_then(|least| Range::new(least, most, 1).ok());
        range.ok_or_else(|| ProofError::Box(format!("a travel of {most} BLU holds no geometry: give 1 or more")))
    };
    Ok(Extent::Grid(Grid(travel.iter().map(range).collect::<Result<_, _>>()?)))
}

impl Fixed {
    /// The hardware with these widths, those that are not given as by default: for coordinates of the width that is given
    /// for all, or else of those of the box.
    ///
    /// # Errors
    /// The model claims nothing, there is no such box, or the hardware cannot be built.
    pub fn new(model: &'static Model, choices: &Options, extent: Extent) -> Result<Fixed, ProofError> {
        let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
        let (axes, wanted) = (extent.axes(model), claims.geometries.axes());
        if axes != wanted {
            let axis = if axes == 1 { "axis" } else { "axes" };
            let range = if wanted == 1 { "one range, such as 0..9" } else { "two ranges, such as 0..9x0..9" };
            return Err(ProofError::Box(format!("a box of {axes} {axis} is not proved: give {range}")));
        }
        let bits = extent.bits()?;
        let spare = spare_bits(model, choices);
        let given = choices.of_all(&WIDTH);
        let of_coordinates = given.filter(|_| model.width_is_of_coordinates());
        let k = of_coordinates.map_or(bits, |width| width.get().saturating_sub(spare).max(1));
        let width = Width::new(u64::from(k + spare)).ok().filter(|_| model.width_is_of_coordinates());
        let choices = choices.clone().with_all(&WIDTH, given.or(width));
        let usual = hardware_at(model, &claims, &choices.clone().with_single(&WIDTH, BTreeMap::new()), k)?;
        for name in choices.of_single(&WIDTH).keys() {
            registers_named(model, &usual, name)?;
        }
        let hardware = hardware_at(model, &claims, &choices, k)?;
        let offset = |(name, width): (&&'static str, &Width)| {
            let usual = usual.bits_of(name);
            ((*name).to_owned(), i64::from(width.get()) - i64::from(usual))
        };
        let offsets = hardware.widths.iter().map(offset).filter(|(_, bits)| *bits != 0).collect();
        Ok(Fixed { model, claims, choices, k, extent, bits, hardware, offsets })
    }

    /// Bits of coordinates that the hardware is made for.
    #[must_use]
    pub fn k(&self) -> u32 {
        self.k
    }

    /// A register is narrower than by default, so that what is proved of the default says nothing.
    #[must_use]
    pub fn is_narrower(&self) -> bool {
        self.offsets.values().any(|bits| *bits < 0)
    }

    /// The box in words.
    #[must_use]
    pub fn about(&self) -> String {
        let about = self.claims.geometries.describe();
        match &self.extent {
            Extent::Bits(bits) => about.replace("of k bits", &format!("of {bits} {}", bit(*bits))),
            grid @ Extent::Grid(_) => about.replace("of k bits", &format!("within {grid}")),
        }
    }

    /// The hardware of every k that is this one at its own k: every register by as much narrower or wider than by default
    /// as it is here. What is proved of it is proved here, for all coordinates of k bits. `None` where there is no such
    /// family, or where the box holds more.
    #[must_use]
    pub fn subject(&self) -> Option<Subject> {
        if self.bits > self.k {
            return None;
        }
        let free = without_widths(self.model, &self.choices);
        let subject = Subject::with(self.model, &free, &self.offsets, Some(self.k)).ok()?.of_box();
        let own = subject.members.iter().find(|(k, ..)| *k == self.k);
        own.is_some_and(|(_, hardware, _)| *hardware == self.hardware).then_some(subject)
    }

    /// The blocks of every kind, followed with coefficients of unknown bits; `None` where that takes too long, or where the
    /// box holds more.
    ///
    /// # Errors
    /// They cannot be followed.
    pub fn blocks(&self, method: CountMethod) -> Option<Result<Vec<Block>, ProofError>> {
        let fits = self.bits <= self.k && self.k <= MOST_FOLLOWED;
        fits.then(|| blocks(self.model, &self.claims, &self.choices, &Narrower::new(), self.k, method))
    }

    /// Simulates geometries of the box, all if their clocks are not more than about `clocks`; or, of large boxes, a `few`
    /// small ones and the extreme ones. Gives the first that goes wrong, and what was tried else. `progress` gets how many are done, and how many
    /// there are.
    ///
    /// # Errors
    /// There is no such box for the model.
    pub fn search(
        &self,
        few: bool,
        clocks: u64,
        progress: impl Fn(usize, usize),
    ) -> Result<(Option<Counterexample>, Tried), ProofError> {
        let free = without_widths(self.model, &self.choices);
        let (mut curves, mut all) = match &self.extent {
            // Listed in a moment, though coordinates of this many bits may be far more.
            Extent::Grid(grid) if few && points(grid) < FEW as u128 => {
                let geometries = Geometries::of(self.model, &free, &self.extent)?;
                (geometries.curves, geometries.all)
            }
            _ => self.small(few),
        };
        if few && !all {
            curves.extend(Geometries::extremes(self.model, &free, &self.extent)?.curves);
        } else if curves.is_empty() {
            let geometries = Geometries::of(self.model, &free, &self.extent)?;
            (curves, all) = (geometries.curves, geometries.all);
        }
        let size = |curve: &Curve| [curve.from(), curve.to()].concat().iter().map(|c| c.unsigned_abs()).sum::<u64>();
        curves.sort_by_cached_key(size);
        let longest = curves.last().and_then(|curve| {
            let bench = Testbench::new(self.model, curve, &free).ok()?.limited(LONG);
            bench.run(EngineKind::Compiled, &mut []).ok().map(|outcome| outcome.clocks)
        });
        let most = usize::try_from(clocks / longest.unwrap_or(LONG).max(1)).unwrap_or(usize::MAX).max(LEAST);
        if curves.len() > most {
            // The least and the greatest.
            curves.drain(most / 2..curves.len() - most / 2);
            all = false;
        }
        let mut tried = Tried { k: self.k, all, ..Tried::default() };
        let bench = Testbench::of_hardware(self.model, self.hardware.clone())?;
        let (number, limit) = (curves.len(), clocks / LEAST as u64);
        let found = try_all(&bench, curves, limit, &mut tried, &|_| true, |done| progress(done, number))?;
        let choices = self.choices.clone();
        Ok((found.map(|(curve, fault)| Counterexample { k: self.k, curve, choices, fault }), tried))
    }

    /// Small geometries of the box, and whether they are all; none where not a `few` are wanted.
    fn small(&self, few: bool) -> (Vec<Curve>, bool) {
        let region = self.claims.geometries;
        let small = self.bits.clamp(1, SMALL);
        let mut curves = if few { region.curves(small, FEW) } else { Vec::new() };
        let all = self.bits <= SMALL && region.is_whole(small) && curves.len() < FEW;
        let holds = |curve: &Curve| match &self.extent {
            Extent::Bits(_) => true,
            Extent::Grid(Grid(ranges)) => {
                let is_in = |point: &[i64]| point.iter().zip(ranges).all(|(c, range)| range.index(*c).is_some());
                is_in(curve.to()) && (matches!(curve, Curve::Line(_)) || is_in(curve.from()))
            }
        };
        let kinds = region.kinds();
        curves.retain(|curve| holds(curve) && kinds.iter().any(|kind| region.symbols(kind, curve).is_some()));
        (curves, all)
    }
}

/// Points of a grid.
fn points(Grid(ranges): &Grid) -> u128 {
    ranges.iter().fold(1_u128, |count, range| count.saturating_mul(range.count().into()))
}

fn bit(number: u32) -> &'static str {
    if number == 1 { "bit" } else { "bits" }
}

/// The k at which registers of these widths begin to be narrower than by default, and a few more: there is where they begin
/// to be too narrow for geometries of k bits.
///
/// # Errors
/// The model claims nothing, or a register does not exist.
pub fn narrowing_ks(model: &'static Model, choices: &Options) -> Result<Vec<u32>, ProofError> {
    let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
    let free = without_widths(model, choices);
    for k in 1..=52 {
        let own = choices_with(model, &claims, &free, &Offsets::new(), k)?;
        let usual = match hardware_at(model, &claims, &own, k) {
            Ok(usual) => usual,
            Err(error) if k == 52 => return Err(error.into()),
            Err(_) => continue,
        };
        for (name, width) in &choices.of_single(&WIDTH) {
            if registers_named(model, &usual, name)?.iter().any(|(_, usual)| usual > width) {
                return Ok((k..=k + 3).filter(|k| *k <= 52).collect());
            }
        }
    }
    Ok(Vec::new())
}
