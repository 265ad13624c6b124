//! A trace that is asked by name, against values known from the recurrence.

use stepwave::{Simulation, Trace};
use stepwave_models::find;
use stepwave_models::options::Options;
use stepwave_nc::{Curve, Line};

fn traced(to: [i64; 2], options: &[&str]) -> Trace {
    let line = Curve::Line(Line::new(vec![0, 0], to.to_vec()).unwrap());
    let options = Options::parse(options.iter().copied()).unwrap();
    Simulation::new(find("dda-line").unwrap(), line).options(options).run_traced().unwrap().1
}

#[test]
fn trace_reads_decimal_registers_as_the_numbers_of_their_digits() {
    let trace = traced([18, 6], &["--radix", "10"]);
    // 18 is added modulo 100 at every clock after the load.
    let expected: Vec<i64> = (0..=100).map(|step| 18 * step % 100).collect();
    assert_eq!(trace.i64("jrx").unwrap()[1..], expected);
    // The bits are digits of four: 0x18, not 18.
    assert_eq!(trace.bits("jrx").unwrap()[2], 0x18);
}

#[test]
fn trace_reads_positions_and_pulses_in_two_s_complement() {
    let trace = traced([-4, 2], &["--width", "3"]);
    assert_eq!(trace.row("dx").unwrap(), "000-_0-0-_0-");
    assert_eq!(trace.i64("x").unwrap(), [0, 0, 0, -1, -1, -2, -2, -3, -3, -4]);
    assert_eq!((trace.len(), trace.is_empty()), (10, false));
}

#[test]
fn trace_refuses_what_it_cannot_show_with_the_reason() {
    let trace = traced([8, 6], &[]);
    let said = |error: stepwave::testbench::SignalError| error.to_string();
    assert!(
        said(trace.i64("jrxx").unwrap_err())
            .contains("there is no signal 'jrxx' in this netlist (did you mean 'jrx'?)")
    );
    assert!(said(trace.row("jrx").unwrap_err()).contains("jrx is 8 at clock 2; a row shows 0, 1 and -1"));
}
