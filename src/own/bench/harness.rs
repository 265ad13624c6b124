//! The harness around a netlist: it resets it, starts it, and counts the pulses of its axes. It is hardware, made of the
//! parts of the models, so that every engine, wave, export and proof has it.
//!
//! ```text
//!   load ──► pending ──► go ──► start port       reset port ◄── reset_left
//!   words ──────────────────► their ports
//!   pulses of the axes ──► decoder ──► dx, x     done port ──► done
//! ```
//!
//! Sample k of a block: `load` is 1 at 0, `go` and the start port at 1 (after a reset of c clocks at c), and the edge
//! after that takes the words. A pulse moves the position at the edge that follows it.

use super::file::Strobe;
use super::{Bench, End, Pulses, Wire};
use crate::models::options::{STRICT, WRAPS};
use crate::models::parts::{Block, POSITION, axis_counter, axis_scope};
use crate::models::{Hardware, Machine, ModelError, Port};
use crate::netlist::cells::{Op, ScopeId};
use crate::netlist::dsl::{Module, Scope, Signal};
use crate::netlist::{Net, Netlist, Width, elaborate};
use crate::own::{announce, matching};

/// The scope of the harness: a name that the top of the netlist does not have.
pub(super) fn scope(netlist: &Netlist) -> String {
    let mut scope = "bench".to_owned();
    let of_top = |parent: Option<ScopeId>| parent == Some(ScopeId::TOP);
    while netlist.scopes[0].name == scope
        || netlist.scopes.iter().any(|other| of_top(other.parent) && other.name == scope)
        || netlist.names.iter().any(|named| named.scope == ScopeId::TOP && named.name == scope)
        || netlist.memories.iter().any(|memory| memory.scope == ScopeId::TOP && memory.name == scope)
    {
        scope.push('_');
    }
    scope
}

/// What drives a port of the netlist.
enum Drive {
    Constant(u64),
    /// A register that takes this net, with its value before the first edge.
    Register {
        next: Net,
        reset: u64,
    },
}

