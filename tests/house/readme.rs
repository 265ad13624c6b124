//! Every `stepwave run` and `stepwave program` in the README is run, and what the README shows of it is compared.

use std::process::Command;

/// Fenced blocks of the README: language and content.
fn blocks(text: &str) -> Vec<(String, String)> {
    let mut blocks = Vec::new();
    let mut open: Option<(String, String)> = None;
    for line in text.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(language), None) => open = Some((language.to_owned(), String::new())),
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (None, Some((_, content))) => *content += &format!("{line}\n"),
            (None, None) => {}
        }
    }
    blocks
}

#[test]
fn the_commands_of_the_readme_print_what_it_shows() {
    let readme = include_str!("../../README.md");
    let blocks = blocks(readme);
    let dir = tempfile::tempdir().unwrap();
    std::fs::create_dir(dir.path().join("examples")).unwrap();
    std::fs::write(dir.path().join("examples/part.ngc"), include_str!("../../examples/part.ngc")).unwrap();
    let mut compared = 0;
    for pair in blocks.windows(2) {
        let [(language, command), (shown_language, shown)] = pair else { unreachable!() };
        if language != "sh" {
            continue;
        }
        // `cargo run --release -- run …` and `stepwave run …` are the same program.
        let words = command.trim().strip_prefix("cargo run --release -- ").or(command.strip_prefix("stepwave "));
        let Some(arguments) = words.filter(|words| words.starts_with("run ") || words.starts_with("program ")) else {
            continue;
        };
        let output = Command::new(env!("CARGO_BIN_EXE_stepwave"))
            .args(arguments.split_whitespace())
            .current_dir(&dir)
            .output()
            .unwrap();
        let printed = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        if shown_language == "text" {
            for line in shown.lines().filter(|line| !line.trim().is_empty() && line.trim() != "…") {
                assert!(printed.lines().any(|printed| printed == line), "not printed: {line}\n{printed}");
                compared += 1;
            }
        }
        let wave = arguments.split("--vcd ").nth(1).and_then(|rest| rest.split_whitespace().next());
        if let Some(wave) = wave {
            assert!(dir.path().join(wave).is_file(), "{wave}");
        }
    }
    assert!(compared > 10, "{compared}");
}

/// The command in the fenced block that ends before each table, and the lines of the table.
fn tables(text: &str) -> Vec<(String, String)> {
    let (mut found, mut last, mut lines) = (Vec::new(), String::new(), text.lines().peekable());
    while let Some(line) = lines.next() {
        if line == "```sh" {
            last = lines.by_ref().take_while(|line| *line != "```").map(|line| format!("{line}\n")).collect();
        } else if line.starts_with('|') {
            let mut table = format!("{line}\n");
            while let Some(row) = lines.next_if(|row| row.starts_with('|')) {
                table += &format!("{row}\n");
            }
            found.push((std::mem::take(&mut last), table));
        } else if !line.is_empty() {
            last.clear();
        }
    }
    found
}

#[test]
fn the_tables_of_the_readme_are_those_that_compare_prints() {
    let mut compared = 0;
    for (command, table) in tables(include_str!("../../README.md")) {
        let Some(arguments) = command.trim().strip_prefix("stepwave compare ") else { continue };
        let words = ["compare"].into_iter().chain(arguments.split_whitespace());
        let output = Command::new(env!("CARGO_BIN_EXE_stepwave")).args(words).output().unwrap();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), table, "{command}");
        compared += 1;
    }
    assert!(compared >= 2, "{compared}");
}

#[test]
fn continuous_integration_runs_the_test_command_of_the_readme() {
    let readme = include_str!("../../README.md");
    let command = blocks(readme).into_iter().find(|(_, content)| content.starts_with("cargo test")).unwrap().1;
    let ci = include_str!("../../.ci/run");
    assert!(ci.lines().any(|line| line == format!("step {}", command.trim())), "{command}");
}
