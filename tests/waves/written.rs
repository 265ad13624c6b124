//! Read back with the crate `wellen`, on which viewers are built.

use std::io::Cursor;

use stepwave_engine::EngineKind;
use stepwave_models::Options;
use wellen::{SignalRef, TimescaleUnit};

use super::{Case, Recording, Shown, Variable, cases, compare, compare_clock, line, record};

/// Reads a wave with `wellen`, without any code of this project.
pub(crate) fn read(vcd: &[u8]) -> Shown {
    let mut wave = wellen::simple::read_from_reader(Cursor::new(vcd.to_vec())).expect("a wave");
    let ids: Vec<SignalRef> = wave.hierarchy().signals().collect();
    wave.load_signals(&ids);
    let (hierarchy, times) = (wave.hierarchy(), wave.time_table());
    let scale = hierarchy.timescale().expect("a timescale");
    assert_eq!((scale.factor, scale.unit), (100, TimescaleUnit::NanoSeconds));
    let variable = |var: &wellen::Var| {
        let changes = wave.get_signal(var.signal_ref()).expect("a loaded signal").iter_changes();
        let change = |(index, value): (u32, wellen::SignalValueRef<'_>)| {
            (times[index as usize], value.to_bit_string().expect("bits"))
        };
        Variable {
            kind: format!("{:?}", var.var_type()).to_lowercase(),
            width: var.length(hierarchy).expect("bits"),
            range: var.index().map(|range| (range.msb(), range.lsb())),
            changes: changes.map(change).collect(),
        }
    };
    let variables = hierarchy.all_vars().map(|var| &hierarchy[var]);
    let list: Vec<(String, Variable)> = variables.map(|var| (var.full_name(hierarchy), variable(var))).collect();
    let count = list.len();
    let shown = Shown { variables: list.into_iter().collect(), last_time: *times.last().expect("a time") };
    assert_eq!(shown.variables.len(), count, "names are unique");
    shown
}

#[test]
fn every_signal_reads_back_as_it_was_at_every_clock() {
    let mut samples = 0;
    for case in cases() {
        for engine in EngineKind::ALL {
            let what = format!("{} on {}", case.what, engine.name());
            let Recording { signals, samples: count, vcd } = record(&case, engine);
            let shown = read(&vcd);
            compare(&what, &shown, &signals, 0, count - 1);
            compare_clock(&what, &shown, 0, count - 1);
            samples += count * signals.len() as u64;
        }
    }
    assert!(samples > 50_000, "{samples} values only");
}

#[test]
fn a_wave_longer_than_every_buffer_reads_back() {
    let case = Case { what: "long line", model: "ppc-line", curve: line(&[-3500, 2500]), choices: Options::default() };
    for engine in EngineKind::ALL {
        let Recording { signals, samples, vcd } = record(&case, engine);
        // The writer holds 128 KiB back, and puts large outputs into a thread of their own from 1 MiB on.
        assert!(vcd.len() > 1 << 20 && samples > 24_000, "{} bytes", vcd.len());
        let shown = read(&vcd);
        compare(engine.name(), &shown, &signals, 0, samples - 1);
        compare_clock(engine.name(), &shown, 0, samples - 1);
    }
}

#[test]
fn every_engine_writes_the_same_bytes() {
    for case in cases() {
        let first = record(&case, EngineKind::Gates).vcd;
        for engine in EngineKind::ALL {
            assert!(record(&case, engine).vcd == first, "{} on {}", case.what, engine.name());
        }
    }
}

#[test]
fn the_cases_hold_what_waves_get_wrong_elsewhere() {
    let recordings: Vec<Recording> = cases().iter().map(|case| record(case, EngineKind::Word)).collect();
    let signals = || recordings.iter().flat_map(|recording| &recording.signals);
    let negative = signals().filter(|signal| signal.signed && signal.samples.iter().any(|bits| bits.starts_with('1')));
    assert!(negative.count() > 10, "negative values");
    for kind in ["reg", "wire", "integer", "parameter"] {
        assert!(signals().any(|signal| signal.variable_type() == kind), "{kind}");
    }
    assert!(signals().any(|signal| signal.width == 64 && signal.signed), "64 bits");
    let flags =
        signals().filter(|signal| signal.path.ends_with("_overflow") && signal.samples.contains(&"1".to_owned()));
    assert!(flags.count() >= 3, "overflows");
    assert!(recordings.iter().any(|recording| recording.signals.len() > 94), "ids of two characters");
    assert!(recordings.iter().any(|recording| recording.samples > 256), "more samples than one block of rows");
}
