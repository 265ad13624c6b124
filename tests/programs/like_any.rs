//! Machines of whole programs on the command line, where a model of one curve does the same.

use stepwave::study::widths::{Known, widths};
use stepwave::study::{Extent, Geometries};
use stepwave::testbench::{Ending, RangeWatch, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::options::WIDTH;
use stepwave_models::{Options, catalogue, find};
use stepwave_nc::{Arc, Curve, Direction, Line};
use stepwave_netlist::Width;

use crate::cli::Folder;

/// Every line from the origin to coordinates of `k` bits.
fn lines(k: u32) -> Vec<Curve> {
    let most = (1_i64 << k) - 1;
    let ends = (-most..=most).flat_map(|x| (-most..=most).map(move |y| vec![x, y]));
    ends.filter_map(|to| Line::new(vec![0, 0], to).ok()).map(Curve::Line).collect()
}

/// Every arc about the origin inside a quadrant, both ends on the circle.
fn arcs(k: u32) -> Vec<Curve> {
    let most = (1_i64 << k) - 1;
    let points: Vec<[i64; 2]> = (-most..=most).flat_map(|x| (-most..=most).map(move |y| [x, y])).collect();
    let mut all = Vec::new();
    for from in &points {
        let near = |to: &&[i64; 2]| {
            let [a, b] = [from, *to].map(|at| at[0] * at[0] + at[1] * at[1]);
            a == b && from != *to && from[0] * to[0] >= 0 && from[1] * to[1] >= 0
        };
        for to in points.iter().filter(near) {
            let left = from[0] * to[1] - from[1] * to[0] > 0;
            let direction = if left { Direction::CounterClockwise } else { Direction::Clockwise };
            all.push(Curve::Arc(Arc::new(*from, *to, [0, 0], direction).unwrap()));
        }
    }
    all
}

#[test]
fn the_least_widths_of_a_machine_are_those_that_every_run_of_the_box_needs() {
    let k = 2;
    for model in catalogue().machines() {
        let mut curves = lines(k);
        curves.extend(if model.moves().unwrap().arcs() { arcs(k) } else { Vec::new() });
        let found = widths(model, &Options::default(), &Extent::Bits(k), &|_| {}).unwrap();
        assert_eq!((found.simulated, found.all, found.faults, found.cut), (curves.len(), true, 0, 0), "{}", model.name);
        let own = Geometries::of(model, &Options::default(), &Extent::Bits(k)).unwrap();
        let bench = Testbench::of_hardware(model, own.hardware).unwrap();
        for register in &found.registers {
            assert_eq!(register.known, Known::Exhaustive);
            let needed = curves.iter().map(|curve| {
                let bench = bench.of(model, curve).unwrap();
                let mut ranges = RangeWatch::new(&bench);
                let outcome = bench.run(EngineKind::Gates, &mut [&mut ranges]).unwrap();
                assert_eq!((outcome.ending, &outcome.reached[..]), (Ending::Done, curve.to()));
                ranges.finish().iter().find(|range| range.name == register.name).unwrap().needed()
            });
            assert_eq!(Some(register.needed), needed.max(), "{}: {}", model.name, register.name);
        }
        // All of them together are enough.
        let least = found.registers.iter().map(|own| (own.name.clone(), Width::new(own.needed.into()).unwrap()));
        let scaled = |name: &str| bench.hardware().shares_a_scale(name) || name == "q";
        let least = Options::default().with_single(&WIDTH, least.filter(|(name, _)| !scaled(name)).collect());
        for curve in &curves {
            let Ok(bench) = Testbench::new(model, curve, &least) else { continue };
            let outcome = bench.run(EngineKind::Word, &mut []).unwrap();
            assert_eq!((outcome.ending, &outcome.reached[..]), (Ending::Done, curve.to()), "{} {curve:?}", model.name);
        }
    }
}

#[test]
fn a_verdict_on_given_widths_is_of_every_line_and_every_arc_of_the_box() {
    let folder = Folder::new();
    let (lines, arcs) = (lines(2).len(), arcs(2).len());
    for model in catalogue().machines() {
        let count = lines + if model.moves().unwrap().arcs() { arcs } else { 0 };
        for options in ["--box 2", "--width 2"] {
            let out = folder.good(&format!("prove {} {options}", model.name));
            for claim in ["no register overflows", "the end point is reached exactly", "every block ends"] {
                let line = format!("PROVED at these widths (exhausted: {count} geometries): {claim}\n");
                assert!(out.contains(&line), "{}: {out}", model.name);
            }
        }
        // The position comes to 3 and -3.
        let ran = folder.run(&format!("prove {} --width x=2 --box 2", model.name));
        assert!(ran.code == 1 && ran.out.starts_with("COUNTEREXAMPLE at k = 2: stepwave run "), "{ran:?}");
    }
    let out = folder.good("prove dda-machine --normalize --box 2");
    assert!(out.contains(&format!("exhausted: {} geometries", lines + arcs)), "{out}");
}

#[test]
fn a_proof_for_every_width_is_refused_with_what_there_is_instead() {
    let folder = Folder::new();
    let ran = folder.run("prove ppc-machine");
    assert_eq!((ran.code, &ran.out[..]), (2, ""));
    assert!(
        ran.err.contains("ppc-machine takes its blocks through a buffer") && ran.err.contains("give --width, --box")
    );
    let ran = folder.run("prove mindev-machine --narrower f=2");
    assert!(ran.code == 1 && ran.out.starts_with("COUNTEREXAMPLE"), "{ran:?}");
}

#[test]
fn a_curve_that_a_machine_does_not_take_is_refused() {
    let folder = Folder::new();
    for (words, hint) in [
        ("run dpm-machine --from 5,0 --to 0,5 --ccw", "dpm-machine interpolates lines of 2 to 9 axes"),
        ("run ppc-machine --to 1", "ppc-machine interpolates lines of 2 to 9 axes, arcs and helices"),
        ("run ppc-machine --ellipse 5,3 --from 5,0 --to 0,3 --ccw", "no --ellipse: leave it out"),
        ("run ppc-machine --from 5,0,0 --to 0,5,30 --ccw", "z climbs more than half as many pulses"),
        ("run ppc-machine", "the end point is missing"),
    ] {
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(hint), "{words}: {ran:?}");
    }
}

