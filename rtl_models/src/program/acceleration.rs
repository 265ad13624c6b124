//! Acceleration of the machines that run programs: the ramp in front of their pulse source, planned and loaded.

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::options::{ACCEL, JERK, Millionths, Options, Quantity};
use crate::parts::{
    CARRY, GROWTH, LENGTH, LIMITS, OWN_PULSES, PARTS, PATH_GAINS, PULSES, RATIO, RATIO_BITS, RATIO_FRACTION, RESTART,
    RampBits, SCurveBits, TICKS, V,
};
use crate::plan::Plan;
use crate::ramping::{MOST_BITS, SBlock, SRamp, Scale, bits, rounded};
use crate::registers::AXES;

/// Bits of the phase.
const BITS: &str = "ramp bits";
/// Bits of the pulses of a block.
const PULSE_BITS: &str = "ramp pulses";

/// Bits of an acceleration.
const GAIN_BITS: &str = "ramp gains";

/// Most bits of the pulses of a ramp over several blocks.
const MOST_CHAIN: u32 = 40;

/// Most bits of a load word.
const MOST_WORD: u32 = 63;

/// Acceleration of a machine that runs programs.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Acceleration {
    /// Acceleration and deceleration along the path, in BLU/s².
    pub gains: [f64; 2],
    /// Jerk along the path, in BLU/s³; `None` of trapezoids.
    pub jerk: Option<f64>,
    n: u32,
    pulse_bits: u32,
    gain_bits: u32,
    hz: f64,
}

/// How a part of a block is to be run; speeds along the path in BLU/s.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Profile {
    /// Speed at its start, on the way and at its end.
    pub speeds: [f64; 3],
    /// Speed from which an axis can start and at which it can stop.
    pub jump: f64,
    /// Pulses of the source for a BLU of the path.
    pub pulses_per_blu: f64,
    /// The same of the part before.
    pub before: f64,
    /// Pulses of the source up to the end of the ramp.
    pub pulses: f64,
    /// Those of the part itself, where the ramp goes over more.
    pub own: f64,
}

/// The scale of the path: pulses of one BLU each.
fn scale(options: &Options) -> Scale {
    let hz = options.clock_hz.map_or(1e6, Millionths::units);
    Scale { hz, per_mm: 1.0 / options.blu_mm.unwrap_or(1e-3) }
}

/// In mm and seconds.
fn physical(model: &'static str, option: &'static str, quantity: Quantity, example: &str) -> Result<f64, ModelError> {
    quantity.mm().ok_or_else(|| ModelError::Value {
        model,
        option,
        value: quantity.to_string(),
        reason: format!("a program has no registers to count in before it is planned: give a unit, such as {example}"),
    })
}

/// Plans the ramp of a machine whose blocks take up to `most` pulses, and up to `per_blu` for a BLU, if it has one.
pub(super) fn plan(plan: &mut Plan, [most, per_blu]: [u64; 2]) -> Result<(), ModelError> {
    let model = plan.model();
    let (gains, jerk) = (plan.get(&ACCEL), plan.get(&JERK));
    let Some(gains) = gains else {
        return match jerk {
            None => Ok(()),
            Some(jerk) => Err(ModelError::Value {
                model,
                option: JERK.name,
                value: jerk.to_string(),
                reason: "a jerk is that of an acceleration: give --accel too, or leave it out".to_owned(),
            }),
        };
    };
    if AXES[..plan.axes()].contains(&V.name()) {
        return Err(ModelError::Widths(format!(
            "{model}: with --accel the register v is a speed, and the program moves an axis V or W: leave --accel or these \
             axes out"
        )));
    }
    for gain in gains.both() {
        physical(model, ACCEL.name, gain, "500mm/s2")?;
    }
    let scale = scale(plan.options());
    let n = match jerk {
        Some(jerk) => {
            physical(model, JERK.name, jerk, "20000mm/s3")?;
            scale.least_bits(&[jerk], 3)
        }
        None => scale.least_bits(&gains.both(), 2),
    };
    let n = n.filter(|n| *n <= MOST_BITS).ok_or_else(|| {
        ModelError::Widths(format!(
            "{model}: an acceleration or a jerk as low as this needs a phase of more than {MOST_BITS} bits: give a greater \
             one, a lower --clock-hz or a smaller --blu"
        ))
    })?;
    let n = n.max(2);
    plan.constants.push((BITS, n.into()));
    let greatest = gains.both().map(|gain| scale.word(gain, 2, n)).into_iter().max().unwrap_or(1);
    plan.constants.push((GAIN_BITS, bits(greatest.saturating_mul(per_blu)).clamp(1, n).into()));
    // Along S curves a ramp goes over several blocks: four times the way in which the greatest speed is braked.
    let slowest = gains.both().into_iter().filter_map(Quantity::mm).fold(f64::INFINITY, f64::min);
    let chain = jerk.map_or(0, |_| rounded(0.5 / scale.exact(slowest, 2, 0)).min(1 << MOST_CHAIN));
    plan.constants.push((PULSE_BITS, bits(most.saturating_add(1).max(chain)).into()));
    // The slowest speed that is loaded may be 1.
    plan.stall_clocks = u64::MAX;
    Ok(())
}

