//! Every verdict against every geometry of few bits, simulated one box after another.

use std::collections::BTreeMap;

use rayon::prelude::*;
use stepwave::study::proof::{Narrower, choices_at};
use stepwave::testbench::{Ending, Testbench};
use stepwave_models::options::{ON_OVERFLOW, WIDTH};
use stepwave_models::{Claims, Hardware, Model, ModelError, Options, find};
use stepwave_netlist::{OnOverflow, Width};

use crate::cli::{Folder, Ran};

/// What all geometries of k bits show.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
struct Facts {
    overflow: bool,
    missed: bool,
    endless: bool,
}

fn facts(model: &'static Model, choices: &Options, k: u32, of: fn(Claims, &Hardware) -> Claims) -> Facts {
    let claims = model.claims.unwrap();
    let hardware = match model.plan(&claims.geometries.largest(k).unwrap(), choices) {
        Ok(hardware) => hardware,
        Err(ModelError::Widths(_)) => return Facts { overflow: true, missed: true, endless: true },
        Err(error) => panic!("{error}"),
    };
    let claims = of(claims, &hardware);
    let kinds = claims.geometries.kinds();
    let mut curves = claims.geometries.curves(k, usize::MAX);
    curves.retain(|curve| kinds.iter().any(|kind| claims.geometries.symbols(kind, curve).is_some()));
    assert!(claims.geometries.is_whole(k) && curves.len() > 6);
    let mut facts = Facts::default();
    let bench = Testbench::of_hardware(model, hardware).unwrap();
    for (curve, outcome) in curves.iter().zip(bench.run_many(&curves, 1 << 20).unwrap()) {
        let Ok(outcome) = outcome else {
            // The hardware does not take it, so that it neither ends nor is reached.
            return Facts { overflow: true, missed: true, endless: true };
        };
        facts.overflow |= outcome.overflows > 0;
        facts.endless |= outcome.ending != Some(Ending::Done);
        facts.missed |= outcome.reached != curve.to();
    }
    facts
}

fn assert_true(ran: &Ran, facts: Facts, what: &str) {
    let proved = |claim: &str| {
        let line = |line: &&str| line.starts_with("PROVED") && line.contains(claim);
        ran.out.lines().any(|own| line(&own))
    };
    assert!(!(proved("no register overflows") && facts.overflow), "{what}: {facts:?} {ran:?}");
    assert!(!(proved("reached exactly") && facts.missed), "{what}: {facts:?} {ran:?}");
    assert!(!(proved("every block ends") && facts.endless), "{what}: {facts:?} {ran:?}");
}

const MODELS: [(&str, &[&str]); 8] = [
    ("ppc-line", &["f", "x"]),
    ("cim-line", &["f"]),
    ("mindev-line", &["e"]),
    ("bresenham", &["cnt"]),
    ("dda-line", &["x"]),
    ("ppc-arc", &["x"]),
    ("mindev-arc", &["f", "e"]),
    ("vector-arc", &["f", "e"]),
];
const MODES: [(&str, OnOverflow); 3] =
    [("trap", OnOverflow::Trap), ("wrap", OnOverflow::Wrap), ("saturate", OnOverflow::Saturate)];

fn cases() -> Vec<(&'static str, &'static str, (&'static str, OnOverflow))> {
    let registers = MODELS.iter().flat_map(|(model, registers)| registers.iter().map(move |name| (*model, *name)));
    registers.flat_map(|(model, register)| MODES.map(|mode| (model, register, mode))).collect()
}

/// The names with a width of their own: one, or one for each axis.
fn known(model: &'static Model, register: &str) -> bool {
    let plan = model.plan(&model.claims.unwrap().geometries.largest(4).unwrap(), &Options::default()).unwrap();
    plan.widths.keys().any(|name| *name == register || name.trim_end_matches(['x', 'y']) == register)
}

#[test]
#[ignore = "exhaustive"]
fn what_is_proved_of_narrower_registers_is_true_of_every_geometry() {
    let (proved, refuted): (Vec<bool>, Vec<bool>) = cases()
        .into_par_iter()
        .filter(|(model, register, _)| known(find(model).unwrap(), register))
        .map(|(name, register, (mode, on_overflow))| {
            let bits = 1;
            let words = format!("prove {name} --narrower {register}={bits} --on-overflow {mode}");
            let ran = Folder::new().run(&words);
            let model = find(name).unwrap();
            let choices = Options::default().with(&ON_OVERFLOW, on_overflow);
            let narrower = Narrower::from([(register.to_owned(), bits)]);
            for k in 3..=4 {
                let own = choices_at(model, &model.claims.unwrap(), &choices, &narrower, k).unwrap();
                assert_true(&ran, facts(model, &own, k, Claims::for_every_k), &words);
            }
            (ran.out.contains("PROVED"), ran.out.contains("COUNTEREXAMPLE"))
        })
        .unzip();
    let count = |all: &[bool]| all.iter().filter(|is| **is).count();
    assert!(count(&proved) + count(&refuted) > 15 && count(&refuted) > 5, "{} {}", count(&proved), count(&refuted));
}

#[test]
#[ignore = "exhaustive"]
fn a_verdict_on_one_hardware_is_what_every_geometry_of_its_box_shows() {
    let verdicts: Vec<bool> = cases()
        .into_par_iter()
        .filter(|(model, register, _)| known(find(model).unwrap(), register))
        .flat_map_iter(|(model, register, mode)| [-1, 0, 1].map(move |more| (model, register, mode, more)))
        .filter_map(|(name, register, (mode, on_overflow), more)| {
            let (model, k) = (find(name).unwrap(), 4);
            let choices = Options::default().with(&ON_OVERFLOW, on_overflow).with_all(&WIDTH, Width::new(4).ok());
            let plan = model.plan(&model.claims.unwrap().geometries.largest(k).unwrap(), &choices).unwrap();
            let own =
                plan.widths.iter().find(|(own, _)| own.trim_end_matches(['x', 'y']) == register || **own == register);
            let bits = own?.1.get().checked_add_signed(more)?;
            let width = Width::new(u64::from(bits)).ok()?;
            let widths: BTreeMap<String, Width> = [(register.to_owned(), width)].into();
            let words = format!("prove {name} --width {k},{register}={bits} --on-overflow {mode}");
            let ran = Folder::new().run(&words);
            if ran.code == 2 {
                // Registers that must be as wide as others, or ordered.
                assert!(
                    model.plan(&model.claims?.geometries.largest(k)?, &choices.with_single(&WIDTH, widths)).is_err(),
                    "{words}: {ran:?}"
                );
                return None;
            }
            let facts = facts(model, &choices.with_single(&WIDTH, widths), k, Claims::of_hardware);
            assert_true(&ran, facts, &words);
            // All is proved, or refuted by a run: of so few geometries nothing is left open.
            assert_eq!(ran.code == 0, facts == Facts::default(), "{words}: {facts:?} {ran:?}");
            assert_eq!(ran.out.contains("COUNTEREXAMPLE"), ran.code == 1, "{words}: {ran:?}");
            Some(ran.code == 0)
        })
        .collect();
    let good = verdicts.iter().filter(|is| **is).count();
    assert!(good > 20 && verdicts.len() - good > 8, "{good} of {}", verdicts.len());
}
