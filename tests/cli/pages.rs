//! `list`, `--help`, completions and manual pages tell everything there is.

use std::collections::BTreeSet;

use serde_json::Value;

use super::{Folder, engines, good};

const COMMANDS: [&str; 11] =
    ["list", "run", "sweep", "compare", "widths", "prove", "diff", "export", "golden", "completions", "man"];

const RUN_OPTIONS: &str = "--from --to --center --cw --ccw --width --preset --normalize --end-point --form --compare \
    --pick-off --timing --beats --on-overflow --clock-hz --blu --engine --vcd --trace --trace-exclude --trace-depth \
    --trace-from --trace-to --trace-on --no-clk --steps --json --plot --bits --help";

/// The options that a text speaks of.
fn options(text: &str) -> BTreeSet<String> {
    let text = text.replace("\\-", "-");
    let words = text.split(|c: char| !(c.is_ascii_lowercase() || c == '-'));
    words.filter(|word| word.starts_with("--") && word.len() > 3).map(str::to_owned).collect()
}

#[test]
fn the_help_of_run_mentions_every_option() {
    let expected: BTreeSet<String> = RUN_OPTIONS.split_whitespace().map(str::to_owned).collect();
    let missing: Vec<_> = expected.difference(&options(&good("run --help"))).cloned().collect();
    assert_eq!(missing, [""; 0]);
}

#[test]
fn the_help_of_run_gives_the_values_of_every_list() {
    let help = good("run --help").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(engines().chain(["auto"]).all(|engine| help.contains(engine)), "{help}");
    for values in ["total, per-axis, longest, iterations", "magnitude, signed, bare", "4, 1", "trap, saturate, wrap"] {
        assert!(help.contains(&format!("[possible values: {values}]")), "{values}: {help}");
    }
}

#[test]
fn the_help_mentions_every_command_and_the_exit_codes() {
    let help = good("--help");
    for command in COMMANDS {
        assert!(help.lines().any(|line| line.trim_start().starts_with(&format!("{command} "))), "{command}: {help}");
        let own = good(&format!("{command} --help"));
        assert!(own.contains(&format!("Usage: stepwave {command}")), "{own}");
        assert_eq!(good(&format!("help {command}")), own);
    }
    assert!(help.contains("0 done and good; 1 the simulated hardware failed a check"), "{help}");
    assert_eq!(good("help"), help);
}

#[test]
fn the_help_of_a_command_begins_with_the_line_that_lists_it() {
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let all = words(&good("--help"));
    for command in [
        "list", "run", "program", "sweep", "compare", "widths", "machine", "prove", "diff", "show", "export", "import",
        "check", "sim",
    ] {
        let help = good(&format!("{command} --help"));
        let title = words(help.split("\n\n").next().unwrap());
        assert!(all.contains(&format!(" {command} {title} ")), "{command}: {title}");
    }
}

#[test]
fn the_help_with_a_model_has_the_options_that_it_takes_and_no_others() {
    for model in stepwave_models::catalogue().iter() {
        for command in ["run", "export", "widths", "prove", "sweep"] {
            let help = good(&format!("{command} {} --help", model.name));
            let begin = format!("{}\n\nIt takes {}.", model.title, model.curve().describe());
            assert!(
                help.split_whitespace().collect::<Vec<_>>().join(" ").starts_with(&begin.replace("\n\n", " ")),
                "{help}"
            );
            let lines = help.lines().filter_map(|line| line.strip_prefix("      --").or(line.strip_prefix("  -w, --")));
            let shown: BTreeSet<&str> = lines.filter_map(|line| line.split_whitespace().next()).collect();
            for option in stepwave_models::options::all() {
                // The sweep has a tolerance of its own for every model.
                if (command, option.name()) != ("sweep", "tolerance") {
                    assert_eq!(
                        shown.contains(option.name()),
                        model.options.iter().any(|taken| taken.name() == option.name()),
                        "{command} {} --{}",
                        model.name,
                        option.name()
                    );
                }
            }
        }
    }
    let help = good("run --to 8,6 dda-line -h");
    assert!(
        help.contains("Usage: stepwave run dda-line [OPTIONS]")
            && !help.contains("--bezier")
            && !help.contains("--textbook"),
        "{help}"
    );
    assert!(good("run spline-dda --help").contains("--bezier") && good("run dda-arc --help").contains("--textbook"));
    // Without a model, all of them.
    assert!(good("run --help").contains("--bezier") && good("run --help my.net").contains("--bezier"));
}

