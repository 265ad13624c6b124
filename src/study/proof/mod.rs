//! Proofs about models: the family of a model's netlists, recorded runs of each, and one attempt for each kind of
//! geometry.

mod counted;
mod counter;
mod file;
mod induction;
mod runs;
mod solver;

use std::collections::BTreeMap;

use stepwave_kernel::formula::{self, Formula};
use stepwave_kernel::prove::{
    self, Case, CaseError, Certificate, Family, FamilyError, Lost, Proof, Row, Strobes, Symbol,
};
use stepwave_kernel::{Design, Net, Width, did_you_mean};
use stepwave_models::{AXES, Choices, Claims, Hardware, Kind, Machine, Model, ModelError};
use stepwave_nc::Curve;

pub use counted::{Block, Way, blocks};
pub use counter::{Counterexample, Fault, search};
pub use file::{CertificateFile, FileError};
pub use induction::{CounterexampleToInduction, INDUCTION_KS, InductionSearch};
use runs::number;
pub use runs::{State, states};
pub use solver::{Answer, Question, SolverError, ask, question};

/// Why nothing can be attempted.
#[derive(Debug, thiserror::Error)]
pub enum ProofError {
    /// The model claims nothing.
    #[error(
        "{model} has no box of geometries over which something is claimed: `stepwave sweep` studies it by simulation"
    )]
    NoClaims {
        /// The model.
        model: &'static str,
    },
    /// There is no such box of geometries for the model.
    #[error("{0}")]
    Box(String),
    /// The hardware cannot be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Its netlists are no family.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// The claims do not fit the netlist.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The load word of an input is no formula of the geometry.
    #[error(
        "the load word {word} of {kind} is no polynomial of its geometry, so that nothing can be concluded from it"
    )]
    Word {
        /// The register.
        word: String,
        /// Kind of geometry.
        kind: String,
    },
    /// An invariant does not hold in a run: the proof is wrong.
    #[error("{kind}: {invariant} was proved, but a run shows that it does not hold")]
    Untrue {
        /// Kind of geometry.
        kind: String,
        /// The invariant.
        invariant: String,
    },
    /// A block cannot be followed to its end.
    #[error("{model} at k = {k}, {kind}: {lost}")]
    Lost {
        /// The model.
        model: &'static str,
        /// Bits of coordinates.
        k: u32,
        /// Kind of geometry.
        kind: String,
        /// Why.
        lost: Lost,
    },
    /// A counted register is not loaded with the way of its axis, bit by bit.
    #[error("{register} is not loaded with |d| in binary, so that its bits are not followed: leave --radix 10 out")]
    Counted {
        /// The register.
        register: String,
    },
    /// No curve of the kind was found.
    #[error("no geometry of the kind {kind} was found to learn from")]
    NoCurves {
        /// Kind of geometry.
        kind: String,
    },
}

/// Words of the loader, and what the symbols of the geometry are.
type Loaded = (Vec<(Net, u64)>, Vec<i128>);

/// Bits by which registers are narrower than by default, by name.
pub type Narrower = BTreeMap<String, u32>;

/// One hardware for every width.
#[derive(Debug)]
pub struct Subject {
    model: &'static Model,
    claims: Claims,
    family: Family,
    strobes: Strobes,
    /// Remainders start from any value.
    any_preset: bool,
    /// The machine of each k, in ascending order.
    members: Vec<(u32, Hardware, Machine)>,
}

/// Least k of a family: below, netlists lose cells.
const LEAST_K: u32 = 3;
/// The k whose netlists are all checked to be of one family.
const GREATEST_K: u32 = 52;
/// The k that are simulated to learn from, with how many curves of each kind.
const LEARNED: [(u32, usize); 4] = [(3, 60), (4, 40), (5, 30), (6, 12)];

/// The choices that make hardware for k-bit coordinates, some registers narrower than by default.
///
/// # Errors
/// There are no such geometries, or a register cannot be so narrow.
pub fn choices_at(
    model: &Model,
    claims: &Claims,
    choices: &Choices,
    narrower: &Narrower,
    k: u32,
) -> Result<Choices, ModelError> {
    let wide = Choices { width: Width::new(u64::from(k)).ok(), ..choices.clone() };
    if narrower.is_empty() {
        return Ok(wide);
    }
    let default = model.plan(&largest(claims, k)?, &wide)?;
    let mut widths = wide.widths.clone();
    for (given, bits) in narrower {
        // A register, or one of each axis: f, or jr for jrx, jry, ….
        let of_axis = |name: &str| AXES.iter().any(|axis| name.strip_suffix(axis) == Some(given.as_str()));
        let exact = default.widths.contains_key(given);
        let meant: Vec<_> =
            default.widths.iter().filter(|(name, _)| if exact { *name == given } else { of_axis(name) }).collect();
        if meant.is_empty() {
            let known: Vec<&str> = default.widths.keys().map(String::as_str).collect();
            return Err(ModelError::Widths(format!(
                "{} has no register {given} with a width to choose{}: give one of {}",
                model.name,
                did_you_mean(given, known.iter().copied()),
                known.join(", ")
            )));
        }
        for (register, own) in meant {
            let less = Width::new(u64::from(own.get().saturating_sub(*bits))).map_err(|_| {
                ModelError::Widths(format!("{}: {register} of {own} cannot be {bits} bits narrower", model.name))
            })?;
            widths.insert(register.clone(), less);
        }
    }
    Ok(Choices { widths, ..wide })
}