impl Acceleration {
    /// That of a machine; `None` of one that runs at its feed at once.
    #[must_use]
    pub fn of(hardware: &Hardware) -> Option<Acceleration> {
        let scale = scale(&hardware.options);
        let blu = |quantity: Quantity| quantity.mm().map(|mm| mm * scale.per_mm);
        let [up, down] = hardware.get(&ACCEL)?.both().map(blu);
        let size = |name| u32::try_from(hardware.constant(name)).unwrap_or(0);
        Some(Acceleration {
            gains: [up?, down?],
            jerk: hardware.get(&JERK).and_then(blu),
            n: size(BITS),
            pulse_bits: size(PULSE_BITS),
            gain_bits: size(GAIN_BITS),
            hz: scale.hz,
        })
    }

    /// The widths of its registers.
    pub(crate) fn bits(&self) -> RampBits {
        let n = self.n;
        let curve = self.jerk.map(|_| SCurveBits {
            change: n,
            ticks: MOST_WORD,
            growth: [n; 2],
            parts: [MOST_WORD - 2; 4],
            length: MOST_WORD,
        });
        RampBits {
            phase: n,
            v: n,
            most: 1 << (n - 1),
            gains: [0, 1].map(|gain| (PATH_GAINS.of(gain).name(), n)),
            curve,
        }
    }

    /// Bits of the pulses of a block.
    pub(crate) fn pulse_bits(&self) -> u32 {
        self.pulse_bits
    }

    /// The most pulses of a ramp that goes over several blocks.
    #[must_use]
    pub fn most_pulses(&self) -> f64 {
        ((1_u64 << self.pulse_bits) - 1) as f64
    }

    /// The greatest speed along the path in BLU/s: a pulse every second clock.
    #[must_use]
    pub fn fastest(&self, pulses_per_blu: f64) -> f64 {
        self.hz / 2.0 / pulses_per_blu
    }