#[test]
fn a_machine_is_kept_as_a_golden_wave() {
    let folder = Folder::new();
    let case = "[[case]]\nname = \"circle\"\nsource = \"by hand\"\nargs = [\"mindev-machine\", \"--from\", \"9,0\", \"--to\", \"9,0\", \"--ccw\"]\n";
    folder.write("cases.toml", case);
    assert!(folder.good("golden record .").ends_with("1 cases recorded, from 3 engines\n"));
    assert_eq!(folder.good("golden check ."), "1 cases same, bit by bit, from 3 engines\n");
}

#[test]
fn a_sweep_of_a_machine_and_a_comparison_have_its_runs() {
    let folder = Folder::new();
    for model in catalogue().machines() {
        let out = folder.good(&format!("sweep {} --to-grid -9..9/3x-7..7/7x-5..5/5 --csv -", model.name));
        let rows: Vec<&str> = out.lines().skip(1).filter(|row| !row.contains("refused")).collect();
        assert_eq!(rows.len(), 7 * 3 * 3 - 1);
        assert!(rows.iter().all(|row| row.contains(",done,")), "{}: {out}", model.name);
    }
    let out = folder.good("compare --from 20,0 --to 0,20 --ccw");
    for model in ["ppc-machine", "dda-machine --normalize", "cim-machine", "mindev-machine"] {
        let row = out.lines().find(|line| line.starts_with(&format!("{model} ")));
        assert!(row.is_some_and(|row| row.ends_with("exact")), "{model}: {out}");
    }
    assert!(find("dpm-machine").is_ok() && !out.contains("dpm-machine"));
}
