//! The pair of integrators that draws a curve of second order.

use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{
    Block, E, END, Iteration, JV, Normalized, axis_scope, integrator, population_count, shifted_left, up_down_counter,
};
use crate::hardware::Hardware;
use crate::options::{END_POINT, EndPoint};

/// What is particular to one axis of the curve.
#[derive(Clone, Copy, Debug)]
pub struct PairSide<'m> {
    /// 1 bit: the motion is negative.
    pub negative: Signal<'m>,
    /// 1 bit: a pulse of the other axis raises the integrand of this one; else it lowers it.
    pub raised: Signal<'m>,
    /// By how much, unsigned.
    pub unit: Signal<'m>,
}

/// Integrators of x and y, each of which corrects the integrand of the other.
///
/// - `jvx`, `jvy`, unsigned: integrands J_V. A pulse of y corrects jvx, one of x corrects jvy.
/// - `jrx`, `jry`, unsigned: remainders J_R.
/// - `ex` and `ey` with [`EndPoint::PerAxis`]: an exhausted axis stops adding and freezes its remainder. Else `e`, which
///   counts the pulses of both.
#[derive(Clone, Copy, Debug)]
pub struct IntegratorPair<'m> {
    m: Scope<'m>,
    block: Block<'m>,
    scopes: [Scope<'m>; 2],
    jv: [Register<'m>; 2],
}

impl<'m> IntegratorPair<'m> {
    /// The integrands.
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware) -> IntegratorPair<'m> {
        let scopes = [0, 1].map(|axis| axis_scope(m, axis));
        let jv = [0, 1].map(|axis| hardware.reg(scopes[axis], JV.of(axis)));
        IntegratorPair { m, block: *block, scopes, jv }
    }

    /// The integrands, equally wide.
    #[must_use]
    pub fn integrands(&self) -> [Signal<'m>; 2] {
        let wide = self.jv.map(|jv| jv.q.bits()).into_iter().max().unwrap_or(1);
        self.jv.map(|jv| jv.q.extend(wide))
    }

    /// Closes integrators, axes and end counters. Returns 1 bit: the end point is reached at this edge.
    #[must_use]
    pub fn close(self, hardware: &Hardware, normalized: Normalized<'m>, sides: [PairSide<'m>; 2]) -> Signal<'m> {
        let IntegratorPair { m, block, scopes, jv } = self;
        let counter = |axis: usize| hardware.counter(scopes[axis], &block, END.of(axis));
        let counters = (hardware.get(&END_POINT) == EndPoint::PerAxis).then(|| [0, 1].map(counter));
        let run = Iteration::new(m, &block, hardware, normalized.run);
        let steps = counters.map_or([run; 2], |counters| counters.map(|counter| run.only(counter.running())));
        let pulses = [0, 1].map(|axis| integrator(scopes[axis], &block, hardware, axis, jv[axis].q, steps[axis]));
        for axis in [0, 1] {
            hardware.axis(scopes[axis], &block, axis, pulses[axis], sides[axis].negative);
        }
        for axis in [0, 1] {
            let (scope, register, PairSide { raised, unit, .. }) = (scopes[axis], jv[axis], sides[axis]);
            let word = block.word(JV.of(axis).name(), register.q.bits());
            let loads = [(block.load, word), (normalized.shift, shifted_left(scope, register.q))];
            let pulse = pulses[1 - axis];
            up_down_counter(register, &loads, pulse & raised, pulse & !raised, unit);
        }
        match counters {
            Some([ex, ey]) => ex.count(pulses[0]) & ey.count(pulses[1]),
            None => hardware.counter(m, &block, E).count_pulses(population_count(m, 2, &pulses)),
        }
    }
}
