//! Designs for other tools: a design as Verilog, and a test bench that drives it as an engine would be driven.
//!
//! ```
//! use stepwave_kernel::{dsl::Module, elaborate, export};
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

mod keywords;
mod testbench;
mod verilog;

pub use testbench::{Stall, Step, Stimulus, testbench};
pub use verilog::verilog;

use crate::netlist::Net;

/// What an export is to say and to show beside the design itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// Lines of the comment at the head.
    pub comment: &'a [String],
    /// Nets that become outputs of the module; a synthesizer keeps what these depend on.
    pub outputs: &'a [Net],
}
