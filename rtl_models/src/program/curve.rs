//! Free curves of a machine that runs programs: the cascaded integrators of `spline-dda`, built where the program has such
//! curves.
//!
//! A curve of 2^s steps is loaded in units of 2^-(3S) BLU, where S is the greatest s of the program: its differences are
//! shifted left by 3(S-s) bits, and stay exact. s is the least with which no axis is faster than a pulse a step anywhere on the
//! curve. The remainders begin at half a BLU, as every curve begins at a whole point; they end there too, at its end.

use stepwave_nc::{AXES_MAX, Curve, PulseBlock, Spline};
use stepwave_netlist::dsl::{Scope, Signal};

use super::frame::{Frame, MODE};
use super::{HardwareBlock, planar};
use crate::differences::{Differences, bits, followed_divisions};
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::parts::{
    CCW, E, FIRST_DIFFERENCE, MODULUS, Motion, ONE_PULSE, QUAD, SECOND_DIFFERENCE, THIRD_DIFFERENCE, cascade,
};
use crate::per_axis;
use crate::plan::Plan;
use crate::registers::{PerAxis, Reg, Rule, Where};

/// Most steps of a curve, as a power of two: p, q, r and their sums then fit in 64 bits, however small other curves are.
const MOST_DIVISIONS: u32 = 19;
/// Bits of the fraction in which sizes are counted.
const FRACTION: u32 = 3 * MOST_DIVISIONS;

/// S, the greatest s of a program.
const DIVISIONS: &str = "divisions";

static WITH_CURVES: Where =
    Where("where the program has G5 or G5.1", |plan: &Plan| plan.constants.iter().any(|(name, _)| *name == DIVISIONS));
const AS_LONGEST: Rule = Rule::Planned("as the curves need, 3S+2");
const AS_CURVES: Rule = Rule::Planned("as the curves need");
/// Remainders.
pub(super) const CURVE_REMAINDER: PerAxis = Reg::each(
    per_axis!("jc"),
    Rule::Planned("3S, 2^S the steps of the longest curve"),
    "remainder of each axis of a curve",
)
.when(&WITH_CURVES)
.follows(|_| true);
/// p, q and r.
pub(super) const CURVE_P: PerAxis = FIRST_DIFFERENCE
    .width(AS_LONGEST)
    .about("first difference of each axis of a curve in 2^-3S BLU")
    .when(&WITH_CURVES);
pub(super) const CURVE_Q: PerAxis =
    SECOND_DIFFERENCE.width(AS_CURVES).about("second difference of each axis of a curve").when(&WITH_CURVES);
pub(super) const CURVE_R: PerAxis =
    THIRD_DIFFERENCE.width(AS_CURVES).about("third difference of each axis of a curve, constant").when(&WITH_CURVES);
/// Steps.
pub(super) const CURVE_STEPS: Reg = E.width(Rule::Planned("S+1")).about("steps left of a curve").when(&WITH_CURVES);

/// What the cascaded integrators must hold for curves.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CurveSize {
    /// The greatest number of steps of one, as a power of two.
    divisions: u32,
    /// Least and greatest p, q and r, in 2^-57 BLU.
    ranges: [[i128; 2]; 3],
}

impl CurveSize {
    /// Of one curve; `None` of one that is too long for the registers, and of a chain of several.
    pub(super) fn of(spline: &Spline) -> Option<CurveSize> {
        let (s, axes) = loaded(spline)?;
        let ranges = axes.map(|axis| axis.raised(FRACTION - 3 * s).ranges(s));
        Some(CurveSize { divisions: s, ranges: joined(ranges[0], ranges[1]) })
    }

    /// What both need.
    pub(super) fn with(self, other: CurveSize) -> CurveSize {
        let divisions = self.divisions.max(other.divisions);
        CurveSize { divisions, ranges: joined(self.ranges, other.ranges) }
    }
}

fn joined(a: [[i128; 2]; 3], b: [[i128; 2]; 3]) -> [[i128; 2]; 3] {
    std::array::from_fn(|order| [a[order][0].min(b[order][0]), a[order][1].max(b[order][1])])
}

