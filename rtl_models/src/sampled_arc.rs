//! `sampled-arc`: data sampling (数据采样法), arc: a coarse stage once a period, and a fine DDA between.
//!
//! ```text
//!   coarse, one state after another                     fine, 2^k additions in T
//!   ┌────────────┐
//!   │ multiplier │◄─┐                                   jvx_next ──► jvx ──► + ──► jrx ──┐
//!   │ divider    │◄─┼── state ──► px, py ──► round ────┤ (buffer)            ▲───────────┘
//!   │ root       │◄─┘     remx, remy   less tx, ty      jvy_next ──► jvy      │ carry ──► dx ──► x
//!   └────────────┘               └─► side of the end
//! ```
//!
//! | register | width | load value |
//! |---|---|---|
//! | f | as it needs | way of a period, in 2^-q BLU |
//! | px, py | n+1+q | coarse point that is calculated, about the centre, in 2^-q BLU, signed |
//! | remx, remy | n+q | 0: what is below 2^-q of both (`7360`) |
//! | xe, ye | n+1 | end point about the centre, signed |
//! | cx, cy | n+2+q | coarse point that the burst draws to, signed |
//! | jvx, jvy | k | whole pulses of the period; `jvx_next`, `jvy_next` those of the next |
//! | jrx, jry | k | remainder J_R: the preset |
//! | e | k+1 | additions of the period left |
//! | phase | as it needs | divider of the clock: parts of an addition that have passed |
//!
//! n bits hold 1.25·R and some BLU, q is `--fraction`, and 2^k is greater than the way of any period. The signs of px and
//! py are all that tells quadrants apart; nothing is reloaded at the axes.
//!
//! - `7m` (T = 8 ms): of the smaller coordinate u and the larger v, where both grow away from each other,
//!   tan α = (u + ½f·cos 45°)/(v - ½f·sin 45°), and u moves by f·cos α = f/√(1 + tan² α). The larger becomes √(R² - u²):
//!   that is Δv from Δv(v - ½Δv) = Δu(u + ½Δu), which keeps the point on the circle. Towards the axis, where |u| shrinks,
//!   both signs in tan α turn over. Beyond 45° x and y change places.
//! - `7360` (T = 10.24 ms, the extended DDA): λ = f/R with n+q bits of fraction, once for the block. Clockwise
//!   Δx = λ(y - ½λx) and Δy = -λ(x + ½λy), counter-clockwise with -λ, added to {px, remx} and {py, remy}. The radius
//!   grows by the factor √(1 + λ⁴/4) a period.
//!
//! The fine stage takes the points rounded to the nearest pulse; the fraction stays in the point. The last period is the
//! one that passes the radius to the end point: before it xe·y - ye·x, which the multiplier gives in every period, has
//! the sign of a point in front of the end, and behind it no longer. It takes what is left, so that the end is exact. An
//! arc that starts behind the radius of its end, or on it, goes once around.
//!
//! The chord of a period leaves the arc by f²/(8R): steps for which that is more than `--tolerance`, or which are longer
//! than R/2, are refused.
//!
//! The multiplier (shift and add), the divider and the root (both restoring) take a bit a clock. While the fine stage
//! draws one period, they calculate the next. A divider of the clock spreads the 2^k additions of a period over T, so
//! that at the clock frequency given a period takes T, what is not a whole number of clocks carried on to the next; a
//! clock that leaves the coarse calculation too few clocks is refused. `stepped` marks the end of each period, which is a
//! row of the step table.
//!
//! A quarter of the circle of 10 BLU with 4 BLU a period, from the golden file `waves/sampled-arc-7m.csv`; the wave
//! stands beside it:
//!
//! ```text
#![doc = include_str!("../../waves/sampled-arc-7m.csv")]
//! ```
//!
//! The same by the step factor, λ = 0.4, from `waves/sampled-arc-7360.csv`:
//!
//! ```text
#![doc = include_str!("../../waves/sampled-arc-7360.csv")]
//! ```

use stepwave_nc::{Arc, Crossing, Direction};
use stepwave_netlist::dsl::{Register, Scope, Signal};

