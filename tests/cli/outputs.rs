//! What goes to standard output, and what the outputs hold.

use serde_json::{Value, json};

use super::{Csv, Folder, Ran, good, refused};

#[test]
fn steps_to_standard_output_is_the_table_and_nothing_else() {
    let text = good("run ppc-line --to 2,1 --steps - --beats 1");
    let rows = ["step,clock,xe,ye,f,e,dx,dy,x,y", "0,1,2,1,0,3,0,0,0,0", "1,2,2,1,-1,2,1,0,1,0", "2,3,2,1,1,1,0,1,1,1"];
    assert_eq!(text, rows.join("\n") + "\n3,4,2,1,0,0,1,0,2,1\n");
}

#[test]
fn json_to_standard_output_is_the_report_and_nothing_else() {
    let report: Value = serde_json::from_str(&good("run ppc-line --to 6,4 --json -")).unwrap();
    let fields: Vec<&str> = report.as_object().unwrap().keys().map(String::as_str).collect();
    let expected = [
        "choices",
        "clocks",
        "end_point",
        "ending",
        "engine",
        "failures",
        "feed",
        "geometry",
        "model",
        "overflow",
        "path_error",
        "pulse_spacing",
        "pulses",
        "rate_deviation",
        "registers",
        "sampling",
        "schema",
        "steps",
        "warnings",
        "widths",
    ];
    assert_eq!(fields, expected);
    assert_eq!(report["schema"], 1);
    assert_eq!(report["model"], "ppc-line");
    assert_eq!(report["geometry"], json!({ "curve": "line", "from": [0, 0], "to": [6, 4] }));
    assert_eq!((&report["clocks"], &report["steps"]), (&json!(41), &json!(10)));
    assert_eq!(report["pulses"], json!({ "x": 6, "y": 4 }));
    assert_eq!(report["end_point"], json!({ "wanted": [6, 4], "reached": [6, 4], "exact": true }));
    assert_eq!(report["overflow"], json!({ "count": 0, "events": [], "components": [] }));
    assert_eq!((&report["ending"], &report["failures"]), (&json!("done"), &json!([])));
    let f = report["registers"].as_array().unwrap().iter().find(|register| register["name"] == "f").unwrap();
    let expected = json!({ "name": "f", "path": "ppc_line.f", "width": 4, "signed": true, "radix": 2,
                           "least": -4, "greatest": 4, "needed_width": 4, "stuck_bits": "---0", "limits": [] });
    assert_eq!(*f, expected);
    // After the first step the machine is at (1, 0): 4/sqrt(52) off the line.
    let error = &report["path_error"];
    assert!((error["greatest"].as_f64().unwrap() - 4.0 / 52f64.sqrt()).abs() < 1e-12, "{error}");
    assert_eq!((&error["step"], &error["position"], &error["within_bound"]), (&json!(1), &json!([1, 0]), &json!(true)));
    // X in the steps 1, 3, 5, 6, 8, 10 and Y in the others, of four clocks each.
    let spacing = json!({ "x": { "least": 4, "greatest": 8, "ideal": 40.0 / 6.0 },
                          "y": { "least": 8, "greatest": 12, "ideal": 10.0 } });
    assert_eq!(report["pulse_spacing"], spacing);
    let off = json!({ "greatest": 0.4, "step": 1 });
    assert_eq!(report["rate_deviation"], json!({ "axes": { "x": off, "y": off }, "bound": null }));
    // Ten steps of four clocks, from the first row to the last, are one window.
    let feed = &report["feed"];
    let [least, mean, greatest] = [&feed["least"]["value"], &feed["mean"], &feed["greatest"]["value"]];
    for speed in [least, mean, greatest].map(|speed| speed.as_f64().unwrap()) {
        assert!((speed - 52f64.sqrt() / 10.0).abs() < 1e-12, "{feed}");
    }
    assert_eq!((&feed["clocks"], &feed["step_clocks"], &feed["ripple"]), (&json!(40), &json!(4.0), &json!(0.0)));
    assert_eq!((&feed["least"]["step"], &feed["greatest"]["step"]), (&json!(10), &json!(10)));
}

