//! Strict and saturating arithmetic: overflow visible by construction.
//!
//! A strict cell computes the exact result and a flag that says whether it fits in the register that it is meant for.
//! The flag, gated by an enable, becomes a property that must never be 1.

use super::Signal;
use crate::bits::Width;
use crate::cells::{Arithmetic, Claim, Net, OnOverflow, Op, Operand, Property};
use crate::diag::Code;

/// A result in the width of the left operand, whether the exact one did not fit, and the sign of the exact one.
struct Narrowed<'m> {
    result: Signal<'m>,
    overflow: Signal<'m>,
    negative: Signal<'m>,
}

impl<'m> Signal<'m> {
    /// Sum, or the nearest value that fits in the width and reading of this signal. `rhs` may have any width.
    #[track_caller]
    #[must_use]
    pub fn saturating_add(self, rhs: Signal<'m>) -> Signal<'m> {
        self.saturated(&self.exact(Arithmetic::Add, rhs))
    }

    /// Difference, or the nearest value that fits in the width and reading of this signal. `rhs` may have any width.
    #[track_caller]
    #[must_use]
    pub fn saturating_sub(self, rhs: Signal<'m>) -> Signal<'m> {
        self.saturated(&self.exact(Arithmetic::Sub, rhs))
    }

    /// Sum that must fit in the width and reading of this signal at every clock where `enable` (1 bit) is 1: a
    /// property named after this signal, which therefore needs a name. What happens where the sum does not fit is the
    /// module's [`OnOverflow`]. `rhs` may have any width and either reading; where it does not fit in those of this
    /// signal, two's complement of 64 bits must hold the exact sum.
    #[track_caller]
    #[must_use]
    pub fn strict_add(self, rhs: Signal<'m>, enable: Signal<'m>) -> Signal<'m> {
        self.strict(Arithmetic::Add, rhs, enable)
    }

    /// Difference that must fit, as [`strict_add`](Signal::strict_add).
    #[track_caller]
    #[must_use]
    pub fn strict_sub(self, rhs: Signal<'m>, enable: Signal<'m>) -> Signal<'m> {
        self.strict(Arithmetic::Sub, rhs, enable)
    }

