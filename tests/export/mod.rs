//! Exported Verilog as text, which `.ci/peers` runs in other simulators, and models for checkers and solvers.

mod command;
mod driven;
mod models;
mod names;
mod operators;
mod schematic;

use stepwave_export::{Options, verilog};
use stepwave_netlist::dsl::{Module, Scope};
use stepwave_netlist::{Design, elaborate};

/// A design described in place.
fn design(name: &str, describe: impl FnOnce(Scope<'_>)) -> Design {
    let module = Module::new(name);
    describe(module.top());
    elaborate(module.finish().unwrap()).unwrap()
}

/// The module without comments.
fn text(design: &Design) -> String {
    let text = verilog(design, &Options::default());
    text.lines().filter(|line| !line.starts_with("//")).map(|line| format!("{line}\n")).collect()
}

#[test]
fn a_small_machine_reads_as_an_engineer_would_write_it() {
    let design = design("adder", |m| {
        let load = m.scope("block").input("load", 1);
        let x = m.scope("axis_x");
        let integrand = x.reg("jvx", 4).reset(5);
        integrand.set(integrand.q);
        let remainder = x.reg("jrx", 4);
        let (carry, sum) = remainder.q.carrying_add(integrand.q);
        remainder.when(load, m.lit(4, 8)).otherwise(sum);
        x.name("pulse", carry & !load);
    });
    let expected = include_str!("adder.v");
    let written = verilog(&design, &Options { comment: &["an adder".to_owned()], outputs: &[] });
    assert_eq!(written, expected, "\n{written}");
    assert_eq!(verilog(&design, &Options { comment: &["an adder".to_owned()], outputs: &[] }), written);
}

#[test]
fn a_comment_of_several_lines_stays_a_comment() {
    let design = design("m", |m| _ = m.input("a", 1));
    let comment = ["one\ntwo\\".to_owned(), "verilator three".to_owned()];
    let written = verilog(&design, &Options { comment: &comment, outputs: &[] });
    assert!(written.starts_with("// one\n// two\n// : verilator three\n// Registers"), "{written}");
}
