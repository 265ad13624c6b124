//! What other programs write, and what no reader should guess.

use super::super::blocks::Format;
use super::super::decode;
use super::{Timescale, ValueKind, Wave, error, file, wave};
use std::fmt::Write;
use std::time::{Duration, Instant};

fn shown(wave: &Wave, path: &str, time: u64) -> String {
    let signal = wave.find(path).unwrap_or_else(|| panic!("{path} in {:?}", wave.signals()));
    wave.value_at_time(signal, time).expect("a signal").to_string()
}

#[test]
fn a_time_scale_is_read_exactly_or_refused_with_its_line() {
    let scale = |text: &str| wave(&file("", "").replace("1 ns", text)).timescale();
    assert_eq!(scale("0.1ps"), Some(Timescale { factor: 100, exponent: -15 }));
    assert_eq!(scale("0.1ps"), scale("100\n  fs"));
    assert_eq!(scale("10us"), Some(Timescale { factor: 10, exponent: -6 }));
    let refused = error(file("", "").replace("$timescale 1 ns", "\n$timescale 1 parsec"));
    assert_eq!(
        refused,
        "memory: line 2: `$timescale 1 parsec` cannot be read: the unit `parsec` is not one of s, ms, us, ns, ps, fs, as, \
         zs; write it as 1, 10 or 100 of a unit, as in `1 ns`"
    );
    let twice = file("", "").replacen("$scope", "$timescale 1000 ps $end $timescale 1 us $end $scope", 1);
    assert_eq!(error(twice), "memory: line 2: a $timescale of 1 us, but line 2 has one of 1 ns; leave one");
    assert_eq!(wave("$enddefinitions $end").timescale(), None);
}

#[test]
fn a_declaration_that_contradicts_itself_is_refused_with_its_line() {
    for (vars, refused) in [
        ("$var wire 4 ! q [7:0] $end", "line 3: `m.q [7:0]`: the range [7:0] is not 4 bits wide, as declared"),
        (
            "$var wire 4 ! q $end\n$var wire 8 ! r $end",
            "line 4: `m.r` is 8 bits, but shares its id code `!` with `m.q` of line 3, which is 4 bits",
        ),
        ("$var wire 1 ! q $end $var event 1 ! e $end", "`m.e` is an event, but shares its id code `!` with `m.q`"),
        ("$var real 64 ! q $end $var wire 64 ! e $end", "which is a real"),
        ("$var bus 4 ! q $end", "line 3: `bus`, the type of `m.q`, is not a type of variables"),
        ("$var wire four ! q $end", "line 3: `m.q` is declared `four` bits wide"),
        ("$var wire 4 ! $end", "line 3: `$var wire 4 !` is not a type, a width, an id code and a name"),
        ("$var wire 4 ! q\n$var wire 4 \" r $end", "line 4: `$var` where the $var of line 3 has no $end yet"),
        ("$upscope $end $upscope $end", "$upscope where no scope is open"),
        ("$colour red $end", "line 3: `$colour` is not a command of the header of a VCD"),
        ("#0", "line 3: `#0` comes before $enddefinitions, which ends the header"),
    ] {
        let refusal = error(file(vars, ""));
        assert!(refusal.contains(refused), "{vars}: {refusal}");
    }
}

