//! `sampled-spline`: data sampling (数据采样法), NURBS: a coarse stage once a period, and a fine DDA between.
//!
//! ```text
//!   memories                coarse, one state after another                fine, 2^k additions in T
//!   wx, wy, w ──► d_0 … d_p ──► ┌────────────┐
//!   knots ──────► alpha ◄─────► │ multiplier │ ──► px, py ──► round ──► jvx_next ──► jvx ──► + ──► jrx ──┐
//!    ▲                          │ divider    │                         (buffer)              ▲───────────┘
//!    │    u, du ◄── state ◄───► │ root       │     less tx, ty ──────► jvy_next ──► jvy      │ carry ──► dx ──► x
//!    └── k, j, r                └────────────┘
//! ```
//!
//! A NURBS of degree p has n+1 control points with weights, and n+p+2 knots U. Knots and u have 32 bits of fraction, points
//! and weights q (`--fraction`, by default 8 more than the largest coordinate has): W is the weight times 2^q, rounded, and a
//! control point is held as (W·X, W·Y, W).
//!
//! - **A point** (de Boor): k is the last span that begins at u or before. The control points k-p to k are d_0 to d_p, and for
//!   r = 1 to p, j = p down to r: α = (u - lo)·2^32 / (hi - lo), of the knots lo = U_(j+k-p) and hi = U_(j+1+k-r), rounded
//!   down; d_j := d_(j-1) + (d_j - d_(j-1))·α / 2^32, rounded to the nearest. The point is (d_p.x, d_p.y)·2^q / d_p.w,
//!   rounded to the nearest.
//! - **A step** of the first order: from d_(p-1) and d_p as they are in front of the last level, g = p·(d_p - d_(p-1)) and
//!   N = g.xy·2^q - g.w·point. Along u the curve goes |N| a span, so that Δu = f·d_p.w·(U_(k+1) - U_k) / |N|, at least 1. The
//!   last period is the one that would come to the end of the knots or beyond it: it goes there, which is the last control
//!   point.
//! - **Chords**: where the point at the middle of the parameters, u + Δu/2, lies farther than `--tolerance` from the middle of
//!   the chord, Δu is halved, and again until it does not or Δu is 1. The report says what is left.
//!
//! By the first order a period goes f where the curve is evenly parametrised; on a circle it is off by up to about
//! 0.21·f²/R. A curve that rests somewhere (N = 0) is refused.
//!
//! The fine stage is that of [`sampled_arc`](crate::sampled_arc): it takes the points rounded to the nearest pulse, and 2^k
//! additions of a period are spread over T = 8 ms. The multiplier takes a bit of its multiplier a clock, the divider and the
//! root a bit of their result; numbers of more than 64 bits are parts under one name. `u` is in front of the points in the
//! step table, whose rows are the ends of periods.
//!
//! **Loading.** Control points and knots are in memories. A block with `store` = 1 writes one address of them and is done at
//! the next edge; the block with `store` = 0 runs the curve. The address of knot i holds control point i too.
//!
//! The recurrence is that of the project: de Boor's algorithm and a Taylor step, as in the papers on NURBS interpolators.
//! A quarter of the circle of 10 BLU with 4 BLU a period, from the golden file `waves/sampled-spline-quarter.csv`; the wave
//! is next to it:
//!
//! ```text
#![doc = include_str!("../waves/sampled-spline-quarter.csv")]
//! ```

use stepwave_nc::Nurbs;
use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use crate::docs::SAMPLED_WIDTH;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{FRACTION, Millionths, ON_OVERFLOW, PRESET, STEP, System, TOLERANCE};
use crate::parts::{BURST, Block, DISPLACEMENT, FineStage, JV, POINT, POSITION, STATE};
use crate::plan::Plan;
use crate::registers::{Reg, Rule};
use crate::sampling::Sampling;

use coarse::Coarse;
use recurrence::{Control, PLACE_FRACTION, Stuck, chord_limit};
use widths::Widths;

mod coarse;
mod recurrence;
mod widths;

const NAME: &str = "sampled-spline";

/// Where the period ends along the knots.
const U: Reg =
    Reg::new("u", Rule::Planned("32 and as the knots need"), "place u of the period's end, in 2^-32").follows(|_| true);
const DU: Reg = Reg::new("du", Rule::Planned("as u"), "step of u of the next period").inner();
const P_XY: Reg<2> =
    Reg::each(["px", "py"], Rule::Planned("n+1+q"), "coarse point that is calculated, signed").signed().inner();

