//! The interpolators of numerical control as netlists: [`parts`] that more than one method uses, and one file per model
//! that holds what is particular to its method.
//!
//! Models use the kernel's public interface only. [`catalogue`] is the one list of models.
//!
//! ```
//! use stepwave_models::{Choices, find};
//! use stepwave_nc::{Curve, Line};
//!
//! let model = find("dda-line")?;
//! let line = Curve::Line(Line::new(vec![0, 0], vec![8, 6]).unwrap());
//! let hardware = model.plan(&line, &Choices::default())?;
//! assert_eq!(hardware.bits("jrx"), 4);
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
pub mod mindev_arc;
pub mod mindev_line;
pub mod parts;
pub mod ppc_arc;
pub mod ppc_conic;
pub mod ppc_line;
pub mod program;
pub mod sampled_arc;
pub mod sampled_line;
pub mod stepgen;
pub mod vector_arc;
pub mod vector_line;

mod choices;
mod claims;
mod docs;
mod error;
mod hardware;
mod machine;
mod model;
mod plan;
mod promise;
mod registers;
mod sampling;
mod words;

pub use choices::{
    Adder, Beats, Choice, Choices, Compare, EndPoint, Form, Millionths, Named, Preset, Radix, StepTiming, System,
    Weights,
};
pub use claims::{Claims, Kind, Region, extremes};
pub use error::ModelError;
pub use hardware::{AXES, Hardware, Pace};
pub use machine::{CutWord, Loaded, Machine, Port, Words};

pub use model::{ChoiceDoc, CurveKind, Model, RegisterDoc};
pub use promise::Promise;
pub use sampling::Sampling;
pub use stepwave_kernel::OnOverflow;

/// Every model.
#[must_use]
pub fn catalogue() -> &'static [Model] {
    const CATALOGUE: &[Model] = &[
        ppc_line::MODEL,
        ppc_arc::MODEL,
        ppc_conic::MODEL,
        dda_line::MODEL,
        dda_arc::MODEL,
        dda_conic::MODEL,
        dda_helix::MODEL,
        dpm_line::MODEL,
        cim_line::MODEL,
        cim_arc::MODEL,
        cim_conic::MODEL,
        mindev_line::MODEL,
        mindev_arc::MODEL,
        vector_line::MODEL,
        vector_arc::MODEL,
        sampled_line::MODEL,
        sampled_arc::MODEL,
        stepgen::MODEL,
        bresenham::MODEL,
    ];
    CATALOGUE
}

/// The model of this name.
///
/// # Errors
/// There is none; the message lists those there are.
pub fn find(name: &str) -> Result<&'static Model, ModelError> {
    catalogue().iter().find(|model| model.name == name).ok_or_else(|| ModelError::UnknownModel {
        name: name.to_owned(),
        known: catalogue().iter().map(|model| model.name).collect::<Vec<_>>().join(", "),
    })
}
