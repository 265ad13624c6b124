//! Strict and saturating arithmetic against exact integers: all operand widths up to four bits, both readings of both
//! operands, every mode, every value, on every engine.

use stepwave_engine::EngineKind;
use stepwave_netlist::cells::{Arithmetic, Claim, Operand};
use stepwave_netlist::dsl::{Scope, Signal};
use stepwave_netlist::{Design, Net, OnOverflow};

use super::{Probe, decode, design_with, encode, net, values, width};

const MODES: [OnOverflow; 3] = [OnOverflow::Trap, OnOverflow::Saturate, OnOverflow::Wrap];

/// An operand's width and reading.
#[derive(Clone, Copy, Debug)]
struct Shape {
    bits: u32,
    signed: bool,
}

impl Shape {
    fn input<'m>(self, m: Scope<'m>, name: &str) -> Signal<'m> {
        if self.signed { m.input_signed(name, self.bits) } else { m.input(name, self.bits) }
    }

    fn fits(self, number: i128) -> bool {
        let (least, greatest) = width(self.bits).range(self.signed);
        (least..=greatest).contains(&number)
    }

    /// The number of this shape that is nearest to an exact one.
    fn nearest(self, number: i128) -> i128 {
        let (least, greatest) = width(self.bits).range(self.signed);
        number.clamp(least, greatest)
    }
}

/// All shapes of up to this many bits.
fn shapes(bits: u32) -> Vec<Shape> {
    (1..=bits).flat_map(|bits| [false, true].map(|signed| Shape { bits, signed })).collect()
}

/// Strict and saturating sum and difference of the inputs `left` and `right`.
fn arithmetic(mode: OnOverflow, left: Shape, right: Shape) -> Design {
    design_with(mode, |m| {
        let (left, right, enable) = (left.input(m, "left"), right.input(m, "right"), m.input("enable", 1));
        m.name("strict_sum", left.strict_add(right, enable));
        m.name("strict_difference", left.strict_sub(right, enable));
        m.name("saturated_sum", left.saturating_add(right));
        m.name("saturated_difference", left.saturating_sub(right));
    })
}

struct Nets {
    left: Net,
    right: Net,
    enable: Net,
    /// Of sum and difference.
    flags: [Net; 2],
    strict: [Net; 2],
    saturated: [Net; 2],
}

impl Nets {
    fn of(design: &Design) -> Nets {
        let net = |name| net(design, name);
        Nets {
            left: net("left"),
            right: net("right"),
            enable: net("enable"),
            flags: [net("left_add_overflow"), net("left_sub_overflow")],
            strict: [net("strict_sum"), net("strict_difference")],
            saturated: [net("saturated_sum"), net("saturated_difference")],
        }
    }
}

/// Both operations on one pair of values.
fn check(probe: &mut Probe, nets: &Nets, mode: OnOverflow, shapes: [Shape; 2], pair: [u64; 2]) {
    let [left, right] = shapes;
    let [a, b] = [decode(pair[0], left.bits, left.signed), decode(pair[1], right.bits, right.signed)];
    for enable in [0, 1] {
        probe.clock(&[(nets.left, pair[0]), (nets.right, pair[1]), (nets.enable, enable)]);
        for (operation, exact) in [a + b, a - b].into_iter().enumerate() {
            let what = || format!("{a} and {b} give {exact}: {left:?} with {right:?}, {mode:?}");
            let flag = u64::from(!left.fits(exact)) & enable;
            assert_eq!(probe.value(nets.flags[operation]), flag, "flag: {}", what());
            let saturated = encode(left.nearest(exact), left.bits);
            assert_eq!(probe.value(nets.saturated[operation]), saturated, "saturated: {}", what());
            let strict = if mode == OnOverflow::Saturate { saturated } else { encode(exact, left.bits) };
            assert_eq!(probe.value(nets.strict[operation]), strict, "strict: {}", what());
        }
    }
}