#[test]
fn list_describes_the_models_that_are_named() {
    let one = good("list dda-arc");
    assert!(
        one.starts_with("  dda-arc  ")
            && !one.contains("dda-line")
            && good("list").contains(one.lines().next().unwrap())
    );
    let two: serde_json::Value = serde_json::from_str(&good("list ramp ppc-line --json")).unwrap();
    let names: Vec<&str> = two.as_array().unwrap().iter().map(|model| model["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["ramp", "ppc-line"]);
    let ran = Folder::new().run("list dda-lin");
    assert!(ran.code == 2 && ran.err.contains("did you mean 'dda-line'"), "{ran:?}");
}

#[test]
fn the_examples_of_the_help_work_as_written() {
    let help = good("run --help");
    let examples: Vec<&str> = help.lines().filter_map(|line| line.trim().strip_prefix("stepwave run ")).collect();
    assert_eq!(examples.len(), 3, "{help}");
    for example in examples {
        // The last one shows a trap.
        let code = i32::from(example.contains("trap"));
        assert_eq!(Folder::new().run(&format!("run {example}")).code, code, "{example}");
    }
}

#[test]
fn the_version_is_that_of_the_package() {
    for option in ["--version", "-V"] {
        assert_eq!(good(option), format!("stepwave {}\n", env!("CARGO_PKG_VERSION")));
    }
}

#[test]
fn the_list_names_every_model_with_its_registers_and_options() {
    let list = good("list");
    let models: Vec<Value> = serde_json::from_str(&good("list --json")).unwrap();
    let names: Vec<&str> = models.iter().map(|model| model["name"].as_str().unwrap()).collect();
    assert!(["ppc-line", "ppc-arc", "dda-line", "dda-arc"].iter().all(|name| names.contains(name)), "{names:?}");
    let run = options(&good("run --help"));
    for model in &models {
        let name = model["name"].as_str().unwrap();
        let begin = list.find(&format!("\n  {name}  ")).unwrap_or_else(|| panic!("{name} is not in the list: {list}"));
        let part = list[begin + 1..].split("\n\n").next().unwrap();
        for (kind, fields) in
            [("registers", ["name", "default_width", "about"].as_slice()), ("options", &["option", "about"])]
        {
            let entries = model[kind].as_array().unwrap();
            assert!(entries.len() >= 2, "{name}: {kind}");
            for entry in entries {
                for field in fields {
                    assert!(part.contains(entry[field].as_str().unwrap()), "{name}: {entry} is not in:\n{part}");
                }
                if let Some(option) = entry["option"].as_str() {
                    assert!(run.contains(option), "{name}: {option}");
                    let (values, default) = (entry["values"].as_array().unwrap(), &entry["default"]);
                    assert!(default.is_null() || values.contains(default), "{name}: {entry}");
                }
            }
        }
        assert!(model["title"].is_string() && model["method"].is_string() && model["source"].is_string(), "{name}");
    }
    let most_axes = |name| models[names.iter().position(|known| *known == name).unwrap()]["curve"]["max_axes"].as_u64();
    assert_eq!((most_axes("dda-line"), most_axes("vector-line"), most_axes("dda-arc")), (Some(6), Some(2), Some(2)));
}

#[test]
fn the_list_groups_its_models_by_method_under_one_heading_each() {
    let list = good("list");
    let models: Vec<Value> = serde_json::from_str(&good("list --json")).unwrap();
    let text = |model: &Value, key: &str| model[key].as_str().unwrap().to_owned();
    let methods: BTreeSet<String> = models.iter().map(|model| text(model, "method")).collect();
    let lines: Vec<&str> = list.lines().collect();
    assert_eq!(lines[0], format!("{} models by method", models.len()));
    let mut seen = 0;
    for method in &methods {
        let of_method = |model: &&Value| text(model, "method") == *method;
        let names: Vec<String> = models.iter().filter(of_method).map(|model| text(model, "name")).collect();
        // In the overview, with its models.
        let overview =
            lines.iter().filter(|line| line.trim_end().ends_with(&names.join(", ")) && line.contains(method));
        assert_eq!(overview.count(), 1, "{method}: {list}");
        // As a heading, with a rule of the same length below.
        let headings: Vec<usize> = (0..lines.len()).filter(|&at| lines[at] == method).collect();
        let [heading] = headings[..] else { panic!("{method} heads {} parts", headings.len()) };
        assert_eq!(lines[heading + 1], "─".repeat(method.chars().count()));
        // Its models, in order, up to the next heading.
        let part = lines[heading + 2..].iter().take_while(|line| line.is_empty() || line.starts_with(' '));
        let titles: Vec<&&str> = part.filter(|line| line.starts_with("  ") && !line.starts_with("   ")).collect();
        assert_eq!(titles.len(), names.len(), "{method}: {titles:?}");
        for (title, name) in titles.iter().zip(&names) {
            assert!(title.starts_with(&format!("  {name}  ")), "{title}");
        }
        seen += names.len();
    }
    assert_eq!(seen, models.len());
}

#[test]
fn registers_and_options_of_the_list_stand_in_columns() {
    let list = good("list");
    let models: Vec<Value> = serde_json::from_str(&good("list --json")).unwrap();
    let mut columns = BTreeSet::new();
    for model in &models {
        for (kind, fields) in [("registers", ["name", "default_width"]), ("options", ["option", "about"])] {
            for entry in model[kind].as_array().unwrap() {
                let [name, next] = fields.map(|field| entry[field].as_str().unwrap());
                let shown = list.lines().filter(|line| {
                    let rest = line.strip_prefix("      ").and_then(|line| line.strip_prefix(name));
                    rest.is_some_and(|rest| rest.starts_with("  ") && rest.trim_start().starts_with(next))
                });
                let places: BTreeSet<usize> = shown
                    .map(|line| {
                        let help: String = line.chars().skip(6 + name.chars().count()).collect();
                        line.chars().count() - help.trim_start().chars().count()
                    })
                    .collect();
                assert!(!places.is_empty(), "{entry} is not in the list");
                columns.extend(places);
            }
        }
    }
    assert_eq!(columns.len(), 1, "one column for all widths and values: {columns:?}");
}

#[test]
fn the_list_says_which_choices_a_model_takes() {
    // A choice in the list is taken, one that is not there is refused.
    let values = [
        ("--width", "9"),
        ("--preset", "zero"),
        ("--normalize", ""),
        ("--end-point", "total"),
        ("--form", "signed"),
        ("--compare", "ge"),
        ("--pick-off", "40"),
        ("--timing", "length=3"),
        ("--beats", "1"),
        ("--on-overflow", "wrap"),
    ];
    let models: Vec<Value> = serde_json::from_str(&good("list --json")).unwrap();
    for model in &models {
        let name = model["name"].as_str().unwrap();
        let geometry = match model["curve"]["kind"].as_str().unwrap() {
            "axis" => "--to 6",
            "line" => "--to 6,4",
            "arc" | "move" => "--from 5,0 --to 0,5 --ccw",
            "conic" => "--ellipse 5,3 --from 5,0 --to 0,3 --ccw",
            "spline" => "--bezier 0,0,1,0,2,1",
            "NURBS" => "--bezier 0,0,1,0,2,1 --step 1 --clock-hz 4000000",
            "helix" => "--from 5,0,0 --to 0,5,4 --ccw",
            kind => panic!("{name}: {kind}"),
        };
        let listed: Vec<&str> =
            model["options"].as_array().unwrap().iter().map(|doc| doc["option"].as_str().unwrap()).collect();
        for (option, value) in values {
            let ran = Folder::new().run(&format!("run {name} {geometry} {option} {value}"));
            assert_eq!(ran.code == 2, !listed.contains(&option), "{name} {option} {value}: {ran:?}");
        }
    }
}

#[test]
fn completions_know_every_command_and_option() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = good(&format!("completions {shell}"));
        for command in COMMANDS {
            assert!(script.contains(command), "{shell}: {command}");
        }
        // fish writes options without their hyphens.
        for option in options(&good("run --help")) {
            let written = if shell == "fish" { format!("-l {}", &option[2..]) } else { option.clone() };
            assert!(script.contains(&written), "{shell}: {option}");
        }
    }
}

