//! Studies: many geometries with many hardware choices, each run measured; and [proofs](proof) over all of them.
//!
//! ```text
//! Sweep (model, Space of geometries, Variants of hardware)  →  rows, part by part  →  Stage (CSV)  →  Parquet, heat map
//! ```
//!
//! A row is what `stepwave run` comes to with the same words. Rows follow from their number alone: neither the number of
//! threads nor how the work is cut changes a byte of what is written.
//!
//! ```
//! use stepwave::models::{Millionths, find};
//! use stepwave::models::options::WIDTH;
//! use stepwave::study::{Cells, Dimension, Drawn, SweepPart, Range, Space, Sweep, Value, Variants};
//!
//! let cells = Cells {
//!     drawn: Drawn::Line,
//!     sizes: vec![],
//!     from: Some(vec![Range::one(0), Range::one(0)]),
//!     to: Some(vec!["1..7".parse()?, "0..3".parse()?]),
//!     center: [0, 0],
//!     directions: vec![],
//!     radii: Millionths(0),
//! };
//! let variants = Variants(vec![Dimension::parse(&WIDTH, "3..4")?]);
//! let sweep = Sweep::new(find("dda-line")?, Space::Cells(cells), variants, SweepPart::WHOLE, 1 << 20)?;
//! let rows = sweep.rows(0..sweep.geometries())?;
//! assert_eq!(rows.len(), 7 * 4 * 2);
//! let clocks = sweep.column("clocks").unwrap();
//! assert_eq!(rows[0][clocks], Value::Whole(9)); // (1, 0) in 3 bits: 2^3 steps and the load
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod boxes;
mod columns;
mod error;
pub mod exhausted;
mod free_curves;
mod hardware_cache;
mod kform;
pub mod machine;
mod merge;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(not(feature = "parquet"))]
#[path = "no_parquet.rs"]
mod parquet;
mod parts;
mod points;
pub mod proof;
pub mod ramp;
mod range;
mod space;
mod stage;
mod summary;
mod sweep;
pub mod synth;
mod table;
mod variants;
pub mod widths;

pub use boxes::{Extent, Geometries};
pub use columns::{RIPPLE, words};
pub use error::StudyError;
pub(crate) use free_curves::{units, usual_degree};
pub use kform::KForm;
pub use merge::merge;
pub use parquet::ParquetTable;
pub use points::read_points;
pub use range::{Grid, Range};
pub use space::{Cells, Geometry, Space, SweepPart};
pub use stage::Stage;
pub use stepwave_nc::Drawn;
pub use summary::Summary;
pub use sweep::{MOST_RUNS, Sweep};
pub use table::{Column, ColumnType, Row, Value, heading, read_line, write_line};
pub use variants::{Dimension, Variants};
