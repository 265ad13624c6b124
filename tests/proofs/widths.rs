//! Least widths: the table of the methods, and agreement with single runs.

use std::collections::BTreeMap;

use rayon::prelude::*;
use stepwave::study::widths::{Known, Widths, widths};
use stepwave::testbench::{Ending, RangeWatch, Testbench};
use stepwave_kernel::Width;
use stepwave_kernel::engine::EngineKind;
use stepwave_models::{Choices, CurveKind, Region, Weights, catalogue, find};

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
        let found = widths(find(model).unwrap(), &choices, k).unwrap();
        assert!(found.all && found.faults == 0 && found.simulated > 1000, "{model}: {found:?}");
        let own = needed(&found, k);
        for (register, bits) in rows {
            assert_eq!(own[register], bits, "{model}: {register}");
        }
        let proved = found.registers.iter().all(|register| register.known == Known::Proved);
        assert_eq!(proved, choices.weights.is_none(), "{model}");
        // Every deviation has a geometry that stops it one bit below.
        let f = found.registers.iter().find(|register| register.name == "f");
        assert!(f.is_none_or(|f| f.witness.is_some()), "{model}");
    }
}

#[test]
fn lanes_and_single_runs_see_the_same_ranges() {
    let k = 3;
    for model in catalogue() {
        let region = match model.curve {
            CurveKind::Line { .. } => Region::Lines,
            CurveKind::Arc => Region::QuadrantArcs,
            _ => continue,
        };
        let found = widths(model, &Choices::default(), k).unwrap();
        let wide = Choices { width: Width::new(u64::from(k)).ok(), ..Choices::default() };
        let hardware = model.plan(&region.largest(k).unwrap(), &wide).unwrap();
        let bench = Testbench::of_hardware(model, hardware).unwrap();
        let kinds = region.kinds();
        let mut curves = region.curves(k, usize::MAX);
        curves.retain(|curve| kinds.iter().any(|kind| region.symbols(kind, curve).is_some()));
        assert_eq!(curves.len(), found.simulated, "{}", model.name);
        let ranges = curves.par_iter().map(|curve| {
            let bench = bench.of(model, curve).unwrap();
            let mut watch = RangeWatch::new(&bench);
            let outcome = bench.run(EngineKind::Word, &mut [&mut watch]).unwrap();
            let ranges = watch.finish().into_iter().map(|range| (range.name, (range.least, range.greatest)));
            if outcome.ending == Ending::Done { ranges.collect() } else { BTreeMap::new() }
        });
        let all = ranges.reduce(BTreeMap::new, |mut all, one| {
            for (name, (least, greatest)) in one {
                let own = all.entry(name).or_insert((least, greatest));
                *own = (own.0.min(least), own.1.max(greatest));
            }
            all
        });
        for register in &found.registers {
            assert_eq!(all[&register.name], register.range, "{}: {}", model.name, register.name);
        }
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
        ("widths ppc-line --box 0", "1..=16"),
        ("widths dda-helix --box 4", "no box of geometries"),
        ("widths ppc-line --box 4 --preset half", "does not take --preset"),
    ] {
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(hint) && ran.err.lines().count() == 1, "{words}: {ran:?}");
    }
}
