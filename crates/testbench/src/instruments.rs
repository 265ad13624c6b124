//! Instruments: cells added to a machine that follow its path while it runs in lanes, so that the path error of every
//! step is known without a position leaving the lane.
//!
//! They are in a copy of the machine's netlist, in the scope `gauge`, and take its signed pulses:
//!
//! ```text
//! line     d ± gain_x on an X pulse, ± gain_y on a Y pulse;  gain_x = -dy, gain_y = dx, d = dx·y - dy·x from the start
//! circle   d ± t + 1 on a pulse of an axis, whose t = 2·x or 2·y about the centre then changes by ±2;  d = x² + y² -
//! R²
//! ```
//!
//! The distance from a line is |d| over its length, that from a circle a function of d that only grows, so that the
//! extremes of d over all steps give the greatest error, in real numbers from exact integers.

use stepwave_engine::lanes::{Observe, ROOT_GAP_UNIT, root_gap};
use stepwave_models::CurveKind;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_nc::{Arc, Curve, Line};
use stepwave_netlist::cells::Op;
use stepwave_netlist::dsl::{Module, Scope, Signal};
use stepwave_netlist::{Design, Net, OnOverflow, Width, elaborate};

use super::measure::Measured;
use super::{Ending, LaneOutcome, Testbench};

/// What the instruments measure against, and the inputs that hold it.
#[derive(Clone, Debug)]
enum Ideal {
    /// One axis, which leaves no line: d is 0.
    Axis,
    /// Gain of each axis.
    Line([Net; 2]),
    /// Twice the start of each axis about the centre, and the square of the radius.
    Circle { start: [Net; 2], square: Net },
}

/// The instruments of one hardware.
#[derive(Clone, Debug)]
pub(super) struct Instruments {
    design: Design,
    ideal: Ideal,
    /// After each step, else 0: |d| of a line, d of a circle.
    seen: Net,
    /// After all that is judged: the same, or after every clock where a step has many pulses.
    judged: Net,
    /// d in this sample.
    deviation: Net,
    /// Bits of d, and of a sum over all steps.
    bits: [u32; 2],
    /// A relative coordinate is less than 2 to this power.
    reach: u32,
    pulses: Vec<Net>,
    /// Completes a step.
    stepped: Net,
    /// 1 in each sample before row 0 of the step table; `None` where that is the sample after the load, of clock 1.
    waits: Option<Net>,
    /// Flags and names of all properties.
    properties: Vec<(Net, String)>,
    traps: bool,
}

impl Instruments {
    /// Those for a bench; `None` where its curves are neither circles nor lines of one or two axes, or too large.
    pub(super) fn new(bench: &Testbench, kind: CurveKind) -> Option<Instruments> {
        let machine = bench.machine();
        let pulses: Vec<Net> = machine.pulses.iter().map(|port| port.net).collect();
        if machine.pulses.iter().any(|port| port.width.get() != 2) {
            return None;
        }
        let reach = machine.positions.iter().map(|port| port.width.get()).max()?;
        let bits = 2 * reach + 2;
        if bits > Width::MAX.get() {
            return None;
        }
        let module = Module::continuing(bench.design().netlist().clone());
        let m = module.top().scope("gauge");
        let step = |pulse: &Net| PulseNets::of(m.net(*pulse, true));
        let stepped = m.net(machine.stepped.net, false);
        let loads = m.net(machine.load.net, false) & m.net(machine.preset_position.net, false);
        let (ideal, deviation, seen) = match (kind, &pulses[..]) {
            (CurveKind::Axis, [_]) => (Ideal::Axis, m.lit_signed(bits, 0), m.lit(bits, 0)),
            (CurveKind::Line { .. }, [x, y]) => line(m, bits, [x, y].map(step)),
            (CurveKind::Arc, [x, y]) => circle(m, bits, [x, y].map(step), loads),
            _ => return None,
        };
        let waits = (!follows_load(bench)).then(|| {
            let begun = m.reg("begun", 1);
            let now = begun.q | stepped | m.net(machine.loaded.net, false);
            begun.set(now);
            (!now).net()
        });
        let every = bench.hardware().sampling.is_some().then(|| seen.net());
        let seen = stepped.mux(seen, m.lit(bits, 0)).net();
        let deviation = deviation.net();
        let properties = bench.design().netlist().properties.iter();
        Some(Instruments {
            ideal,
            seen,
            judged: every.unwrap_or(seen),
            deviation,
            // A full circle of radius 2^(reach - 2) takes 2^(reach + 1) steps, each less than 2 BLU or 2^17 units off.
            bits: [bits, (reach + 18).min(Width::MAX.get())],
            reach,
            pulses,
            stepped: machine.stepped.net,
            waits,
            properties: properties.map(|property| (property.never, property.name.clone())).collect(),
            traps: bench.hardware().get(&ON_OVERFLOW) == OnOverflow::Trap,
            design: elaborate(module.finish().ok()?).ok()?,
        })
    }

