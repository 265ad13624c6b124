//! Designs for other tools: a design as Verilog, and a test bench that drives it as an engine would be driven, or a
//! harness of four pins for place and route; for model checkers and solvers as BTOR2 and as SMT-LIB 2, if need be with
//! a loader that drives it in the test bench's stead.
//!
//! ```
//! use stepwave_export as export;
//! use stepwave_netlist::{dsl::Module, elaborate};
//!
//! let module = Module::new("counter");
//! let m = module.top();
//! let enable = m.input("enable", 1);
//! let count = m.reg("count", 4);
//! count.when(enable, count.q.wrapping_add(m.lit(4, 1))).else_hold();
//! let outputs = [count.q.net()];
//!
//! let design = elaborate(module.finish().unwrap()).unwrap();
//! let text = export::verilog(&design, &export::Options { comment: &[], outputs: &outputs });
//! assert!(text.contains("if (enable) count <= count + 4'd1;"));
//! ```

mod btor2;
mod driven;
mod harness;
mod keywords;
mod smt2;
mod testbench;
mod verilog;
mod words;

pub use btor2::btor2;
pub use driven::{Driven, driven};
pub use harness::harness;
pub use smt2::{smt2, smt2_asking};
pub use testbench::{Stall, Step, Stimulus, testbench};
pub use verilog::verilog;

use stepwave_netlist::cells::Net;

/// What an export says and shows in addition to the design.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// Lines of the comment at the head.
    pub comment: &'a [String],
    /// Nets that become outputs of the module; a synthesizer keeps what these depend on.
    pub outputs: &'a [Net],
}

/// What a model checker or a solver gets in addition to the design.
#[derive(Clone, Copy, Debug, Default)]
pub struct Checking<'a> {
    /// Lines of the comment at the head.
    pub comment: &'a [String],
    /// Inputs that keep one unknown value in all clocks; the others may take any value in each.
    pub held: &'a [Net],
}

/// Lines of comment, each after a mark.
fn comment(lines: &[String], mark: &str) -> String {
    lines.iter().flat_map(|text| text.lines()).map(|line| format!("{mark}{line}\n")).collect()
}
