//! Overflow events: which component, which operands, what exactly, when, and how wide it would have had to be.

mod big;
mod tally;

use std::fmt;

use num_bigint::BigInt;

use serde::{Deserialize, Serialize};
use serde_json::json;
use stepwave_engine::{Rows, Wanted};
use stepwave_models::Machine;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_netlist::bits;
use stepwave_netlist::cells::{Claim, Operator, Property, Undefined, Word};
use stepwave_netlist::{Net, Netlist, OnOverflow, Width, elaborate};

use super::checkpoint::{GREATEST, Memory, recalled};
use super::{BlockReport, Columns, Observer, ObserverError, Testbench};
pub use tally::OverflowTally;

/// Events kept in full; further ones are counted.
const KEPT: usize = 100;

/// A property violated at one clock.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OverflowEvent {
    /// A strict cell whose exact result did not fit.
    Overflow {
        /// Path of the register.
        component: String,
        /// Its width.
        width: Width,
        /// Two's complement.
        signed: bool,
        /// What was computed.
        operation: Operator,
        /// Value of the register.
        left: i128,
        /// What was added or subtracted.
        right: i128,
        /// Clock of the sample with the operands; the register would take the result at the next edge.
        clock: u64,
    },
    /// A result of imported hardware, of more than 64 bits or of operands of as many, that did not fit.
    Wide {
        /// Path of the register.
        component: String,
        /// Bits that are kept.
        bits: u32,
        /// They are read as two's complement.
        signed: bool,
        /// What was computed.
        operation: Operator,
        /// First operand.
        left: BigInt,
        /// Second operand.
        right: BigInt,
        /// Clock of the sample.
        clock: u64,
    },
    /// Imported hardware took the result of an operation that has none.
    Undefined {
        /// Path of what takes it, or of the memory.
        component: String,
        /// The operation.
        undefined: Undefined,
        /// The dividend, or the address.
        operand: BigInt,
        /// Clock of the sample.
        clock: u64,
    },
    /// An invariant of the model that did not hold: a defect of the model.
    Invariant {
        /// Path of the invariant.
        component: String,
        /// Clock of the sample.
        clock: u64,
    },
}

impl OverflowEvent {
    /// Path of the component.
    #[must_use]
    pub fn component(&self) -> &str {
        match self {
            OverflowEvent::Overflow { component, .. }
            | OverflowEvent::Wide { component, .. }
            | OverflowEvent::Undefined { component, .. }
            | OverflowEvent::Invariant { component, .. } => component,
        }
    }

    /// Clock of the sample in which it was seen.
    #[must_use]
    pub fn clock(&self) -> u64 {
        match self {
            OverflowEvent::Overflow { clock, .. }
            | OverflowEvent::Wide { clock, .. }
            | OverflowEvent::Undefined { clock, .. }
            | OverflowEvent::Invariant { clock, .. } => *clock,
        }
    }

    /// The operation without a result that it is about.
    #[must_use]
    pub fn undefined(&self) -> Option<Undefined> {
        if let OverflowEvent::Undefined { undefined, .. } = self { Some(*undefined) } else { None }
    }

    /// The exact result, and the width that would have held it.
    #[must_use]
    pub fn exact(&self) -> Option<(i128, u32)> {
        let OverflowEvent::Overflow { operation, left, right, signed, .. } = self else { return None };
        let exact = operation.exact(*left, *right)?;
        Some((exact, Width::needed(exact, *signed)))
    }

    /// The exact result of a [`Wide`](OverflowEvent::Wide) one, where it has no more than 2^16 bits.
    #[must_use]
    pub fn exact_wide(&self) -> Option<BigInt> {
        let OverflowEvent::Wide { operation, left, right, .. } = self else { return None };
        big::exact(*operation, left, right)
    }

    /// Bits that would have held that result; `None` where none would.
    #[must_use]
    pub fn needed_wide(&self) -> Option<u64> {
        let OverflowEvent::Wide { signed, .. } = self else { return None };
        big::needed(&self.exact_wide()?, *signed)
    }
}

