//! The four-beat ring counter of point-by-point methods: judge, feed, compute, compare.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::Block;
use crate::options::Beats;

/// The beats of a step. In the four-beat form a one-hot ring counter gives each one clock; in the one-beat form all
/// four are the same clock.
#[derive(Clone, Copy, Debug)]
pub struct BeatRing<'m> {
    m: Scope<'m>,
    ring: Option<Register<'m>>,
    /// 1 bit: the deviation is judged and the axis chosen.
    pub judge: Signal<'m>,
    /// 1 bit: the axis steps.
    pub feed: Signal<'m>,
    /// 1 bit: the deviation is computed anew.
    pub compute: Signal<'m>,
    /// 1 bit: the end counter counts and is compared with 0.
    pub compare: Signal<'m>,
}

impl<'m> BeatRing<'m> {
    /// The beats while `busy` (1 bit) is 1.
    #[must_use]
    pub fn new(m: Scope<'m>, beats: Beats, busy: Signal<'m>) -> BeatRing<'m> {
        match beats {
            Beats::One => BeatRing { m, ring: None, judge: busy, feed: busy, compute: busy, compare: busy },
            Beats::Four => {
                let names = [(0, "IDLE"), (1, "JUDGE"), (2, "FEED"), (4, "COMPUTE"), (8, "COMPARE")];
                let states = names.map(|(value, name)| (value, name.to_owned())).to_vec();
                let ring = m.reg("beat", 4).shown(Format::States(states));
                let [judge, feed, compute, compare] = [0, 1, 2, 3].map(|beat| ring.q.bit(beat));
                BeatRing { m, ring: Some(ring), judge, feed, compute, compare }
            }
        }
    }

    /// What the judge beat decided, valid in the beats after it: a register in the four-beat form, a net in the other.
    #[must_use]
    pub fn decided(&self, name: &str, decision: Signal<'m>) -> Signal<'m> {
        if self.ring.is_none() {
            return self.m.name(name, decision);
        }
        let register = self.m.reg(name, decision.bits());
        register.when(self.judge, decision).else_hold();
        register.q
    }

    /// Closes the ring and the block, which starts with the judge beat; the compare beat is its step, and `last` (1
    /// bit) there ends it.
    pub fn close(self, block: Block<'m>, last: Signal<'m>) {
        if let Some(ring) = self.ring {
            let rotated = ring.q.slice(0, 3).concat(ring.q.msb());
            ring.when(block.load, self.m.lit(4, 1)).when(self.compare & last, self.m.lit(4, 0)).otherwise(rotated);
        }
        block.close(block.load, self.compare, last);
    }
}
