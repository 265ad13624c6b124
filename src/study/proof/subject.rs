//! The family of a model's netlists, and attempts at proofs of it.

use std::ops::Range;

use stepwave_models::{Claims, Hardware, Kind, Machine, Model, ModelError, Options, Region};
use stepwave_netlist::Design;
use stepwave_netlist::formula::{Formula, Symbol, name, number};
use stepwave_prove::{self as prove, Certificate, Family, Proof, Strobes};

use super::ProofError;
use super::learning::rows;
use super::members::{Narrower, Offsets, choices_with, hardware_at, largest, offsets};

/// One hardware for every width.
#[derive(Debug)]
pub struct Subject {
    pub(super) model: &'static Model,
    pub(super) claims: Claims,
    pub(super) family: Family,
    pub(super) strobes: Strobes,
    /// Remainders start from any value.
    any_preset: bool,
    is_whole: bool,
    /// The machine of each k, in ascending order.
    pub(super) members: Vec<(u32, Hardware, Machine)>,
}

/// Least k of a family: below, netlists lose cells.
const LEAST_K: u32 = 3;
/// The k whose netlists are all checked to be of one family.
const GREATEST_K: u32 = 52;
impl Subject {
    /// The hardware of a model for every k, with these choices in addition to the widths.
    ///
    /// # Errors
    /// The model claims nothing, a choice is impossible, or the netlists of several k differ in more than widths.
    pub fn new(model: &'static Model, choices: &Options, narrower: &Narrower) -> Result<Subject, ProofError> {
        Subject::with(model, choices, &offsets(narrower), None)
    }

    /// As [`new`](Subject::new), some registers narrower or wider. Of a travel of one axis, whose hardware is not the same
    /// circuit at every k, the k around `at`, or as many as there are in a row.
    pub(super) fn with(
        model: &'static Model,
        choices: &Options,
        offsets: &Offsets,
        at: Option<u32>,
    ) -> Result<Subject, ProofError> {
        let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
        if model.is_buffered() {
            return Err(ProofError::Buffered { model: model.name });
        }
        let member = |k| -> Result<_, ModelError> {
            let curve = largest(&claims, k)?;
            let hardware = hardware_at(model, &claims, &choices_with(model, &claims, choices, offsets, k)?, k)?;
            let machine = model.machine(&hardware)?;
            machine.encode(&hardware, &model.words(&hardware, &curve)?)?;
            Ok((k, hardware, machine))
        };
        let mut members: Vec<(u32, Hardware, Machine)> = Vec::new();
        for k in LEAST_K..=GREATEST_K {
            match member(k) {
                Ok(member) => members.push(member),
                // A fixed choice, such as a preset, may need more bits than the least k has; the widest may not be built.
                Err(ModelError::DoesNotFit { .. }) if members.is_empty() && k < LEAST_K + 8 => {}
                Err(_) if members.len() > 1 => break,
                Err(error) => return Err(error.into()),
            }
        }
        let designs: Vec<(u32, Design)> = members.iter().map(|(k, _, machine)| (*k, machine.design.clone())).collect();
        let family = if claims.geometries == Region::Travels {
            let alike = alike(&designs, members.iter().position(|(k, ..)| Some(*k) == at));
            if alike.len() < 2 {
                return Err(ProofError::Box(format!(
                    "{} with these widths is another circuit at each number of bits, so that nothing is proved for every k: give \
                     a box (--box 8), of which every travel is simulated",
                    model.name
                )));
            }
            members = members.drain(alike.clone()).collect();
            Family::of(&designs[alike])?
        } else {
            Family::of(&designs)?
        };
        let machine = &members[0].2;
        let strobes = strobes(machine);
        let claims = claims.for_every_k(&members[0].1);
        let is_whole = family.ks().iter().copied().eq(LEAST_K..=GREATEST_K) && (1..LEAST_K).all(|k| member(k).is_ok());
        Ok(Subject { model, claims, family, strobes, any_preset: false, is_whole, members })
    }

    /// The family is of every k that coordinates have, but for the least, for which there is such hardware too.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// The same with remainder registers that start from any value: one more number of the geometry for each.
    #[must_use]
    pub fn with_any_preset(self) -> Subject {
        Subject { any_preset: true, ..self }
    }

    /// The hardware that claims are about: without presets where remainders start from any value.
    pub(super) fn claimed(&self) -> Hardware {
        let hardware = self.members[0].1.clone();
        let presets = if self.any_preset { Vec::new() } else { hardware.presets };
        Hardware { presets, ..hardware }
    }

    /// The same of the geometries that a box holds, where it is proved of more.
    #[must_use]
    pub fn of_box(self) -> Subject {
        let own = self.model.claims.map(|claims| claims.of_hardware(&self.members[0].1).geometries);
        Subject { claims: Claims { geometries: own.unwrap_or(self.claims.geometries), ..self.claims }, ..self }
    }

    /// The same [of a box](Subject::of_box), without what says only why a block ends, which widths do not depend on.
    #[must_use]
    pub fn of_widths(self) -> Subject {
        let own = self.of_box();
        Subject { claims: Claims { rank: |_| None, ends: |_| Vec::new(), ..own.claims }, ..own }
    }

    /// Remainder registers that start from any value; their load words are numbers of the geometry themselves.
    #[must_use]
    pub fn presets(&self) -> Vec<String> {
        let machine = &self.members[0].2;
        let remainders = machine.inputs.keys().filter(|register| register.starts_with("jr"));
        if self.any_preset { remainders.cloned().collect() } else { Vec::new() }
    }

