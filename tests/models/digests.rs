//! Every model with every value of every option on a small and an awkward curve: the netlist, the load words, the title
//! and the command that repeats the run are those recorded in `digests.txt`. The golden waves see a few combinations
//! only.
//!
//! `STEPWAVE_BLESS=1 cargo test --test main models::digests` records them anew.

use std::fmt::Write as _;
use std::path::Path;

use stepwave::program::{Preparation, Survey};
use stepwave::report::{run_command, title};
use stepwave::study::{Dimension, Variants};
use stepwave_models::options::AnyOption;
use stepwave_models::program::Size;
use stepwave_models::{CurveKind, Model, Options, catalogue};
use stepwave_nc::{
    AXES_MAX, Arc, Conic, ControlPoint, Curve, Direction, Helix, Line, NURBS_UNIT, Nurbs, Spline, SplineForm,
};
use stepwave_netlist::text;

/// Values of each option, of which at least one is refused where there can be one.
fn values(option: &dyn AnyOption) -> &'static [&'static str] {
    match option.name() {
        "width" => &["9", "f=7", "jr=8,jv=6", "8,e=12"],
        "preset" => &["zero", "half", "full", "5", "half,jrx=3"],
        "normalize" => &["yes"],
        "radix" => &["2", "10"],
        "adder" => &["parallel", "serial"],
        "end-point" => &["total", "per-axis", "longest", "iterations"],
        "form" => &["magnitude", "signed", "bare"],
        "weights" => &["mid", "pre", "post"],
        "beats" => &["4", "1"],
        "override" => &["none", "35"],
        "cascade" => &["none", "4"],
        "compare" => &["ge", "gt"],
        "pick-off" => &["7", "32"],
        "timing" => &[],
        "system" => &["7m", "7360"],
        "fraction" => &["8", "12", "3"],
        "divisions" => &["2", "9"],
        "step" => &["2.5", "80"],
        "tolerance" => &[],
        "speed" => &["100", "vs=9,vc=200,ve=3", "300mm/min"],
        "accel" => &["9", "40,7", "500mm/s2"],
        "jerk" => &["none", "3"],
        "ramp" => &["before", "after"],
        "period" => &["40"],
        "smooth" => &["sum=3", "exp=2"],
        "brake" => &["square", "count"],
        "on-overflow" => &["trap", "saturate", "wrap"],
        option => panic!("values of {option} are missing here"),
    }
}

/// A small and an awkward curve that the model takes.
pub(super) fn curves(model: &Model) -> [Curve; 2] {
    let line = |from: &[i64], to: &[i64]| Curve::Line(Line::new(from.to_vec(), to.to_vec()).unwrap());
    let arc = |from, to, center, direction| Arc::new(from, to, center, direction).unwrap();
    let (cw, ccw) = (Direction::Clockwise, Direction::CounterClockwise);
    match model.curve() {
        CurveKind::Move => [
            Curve::Arc(arc([5, 0], [0, 5], [0, 0], ccw)),
            Curve::Helix(Helix::new([17, -4, 9], [-17, 4, -11], [0, 0], cw).unwrap()),
        ],
        CurveKind::Axis => [line(&[0], &[12]), line(&[5], &[-95])],
        CurveKind::Line { max_axes: 2 } => [line(&[0, 0], &[8, 6]), line(&[5, -3], &[-95, 0])],
        CurveKind::Line { .. } => [line(&[0, 0], &[8, 6]), line(&[5, -3, 2], &[-95, -3, 77])],
        CurveKind::Arc => [
            Curve::Arc(arc([5, 0], [0, 5], [0, 0], ccw)),
            // Off its circle, through all quadrants, about a centre of its own.
            Curve::Arc(arc([17, -4], [-14, 10], [1, 2], cw)),
        ],
        CurveKind::Spline => [
            Curve::Spline(Spline::new(SplineForm::Bezier, &[[0, 0], [4, 0], [8, 4], [8, 8]]).unwrap()),
            Curve::Spline(Spline::new(SplineForm::BSpline, &[[0, 5], [40, -9], [3, 4], [18, 40], [8, 8]]).unwrap()),
        ],
        CurveKind::Nurbs => {
            let point = |at, eighths: i64| ControlPoint { at, weight: eighths * NURBS_UNIT / 8 };
            let points =
                [point([0, 5], 8), point([40, -9], 5), point([3, 4], 30), point([18, 40], 8), point([8, 8], 1)];
            [
                Curve::Nurbs(Nurbs::bezier(&[[0, 0], [4, 0], [8, 4], [8, 8]]).unwrap()),
                Curve::Nurbs(Nurbs::new(2, &points, None).unwrap()),
            ]
        }
        CurveKind::Helix => [
            Curve::Helix(Helix::new([5, 0, 0], [0, 5, 3], [0, 0], ccw).unwrap()),
            Curve::Helix(Helix::new([17, -4, 9], [-17, 4, -31], [0, 0], cw).unwrap()),
        ],
        CurveKind::Conic => {
            let ellipse = |semi_axes, from, to, center, direction| {
                Curve::Conic(Conic::ellipse(semi_axes, from, to, center, direction).unwrap())
            };
            [ellipse([6, 4], [6, 0], [0, 4], [0, 0], ccw), ellipse([3, 11], [4, 2], [-2, 2], [1, 2], cw)]
        }
    }
}

