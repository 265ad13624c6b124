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

fn sources() -> Vec<(PathBuf, String)> {
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
