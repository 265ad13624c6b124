//! Axes other than x, y and z: they follow, arrive and are fed as RS-274 says, by every family.

use proptest::prelude::*;
use serde_json::{Value, json};
use stepwave::testbench::{BlockReport, Ending, Observer, ObserverError, Step, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::program::Size;
use stepwave_models::{OnOverflow, Options, catalogue, options::ON_OVERFLOW};
use stepwave_nc::{Others, PulseBlock, Rounder, SegmentShape};

use super::command::{FAMILIES, number, report};
use super::machines::{Control, of_machine, tool_move};
use crate::cli::Folder;
use crate::reference::{self, EndPoint, Form, cim_line, dpm_line, mindev_line, ppc_line};

/// The places after each step, block by block.
#[derive(Default)]
struct Places(Vec<Vec<Vec<i64>>>);

impl Observer for Places {
    fn block_begun(&mut self, _: &BlockReport) -> Result<(), ObserverError> {
        self.0.push(Vec::new());
        Ok(())
    }

    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        if step.number > 0 {
            self.0.last_mut().unwrap().push(step.position.clone());
        }
        Ok(())
    }
}

/// The two axes that travel farthest, the first of equals, in the order of a plane.
fn plane(travels: &[i64]) -> [usize; 2] {
    let mut axes: Vec<usize> = (0..travels.len()).collect();
    axes.sort_by_key(|&axis| (-travels[axis].abs(), axis));
    let [low, high] = [axes[0].min(axes[1]), axes[0].max(axes[1])];
    if (low, high) == (0, 2) { [2, 0] } else { [low, high] }
}

/// The path of a line by a machine that interpolates in a plane: those two axes by the method, the others after their pulses.
fn followed(family: &str, bits: u32, from: &[i64], to: &[i64]) -> Vec<Vec<i64>> {
    let travels: Vec<i64> = from.iter().zip(to).map(|(from, to)| to - from).collect();
    let pair = plane(&travels);
    let [start, end] = [from, to].map(|point| pair.map(|axis| point[axis]));
    let table = match family {
        "ppc" => ppc_line(start, end, Form::Magnitude, EndPoint::PerAxis),
        "cim" => cim_line(start, end),
        "mindev" => mindev_line(start, end),
        _ => reference::dda_line(bits, &start, &end, &[1 << (bits - 1); 2], false, EndPoint::PerAxis),
    };
    let whole: i64 = pair.iter().map(|&axis| travels[axis].abs()).sum();
    let (mut at, mut rest, mut before) = (from.to_vec(), vec![whole / 2; from.len()], start);
    let place = |next: [i64; 2]| {
        let pulses: i64 = [0, 1].map(|axis| (next[axis] - before[axis]).abs()).iter().sum();
        before = next;
        for axis in 0..at.len() {
            match pair.iter().position(|of| *of == axis) {
                Some(of) => at[axis] = next[of],
                None => {
                    rest[axis] += travels[axis].abs() * pulses;
                    if rest[axis] >= whole {
                        rest[axis] -= whole;
                        at[axis] += travels[axis].signum();
                    }
                }
            }
        }
        at.clone()
    };
    table.path().into_iter().skip(1).map(place).collect()
}