impl Bench {
    /// The netlist in its harness.
    pub(super) fn harnessed(&self, hardware: &Hardware) -> Result<Machine, ModelError> {
        let mut netlist = self.netlist.clone();
        let wraps: Vec<String> = self.wraps.iter().cloned().chain(hardware.get(&WRAPS)).collect();
        let refused = |option: &'static str, value: &str, reason: String| ModelError::Value {
            model: hardware.model,
            option,
            value: value.to_owned(),
            reason,
        };
        announce(&mut netlist, &wraps).map_err(|(glob, why)| refused(WRAPS.name, &glob, why))?;
        let own_properties = netlist.properties.len();
        let inputs: Vec<Net> = elaborate(netlist.clone())?.inputs().to_vec();
        let module = Module::continuing(netlist);
        let drives = self.wired(&module, hardware);
        let mut netlist = module.finish()?;
        for input in inputs {
            let drive = drives.iter().find(|(net, _)| *net == input).map(|(_, drive)| drive);
            let is_loaded = self.loads.iter().any(|loaded| loaded.input == input);
            netlist.cells[input.index()].op = match drive {
                Some(Drive::Constant(value)) => Op::Const(*value),
                Some(Drive::Register { next, reset }) => Op::Register { next: Some(*next), reset: *reset },
                None if is_loaded => Op::Input,
                None => Op::Const(0),
            };
        }
        let mut traps: Vec<Net> = netlist.properties[own_properties..].iter().map(|property| property.never).collect();
        let strict = self.strict.iter().cloned().chain(hardware.get(&STRICT));
        for glob in strict {
            let found = matching(&glob, netlist.properties[..own_properties].iter())
                .map_err(|why| refused(STRICT.name, &glob, why))?;
            if let Some(announced) = found.iter().find(|property| property.claim.is_announced()) {
                let why =
                    format!("{} is announced to lose its carry: leave out one of --wraps and --strict", announced.name);
                return Err(refused(STRICT.name, &glob, why));
            }
            traps.extend(found.iter().map(|property| property.never));
        }
        self.ports(netlist, hardware, traps)
    }

    fn ports(&self, netlist: Netlist, hardware: &Hardware, traps: Vec<Net>) -> Result<Machine, ModelError> {
        let (top, scope) = (netlist.scopes[0].name.clone(), scope(&self.netlist));
        let find = |inner: &str| Port::of(&netlist, &format!("{top}.{scope}.{inner}"));
        let axis = |letter: &str, name: String| find(&format!("axis_{letter}.{name}"));
        let letters = || hardware.letters().iter();
        let mut inputs: std::collections::BTreeMap<String, Port> = Default::default();
        for loaded in &self.loads {
            let (net, word) = (loaded.input, &loaded.word);
            inputs.insert(word.name.to_owned(), Port { net, width: word.width, reading: word.reading });
        }
        if let End::Clocks { word } = &self.end {
            inputs.insert(word.name.to_owned(), find("block.clocks_in")?);
        }
        for letter in letters() {
            inputs.insert((*letter).to_owned(), find(&format!("block.{letter}_in"))?);
        }
        Ok(Machine {
            load: find("block.load")?,
            preset_position: find("block.preset_position")?,
            done: find("block.done")?,
            loaded: find("block.loaded")?,
            stepped: find("block.stepped")?,
            pulses: letters().map(|letter| axis(letter, format!("d{letter}"))).collect::<Result<_, _>>()?,
            positions: letters().map(|letter| axis(letter, (*letter).to_owned())).collect::<Result<_, _>>()?,
            table: hardware
                .table
                .iter()
                .map(|name| Ok((*name, Port::of(&netlist, name)?)))
                .collect::<Result<_, ModelError>>()?,
            inputs,
            buffer: None,
            after: None,
            traps,
            design: elaborate(netlist)?,
        })
    }

    /// The hardware of the harness, and what it drives.
    fn wired(&self, module: &Module, hardware: &Hardware) -> Vec<(Net, Drive)> {
        let m = module.top().scope(&scope(&self.netlist));
        let block = Block::new(m);
        let mut drives: Vec<(Net, Drive)> =
            self.constants.iter().map(|&(net, value)| (net, Drive::Constant(value))).collect();
        let fire = self.fire(m, &block, &mut drives);
        let go = m.reg("go", 1);
        go.set(fire);
        let (yes, no) = (m.lit(1, 1), m.lit(1, 0));
        let started = m.reg("started", 1);
        started.when(block.load, no).when(go.q, yes).else_hold();
        let alive = m.reg("alive", 1);
        alive.when(go.q, yes).else_hold();
        // What it starts with, a pulse follows in the very sample.
        let runs = alive.q | go.q;
        let ended = self.ended(m, &block, started.q);
        let finish = ended & started.q & block.busy;
        if let Some(Wire { net, inverted }) = self.start {
            let next = match self.strobe {
                Strobe::Pulse => fire,
                Strobe::Level => {
                    let level = m.reg("start", 1);
                    let next = fire | (level.q & !finish);
                    level.set(next);
                    next
                }
            };
            let next = if inverted { !next } else { next };
            drives.push((net, Drive::Register { next: next.net(), reset: u64::from(inverted) }));
        }
        let mut pulsed = no;
        for (axis, pulses) in self.axes.iter().enumerate() {
            let scope = axis_scope(m, axis);
            let (pulse, negative) = decoded(scope, *pulses, runs);
            let pulse = pulse & runs;
            if axis >= hardware.axes {
                // The geometry has no such axis.
                scope.invariant("no_pulse", !pulse);
                continue;
            }
            pulsed = pulsed | pulse;
            let position = POSITION.of(axis);
            axis_counter(scope, &block, position.name(), hardware.bits(position), pulse, negative);
        }
        let step = self.step.map_or(pulsed, |step| wire(m, step));
        block.close_after(go.q, step & runs, finish);
        drives
    }

    /// 1 bit: the sample before that in which the block is started. Drives the reset port.
    fn fire<'m>(&self, m: Scope<'m>, block: &Block<'m>, drives: &mut Vec<(Net, Drive)>) -> Signal<'m> {
        let mut resets = m.lit(1, 0);
        if let Some(reset) = self.reset {
            if reset.clocks > 1 {
                let more = reset.clocks - 1;
                let left = m.reg("reset_left", Width::needed_unsigned(more.into())).reset(more);
                resets = left.q.is_nonzero();
                left.when(resets, left.q.wrapping_sub(m.lit(left.q.bits(), 1))).else_hold();
            }
            let next = if reset.active { resets } else { !resets };
            let first = (reset.clocks > 0) == reset.active;
            drives.push((reset.input, Drive::Register { next: next.net(), reset: u64::from(first) }));
        }
        let pending = m.reg("pending", 1);
        let wanted = block.load | pending.q;
        pending.set(wanted & resets);
        wanted & !resets
    }

    /// 1 bit: the block has ended, if it has been started.
    fn ended<'m>(&self, m: Scope<'m>, block: &Block<'m>, started: Signal<'m>) -> Signal<'m> {
        match &self.end {
            End::Done(done) => wire(m, *done),
            End::Clocks { word } => {
                let left = m.reg("clocks_left", word.width.get());
                let one = m.lit(left.q.bits(), 1);
                let count = started & left.q.is_nonzero();
                let load = block.word("clocks", word.width.get());
                left.when(block.load, load).when(count, left.q.wrapping_sub(one)).else_hold();
                left.q.equals(one)
            }
        }
    }
}

