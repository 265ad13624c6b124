//! `stepwave show`: waves in the terminal, ours and those of others.

use super::Folder;

/// What Icarus Verilog 11 writes for a counter whose steps are 3 and, from 22 ns on, -1.
pub(super) const ICARUS: &str = "$date\n\tMon Nov 30 09:38:39 2026\n$end\n$version\n\tIcarus Verilog\n$end\n$timescale\n\t1ps\n$end\n\
    $scope module tb $end\n$var wire 4 ! n [3:0] $end\n$var reg 1 \" clk $end\n$var reg 1 # up $end\n$scope module dut $end\n\
    $var wire 1 \" clk $end\n$var wire 1 # up $end\n$var reg 4 $ n [3:0] $end\n$upscope $end\n$upscope $end\n$enddefinitions $end\n\
    #0\n$dumpvars\nbx $\n1#\n0\"\nbx !\n$end\n#5000\nb0 !\nb0 $\n1\"\n#10000\n0\"\n#15000\nb11 !\nb11 $\n1\"\n#20000\n0\"\n#22000\n0#\n\
    #25000\nb10 !\nb10 $\n1\"\n#30000\n0\"\n#35000\nb1 !\nb1 $\n1\"\n#40000\n0\"\n#45000\nb0 !\nb0 $\n1\"\n#50000\n0\"\n\
    #55000\nb1111 !\nb1111 $\n1\"\n#60000\n0\"\n";

/// What a command says that is refused and prints nothing else.
fn refused_in(folder: &Folder, words: &str) -> String {
    let ran = folder.run(words);
    assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{ran:?}");
    ran.err
}

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
    let refused = |words: &str| refused_in(&folder, words);
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

#[test]
fn a_model_is_run_and_shown_as_the_wave_that_run_writes() {
    let folder = Folder::new();
    // One of each kind of curve, with names of states, decimal digits, one axis, and the operands of a trap.
    for run in [
        "ppc-line --to 6,4",
        "dda-line --to 8,6 --radix 10",
        "ppc-arc --from 5,0 --to 0,5 --ccw --clock-hz 2e6",
        "sampled-spline --bezier 0,0,30,90,60,-40,90,20",
        "ramp --to 12",
        "ppc-line --to 6,4 --width f=3",
    ] {
        let written = folder.run(&format!("run {run} --vcd w.vcd"));
        for shown in ["", "--trace-from 3 --trace-to 20", "--ascii --columns 60 --values hex", "--by-time"] {
            let (ours, theirs) =
                (folder.run(&format!("show {run} {shown}")), folder.good(&format!("show w.vcd {shown}")));
            // Where one number is a point, the option of a clock has another name.
            assert_eq!(ours.out.replace("more: --trace-from", "more: --from"), theirs, "{run} {shown}");
            assert_eq!((ours.code, &ours.err), (written.code, &written.err), "{run} {shown}");
        }
        folder.files().iter().for_each(|file| std::fs::remove_file(folder.path(file)).unwrap());
    }
    // Nothing was written, but for what is asked for.
    folder.good("show ppc-line --to 6,4 --svg line.svg");
    assert_eq!(folder.files(), ["line.svg"]);
}

#[test]
fn names_of_states_come_through_a_pipe_in_comments_of_the_wave() {
    let folder = Folder::new();
    let piped = folder.good("run ppc-arc --from 5,0 --to 0,5 --ccw --vcd -");
    assert!(piped.contains("\n$comment state beat 0001 JUDGE $end\n$comment state beat 0010 FEED $end\n"), "{piped}");
    folder.good("run ppc-arc --from 5,0 --to 0,5 --ccw --vcd file.vcd");
    let file = folder.read("file.vcd");
    // A file has its names next to it, and no comment more than it had.
    assert_eq!(file.matches("$comment").count(), 1);
    let without: String =
        piped.lines().filter(|line| !line.starts_with("$comment state")).map(|line| format!("{line}\n")).collect();
    assert_eq!(without, file);
    // The wave alone, in another folder, is shown as the file with what lies next to it.
    let other = Folder::new();
    other.write("piped.vcd", &piped);
    for shown in ["", "--by-time", "--values hex --from 3 --to 40"] {
        assert_eq!(
            other.good(&format!("show piped.vcd {shown}")),
            folder.good(&format!("show file.vcd {shown}")),
            "{shown}"
        );
    }
    // Comments of others are prose, whatever they begin with.
    let odd =
        piped.replace("$comment state beat 0001 JUDGE $end", "$comment state of the art $end $comment state $end");
    other.write("odd.vcd", &odd);
    assert!(!other.good("show odd.vcd").contains("JUDGE"));
}

#[test]
fn a_run_of_many_clocks_is_recorded_as_far_as_it_is_shown() {
    let folder = Folder::new();
    // All of it would be a wave of more than 1 GB. The clocks by hand: one that loads, 2^24 additions, and what is pending.
    let long = folder.run("show dda-line --to 16777215,3 --width 24 --columns 60");
    assert_eq!(long.code, 0, "{}", long.err);
    let [.., last] = &long.out.lines().collect::<Vec<_>>()[..] else { panic!("{}", long.out) };
    let count = |word: &str| last.split(word).nth(1).and_then(|rest| rest.split(|c: char| !c.is_ascii_digit()).next());
    let [to, more] = ["clock 0 to ", "; "].map(|word| count(word).unwrap().parse::<u64>().unwrap());
    assert_eq!(to + more, (1 << 24) + 1, "{last}");
    // And from where it is shown: the down-counter of steps is at 0 in the last sample, and at k in that k clocks before.
    let late = folder.run("show dda-line --to 16777215,3 --width 24 --from 16777210 --signals e");
    assert_eq!(late.code, 0, "{}", late.err);
    let says = ["e │7│6│5│4│3│2│1│0", "clock 16777210 to 16777217"];
    assert_eq!(late.out.lines().skip(1).collect::<Vec<_>>(), says);
    let none = refused_in(&folder, "show dda-line --to 16777215,3 --width 24 --from 16777218");
    assert!(none.contains("nothing is left from clock 16777218 on: no clock from 0 to 16777217 "), "{none}");
}