#[test]
fn the_bash_completions_are_a_script_that_bash_can_read() {
    let folder = Folder::new();
    folder.write("completions.bash", &good("completions bash"));
    let test = "source ./completions.bash && COMP_WORDS=(stepwave run --tra) COMP_CWORD=2 && _stepwave stepwave --tra run \
                && printf '%s\\n' \"${COMPREPLY[@]}\"";
    let output = std::process::Command::new("bash").args(["-c", test]).current_dir(folder.path("")).output().unwrap();
    let offered: BTreeSet<String> = String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect();
    let expected = [
        "--trace",
        "--trace-depth",
        "--trace-exclude",
        "--trace-from",
        "--trace-on",
        "--trace-speed",
        "--trace-steps",
        "--trace-to",
    ];
    assert_eq!(offered, expected.map(str::to_owned).into(), "{output:?}");
}

#[test]
fn every_command_has_a_manual_page_with_all_its_options() {
    let folder = Folder::new();
    folder.good("man .");
    let program = folder.read("stepwave.1").replace("\\-", "-");
    for command in COMMANDS {
        assert!(program.contains(&format!("stepwave-{command}(1)")), "{command} is not in the page of the program");
        let page = folder.read(&format!("stepwave-{command}.1"));
        assert!(page.contains(&format!(".TH STEPWAVE-{}", command.to_uppercase())), "{page}");
        let help = options(&good(&format!("{command} --help")));
        assert!(
            options(&page).is_superset(&help),
            "{command}: {help:?} are in the help, in the page {:?}",
            options(&page)
        );
    }
}

#[test]
fn every_page_that_a_page_refers_to_is_written() {
    let folder = Folder::new();
    folder.good("man .");
    let files = folder.files();
    for file in &files {
        let page = folder.read(file).replace("\\-", "-");
        let pages = page.split(|c: char| c.is_whitespace()).filter_map(|word| word.strip_suffix("(1)"));
        for name in pages.map(|name| name.trim_start_matches(|c: char| !c.is_ascii_lowercase())) {
            assert!(files.contains(&format!("{name}.1")), "{file} refers to {name}(1)");
        }
    }
    assert!(files.contains(&"stepwave-golden-record.1".to_owned()), "{files:?}");
}

#[test]
fn manual_pages_are_written_into_the_folder_given() {
    let folder = Folder::new();
    folder.make("pages");
    assert_eq!(folder.good("man pages"), "");
    assert!(folder.path("pages/stepwave-run.1").is_file());
    assert_eq!(folder.files(), ["pages"]);
}
