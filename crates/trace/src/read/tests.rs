mod foreign;
mod inflated;

use super::{ClockError, Timescale, ValueKind, Wave, WaveError};
use std::fmt::Write;

/// A counter that counts clocks, as a simulator would dump it.
#[derive(Clone)]
pub(crate) struct Counter {
    pub(crate) unit: &'static str,
    pub(crate) period: u64,
    /// From the edge to the change of the outputs.
    pub(crate) delay: u64,
    pub(crate) cycles: u64,
    pub(crate) scopes: &'static [&'static str],
    pub(crate) width: u32,
    pub(crate) start: u64,
    /// The cycle in which bit 2 of the count is wrong.
    pub(crate) flip: Option<u64>,
}

pub(crate) const COUNTER: Counter = Counter {
    unit: "1 ns",
    period: 10,
    delay: 0,
    cycles: 12,
    scopes: &["dda_line", "x"],
    width: 4,
    start: 0,
    flip: None,
};

impl Counter {
    pub(crate) fn vcd(&self) -> String {
        let Self { unit, period, delay, cycles, scopes, width, start, flip } = self;
        let mut out = format!("$timescale {unit} $end\n");
        let mut line = |text: String| writeln!(out, "{text}").expect("a string takes all");
        scopes.iter().for_each(|scope| line(format!("$scope module {scope} $end")));
        line("$var wire 1 ! clk $end".into());
        line(format!("$var reg {width} \" count [{}:0] $end", width - 1));
        line("$var wire 1 # odd $end\n$var integer 8 $ e $end".into());
        scopes.iter().for_each(|_| line("$upscope $end".into()));
        line("$enddefinitions $end".into());
        for k in 0..*cycles {
            line(format!("#{}\n{}!", k * period, u8::from(k > 0)));
            if *delay > 0 {
                line(format!("#{}", k * period + delay));
            }
            let count = k + start;
            let shown = (count ^ if *flip == Some(k) { 4 } else { 0 }) % (1 << width);
            line(format!("b{shown:b} \"\n{}#\nb{:08b} $", count % 2, (256 - count) % 256));
            line(format!("#{}\n0!", k * period + period / 2));
        }
        line(format!("#{}", cycles * period));
        out
    }

    pub(crate) fn wave(&self) -> Wave {
        wave(&self.vcd())
    }
}

pub(crate) fn wave(text: &str) -> Wave {
    Wave::from_bytes(text.into()).expect("a wave")
}

/// A header around variables, and a body.
pub(crate) fn file(vars: &str, body: &str) -> String {
    format!("$timescale 1 ns $end\n$scope module m $end\n{vars}\n$upscope $end\n$enddefinitions $end\n{body}\n")
}

fn error(text: impl Into<Vec<u8>>) -> String {
    Wave::from_bytes(text.into()).expect_err("no wave").to_string()
}

/// The samples of a signal, one after the other.
fn row(wave: &Wave, path: &str) -> String {
    let signal = wave.find(path).expect("the signal");
    let cycles = 0..wave.cycles().expect("a clock");
    let cell = |cycle| wave.value_at_cycle(signal, cycle).expect("a clock").expect("a cycle").cell();
    cycles.map(cell).collect::<Vec<_>>().join(" ")
}

#[test]
fn a_sample_is_the_value_held_just_before_the_next_rising_edge() {
    let vars = "$var wire 1 ! clk $end $var wire 4 \" q $end";
    // Changes at the edge, later in the cycle, twice at one time, and at the falling edge.
    let body = "#0 0! b1 \" #5 1! b10 \" #7 b11 \" #10 0! #15 1! b100 \" b101 \" #20 0! b110 \" #25 1! #30 0! b111 \"";
    let wave = wave(&file(vars, body));
    assert_eq!(row(&wave, "m.q"), "0001 0011 0110 0111");
    assert_eq!(wave.cycles(), Ok(4));
    assert!(wave.value_at_cycle(1, 4).expect("a clock").is_none());
    assert_eq!(wave.value_at_time(1, 6).expect("a signal").to_string(), "0010 (2)");
}

