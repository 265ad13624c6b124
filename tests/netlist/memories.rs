//! Memories in the text form and in diagnostics.

use std::collections::HashMap;

use stepwave_netlist::dsl::Module;
use stepwave_netlist::passes::simplify;
use stepwave_netlist::{Code, elaborate, text};

const GOOD: &str = "netlist m
scope 1 in 0 \"core\"
memory 0 in 1 \"ram\" width 8 words 32
initial 0 0x1 0xff*2 0x0*20
write 0 enable %0 address %1 data %4 mask %4
write 0 enable %0 address %3 data %4
memory 1 in 0 \"rom\" width 3 words 16777216
%0:1 = input
%1:64 = input
%2:5 = slice %1 0
%3:3 = read 1 %1
%4:8 = read 0 %2
";

#[test]
fn a_memory_is_printed_and_parsed_without_loss() {
    let netlist = text::parse(GOOD).unwrap();
    assert_eq!(text::print(&netlist), GOOD);
    let design = elaborate(netlist.clone()).unwrap();
    // The ports keep what they read.
    assert_eq!(design.order().len(), 3);
    let simplified = simplify(&netlist, &HashMap::new()).netlist;
    assert_eq!(text::print(&simplified), GOOD);
    // More runs than a line has.
    let mut netlist = netlist;
    netlist.memories[0].initial = (0..32).collect();
    let printed = text::print(&netlist);
    assert_eq!(printed.lines().filter(|line| line.starts_with("initial 0 ")).count(), 2, "{printed}");
    assert_eq!(text::parse(&printed).unwrap(), netlist);
}

#[test]
fn a_line_of_a_memory_that_cannot_be_read_is_named() {
    for line in [
        "memory 3 in 0 \"x\" width 8 words 4",
        "memory 2 in 0 \"x\" width 65 words 4",
        "memory 2 in 0 \"x\" width 8",
        "memory 2 in 0 x width 8 words 4",
        "initial 2 0x0",
        "initial 0 0x0*10",
        "initial 1 0x0*16777217",
        "initial 1 0x0*18446744073709551615",
        "initial 1 5",
        "initial 1 0x5*",
        "write 2 enable %0 address %1 data %4",
        "write 0 enable %0 address %1",
        "write 0 enable %0 address %1 data %4 mask",
    ] {
        let said = text::parse(&format!("{GOOD}{line}\n")).unwrap_err();
        assert_eq!(said.0.len(), 1, "{line}: {said}");
        assert!(said.to_string().starts_with("line 13: "), "{line}: {said}");
    }
}

#[test]
fn what_is_wrong_with_a_memory_is_said_once_with_its_name() {
    for (good, bad, code, message) in [
        ("width 8 words 32", "width 8 words 33554432", Code::OutOfRange, "of 33554432 words is not possible"),
        ("width 3 words 16777216", "width 3 words 0", Code::OutOfRange, "of 0 words is not possible: 1 to 16777216"),
        ("0xff*2", "0x100*2", Code::ValueTooWide, "the word 256 does not fit in the 8 bits of the memory m.core.ram"),
        ("ram\" width 8", "ram\" width 9", Code::WidthMismatch, "m.core.ram"),
        ("enable %0 address %3", "enable %3 address %3", Code::NotOneBit, "%3 (3 bits) enables a write of m.core.ram"),
        ("address %3 data %4", "address %3 data %2", Code::WidthMismatch, "%2 (5 bits) is written to m.core.ram"),
        ("mask %4", "mask %1", Code::WidthMismatch, "%1 (64 bits) is written to m.core.ram, whose words have 8 bits"),
        ("read 1 %1", "read 2 %1", Code::OutOfRange, "there is no memory 2"),
        ("%3:3 = read 1", "%3:3 = read 0", Code::WidthMismatch, "a word of m.core.ram has 8 bits, not 3 bits"),
        ("0 \"rom\"", "0 \"core\"", Code::DuplicateName, "'m.core' is given to scope 1 and to memory 1"),
        ("0 \"rom\"", "7 \"rom\"", Code::Order, "'rom'"),
        ("data %4 mask", "data %9 mask", Code::Order, "'ram'"),
    ] {
        let spoilt = GOOD.replacen(good, bad, 1);
        assert_ne!(spoilt, GOOD, "{good}");
        let said = elaborate(text::parse(&spoilt).unwrap()).unwrap_err();
        assert!(said.0.iter().any(|d| d.code == code && d.message.contains(message)), "{bad}: {said}");
    }
}

#[test]
fn a_mistake_in_a_description_of_a_memory_has_its_line() {
    let module = Module::new("m");
    let m = module.top();
    let ram = m.memory("ram", 4, 2).initial([1, 2, 3]);
    ram.write(m.lit(1, 1), m.lit(1, 0), m.lit(5, 0), None);
    let _ = m.memory("ram", 65, 2);
    let said = module.finish().unwrap_err();
    let codes: Vec<Code> = said.0.iter().map(|d| d.code).collect();
    assert_eq!(codes, [Code::OutOfRange, Code::WidthMismatch, Code::DuplicateName, Code::BadWidth], "{said}");
    assert!(said.0.iter().all(|d| d.place.to_string().contains("memories.rs:")), "{said}");
}
