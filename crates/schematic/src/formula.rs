//! Logic as text: what a net is, in terms of the nets that are drawn.

use stepwave_netlist::cells::Op;
use stepwave_netlist::{Net, Width};

use crate::fold::Fold;

/// How tightly the outermost operator of a text binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Level {
    Choice,
    Or,
    Xor,
    And,
    Compare,
    Atom,
}

/// A part of a text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Piece {
    Text(String),
    /// A net that is drawn, by its name.
    Net(Net),
    /// A net that is drawn, by a text that names it already: the name of a state.
    Named(Net, String),
}

/// A text about nets.
#[derive(Clone, Debug)]
pub(crate) struct Formula {
    pub(crate) pieces: Vec<Piece>,
    level: Level,
}

impl Formula {
    fn text(text: impl Into<String>) -> Formula {
        Formula { pieces: vec![Piece::Text(text.into())], level: Level::Atom }
    }

    fn net(net: Net) -> Formula {
        Formula { pieces: vec![Piece::Net(net)], level: Level::Atom }
    }

    fn push(&mut self, text: &str) {
        self.pieces.push(Piece::Text(text.to_owned()));
    }

    /// In parentheses where it binds less tightly.
    fn within(self, level: Level) -> Formula {
        if self.level >= level {
            return self;
        }
        let mut all = Formula::text("(");
        all.pieces.extend(self.pieces);
        all.push(")");
        all
    }

    fn joined(self, sign: &str, other: Formula, level: Level) -> Formula {
        let inner = if level == Level::Compare { Level::Atom } else { level };
        let mut all = self.within(inner);
        all.push(sign);
        all.pieces.extend(other.within(inner).pieces);
        Formula { level, ..all }
    }

    /// The nets that are drawn, each once.
    pub(crate) fn nets(&self) -> Vec<Net> {
        let mut nets: Vec<Net> = Vec::new();
        for piece in &self.pieces {
            if let Piece::Net(net) | Piece::Named(net, _) = piece
                && !nets.contains(net)
            {
                nets.push(*net);
            }
        }
        nets
    }

    /// The text, given how each net is written.
    pub(crate) fn written(&self, mut name: impl FnMut(Net) -> String) -> String {
        let text = |piece: &Piece| match piece {
            Piece::Text(text) | Piece::Named(_, text) => text.clone(),
            Piece::Net(net) => name(*net),
        };
        self.pieces.iter().map(text).collect()
    }
}

/// A number as it is shown: in decimal, a large one in hexadecimal.
pub(crate) fn number(value: u64) -> String {
    if value < 10_000 { value.to_string() } else { format!("0x{value:x}") }
}