use crate::docs::{SAMPLED_SYSTEM, SAMPLED_WIDTH};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::{Interpolates, Method, Model, RegisterDoc};
use crate::options::{FRACTION, ON_OVERFLOW, PRESET, STEP, System, TOLERANCE};
use crate::parts::{ArithmeticUnit, Block, FineStage, magnitude, negated, with_sign};
use crate::plan::Plan;
use crate::sampling::Sampling;
use crate::sizes;

/// Data sampling with a fine DDA, arc.
pub static MODEL: Model = Model {
    name: "sampled-arc",
    title: "Data sampling with a fine DDA, arc",
    method: "data sampling",
    source: "数据采样法, the two-stage interpolation of CNC systems, as in Chinese NC textbooks",
    registers: &[
        RegisterDoc { name: "state", width: "4", about: "step of the coarse calculation" },
        RegisterDoc {
            name: "px, py",
            width: "n+1+q",
            about: "coarse point that is calculated, about the centre, signed",
        },
        RegisterDoc { name: "remx, remy", width: "n+q", about: "remainder of each below the fraction (7360)" },
        RegisterDoc::SAMPLED_POINT,
        RegisterDoc::SAMPLED_JV,
        RegisterDoc::SAMPLED_JR,
        RegisterDoc::POSITIONS,
    ],
    options: &[
        &SAMPLED_SYSTEM,
        &FRACTION,
        &STEP.about("BLU of a period, R/2 at most (default: 8, or what is taken); or --feed"),
        &TOLERANCE.about("greatest chord error in BLU (default: 1)"),
        &SAMPLED_WIDTH,
        &PRESET,
        &ON_OVERFLOW,
    ],
    claims: None,
    interpolates: Interpolates::Arcs(Method { plan, load }),
    hardware,
};

fn plan(arc: &Arc, plan: &mut Plan) -> Result<(), ModelError> {
    let radius = arc.radius();
    let sampling = Sampling::plan(plan, radius, Some(radius))?;
    let sectors = arc.sectors(Crossing::PathExtreme);
    // The end may lie 1 BLU beside the circle, and a path by the step factor ends outside it.
    let more = 2.0 + growth(&sampling, radius);
    let coarse = f64::from(coarse_clocks(&sampling));
    sampling.hardware(plan, [more, coarse], sizes::arc_positions(arc, &sectors))?;
    Ok(())
}

/// Clocks from one hand-over to the next: a component takes a bit a clock, and its state two more.
fn coarse_clocks(sampling: &Sampling) -> u32 {
    let bits = sampling.magnitude();
    let [product, root, quotient] = [bits + 2, bits + 2, 2 * bits + 2];
    let (sides, hand, drive) = (2 * product, 1, 1);
    match sampling.system {
        System::Direction => 2 * quotient + 2 * root + 2 * product + drive + sides + hand,
        System::StepFactor => 4 * product + sides + hand,
    }
}

/// How far a full circle by the step factor ends outside, in BLU: λ = f/R, and R grows by the factor sqrt(1 + λ⁴/4) in
/// each of 2π/λ periods.
fn growth(sampling: &Sampling, radius: f64) -> f64 {
    match sampling.system {
        System::Direction => 0.0,
        System::StepFactor => radius * (sampling.step.units() / radius).powi(3) * std::f64::consts::FRAC_PI_4,
    }
}

/// States of the coarse stage that both systems have; the others follow.
mod at {
    pub(super) const SQUARE_X: u64 = 1;
    pub(super) const SQUARE_Y: u64 = 2;
    pub(super) const SIDE_X: u64 = 3;
    pub(super) const SIDE_Y: u64 = 4;
    pub(super) const HAND: u64 = 5;
    pub(super) const HALF: u64 = 6;
    pub(super) const TANGENT: u64 = 7;
    pub(super) const SQUARE_TANGENT: u64 = 8;
    pub(super) const SECANT: u64 = 9;
    pub(super) const COSINE: u64 = 10;
    pub(super) const DRIVE: u64 = 11;
    pub(super) const SQUARE: u64 = 12;
    pub(super) const ROOT: u64 = 13;
    pub(super) const RADIUS: u64 = 6;
    pub(super) const LAMBDA: u64 = 7;
    pub(super) const MIDDLE_X: u64 = 8;
    pub(super) const MIDDLE_Y: u64 = 9;
    pub(super) const STEP_X: u64 = 10;
    pub(super) const STEP_Y: u64 = 11;
}

