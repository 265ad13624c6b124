//! Overflow events: which component, which operands, what exactly, when, and how wide it would have had to be.

use std::fmt;

use serde::{Deserialize, Serialize};
use serde_json::json;
use stepwave_engine::Rows;
use stepwave_models::Machine;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_netlist::bits;
use stepwave_netlist::cells::{Arithmetic, Claim, Property};
use stepwave_netlist::{OnOverflow, Width, elaborate};

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
        /// Add or subtract.
        operation: Arithmetic,
        /// Value of the register.
        left: i128,
        /// What was added or subtracted.
        right: i128,
        /// Clock of the sample with the operands; the register would take the result at the next edge.
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
            OverflowEvent::Overflow { component, .. } | OverflowEvent::Invariant { component, .. } => component,
        }
    }

    /// Clock of the sample in which it was seen.
    #[must_use]
    pub fn clock(&self) -> u64 {
        match self {
            OverflowEvent::Overflow { clock, .. } | OverflowEvent::Invariant { clock, .. } => *clock,
        }
    }

    /// The exact result, and the width that would have held it.
    #[must_use]
    pub fn exact(&self) -> Option<(i128, u32)> {
        let OverflowEvent::Overflow { operation, left, right, signed, .. } = self else { return None };
        let exact = exact(*operation, *left, *right);
        Some((exact, Width::needed(exact, *signed)))
    }
}

impl fmt::Display for OverflowEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let OverflowEvent::Overflow { component, width, signed, operation, left, right, clock } = self else {
            return write!(f, "invariant {} does not hold at clock {}", self.component(), self.clock());
        };
        let (exact, needed) = self.exact().unwrap_or_default();
        let (least, greatest) = width.range(*signed);
        let sign = match operation {
            Arithmetic::Add => "+",
            Arithmetic::Sub => "-",
        };
        let right = if *right < 0 { format!("({right})") } else { right.to_string() };
        write!(
            f,
            "overflow of {component} at clock {clock}: {left} {sign} {right} = {exact} does not fit in its {width} \
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
                && matches!(property.claim, Claim::NoOverflow { operation, .. } if operation == *wanted)
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
}

struct Watched {
    property: Property,
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
        let needed = numbers(watched, seen).and_then(|(operation, left, right, signed)| {
            let exact = exact(operation, left, right);
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
        let netlist = bench.design().netlist();
        let at = |net| bench.columns().index(net);
        let watched = netlist.properties.iter().map(|property| {
            let operands = match property.claim {
                Claim::NoOverflow { left, right, .. } => {
                    Some((at(left.net), netlist.width(left.net), at(right.net), netlist.width(right.net)))
                }
                Claim::Invariant => None,
            };
            Watched { property: property.clone(), never: at(property.never), operands }
        });
        let mode = bench.hardware().get(&ON_OVERFLOW);
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
                None => found.push(OverflowTally { count: tally.count, first, needed: tally.needed }),
                Some(known) => {
                    known.count = known.count.saturating_add(tally.count);
                    known.needed = known.needed.zip(tally.needed).map(|(a, b)| a.max(b));
                    if first.clock() < known.first.clock() {
                        known.first = first;
                    }
                }
            }
        }
        found.sort_by_key(|tally| tally.first.clock());
        found
    }
}

fn exact(operation: Arithmetic, left: i128, right: i128) -> i128 {
    match operation {
        Arithmetic::Add => left + right,
        Arithmetic::Sub => left - right,
    }
}

/// Operation and operands of a strict cell as numbers, and the register's sign.
fn numbers(watched: &Watched, seen: &Seen) -> Option<(Arithmetic, i128, i128, bool)> {
    let Claim::NoOverflow { operation, left, right } = watched.property.claim else { return None };
    let ((_, width, _, right_width), (a, b)) = watched.operands.zip(seen.operands)?;
    let (a, b) = (bits::number(width, a, left.signed), bits::number(right_width, b, right.signed));
    Some((operation, a, b, left.signed))
}

fn event(watched: &Watched, seen: &Seen) -> OverflowEvent {
    let (component, clock) = (watched.property.name.clone(), seen.clock);
    match (numbers(watched, seen), watched.operands) {
        (Some((operation, left, right, signed)), Some((_, width, ..))) => {
            OverflowEvent::Overflow { component, width, signed, operation, left, right, clock }
        }
        _ => OverflowEvent::Invariant { component, clock },
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