#[test]
fn the_last_cycle_is_sampled_at_the_end_of_the_file() {
    let wave = wave(&file("$var wire 1 ! clk $end $var wire 1 \" q $end", "#0 0! 0\" #5 1! #9 1\""));
    assert_eq!(row(&wave, "m.q"), "0 1");
}

#[test]
fn a_clock_that_is_high_at_first_has_no_edge_there_but_rises_from_x() {
    let wave = wave(&file("$var wire 1 ! clk $end $var wire 4 \" q $end", "#0 1! b1 \" #5 x! #10 1! b10 \" #15 0!"));
    assert_eq!(row(&wave, "m.q"), "0001 0010");
}

#[test]
fn the_clock_is_the_shallowest_clk_or_clock_unless_named() {
    let vars = "$var wire 1 ! phase $end $scope module n $end $var wire 1 \" clk $end $upscope $end
        $var wire 1 # CLOCK $end $var wire 2 $ clk $end";
    let body = "#0 0! 0\" 0# #1 1! #2 0! #3 1! #4 1# #5 0#";
    let open = || wave(&file(vars, body));
    let path = |wave: &Wave| wave.signals()[wave.clock().expect("a clock").signal()].path.clone();
    assert_eq!(path(&open()), "m.CLOCK");
    assert_eq!(open().cycles(), Ok(2));
    let named = open().with_clock("phase").expect("that clock");
    assert_eq!((path(&named), named.cycles()), ("m.phase".into(), Ok(3)));
    let problem = |name: &str| open().with_clock(name).expect_err("no such clock").to_string();
    assert_eq!(problem("hase"), "memory: no signal `hase` to use as the clock");
    assert_eq!(problem("m.clk"), "memory: `m.clk` cannot be the clock: it is not one bit");
    assert_eq!(problem("n.clk"), "memory: the clock `m.n.clk` never rises");
}

#[test]
fn a_file_without_a_clock_is_read() {
    let wave = wave(&file("$var wire 1 ! q $end", "#0 0! #1 1!"));
    let problem = wave.cycles().expect_err("no clock");
    assert!(matches!(&problem, ClockError::None { name, .. } if name == "memory"));
    assert_eq!(
        problem.to_string(),
        "memory: no 1-bit signal named clk or clock; those that rise most are m.q (1 rising edge)"
    );
}

#[test]
fn values_read_by_the_kind_of_their_variable() {
    let vars = "$var reg 4 a u [3:0] $end $var integer 4 b i $end $var real 64 c r $end $var string 1 d s $end
        $var event 1 e ev $end $var wire 3 f x $end $var wire 130 g wide $end $var wire 1 h never $end";
    let body = "#0 b110 a b1110 b r0.5 c sGO\\x20ON d b0X f b1 g #3 1e #4 1e";
    let wave = wave(&file(vars, body));
    let shown: Vec<String> = (0..8).map(|i| wave.value_at_time(i, 4).expect("a signal").to_string()).collect();
    let wide = format!("{}1", "0".repeat(129));
    assert_eq!(shown, ["0110 (6)", "1110 (-2)", "0.5", "\"GO ON\"", "event no. 2", "00x", &wide, "no value yet"]);
    let kinds: Vec<ValueKind> = wave.signals().iter().take(5).map(|signal| signal.kind).collect();
    assert_eq!(kinds, [ValueKind::Unsigned, ValueKind::Signed, ValueKind::Real, ValueKind::Text, ValueKind::Event]);
    assert_eq!(wave.signals()[0].path, "m.u");
    assert_eq!(wave.timescale(), Some(Timescale { factor: 1, exponent: -9 }));
}