impl fmt::Display for OverflowEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (component, clock) = (self.component(), self.clock());
        match self {
            OverflowEvent::Overflow { width, signed, operation, left, right, .. } => {
                let (least, greatest) = width.range(*signed);
                let sum = [left, right].map(i128::to_string);
                let Some((exact, needed)) = self.exact() else {
                    let computed = computed(*operation, &sum);
                    return write!(f, "overflow of {component} at clock {clock}: {computed} has more than 127 bits");
                };
                let needed = (*signed || exact >= 0).then_some(u64::from(needed));
                let width = (width.to_string(), [least, greatest].map(|end| end.to_string()));
                sentence(f, self, &computed(*operation, &sum), &exact.to_string(), width, needed)
            }
            OverflowEvent::Wide { bits, signed, operation, left, right, .. } => {
                let sum = [left, right].map(BigInt::to_string);
                let Some(exact) = self.exact_wide() else {
                    let (computed, most) = (computed(*operation, &sum), big::MOST_BITS);
                    return write!(f, "overflow of {component} at clock {clock}: {computed} has more than {most} bits");
                };
                let width = (format!("{bits} bits"), big::range(*bits, *signed).map(|end| end.to_string()));
                let needed = big::needed(&exact, *signed);
                sentence(f, self, &computed(*operation, &sum), &exact.to_string(), width, needed)
            }
            OverflowEvent::Undefined { undefined, operand, .. } => match undefined.memory() {
                None => {
                    let sign = if *undefined == Undefined::Quotient { '/' } else { '%' };
                    write!(f, "division by zero of {component} at clock {clock}: {operand} {sign} 0")
                }
                Some((first, words)) => {
                    let (name, last) = (undefined.name(), u128::from(first) + u128::from(words) - 1);
                    write!(
                        f,
                        "{name} outside of {component} at clock {clock}: address {operand}; it has {words} words \
                         ({first} to {last})"
                    )
                }
            },
            OverflowEvent::Invariant { .. } => write!(f, "invariant {component} does not hold at clock {clock}"),
        }
    }
}

/// An operation in figures.
fn computed(operation: Operator, [left, right]: &[String; 2]) -> String {
    let in_brackets = |value: &String| if value.starts_with('-') { format!("({value})") } else { value.clone() };
    match operation {
        Operator::Neg => format!("-{}", in_brackets(left)),
        _ => format!("{left} {} {}", operation.sign(), in_brackets(right)),
    }
}

/// What was computed does not fit: with the exact result, the width and its least and greatest number, and the bits that
/// would hold it.
fn sentence(
    f: &mut fmt::Formatter<'_>,
    event: &OverflowEvent,
    computed: &str,
    exact: &str,
    (width, [least, greatest]): (String, [String; 2]),
    needed: Option<u64>,
) -> fmt::Result {
    let (component, clock) = (event.component(), event.clock());
    write!(
        f,
        "overflow of {component} at clock {clock}: {computed} = {exact} does not fit in its {width} \
         ({least} to {greatest}); "
    )?;
    match needed {
        None => f.write_str("no unsigned width would hold it"),
        Some(needed) => write!(f, "{needed} bits would hold it"),
    }
}

impl Testbench {
    /// The same bench with a scope `trap` in its waves that shows the operands and the exact result of the cell that an
    /// event is about; `None` where they cannot be shown.
    #[must_use]
    pub fn showing(&self, event: &OverflowEvent) -> Option<Testbench> {
        let OverflowEvent::Overflow { component, operation: wanted, .. } = event else { return None };
        let netlist = self.design().netlist();
        let of_event = |property: &&Property| {
            property.name == *component
                && matches!(property.claim, Claim::NoOverflow { operation, .. } if Operator::from(operation) == *wanted)
        };
        let shown = netlist.showing_operands(netlist.properties.iter().find(of_event)?)?;
        let machine = Machine { design: elaborate(shown).ok()?, ..self.machine().clone() };
        let columns = Columns::of(&machine);
        let bench = Testbench { machine, columns, ..self.clone() };
        let Some(before) = self.running() else { return Some(bench) };
        let bench = bench.leaving_out_phase();
        // An operand that runs with the phase is shown, so that nothing may be passed over.
        let alike = bench.running().is_some_and(|running| running.nets == before.nets);
        Some(if alike { bench } else { Testbench { running: Some(before.clone()), every_sample: true, ..bench } })
    }
}

struct Watched {
    property: Property,
    source: Option<String>,
    never: usize,
    operands: Operands,
}

/// Where the operands of a property are: the columns and widths of two nets, or of two words of which one, or the result,
/// has more than 64 bits.
enum Operands {
    None,
    Nets(usize, Width, usize, Width),
    Words([Vec<(usize, u32)>; 2]),
}

/// A violation as it was seen.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Seen {
    property: usize,
    clock: u64,
    /// Bits of both operands, where the property has some.
    operands: Option<(u64, u64)>,
    /// Those of words: of all nets of the first, then of the second.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    words: Vec<u64>,
}

/// The violations of one property.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Tally {
    count: u64,
    first: Option<Seen>,
    /// As in [`OverflowTally`]; 0 before the first.
    needed: Option<u32>,
    /// As in [`OverflowTally`], once the block is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    line: Option<u64>,
}

