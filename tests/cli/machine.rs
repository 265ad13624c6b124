//! `stepwave machine`: what it says of every method is what single runs come to.

use std::sync::LazyLock;

use serde_json::Value;

use super::{Folder, good, refused};

pub(super) const SMALL: &str = "machine --travel 0.02mm,0.015mm --blu 1um --feed 30mm/min";

/// What `SMALL` reports of every method, run once for all tests.
pub(super) static ALL: LazyLock<Value> = LazyLock::new(|| json(&format!("{SMALL} --json")));

fn json(words: &str) -> Value {
    serde_json::from_str(&good(words)).unwrap()
}

/// A run by the words of a command that the report names.
fn repeated(command: &Value) -> Value {
    json(&format!("{} --json -", command.as_str().unwrap().strip_prefix("stepwave ").unwrap()))
}

#[test]
fn corners_and_clocks_are_those_of_single_runs() {
    let all = &*ALL;
    assert_eq!((all["travel"].clone(), all["left_out"].clone()), (serde_json::json!([20, 15]), serde_json::json!([])));
    let machines = all["machines"].as_array().unwrap();
    assert!(machines.len() >= 15, "{}", machines.len());
    for machine in machines {
        let name = machine["model"].as_str().unwrap();
        let (mut slowest, mut worst): (f64, f64) = (f64::MAX, 0.0);
        for corner in machine["corners"].as_array().unwrap() {
            let ran = repeated(&corner["run"]);

            let (clocks, error) = (ran["clocks"].as_u64().unwrap() - 1, &ran["path_error"]["greatest"]);
            assert_eq!((&corner["clocks"], &corner["path_error"]), (&Value::from(clocks), error), "{name} {corner}");
            assert_eq!(corner["done"], true, "{name} {corner}");
            slowest = slowest.min(corner["length"].as_f64().unwrap() / clocks as f64);
            worst = worst.max(error.as_f64().unwrap());
        }
        assert_eq!(machine["path_error"]["greatest"].as_f64(), Some(worst), "{name}");
        // 30 mm/min are 500 BLU/s.
        let clock = machine["clock_hz"].as_f64().unwrap();
        if name.starts_with("sampled") {
            assert_eq!(clock, 1e6, "{name}");
        } else {
            assert!((clock * slowest - 500.0).abs() < 1e-6, "{name}: {clock} Hz, {slowest} BLU a clock");
            assert!((machine["feed"]["least"].as_f64().unwrap() - 30.0).abs() < 1e-6, "{name}");
        }
    }
}

#[test]
fn one_bit_below_fails_as_it_says() {
    let all = &*ALL;
    let mut failed = 0;
    for machine in all["machines"].as_array().unwrap() {
        for register in machine["registers"].as_array().unwrap() {
            let Some(command) = register["one_bit_below"].as_str() else { continue };
            let ran = Folder::new().run(command.strip_prefix("stepwave ").unwrap());
            assert!(ran.code > 0, "{command}: {ran:?}");
            failed += 1;
        }
    }
    assert!(failed > 80, "{failed}");
}

#[test]
fn registers_of_one_scale_are_listed_as_wide_as_they_are_built() {
    // The rates of both axes are as wide as the counter, however short an axis is.
    let all = json("machine dpm-line --travel 20um,7um --blu 1um --feed 30mm/min --json");
    let machine = &all["machines"][0];
    let ran = repeated(&machine["corners"][0]["run"]);
    for name in ["mx", "my", "q"] {
        let of = |registers: &Value| {
            registers.as_array().unwrap().iter().find(|register| register["name"] == name).unwrap().clone()
        };
        assert_eq!(of(&machine["registers"])["needed"], of(&ran["registers"])["width"], "{name}");
    }
}

#[test]
fn a_machine_of_three_axes_has_the_methods_of_lines_in_space() {
    let all = json("machine ppc-line dda-line bresenham --travel 20um,15um,9um --blu 0.001mm --feed 10mm/s --json");
    for machine in all["machines"].as_array().unwrap() {
        let name = machine["model"].as_str().unwrap();
        for corner in machine["corners"].as_array().unwrap() {
            let ran = repeated(&corner["run"]);
            assert_eq!(ran["clocks"].as_u64().unwrap() - 1, corner["clocks"].as_u64().unwrap(), "{name}");
        }
        assert!(machine["registers"].as_array().unwrap().iter().all(|own| own["known"] == "sampled"), "{name}");
    }
    assert_eq!(all["feed"], 600.0);
}

