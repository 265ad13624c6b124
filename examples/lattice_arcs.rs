//! Prints, as geometries for `stepwave sweep --file`, every counter-clockwise arc inside the first quadrant between two
//! lattice points of a circle about the origin with coordinates of this many bits: `lattice_arcs 10 > arcs.csv`.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;

fn arcs(bits: u32, out: &mut impl Write) -> io::Result<()> {
    let mut circles: BTreeMap<u64, Vec<[u64; 2]>> = BTreeMap::new();
    for x in 0..1_u64 << bits {
        for y in 0..1 << bits {
            circles.entry(x * x + y * y).or_default().push([x, y]);
        }
    }
    writeln!(out, "from_x,from_y,to_x,to_y,direction")?;
    for points in circles.values() {
        // Counter-clockwise in the first quadrant x falls.
        for (place, [to_x, to_y]) in points.iter().enumerate() {
            for [from_x, from_y] in &points[place + 1..] {
                writeln!(out, "{from_x},{from_y},{to_x},{to_y},ccw")?;
            }
        }
    }
    out.flush()
}

fn main() -> ExitCode {
    let bits = std::env::args().nth(1).and_then(|bits| bits.parse().ok()).filter(|bits| (1..=12).contains(bits));
    let done = bits.map(|bits| arcs(bits, &mut BufWriter::new(io::stdout().lock())));
    if let Some(Ok(())) = done { ExitCode::SUCCESS } else { ExitCode::from(2) }
}