/// The places after each step of a table.
fn places(table: &reference::Table, axes: usize) -> Vec<Vec<i64>> {
    let columns: Vec<Vec<i64>> = reference::AXES.iter().take(axes).map(|axis| table.column(axis)).collect();
    (1..columns[0].len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
}

/// The path of a line of all axes by the recurrence of its method.
fn expected(family: &str, bits: u32, from: &[i64], to: &[i64], steps: usize) -> Vec<Vec<i64>> {
    match family {
        "stepgen" => {
            let at = |i: i64| {
                from.iter().zip(to).map(|(from, to)| from + ((to - from) * i).div_euclid(steps as i64)).collect()
            };
            (1..=steps as i64).map(at).collect()
        }
        "bresenham" => places(&reference::bresenham(from, to, Form::Magnitude, false), from.len()),
        "dpm" => places(&dpm_line(bits, from, to), from.len()),
        _ => followed(family, bits, from, to),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(12) })]

    #[test]
    fn lines_of_many_axes_go_by_the_recurrence_of_their_method(
        ends in prop::collection::vec(prop::array::uniform9(-40i64..40), 1..4),
        axes in 4usize..10,
    ) {
        let mut at = [0; 9];
        let moves: Vec<_> = ends.into_iter().map(|mut to| {
            to[axes..].fill(0);
            let [[from, other_from], [end, other_to]] = [at, to].map(|place| {
                let real = place.map(|c| c as f64);
                [real[..3].to_vec(), real[3..].to_vec()]
            });
            let point = |place: Vec<f64>| <[f64; 3]>::try_from(place).unwrap();
            let others = |place: Vec<f64>| <[f64; 6]>::try_from(place).unwrap();
            at = to;
            let mut of = tool_move(point(from), point(end), SegmentShape::Line);
            of.others = Others { from: others(other_from), to: others(other_to) };
            of
        }).collect();
        for model in catalogue().machines() {
            let (machine, family) = (model.moves().unwrap(), model.method_name());
            let (mut rounder, mut blocks, mut size) = (Rounder::new(None), Vec::new(), Size::default());
            moves.iter().for_each(|of| { rounder.blocks(of, &mut blocks).unwrap(); });
            blocks.iter().for_each(|block| size.add(machine.crossing(), block));
            let options = Options::default().with(&ON_OVERFLOW, OnOverflow::Trap);
            let hardware = model.plan_program(&size, &options).unwrap();
            let bits = ["jvx", "q"].map(|name| hardware.widths.get(name).map_or(0, |width| width.get()));
            let count = hardware.axes;
            let bench = Testbench::of_machine(hardware.clone(), model.machine(&hardware).unwrap()).limited(1 << 20);
            let ran = [EngineKind::Word, EngineKind::Gates, EngineKind::Compiled].map(|engine| {
                let all = of_machine(machine, &hardware, &blocks);
                let (mut control, mut places) = (Control::new(&bench, all, 1 << 31), Places::default());
                let outcome = bench.run_fed(engine, &mut control, &mut [&mut places]).unwrap();
                (outcome.ending, places.0)
            });
            prop_assert!(ran[0] == ran[1] && ran[1] == ran[2], "{}: engines differ", family);
            let [(ending, paths), ..] = ran;
            prop_assert_eq!(ending, Ending::Done);
            prop_assert_eq!(paths.len(), blocks.len());
            for (PulseBlock { from, to, .. }, path) in blocks.iter().zip(paths) {
                let wanted = expected(family, bits[0].max(bits[1]), &from[..count], &to[..count], path.len());
                prop_assert_eq!(path, wanted, "{} {:?} {:?}", family, from, to);
            }
        }
    }

    #[test]
    fn axes_next_to_an_arc_go_evenly_with_its_angle(
        radius in 20i64..300,
        quarters in 1usize..5,
        climb in -0.9f64..0.9,
        turn in prop::array::uniform2(-0.9f64..0.9),
    ) {
        // Each goes at most nine tenths as far as it can follow.
        let reach = radius as f64 * quarters as f64;
        let center = [-radius as f64, 0.0];
        let about = [[radius, 0], [0, radius], [-radius, 0], [0, -radius]][quarters % 4];
        let end = [center[0] + about[0] as f64, about[1] as f64, (climb * reach).round()];
        let direction = stepwave_nc::Direction::CounterClockwise;
        let shape = SegmentShape::Arc { plane: stepwave_nc::Plane::Xy, center, direction };
        let mut of = tool_move([0.0; 3], end, shape);
        of.others.to = [(turn[0] * reach).round(), 0.0, 0.0, (turn[1] * reach).round(), 0.0, 0.0];
        for model in catalogue().machines().filter(|model| model.moves().unwrap().arcs()) {
            let machine = model.moves().unwrap();
            let (mut rounder, mut blocks, mut size) = (Rounder::new(None), Vec::new(), Size::default());
            rounder.blocks(&of, &mut blocks).unwrap();
            blocks.iter().for_each(|block| size.add(machine.crossing(), block));
            let hardware = model.plan_program(&size, &Options::default()).unwrap();
            let bench = Testbench::of_machine(hardware.clone(), model.machine(&hardware).unwrap()).limited(1 << 20);
            let all = of_machine(machine, &hardware, &blocks);
            let (mut control, mut places) = (Control::new(&bench, all, 1 << 31), Places::default());
            let outcome = bench.run_fed(EngineKind::Word, &mut control, &mut [&mut places]).unwrap();
            prop_assert_eq!(outcome.ending, Ending::Done);
            let whole: f64 = quarters as f64 * std::f64::consts::FRAC_PI_2;
            for place in places.0.iter().flatten() {
                let angle = (place[1] as f64).atan2(place[0] as f64 - center[0]);
                let angle = if angle < -1e-9 { angle + std::f64::consts::TAU } else { angle };
                let others = [(2, end[2]), (3, of.others.to[0]), (6, of.others.to[3])];
                for (axis, all) in others.into_iter().filter(|(axis, _)| *axis < place.len()) {
                    // A full turn starts and ends at angle 0; elsewhere a follower is within a pulse of its share, which is off
                    // the angle by half a BLU of rounding, and of the plane by as much as a pulse there.
                    let off = (place[axis] as f64 - all * angle / whole).abs();
                    let off = off.min((place[axis] as f64 - all * (angle + std::f64::consts::TAU) / whole).abs());
                    prop_assert!(off <= 3.0, "{}: {} off on axis {} of {:?}", model.method_name(), off, axis, place);
                }
            }
            let last = places.0.last().and_then(|path| path.last()).unwrap().iter().map(|&c| c as f64).collect::<Vec<_>>();
            let [a, b, c, u, ..] = of.others.to;
            let wanted = [end[0], end[1], end[2], a, b, c, u];
            prop_assert_eq!(&last[..], &wanted[..hardware.axes]);
        }
    }
}

