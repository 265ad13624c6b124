//! Tool radius compensation: from the contour as programmed (G41, G42) to the path of the tool's centre.
//!
//! With s = 1 for G41 and s = -1 for G42, the tool's centre is at the distance r from the contour along the normal
//! n = s·(-ly, lx). A line is moved by r·n; a counter-clockwise arc gets the radius R - s·r, a clockwise one R + s·r.
//! At a corner P, with the unit tangents l1 (leaving) and l2 (entering), p = -(l1·l2) and q = s·(l2x·l1y - l1x·l2y)
//! decide:
//!
//! | class | when | the tool's centre |
//! |---|---|---|
//! | shortening (inside) | q < 0 | turns where the offset paths meet, before both ends |
//! | extension (outside) | q > 0, p <= 0 | turns where the offset paths meet, beyond both ends |
//! | insertion (outside) | q > 0, p > 0 | goes round P: by P + r(n1 + l1) and P + r(n2 - l2), or on an arc of radius r |
//! | straight on | q = 0, p < 0 | passes P + r·n |
//! | reversal | q = 0, p > 0 | goes round P as on an insertion |
//!
//! q counts as 0 within 1e-9 (the sine of the angle between the tangents), and so does p where it separates extension
//! from insertion. Next to an arc, an extension whose offset paths do not meet is an insertion; a tangent of the arc
//! then is a move of its own. Two paths with an arc meet in two points; the one nearest to P + r·n is taken. A reversal
//! whose second block bends into the tool has no room for it and is an error.
//!
//! **Scheme B** sees each block alone. From normal to normal, blocks whose offset paths do not meet are joined by a
//! straight move: inside corners are overcut, outside corners are cut off, unless the programmer rounds them with arcs,
//! as machines of that kind want it. **Scheme C** looks one block ahead and does what the table says; what two blocks
//! that are no neighbours do to one another it does not see either.
//!
//! - *Start-up* (On to Left or Right): a straight move, at least r long in the plane, from the uncompensated point to
//!   P + r·n of the block that follows, at its start; if none follows, of its own end. This is done at outside corners
//!   too. *Cancel*: the block before ends at P + r·n of its end, and a straight move of at least r goes to the programmed
//!   point.
//! - A *stop* or the end of the program ([`Compensator::flush`]): the tool stops at P + r·n of the last block's end. If
//!   the contour continues, the tool goes round an outside corner from there, and straight to the next normal at an
//!   inside corner, which it has overcut by then.
//! - Moves *without motion in the plane* (along the third axis) are done where the block before them ends, with the
//!   look-ahead passing over them; at most [`WAITING_LIMIT`] between two blocks. A start-up or cancel in such a block
//!   takes effect on the next move in the plane.
//! - A *change of the radius* joins P + r1·n1 and P + r2·n2 by a straight move, a *change of the side* P + r·n1 and
//!   P + r·n2, which crosses the contour; the latter between straight moves only.
//! - The third coordinate of an end is kept as programmed.
//!
//! Tools that are too large are errors that name the block: offset paths that do not meet at an inside corner, an arc
//! with the tool inside that is not larger than the tool, and a compensated block that would run backwards.

mod corner;
mod error;
mod geometry;
mod stream;

pub use error::{CompensationError, CompensationErrorKind};
pub use stream::Compensator;

/// The largest number of moves without motion in the plane between two compensated blocks.
pub const WAITING_LIMIT: usize = 8;

/// How far compensation sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Scheme {
    /// Each block alone; a straight move joins the normals at a corner.
    B,
    /// One block of look-ahead.
    #[default]
    C,
}

/// How an insertion of scheme C goes round an outside corner; scheme B does not use it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Corner {
    /// Straight moves, by P + r(n1 + l1) and P + r(n2 - l2).
    #[default]
    Straight,
    /// An arc about the corner.
    Circular,
}

#[cfg(test)]
mod tests;
