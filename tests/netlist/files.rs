//! Text before, text after: what simplification makes of a netlist (`passes/*.txt`), and what is said of a bad text
//! (`diagnostics/*.txt`).
//!
//! A file begins with lines `# ` that say what it shows. Cases are parted by a line `====`, the two texts of a case by
//! `----`. In a case of passes, a line `fixed %0 = 0` says that a net is taken to have this value. Every case is in a
//! module `m`, whose first line `netlist m` is left out. `STEPWAVE_BLESS=1 cargo test --test main netlist::files` writes the
//! text after it anew.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use stepwave_netlist::passes::simplify;
use stepwave_netlist::{Net, elaborate, text};

const BETWEEN_CASES: &str = "====\n";
const BETWEEN_TEXTS: &str = "----\n";

/// The text after it of each case in the files of a folder, which `after` makes of the text before it.
fn every_file(folder: &str, after: fn(&str) -> String) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/netlist").join(folder);
    let mut files: Vec<PathBuf> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() > 3, "{} holds {} files", folder.display(), files.len());
    let mut wrong = Vec::new();
    for file in files {
        let recorded = fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
        let about: String = recorded.split_inclusive('\n').take_while(|line| line.starts_with("# ")).collect();
        assert!(!about.is_empty(), "{} does not say what it shows", file.display());
        let cases = recorded[about.len()..].split(BETWEEN_CASES).map(|case| {
            let before = case.split(BETWEEN_TEXTS).next().unwrap_or_default();
            format!("{before}{BETWEEN_TEXTS}{}", after(before))
        });
        let made = about + &cases.collect::<Vec<_>>().join(BETWEEN_CASES);
        if made != recorded && std::env::var_os("STEPWAVE_BLESS").is_some() {
            fs::write(&file, made).unwrap();
        } else if made != recorded {
            let line = made.lines().zip(recorded.lines()).take_while(|(made, recorded)| made == recorded).count();
            let at = |text: &str| text.lines().nth(line).unwrap_or("the end").to_owned();
            let (made, recorded) = (at(&made), at(&recorded));
            wrong.push(format!("{}:{}: recorded '{recorded}', now '{made}'", file.display(), line + 1));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn netlist(cells: &str) -> String {
    format!("netlist m\n{cells}")
}

/// Without the line that every case has.
fn cells(text: &str) -> String {
    text.strip_prefix("netlist m\n").unwrap_or(text).to_owned()
}

#[test]
fn files_of_passes_hold_what_becomes_of_a_netlist() {
    every_file("passes", |before| {
        let (fixed, lines): (Vec<&str>, Vec<&str>) =
            before.split_inclusive('\n').partition(|line| line.starts_with("fixed "));
        let number = |word: &str| word.trim().trim_start_matches('%').parse().unwrap();
        let fixed: HashMap<Net, u64> = fixed
            .iter()
            .filter_map(|line| line.strip_prefix("fixed ")?.split_once('='))
            .map(|(net, value)| (Net(u32::try_from(number(net)).unwrap()), number(value)))
            .collect();
        let before = elaborate(text::parse(&netlist(&lines.concat())).unwrap()).unwrap();
        cells(&text::print(&simplify(before.netlist(), &fixed).netlist))
    });
}

#[test]
fn files_of_diagnostics_hold_what_is_said_of_a_bad_text() {
    every_file("diagnostics", |before| {
        let read = text::parse(&netlist(before)).and_then(elaborate);
        format!("{}\n", read.expect_err("a mistake is reported"))
    });
}
