//! `stepwave export`.

use crate::cli::Folder;

const ARC: &str = "ppc-arc --from 5,-3 --to -5,3 --ccw";

#[test]
fn module_and_bench_are_written_and_counted() {
    let folder = Folder::new();
    let printed = folder.good("export dda-line --to 8,6 --width 4 --verilog line.v --testbench line_tb.v");
    assert_eq!(printed, "dda_line: 15 registers of 42 bits together, 11 inputs, 12 outputs\n");
    assert_eq!(folder.files(), ["line.v", "line_tb.v"]);
    assert!(folder.read("line.v").contains("            reg [3:0] jrx;\n"));
    assert!(folder.read("line_tb.v").contains("$dumpfile(\"line_tb.vcd\");"));
}

#[test]
fn a_harness_has_a_register_for_every_bit_of_the_ports_and_flags_can_be_left_out() {
    let ports = |words: &str| {
        let folder = Folder::new();
        folder.good(&format!("export {words} --verilog m.v --harness h.v"));
        let (module, harness) = (folder.read("m.v"), folder.read("h.v"));
        let of = |text: &str, start: &str| -> u64 {
            let lines = text.lines().skip_while(|line| !line.starts_with("module ")).map(str::trim);
            let lines = lines.take_while(|line| *line != ");").filter(|line| line.starts_with(start));
            let bits = |line: &str| {
                line.split_once('[')
                    .and_then(|(_, rest)| rest.split_once(':'))
                    .map(|(top, _)| top.parse::<u64>().unwrap() + 1)
            };
            lines.map(|line| bits(line).unwrap_or(1)).sum()
        };
        // Clock and reset have pins of their own.
        let (inputs, outputs) = (of(&module, "input") - 2, of(&module, "output"));
        assert!(
            harness.contains(&format!("    reg [{}:0] in;\n    wire [{}:0] out;\n", inputs - 1, outputs - 1)),
            "{harness}"
        );
        assert_eq!((of(&harness, "input"), of(&harness, "output")), (3, 1), "{harness}");
        let last = |word: &str, bits: u64| harness.contains(&format!("{word}[{}:", bits - 1));
        assert!(last("(in", inputs) && last("(out", outputs), "{harness}");
        (module.matches("_overflow").count(), outputs)
    };
    let arc = |more: &str| ports(&format!("{ARC}{more}"));
    let ((all, with), (fewer, without)) = (arc(""), arc(" --no-flags"));
    assert!(fewer < all && without < with, "{fewer} of {all}, {without} of {with}");
    // Words of more than 64 bits are one port.
    ports("sampled-spline --bezier 0,0,50,80,100,0 --step 20");
}

#[test]
fn the_same_command_writes_the_same_bytes() {
    let text = |folder: Folder| {
        folder.good(&format!("export {ARC} --verilog a.v --testbench b.v --btor2 c.btor2 --smt2 d.smt2"));
        ["a.v", "b.v", "c.btor2", "d.smt2"].map(|file| folder.read(file)).concat()
    };
    assert_eq!(text(Folder::new()), text(Folder::new()));
}

#[test]
fn standard_output_holds_the_file_alone() {
    let folder = Folder::new();
    let verilog = folder.good(&format!("export {ARC} --verilog -"));
    assert!(verilog.starts_with("// ppc-arc; ") && verilog.ends_with("endmodule\n"), "{verilog}");
    let bench = folder.good(&format!("export {ARC} --testbench -"));
    assert!(bench.contains("$dumpfile(\"ppc_arc_tb.vcd\");"), "{bench}");
    let model = folder.good(&format!("export {ARC} --btor2 -"));
    assert!(model.starts_with("; ppc-arc; ") && model.ends_with("_overflow\n"), "{model}");
    let question = folder.good(&format!("export {ARC} --smt2 -"));
    assert!(question.starts_with("; ppc-arc; ") && question.ends_with("(check-sat)\n"), "{question}");
    assert_eq!(folder.files(), [""; 0]);
}

#[test]
fn a_question_reaches_to_the_end_of_the_run_unless_another_clock_is_given() {
    let asked = |words: &str| {
        let folder = Folder::new();
        let printed = folder.good(&format!("export {words} --smt2 q.smt2"));
        let last = printed.lines().last().unwrap().to_owned();
        let clock = last.strip_prefix("asked is whether a property is violated in one of the clocks 0 to ").unwrap();
        let text = folder.read("q.smt2");
        assert!(text.contains(&format!("\n; Clock {clock}.\n")), "{words}");
        assert_eq!(text.matches("\n; Clock ").count(), 1 + clock.parse::<usize>().unwrap(), "{words}");
        clock.to_owned()
    };
    assert_eq!(asked("ppc-line --to 6,4"), "41");
    // Trapped there: see the tests of overflows.
    assert_eq!(asked("ppc-line --to 6,4 --width f=3"), "15");
    assert_eq!(asked("ppc-line --to 6,4 --depth 3"), "3");
    assert_eq!(asked("ppc-line --to 6,4 --depth 0"), "0");
    // Days of clocks.
    assert_eq!(asked("dda-line --to 8,6 --width 50"), "1000");
}

