//! What is loaded into every machine that interpolates in a plane.

use stepwave_nc::{Arc, Crossing, Curve, Direction, Plane, PulseBlock, Sector};

use super::frame::{MODE, THIRD_SIGN};
use super::{HardwareBlock, Paced, Size};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::Interpolates;
use crate::machine::Words;
use crate::options::{END_POINT, EndPoint, Preset};
use crate::parts::{CCW, END, F, PLANE, POSITION, QUAD, REST, SHARE, WHOLE, XI_YI};
use crate::plan::Plan;
use crate::registers::{Reg, Registers};

/// A line, or one sector of an arc, as its machine starts it.
pub(super) struct Start {
    /// Pulses of the first and the second axis of the plane.
    pub(super) pulses: [i128; 2],
    /// Magnitudes of the coordinates about the centre, in BLU; 0 on a line.
    pub(super) start: [i128; 2],
    /// x² + y² - R² there, in BLU²; 0 on a line.
    pub(super) deviation: i128,
    /// The first coordinate grows along the sector.
    pub(super) x_grows: bool,
    /// The angle of the sector in radians; 0 on a line.
    pub(super) angle: f64,
}

/// Plans end point, third axis and positions.
pub(super) fn common_plan(plan: &mut Plan, size: &Size) {
    plan.positions(size.positions);
    plan.fix(&END_POINT, EndPoint::PerAxis);
    plan.usual_preset(Preset::Half);
}

/// The registers of a machine that judges its steps by a deviation.
pub(super) const JUDGED: Registers = &[&MODE, &PLANE, &QUAD, &F, &XI_YI, &END.pair(), &WHOLE, &POSITION];

/// The moves of a machine that judges its steps by a deviation; a commanded feed sets the frequency of its pulse source.
pub(super) const fn judging(
    crossing: Crossing,
    load: fn(&PulseBlock, &Hardware) -> Vec<HardwareBlock>,
    error_bound: fn(&Hardware, &PulseBlock) -> Option<f64>,
) -> Interpolates {
    Interpolates::Moves(Paced {
        arcs: Some(crossing),
        direct: true,
        plan: judged,
        // Those of both axes of a sector.
        most_steps: |size, _| [size.magnitude.saturating_mul(2), 1],
        load,
        error_bound,
    })
}

/// Plans a machine that judges its steps by a deviation `f`, with the coordinates or displacements `xi` and `yi`.
fn judged(size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
    plan.n = plan.magnitude_bits(size.magnitude);
    common_plan(plan, size);
    Ok(())
}

/// Most bits of a machine whose blocks take 2^n steps: at a step every second clock they end within 2^53 clocks.
const SCALE_BITS: u32 = 52;

/// Clocks without a pulse after which none will come, of a machine whose blocks take 2^n steps in registers of this many bits:
/// a step every second clock, after the buffer is ready.
pub(super) fn stall_clocks(bits: u32) -> u64 {
    2u64.checked_shl(bits).unwrap_or(u64::MAX).saturating_add(u64::from(bits) + 16)
}

/// Checks registers that share one scale: they are equally wide, and where it is `fixed` for all blocks, these end.
pub(super) fn one_scale(plan: &Plan, registers: &[Reg], fixed: bool) -> Result<(), ModelError> {
    let (Some((last, others)), name) = (registers.split_last(), plan.model()) else { return Ok(()) };
    let bits = plan.bits(*last);
    if others.iter().any(|other| plan.bits(*other) != bits) {
        let others = others.iter().map(|other| other.name()).collect::<Vec<_>>().join(", ");
        let last = last.name();
        return Err(ModelError::Widths(format!(
            "{name}: {others} and {last} share one scale and must be equally wide: give one --width"
        )));
    }
    if fixed && bits > SCALE_BITS {
        return Err(ModelError::Widths(format!(
            "{name}: a block takes 2^{bits} steps in registers of {bits} bits, at least two clocks each, and would not end \
             within 2^53 clocks: give --width {SCALE_BITS} or less"
        )));
    }
    Ok(())
}