/// The geometry of k-bit coordinates that needs the widest registers.
fn largest(claims: &Claims, k: u32) -> Result<Curve, ModelError> {
    claims.geometries.largest(k).ok_or_else(|| ModelError::Widths(format!("there are no geometries of {k} bits")))
}

/// The rows of one run.
fn rows(k: u32, symbols: &[i128], machine: &Machine, words: &[(Net, u64)]) -> Vec<Row> {
    let row = |(steps, state): (i128, &State)| {
        let registers = machine.design.registers().iter().map(|register| state.number(machine, *register));
        Row { k, symbols: symbols.to_vec(), registers: registers.collect(), steps }
    };
    (0..).zip(&states(machine, words)).map(row).collect()
}

impl Subject {
    /// The hardware of a model for every k, with these choices beside the widths.
    ///
    /// # Errors
    /// The model claims nothing, a choice is impossible, or the netlists of several k differ in more than widths.
    pub fn new(model: &'static Model, choices: &Choices, narrower: &Narrower) -> Result<Subject, ProofError> {
        let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
        let mut members: Vec<(u32, Hardware, Machine)> = Vec::new();
        for k in LEAST_K..=GREATEST_K {
            let curve = largest(&claims, k)?;
            let built = choices_at(model, &claims, choices, narrower, k).and_then(|choices| {
                let hardware = model.plan(&curve, &choices)?;
                let machine = model.machine(&hardware)?;
                machine.encode(&hardware, &model.words(&hardware, &curve))?;
                Ok((k, hardware, machine))
            });
            match built {
                Ok(member) => members.push(member),
                // A fixed choice, such as a preset, may need more bits than the least k has; the widest may not be built.
                Err(ModelError::DoesNotFit { .. }) if members.is_empty() && k < LEAST_K + 8 => {}
                Err(_) if members.len() > 1 => break,
                Err(error) => return Err(error.into()),
            }
        }
        let designs: Vec<(u32, Design)> = members.iter().map(|(k, _, machine)| (*k, machine.design.clone())).collect();
        let family = Family::of(&designs)?;
        let machine = &members[0].2;
        let strobes = machine.strobes();
        let claims = claims.of_hardware(&members[0].1);
        Ok(Subject { model, claims, family, strobes, any_preset: false, members })
    }

    /// The same with remainder registers that start from any value: one more number of the geometry for each.
    #[must_use]
    pub fn with_any_preset(self) -> Subject {
        Subject { any_preset: true, ..self }
    }

    /// Remainder registers that start from any value; their load words are numbers of the geometry themselves.
    #[must_use]
    pub fn presets(&self) -> Vec<String> {
        let machine = &self.members[0].2;
        let remainders = machine.inputs.keys().filter(|register| register.starts_with("jr"));
        if self.any_preset { remainders.cloned().collect() } else { Vec::new() }
    }

    /// The least and the greatest k of the family.
    #[must_use]
    pub fn ks(&self) -> (u32, u32) {
        let all = self.family.ks();
        (all.first().copied().unwrap_or(0), all.last().copied().unwrap_or(0))
    }

