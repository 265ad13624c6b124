//! The arc in whole BLU that is nearest to an arc in real numbers.

use std::f64::consts::PI;

use super::bow::{Bow, between, length};
use crate::{Arc, Direction};

/// An arc that a machine can get, or the straight line between the same ends, which is empty where they are equal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    /// The arc; `None` where the straight line is nearer.
    pub(super) arc: Option<Arc>,
    /// The two-sided distance from the ideal arc, in BLU.
    pub(super) apart: f64,
}

/// The search for the whole centre of an arc between two whole points.
struct Search<'a> {
    ideal: &'a Bow,
    /// Points of the ideal arc between its ends.
    between: [[f64; 2]; 3],
    ends: [[i64; 2]; 2],
    direction: Direction,
    best: Option<Found>,
}

#[derive(Clone, Copy)]
struct Found {
    arc: Arc,
    apart: f64,
    /// Of arcs equally near, as where an end alone decides, the one that fits best in between.
    fit: f64,
}

/// Distances that differ by less are equal, in BLU.
const EQUAL: f64 = 1e-9;
/// Radius up to which every whole centre that can be the nearest is tried, in BLU.
const SMALL: f64 = 4.0;

/// The nearest arc between two whole points, or the straight line between them.
pub(super) fn nearest(ideal: &Bow, seeds: [[f64; 2]; 2], [start, end]: [[i64; 2]; 2], direction: Direction) -> Nearest {
    let straight = ideal.apart_from_line([start, end].map(real));
    let between = [1.0, 2.0, 3.0].map(|part| ideal.after(ideal.turn() * part / 4.0));
    let mut search = Search { ideal, between, ends: [start, end], direction, best: None };
    let reach = if ideal.radius_at_start() <= SMALL { 8 } else { 2 };
    for seed in seeds {
        search.square(whole(seed), reach);
    }
    search.along(seeds[0]);
    search.climb();
    match search.best {
        Some(Found { arc, apart, .. }) if apart <= straight => Nearest { arc: Some(arc), apart },
        _ => Nearest { arc: None, apart: straight },
    }
}

impl Search<'_> {
    /// All centres in a square about one.
    fn square(&mut self, [x, y]: [i64; 2], reach: i64) {
        for dx in -reach..=reach {
            for dy in -reach..=reach {
                self.attempt([x.saturating_add(dx), y.saturating_add(dy)]);
            }
        }
    }

    /// Centres farther and farther from the ends and nearer and nearer to them: of a flat arc many do, and the best may
    /// be far from the ideal one.
    fn along(&mut self, center: [f64; 2]) {
        let [start, end] = self.ends.map(real);
        let middle = [0, 1].map(|axis| (start[axis] + end[axis]) / 2.0);
        let arm = between(middle, center);
        // A turn of a right angle or more says by itself where its centre is.
        if self.ideal.turn() >= PI / 2.0 || length(arm) == 0.0 {
            return;
        }
        for part in 1..=24 {
            for factor in [1.0 + f64::from(part) / 16.0, 1.0 / (1.0 + f64::from(part) / 16.0)] {
                self.square(whole([middle[0] + arm[0] * factor, middle[1] + arm[1] * factor]), 1);
            }
        }
    }

    /// Goes to a neighbour as long as one is nearer.
    fn climb(&mut self) {
        for _ in 0..64 {
            let Some(Found { arc, .. }) = self.best else { return };
            self.square(arc.center(), 1);
            if self.best.is_none_or(|best| best.arc.center() == arc.center()) {
                return;
            }
        }
    }

    fn attempt(&mut self, center: [i64; 2]) {
        let [start, end] = self.ends;
        let Ok(arc) = Arc::new(start, end, center, self.direction) else { return };
        let (at, to, radius) = (real(center), real(end), arc.radius());
        let off = |point: [f64; 2]| (length(between(at, point)) - radius).abs();
        let offs = self.between.map(off);
        // No point of the ideal arc is nearer to the commanded one than to its circle or its end.
        let least = self.between.iter().zip(offs).map(|(point, off)| off.min(length(between(*point, to))));
        let least = least.fold(0.0, f64::max);
        if self.best.is_some_and(|best| least > best.apart + EQUAL) {
            return;
        }
        let commanded = Bow::circle([start, end].map(real), at, arc.sweep(), self.direction);
        let found =
            Found { arc, apart: self.ideal.apart(&commanded), fit: off(to) + offs.into_iter().fold(0.0, f64::max) };
        let nearer = self.best.is_none_or(|best| {
            let gain = best.apart - found.apart;
            gain > EQUAL || (gain > -EQUAL && found.fit < best.fit)
        });
        if nearer {
            self.best = Some(found);
        }
    }
}

fn real(point: [i64; 2]) -> [f64; 2] {
    // Within 2^53, as every difference of coordinates is.
    point.map(|c| c as f64)
}

fn whole(point: [f64; 2]) -> [i64; 2] {
    // Beyond the limit of coordinates the cast saturates, and the arc is refused.
    #[allow(clippy::cast_possible_truncation)]
    point.map(|c| c.round() as i64)
}
