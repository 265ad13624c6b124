//! A sweep: which width and which beat does a point-by-point line need, over every line to a grid of end points.
//!
//! ```sh
//! cargo run --example sweep
//! ```

#![allow(clippy::print_stdout, reason = "an example prints")]

use stepwave::Error;
use stepwave::models::options::{BEATS, WIDTH};
use stepwave::models::{Millionths, find};
use stepwave::study::{Cells, Dimension, Drawn, Range, Space, Sweep, SweepPart, Value, Variants, heading, write_line};

fn main() -> Result<(), Error> {
    // Every line from the origin to a point of the grid, but the one without a pulse.
    let lines = Cells {
        drawn: Drawn::Line,
        sizes: vec![],
        from: Some(vec![Range::one(0), Range::one(0)]),
        to: Some(vec!["1..31".parse()?, "0..31".parse()?]),
        center: [0, 0],
        directions: vec![],
        radii: Millionths(0),
    };
    // Each with three widths and two forms of the controller.
    let hardware = Variants(vec![Dimension::parse(&WIDTH, "5..7")?, Dimension::parse(&BEATS, "4,1")?]);
    let sweep = Sweep::new(find("ppc-line")?, Space::Cells(lines), hardware, SweepPart::WHOLE, 1 << 20)?;

    let rows = sweep.rows(0..sweep.geometries())?;
    let (clocks, error) = (sweep.column("clocks"), sweep.column("max_error"));
    let number = |row: &[Value], column: Option<usize>| column.and_then(|column| row[column].number()).unwrap_or(0.0);
    let slowest = rows.iter().max_by(|a, b| number(a, clocks).total_cmp(&number(b, clocks)));
    let worst = rows.iter().max_by(|a, b| number(a, error).total_cmp(&number(b, error)));

    println!("{} runs", rows.len());
    println!("{}", heading(sweep.columns()));
    for row in [slowest, worst].into_iter().flatten() {
        let mut line = String::new();
        write_line(row, &mut line);
        print!("{line}");
    }
    Ok(())
}
