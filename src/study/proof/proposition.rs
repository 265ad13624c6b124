//! What is to be proved: a model, its options, and the geometries.

use std::fmt::Write as _;

use stepwave_models::options::{PRESET, WIDTH};
use stepwave_models::{Claims, Model, Options};

use super::{Fixed, Narrower, ProofError, Subject, choices_at, hardware_at};
use crate::study::Extent;
use crate::study::boxes::MOST_BITS;

/// That the hardware of a model keeps its claims for all geometries of a box: no register overflows, the end point is
/// reached exactly, every block ends.
///
/// ```
/// use stepwave::models::find;
/// use stepwave::proof::{Effort, Proposition, check};
///
/// let verdict = Proposition::of(find("ppc-line")?).prove(&Effort::default())?;
/// assert!(verdict.is_proved());
/// let certificate = verdict.certificate().ok_or("no certificate")?.to_string();
/// assert!(certificate.starts_with("stepwave certificate 1\nmodel ppc-line\nkind Q1\n"));
/// assert!(check(&certificate)?.is_proved());
///
/// let narrow = Proposition::of(find("ppc-line")?).narrower("f", 1).prove(&Effort::default())?;
/// let example = narrow.counterexample().ok_or("no counterexample")?;
/// assert_eq!(example.k, 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "nothing is proved before `prove`"]
pub struct Proposition {
    pub(crate) model: &'static Model,
    pub(crate) options: Options,
    /// The box that is given.
    pub(crate) extent: Option<Extent>,
    /// Remainder registers start from any value.
    pub(crate) any_preset: bool,
    pub(crate) narrower: Narrower,
}

impl Proposition {
    /// Of hardware as it is by default, for every k, the bits of coordinates.
    pub fn of(model: &'static Model) -> Proposition {
        Proposition { model, options: Options::default(), extent: None, any_preset: false, narrower: Narrower::new() }
    }

    /// With these options of the hardware; one that gives widths makes it one hardware.
    pub fn options(self, options: Options) -> Proposition {
        Proposition { options, ..self }
    }

    /// Of one hardware, and the geometries of this box.
    pub fn extent(self, extent: impl Into<Option<Extent>>) -> Proposition {
        Proposition { extent: extent.into(), ..self }
    }

    /// With remainder registers that start from any value.
    pub fn any_preset(self, any: bool) -> Proposition {
        Proposition { any_preset: any, ..self }
    }

    /// With a register by this many bits narrower than by default.
    pub fn narrower(mut self, register: &str, bits: u32) -> Proposition {
        self.narrower.insert(register.to_owned(), bits);
        self
    }

    /// The options of the hardware and the box, as words of a command line.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let any = self.any_preset.then(|| "--any-preset".to_owned());
        let extent = self.extent.iter().flat_map(|extent| {
            let extent = match extent {
                Extent::Bits(bits) => bits.to_string(),
                grid @ Extent::Grid(_) => grid.to_string(),
            };
            ["--box".to_owned(), extent]
        });
        self.options.words().into_iter().chain(any).chain(extent).collect()
    }

    /// The inverse of [`words`](Self::words); `None` for words in another order, or of anything else.
    pub(super) fn with_words(self, words: &[String]) -> Option<Proposition> {
        let mut rest = words;
        let extent = match rest {
            [before @ .., name, extent] if name == "--box" => {
                rest = before;
                Some(extent.parse().ok()?)
            }
            _ => None,
        };
        let any = rest.last().is_some_and(|word| word == "--any-preset");
        rest = &rest[..rest.len() - usize::from(any)];
        let options = Options::parse(rest.iter().map(String::as_str)).ok()?;
        let own = self.options(options).extent(extent).any_preset(any);
        (own.words() == words && (!any || own.options.get(&PRESET).is_none())).then_some(own)
    }

    /// The hardware in words: the model with its options, and the registers that are narrower than by default.
    #[must_use]
    pub fn hardware(&self) -> String {
        let mut words = [vec![self.model.name.to_owned()], self.words()].concat().join(" ");
        let narrower = self.narrower.iter().filter(|(_, bits)| **bits > 0);
        for (place, (register, bits)) in narrower.enumerate() {
            let and = if place > 0 { " and" } else { "" };
            let unit = if *bits == 1 { "bit" } else { "bits" };
            // Writing to a string cannot fail.
            let _ = write!(words, "{and} with {register} {bits} {unit} narrower");
        }
        words
    }

    /// What the model claims.
    ///
    /// # Errors
    /// It claims nothing.
    pub(crate) fn claims(&self) -> Result<Claims, ProofError> {
        self.model.claims.ok_or(ProofError::NoClaims { model: self.model.name })
    }

    /// What the model claims for every k of hardware with these options.
    ///
    /// # Errors
    /// It claims nothing.
    pub(crate) fn claims_for_every_k(&self) -> Result<Claims, ProofError> {
        let claims = self.claims()?;
        let hardware = |k| {
            let own = choices_at(self.model, &claims, &self.options, &self.narrower, k)?;
            hardware_at(self.model, &claims, &own, k)
        };
        // One k is as good as another, but a choice may need more bits than the least have.
        let any = (1..=MOST_BITS).find_map(|k| hardware(k).ok());
        Ok(any.map_or(claims, |hardware| claims.for_every_k(&hardware)))
    }

    /// The box that is given, or what coordinates of the width that is given for all registers hold.
    pub(crate) fn bounds(&self) -> Option<Extent> {
        let width = self.options.of_all(&WIDTH).filter(|_| self.model.width_is_of_coordinates());
        let of_width = || width.map(|width| Extent::Bits(width.get()));
        self.extent.clone().or_else(of_width)
    }

    /// It is about one hardware, and not about one for every k.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        self.bounds().is_some() || !self.options.of_single(&WIDTH).is_empty()
    }

    /// Refuses what is about hardware of every k where the widths are given, or about remainders where there are none.
    pub(super) fn check(&self) -> Result<(), ProofError> {
        let model = self.model.name;
        if self.is_fixed() && !self.narrower.is_empty() {
            return Err(ProofError::ForEveryK { option: "--narrower" });
        }
        match self.any_preset {
            true if self.is_fixed() => Err(ProofError::ForEveryK { option: "--any-preset" }),
            true if !self.claims()?.counted.is_empty() => Err(ProofError::NoRemainder { model }),
            _ => Ok(()),
        }
    }

    /// The hardware of given widths.
    pub(super) fn fixed(&self, extent: Extent) -> Result<Fixed, ProofError> {
        Fixed::new(self.model, &self.options, extent)
    }

    /// The hardware of every width.
    pub(super) fn subject(&self) -> Result<Subject, ProofError> {
        let subject = Subject::new(self.model, &self.options, &self.narrower)?;
        let subject = if self.any_preset { subject.with_any_preset() } else { subject };
        if self.any_preset && subject.presets().is_empty() {
            return Err(ProofError::NoRemainder { model: self.model.name });
        }
        Ok(subject)
    }
}
