//! Values below zero reach their option, whose message names the value and the limit.

use super::{Folder, good, refused};

/// The options of a command that take a value, by its help.
fn with_values(help: &str) -> Vec<String> {
    let option = |line: &str| {
        let (_, rest) = line.split_once("--").filter(|(before, _)| before.trim().len() <= 3)?;
        let (name, value) = rest.split_once([' ', '[']).unwrap_or((rest, ""));
        value.trim_start_matches('=').starts_with('<').then(|| name.to_owned())
    };
    let lines = help.lines().filter(|line| line.starts_with("  ") && line.trim_start().starts_with('-'));
    lines.filter_map(option).collect()
}

#[test]
fn no_value_of_any_option_is_taken_for_an_option() {
    let folder = Folder::new();
    let help = good("--help");
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let named = commands.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let commands: Vec<&str> = named.filter_map(|line| line.split_whitespace().next()).collect();
    assert!(commands.len() > 12, "{commands:?}");
    let mut looked_at = 0;
    for command in commands.into_iter().filter(|command| *command != "help") {
        for option in with_values(&good(&format!("{command} --help"))) {
            for value in ["-1.5zz", "-.5"] {
                let ran = folder.run(&format!("{command} --{option} {value}"));
                assert_eq!(ran.code, 2, "{command} --{option} {value}: {ran:?}");
                assert!(!ran.err.contains("unexpected argument"), "{command} --{option} {value}: {}", ran.err);
                looked_at += 1;
            }
        }
    }
    assert!(looked_at > 400, "{looked_at}");
}

#[test]
fn lengths_speeds_and_numbers_below_zero_are_refused_with_their_limit() {
    for (words, hints) in [
        ("machine --travel -300mm,200mm --feed 9", ["'-300mm'", "give lengths above 0 in mm, um or in"]),
        ("machine --travel 3mm,2mm --feed -9", ["'-9'", "give a speed above 0"]),
        ("machine --travel 3mm,2mm --feed 9 --blu -1um", ["'-1um'", "give one above 0"]),
        ("machine --travel 3mm,2mm --feed 9 --clock-hz -5", ["--clock-hz -5", "0"]),
        ("machine --travel 3mm,2mm --feed 9 --accel -5mm/s2", ["'-5mm/s2'", "from 1 on"]),
        ("machine --travel 3mm,2mm --feed 9 --accel 5mm/s2 --jerk -5", ["'-5'", "from 1 on"]),
        ("run dda-line --to 8,6 -w -4", ["'-4'", "from 1 to 64"]),
        ("run dda-line --to 8,6 --feed -4", ["'-4'", "give mm/min above 0"]),
        ("run dda-line --to 8,6 --max-clocks -4", ["'-4'", "give a whole number from 1 on"]),
        ("run dda-line --to 8,6 --preset -4", ["'-4'", "a number from 0 on"]),
        ("run sampled-line --to 8,6 --step -.5", ["'-.5'", "from 0.000001 to 1e9"]),
        ("sweep dda-line --to-grid 1..3x1..3 --samples -4", ["'-4'", "give a whole number from 1 on"]),
        ("sweep dda-line --to-grid 1..3x1..3 --width -4", ["'-4'", "from 1 to 64"]),
        ("program part.ngc --method dda --rapid -4", ["'-4'", "give mm/min above 0"]),
        ("widths dda-line --box -4", ["-4", "1 to 52 bits"]),
        ("show dda-line --to 8,6 --from -1", ["'-1' for '--from <N> or --trace-from <N>'", "from 0 on"]),
        ("show dda-line --to -1 --signals e", ["'-1' for '--to <N> or --trace-to <N>'", "from 0 on"]),
        ("run dda-line --to 8,6 --cw -5", ["unexpected argument '-5'", "stepwave run --help"]),
        ("run dda-line --from 1 --to 8,6", ["the start point has 1 coordinate and", "2: give"]),
    ] {
        refused(words, &hints);
    }
}

#[test]
fn coordinates_below_zero_are_points_as_they_were() {
    let folder = Folder::new();
    assert_eq!(folder.good("run ramp --to -5 --quiet"), "");
    assert!(folder.good("show dda-line --from -1,-2 --to -4,2 --signals e").contains("\ne "));
    assert!(folder.good("sweep dda-line --to-grid -3..3x-2 --csv -").contains("-3"));
}