impl Tally {
    const NONE: Tally = Tally { count: 0, first: None, needed: Some(0), line: None };

    fn count(&mut self, watched: &Watched, seen: &Seen) {
        self.count += 1;
        let needed = match event(watched, seen) {
            OverflowEvent::Overflow { operation, left, right, signed, .. } => operation
                .exact(left, right)
                .and_then(|exact| (signed || exact >= 0).then(|| Width::needed(exact, signed))),
            OverflowEvent::Wide { operation, left, right, signed, .. } => big::exact(operation, &left, &right)
                .and_then(|exact| big::needed(&exact, signed))
                .and_then(|needed| u32::try_from(needed).ok()),
            OverflowEvent::Undefined { .. } | OverflowEvent::Invariant { .. } => None,
        };
        self.needed = self.needed.zip(needed).map(|(before, now)| before.max(now));
        if self.first.is_none() {
            self.first = Some(seen.clone());
        }
    }
}

/// Records the violations of every property.
pub struct OverflowWatch {
    watched: Vec<Watched>,
    /// Of each property.
    tallies: Vec<Tally>,
    /// The first of them.
    seen: Vec<Seen>,
    /// All of them.
    pub count: u64,
    /// What the strict cells do.
    pub mode: OnOverflow,
    /// The line of the program whose block runs.
    line: u64,
}

impl OverflowWatch {
    /// Watches every property of a machine.
    #[must_use]
    pub fn new(bench: &Testbench) -> OverflowWatch {
        let watch = OverflowWatch::of(bench.design().netlist(), bench.columns());
        OverflowWatch { mode: bench.hardware().get(&ON_OVERFLOW), ..watch }
    }

    /// Watches every property of a netlist whose strict cells wrap.
    #[must_use]
    pub fn of(netlist: &Netlist, columns: &Columns) -> OverflowWatch {
        let at = |net| columns.index(net);
        let reported = |property: &&Property| property.claim.is_goal();
        let watched = netlist.properties.iter().filter(reported).map(|property| {
            let pair = |a: Net, b: Net| Operands::Nets(at(a), netlist.width(a), at(b), netlist.width(b));
            let word = |word: &Word| word.nets.iter().map(|&net| (at(net), netlist.width(net).get())).collect();
            let operands = match &property.claim {
                Claim::NoOverflow { left, right, .. } => pair(left.net, right.net),
                Claim::Fits { left, right, bits, .. } => match (&left.nets[..], &right.nets[..]) {
                    ([a], [b]) if *bits <= Width::MAX.get() => pair(*a, *b),
                    _ => Operands::Words([word(left), word(right)]),
                },
                Claim::Defined { operand, .. } => Operands::Words([word(operand), Vec::new()]),
                Claim::Invariant | Claim::Assumption | Claim::Cover | Claim::Print { .. } => Operands::None,
            };
            let source = netlist.line_of(property.never);
            Watched { property: property.clone(), source, never: at(property.never), operands }
        });
        let mode = OnOverflow::Wrap;
        let watched: Vec<_> = watched.collect();
        OverflowWatch { tallies: vec![Tally::NONE; watched.len()], watched, seen: Vec::new(), count: 0, mode, line: 0 }
    }

    /// The first violations, in full.
    #[must_use]
    pub fn events(&self) -> Vec<OverflowEvent> {
        self.seen.iter().filter_map(|seen| Some(event(self.watched.get(seen.property)?, seen))).collect()
    }

    /// All violations, counted by component, the component that was first in front.
    #[must_use]
    pub fn tallies(&self) -> Vec<OverflowTally> {
        let mut found: Vec<OverflowTally> = Vec::new();
        for (watched, tally) in self.watched.iter().zip(&self.tallies) {
            let Some(first) = tally.first.as_ref().map(|seen| event(watched, seen)) else { continue };
            let alike = |known: &&mut OverflowTally| {
                known.first.component() == first.component() && known.first.undefined() == first.undefined()
            };
            match found.iter_mut().find(alike) {
                None => {
                    let (source, line) = (watched.source.clone(), tally.line.unwrap_or(self.line));
                    found.push(OverflowTally { count: tally.count, first, needed: tally.needed, source, line });
                }
                Some(known) => {
                    known.count = known.count.saturating_add(tally.count);
                    known.needed = known.needed.zip(tally.needed).map(|(a, b)| a.max(b));
                    if first.clock() < known.first.clock() {
                        known.first = first;
                        known.source.clone_from(&watched.source);
                        known.line = tally.line.unwrap_or(self.line);
                    }
                }
            }
        }
        found.sort_by_key(|tally| tally.first.clock());
        found
    }
}

