//! A curve in words, in JSON, and as the options of a command: `stepwave run dda-line --to 8,6 --width 4`.

use serde_json::{Value, json};
use stepwave_models::{Hardware, Model, Options, Takes};
use stepwave_nc::{Arc, Curve, Direction, Opens, Shape};

use crate::testbench::point;

/// What gives a curve besides its ends.
#[derive(Default)]
struct Form {
    name: &'static str,
    /// c of a parabola, or the semi-axes of another conic, in BLU.
    sizes: Vec<i64>,
    opens: Option<Opens>,
    center: Option<[i64; 2]>,
    direction: Option<Direction>,
    radius: Option<f64>,
}

impl Form {
    fn of(curve: &Curve) -> Form {
        let round = |name, arc: &Arc| {
            let (center, direction, radius) = (Some(arc.center()), Some(arc.direction()), Some(arc.radius()));
            Form { name, center, direction, radius, ..Form::default() }
        };
        match curve {
            Curve::Line(_) => Form { name: "line", ..Form::default() },
            Curve::Arc(arc) => round("arc", arc),
            Curve::Helix(helix) => round("helix", helix.arc()),
            Curve::Conic(conic) => {
                let (name, sizes) = match conic.shape() {
                    Shape::Ellipse { semi_axes } => ("ellipse", semi_axes.to_vec()),
                    Shape::Parabola { c, .. } => ("parabola", vec![c]),
                    Shape::Hyperbola { semi_axes, .. } => ("hyperbola", semi_axes.to_vec()),
                };
                let (opens, center, direction) = (conic.opens(), Some(conic.center()), conic.direction());
                Form { name, sizes, opens, center, direction, radius: None }
            }
        }
    }
}

/// The geometry in words: `line (0, 0) to (8, 6)`.
#[must_use]
pub fn geometry(curve: &Curve) -> String {
    let Form { name, sizes, opens, center, direction, .. } = Form::of(curve);
    let full = matches!(curve, Curve::Arc(arc) if arc.is_full_circle());
    let mut words = vec![if full { "full circle" } else { name }.to_owned()];
    match sizes[..] {
        [] => {}
        [c] => words.push(c.to_string()),
        _ => words.push(point(&sizes)),
    }
    words.extend(opens.map(|opens| format!("opening to {opens}")));
    words.push(format!("{} to {}", point(curve.from()), point(curve.to())));
    words.extend(direction.map(|direction| direction.to_string()));
    let about = if sizes.len() == 1 { "from the vertex" } else { "about" };
    words.extend(center.map(|center| format!("{about} {}", point(&center))));
    words.join(" ")
}

/// The geometry in the JSON report.
pub(super) fn json(curve: &Curve) -> Value {
    let Form { name, sizes, opens, center, direction, radius } = Form::of(curve);
    let mut fields = json!({ "curve": name, "from": curve.from(), "to": curve.to() });
    if let Some(center) = center {
        fields["center"] = json!(center);
        fields["direction"] = json!(direction.map(|direction| direction.to_string()));
    }
    if let Some(radius) = radius {
        fields["radius"] = json!(radius);
    }
    if !sizes.is_empty() {
        fields["sizes"] = json!(sizes);
        fields["opens"] = json!(opens.map(|opens| opens.to_string()));
    }
    fields
}

/// The options that give a curve.
#[must_use]
pub fn geometry_options(curve: &Curve) -> Vec<String> {
    let list = |numbers: &[i64]| numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
    let Form { name, sizes, opens, center, direction, .. } = Form::of(curve);
    let mut words = Vec::new();
    let mut option = |name: &str, value: String| words.extend([format!("--{name}"), value]);
    if !sizes.is_empty() {
        option(name, list(&sizes));
    }
    if let Some(opens) = opens {
        option("opens", opens.to_string());
    }
    if curve.from().iter().any(|coordinate| *coordinate != 0) {
        option("from", list(curve.from()));
    }
    option("to", list(curve.to()));
    if let Some(center) = center.filter(|center| *center != [0, 0]) {
        option("center", list(&center));
    }
    words.extend(direction.map(|turn| if turn == Direction::Clockwise { "--cw" } else { "--ccw" }.to_owned()));
    words
}

/// The command that runs a curve on this hardware.
#[must_use]
pub fn run_command(model: &Model, curve: &Curve, choices: &Options) -> String {
    let words = [vec![format!("stepwave run {}", model.name)], geometry_options(curve), choices.words()].concat();
    words.join(" ")
}

/// One line for wave headers: model, geometry, choices.
#[must_use]
pub fn title(model: &Model, hardware: &Hardware, curve: &Curve) -> String {
    let choice = |takes: &&'static dyn Takes| format!("{} {}", takes.name(), hardware.text(takes.option()));
    let choices: Vec<_> = model.options.iter().map(choice).collect();
    // A netlist is the same wherever it is.
    let name = if model.is_described() { file_name(model.source) } else { model.name };
    format!("{name}; {}; {}", geometry(curve), choices.join("; "))
}

pub(super) fn file_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}
