//! Hardware as data: netlists of clocked, fixed-width components, how they are described, checked and simplified, and
//! the samples that come of them.
//!
//! It knows registers, adders and nets; it knows no interpolation method, no engine and no file. Data flows in one
//! direction:
//!
//! ```text
//! dsl → Netlist → elaborate → Design → (an engine) → Rows
//! ```
//!
//! A counter of four bits, from description to checked design:
//!
//! ```
//! use stepwave_netlist::{dsl::Module, elaborate, text};
//!
//! let module = Module::new("counter");
//! let m = module.top();
//! let enable = m.input("enable", 1);
//! let count = m.reg("count", 4);
//! count.when(enable, count.q.wrapping_add(m.lit(4, 1))).else_hold();
//! let count = count.q.net();
//!
//! let design = elaborate(module.finish().unwrap()).unwrap();
//! assert_eq!(design.registers(), [count]);
//! assert!(text::print(design.netlist()).contains("register"));
//! ```

pub mod bits;
pub mod cells;
pub mod diag;
pub mod dsl;
mod elaborate;
pub mod formula;
pub mod message;
mod nearest;
mod operator;
pub mod passes;
mod rows;
pub mod text;

pub use bits::{Bits, Width, WidthError};
pub use cells::{HasMemories, Net, Netlist, OnOverflow};
pub use diag::{Code, Diagnostic, Diagnostics, Place};
pub use elaborate::{Design, elaborate};
pub use nearest::did_you_mean;
pub use rows::{Extremes, Rows};
