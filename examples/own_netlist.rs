//! A netlist that is not an interpolator: a linear feedback shift register of 8 bits and a counter of its ones, simulated clock
//! by clock and written as Verilog.
//!
//! ```text
//! cargo run --example own_netlist
//! ```

#![allow(clippy::print_stdout, reason = "an example prints")]

use stepwave::engine::{EngineKind, Rows, Watch};
use stepwave::export::{Options, verilog};
use stepwave::netlist::dsl::Module;
use stepwave::netlist::{Diagnostics, elaborate};

fn main() -> Result<(), Diagnostics> {
    let module = Module::new("noise");
    let m = module.top();
    let state = m.reg("state", 8).reset(1);
    // x^8 + x^6 + x^5 + x^4 + 1 goes through all 255 states but 0.
    let next = state.q.bit(7) ^ state.q.bit(5) ^ state.q.bit(4) ^ state.q.bit(3);
    state.set(state.q.slice(0, 7).concat(m.name("next", next)));
    let ones = m.reg("ones", 8);
    // A sum that does not fit in 8 bits would be a violated property of the netlist.
    ones.set(ones.q.strict_add(next, m.lit(1, 1)));
    let columns = [state.q.net(), ones.q.net()];

    let design = elaborate(module.finish()?)?;
    let watch = Watch { columns: columns.to_vec(), stops: vec![] };
    let mut engine = EngineKind::Word.build(&design, &watch);
    let mut rows = Rows::new(columns.len(), 256);
    engine.reset(&mut rows);
    engine.run(255, &mut rows);
    for clock in [0, 1, 2, 3, 254, 255] {
        let row = rows.row(clock);
        println!("clock {clock:3}: state {:08b}, {} ones", row[0], row[1]);
    }
    let text = verilog(&design, &Options { comment: &["A shift register".to_owned()], outputs: &columns });
    println!(
        "{} lines of Verilog, the first of them: {}",
        text.lines().count(),
        text.lines().next().unwrap_or_default()
    );
    Ok(())
}
