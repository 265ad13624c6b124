//! Helices: an arc in x and y with a travel in z.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::limit::check_coordinates;
use crate::{Arc, Crossing, Direction, GeometryError, Sector};

/// A helix: an [`Arc`] in x and y during which z moves evenly from start to end.
///
/// The arc's rules hold: its end may lie up to one BLU off the circle, and one that ends where it starts is a full
/// turn. The travel in z may be 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Helix {
    arc: Arc,
    from: [i64; 3],
    to: [i64; 3],
}

/// A piece of a helix inside one quadrant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct HelixSector {
    /// The piece in x and y, relative to the centre; it crosses the axes at the [rounded
    /// radius](Crossing::RoundedRadius).
    pub plane: Sector,
    /// The number of steps in z from the start of the helix to the end of this piece, in BLU; never negative.
    pub z_steps: i64,
}

impl Helix {
    /// The helix between two points about a centre in x and y, all in BLU and in machine coordinates.
    ///
    /// # Errors
    /// If a coordinate is beyond [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT), or if [`Arc::new`] refuses the arc in
    /// x and y.
    ///
    /// ```
    /// use stepwave_nc::{Direction, Helix};
    ///
    /// let helix = Helix::new([5, 0, 0], [0, 5, -3], [0, 0], Direction::CounterClockwise)?;
    /// assert_eq!((helix.arc().to(), helix.z_travel()), ([0, 5], -3));
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    pub fn new(from: [i64; 3], to: [i64; 3], center: [i64; 2], direction: Direction) -> Result<Helix, GeometryError> {
        check_coordinates(&from)?;
        check_coordinates(&to)?;
        let arc = Arc::new([from[0], from[1]], [to[0], to[1]], center, direction)?;
        Ok(Helix { arc, from, to })
    }

    /// As [`new`](Helix::new), where the radii of the arc may differ by this many BLU more: see [`Arc::within`].
    ///
    /// # Errors
    /// As [`new`](Helix::new), and as [`Arc::within`].
    pub fn within(
        from: [i64; 3],
        to: [i64; 3],
        center: [i64; 2],
        direction: Direction,
        tolerance: f64,
    ) -> Result<Helix, GeometryError> {
        let arc = Arc::within([from[0], from[1]], [to[0], to[1]], center, direction, tolerance)?;
        Helix::new(from, to, arc.center(), direction)
    }

    /// The arc in x and y.
    #[must_use]
    pub fn arc(&self) -> &Arc {
        &self.arc
    }

    /// The start point in machine coordinates, in BLU.
    #[must_use]
    pub fn from(&self) -> [i64; 3] {
        self.from
    }

    /// The end point in machine coordinates, in BLU.
    #[must_use]
    pub fn to(&self) -> [i64; 3] {
        self.to
    }

    /// The signed travel in z from start to end, in BLU.
    #[must_use]
    pub fn z_travel(&self) -> i64 {
        self.to[2] - self.from[2]
    }

