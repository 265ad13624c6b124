//! What is to be proved of a netlist: a case of geometries and how the loader states it, invariants, goals.

use std::collections::HashSet;

use stepwave_netlist::bits::Reading;
use stepwave_netlist::cells::{Net, Op};
use stepwave_netlist::formula::{ByMode, Clause, Formula, Symbol};

use super::family::{Bits, Family};
use super::poly::{Poly, Var};
use super::proof::Row;
use super::variables::Variables;
use crate::Strobes;

/// Geometries of one kind, the words that the loader gives the netlist for them, and what is to come of it. Formulas
/// may use the symbols, `2^k` (one more than the greatest coordinate) and `2^(k-1)`, and, but for premises and words,
/// registers by their names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Case {
    /// What distinguishes it from the others.
    pub name: String,
    /// The numbers that describe a geometry.
    pub symbols: Vec<Symbol>,
    /// Names for numbers that are the same for all geometries of the case.
    pub constants: Vec<(String, i128)>,
    /// What else is true of them.
    pub premises: Vec<Clause>,
    /// The word on each input, by the input's name.
    pub words: Vec<(String, Formula)>,
    /// Inputs that may change at any clock: what is proved does not depend on them.
    pub free: Vec<String>,
    /// What holds when the block is done.
    pub goals: Vec<Clause>,
    /// Never below 0 while the block runs, and less after every step.
    pub rank: Option<Formula>,
    /// Registers of one or two bits that change what the others mean: each combination of their values has invariants of
    /// its own.
    pub modes: Vec<String>,
    /// Names for numbers that are others in other modes; for guesses and for what the netlist's author claims.
    pub by_mode: Vec<ByMode>,
    /// How often the modes have changed since the load is a mode too, which no register holds: what holds in a quadrant
    /// may be something else when an arc comes to it again.
    pub counts_changes: bool,
    /// Registers of fixed width that are held bit by bit.
    pub bitwise: Vec<String>,
    /// A name for the number of steps that the block has taken, which no register holds.
    pub steps: Option<String>,
    /// What may hold between two steps; not believed, but left out where it does not.
    pub guesses: Vec<Clause>,
}

/// What cannot be stated of a netlist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CaseError {
    /// A formula uses an unknown name.
    #[error("the case '{case}': nothing bears the name '{name}'")]
    UnknownName {
        /// The case.
        case: String,
        /// The name.
        name: String,
    },
    /// An input gets no word.
    #[error("the case '{case}' gives no word for the input '{name}'")]
    NoWord {
        /// The case.
        case: String,
        /// The input.
        name: String,
    },
    /// There are more unknowns than can be numbered.
    #[error("the case '{case}' has too many unknowns")]
    TooLarge {
        /// The case.
        case: String,
    },
}

/// A case bound to a family of netlists: every name is a variable.
#[derive(Clone, Debug)]
pub(crate) struct System<'f> {
    pub(crate) family: &'f Family,
    pub(crate) strobes: Strobes,
    pub(crate) variables: Variables,
    pub(crate) symbols: Vec<Var>,
    /// Registers and the variables of what they hold in a row.
    pub(crate) registers: Vec<(Net, Var)>,
    /// Registers that are held bit by bit, with their bits from the lowest on.
    pub(crate) bitwise: Vec<(Net, Vec<Var>)>,
    pub(crate) premises: Vec<Vec<Poly>>,
    pub(crate) words: Vec<(Net, Poly)>,
    pub(crate) goals: Vec<(String, Vec<Poly>)>,
    pub(crate) rank: Option<Poly>,
    pub(crate) modes: Vec<(Net, Var)>,
    /// A further mode is how often these have changed from row to row.
    counts_changes: bool,
    /// The number of steps that the block has taken.
    pub(crate) steps: Option<Var>,
    /// What is stated of every combination of values of the mode registers.
    stated: Vec<(Vec<i128>, Stated)>,
}

/// What may hold in each row of some modes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stated {
    /// Invariants of the netlist's author.
    pub(crate) authored: Vec<(String, Vec<Poly>)>,
    /// What else may be an invariant.
    pub(crate) guesses: Vec<Vec<Poly>>,
}

static NOTHING: Stated = Stated { authored: Vec::new(), guesses: Vec::new() };

