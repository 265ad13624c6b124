//! What a command reads it does not write over, however the file is named.

use std::fs;
use std::os::unix::fs::symlink;

use super::{Folder, Ran};

const POINTS: &str = "to_x,to_y\n5,3\n2,1\n";
const PART: &str = "G01 X0.004 Y0.003 F600\n";

/// A folder with every kind of input, each also by a link and by a second name.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("p.csv", POINTS);
    folder.write("points", POINTS);
    folder.write(".o.parquet.sweep.part", POINTS);
    folder.write(".o.csv.sweep.part", POINTS);
    folder.write("part", PART);
    folder.write("part.gtkw", PART);
    folder.good("run ppc-line --to 5,3 --vcd a.vcd");
    folder.good("run ppc-line --to 5,2 --vcd b.vcd --checkpoints states");
    for part in [1, 2] {
        folder.good(&format!("sweep ppc-line --to-grid 0..5x0..5 --shard {part}/2 --csv {part}.csv"));
    }
    folder.make("sub");
    for name in ["p.csv", "points", "part", "a.vcd", "1.csv"] {
        symlink(name, folder.path(&format!("link-{name}"))).unwrap();
        fs::hard_link(folder.path(name), folder.path(&format!("hard-{name}"))).unwrap();
    }
    folder
}

/// Every file by its name and content.
fn contents(folder: &Folder) -> Vec<(String, Vec<u8>)> {
    let read = |name: String| (name.clone(), fs::read(folder.path(&name)).unwrap_or_default());
    folder.files().into_iter().map(read).collect()
}

fn assert_kept(folder: &Folder, before: &[(String, Vec<u8>)], words: &str, ran: &Ran, names: &[&str]) {
    assert_eq!((ran.code, ran.out.as_str(), ran.err.lines().count()), (2, "", 1), "{words}: {ran:?}");
    for name in names {
        assert!(ran.err.contains(name), "{name}: {words}: {ran:?}");
    }
    assert!(ran.err.contains("name another file"), "{words}: {ran:?}");
    assert!(contents(folder) == before, "{words}: {ran:?}");
}

#[test]
fn an_output_that_is_an_input_is_refused_and_the_input_stays() {
    let folder = folder();
    let before = contents(&folder);
    let sweep = "sweep ppc-line --file";
    for (words, names) in [
        ("p.csv --csv p.csv", ["p.csv"; 2]),
        ("p.csv --csv ./p.csv", ["./p.csv"; 2]),
        ("./p.csv --csv sub/../p.csv", ["sub/../p.csv", "./p.csv"]),
        ("p.csv --csv link-p.csv", ["link-p.csv", "p.csv"]),
        ("link-p.csv --csv p.csv", ["link-p.csv", "p.csv"]),
        ("hard-p.csv --csv p.csv", ["hard-p.csv", "p.csv"]),
        ("points --parquet points", ["points"; 2]),
        (".o.csv.sweep.part --csv o.csv", [".o.csv.sweep.part"; 2]),
        (".o.parquet.sweep.part --parquet o.parquet", [".o.parquet.sweep.part"; 2]),
    ] {
        let ran = folder.run(&format!("{sweep} {words}"));
        assert_kept(&folder, &before, words, &ran, &names);
    }
    for (words, names) in [
        ("program part --method ppc --json part", ["part"; 2]),
        ("program part --method ppc --vcd ./part", ["./part", "part"]),
        ("program part --method ppc --steps hard-part", ["hard-part", "part"]),
        ("program part --method ppc --plot link-part", ["link-part", "part"]),
        // The viewer's file next to the wave.
        ("program part.gtkw --method ppc --vcd part.vcd", ["part.gtkw"; 2]),
        ("diff a.vcd b.vcd --merged a.vcd", ["a.vcd"; 2]),
        ("diff a.vcd b.vcd --merged b.vcd", ["b.vcd"; 2]),
        ("diff hard-a.vcd b.vcd --merged link-a.vcd", ["link-a.vcd", "hard-a.vcd"]),
        ("sweep merge 1.csv 1.csv 2.csv", ["1.csv"; 2]),
        ("sweep merge ./2.csv 1.csv 2.csv", ["./2.csv", "2.csv"]),
        ("sweep merge hard-1.csv 1.csv 2.csv", ["hard-1.csv", "1.csv"]),
        ("run ppc-line --to 5,2 --checkpoints states --json states", ["states"; 2]),
        ("run ppc-line --to 5,2 --checkpoints states --vcd ./states", ["./states", "states"]),
    ] {
        let ran = folder.run(words);
        assert_kept(&folder, &before, words, &ran, &names);
    }
}

#[test]
fn standard_output_that_is_an_input_is_refused() {
    let folder = folder();
    let before = contents(&folder);
    for (words, input) in [
        ("program part --method ppc --json -", "part"),
        ("sweep ppc-line --file p.csv --csv -", "p.csv"),
        ("sweep ppc-line --file p.csv --csv /dev/stdout", "p.csv"),
        ("diff a.vcd b.vcd --merged -", "b.vcd"),
        ("sweep merge - 1.csv 2.csv", "1.csv"),
    ] {
        let file = fs::File::options().append(true).open(folder.path(input)).unwrap();
        let ran = Ran::new(folder.command().args(words.split(' ')).stdout(file).output().unwrap());
        assert_kept(&folder, &before, words, &ran, &[input]);
    }
}

#[test]
fn two_names_of_one_file_are_one_output() {
    let folder = folder();
    let before = contents(&folder);
    for words in ["--steps points --json hard-points", "--vcd link-points --plot points"] {
        let ran = folder.run(&format!("run ppc-line --to 5,3 {words}"));
        assert!(ran.code == 2 && ran.err.contains("two outputs would go to "), "{words}: {ran:?}");
        assert!(contents(&folder) == before, "{words}");
    }
    // An output may not have the name of the rows that are to become another.
    let ran = folder.run("sweep ppc-line --to-grid 0..5x0..5 --csv q.csv --plot .q.csv.sweep.part");
    assert!(ran.code == 2 && ran.err.contains("two outputs would go to "), "{ran:?}");
    assert!(ran.err.contains(".q.csv.sweep.part"), "{ran:?}");
    assert!(contents(&folder) == before);
}

#[test]
fn a_link_to_where_nothing_is_yet_is_kept() {
    let folder = Folder::new();
    folder.make("sub");
    symlink("sub/there", folder.path("here")).unwrap();
    let ran = folder.run("run ppc-line --to 2,1 --steps here --json sub/there");
    assert!(ran.code == 2 && ran.err.contains("two outputs would go to "), "{ran:?}");
    folder.good("run ppc-line --to 2,1 --steps here");
    assert!(folder.path("here").is_symlink());
    assert!(folder.read("sub/there").starts_with("step,clock"));
}
