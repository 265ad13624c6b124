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
fn the_same_command_writes_the_same_bytes() {
    let text = |folder: Folder| {
        folder.good(&format!("export {ARC} --verilog a.v --testbench b.v"));
        folder.read("a.v") + &folder.read("b.v")
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
    assert_eq!(folder.files(), [""; 0]);
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
        ("export ppc-line --to 6,4 --verilog a.v --blu 1um", "unexpected argument '--blu'"),
        ("export ppc-line --verilog a.v", "the end point is missing"),
        ("export ppc-line --to 6,4 --preset half --verilog a.v", "--preset"),
        ("export ppc-line --to 6,4 --width 2 --verilog a.v", "--width"),
        ("export nothing --to 6,4 --verilog a.v", "nothing"),
        ("export ppc-line --to 6,4 --verilog a.v --testbench a.v", "give each its own file"),
        ("export ppc-line --to 6,4 --verilog a.v --testbench no/b.v", "no/b.v"),
        ("export ppc-line --to 6,4 --verilog - --testbench -", "standard output"),
    ] {
        let folder = Folder::new();
        let ran = folder.run(words);
        assert_eq!(ran.code, 2, "{words}: {ran:?}");
        assert!(ran.err.contains(hint), "{words}: {ran:?}");
        assert_eq!(folder.files(), [""; 0], "{words}");
    }
}