/// Load words that no register has.
const STORE: &str = "store";
const ADDRESS: &str = "address";
const STORED: [&str; 4] = ["wx", "wy", "w", "knot"];
const END: &str = "end_u";
const LAST_SPAN: &str = "last_span";
const ENDS: Reg<2> = Reg::each(["xe", "ye"], Rule::Planned("n+1"), "end point, signed");

/// Numbers that the hardware is built with.
const DEGREE: &str = "degree";
const KNOTS: &str = "knots";

/// Data sampling with a fine DDA, NURBS.
pub static MODEL: Model = Model {
    name: NAME,
    title: "Data sampling with a fine DDA, NURBS",
    method: "data sampling",
    source: "数据采样法 with de Boor's algorithm and a Taylor step of the first order, as papers on NURBS interpolators have it",
    registers: &[&STATE.width(Rule::Bits(coarse::STATE_BITS)), &P_XY, &DU, &U, &POINT, &BURST, &POSITION],
    options: &[
        &FRACTION.about("bits of the fraction of coarse points, 8 or more (default: 8 more than the coordinates have)"),
        &STEP.about("BLU of a period (default: 8); or --feed"),
        &TOLERANCE.about("chord error in BLU, in the middle of each step of u, at most (default: 1)"),
        &SAMPLED_WIDTH,
        &PRESET,
        &ON_OVERFLOW,
    ],
    claims: None,
    interpolates: Interpolates::Nurbs(Method { plan, load }),
    hardware,
};

/// The travel of a period in BLU where none is chosen.
const USUAL_STEP: Millionths = Millionths(8_000_000);
/// Least and greatest bits of the fraction.
const FRACTIONS: [u32; 2] = [8, 48];

fn plan(nurbs: &Nurbs, plan: &mut Plan) -> Result<(), ModelError> {
    let largest = nurbs.points().iter().flat_map(|point| point.at).map(i64::unsigned_abs).max().unwrap_or(0);
    let usual = Width::needed_unsigned(largest.into()) + 8;
    let fraction = plan.decide(&FRACTION, Some(usual)).unwrap_or(usual);
    let refused = |option, value: String, reason: String| Err(ModelError::Value { model: NAME, option, value, reason });
    let [least, most] = FRACTIONS;
    if !(least..=most).contains(&fraction) {
        let reason = format!("a coarse point has {least} to {most} bits of fraction");
        return refused(FRACTION.name, fraction.to_string(), reason);
    }
    let tolerance = plan.get(&TOLERANCE).unwrap_or(Millionths(1_000_000));
    let step = plan.get(&STEP).unwrap_or(USUAL_STEP);
    let word = (u128::from(step.0) << fraction).saturating_add(500_000) / 1_000_000;
    let Some(word) = u64::try_from(word).ok().filter(|word| *word > 0 && word >> 62 == 0) else {
        let reason = format!("it does not fit {fraction} bits of fraction: give another --step, or another --feed");
        return refused(STEP.name, step.to_string(), reason);
    };
    let control = Control::new(nurbs, fraction);
    if let Some(index) = control.points.iter().position(|[.., weight]| *weight == 0) {
        let reason = format!("the weight of point {} would be 0: give more bits", index + 1);
        return refused(FRACTION.name, fraction.to_string(), reason);
    }
    let whole = Width::needed_unsigned(u128::from(largest) + 1);
    let widths = Widths::of(&control, whole, word);
    if let Some(what) = widths.too_wide() {
        let fits = (least..fraction).rev().find(|&fraction| {
            let word = (u128::from(step.0) << fraction) / 1_000_000;
            let control = Control::new(nurbs, fraction);
            Widths::of(&control, whole, u64::try_from(word).unwrap_or(u64::MAX)).too_wide().is_none()
        });
        let remedy = fits.map_or_else(
            || "give a smaller geometry, smaller weights, or a greater BLU".to_owned(),
            |fits| format!("give --fraction {fits} or less"),
        );
        return Err(ModelError::Widths(format!("{NAME}: with {fraction} bits of fraction {what}: {remedy}")));
    }
    let course = control.course(word, chord_limit(tolerance, fraction, widths.chord)).map_err(|stuck| match stuck {
        Stuck::Rests(u) => ModelError::Widths(format!(
            "{NAME}: the curve rests at u = {u:.6}, where no step is short enough: move the control points apart there"
        )),
        Stuck::Periods(most) => ModelError::Widths(format!(
            "{NAME}: the curve would take more than {most} periods: give a greater --step or --tolerance"
        )),
    })?;

    let constants = [(DEGREE, control.degree as i128), (KNOTS, control.knots.len() as i128)];
    plan.constants.extend(constants.into_iter().chain(widths.constants()));
    plan.set(U, widths.place).set(DU, widths.place).set_each(P_XY, widths.point);
    let clock_hz = plan.options().clock_hz;
    let sampling = Sampling {
        system: System::Direction,
        fraction,
        step,
        word,
        whole,
        chord_error: course.chord_error,
        tolerance,
        clock_hz,
        clocks: [1, 1],
    };
    // The fine stage holds a period of f and a BLU of rounding, and what the longest period is beyond that.
    let more = course.widest as f64 - step.units() - 1.0;
    let spans = control.points.len() - control.degree;
    let clocks = widths.clocks(fraction, control.degree, spans, course.halvings + 1);
    let positions = [0, 1].map(|axis| nurbs.points().iter().map(move |point| point.at[axis]));
    FineStage::plan(sampling, plan, more, clocks, positions)?;
    // Halved steps may be shorter than a pulse.
    let period = plan.sampling.map_or(0, |sampling| sampling.clocks[0] / sampling.clocks[1] + 1);
    plan.stall_clocks = plan.stall_clocks.saturating_add(period.saturating_mul(course.still));
    Ok(())
}

