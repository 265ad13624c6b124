use super::*;
use crate::engine::EngineKind;
use crate::models::{find, options::Options};
use crate::nc::{Curve, Line};
use crate::testbench::Testbench;

#[test]
fn a_page_that_becomes_too_large_says_at_which_clock_and_what_to_do() {
    let line = Curve::Line(Line::new(vec![0, 0], vec![3000, 1000]).expect("a line"));
    let bench = Testbench::new(find("dda-line").expect("a model"), &line, &Options::default()).expect("a bench");
    let of = |bytes| Limit { bytes, ..limit(&WaveOptions::default()) };
    let run = |bytes| {
        let record = RunRecord::of_bench(&bench, &WaveOptions::default(), [1e6, 1e-3, 1e-3], of(bytes));
        let mut record = record.expect("signals");
        bench.run(EngineKind::Word, &mut [&mut record]).map_err(|error| error.to_string())
    };
    assert!(run(1 << 20).is_ok());
    let refused = run(1 << 14).expect_err("four thousand clocks take more");
    assert!(refused.starts_with("the page has come to 0 MB of changes at clock "), "{refused}");
    assert!(refused.ends_with(", and was given up: show fewer signals (--trace) or a window (--trace-from, --trace-to), write --fst for a viewer, or give --large"), "{refused}");
}