    /// The angle through which the helix turns, in radians: [`Arc::sweep`], more than 0, and 2π for a full turn.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.arc.sweep()
    }

    /// The length of the ideal helix, in BLU.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.arc.length().hypot(self.z_travel() as f64)
    }

    /// The pieces of the helix inside one quadrant each, in the order of the motion: those of its arc, and how far z
    /// has gone at the end of each.
    ///
    /// At the angle θᵢ of the whole angle θ that is round(|Z|·θᵢ/θ), and at the end of the helix |Z|.
    ///
    /// ```
    /// use stepwave_nc::{Direction, Helix};
    ///
    /// let helix = Helix::new([0, -5, 0], [0, 5, 9], [0, 0], Direction::CounterClockwise)?;
    /// let steps: Vec<i64> = helix.sectors().iter().map(|sector| sector.z_steps).collect();
    /// assert_eq!(steps, [5, 9]);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn sectors(&self) -> Vec<HelixSector> {
        let travel = self.z_travel().abs();
        let sectors = self.arc.sectors(Crossing::RoundedRadius).into_iter().zip(self.arc.parts());
        sectors.map(|(plane, part)| HelixSector { plane, z_steps: share(travel, part) }).collect()
    }

    /// The distance of a position from the ideal helix, in BLU: √(r² + (dz·cos β)²).
    ///
    /// r is the distance from the whole circle and dz that of z from the helix at the position's own angle;
    /// tan β = |Z|/(Rθ) is the slope of the helix, so that dz·cos β is the distance from it on the unrolled cylinder. A
    /// position beyond an end of the helix is measured against that end: as far as halfway round to the other end,
    /// but 2 BLU at least, and of two ends and the turn between, whichever is nearest in z.
    ///
    /// The position is in machine coordinates; coordinates after z are ignored, and with fewer there is no distance
    /// (NaN).
    ///
    /// ```
    /// use stepwave_nc::{Direction, Helix};
    ///
    /// let flat = Helix::new([5, 0, 7], [0, 5, 7], [0, 0], Direction::CounterClockwise)?;
    /// assert_eq!(flat.deviation(&[3, 4, 7]), 0.0);
    /// assert_eq!(flat.deviation(&[6, 8, 7 + 12]), 13.0);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn deviation(&self, position: &[i64]) -> f64 {
        self.ruler().deviation(position)
    }

    /// The distance with the side of the cylinder, in BLU: negative inside it.
    #[must_use]
    pub fn signed_deviation(&self, position: &[i64]) -> f64 {
        let distance = self.deviation(position);
        if self.arc.signed_deviation(position) < 0.0 { -distance } else { distance }
    }

    /// Points of the ideal helix seen along z, in BLU and machine coordinates, for drawing: [`Arc::outline`].
    #[must_use]
    pub fn outline(&self, max_points: usize) -> Vec<[f64; 2]> {
        self.arc.outline(max_points)
    }

    /// The start and the end point in place, for a curve that lends them as slices.
    pub(crate) fn ends(&self) -> (&[i64], &[i64]) {
        (&self.from, &self.to)
    }

    /// What measures positions against this helix.
    pub(crate) fn ruler(&self) -> Ruler {
        let (angle, radius) = (self.angle(), self.arc.radius());
        let travel = self.z_travel() as f64;
        Ruler {
            arc: self.arc,
            z: self.from[2],
            travel,
            angle,
            overhang: ((TAU - angle) / 2.0).max((2.0 / radius).min(FRAC_PI_2)),
            cosine: 1.0 / 1.0_f64.hypot(travel / (radius * angle)),
        }
    }
}

/// A part, from 0 to 1, of a whole number of steps of at least 0, to the nearest.
#[must_use]
pub fn share(travel: i64, part: f64) -> i64 {
    // At most 2^53, which f64 holds exactly; a cast saturates.
    #[expect(clippy::cast_possible_truncation, reason = "rounded, and no more than `travel`")]
    let steps = (travel as f64 * part).round() as i64;
    steps.clamp(0, travel)
}

/// A helix with all that its deviations share worked out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ruler {
    arc: Arc,
    /// z at the start.
    z: i64,
    travel: f64,
    angle: f64,
    /// How far beyond an end, in radians, a position still counts as there.
    overhang: f64,
    /// cos β.
    cosine: f64,
}

impl Ruler {
    /// See [`Helix::deviation`].
    pub(crate) fn deviation(&self, position: &[i64]) -> f64 {
        let [x, y, z, ..] = *position else {
            return f64::NAN;
        };
        let risen = (i128::from(z) - i128::from(self.z)) as f64;
        let [cx, cy] = self.arc.center();
        let off = if [x, y] == [cx, cy] {
            let [low, high] = [self.travel.min(0.0), self.travel.max(0.0)];
            risen - risen.clamp(low, high) // the axis is next to every turn
        } else {
            let here = self.arc.turn_to([x, y]);
            let turns = [here, here - TAU, here + TAU].into_iter();
            let near = turns.filter(|turn| (-self.overhang..=self.angle + self.overhang).contains(turn));
            let height = |turn: f64| self.travel * turn.clamp(0.0, self.angle) / self.angle;
            near.map(|turn| (risen - height(turn)).abs()).fold(f64::INFINITY, f64::min)
        };
        self.arc.deviation(position).hypot(off * self.cosine)
    }
}

#[cfg(test)]
mod tests;
