//! Widths relative to k: proved for every k at once, and evaluated at any.

use std::ops::RangeInclusive;

use rayon::prelude::*;
use stepwave_models::{Hardware, Model, ModelError, Options};

use super::boxes::{Extent, Geometries, MOST_BITS, without_widths};
use super::proof::{Block, CountMethod, Narrower, ProofError, Subject, blocks, choices_at, hardware_at};
use super::widths::least_seen;

/// The k whose geometries are all simulated to find how wide registers must be; the first at which a choice, such as a
/// preset, fits is taken.
const FOUND: RangeInclusive<u32> = 5..=8;
/// The greatest k at which a block of a counted model is followed: it takes 2^k clocks.
const MOST_FOLLOWED: u32 = 16;

/// Widths that are enough for every geometry of coordinates of k bits, whatever k is: those by default, less this many
/// bits.
#[derive(Clone, Debug)]
pub struct KForm {
    model: &'static Model,
    choices: Options,
    narrower: Narrower,
    /// Each k needs a proof of its own.
    counted: bool,
    /// Those for which it is proved.
    ks: RangeInclusive<u32>,
}

impl KForm {
    /// The form of a model with these choices; `None` where none is proved. Widths among the choices are left out.
    ///
    /// # Errors
    /// The hardware cannot be built.
    pub fn of(model: &'static Model, choices: &Options) -> Result<Option<KForm>, ProofError> {
        let Some(claims) = model.claims else { return Ok(None) };
        let choices = without_widths(model, choices);
        let mut found = None;
        for k in FOUND {
            match Geometries::of(model, &choices, &Extent::Bits(k)) {
                Ok(geometries) => {
                    found = Some(least_seen(model, &geometries)?);
                    break;
                }
                Err(ProofError::Model(ModelError::DoesNotFit { .. })) => {}
                Err(error) => return Err(error),
            }
        }
        let Some(seen) = found else { return Ok(None) };
        let counted = !claims.counted.is_empty();
        let narrower = seen.iter().map(|(name, given, needed)| (name.clone(), given.saturating_sub(*needed)));
        let narrower: Narrower = narrower.filter(|(_, less)| *less > 0).collect();
        // Where not all of the registers can be as narrow at once, those by default may still be proved.
        for narrower in [narrower, Narrower::new()] {
            let ks = if counted { Some(1..=MOST_BITS) } else { proved_ks(model, &choices, &narrower) };
            if let Some(ks) = ks {
                return Ok(Some(KForm { model, choices, narrower, counted, ks }));
            }
        }
        Ok(None)
    }

    /// Hardware that is wide enough for every geometry of coordinates of `k` bits; `None` where it is not proved at
    /// this k.
    ///
    /// # Errors
    /// There is no such hardware.
    pub fn hardware(&self, k: u32) -> Result<Option<Hardware>, ProofError> {
        let Some(claims) = self.model.claims.filter(|_| self.ks.contains(&k)) else { return Ok(None) };
        if self.counted {
            let exact = |block: &Block| block.is_exact();
            let followed = k <= MOST_FOLLOWED
                && blocks(self.model, &claims, &self.choices, &self.narrower, k, CountMethod::Follow)
                    .is_ok_and(|blocks| blocks.iter().all(exact));
            if !followed {
                return Ok(None);
            }
        }
        let choices = choices_at(self.model, &claims, &self.choices, &self.narrower, k)?;
        Ok(Some(hardware_at(self.model, &claims, &choices, k)?))
    }

    /// It was proved for every k at once.
    #[must_use]
    pub fn is_for_every_k(&self) -> bool {
        !self.counted
    }
}

/// The k for which with registers as narrow as this nothing overflows and every end is reached; `None` of none.
fn proved_ks(model: &'static Model, choices: &Options, narrower: &Narrower) -> Option<RangeInclusive<u32>> {
    let subject = Subject::new(model, choices, narrower).ok()?.of_widths();
    let safe = |kind| subject.prove(&kind).is_ok_and(|(proof, _)| proof.is_safe());
    let (least, greatest) = subject.ks();
    subject.kinds().into_par_iter().all(safe).then_some(if subject.is_whole() {
        1..=greatest
    } else {
        least..=greatest
    })
}
