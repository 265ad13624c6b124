//! Read back with the crate `vcd`, whose parser follows the standard to the letter.

use std::collections::HashMap;

use stepwave_engine::EngineKind;
use vcd::{Command, Header, IdCode, ReferenceIndex, ScopeItem, ScopeType, SimulationCommand, Var};

use super::{Shown, Variable, cases, compare, compare_clock, record};

/// Every variable with its path, in the order of the header.
pub(super) fn variables(header: &Header) -> Vec<(String, &Var)> {
    fn below<'a>(items: &'a [ScopeItem], path: &str, found: &mut Vec<(String, &'a Var)>) {
        for item in items {
            match item {
                ScopeItem::Scope(scope) => {
                    assert_eq!(scope.scope_type, ScopeType::Module);
                    below(&scope.items, &format!("{path}{}.", scope.identifier), found);
                }
                ScopeItem::Var(var) => found.push((format!("{path}{}", var.reference), var)),
                other => assert!(matches!(other, ScopeItem::Comment(_)), "{other:?}"),
            }
        }
    }
    let mut found = Vec::new();
    below(&header.items, "", &mut found);
    found
}

/// Reads a wave with the crate `vcd`. It also checks: every variable is dumped once in `$dumpvars`, then changes only;
/// values are as long as their variable is wide.
fn read(vcd: &[u8]) -> Shown {
    let mut parser = vcd::Parser::new(vcd);
    let header = parser.parse_header().expect("a header");
    let list = variables(&header);
    let widths: HashMap<IdCode, usize> = list.iter().map(|(_, var)| (var.code, var.size as usize)).collect();
    let mut changes: HashMap<IdCode, Vec<(u64, String)>> = HashMap::new();
    let (mut time, mut dumping, mut dumped) = (None, false, false);
    for command in parser {
        let (id, value) = match command.expect("a command") {
            Command::Timestamp(next) => {
                assert!(time.is_none_or(|time| time < next), "#{next} behind #{time:?}");
                assert!(time.is_none() || dumped, "$dumpvars belongs to the first time");
                time = Some(next);
                continue;
            }
            Command::Begin(SimulationCommand::Dumpvars) => {
                assert!(!dumped && time.is_some() && changes.is_empty());
                dumping = true;
                continue;
            }
            Command::End(SimulationCommand::Dumpvars) => {
                assert!(
                    widths.keys().all(|id| changes.get(id).is_some_and(|list| list.len() == 1)),
                    "$dumpvars has every variable"
                );
                (dumping, dumped) = (false, true);
                continue;
            }
            Command::ChangeScalar(id, value) => (id, value.to_string()),
            Command::ChangeVector(id, value) => (id, value.to_string()),
            other => panic!("{other:?}"),
        };
        assert_eq!(value.len(), widths[&id], "{value} of {id}");
        assert!(dumping || dumped, "a change before $dumpvars");
        let list = changes.entry(id).or_default();
        assert!(list.last().is_none_or(|(_, last)| *last != value), "{id} is written although it stays {value}");
        list.push((time.expect("a time"), value));
    }
    let variable = |var: &Var| Variable {
        kind: var.var_type.to_string(),
        width: var.size,
        range: var.index.map(|index| match index {
            ReferenceIndex::Range(msb, lsb) => (msb.into(), lsb.into()),
            ReferenceIndex::BitSelect(bit) => (bit.into(), bit.into()),
        }),
        changes: changes[&var.code].clone(),
    };
    Shown {
        variables: list.iter().map(|(path, var)| (path.clone(), variable(var))).collect(),
        last_time: time.expect("a time"),
    }
}

#[test]
fn every_signal_reads_back_as_it_was_at_every_clock_in_a_second_reader_too() {
    for case in cases() {
        let recording = record(&case, EngineKind::Word);
        let shown = read(&recording.vcd);
        compare(case.what, &shown, &recording.signals, 0, recording.samples - 1);
        compare_clock(case.what, &shown, 0, recording.samples - 1);
    }
}

#[test]
fn the_header_says_by_what_and_of_what_and_no_date() {
    let case = &cases()[0];
    let header = vcd::Parser::new(record(case, EngineKind::Word).vcd.as_slice()).parse_header().unwrap();
    assert_eq!(header.version, Some(format!("stepwave {}", env!("CARGO_PKG_VERSION"))));
    assert_eq!(header.timescale, Some((100, vcd::TimescaleUnit::NS)));
    assert_eq!(header.date, None);
    let ScopeItem::Comment(comment) = &header.items[0] else { panic!("{:?}", header.items[0]) };
    assert_eq!(*comment, format!("schema 1; clock 1000000 Hz; {}", case.what));
}
