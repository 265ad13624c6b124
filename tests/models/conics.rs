//! Conics for the models that interpolate them, and point-by-point comparison along them.

use rayon::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::options::{BEATS, END_POINT};
use stepwave_models::{Beats, EndPoint, Options};
use stepwave_nc::{Conic, Curve, Direction};

use super::check;
use crate::reference::{self, Opens, Shape, ppc_conic};

/// An arc of a conic, as the reference takes it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    pub(super) shape: Shape,
    pub(super) from: [i64; 2],
    pub(super) to: [i64; 2],
    pub(super) center: [i64; 2],
    pub(super) clockwise: bool,
}

fn opens(opens: Opens) -> stepwave_nc::Opens {
    match opens {
        Opens::PlusX => stepwave_nc::Opens::PlusX,
        Opens::MinusX => stepwave_nc::Opens::MinusX,
        Opens::PlusY => stepwave_nc::Opens::PlusY,
        Opens::MinusY => stepwave_nc::Opens::MinusY,
    }
}

impl Case {
    fn new(shape: Shape, from: [i64; 2], to: [i64; 2], clockwise: bool) -> Case {
        Case { shape, from, to, center: [0, 0], clockwise }
    }

    /// The same curve elsewhere.
    pub(super) fn moved(self, by: [i64; 2]) -> Case {
        let moved = |[x, y]: [i64; 2]| [x + by[0], y + by[1]];
        Case { from: moved(self.from), to: moved(self.to), center: moved(self.center), ..self }
    }

    pub(super) fn curve(&self) -> Curve {
        let Case { from, to, center, .. } = *self;
        let direction = if self.clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
        let conic = match self.shape {
            Shape::Ellipse(semi_axes) => Conic::ellipse(semi_axes, from, to, center, direction),
            Shape::Parabola(c, to_where) => Conic::parabola(c, Some(opens(to_where)), from, to, center),
            Shape::Hyperbola(semi_axes, to_where) => {
                Conic::hyperbola(semi_axes, Some(opens(to_where)), from, to, center)
            }
        };
        conic.unwrap_or_else(|error| panic!("{self:?}: {error}")).into()
    }
}

/// Every quarter of every ellipse with semi-axes below `limit`, in both directions.
pub(super) fn every_quarter_ellipse(limit: i64, check: impl Fn(&Case) + Sync) {
    (1..limit).into_par_iter().for_each(|a| {
        for b in 1..limit {
            let corners = [[a, 0], [0, b], [-a, 0], [0, -b]];
            for (quarter, &from) in corners.iter().enumerate() {
                let to = corners[(quarter + 1) % 4];
                check(&Case::new(Shape::Ellipse([a, b]), from, to, false));
                check(&Case::new(Shape::Ellipse([a, b]), to, from, true));
            }
        }
    });
}

/// Where a curve opens, and where that takes a point of one that opens in the direction +x.
type Image = (Opens, fn([i64; 2]) -> [i64; 2]);

/// The four images of a curve that opens to +x: where each opens to, and where a point goes.
fn images() -> [Image; 4] {
    [
        (Opens::PlusX, |p| p),
        (Opens::MinusX, |[x, y]| [-x, y]),
        (Opens::PlusY, |[x, y]| [y, x]),
        (Opens::MinusY, |[x, y]| [y, -x]),
    ]
}

/// Arcs of ellipses across axes and with rounded ends, and parabolas and hyperbolas of all orientations, there and
/// back, on one side of the axis and across the vertex.
pub(super) fn various() -> Vec<Case> {
    let mut cases = Vec::new();
    for clockwise in [true, false] {
        for semi_axes in [[5, 5], [10, 4], [4, 10], [25, 2], [7, 1], [13, 8]] {
            let [a, b] = semi_axes;
            let shape = Shape::Ellipse(semi_axes);
            for from in [[a, 0], [0, b], [-a, 0], [0, -b]] {
                for to in [[a, 0], [0, -b]] {
                    cases.push(Case::new(shape, from, to, clockwise));
                }
            }
        }
        // Off the curve: (3, 4) and (-2, 4) are less than 1 BLU off.
        cases.push(Case::new(Shape::Ellipse([8, 4]), [3, 4], [-8, 1], clockwise));
        cases.push(Case::new(Shape::Ellipse([8, 4]), [-8, 0], [7, 2], clockwise));
    }
    let parabola = |c| move |to_where| Shape::Parabola(c, to_where);
    let hyperbola = |semi_axes| move |to_where| Shape::Hyperbola(semi_axes, to_where);
    for (to_where, image) in images() {
        let mut in_both_directions = |shape: Shape, from: [i64; 2], to: [i64; 2]| {
            cases.push(Case::new(shape, image(from), image(to), false));
            cases.push(Case::new(shape, image(to), image(from), false));
        };
        for c in [1, 4, 9, 25] {
            let point = |t: i64| [t * t / c, t];
            let on_curve: Vec<i64> = (-30..=30).filter(|t| t * t % c == 0).collect();
            let shape = parabola(c)(to_where);
            for (&first, &last) in on_curve.iter().zip(on_curve.iter().rev()).step_by(3) {
                if first != last {
                    in_both_directions(shape, point(first), point(last));
                }
            }
            in_both_directions(shape, [0, 0], point(*on_curve.last().unwrap()));
            in_both_directions(shape, point(on_curve[0]), [0, 0]);
        }
        // y² = 5x: rounded ends.
        in_both_directions(parabola(5)(to_where), [1, 2], [7, 6]);
        // x² - y² = 9 and x²/9 - y²/16 = 1 at lattice points, and x²/16 - y²/4 = 1 at rounded ones.
        in_both_directions(hyperbola([3, 3])(to_where), [3, 0], [5, 4]);
        in_both_directions(hyperbola([3, 3])(to_where), [5, -4], [5, 4]);
        in_both_directions(hyperbola([3, 4])(to_where), [3, 0], [5, 5]);
        in_both_directions(hyperbola([4, 2])(to_where), [4, 0], [9, 4]);
        in_both_directions(hyperbola([4, 2])(to_where), [9, -4], [12, 6]);
    }
    cases
}

fn check_ppc(case: &Case, beats: Beats, engine: EngineKind) {
    let curve = case.curve();
    let Curve::Conic(conic) = &curve else { panic!("a conic") };
    let ends = [(EndPoint::PerAxis, reference::EndPoint::PerAxis), (EndPoint::Total, reference::EndPoint::Total)];
    for (end_point, end_reference) in ends {
        if end_point == EndPoint::PerAxis || conic.ends_on_curve() {
            let choices = Options::default().with(&END_POINT, end_point).with(&BEATS, beats);
            let table = ppc_conic(case.shape, case.from, case.to, case.center, case.clockwise, end_reference);
            check("ppc-conic", &curve, &choices, engine, &table);
        }
    }
}

#[test]
fn every_quarter_ellipse_with_semi_axes_below_30() {
    every_quarter_ellipse(30, |case| check_ppc(case, Beats::One, EngineKind::Word));
}

#[test]
fn conics_of_every_shape_and_orientation() {
    various().iter().for_each(|case| check_ppc(case, Beats::One, EngineKind::Word));
}

#[test]
#[ignore = "exhaustive"]
fn conics_in_four_beats_on_every_engine_about_a_translated_centre() {
    for engine in EngineKind::ALL {
        various().iter().step_by(5).for_each(|case| check_ppc(&case.moved([-40, 13]), Beats::Four, engine));
    }
}