const COMMON: [(u64, &str); 6] = [
    (0, "IDLE"),
    (at::SQUARE_X, "SQUARE_X"),
    (at::SQUARE_Y, "SQUARE_Y"),
    (at::SIDE_X, "SIDE_X"),
    (at::SIDE_Y, "SIDE_Y"),
    (at::HAND, "HAND_OVER"),
];
const DIRECTION: [(u64, &str); 8] = [
    (at::HALF, "HALF_STEP"),
    (at::TANGENT, "TANGENT"),
    (at::SQUARE_TANGENT, "SQUARE_TAN"),
    (at::SECANT, "SECANT"),
    (at::COSINE, "COSINE"),
    (at::DRIVE, "DRIVE"),
    (at::SQUARE, "SQUARE"),
    (at::ROOT, "ROOT"),
];
const STEP_FACTOR: [(u64, &str); 6] = [
    (at::RADIUS, "RADIUS"),
    (at::LAMBDA, "LAMBDA"),
    (at::MIDDLE_X, "MIDDLE_X"),
    (at::MIDDLE_Y, "MIDDLE_Y"),
    (at::STEP_X, "STEP_X"),
    (at::STEP_Y, "STEP_Y"),
];

/// The coarse point and the units that calculate, in the scope `coarse`.
struct Coarse<'m> {
    m: Scope<'m>,
    block: Block<'m>,
    sampling: Sampling,
    f: Signal<'m>,
    ccw: Signal<'m>,
    /// Both axes of the point.
    point: [Register<'m>; 2],
    /// R², whole.
    square: Register<'m>,
    unit: ArithmeticUnit<'m>,
}