    /// The machine with its instruments; all nets of the machine are what they were.
    pub(super) fn design(&self) -> &Design {
        &self.design
    }

    /// The numbers that [`read`](Self::read) wants.
    pub(super) fn observe(&self) -> Vec<Observe> {
        let (net, judged, bits) = (self.seen, self.judged, self.bits[1]);
        let path = match self.ideal {
            Ideal::Axis | Ideal::Line(_) => {
                [Observe::Last(net), Observe::Max { net: judged, signed: false }, Observe::Sum { net, bits: 32 }]
            }
            Ideal::Circle { square, .. } => [
                Observe::Min { net: judged, signed: true },
                Observe::Max { net: judged, signed: true },
                Observe::RootGaps { base: square, offset: net, bits },
            ],
        };
        let gaps = self.pulses.iter().flat_map(|&net| [Observe::LeastGap(net), Observe::GreatestGap(net)]);
        let never = self.properties.iter().map(|&(never, _)| Observe::Last(never));
        let rows = self.waits.map(|net| Observe::Count(vec![net])).into_iter().chain([Observe::Since(self.stepped)]);
        path.into_iter().chain([Observe::Last(self.deviation)]).chain(gaps).chain(rows).chain(never).collect()
    }

    /// What the inputs are to hold for a geometry; `None` where it is too large.
    pub(super) fn words(&self, curve: &Curve) -> Option<Vec<(Net, u64)>> {
        let numbers = match (&self.ideal, curve) {
            (Ideal::Axis, Curve::Line(_)) => Vec::new(),
            (Ideal::Line(gain), Curve::Line(line)) => {
                let [dx, dy] = <[i64; 2]>::try_from(line.delta()).ok()?.map(|travel| self.reached(travel));
                vec![(gain[0], -dy?), (gain[1], dx?)]
            }
            (Ideal::Circle { start, square }, Curve::Arc(arc)) => {
                // So that every position, of any width, is within reach of the centre.
                let far = |&c: &i64| c.unsigned_abs() >= 1 << (self.reach - 1);
                if arc.center().iter().any(far) {
                    return None;
                }
                let [x, y] = arc.start().map(|travel| self.reached(travel));
                vec![(start[0], 2 * x?), (start[1], 2 * y?), (*square, i64::try_from(arc.radius_squared()).ok()?)]
            }
            _ => return None,
        };
        Some(numbers.into_iter().map(|(net, number)| (net, number.cast_unsigned())).collect())
    }

    /// A coordinate, if it is within reach.
    fn reached(&self, travel: i64) -> Option<i64> {
        (travel.unsigned_abs() < 1 << self.reach).then_some(travel)
    }

    /// What was measured of a run; `None` where the instruments cannot have followed it.
    pub(super) fn read(
        &self,
        bench: &Testbench,
        curve: &Curve,
        outcome: LaneOutcome,
        values: &[u64],
    ) -> Option<Measured> {
        if outcome.ending.is_none() {
            return Some(Measured::given_up(self.pulses.len(), outcome.clocks));
        }
        self.words(curve)?;
        let trapped = outcome.ending == Some(Ending::Trapped);
        // A position that has left its register is where no pulse led.
        if outcome.overflows > 0 && !trapped {
            return None;
        }
        let ([least, greatest, sum, last], rest) = values.split_first_chunk::<4>()?;
        let width = Width::new(self.bits[0].into()).ok()?;
        let signed = |bits: u64| stepwave_netlist::bits::to_signed(width, bits);
        if i128::from(signed(*last)) != reached(curve, &outcome.reached)? {
            return None;
        }
        let (worst, mean, most) = match curve {
            Curve::Line(line) => {
                let length = line.length();
                (*greatest as f64 / length, *sum as f64 / length, *greatest)
            }
            Curve::Arc(arc) => {
                let square = arc.radius_squared();
                let at = |offset: i64| {
                    let gap = arc.signed_deviation_at((square + i128::from(offset)).unsigned_abs()).abs();
                    (gap, root_gap(square as f64, offset as f64))
                };
                let ((inside, near), (outside, far)) = (at(signed(*least)), at(signed(*greatest)));
                (inside.max(outside), *sum as f64 / ROOT_GAP_UNIT, near.max(far))
            }
            _ => return None,
        };
        // What 32 bits may not have held.
        if u128::from(most) * u128::from(outcome.steps) >= 1 << 32 && !self.has_wide_sums() {
            return None;
        }
        let (gaps, rest) = rest.split_at_checked(2 * self.pulses.len())?;
        let (rows, never) = rest.split_at_checked(1 + usize::from(self.waits.is_some()))?;
        let (first, since) = if let &[waits, since] = rows { (waits, since) } else { (1, *rows.first()?) };
        let clocks = outcome.clocks.saturating_sub(since).saturating_sub(first);
        let flagged = || never.iter().zip(&self.properties).filter(|(flag, _)| **flag == 1);
        let mut measured = Measured {
            greatest: Some(worst),
            mean: (outcome.steps > 0).then(|| mean / outcome.steps as f64),
            overflows: if self.traps { flagged().count() as u64 } else { 0 },
            component: flagged().next().filter(|_| self.traps).map(|(_, (_, name))| name.clone()),
            spacing: gaps.chunks(2).map(|gap| (gap[0] > 0).then_some([gap[0], gap[1]])).collect(),
            ..Measured::unfinished(outcome)
        };
        measured.take_speed(bench, curve, clocks);
        Some(measured)
    }