impl<'f> System<'f> {
    pub(crate) fn new(family: &'f Family, strobes: Strobes, case: &Case) -> Result<System<'f>, CaseError> {
        let too_large = || CaseError::TooLarge { case: case.name.clone() };
        let mut variables =
            Variables::new(family.scale_name(), if family.ks().len() == 1 { 1 } else { family.least_scale() });
        let mut symbols = Vec::new();
        for symbol in &case.symbols {
            let bound = |formula| poly(formula, case, family, &variables);
            let (least, greatest) = (bound(&symbol.least)?, bound(&symbol.greatest)?);
            symbols.push(variables.add(symbol.name.clone(), Some(least), Some(greatest)).ok_or_else(too_large)?);
        }
        let words = load_words(family, strobes, case, &variables)?;
        let premises: Result<_, CaseError> = case
            .premises
            .iter()
            .map(|clause| clause.any.iter().map(|formula| poly(formula, case, family, &variables)).collect())
            .collect();
        let (registers, bitwise) = registers(family, case, &mut variables)?;
        let steps = case.steps.clone().map(|name| variables.add(name, Some(Poly::from(0)), None).ok_or_else(too_large));
        let steps = steps.transpose()?;
        let goals = clauses(&case.goals, case, family, &variables, &[])?;
        let modes = modes(family, case, &variables, &registers)?;
        let stated = stated(family, case, &variables, &modes)?;
        Ok(System {
            family,
            strobes,
            premises: premises?,
            words,
            goals,
            rank: case.rank.as_ref().map(|formula| poly(formula, case, family, &variables)).transpose()?,
            modes,
            counts_changes: case.counts_changes,
            steps,
            stated,
            variables,
            symbols,
            registers,
            bitwise,
        })
    }

    /// What is stated of these modes.
    pub(crate) fn stated(&self, modes: &[i128]) -> &Stated {
        let held = &modes[..self.modes.len().min(modes.len())];
        self.stated.iter().find(|(own, _)| own == held).map_or(&NOTHING, |(_, stated)| stated)
    }

    /// Numbers that tell the modes of a row.
    pub(crate) fn count_modes(&self) -> usize {
        self.modes.len() + usize::from(self.counts_changes)
    }

    /// The modes of a row whose mode registers hold these numbers, after a row of the modes `before`, or the first one.
    pub(crate) fn after(&self, before: Option<&[i128]>, held: Vec<i128>) -> Vec<i128> {
        let mut modes = held;
        if self.counts_changes {
            let changes = before
                .and_then(<[i128]>::split_last)
                .map_or(0, |(changes, before)| changes.saturating_add(i128::from(*before != modes[..])));
            modes.push(changes);
        }
        modes
    }

    /// The modes of the rows of runs, one run after the other, each from its first row on.
    pub(crate) fn modes_of(&self, rows: &[Row]) -> Vec<(Vec<i128>, Vec<i128>)> {
        let mut before: Option<Vec<i128>> = None;
        let one = |row: &Row| {
            let values = self.row(self.family.scale_at(row.k), &row.symbols, &row.registers, row.steps);
            let held = self.modes.iter().map(|(_, var)| values[var.index()]).collect();
            let modes = self.after(before.as_deref().filter(|_| row.steps > 0), held);
            before = Some(modes.clone());
            (modes, values)
        };
        rows.iter().map(one).collect()
    }

    /// The modes in words, for what holds in them: `quad = 1: changes = 2: `.
    pub(crate) fn in_modes(&self, modes: &[i128]) -> String {
        let names = self.modes.iter().map(|(_, var)| self.variables.name(*var));
        let names = names.chain(self.counts_changes.then(|| "changes".to_owned()));
        names.zip(modes).map(|(name, value)| format!("{name} = {value}: ")).collect()
    }

    /// The variables of registers on which claims, goals and strobes depend, directly or over some clocks.
    pub(crate) fn relevant(&self) -> HashSet<Var> {
        let netlist = self.family.netlist();
        let next = |net: Net| match netlist.cell(net).op {
            Op::Register { next, .. } => next,
            _ => None,
        };
        let named = self.goals.iter().flat_map(|(_, any)| any).chain(&self.rank).flat_map(Poly::vars);
        let wanted: HashSet<Var> = named.collect();
        let registers = self.registers.iter().filter(|(_, var)| wanted.contains(var)).map(|(register, _)| *register);
        let strobes = [self.strobes.loaded, self.strobes.stepped, self.strobes.done];
        let mut open: Vec<Net> = netlist.properties.iter().map(|property| property.never).collect();
        open.extend(registers.chain(self.modes.iter().map(|(register, _)| *register)));
        open.extend(strobes.into_iter().filter_map(next));
        let mut seen = HashSet::new();
        while let Some(net) = open.pop() {
            if seen.insert(net) {
                netlist.cell(net).op.visit_inputs(|input| open.push(input));
                open.extend(next(net));
            }
        }
        self.registers.iter().filter(|(register, _)| seen.contains(register)).map(|(_, var)| *var).collect()
    }

    /// A register is read in two's complement.
    pub(crate) fn is_signed(&self, register: Net) -> bool {
        is_signed(self.family, register)
    }

    /// Every variable that a row of a run has a value for, in order: the scale, the symbols, the registers, their bits,
    /// the steps taken.
    pub(crate) fn row(&self, scale: i128, symbols: &[i128], registers: &[i128], steps: i128) -> Vec<i128> {
        let mut row = vec![0; self.variables.len()];
        row[Family::SCALE.index()] = scale;
        for (var, value) in self.symbols.iter().zip(symbols) {
            row[var.index()] = *value;
        }
        if let Some(var) = self.steps {
            row[var.index()] = steps;
        }
        let held = |register: Net| {
            let place = self.family.design().registers().iter().position(|other| *other == register);
            place.and_then(|place| registers.get(place)).copied().unwrap_or(0)
        };
        for (register, var) in &self.registers {
            row[var.index()] = held(*register);
        }
        for (register, bits) in &self.bitwise {
            for (place, bit) in bits.iter().enumerate() {
                row[bit.index()] = held(*register) >> place & 1;
            }
        }
        row
    }
}

fn is_signed(family: &Family, register: Net) -> bool {
    family.netlist().name_of(register).is_some_and(|named| named.format.reading() == Reading::Signed)
}

/// The words on the inputs while the block is loaded.
fn load_words(
    family: &Family,
    strobes: Strobes,
    case: &Case,
    variables: &Variables,
) -> Result<Vec<(Net, Poly)>, CaseError> {
    let netlist = family.netlist();
    let mut words: Vec<(Net, Poly)> = Vec::new();
    for &input in family.design().inputs() {
        let name = netlist.name_of(input).map(|named| named.name.clone()).unwrap_or_default();
        let word = if input == strobes.load || input == strobes.preset_position {
            Poly::from(1)
        } else if case.free.contains(&name) {
            // No number is known, at any clock.
            Poly::lost()
        } else {
            let no_word = || CaseError::NoWord { case: case.name.clone(), name: name.clone() };
            let (_, formula) = case.words.iter().find(|(given, _)| *given == name).ok_or_else(no_word)?;
            poly(formula, case, family, variables)?
        };
        words.push((input, word));
    }
    Ok(words)
}

/// Registers with the variables of what they hold, and those that are held bit by bit with the variables of their bits.
#[expect(clippy::type_complexity, reason = "two lists of the same registers")]
fn registers(
    family: &Family,
    case: &Case,
    variables: &mut Variables,
) -> Result<(Vec<(Net, Var)>, Vec<(Net, Vec<Var>)>), CaseError> {
    let netlist = family.netlist();
    let too_large = || CaseError::TooLarge { case: case.name.clone() };
    let (mut registers, mut bitwise) = (Vec::new(), Vec::new());
    for &register in family.design().registers() {
        let named = netlist.name_of(register);
        let name = named.map_or_else(|| format!("%{}", register.index()), |named| named.name.clone());
        let is_bitwise = case.bitwise.contains(&name);
        // A name that occurs twice is replaced by its path.
        let name = match (variables.find(&name), named) {
            (Some(_), Some(named)) => netlist.path(named),
            _ => name,
        };
        let width = family.width(register);
        if is_bitwise && !width.grows {
            let bit = |variables: &mut Variables, bit| {
                variables.add(format!("{name}.{bit}"), Some(Poly::from(0)), Some(Poly::from(1)))
            };
            let bits: Option<Vec<Var>> = (0..width.fixed).map(|place| bit(variables, place)).collect();
            bitwise.push((register, bits.ok_or_else(too_large)?));
            continue;
        }
        let (least, greatest) = range(family, register);
        let var = variables.add(name, Some(least), Some(greatest)).ok_or_else(too_large)?;
        registers.push((register, var));
    }
    Ok((registers, bitwise))
}

/// Least and greatest number in a register.
pub(super) fn range(family: &Family, register: Net) -> (Poly, Poly) {
    assert!(matches!(family.netlist().cell(register).op, Op::Register { .. }));
    let width = family.width(register);
    if is_signed(family, register) {
        let half = family.power(Bits { fixed: width.fixed - 1, ..width });
        (half.negated(), half.plus_number(-1))
    } else {
        (Poly::from(0), family.power(width).plus_number(-1))
    }
}

/// Most bits of a mode register.
const MOST_MODE_BITS: i64 = 2;

/// The mode registers.
fn modes(
    family: &Family,
    case: &Case,
    variables: &Variables,
    registers: &[(Net, Var)],
) -> Result<Vec<(Net, Var)>, CaseError> {
    let mode = |mode: &String| {
        let var = variables.find(mode);
        let is_small = |net: Net| !family.width(net).grows && family.width(net).fixed <= MOST_MODE_BITS;
        let found = registers.iter().find(|(net, other)| Some(*other) == var && is_small(*net));
        found.copied().ok_or_else(|| CaseError::UnknownName { case: case.name.clone(), name: mode.clone() })
    };
    case.modes.iter().map(mode).collect()
}

/// What the author of the netlist and the case state of every combination of values of the mode registers.
fn stated(
    family: &Family,
    case: &Case,
    variables: &Variables,
    modes: &[(Net, Var)],
) -> Result<Vec<(Vec<i128>, Stated)>, CaseError> {
    let mut combinations: Vec<Vec<i128>> = vec![Vec::new()];
    for (net, _) in modes {
        let count = 1_i128 << family.width(*net).fixed;
        combinations = combinations
            .into_iter()
            .flat_map(|held| (0..count).map(move |value| [&held[..], &[value]].concat()))
            .collect();
    }
    let one = |held: Vec<i128>| {
        let authored = clauses(&family.netlist().invariants, case, family, variables, &held)?;
        let guesses = clauses(&case.guesses, case, family, variables, &held)?;
        Ok((held, Stated { authored, guesses: guesses.into_iter().map(|(_, any)| any).collect() }))
    };
    combinations.into_iter().map(one).collect()
}

/// Clauses as polynomials of variables where the mode registers hold these numbers; of none, in any modes.
fn clauses(
    all: &[Clause],
    case: &Case,
    family: &Family,
    variables: &Variables,
    held: &[i128],
) -> Result<Vec<(String, Vec<Poly>)>, CaseError> {
    let clause = |clause: &Clause| {
        let any = clause.any.iter().map(|formula| poly_in(formula, case, family, variables, held));
        Ok((clause.name.clone(), any.collect::<Result<_, CaseError>>()?))
    };
    all.iter().map(clause).collect()
}

/// A formula as a polynomial of variables, in any modes.
fn poly(formula: &Formula, case: &Case, family: &Family, variables: &Variables) -> Result<Poly, CaseError> {
    poly_in(formula, case, family, variables, &[])
}

/// A formula as a polynomial of variables where the mode registers hold these numbers.
fn poly_in(
    formula: &Formula,
    case: &Case,
    family: &Family,
    variables: &Variables,
    held: &[i128],
) -> Result<Poly, CaseError> {
    let by_mode = |name: &String| {
        let own = case.by_mode.iter().find(|own| own.name == *name)?;
        let (_, value) = case.modes.iter().zip(held).find(|(register, _)| **register == own.register)?;
        own.values.get(usize::try_from(*value).ok()?).copied()
    };
    let mut sum = Poly::from(0);
    for (product, coefficient) in formula.terms() {
        let mut term = Poly::from(coefficient);
        for name in product {
            let constant = case.constants.iter().find(|(other, _)| other == name).map(|(_, number)| *number);
            let factor = if name == "2^k" {
                family.two_to_k()
            } else if name == "2^(k-1)" {
                family.half()
            } else if let Some(number) = constant.or_else(|| by_mode(name)) {
                Poly::from(number)
            } else {
                let var = variables.find(name).filter(|var| *var != Family::SCALE);
                Poly::from(var.ok_or_else(|| CaseError::UnknownName { case: case.name.clone(), name: name.clone() })?)
            };
            term = term.times(&factor);
        }
        sum = sum.plus(&term);
    }
    Ok(sum)
}