/// What a system adds to the common sequence.
struct Way<'m> {
    /// Operands of the multiplier.
    products: Vec<(Signal<'m>, Signal<'m>, Signal<'m>)>,
    /// From state to state.
    moves: Vec<(Signal<'m>, u64)>,
    /// First state of the block, first state of a period.
    first: [u64; 2],
    /// 1 bit: the next point stands behind this edge.
    stands: Signal<'m>,
}

impl<'m> Coarse<'m> {
    fn held(&self, name: &str, condition: Signal<'m>, value: Signal<'m>) -> Signal<'m> {
        let register = self.m.reg(name, value.bits());
        register.when(condition, value).else_hold();
        register.q
    }

    /// Magnitude of a coordinate, n+q bits.
    fn magnitude(&self, value: Signal<'m>) -> Signal<'m> {
        magnitude(self.m, value).slice(0, self.sampling.magnitude())
    }

    /// The start of the block, of an axis.
    fn start(&self, axis: usize) -> Signal<'m> {
        self.block.word_signed(["px", "py"][axis], self.point[axis].q.bits())
    }

    /// R² with the fraction of a square.
    fn radicand(&self) -> Signal<'m> {
        self.square.q.concat(self.m.lit(2 * self.sampling.fraction, 0))
    }

    /// tan α = (u + f/2·cos 45°) / (v - f/2·sin 45°) of the axis u that is driven and the other, v; u moves by f·cos α,
    /// and v is what the circle leaves of R².
    fn by_direction(&self) -> Way<'m> {
        let (m, bits) = (self.m, self.sampling.magnitude());
        let begins = |state| self.unit.begins(state);
        let product = self.unit.multiplier.product();
        let f_bits = self.f.bits();
        // Bits of the fraction of tan and sec.
        let p = f_bits.min(bits - 2);

        // ½·cos 45° with as many bits as f has.
        let k = f_bits.min(40);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let half_cosine = m.lit(k, (std::f64::consts::FRAC_1_SQRT_2 / 2.0 * (1_u64 << k) as f64).round() as u64);
        let half = self.held("half_step", self.unit.multiplied(at::HALF), product.slice(k, f_bits));

        let [x, y] = self.point.map(|axis| axis.q);
        let [ax, ay] = [x, y].map(|coordinate| self.magnitude(coordinate));
        let x_is_driven = !ay.less_than(ax);
        let [driven, other] = [x_is_driven.mux(x, y), x_is_driven.mux(y, x)];
        let [u, v] = [x_is_driven.mux(ax, ay), x_is_driven.mux(ay, ax)];
        // Clockwise x goes with y, and y against x.
        let backwards = x_is_driven.mux(y.msb(), !x.msb()) ^ self.ccw;
        let outwards = u.is_zero() | !(driven.msb() ^ backwards);
        let wide_half = half.extend(bits);
        let ahead = outwards.mux(u.wrapping_add(wide_half), magnitude_of_difference(m, u, wide_half));
        let below = outwards.mux(v.wrapping_sub(wide_half), v.wrapping_add(wide_half));
        let begun = begins(at::TANGENT);
        let drives_x = self.held("x_is_driven", begun, x_is_driven);
        let backwards = self.held("backwards", begun, backwards);
        let other_negative = self.held("other_negative", begun, other.msb());

        let tangent =
            self.held("tangent", self.unit.divided(at::TANGENT), self.unit.divider.quotient().slice(0, p + 1));
        let one = m.lit(1, 1).concat(m.lit(2 * p, 0)).extend(2 * bits);
        let above_one = product.slice(0, 2 * p + 2).extend(2 * bits).wrapping_add(one);
        let secant = self.unit.root.root().slice(0, p + 2);
        let way = self.unit.divider.quotient().slice(0, f_bits);
        let driven = drives_x.mux(x, y);
        let wide = way.extend(driven.bits()).as_signed();
        let moved = backwards.mux(driven.wrapping_sub(wide), driven.wrapping_add(wide));
        let left = self.radicand().saturating_sub(product);
        let found = with_sign(m, self.unit.root.root(), bits + 1, other_negative);
        let drive = self.unit.sequence.at(at::DRIVE);
        for (axis, name) in [(0, drives_x), (1, !drives_x)] {
            self.point[axis]
                .when(self.block.load, self.start(axis))
                .when(drive & name, moved)
                .when(self.unit.rooted(at::ROOT) & !name, found)
                .else_hold();
        }
        self.unit.divider.close(&[
            (begun, ahead.concat(m.lit(p, 0)), below),
            (begins(at::COSINE), self.f.concat(m.lit(p, 0)), secant),
        ]);
        self.unit.root.close(&[(begins(at::SECANT), above_one), (begins(at::ROOT), left)]);
        let coordinate = self.magnitude(driven);
        Way {
            products: vec![
                (begins(at::HALF), self.f, half_cosine),
                (begins(at::SQUARE_TANGENT), tangent, tangent),
                (begins(at::SQUARE), coordinate, coordinate),
            ],
            moves: vec![
                (self.unit.multiplied(at::HALF), at::SIDE_X),
                (self.unit.divided(at::TANGENT), at::SQUARE_TANGENT),
                (self.unit.multiplied(at::SQUARE_TANGENT), at::SECANT),
                (self.unit.rooted(at::SECANT), at::COSINE),
                (self.unit.divided(at::COSINE), at::DRIVE),
                (drive, at::SQUARE),
                (self.unit.multiplied(at::SQUARE), at::ROOT),
            ],
            first: [at::HALF, at::TANGENT],
            stands: self.unit.rooted(at::ROOT),
        }
    }

    /// λ = f/R, and clockwise Δx = λ(y - ½λx), Δy = -λ(x + ½λy); counter-clockwise λ is negative.
    fn by_step_factor(&self) -> Way<'m> {
        let (m, bits) = (self.m, self.sampling.magnitude());
        let begins = |state| self.unit.begins(state);
        let product = self.unit.multiplier.product();
        let lambda = self.held("lambda", self.unit.divided(at::LAMBDA), self.unit.divider.quotient().slice(0, bits));
        let [x, y] = self.point.map(|axis| axis.q);
        // Half of λ times a coordinate, with the coordinate's sign.
        let half = |coordinate: Signal<'m>| with_sign(m, product.slice(bits + 1, bits - 1), bits + 1, coordinate.msb());
        let plus =
            |a: Signal<'m>, b: Signal<'m>, subtract: Signal<'m>| subtract.mux(a.wrapping_sub(b), a.wrapping_add(b));
        let middle_y = plus(y, half(x), !self.ccw);
        let middle_x = plus(x, half(y), self.ccw);
        let middle_y = self.held("middle_y", self.unit.multiplied(at::MIDDLE_X), middle_y).as_signed();
        let middle_x = self.held("middle_x", self.unit.multiplied(at::MIDDLE_Y), middle_x).as_signed();
        for (axis, state, middle, against) in
            [(0, at::STEP_X, middle_y, self.ccw), (1, at::STEP_Y, middle_x, !self.ccw)]
        {
            let rest = m.reg(["remx", "remy"][axis], bits);
            let whole = self.point[axis].q.concat(rest.q);
            let way = product.extend(2 * bits + 1).as_signed();
            let sum = plus(whole, way, middle.msb() ^ against);
            let stepped = self.unit.multiplied(state);
            let point = sum.slice(bits, bits + 1).as_signed();
            self.point[axis].when(self.block.load, self.start(axis)).when(stepped, point).else_hold();
            rest.when(self.block.load, m.lit(bits, 0)).when(stepped, sum.slice(0, bits)).else_hold();
        }
        self.unit.divider.close(&[(begins(at::LAMBDA), self.f.concat(m.lit(bits, 0)), self.unit.root.root())]);
        self.unit.root.close(&[(begins(at::RADIUS), self.radicand())]);
        Way {
            products: vec![
                (begins(at::MIDDLE_X), self.magnitude(x), lambda),
                (begins(at::MIDDLE_Y), self.magnitude(y), lambda),
                (begins(at::STEP_X), self.magnitude(middle_y), lambda),
                (begins(at::STEP_Y), self.magnitude(middle_x), lambda),
            ],
            moves: vec![
                (self.unit.rooted(at::RADIUS), at::LAMBDA),
                (self.unit.divided(at::LAMBDA), at::SIDE_X),
                (self.unit.multiplied(at::MIDDLE_X), at::MIDDLE_Y),
                (self.unit.multiplied(at::MIDDLE_Y), at::STEP_X),
                (self.unit.multiplied(at::STEP_X), at::STEP_Y),
            ],
            first: [at::RADIUS, at::MIDDLE_X],
            stands: self.unit.multiplied(at::STEP_Y),
        }
    }
}