/// Coarse and fast enough for every feed here.
const USUAL: &str = "--blu 0.01mm --blu-rotary 0.01deg --clock-hz 1e6";

#[test]
fn a_feed_is_along_x_y_z_else_along_u_v_w_else_in_degrees() {
    let program = "G21 G90 G94 G1 X3 Y4 A90 F300\n(1 s: 5 mm, whatever A turns)\n\
        G1 A180 F5400\n(1 s: 90 degrees)\n\
        G93 A90 C-120 F60\n(1 s: 150 degrees of A and C together)\n\
        G94 U-3 W4 B30 F300\n(1 s: 5 mm of U and W)\n\
        G20 F180\nA95\n(1.667 s: 5 degrees; inches are not degrees)\nG21\n\
        G93 G1 X0 Y0 A0 F30\n(2 s)\n\
        G94 G2 X2 I1 J0 C0 F60\n(pi s: half a circle of 1 mm)\nM30\n";
    let seconds = [1.0, 1.0, 1.0, 1.0, 5.0 / 3.0, 2.0, std::f64::consts::PI];
    for family in FAMILIES {
        let report = report(&Folder::new(), program, &format!("--method {family} {USUAL}"));
        let blocks = report["blocks"].as_array().unwrap();
        assert_eq!((report["missed_end_points"].as_u64(), blocks.len()), (Some(0), seconds.len()), "{family}");
        assert_eq!(report["reached"], json!([200, 0, 0, 0, 3000, 0, -300, 0, 400]), "{family}");
        // Rounding to pulses makes a half circle and its chords a little shorter.
        for (block, wanted) in blocks.iter().zip(seconds) {
            let seconds = number(&block["seconds"]);
            assert!(
                (seconds / wanted - 1.0).abs() < 0.01,
                "{family}, line {}: {seconds} s for {wanted}",
                block["line"]
            );
        }
        for (index, (unit, commanded)) in
            [("mm", 300.0), ("degrees", 5400.0), ("degrees", 9000.0), ("mm", 300.0), ("degrees", 180.0)]
                .into_iter()
                .enumerate()
        {
            let given = number(&blocks[index]["feed"][format!("commanded_{unit}_per_min")]);
            assert!((given - commanded).abs() < 1e-6, "{family}: {given} for {commanded}");
        }
    }
}