    /// Registers that are loaded with any word, with the names and the greatest values of these words: numbers of the
    /// geometry themselves.
    pub(super) fn any_words(&self) -> Vec<(String, Symbol)> {
        let (_, hardware, machine) = &self.members[0];
        let presets = self.presets();
        let named = |register: &String| {
            let preset = presets.contains(register).then_some("preset");
            preset.or((self.claims.loaded_any)(hardware, register).then_some("loaded"))
        };
        let any = machine.inputs.keys().filter_map(|register| {
            let name = format!("{} {register}", named(register)?);
            Some((register.clone(), Symbol { name, least: number(0), greatest: self.mask(register) }))
        });
        any.collect()
    }

    /// The greatest number of the input of a register.
    fn mask(&self, register: &str) -> Formula {
        let bits = |member: &(u32, Hardware, Machine)| i64::from(member.2.inputs[register].width.get());
        let (k, own) = (i64::from(self.members[0].0), bits(&self.members[0]));
        let grows = self.members.get(1).is_some_and(|member| bits(member) > own);
        match own - k {
            _ if !grows => number((1_i128 << own) - 1),
            wider @ 0.. => name("2^k") * number(1 << wider) - 1,
            -1 => name("2^(k-1)") - 1,
            // More than it holds, which is cut as it is loaded.
            _ => name("2^k") - 1,
        }
    }

    /// The least and the greatest k of the family.
    #[must_use]
    pub fn ks(&self) -> (u32, u32) {
        let all = self.family.ks();
        (all.first().copied().unwrap_or(0), all.last().copied().unwrap_or(0))
    }

    /// The box in words, with what may be anything.
    #[must_use]
    pub fn about(&self) -> String {
        let mut about = self.claims.geometries.describe().to_owned();
        let presets = self.presets();
        let loaded = self.any_words().into_iter().map(|(register, _)| register).filter(|own| !presets.contains(own));
        let loaded: Vec<String> = loaded.collect();
        if !loaded.is_empty() {
            about += &format!(", whatever is loaded into {}", loaded.join(", "));
        }
        if !self.claims.free.is_empty() {
            about += &format!(", whatever {} are at any clock", self.claims.free.join(" and "));
        }
        about
    }

    /// The kinds of geometry that together are the box.
    #[must_use]
    pub fn kinds(&self) -> Vec<Kind> {
        self.claims.geometries.kinds()
    }

    /// Claims of no overflow by number: the component that each is about.
    #[must_use]
    pub fn claim(&self, number: usize) -> &str {
        self.family.design().netlist().properties.get(number).map_or("", |property| &property.name)
    }

    /// Attempts a proof for one kind of geometry.
    ///
    /// # Errors
    /// See [`ProofError`].
    pub fn prove(&self, kind: &Kind) -> Result<(Proof, Certificate), ProofError> {
        let (case, rows) = self.case(kind)?;
        Ok(prove::prove(&self.family, self.strobes, &case, &rows)?)
    }

    /// Checks the certificate of a kind of geometry.
    ///
    /// # Errors
    /// See [`ProofError`].
    pub fn check(&self, kind: &Kind, certificate: &Certificate) -> Result<Proof, ProofError> {
        let (case, _) = self.case(kind)?;
        Ok(prove::check(&self.family, self.strobes, &case, certificate)?)
    }

    /// Whether the invariants of a certificate hold in runs of up to `most` curves of k-bit coordinates; gives how many
    /// rows were looked at.
    ///
    /// # Errors
    /// See [`ProofError`].
    pub fn holds_in_runs(
        &self,
        kind: &Kind,
        certificate: &Certificate,
        k: u32,
        most: usize,
    ) -> Result<usize, ProofError> {
        let (case, _) = self.case(kind)?;
        let mut rows = Vec::new();
        for (curve, symbols) in self.claims.geometries.curves_of(kind, k).take(most) {
            let Some((_, hardware, machine)) = self.members.iter().find(|(other, ..)| *other == k) else { continue };
            let blocks = machine.encode(hardware, &self.model.words(hardware, &curve)?)?;
            let words = blocks.into_iter().next().unwrap_or_default();
            rows.extend(self::rows(k, &symbols, machine, &words));
        }
        match prove::violated(&self.family, self.strobes, &case, certificate, &rows)? {
            Some(invariant) => Err(ProofError::Untrue { kind: kind.name.clone(), invariant }),
            None => Ok(rows.len()),
        }
    }
}

/// The most designs in a row that are one circuit, this one among them.
fn alike(designs: &[(u32, Design)], at: Option<usize>) -> Range<usize> {
    let around = |at: usize| {
        let mut range = at..at + 1;
        while range.end < designs.len() && Family::of(&designs[range.start..=range.end]).is_ok() {
            range.end += 1;
        }
        while range.start > 0 && Family::of(&designs[range.start - 1..range.end]).is_ok() {
            range.start -= 1;
        }
        range
    };
    if let Some(at) = at {
        return around(at);
    }
    let (mut longest, mut next) = (0..0, 0);
    while next < designs.len() {
        let range = around(next);
        next = range.end;
        if range.len() > longest.len() {
            longest = range;
        }
    }
    longest
}

/// The nets by which a proof follows a block of a machine.
#[must_use]
pub fn strobes(machine: &Machine) -> Strobes {
    let [load, preset_position, loaded, stepped, done] =
        [machine.load, machine.preset_position, machine.loaded, machine.stepped, machine.done].map(|port| port.net);
    Strobes { load, preset_position, loaded, stepped, done }
}

#[cfg(test)]
mod tests;