fn event(watched: &Watched, seen: &Seen) -> OverflowEvent {
    let (component, clock) = (watched.property.name.clone(), seen.clock);
    let narrow = |signs: [bool; 2]| match (&watched.operands, seen.operands) {
        (Operands::Nets(_, a, _, b), Some((left, right))) => {
            Some((bits::number(*a, left, signs[0]), bits::number(*b, right, signs[1]), *a))
        }
        _ => None,
    };
    match &watched.property.claim {
        Claim::NoOverflow { operation, left, right } => {
            if let Some((a, b, width)) = narrow([left.signed, right.signed]) {
                let (operation, signed) = ((*operation).into(), left.signed);
                return OverflowEvent::Overflow { component, width, signed, operation, left: a, right: b, clock };
            }
        }
        Claim::Fits { operator, left, right, bits, signed, .. } => {
            let (operation, signed) = (*operator, *signed);
            let width = Width::new(u64::from(*bits)).unwrap_or(Width::MAX);
            if let Some((left, right, _)) = narrow([left.signed, right.signed]) {
                return OverflowEvent::Overflow { component, width, signed, operation, left, right, clock };
            }
            if let Operands::Words([a, b]) = &watched.operands {
                let (first, second) = seen.words.split_at(a.len().min(seen.words.len()));
                let [left, right] = [(left, a, first), (right, b, second)].map(|(word, columns, values)| {
                    let bits = columns.iter().map(|(_, bits)| bits).sum();
                    big::number(values, bits, word.signed)
                });
                return OverflowEvent::Wide { component, bits: *bits, signed, operation, left, right, clock };
            }
        }
        Claim::Defined { undefined, operand } => {
            if let Operands::Words([columns, _]) = &watched.operands {
                let bits = columns.iter().map(|(_, bits)| bits).sum();
                let operand = big::number(&seen.words, bits, operand.signed);
                return OverflowEvent::Undefined { component, undefined: *undefined, operand, clock };
            }
        }
        Claim::Invariant | Claim::Assumption | Claim::Cover | Claim::Print { .. } => {}
    }
    OverflowEvent::Invariant { component, clock }
}

impl Observer for OverflowWatch {
    fn wants_steps(&self) -> bool {
        false
    }

    fn remember(&self, memory: &mut Memory) {
        memory.insert("overflows".to_owned(), json!([self.count, self.seen, self.tallies]));
    }

    fn recall(&mut self, memory: &Memory) {
        let gathered: Option<(u64, Vec<Seen>, Vec<Tally>)> = recalled(memory, "overflows");
        let sound = |count: u64, tallies: &[Tally]| {
            let counts = || tallies.iter().map(|tally| tally.count).chain([count]);
            tallies.len() == self.watched.len() && counts().all(|count| count <= GREATEST)
        };
        if let Some((count, seen, tallies)) = gathered.filter(|(count, _, tallies)| sound(*count, tallies)) {
            (self.count, self.seen, self.tallies) = (count, seen, tallies);
        }
    }

    fn block_begun(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        // The samples up to here have been seen, and those of the block perhaps.
        let begun = |tally: &&mut Tally| tally.first.as_ref().is_some_and(|seen| seen.clock < block.begun);
        for tally in self.tallies.iter_mut().filter(begun) {
            tally.line.get_or_insert(self.line);
        }
        self.line = block.of.place.line;
        Ok(())
    }

    fn want(&mut self, _: &Testbench, wanted: &mut Wanted) -> bool {
        wanted.never.extend(self.watched.iter().map(|watched| watched.property.never));
        true
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        if !self.watched.iter().any(|watched| rows.any(watched.never)) {
            return Ok(());
        }
        for row in 0..rows.len() {
            for (property, watched) in self.watched.iter().enumerate() {
                if rows.value(watched.never, row) == 0 {
                    continue;
                }
                let (mut operands, mut words) = (None, Vec::new());
                match &watched.operands {
                    Operands::None => {}
                    Operands::Nets(a, _, b, _) => operands = Some((rows.value(*a, row), rows.value(*b, row))),
                    Operands::Words(both) => {
                        words.extend(both.iter().flatten().map(|(column, _)| rows.value(*column, row)));
                    }
                }
                let seen = Seen { property, clock: rows.clock(row), operands, words };
                self.count += 1;
                self.tallies[property].count(watched, &seen);
                if self.seen.len() < KEPT {
                    self.seen.push(seen);
                }
            }
        }
        Ok(())
    }
}
