//! SMT-LIB 2 in the logic of bit vectors, of any design: what holds in every clock, and the question whether a property
//! is violated within some clocks.
//!
//! Four functions say what the design is. `init`: the registers have their reset values. `settled`: every net is what
//! its cell makes of its operands. `edge`: the registers take their next values, which are marked with a `+`.
//! `violated`: a property is. The question strings clocks together, each with a constant `PATH@CLOCK` for every net, so
//! that a solver that answers `sat` can be asked for all of them; clock k is sample k of an engine.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::words::{Symbols, Term, leaves, term};
use super::{Checking, comment};
use stepwave_netlist::bits::{Bits, Width};
use stepwave_netlist::cells::{Claim, Net, Netlist, Op};
use stepwave_netlist::{Design, HasMemories};

/// The design as an SMT-LIB 2 script that asks whether a property is violated in one of the clocks 0 to `depth`: `sat`
/// if one is. The last two lines are the question. An input that is held is one constant for all clocks. The same
/// design gives the same text.
///
/// # Errors
/// The design has a memory.
pub fn smt2(design: &Design, checking: &Checking<'_>, depth: u64) -> Result<String, HasMemories> {
    smt2_asking(design, checking, depth, |violated, _| format!("(assert {violated})\n(check-sat)\n"))
}

/// As [`smt2`], with another question in its place: `ask` gets the term for a violated property, and a function that
/// gives the name of a net at a clock, or of one that is held (no clock).
///
/// # Errors
/// The design has a memory.
pub fn smt2_asking(
    design: &Design,
    checking: &Checking<'_>,
    depth: u64,
    ask: impl FnOnce(&str, &dyn Fn(Net, Option<u64>) -> String) -> String,
) -> Result<String, HasMemories> {
    design.without_memories("solvers")?;
    let script = Script::new(design, checking);
    let mut text = comment(checking.comment, "; ");
    _ = writeln!(
        text,
        "; sat: a property is violated in one of the clocks 0 to {depth}. PATH@CLOCK is a net at a clock."
    );
    text += "(set-option :produce-models true)\n(set-logic QF_BV)\n";
    if !checking.held.is_empty() {
        text += "\n; The same in every clock; what is known of them may be asserted after these lines.\n";
    }
    for &net in checking.held {
        _ = writeln!(text, "(declare-const {} {})", script.name(net), sort(script.netlist.width(net)));
    }
    text += &script.functions();
    for clock in 0..=depth {
        text += &script.clock(clock);
    }
    let violated = (0..=depth).map(|clock| call("violated", script.flags.iter().map(|&net| script.at(net, clock))));
    let violated = joined("or", "false", violated.collect());
    let name = |net: Net, clock: Option<u64>| clock.map_or_else(|| script.name(net), |clock| script.at(net, clock));
    Ok(text + "\n; The question.\n" + &ask(&violated, &name))
}

/// Writing to a string cannot fail, so results of `writeln!` are dropped.
struct Script<'a> {
    netlist: &'a Netlist,
    symbols: Symbols,
    registers: &'a [Net],
    /// All nets that have a value at each clock: inputs that are not held, registers, named constants, and cells in the
    /// order of the design.
    nets: Vec<Net>,
    /// Nets that registers take.
    nexts: Vec<Net>,
    /// Nets that must never be 1.
    flags: Vec<Net>,
}

fn sort(width: Width) -> String {
    format!("(_ BitVec {})", width.get())
}

fn literal(width: Width, value: u64) -> String {
    format!("#b{}", Bits::truncated(width, value))
}

fn equation(left: &str, right: &str) -> String {
    format!("(= {left} {right})")
}

/// A function applied to arguments, or itself if there are none.
fn call(function: &str, arguments: impl Iterator<Item = String>) -> String {
    let words: Vec<String> = std::iter::once(function.to_owned()).chain(arguments).collect();
    if words.len() == 1 { words.concat() } else { format!("({})", words.join(" ")) }
}

/// Truth values joined by an operator; `none` if there are none.
fn joined(operator: &str, none: &str, values: Vec<String>) -> String {
    match &values[..] {
        [] => none.to_owned(),
        [value] => value.clone(),
        _ => format!("({operator} {})", values.join(" ")),
    }
}

