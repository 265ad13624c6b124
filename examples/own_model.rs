//! A method that is not in the catalogue: a DDA that subtracts, so that the borrow is the pulse. `main` gives it every
//! command of the program:
//!
//! ```text
//! cargo run --example own_model -- run borrow-line --to 8,6 --steps -
//! cargo run --example own_model -- sweep borrow-line --to-grid 0..63x0..63 --csv lines.csv
//! cargo run --example own_model -- prove borrow-line
//! ```
//!
//! ```text
//!   for each axis:   jv ──► - ──► jr ──┐      2^n iterations, which e counts
//!                           ▲──────────┘
//!                           │ borrow
//!                           └──► d ──► position
//! ```

use std::process::ExitCode;

use stepwave::models::options::{ON_OVERFLOW, WIDTH};
use stepwave::models::parts::{Block, E, JR, JV, POSITION, SIGN, axis_scope};
use stepwave::models::{
    Claims, Hardware, Interpolates, Method, Model, ModelError, Pace, Plan, Region, Words, catalogue,
};
use stepwave::nc::Line;
use stepwave::netlist::dsl::Scope;

static BORROW_LINE: Model = Model {
    name: "borrow-line",
    title: "Subtracting DDA, line of 2 axes",
    method: "subtracting DDA",
    source: "an example of this project",
    registers: &[
        &(JV, JR.about("remainder J_R of each axis, from 0")),
        &E.about("iterations left, from 2^n"),
        &POSITION,
    ],
    options: &[&WIDTH, &ON_OVERFLOW],
    claims: Some(Claims::of(Region::Lines)),
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    plan.n = plan.magnitude_bits(line.delta().iter().map(|d| d.unsigned_abs()).max().unwrap_or(0));
    let iterations = plan.bits(JR.of(0)) + 1;
    plan.set(E, iterations).positions(line.from().iter().zip(line.to()).map(|(&from, &to)| [from, to]));
    plan.integrators(1)?;
    plan.pace = Pace::Cycle(JR.of(0));
    plan.error_bound = Some(1.0);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    for axis in 0..hardware.axes {
        let (scope, remainder) = (axis_scope(m, axis), JR.of(axis));
        let integrand = hardware.held(scope, &block, JV.of(axis)).extend(hardware.bits(remainder));
        let jr = hardware.reg(scope, remainder);
        let (borrow, rest) = jr.q.borrowing_sub(integrand);
        jr.when(block.load, hardware.word(&block, remainder)).when(block.busy, rest).else_hold();
        let (pulse, negative) = (scope.name("pulse", borrow & block.busy), hardware.held(scope, &block, SIGN.of(axis)));
        hardware.axis(scope, &block, axis, pulse, negative);
    }
    let last = hardware.counter(m, &block, E).count(block.busy);
    block.close(block.load, block.busy, last);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let words = (0..hardware.axes).fold(Words::new().set(E, 1_i128 << hardware.bits(JR.of(0))), |words, axis| {
        let delta = line.delta()[axis];
        let words = words.set(JV.of(axis), delta.abs()).set(JR.of(axis), 0).set(SIGN.of(axis), delta < 0);
        words.set(POSITION.of(axis), line.from()[axis])
    });
    vec![words]
}

fn main() -> ExitCode {
    stepwave::main_with(catalogue().with(&BORROW_LINE))
}
