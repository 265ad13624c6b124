//! `stepwave show`: waves in the terminal, ours and those of others.

use super::Folder;

/// What Icarus Verilog 11 writes for a counter whose steps are 3 and, from 22 ns on, -1.
pub(super) const ICARUS: &str = "$date\n\tMon Nov 30 09:38:39 2026\n$end\n$version\n\tIcarus Verilog\n$end\n$timescale\n\t1ps\n$end\n\
    $scope module tb $end\n$var wire 4 ! n [3:0] $end\n$var reg 1 \" clk $end\n$var reg 1 # up $end\n$scope module dut $end\n\
    $var wire 1 \" clk $end\n$var wire 1 # up $end\n$var reg 4 $ n [3:0] $end\n$upscope $end\n$upscope $end\n$enddefinitions $end\n\
    #0\n$dumpvars\nbx $\n1#\n0\"\nbx !\n$end\n#5000\nb0 !\nb0 $\n1\"\n#10000\n0\"\n#15000\nb11 !\nb11 $\n1\"\n#20000\n0\"\n#22000\n0#\n\
    #25000\nb10 !\nb10 $\n1\"\n#30000\n0\"\n#35000\nb1 !\nb1 $\n1\"\n#40000\n0\"\n#45000\nb0 !\nb0 $\n1\"\n#50000\n0\"\n\
    #55000\nb1111 !\nb1111 $\n1\"\n#60000\n0\"\n";

#[test]
fn a_run_is_shown_clock_by_clock_with_the_names_of_its_states() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 3,2 --vcd line.vcd");
    let shown = folder.good("show line.vcd --ascii --to 9 --signals beat --signals f --signals *.x --signals stepped");
    // F of the line to (3, 2): -2 after the X step, judged at clock 1 and computed at clock 4, and +1 four clocks later.
    let wanted = [
        "              0                                       5",
        "beat          |IDLE   |JUDGE  |FEED   |COMPUTE|COMPARE|JUDGE  |FEED   |COMPUTE",
        "f             |0                              |-2",
        r"block.stepped ________________________________________/-------\_______________",
        "axis_x.x      |0              |0",
    ];
    let lines: Vec<&str> = shown.lines().collect();
    assert_eq!(lines[..4], wanted[..4], "{shown}");
    assert_eq!(shown.lines().last(), Some("clock 0 to 9"));
    // In a pipe without colour, and in 80 columns.
    assert!(!shown.contains('\x1b') && shown.lines().all(|line| line.chars().count() <= 80));
    // The registers are those of the step table at its clocks.
    let table = folder.good("run ppc-line --to 3,2 --steps -");
    let shown = folder.good("show line.vcd --columns 1000 --to 21 --ascii --signals *.x --signals *.y");
    for name in ["x", "y"] {
        let column = table.lines().next().unwrap().split(',').position(|head| head == name).unwrap();
        let row = shown.lines().find(|line| line.starts_with(&format!("axis_{name}.{name}"))).unwrap();
        let cell = shown.lines().next().unwrap().find("5").unwrap() - row.find('|').unwrap();
        let cells = &row[row.find('|').unwrap()..];
        let at = |clock: usize| {
            let upto = &cells[..(clock * cell / 5 + 1).min(cells.len())];
            let start = upto.rfind('|').unwrap();
            cells[start + 1..].split('|').next().unwrap().trim().to_owned()
        };
        for line in table.lines().skip(1) {
            let values: Vec<&str> = line.split(',').collect();
            assert_eq!(at(values[1].parse().unwrap()), values[column], "{name} at clock {}\n{shown}", values[1]);
        }
    }
}

#[test]
fn a_wave_of_icarus_is_shown_by_clock_and_by_time() {
    let folder = Folder::new();
    folder.write("c.vcd", ICARUS);
    let shown = folder.good("show c.vcd");
    let wanted = [
        "       0              5",
        "n      │x │0 │3 │2 │1 │0 │15",
        "up     ▔▔▔▔▔▔╲▁▁▁▁▁▁▁▁▁▁▁▁▁▁",
        "dut.up ▔▔▔▔▔▔╲▁▁▁▁▁▁▁▁▁▁▁▁▁▁",
        "dut.n  │x │0 │3 │2 │1 │0 │15",
        "clock 0 to 6",
    ];
    assert_eq!(shown.lines().collect::<Vec<_>>(), wanted);
    let shown = folder.good("show c.vcd --radix signed --ascii --by-time --signals tb.n --signals tb.up --from 22000");
    let wanted = [
        "   22000       30000       40000       50000       60000",
        "n  |3    |2          |1          |0          |-1",
        "up _________________________________________________",
        "time 22000 to 60000, in units of 1 ps",
    ];
    assert_eq!(shown.lines().last(), wanted.last().copied());
    assert!(shown.contains("|-1") && shown.contains("22000"), "{shown}");
}

#[test]
fn what_cannot_be_shown_is_refused_with_the_remedy() {
    let folder = Folder::new();
    folder.write("c.vcd", ICARUS);
    let refused = |words: &str| {
        let ran = folder.run(words);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{ran:?}");
        ran.err
    };
    assert!(refused("show c.vcd --signals q").contains("no signal of c.vcd is called 'q'"));
    assert!(refused("show c.vcd --from 7").contains("nothing is left from clock 7 on: the wave ends at clock 6"));
    assert!(refused("show c.vcd --from 5 --to 3").contains("--to 3 is before --from 5: exchange them"));
    assert!(refused("show c.vcd --clock tb.nix").contains("nix"));
    assert!(refused("show c.vcd --ignore * --columns 60").contains("no signal of c.vcd is left to show"));
    assert!(refused("show c.vcd --by-time --clock clk").contains("--clock"));
    assert_eq!(folder.files(), ["c.vcd"]);
}

#[test]
fn a_wave_may_come_from_standard_input() {
    let folder = Folder::new();
    folder.write("c.vcd", ICARUS);
    let piped = |words: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_stepwave"))
            .args(words)
            .current_dir(folder.path(""))
            .stdin(std::fs::File::open(folder.path("c.vcd")).unwrap())
            .output()
            .unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    assert_eq!(piped(&["show", "-"]), (Some(0), folder.good("show c.vcd"), String::new()));
    assert_eq!(piped(&["diff", "c.vcd", "-"]).0, Some(0));
    let (code, _, said) = piped(&["diff", "-", "-"]);
    assert!(code == Some(2) && said.contains("standard input is one wave: give the other one as a file"), "{said}");
}
