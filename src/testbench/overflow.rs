//! Overflow events: which component, which operands, what exactly, when, and how wide it would have had to be.

use std::fmt;

use serde::{Deserialize, Serialize};
use serde_json::json;
use stepwave_engine::Rows;
use stepwave_models::Machine;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_netlist::bits;
use stepwave_netlist::cells::{Claim, Operator, Property, Source};
use stepwave_netlist::{Netlist, OnOverflow, Width, elaborate};

use super::checkpoint::{GREATEST, Memory, recalled};
use super::{Columns, Observer, ObserverError, Testbench};

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
        /// What was computed.
        operation: Operator,
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
            | OverflowEvent::Invariant { component, .. } => component,
        }
    }

    /// Clock of the sample in which it was seen.
    #[must_use]
    pub fn clock(&self) -> u64 {
        match self {
            OverflowEvent::Overflow { clock, .. }
            | OverflowEvent::Wide { clock, .. }
            | OverflowEvent::Invariant { clock, .. } => *clock,
        }
    }

    /// The exact result, and the width that would have held it.
    #[must_use]
    pub fn exact(&self) -> Option<(i128, u32)> {
        let OverflowEvent::Overflow { operation, left, right, signed, .. } = self else { return None };
        let exact = operation.exact(*left, *right)?;
        Some((exact, Width::needed(exact, *signed)))
    }
}

impl fmt::Display for OverflowEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let OverflowEvent::Wide { component, bits, operation, clock } = self {
            let name = operation.name();
            return write!(
                f,
                "overflow of {component} at clock {clock}: the exact result of {name} does not fit in {bits} bits"
            );
        }
        let OverflowEvent::Overflow { component, width, signed, operation, left, right, clock } = self else {
            return write!(f, "invariant {} does not hold at clock {}", self.component(), self.clock());
        };
        let (least, greatest) = width.range(*signed);
        let sign = operation.sign();
        let in_brackets = |value: i128| if value < 0 { format!("({value})") } else { value.to_string() };
        let computed = match operation {
            Operator::Neg => format!("-{}", in_brackets(*left)),
            _ => format!("{left} {sign} {}", in_brackets(*right)),
        };
        let Some((exact, needed)) = self.exact() else {
            return write!(f, "overflow of {component} at clock {clock}: {computed} has more than 127 bits");
        };
        write!(
            f,
            "overflow of {component} at clock {clock}: {computed} = {exact} does not fit in its {width} \
             ({least} to {greatest}); "
        )?;
        if exact < 0 && !signed {
            f.write_str("no unsigned width would hold it")
        } else {
            write!(f, "{needed} bits would hold it")
        }
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
        Some(Testbench { machine, columns, ..self.clone() })
    }
}

/// The violations of all properties of one component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverflowTally {
    /// How many.
    pub count: u64,
    /// The first.
    pub first: OverflowEvent,
    /// Width that would have held every exact result, if one would.
    pub needed: Option<u32>,
    /// `file:line` of the source of the first, of imported hardware.
    pub source: Option<String>,
}

impl OverflowTally {
    /// The first with the line of its source, how often there were others, and what would have held all of them.
    #[must_use]
    pub fn sentence(&self) -> String {
        let times = if self.count == 1 { "once".to_owned() } else { format!("{} times", self.count) };
        let needed = self.needed.filter(|_| self.count > 1);
        let all = needed.map_or_else(String::new, |bits| format!(", {bits} bits would hold all"));
        format!("{} ({times}{all})", self.placed())
    }

    /// It is of an assertion, and not of a result that did not fit.
    #[must_use]
    pub fn is_assertion(&self) -> bool {
        matches!(self.first, OverflowEvent::Invariant { .. })
    }

    /// The first, with the line of its source.
    #[must_use]
    pub fn placed(&self) -> String {
        match &self.source {
            Some(source) => format!("{source}: {}", self.first),
            None => self.first.to_string(),
        }
    }
}

struct Watched {
    property: Property,
    source: Option<String>,
    never: usize,
    operands: Option<(usize, Width, usize, Width)>,
}

