//! `ramp`: a pulse source that accelerates and brakes, for one axis.
//!
//! ```text
//!   vc · override ──► target ──► + a, - d ──► v ──► + ──► phase ──► carry: pulse ──► e ──► done
//!                                   ▲         ▲      ▲──────┤          │
//!   e·2^n - phase ──► brake? ───────┘         │             │          └──► position
//!   j ──► + ──► av (S curve) ─────────────────┘             │
//!          ▲─────┘                                 old v is added
//! ```
//!
//! Every clock is a tick: {pulse, phase} := phase + v, with the v from before the tick. v goes to `vc` by `a` in each tick, and
//! to `ve` by `d` in time for the last pulse. The block ends with its last pulse, whatever v is then, so that the count is
//! exact in every case. Until a limit is met t ticks give floor((P + vs·t + a·t(t-1)/2)/2^n) pulses, P the preset of `phase`.
//!
//! **Braking.** `--brake square` compares what remains with the length of the ramp down, the square of the speed:
//! it brakes where 2d·(e·2^n - phase) <= w² - ve² + 2d·(v + w), w the speed of the next tick without braking. Short blocks are
//! triangles by that alone. `--brake count` needs no multiplier: `r` counts the pulses of the ramp up and down again, and it
//! brakes when r + 1 remain; it wants a = d and vs = ve, and may end about a pulse of the ramp early.
//!
//! **S curve.** With `--jerk` a ramp is 2m + h ticks: in the first m of them `av` grows by j, h it stays, in the last m it falls again, and
//! v goes by `av`. The loader plans m, h and j for the jerk and the acceleration given as limits, adds what is left of vc - vs
//! to vs and ve, and lowers the greatest speed of a short block until both ramps fit. The ramp down begins with the first tick in which less than
//! v and its `length` remain.
//!
//! **Events.** `hold` takes the target to 0, `trim` to another share of vc (`run --event CLOCK:hold`, `CLOCK:resume`,
//! `CLOCK:override=PERCENT`). What comes at clock k is in force at edge k+1: v changes there, and the phase adds that v at
//! edge k+2. With an S curve they act while no ramp runs, and the rest of the block is a trapezoid with a = d = j·m.
//!
//! **Units.** Speeds, accelerations and jerks are numbers of the registers, 2^-n pulses a tick and so on, or have a unit:
//! `--accel 500mm/s2 --speed 2400mm/min` at `--clock-hz` and `--blu`. n is then the least with which every acceleration (or the
//! jerk) is 128 or more, at most 54. vs and ve are without a choice the greatest speed at which no pulse is waited for, sqrt(a·2^n).
//!
//! The recurrence is the project's own form of what motion control chips do. 12 pulses with 8 bits, from the golden file
//! `waves/ramp-12.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/ramp-12.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::Width;
use stepwave_netlist::dsl::Scope;
use stepwave_netlist::formula::{Clause, name};

use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{
    ACCEL, BRAKE, Brake, Gains, JERK, Millionths, ON_OVERFLOW, Options, PRESET, PerRegister, Quantity, SPEED, WIDTH,
};
use crate::parts::{
    Block, CHANGE, E, GAINS, GROWTH, LENGTH, LIMITS, PARTS, PHASE, POSITION, RISEN, Ramp, RampBits, RampEdge, SIGN,
    TICKS, V, axis_scope,
};
use crate::plan::Plan;
use crate::ramping::{MOST_BITS, SBlock, SRamp, Scale, bits, usual_start};
use crate::registers::Rule;
use crate::sizes;

const NAME: &str = "ramp";

/// What is not given, in units of the registers.
const USUAL: (Quantity, Quantity) = (Quantity::Word(16), Quantity::Word(144));

/// The drive speed that is not given, where accelerations have units.
const USUAL_FEED: Quantity = Quantity::Physical { number: 2400.0, unit: "mm/min", mm: 1.0 / 60.0 };

