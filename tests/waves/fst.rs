//! The FST of a run against its VCD: both read with the crate `wellen`, change by change.

use std::io::Cursor;

use stepwave::testbench::{Testbench, WaveWriter, Window};
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_models::find;
use stepwave_netlist::dsl::Module;
use stepwave_netlist::elaborate;
use stepwave_trace::WaveBody;
use stepwave_trace::fst::FstHeader;
use stepwave_trace::probe::Selection;
use stepwave_trace::timescale::ClockTime;

use super::own_designs::wide;
use super::written::read;
use super::{Case, Folder, Shown, cases, compare, compare_clock, record, record_design};

fn fst(case: &Case) -> Vec<u8> {
    let bench = Testbench::new(find(case.model).unwrap(), &case.curve, &case.choices).unwrap();
    let probes = Selection::default().probes(bench.design(), bench.columns().nets()).unwrap();
    let header = FstHeader { probes: &probes, time: ClockTime::from_hz(1e6).unwrap(), clk: true };
    let mut wave = WaveWriter::new(header.write(Cursor::new(Vec::new())).unwrap(), Window::default());
    bench.run(EngineKind::Word, &mut [&mut wave]).unwrap();
    wave.finish().unwrap().into_inner()
}

/// The same names of the same kinds, and the same changes at the same times.
fn same(what: &str, vcd: &Shown, fst: &Shown) {
    assert_eq!(vcd.last_time, fst.last_time, "{what}");
    assert_eq!(vcd.variables.len(), fst.variables.len(), "{what}");
    for (path, of_vcd) in &vcd.variables {
        let of_fst = fst.variables.get(path).unwrap_or_else(|| panic!("{what}: the FST has no {path}"));
        assert_eq!((&of_vcd.kind, of_vcd.width), (&of_fst.kind, of_fst.width), "{what}: {path}");
        assert_eq!(of_vcd.range, of_fst.range, "{what}: {path}");
        assert_eq!(of_vcd.changes, of_fst.changes, "{what}: {path}");
    }
}

#[test]
fn an_fst_holds_the_changes_of_the_vcd() {
    for case in cases() {
        let recording = record(&case, EngineKind::Word);
        let shown = read(&fst(&case));
        same(case.what, &read(&recording.vcd), &shown);
        compare(case.what, &shown, &recording.signals, 0, recording.samples - 1);
        compare_clock(case.what, &shown, 0, recording.samples - 1);
    }
}

#[test]
fn a_net_with_two_names_changes_under_both() {
    let module = Module::new("m");
    let m = module.top();
    let count = m.scope("inner").reg("count", 3);
    count.set(count.q.wrapping_add(m.lit(3, 1)));
    m.name("alias", count.q);
    m.name("inverse", !count.q);
    let design = elaborate(module.finish().unwrap()).unwrap();
    let columns: Vec<_> = design.netlist().names[..3].iter().map(|named| named.net).collect();
    let columns = vec![columns[0], columns[2]];
    let mut engine = EngineKind::Word.build(&design, &Watch { columns: columns.clone(), stops: vec![] });
    let mut rows = Rows::new(2, 30);
    engine.reset(&mut rows);
    engine.run(20, &mut rows);
    let probes = Selection::default().probes(&design, &columns).unwrap();
    let header = FstHeader { probes: &probes, time: ClockTime::from_hz(1e6).unwrap(), clk: true };
    let mut body = header.write(Cursor::new(Vec::new())).unwrap();
    body.rows(&rows, 0..rows.len()).unwrap();
    let shown = read(&body.finish().unwrap().into_inner());
    let changes = |path: &str| shown.variables[path].changes.clone();
    assert_eq!(changes("m.alias"), changes("m.inner.count"));
    assert_eq!((changes("m.alias").len(), changes("m.inverse").len()), (21, 21));
    assert_eq!(changes("m.alias")[3].1, "011");
}

#[test]
fn words_of_more_than_64_bits_are_one_variable() {
    let design = wide();
    let columns: Vec<_> = design.netlist().nets().collect();
    let probes = Selection::default().probes(&design, &columns).unwrap();
    for clk in [true, false] {
        let header = FstHeader { probes: &probes, time: ClockTime::from_hz(1e6).unwrap(), clk };
        let mut body = header.write(Cursor::new(Vec::new())).unwrap();
        let mut engine = EngineKind::Word.build(&design, &Watch { columns: columns.clone(), stops: vec![] });
        let mut rows = Rows::new(columns.len(), 901);
        engine.reset(&mut rows);
        engine.run(900, &mut rows);
        body.rows(&rows, 0..rows.len()).unwrap();
        let shown = read(&body.finish().unwrap().into_inner());
        let recording = record_design(&design, 900, EngineKind::Word);
        compare("the FST", &shown, &recording.signals, 0, 900);
    }
}