/// The blocks of the machine for a block of the program: one for a line, one for each sector of an arc. `own` gives the
/// words of the method, and the steps that the interpolator takes.
pub(super) fn blocks(
    crossing: Crossing,
    block: &PulseBlock,
    own: impl Fn(&Start) -> (Words, f64),
) -> Vec<HardwareBlock> {
    match &block.curve {
        Curve::Line(line) => {
            let delta: Vec<i128> = line.delta().into_iter().map(i128::from).collect();
            let [dx, dy, third] = [0, 1, 2].map(|axis| delta.get(axis).copied().unwrap_or(0));
            let start = Start { pulses: [dx.abs(), dy.abs()], start: [0; 2], deviation: 0, x_grows: false, angle: 0.0 };
            let quad = match (dx < 0, dy < 0) {
                (false, false) => 0,
                (true, false) => 1,
                (true, true) => 2,
                (false, true) => 3,
            };
            let (words, steps) = own(&start);
            let common = common(block, Words::new().set(MODE, 1).set(QUAD, quad).set(CCW, false), start.pulses, third);
            vec![HardwareBlock { words: words.and(common), steps, length: line.length() }]
        }
        Curve::Arc(arc) => sectors(crossing, block, arc, |_, _| 0, &own),
        Curve::Helix(helix) => {
            let all = helix.sectors();
            let sign = helix.z_travel().signum();
            let third = |index: usize, _: &Sector| {
                let after = all.get(index).map_or(0, |sector| sector.z_steps);
                let before = index.checked_sub(1).and_then(|index| all.get(index)).map_or(0, |sector| sector.z_steps);
                i128::from(sign * (after - before))
            };
            sectors(crossing, block, helix.arc(), third, &own)
        }
        _ => Vec::new(),
    }
}

fn sectors(
    crossing: Crossing,
    block: &PulseBlock,
    arc: &Arc,
    third: impl Fn(usize, &Sector) -> i128,
    own: &impl Fn(&Start) -> (Words, f64),
) -> Vec<HardwareBlock> {
    let all = arc.sectors(crossing);
    let travels: Vec<i128> = all.iter().enumerate().map(|(index, sector)| third(index, sector)).collect();
    let begin = |(sector, third): (&Sector, i128)| {
        let [x, y] = sector.start.map(i128::from);
        let [start, end] = [sector.start, sector.end].map(|point| point.map(|c| c as f64));
        let turn = start[0] * end[1] - start[1] * end[0];
        let angle = turn.abs().atan2(start[0] * end[0] + start[1] * end[1]);
        let at = Start {
            pulses: sector.steps().map(i128::from),
            start: [x.abs(), y.abs()],
            deviation: x * x + y * y - arc.radius_squared(),
            x_grows: sector.quadrant.growing_axis(arc.direction()) == 0,
            angle,
        };
        let ccw = arc.direction() == Direction::CounterClockwise;
        let mode = Words::new().set(MODE, 2).set(QUAD, sector.quadrant.index()).set(CCW, ccw);
        let (words, steps) = own(&at);
        let length = f64::hypot(arc.radius() * angle, third as f64);
        HardwareBlock { words: words.and(common(block, mode, at.pulses, third)), steps, length }
    };
    all.iter().zip(travels).map(begin).filter(|block| block.has_pulses()).collect()
}

/// Words that every machine in a plane has.
fn common(block: &PulseBlock, mode: Words, [ex, ey]: [i128; 2], third: i128) -> Words {
    let plane = match block.plane {
        Plane::Xy => 0,
        Plane::Zx => 1,
        Plane::Yz => 2,
    };
    let whole = ex + ey;
    let words = mode.set(PLANE, plane).set_each(END.pair(), [ex, ey]).set(WHOLE, whole);
    words.set(SHARE, third.abs()).set(REST, whole / 2).set(THIRD_SIGN, third < 0)
}

/// Greatest distance from a curve in BLU, where it is `plane` in the plane and a third axis follows within a pulse.
pub(super) fn bound(block: &PulseBlock, plane: f64) -> f64 {
    let third = block.plane.axes()[2];
    if block.from[third] == block.to[third] { plane } else { plane + 1.0 }
}

/// Steps of a motion that always moves its faster axis: of a sector, ∫ max(|cos|, |sin|) R dφ.
pub(super) fn longest_steps(at: &Start) -> f64 {
    let [ex, ey] = at.pulses.map(|pulses| pulses as f64);
    if at.angle == 0.0 {
        return ex.max(ey);
    }
    // Where the sector passes 45° the axes change their parts: |x| + |y| at its ends and √2·R between tell how far.
    let [x, y] = at.start.map(|c| c as f64);
    let radius = f64::hypot(x, y);
    let (end_x, end_y) = if at.x_grows { (x + ex, y - ey) } else { (x - ex, y + ey) };
    let diagonal = radius / std::f64::consts::SQRT_2;
    let passes = (x < y) != (end_x < end_y);
    if !passes {
        return ex.max(ey);
    }
    // The displacement of each axis to the 45° point, and from there.
    let before = (x - diagonal).abs().max((y - diagonal).abs());
    let after = (end_x - diagonal).abs().max((end_y - diagonal).abs());
    before + after
}
