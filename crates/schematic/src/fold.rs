//! Which nets are drawn, and which are text: slices, constants and small logic are written where they are read, overflow
//! flags are marked at what they watch, and multiplexers before a register are rows of its box.

use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Format, NamedNet, Op};
use stepwave_netlist::{Net, Netlist};

/// Characters of logic that is written where it is read: once, and several times.
const LONGEST: usize = 56;
const LONGEST_COPY: usize = 24;

/// A netlist with what becomes of each net in a drawing.
pub(crate) struct Fold<'n> {
    pub(crate) netlist: &'n Netlist,
    /// Something that is drawn depends on it.
    live: Vec<bool>,
    /// Cells that read it.
    uses: Vec<u32>,
    /// Its value where that is always the same.
    constants: Vec<Option<u64>>,
    /// The index of its first name.
    names: Vec<Option<usize>>,
    /// It has a symbol, or a pin of one.
    pub(crate) drawn: Vec<bool>,
    /// A multiplexer that is a row of the box of its only reader.
    chained: Vec<bool>,
    /// What has to be drawn, as a symbol is its only reader.
    operand: Vec<bool>,
}

/// A row of a box: the value under a condition.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    /// The select, and whether it must be 1; none where no row before holds.
    pub(crate) condition: Option<(Net, bool)>,
    pub(crate) value: Net,
}

impl<'n> Fold<'n> {
    /// Of a netlist of which these nets are outputs.
    pub(crate) fn new(netlist: &'n Netlist, outputs: &[Net]) -> Fold<'n> {
        let count = netlist.cells.len();
        let mut names = vec![None; count];
        for (index, named) in netlist.names.iter().enumerate() {
            named.nets().for_each(|net| {
                names[net.index()].get_or_insert(index);
            });
        }
        let empty = || vec![false; count];
        let [live, drawn, chained, operand] = [empty(), empty(), empty(), empty()];
        let constants = constants(netlist);
        let mut fold = Fold { netlist, live, uses: vec![0; count], constants, names, drawn, chained, operand };
        fold.find_live(outputs);
        fold.find_chains();
        fold.find_operands();
        fold.find_drawn(outputs);
        fold
    }

    /// The same of a netlist that differs in its scopes alone.
    pub(crate) fn with_scopes<'g>(self, netlist: &'g Netlist) -> Fold<'g>
    where
        'n: 'g,
    {
        Fold { netlist, ..self }
    }

    /// No cell reads it, and it is not an input.
    pub(crate) fn is_unread(&self, net: Net) -> bool {
        self.uses[net.index()] == 0 && self.netlist.cell(net).op != Op::Input
    }

    /// One cell reads it.
    pub(crate) fn is_read_once(&self, net: Net) -> bool {
        self.uses[net.index()] == 1
    }

    /// Bits of a net.
    pub(crate) fn width(&self, net: Net) -> u32 {
        self.netlist.width(net).get()
    }

