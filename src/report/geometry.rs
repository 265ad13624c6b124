//! A curve in words, in JSON, and as the options of a command: `stepwave run dda-line --to 8,6 --width 4`.

use serde_json::{Value, json};
use stepwave_models::{Hardware, Model, Options, Takes};
use stepwave_nc::{Curve, Description, Direction, Drawn, NURBS_UNIT, Nurbs, SplineForm};

use crate::testbench::point;

/// The geometry in words: `line (0, 0) to (8, 6)`.
#[must_use]
pub fn geometry(curve: &Curve) -> String {
    if let Curve::Nurbs(nurbs) = curve {
        return self::nurbs(nurbs);
    }
    let Description { drawn, sizes, center, direction, .. } = curve.description();
    if drawn.is_spline() {
        return spline(drawn, sizes.as_chunks().0);
    }
    let full = matches!(curve, Curve::Arc(arc) if arc.is_full_circle());
    let mut words = vec![if full { "full circle" } else { drawn.name() }.to_owned()];
    match sizes[..] {
        [] => {}
        [c] => words.push(c.to_string()),
        _ => words.push(point(&sizes)),
    }
    words.extend(drawn.opens().map(|opens| format!("opening to {opens}")));
    words.push(format!("{} to {}", point(curve.from()), point(curve.to())));
    words.extend(drawn.turns().then(|| direction.to_string()));
    let about = if sizes.len() == 1 { "from the vertex" } else { "about" };
    words.extend(drawn.is_centered().then(|| format!("{about} {}", point(&center))));
    words.join(" ")
}

/// A NURBS by its degree and points, or where they are many by its ends.
fn nurbs(nurbs: &Nurbs) -> String {
    let points: Vec<_> = nurbs.points().iter().map(|point| point.at).collect();
    let weighted = nurbs.points().iter().any(|point| point.weight != NURBS_UNIT);
    let what = spline(Drawn::Nurbs, &points);
    format!("{what}, degree {}{}", nurbs.degree(), if weighted { ", with weights" } else { "" })
}

/// In ones: `0.707106781`.
fn decimal(value: i64) -> String {
    let (sign, size) = (if value < 0 { "-" } else { "" }, value.unsigned_abs());
    let unit = NURBS_UNIT.unsigned_abs();
    let rest = format!("{:09}", size % unit);
    let rest = rest.trim_end_matches('0');
    format!("{sign}{}{}{rest}", size / unit, if rest.is_empty() { "" } else { "." })
}

/// Numbers in ones, as options take them.
fn decimals(values: impl IntoIterator<Item = i64>) -> String {
    values.into_iter().map(decimal).collect::<Vec<_>>().join(",")
}

/// The options that give a NURBS.
fn nurbs_options(nurbs: &Nurbs) -> Vec<String> {
    let point = |point: &stepwave_nc::ControlPoint| {
        let [x, y] = point.at;
        format!("{x},{y},{}", decimal(point.weight))
    };
    let points = nurbs.points().iter().map(point).collect::<Vec<_>>().join(",");
    let (degree, knots) = (nurbs.degree().to_string(), decimals(nurbs.knots().iter().copied()));
    ["--nurbs", &points, "--degree", &degree, "--knots", &knots].map(str::to_owned).to_vec()
}

/// A free curve by its points, or where they are many by its ends.
fn spline(drawn: Drawn, points: &[[i64; 2]]) -> String {
    const FEW: usize = 6;
    let all: Vec<_> = points.iter().map(|at| point(at)).collect();
    match &all[..] {
        [first, .., last] if all.len() > FEW => {
            format!("{} of {} points, {first} to {last}", drawn.name(), all.len())
        }
        _ => format!("{} {}", drawn.name(), all.join(", ")),
    }
}