/// |a - b| of two unsigned numbers of the same width.
fn magnitude_of_difference<'m>(m: Scope<'m>, a: Signal<'m>, b: Signal<'m>) -> Signal<'m> {
    let (borrow, difference) = a.borrowing_sub(b);
    borrow.mux(negated(m, difference.as_signed()).as_unsigned(), difference)
}

fn hardware(top: Scope<'_>, hardware: &Hardware) {
    let Some(sampling) = hardware.sampling else { return };
    let by_direction = sampling.system == System::Direction;
    let (q, n, bits) = (sampling.fraction, sampling.whole, sampling.magnitude());
    let block = Block::new(top);
    let fine = FineStage::new(top.scope("fine"), hardware.bits("jvx"));
    let m = top.scope("coarse");
    let own = if by_direction { &DIRECTION[..] } else { &STEP_FACTOR };
    let coarse = Coarse {
        m,
        block,
        sampling,
        f: block.held(m, "f", sampling.word_bits()),
        ccw: block.held(m, "ccw", 1),
        point: ["px", "py"].map(|name| m.reg_signed(name, bits + 1)),
        square: m.reg("square", 2 * n),
        unit: ArithmeticUnit::new(m, &[&COMMON[..], own].concat(), [bits; 2], [2 * bits, bits], bits),
    };
    let ends = ["xe", "ye"].map(|name| block.held_signed(m, name, n + 1));
    let Way { products, moves, first, stands } =
        if by_direction { coarse.by_direction() } else { coarse.by_step_factor() };

    let product = coarse.unit.multiplier.product();
    let of_square = product.slice(0, 2 * n);
    let [squared_x, squared_y] = [at::SQUARE_X, at::SQUARE_Y].map(|state| coarse.unit.multiplied(state));
    let sum = coarse.square.q.wrapping_add(of_square);
    coarse.square.when(squared_x, of_square).when(squared_y, sum).else_hold();

    // On which side of the end's radius the point lies: xe·y - ye·x.
    let [x, y] = coarse.point.map(|axis| axis.q);
    let [ax, ay] = [x, y].map(|coordinate| coarse.magnitude(coordinate));
    let [ex, ey] = ends.map(|end| magnitude(m, end).slice(0, n));
    let wide = bits + n + 2;
    let turned = |negative| with_sign(m, product.slice(0, bits + n), wide, negative);
    let [side_x, side_y] = [at::SIDE_X, at::SIDE_Y].map(|state| coarse.unit.multiplied(state));
    let half_side = coarse.held("side", side_x, turned(ends[0].msb() ^ y.msb()));
    let side = half_side.as_signed().wrapping_sub(turned(ends[1].msb() ^ x.msb()));
    // Before it, in the sense of the motion.
    let before = coarse.ccw.mux(side.msb(), !side.msb() & side.is_nonzero());
    let was_before = coarse.held("before", side_y, before);
    let arrives = m.reg("arrives", 1);
    let first_side = m.reg("first", 1);
    let [yes, no] = [m.lit(1, 1), m.lit(1, 0)];
    arrives.when(block.load, no).when(side_y, was_before & !before & !first_side.q).else_hold();
    first_side.when(block.load, yes).when(side_y, no).else_hold();

    let begins = |state| coarse.unit.begins(state);
    let [whole_x, whole_y] = [ax, ay].map(|coordinate| coordinate.slice(q, n));
    let common = [
        (begins(at::SQUARE_X), whole_x, whole_x),
        (begins(at::SQUARE_Y), whole_y, whole_y),
        (begins(at::SIDE_X), ay, ex),
        (begins(at::SIDE_Y), ax, ey),
    ];
    coarse.unit.multiplier.close(&[&common[..], &products].concat());
    let hand = m.name("hand", coarse.unit.sequence.at(at::HAND) & fine.free());
    let common = [
        (squared_x, at::SQUARE_Y),
        (squared_y, first[0]),
        (stands, at::SIDE_X),
        (side_x, at::SIDE_Y),
        (side_y & first_side.q, first[1]),
        (side_y, at::HAND),
        (hand & !arrives.q, first[1]),
        (hand, 0),
    ];
    coarse.unit.sequence.close(block.load, &[&common[..], &moves].concat());
    // As wide as the points that the fine stage takes.
    let points = [x, y].map(|coordinate| coordinate.extend(bits + 2));
    fine.close(block, hardware, [hand, arrives.q], points, q, ends);
}

fn load(arc: &Arc, hardware: &Hardware) -> Vec<Words> {
    let Some(sampling) = hardware.sampling else { return Vec::new() };
    let [[x, y], [xe, ye], from] = [arc.start(), arc.end(), arc.from()].map(|point| point.map(i128::from));
    let fine = |coordinate: i128| coordinate << sampling.fraction;
    vec![vec![
        ("f", sampling.word.into()),
        ("ccw", i128::from(arc.direction() == Direction::CounterClockwise)),
        ("px", fine(x)),
        ("py", fine(y)),
        ("xe", xe),
        ("ye", ye),
        ("tx", x),
        ("ty", y),
        ("jrx", hardware.preset(0, "jrx")),
        ("jry", hardware.preset(1, "jry")),
        ("x", from[0]),
        ("y", from[1]),
    ]]
}