    #[track_caller]
    fn strict(self, operation: Arithmetic, rhs: Signal<'m>, enable: Signal<'m>) -> Signal<'m> {
        let module = self.scope().module;
        let rhs = self.own(rhs);
        let narrowed = self.exact(operation, rhs);
        let enable = self.enabling(enable);
        let never = enable & narrowed.overflow;
        let named = {
            let state = module.state.borrow();
            state.netlist.name_of(self.net()).map(|named| (state.netlist.path(named), named.name.clone()))
        };
        if let Some((path, leaf)) = named {
            let left = Operand { net: self.net(), signed: self.is_signed() };
            let right = Operand { net: rhs.net(), signed: rhs.is_signed() };
            self.scope().add_property(Property {
                name: path,
                never: never.net(),
                claim: Claim::NoOverflow { operation, left, right },
            });
            let word = match operation {
                Arithmetic::Add => "add",
                Arithmetic::Sub => "sub",
            };
            self.scope().name(&format!("{leaf}_{word}_overflow"), never);
        } else {
            module.report(Code::Unnamed, "a strict operator needs a named left operand to report".to_owned());
        }
        match module.on_overflow {
            OnOverflow::Saturate => self.saturated(&narrowed),
            OnOverflow::Trap | OnOverflow::Wrap => narrowed.result,
        }
    }

    /// The enable of a strict cell, or a diagnostic and a 0.
    #[track_caller]
    fn enabling(self, enable: Signal<'m>) -> Signal<'m> {
        let enable = self.own(enable);
        if enable.bits() == 1 {
            return enable;
        }
        let module = self.scope().module;
        let what = module.state.borrow().netlist.describe(enable.net());
        module.report(Code::NotOneBit, format!("{what} enables, so it must be 1 bit"));
        self.scope().lit(1, 0)
    }

    #[track_caller]
    fn saturated(self, narrowed: &Narrowed<'m>) -> Signal<'m> {
        let width = self.width();
        let (least, greatest) =
            if self.is_signed() { (width.sign_bit(), width.mask() >> 1) } else { (0, width.mask()) };
        let limit = |value| self.scope().lit(width.get(), value);
        let nearest = narrowed.negative.mux(limit(least), limit(greatest));
        let result = narrowed.overflow.mux(nearest, narrowed.result.as_unsigned());
        if self.is_signed() { result.as_signed() } else { result }
    }

    /// The result cut to the width of this signal, and whether that lost anything.
    #[track_caller]
    fn exact(self, operation: Arithmetic, rhs: Signal<'m>) -> Narrowed<'m> {
        let rhs = self.own(rhs);
        let fits = if self.is_signed() == rhs.is_signed() {
            rhs.bits() <= self.bits()
        } else {
            self.is_signed() && rhs.bits() < self.bits()
        };
        if fits { self.exact_in_place(operation, rhs) } else { self.exact_widened(operation, rhs) }
    }

    /// Both operands fit in the width and reading of this one: the adder's own carry or overflow is the flag.
    #[track_caller]
    fn exact_in_place(self, operation: Arithmetic, rhs: Signal<'m>) -> Narrowed<'m> {
        let rhs = rhs.extend(self.bits());
        let (a, b) = (self.net(), rhs.net());
        let flag: fn(Net, Net) -> Op = match (operation, self.is_signed()) {
            (Arithmetic::Add, false) => Op::Carry,
            (Arithmetic::Sub, false) => Op::Borrow,
            (Arithmetic::Add, true) => Op::AddOverflow,
            (Arithmetic::Sub, true) => Op::SubOverflow,
        };
        let result = match operation {
            Arithmetic::Add => self.wrapping_add(rhs),
            Arithmetic::Sub => self.wrapping_sub(rhs),
        };
        // Where it overflows, a two's-complement result has the sign of its left operand, an unsigned sum is too
        // great and an unsigned difference too small.
        let negative = match (operation, self.is_signed()) {
            (_, true) => self.msb(),
            (Arithmetic::Add, false) => self.scope().lit(1, 0),
            (Arithmetic::Sub, false) => self.scope().lit(1, 1),
        };
        Narrowed { result, overflow: self.flag(flag(a, b)), negative }
    }

    /// Operands of unlike width or reading: a two's-complement adder wide enough for any result, then cut.
    #[track_caller]
    fn exact_widened(self, operation: Arithmetic, rhs: Signal<'m>) -> Narrowed<'m> {
        let signed_bits = |signal: Signal<'m>| signal.bits() + u32::from(!signal.is_signed());
        let wide = signed_bits(self).max(signed_bits(rhs)) + 1;
        if wide > Width::MAX.get() {
            return self.too_wide(operation, rhs, wide);
        }
        let (a, b) = (self.extend(wide).as_signed(), rhs.extend(wide).as_signed());
        let exact = match operation {
            Arithmetic::Add => a.wrapping_add(b),
            Arithmetic::Sub => a.wrapping_sub(b),
        };
        let cut = exact.slice(0, self.bits());
        let result = if self.is_signed() { cut.as_signed() } else { cut };
        // It fits exactly where extending the cut result gives the exact one again.
        let overflow = !result.extend(wide).equals(exact);
        Narrowed { result, overflow, negative: exact.msb() }
    }

    /// No adder is wide enough for the exact result: a diagnostic, and a 0 that always fits.
    #[track_caller]
    fn too_wide(self, operation: Arithmetic, rhs: Signal<'m>, wide: u32) -> Narrowed<'m> {
        let module = self.scope().module;
        if !self.is_guess() && !rhs.is_guess() {
            let [a, b] = [self, rhs].map(|operand| module.state.borrow().netlist.describe(operand.net()));
            let what = match operation {
                Arithmetic::Add => "sum",
                Arithmetic::Sub => "difference",
            };
            let most = Width::MAX.get();
            let message =
                format!("the exact {what} of {a} and {b} needs two's complement of {wide} bits; {most} is the most");
            module.report(Code::BadWidth, message);
        }
        let zero = |bits| self.scope().lit(bits, 0);
        let result = if self.is_signed() { zero(self.bits()).as_signed() } else { zero(self.bits()) };
        Narrowed { result, overflow: zero(1), negative: zero(1) }
    }
}