#[test]
fn every_sum_and_difference_of_up_to_four_bits_is_exact_or_flagged_in_every_mode() {
    for mode in MODES {
        for left in shapes(4) {
            for right in shapes(4) {
                let design = arithmetic(mode, left, right);
                let nets = Nets::of(&design);
                for kind in EngineKind::ALL {
                    let mut probe = Probe::new(&design, kind);
                    for a in values(left.bits) {
                        for b in values(right.bits) {
                            check(&mut probe, &nets, mode, [left, right], [a, b]);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn the_widest_registers_are_exact_or_flagged_at_their_ends() {
    let edges = |bits: u32| {
        let (mask, sign) = (width(bits).mask(), width(bits).sign_bit());
        [0, 1, sign - 1, sign, sign | 1, mask - 1, mask]
    };
    let shape = |bits, signed| Shape { bits, signed };
    for (left, right) in [
        (shape(64, false), shape(64, false)),
        (shape(64, true), shape(64, true)),
        (shape(64, false), shape(2, false)),
        (shape(64, true), shape(2, true)),
        (shape(64, true), shape(1, false)),
        (shape(64, true), shape(63, false)),
        (shape(62, false), shape(62, true)),
        (shape(62, true), shape(62, false)),
        (shape(4, true), shape(63, true)),
        (shape(4, false), shape(62, false)),
    ] {
        for mode in MODES {
            let design = arithmetic(mode, left, right);
            let nets = Nets::of(&design);
            for kind in EngineKind::ALL {
                let mut probe = Probe::new(&design, kind);
                for a in edges(left.bits) {
                    for b in edges(right.bits) {
                        check(&mut probe, &nets, mode, [left, right], [a & width(left.bits).mask(), b]);
                    }
                }
            }
        }
    }
}

#[test]
fn a_saturated_result_keeps_the_reading_of_its_left_operand() {
    for left in shapes(2) {
        for right in shapes(3) {
            design_with(OnOverflow::Saturate, |m| {
                let (l, r, enable) = (left.input(m, "left"), right.input(m, "right"), m.lit(1, 1));
                for result in
                    [l.strict_add(r, enable), l.strict_sub(r, enable), l.saturating_add(r), l.saturating_sub(r)]
                {
                    assert_eq!((result.bits(), result.is_signed()), (left.bits, left.signed), "{left:?} {right:?}");
                }
            });
        }
    }
}

#[test]
fn a_strict_cell_claims_what_it_adds_under_the_path_of_its_left_operand() {
    let design = design_with(OnOverflow::Trap, |m| {
        let register = m.scope("axis").reg_signed("x", 4);
        let step = m.input("step", 2);
        let enable = m.input("enable", 1);
        let sum = register.q.strict_add(step, enable);
        let _ = register.q.strict_sub(step.as_signed(), enable);
        register.set(sum);
    });
    let netlist = design.netlist();
    let left = Operand { net: net(&design, "m.axis.x"), signed: true };
    let step = net(&design, "step");
    let claim = |operation, signed| Claim::NoOverflow { operation, left, right: Operand { net: step, signed } };
    let claims: Vec<(&str, Claim)> = netlist.properties.iter().map(|p| (p.name.as_str(), p.claim.clone())).collect();
    let want = [("m.axis.x", claim(Arithmetic::Add, false)), ("m.axis.x", claim(Arithmetic::Sub, true))];
    assert_eq!(claims, want);
    let flags: Vec<Net> = netlist.properties.iter().map(|property| property.never).collect();
    assert_eq!(flags, [net(&design, "m.axis.x_add_overflow"), net(&design, "m.axis.x_sub_overflow")]);
}

#[test]
fn saturating_arithmetic_claims_nothing() {
    let design = design_with(OnOverflow::Trap, |m| {
        let (a, b) = (m.input("a", 4), m.input("b", 6));
        m.name("sum", a.saturating_add(b));
        m.name("difference", (a & a).saturating_sub(b));
    });
    assert!(design.netlist().properties.is_empty());
}