/// A pulse source that accelerates and brakes, for one axis.
pub static MODEL: Model = Model {
    name: NAME,
    title: "Acceleration and deceleration of a pulse source, one axis",
    method: "acceleration and deceleration 加减速",
    source: "second- and third-order DDA in front of a pulse source, as in motion control chips",
    registers: &[
        &PHASE,
        &V,
        &CHANGE,
        &TICKS,
        &E.width(Rule::Planned("as the block needs")).about("pulses left of the block"),
        &RISEN,
        &LIMITS,
        &GAINS,
        &GROWTH,
        &PARTS,
        &LENGTH,
        &SIGN,
        &POSITION,
    ],
    options: &[
        &WIDTH.about("n of phase and v, or REGISTER=N,… (default: the least that holds speeds and accelerations)"),
        &PRESET.about("zero (default) | half | full | N: of the phase"),
        &SPEED.about("vc, or vs=V,vc=V,ve=V (default: vc=144, or 2400mm/min where accelerations have units, and vs and ve as fast as one can start)"),
        &ACCEL.about("A or A,D (default: 16)"),
        &JERK,
        &BRAKE,
        &ON_OVERFLOW,
    ],
    claims: Some(Claims {
        // Of a travel are its pulses and its sign; the rest is that of the speed, and along an S planned for the travel.
        loaded_any: |hardware, register| hardware.get(&JERK).is_none() && ![E.name(), SIGN.of(0).name(), POSITION.of(0).name()].contains(&register),
        free: &["hold", "trim"],
        // At most the pulses that there were.
        guesses: |hardware, _| match hardware.get(&BRAKE) {
            Brake::Count => {
                let made = name("|dx|") - E.value() - RISEN.value();
                vec![Clause::at_least_zero("r counts pulses of the acceleration", made)]
            }
            Brake::Square => Vec::new(),
        },
        // An operator may hold it for ever.
        rank: |_| None,
        ..Claims::of(Region::Travels)
    }),
    interpolates: Interpolates::Axis(Method { plan, load }),
    hardware,
};

/// What the ramp of a block is loaded with.
#[derive(Clone, Copy)]
struct Ramping {
    n: u32,
    /// vs, vc, ve.
    speeds: [u64; 3],
    /// a, d.
    gains: [u64; 2],
    jerk: Option<u64>,
}

fn refused<T>(option: &'static str, value: String, reason: String) -> Result<T, ModelError> {
    Err(ModelError::Value { model: NAME, option, value, reason })
}

/// What the options say for registers of n bits, or of as many as they need.
fn ramping(options: &Options, n: Option<u32>) -> Result<Ramping, ModelError> {
    let speeds = options.value(&SPEED);
    let get_speed = |name: &str| speeds.single.get(name).copied().or(speeds.all.filter(|_| name == "vc"));
    let (gains, jerk) = (options.value(&ACCEL), options.value(&JERK));
    let hz = options.clock_hz.map_or(1e6, Millionths::units);
    let scale = Scale { hz, per_mm: 1.0 / options.blu_mm.unwrap_or(1e-3) };
    let gains = gains.map_or([USUAL.0; 2], Gains::both);
    // Of an acceleration with a unit a speed of the register would say nothing.
    let has_unit = gains.iter().any(|gain| gain.mm().is_some()) || jerk.is_some_and(|jerk| jerk.mm().is_some());
    let drive = get_speed("vc").unwrap_or(if has_unit { USUAL_FEED } else { USUAL.1 });
    let by_gain = match jerk {
        Some(jerk) => scale.least_bits(&[jerk], 3),
        None => scale.least_bits(&gains, 2),
    };
    let by_speed = (1..=MOST_BITS + 1).find(|&n| bits(scale.word(drive, 1, n)) <= n).unwrap_or(MOST_BITS + 1);
    if let Some(n) = n.filter(|n| *n > MOST_BITS) {
        return Err(ModelError::Widths(format!(
            "{NAME}: a phase of {n} bits is too wide, as a speed times an override has 10 more: give --width {MOST_BITS} or less"
        )));
    }
    let by_gain = by_gain.unwrap_or(if has_unit { MOST_BITS + 1 } else { 1 });
    let n = n.unwrap_or_else(|| by_gain.max(by_speed));
    if n > MOST_BITS {
        return Err(ModelError::Widths(format!(
            "{NAME}: speeds and accelerations as low as these need a phase of more than {MOST_BITS} bits: give a lower \
             --clock-hz, greater ones, or --width"
        )));
    }
    let words = gains.map(|gain| scale.word(gain, 2, n));
    let jerk_word = jerk.map(|jerk| scale.word(jerk, 3, n));
    let vc = scale.word(drive, 1, n);
    let usual = Quantity::Word(usual_start(words[0].max(words[1]), n, vc));
    let [vs, ve] = ["vs", "ve"].map(|name| scale.word(get_speed(name).unwrap_or(usual), 1, n));
    let zero = [(ACCEL.name, words[0]), (ACCEL.name, words[1]), (JERK.name, jerk_word.unwrap_or(1)), (SPEED.name, vc)];
    if let Some((option, _)) = zero.into_iter().find(|(_, word)| *word == 0) {
        let text = match option {
            _ if option == ACCEL.name => format!("{},{}", gains[0], gains[1]),
            _ if option == JERK.name => jerk.map_or_else(String::new, |jerk| jerk.to_string()),
            _ => drive.to_string(),
        };
        return refused(option, text, format!("it is 0 in registers of {n} bits: give a greater --width, or none"));
    }
    Ok(Ramping { n, speeds: [vs, vc, ve], gains: words, jerk: jerk_word })
}