#[test]
fn a_machine_holds_every_line_of_its_travel() {
    let all = json("machine mindev-line ppc-line cim-line --travel 2mm,3mm,1mm --blu 1mm --feed 1 --json");
    for machine in all["machines"].as_array().unwrap() {
        let registers = machine["registers"].as_array().unwrap();
        let width = |own: &Value| format!("{}={}", own["name"].as_str().unwrap(), own["needed"]);
        let widths = registers.iter().map(width).collect::<Vec<_>>().join(",");
        let name = machine["model"].as_str().unwrap();
        let swept = good(&format!("sweep {name} --to-grid -2..2x-3..3x-1..1 --width {widths} --csv -"));
        let bad = swept.lines().skip(1).filter(|row| !row.contains("done")).count();
        assert_eq!((swept.lines().count(), bad), (5 * 7 * 3 + 1, 1), "{name}: {swept}");
    }
}

/// 2^27 iterations, of which runs are given up after half.
#[test]
#[ignore = "exhaustive"]
fn a_machine_whose_runs_are_given_up_claims_neither_clock_nor_feed() {
    let all = json("machine dda-line --travel 100000mm,1mm --blu 1um --feed 600 --json");
    let machine = &all["machines"][0];
    assert!(machine["corners"].as_array().unwrap().iter().any(|corner| corner["done"] == false), "{machine}");
    for field in ["clock_hz", "feed"] {
        assert!(machine[field].is_null() || machine[field]["least"].is_null(), "{}", machine[field]);
    }
}

#[test]
fn tables_name_every_method_and_register() {
    let text = good(&format!("{SMALL} ppc-line mindev-arc"));
    assert!(text.starts_with("travel ±20, ±15 BLU of 0.001 mm, feed 30 mm/min\n"), "{text}");
    assert!(text.contains("\nppc-line\n") && text.contains("--width 5,f=5"), "{text}");
    let markdown = good(&format!("{SMALL} ppc-line mindev-arc --markdown"));
    assert!(
        markdown.contains("| method | registers, bits | bits of all | clock |") && markdown.contains("### mindev-arc"),
        "{markdown}"
    );
}

#[test]
fn what_is_no_machine_is_refused() {
    let with = |more: &str| format!("machine --feed 600 --travel {more}");
    refused(&with("300mm"), &["one axis", "two or three", "300mm,200mm"]);
    refused(&with("1mm,1mm,1mm,1mm"), &["4 axes", "two or three"]);
    refused(&with("0mm,200mm"), &["0mm", "300mm,200mm"]);
    refused(&with("-3,200"), &["-3"]);
    refused(&with("3parsec,200mm"), &["3parsec"]);
    refused(&with("1mm,1mm --blu 1e-30mm"), &["BLU", "2^52", "--blu"]);
    refused(&with("1mm,1mm dda-conic"), &["dda-conic", "leave it out"]);
    refused(&with("1mm,1mm ppc-machine"), &["ppc-machine", "leave it out"]);
    refused("machine --travel 1mm,1mm --feed fast", &["fast", "2400mm/min"]);
    refused("machine --travel 1mm,1mm", &["--feed"]);
    refused("machine --travel 1mm,1mm --feed 1e300", &["1e-6 to 1e9"]);
    refused(&with("1mm,1mm --clock-hz 0"), &["--clock-hz 0", "1e6"]);
    refused("machine sampled-arc --travel 0.1mm,0.1mm --feed 2400", &["no method", "sampled-arc", "radius 100.000"]);
}

/// The least whole number of pulses and the ticks of a ramp between two speeds, in BLU and seconds.
fn ramp(start: f64, feed: f64, gain: f64, jerk: Option<f64>) -> [f64; 2] {
    let difference = feed - start;
    let seconds = match jerk {
        None => difference / gain,
        Some(jerk) if difference >= gain * gain / jerk => difference / gain + gain / jerk,
        Some(jerk) => 2.0 * (difference / jerk).sqrt(),
    };
    [seconds, seconds * (start + feed) / 2.0]
}