#[test]
fn all_pieces_of_a_helix_keep_its_time_where_few_have_a_pulse_of_another_axis() {
    // 10.17 mm in 2.03 s; C has two pulses, which most pieces of the helix are without.
    let program = "G21 G90 G94 G2 X4 Y0 I2 J0 Z8 C0.02 F300\nM30\n";
    let wanted = f64::hypot(2.0 * std::f64::consts::PI, 8.0) / 5.0;
    for family in FAMILIES {
        let report = report(&Folder::new(), program, &format!("--method {family} {USUAL}"));
        let seconds = number(&report["blocks"][0]["seconds"]);
        assert!((seconds / wanted - 1.0).abs() < 0.01, "{family}: {seconds} s for {wanted}");
    }
}

#[test]
fn a_line_whose_path_is_rounded_off_counts_all_axes() {
    let report = report(&Folder::new(), "G1 X0.001 A9 C12 F600\nM30\n", &format!("--method ppc {USUAL}"));
    let block = &report["blocks"][0];
    assert_eq!(number(&block["length"]), 1500.0, "{block}");
    assert!((number(&block["seconds"]) - 1.5).abs() < 1e-4, "{block}");
    let speed = |what: &str| number(&block["feed"][what]["value"]);
    assert!(speed("least") > 0.7 && speed("greatest") < 0.8, "{block}");
}

#[test]
fn a_compensated_contour_turns_with_its_blocks() {
    let program = "G21 G90 G1 F600 G41 D1 X10 Y0 A10\nX20 A20\nA50\nY20 A60\nG40 X0 Y30 A0\nG91 A-5 B7\nG28 A0\nM30\n";
    for family in FAMILIES {
        let folder = Folder::new();
        let report = report(&folder, program, &format!("--method {family} {USUAL} --tool 1=2mm"));
        let ends = |block: &Value| {
            let end = &block["end_point"]["reached"];
            (block["kind"].as_str().unwrap().to_owned(), end[3].as_i64().unwrap(), end[4].as_i64().unwrap())
        };
        let ends: Vec<_> = report["blocks"].as_array().unwrap().iter().map(ends).collect();
        let wanted = [
            ("start-up", 1000, 0),
            ("line", 2000, 0),
            ("line", 5000, 0),
            ("line", 6000, 0),
            ("cancel", 0, 0),
            ("line", -500, 700),
            // To the place that is given under G91, which is here, and home.
            ("rapid", 0, 700),
        ];
        let wanted: Vec<_> = wanted.map(|(kind, a, b)| (kind.to_owned(), a, b)).into();
        assert_eq!(ends, wanted, "{family}");
    }
}

#[test]
fn what_has_no_such_axis_says_so() {
    let folder = Folder::new();
    let bad = |text: &str, options: &str| {
        std::fs::write(folder.path("p.ngc"), text).unwrap();
        let ran = folder.run(&format!("program p.ngc {options}"));
        assert_eq!(ran.code, 2, "{ran:?}");
        ran.err
    };
    let said = bad("F1 G5 X1 Y1 I1 J0 P0 Q-1 A3", "--method dda");
    assert!(
        said.contains("line 1, column 26: A3 has nothing that uses it in this block: it belongs to G00 to G03"),
        "{said}"
    );
    let said = bad("G1 F100 X1 V1", "--method ppc --accel 500mm/s2");
    assert!(said.contains("leave --accel or these axes out"), "{said}");
    let said = bad("G1 F100 X1 A1", "--method ppc --blu-rotary 0deg");
    assert!(said.contains("invalid angle '0deg': give degrees above 0, such as 0.001deg"), "{said}");
}

#[test]
fn the_example_of_a_fourth_axis_ends_every_move_by_every_family() {
    let text = include_str!("../../examples/fourth_axis.ngc");
    for family in FAMILIES {
        let normalize = if family == "dda" { "--normalize" } else { "" };
        let options = format!("--method {family} --blu 0.1mm --blu-rotary 0.1deg --clock-hz 1e5 {normalize}");
        let report = report(&Folder::new(), text, &options);
        assert_eq!((&report["missed_end_points"], &report["beyond_bound"]), (&json!(0), &json!(0)), "{family}");
        assert_eq!(report["pulses"], json!({ "x": 720, "y": 80, "z": 200, "a": 31500 }), "{family}");
    }
}
