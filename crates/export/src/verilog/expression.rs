//! Expressions: exactly as many bits as the net has, in every context.
//!
//! Verilog widens operands to their context and takes a context as signed where all operands are. Neither happens here:
//! operands of one operator are equally wide, as the netlist has them; what changes a width is in braces, which are
//! a context of their own; comparisons say `$signed` or `$unsigned` where their operands do not.

use std::cell::RefCell;
use std::collections::BTreeSet;

use super::layout::{Form, Layout, Wide};
use super::names::Names;
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Netlist, Op, ScopeId};

/// How tightly an expression holds together; a looser one needs parentheses inside a tighter one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Binding {
    Select,
    Or,
    Xor,
    And,
    Equal,
    Less,
    Shift,
    Sum,
    Product,
    Unary,
    Atom,
}

/// A piece of Verilog and how to build upon it.
#[derive(Clone, Debug)]
pub(super) struct Expression {
    pub(super) text: String,
    binding: Binding,
    signed: bool,
}

impl Expression {
    fn atom(text: String) -> Expression {
        Expression { text, binding: Binding::Atom, signed: false }
    }

    /// The same bits, read as unsigned.
    fn into_unsigned(self) -> Expression {
        if self.signed { Expression::atom(format!("$unsigned({})", self.text)) } else { self }
    }

    /// The text, in parentheses if it is looser than `binding`.
    fn within(&self, binding: Binding) -> String {
        if self.binding < binding { format!("({})", self.text) } else { self.text.clone() }
    }
}

/// Writes expressions of one design.
pub(super) struct Writer<'a> {
    pub(super) netlist: &'a Netlist,
    pub(super) names: &'a Names,
    pub(super) layout: &'a Layout,
    /// Nets whose names are hidden where they are read, so that a further name was made up.
    pub(super) hidden: RefCell<BTreeSet<Net>>,
}

/// A constant with its width.
pub(super) fn literal(width: Width, value: u64) -> String {
    format!("{}'d{value}", width.get())
}

/// Index of some bits of a name: nothing if they are all.
fn range(of: u32, low: u32, width: u32) -> String {
    match width {
        _ if width == of => String::new(),
        1 => format!("[{low}]"),
        _ => format!("[{}:{low}]", low + width - 1),
    }
}

