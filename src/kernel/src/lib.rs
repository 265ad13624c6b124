//! The hardware kernel of `stepwave`: netlists of clocked, fixed-width components, the engines that simulate them
//! clock by clock, and the waves that come out.
//!
//! It knows registers, adders and nets; it knows no interpolation method and no NC program. Data flows one way:
//!
//! ```text
//! dsl → Netlist → elaborate → Design → Engine → Rows → trace
//! ```
//!
//! A counter of four bits, from description to samples:
//!
//! ```
//! use stepwave_kernel::{dsl::Module, elaborate, engine::{EngineKind, Rows, Watch}};
//!
//! let module = Module::new("counter");
//! let m = module.top();
//! let enable = m.input("enable", 1);
//! let count = m.reg("count", 4);
//! count.when(enable, count.q.wrapping_add(m.lit(4, 1))).else_hold();
//! let (enable, count) = (enable.net(), count.q.net());
//!
//! let design = elaborate(module.finish().unwrap()).unwrap();
//! let watch = Watch { columns: vec![count], stops: vec![] };
//! let mut engine = EngineKind::Gates.build(&design, &watch);
//! let mut rows = Rows::new(1, 32);
//! engine.set_input(enable, 1);
//! engine.reset(&mut rows);
//! engine.run(18, &mut rows);
//! assert_eq!(rows.row(18), [2]); // 18 modulo 16
//! ```

pub mod bits;
pub mod diag;
pub mod dsl;
mod elaborate;
pub mod engine;
pub mod export;
pub mod formula;
pub mod guard;
mod nearest;
pub mod netlist;
pub mod passes;
pub mod prove;
pub mod text;
pub mod trace;

pub use bits::{Bits, Width, WidthError};
pub use diag::{Code, Diagnostic, Diagnostics, Place};
pub use elaborate::{Design, elaborate};
pub use nearest::did_you_mean;
pub use netlist::{Net, Netlist, OnOverflow};
