//! `cim-arc`: comparison-integral (比较积分法), arc.
//!
//! ```text
//!   quad, ccw ──► kind ──► which interval grows, directions
//!                   │
//!   a = |x| ──┬──► compare ──► base axis, which steps always
//!   b = |y| ──┘                    │
//!      ▲      F ──► F >= 0 ──► the other axis steps too ──► dx, dy ──► x, y
//!      │      ▲                    │                         │
//!      └──────┴── ± weights ◄──────┴─────────────────────────┴──► ex, ey ──► done
//! ```
//!
//! The axis with the smaller interval is the base axis: it steps at every step, the other where F >= 0. F gains the
//! weight of the base axis for its pulse and loses that of the other for its own. With `mid` a pulse weighs A before it
//! plus A after it, so that F is x² + y² - R² up to its sign; with `pre` A before, with `post` A after it. Where A and
//! B change places the base axis changes, and F := -F: without that the path drifts by up to 2.8 BLU. The loader splits
//! the arc at the axes, at R rounded to the nearest integer but never before the point already reached.
//!
//! With `mid` the path stays within 1 BLU of the circle. F with `pre` and `post` is within [-R, R] while both axes run,
//! in n+1 bits; forced steps after that take it to 1.39 R where a split is off the circle. Inside a quadrant with both
//! ends on the circle n+1 bits always do: `pre` weighs half of what x² + y² gains less the steps of both axes, `post`
//! half of that and the steps.
//!
//! The arc NR1 from (5, 0) to (0, 5), from the golden file `waves/cim-arc-nr1.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/cim-arc-nr1.csv")]
//! ```

use stepwave_nc::{Arc, Crossing, Sector};
use stepwave_netlist::dsl::Scope;
use stepwave_netlist::formula::{Formula, name};

use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{BEATS, END_POINT, EndPoint, ON_OVERFLOW, WEIGHTS, WIDTH, Weights};
use crate::parts::{
    A_B, ArcKind, BASE, Block, CCW, Change, END, F, POSITION, QUAD, Side, comparison_integral, quadrant_register,
};
use crate::plan::Plan;
use crate::{sizes, words};

/// Comparison-integral, arc.
pub static MODEL: Model = Model {
    name: "cim-arc",
    title: "Comparison-integral, arc",
    method: "comparison-integral",
    source: "比较积分法, as in Chinese NC textbooks, with F turned over where the base axis changes",
    registers: &[
        &F.about("deviation F, two's complement"),
        &A_B.about("interval weights A of an X, B of a Y pulse: |x|, |y|"),
        &BASE,
        &QUAD,
        &END,
        &POSITION,
    ],
    options: &[&WIDTH, &WEIGHTS, &BEATS, &ON_OVERFLOW],
    claims: Some(Claims { modes: &[BASE], ..Claims::of(Region::QuadrantArcs) }),
    interpolates: Interpolates::Arcs(Method { plan, load }),
    hardware,
};

fn plan(arc: &Arc, plan: &mut Plan) -> Result<(), ModelError> {
    let sectors = arc.sectors(Crossing::RoundedRadius);
    plan.n = plan.magnitude_bits(sizes::largest_coordinate(&sectors));
    plan.set(F, sizes::off_circle_bits(arc, plan) + 2);
    plan.positions(sizes::arc_positions(arc, &sectors));
    plan.fix(&END_POINT, EndPoint::PerAxis);
    plan.error_bound = (plan.get(&WEIGHTS) == Weights::Mid).then_some(1.0);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let ccw = hardware.held(m, &block, CCW);
    let quad = quadrant_register(m);
    quad.when(block.load, hardware.word(&block, QUAD)).else_hold();
    let kind = ArcKind::decode(m.scope("quadrant"), quad.q, ccw);
    let side = |negative, grows| Side { negative, change: Some(Change { grows, unit: m.lit(1, 1) }) };
    let sides = [side(kind.x_negative, kind.x_grows), side(kind.y_negative, !kind.x_grows)];
    between_steps(m, hardware.get(&WEIGHTS));
    comparison_integral(m, block, hardware, sides);
}

/// F is ±(x² + y² - R²), or with `pre` and `post` half of that less or more the steps of both axes; it stays between
/// what a step of the base axis at -1 and a step of both at 0 leave, turned over where the base axis changes.
fn between_steps(m: Scope<'_>, rule: Weights) {
    let (f, y_is_base, x_grows) = (|| F.value(), || BASE.value(), || name("x_grows"));
    let [[a, b], [ex, ey]] = [A_B, END.pair()].map(|pair| [pair.of(0), pair.of(1)]);
    let x = ("x", a, b, [ex, ey], y_is_base() - 1, [x_grows() - 1, -x_grows()]);
    let y = ("y", b, a, [ey, ex], -y_is_base(), [-x_grows(), x_grows() - 1]);
    for (axis, own, other, [end, end_of_other], not, [grows, shrinks]) in [x, y] {
        let state = |bound: &str, any: Vec<Formula>| {
            m.between_steps(&format!("f_from_{bound}_{axis}"), any.into_iter().chain([not.clone()]));
        };
        if rule == Weights::Mid {
            state("below", vec![f() + 2 * other.value()]);
            state("above", vec![2 * own.value() - f(), -f()]);
            continue;
        }
        state("of_a_tie", vec![other.value() - own.value() - 1, -f(), grows.clone()]);
        // Where the growing axis with `pre`, the shrinking one with `post` is at its end, the steps taken bound F.
        let (below, above) = (f() + other.value() + 1, own.value() - f());
        let (free_below, free_above) = if rule == Weights::Pre { (grows, shrinks) } else { (shrinks, grows) };
        state("below", vec![below.clone(), free_below]);
        state("below_while_running", vec![below, -end.value()]);
        state("above", vec![above.clone(), free_above]);
        state("above_while_running", vec![above, -end_of_other.value()]);
    }
}

fn load(arc: &Arc, hardware: &Hardware) -> Vec<Words> {
    let block = |sector: &Sector| {
        let [x, y] = sector.start.map(i128::from);
        let x_grows = sector.quadrant.growing_axis(arc.direction()) == 0;
        let deviation = x * x + y * y - arc.radius_squared();
        let f = words::weighed(hardware.get(&WEIGHTS), [x.abs(), y.abs()], x_grows, deviation);
        let own = Words::new().set(F, f).set_each(A_B, [x.abs(), y.abs()]).set_each(END.pair(), sector.steps());
        own.and(words::sector(arc, sector))
    };
    arc.sectors(Crossing::RoundedRadius).iter().map(block).collect()
}