impl Writer<'_> {
    /// A net's value, read in a scope.
    pub(super) fn read(&self, net: Net, place: ScopeId) -> Expression {
        match (self.layout.known(net), self.layout.forms[net.index()]) {
            // A number says more than a name.
            (Some(value), _) => Expression::atom(literal(self.netlist.width(net), value)),
            (None, Form::Named | Form::Unnamed) => {
                Expression { signed: self.is_signed(net), ..Expression::atom(self.name(net, place)) }
            }
            (None, Form::Inline | Form::Arm | Form::Dead) => self.value(net, place),
        }
    }

    fn is_signed(&self, net: Net) -> bool {
        self.names.first(net).is_some_and(|entry| self.netlist.names[entry].format.is_signed())
    }

    /// The name of a declared net, as seen from a scope.
    pub(super) fn name(&self, net: Net, place: ScopeId) -> String {
        let Some(entry) = self.names.first(net) else { return self.names.unnamed(net) };
        match self.names.path_from(self.netlist, entry, place) {
            // Yosys accepts no escaped name after a dot: the scope has a further name for it.
            Some(path) if self.names.is_escaped(entry) && path.contains('.') => {
                let scopes = path.strip_suffix(&self.names.named[entry]).unwrap_or_default();
                format!("{scopes}{}", self.names.unnamed(net))
            }
            Some(path) => path,
            None => {
                self.hidden.borrow_mut().insert(net);
                self.names.unnamed(net)
            }
        }
    }

    /// Some bits of a net that is declared or a part of something declared.
    pub(super) fn part(&self, net: Net, low: u32, width: u32, place: ScopeId) -> String {
        let inner = |of: Net, below: u32| self.part(of, low + below, width, place);
        let all = self.netlist.width(net).get();
        if let Some(value) = self.layout.known(net) {
            let mask = u64::MAX >> (64 - width);
            return format!("{width}'d{}", value >> low & mask);
        }
        if self.layout.forms[net.index()] == Form::Inline {
            match (self.netlist.cell(net).op, self.layout.wide_of(net)) {
                (Op::Slice { of, low: below }, _) => return inner(of, u32::from(below)),
                (Op::Add(..) | Op::Sub(..), Some(wide)) => {
                    return self.names.wide(wide.of) + &range(all + 1, low, width);
                }
                _ if width == all => return self.read(net, place).text,
                // The layout declares every net that is cut.
                _ => {}
            }
        }
        self.name(net, place) + &range(all, low, width)
    }

    /// The widened sum or difference of a carry or an overflow.
    pub(super) fn wide(&self, wide: &Wide, place: ScopeId) -> String {
        let widened = |net: Net| {
            if let Some(value) = self.layout.known(net) {
                let width = self.netlist.width(net);
                let above = wide.signed && value & width.sign_bit() != 0;
                return format!("{}'d{}", width.get() + 1, u128::from(value) | u128::from(above) << width.get());
            }
            let value = self.read(net, place).text;
            let top = self.netlist.width(net).get() - 1;
            let above = if wide.signed { self.part(net, top, 1, place) } else { "1'b0".to_owned() };
            format!("{{{above}, {value}}}")
        };
        let operator = if wide.subtract { '-' } else { '+' };
        format!("{} {operator} {}", widened(wide.left), widened(wide.right))
    }

    /// What a cell computes, written in a scope.
    pub(super) fn value(&self, net: Net, place: ScopeId) -> Expression {
        let cell = self.netlist.cell(net);
        let width = cell.width.get();
        let read = |net: Net| self.read(net, place);
        if let Some(value) = self.layout.known(net) {
            return Expression::atom(literal(cell.width, value));
        }
        if let Some(passed) = self.layout.passed(cell.op) {
            return read(passed);
        }
        if let Some(wide) = self.layout.wide_of(net) {
            let name = self.names.wide(wide.of);
            let top = self.netlist.width(wide.left).get();
            return match cell.op {
                Op::Carry(..) => Expression::atom(format!("{name}[{top}]")),
                Op::Add(..) | Op::Sub(..) => Expression::atom(name + &range(width + 1, 0, width)),
                // The added bit holds the sign of the exact result.
                _ => Expression {
                    binding: Binding::Xor,
                    ..Expression::atom(format!("{name}[{top}] ^ {name}[{}]", top - 1))
                },
            };
        }
        match cell.op {
            Op::Input | Op::Register { .. } => read(net),
            Op::Const(value) => Expression::atom(literal(cell.width, value)),
            Op::Not(a) => self.not(a, place),
            Op::And(a, b) => self.both(a, "&", b, Binding::And, place),
            Op::Or(a, b) => self.both(a, "|", b, Binding::Or, place),
            Op::Xor(a, b) => self.both(a, "^", b, Binding::Xor, place),
            Op::Add(a, b) => self.both(a, "+", b, Binding::Sum, place),
            Op::Sub(a, b) => self.both(a, "-", b, Binding::Sum, place),
            Op::Mul(a, b) => self.both(a, "*", b, Binding::Product, place),
            Op::Div(a, b) => self.divide(a, "/", b, place),
            Op::Rem(a, b) => self.divide(a, "%", b, place),
            Op::ShiftLeft(a, by) => self.shift(a, "<<", by, place),
            Op::ShiftRight(a, by) => self.shift(a, ">>", by, place),
            // In braces: an unsigned operand next to it would let zeros enter.
            Op::ShiftArithmetic(a, by) => {
                let (a, by) = (read(a), read(by).into_unsigned().within(Binding::Unary));
                let a = if a.signed { a.within(Binding::Unary) } else { format!("$signed({})", a.text) };
                Expression::atom(format!("{{{a} >>> {by}}}"))
            }
            Op::Mux { select, high, low } => {
                let (select, high, low) = (read(select), read(high), read(low));
                let tight = Binding::Or;
                let text = format!("{} ? {} : {}", select.within(tight), high.within(tight), low.text);
                Expression { text, binding: Binding::Select, signed: high.signed && low.signed }
            }
            Op::Equal(a, b) => Expression { signed: false, ..self.both(a, "==", b, Binding::Equal, place) },
            Op::Borrow(a, b) => self.less("$unsigned", a, b, place),
            Op::LessSigned(a, b) => self.less("$signed", a, b, place),
            Op::Slice { of, .. } if self.netlist.width(of).get() == width => read(of).into_unsigned(),
            Op::Slice { of, low } => Expression::atom(self.part(of, u32::from(low), width, place)),
            Op::Concat { high, low } => Expression::atom(format!("{{{}, {}}}", read(high).text, read(low).text)),
            Op::ZeroExtend(a) | Op::SignExtend(a) if self.netlist.width(a).get() == width => read(a),
            Op::ZeroExtend(a) => {
                let more = width - self.netlist.width(a).get();
                Expression::atom(format!("{{{more}'d0, {}}}", read(a).text))
            }
            Op::SignExtend(a) => {
                let (from, value) = (self.netlist.width(a).get(), read(a).text);
                let more = width - from;
                let sign = if from == 1 { value.clone() } else { self.part(a, from - 1, 1, place) };
                let signs = if more == 1 { sign } else { format!("{{{more}{{{sign}}}}}") };
                Expression::atom(format!("{{{signs}, {value}}}"))
            }
            Op::Read { memory, address } => {
                let word = self.word(memory as usize, address, place);
                Expression::atom(match self.inside(memory as usize, address, place) {
                    Some(inside) => format!("{{{inside} ? {word} : {}}}", literal(cell.width, 0)),
                    None => word,
                })
            }
            // Always parts of a widened adder.
            Op::Carry(..) | Op::AddOverflow(..) | Op::SubOverflow(..) => Expression::atom(self.names.unnamed(net)),
        }
    }

    /// A word of a memory.
    pub(super) fn word(&self, memory: usize, address: Net, place: ScopeId) -> String {
        format!("{}[{}]", self.names.memories[memory], self.read(address, place).into_unsigned().text)
    }

    /// The address is one of the memory; none where it always is.
    pub(super) fn inside(&self, memory: usize, address: Net, place: ScopeId) -> Option<String> {
        let (size, width) = (self.netlist.memories[memory].size, self.netlist.width(address));
        let address = self.read(address, place).into_unsigned().within(Binding::Shift);
        (size <= width.mask()).then(|| format!("{address} < {}", literal(width, size)))
    }

    /// The address is a constant beyond the memory: a port that writes there writes nothing, and simulators warn of it.
    pub(super) fn is_outside(&self, memory: usize, address: Net) -> bool {
        self.layout.known(address).is_some_and(|address| address >= self.netlist.memories[memory].size)
    }

    /// The complement, without a second one in front of a first.
    fn not(&self, net: Net, place: ScopeId) -> Expression {
        let inline = self.layout.forms[net.index()] == Form::Inline && self.layout.known(net).is_none();
        match self.netlist.cell(net).op {
            Op::Equal(a, b) if inline => Expression { signed: false, ..self.both(a, "!=", b, Binding::Equal, place) },
            Op::Not(a) if inline => self.read(a, place),
            _ => {
                let value = self.read(net, place);
                let text = format!("~{}", value.within(Binding::Atom));
                Expression { text, binding: Binding::Unary, signed: value.signed }
            }
        }
    }

    fn both(&self, a: Net, operator: &str, b: Net, binding: Binding, place: ScopeId) -> Expression {
        let (a, b) = (self.read(a, place), self.read(b, place));
        // Only these may have an equal operator on the right without parentheses; mixed ones get them for the reader.
        let chains = matches!(binding, Binding::And | Binding::Or | Binding::Xor);
        let side = |side: &Expression, chained: bool| {
            let same = side.binding == binding && chained;
            if same || side.binding > binding.max(Binding::And) {
                side.text.clone()
            } else {
                format!("({})", side.text)
            }
        };
        let left = side(&a, chains || binding == Binding::Sum);
        let right = side(&b, chains);
        Expression { text: format!("{left} {operator} {right}"), binding, signed: a.signed && b.signed }
    }

    /// A quotient or remainder of unsigned numbers, 0 where the divisor is 0.
    fn divide(&self, a: Net, operator: &str, b: Net, place: ScopeId) -> Expression {
        let width = self.netlist.width(a);
        let zero = literal(width, 0);
        let (a, b) = (self.read(a, place).into_unsigned(), self.read(b, place).into_unsigned());
        let (a, b) = (a.within(Binding::Unary), b.within(Binding::Unary));
        match width {
            // A quotient by 1; a remainder of 1 bit is known.
            Width::ONE => Expression { binding: Binding::And, ..Expression::atom(format!("{a} & {b}")) },
            _ => Expression::atom(format!("{{{b} == {zero} ? {zero} : {a} {operator} {b}}}")),
        }
    }

    /// A shift in which zeros enter.
    fn shift(&self, a: Net, operator: &str, by: Net, place: ScopeId) -> Expression {
        let (a, by) = (self.read(a, place), self.read(by, place).into_unsigned());
        let text = format!("{} {operator} {}", a.within(Binding::Unary), by.within(Binding::Unary));
        Expression { text, binding: Binding::Shift, signed: a.signed }
    }

    fn less(&self, reading: &str, a: Net, b: Net, place: ScopeId) -> Expression {
        let (a, b) = (self.read(a, place), self.read(b, place));
        let wants_signed = reading == "$signed";
        // One unsigned operand makes the comparison unsigned.
        let as_it_is = if wants_signed { a.signed && b.signed } else { !(a.signed && b.signed) };
        let side = |side: &Expression| {
            if as_it_is { side.within(Binding::Atom) } else { format!("{reading}({})", side.text) }
        };
        let text = format!("{} < {}", side(&a), side(&b));
        Expression { text, binding: Binding::Less, signed: false }
    }
}
