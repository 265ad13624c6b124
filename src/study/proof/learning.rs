//! What is learnt from runs: the words of the loader as formulas of the geometry, and rows to guess invariants from.

use std::collections::{BTreeMap, BTreeSet};

use stepwave_models::{Kind, Machine};
use stepwave_nc::Curve;
use stepwave_netlist::Net;
use stepwave_netlist::formula::{self, Formula};
use stepwave_prove::{self as prove, Case, Row};

use super::{ProofError, State, Subject, states};

/// Words of the loader, and what the symbols of the geometry are.
type Loaded = (Vec<(Net, u64)>, Vec<i128>);

/// The name of the number of steps that a block has taken.
const STEPS: &str = "steps";
/// How many of the least k have all of their geometries looked at for what the loader gives them.
const COMPARED: usize = 2;
/// How many curves of each kind are simulated to learn from, at each of the least k.
const LEARNED: [usize; 4] = [60, 40, 30, 12];

/// The rows of one run.
pub(super) fn rows(k: u32, symbols: &[i128], machine: &Machine, words: &[(Net, u64)]) -> Vec<Row> {
    let row = |(steps, state): (i128, &State)| {
        let registers = machine.design.registers().iter().map(|register| state.number(machine, *register));
        Row { k, symbols: symbols.to_vec(), registers: registers.collect(), steps }
    };
    (0..).zip(&states(machine, words)).map(row).collect()
}

impl Subject {
    /// The kind with the words of its loader, and rows of recorded runs.
    pub(super) fn case(&self, kind: &Kind) -> Result<(Case, Vec<Row>), ProofError> {
        let curves = self.curves(kind);
        let any = self.any_words();
        let mut rows = Vec::new();
        for (place, (member, curve, symbols)) in curves.iter().enumerate() {
            let Some((words, symbols)) = self.loaded(place, *member, curve, symbols)? else { continue };
            let (k, _, machine) = &self.members[*member];
            rows.extend(self::rows(*k, &symbols, machine, &words));
        }
        let mut words = self.words(kind, &curves)?;
        words.extend(any.iter().map(|(register, symbol)| (format!("{register}_in"), formula::name(&symbol.name))));
        let hardware = &self.claimed();
        let guesses = [(self.claims.guesses)(hardware, kind), (self.claims.ends)(hardware)].concat();
        let rank = (self.claims.rank)(hardware);
        let counts_steps =
            guesses.iter().flat_map(|clause| &clause.any).chain(&rank).any(|formula| formula.names().contains(&STEPS));
        let case = Case {
            name: kind.name.clone(),
            symbols: kind.symbols.iter().cloned().chain(any.into_iter().map(|(_, symbol)| symbol)).collect(),
            constants: kind.constants.clone(),
            premises: kind.premises.clone(),
            words,
            free: self.claims.free.iter().map(|input| (*input).to_owned()).collect(),
            goals: kind.goals.clone(),
            rank,
            modes: self.claims.modes.iter().map(|mode| mode.name().to_owned()).collect(),
            bitwise: self.claims.bitwise.iter().map(|register| register.name().to_owned()).collect(),
            by_mode: kind.by_mode.clone(),
            counts_changes: self.claims.counts_changes,
            steps: counts_steps.then(|| STEPS.to_owned()),
            guesses,
        };
        Ok((case, rows))
    }

    /// The words of the loader for a curve, and its symbols with the presets that were chosen for it by its `place` among
    /// others; `None` where there is nothing to load.
    pub(super) fn loaded(
        &self,
        place: usize,
        member: usize,
        curve: &Curve,
        symbols: &[i128],
    ) -> Result<Option<Loaded>, ProofError> {
        let (_, hardware, machine) = &self.members[member];
        let blocks = machine.encode(hardware, &self.model.words(hardware, curve)?)?;
        // Several blocks are several loads; the first alone is that of the kind.
        let Some(mut words) = blocks.into_iter().next() else { return Ok(None) };
        let mut symbols = symbols.to_vec();
        for (number, (register, _)) in self.any_words().iter().enumerate() {
            let port = machine.inputs[register];
            // Any values, spread over the register by multiples of the golden section.
            let spread = (place as u64 * 131 + number as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            let value = spread >> (64 - port.width.get());
            words.retain(|(net, _)| *net != port.net);
            words.push((port.net, value));
            symbols.push(i128::from(value));
        }
        Ok(Some((words, symbols)))
    }

    /// Curves of a kind to learn from: place of the member, curve, symbols.
    pub(super) fn curves(&self, kind: &Kind) -> Vec<(usize, Curve, Vec<i128>)> {
        let mut curves = Vec::new();
        for (member, most) in (0..self.members.len()).zip(LEARNED) {
            let k = self.members[member].0;
            let own = self.claims.geometries.curves_of(kind, k).map(|(curve, symbols)| (member, curve, symbols));
            curves.extend(own.take(most));
        }
        curves
    }

    /// What the loader puts on each input, as a formula of the geometry: learnt from its words for these curves, and compared
    /// with those for every geometry of the least widths.
    fn words(&self, kind: &Kind, curves: &[(usize, Curve, Vec<i128>)]) -> Result<Vec<(String, Formula)>, ProofError> {
        let names: Vec<&str> =
            ["2^(k-1)"].into_iter().chain(kind.symbols.iter().map(|symbol| symbol.name.as_str())).collect();
        let any: BTreeSet<String> = self.any_words().into_iter().map(|(register, _)| register).collect();
        let mut samples: BTreeMap<&str, Vec<Vec<i128>>> = BTreeMap::new();
        for (member, curve, symbols) in curves {
            let (k, hardware, _) = &self.members[*member];
            let Some(words) = self.model.words(hardware, curve)?.into_iter().next() else { continue };
            for (register, value) in words.into_iter().filter(|(register, _)| !any.contains(*register)) {
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
        let formulas: Vec<(String, Formula)> = samples.into_iter().map(formula).collect::<Result<_, ProofError>>()?;
        self.compare(kind, &formulas)?;
        Ok(formulas)
    }

    /// Refuses formulas that give another word than the loader for some geometry of the kind.
    fn compare(&self, kind: &Kind, formulas: &[(String, Formula)]) -> Result<(), ProofError> {
        for (k, hardware, _) in self.members.iter().take(COMPARED) {
            for (curve, symbols) in self.claims.geometries.curves_of(kind, *k) {
                let of_symbols = || kind.symbols.iter().map(|symbol| symbol.name.as_str()).zip(symbols.iter().copied());
                let value = |name: &str| of_symbols().chain([("2^(k-1)", 1 << (k - 1))]).find(|own| own.0 == name);
                let Some(words) = self.model.words(hardware, &curve)?.into_iter().next() else { continue };
                for (register, word) in words {
                    let own = formulas.iter().find(|(input, _)| input.strip_suffix("_in") == Some(register));
                    let given = own.map(|(_, formula)| formula.value(|name| value(name).map(|(_, number)| number)));
                    if given.is_some_and(|given| given != Some(word)) {
                        return Err(ProofError::Word { word: register.to_owned(), kind: kind.name.clone() });
                    }
                }
            }
        }
        Ok(())
    }
}
