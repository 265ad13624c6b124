//! The examples are short, and the model of one's own has every command.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Lines that are neither blank nor a comment.
fn code_lines(text: &str) -> usize {
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

#[test]
fn examples_for_users_of_the_crates_are_at_most_60_lines_of_code() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for name in ["first_wave", "own_model", "own_netlist", "regression_test", "spiral", "sweep"] {
        let text = std::fs::read_to_string(folder.join(name).with_extension("rs")).unwrap();
        assert!(code_lines(&text) <= 60, "{name}: {} lines", code_lines(&text));
        assert!(
            include_str!("../../src/guide.rs").contains(&format!("    {name}\n")),
            "{name} is no page of the guide"
        );
    }
}

/// The built example; `cargo test` builds all of them.
fn example(name: &str) -> PathBuf {
    let program = Path::new(env!("CARGO_BIN_EXE_stepwave"));
    let built = program.with_file_name("examples").join(name).with_extension(std::env::consts::EXE_EXTENSION);
    assert!(built.exists(), "{name} is not built: `cargo test` and `cargo build --examples` do it");
    built
}

#[test]
fn own_model_has_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &str| {
        let output = Command::new(example("own_model")).args(words.split(' ')).current_dir(&folder).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        assert!(output.status.success(), "{words}: {}", text(output.stderr));
        text(output.stdout)
    };
    assert!(run("list").contains("\n  borrow-line  Subtracting DDA, line of 2 axes\n"));
    // 8/16 and 6/16, taken away: the first step borrows on both axes, and after 2^4 both remainders are 0 again.
    let table = run("run borrow-line --to 8,6 --steps -");
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows[0], "step,clock,jvx,jrx,jvy,jry,e,dx,dy,x,y");
    assert_eq!((rows[2], rows[17]), ("1,2,8,8,6,10,15,1,1,1,1", "16,17,8,0,6,0,0,0,0,8,6"));
    assert!(run("run borrow-line --to -3,5 --vcd line.vcd").contains("end point (-3, 5) reached exactly"));
    assert!(folder.path().join("line.gtkw").exists());
    let proved = run("prove borrow-line");
    assert!(include_str!("../../README.md").contains(&proved), "{proved}");
    let proved = run("prove borrow-line --certificate line.cert");
    assert_eq!(proved.matches("PROVED for all k: ").count(), 3, "{proved}");
    assert!(run("prove check line.cert").contains("PROVED"));
    assert!(
        run("widths borrow-line --box 4").contains("jrx            4      4  k      0 to 15                  proved")
    );
    let rows = run("sweep borrow-line --to-grid -7..7x-7..7 --width 3..5 --csv -");
    assert_eq!((rows.matches(",done,").count(), rows.matches(",true,").count()), (3 * 224, 3 * 224));
    assert!(run("compare --to 8,6").contains("\nborrow-line "));
    run("export borrow-line --to 8,6 --verilog line.v --testbench line_tb.v");
    assert!(std::fs::read_to_string(folder.path().join("line.v")).unwrap().contains("module borrow_line"));
    let case = "[[case]]\nname = \"own\"\nargs = [\"borrow-line\", \"--to\", \"8,6\"]\n";
    std::fs::create_dir(folder.path().join("golden")).unwrap();
    std::fs::write(folder.path().join("golden/cases.toml"), case).unwrap();
    run("golden record golden");
    assert!(run("golden check golden").contains("1 "), "one case");
}

#[test]
fn own_netlist_goes_through_all_states_but_0() {
    let output = Command::new(example("own_netlist")).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    // A sequence of 255 states has 128 ones, and is back at its first state.
    assert!(text.contains("clock   0: state 00000001, 0 ones\nclock   1: state 00000010, 0 ones\n"), "{text}");
    assert!(text.contains("clock 255: state 00000001, 128 ones\n"), "{text}");
}

/// What an example prints in a folder of its own.
fn printed(name: &str, folder: &Path) -> String {
    let output = Command::new(example(name)).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn first_wave_writes_the_files_of_the_run_and_shows_its_pulses() {
    let folder = tempfile::tempdir().unwrap();
    let text = printed("first_wave", folder.path());
    // 6/16 a clock from 0: carries at the additions 3, 6, 8, 11, 14 and 16; the load takes clock 1.
    assert!(text.contains("pulses of y  0000_1001_0100_1001_01\n"), "{text}");
    assert!(text.contains("16 steps in 17 clocks"), "{text}");
    for file in ["line.vcd", "line.gtkw", "line.csv", "line.json"] {
        assert!(folder.path().join(file).exists(), "{file}");
    }
}

#[test]
fn regression_test_finds_the_golden_waves_as_recorded() {
    let folder = tempfile::tempdir().unwrap();
    assert!(printed("regression_test", folder.path()).ends_with(" cases are as recorded, bit by bit\n"));
}

#[test]
fn sweep_names_its_slowest_and_its_worst_run() {
    let folder = tempfile::tempdir().unwrap();
    let text = printed("sweep", folder.path());
    // 31 times 32 lines in three widths and two forms; the longest line has 62 steps of four beats, and the load.
    assert!(text.starts_with("5952 runs\n") && text.contains(",249,"), "{text}");
}

#[test]
fn spiral_and_involute_stay_near_their_curves_and_are_simulated_by_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(example("spiral")).arg("spiral.net").current_dir(&folder).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    // 19 radians; no count has overflowed, or it would have ended.
    assert_eq!(text, "311296 clocks; spiral 0.118 BLU off, involute 0.119 BLU off\n");
    let ran = Command::new(env!("CARGO_BIN_EXE_stepwave"))
        .args(["sim", "spiral.net", "--clocks", "311296", "--vcd", "spiral.vcd", "--trace", "x", "--trace", "y"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(ran.status.success(), "{ran:?}");
    // The involute after 19 radians: 10·(cos θ + θ·sin θ), 10·(sin θ - θ·cos θ) BLU.
    let (sin, cos) = 19.0_f64.sin_cos();
    let wave = std::fs::read_to_string(folder.path().join("spiral.vcd")).unwrap();
    let last = |name: &str| {
        let head = wave.lines().find(|line| line.starts_with("$var") && line.contains(&format!(" {name}"))).unwrap();
        let code = head.split_whitespace().nth(3).unwrap();
        let bits =
            wave.lines().rev().find_map(|line| line.strip_suffix(&format!(" {code}"))?.strip_prefix('b')).unwrap();
        let number = i64::from_str_radix(bits, 2).unwrap();
        (if number >= 1 << 14 { number - (1 << 15) } else { number }) as f64 / 64.0
    };
    for (name, exact) in [("x", 10.0 * (cos + 19.0 * sin)), ("y", 10.0 * (sin - 19.0 * cos))] {
        assert!((last(name) - exact).abs() < 0.12, "{name}: {} for {exact}", last(name));
    }
}