#[test]
fn a_value_that_is_none_of_its_variable_is_refused_with_line_and_signal() {
    let vars = "$var wire 4 ! q $end $var wire 1 % b $end $var real 64 # r $end $var string 1 $ s $end";
    for (body, refused) in [
        ("b12 !", "`b12` is not a value of `m.q`, which is 4 bits: `2` is not a state of a bit"),
        ("b10 %", "`b10` is not a value of `m.b`, which is 1 bit: it has more digits"),
        ("b !", "it has no digit"),
        ("bu1 !", "it has fewer digits, and no rule extends a leading `u`"),
        ("r1.5 !", "`r1.5` is not a value of `m.q`, which is 4 bits: it is of another kind"),
        ("sIDLE !", "`sIDLE` is not a value of `m.q`, which is 4 bits: it is of another kind"),
        ("b1 #", "`b1` is not a value of `m.r`, which is a real: it is of another kind"),
        ("rone #", "`rone` is not a value of `m.r`, which is a real: it is not a number"),
        ("r1 # sIDLE #", "`sIDLE` is not a value of `m.r`, which is a real: it is of another kind"),
        ("b1 $", "`b1` is not a value of `m.s`, which is a string"),
        ("?!", "`?!` is not a change of a value"),
        ("1 !", "for the id code ``"),
        ("$dumpsome", "`$dumpsome` is not a command among changes of values"),
        (
            "#18446744073709551616",
            "`#18446744073709551616` is not a time, a whole number from 0 to 18446744073709551615",
        ),
        ("#9007199254740993e0", "is not a time"),
        ("#1.5", "`#1.5` is not a time"),
    ] {
        let refusal = error(file(vars, &format!("#0\n{body}")));
        assert!(refusal.starts_with("memory: line 7: ") && refusal.contains(refused), "{body}: {refusal}");
    }
}

#[test]
fn enumerations_of_myhdl_are_texts_and_parameters_are_what_their_values_are() {
    let vars = "$var real 1 # state $end $var real 64 % r $end $var parameter 64 ! P $end $var parameter 8 \" N $end";
    let wave = wave(&file(vars, "#0 sIDLE # r0.5 % r2.5 ! b101 \" #1 sRUN #"));
    assert_eq!(shown(&wave, "m.state", 0), "\"IDLE\"");
    assert_eq!(shown(&wave, "m.state", 1), "\"RUN\"");
    assert_eq!((shown(&wave, "m.r", 0), shown(&wave, "m.P", 0)), ("0.5".into(), "2.5".into()));
    assert_eq!(shown(&wave, "m.N", 0), "00000101 (5)");
    let kinds: Vec<ValueKind> = wave.signals().iter().map(|signal| signal.kind).collect();
    assert_eq!(kinds, [ValueKind::Text, ValueKind::Real, ValueKind::Real, ValueKind::Unsigned]);
}

#[test]
fn extended_vcd_is_named() {
    for (body, line) in
        [("#0\npD 6 6 <0", 7), ("$dumpports\npU 6 6 <0", 6), ("#0 $dumpportsoff", 6), ("$vcdclose #1 $end", 6)]
    {
        let refusal = error(file("$var port 1 <0 bit $end", body));
        let place = format!("memory: line {line}: extended VCD ($dumpports) is not supported");
        assert!(refusal.starts_with(&place), "{refusal}");
    }
}

#[test]
fn what_follows_the_end_of_the_header_on_its_line_is_read_too() {
    let wave = wave("$timescale 1ns$end $var wire 1 ! q $end $enddefinitions $end #3 1!\n#4.0 0! #1e1 x!");
    assert_eq!(wave.times(), [3, 4, 10]);
    assert_eq!(
        (shown(&wave, "q", 3), shown(&wave, "q", 9), shown(&wave, "q", 10)),
        ("1".into(), "0".into(), "x".into())
    );
}

#[test]
fn attributes_of_vhdl_print_nothing_and_their_signed_types_count() {
    let vars = "$attrbegin misc 02 STRING 1040 $end $var string 1 ! s $end
        $attrbegin misc 02 SIGNED 1033 $end $var wire 4 \" i [3:0] $end
        $attrbegin misc 07 state 1 IDLE 0 1 $end $attrbegin misc 02 UNSIGNED 2056 $end $var wire 4 # u [3:0] $end $attrend $end";
    let wave = wave(&file(vars, "#0 sA ! b1111 \" b1111 #"));
    assert_eq!((shown(&wave, "m.i", 0), shown(&wave, "m.u", 0)), ("1111 (-1)".into(), "1111 (15)".into()));
}

