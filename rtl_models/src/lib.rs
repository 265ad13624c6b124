//! The interpolators of numerical control as netlists: [`parts`] that more than one method uses, and one file per model
//! that holds what is particular to its method.
//!
//! Models use the public interface of the netlist crate only. [`catalogue`] holds them all.
//!
//! ```
//! use stepwave_models::parts::JR;
//! use stepwave_models::{Options, find};
//! use stepwave_nc::{Curve, Line};
//!
//! let model = find("dda-line")?;
//! let line = Curve::Line(Line::new(vec![0, 0], vec![8, 6]).unwrap());
//! let hardware = model.plan(&line, &Options::default())?;
//! assert_eq!(hardware.bits(JR.of(0)), 4);
//! let machine = model.machine(&hardware)?;
//! assert_eq!(machine.design.netlist().cell(machine.positions[0].net).width.get(), 6);
//! # Ok::<(), stepwave_models::ModelError>(())
//! ```

pub mod bresenham;
pub mod cim_arc;
pub mod cim_conic;
pub mod cim_line;
pub mod dda_arc;
pub mod dda_conic;
pub mod dda_helix;
pub mod dda_line;
pub mod dpm_line;
pub mod events;
pub mod mindev_arc;
pub mod mindev_line;
pub mod options;
pub mod parts;
pub mod ppc_arc;
pub mod ppc_conic;
pub mod ppc_line;
pub mod program;
pub mod ramp;
pub mod ramp_after;
pub mod ramping;
pub mod registers;
pub mod sampled_arc;
pub mod sampled_line;
pub mod sampled_spline;
pub mod spline_dda;
pub mod stepgen;
pub mod vector_arc;
pub mod vector_line;

/// The models of this crate, in the order of `stepwave list`: with its module above, a model is known everywhere.
static MODELS: &[&Model] = &[
    &ppc_line::MODEL,
    &ppc_arc::MODEL,
    &ppc_conic::MODEL,
    &dda_line::MODEL,
    &dda_arc::MODEL,
    &dda_conic::MODEL,
    &dda_helix::MODEL,
    &dpm_line::MODEL,
    &cim_line::MODEL,
    &cim_arc::MODEL,
    &cim_conic::MODEL,
    &mindev_line::MODEL,
    &mindev_arc::MODEL,
    &vector_line::MODEL,
    &vector_arc::MODEL,
    &sampled_line::MODEL,
    &sampled_arc::MODEL,
    &sampled_spline::MODEL,
    &spline_dda::MODEL,
    &ramp::MODEL,
    &ramp_after::MODEL,
    &stepgen::MODEL,
    &bresenham::MODEL,
    &program::ppc::MODEL,
    &program::dda::MODEL,
    &program::dpm::MODEL,
    &program::cim::MODEL,
    &program::mindev::MODEL,
    &program::stepgen::MODEL,
    &program::bresenham::MODEL,
];

mod catalogue;
mod claims;
mod described;
mod differences;
mod docs;
mod error;
mod hardware;
mod interpolates;
mod machine;
mod model;
mod plan;
mod promise;
mod sampling;
mod sizes;
mod words;

pub use catalogue::{Catalogue, catalogue, find, installed};
pub use claims::{Claims, Kind, Region, extremes};
pub use described::{Described, know};
pub use error::ModelError;
pub use hardware::{Hardware, Pace};
pub use machine::{AfterPorts, BufferPorts, CutWord, Loaded, Machine, Port, Words};
pub use options::{
    Adder, AnyOption, Beats, Compare, EndPoint, Form, Millionths, Named, OptionDef, Options, PerRegister, Preset,
    Radix, StepTiming, System, Takes, Weights,
};

pub use interpolates::{CurveKind, Interpolates, Method};
pub use model::Model;
pub use plan::Plan;
pub use promise::Promise;
pub use registers::{AXES, N, PerAxis, Reg};
pub use sampling::Sampling;
pub use stepwave_netlist::OnOverflow;