impl Ramping {
    fn check(&self, brake: Brake) -> Result<(), ModelError> {
        let Ramping { n, speeds: [vs, vc, ve], gains: [a, d], jerk } = *self;
        let most = (1_u64 << n) - 1;
        if vc > most {
            let reason = format!(
                "{vc} is more than a pulse a tick in registers of {n} bits: give a speed up to {most}, or --width {}",
                bits(vc)
            );
            return refused(SPEED.name, format!("vc={vc}"), reason);
        }
        if let Some((name, speed)) = [("vs", vs), ("ve", ve)].into_iter().find(|(_, speed)| !(1..=vc).contains(speed)) {
            return refused(SPEED.name, format!("{name}={speed}"), format!("it lies between 1 and vc, which is {vc}"));
        }
        if (brake == Brake::Count || jerk.is_some()) && vs != ve {
            let with = if jerk.is_some() { "an S curve" } else { "--brake count" };
            return refused(
                SPEED.name,
                format!("vs={vs},ve={ve}"),
                format!("{with} starts and stops at one speed: give vs and ve alike"),
            );
        }
        if brake == Brake::Count && jerk.is_some() {
            return refused(
                BRAKE.name,
                "count".to_owned(),
                "an S curve brakes by the length of its ramp: leave it out".to_owned(),
            );
        }
        if a != d && (brake == Brake::Count || jerk.is_some()) {
            let with = if jerk.is_some() { "the limit of an S curve" } else { "--brake count" };
            return refused(
                ACCEL.name,
                format!("{a},{d}"),
                format!("{with} is one number: give the acceleration alone"),
            );
        }
        Ok(())
    }
}

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let given = plan.bits_or(0);
    let single = [plan.bits(PHASE), plan.bits(V)];
    let phase = if given > 0 { given } else { single[0] };
    let of = ramping(plan.options(), (phase > 0).then_some(phase))?;
    of.check(plan.get(&BRAKE))?;
    of.fix(plan);
    plan.n = of.n;
    let pulses = sizes::longest(line);
    plan.set(E, bits(pulses)).set(GAINS.of(0), bits(of.gains[0])).set(GAINS.of(1), bits(of.gains[1]));
    plan.set(RISEN, plan.bits(E));
    if plan.bits(V) > plan.bits(PHASE) {
        return Err(ModelError::Widths(format!(
            "{NAME}: v of {} bits may be more than a pulse a tick where the phase has {}: give both one --width",
            plan.bits(V),
            plan.bits(PHASE)
        )));
    }
    if let Some(block) = of.s_block(pulses, preset(plan, of.n)) {
        let SBlock { up, down, length, .. } = block;
        let gain = up.most().max(of.gains[0]);
        plan.set(CHANGE, bits(up.most().max(down.most())));
        plan.set(TICKS, bits(up.ticks().max(down.ticks())));
        plan.set_each(GROWTH, bits(up.j.max(down.j)));
        plan.set_each(PARTS, bits([up.m, up.h, down.m, down.h].into_iter().max().unwrap_or(1)));
        let (ticks, parts) = (plan.bits(TICKS), (0..4).map(|part| plan.bits(PARTS.of(part))).max().unwrap_or(0));
        if ticks < parts {
            return Err(ModelError::Widths(format!(
                "{NAME}: k of {ticks} bits counts fewer ticks than the parts of a ramp have (mu, hu, md, hd: {parts} bits): give \
                 --width k={parts}"
            )));
        }
        plan.set(LENGTH, Width::needed_unsigned(length));
        plan.set_each(GAINS, bits(gain));
    }
    let slowest = of.speeds[0].min(of.speeds[2]).min((of.speeds[1] >> 7).max(1));
    plan.stall_clocks = ((1_u64 << of.n) / slowest.max(1)).saturating_add(16);
    plan.positions([[line.from()[0], line.to()[0]]]);
    plan.error_bound = Some(0.0);
    Ok(())
}