#[test]
fn the_report_of_an_arc_gives_centre_direction_and_radius() {
    let report: Value =
        serde_json::from_str(&good("run dda-arc --from 15,10 --to 10,15 --center 10,10 --ccw --json -")).unwrap();
    let geometry = &report["geometry"];
    assert_eq!((&geometry["curve"], &geometry["center"]), (&json!("arc"), &json!([10, 10])));
    assert_eq!(report["rate_deviation"], Value::Null);
    assert_eq!(report["pulse_spacing"]["x"]["ideal"], Value::Null);
    assert_eq!((&geometry["radius"], &geometry["direction"]), (&json!(5.0), &json!("counter-clockwise")));
}

#[test]
fn each_output_alone_may_go_to_standard_output() {
    let begins = [("--vcd", "$version stepwave"), ("--steps", "step,clock,"), ("--json", "{\n"), ("--plot", "<svg ")];
    for (option, begin) in begins {
        let folder = Folder::new();
        let text = folder.good(&format!("run ppc-line --to 6,4 {option} -"));
        assert!(text.starts_with(begin), "{option}: {text}");
        assert!(!text.contains("reached exactly"), "{option}: the summary stands there too");
        assert_eq!(folder.files(), [""; 0], "{option}");
    }
}

#[test]
fn a_file_and_standard_output_hold_the_same() {
    let folder = Folder::new();
    let words = "run dda-arc --from 5,0 --to 0,5 --ccw";
    let printed = folder.good(&format!("{words} --vcd w.vcd --steps s.csv --json r.json --plot p.svg"));
    assert!(printed.contains("reached exactly"), "with files only, the summary is printed: {printed}");
    for (option, file) in [("--vcd", "w.vcd"), ("--steps", "s.csv"), ("--json", "r.json"), ("--plot", "p.svg")] {
        // Names of states lie next to a file, and are in comments of what goes through a pipe.
        let piped = good(&format!("{words} {option} -"));
        let lines = piped.split_inclusive('\n').filter(|line| !line.starts_with("$comment state "));
        assert_eq!(lines.collect::<String>(), folder.read(file), "{option}");
    }
}

#[test]
fn two_outputs_cannot_both_go_to_standard_output() {
    let options = ["--vcd -", "--steps -", "--json -", "--plot -"];
    for (index, first) in options.iter().enumerate() {
        for second in &options[index + 1..] {
            refused(&format!("run ppc-line --to 6,4 {first} {second}"), &["two outputs", "standard output"]);
        }
    }
}

#[test]
fn a_trapped_run_still_writes_its_outputs() {
    let folder = Folder::new();
    let ran = folder.run("run ppc-line --to 6,4 --width f=3 --vcd w.vcd --steps - --json r.json --plot p.svg");
    assert_eq!((ran.code, ran.err.lines().count()), (1, 1), "{ran:?}");
    assert_eq!(Csv::parse(&ran.out).rows.len(), 1 + 3);
    assert_eq!(folder.files(), ["p.svg", "r.json", "w.beat.states", "w.gtkw", "w.vcd"]);
    let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    assert_eq!(report["ending"], "trapped");
    assert!(folder.read("p.svg").contains("overflow of ppc_line.f"));
}

#[test]
fn the_plot_is_a_whole_svg_document_with_title_path_and_deviation() {
    for words in ["ppc-line --to 6,4", "dda-arc --from 5,0 --to 0,5 --ccw", "dda-line --to 8,6,3"] {
        let svg = good(&format!("run {words} --plot -"));
        assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") && svg.ends_with("</svg>\n"), "{svg}");
        assert!(svg.contains(&format!("<title>{}: ", words.split(' ').next().unwrap())), "{svg}");
        // Every element is closed, by a tag of its own or in itself.
        let tags = |mark: &str| svg.matches(mark).count();
        assert_eq!(tags("<"), tags(">"), "{words}");
        assert_eq!(tags("<") - 2 * tags("</"), tags("/>"), "{words}");
    }
}

#[test]
fn bits_shows_registers_in_binary_and_positions_in_decimal() {
    let text = good("run ppc-line --from -1,1 --to -4,2 --form signed --bits");
    let rows: Vec<&str> = text.lines().skip(2).take(2).collect();
    assert_eq!(rows, ["   0  101  001  000  100         -1  1", "   1  101  001  101  011     +Y  -1  2"]);
}