#[test]
fn ramps_are_those_of_programs_and_of_the_data_sheets() {
    let size = "machine dda-line bresenham mindev-line ppc-arc vector-line --travel 4mm,3mm --blu 10um";
    for (jerk, name) in [(None, ""), (Some(20_000.0 * 100.0), " --jerk 20000mm/s3")] {
        let accel = if jerk.is_some() { "500mm/s2" } else { "500mm/s2,800mm/s2" };
        let all = json(&format!("{size} --feed 1200mm/min --accel {accel}{name} --clock-hz 2e5 --json"));
        for machine in all["machines"].as_array().unwrap() {
            let (model, ramp_of) = (machine["model"].as_str().unwrap(), &machine["ramp"]);
            assert_eq!(ramp_of.is_null(), model.starts_with("vector"), "{machine}");
            if ramp_of.is_null() {
                continue;
            }
            // The same program by itself.
            let folder = Folder::new();
            folder.write("move.ngc", ramp_of["program"].as_str().unwrap());
            let command =
                ramp_of["run"].as_str().unwrap().strip_prefix("stepwave ").unwrap().replace("FILE", "move.ngc");
            let ran: Value = serde_json::from_str(&folder.good(&format!("{command} --json -"))).unwrap();
            assert_eq!(ran["blocks"][0]["clocks"], ramp_of["clocks"], "{model} {}", ran["blocks"][0]);
            // Registers as that program has them.
            let verilog = folder.good(&format!("export --{} --verilog -", command.replace("move.ngc", "move.ngc ")));
            let (_, source) = verilog.split_once("begin : pulse_source\n").unwrap();
            let registers = ramp_of["registers"].as_array().unwrap();
            assert_eq!(registers.len(), if jerk.is_some() { 7 } else { 4 }, "{registers:?}");
            for own in registers {
                let bits = own["bits"].as_u64().unwrap();
                let declared = format!("reg [{}:0] {};\n", bits - 1, own["name"].as_str().unwrap());
                assert!(source.contains(&declared), "{model} {declared}");
            }
            // Pulses of the source set the ramp: a BLU each along an axis, or along the path.
            let feed = ramp_of["feed"].as_f64().unwrap() / 60.0 / 0.01;
            let source = if model.starts_with("dda") || model == "bresenham" { feed } else { 2000.0 };
            let down = if jerk.is_some() { 50_000.0 } else { 80_000.0 };
            let start = f64::sqrt(down);
            assert!((feed / 2000.0 - 1.0).abs() < 0.005 || source == 2000.0, "{model}: {feed}");
            let share = feed / source;
            for (part, gain) in [("up", 50_000.0), ("down", down)] {
                let wanted = ramp(start, source, gain, jerk);
                let seconds = ramp_of[part]["seconds"].as_f64().unwrap();
                let length = ramp_of[part]["mm"].as_f64().unwrap() / 0.01;
                // Some pulses at the start speed, and what the count of pulses of an arc is off.
                let pulses = if model.ends_with("arc") { 6.0 } else { 3.0 };
                let near = |seen: f64, wanted: f64, off: f64| (seen - wanted).abs() < 0.01 * wanted + off;
                assert!(near(seconds, wanted[0], pulses / start), "{model} {part} {seconds} {wanted:?}");
                // Along an arc by pulses the share is that of the direction.
                let length_is_known = model != "ppc-arc";
                assert!(
                    !length_is_known || near(length, wanted[1] * share, pulses),
                    "{model} {part} {length} {wanted:?}"
                );
            }
        }
        let few = "machine mindev-line vector-line --travel 4mm,3mm --blu 10um";
        let text = good(&format!("{few} --feed 1200mm/min --accel 500mm/s2{name} --clock-hz 2e5"));
        let heading =
            format!("one move across the travel by `stepwave program --accel 500mm/s2{name}` at 200.000 kHz\n");
        assert!(text.contains(&heading), "{text}");
    }
}
