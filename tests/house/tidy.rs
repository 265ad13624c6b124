//! Rules that no compiler checks.

use std::fs;
use std::path::{Path, PathBuf};

const MOST_LINES: usize = 500;
const MOST_GOLDEN_BYTES: u64 = 100_000;

/// Every file below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found
}

pub(super) fn sources() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let all = ["src", "crates", "rtl_models", "tests", "examples", "benches"]
        .into_iter()
        .flat_map(|folder| files(&root.join(folder)));
    let rust = all.filter(|path| path.extension().is_some_and(|extension| extension == "rs"));
    rust.map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

#[test]
fn no_source_file_has_more_than_500_lines() {
    let long: Vec<_> = sources().into_iter().filter(|(_, text)| text.lines().count() > MOST_LINES).collect();
    assert!(long.is_empty(), "{:?}", long.iter().map(|(path, _)| path).collect::<Vec<_>>());
}

#[test]
fn every_source_file_says_first_what_it_is_for() {
    // A module's own tests are for that module.
    for (path, text) in sources().into_iter().filter(|(path, _)| !path.ends_with("tests.rs")) {
        assert!(text.starts_with("//!"), "{}", path.display());
    }
}

#[test]
fn the_recurrences_know_nothing_of_the_workspace() {
    let crate_name = "stepwave";
    for (path, text) in sources() {
        if path.components().any(|part| part.as_os_str() == "reference") {
            assert!(!text.contains(crate_name), "{}", path.display());
        }
    }
}

#[test]
fn golden_files_stay_small() {
    for path in files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("waves")) {
        let bytes = path.metadata().unwrap().len();
        assert!(bytes < MOST_GOLDEN_BYTES, "{}: {bytes} bytes", path.display());
    }
}

#[test]
fn architecture_stays_short() {
    let text = include_str!("../../ARCHITECTURE.md");
    assert!(text.lines().count() < 150);
}

/// Phrases that no engineer of this field writes, in what a user reads: messages, help, and documents.
#[test]
fn messages_and_documents_are_in_the_words_of_the_field() {
    let odd = ["came to a stand", "come to a stand", "lost its way", "that the machine was told", "behind edge"];
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pages =
        files(&root.join("docs")).into_iter().chain(["README.md", "CONTRIBUTING.md"].map(|page| root.join(page)));
    let pages = pages.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    let pages = pages.map(|path| (path.clone(), fs::read_to_string(path).unwrap()));
    let sources = sources().into_iter().filter(|(path, _)| !path.starts_with(root.join("tests")));
    let mut found = Vec::new();
    for (path, text) in sources.chain(pages) {
        let is_rust = path.extension().is_some_and(|ending| ending == "rs");
        for (number, line) in text.lines().enumerate() {
            let invalid = is_rust && line.contains('"') && line.contains("' is no ");
            if invalid || odd.iter().any(|phrase| line.contains(phrase)) {
                found.push(format!("{}:{}: {line}", path.display(), number + 1));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