    /// The first name of a net.
    pub(crate) fn named(&self, net: Net) -> Option<&'n NamedNet> {
        self.names[net.index()].map(|index| &self.netlist.names[index])
    }

    /// A name as that of one of its nets: with the bits that the net has of a word.
    pub(crate) fn part(&self, named: &NamedNet, net: Net) -> String {
        if !named.is_wide() {
            return named.name.clone();
        }
        let at = named.nets().position(|part| part == net).unwrap_or(0);
        let low = at * NamedNet::PART as usize;
        format!("{}[{}:{low}]", named.name, low + self.width(net) as usize - 1)
    }

    pub(crate) fn is_signed(&self, net: Net) -> bool {
        self.named(net).is_some_and(|named| !named.is_wide() && named.format.is_signed())
    }

    /// The name of a value of a net.
    pub(crate) fn state(&self, net: Net, value: u64) -> Option<String> {
        match &self.named(net)?.format {
            Format::States(names) => names.iter().find(|state| state.0 == value).map(|state| state.1.clone()),
            _ => None,
        }
    }

    /// The name of the state that a bit means, where every state has a bit of its own.
    pub(crate) fn one_hot(&self, net: Net, bit: u32) -> Option<String> {
        let Format::States(names) = &self.named(net)?.format else { return None };
        let alone = names.iter().all(|state| state.0.count_ones() <= 1) && names.len() > 2;
        if alone { self.state(net, 1 << bit) } else { None }
    }

    /// The value of a net that is always the same.
    pub(crate) fn constant(&self, net: Net) -> Option<u64> {
        self.constants[net.index()]
    }

    /// It is drawn, and may be wired to what reads it: a constant is written there.
    pub(crate) fn has_readers(&self, net: Net) -> bool {
        self.drawn[net.index()] && self.constant(net).is_none()
    }

    /// The net that is drawn for this one, if this is that net or bits of it.
    pub(crate) fn base(&self, net: Net) -> Option<Net> {
        if self.has_readers(net) {
            return Some(net);
        }
        match self.netlist.cell(net).op {
            Op::Slice { of, .. } | Op::ZeroExtend(of) | Op::SignExtend(of) => self.base(of),
            _ => None,
        }
    }

    /// The net under slices and extensions.
    pub(crate) fn under(&self, net: Net) -> Net {
        match self.netlist.cell(net).op {
            Op::Slice { of, .. } | Op::ZeroExtend(of) | Op::SignExtend(of) => self.under(of),
            _ => net,
        }
    }

    /// Marks what registers, memories, outputs and names depend on, but not what only flags do.
    fn find_live(&mut self, outputs: &[Net]) {
        let flags: Vec<Net> = self.netlist.properties.iter().map(|property| property.never).collect();
        let mut pending: Vec<Net> = outputs.iter().copied().filter(|net| !flags.contains(net)).collect();
        let names = self.netlist.names.iter().flat_map(NamedNet::nets);
        pending.extend(names.filter(|net| !flags.contains(net)));
        pending.extend(self.netlist.nets().filter(|&net| matches!(self.netlist.cell(net).op, Op::Register { .. })));
        for port in self.netlist.memories.iter().flat_map(|memory| &memory.writes) {
            pending.extend(port.nets());
            port.nets().iter().for_each(|net| self.uses[net.index()] += 1);
        }
        while let Some(net) = pending.pop() {
            if std::mem::replace(&mut self.live[net.index()], true) {
                continue;
            }
            for net in self.read(net) {
                self.uses[net.index()] += 1;
                pending.push(net);
            }
        }
    }

    /// What a net depends on: not on what a constant keeps from it.
    fn read(&self, net: Net) -> Vec<Net> {
        let mut read = Vec::new();
        let op = self.netlist.cell(net).op;
        match op {
            _ if self.constant(net).is_some() => {}
            Op::Register { next, .. } => read.extend(next),
            Op::Mux { select, high, low } => match self.constant(select) {
                Some(select) => read.push(if select == 1 { high } else { low }),
                None => read.extend([select, high, low]),
            },
            _ => op.visit_inputs(|input| read.push(input)),
        }
        read
    }

    /// A multiplexer that its only reader can have as a row.
    fn can_chain(&self, net: Net) -> bool {
        let is_choice = matches!(self.netlist.cell(net).op, Op::Mux { .. });
        is_choice && self.uses[net.index()] == 1 && self.names[net.index()].is_none()
    }

    fn find_chains(&mut self) {
        let mut nets: Vec<Net> = self.netlist.nets().collect();
        nets.reverse();
        for &net in &nets {
            match self.netlist.cell(net).op {
                Op::Register { next: Some(next), .. } if self.can_chain(next) => self.chained[next.index()] = true,
                _ => {}
            }
        }
        // A reader comes after what it reads, but for registers.
        for net in nets.into_iter().filter(|net| self.live[net.index()]) {
            if let Op::Mux { high, low, .. } = self.netlist.cell(net).op {
                let is_box = self.netlist.width(net) != Width::ONE || self.chained[net.index()];
                let next = [low, high].into_iter().find(|&next| self.can_chain(next));
                if let Some(next) = next.filter(|_| is_box) {
                    self.chained[next.index()] = true;
                }
            }
        }
    }

    /// The rows of a box whose value is this net.
    pub(crate) fn choices(&self, net: Net) -> Vec<Choice> {
        let (mut rows, mut at, mut is_first) = (Vec::new(), net, true);
        while let Op::Mux { select, high, low } = self.netlist.cell(at).op {
            if !(is_first && self.drawn[at.index()] && at == net || self.chained[at.index()]) {
                break;
            }
            is_first = false;
            let onwards = !self.chained[low.index()] && self.chained[high.index()];
            let (value, next) = if onwards { (low, high) } else { (high, low) };
            match self.constant(select).map(|select| (select == 1) != onwards) {
                // Never taken.
                Some(false) => {}
                Some(true) => {
                    at = value;
                    break;
                }
                None => rows.push(Choice { condition: Some((select, !onwards)), value }),
            }
            at = next;
        }
        rows.push(Choice { condition: None, value: at });
        rows
    }

    /// Operators have wires at their inputs, not texts.
    fn find_operands(&mut self) {
        for net in self.netlist.nets().filter(|net| self.live[net.index()]) {
            let op = self.netlist.cell(net).op;
            let mut inputs = Vec::new();
            if is_operator(&op) {
                op.visit_inputs(|input| inputs.push(self.under(input).index()));
            }
            inputs.into_iter().for_each(|input| self.operand[input] = true);
        }
    }

    fn find_drawn(&mut self, outputs: &[Net]) {
        for net in self.netlist.nets().filter(|&net| self.live[net.index()]).collect::<Vec<_>>() {
            let is_named = self.names[net.index()].is_some();
            let uses = self.uses[net.index()];
            let shown = outputs.contains(&net) || is_named && uses == 0;
            let op = self.netlist.cell(net).op;
            let longest = if uses > 1 { LONGEST_COPY } else { LONGEST };
            let is_long = |fold: &Fold| fold.length(net) > longest;
            self.drawn[net.index()] = match op {
                _ if self.chained[net.index()] => false,
                Op::Input | Op::Register { .. } => true,
                _ if self.constant(net).is_some() => outputs.contains(&net),
                Op::Slice { .. } | Op::ZeroExtend(_) | Op::SignExtend(_) => shown,
                Op::Mux { .. } if self.netlist.width(net) != Width::ONE => true,
                Op::Equal(a, b) if self.constant(a).is_none() && self.constant(b).is_none() => true,
                Op::Not(_)
                | Op::And(..)
                | Op::Or(..)
                | Op::Xor(..)
                | Op::Equal(..)
                | Op::Mux { .. }
                | Op::Concat { .. } => is_named || self.operand[net.index()] || shown || is_long(self),
                _ => true,
            };
        }
    }

    /// Characters of a net as text.
    fn length(&self, net: Net) -> usize {
        let name = |net: Net| self.named(net).map_or_else(|| "①".to_owned(), |named| named.name.clone());
        self.inner(net).written(name).chars().count()
    }
}