fn crc(text: &str) -> u32 {
    crc32fast::hash(text.as_bytes())
}

/// What a model makes of a curve with some options.
fn digest(model: &'static Model, curve: &Curve, variants: &Variants) -> String {
    let (choices, words) = variants.at(0);
    let said = words.join(" ");
    let text = match model.plan(curve, &choices) {
        Err(error) => format!("refused {:08x}", crc(&error.to_string())),
        Ok(hardware) => {
            let machine = model.machine(&hardware).unwrap();
            let loaded = match machine.load(&hardware, &model.words(&hardware, curve).unwrap()) {
                Ok(loaded) => format!("{:?} {:?}", loaded.blocks, loaded.cut),
                Err(error) => error.to_string(),
            };
            let netlist = text::print(machine.design.netlist());
            let described = title(model, &hardware, curve) + &run_command(model, curve, &choices);
            let numbers = format!(
                "{:?} {:?} {:?} {} {:?}",
                hardware.table, hardware.error_bound, hardware.rate_bound, hardware.stall_clocks, hardware.pace
            );
            format!("{:08x} {:08x} {:08x} {:08x}", crc(&netlist), crc(&loaded), crc(&described), crc(&numbers))
        }
    };
    format!("{said:24} {text}")
}

/// Every option with every of its values, one option at a time; then every pair of values of two options.
fn combinations(model: &Model) -> (Vec<Variants>, Vec<Variants>) {
    let options = model.options.iter().map(|takes| takes.option());
    let dimensions: Vec<Vec<Dimension>> = options
        .map(|option| values(option).iter().map(|text| Dimension::parse(option, text).unwrap()).collect())
        .collect();
    let single = dimensions.iter().flatten().map(|dimension| Variants(vec![dimension.clone()]));
    let mut pairs = Vec::new();
    for (index, first) in dimensions.iter().enumerate() {
        for second in dimensions[index + 1..].iter().flatten() {
            pairs.extend(first.iter().map(|first| Variants(vec![first.clone(), second.clone()])));
        }
    }
    ([Variants::default()].into_iter().chain(single).collect(), pairs)
}

fn all() -> String {
    let mut text = String::new();
    for model in catalogue().iter() {
        let (single, pairs) = combinations(model);
        for (curve, what) in curves(model).iter().zip(["small", "awkward"]) {
            writeln!(text, "{} {what}", model.name).unwrap();
            for variants in &single {
                writeln!(text, "  {}", digest(model, curve, variants)).unwrap();
            }
            let pairs: String = pairs.iter().map(|variants| digest(model, curve, variants)).collect();
            writeln!(text, "  pairs {:08x}", crc(&pairs)).unwrap();
        }
    }
    for model in catalogue().machines() {
        writeln!(text, "program {}", model.method_name()).unwrap();
        let options = model.options.iter().map(|takes| takes.option());
        let given = options.flat_map(|option| values(option).iter().map(move |text| (option, text)));
        let mut positions = [[0; 2]; AXES_MAX];
        positions[..3].copy_from_slice(&[[-20, 300], [0, 200], [-5, 0]]);
        let size = Size { magnitude: 300, positions, axes: 3, curves: None };
        for (option, value) in given {
            let variants = Variants(vec![Dimension::parse(option, value).unwrap()]);
            writeln!(text, "  {value:24} {}", digest_of_machine(model, &size, &variants.at(0).0)).unwrap();
        }
        let moves = model.moves().unwrap();
        if moves.curves() {
            let program = "G21 F1 G5.1 X0.3 Y0.1 J0.2\nG5 X0 Y0 I0.04 J-0.1 P0 Q1\n";
            let size = Survey::of(program.as_bytes(), moves, &Preparation::default()).unwrap().size;
            writeln!(text, "  {:24} {}", "curves", digest_of_machine(model, &size, &Options::default())).unwrap();
        }
    }
    text
}

/// Of the netlist of a machine for programs of this size, and of its widths.
fn digest_of_machine(model: &Model, size: &Size, options: &Options) -> String {
    let netlist = model
        .plan_program(size, options)
        .and_then(|hardware| Ok((format!("{:?}{:?}", hardware.widths, hardware.table), model.machine(&hardware)?)));
    match netlist {
        Ok((plan, machine)) => format!("{:08x} {:08x}", crc(&text::print(machine.design.netlist())), crc(&plan)),
        Err(error) => format!("refused {:08x}", crc(&error.to_string())),
    }
}

#[test]
fn digests_of_every_option_value_are_those_recorded() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/digests.txt");
    let now = all();
    if std::env::var_os("STEPWAVE_BLESS").is_some() {
        std::fs::write(&path, now).unwrap();
        return;
    }
    let recorded = std::fs::read_to_string(&path).unwrap();
    let (now, recorded): (Vec<_>, Vec<_>) = (now.lines().collect(), recorded.lines().collect());
    for (index, (now, recorded)) in now.iter().zip(&recorded).enumerate() {
        assert_eq!(now, recorded, "line {} of digests.txt", index + 1);
    }
    assert_eq!(now.len(), recorded.len());
}