impl<'a> Script<'a> {
    fn new(design: &'a Design, checking: &Checking<'a>) -> Script<'a> {
        let netlist = design.netlist();
        let symbols = Symbols::new(netlist);
        let is_constant = |net: &Net| matches!(netlist.cell(*net).op, Op::Const(_));
        let named = |net: &Net| symbols.nets[net.index()].is_some();
        let held = |net: &Net| checking.held.contains(net);
        let mut nets: Vec<Net> = leaves(netlist).filter(|net| !held(net)).collect();
        nets.extend(netlist.nets().filter(|net| is_constant(net) && named(net)));
        nets.extend(design.order());
        let next = |&register: &Net| match netlist.cell(register).op {
            Op::Register { next, .. } => next,
            _ => None,
        };
        let varies = |net: &Net| !held(net) && (named(net) || !is_constant(net));
        let nexts: BTreeSet<Net> = design.registers().iter().filter_map(next).filter(varies).collect();
        let claimed = netlist.properties.iter().filter(|property| property.claim.is_goal());
        let flags: BTreeSet<Net> = claimed.map(|property| property.never).filter(varies).collect();
        let (nexts, flags) = (nexts.into_iter().collect(), flags.into_iter().collect());
        Script { netlist, symbols, registers: design.registers(), nets, nexts, flags }
    }

    /// The name of a net without its clock.
    fn name(&self, net: Net) -> String {
        self.symbols.nets[net.index()].clone().unwrap_or_else(|| format!("n{}", net.index()))
    }

    fn at(&self, net: Net, clock: u64) -> String {
        format!("{}@{clock}", self.name(net))
    }

    /// A net as an operand inside a function.
    fn read(&self, net: Net) -> String {
        match (self.netlist.cell(net).op, &self.symbols.nets[net.index()]) {
            (Op::Const(value), None) => literal(self.netlist.width(net), value),
            _ => self.name(net),
        }
    }

    fn write(&self, term: &Term) -> String {
        let (word, operands, numbers) = match term {
            Term::Net(net) => return self.read(*net),
            Term::Zero(bits) => return format!("(_ bv0 {bits})"),
            Term::Apply(word, _, operands, numbers) => (word, operands, numbers),
        };
        // A number before operands, whose names may hold anything but these marks.
        let mut text = word.smt2.to_owned();
        for (index, number) in numbers.iter().enumerate() {
            text = text.replace(&format!("#{index}"), &number.to_string());
        }
        let mut parts = text.split('$');
        let mut text = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let (index, rest) = part.split_at(1);
            let operand = index.parse().ok().and_then(|index: usize| operands.get(index));
            text += &operand.map(|operand| self.write(operand)).unwrap_or_default();
            text += rest;
        }
        text
    }

    fn functions(&self) -> String {
        let parameter = |&net: &Net| format!("({} {})", self.name(net), sort(self.netlist.width(net)));
        let reset = self.registers.iter().filter_map(|&net| match self.netlist.cell(net).op {
            Op::Register { reset, .. } => Some(equation(&self.name(net), &literal(self.netlist.width(net), reset))),
            _ => None,
        });
        let settled = self.nets.iter().filter_map(|&net| match (self.netlist.cell(net).op, term(self.netlist, net)) {
            (Op::Const(value), _) => Some(equation(&self.name(net), &literal(self.netlist.width(net), value))),
            (_, Term::Net(_)) => None,
            (_, term) => Some(equation(&self.name(net), &self.write(&term))),
        });
        let taken = self.registers.iter().filter_map(|&net| match self.netlist.cell(net).op {
            Op::Register { next: Some(next), .. } => Some(equation(&format!("{}+", self.name(net)), &self.read(next))),
            _ => None,
        });
        let next = |&net: &Net| format!("({}+ {})", self.name(net), sort(self.netlist.width(net)));
        let mut text = String::new();
        let mut function = |name: &str, about: &str, parameters: Vec<String>, value: String| {
            let parameters = parameters.join("\n    ");
            _ = writeln!(text, "\n; {about}\n(define-fun {name} (\n    {parameters}\n  ) Bool\n  {value})");
        };
        let all = |list: Vec<String>| match &list[..] {
            [_, _, ..] => format!("(and\n    {})", list.join("\n    ")),
            _ => joined("and", "true", list),
        };
        function(
            "init",
            "Registers before the first edge.",
            self.registers.iter().map(parameter).collect(),
            all(reset.collect()),
        );
        function("settled", "Between two edges.", self.nets.iter().map(parameter).collect(), all(settled.collect()));
        let edge = self.nexts.iter().map(parameter).chain(self.registers.iter().map(next)).collect();
        function("edge", "At an edge.", edge, all(taken.collect()));
        function("violated", "A property is violated.", self.flags.iter().map(parameter).collect(), self.violated());
        text
    }

    /// One of the properties is violated. A comment after each says what it is about, up to the end of the line.
    fn violated(&self) -> String {
        let properties = self.netlist.properties.iter().zip(&self.symbols.properties);
        let properties = properties.filter(|(property, _)| property.claim.is_goal());
        let lines = properties.map(|(property, name)| format!("(= {} #b1) ; {name}", self.read(property.never)));
        match &lines.collect::<Vec<_>>()[..] {
            [] => "false".to_owned(),
            [only] => format!("{only}\n  "),
            lines => format!("(or\n    {}\n  )", lines.join("\n    ")),
        }
    }

    /// The constants of a clock, and what holds of them.
    fn clock(&self, clock: u64) -> String {
        let mut text = format!("\n; Clock {clock}.\n");
        for &net in &self.nets {
            _ = writeln!(text, "(declare-const {} {})", self.at(net, clock), sort(self.netlist.width(net)));
        }
        let at = |nets: &[Net], clock: u64| nets.iter().map(|&net| self.at(net, clock)).collect::<Vec<_>>();
        let entered = match clock.checked_sub(1) {
            None => call("init", at(self.registers, 0).into_iter()),
            Some(last) => call("edge", at(&self.nexts, last).into_iter().chain(at(self.registers, clock))),
        };
        let settled = call("settled", at(&self.nets, clock).into_iter());
        _ = writeln!(text, "(assert {entered})\n(assert {settled})");
        for property in self.netlist.properties.iter().filter(|property| property.claim == Claim::Assumption) {
            // A constant without a name has no name of its own in a clock.
            if self.nets.contains(&property.never) {
                _ = writeln!(text, "(assert (= {} #b0))", self.at(property.never, clock));
            } else if self.netlist.cell(property.never).op == Op::Const(1) {
                text += "(assert false)\n";
            }
        }
        text
    }
}
