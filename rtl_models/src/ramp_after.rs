//! `ramp-after`: acceleration after the interpolator, one axis: a moving sum or an exponential over the displacements of periods.
//!
//! ```text
//!   left ──► min(f, left) ──┬──► + ──► s ──► + ──► /k ──► jv ──► + ──► jr      2^n additions
//!                           ▼    │           ▲     │             ▲──────┤      a period
//!                  delay of k    - ◄─ oldest └ rem └► remainder          └──► carry: pulse ──► e ──► done
//! ```
//!
//! In every period the interpolator hands over f BLU, in the last one what is left. What goes to the axis rises and falls over the
//! periods after that, and all of it comes out.
//!
//! **Moving sum** (`--smooth sum=K`): S += in - in of k periods ago, {out, rem} := (S + rem) div, mod k. S <= k·f; after k
//! more periods all is out. Six periods of 10 with k = 4: out is 2, 5, 8, 10, 10, 10, 7, 5, 3, 0.
//!
//! **Exponential** (`--smooth exp=S`): acc += in, out = acc/2^s rounded up, acc -= out. acc <= f·2^s. Rounded down,
//! 2^s - 1 would stay for ever. Four periods of 10 with s = 2: out is 3, 5, 6, 7, 5, 4, 3, 2, 2, 1, 1, 1.
//!
//! The fine stage is a DDA of n bits: 2^n additions of out make out pulses, and `jr` is its preset again. A period is one clock more, at
//! which out is calculated. `stepped` marks its end, which is a row of the step table.
//!
//! Two axes of a circle keep their common delay, but the radius shrinks: with f a period by (k²-1)·f²/(24·R) of the moving sum, and by
//! (4^s-2^s)·f²/(2·R) of the exponential.
//!
//! The recurrence is that of acceleration control after interpolation 插补后加减速 in CNC systems, in the project's own form with
//! remainders. Six periods of 10, from the golden file `waves/ramp-after-60.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/ramp-after-60.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::dsl::{Scope, Signal};

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{Millionths, ON_OVERFLOW, PRESET, SMOOTH, STEP, Smooth, WIDTH};
use crate::parts::{
    Block, DISPLACEMENT, E, Iteration, JR, JV, NONE, POSITION, SIGN, Taking, YOUNGER, axis_scope, exponential,
    integrand, integrator, moving_sum,
};
use crate::plan::Plan;
use crate::ramping::bits;
use crate::registers::{AS_NEEDED, Reg, Rule, Where};
use crate::sizes;

const NAME: &str = "ramp-after";

/// BLU of a period where none are chosen.
const USUAL_STEP: u64 = 10;
/// Most BLU of a period.
const MOST_STEP: u64 = 1 << 30;

static BY_SUM: Where = Where("--smooth sum", |plan| matches!(plan.get(&SMOOTH), Smooth::Sum(_)));
static BY_SHARE: Where = Where("--smooth exp", |plan| matches!(plan.get(&SMOOTH), Smooth::Exponential(_)));

/// Displacement still to be handed over.
const LEFT: Reg = Reg::new("left", AS_NEEDED, "BLU that the interpolator has not handed over");
/// The sum of the last k.
const SUM: Reg = Reg::new("s", AS_NEEDED, "sum of the last k displacements").when(&BY_SUM);
/// What its division left.
const REMAINDER: Reg = Reg::new("rem", AS_NEEDED, "remainder of the sum divided by k").when(&BY_SUM);
/// What is still inside.
const INSIDE: Reg = Reg::new("acc", AS_NEEDED, "displacement that has not come out").when(&BY_SHARE);
/// Clock of the period.
const CLOCK: Reg = Reg::new("i", Rule::Planned("n+1"), "clock of the period, from 0").hidden().follows(|_| true);

/// Moving sum or exponential after the interpolator, one axis.
pub static MODEL: Model = Model {
    name: NAME,
    title: "Acceleration after the interpolator, one axis",
    method: "acceleration and deceleration 加减速",
    source: "插补后加减速, acceleration and deceleration after interpolation in CNC systems",
    registers: &[
        &LEFT,
        &SUM,
        &REMAINDER,
        &INSIDE,
        &(JV, JR),
        &E.width(AS_NEEDED).about("pulses left of the block"),
        &CLOCK,
        &DISPLACEMENT.hidden(),
        &SIGN,
        &POSITION,
    ],
    options: &[
        &WIDTH.about("n of jv and jr, or REGISTER=N,… (default: the least that holds f)"),
        &SMOOTH,
        &STEP.about("whole BLU of a period (default: 10)"),
        &PRESET,
        &ON_OVERFLOW,
    ],
    claims: None,
    interpolates: Interpolates::Axis(Method { plan, load }),
    hardware,
};

