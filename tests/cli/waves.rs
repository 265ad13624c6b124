//! `stepwave diff` on what other programs write.

use std::fs;
use std::io::Write;
use std::process::Stdio;
use std::time::{Duration, Instant};

use super::{Folder, Ran};

fn header(timescale: &str, vars: &str) -> String {
    format!("$timescale {timescale} $end\n$scope module top $end\n{vars}\n$upscope $end\n$enddefinitions $end\n")
}

fn folder(files: &[(&str, &str)]) -> Folder {
    let folder = Folder::new();
    files.iter().for_each(|(name, text)| fs::write(folder.path(name), text).unwrap());
    folder
}

#[test]
fn a_tenth_of_a_picosecond_is_100_femtoseconds() {
    let wave = |unit| header(unit, "$var wire 1 ! clk $end") + "#0\n0!\n#1\n1!\n#2\n0!\n";
    let folder = folder(&[("a.vcd", &wave("0.1ps")), ("b.vcd", &wave("100fs")), ("c.vcd", &wave("1 tick"))]);
    assert_eq!(folder.good("diff a.vcd b.vcd --by time"), "same: 1 signal up to 200 fs\n");
    let ran = folder.run("diff a.vcd c.vcd --by time");
    assert_eq!(ran.code, 2);
    assert!(ran.err.starts_with("stepwave: c.vcd: line 1: `$timescale 1 tick` cannot be read"), "{}", ran.err);
}

#[test]
fn enumerations_of_myhdl_are_compared_as_texts_or_left_out() {
    let wave = |state: &str| {
        header("1ns", "$var wire 1 ! clk $end\n$var real 1 # state $end")
            + &format!("#0\n0!\nsIDLE #\n#1\n1!\ns{state} #\n")
    };
    let folder = folder(&[("a.vcd", &wave("RUN")), ("b.vcd", &wave("STOP"))]);
    assert_eq!(folder.good("diff a.vcd a.vcd --by time"), "same: 2 signals up to 1 ns\n");
    assert_eq!(folder.good("diff a.vcd b.vcd --by time --ignore state"), "same: 1 signal up to 1 ns\n");
    let ran = folder.run("diff a.vcd b.vcd --by time");
    assert_eq!(ran.code, 1);
    assert!(ran.out.contains("signal top.state\n  A  \"RUN\"\n  B  \"STOP\""), "{}", ran.out);
}

#[test]
fn extended_vcd_is_refused_with_its_line() {
    let text = "$timescale 1ns $end\n$var port 1 <0 bit $end\n$enddefinitions $end\n#0\npD 6 6 <0\n";
    let ran = folder(&[("a.vcd", text)]).run("diff a.vcd a.vcd --by time");
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("a.vcd: line 5: extended VCD ($dumpports) is not supported"), "{}", ran.err);
}

#[test]
fn nothing_precedes_a_merged_wave() {
    let vars = "$var wire 1 ! clk $end\n$attrbegin misc 02 STRING 1040 $end\n$var string 1 # s $end\n\
                $attrbegin misc 02 UNSIGNED 2056 $end\n$var wire 4 % u [3:0] $end\n\
                $attrbegin misc 02 CHARACTER 3087 $end\n$var wire 8 & c [7:0] $end";
    let text = header("1ns", vars) + "#0\n0!\nsA #\nb1 %\nb1 &\n#1\n1!\nsB #\n";
    let out = folder(&[("a.vcd", &text)]).good("diff a.vcd a.vcd --merged -");
    assert!(out.starts_with("$version stepwave $end\n$comment"), "{out}");
    assert!(out.ends_with("sB \"\nsB %\n"), "{out}");
}

#[test]
fn a_wave_without_a_clock_names_the_bits_that_could_be_one() {
    let text =
        header("1ns", "$var wire 1 ! osc $end\n$var wire 1 # en $end") + "#0\n0!\n0#\n#1\n1!\n1#\n#2\n0!\n#3\n1!\n";
    let ran = folder(&[("a.vcd", &text)]).run("diff a.vcd a.vcd");
    assert_eq!(ran.code, 2);
    let named = "those that rise most are top.osc (2 rising edges), top.en (1 rising edge): name the clock with --clock, or \
        compare with --by time";
    assert!(ran.err.contains(named), "{}", ran.err);
}

#[test]
fn a_small_wave_of_great_width_takes_no_time() {
    let mut text = header("1 ns", "$var wire 1048576 ! q $end\n$var wire 1 c clk $end");
    (0..4000).for_each(|time| text += &format!("#{time}\nb{} !\n{}c\n", time % 2, time % 2));
    let folder = folder(&[("a.vcd", &text)]);
    let start = Instant::now();
    assert_eq!(folder.good("diff a.vcd a.vcd"), "same: 1 signal over 2001 cycles\n");
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

#[test]
fn a_device_is_refused_and_a_pipe_is_read() {
    let text = header("1 ns", "$var wire 1 ! clk $end\n$var wire 1 # q $end") + "#0\n0!\n0#\n#1\n1!\n1#\n";
    let folder = folder(&[("a.vcd", &text)]);
    for device in ["/dev/zero", "/dev/urandom", "/dev/null"] {
        let ran = folder.run(&format!("diff {device} a.vcd"));
        assert_eq!(
            (ran.code, ran.err),
            (2, format!("stepwave: {device}: it is a device, not a wave: name a file or a pipe\n"))
        );
    }
    let mut child = folder.command();
    let mut child =
        child.args(["diff", "/dev/stdin", "a.vcd"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    assert_eq!(Ran::new(child.wait_with_output().unwrap()).out, "same: 1 signal over 2 cycles\n");
}

#[test]
fn braces_within_braces_are_no_crash() {
    let text = header("1 ns", "$var wire 1 ! clk $end\n$var wire 1 # q $end") + "#0\n0!\n0#\n#1\n1!\n1#\n";
    let folder = folder(&[("a.vcd", &text)]);
    for glob in ["{{{{", "{{{{{{{{{{{{q}}}}}}}}}}}}", &"{".repeat(10_000), "{,}{,", "[", "\\"] {
        let ran = folder.run_words(&["diff", "a.vcd", "a.vcd", "--signals", glob]);
        assert_eq!(ran.code, 2, "{ran:?}");
        let ran = folder.run_words(&["run", "dda-line", "--to", "3,2", "--vcd", "w.vcd", "--trace", glob]);
        assert_eq!(ran.code, 2, "{ran:?}");
    }
}
