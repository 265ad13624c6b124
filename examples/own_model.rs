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
use stepwave::models::parts::{Block, DownCounter, axis_counter};
use stepwave::models::{
    Claims, Hardware, Interpolates, Method, Model, ModelError, Pace, Plan, Region, RegisterDoc, Words, catalogue,
};
use stepwave::nc::Line;
use stepwave::netlist::dsl::Scope;

static BORROW_LINE: Model = Model {
    name: "borrow-line",
    title: "Subtracting DDA, line of 2 axes",
    method: "subtracting DDA",
    source: "an example of this project",
    registers: &[
        RegisterDoc { name: "jvx, jvy", width: "n", about: "integrand J_V of each axis, |d|" },
        RegisterDoc { name: "jrx, jry", width: "n", about: "remainder J_R of each axis, from 0" },
        RegisterDoc { name: "e", width: "n+1", about: "iterations left, from 2^n" },
        RegisterDoc { name: "x, y", width: "as the path needs, + 1", about: "machine position, signed" },
    ],
    options: &[&WIDTH, &ON_OVERFLOW],
    claims: Some(Claims::of(Region::Lines)),
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

/// Letter, integrand, remainder and direction of each axis.
const NAMES: [[&str; 4]; 2] = [["x", "jvx", "jrx", "sx"], ["y", "jvy", "jry", "sy"]];

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let n = plan.magnitude_bits(line.delta().iter().map(|d| d.unsigned_abs()).max().unwrap_or(0));
    plan.register("jvx", n).register("jrx", n).register("jvy", n).register("jry", n);
    let e = plan.bits("jrx") + 1;
    plan.register("e", e).positions(line.from().iter().zip(line.to()).map(|(&from, &to)| vec![from, to]));
    plan.integrators(1)?;
    plan.pace = Pace::Cycle("jrx");
    plan.error_bound = Some(1.0);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    for [letter, jv, jr, sign] in NAMES {
        let (scope, bits) = (m.scope(&format!("axis_{letter}")), hardware.bits(jr));
        let integrand = block.held(scope, jv, hardware.bits(jv)).extend(bits);
        let remainder = scope.reg(jr, bits);
        let (borrow, rest) = remainder.q.borrowing_sub(integrand);
        remainder.when(block.load, block.word(jr, bits)).when(block.busy, rest).else_hold();
        let (pulse, negative) = (scope.name("pulse", borrow & block.busy), block.held(scope, sign, 1));
        axis_counter(scope, &block, letter, hardware.bits(letter), pulse, negative);
    }
    let last = DownCounter::new(m, &block, "e", hardware.bits("e")).count(block.busy);
    block.close(block.load, block.busy, last);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let mut words: Words = vec![("e", 1 << hardware.bits("jrx"))];
    for (axis, [letter, jv, jr, sign]) in NAMES.into_iter().enumerate() {
        let [delta, start] = [line.delta()[axis], line.from()[axis]].map(i128::from);
        words.extend([(jv, delta.abs()), (jr, 0), (sign, i128::from(delta < 0)), (letter, start)]);
    }
    vec![words]
}

fn main() -> ExitCode {
    stepwave::main_with(catalogue().with(&BORROW_LINE))
}
