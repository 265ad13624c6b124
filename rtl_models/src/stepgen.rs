//! `stepgen`: the step generator of FPGA motion cards, line of 2 to 6 axes.
//!
//! ```text
//!   for each axis i:   ratei ──► + ──► acci ──┐                         2^k accumulations
//!                                ▲────────────┤                         e, last step over ──► done
//!                                ┊            └─► pick-off bit changes: step ──► stepi, diri ──► position i
//!                                ┊                                       │          │
//!                                └┄┄┄┄ hold of all axes ◄── not yet ◄────┴──── timers: length, space, setup, hold
//! ```
//!
//! Every accumulation adds the rate to the accumulator of each axis. A change of its pick-off bit p is a step in the
//! direction of the rate: the axis is at floor(acc / 2^p) steps from its start. The position counters count the steps
//! that are sent.
//!
//! **End of a block.** A block has 2^k accumulations, and rates are loaded that make it exact: d·2^(p-k) is a whole number
//! as long as k <= p, and 2^k of them are d·2^p, exactly d steps, for every preset. No rate is rounded. (A host
//! that chooses its number N of accumulations freely must round, and d·2^p / N up is exact from an accumulator of 0
//! where N <= 2^p: what it is too much stays below a step.) At most one step is made in an accumulation, so 2^k is at
//! least the longest abs(d). Without a choice k is n + ceil(log2(length + space)): no step of the fastest axis has to
//! wait for the one before it. The width of e sets another k, and so the feed: `--width e=N` makes 2^(N-1)
//! accumulations. A block is done when the last step and the space after it are over.
//!
//! **Timers.** A step is sent at the edge of its accumulation. Where the timers of its axis do not allow that, the
//! accumulation waits, and with it those of all axes, as on a card whose hold inputs are joined: no step is lost, and
//! the path stays that of the accumulators. Step output: 1 for `length` clocks, 0 for `space` clocks at least.
//! Direction output: changes `hold` clocks after the end of a step at least, `setup` clocks before the next.
//!
//! **Widths.** n bits hold the longest abs(d). What an accumulator comes to lies from -(2^n - 1)·2^p to 2^n·2^p - 1, which
//! n+1+p bits hold. Without `--pick-off` p is k, the least that makes every rate whole. The cards of today have 48
//! bits, rates of 32 bits and p = 32 (`--pick-off 32 --width acc=48,rate=32`): lines of less than 2^15 steps. Too
//! narrow an accumulator traps. Wrapped around it still makes every step as long as it has its pick-off bit, but gives
//! its host a wrong position; where it ends below that bit its sign is picked off, and the steps are too many.
//!
//! Each axis is less than one step off its ideal place, and with the preset `half` at most half a step: the path stays
//! within sqrt(2) BLU, or sqrt(1/2).
//!
//! The line (3, -2), from the golden file `waves/stepgen-3-2.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/stepgen-3-2.csv")]
//! ```

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use stepwave_nc::Line;
use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Scope, Signal};

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{
    END_POINT, EndPoint, ON_OVERFLOW, PICK_OFF, PRESET, PerRegister, Preset, StepTiming, TIMING, Taken, WIDTH,
};
use crate::parts::{ACC, Block, E, POSITION, PhaseAccumulator, RATE, StepOutput, axis_scope};
use crate::per_axis;
use crate::plan::Plan;
use crate::registers::{AXES, PerAxis, Reg, Rule};
use crate::sizes;

const NAME: &str = "stepgen";

/// The outputs of each axis.
const OUTPUTS: (PerAxis, PerAxis) = (
    Reg::each(per_axis!("step"), Rule::Bits(1), "step output of each axis").hidden(),
    Reg::each(per_axis!("dir"), Rule::Bits(1), "direction output of each axis").hidden(),
);

/// Longest time of an output, in clocks.
const LONGEST_TIME: u64 = 1 << 20;

pub(crate) static PART_OF_A_STEP: Taken<PerRegister<Preset>> =
    PRESET.about("zero (default) | half | full | N below 2^p, or accx=N,accy=N");
pub(crate) static PICKED: Taken<Option<u64>> =
    PICK_OFF.about("bit p whose changes are steps (default: k; on many cards 32)");
pub(crate) static TIMES: Taken<StepTiming> =
    TIMING.about("length=CLOCKS,space=CLOCKS,setup=CLOCKS,hold=CLOCKS (default: 2, 2, 4, 4)");

