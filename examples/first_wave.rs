//! The first wave: a DDA line to (8, 6) in four bits, with its step table, its report and a wave for GTKWave.
//!
//! ```sh
//! cargo run --example first_wave && gtkwave line.gtkw
//! ```

#![allow(clippy::print_stdout, reason = "an example prints")]

use stepwave::models::find;
use stepwave::models::options::Options;
use stepwave::nc::{Curve, Line};
use stepwave::{Error, Simulation};

fn main() -> Result<(), Error> {
    let model = find("dda-line")?;
    let line = Curve::Line(Line::new(vec![0, 0], vec![8, 6])?);
    // The options are those of the command line.
    let options = Options::parse(["--width", "4"])?;
    let simulation = Simulation::new(model, line).options(options);

    // Files and report of one run; all files appear, or none.
    let report = simulation.clone().vcd("line.vcd").steps("line.csv").json("line.json").run()?;
    print!("{}", report.summary());
    assert!(report.failures().is_empty(), "nothing overflowed, and the end was reached");

    // A short run can be asked directly: a digit a clock, in groups of four.
    let (_, trace) = simulation.run_traced()?;
    println!("pulses of x  {}", trace.row("dx")?);
    println!("pulses of y  {}", trace.row("dy")?);
    println!("remainder    {:?}", trace.i64("jrx")?);
    Ok(())
}