#[test]
fn two_names_of_one_id_code_share_their_changes_and_no_two_signals_share_a_path() {
    let vars = "$var wire 1 ! a $end $var wire 1 ! b $end $var wire 1 # a $end";
    let wave = wave(&file(vars, "#0 0! 1#"));
    let paths: Vec<&str> = wave.signals().iter().map(|signal| signal.path.as_str()).collect();
    assert_eq!(paths, ["m.a", "m.b", "m.a#2"]);
    assert_eq!(wave.signals()[0].stored, wave.signals()[1].stored);
}

#[test]
fn what_is_no_wave_is_refused_with_its_place() {
    assert_eq!(error(""), "memory: the file is empty");
    assert!(error("\0\u{1}junk").starts_with("memory: neither VCD"));
    assert_eq!(
        error("$timescale 1 ns $end\n$scope module m"),
        "memory: line 2: the file ends inside the header; it was cut off or is still being written"
    );
    let one = |body: &str| error(file("$var wire 4 ! q $end", body));
    assert!(one("#0\nb1").starts_with("memory: line 7: the file ends inside a value"));
    assert_eq!(one("#0 b1 ! #5 b0 ! #4"), "memory: line 6: the time goes back from #5 to #4");
    assert_eq!(one("#0 b1 %"), "memory: line 6: a value for the id code `%`, which no $var declares");
    assert_eq!(one("#-3"), "memory: line 6: `#-3` is not a time, a whole number from 0 to 18446744073709551615");
    assert_eq!(
        one("#0 b10101 !"),
        "memory: line 6: `b10101` is not a value of `m.q`, which is 4 bits: it has more digits"
    );
    let wide = error(file("$var wire 4294967295 ! q $end", "#0 b1 !"));
    assert_eq!(wide, "memory: `m.q` is declared 4294967295 bits wide; at most 1048576 can be read");
}

#[test]
fn what_cannot_be_opened_is_refused_with_its_name() {
    let missing = Wave::open("no/such/wave.vcd").expect_err("no file");
    assert!(matches!(&missing, WaveError::Io { name, .. } if name == "no/such/wave.vcd"));
    assert!(matches!(Wave::open("."), Err(WaveError::Io { .. })));
}

#[test]
fn no_broken_vcd_makes_the_reader_panic() {
    let vars = "$var wire 1 ! clk $end $var integer 4 \" q [3:0] $end $var real 64 # r $end $var string 1 $ s $end";
    let whole = file(vars, "#0\n$dumpvars\n0!\nb0 \"\nr0 #\nsA $\n$end\n#5\n1!\nbx1 \"\nr1.5 #\nsB $\n#10\n0!");
    never_panics(whole.as_bytes());
}

/// Cuts the file off at every byte, and puts other bytes in every place.
fn never_panics(whole: &[u8]) {
    assert!(Wave::from_bytes(whole.to_vec()).is_ok());
    let touch = |bytes: Vec<u8>| {
        if let Ok(wave) = Wave::from_bytes(bytes) {
            for signal in 0..wave.signals().len() {
                let at_time = wave.value_at_time(signal, u64::MAX).map(|value| value.to_string());
                assert!(at_time.is_some());
                let _ = wave.value_at_cycle(signal, 1);
            }
        }
    };
    for at in 0..whole.len() {
        touch(whole[..at].to_vec());
        for byte in *b"\0 \n$#b019x!\"\xff" {
            let mut bytes = whole.to_vec();
            bytes[at] = byte;
            touch(bytes);
        }
    }
}

/// The run of [`COUNTER`] as the crate `fst-writer` writes it.
const COUNTER_FST: &[u8] = include_bytes!("counter.fst");

#[test]
fn an_fst_reads_as_the_vcd_of_the_same_run() {
    let (fst, vcd) = (Wave::from_bytes(COUNTER_FST.to_vec()).expect("an FST"), COUNTER.wave());
    assert_eq!(fst.signals(), vcd.signals());
    assert_eq!(fst.timescale(), vcd.timescale());
    for signal in vcd.signals() {
        assert_eq!(row(&fst, &signal.path), row(&vcd, &signal.path));
    }
}

#[test]
fn no_broken_fst_makes_the_reader_panic() {
    never_panics(COUNTER_FST);
}