/// Phase accumulators of a motion card, line of 2 to 6 axes.
pub static MODEL: Model = Model {
    name: NAME,
    title: "Phase accumulators of a motion card, line of 2 to 6 axes",
    method: "modern step generators",
    source: "the step generators of FPGA motion cards: direct digital synthesis of step and direction",
    registers: &[
        &(RATE, ACC),
        &E.width(Rule::Planned("k+1")).about("accumulations left, from 2^k"),
        &OUTPUTS,
        &POSITION,
    ],
    options: &[&WIDTH, &PART_OF_A_STEP, &PICKED, &TIMES, &ON_OVERFLOW],
    claims: None,
    interpolates: Interpolates::Lines(6, Method { plan, load }),
    hardware,
};

/// The least number whose power of two is not less.
fn log2_up(value: u64) -> u32 {
    if value <= 1 { 0 } else { Width::needed_unsigned(u128::from(value - 1)) }
}

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let accumulations = registers(plan, sizes::longest(line), sizes::end_positions(line))?;
    plan.stall_clocks = stall_clocks(plan, accumulations);
    let off = axis_bound(&plan.presets()?);
    plan.error_bound = (plan.axes() == 2).then_some(if off < 1.0 { FRAC_1_SQRT_2 } else { SQRT_2 });
    Ok(())
}

/// Clocks without a pulse after which none will come, where accumulations alone take `clocks`: an axis of one step may make
/// it at the end, after all delays.
pub(crate) fn stall_clocks(plan: &Plan, clocks: u64) -> u64 {
    let timing = plan.get(&TIMING);
    let delays = 2 * (timing.length + timing.space + timing.setup + timing.hold);
    clocks.saturating_add(delays).saturating_add(16)
}

/// How far an axis is from its ideal place at most, in BLU.
pub(crate) fn axis_bound(presets: &[Preset]) -> f64 {
    if presets.iter().all(|preset| *preset == Preset::Half) { 0.5 } else { 1.0 }
}

/// The registers for blocks of up to `longest` steps that lead to these positions of each axis. Returns the
/// accumulations of the longest block.
pub(crate) fn registers(
    plan: &mut Plan,
    longest: u64,
    positions: impl IntoIterator<Item = impl IntoIterator<Item = i64>>,
) -> Result<u64, ModelError> {
    let timing = timing(plan)?;
    plan.n = plan.magnitude_bits(longest);
    let undelayed = plan.n + log2_up(timing.length + timing.space);
    let given = plan.get(&PICK_OFF).map(|bit| u32::try_from(bit).unwrap_or(u32::MAX));
    plan.set(E, given.map_or(undelayed, |bit| undelayed.min(bit)).max(log2_up(longest)) + 1);
    let k = plan.bits(E) - 1;
    let pick_off = given.unwrap_or(k);
    accumulations(longest, k, pick_off)?;
    plan.set_each(RATE, (plan.n + 1).saturating_add(pick_off - k));
    plan.set_each(ACC, (plan.n + 1).saturating_add(pick_off)).positions(positions);
    plan.fix(&END_POINT, EndPoint::Iterations);
    plan.fix(&PICK_OFF, Some(u64::from(pick_off)));
    presets(&plan.presets()?, pick_off)?;
    Ok(1_u64.checked_shl(k).unwrap_or(u64::MAX))
}

/// The times chosen, which must be possible.
fn timing(plan: &Plan) -> Result<StepTiming, ModelError> {
    let timing = plan.get(&TIMING);
    let times = [timing.length, timing.space, timing.setup, timing.hold];
    if times[..2].contains(&0) || times.into_iter().any(|clocks| clocks > LONGEST_TIME) {
        return Err(ModelError::Value {
            model: NAME,
            option: TIMING.name,
            value: timing.to_string(),
            reason: format!("length and space are 1 clock at least, and no time is more than {LONGEST_TIME}"),
        });
    }
    Ok(timing)
}

/// Refuses 2^k accumulations that cannot make every step of the line, or not with whole rates.
fn accumulations(longest: u64, k: u32, pick_off: u32) -> Result<(), ModelError> {
    let least = log2_up(longest);
    let bits = k + 1;
    if k < least {
        let made = 1_u64 << k;
        return Err(ModelError::Widths(format!(
            "{NAME}: e of {bits} bits counts {made} accumulations, but the longest axis has {longest} steps, and an \
             accumulation makes one at most: give --width e={} or more",
            least + 1
        )));
    }
    if k > pick_off {
        let fewer = if pick_off >= least { format!(", or --width e={}", pick_off + 1) } else { String::new() };
        return Err(ModelError::Widths(format!(
            "{NAME}: 2^{k} accumulations (e of {bits} bits) and pick-off bit {pick_off} would give the rates a fraction: \
             give --pick-off {k} or more{fewer}"
        )));
    }
    Ok(())
}