#[test]
fn edges_of_another_signal_are_those_of_the_whole_run() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 6,4 --vcd w.vcd");
    for more in ["", " --to 5", " --from 2 --to 4"] {
        let clock = format!("--clock ppc_line.block.stepped --signals e --signals x{more}");
        let shown = folder.good(&format!("show ppc-line --to 6,4 {clock}"));
        assert_eq!(shown, folder.good(&format!("show w.vcd {clock}")));
    }
    // A wave without a clock is drawn by time, as `show` calls it.
    folder.good("run ppc-line --to 6,4 --no-clk --vcd still.vcd");
    for clock in ["", " --clock nope"] {
        let refused = refused_in(&folder, &format!("show still.vcd{clock}"));
        assert!(refused.contains("--by-time") && !refused.contains("--by time"), "{refused}");
        assert_eq!(refused.matches("still.vcd").count(), 1, "{refused}");
    }
    // A step is fewer clocks than its number counts: 10 of them, and the count of the first sample.
    let shown = folder.good("show ppc-line --to 6,4 --clock ppc_line.block.stepped --signals e --to 9");
    assert_eq!(shown.lines().last(), Some("clock 0 to 9"));
}

#[test]
fn an_option_given_twice_is_named_as_its_user_wrote_it() {
    let folder = Folder::new();
    for (words, says) in [
        (
            "show dda-line --to 8,6 --to 3 --to 4",
            "the argument '--to <N> or --trace-to <N>' cannot be used multiple times",
        ),
        (
            "show dda-line --to 8,6 --from 3 --from 4",
            "the argument '--from <N> or --trace-from <N>' cannot be used multiple times",
        ),
        (
            "show dda-line --to 8,6 --radix hex --radix hex",
            "the argument '--radix <FORM> or --values <FORM>' cannot be used multiple times",
        ),
    ] {
        let said = refused_in(&folder, words);
        assert!(said.contains(says), "{said}");
    }
}

#[test]
fn one_number_is_a_clock_and_numbers_with_commas_are_a_point() {
    let folder = Folder::new();
    let shown = folder.good("show dda-line --to 8,6 --to=7 --from 2,1 --from 4 --signals e --radix hex");
    assert_eq!(
        shown,
        folder.good("show dda-line --from 2,1 --to 8,6 --trace-from 4 --trace-to 7 --signals e --values hex")
    );
    assert_eq!(shown.lines().last(), Some("clock 4 to 7"));
    // Of one axis a number is its travel.
    let shown = folder.good("show ramp --to 12 --trace-to 3");
    assert_eq!(shown.lines().last(), Some("clock 0 to 3"));
    // What is advised shows the next clocks of the same run.
    let advice = |shown: String| shown.lines().last().unwrap_or_default().split("more: ").nth(1).unwrap().to_owned();
    let next = advice(folder.good("show ramp --to 100")).replace(" shows the next", "");
    assert_eq!(next, "--trace-from 13");
    let shown = folder.good(&format!("show ramp --to 100 {next}"));
    assert!(shown.lines().last().unwrap().starts_with("clock 13 to 25; "), "{shown}");
    assert!(advice(folder.good("show dda-line --to 100,30")).starts_with("--from "));
}

#[test]
fn a_name_that_is_no_wave_and_no_model_is_refused_with_what_is_near() {
    let folder = Folder::new();
    folder.write("c.vcd", ICARUS);
    let refused = |words: &str| refused_in(&folder, words);
    let near = refused("show dda-lin --to 8,6");
    assert!(near.contains("dda-lin is neither the file of a wave nor a model"), "{near}");
    assert!(near.contains("did you mean 'dda-line'?") && near.contains("give the path of a VCD or FST"), "{near}");
    // The ending says that a wave is meant, whether it is there or not.
    assert!(refused("show dda-line.vcd").contains("dda-line.vcd: cannot be read"));
    assert!(refused("show c.vcd --to 8,6").contains("--to is of the run of a model, and c.vcd is the file of a wave"));
    assert!(refused("show c.vcd --width 4").contains("--width is of the run of a model"));
    assert!(refused("show dda-line --to 8,6 --from 99").contains("nothing is left from clock 99 on"));
    assert!(refused("show dda-line --to 8,6 --center 1,1").contains("--center"));
    assert_eq!(folder.files(), ["c.vcd"]);
    // A file of the name of a model is what is shown.
    folder.write("dda-line", ICARUS);
    assert_eq!(folder.good("show dda-line"), folder.good("show c.vcd"));
}

#[test]
fn a_netlist_of_ones_own_is_run_and_shown() {
    let folder = Folder::new();
    folder.good("export dda-line --to 8,6 --width 4 --netlist own.net");
    let refused = folder.run("show own.net --to 8,6");
    assert_eq!(refused.code, 2, "{refused:?}");
    assert!(refused.err.contains("own.toml"), "{}", refused.err);
}
