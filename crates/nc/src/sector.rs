//! Splitting an arc at the axes through its centre.

use crate::exact::{ceil_sqrt, length, norm_squared, round_sqrt, vector};
use crate::{Arc, Quadrant};

/// Where an arc that continues into the next quadrant crosses the axis.
///
/// Under either rule the last crossing of an arc is moved out to the end point's coordinate on the same axis, |c|,
/// where that is greater. In the last sector this coordinate can only shrink, so an end point up to 1 BLU off the
/// circle is always reached. An end point on the circle never moves a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Crossing {
    /// Where the path of point-by-point comparison crosses: the growing coordinate is at max(|c0|, ⌈√(R² - 1)⌉, 1),
    /// with c0 its value at the start of the sector.
    ///
    /// Next to the axis the shrinking coordinate is 1, and the path steps over as soon as it is not inside the circle,
    /// c² + 1 ≥ R². R = 1 steps to the centre first and from there to ±1.
    PathExtreme,
    /// At the radius rounded to the nearest integer, but never short of the point already reached, |c0|.
    RoundedRadius,
}

impl Crossing {
    /// The coordinate, without its sign and in BLU, at which an arc of this squared radius (1 BLU² or more) crosses an axis, unless
    /// it starts or ends farther out there.
    ///
    /// ```
    /// use stepwave_nc::Crossing;
    ///
    /// // R is 3.16 and 3.32 BLU.
    /// assert_eq!(Crossing::PathExtreme.axis(10), 3);
    /// assert_eq!(Crossing::PathExtreme.axis(11), 4);
    /// assert_eq!(Crossing::RoundedRadius.axis(11), 3);
    /// ```
    #[must_use]
    pub fn axis(self, square: u128) -> u128 {
        match self {
            Crossing::PathExtreme => ceil_sqrt(square.saturating_sub(1)).max(1),
            Crossing::RoundedRadius => round_sqrt(square),
        }
    }
}

/// A piece of an arc inside one quadrant; the points are relative to the centre, in BLU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Sector {
    /// The quadrant that the piece runs through.
    pub quadrant: Quadrant,
    /// Where it starts: the start point of the arc or a point on the axis that is crossed.
    pub start: [i64; 2],
    /// Where it ends: a point on the next axis or the end point of the arc.
    pub end: [i64; 2],
}

impl Sector {
    /// The number of steps of each axis from start to end, |Δx| and |Δy| in BLU.
    ///
    /// Differences beyond `i64` saturate; no sector of an [`Arc`] has one.
    ///
    /// ```
    /// use stepwave_nc::{Quadrant, Sector};
    ///
    /// let sector = Sector { quadrant: Quadrant::III, start: [-5, -3], end: [-6, 0] };
    /// assert_eq!(sector.steps(), [1, 3]);
    /// ```
    #[must_use]
    pub fn steps(&self) -> [i64; 2] {
        let span = |axis: usize| length(self.end[axis].abs_diff(self.start[axis]).into());
        [span(0), span(1)]
    }
}

/// The sectors of an arc, in the order of the motion.
///
/// In each of them the end is reached with the motion of its quadrant: one coordinate grows, the other shrinks. Every
/// crossing and the last sector after a crossing have that from [`Turn::sectors`]. It leaves an arc with no crossing,
/// from (g, s) to (g', s') in growing and shrinking magnitudes, whose end is ahead: g' s > g s'. With s' > s also g' >
/// g; with g' < g also s' < s. In both cases one end is farther out by 1 BLU or more on both axes, so its radius is
/// greater by more than 1 BLU (with (g, s) the inner one, R² + 2(g + s) + 2 > (R + 1)², as g + s ≥ R), which is not an
/// [`Arc`].
///
/// [`Turn::sectors`]: crate::turn::Turn::sectors
pub(crate) fn split(arc: &Arc, crossing: Crossing) -> Vec<Sector> {
    let radius = crossing.axis(norm_squared(vector(arc.start())));
    arc.turn().sectors([length(radius); 2])
}

#[cfg(test)]
mod tests;