/// The bit whose changes are steps.
fn pick_off(hardware: &Hardware) -> u64 {
    hardware.get(&PICK_OFF).unwrap_or(0)
}

/// Refuses a preset that is a step or more.
fn presets(presets: &[Preset], pick_off: u32) -> Result<(), ModelError> {
    let step = 1_u128.checked_shl(pick_off).unwrap_or(u128::MAX);
    match presets.iter().find(|preset| preset.value(step).is_none()) {
        Some(preset) => Err(ModelError::Value {
            model: NAME,
            option: PRESET.name,
            value: preset.to_string(),
            reason: format!("a preset is a part of a step, from 0 to {}, with pick-off bit {pick_off}", step - 1),
        }),
        None => Ok(()),
    }
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    interpolator(m, hardware, Block::new(m), None);
}

/// A pulse source that runs while its last argument (1 bit) is 1.
type Source<'m> = fn(Scope<'m>, &Hardware, &Block<'m>, Signal<'m>) -> Signal<'m>;

/// The wiring after a block loader. Each pulse of a source is an accumulation; without one there is one a clock.
pub(crate) fn interpolator<'m>(m: Scope<'m>, hardware: &Hardware, block: Block<'m>, source: Option<Source<'m>>) {
    let e = hardware.counter(m, &block, E);
    let axis = |axis: usize| {
        let (scope, bits) = (axis_scope(m, axis), [ACC, RATE].map(|register| hardware.bits(register.of(axis))));
        let acc = PhaseAccumulator::new(scope, &block, axis, bits, pick_off(hardware), hardware.get(&ON_OVERFLOW));
        let output = StepOutput::new(scope, AXES[axis], hardware.get(&TIMING), acc.negative());
        (scope, acc, output)
    };
    let axes: Vec<_> = (0..hardware.axes).map(axis).collect();

    // An accumulation waits until every step that it makes may be sent.
    let waiting = axes.iter().map(|(_, acc, output)| acc.steps() & !output.ready()).reduce(|a, b| a | b);
    let counting = block.busy & e.running();
    let hold = m.name("hold", waiting.map_or(!counting, |waiting| counting & waiting));
    let ready = counting & !hold;
    let accumulate = m.name("accumulate", source.map_or(ready, |source| source(m, hardware, &block, ready)));
    let mut resting = e.count(accumulate);
    for (i, (scope, acc, output)) in axes.into_iter().enumerate() {
        let send = scope.name("send", accumulate & acc.steps());
        hardware.axis(scope, &block, i, send, acc.negative());
        acc.close(&block, accumulate);
        resting = resting & output.close(send);
    }
    block.close_after(block.load, accumulate, block.busy & resting);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    vec![words(&line.delta(), line.from(), hardware, hardware.bits(E) - 1)]
}

/// The least k for a block of these displacements in BLU, at most that of `e`: 2^k accumulations make every step, and
/// the rates, which are the greater the fewer accumulations there are, fit in their registers.
pub(crate) fn least_accumulations(delta: &[i64], hardware: &Hardware) -> u32 {
    let longest = sizes::longest_of(delta);
    let rate = Width::needed_unsigned(u128::from(longest)) + 1;
    let room = hardware.bits(RATE.of(0));
    let by_rate = rate.saturating_add(u32::try_from(pick_off(hardware)).unwrap_or(u32::MAX)).saturating_sub(room);
    by_rate.max(log2_up(longest)).min(hardware.bits(E).saturating_sub(1))
}

/// The words of a block with these displacements of the axes, in BLU, in 2^k accumulations, and of the first block with
/// the place that it starts from.
pub(crate) fn words(delta: &[i64], from: &[i64], hardware: &Hardware, k: u32) -> Words {
    let step = 1_u128.checked_shl(u32::try_from(pick_off(hardware)).unwrap_or(u32::MAX)).unwrap_or(0);
    let unit = i128::try_from(step >> k).unwrap_or(0);
    let mut words = Words::new().set(E, 1_i128 << k);
    for (axis, &delta) in delta.iter().enumerate() {
        let preset = hardware.presets[axis].value(step).unwrap_or(0);
        words = words.set(RATE.of(axis), i128::from(delta) * unit);
        words = words.set(ACC.of(axis), i128::try_from(preset).unwrap_or(0));
        if let Some(&from) = from.get(axis) {
            words = words.set(POSITION.of(axis), from);
        }
    }
    words
}