/// The values of nets that are always the same.
fn constants(netlist: &Netlist) -> Vec<Option<u64>> {
    let mut known: Vec<Option<u64>> = Vec::with_capacity(netlist.cells.len());
    for cell in &netlist.cells {
        let of = |net: Net| known[net.index()];
        let mask = cell.width.mask();
        known.push(match cell.op {
            Op::Const(value) => Some(value),
            Op::ZeroExtend(a) => of(a),
            Op::SignExtend(a) => of(a).map(|value| {
                let width = netlist.width(a);
                let ones = if value & width.sign_bit() == 0 { 0 } else { !width.mask() };
                (value | ones) & mask
            }),
            Op::Not(a) => of(a).map(|value| !value & mask),
            Op::Slice { of: a, low } => of(a).map(|value| value >> low & mask),
            Op::And(a, b) => match (of(a), of(b)) {
                (Some(0), _) | (_, Some(0)) => Some(0),
                (a, b) => a.zip(b).map(|(a, b)| a & b),
            },
            Op::Or(a, b) => match (of(a), of(b)) {
                (Some(ones), _) | (_, Some(ones)) if ones == mask => Some(ones),
                (a, b) => a.zip(b).map(|(a, b)| a | b),
            },
            Op::Concat { high, low } => of(high).zip(of(low)).map(|(a, b)| a << netlist.width(low).get() | b),
            _ => None,
        });
    }
    known
}

/// An operator that has a symbol of its own.
pub(crate) fn is_operator(op: &Op) -> bool {
    matches!(
        op,
        Op::Add(..)
            | Op::Sub(..)
            | Op::Mul(..)
            | Op::Div(..)
            | Op::Rem(..)
            | Op::ShiftLeft(..)
            | Op::ShiftRight(..)
            | Op::ShiftArithmetic(..)
            | Op::Carry(..)
            | Op::Borrow(..)
            | Op::AddOverflow(..)
            | Op::SubOverflow(..)
            | Op::LessSigned(..)
    )
}
