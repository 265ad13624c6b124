//! Every `stepwave run`, `program` and `compare` in the README and in `docs/` is run, and what they show of it is compared.

use std::fs;
use std::path::Path;
use std::process::Command;

/// The README and the pages of `docs/`, by name.
fn pages() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = fs::read_dir(root.join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let pages =
        docs.filter(|path| path.extension().is_some_and(|ending| ending == "md")).chain([root.join("README.md")]);
    pages.map(|path| (path.display().to_string(), fs::read_to_string(path).unwrap())).collect()
}

/// Fenced blocks of a page: language and content.
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
fn commands_of_the_documents_print_what_is_shown() {
    let blocks: Vec<_> = pages().iter().flat_map(|(_, text)| blocks(text)).collect();
    let dir = tempfile::tempdir().unwrap();
    std::fs::create_dir(dir.path().join("examples")).unwrap();
    std::fs::write(dir.path().join("examples/part.ngc"), include_str!("../../examples/part.ngc")).unwrap();
    let mut compared = 0;
    for pair in blocks.windows(2) {
        let [(language, command), (shown_language, shown)] = pair else { unreachable!() };
        if language != "sh" {
            continue;
        }
        // `cargo run -- run …` and `stepwave run …` are the same program.
        let words = command.trim().strip_prefix("cargo run -- ").or(command.strip_prefix("stepwave "));
        let Some(arguments) =
            words.filter(|words| ["run ", "program ", "show "].iter().any(|command| words.starts_with(command)))
        else {
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
fn tables_of_the_documents_are_those_that_compare_prints() {
    let mut compared = 0;
    for (command, table) in pages().iter().flat_map(|(_, text)| tables(text)) {
        let Some(arguments) = command.trim().strip_prefix("stepwave compare ") else { continue };
        let words = ["compare"].into_iter().chain(arguments.split_whitespace());
        let output = Command::new(env!("CARGO_BIN_EXE_stepwave")).args(words).output().unwrap();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), table, "{command}");
        compared += 1;
    }
    assert!(compared >= 2, "{compared}");
}

#[test]
fn readme_is_short_and_links_to_pages_that_exist() {
    assert!(include_str!("../../README.md").lines().count() <= 150);
    for (page, text) in pages() {
        let folder = Path::new(&page).parent().unwrap();
        for target in text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
            assert!(
                target.starts_with("http") || target.is_empty() || folder.join(target).exists(),
                "{page}: {target}"
            );
        }
    }
}

#[test]
fn continuous_integration_runs_the_test_command_of_the_readme() {
    let readme = include_str!("../../README.md");
    let command = blocks(readme).into_iter().find(|(_, content)| content.starts_with("cargo test")).unwrap().1;
    let ci = include_str!("../../.ci/run");
    assert!(ci.lines().any(|line| line == format!("step {}", command.trim())), "{command}");
}