    fn has_wide_sums(&self) -> bool {
        self.bits.iter().any(|&bits| bits > 32)
    }
}

/// The strobe `loaded` is 1 in the very sample after an edge that loads.
fn follows_load(bench: &Testbench) -> bool {
    let machine = bench.machine();
    let cell = bench.design().netlist().cell(machine.loaded.net);
    matches!(cell.op, Op::Register { next: Some(next), .. } if next == machine.load.net)
}

/// The sign of the pulse of an axis; 1 bit each.
#[derive(Clone, Copy)]
struct PulseNets<'m> {
    any: Signal<'m>,
    up: Signal<'m>,
    down: Signal<'m>,
}

impl<'m> PulseNets<'m> {
    /// Of a pulse of two bits: 0, 1 or -1.
    fn of(pulse: Signal<'m>) -> PulseNets<'m> {
        let (any, down) = (pulse.bit(0), pulse.bit(1));
        PulseNets { any, up: any & !down, down }
    }

    /// `value` plus `gain` upwards, minus `gain` downwards.
    fn moved(self, value: Signal<'m>, gain: Signal<'m>) -> Signal<'m> {
        let up = self.up.mux(value.wrapping_add(gain), value);
        self.down.mux(up.wrapping_sub(gain), up)
    }
}

/// d of a line and its magnitude.
fn line<'m>(m: Scope<'m>, bits: u32, pulses: [PulseNets<'m>; 2]) -> (Ideal, Signal<'m>, Signal<'m>) {
    let d = m.reg_signed("d", bits);
    let gain = ["gain_x", "gain_y"].map(|name| m.input_signed(name, bits));
    let now = pulses.iter().zip(gain).fold(d.q, |d, (pulse, gain)| pulse.moved(d, gain));
    d.set(now);
    let magnitude = now.msb().mux(m.lit_signed(bits, 0).wrapping_sub(now), now).as_unsigned();
    (Ideal::Line(gain.map(Signal::net)), now, magnitude)
}

/// d of a circle, twice.
fn circle<'m>(
    m: Scope<'m>,
    bits: u32,
    pulses: [PulseNets<'m>; 2],
    loads: Signal<'m>,
) -> (Ideal, Signal<'m>, Signal<'m>) {
    let d = m.reg_signed("d", bits);
    let start = ["start_x", "start_y"].map(|name| m.input_signed(name, bits));
    let mut now = d.q;
    for ((pulse, start), name) in pulses.into_iter().zip(start).zip(["twice_x", "twice_y"]) {
        let twice = m.reg_signed(name, bits);
        now = pulse.moved(now, twice.q);
        now = pulse.any.mux(now.wrapping_add(m.lit_signed(bits, 1)), now);
        twice.when(loads, start).otherwise(pulse.moved(twice.q, m.lit_signed(bits, 2)));
    }
    d.set(now);
    let ideal = Ideal::Circle { start: start.map(Signal::net), square: m.input("square", bits).net() };
    (ideal, now, now)
}

/// d at a position.
fn reached(curve: &Curve, position: &[i64]) -> Option<i128> {
    if position.len() == 1 {
        return Some(0);
    }
    let position = <[i64; 2]>::try_from(position).ok()?;
    Some(match curve {
        Curve::Line(line) => cross(line, position)?,
        Curve::Arc(arc) => offset(arc, position)?,
        _ => return None,
    })
}

/// dx·y - dy·x of a position about the start of a line of two axes, in BLU².
pub(super) fn cross(line: &Line, position: [i64; 2]) -> Option<i128> {
    let [dx, dy] = <[i64; 2]>::try_from(line.delta()).ok()?.map(i128::from);
    let offset = |axis: usize| i128::from(position[axis]) - i128::from(line.from()[axis]);
    Some(dx * offset(1) - dy * offset(0))
}

/// x² + y² - R² of a position about the centre of an arc, in BLU²; none where it is beyond all measure.
pub(super) fn offset(arc: &Arc, position: [i64; 2]) -> Option<i128> {
    let offset = |axis: usize| i128::from(position[axis]) - i128::from(arc.center()[axis]);
    let [x, y] = [offset(0).checked_pow(2)?, offset(1).checked_pow(2)?];
    x.checked_add(y)?.checked_sub(arc.radius_squared())
}