    /// The box in words.
    #[must_use]
    pub fn about(&self) -> &'static str {
        self.claims.geometries.describe()
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
        let all = self.claims.geometries.curves(k, 4000);
        let own = all.iter().filter_map(|curve| Some((curve, self.claims.geometries.symbols(kind, curve)?)));
        let mut rows = Vec::new();
        for (curve, symbols) in own.take(most) {
            let Some((_, hardware, machine)) = self.members.iter().find(|(other, ..)| *other == k) else { continue };
            let blocks = machine.encode(hardware, &self.model.words(hardware, curve))?;
            let words = blocks.into_iter().next().unwrap_or_default();
            rows.extend(self::rows(k, &symbols, machine, &words));
        }
        match prove::violated(&self.family, self.strobes, &case, certificate, &rows)? {
            Some(invariant) => Err(ProofError::Untrue { kind: kind.name.clone(), invariant }),
            None => Ok(rows.len()),
        }
    }

    /// The kind with the words of its loader, and rows of recorded runs.
    fn case(&self, kind: &Kind) -> Result<(Case, Vec<Row>), ProofError> {
        let curves = self.curves(kind);
        let presets = self.presets();
        let mut rows = Vec::new();
        for (place, (member, curve, symbols)) in curves.iter().enumerate() {
            let Some((words, symbols)) = self.loaded(place, *member, curve, symbols)? else { continue };
            let (k, _, machine) = &self.members[*member];
            rows.extend(self::rows(*k, &symbols, machine, &words));
        }
        let any = |register: &String| Symbol {
            name: format!("preset {register}"),
            least: formula::number(0),
            greatest: formula::name("2^k") - 1,
        };
        let mut words = self.words(kind, &curves)?;
        for register in &presets {
            words.retain(|(input, _)| *input != format!("{register}_in"));
            words.push((format!("{register}_in"), formula::name(&format!("preset {register}"))));
        }
        let guesses = (self.claims.guesses)(&self.members[0].1);
        let case = Case {
            name: kind.name.clone(),
            symbols: kind.symbols.iter().cloned().chain(presets.iter().map(any)).collect(),
            constants: kind.constants.clone(),
            premises: kind.premises.clone(),
            words,
            goals: kind.goals.clone(),
            rank: (self.claims.rank)(&self.members[0].1),
            modes: self.claims.modes.iter().map(|mode| (*mode).to_owned()).collect(),
            bitwise: self.claims.bitwise.iter().map(|register| (*register).to_owned()).collect(),
            steps: (!guesses.is_empty()).then(|| "steps".to_owned()),
            guesses,
        };
        Ok((case, rows))
    }

    /// The words of the loader for a curve, and its symbols with the presets that were chosen for it by its `place` among
    /// others; `None` where there is nothing to load.
    fn loaded(
        &self,
        place: usize,
        member: usize,
        curve: &Curve,
        symbols: &[i128],
    ) -> Result<Option<Loaded>, ProofError> {
        let (_, hardware, machine) = &self.members[member];
        let blocks = machine.encode(hardware, &self.model.words(hardware, curve))?;
        // Several blocks are several loads; the first alone is that of the kind.
        let Some(mut words) = blocks.into_iter().next() else { return Ok(None) };
        let mut symbols = symbols.to_vec();
        for (number, register) in self.presets().iter().enumerate() {
            let port = machine.inputs[register];
            // Any values, spread over the register.
            let value = (place as u64 * 7919 + number as u64 * 104_729) & port.width.mask();
            words.retain(|(net, _)| *net != port.net);
            words.push((port.net, value));
            symbols.push(i128::from(value));
        }
        Ok(Some((words, symbols)))
    }

    /// Curves of a kind to learn from: place of the member, curve, symbols.
    fn curves(&self, kind: &Kind) -> Vec<(usize, Curve, Vec<i128>)> {
        let mut curves = Vec::new();
        for (k, most) in LEARNED {
            let Some(member) = self.members.iter().position(|(other, ..)| *other == k) else { continue };
            let all = self.claims.geometries.curves(k, 4000);
            let own = all.into_iter().filter_map(|curve| {
                let symbols = self.claims.geometries.symbols(kind, &curve)?;
                Some((member, curve, symbols))
            });
            curves.extend(own.take(most));
        }
        curves
    }

    /// What the loader puts on each input, as a formula of the geometry: learnt from its words, and compared with every
    /// one of them.
    fn words(&self, kind: &Kind, curves: &[(usize, Curve, Vec<i128>)]) -> Result<Vec<(String, Formula)>, ProofError> {
        let names: Vec<&str> =
            ["2^(k-1)"].into_iter().chain(kind.symbols.iter().map(|symbol| symbol.name.as_str())).collect();
        let mut samples: BTreeMap<&str, Vec<Vec<i128>>> = BTreeMap::new();
        for (member, curve, symbols) in curves {
            let (k, hardware, _) = &self.members[*member];
            let Some(words) = self.model.words(hardware, curve).into_iter().next() else { continue };
            for (register, value) in words {
                let row = [&[1_i128 << (k - 1)][..], symbols, &[value]].concat();
                samples.entry(register).or_default().push(row);
            }
        }
        if samples.is_empty() {
            return Err(ProofError::NoCurves { kind: kind.name.clone() });
        }
        let formula = |(register, rows): (&str, Vec<Vec<i128>>)| {
            let formula = prove::fit(&names, &rows)
                .ok_or_else(|| ProofError::Word { word: register.to_owned(), kind: kind.name.clone() })?;
            Ok((format!("{register}_in"), formula))
        };
        samples.into_iter().map(formula).collect()
    }
}
