//! `dpm-line`: digital pulse multiplier, or rate multiplier (数字脉冲乘法器), line of 2 to 6 axes.
//!
//! ```text
//!   clock ──► counter q, stages 0 … n-1 ──► carry ──► done
//!                │ one pulse line a stage
//!                ▼
//!   for each axis i:   p0 ──► & ◄── bit n-1 of mi
//!                      p1 ──► & ◄── bit n-2            ──► or ──► di ──► position i
//!                      …      …
//!                    pn-1 ──► & ◄── bit 0
//! ```
//!
//! One synchronous counter is shared by all axes. Stage k, from the lowest on, offers a pulse at the clock at which it
//! goes from 0 to 1, when all stages below it are 1: exactly one stage a clock, but for the clock that takes the
//! counter from all ones to 0. That carry ends the block after 2^n clocks. Stage k pulses in 2^(n-1-k) of them and is
//! gated by bit n-1-k of the coefficient, so that every axis gets as many pulses as its coefficient says. They are not
//! evenly spread: an axis may be up to (3n+7)/18 + (-1)^n/(9·2^n) pulses off the place t·M/2^n where it should be after
//! clock t. The report says how far it was, and the least and greatest distance of its pulses.
//!
//! **Cascade** (`--cascade BITS`, the *add* mode). The counter is made of units of this many bits. The first counts every
//! clock and holds the high bits of the coefficients; the word of each further one extends them below, and it counts
//! only in the state of all ones of the units before it, where these give no pulse. Unit by unit these are the stages
//! of one counter of all bits, so a cascade gives the same pulses at the same clocks as one unit of the same n; n is a
//! whole number of units.
//!
//! **Decades** (`--radix 10`). Coefficients are binary-coded decimal, a decade unit counts a digit, and a block lasts
//! 10^(digits) clocks. A decade has a pulse train for each bit of a digit: bit 8 in the counts 0 to 3 and 5 to 8, bit 4
//! in 1, 3, 5, 7, bit 2 in 2, 6, bit 1 in 4, and none in 9, where the next decade counts. Trains that meet (8 and 4, 8
//! and 2) belong to no common digit. These counts are a definition of this project; other decade rate multipliers
//! choose others. An axis is up to 7k/9 + 56/81·(1 - 10^(-k)) pulses off its place with k digits, and so far where all
//! of them are 7.
//!
//! **Feed override** (`--override PERCENT`, the *multiply* mode). Two decade units count every clock and gate their
//! pulses by the digits of the percentage; the line's own counter takes a step at their pulses only. A block needs
//! about 100/PERCENT times as many clocks for the same pulses in the same order.
//!
//! The line (5, 3) in 3 bits, from the golden file `waves/dpm-line-5-3.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/dpm-line-5-3.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Scope, Signal};

use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::{Hardware, Pace, modulus};
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{CASCADE, END_POINT, EndPoint, ON_OVERFLOW, OVERRIDE, RADIX, Radix, WIDTH};
use crate::parts::{Block, COEFFICIENT, POSITION, Q, RateMultiplier, SIGN, Units, axis_scope};
use crate::plan::Plan;
use crate::registers::{Reg, Rule, Where, With};
use crate::sizes;

const NAME: &str = "dpm-line";

/// The number of the feed override.
const PERCENT: Reg = Reg::new("percent", Rule::Bits(8), "the feed override, two decimal digits");
const O: Reg = Reg::new("o", Rule::Bits(8), "count of the feed override, two decimal digits").when(&OVERRIDDEN);
static OVERRIDDEN: With<Option<u64>> = With(&OVERRIDE, Option::is_some);
/// The counters of a cascade.
const Q_UNITS: Reg<64> = Reg::each(UNITS, Rule::Planned("BITS"), "counters of the units, the fastest first")
    .when(&CASCADED)
    .count(|plan| units_of(plan).count as usize);
static CASCADED: Where = Where("--cascade with fewer bits than n", is_cascaded);
static NOT_CASCADED: Where = Where("without --cascade, or with --cascade n", |plan| !is_cascaded(plan));
#[rustfmt::skip]
const UNITS: [&str; 64] = [
    "q1", "q2", "q3", "q4", "q5", "q6", "q7", "q8", "q9", "q10", "q11", "q12", "q13",
    "q14", "q15", "q16", "q17", "q18", "q19", "q20", "q21", "q22", "q23", "q24", "q25", "q26",
    "q27", "q28", "q29", "q30", "q31", "q32", "q33", "q34", "q35", "q36", "q37", "q38", "q39",
    "q40", "q41", "q42", "q43", "q44", "q45", "q46", "q47", "q48", "q49", "q50", "q51", "q52",
    "q53", "q54", "q55", "q56", "q57", "q58", "q59", "q60", "q61", "q62", "q63", "q64",
];