fn wire<'m>(m: Scope<'m>, wire: Wire) -> Signal<'m> {
    let signal = m.net(wire.net, false);
    if wire.inverted { !signal } else { signal }
}

/// The signal in the sample before.
fn before<'m>(m: Scope<'m>, name: &str, signal: Signal<'m>) -> Signal<'m> {
    let register = m.reg(name, signal.bits());
    register.set(signal.as_unsigned());
    register.q
}

/// The pulse of an axis, and whether it is negative, 1 bit each. What cannot be followed violates an invariant.
fn decoded<'m>(m: Scope<'m>, pulses: Pulses, alive: Signal<'m>) -> (Signal<'m>, Signal<'m>) {
    let strobe = |name: &str, pulse: Wire, edges: bool| {
        let pulse = wire(m, pulse);
        if edges { pulse & !before(m, name, pulse) } else { pulse }
    };
    match pulses {
        Pulses::Still => (m.lit(1, 0), m.lit(1, 0)),
        Pulses::Strobe { pulse, negative, edges } => {
            (strobe("before", pulse, edges), negative.map_or(m.lit(1, 0), |negative| wire(m, negative)))
        }
        Pulses::Signed(net) => {
            let signed = m.net(net, false);
            let (bits, negative) = (signed.bits(), signed.msb());
            let one = signed.equals(m.lit(bits, 1));
            let minus_one = (!signed).is_zero();
            m.invariant("at_most_one_pulse", !alive | signed.is_zero() | one | minus_one);
            (signed.is_nonzero(), negative)
        }
        Pulses::UpDown { up, down, edges } => {
            let (up, down) = (strobe("up_before", up, edges), strobe("down_before", down, edges));
            m.invariant("not_both_directions", !(alive & up & down));
            (up ^ down, down)
        }
        Pulses::Quadrature([a, b]) => {
            let (a, b) = (wire(m, a), wire(m, b));
            let place = b.concat(a ^ b);
            let moved = place.wrapping_sub(before(m, "before", place));
            m.invariant("one_signal_at_a_time", !(alive & moved.equals(m.lit(2, 2))));
            (moved.bit(0), moved.bit(1))
        }
        Pulses::Position(net) => {
            let position = m.net(net, false);
            let moved = position.wrapping_sub(before(m, "before", position));
            let one = moved.equals(m.lit(moved.bits(), 1));
            let minus_one = (!moved).is_zero();
            m.invariant("at_most_one_pulse", !alive | moved.is_zero() | one | minus_one);
            // Of a counter of one bit up and down are the same.
            (moved.is_nonzero(), minus_one & !one)
        }
    }
}
