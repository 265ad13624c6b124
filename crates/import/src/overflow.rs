//! Overflow events: an exact result that does not fit in the bits that are kept of it, in a clock in which it is taken.
//!
//! False alarms are what makes people switch such checks off, so:
//! - only bits that something reads count as kept, and a carry that is read elsewhere is kept;
//! - a result is taken where multiplexers and enables let it, and what other logic makes of it, through into a register or
//!   an output: `t == 9 ? 0 : t + 1` never takes what it drops;
//! - what nobody has named is read as its operands are, so that parts of a signed expression are signed;
//! - what cannot overflow for any values of its operands has no event;
//! - `(* stepwave_wraps *)` on the net or register announces that a carry is meant to be lost.

use std::collections::{HashMap, HashSet};

use stepwave_netlist::Net;
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::Word as Operand;
use stepwave_netlist::cells::{Claim, Format, NamedNet, Op, Operator, Property, ScopeData, ScopeId};

use crate::cells::is_register;
use crate::design::Design;
use crate::json::{Cell, Wire};
use crate::names::Scopes;
use crate::word::Word;

/// Attribute of a net or register whose carry is meant to be lost.
const WRAPS: &str = "stepwave_wraps";

/// A pin that reads bits of a cell.
struct Reader<'a> {
    cell: &'a Cell,
    name: &'a str,
    pin: &'a str,
    /// Place of the bit on the pin.
    at: usize,
}

/// Who reads each numbered net, and which nets are outputs of the design.
pub(crate) struct Readers<'a> {
    of: HashMap<u32, Vec<Reader<'a>>>,
    /// When the result of a cell is taken, by its name and the port of a memory; `None` while it is being worked out.
    taken: HashMap<(&'a str, usize), Option<Net>>,
    outputs: HashSet<u32>,
    /// Bits that anything reads.
    read: HashSet<u32>,
    /// Cells one after another that are being looked at.
    depth: usize,
}

/// Logic of more cells one after another is taken to take what it reads.
const DEEPEST: usize = 400;

/// An operand as numbers: its word, its reading, and the least and greatest number that it can be, up to 64 bits.
struct Read {
    word: Word,
    signed: bool,
    range: Option<[i128; 2]>,
}

impl Read {
    /// It, for a claim.
    fn operand(&self) -> Operand {
        Operand { nets: self.word.parts.clone(), signed: self.signed }
    }
}

/// The number needs no more bits than these.
fn holds(kept: usize, signed: bool, number: i128) -> bool {
    (signed || number >= 0) && Width::needed(number, signed) as usize <= kept
}

fn is_constant(wires: &[Wire]) -> bool {
    wires.iter().all(|wire| matches!(wire, Wire::Constant(_)))
}

/// Read as signed: the cell is, or the upper bits are copies of one net, or it is a constant of mostly leading ones.
fn is_signed(wires: &[Wire], cell_signed: bool) -> bool {
    if cell_signed {
        return true;
    }
    let Some(top) = wires.last() else { return false };
    let copies = wires.iter().rev().take_while(|wire| *wire == top).count();
    match top {
        Wire::Net(_) => copies > 1,
        Wire::Constant(text) => text == "1" && wires.len() > 1 && is_constant(wires) && 2 * copies > wires.len(),
    }
}

/// The inputs of multiplexers that are handed on to a bit.
fn handed_on(cell: &Cell) -> impl Iterator<Item = (&Wire, &Wire)> {
    let y = cell.pin("Y");
    let pins = if is_multiplexer(cell) { ["A", "B"] } else { ["", ""] };
    pins.into_iter().flat_map(move |pin| cell.pin(pin).iter().zip(y.iter().cycle()))
}

fn is_multiplexer(cell: &Cell) -> bool {
    matches!(cell.kind.as_str(), "$mux" | "$pmux")
}

