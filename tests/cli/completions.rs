//! What shells offer, asked of a real bash.

use std::collections::BTreeSet;
use std::process::Command;

use super::{Folder, good};

/// What bash offers after these words, the last of which is being written.
fn offered(words: &[&str]) -> BTreeSet<String> {
    let folder = Folder::new();
    folder.write("completions.bash", &good("completions bash"));
    let [.., before, last] = words else { panic!("{words:?}") };
    let list = words.iter().map(|word| format!("'{word}'")).collect::<Vec<_>>().join(" ");
    // The function that bash itself would call.
    let test = format!(
        "source ./completions.bash
         function=$(complete -p stepwave | sed 's/.*-F \\([^ ]*\\).*/\\1/')
         COMP_WORDS=({list}) COMP_CWORD={}
         $function stepwave '{last}' '{before}'
         printf '%s\\n' \"${{COMPREPLY[@]}}\"",
        words.len() - 1
    );
    let output = Command::new("bash").args(["-c", &test]).current_dir(folder.path("")).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

fn set(words: &str) -> BTreeSet<String> {
    words.split_whitespace().map(str::to_owned).collect()
}

#[test]
fn models_complete_where_a_model_is_wanted() {
    for command in ["run", "widths", "prove", "export", "sweep"] {
        assert_eq!(
            offered(&["stepwave", command, "mindev"]),
            set("mindev-line mindev-arc mindev-machine"),
            "{command}"
        );
    }
}

#[test]
fn registers_of_the_very_model_complete() {
    assert_eq!(offered(&["stepwave", "run", "vector-line", "--width", ""]), set("xe= ye= f= e= x= y="));
    assert_eq!(offered(&["stepwave", "run", "ppc-arc", "--to", "0,5", "--width", "x"]), set("xi= x="));
    assert_eq!(offered(&["stepwave", "prove", "cim-line", "--narrower", "e"]), set("ex= ey= ez= ea= eb= ec="));
    assert_eq!(offered(&["stepwave", "run", "dda-line", "--trace", "jr"]), set("jrx jry jrz jra jrb jrc"));
    // Without a model, those of all.
    assert!(offered(&["stepwave", "run", "--width", ""]).is_superset(&set("accx= alpha= f= cnty=")));
}

#[test]
fn values_of_options_complete() {
    assert_eq!(offered(&["stepwave", "run", "dda-line", "--engine", ""]), set("auto compiled word gates"));
    assert_eq!(offered(&["stepwave", "run", "dda-line", "--preset", ""]), set("zero half full"));
    assert_eq!(offered(&["stepwave", "sweep", "dda-line", "--adder", "s"]), set("serial"));
    assert_eq!(offered(&["stepwave", "program", "--method", ""]), set("ppc dda dpm cim mindev stepgen bresenham"));
    assert_eq!(offered(&["stepwave", "completions", "z"]), set("zsh"));
}

#[test]
fn files_complete() {
    assert_eq!(offered(&["stepwave", "run", "dda-line", "--vcd", "comp"]), set("completions.bash"));
    // Where the function offers nothing, bash itself offers files.
    assert!(
        good("completions bash").contains("complete -F _stepwave_with_registers -o nosort -o bashdefault -o default")
    );
}

#[test]
fn the_scripts_of_other_shells_hold_the_names_too() {
    for shell in ["zsh", "fish"] {
        let script = good(&format!("completions {shell}"));
        for name in ["ppc-line", "stepgen", "accx=", "alpha=", "compiled", "mindev"] {
            assert!(script.contains(name), "{shell}: {name}");
        }
    }
}