/// Bits of an address of the knots, and of a span.
fn address_bits(knots: u32) -> u32 {
    Width::needed_unsigned(u128::from(knots))
}

fn hardware(top: Scope<'_>, hardware: &Hardware) {
    let Some(sampling) = hardware.sampling else { return };
    let widths = Widths::built(hardware);
    let block = Block::new(top);
    let store = block.word(STORE, 1);
    let fine = FineStage::new(top.scope("fine"), hardware.bits(JV.of(0)));
    let m = top.scope("coarse");
    let runs = m.name("runs", block.load & !store);

    let size = u32::try_from(hardware.constant(KNOTS)).unwrap_or(1);
    let address = block.word(ADDRESS, address_bits(size));
    let [wx, wy, w, knot] = STORED;
    let words = [
        (wx, block.word_signed(wx, widths.homogeneous)),
        (wy, block.word_signed(wy, widths.homogeneous)),
        (w, block.word(w, widths.weight)),
        (knot, block.word(knot, widths.place)),
    ];
    let memories = words.map(|(name, word)| {
        let memory = m.memory(name, word.bits(), size.into());
        memory.write(block.load & store, address, word.as_unsigned(), None);
        memory
    });
    let ends = [0, 1].map(|axis| block.held_signed(m, ENDS.of(axis).name(), sampling.whole + 1));
    let coarse = Coarse::new(m, &block, hardware, widths, memories);
    let (hand, last, place, points) = coarse.close(runs, fine.free());

    let (over, take) = fine.draw(&block, hardware, [hand, last], points, sampling.fraction, ends);
    let next = m.reg("u_next", widths.place);
    next.when(hand, place).else_hold();
    let drawn = top.reg(U.name(), widths.place);
    drawn.when(block.load, m.lit(widths.place, 0)).when(take, next.q).else_hold();

    // What is stored is there at the next edge.
    let storing = m.reg("storing", 1);
    storing.set(block.load & store);
    let finish = storing.q | over & fine.last();
    block.close_after(runs, over, finish);
}

fn load(nurbs: &Nurbs, hardware: &Hardware) -> Vec<Words> {
    let Some(sampling) = hardware.sampling else { return Vec::new() };
    let control = Control::new(nurbs, sampling.fraction);
    let start = nurbs.from().map(i128::from);
    let [wx, wy, w, knot] = STORED;
    let fine = |words| FineStage::words(words, hardware, start, start).pop().unwrap_or_default();
    let store = |(address, &place): (usize, &i128)| {
        let [x, y, weight] = control.points.get(address).copied().unwrap_or_default();
        let words = Words::new().set_input(STORE, 1).set_input(ADDRESS, address as i128);
        let words = words.set_input(wx, x).set_input(wy, y).set_input(w, weight).set_input(knot, place);
        // The first block presets the position counters.
        if address == 0 { fine(words) } else { words }
    };
    let words = Words::new().set_input(STORE, 0).set(DISPLACEMENT, sampling.word).set_input(END, control.end());
    let words = words.set_input(LAST_SPAN, control.points.len() as i128 - 1).set_each(ENDS, nurbs.to());
    let run = fine(words);
    control.knots.iter().enumerate().map(store).chain([run]).collect()
}

/// A register that holds what is chosen among several by a number (its bits do), 0 beyond them.
fn chosen<'m>(m: Scope<'m>, among: &[Register<'m>], number: Signal<'m>) -> Signal<'m> {
    let first = among[0].q;
    among.iter().enumerate().skip(1).fold(first, |value, (index, register)| {
        // At most the degree.
        let here = number.equals(m.lit(number.bits(), index as u64));
        here.mux(register.q, value)
    })
}
