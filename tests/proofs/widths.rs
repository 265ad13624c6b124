//! Least widths: the table of the methods, and agreement with single runs.

use std::collections::BTreeMap;

use stepwave::study::widths::{Known, Widths, ranges_alone, widths};
use stepwave::study::{Extent, Geometries};
use stepwave::testbench::Testbench;
use stepwave_kernel::engine::EngineKind;
use stepwave_models::{Choices, Model, Weights, catalogue, find};
use stepwave_nc::{Curve, Shape};

use crate::cli::Folder;

fn needed(found: &Widths, k: u32) -> BTreeMap<&str, i64> {
    found.registers.iter().map(|register| (register.name.as_str(), i64::from(register.needed) - i64::from(k))).collect()
}

#[test]
fn the_least_widths_of_the_methods_are_those_of_the_literature() {
    let pre = Choices { weights: Some(Weights::Pre), ..Choices::default() };
    for (model, choices, rows) in [
        ("ppc-line", Choices::default(), vec![("f", 1), ("e", 1), ("xe", 0), ("x", 1)]),
        ("ppc-arc", Choices::default(), vec![("f", 2), ("xi", 0), ("yi", 0)]),
        ("cim-line", Choices::default(), vec![("f", 1), ("a", 0), ("ex", 0)]),
        ("cim-arc", pre, vec![("f", 1)]),
        ("cim-arc", Choices::default(), vec![("f", 2)]),
        ("dda-line", Choices::default(), vec![("jvx", 0), ("jrx", 0), ("e", 1)]),
        ("dda-arc", Choices::default(), vec![("jvx", 0), ("jry", 0), ("ex", 0)]),
        ("mindev-line", Choices::default(), vec![("f", 2), ("l", 0), ("e", 0)]),
        ("bresenham", Choices::default(), vec![("cntx", 1), ("e", 0)]),
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
    let found = widths(model, &Choices::default(), extent).unwrap();
    let own = Geometries::of(model, &Choices::default(), extent).unwrap();
    assert_eq!((own.curves.len(), own.all), (found.simulated, found.all), "{}", model.name);
    let bench = Testbench::of_hardware(model, own.hardware).unwrap();
    let alone = ranges_alone(model, &bench, &own.curves, EngineKind::Word).unwrap();
    assert!(!found.registers.is_empty());
    for register in &found.registers {
        assert_eq!(alone[&register.name], register.range, "{} {extent}: {}", model.name, register.name);
    }
}

#[test]
fn lanes_and_single_runs_of_every_model_see_the_same_ranges() {
    for model in catalogue() {
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
    let of = |model: &str, extent: &str| widths(find(model).unwrap(), &Choices::default(), &extent.parse().unwrap());
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
    let large = of("bresenham", "0..2000x0..2000").unwrap();
    assert!(!large.all && large.registers.iter().all(|register| register.known != Known::Exhaustive));
}

#[test]
fn boxes_of_conics_and_helices_hold_what_is_counted_by_hand() {
    let of =
        |model: &str, k| Geometries::of(find(model).unwrap(), &Choices::default(), &Extent::Bits(k)).unwrap().curves;
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
        let found = widths(find(model).unwrap(), &Choices::default(), &Extent::Bits(3)).unwrap();
        assert!(found.all && found.registers.iter().all(|register| register.known == Known::Exhaustive), "{model}");
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
        ("widths ppc-line --box 0", "1 to 16 bits"),
        ("widths ppc-line --box 9..0x0..9", "give 0..9"),
        ("widths ppc-line --box 0..9", "0..255x0..255"),
        ("widths ppc-line --box 0..9x0..9x0..9", "give --box 0..9x0..9\n"),
        ("widths ppc-arc --box 0..9x0..9x0..9", "give --box 0..9x0..9"),
        ("widths ppc-arc --box 1..2x5..6", "the box holds nothing"),
        ("widths ppc-arc --box 0..9999x0..9999", "0..2047x0..2047"),
        ("widths ppc-line --box 0..65536x0..9", "within ±65535"),
        ("widths dda-helix --box 0..4x0..4", "give --box 4"),
        ("widths ppc-line --box 4 --preset half", "does not take --preset"),
    ] {
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(hint) && ran.err.lines().count() == 1, "{words}: {ran:?}");
    }
}
