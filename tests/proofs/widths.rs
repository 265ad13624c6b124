//! Least widths: the table of the methods, and agreement with single runs.

use std::collections::BTreeMap;

use stepwave::study::proof::ProofError;
use stepwave::study::widths::{Known, Widths, by_proof, ranges_alone, simulated};
use stepwave::study::{Extent, Geometries};
use stepwave::testbench::{Ending, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::options::WEIGHTS;
use stepwave_models::{CurveKind, Model, Options, Weights, catalogue, find};
use stepwave_nc::{Curve, Shape};

use crate::cli::Folder;

fn widths(model: &'static Model, choices: &Options, extent: &Extent) -> Result<Widths, ProofError> {
    stepwave::study::widths::widths(model, choices, extent, &|_| {})
}

fn needed(found: &Widths, k: u32) -> BTreeMap<&str, i64> {
    found.registers.iter().map(|register| (register.name.as_str(), i64::from(register.needed) - i64::from(k))).collect()
}

#[test]
#[ignore = "exhaustive"]
fn the_least_widths_of_the_methods_are_those_of_the_literature() {
    let pre = Options::default().with(&WEIGHTS, Weights::Pre);
    for (model, choices, rows) in [
        ("ppc-line", Options::default(), vec![("f", 1), ("e", 1), ("xe", 0), ("x", 1)]),
        ("ppc-arc", Options::default(), vec![("f", 2), ("xi", 0), ("yi", 0)]),
        ("cim-line", Options::default(), vec![("f", 1), ("a", 0), ("ex", 0)]),
        ("cim-arc", pre, vec![("f", 1)]),
        ("cim-arc", Options::default(), vec![("f", 2)]),
        ("dda-line", Options::default(), vec![("jvx", 0), ("jrx", 0), ("e", 1)]),
        ("dda-arc", Options::default(), vec![("jvx", 0), ("jry", 0), ("ex", 0)]),
        ("mindev-line", Options::default(), vec![("f", 2), ("l", 0), ("e", 0)]),
        ("bresenham", Options::default(), vec![("cntx", 1), ("e", 0)]),
        ("mindev-arc", Options::default(), vec![("f", 1), ("e", 1)]),
        ("vector-arc", Options::default(), vec![("f", 2), ("e", 1)]),
    ] {
        let k = 5;
        let found = widths(find(model).unwrap(), &choices, &Extent::Bits(k)).unwrap();
        assert!(found.all && found.faults == 0 && found.simulated > 1000, "{model}: {found:?}");
        let own = needed(&found, k);
        for (register, bits) in rows {
            assert_eq!(own[register], bits, "{model}: {register}");
        }
        assert!(found.registers.iter().all(|register| register.known == Known::Proved), "{model}: {found:?}");
        // Every deviation has a geometry that stops it one bit below.
        let f = found.registers.iter().find(|register| register.name == "f");
        assert!(f.is_none_or(|f| f.witness.is_some()), "{model}");
    }
}

/// Wants what lanes see over a box to be what single runs see.
fn assert_as_alone(model: &'static Model, extent: &Extent) {
    let found = widths(model, &Options::default(), extent).unwrap();
    let own = Geometries::of(model, &Options::default(), extent).unwrap();
    assert_eq!((own.curves.len(), own.all), (found.simulated, found.all), "{}", model.name);
    let bench = Testbench::of_hardware(model, own.hardware).unwrap();
    let alone = ranges_alone(model, &bench, &own.curves, EngineKind::Word).unwrap();
    assert!(!found.registers.is_empty());
    for register in &found.registers {
        assert_eq!(alone[&register.name], register.range, "{} {extent}: {}", model.name, register.name);
    }
}

/// The models with boxes of geometries: free curves have none.
fn boxed() -> impl Iterator<Item = &'static Model> {
    let all: Vec<&'static Model> = catalogue().iter().collect();
    all.into_iter().filter(|model| !matches!(model.curve(), CurveKind::Spline | CurveKind::Nurbs))
}