impl Readers<'_> {
    /// Finds the bits that anything reads: what a multiplexer hands on counts where its result is read.
    fn find_read<'c>(&mut self, cells: impl Iterator<Item = &'c Cell> + Clone) {
        let mut from: HashMap<u32, Vec<u32>> = HashMap::new();
        for (input, output) in cells.flat_map(handed_on) {
            if let (Wire::Net(input), Wire::Net(output)) = (input, output) {
                from.entry(*output).or_default().push(*input);
            }
        }
        let outright = |reader: &Reader<'_>| !is_multiplexer(reader.cell) || reader.pin == "S";
        let read = self.of.iter().filter(|(_, all)| all.iter().any(outright)).map(|(net, _)| *net);
        let mut pending: Vec<u32> = read.chain(self.outputs.iter().copied()).collect();
        while let Some(net) = pending.pop() {
            if self.read.insert(net) {
                pending.extend(from.get(&net).into_iter().flatten());
            }
        }
    }

    pub(crate) fn is_read(&self, wire: &Wire) -> bool {
        matches!(wire, Wire::Net(net) if self.read.contains(net))
    }
}

impl<'a> Design<'a> {
    /// Who reads what.
    pub(crate) fn readers(&self) -> Readers<'a> {
        let mut of: HashMap<u32, Vec<Reader<'a>>> = HashMap::new();
        let module = self.module;
        // What only a text shows is not part of the hardware.
        for (name, cell) in module.cells.iter().filter(|(_, cell)| cell.kind != "$print") {
            for (pin, wires) in
                cell.connections.iter().filter(|(pin, _)| !matches!(pin.as_str(), "Y" | "Q" | "RD_DATA"))
            {
                for (at, wire) in wires.iter().enumerate() {
                    if let Wire::Net(net) = wire {
                        of.entry(*net).or_default().push(Reader { cell, name, pin, at });
                    }
                }
            }
        }
        let ports = module.ports.values().filter(|port| port.direction == "output");
        let outputs = ports.flat_map(|port| &port.bits).filter_map(|wire| match wire {
            Wire::Net(net) => Some(*net),
            Wire::Constant(_) => None,
        });
        let (taken, outputs, read) = (HashMap::new(), outputs.collect(), HashSet::new());
        let mut readers = Readers { of, taken, outputs, read, depth: 0 };
        readers.find_read(module.cells.values());
        readers
    }

    /// A property for every operator whose result may not fit.
    pub(crate) fn overflows(&mut self, scopes: &mut Scopes, readers: &mut Readers<'a>) {
        let module = self.module;
        let arithmetic = |kind: &str| matches!(kind, "$add" | "$sub" | "$neg" | "$mul" | "$pow" | "$shl" | "$sshl");
        let mut flags: Vec<(String, Net)> = Vec::new();
        for (name, cell) in module.cells.iter().filter(|(_, cell)| arithmetic(&cell.kind)) {
            let y = cell.pin("Y");
            let kept = y.iter().rposition(|wire| readers.is_read(wire)).map_or(0, |last| last + 1);
            // Yosys has made it of an index, and not the author.
            if name.contains(":0$") || cell.place().is_some_and(|place| place.line == 0) {
                continue;
            }
            self.at(cell);
            let target = self.target(name, &y[..kept], readers);
            if let Some((never, claim)) = self.lost(name, cell, kept, &target, readers) {
                let operator = cell.kind.trim_start_matches('$');
                let place = cell.short_line().unwrap_or_else(|| name.clone());
                let target = if target.name.is_empty() { format!("{place} {operator}") } else { target.name };
                let path = format!("{}.{target}", self.builder.netlist.scopes[0].name);
                flags.push((target, never));
                self.builder.netlist.properties.push(Property { name: path, never, claim });
            }
        }
        self.show_flags(scopes, "overflow", flags);
    }

    /// Names the nets of some properties in a scope of their own.
    pub(crate) fn show_flags(&mut self, scopes: &mut Scopes, scope: &str, flags: Vec<(String, Net)>) {
        if flags.is_empty() {
            return;
        }
        let (_, own) = scopes.place(&mut self.builder.netlist.scopes, scope);
        let scope = ScopeId(u32::try_from(self.builder.netlist.scopes.len()).unwrap_or(u32::MAX));
        self.builder.netlist.scopes.push(ScopeData { parent: Some(ScopeId::TOP), name: own });
        for (name, net) in flags {
            let name = scopes.fresh(scope, &crate::names::cleaned(&name));
            self.builder.netlist.names.push(NamedNet::new(net, scope, &name, Format::Unsigned));
        }
    }

    /// When an operator loses something of its exact result, and what is claimed; `None` where it never does.
    fn lost(
        &mut self,
        name: &'a str,
        cell: &'a Cell,
        kept: usize,
        target: &Target,
        readers: &mut Readers<'a>,
    ) -> Option<(Net, Claim)> {
        if kept == 0 {
            return None;
        }
        let operator = match cell.kind.as_str() {
            "$add" => Operator::Add,
            "$sub" => Operator::Sub,
            "$neg" => Operator::Neg,
            "$mul" => Operator::Mul,
            "$pow" => Operator::Power,
            _ => Operator::ShiftLeft,
        };
        let shift = operator == Operator::ShiftLeft;
        let power = operator == Operator::Power;
        let of_left = matches!(operator, Operator::Neg | Operator::ShiftLeft | Operator::Power);
        let both = cell.flag("A_SIGNED") && (of_left || cell.flag("B_SIGNED"));
        let a = self.operand_read(cell.pin("A"), is_signed(cell.pin("A"), both))?;
        let b = match operator {
            Operator::Neg => self.operand_read(&[Wire::Constant("0".to_owned())], false)?,
            // An exponent that is imported is not negative.
            Operator::Power => self.operand_read(cell.pin("B"), false)?,
            _ => self.operand_read(cell.pin("B"), is_signed(cell.pin("B"), both && !shift) && !shift)?,
        };
        // What nobody has named is read as its operands are.
        let unnamed = both || a.signed && (b.signed || of_left);
        let (signed, wraps) = (target.signed.unwrap_or(unnamed), target.wraps);
        let results = a.range.zip(b.range).and_then(|(a, b)| operator.range(a, b));
        if results.is_some_and(|(low, high)| holds(kept, signed, low) && holds(kept, signed, high)) {
            return None;
        }
        let bits = u32::try_from(kept).unwrap_or(u32::MAX);
        let outside = match b.range {
            // Of a constant exponent alone.
            Some([least, exponent]) if power && least == exponent && exponent > 1 => {
                self.power_outside(&a, exponent, bits, signed)
            }
            _ if power => return None,
            _ => self.outside(operator, &a, &b, bits, signed),
        };
        let taken = self.cell_taken(name, cell, readers);
        // A bit of its own, so that it has the line of this operator.
        let never = self.builder.push(Op::And(outside, taken), 1);
        let (left, right) = (a.operand(), b.operand());
        Some((never, Claim::Fits { operator, left, right, bits, signed, wraps }))
    }

    fn operand_read(&mut self, wires: &[Wire], signed: bool) -> Option<Read> {
        if wires.is_empty() {
            return None;
        }
        let word = self.word(wires);
        let range = self.numbers(wires, signed);
        Some(Read { word, signed, range })
    }

    /// Least and greatest number that is on these wires, up to 64 of them.
    pub(crate) fn numbers(&self, wires: &[Wire], signed: bool) -> Option<[i128; 2]> {
        // Zeros above are not part of the number.
        let zeros = wires.iter().rev().take_while(|wire| **wire == Wire::Constant("0".to_owned())).count();
        let width = Width::new((wires.len() - if signed { 0 } else { zeros }).max(1) as u64).ok()?;
        if is_constant(wires) {
            let value = wires
                .iter()
                .rev()
                .fold(0u64, |value, wire| value << 1 | u64::from(*wire == Wire::Constant("1".to_owned())));
            let value = stepwave_netlist::bits::number(width, value, signed);
            return Some([value, value]);
        }
        let (least, greatest) = width.range(signed);
        Some([least, greatest])
    }

    /// The exact result is outside of what the kept bits show.
    fn outside(&mut self, operator: Operator, a: &Read, b: &Read, kept: u32, signed: bool) -> Net {
        if operator == Operator::ShiftLeft {
            // Shifted there and back: something is lost where another number comes out.
            let wide = a.word.width.max(kept) + 1;
            let x = self.builder.fit(&a.word, wide, a.signed);
            let there = self.builder.shift(&x, &b.word, true, false);
            let there = self.builder.fit(&there, kept, signed);
            let there = self.builder.fit(&there, wide, signed);
            let back = self.builder.shift(&there, &b.word, false, signed);
            let same = self.builder.equal(&back, &x);
            // An amount beyond the word shifts everything out, which comes back as 0.
            let limit = self.builder.number(u64::from(kept), b.word.width.max(u32::BITS));
            let amount = self.builder.fit(&b.word, b.word.width.max(u32::BITS), false);
            let small = self.builder.less(&amount, &limit, false);
            let any = self.builder.any(&x);
            let (large, changed) = (self.builder.invert(small), self.builder.invert(same));
            let gone = self.builder.and(large, any);
            return self.builder.or(changed, gone);
        }
        let wide = match operator {
            Operator::Mul => a.word.width + b.word.width + 2,
            _ => a.word.width.max(b.word.width) + 2,
        };
        let wide = wide.max(kept + 1);
        let x = self.builder.fit(&a.word, wide, a.signed);
        let y = self.builder.fit(&b.word, wide, b.signed);
        let exact = match operator {
            Operator::Add => self.builder.add(&x, &y, None).0,
            Operator::Sub => self.builder.sub(&x, &y),
            Operator::Neg => self.builder.negate(&x),
            _ => self.builder.mul(&x, &y),
        };
        let cut = self.builder.fit(&exact, kept, false);
        let shown = self.builder.fit(&cut, wide, signed);
        let same = self.builder.equal(&shown, &exact);
        self.builder.invert(same)
    }

    /// The same of a power, without more bits than those of the base that can matter.
    fn power_outside(&mut self, base: &Read, exponent: i128, kept: u32, signed: bool) -> Net {
        // What is neither 0, 1 nor -1 has with such an exponent more bits than are kept: the least that is odd or even too.
        let most = i128::from(kept) + 2;
        let exponent = exponent.min(most + (exponent - most).rem_euclid(2));
        let exponent = u32::try_from(exponent).unwrap_or(0);
        // A base that does not fit in these bits, of which one is a sign, overflows.
        let narrow = (kept + 1).div_ceil(exponent.max(1)) + 2;
        let all = self.builder.fit(&base.word, base.word.width.max(narrow) + 1, base.signed);
        let low = self.builder.fit(&all, narrow, false);
        let back = self.builder.fit(&low, all.width, true);
        let small = self.builder.equal(&back, &all);
        let wide = (narrow * exponent).max(kept) + 2;
        let factor = self.builder.fit(&low, wide, true);
        let mut exact = self.builder.number(1, wide);
        for bit in (0..u32::BITS - exponent.leading_zeros()).rev() {
            exact = self.builder.mul(&exact, &exact);
            if exponent >> bit & 1 == 1 {
                exact = self.builder.mul(&exact, &factor);
            }
        }
        let cut = self.builder.fit(&exact, kept, false);
        let shown = self.builder.fit(&cut, wide, signed);
        let same = self.builder.equal(&shown, &exact);
        let fits = self.builder.and(small, same);
        self.builder.invert(fits)
    }

    /// What the result of a cell of this name is for.
    pub(crate) fn target(&self, cell: &str, bits: &[Wire], readers: &Readers<'a>) -> Target {
        // `$flatten\\s2.$sub$…` is of the scope s2.
        let inner = cell.strip_prefix("$flatten").map_or("", |rest| rest.trim_start_matches('\\'));
        let scope = inner.rsplit_once(".$").map_or("", |(scope, _)| scope);
        let of = |bits: &[Wire]| {
            let names = self.module.netnames.iter().filter(|(_, name)| !name.is_hidden());
            let found = names.filter(|(_, name)| {
                name.bits.starts_with(bits) || bits.starts_with(&name.bits) && name.bits.len() + 1 >= bits.len()
            });
            // Its own bits rather than a part of others, and what is declared where the operator is.
            let found = found.min_by_key(|(name, of)| {
                let outer = name.rsplit_once('.').map_or("", |(outer, _)| outer);
                (of.bits != bits, outer != scope, of.bits.len())
            });
            found.map(|(name, of)| Target { name: name.clone(), signed: Some(of.is_signed()), wraps: of.has(WRAPS) })
        };
        let mut bits = bits.to_vec();
        for _ in 0..16 {
            let Some(Wire::Net(first)) = bits.first().cloned() else { break };
            if let Some(target) = of(&bits) {
                return target;
            }
            // Through multiplexers, extensions and into the register.
            let Some(reader) = readers.of.get(&first).and_then(|all| all.iter().find(|reader| passes(reader))) else {
                break;
            };
            let out = if is_register(&reader.cell.kind) { reader.cell.pin("Q") } else { reader.cell.pin("Y") };
            let low = if reader.cell.kind == "$pmux" { reader.at % out.len().max(1) } else { reader.at };
            bits = out.iter().skip(low).take(bits.len()).cloned().collect();
        }
        Target { name: String::new(), signed: None, wraps: false }
    }

    /// When the result of a cell is taken.
    pub(crate) fn cell_taken(&mut self, name: &'a str, cell: &'a Cell, readers: &mut Readers<'a>) -> Net {
        self.bits_taken((name, 0), cell.pin("Y"), readers)
    }

    /// When bits are taken that are a result of a cell; `key` is its name and the port of a memory.
    pub(crate) fn bits_taken(&mut self, key: (&'a str, usize), bits: &[Wire], readers: &mut Readers<'a>) -> Net {
        let always = self.builder.number(1, 1).parts[0];
        match readers.taken.get(&key) {
            Some(Some(net)) => return *net,
            Some(None) => return always,
            None => {}
        }
        readers.taken.insert(key, None);
        let mut all: Vec<(&'a str, &'a str, &'a Cell, usize)> = Vec::new();
        let mut output = false;
        for wire in bits {
            let Wire::Net(net) = wire else { continue };
            output |= readers.outputs.contains(net);
            let width = |reader: &Reader<'a>| reader.cell.pin("Y").len().max(1);
            // Of a multiplexer with several inputs, which of them.
            let slot = |reader: &Reader<'a>| {
                if reader.cell.kind == "$pmux" && reader.pin == "B" { reader.at / width(reader) } else { 0 }
            };
            all.extend(
                readers
                    .of
                    .get(net)
                    .into_iter()
                    .flatten()
                    .map(|reader| (reader.name, reader.pin, reader.cell, slot(reader))),
            );
        }
        all.sort_by_key(|(name, pin, _, slot)| (*name, *pin, *slot));
        all.dedup_by_key(|(name, pin, _, slot)| (*name, *pin, *slot));
        let mut taken = self.builder.number(u64::from(output), 1).parts[0];
        for (name, pin, reader, slot) in all {
            let own = self.reader_takes(name, pin, reader, slot, readers);
            taken = self.builder.or(taken, own);
        }
        readers.taken.insert(key, Some(taken));
        taken
    }

    /// When a pin takes what is on it.
    fn reader_takes(
        &mut self,
        name: &'a str,
        pin: &str,
        cell: &'a Cell,
        slot: usize,
        readers: &mut Readers<'a>,
    ) -> Net {
        let always = self.builder.number(1, 1).parts[0];
        let chosen = match (cell.kind.as_str(), pin) {
            ("$mux", "A" | "B") | ("$pmux", "A") => {
                let select = self.word(cell.pin("S"));
                let any = self.builder.any(&select);
                if pin == "A" { self.builder.invert(any) } else { any }
            }
            ("$pmux", "B") => {
                let Some(select) = cell.pin("S").get(slot) else { return always };
                self.word(std::slice::from_ref(select)).parts[0]
            }
            (kind, "D") if is_register(kind) => return self.clocked_in(cell),
            // Other logic takes what its own result is taken for.
            _ if readers.depth < DEEPEST && !cell.pin("Y").is_empty() => always,
            _ => return always,
        };
        readers.depth += 1;
        let after = self.cell_taken(name, cell, readers);
        readers.depth -= 1;
        self.builder.and(chosen, after)
    }

    /// A register takes its data at the next edge.
    fn clocked_in(&mut self, cell: &Cell) -> Net {
        let mut taken = self.builder.number(1, 1).parts[0];
        for (pin, active) in [("EN", true), ("SRST", false), ("ARST", false), ("ALOAD", false)] {
            if let Some(net) = self.control(cell, pin) {
                let net = if active { net } else { self.builder.invert(net) };
                taken = self.builder.and(taken, net);
            }
        }
        taken
    }
}

/// What a result drives: its name, its declared sign, and whether it is announced to wrap.
pub(crate) struct Target {
    pub(crate) name: String,
    /// Its declared sign; nothing where nobody has named it.
    signed: Option<bool>,
    wraps: bool,
}

/// A pin that hands a word on unchanged.
fn passes(reader: &Reader<'_>) -> bool {
    match reader.cell.kind.as_str() {
        "$mux" | "$pmux" => reader.pin != "S",
        "$pos" => true,
        kind => is_register(kind) && reader.pin == "D",
    }
}
