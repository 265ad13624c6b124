//! Curves that no model of the catalogue draws: a network of six integrators for an Archimedean spiral and, as its integral, the
//! involute of a circle; its path against the exact curves.
//!
//! ```text
//!   c, s     a·cos θ, a·sin θ          dc = -s dθ         ds = c dθ
//!   u, w     the spiral of radius aθ   du = (c - w) dθ    dw = (s + u) dθ
//!   x, y     the involute of radius a  dx = u dθ          dy = w dθ        from x = a
//! ```
//!
//! ```text
//! cargo run --example spiral -- spiral.net
//! stepwave sim spiral.net --clocks 311296 --vcd spiral.vcd
//! ```

#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;

use stepwave::engine::{EngineKind, Rows, Watch};
use stepwave::netlist::bits::to_signed;
use stepwave::netlist::dsl::{Module, Register, Scope, Signal};
use stepwave::netlist::{elaborate, text};

/// Bits of a remainder register: θ grows by 2^-14 a clock. Bits of a count below 1 BLU.
const N: u32 = 14;
const FRACTION: u32 = 6;
/// Radius of the circle, and of the spiral for each radian, in BLU.
const A: u64 = 10;

/// An integrator: a remainder register takes the integrand at every clock; what it carries, -1, 0 or 1, is its pulse.
fn integrator<'m>(m: Scope<'m>, name: &str, integrand: Signal<'m>) -> Signal<'m> {
    let remainder = m.reg(name, N).reset(1 << (N - 1));
    let sum = remainder.q.extend(N + 2).as_signed().wrapping_add(integrand.extend(N + 2));
    remainder.set(sum.slice(0, N));
    sum.slice(N, 2).as_signed()
}

fn main() -> Result<(), Box<dyn Error>> {
    let module = Module::new("spiral");
    let (m, on) = (module.top(), module.top().lit(1, 1));
    let count = |name: &str, start: u64| m.reg_signed(name, N + 1).reset(start);
    let [c, x] = ["c", "x"].map(|name| count(name, A << FRACTION));
    let [s, u, w, y] = ["s", "u", "w", "y"].map(|name| count(name, 0));
    let [along, across] =
        [c.q.extend(N + 2).wrapping_sub(w.q.extend(N + 2)), s.q.extend(N + 2).wrapping_add(u.q.extend(N + 2))];
    c.set(c.q.strict_sub(integrator(m, "rc", s.q), on));
    let network = [(s, "rs", c.q), (u, "ru", along), (w, "rw", across), (x, "rx", u.q), (y, "ry", w.q)];
    for (register, remainder, integrand) in network {
        register.set(register.q.strict_add(integrator(m, remainder, integrand), on));
    }
    let columns = [u, w, x, y].map(|register: Register<'_>| register.q.net());

    let design = elaborate(module.finish()?)?;
    let width = design.netlist().width(columns[0]);
    let stops = design.netlist().properties.iter().map(|property| property.never).collect();
    let mut engine = EngineKind::Compiled.build(&design, &Watch { columns: columns.to_vec(), stops });
    if let Some(file) = std::env::args().nth(1) {
        std::fs::write(file, text::print(design.netlist()))?;
    }
    let mut rows = Rows::new(columns.len(), 1 << N);
    engine.reset(&mut rows);
    let mut worst = [0.0_f64; 2];
    // Three turns, and what is over of a radian.
    for _ in 0..19 {
        rows.clear();
        engine.run(1 << N, &mut rows);
        for row in 0..rows.len() {
            let angle = rows.clock(row) as f64 / f64::from(1 << N);
            let ((sin, cos), a) = (angle.sin_cos(), A as f64);
            let spiral = [a * angle * cos, a * angle * sin];
            let involute = [a * cos + spiral[1], a * sin - spiral[0]];
            // In parts of a BLU.
            let at = |column: usize| to_signed(width, rows.value(column, row)) as f64 / f64::from(1 << FRACTION);
            for (curve, exact) in [spiral, involute].into_iter().enumerate() {
                let off = f64::hypot(at(2 * curve) - exact[0], at(2 * curve + 1) - exact[1]);
                worst[curve] = worst[curve].max(off);
            }
        }
    }
    println!("{} clocks; spiral {:.3} BLU off, involute {:.3} BLU off", rows.clock(rows.len() - 1), worst[0], worst[1]);
    Ok(())
}