#[test]
#[ignore = "exhaustive"]
fn lanes_and_single_runs_of_every_model_see_the_same_ranges() {
    for model in boxed() {
        assert_as_alone(model, &Extent::Bits(3));
        // Of four bits where a run takes few clocks.
        if !matches!(model.name, "stepgen" | "dpm-line" | "dda-helix" | "dda-conic" | "dda-arc") {
            assert_as_alone(model, &Extent::Bits(4));
        }
    }
    for (model, grid) in [("dda-line", "-3..9x0..5"), ("stepgen", "1..4x0..3x-2..2"), ("ppc-arc", "-5..5x-5..5")] {
        assert_as_alone(find(model).unwrap(), &grid.parse().unwrap());
    }
}

#[test]
fn a_box_of_ranges_holds_its_own_points_alone() {
    let of = |model: &str, extent: &str| widths(find(model).unwrap(), &Options::default(), &extent.parse().unwrap());
    let grid = of("ppc-line", "0..7x0..7").unwrap();
    // 8 · 8 points, and the origin is none.
    assert_eq!((grid.simulated, grid.all, grid.k), (63, true, 3));
    assert_eq!(of("ppc-line", "-7..7x-7..7").unwrap().registers, of("ppc-line", "3").unwrap().registers);
    // On circles about the origin with coordinates to 5 there are (0, 1) to (0, 5) with those of x, (1, 2), (1, 3), (1, 4),
    // (1, 5), (2, 3), (2, 4), (2, 5), (3, 4), (3, 5), (4, 5) with those turned over, and (0, 5) with (3, 4): each pair
    // both ways.
    let arcs = of("ppc-arc", "0..5x0..5").unwrap();
    assert_eq!(arcs.simulated, 2 * (5 + 10 + 4));
    // The box of three bits has the same arcs, in another order.
    let ranges = |extent: &str| -> Vec<_> {
        let found = of("ppc-arc", extent).unwrap();
        found.registers.into_iter().map(|register| (register.name, register.needed, register.range)).collect()
    };
    assert_eq!(ranges("-7..7x-7..7"), ranges("3"));
}

#[test]
fn boxes_of_conics_and_helices_hold_what_is_counted_by_hand() {
    let of =
        |model: &str, k| Geometries::of(find(model).unwrap(), &Options::default(), &Extent::Bits(k)).unwrap().curves;
    let count = |curves: &[Curve], is: fn(&Shape) -> bool| {
        curves.iter().filter(|curve| matches!(curve, Curve::Conic(conic) if is(&conic.shape()))).count()
    };
    let conics = of("ppc-conic", 2);
    // Nine pairs of semi-axes, four quarters, both ways.
    assert_eq!(count(&conics, |shape| matches!(shape, Shape::Ellipse { .. })), 9 * 4 * 2);
    // y² = cx up to 3: (1, 1) of c = 1, (2, 2) of c = 2, (3, 3) of c = 3, each with four openings, two sides, both ways.
    assert_eq!(count(&conics, |shape| matches!(shape, Shape::Parabola { .. })), 3 * 4 * 2 * 2);
    // Two bits have no hyperbola: (x/a)² - (y/b)² = 1 first has (5, 4) of a = b = 3, and (5, 4k/3) of such b.
    assert_eq!(count(&conics, |shape| matches!(shape, Shape::Hyperbola { .. })), 0);
    let conics = of("ppc-conic", 3);
    assert!(count(&conics, |shape| matches!(shape, Shape::Hyperbola { semi_axes: [3, 3], .. })) == 4 * 2 * 2);
    // The quarters of radius 1, four of them both ways, with z from -1 to 1.
    assert_eq!(of("dda-helix", 1).len(), 4 * 2 * 3);
    for model in ["ppc-conic", "cim-conic", "dda-conic", "dda-helix"] {
        let found = widths(find(model).unwrap(), &Options::default(), &Extent::Bits(3)).unwrap();
        assert!(found.all && found.registers.iter().all(|register| register.known == Known::Exhaustive), "{model}");
    }
}