/// The geometry in the JSON report.
pub(super) fn json(curve: &Curve) -> Value {
    let Description { drawn, sizes, center, direction, .. } = curve.description();
    let mut fields = json!({ "curve": drawn.name(), "from": curve.from(), "to": curve.to() });
    if drawn.is_centered() {
        fields["center"] = json!(center);
        fields["direction"] = json!(drawn.turns().then(|| direction.to_string()));
    }
    if let Some(arc) = curve.arc() {
        fields["radius"] = json!(arc.radius());
    }
    if let Curve::Nurbs(nurbs) = curve {
        let ones = |value: i64| value as f64 / NURBS_UNIT as f64;
        fields["points"] = json!(nurbs.points().iter().map(|point| point.at).collect::<Vec<_>>());
        fields["weights"] = json!(nurbs.points().iter().map(|point| ones(point.weight)).collect::<Vec<_>>());
        fields["degree"] = json!(nurbs.degree());
        fields["knots"] = json!(nurbs.knots().iter().map(|knot| ones(*knot)).collect::<Vec<_>>());
    } else if drawn.is_spline() {
        fields["points"] = json!(sizes.as_chunks::<2>().0);
    } else if !sizes.is_empty() {
        fields["sizes"] = json!(sizes);
        fields["opens"] = json!(drawn.opens().map(|opens| opens.to_string()));
    }
    fields
}

/// The options that give a curve.
#[must_use]
pub fn geometry_options(curve: &Curve) -> Vec<String> {
    if let Curve::Nurbs(nurbs) = curve {
        return nurbs_options(nurbs);
    }
    let list = |numbers: &[i64]| numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
    let Description { drawn, sizes, center, direction, .. } = curve.description();
    let mut words = Vec::new();
    let mut option = |name: &str, value: String| words.extend([name.to_owned(), value]);
    if !sizes.is_empty() {
        option(drawn.option(), list(&sizes));
    }
    if drawn.is_spline() {
        words.extend((drawn == Drawn::Spline(SplineForm::BSpline)).then(|| "--b-spline".to_owned()));
        return words;
    }
    if let Some(opens) = drawn.opens() {
        option("--opens", opens.to_string());
    }
    if curve.from().iter().any(|coordinate| *coordinate != 0) {
        option("--from", list(curve.from()));
    }
    option("--to", list(curve.to()));
    if center != [0, 0] {
        option("--center", list(&center));
    }
    let turn = if direction == Direction::Clockwise { "--cw" } else { "--ccw" };
    words.extend(drawn.turns().then(|| turn.to_owned()));
    words
}

/// The command that runs a curve on this hardware.
#[must_use]
pub fn run_command(model: &Model, curve: &Curve, choices: &Options) -> String {
    command("run", model, curve, choices)
}

/// The command that exports this hardware, without a file to write.
#[must_use]
pub fn export_command(model: &Model, curve: &Curve, choices: &Options) -> String {
    command("export", model, curve, choices)
}

fn command(verb: &str, model: &Model, curve: &Curve, choices: &Options) -> String {
    let words = [vec![format!("stepwave {verb} {}", model.name)], geometry_options(curve), choices.words()].concat();
    words.join(" ")
}

/// The options of a model without those that do nothing as the others are chosen.
pub(super) fn in_force<'h>(model: &'h Model, hardware: &'h Hardware) -> impl Iterator<Item = &'h &'static dyn Takes> {
    model.options.iter().filter(|takes| takes.idle(&hardware.options).is_none())
}

/// One line for wave headers: model, geometry, choices.
#[must_use]
pub fn title(model: &Model, hardware: &Hardware, curve: &Curve) -> String {
    let choice = |takes: &&'static dyn Takes| format!("{} {}", takes.name(), hardware.text(takes.option()));
    let choices: Vec<_> = in_force(model, hardware).map(choice).collect();
    // A netlist is the same wherever it is.
    let name = if model.is_described() { file_name(model.source) } else { model.name };
    format!("{name}; {}; {}", geometry(curve), choices.join("; "))
}

pub(super) fn file_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}