impl Fold<'_> {
    /// What a net is: its name where it is drawn, else what drives it. A constant is written as it is, also where an output has it.
    pub(crate) fn formula(&self, net: Net) -> Formula {
        if self.has_readers(net) { Formula::net(net) } else { self.inner(net) }
    }

    /// What drives a net, whether it is drawn or not.
    pub(crate) fn inner(&self, net: Net) -> Formula {
        let width = self.netlist.width(net);
        if let Some(value) = self.constant(net) {
            return Formula::text(number(value));
        }
        match self.netlist.cell(net).op {
            Op::And(a, b) | Op::Or(a, b) if self.constant(a).is_some() && width == Width::ONE => self.formula(b),
            Op::And(a, b) | Op::Or(a, b) if self.constant(b).is_some() && width == Width::ONE => self.formula(a),
            Op::Not(of) => self.inverted(of),
            Op::And(a, b) => self.formula(a).joined(" & ", self.formula(b), Level::And),
            Op::Or(a, b) => self.formula(a).joined(" | ", self.formula(b), Level::Or),
            Op::Xor(a, b) => self.formula(a).joined(" ^ ", self.formula(b), Level::Xor),
            Op::Equal(a, b) => self.equal(a, b, " = "),
            Op::Mux { select, high, low } => self.choice(select, high, low),
            Op::Slice { of, low } => self.slice(of, u32::from(low), width),
            Op::Concat { high, low } => {
                let mut all = Formula::text("{");
                self.parts(high, &mut all);
                all.push(", ");
                self.parts(low, &mut all);
                all.push("}");
                all
            }
            Op::ZeroExtend(of) | Op::SignExtend(of) => self.formula(of),
            // All others are drawn.
            _ => Formula::net(net),
        }
    }

    /// The parts of a concatenation, without inner braces.
    fn parts(&self, net: Net, all: &mut Formula) {
        match self.netlist.cell(net).op {
            Op::Concat { high, low } if !self.drawn[net.index()] => {
                self.parts(high, all);
                all.push(", ");
                self.parts(low, all);
            }
            Op::Const(value) => {
                let width = self.netlist.width(net).get();
                all.push(&if width == 1 { number(value) } else { format!("{width}'{}", number(value)) });
            }
            _ => all.pieces.extend(self.formula(net).pieces),
        }
    }

    /// The complement of a net.
    pub(crate) fn inverted(&self, net: Net) -> Formula {
        if !self.drawn[net.index()] {
            match self.netlist.cell(net).op {
                Op::Not(of) => return self.formula(of),
                Op::Equal(a, b) => return self.equal(a, b, " ≠ "),
                Op::Slice { of, low } if self.is_sign(of, low, net) => {
                    return self.formula(of).joined(" ≥ ", Formula::text("0"), Level::Compare);
                }
                Op::Const(0) if self.netlist.width(net) == Width::ONE => return Formula::text("1"),
                Op::Const(1) if self.netlist.width(net) == Width::ONE => return Formula::text("0"),
                _ => {}
            }
        }
        let mut all = Formula::text("!");
        all.pieces.extend(self.formula(net).within(Level::Atom).pieces);
        all
    }

    fn equal(&self, a: Net, b: Net, sign: &str) -> Formula {
        let (a, b) = if self.constant(a).is_some() { (b, a) } else { (a, b) };
        let states = self.base(a).filter(|&base| self.netlist.width(base) == self.netlist.width(a));
        let state = states.zip(self.constant(b)).and_then(|(base, value)| self.state(base, value));
        let right = state.map_or_else(|| self.formula(b), Formula::text);
        self.formula(a).joined(sign, right, Level::Compare)
    }

    fn choice(&self, select: Net, high: Net, low: Net) -> Formula {
        let is_bit = self.netlist.width(high) == Width::ONE;
        match (self.constant(high), self.constant(low)) {
            (Some(0), _) if is_bit => self.inverted(select).joined(" & ", self.formula(low), Level::And),
            (Some(_), _) if is_bit => self.formula(select).joined(" | ", self.formula(low), Level::Or),
            (_, Some(0)) if is_bit => self.formula(select).joined(" & ", self.formula(high), Level::And),
            (_, Some(_)) if is_bit => self.inverted(select).joined(" | ", self.formula(high), Level::Or),
            _ => {
                let mut all = self.formula(select).within(Level::Or);
                all.push(" ? ");
                all.pieces.extend(self.formula(high).within(Level::Or).pieces);
                all.push(" : ");
                all.pieces.extend(self.formula(low).pieces);
                Formula { level: Level::Choice, ..all }
            }
        }
    }

    /// The top bit of a number in two's complement.
    fn is_sign(&self, of: Net, low: u8, bit: Net) -> bool {
        let is_top = u32::from(low) + 1 == self.netlist.width(of).get() && self.netlist.width(bit) == Width::ONE;
        is_top && self.base(of).is_some_and(|base| base == of && self.is_signed(base))
    }

    /// Bits of a net from `low` upwards.
    fn slice(&self, of: Net, low: u32, width: Width) -> Formula {
        let (high, all) = (low + width.get() - 1, self.netlist.width(of).get());
        if width.get() == all {
            return self.formula(of);
        }
        if !self.drawn[of.index()] {
            match self.netlist.cell(of).op {
                Op::Slice { of, low: below } => return self.slice(of, low + u32::from(below), width),
                Op::ZeroExtend(inner) | Op::SignExtend(inner) if high < self.netlist.width(inner).get() => {
                    return self.slice(inner, low, width);
                }
                Op::Concat { low: lower, .. } if high < self.netlist.width(lower).get() => {
                    return self.slice(lower, low, width);
                }
                Op::Concat { high: upper, low: lower } if low >= self.netlist.width(lower).get() => {
                    return self.slice(upper, low - self.netlist.width(lower).get(), width);
                }
                _ => {}
            }
        } else if width == Width::ONE {
            if high + 1 == all && self.is_signed(of) {
                return Formula::net(of).joined(" < ", Formula::text("0"), Level::Compare);
            }
            if let Some(name) = self.one_hot(of, low) {
                return Formula { pieces: vec![Piece::Named(of, name)], level: Level::Atom };
            }
        }
        let mut text = self.formula(of).within(Level::Atom);
        text.push(&if width == Width::ONE { format!("[{low}]") } else { format!("[{high}:{low}]") });
        Formula { level: Level::Atom, ..text }
    }
}
