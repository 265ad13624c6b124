//! A line in space, 3 axes or more: every axis is judged against the longest one, by a deviation of its own.

use stepwave_nc::Line;
use stepwave_netlist::dsl::{Scope, Signal};

use super::{BeatRing, Block, DeviationAccumulator, LONGEST, POSITION, SIGN, axis_scope};
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::options::BEATS;
use crate::per_axis;
use crate::registers::{N, PerAxis, Reg, Where};

/// Hardware of two axes.
pub static IN_PLANE: Where = Where("2 axes", |plan| plan.axes() == 2);
/// Hardware of more axes than two.
pub static IN_SPACE: Where = Where("3 axes or more", |plan| plan.axes() > 2);

/// Displacement of the longest axis.
pub const LONG: Reg = Reg::new("l", N, "displacement L of the longest axis");
/// Displacements of all axes.
pub const TRAVEL: PerAxis = Reg::each(per_axis!("", "e"), N, "displacement S of each axis");
/// Deviations of all axes; that of the longest stays 0.
pub const DEVIATION: PerAxis =
    Reg::each(per_axis!("f"), N.plus(1), "deviation of each axis from the longest one").signed().when(&IN_SPACE);

/// The axes of a line in space, with the deviation of each from the longest one.
///
/// - `l`: displacement L of the longest axis. For each axis `xe`, …: its displacement S; `fx`, …: its deviation, two's
///   complement, 0 of the longest axis; `x_is_longest`, `sx`, …, 1 bit each.
#[derive(Clone, Debug)]
pub struct SpaceLine<'m> {
    /// The beats of a step.
    pub beat: BeatRing<'m>,
    axes: Vec<SpaceAxis<'m>>,
}

/// One axis of them.
#[derive(Clone, Copy, Debug)]
pub struct SpaceAxis<'m> {
    /// 1 bit: it is the longest one.
    pub is_longest: Signal<'m>,
    /// 1 bit: its deviation is 0 or more.
    pub not_negative: Signal<'m>,
    /// L and S, unsigned.
    pub travels: [Signal<'m>; 2],
    m: Scope<'m>,
    f: DeviationAccumulator<'m>,
}

impl<'m> SpaceLine<'m> {
    /// The registers of all axes.
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware) -> SpaceLine<'m> {
        let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
        let long = hardware.held(m, block, LONG);
        let axis = |axis: usize| {
            let m = axis_scope(m, axis);
            let f = DeviationAccumulator::of(m, DEVIATION.of(axis), hardware);
            SpaceAxis {
                is_longest: hardware.held(m, block, LONGEST.of(axis)),
                not_negative: f.not_negative(),
                travels: [long, hardware.held(m, block, TRAVEL.of(axis))],
                m,
                f,
            }
        };
        SpaceLine { beat, axes: (0..hardware.axes).map(axis).collect() }
    }

    /// The axes, in order.
    #[must_use]
    pub fn axes(&self) -> &[SpaceAxis<'m>] {
        &self.axes
    }

    /// What the judge beat decides for each axis (1 bit each), valid in the beats after it.
    #[must_use]
    pub fn decided(&self, judged: &[Signal<'m>]) -> Vec<Signal<'m>> {
        let names = per_axis!("take_");
        names.iter().zip(judged).map(|(name, judged)| self.beat.decided(name, *judged)).collect()
    }

    /// Closes pulses and deviations: the feed beat steps the axes `taken` (1 bit each), the compute beat adds to the
    /// deviation of each axis but the longest what `change` gives for it, two's complement.
    pub fn close(
        &self,
        block: &Block<'m>,
        hardware: &Hardware,
        taken: &[Signal<'m>],
        change: impl Fn(&SpaceAxis<'m>, Signal<'m>) -> Signal<'m>,
    ) {
        for (i, (axis, taken)) in self.axes.iter().zip(taken).enumerate() {
            let m = axis.m;
            let negative = hardware.held(m, block, SIGN.of(i));
            hardware.axis(m, block, i, self.beat.feed & *taken, negative);
            let operand = m.name("operand", change(axis, *taken));
            axis.f.close_adding(block, self.beat.compute & !axis.is_longest, operand);
        }
    }
}

/// The words of a line whose longest axis is this one. `deviation` gives the first deviation of another axis from L
/// and S.
pub(crate) fn space_words(line: &Line, longest: usize, deviation: impl Fn(i128, i128) -> i128) -> Words {
    let travels: Vec<i128> = line.delta().into_iter().map(|d| i128::from(d).abs()).collect();
    let long = travels.get(longest).copied().unwrap_or(0);
    let axes = line.delta().into_iter().zip(line.from()).zip(travels).enumerate();
    axes.fold(Words::new().set(LONG, long), |words, (axis, ((delta, from), travel))| {
        let f = if axis == longest { 0 } else { deviation(long, travel) };
        let words = words.set(TRAVEL.of(axis), travel).set(DEVIATION.of(axis), f).set(SIGN.of(axis), delta < 0);
        words.set(LONGEST.of(axis), axis == longest).set(POSITION.of(axis), *from)
    })
}
