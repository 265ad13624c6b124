//! Acceleration and deceleration of a pulse source: trapezoids, S curves, and what an operator does meanwhile.

use super::Table;

/// How it finds where to brake.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Braking {
    Square,
    Count,
    /// By an S curve of this jerk.
    Jerk(i128),
}

/// What is in force from a tick on: a hold, and the override in percent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InForce {
    pub(crate) tick: u64,
    pub(crate) hold: bool,
    pub(crate) percent: i128,
}

/// A block of pulses.
#[derive(Clone, Debug)]
pub(crate) struct RampBlock {
    /// Bits of the phase and of the speed.
    pub(crate) bits: u32,
    pub(crate) pulses: i128,
    pub(crate) start: i128,
    pub(crate) drive: i128,
    pub(crate) stop: i128,
    pub(crate) up: i128,
    pub(crate) down: i128,
    pub(crate) preset: i128,
    pub(crate) braking: Braking,
    pub(crate) events: Vec<InForce>,
}

/// A ramp of 2m + h ticks with the jerk j, and what is left of the difference.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Plan {
    pub(crate) m: i128,
    pub(crate) h: i128,
    pub(crate) j: i128,
    pub(crate) rest: i128,
}

/// The least whole number whose square times `j` is at least `d`.
fn root_up(d: i128, j: i128) -> i128 {
    let mut root = (d / j).isqrt();
    while root * root * j < d {
        root += 1;
    }
    root
}

pub(crate) fn plan(low: i128, high: i128, jerk: i128, most: i128) -> Plan {
    let d = high - low;
    if d == 0 {
        return Plan { m: 0, h: 0, j: 0, rest: 0 };
    }
    let m = (most / jerk).min(root_up(d, jerk)).max(1);
    let h = ((d + jerk * m - 1) / (jerk * m) - m).max(0);
    let j = d / (m * (m + h));
    if j == 0 {
        let m = m.min(d.isqrt());
        let h = d / m - m;
        return Plan { m, h, j: 1, rest: d - m * (m + h) };
    }
    Plan { m, h, j, rest: d - j * m * (m + h) }
}

/// The speeds of the ticks of a ramp up, one by one.
pub(crate) fn speeds_up(low: i128, plan: Plan) -> Vec<i128> {
    let (mut v, mut acceleration, mut all) = (low, 0, Vec::new());
    for tick in 1..=2 * plan.m + plan.h {
        all.push(v);
        v += acceleration;
        if tick <= plan.m {
            acceleration += plan.j;
        } else if tick > plan.m + plan.h {
            acceleration -= plan.j;
        }
    }
    all
}

/// The same of a ramp down to `low`.
fn speeds_down(low: i128, high: i128, plan: Plan) -> Vec<i128> {
    // What the ramp up has, from the top: each tick as much below as that is above its start.
    speeds_up(low, plan).into_iter().map(|v| high - (v - low)).collect()
}

/// The greatest speed up to `drive` with which both ramps fit, with the plans and the lower speeds.
fn fitting(block: &RampBlock, jerk: i128) -> (i128, Plan) {
    let room = (block.pulses << block.bits) - block.preset;
    let fits = |top: i128| {
        let plan = plan(block.start, top, jerk, block.up);
        let low = block.start + plan.rest;
        speeds_up(low, plan).iter().sum::<i128>() + speeds_down(low, top, plan).iter().sum::<i128>() <= room
    };
    let (mut low, mut high) = (block.start, block.drive);
    if fits(high) {
        low = high;
    }
    while high - low > 1 {
        let middle = (low + high) / 2;
        if fits(middle) { low = middle } else { high = middle }
    }
    (low, plan(block.start, low, jerk, block.up))
}

/// A ramp that runs: the ticks left of it, and whether it goes down.
struct Curve {
    plan: Plan,
    left: i128,
    is_down: bool,
    length: i128,
    acceleration: i128,
    by_hand: bool,
}

/// The columns `phase`, `v`, `e`, `dx`, `x`, with `r` or `av` where there is one.
pub(crate) fn ramp(block: &RampBlock) -> Table {
    let RampBlock { bits, up, down, .. } = *block;
    let (mut a, mut d, mut start, mut stop) = (up, down, block.start, block.stop);
    let mut curve = None;
    if let Braking::Jerk(jerk) = block.braking {
        let (top, plan) = fitting(block, jerk);
        (start, stop) = (start + plan.rest, stop + plan.rest);
        if plan.j > 0 {
            (a, d) = (plan.j * plan.m, plan.j * plan.m);
        }
        let ticks = 2 * plan.m + plan.h;
        let length = speeds_down(stop, top, plan).iter().sum();
        curve = Some(Curve { plan, left: ticks, is_down: false, length, acceleration: 0, by_hand: false });
    }
    let one: i128 = 1 << bits;
    let (mut phase, mut v, mut e, mut r, mut x) = (block.preset, start, block.pulses, 0, 0);
    let mut names = vec!["phase", "v", "e", "dx", "x"];
    names.extend(match block.braking {
        Braking::Square => None,
        Braking::Count => Some("r"),
        Braking::Jerk(_) => Some("av"),
    });
    let mut table = Table::new(names.iter().map(|name| (*name).to_owned()).collect());
    let mut row = |phase: i128, v: i128, e: i128, pulse: i128, x: i128, more: i128| {
        let values = [phase, v, e, pulse, x, more].map(|value| i64::try_from(value).unwrap());
        table.push(&[&values[..names.len()]]);
    };
    row(phase, v, e, 0, 0, 0);
    for tick in 1.. {
        let force = block.events.iter().rev().find(|event| event.tick <= tick);
        let (hold, percent) = force.map_or((false, 100), |event| (event.hold, event.percent));
        let share = (128 * percent + 50) / 100;
        let target = if hold { 0 } else { ((block.drive * share) >> 7).min(one - 1) };
        let remaining = e * one - phase;
        let wanted = if v < target {
            if v == 0 { start.min(target) } else { (v + a).min(target) }
        } else if v > target {
            if target == 0 && v - d < stop { 0 } else { (v - d).max(target) }
        } else {
            v
        };
        let brake = match block.braking {
            Braking::Count => e <= r + 1,
            _ => 2 * d * remaining <= wanted * wanted - stop * stop + 2 * d * (v + wanted),
        };
        let mut next = if brake { wanted.min((v - d).max(stop)) } else { wanted };
        let before = curve.as_ref().map_or(0, |curve| curve.acceleration);
        if let Some(curve) = &mut curve {
            let idle = curve.left == 0;
            curve.by_hand |= idle && (hold || share != 128);
            if !curve.by_hand {
                if idle && v > stop && remaining < v + curve.length {
                    (curve.is_down, curve.left) = (true, 2 * curve.plan.m + curve.plan.h);
                }
                next = if curve.is_down { v - before } else { v + before };
                if curve.left > curve.plan.m + curve.plan.h {
                    curve.acceleration += curve.plan.j;
                } else if curve.left > 0 && curve.left <= curve.plan.m {
                    curve.acceleration -= curve.plan.j;
                }
                curve.left = (curve.left - 1).max(0);
            }
        }
        phase += v;
        let pulse = phase / one;
        phase %= one;
        e -= pulse;
        x += pulse;
        if next > v {
            r += pulse;
        } else if next < v {
            r = (r - pulse).max(0);
        }
        v = next;
        row(phase, v, e, pulse, x, curve.as_ref().map_or(r, |curve| curve.acceleration));
        if e == 0 {
            break;
        }
        assert!(tick < 10_000_000, "it stands still: {block:?}");
    }
    table.finished = true;
    table
}