/// One counter for both axes ends some conics elsewhere; with a full preset some come to a stand.
#[test]
fn geometries_that_miss_their_ends_are_counted_as_single_runs_end() {
    let folder = Folder::new();
    for options in ["", " --end-point total", " --preset full"] {
        let choices = Options::parse(options.split_whitespace()).unwrap();
        let model = find("dda-conic").unwrap();
        let Geometries { curves, hardware, .. } = Geometries::of(model, &choices, &Extent::Bits(3)).unwrap();
        let bench = Testbench::of_hardware(model, hardware).unwrap();
        let (mut missed, mut open) = (0, 0);
        for curve in &curves {
            let outcome = bench.of(model, curve).unwrap().run(EngineKind::Word, &mut []).unwrap();
            match outcome.ending {
                Ending::Done => missed += usize::from(outcome.reached != curve.to()),
                _ => open += 1,
            }
        }
        assert_eq!([missed > 0, open > 0], [options.contains("total"), options.contains("full")], "{options}");
        let printed = folder.good(&format!("widths dda-conic --box 3{options}"));
        let says = |count: usize, what: &str| printed.contains(&format!("\n{count} geometries {what}")) == (count > 0);
        assert!(says(missed, "end, but miss their end points; what registers held counts\n"), "{options} {printed}");
        assert!(says(open, "had not ended after 16777216 clocks, and were followed no further\n"), "{printed}");
        let printed = folder.good(&format!("widths dda-conic --box 3{options} --json"));
        let json: serde_json::Value = serde_json::from_str(&printed).unwrap();
        let counts = ["missed_end_points", "followed_in_part", "faults"].map(|field| json[field].as_u64());
        assert_eq!(counts, [Some(missed as u64), Some(open as u64), Some(0)], "{options}");
        assert_eq!(json["followed_clocks"], 1 << 24);
    }
}

