//! Left-shift normalisation of integrands.

use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::Block;

/// Shifts the integrands left after a block was loaded, one bit a clock, until one of them is large enough. Without
/// normalisation it does nothing and costs no clock.
#[derive(Clone, Copy, Debug)]
pub struct Normalizer<'m> {
    shifting: Option<Register<'m>>,
    load: Signal<'m>,
    busy: Signal<'m>,
    none: Signal<'m>,
}

/// What the normaliser gives to the other parts; 1 bit each.
#[derive(Clone, Copy, Debug)]
pub struct Normalized<'m> {
    /// The integrands shift left at this edge.
    pub shift: Signal<'m>,
    /// The block is loaded and normalised after this edge.
    pub ready: Signal<'m>,
    /// The integrators may add.
    pub run: Signal<'m>,
}

impl<'m> Normalizer<'m> {
    /// A normaliser, or none.
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, normalize: bool) -> Normalizer<'m> {
        let shifting = normalize.then(|| m.reg("normalizing", 1));
        Normalizer { shifting, load: block.load, busy: block.busy, none: m.lit(1, 0) }
    }

    /// Closes it: shifts until the or of all integrands, which are equally wide, has a 1 among its `top` highest bits.
    /// More bits than they have, or none, are a mistake that [`finish`](stepwave_netlist::dsl::Module::finish) reports.
    #[track_caller]
    #[must_use]
    pub fn close(self, integrands: &[Signal<'m>], top: u32) -> Normalized<'m> {
        let Some(shifting) = self.shifting else {
            return Normalized { shift: self.none, ready: self.load, run: self.busy };
        };
        let any = integrands.iter().copied().reduce(|a, b| a | b).unwrap_or(self.none);
        // Too many from bit 0 on are as many too many as from below it.
        let large = any.slice(any.bits().saturating_sub(top), top).is_nonzero();
        shifting.when(self.load, !self.none).when(large, self.none).else_hold();
        Normalized { shift: shifting.q & !large, ready: shifting.q & large, run: self.busy & !shifting.q }
    }
}

/// Shifted left by one bit; the highest is lost.
#[must_use]
pub fn shifted_left<'m>(m: Scope<'m>, value: Signal<'m>) -> Signal<'m> {
    if value.bits() == 1 { m.lit(1, 0) } else { value.slice(0, value.bits() - 1).concat(m.lit(1, 0)) }
}

/// Shifted right by one bit; the lowest is lost.
#[must_use]
pub fn shifted_right<'m>(m: Scope<'m>, value: Signal<'m>) -> Signal<'m> {
    if value.bits() == 1 { m.lit(1, 0) } else { m.lit(1, 0).concat(value.slice(1, value.bits() - 1)) }
}