#[test]
fn a_vector_declared_bit_by_bit_is_whole() {
    let vars = "$var wire 1 a q [3] $end $var wire 1 b q [2] $end $var wire 2 c q [1:0] $end $var wire 1 d r [0] $end";
    let wave = wave(&file(vars, "#0 1a 0b b01 c 1d #1 1b b10 c"));
    assert_eq!((shown(&wave, "m.q", 0), shown(&wave, "m.q", 1)), ("1001 (9)".into(), "1110 (14)".into()));
    assert_eq!(wave.signals().len(), 2);
    assert_eq!((wave.signals()[0].width, shown(&wave, "m.r", 1)), (4, "1".into()));
}

#[test]
fn a_wave_without_a_clock_names_the_bits_that_rise_most_often() {
    let vars = "$var wire 1 a slow $end $var wire 1 b osc $end $var wire 1 b osc2 $end $var wire 2 c bus $end $var wire 1 d flat $end";
    let mut body = String::from("#0 0a 0b b0 c 0d");
    for time in 1..20 {
        let _ = write!(body, " #{time} {}b {}a b{:b} c", time % 2, time / 4 % 2, time % 4);
    }
    let problem = wave(&file(vars, &body)).cycles().expect_err("no clock").to_string();
    assert_eq!(
        problem,
        "memory: no 1-bit signal named clk or clock; those that rise most are m.osc (10 rising edges), m.slow (2 rising edges)"
    );
}

/// Reads in linear time, or this takes minutes.
fn soon<T>(work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    result
}

#[test]
fn a_small_file_takes_little_time_and_memory_or_is_refused_by_its_limit() {
    let repeated = |line: &dyn Fn(u32) -> String| (0..20_000).map(line).collect::<Vec<_>>().join("\n");
    let wide = repeated(&|time| format!("#{time}\nb{} !", time % 2));
    let wide = soon(|| wave(&file("$var wire 1048576 ! q $end", &wide)));
    assert_eq!(shown(&wide, "m.q", 7), "1048576'b1");

    let same = repeated(&|number| format!("$var wire 1 i{number} q $end"));
    let same = soon(|| wave(&file(&same, "")));
    assert_eq!(same.signals().last().map(|signal| signal.path.as_str()), Some("m.q#20000"));

    let line = error(file("", &" ".repeat(33 << 20)));
    assert_eq!(line, "memory: line 6: a line of more than 32 MiB cannot be read; break it at any blank");
    let deep = "$scope module s $end ".repeat(300);
    assert!(error(file(&deep, "")).contains("more than 256 scopes within one another cannot be read"));
    let long = format!("$scope module {} $end", "s".repeat(5000));
    assert!(error(file(&long, "")).contains("a path of more than 4096 bytes"));
    let vars = repeated(&|number| format!("$var wire 1 {number} q $end"));
    let paths = format!("$scope module {} $end {vars}", "s".repeat(4000));
    assert!(error(file(&paths, "")).contains("the signals and their paths take more than"));

    let bits = repeated(&|bit| format!("$var wire 1 i{bit} q [{}] $end", 20_000 - bit));
    let body = repeated(&|time| format!("#{time}\n{}i7", time % 2));
    assert!(soon(|| error(file(&bits, &body))).contains("`m.q` is declared bit by bit, 20000 bits"));
}

/// Gives lines and lines.
struct Endless;

impl std::io::Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        buffer.fill(b'x');
        if let Some(last) = buffer.last_mut() {
            *last = b'\n';
        }
        Ok(buffer.len())
    }
}

#[test]
fn a_pipe_without_an_end_is_refused_by_its_limit() {
    let head = b"$comment ".to_vec();
    let refused = soon(|| decode::piped(head, Endless, Format::Vcd, "pipe".into())).expect_err("no end").to_string();
    assert_eq!(refused, "pipe: it gives more than 256 MiB, the limit for a pipe; write it to a file first");
    let text = file("$var wire 1 ! clk $end", "#0 0! #1 1!");
    let (head, rest) = text.as_bytes().split_at(20);
    let wave = decode::piped(head.to_vec(), rest, Format::Vcd, "pipe".into()).expect("a wave");
    assert_eq!(wave.cycles(), Ok(2));
}
