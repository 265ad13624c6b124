//! The command that repeats a run: `stepwave run dda-line --to 8,6 --width 4`.

use stepwave_models::{Model, Options};
use stepwave_nc::{Curve, Direction, Shape};

fn point(coordinates: &[i64]) -> String {
    coordinates.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
}

fn direction(direction: Direction) -> &'static str {
    if direction == Direction::Clockwise { "--cw" } else { "--ccw" }
}

/// The options that give a curve.
#[must_use]
pub fn geometry_options(curve: &Curve) -> Vec<String> {
    let mut words = Vec::new();
    let mut center = [0, 0];
    let mut turn = None;
    match curve {
        Curve::Line(_) => {}
        Curve::Arc(arc) => (center, turn) = (arc.center(), Some(arc.direction())),
        Curve::Helix(helix) => (center, turn) = (helix.arc().center(), Some(helix.arc().direction())),
        Curve::Conic(conic) => {
            (center, turn) = (conic.center(), conic.direction());
            match conic.shape() {
                Shape::Ellipse { semi_axes } => words.extend(["--ellipse".to_owned(), point(&semi_axes)]),
                Shape::Parabola { c, opens } => {
                    words.extend(["--parabola".to_owned(), c.to_string(), "--opens".to_owned(), opens.to_string()]);
                }
                Shape::Hyperbola { semi_axes, opens } => {
                    words.extend([
                        "--hyperbola".to_owned(),
                        point(&semi_axes),
                        "--opens".to_owned(),
                        opens.to_string(),
                    ]);
                }
            }
        }
    }
    if curve.from().iter().any(|coordinate| *coordinate != 0) {
        words.extend(["--from".to_owned(), point(curve.from())]);
    }
    words.extend(["--to".to_owned(), point(curve.to())]);
    if center != [0, 0] {
        words.extend(["--center".to_owned(), point(&center)]);
    }
    words.extend(turn.map(|turn| direction(turn).to_owned()));
    words
}

/// The command that runs a curve on this hardware.
#[must_use]
pub fn run_command(model: &Model, curve: &Curve, choices: &Options) -> String {
    let words = [vec![format!("stepwave run {}", model.name)], geometry_options(curve), choices.words()].concat();
    words.join(" ")
}