fn preset(plan: &Plan, n: u32) -> u64 {
    let value = plan.presets().ok().and_then(|presets| presets.first().and_then(|preset| preset.value(1 << n)));
    value.and_then(|value| u64::try_from(value).ok()).unwrap_or(0)
}

impl Ramping {
    /// Keeps what was resolved in place of what was given.
    fn fix(&self, plan: &mut Plan) {
        let single = ["vs", "vc", "ve"].into_iter().zip(self.speeds);
        let single = single.map(|(name, speed)| (name.to_owned(), Quantity::Word(speed))).collect();
        plan.fix(&SPEED, PerRegister { all: None, single });
        let [up, down] = self.gains.map(Quantity::Word);
        plan.fix(&ACCEL, Some(Gains { up, down: (up != down).then_some(down) }));
        plan.fix(&JERK, self.jerk.map(Quantity::Word));
    }

    /// The plan of a block along S curves; `None` of a trapezoid.
    fn s_block(&self, pulses: u64, preset: u64) -> Option<SBlock> {
        let jerk = self.jerk?;
        let length = (u128::from(pulses) << self.n).saturating_sub(preset.into());
        Some(SBlock::new(self.speeds, jerk, self.gains[0], length))
    }
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let e = hardware.counter(m, &block, E);
    let scope = m.scope("pulse_source");
    let ramp = Ramp::new(scope, RampBits::of(hardware), &block);
    let tick = block.busy & !block.load;
    let pulse = ramp.pulse(tick);
    let axis = axis_scope(m, 0);
    let negative = block.held(axis, SIGN.of(0).name(), 1);
    hardware.axis(axis, &block, 0, pulse, negative);
    let [preset, first] = [PHASE, V].map(|register| hardware.word(&block, register));
    let brake = hardware.get(&BRAKE);
    let risen = (brake == Brake::Count).then(|| hardware.reg(scope, RISEN));
    ramp.close(
        RampEdge { preset: Some(preset), first, by_hand: m.lit(1, 0), runs: tick, tick, left: e.left() },
        brake,
        risen,
    );
    let last = e.count(pulse);
    block.close(block.load, block.busy, last);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let pulses = sizes::longest(line);
    // What it was planned with.
    let Ok(of) = ramping(&hardware.options, Some(hardware.bits(PHASE))) else { return Vec::new() };
    let mut words = Words::new().set(E, pulses).set(PHASE, hardware.preset(PHASE)).set_each(LIMITS, of.speeds);
    let mut start = of.speeds[0];
    let mut gains = of.gains;
    if let Some(block) = of.s_block(pulses, u64::try_from(hardware.preset(PHASE)).unwrap_or(0)) {
        let SBlock { start: from, stop, up, down, length, .. } = block;
        let or_limit = |ramp: SRamp| if ramp.ticks() == 0 { of.gains[0] } else { ramp.most() };
        (start, gains) = (from, [or_limit(up), or_limit(down)]);
        words = words.set_each(LIMITS, [from, of.speeds[1], stop]).set(TICKS, up.ticks());
        words = words.set_each(GROWTH, [up.j, down.j]).set_each(PARTS, [up.m, up.h, down.m, down.h]);
        words = words.set(LENGTH, i128::try_from(length).unwrap_or(i128::MAX));
    }
    let words = words.set(V, start).set_each(GAINS, gains);
    vec![words.set(SIGN.of(0), i128::from(line.delta()[0] < 0)).set(POSITION.of(0), line.from()[0])]
}