#[test]
fn the_table_names_a_run_that_one_bit_less_does_not_hold() {
    let folder = Folder::new();
    let table = folder.good("widths ppc-line --box 4");
    let f = table.lines().find(|line| line.starts_with("f ")).unwrap();
    let words: Vec<&str> = f.split_whitespace().collect();
    assert_eq!((words[..4].to_vec(), words[7]), (vec!["f", "5", "5", "k+1"], "proved"), "{table}");
    let command = f.split_once("stepwave ").unwrap().1;
    let ran = folder.run(command);
    assert!(ran.code == 1 && ran.err.contains("overflow of ppc_line.f"), "{command}: {ran:?}");
    let json: serde_json::Value = serde_json::from_str(&folder.good("widths stepgen --box 3 --json")).unwrap();
    assert_eq!((&json["all"], &json["registers"][0]["known"]), (&true.into(), &"exhaustive".into()));
    for (words, hint) in [
        ("widths ppc-line", "--box"),
        ("widths ppc-line --box 0", "1 to 52 bits"),
        ("widths ppc-line --box 53", "1 to 52 bits"),
        ("widths cim-conic --box 17", "at most 16 bits"),
        ("widths ppc-conic --box 20", "at most 16 bits"),
        ("widths ppc-line --box 20 --form bare", "at most 16 bits"),
        ("widths ppc-line --box 9..0x0..9", "give 0..9"),
        (
            "widths ppc-line --box 0..9",
            "the box has 1 range, but ppc-line interpolates lines of 2 to 6 axes (--from X,Y,… --to X,Y,…): give --box 0..9x0..9\n",
        ),
        ("widths ramp --box 0..9x0..9", "give --box 0..9\n"),
        ("widths vector-line --box 0..9x0..9x0..9", "give --box 0..9x0..9\n"),
        ("widths ppc-arc --box 0..9x0..9x0..9", "give --box 0..9x0..9"),
        ("widths ppc-arc --box 1..2x5..6", "the box holds nothing"),
        ("widths ppc-arc --box 1..3000x5000000000..5000002000", "6003000 points are too many to look at all"),
        ("widths ppc-line --box 0..4503599627370496x0..9", "within ±4503599627370495"),
        ("widths dda-helix --box 0..4x0..4", "give --box 4"),
        ("widths ppc-line --box 4 --preset half", "does not take --preset"),
    ] {
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(hint) && ran.err.lines().count() == 1, "{words}: {ran:?}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_large_box_of_bits_has_the_proved_width_and_a_run_that_needs_it() {
    let pre = Options::default().with(&WEIGHTS, Weights::Pre);
    for (model, choices, rows) in [
        // Lines: F in [-b, a - 1], a + b steps. Arcs: F in [-(2R - 1), 2R - 2], at most 2R steps in a quadrant.
        ("ppc-line", Options::default(), vec![("f", 1), ("e", 1), ("xe", 0), ("ye", 0), ("x", 1), ("y", 1)]),
        ("ppc-arc", Options::default(), vec![("f", 2), ("xi", 0), ("yi", 0), ("e", 1), ("x", 1)]),
        ("cim-line", Options::default(), vec![("f", 1), ("a", 0), ("b", 0), ("ex", 0)]),
        ("cim-arc", pre, vec![("f", 1), ("a", 0), ("ey", 0)]),
        ("dda-line", Options::default(), vec![("jvx", 0), ("jry", 0), ("e", 1), ("x", 1)]),
        ("mindev-line", Options::default(), vec![("f", 2), ("l", 0)]),
        ("bresenham", Options::default(), vec![("cntx", 1), ("e", 0), ("stepsy", 0)]),
    ] {
        for k in [9, 16, 40] {
            let found = widths(find(model).unwrap(), &choices, &Extent::Bits(k)).unwrap();
            let own = needed(&found, k);
            for (register, bits) in &rows {
                assert_eq!(own[register], *bits, "{model} of {k} bits: {register}");
            }
            for register in &found.registers {
                assert_eq!(register.known, Known::Proved, "{model} of {k} bits: {register:?}");
                let witness = register.witness.as_ref().unwrap_or_else(|| panic!("{model} of {k} bits: {register:?}"));
                // Positions alone come to their extremes only at the end of a line.
                assert!(witness.ran || k > 16 && matches!(register.name.as_str(), "x" | "y"), "{model}: {register:?}");
            }
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_box_of_ranges_may_need_less_than_its_bits() {
    let of = |model: &str, extent: &str| {
        let found = widths(find(model).unwrap(), &Options::default(), &extent.parse().unwrap()).unwrap();
        let rows = found.registers.iter();
        rows.map(|register| (register.name.clone(), (register.needed, register.known))).collect::<BTreeMap<_, _>>()
    };
    for (extent, rows) in [
        // 299,999 needs 19 bits and a sign; 500,000 steps.
        ("0..300000x0..200000", [("f", 20), ("e", 19), ("xe", 19), ("ye", 18), ("x", 20), ("y", 19)]),
        // F within [-2^18, 2^18 - 1], though a coordinate of 2^18 has 19 bits.
        ("0..262144x0..262144", [("f", 19), ("e", 20), ("xe", 19), ("ye", 19), ("x", 20), ("y", 20)]),
        ("-262144..0x0..3", [("f", 19), ("e", 19), ("xe", 19), ("ye", 2), ("x", 19), ("y", 3)]),
    ] {
        let found = of("ppc-line", extent);
        for (register, bits) in rows {
            assert_eq!(found[register], (bits, Known::Proved), "{extent}: {register}");
        }
    }
}

/// Wants a proof to give what the simulation of every geometry of a box gives, or more where it says so.
fn assert_proof_agrees(model: &'static Model, extent: &str) {
    let (choices, box_of) = (Options::default(), extent.parse::<Extent>().unwrap());
    let whole = Geometries::of(model, &choices, &box_of).unwrap();
    assert!(whole.all);
    let whole = simulated(model, &choices, &box_of, whole, &|_| {}).unwrap();
    let proved = by_proof(model, &choices, &box_of, &|_| {}).unwrap().unwrap();
    assert_eq!(proved.registers.len(), whole.registers.len());
    for (proved, true_one) in proved.registers.iter().zip(&whole.registers) {
        assert_eq!(proved.name, true_one.name);
        let (least, most) = (true_one.needed, proved.needed);
        assert!(proved.shown <= least && least <= most, "{} {extent}: {proved:?} {true_one:?}", model.name);
        assert!(proved.known == Known::Enough || least == most, "{} {extent}: {proved:?} {true_one:?}", model.name);
    }
}

#[test]
#[ignore = "exhaustive"]
fn what_is_proved_of_a_box_is_what_all_of_its_geometries_need() {
    for model in ["ppc-line", "cim-line", "mindev-line", "vector-line"] {
        for extent in ["0..8x0..8", "-3..16x2..5", "9..9x0..8", "-16..-4x-9..30", "0..31/6x3..29/2", "5..40x0..0"] {
            assert_proof_agrees(find(model).unwrap(), extent);
        }
    }
    for (model, extent) in [("dda-line", "0..8x0..5"), ("bresenham", "0..8x-8..3"), ("ppc-arc", "-25..25x0..33")] {
        assert_proof_agrees(find(model).unwrap(), extent);
    }
}

#[test]
#[ignore = "exhaustive"]
fn the_extreme_geometries_need_what_all_of_them_need() {
    for model in boxed() {
        let ks: &[u32] = match model.name {
            "dda-helix" | "dda-conic" => &[3],
            "stepgen" | "dpm-line" | "ppc-conic" | "cim-conic" | "sampled-line" | "sampled-arc" => &[4],
            _ => &[4, 5],
        };
        for &k in ks {
            let (choices, extent) = (Options::default(), Extent::Bits(k));
            let of = |set: Geometries| simulated(model, &choices, &extent, set, &|_| {}).unwrap();
            let all = Geometries::of(model, &choices, &extent).unwrap();
            let extremes = Geometries::extremes(model, &choices, &extent).unwrap();
            assert!(all.all && !extremes.all);
            let [all, extremes] = [of(all), of(extremes)];
            let rows = |found: &Widths| -> Vec<(String, u32)> {
                found.registers.iter().map(|register| (register.name.clone(), register.needed)).collect()
            };
            assert_eq!(rows(&extremes), rows(&all), "{} of {k} bits", model.name);
        }
    }
}

#[test]
fn conics_of_the_largest_box_lie_on_their_curves() {
    for model in ["cim-conic", "ppc-conic"] {
        let found = Geometries::extremes(find(model).unwrap(), &Options::default(), &Extent::Bits(16)).unwrap();
        let on = |curve: &Curve| matches!(curve, Curve::Conic(conic) if conic.ends_on_curve());
        assert!(found.curves.iter().all(on) && found.k == 16);
        let has = |is: fn(&Shape) -> bool| {
            found.curves.iter().any(|curve| matches!(curve, Curve::Conic(conic) if is(&conic.shape())))
        };
        assert!(has(|shape| matches!(shape, Shape::Ellipse { semi_axes: [65535, 65535] })));
        assert!(has(|shape| matches!(shape, Shape::Ellipse { semi_axes: [1, 65535] })));
        assert!(has(|shape| matches!(shape, Shape::Hyperbola { semi_axes: [39321, 39321], .. })));
        assert!(has(|shape| matches!(shape, Shape::Parabola { c: 65535, .. })));
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_width_that_is_given_is_judged() {
    let folder = Folder::new();
    // F of 6-bit lines needs 7 bits, of 6-bit arcs 8.
    for (words, code, message) in [
        ("widths ppc-line --box 6 --width f=7", 0, ""),
        ("widths ppc-line --box 6 --width f=6", 1, "f of 6 bits is too narrow, it needs 7: stepwave run ppc-line"),
        ("widths ppc-line --box 20 --width f=20", 1, "f of 20 bits is too narrow, it needs 21: stepwave run ppc-line"),
        ("widths ppc-line --box 6 --width 5", 1, "xe of 5 bits is too narrow, it needs 6: stepwave run ppc-line"),
        ("widths ppc-line --box 6 --width 9", 0, ""),
        ("widths ppc-arc --box 6 --width f=7", 1, "f of 7 bits is too narrow, it needs 8"),
        ("widths dda-line --box 4 --width 6", 0, ""),
        ("widths dda-line --box 4 --width 3", 1, "jvx of 3 bits is too narrow, it needs 4"),
        ("widths cim-conic --box 2 --width 2", 1, "is too narrow"),
        ("widths ppc-line --box 6 --width g=7", 2, "has no register 'g'"),
    ] {
        let ran = folder.run(words);
        assert!(ran.code == code && ran.err.contains(message) && ran.err.is_empty() == (code == 0), "{words}: {ran:?}");
    }
    let table = folder.run("widths ppc-line --box 6 --width f=6");
    let f = table.out.lines().find(|line| line.starts_with("f ")).unwrap();
    assert_eq!(f.split_whitespace().take(3).collect::<Vec<_>>(), ["f", "6", "7"]);
    // The run that is named shows it.
    let named = table.err.lines().next().unwrap().split_once("stepwave run").unwrap().1;
    let shown = folder.run(&format!("run{named}"));
    assert!(shown.code == 1 && shown.err.contains("overflow of ppc_line.f"), "{shown:?}");
    // The scale of an integrator is that of the hardware: its remainder fills 6 bits.
    let json: serde_json::Value =
        serde_json::from_str(&folder.good("widths dda-line --box 4 --width 6 --json")).unwrap();
    let row = |name: &str| json["registers"].as_array().unwrap().iter().find(|row| row["name"] == name).unwrap();
    assert_eq!((&row("jrx")["given"], &row("jrx")["needed"]), (&6.into(), &6.into()));
    assert_eq!((&row("jvx")["given"], &row("jvx")["needed"]), (&6.into(), &4.into()));
    assert_eq!((&row("x")["least"], &row("x")["greatest"]), (&(-15).into(), &15.into()));
}

/// Registers of `widths … --json`: what is given and what is needed.
fn judged(folder: &Folder, words: &str, code: i32) -> BTreeMap<String, [i64; 2]> {
    let ran = folder.run(&format!("{words} --json"));
    assert_eq!(ran.code, code, "{words}: {ran:?}");
    let json: serde_json::Value = serde_json::from_str(&ran.out).unwrap();
    let rows = json["registers"].as_array().unwrap().iter();
    let number = |row: &serde_json::Value, key: &str| row[key].as_i64().unwrap();
    rows.map(|row| (row["name"].as_str().unwrap().to_owned(), ["given", "needed"].map(|key| number(row, key))))
        .collect()
}

#[test]
fn a_width_that_is_none_of_coordinates_is_not_taken_from_the_box() {
    let folder = Folder::new();
    // A period of 8 BLU is 8 pulses of one axis at most, whatever the length of the line.
    for words in ["widths sampled-line --box 5", "widths sampled-line --box 5 --width 4", "widths sampled-arc --box 5"]
    {
        let rows = judged(&folder, words, 0);
        assert!(["jvx", "jvy", "jrx", "jry"].iter().all(|name| rows[*name] == [4, 4]), "{words}: {rows:?}");
    }
    assert_eq!(judged(&folder, "widths sampled-line --box 3 --step 20", 0)["jrx"], [5, 5]);
    assert_eq!(judged(&folder, "widths sampled-line --box 3 --width 6", 0)["jrx"], [6, 6]);
}

#[test]
fn the_accumulations_of_a_step_generator_are_those_that_are_given() {
    let folder = Folder::new();
    // 2^11 accumulations of a rate of 31 or 2^5 · 31 less: 31 · 2^11 and a sign are 17 bits.
    let rows = judged(&folder, "widths stepgen --box 5 --width 9,accx=14", 1);
    assert_eq!((rows["e"], rows["accx"]), ([12, 12], [14, 17]));
    let rows = judged(&folder, "widths stepgen --box 5 --width 9", 0);
    assert_eq!((rows["e"], rows["accx"]), ([12, 12], [21, 17]));
    // Fewer accumulations than by default are no fault.
    let rows = judged(&folder, "widths stepgen --box 5 --width 5,e=7", 0);
    assert_eq!((rows["e"], rows["accx"]), ([7, 7], [12, 12]));
    assert_eq!(judged(&folder, "widths stepgen --box 5", 0)["e"], [8, 8]);
}

#[test]
fn a_box_of_more_points_than_are_listed_has_the_arcs_next_to_its_corners() {
    let model = find("ppc-arc").unwrap();
    let of = |extent: &str| Geometries::of(model, &Options::default(), &extent.parse().unwrap()).unwrap();
    // 10,007,001 points, none of which is another one with x and y exchanged.
    let found = of("0..5000x60000..62000");
    assert!(!found.all && found.curves.len() > 100, "{} arcs", found.curves.len());
    let square = |point: &[i64]| point.iter().map(|side| side.pow(2)).sum::<i64>();
    for curve in &found.curves {
        let (from, to) = (curve.from(), curve.to());
        assert!(square(from) == square(to) && from != to, "{curve:?}");
        for point in [from, to] {
            assert!((0..=5000).contains(&point[0]) && (60_000..=62_000).contains(&point[1]), "{curve:?}");
        }
    }
}
