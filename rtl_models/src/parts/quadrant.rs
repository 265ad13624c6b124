//! Quadrant logic of arcs: from quadrant and direction to the kind of arc and the signs of its motion.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{Block, PairSide};
use crate::registers::{Reg, Rule};

/// The quadrant of the motion.
pub const QUAD: Reg = Reg::new("quad", Rule::Bits(2), "quadrant of the step, Q1 = 0 … Q4 = 3");
/// The direction of an arc: 1 is counter-clockwise.
pub const CCW: Reg = Reg::new("ccw", Rule::Bits(1), "direction of the arc, 1 is counter-clockwise").hidden();

/// The kind of an arc (SR1 … NR4), decoded. 1 bit each.
#[derive(Clone, Copy, Debug)]
pub struct ArcKind<'m> {
    /// |x| grows and |y| shrinks; else vice versa.
    pub x_grows: Signal<'m>,
    /// The motion in x is negative.
    pub x_negative: Signal<'m>,
    /// The motion in y is negative.
    pub y_negative: Signal<'m>,
}

impl<'m> ArcKind<'m> {
    /// The kind of the arc that was loaded: `ccw`, 1 bit, and [`quad`](quadrant_register) hold their words.
    #[must_use]
    pub fn held(m: Scope<'m>, block: &Block<'m>) -> ArcKind<'m> {
        let ccw = block.held(m, CCW.name(), 1);
        let quad = quadrant_register(m);
        quad.when(block.load, block.word(QUAD.name(), 2)).else_hold();
        ArcKind::decode(m.scope("quadrant"), quad.q, ccw)
    }

    /// The sides of the pair of integrators that draws the arc: a Y pulse changes |y|, which is J_VX, an X pulse |x|,
    /// which is J_VY, both by `unit` (unsigned).
    #[must_use]
    pub fn pair_sides(self, unit: Signal<'m>) -> [PairSide<'m>; 2] {
        let x = PairSide { negative: self.x_negative, raised: !self.x_grows, unit };
        let y = PairSide { negative: self.y_negative, raised: self.x_grows, unit };
        [x, y]
    }

    /// Decodes a quadrant (2 bits, Q1 = 0 … Q4 = 3) and a direction (1 bit, 1 is counter-clockwise), and shows the kind
    /// by its textbook name in the wave.
    #[must_use]
    pub fn decode(m: Scope<'m>, quadrant: Signal<'m>, counter_clockwise: Signal<'m>) -> ArcKind<'m> {
        ArcKind::show(m, counter_clockwise.concat(quadrant), &[]);
        ArcKind::of(m, quadrant, counter_clockwise)
    }

    /// As [`decode`](ArcKind::decode), of a machine of arcs and lines: on an arc the first of `modes` (1 bit each) is 1,
    /// on a line the second, before the first block none, nor on a free curve, on which `curve` is 1. The wave says which.
    #[must_use]
    pub fn decode_in_modes(
        m: Scope<'m>,
        quadrant: Signal<'m>,
        counter_clockwise: Signal<'m>,
        [arc, line]: [Signal<'m>; 2],
        curve: Option<Signal<'m>>,
    ) -> ArcKind<'m> {
        let of_arc = counter_clockwise.concat(quadrant).extend(4);
        let [of_line, none] = [8, 9].map(|value| m.lit(4, value));
        let other = curve.map_or(none, |curve| curve.mux(m.lit(4, 10), none));
        let kind = arc.mux(of_arc, line.mux(of_line, other));
        ArcKind::show(m, kind, if curve.is_some() { &["LINE", "NONE", "CURVE"] } else { &["LINE", "NONE"] });
        ArcKind::of(m, quadrant, counter_clockwise)
    }

    fn show(m: Scope<'m>, kind: Signal<'m>, others: &[&str]) {
        let names = ["SR1", "SR2", "SR3", "SR4", "NR1", "NR2", "NR3", "NR4"];
        let states = (0..).zip(names.iter().chain(others)).map(|(value, name)| (value, (*name).to_owned())).collect();
        m.show("kind", kind, Format::States(states));
    }

    fn of(m: Scope<'m>, quadrant: Signal<'m>, counter_clockwise: Signal<'m>) -> ArcKind<'m> {
        let (low, high) = (quadrant.bit(0), quadrant.bit(1));
        ArcKind {
            x_grows: m.name("x_grows", x_grows(quadrant, counter_clockwise)),
            // Clockwise x falls in the lower half, Q3 and Q4.
            x_negative: m.name("x_negative", high ^ counter_clockwise),
            // Clockwise y falls in the right half, Q1 and Q4.
            y_negative: m.name("y_negative", !(low ^ high) ^ counter_clockwise),
        }
    }
}

/// The quadrant register `quad`: 2 bits, Q1 = 0 … Q4 = 3.
pub fn quadrant_register(m: Scope<'_>) -> Register<'_> {
    let states = (0..).zip(["Q1", "Q2", "Q3", "Q4"]).map(|(value, name)| (value, name.to_owned())).collect();
    m.reg(QUAD.name(), 2).shown(Format::States(states))
}

/// 1 bit: |x| grows and |y| shrinks on an arc in this quadrant (2 bits) and direction (1 bit): clockwise in Q1 and Q3.
#[must_use]
pub fn x_grows<'m>(quadrant: Signal<'m>, counter_clockwise: Signal<'m>) -> Signal<'m> {
    !(quadrant.bit(0) ^ counter_clockwise)
}

/// The quadrant that the motion enters after this one (2 bits).
#[must_use]
pub fn next_quadrant<'m>(m: Scope<'m>, quadrant: Signal<'m>, counter_clockwise: Signal<'m>) -> Signal<'m> {
    let one = m.lit(2, 1);
    counter_clockwise.mux(quadrant.wrapping_add(one), quadrant.wrapping_sub(one))
}
