//! Ramps of one axis: what is proved whatever speeds are loaded and whatever the operator does, boxes and their widths.

use std::collections::BTreeMap;

use proptest::prelude::*;
use stepwave::study::Extent;
use stepwave::study::widths::widths;
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_models::{Options, find};
use stepwave_nc::{Curve, Line};

use crate::cli::Folder;

const EVERY: &str = "whatever is loaded into a, d, phase, v, vc, ve, vs, whatever hold and trim are at any clock";

#[test]
fn no_register_of_a_ramp_overflows_whatever_is_loaded_and_whatever_the_operator_does() {
    let folder = Folder::new();
    for (words, ks) in [
        ("", "3 to 49"),
        ("--width 12", "6 to 45"),
        ("--brake count", "3 to 49"),
        // From k = 20 on the square of what is left is wider than that of the speed.
        ("--accel 500mm/s2 --speed 2400mm/min", "3 to 19"),
    ] {
        let out = folder.good(&format!("prove ramp {words}"));
        assert!(out.contains(EVERY), "{out}");
        assert!(out.contains(&format!("PROVED for k = {ks}: no register overflows\n")), "{out}");
        let exact = format!("PROVED for k = {ks}: the end point is reached exactly by every block that ends\n");
        assert!(out.contains(&exact) && out.contains("not claimed: every block ends\n"), "{out}");
    }
    // The same of a wide box, whose hardware is of another family.
    let out = folder.good("prove ramp --accel 500mm/s2 --speed 2400mm/min --box 30");
    assert!(out.contains("PROVED at these widths: no register overflows\n"), "{out}");
}

#[test]
fn a_box_of_a_ramp_is_simulated_to_its_ends() {
    let folder = Folder::new();
    for words in ["--travel 40", "--box -3..30", "--box 5 --jerk 4 --accel 12", "--box 5 --brake count"] {
        let out = folder.good(&format!("prove ramp {words}"));
        for claim in ["no register overflows", "the end point is reached exactly", "every block ends"] {
            assert!(out.lines().any(|line| line.starts_with("PROVED") && line.ends_with(claim)), "{words}: {out}");
        }
    }
    // One travel, and not all of 5 bits, in the certificate too.
    let out = folder.good("prove ramp --box 5..5 --certificate one.cert");
    assert!(
        out.starts_with("ramp --box 5..5: every travel of one axis from the origin to a coordinate within 5..5\n"),
        "{out}"
    );
    assert!(folder.good("prove check one.cert").starts_with("ramp --box 5..5: "));
    // 2 · 63 travels of 6 bits.
    assert!(folder.good("prove ramp --box 6").contains("(exhausted: 126 geometries)"));
}

#[test]
fn a_register_that_is_too_narrow_is_refuted_by_a_run_that_shows_it() {
    let folder = Folder::new();
    for (words, run) in [
        ("--narrower e=1", "stepwave run ramp --to 2 --width e=1"),
        ("--narrower x=2", "stepwave run ramp --to 1 --width x=1"),
        ("--width 8,e=5 --box 6", "stepwave run ramp --to 32 --width 8,e=5"),
        ("--width e=4", "stepwave run ramp --to 16 --width e=4"),
    ] {
        let ran = folder.run(&format!("prove ramp {words}"));
        assert!(ran.code == 1 && ran.out.contains(&format!(": {run}\n")), "{words}: {ran:?}");
        assert_eq!(
            folder.run(run.strip_prefix("stepwave ").unwrap()).code,
            2 - i32::from(run.contains("x=1")),
            "{run}"
        );
    }
}

#[test]
fn the_limits_of_the_speed_are_as_wide_as_v_and_no_other_width_is_taken() {
    let folder = Folder::new();
    for words in ["prove ramp --narrower vc=7", "prove ramp --width vs=3 --box 4", "widths ramp --box 4 --width ve=2"] {
        let ran = folder.run(words);
        assert!(
            ran.code == 2 && ran.err.contains("no register") && ran.err.contains("did you mean 'v'"),
            "{words}: {ran:?}"
        );
    }
    let ran = folder.run("run ramp --to 12 --width vs=3");
    assert!(ran.code == 2 && ran.err.contains("no register 'vs' here for --width"), "{ran:?}");
    let ran = folder.run("run ramp --to 12 --width v=7");
    assert!(
        ran.code == 2
            && ran.err.contains("vc = 144 does not fit in its 7 bits; 8 bits would hold it: give --width v=8"),
        "{ran:?}"
    );
    folder.good("run ramp --to 12 --width v=8");
    let ran = folder.run("run ramp --to 12 --jerk 4 --width k=1");
    assert!(ran.code == 2 && ran.err.contains("give --width k=3"), "{ran:?}");
}

#[test]
fn the_least_widths_of_a_box_hold_in_every_run_of_it_all_at_once_and_one_bit_less_does_not() {
    let folder = Folder::new();
    for (name, words, register, k) in [
        ("ramp-after", "--smooth exp=1 --step 3", "acc", 5),
        ("ramp-after", "--smooth exp=2 --step 35", "acc", 6),
        ("ramp-after", "--smooth exp=3 --step 10", "acc", 6),
        ("ramp-after", "--smooth sum=5 --step 7", "s", 5),
        // v holds the limits too, which these short travels do not come to.
        ("ramp", "--speed vs=33,vc=434,ve=33 --accel 32", "v", 2),
        ("ramp", "--speed vs=10,vc=71,ve=10 --accel 3 --jerk 1", "v", 3),
        ("ramp", "--speed vs=9,vc=41,ve=9 --accel 33 --brake count --preset 3", "v", 2),
    ] {
        let model = find(name).unwrap();
        let options = Options::parse(words.split_whitespace()).unwrap();
        let found = widths(model, &options, &Extent::Bits(k), &|_| {}).unwrap();
        let least: Vec<String> = found.registers.iter().map(|own| format!("{}={}", own.name, own.needed)).collect();
        let least = least.join(",");
        for to in (1 - (1 << k)..1 << k).filter(|to: &i64| *to != 0) {
            folder.good(&format!("run {name} --to {to} {words} --width {least} -q"));
        }
        let own = found.registers.iter().find(|own| own.name == register).unwrap();
        let to = own.witness.as_ref().unwrap().curve.to()[0];
        let ran = folder.run(&format!("run {name} --to {to} {words} --width {register}={}", own.needed - 1));
        assert!(ran.code != 0 && ran.err.contains("bits would hold it"), "{name} {words}: {ran:?}");
    }
}

