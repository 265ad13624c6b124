//! Designs that no model has: aliases, every width, quiet nets.

use stepwave_engine::EngineKind;
use stepwave_netlist::dsl::Module;
use stepwave_netlist::elaborate;

use super::written::read;
use super::{compare, compare_clock, record_design};

#[test]
fn a_net_with_two_names_is_dumped_once() {
    let module = Module::new("m");
    let m = module.top();
    let inner = m.scope("inner");
    let count = inner.reg("count", 3);
    let next = count.q.wrapping_add(m.lit(3, 1));
    count.set(next);
    m.name("alias", count.q);
    m.name("next", next);
    m.name("far", count.q);
    let design = elaborate(module.finish().unwrap()).unwrap();
    let text = String::from_utf8(record_design(&design, 2, EngineKind::Word).vcd).unwrap();
    let expected = "\
$scope module m $end
$var wire 1 ! clk $end
$var reg 3 \" alias [2:0] $end
$var wire 3 # next [2:0] $end
$var reg 3 \" far [2:0] $end
$scope module inner $end
$var reg 3 \" count [2:0] $end
$upscope $end
$upscope $end
$enddefinitions $end
#0
$dumpvars
0!
b000 \"
b001 #
$end
#10
1!
b001 \"
b010 #
#15
0!
#20
1!
b010 \"
b011 #
#25
0!
#30
";
    assert_eq!(text.split_once("100 ns $end\n").unwrap().1, expected);
}

#[test]
fn every_bit_of_every_width_reads_back() {
    let module = Module::new("m");
    let m = module.top();
    let (unsigned, signed) = (m.scope("unsigned"), m.scope("signed"));
    for width in 1..=64 {
        // Shifts a 1 in where the top bit and the one in the middle are alike: every bit moves, and both values last.
        let (plain, read_signed) =
            (unsigned.reg(&format!("r{width}"), width), signed.reg_signed(&format!("r{width}"), width));
        let new = !(plain.q.bit(width - 1) ^ plain.q.bit(width / 2));
        let next = if width == 1 { !plain.q } else { plain.q.slice(0, width - 1).concat(new) };
        plain.set(next);
        read_signed.set(next.as_signed());
    }
    let design = elaborate(module.finish().unwrap()).unwrap();
    for engine in EngineKind::ALL {
        let recording = record_design(&design, 350, engine);
        for signal in recording.signals.iter().filter(|signal| signal.width > 2) {
            let seen = |bit: char| {
                (0..signal.width as usize).all(|at| signal.samples.iter().any(|bits| bits[at..].starts_with(bit)))
            };
            assert!(seen('0') && seen('1'), "{} does not move enough to be a test", signal.path);
        }
        let shown = read(&recording.vcd);
        compare(engine.name(), &shown, &recording.signals, 0, 350);
        compare_clock(engine.name(), &shown, 0, 350);
    }
}

#[test]
fn nets_that_rest_for_long_and_move_once_read_back() {
    // Bit k of a counter moves every 2^k clocks, so that blocks of samples pass in which it rests.
    let module = Module::new("m");
    let m = module.top();
    let count = m.reg("count", 12);
    count.set(count.q.wrapping_add(m.lit(12, 1)));
    for bit in 0..12 {
        m.name(&format!("bit{bit}"), count.q.bit(bit));
        m.name(&format!("from{bit}"), count.q.slice(bit, 12 - bit));
    }
    let design = elaborate(module.finish().unwrap()).unwrap();
    let recording = record_design(&design, 3000, EngineKind::Word);
    let shown = read(&recording.vcd);
    compare("resting nets", &shown, &recording.signals, 0, 3000);
    for bit in 0..12u64 {
        let changes = &shown.variables[&format!("m.bit{bit}")].changes;
        assert_eq!(changes.len() as u64, 1 + 3000 / (1 << bit), "bit {bit}: one line a change");
    }
}

/// Words of 138, 131 and 65 bits: one that moves always, one whose parts move once each, and one that never does.
pub(super) const WIDE: &str = "netlist m
scope 1 in 0 \"inner\"
%0:10 = register reset 0x0 next %11
%1:64 = register reset 0xfffffffffffffff0 next %13
%2:64 = register reset 0x1 next %14
%3:64 = register reset 0x0 next %20
%4:64 = register reset 0x0 next %21
%5:3 = register reset 0x0 next %22
%6:10 = const 0x1
%7:64 = const 0x9e3779b97f4a7c15
%8:10 = const 0x64
%9:10 = const 0x165
%10:10 = const 0x2bc
%11:10 = add %0 %6
%12:1 = equal %0 %8
%13:64 = add %1 %7
%14:64 = xor %2 %13
%15:1 = equal %0 %9
%16:1 = equal %0 %10
%17:64 = not %3
%18:64 = not %4
%19:3 = not %5
%20:64 = mux %12 %17 %3
%21:64 = mux %15 %18 %4
%22:3 = mux %16 %19 %5
%23:1 = const 0x1
name %1 %2 %0 in 0 \"busy\" signed
name %3 %4 %5 in 1 \"rest\" unsigned
name %3 in 1 \"low\" unsigned
name %3 %4 %5 in 0 \"far\" binary
name %7 %23 in 0 \"still\" unsigned
name %3 %23 in 0 \"mixed\" unsigned
";

/// [`WIDE`] as a design.
pub(super) fn wide() -> stepwave_netlist::Design {
    elaborate(stepwave_netlist::text::parse(WIDE).unwrap()).unwrap()
}

#[test]
fn words_of_more_than_64_bits_are_one_variable() {
    let design = wide();
    for engine in EngineKind::ALL {
        let recording = record_design(&design, 900, engine);
        let shown = read(&recording.vcd);
        compare(engine.name(), &shown, &recording.signals, 0, 900);
        let changes = |path: &str| shown.variables[path].changes.len();
        assert_eq!((changes("m.busy"), changes("m.inner.rest"), changes("m.far")), (901, 4, 4));
        assert_eq!((changes("m.still"), changes("m.mixed")), (1, 2));
    }
}
