//! What is loaded into every machine that interpolates in a plane.

use stepwave_nc::{AXES_MAX, Arc, Crossing, Curve, Direction, PulseBlock, Sector, share};

use super::frame::MODE;
use super::{HardwareBlock, Paced, Size};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::Interpolates;
use crate::machine::Words;
use crate::options::{END_POINT, EndPoint, Preset};
use crate::parts::{
    CCW, END, F, FOLLOWER_SIGN, PLANE, POSITION, QUAD, REST, SHARE, WHOLE, XI_YI, followers_of, plane_bits, plane_index,
};
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
    plan.set(PLANE, plane_bits(plan.axes()));
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
        curves: false,
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
    hardware: &Hardware,
    block: &PulseBlock,
    own: impl Fn(&Start) -> (Words, f64),
) -> Vec<HardwareBlock> {
    let common = |mode, pulses, travels: &[i64]| common(hardware, block, mode, pulses, travels);
    match (&block.curve, block.curve.arc()) {
        (Curve::Line(_), _) => {
            let mut travels = block.axes[..2].iter().map(|&axis| i128::from(block.travel(axis)));
            let [dx, dy] = [(); 2].map(|()| travels.next().unwrap_or(0));
            let start = Start { pulses: [dx.abs(), dy.abs()], start: [0; 2], deviation: 0, x_grows: false, angle: 0.0 };
            let quad = match (dx < 0, dy < 0) {
                (false, false) => 0,
                (true, false) => 1,
                (true, true) => 2,
                (false, true) => 3,
            };
            let (words, steps) = own(&start);
            let mode = Words::new().set(MODE, 1).set(QUAD, quad).set(CCW, false);
            let common =
                common(mode, start.pulses, &followers(block).map(|axis| block.travel(axis)).collect::<Vec<_>>());
            vec![HardwareBlock { words: words.and(common), steps, length: block.length() }]
        }
        (_, Some(arc)) => sectors(crossing, block, arc, own, common),
        _ => Vec::new(),
    }
}

fn sectors(
    crossing: Crossing,
    block: &PulseBlock,
    arc: &Arc,
    own: impl Fn(&Start) -> (Words, f64),
    common: impl Fn(Words, [i128; 2], &[i64]) -> Words,
) -> Vec<HardwareBlock> {
    let third = block.axes.get(2).copied();
    let begin = |Piece { sector, pulses, travels }: Piece| {
        let [x, y] = sector.start.map(i128::from);
        let [start, end] = [sector.start, sector.end].map(|point| point.map(|c| c as f64));
        let turn = start[0] * end[1] - start[1] * end[0];
        let angle = turn.abs().atan2(start[0] * end[0] + start[1] * end[1]);
        let at = Start {
            pulses: pulses.map(i128::from),
            start: [x.abs(), y.abs()],
            deviation: x * x + y * y - arc.radius_squared(),
            x_grows: sector.quadrant.growing_axis(arc.direction()) == 0,
            angle,
        };
        let ccw = arc.direction() == Direction::CounterClockwise;
        let mode = Words::new().set(MODE, 2).set(QUAD, sector.quadrant.index()).set(CCW, ccw);
        let (words, steps) = own(&at);
        let climb =
            followers(block).zip(&travels).find(|(axis, _)| Some(*axis) == third).map_or(0, |(_, travel)| *travel);
        let length = f64::hypot(arc.radius() * angle, climb as f64);
        HardwareBlock { words: words.and(common(mode, at.pulses, &travels)), steps, length }
    };
    pieces(crossing, block, arc).into_iter().filter(|piece| piece.pulses != [0; 2]).map(begin).collect()
}

/// A sector of an arc, with the axes that follow it.
pub(super) struct Piece {
    sector: Sector,
    /// Pulses of the two axes of the plane.
    pub(super) pulses: [i64; 2],
    /// Signed travels of the [followers].
    pub(super) travels: Vec<i64>,
}

/// The sectors of an arc: each axis that follows goes evenly with the angle, to the nearest pulse at the end of each.
pub(super) fn pieces(crossing: Crossing, block: &PulseBlock, arc: &Arc) -> Vec<Piece> {
    let (mut gone, parts) = ([0; AXES_MAX], arc.parts());
    let piece = |(index, sector): (usize, Sector)| {
        let part = parts.get(index).copied().unwrap_or(1.0);
        let travel = |axis: usize| {
            let all = block.travel(axis);
            let to = all.signum() * share(all.abs(), part);
            to - std::mem::replace(&mut gone[axis], to)
        };
        Piece { sector, pulses: sector.steps(), travels: followers(block).map(travel).collect() }
    };
    arc.sectors(crossing).into_iter().enumerate().map(piece).collect()
}

/// The axes of the largest machine that follow those of the plane, in the order of the followers of the hardware.
fn followers(block: &PulseBlock) -> impl Iterator<Item = usize> {
    let plane = [block.axes[0], block.axes[1]];
    (0..AXES_MAX).filter(move |axis| !plane.contains(axis))
}

/// Words that every machine in a plane has, with the pulses of both axes that its end counters count. `travels` are those of the [followers].
pub(super) fn common(
    hardware: &Hardware,
    block: &PulseBlock,
    mode: Words,
    [ex, ey]: [i128; 2],
    travels: &[i64],
) -> Words {
    // Of a free curve no axis is one of these, nor follows; with 0 one would have a pulse in every step.
    let whole = (ex + ey).max(1);
    let plane = plane_index([block.axes[0], block.axes[1]]);
    let words = mode.set(PLANE, plane as i128).set_each(END.pair(), [ex, ey]).set(WHOLE, whole);
    let all = (0..followers_of(hardware.axes)).zip(travels);
    all.fold(words, |words, (index, &travel)| {
        let words = words.set(SHARE.of(index), travel.abs()).set(REST.of(index), whole / 2);
        words.set(FOLLOWER_SIGN.of(index), travel < 0)
    })
}

/// Greatest distance from a curve in BLU, where it is `plane` in the plane and every other axis follows within a pulse.
pub(super) fn bound(block: &PulseBlock, plane: f64) -> f64 {
    let following = block.axes[2..].iter().filter(|axis| block.travel(**axis) != 0).count();
    plane + (following as f64).sqrt()
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
