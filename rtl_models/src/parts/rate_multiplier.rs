//! The digital pulse multiplier, or rate multiplier: a counter whose stages offer pulses, and the gates by which a
//! coefficient lets them through.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Scope, Signal};

use super::Block;
use crate::options::Radix;
use crate::per_axis;
use crate::registers::{N, PerAxis, Reg};

/// Coefficients.
pub const COEFFICIENT: PerAxis = Reg::each(per_axis!("m"), N, "coefficient M of each axis, |d|").scaled();
/// The counter that all axes share.
pub const Q: Reg = Reg::new("q", N, "counter that all axes share");

/// The units that a counter is made of, each cascaded after the one before it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Units {
    /// Binary units, or decades.
    pub radix: Radix,
    /// Bits of each unit; a decade has 4.
    pub bits: u32,
    /// Number of units, at least one.
    pub count: u32,
}

/// A pulse that a stage offers.
#[derive(Clone, Debug)]
struct Stage<'m> {
    /// Number of the binary stage, or weight of the decimal bit that it belongs to.
    label: String,
    /// 1 bit: there is one at this edge.
    pulse: Signal<'m>,
}

/// A counter of cascaded units. At every edge with `step` = 1 it counts, and one of its stages offers a pulse, but for
/// the edge at which it goes from its last state to 0. A load sets it to 0.
///
/// The first unit counts every step, each further one only those that find all units before it in their last state. So
/// binary units count and pulse as one counter of all their bits does.
///
/// - Binary unit: stage k, from 0, pulses where it goes from 0 to 1: all stages below it are 1. Its names: `p` and k.
/// - Decade: four pulse trains, 8, 4, 2 and 1 of its ten counts, no two of which that a digit combines coincide: in the
///   counts 0 to 3 and 5 to 8; 1, 3, 5, 7; 2, 6; 4. Its names: `p` and the weight in the whole number.
#[derive(Clone, Debug)]
pub struct RateMultiplier<'m> {
    /// The one for the highest bit of a coefficient first.
    stages: Vec<Stage<'m>>,
    /// 1 bit: at this edge the counter goes from its last state to 0.
    pub carry: Signal<'m>,
}

/// One unit of it.
struct Unit<'m> {
    count: Signal<'m>,
    stages: Vec<Stage<'m>>,
    carry: Signal<'m>,
}

impl<'m> RateMultiplier<'m> {
    /// The counter `name` with its stages; several units have a scope each, `unit_1` the first, and their counters a
    /// number after the name. `step` is 1 bit.
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, name: &str, units: Units, step: Signal<'m>) -> RateMultiplier<'m> {
        let Units { radix, bits, count } = units;
        let mut whole: Option<Signal<'m>> = None;
        let mut counter = RateMultiplier { stages: Vec::new(), carry: step };
        for index in 0..count {
            let (scope, name) = match count {
                1 => (m, name.to_owned()),
                _ => (m.scope(&format!("unit_{}", index + 1)), format!("{name}{}", index + 1)),
            };
            let unit = match radix {
                Radix::Binary => binary(scope, block, &name, bits, index * bits, counter.carry),
                Radix::Decimal => decade(scope, block, &name, count - 1 - index, counter.carry),
            };
            whole = Some(whole.map_or(unit.count, |low| unit.count.concat(low)));
            counter.stages.extend(unit.stages);
            counter.carry = unit.carry;
        }
        if let Some(whole) = whole.filter(|_| count > 1) {
            m.show(name, whole, format(radix));
        }
        counter
    }

    /// The gates of one coefficient, in the scope `gates`: each bit lets the pulses of its stage through, the highest
    /// those of the fastest. Returns their OR, 1 bit: in a cycle of the counter as many pulses as the coefficient says,
    /// which is as wide as the counter.
    #[must_use]
    pub fn gated(&self, m: Scope<'m>, coefficient: Signal<'m>) -> Signal<'m> {
        let gates = m.scope("gates");
        let passed = self.stages.iter().zip((0..coefficient.bits()).rev());
        let passed =
            passed.map(|(Stage { label, pulse }, bit)| gates.name(&format!("g{label}"), *pulse & coefficient.bit(bit)));
        passed.reduce(|a, b| a | b).unwrap_or(self.carry)
    }
}

fn format(radix: Radix) -> Format {
    match radix {
        Radix::Binary => Format::Unsigned,
        Radix::Decimal => Format::Decimal,
    }
}

/// A synchronous binary counter of `bits` stages, the first of which is stage `first` of the whole.
fn binary<'m>(m: Scope<'m>, block: &Block<'m>, name: &str, bits: u32, first: u32, enable: Signal<'m>) -> Unit<'m> {
    let counter = m.reg(name, bits);
    let more = counter.q.wrapping_add(m.lit(bits, 1));
    counter.when(block.load, m.lit(bits, 0)).when(enable, more).else_hold();
    let mut ones_below = enable;
    let stages = (0..bits).map(|stage| {
        let (label, q) = ((first + stage).to_string(), counter.q.bit(stage));
        let pulse = m.name(&format!("p{label}"), ones_below & !q);
        ones_below = ones_below & q;
        Stage { label, pulse }
    });
    let stages = stages.collect();
    Unit { count: counter.q, stages, carry: m.name("carry", ones_below) }
}

/// A decade for the digit of 10^`exponent`.
fn decade<'m>(m: Scope<'m>, block: &Block<'m>, name: &str, exponent: u32, enable: Signal<'m>) -> Unit<'m> {
    let digit = m.reg(name, 4).shown(Format::Decimal);
    let [nine, four] = [9, 4].map(|count| digit.q.equals(m.lit(4, count)));
    let (zero, more) = (m.lit(4, 0), digit.q.wrapping_add(m.lit(4, 1)));
    digit.when(block.load, zero).when(enable, nine.mux(zero, more)).else_hold();
    let [q0, q1, _, q3] = [0, 1, 2, 3].map(|bit| digit.q.bit(bit));
    let trains = [(8, !four & !nine), (4, !q3 & q0), (2, !q3 & q1 & !q0), (1, four)];
    let stages = trains.into_iter().map(|(weight, train)| {
        let label = format!("{weight}{}", "0".repeat(exponent as usize));
        let pulse = m.name(&format!("p{label}"), enable & train);
        Stage { label, pulse }
    });
    let stages = stages.collect();
    Unit { count: digit.q, stages, carry: m.name("carry", enable & nine) }
}