#[test]
fn what_has_no_proof_says_so() {
    let folder = Folder::new();
    let ran = folder.run("prove ramp --jerk 4 --accel 12");
    assert!(
        ran.code == 2
            && ran.err.contains(
                "is not a polynomial of its geometry, so that nothing can be concluded from it for every k: give a box"
            ),
        "{ran:?}"
    );
    let ran = folder.run("prove ramp --jerk 4 --accel 12 --box 14");
    assert!(
        ran.code == 1 && ran.out.contains("UNKNOWN: ") && ran.err.contains("no counterexample was found"),
        "{ran:?}"
    );
    for model in ["ramp", "ppc-line"] {
        let ran = folder.run(&format!("prove {model} --any-preset"));
        assert!(ran.code == 2 && ran.err.contains("has no remainder to preset: leave --any-preset out"), "{ran:?}");
    }
    let ran = folder.run("prove ramp --brake count --narrower r=1");
    assert!(ran.code == 2 && ran.err.contains("is another circuit at each number of bits"), "{ran:?}");
    let ran = folder.run("prove ramp --travel 100,5");
    assert!(
        ran.code == 2 && ran.err.contains("a box of 2 axes is not proved: give one range, such as 0..9"),
        "{ran:?}"
    );
}

#[test]
fn the_widths_of_a_box_are_those_that_runs_of_all_of_it_need() {
    for (words, k) in [("", 5), ("--accel 12 --jerk 4", 5), ("--brake count --accel 9 --speed 100", 5)] {
        let options = Options::parse(words.split_whitespace()).unwrap();
        let model = find("ramp").unwrap();
        let found = widths(model, &options, &Extent::Bits(k), &|_| {}).unwrap();
        assert!(found.all && found.simulated == 2 * ((1 << k) - 1) && found.faults == 0, "{words}: {found:?}");
        // What single runs report, each by hardware planned for itself.
        let mut needed: BTreeMap<String, u32> = BTreeMap::new();
        let folder = Folder::new();
        for to in (1 - (1 << k)..1 << k).filter(|to: &i64| *to != 0) {
            let json = folder.good(&format!("run ramp --to {to} {words} --json -"));
            let report: serde_json::Value = serde_json::from_str(&json).unwrap();
            for register in report["registers"].as_array().unwrap() {
                let bits = u32::try_from(register["needed_width"].as_u64().unwrap()).unwrap();
                let own = needed.entry(register["name"].as_str().unwrap().to_owned()).or_default();
                *own = (*own).max(bits);
            }
        }
        for register in &found.registers {
            assert_eq!(needed[&register.name], register.needed, "{words}: {}", register.name);
        }
    }
}

proptest! {
    #[test]
    fn any_words_and_any_events_do_what_is_proved(
        to in prop_oneof![-40i64..0, 1i64..40],
        count in any::<bool>(),
        seed in any::<[u64; 8]>(),
        events in prop::collection::vec((any::<bool>(), any::<u64>()), 64),
    ) {
        let model = find("ramp").unwrap();
        let choices = Options::parse(if count { vec!["--brake", "count"] } else { vec![] }).unwrap();
        let curve = Curve::Line(Line::new(vec![0], vec![to]).unwrap());
        let hardware = model.plan(&curve, &choices).unwrap();
        let machine = model.machine(&hardware).unwrap();
        let netlist = machine.design.netlist();
        let input = |name: &str| netlist.find(name).unwrap().net;
        let mut engine = EngineKind::Word.build(&machine.design, &Watch::default());
        let mut samples = Rows::new(0, 0);
        let own = machine.encode(&hardware, &model.words(&hardware, &curve).unwrap()).unwrap().remove(0);
        own.iter().for_each(|(net, word)| engine.set_input(*net, *word));
        for (name, word) in ["a", "d", "phase", "v", "vc", "ve", "vs"].into_iter().zip(seed) {
            let net = input(&format!("{name}_in"));
            engine.set_input(net, word & netlist.width(net).mask());
        }
        let strobes = [machine.load.net, machine.preset_position.net];
        strobes.iter().for_each(|strobe| engine.set_input(*strobe, 1));
        engine.reset(&mut samples);
        strobes.iter().for_each(|strobe| engine.set_input(*strobe, 0));
        let (hold, trim) = (input("hold"), input("trim"));
        for clock in 0..2000 {
            let (held, share) = events[clock % events.len()];
            engine.set_input(hold, u64::from(held));
            engine.set_input(trim, share & netlist.width(trim).mask());
            engine.run(1, &mut samples);
            for property in &netlist.properties {
                prop_assert_eq!(engine.value(property.never), 0, "{} at clock {}", property.name, clock);
            }
            if engine.value(machine.done.net) == 1 {
                let x = &machine.positions[0];
                prop_assert_eq!(stepwave_netlist::bits::to_signed(x.width, engine.value(x.net)), to);
                return Ok(());
            }
        }
    }
}