/// A violation as it was seen.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Seen {
    property: usize,
    clock: u64,
    /// Bits of both operands, where the property has some.
    operands: Option<(u64, u64)>,
}

/// The violations of one property.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Tally {
    count: u64,
    first: Option<Seen>,
    /// As in [`OverflowTally`]; 0 before the first.
    needed: Option<u32>,
}

impl Tally {
    const NONE: Tally = Tally { count: 0, first: None, needed: Some(0) };

    fn count(&mut self, watched: &Watched, seen: &Seen) {
        self.count += 1;
        let needed = numbers(watched, seen).and_then(|(operation, left, right, _, signed)| {
            let exact = operation.exact(left, right)?;
            (signed || exact >= 0).then(|| Width::needed(exact, signed))
        });
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
            let operands = match property.claim {
                Claim::NoOverflow { left, right, .. } | Claim::Fits { left, right, .. } => {
                    Some((at(left.net), netlist.width(left.net), at(right.net), netlist.width(right.net)))
                }
                Claim::FitsWide { .. } | Claim::Invariant | Claim::Assumption | Claim::Cover => None,
            };
            let source = match netlist.sources.get(property.never.index()) {
                Some(Some(Source::File { file, line, .. })) => Some(format!("{file}:{line}")),
                _ => None,
            };
            Watched { property: property.clone(), source, never: at(property.never), operands }
        });
        let mode = OnOverflow::Wrap;
        let watched: Vec<_> = watched.collect();
        OverflowWatch { tallies: vec![Tally::NONE; watched.len()], watched, seen: Vec::new(), count: 0, mode }
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
            match found.iter_mut().find(|known| known.first.component() == first.component()) {
                None => {
                    let source = watched.source.clone();
                    found.push(OverflowTally { count: tally.count, first, needed: tally.needed, source });
                }
                Some(known) => {
                    known.count = known.count.saturating_add(tally.count);
                    known.needed = known.needed.zip(tally.needed).map(|(a, b)| a.max(b));
                    if first.clock() < known.first.clock() {
                        known.first = first;
                        known.source.clone_from(&watched.source);
                    }
                }
            }
        }
        found.sort_by_key(|tally| tally.first.clock());
        found
    }
}

/// What a property says of a result: the operator, both operands as numbers, the bits that are kept and their reading.
fn numbers(watched: &Watched, seen: &Seen) -> Option<(Operator, i128, i128, Width, bool)> {
    let ((_, left_width, _, right_width), (a, b)) = watched.operands.zip(seen.operands)?;
    let (operator, left, right, width, signed) = match watched.property.claim {
        Claim::NoOverflow { operation, left, right } => (operation.into(), left, right, left_width, left.signed),
        Claim::Fits { operator, left, right, width, signed, .. } => (operator, left, right, width, signed),
        Claim::FitsWide { .. } | Claim::Invariant | Claim::Assumption | Claim::Cover => return None,
    };
    let (a, b) = (bits::number(left_width, a, left.signed), bits::number(right_width, b, right.signed));
    Some((operator, a, b, width, signed))
}

fn event(watched: &Watched, seen: &Seen) -> OverflowEvent {
    let (component, clock) = (watched.property.name.clone(), seen.clock);
    match (numbers(watched, seen), watched.property.claim) {
        (Some((operation, left, right, width, signed)), _) => {
            OverflowEvent::Overflow { component, width, signed, operation, left, right, clock }
        }
        (None, Claim::FitsWide { operator, bits, .. }) => {
            OverflowEvent::Wide { component, bits, operation: operator, clock }
        }
        (None, _) => OverflowEvent::Invariant { component, clock },
    }
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

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        if !self.watched.iter().any(|watched| rows.any(watched.never)) {
            return Ok(());
        }
        for row in 0..rows.len() {
            for (property, watched) in self.watched.iter().enumerate() {
                if rows.value(watched.never, row) == 0 {
                    continue;
                }
                let operands = watched.operands.map(|(a, _, b, _)| (rows.value(a, row), rows.value(b, row)));
                let seen = Seen { property, clock: rows.clock(row), operands };
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
