//! The geometry of numerical control, in integers: blocks and their ideal curves.
//!
//! Every length is in BLU (basic length units, the pulse equivalent δ): one pulse moves an axis by one BLU, and a
//! programmed point has integer coordinates. This crate holds what a block *is* (a [`Line`], an [`Arc`], a [`Conic`], a
//! [`Helix`], a [`Spline`] or a [`Nurbs`], all a [`Curve`]), into which quadrants it falls ([`Arc::sectors`], [`Conic::sectors`],
//! [`Helix::sectors`]), and how far a point that hardware has reached lies off the ideal curve ([`Curve::deviation`]).
//! It knows no register, no clock and no interpolation method.
//!
//! Decisions (which quadrant, on the circle or not, before or after) are made in exact integers; `f64` appears only
//! where a length, an angle or an error is reported. No input panics: what cannot be built is a [`GeometryError`].
//!
//! ```
//! use stepwave_nc::{Arc, Crossing, Direction};
//!
//! // Clockwise about the origin, from the third quadrant into the second.
//! let arc = Arc::new([-5, -3], [-3, 5], [0, 0], Direction::Clockwise)?;
//! let sectors = arc.sectors(Crossing::PathExtreme);
//! assert_eq!(sectors[0].end, [-6, 0]); // the path crosses outside the circle of radius 5.831
//! assert_eq!(sectors.iter().flat_map(|sector| sector.steps()).sum::<i64>(), 12);
//! # Ok::<(), stepwave_nc::GeometryError>(())
//! ```

mod arc;
mod bezier;
mod compensation;
mod conic;
mod contour;
mod curve;
mod ends;
mod error;
mod exact;
mod foot;
mod gauge;
mod helix;
mod limit;
mod line;
mod nurbs;
mod program;
mod pulses;
mod quadrant;
mod sector;
mod spline;
mod tangent;
mod turn;

pub use arc::Arc;
pub use bezier::Bezier;
pub use compensation::{CompensationError, CompensationErrorKind, Compensator, Corner, Scheme, WAITING_LIMIT};
pub use conic::{Conic, ConicSector, Opens, Shape, Weight};
pub use contour::{
    Cause, Controls, Coordinates, Feed, FeedAxes, Move, OTHERS, Others, PathControl, Place, Plane, Point, Position,
    Segment, SegmentShape, Side, ToolMove,
};
pub use curve::{Curve, CurveType, Description, Drawn, OUTLINE_LIMIT};
pub use error::{End, GeometryError};
pub use gauge::{BatchGauge, Gauge};
pub use helix::{Helix, HelixSector, share};
pub use limit::{AXES_MAX, AXES_MIN, AXIS_LETTERS, CONIC_LIMIT, COORDINATE_LIMIT, PARABOLA_LIMIT};
pub use line::Line;
pub use nurbs::{ControlPoint, KnotFault, NURBS_DEGREE, NURBS_MOST, NURBS_POINTS, NURBS_UNIT, Nurbs};
pub use program::{
    Auxiliary, Coolant, Event, Integers, PROGRAM_LIMIT, Program, ProgramError, ProgramErrorKind, Reading, ReadingError,
    Spindle,
};
pub use pulses::{PulseBlock, ROUNDING_LIMIT, Rounder, swept};
pub use quadrant::{Direction, Quadrant};
pub use sector::{Crossing, Sector};
pub use spline::{SPLINE_POINTS, Spline, SplineForm, SplineSegment};
