//! `stepwave`: cycle-accurate simulation of numerical-control interpolator hardware.
//!
//! Registers, adders, integrators and end-point counters are clocked components of fixed width, wired into one netlist
//! per interpolation method, simulated clock by clock and dumped as VCD. This crate is the bench on which geometry
//! ([`nc`]), models ([`models`]), engines ([`engine`]) and waves ([`trace`]) meet; the program `stepwave` is its
//! command line.
//!
//! A DDA line to (8, 6) in four bits, with its wave and its report:
//!
//! ```
//! use stepwave::Simulation;
//! use stepwave::models::{find, options::Options};
//! use stepwave::nc::{Curve, Line};
//!
//! let line = Curve::Line(Line::new(vec![0, 0], vec![8, 6])?);
//! let simulation = Simulation::new(find("dda-line")?, line).options(Options::parse(["--width", "4"])?);
//! # let folder = tempfile::tempdir()?;
//! # let simulation = simulation.vcd(folder.path().join("line.vcd"));
//! let (report, trace) = simulation.run_traced()?; // `.vcd("line.vcd")` writes the wave with GTKWave's files
//! assert!(report.failures().is_empty());
//! assert_eq!(trace.row("dy")?, "0000_1001_0100_1001_01");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`guide`] has programs to read first: a first wave, a method of one's own with every command, a netlist that is not
//! an interpolator, golden waves in `cargo test`, a sweep. One crate a layer: [`netlist`] is hardware as data,
//! [`engine`] runs it, [`trace`] shows it, [`export`] hands it on, [`prove`] proves things of it, [`nc`] is geometry
//! and NC programs, [`models`] the interpolators.

pub use stepwave_engine as engine;
pub use stepwave_export as export;
pub use stepwave_import as import;
pub use stepwave_models as models;
pub use stepwave_nc as nc;
pub use stepwave_netlist as netlist;
pub use stepwave_prove as prove;
pub use stepwave_schematic as schematic;
pub use stepwave_testbench as testbench;
pub use stepwave_trace as trace;

#[cfg(feature = "cli")]
mod app;
#[cfg(feature = "cli")]
mod cli;
#[cfg(feature = "cli")]
mod commands;
mod error;
pub mod golden;
pub mod guide;
#[cfg_attr(not(feature = "cli"), allow(dead_code, reason = "commands use the rest"))]
mod output;
#[cfg_attr(not(feature = "cli"), allow(dead_code, reason = "commands use the rest"))]
pub mod own;
pub mod program;
pub mod report;
#[cfg_attr(not(feature = "cli"), allow(dead_code, reason = "commands use the rest"))]
mod simulation;
#[cfg_attr(not(feature = "cli"), allow(dead_code, reason = "commands use the rest"))]
mod stop;
pub mod study;
#[cfg_attr(not(feature = "cli"), allow(dead_code, reason = "commands use the rest"))]
mod waves;

#[cfg(feature = "cli")]
pub use app::main_with;
pub use error::Error;
pub use simulation::Simulation;
pub use study::proof;
pub use testbench::Trace;
pub use waves::{Viewer, WaveOptions};
