//! The step and direction output of an axis, and the timers that keep to what a motor drive asks for.

use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use crate::options::StepTiming;

/// A one-shot timer: started at an edge it runs for this many clocks after it.
#[derive(Clone, Copy, Debug)]
pub struct Timer<'m> {
    m: Scope<'m>,
    register: Register<'m>,
    clocks: u64,
}

impl<'m> Timer<'m> {
    /// The down-counter of this name, as wide as the clocks need.
    #[must_use]
    pub fn new(m: Scope<'m>, name: &str, clocks: u64) -> Timer<'m> {
        let register = m.reg(name, Width::needed_unsigned(u128::from(clocks)));
        Timer { m, register, clocks }
    }

    /// 1 bit: it runs.
    #[must_use]
    pub fn running(&self) -> Signal<'m> {
        self.register.q.is_nonzero()
    }

    /// 1 bit: it runs, and this many clocks of its time are left.
    #[must_use]
    pub fn left(&self, clocks: u64) -> Signal<'m> {
        self.register.q.equals(self.literal(clocks))
    }

    /// Closes it: at an edge with `start` = 1 it begins anew.
    pub fn close(self, start: Signal<'m>) {
        let less = self.register.q.wrapping_sub(self.literal(1));
        self.register.when(start, self.literal(self.clocks)).when(self.running(), less).else_hold();
    }

    fn literal(&self, value: u64) -> Signal<'m> {
        // Of a timer of no clocks only the 0 that it holds matters.
        self.m.lit(self.register.q.bits(), value)
    }
}

/// Step and direction of an axis.
///
/// - `step` + axis, 1 bit: 1 for `length` clocks from the edge that sends a step, then 0 for `space` clocks at least.
/// - `dir` + axis, 1 bit: 1 is negative. It changes `hold` clocks after the end of the last step or later, and the next
///   step follows `setup` clocks after the change or later (the next clock where that is 0).
/// - `pulse_timer`, `hold_timer`, `setup_timer`: run on between blocks.
#[derive(Clone, Copy, Debug)]
pub struct StepOutput<'m> {
    m: Scope<'m>,
    step: Register<'m>,
    turned: Signal<'m>,
    pulse: Timer<'m>,
    setup: Timer<'m>,
    hold: Timer<'m>,
    timing: StepTiming,
}

impl<'m> StepOutput<'m> {
    /// The outputs and timers. `negative` (1 bit) is the direction wanted; times are in clocks, `length` and `space` 1
    /// or more.
    #[must_use]
    pub fn new(m: Scope<'m>, axis: &str, timing: StepTiming, negative: Signal<'m>) -> StepOutput<'m> {
        let step = m.reg(&format!("step{axis}"), 1);
        let dir = m.reg(&format!("dir{axis}"), 1);
        let pulse = Timer::new(m, "pulse_timer", (timing.length + timing.space).saturating_sub(1));
        let hold = Timer::new(m, "hold_timer", (timing.length + timing.hold).saturating_sub(1));
        let setup = Timer::new(m, "setup_timer", timing.setup.saturating_sub(1));
        let change = dir.q ^ negative;
        let turn = change & !hold.running();
        dir.when(turn, negative).else_hold();
        setup.close(turn);
        StepOutput { m, step, turned: !change, pulse, setup, hold, timing }
    }

    /// 1 bit: a step may be sent at this edge.
    #[must_use]
    pub fn ready(&self) -> Signal<'m> {
        self.turned & !self.setup.running() & !self.pulse.running()
    }

    /// Closes it: at an edge with `send` = 1 a step is sent, which must be ready. Returns 1 bit: no step is sent at
    /// this edge, and the last one and its space are over.
    #[must_use]
    pub fn close(self, send: Signal<'m>) -> Signal<'m> {
        let one = self.m.lit(1, 1);
        self.step.when(send, one).when(self.pulse.left(self.timing.space), !one).else_hold();
        self.pulse.close(send);
        self.hold.close(send);
        !send & !self.pulse.running()
    }
}