/// s of a curve, and the differences of its axes in 2^-3s BLU.
fn loaded(spline: &Spline) -> Option<(u32, [Differences; 2])> {
    let [segment] = spline.segments() else { return None };
    // Of a Bézier curve, whose coefficients are whole.
    let s = followed_divisions(segment, MOST_DIVISIONS).filter(|_| segment.divisor == 1)?;
    Some((s, segment.coefficients.map(|c| Differences::exact(c, s))))
}

/// Plans the integrators, if there are curves.
pub(super) fn plan(plan: &mut Plan, size: Option<CurveSize>) {
    let Some(CurveSize { divisions, ranges }) = size else { return };
    plan.constants.push((DIVISIONS, divisions.into()));
    plan.constants.push((MODULUS, 1 << (3 * divisions)));
    let remedy = "a difference that was cut owes more than a pulse a step: give wider p, q and r, or leave --width out";
    plan.remedies.push((ONE_PULSE, remedy.to_owned()));
    let [p, q, r] = ranges.map(|range| bits(range.map(|most| most >> (FRACTION - 3 * divisions))));
    plan.set_each(CURVE_P, p).set_each(CURVE_Q, q).set_each(CURVE_R, r).set(CURVE_STEPS, divisions + 1);
    plan.stall_clocks = plan.stall_clocks.max(planar::stall_clocks(divisions));
}

/// This hardware has them.
pub(super) fn has(hardware: &Hardware) -> bool {
    hardware.constant(DIVISIONS) > 0
}

/// With the words of integrators that have nothing to do, where the hardware has them.
pub(super) fn at_rest(hardware: &Hardware, words: Words) -> Words {
    if !has(hardware) {
        return words;
    }
    let all = [CURVE_REMAINDER, CURVE_P, CURVE_Q, CURVE_R].into_iter();
    all.fold(words.set(CURVE_STEPS, 0), |words, register| words.set_each(register.pair(), [0; 2]))
}

/// The words of a curve of G5 or G5.1; `still` are those of the method for lines and arcs, which has nothing to do.
pub(super) fn load(hardware: &Hardware, block: &PulseBlock, still: Words) -> Vec<HardwareBlock> {
    let Curve::Spline(spline) = &block.curve else { return Vec::new() };
    let Some((s, axes)) = loaded(spline) else { return Vec::new() };
    let finest = u32::try_from(hardware.constant(DIVISIONS)).unwrap_or(s);
    let half = hardware.constant(MODULUS) / 2;
    let mode = still.set(MODE, 3).set(QUAD, 0).set(CCW, false);
    let still = planar::common(hardware, block, mode, [0; 2], &[0; AXES_MAX]);
    let words = axes.into_iter().enumerate().fold(still, |words, (axis, differences)| {
        differences.raised(3 * finest.saturating_sub(s)).words(words, axis).set(CURVE_REMAINDER.of(axis), half)
    });
    vec![HardwareBlock {
        words: words.set(CURVE_STEPS, 1_i128 << s),
        steps: 2f64.powi(s.cast_signed()),
        length: block.length(),
    }]
}

/// What the integrators of curves make of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfCurve<'m> {
    /// 1 bit: the block is a curve.
    pub(super) is: Signal<'m>,
    /// Of both axes of the plane.
    pub(super) motions: [Motion<'m>; 2],
    /// 1 bit: it is the last of a curve.
    pub(super) last: Signal<'m>,
}

/// The integrators, where the hardware has them.
///
/// - `curve_x`, `curve_y`: `jcx`, `px`, `qx`, `rx` of one [cascade], which steps where the block is a curve.
/// - `e`: steps that are left of it.
pub(super) fn hardware<'m>(m: Scope<'m>, hardware: &Hardware, frame: &Frame<'m>) -> Option<OfCurve<'m>> {
    let is = frame.curve?;
    let step = frame.step & is;
    let motions = [0, 1].map(|axis| {
        let m = m.scope(["curve_x", "curve_y"][axis]);
        let [pulse, negative] = cascade(m, &frame.block, hardware, (axis, CURVE_REMAINDER.of(axis)), step);
        Motion { pulse, negative }
    });
    let last = hardware.counter(m, &frame.block, CURVE_STEPS).count(step);
    Some(OfCurve { is, motions, last })
}
