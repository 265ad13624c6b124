//! Obstacles of a proof: states that the invariants allow, and what a step from one of them must not do.
//! No run need reach such a state; but as long as the invariants allow it, nothing can be concluded from them.

use super::certificate::Certificate;
use super::family::Family;
use super::obligations::Invariants;
use super::poly::{Poly, Var};
use super::proof::{Row, in_words};
use super::system::{Case, CaseError, System, range};
use crate::Strobes;
use stepwave_netlist::cells::Net;

/// The invariants of an attempt, by which states and steps are judged.
#[derive(Clone, Debug)]
pub struct InvariantStates<'f> {
    system: System<'f>,
    invariants: Vec<Invariants>,
    relevant: Vec<Var>,
}

/// What every variable stands for.
type Values = Vec<i128>;

impl<'f> InvariantStates<'f> {
    /// The invariants that an attempt came to, and those of the author, kept or not.
    ///
    /// # Errors
    /// The case does not fit the netlist.
    pub fn new(
        family: &'f Family,
        strobes: Strobes,
        case: &Case,
        certificate: &Certificate,
    ) -> Result<InvariantStates<'f>, CaseError> {
        let system = System::new(family, strobes, case)?;
        let mut invariants = certificate.invariants.clone();
        for own in &mut invariants {
            let authored = &system.stated(&own.modes).authored;
            let lost: Vec<_> = authored.iter().filter(|(_, any)| !own.clauses.contains(any)).collect();
            own.clauses.extend(lost.into_iter().map(|(_, any)| any.clone()));
        }
        let mut relevant: Vec<Var> = system.relevant().into_iter().collect();
        relevant.sort_unstable();
        Ok(InvariantStates { system, invariants, relevant })
    }

    /// Shows states between two steps that the invariants allow, until `visit` says that it has seen enough. They are
    /// of the geometry of `usual`, a row of a run, and registers on which nothing depends hold what they hold there. Of
    /// more than `most` combinations of free values, that many are tried, spread over all.
    ///
    /// Gives how many states were shown.
    pub fn states(&self, usual: &Row, most: u64, mut visit: impl FnMut(&Row) -> bool) -> u64 {
        let mut shown = 0;
        for own in &self.invariants {
            let mut values = self.values(usual);
            for ((_, var), value) in self.system.modes.iter().zip(&own.modes) {
                values[var.index()] = *value;
            }
            let free = self.free(own, &values);
            let count = free.iter().fold(1_u128, |count, (_, least, greatest)| {
                count.saturating_mul((greatest - least + 1).max(0).unsigned_abs())
            });
            let tried = count.min(most.into());
            // By the golden section, so that no pattern of the numbers is met.
            let stride = if tried == count { 1 } else { (count / 1000).saturating_mul(618) | 1 };
            for place in 0..tried {
                let mut place = place.wrapping_mul(stride) % count;
                for (var, least, greatest) in &free {
                    let span = (greatest - least + 1).unsigned_abs();
                    values[var.index()] = least + i128::try_from(place % span).unwrap_or(0);
                    place /= span;
                }
                if self.complete(own, &mut values) {
                    shown += 1;
                    if visit(&self.row(usual, &values)) {
                        return shown;
                    }
                }
            }
        }
        shown
    }

    /// Something depends on this register.
    #[must_use]
    pub fn matters(&self, register: Net) -> bool {
        let bitwise = self.system.bitwise.iter().any(|(net, _)| *net == register);
        bitwise || self.system.registers.iter().any(|(net, var)| *net == register && self.relevant.contains(var))
    }

    /// What is wrong with a step that begins and ends in these states and overflows nowhere, in words; `None` where it
    /// is as it should be.
    #[must_use]
    pub fn judge(&self, before: &Row, after: &Row, done: bool) -> Option<String> {
        let (before, after) = (self.values(before), self.values(after));
        if done {
            let missed = self.system.goals.iter().find(|(_, any)| !is_any(any, &after));
            return missed.map(|(name, _)| format!("the block ends, but {name} does not hold"));
        }
        let held: Vec<i128> = self.system.modes.iter().map(|(_, var)| after[var.index()]).collect();
        let broken = self.system.stated(&held).authored.iter().find(|(_, any)| !is_any(any, &after));
        if let Some((name, any)) = broken {
            return Some(format!("{name} does not hold any more: {}", in_words(&self.system, any)));
        }
        let rank = self.system.rank.as_ref()?;
        let (before, after) = (rank.value(|var| before[var.index()])?, rank.value(|var| after[var.index()])?);
        (after >= before).then(|| format!("the steps that are left do not become less: {before}, then {after}"))
    }

    /// Variables that the invariants do not determine, with their least and greatest values.
    fn free(&self, own: &Invariants, values: &[i128]) -> Vec<(Var, i128, i128)> {
        let is_fixed = |var: Var| {
            own.equalities.iter().any(|(other, _)| *other == var) || self.system.modes.iter().any(|(_, m)| *m == var)
        };
        let value = |poly: &Poly| poly.value(|var| values[var.index()]).unwrap_or(0);
        let of_register = |(net, var): &(Net, Var)| {
            let (least, greatest) = range(self.system.family, *net);
            (*var, value(&least), value(&greatest))
        };
        let registers = self.system.registers.iter().filter(|(_, var)| self.relevant.contains(var)).map(of_register);
        let bits = self.system.bitwise.iter().flat_map(|(_, bits)| bits.iter().map(|bit| (*bit, 0, 1)));
        // More steps than a block of such coordinates takes.
        let steps = self.system.steps.map(|var| (var, 0, 4 * values[Family::SCALE.index()]));
        registers.chain(bits).chain(steps).filter(|(var, ..)| !is_fixed(*var)).collect()
    }

    /// Works out what the invariants determine; whether they all hold then, and every register holds its number.
    fn complete(&self, own: &Invariants, values: &mut Values) -> bool {
        for (var, poly) in &own.equalities {
            let Some(value) = poly.value(|other| values[other.index()]) else { return false };
            values[var.index()] = value;
        }
        let fits = |(net, var): &(Net, Var)| {
            let (least, greatest) = range(self.system.family, *net);
            is_any(&[Poly::from(*var).minus(&least)], values) && is_any(&[greatest.minus(&Poly::from(*var))], values)
        };
        let is_bit = |bit: &Var| (0..=1).contains(&values[bit.index()]);
        own.clauses.iter().all(|any| is_any(any, values))
            && self.system.bitwise.iter().all(|(_, bits)| bits.iter().all(is_bit))
            && self.system.registers.iter().all(fits)
    }

    fn values(&self, row: &Row) -> Values {
        self.system.row(self.system.family.scale_at(row.k), &row.symbols, &row.registers, row.steps)
    }

    /// The state of these values, of the geometry of another.
    fn row(&self, usual: &Row, values: &[i128]) -> Row {
        let held = |register: &Net| {
            let whole = self.system.registers.iter().find(|(net, _)| net == register);
            let bits = self.system.bitwise.iter().find(|(net, _)| net == register);
            match (whole, bits) {
                (Some((_, var)), _) => values[var.index()],
                (None, Some((_, bits))) => bits.iter().rev().fold(0, |number, bit| 2 * number + values[bit.index()]),
                (None, None) => 0,
            }
        };
        let registers = self.system.family.design().registers().iter().map(held).collect();
        let steps = self.system.steps.map_or(usual.steps, |var| values[var.index()]);
        Row { registers, steps, ..usual.clone() }
    }
}

/// One of these is 0 or more.
fn is_any(any: &[Poly], values: &[i128]) -> bool {
    any.iter().any(|poly| poly.value(|var| values[var.index()]).is_some_and(|number| number >= 0))
}
