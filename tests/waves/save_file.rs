//! The GTKWave save file: a row that is not named exactly as GTKWave names the signal vanishes without a message.

use std::collections::{BTreeMap, BTreeSet};

use vcd::{ReferenceIndex, Var, VarType};

use super::Folder;
use super::second_reader::variables;

const RUNS: [&str; 9] = [
    "ppc-line --to 6,4",
    "ppc-line --from -1,1 --to -4,2 --form signed --beats 1 --end-point per-axis",
    "ppc-line --to 6,4 --width f=3",
    "ppc-arc --from 6,0 --to 0,6 --ccw",
    "ppc-arc --from -5,-3 --to -3,5 --cw --beats 1 --no-clk",
    "dda-line --to 8,6",
    "dda-line --to 9,-30,4,0,-17,31 --end-point per-axis --trace axis_?.*",
    "dda-arc --from 5,0 --to 0,5 --ccw",
    "dda-arc --from 5,0 --to 0,5 --ccw --width jv=6,jr=6 --normalize --trace-from 5 --trace-exclude *_in",
];

/// A row of a save file: its flags and what comes with it.
struct Row {
    flags: u32,
    name: String,
    states: Option<String>,
}

/// The content of a save file.
#[derive(Default)]
struct SaveFile {
    settings: BTreeMap<String, String>,
    zoom: String,
    rows: Vec<Row>,
}

const GROUP_OPEN: u32 = 0x80_0200;
const GROUP_CLOSE: u32 = 0x100_0200;
const SHUT_OPEN: u32 = 0xc0_0200;
const SHUT_CLOSE: u32 = 0x140_1200;
const HEIGHT: u32 = 0x2_0200;
const TRANSLATED: u32 = 0x2000;

/// Takes a save file apart line by line; every line must be of a known kind, groups must close in order.
fn parse(text: &str) -> SaveFile {
    let mut file = SaveFile::default();
    let (mut flags, mut states, mut groups) = (None, None, Vec::new());
    for line in text.lines() {
        if let Some(hex) = line.strip_prefix('@') {
            flags = Some(u32::from_str_radix(hex, 16).expect("flags in hex"));
        } else if let Some(rest) = line.strip_prefix('[') {
            let (key, value) = rest.split_once("] ").unwrap_or_else(|| panic!("{line}"));
            file.settings.insert(key.to_owned(), value.to_owned());
        } else if let Some(zoom) = line.strip_prefix('*') {
            file.zoom = zoom.to_owned();
        } else if let Some(name) = line.strip_prefix("^1 ") {
            states = Some(name.to_owned());
        } else if let Some(title) = line.strip_prefix('-') {
            match flags.expect("flags") {
                GROUP_OPEN | SHUT_OPEN => groups.push(title.to_owned()),
                GROUP_CLOSE | SHUT_CLOSE => assert_eq!(groups.pop().as_deref(), Some(title), "{text}"),
                HEIGHT => {
                    assert!(title.is_empty() && file.rows.last().is_some_and(|row| row.flags & 0x8000 != 0), "{text}")
                }
                other => panic!("{other:x} before {line}"),
            }
        } else {
            assert!(line.starts_with(|c: char| c.is_ascii_alphabetic()), "{line}");
            file.rows.push(Row { flags: flags.expect("flags"), name: line.to_owned(), states: states.take() });
        }
    }
    assert!(groups.is_empty() && states.is_none() && text.ends_with('\n'), "{text}");
    file
}

/// GTKWave's own name: `reg` and `wire` vectors with their range, all else bare.
fn name_in_gtkwave(path: &str, var: &Var) -> String {
    match (var.var_type, var.index) {
        (VarType::Reg | VarType::Wire, Some(ReferenceIndex::Range(msb, lsb))) => format!("{path}[{msb}:{lsb}]"),
        _ => path.to_owned(),
    }
}

/// Runs the program with a wave; gives the folder and the parsed save file.
fn saved(words: &str) -> (Folder, SaveFile) {
    let folder = Folder::new();
    let ran = folder.run(&format!("run {words} --vcd w.vcd"));
    assert_eq!(ran.code, i32::from(words.contains("f=3")), "{words}: {ran:?}");
    let file = parse(&folder.read("w.gtkw"));
    (folder, file)
}

/// Every variable of the wave by GTKWave's name.
fn names(folder: &Folder) -> BTreeMap<String, Var> {
    let text = folder.read("w.vcd");
    let header = vcd::Parser::new(text.as_bytes()).parse_header().expect("a header");
    variables(&header).into_iter().map(|(path, var)| (name_in_gtkwave(&path, var), var.clone())).collect()
}

#[test]
fn every_row_names_a_variable_as_gtkwave_does_and_every_variable_has_its_row() {
    for words in RUNS {
        let (folder, file) = saved(words);
        let rows: BTreeSet<String> = file.rows.iter().map(|row| row.name.clone()).collect();
        assert_eq!(rows.len(), file.rows.len(), "{words}: a row twice");
        assert_eq!(rows, names(&folder).into_keys().collect(), "{words}");
    }
}