#[test]
fn sixty_four_steps_are_printed_and_one_more_is_a_hint() {
    let table = good("run ppc-line --to 32,32");
    assert!(table.lines().any(|line| line.starts_with("  64  ")) && !table.contains("--steps"), "{table}");
    let hint = good("run ppc-line --to 33,32");
    assert!(hint.starts_with("more than 64 steps: --steps FILE"), "{hint}");
    assert!(hint.contains("65 steps in") && !hint.contains("step  xe"), "{hint}");
}

#[test]
fn a_full_standard_output_is_named() {
    let folder = Folder::new();
    for words in ["list", "run ppc-line --to 6,4", "run ppc-line --to 6,4 --steps -", "run ppc-line --to 6,4 --json -"]
    {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let ran = Ran::new(folder.command().args(words.split(' ')).stdout(full).output().unwrap());
        assert_eq!(ran.code, 2, "{words}: {ran:?}");
        assert!(ran.err.starts_with("stepwave: cannot write standard output: "), "{words}: {ran:?}");
        assert_eq!(ran.err.lines().count(), 1, "{words}: {ran:?}");
    }
}

#[test]
fn numbers_of_a_report_are_numbers() {
    let report: Value =
        serde_json::from_str(&good("run sampled-line --to 30,20 --step 2.5 --fraction 9 --preset 3 --json -")).unwrap();
    let choices = &report["choices"];
    assert_eq!((&choices["step"], &choices["fraction"], &choices["preset"]), (&json!(2.5), &json!(9), &json!(3)));
    assert_eq!((&choices["system"], &choices["on_overflow"]), (&json!("7m"), &json!("trap")));
    let report: Value = serde_json::from_str(&good("run ppc-line --to 6,4 --json -")).unwrap();
    assert_eq!(report["choices"]["beats"], 4);
}

#[test]
fn the_files_of_the_viewer_that_is_asked_for_are_next_to_the_wave() {
    let folder = Folder::new();
    let words = "run ppc-line --to 6,4 --vcd w.vcd";
    let gtkwave = ["w.beat.states", "w.gtkw"];
    folder.good(&format!("{words} --viewer surfer"));
    assert_eq!(folder.files(), [".surfer", "w.sucl", "w.vcd"]);
    let commands = folder.read("w.sucl");
    assert!(
        commands
            .starts_with("# In the folder of this file: surfer --command-file w.sucl w.vcd\nvariable_add ppc_line.")
    );
    assert!(commands.contains("variable_add ppc_line.beat\nitem_set_format w.beat\n"), "{commands}");
    assert!(commands.ends_with("\nitem_unfocus\nzoom_fit\n"));
    let mapping = "Name = w.beat\nBits = 4\n0b0000 IDLE\n0b0001 JUDGE\n0b0010 FEED\n0b0100 COMPUTE\n0b1000 COMPARE\n";
    assert_eq!(folder.read(".surfer/mappings/w.beat"), mapping);
    // Every row of the command file is a variable of the wave.
    let wave = stepwave::trace::read::Wave::open(folder.path("w.vcd")).unwrap();
    let paths: Vec<&str> = wave.signals().iter().map(|signal| signal.path.as_str()).collect();
    let rows: Vec<&str> = commands.lines().filter_map(|line| line.strip_prefix("variable_add ")).collect();
    assert_eq!(rows.len(), paths.len());
    assert!(rows.iter().all(|row| paths.contains(row)), "{rows:?} {paths:?}");
    folder.good(&format!("{words} --viewer both"));
    assert_eq!(folder.files(), [".surfer", gtkwave[0], gtkwave[1], "w.sucl", "w.vcd"]);
    let plain = Folder::new();
    plain.good(words);
    assert_eq!(plain.files(), [gtkwave[0], gtkwave[1], "w.vcd"]);
    assert_eq!(plain.read("w.gtkw"), folder.read("w.gtkw"));
}

#[test]
fn a_viewer_without_a_wave_in_a_file_is_refused() {
    for words in ["--html w.html", "--vcd -"] {
        refused(
            &format!("run ppc-line --to 6,4 --viewer surfer {words}"),
            &["--viewer is about files next to a wave", "--vcd FILE"],
        );
    }
    refused("run ppc-line --to 6,4 --viewer surfer", &["--vcd"]);
}
