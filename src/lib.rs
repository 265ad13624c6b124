//! `stepwave`: cycle-accurate simulation of numerical-control interpolator hardware.
//!
//! Registers, adders, integrators and end-point counters are clocked components of fixed width, wired into one netlist
//! per interpolation method, simulated clock by clock and dumped as VCD. This crate is the bench on which geometry
//! ([`nc`]), models ([`models`]), engines ([`engine`]) and waves ([`trace`]) meet; the program `stepwave` is its command line.
//!
//! A DDA line to (8, 6) in four bits, step by step:
//!
//! ```
//! use stepwave::engine::EngineKind;
//! use stepwave::models::{Options, find};
//! use stepwave::nc::{Curve, Line};
//! use stepwave::testbench::{Observer, ObserverError, Step, Testbench};
//!
//! #[derive(Default)]
//! struct Pulses { y: Vec<u64> }
//!
//! impl Observer for Pulses {
//!     fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
//!         if step.pulses[1] != 0 {
//!             self.y.push(step.number);
//!         }
//!         Ok(())
//!     }
//! }
//!
//! let curve = Curve::Line(Line::new(vec![0, 0], vec![8, 6])?);
//! let bench = Testbench::new(find("dda-line")?, &curve, &Options::default())?;
//! let mut pulses = Pulses::default();
//! let outcome = bench.run(EngineKind::Word, &mut [&mut pulses]).unwrap();
//! assert_eq!(pulses.y, [3, 6, 8, 11, 14, 16]);
//! assert_eq!(outcome.reached, [8, 6]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use stepwave_engine as engine;
pub use stepwave_export as export;
pub use stepwave_models as models;
pub use stepwave_nc as nc;
pub use stepwave_netlist as netlist;
pub use stepwave_prove as prove;
pub use stepwave_trace as trace;

#[cfg(feature = "cli")]
mod app;
#[cfg(feature = "cli")]
mod cli;
#[cfg(feature = "cli")]
mod commands;
mod error;
#[cfg(feature = "cli")]
pub mod golden;
mod output;
pub mod program;
pub mod report;
mod simulation;
mod stop;
pub mod study;
pub mod testbench;
mod waves;

#[cfg(feature = "cli")]
pub use app::main_with;
pub use error::Error;
pub use simulation::Simulation;
pub use testbench::Trace;
pub use waves::WaveOptions;