/// The units of the feed override.
const OVERRIDE_UNITS: Units = Units { radix: Radix::Decimal, bits: 4, count: 2 };

/// Digital pulse multiplier (rate multiplier), line of 2 to 6 axes.
pub static MODEL: Model = Model {
    name: NAME,
    title: "Digital pulse multiplier (rate multiplier), line of 2 to 6 axes",
    method: "digital pulse multiplier",
    source: "数字脉冲乘法器, the digital pulse multiplier of Chinese NC textbooks, known as binary rate multiplier; the \
             counts of a decade are a definition of this project",
    registers: &[
        &O,
        &Q.when(&NOT_CASCADED).follows(|plan| plan.get(&RADIX) == Radix::Decimal),
        &Q_UNITS,
        &COEFFICIENT,
        &POSITION,
    ],
    options: &[
        &WIDTH,
        &RADIX.only(
            Some(Radix::Binary),
            &[(Radix::Binary, ""), (Radix::Decimal, ": decade units, 4 bits a digit")],
            "",
        ),
        &CASCADE.about("BITS of each unit, of which n is a multiple (default: one unit)"),
        &OVERRIDE,
        &ON_OVERFLOW,
    ],
    claims: Some(Claims {
        rank: |_| None,
        counted: &[COEFFICIENT.of(0), COEFFICIENT.of(1)],
        ..Claims::of(Region::Lines)
    }),
    interpolates: Interpolates::Lines(6, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let n = size(plan, sizes::longest(line))?;
    let units = units(plan.get(&RADIX), plan.get(&CASCADE), n);
    let slower = plan.get(&OVERRIDE).is_some();
    plan.n = n;
    plan.set_each(Q_UNITS, units.bits).positions(sizes::end_positions(line));
    plan.fix(&END_POINT, EndPoint::Iterations);
    check_widths(plan, units)?;
    let n = plan.bits(COEFFICIENT.of(0));
    let clocks = u64::try_from(modulus(units.radix, n)).unwrap_or(u64::MAX);
    plan.stall_clocks = clocks.saturating_mul(if slower { 100 } else { 1 }).saturating_add(16);
    plan.pace = Pace::Cycle(COEFFICIENT.of(0));
    let bound = rate_bound(units.radix, n);
    plan.rate_bound = Some(bound);
    // The place where all axes should be lies on the line.
    plan.error_bound = Some((0..plan.axes()).fold(0.0, |sum, _| f64::hypot(sum, bound)));
    Ok(())
}

/// Bits of a coefficient: as chosen, or the least whole number of units that holds `largest`.
fn size(plan: &Plan, largest: u64) -> Result<u32, ModelError> {
    let refuse = |option, value, reason: String| ModelError::Value { model: NAME, option, value, reason };
    if let Some(percent) = plan.get(&OVERRIDE).filter(|percent| !(1..=99).contains(percent)) {
        let reason = "its two decades pass 1 to 99 of 100 clocks; leave it out for all of them".to_owned();
        return Err(refuse(OVERRIDE.name, percent.to_string(), reason));
    }
    let radix = plan.get(&RADIX);
    let unit = unit(radix, plan.get(&CASCADE));
    if let (Radix::Decimal, Some(bits)) = (radix, plan.get(&CASCADE)) {
        let reason = "decades are cascaded as they are, 4 bits a unit: leave --cascade or --radix 10 out".to_owned();
        return Err(refuse(CASCADE.name, bits.get().to_string(), reason));
    }
    let least = radix.reading().needed(largest.into()).next_multiple_of(unit);
    if plan.options().of_all(&WIDTH).is_none() && radix == Radix::Binary && least > Width::MAX.get() {
        let reason = format!(
            "this line needs registers of {least} bits in whole units, but a register holds 1 to 64 bits: give units of \
             fewer bits"
        );
        return Err(refuse(CASCADE.name, unit.to_string(), reason));
    }
    match plan.options().of_all(&WIDTH).map(Width::get) {
        Some(bits) if bits % unit != 0 => {
            let what = match radix {
                Radix::Binary => format!("units of {unit} bits"),
                Radix::Decimal => "decimal digits of 4 bits".to_owned(),
            };
            let more = Some(bits.next_multiple_of(unit)).filter(|&more| more <= Width::MAX.get());
            let whole = more.unwrap_or(bits - bits % unit);
            let reason = format!("it is no whole number of {what}; give --width {whole}");
            Err(refuse(WIDTH.name, bits.to_string(), reason))
        }
        Some(bits) => Ok(bits),
        None => Ok(least),
    }
}

/// What the bits of a counter must be a multiple of.
fn unit(radix: Radix, cascade: Option<Width>) -> u32 {
    match radix {
        Radix::Binary => cascade.map_or(1, Width::get),
        Radix::Decimal => 4,
    }
}

/// The units of a counter of `n` bits.
fn units(radix: Radix, cascade: Option<Width>, n: u32) -> Units {
    let whole = radix == Radix::Binary && cascade.is_none();
    let bits = if whole { n } else { unit(radix, cascade) };
    Units { radix, bits, count: n / bits }
}

fn is_cascaded(plan: &Plan) -> bool {
    units_of(plan).radix == Radix::Binary && units_of(plan).count > 1
}

fn units_of(plan: &Plan) -> Units {
    units(plan.get(&RADIX), plan.get(&CASCADE), plan.n)
}

/// Coefficients must be as wide as the counter, and units as wide as they are said to be.
fn check_widths(plan: &Plan, units: Units) -> Result<(), ModelError> {
    plan.check()?;
    let whole = units.radix == Radix::Binary && units.count == 1;
    let counter = if whole { plan.bits(Q) } else { units.bits * units.count };
    let cascaded = if units.radix == Radix::Binary && !whole { units.count as usize } else { 0 };
    let coefficients = (0..plan.axes()).map(|axis| (COEFFICIENT.of(axis), counter, "the counter has"));
    let of_units = (0..cascaded).map(|unit| (Q_UNITS.of(unit), units.bits, "each unit has"));
    let mut all: Vec<_> = coefficients.chain(of_units).collect();
    all.sort_by_key(|(register, ..)| register.name());
    let mut widest = counter;
    let mut odd = None;
    for (register, wanted, what) in all {
        let bits = plan.bits(register);
        if wanted == counter {
            widest = widest.max(bits);
        }
        if bits != wanted {
            let (name, s) = (register.name(), if bits == 1 { "" } else { "s" });
            odd = odd.or(Some(format!("{name} of {bits} bit{s}, but {what} {wanted}")));
        }
    }
    let unit = unit(plan.get(&RADIX), plan.get(&CASCADE));
    let all = Some(widest.next_multiple_of(unit)).filter(|&all| all <= Width::MAX.get()).unwrap_or(counter);
    odd.map_or(Ok(()), |odd| Err(ModelError::Widths(format!("{NAME}: {odd}: give --width {all}"))))
}

/// Greatest deviation of an axis from its uniform rate, in pulses, for every coefficient of `n` bits.
pub(crate) fn rate_bound(radix: Radix, n: u32) -> f64 {
    match radix {
        Radix::Binary => (3.0 * f64::from(n) + 7.0) / 18.0 + (-0.5_f64).powf(f64::from(n)) / 9.0,
        Radix::Decimal => {
            let digits = f64::from(n / 4);
            7.0 * digits / 9.0 + 56.0 / 81.0 * (1.0 - 0.1_f64.powf(digits))
        }
    }
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let step = match hardware.get(&OVERRIDE) {
        Some(_) => feed_override(m.scope("feed_override"), &block),
        None => block.busy,
    };
    let units = units(hardware.get(&RADIX), hardware.get(&CASCADE), hardware.bits(COEFFICIENT.of(0)));
    let counter = RateMultiplier::new(m.scope("counter"), &block, Q.name(), units, step);
    for axis in 0..hardware.axes {
        let (scope, own) = (axis_scope(m, axis), COEFFICIENT.of(axis));
        let coefficient = block.held_in(scope, hardware.get(&RADIX), own.name(), hardware.bits(own));
        let negative = hardware.held(scope, &block, SIGN.of(axis));
        let pulse = scope.name("pulse", counter.gated(scope, coefficient));
        hardware.axis(scope, &block, axis, pulse, negative);
    }
    block.close(block.load, step, counter.carry);
}

/// Two decades that pass a percentage of the clocks of a block: 1 bit, the line takes a step at this edge.
fn feed_override<'m>(m: Scope<'m>, block: &Block<'m>) -> Signal<'m> {
    let percent = block.held_in(m, Radix::Decimal, PERCENT.name(), OVERRIDE_UNITS.bits * OVERRIDE_UNITS.count);
    let counter = RateMultiplier::new(m, block, O.name(), OVERRIDE_UNITS, block.busy);
    m.name("feed", counter.gated(m, percent))
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let mut words = hardware.get(&OVERRIDE).map_or_else(Words::new, |percent| Words::new().set(PERCENT, percent));
    for (axis, delta) in line.delta().into_iter().enumerate() {
        words = words.set(COEFFICIENT.of(axis), i128::from(delta).abs()).set(SIGN.of(axis), delta < 0);
        words = words.set(POSITION.of(axis), line.from()[axis]);
    }
    vec![words]
}