#[test]
fn signed_registers_show_signed_and_vectors_never_as_ones_and_zeros() {
    for words in RUNS {
        let (folder, file) = saved(words);
        let names = names(&folder);
        for row in &file.rows {
            let var = &names[&row.name];
            // 0x400 signed, 0x4 decimal, 0x8 binary, right-justified 0x20.
            let expected = match (var.var_type, var.size) {
                _ if row.flags & TRANSLATED != 0 => 0x2028,
                (VarType::Integer, _) => 0x420 | row.flags & 0x8_8000,
                (VarType::Parameter, _) | (_, 2..) => 0x24,
                _ => 0x28,
            };
            assert_eq!(row.flags, expected, "{words}: {} is shown with @{:x}", row.name, row.flags);
        }
    }
}

#[test]
fn positions_are_drawn_as_curves() {
    let (_, file) = saved("dda-line --to 8,6");
    for name in ["dda_line.axis_x.x", "dda_line.axis_y.y"] {
        assert!(file.rows.iter().any(|row| row.name == name && row.flags == 0x8_8420), "{name}");
    }
}

#[test]
fn state_names_lie_next_to_the_wave_and_are_as_wide_as_their_register() {
    let mut translated = 0;
    for words in RUNS {
        let (folder, file) = saved(words);
        let names = names(&folder);
        let mut used = BTreeSet::from(["w.gtkw".to_owned(), "w.vcd".to_owned()]);
        for row in &file.rows {
            assert_eq!(row.states.is_some(), row.flags & TRANSLATED != 0, "{words}: {}", row.name);
            let Some(states) = &row.states else { continue };
            translated += 1;
            // Written as if all files were in `/`: GTKWave takes the path from the save file to the other.
            let states = states.trim_start_matches('/');
            let width = usize::try_from(names[&row.name].size).unwrap();
            let mut known = BTreeSet::new();
            for line in folder.read(states).lines() {
                let (bits, name) = line.split_once(' ').unwrap_or_else(|| panic!("{states}: {line}"));
                assert!(bits.len() == width && bits.chars().all(|c| "01".contains(c)), "{words}: {states}: {line}");
                assert!(!name.is_empty() && known.insert(bits.to_owned()), "{words}: {states}: {line}");
            }
            used.insert(states.to_owned());
        }
        assert_eq!(folder.files(), used.into_iter().collect::<Vec<_>>(), "{words}");
    }
    assert!(translated >= 6, "{translated} rows with state names");
}

#[test]
fn every_value_that_the_beats_take_has_a_name() {
    let (folder, file) = saved("ppc-line --to 6,4");
    let row = file.rows.iter().find(|row| row.name == "ppc_line.beat[3:0]").unwrap();
    let states = folder.read(row.states.as_ref().unwrap().trim_start_matches('/'));
    assert_eq!(states, "0000 IDLE\n0001 JUDGE\n0010 FEED\n0100 COMPUTE\n1000 COMPARE\n");
}

#[test]
fn the_save_file_opens_its_wave_and_its_hierarchy() {
    for words in RUNS {
        let (_, file) = saved(words);
        assert_eq!(file.settings["dumpfile"].trim_start_matches("\"/"), "w.vcd\"", "{words}");
        let top = words.split(' ').next().unwrap().replace('-', "_");
        assert_eq!(file.settings["treeopen"], format!("{top}."), "{words}");
    }
}

#[test]
fn the_zoom_line_has_26_markers_and_a_trap_is_marked_at_its_clock() {
    for words in RUNS {
        let (_, file) = saved(words);
        let numbers: Vec<f64> = file.zoom.split(' ').map(|word| word.parse().unwrap()).collect();
        assert_eq!(numbers.len(), 1 + 1 + 26, "{words}: {}", file.zoom);
        let trap = words.contains("f=3");
        assert_eq!(file.settings.get("markername").map(String::as_str), trap.then_some("Aoverflow"), "{words}");
        // Clock 15 at 1 us, in the unit of the timescale, ns.
        let marks = if trap { [15000.0; 2] } else { [-1.0; 2] };
        assert_eq!(numbers[1..3], marks, "{words}");
        assert!(numbers[3..].iter().all(|mark| *mark == -1.0), "{words}");
    }
}

#[test]
fn a_stale_save_file_is_written_anew_with_the_wave() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 6,4 --vcd w.vcd");
    let narrow = folder.read("w.gtkw");
    folder.good("run ppc-line --to 6,4 --width 9 --vcd w.vcd");
    let wide = folder.read("w.gtkw");
    assert!(narrow.contains("ppc_line.xe[2:0]") && wide.contains("ppc_line.xe[8:0]"), "{wide}");
}