#[test]
fn a_run_gives_the_same_fst_again_and_no_date() {
    let case = &cases()[0];
    let bytes = fst(case);
    assert!(bytes == fst(case));
    // The header block: type and length, seven numbers and a test pattern, the exponent of the time, then the texts.
    let (version, rest) = bytes[1 + 9 * 8 + 1..].split_at(128);
    assert!(version.starts_with(format!("stepwave {}\0", env!("CARGO_PKG_VERSION")).as_bytes()));
    assert!(rest[..119].iter().all(|&byte| byte == 0), "the date is empty");
}

#[test]
fn windows_filters_and_an_absent_clock_hold_for_both_formats() {
    for options in [
        "",
        "--trace-from 5",
        "--trace-from 5 --trace-to 9",
        "--trace-from 7 --trace-to 7",
        "--trace-to 0",
        "--trace-on dda_line.block.done",
        "--trace jr* --trace-exclude jry",
        "--trace-depth 1",
        "--no-clk",
        "--no-clk --trace-from 3 --trace-to 12",
    ] {
        let folder = Folder::new();
        folder.good(&format!("run dda-line --to 8,6 --vcd w.vcd --fst w.fst {options}"));
        let bytes = |name| std::fs::read(folder.path(name)).unwrap();
        let (vcd, fst) = (read(&bytes("w.vcd")), read(&bytes("w.fst")));
        same(options, &vcd, &fst);
        let first = |shown: &Shown| shown.variables.values().map(|variable| variable.changes[0].0).min();
        assert_eq!(first(&vcd), first(&fst), "{options}");
        // A wave without its clock can be compared by time only.
        let by: &[&str] = if options.contains("--no-clk") { &["time"] } else { &["clock", "time"] };
        for by in by {
            let said = folder.good(&format!("diff w.vcd w.fst --by {by}"));
            assert!(said.starts_with("same"), "{options}: {said}");
        }
    }
}

#[test]
fn diff_finds_the_first_divergence_between_a_vcd_and_an_fst() {
    let folder = Folder::new();
    folder.good("run dda-line --to 8,6 --vcd a.vcd");
    folder.good("run dda-line --to 8,7 --fst b.fst");
    let ran = folder.run("diff a.vcd b.fst");
    assert_eq!(ran.code, 1, "{ran:?}");
}

#[test]
fn the_files_next_to_an_fst_name_it_and_never_replace_those_of_a_vcd() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 6,4 --fst w.fst");
    assert_eq!(folder.files(), ["w.beat.states", "w.fst", "w.gtkw"]);
    let alone = folder.read("w.gtkw");
    assert!(alone.starts_with("[dumpfile] \"/w.fst\"\n[savefile] \"/w.gtkw\"\n"), "{alone}");

    let folder = Folder::new();
    folder.good("run ppc-line --to 6,4 --fst w.fst --vcd w.vcd");
    let names = ["w.beat.states", "w.fst", "w.fst.beat.states", "w.fst.gtkw", "w.gtkw", "w.vcd"];
    assert_eq!(folder.files(), names);
    assert!(folder.read("w.gtkw").starts_with("[dumpfile] \"/w.vcd\"\n[savefile] \"/w.gtkw\"\n"));
    let twin = folder.read("w.fst.gtkw");
    assert!(twin.starts_with("[dumpfile] \"/w.fst\"\n[savefile] \"/w.fst.gtkw\"\n"), "{twin}");
    assert!(twin.contains("^1 /w.fst.beat.states\n"), "{twin}");

    let folder = Folder::new();
    folder.good("run ppc-line --to 6,4 --fst a.fst --vcd b.vcd");
    assert_eq!(folder.files(), ["a.beat.states", "a.fst", "a.gtkw", "b.beat.states", "b.gtkw", "b.vcd"]);
}

#[test]
fn an_fst_is_refused_where_one_cannot_go_back() {
    for target in ["-", "/dev/null", "/dev/full"] {
        let folder = Folder::new();
        let ran = folder.run(&format!("run ppc-line --to 6,4 --fst {target} --vcd w.vcd"));
        assert_eq!((ran.code, ran.out.as_str()), (2, ""));
        assert!(ran.err.contains(&format!("cannot write {target}: FST is written back and forth")), "{}", ran.err);
        assert!(folder.files().is_empty());
    }
}