#[test]
fn load_words_are_those_of_the_geometry_unless_they_are_left_open() {
    let inputs = |words: &str| {
        let text = Folder::new().good(&format!("export {words} --smt2 - --depth 1"));
        let model = Folder::new().good(&format!("export {words} --btor2 -"));
        assert!(!model.contains(" input "), "{model}");
        // One constant for all clocks.
        let constant =
            |line: &str| line.strip_prefix("(declare-const ").map(|rest| rest.split(' ').next().unwrap().to_owned());
        let held: Vec<String> = text.lines().filter_map(constant).filter(|name| !name.contains('@')).collect();
        // A state without a first value that keeps what it has.
        let first = |name: &&String| {
            let state = model.lines().find(|line| line.ends_with(&format!(" {name}"))).unwrap();
            let number = state.split(' ').next().unwrap();
            let next =
                model.lines().find(|line| line.contains(" next ") && line.ends_with(&format!(" {number} {number}")));
            state.contains(" state ") && next.is_some() && !model.contains(&format!("init 1 {number} "))
        };
        assert_eq!(held.iter().filter(first).count(), held.len(), "{model}");
        held
    };
    let line = "ppc-line --to 6,4";
    assert_eq!(inputs(line), [""; 0]);
    assert_eq!(inputs(&format!("{line} --any-geometry=xe,ye")), ["ppc_line.block.xe_in", "ppc_line.block.ye_in"]);
    assert_eq!(inputs(&format!("{line} --any-geometry")).len(), 8);
}

#[test]
fn a_bench_loads_every_block_and_looks_for_overflow_only_where_it_traps() {
    let steps = |words: &str| {
        let bench = Folder::new().good(&format!("export {words} --testbench -"));
        (bench.matches(": begin\n").count(), bench.matches(" is 1\"").count())
    };
    let dda = "dda-arc --from 5,-3 --to -5,3 --ccw";
    // Three quadrants: each is loaded and run; the first is loaded from the beginning.
    assert_eq!(steps(dda).0, 5);
    assert!(steps(dda).1 > 0);
    assert_eq!(steps(&format!("{dda} --on-overflow wrap")), (5, 0));
    assert_eq!(steps("ppc-line --to 6,4").0, 1);
}

#[test]
fn what_cannot_be_exported_leaves_no_file() {
    for (words, hint) in [
        ("export ppc-line --to 6,4", "--verilog"),
        ("export ppc-line --to 6,4 --verilog a.v --engine word", "unexpected argument '--engine'"),
        ("export ppc-line --verilog a.v", "the end point is missing"),
        ("export ppc-line --to 6,4 --preset half --verilog a.v", "--preset"),
        ("export ppc-line --to 6,4 --width 2 --verilog a.v", "--width"),
        ("export nothing --to 6,4 --verilog a.v", "nothing"),
        ("export ppc-line --to 6,4 --verilog a.v --testbench a.v", "give each its own file"),
        ("export ppc-line --to 6,4 --verilog a.v --testbench no/b.v", "no/b.v"),
        ("export ppc-line --to 6,4 --verilog - --testbench -", "standard output"),
        ("export ppc-line --to 6,4 --btor2 - --smt2 -", "standard output"),
        ("export ppc-line --to 6,4 --btor2 a.btor2 --smt2 no/b", "no/b"),
        ("export ppc-line --to 6,4 --verilog a.v --any-geometry", "--btor2"),
        ("export ppc-line --to 6,4 --btor2 a --depth 3", "--smt2"),
        ("export ppc-line --to 6,4 --smt2 a --depth 100001", "100001"),
        (
            "export ppc-line --to 6,4 --btor2 a --any-geometry=xe,q",
            "no such load word; there are all, e, f, sx, sy, x,",
        ),
    ] {
        let folder = Folder::new();
        let ran = folder.run(words);
        assert_eq!(ran.code, 2, "{words}: {ran:?}");
        assert!(ran.err.contains(hint), "{words}: {ran:?}");
        assert_eq!(folder.files(), [""; 0], "{words}");
    }
}

#[test]
fn a_schematic_is_drawn_of_models_programs_and_netlists_without_a_bench_file() {
    let folder = Folder::new();
    let printed = folder.good("export dda-line --to 8,6 --width 4 --schematic line.svg --netlist line.net");
    assert_eq!(printed.lines().last(), Some("the block diagram has 34 symbols"));
    assert!(folder.read("line.svg").starts_with("<svg "));
    let printed = folder.good("export line.net --schematic again.svg --levels 0");
    let closed = ", scopes 0 of 1 levels deep: --levels 1 opens more of them, --scope PATH draws one of block, axis_x, axis_y \
                  alone\n";
    assert!(printed.starts_with("dda_line: ") && printed.ends_with(closed), "{printed}");
    folder.good("export line.net --schematic axis.svg --scope axis_x");
    assert!(folder.read("axis.svg").contains(">jrx<") && !folder.read("axis.svg").contains(">jry<"));
    let piped = folder.good("export line.net --schematic -");
    assert!(piped.starts_with("<svg ") && piped.ends_with("</svg>\n"), "{piped}");
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let folder = Folder::new();
    folder.good("export dda-line --to 8,6 --netlist line.net");
    for (more, message) in [
        ("--scope axis_w", "no scope is called 'axis_w' (did you mean 'axis_x'?)"),
        ("--scope wave", "no scope is called 'wave'; there are block, axis_x, axis_y"),
        ("--width 4", "line.net is drawn as it is: leave --width out, or give a geometry for its bench file"),
    ] {
        let ran = folder.run(&format!("export line.net --schematic f.svg {more}"));
        assert_eq!((ran.code, ran.err), (2, format!("stepwave: {message}\n")));
    }
    let ran = folder.run("export line.net --schematic ./line.net");
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(folder.read("line.net").starts_with("netlist dda_line"));
}