    /// The speed in BLU/s from which an axis can start, if nothing else is known of it: sqrt(a), the least with which no pulse is
    /// waited for.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.gains[0].max(self.gains[1]).sqrt()
    }

    /// The words of the ramp for a part that runs alone, as fast as it can.
    pub(super) fn alone(&self, pulses: f64, length: f64) -> Words {
        let pulses_per_blu = pulses / length;
        let (jump, fastest) = (self.start(), self.fastest(pulses_per_blu));
        let [first, last] = [jump.min(fastest); 2];
        self.words(&Profile {
            speeds: [first, fastest, last],
            jump: first,
            pulses_per_blu,
            before: pulses_per_blu,
            pulses,
            own: pulses,
        })
        .0
    }

    /// The words of the ramp for a part of a block, and the frequency in Hz that its source has on the way.
    #[must_use]
    pub fn words(&self, profile: &Profile) -> (Words, f64) {
        let Profile { speeds, jump, pulses_per_blu: k, before, pulses, own } = *profile;
        let (unit, most) = (self.unit(), (1_u64 << self.n) - 1);
        let drive = rounded(speeds[1] * k * unit).clamp(1, 1 << (self.n - 1));
        let [mut start, mut stop, restart] =
            [speeds[0], speeds[2], jump].map(|v| rounded(v * k * unit).clamp(1, drive));
        let mut gains = self.gains(k);
        let left = self.counted(pulses);
        let ratio = rounded(k / before * 2f64.powi(RATIO_FRACTION.cast_signed())).min((1 << RATIO_BITS) - 1);
        let mut words = Words::new().set(PULSES, left).set(RESTART, restart).set(RATIO, ratio);
        let mut first = start;
        if let Some(jerk) = self.jerk {
            let jerk = rounded(jerk * k * unit / self.hz / self.hz).clamp(1, most);
            let limit = gains[0].min(gains[1]);
            let block = SBlock::new([start, drive, stop], jerk, limit, u128::from(left) << self.n);
            let SBlock { up, down, length, .. } = block;
            (start, stop, first) = (block.start, block.stop, block.start);
            gains = [up, down].map(|ramp: SRamp| if ramp.ticks() == 0 { limit } else { ramp.most() });
            let length = i128::try_from(length).unwrap_or(i128::MAX).min((1 << MOST_WORD) - 1);
            words = words.set(TICKS, up.ticks()).set_each(GROWTH, [up.j, down.j]);
            words = words.set_each(PARTS, [up.m, up.h, down.m, down.h]).set(LENGTH, length);
            words = words.set(CARRY, false).set(OWN_PULSES, self.counted(own));
        }
        let words = words.set(V, first).set_each(LIMITS, [start, drive, stop]).set_each(PATH_GAINS, gains);
        (words, drive as f64 / unit)
    }

    /// A speed of 1 Hz as a word.
    fn unit(&self) -> f64 {
        2f64.powi(self.n.cast_signed()) / self.hz
    }

    /// The gains along the path as words, where a BLU has this many pulses.
    fn gains(&self, pulses_per_blu: f64) -> [u64; 2] {
        let greatest = (1 << self.gain_bits) - 1;
        self.gains.map(|gain| rounded(gain * pulses_per_blu * self.unit() / self.hz).clamp(1, greatest))
    }

    /// A number of pulses as its register holds it.
    fn counted(&self, pulses: f64) -> u64 {
        rounded(pulses.ceil()).min((1 << self.pulse_bits) - 1)
    }

    /// The words of the ramp for a part over which that of a part before goes: they count after a hold, an override or a stop,
    /// and make it a trapezoid. Its speeds are the greatest at its start and end from which the end of the ramp can be met.
    #[must_use]
    pub fn carried(&self, profile: &Profile) -> (Words, f64) {
        let Profile { speeds: [start, drive, stop], jump, pulses_per_blu: k, pulses, own, .. } = *profile;
        let (unit, most) = (self.unit(), 1 << (self.n - 1));
        let [drive, start, stop] = [drive, start, stop].map(|v| rounded(v * k * unit).clamp(1, most));
        let restart = rounded(jump * k * unit).clamp(1, drive);
        let [pulses, own] = [pulses, own].map(|pulses| self.counted(pulses));
        let words = Words::new().set(PULSES, pulses).set(OWN_PULSES, own).set(RESTART, restart).set(CARRY, true);
        let words = words.set(RATIO, 1_u64 << RATIO_FRACTION).set(TICKS, 0).set_each(GROWTH, [0; 2]);
        let words = words.set_each(PARTS, [0; 4]).set(LENGTH, 0).set(V, start);
        (words.set_each(LIMITS, [restart, drive, stop]).set_each(PATH_GAINS, self.gains(k)), drive as f64 / unit)
    }
}