/// Whole BLU of a period.
fn step(step: Option<Millionths>) -> Result<u64, ModelError> {
    let Some(step) = step else { return Ok(USUAL_STEP) };
    let whole = step.0 / 1_000_000;
    if step.0 % 1_000_000 != 0 || !(1..=MOST_STEP).contains(&whole) {
        let reason = format!("a period hands over whole BLU, from 1 to {MOST_STEP}");
        return Err(ModelError::Value { model: NAME, option: STEP.name, value: step.to_string(), reason });
    }
    Ok(whole)
}

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let f = step(plan.get(&STEP))?;
    plan.fix(&STEP, Some(Millionths(f * 1_000_000)));
    plan.n = plan.bits_or(bits(f));
    let pulses = sizes::longest(line);
    let clock = plan.bits(JR.of(0)) + 1;
    plan.set(LEFT, bits(pulses)).set(E, bits(pulses)).set(DISPLACEMENT, bits(f)).set(CLOCK, clock);
    plan.positions([[line.from()[0], line.to()[0]]]);
    let smooth = plan.get(&SMOOTH);
    let periods = match smooth {
        Smooth::Sum(k) => {
            plan.set(SUM, bits(f * k)).set(REMAINDER, bits(k - 1));
            k
        }
        Smooth::Exponential(s) => {
            plan.set(INSIDE, bits(f * ((1 << s) - 1)));
            1 << s
        }
    };
    plan.integrators(1)?;
    if let Smooth::Sum(k) = smooth
        && plan.bits(REMAINDER) < bits(k - 1)
    {
        return Err(ModelError::Widths(format!(
            "{NAME}: rem of {} does not hold the remainders of a division by {k}: give --width rem={} or more",
            plan.bits(REMAINDER),
            bits(k - 1)
        )));
    }
    plan.remedies.push((NONE, format!("a period has more pulses than jv holds: give --width {} or more", bits(f))));
    plan.remedies
        .push((YOUNGER, format!("the sum has more bits: give --width s={} or more", bits(f.saturating_mul(periods)))));
    if plan.bits(JR.of(0)) > 52 {
        return Err(ModelError::Widths(format!("{NAME}: a period has 2^n additions: give --width 52 or less")));
    }
    // While the first of it comes out, which is less than a pulse a period at first.
    plan.stall_clocks = ((1_u64 << plan.bits(JR.of(0))) + 1).saturating_mul(periods + 2).saturating_add(16);
    plan.error_bound = Some(0.0);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let (running, n) = (block.busy & !block.load, hardware.bits(JR.of(0)));
    let clock = m.reg(CLOCK.name(), n + 1);
    let begins = m.name("begins", running & clock.q.is_zero());
    let ends = m.name("ends", running & clock.q.msb());
    let zero = m.lit(n + 1, 0);
    let next = clock.q.wrapping_add(m.lit(n + 1, 1));
    clock.when(block.load | ends, zero).when(running, next).else_hold();

    let input = handed_over(m, hardware, &block, begins);
    let at = Taking { clear: Some(block.load), begins };
    let output = match hardware.get(&SMOOTH) {
        Smooth::Sum(k) => {
            let m = m.scope("moving_sum");
            moving_sum(m, || [SUM, REMAINDER].map(|register| hardware.reg(m, register)), at, input, k)
        }
        Smooth::Exponential(s) => {
            let m = m.scope("exponential");
            exponential(m, hardware.reg(m, INSIDE), at, input, s)
        }
    };

    let axis = axis_scope(m, 0);
    let jv = axis.reg(JV.of(0).name(), hardware.bits(JV.of(0)));
    integrand(m, axis, jv, at, output);
    let add = running & !clock.q.is_zero();
    let pulse = integrator(axis, &block, hardware, 0, jv.q, Iteration { add, complete: add });
    let negative = block.held(axis, SIGN.of(0).name(), 1);
    hardware.axis(axis, &block, 0, pulse, negative);
    let e = hardware.counter(m, &block, E);
    let last = e.count(pulse);
    block.close(block.load, ends, last);
}

/// What the interpolator hands over in a period: f, or what is left.
fn handed_over<'m>(m: Scope<'m>, hardware: &Hardware, block: &Block<'m>, begins: Signal<'m>) -> Signal<'m> {
    let left = hardware.reg(m, LEFT);
    let f = hardware.held(m, block, DISPLACEMENT);
    let wide = left.q.bits().max(f.bits());
    let [all, step] = [left.q, f].map(|signal| signal.extend(wide));
    let input = m.name("input", all.less_than(step).mux(all, step));
    let rest = all.wrapping_sub(input).slice(0, left.q.bits());
    left.when(block.load, hardware.word(block, LEFT)).when(begins, rest).else_hold();
    input
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let pulses = sizes::longest(line);
    let f = step(hardware.get(&STEP)).unwrap_or(USUAL_STEP);
    let words = Words::new().set(LEFT, pulses).set(E, pulses).set(DISPLACEMENT, f);
    let words = words.set(JR.of(0), hardware.preset(JR.of(0)));
    vec![words.set(SIGN.of(0), i128::from(line.delta()[0] < 0)).set(POSITION.of(0), line.from()[0])]
}
