//! The text form of a netlist, for tests and for people: one cell a line, printed and parsed without loss (lines
//! of Rust source excepted).
//!
//! ```text
//! netlist counter
//! scope 1 in 0 "x"
//! %0:1 = input
//! %1:4 = register reset 0x0 next %3
//! %2:4 = const 0x1
//! %3:4 = add %1 %2
//! %4:1 = carry %1 %2 at "counter.v" 12 5
//! name %1 in 1 "count" unsigned
//! property "counter.x.count" never %4 add %1 unsigned %2 unsigned
//! between-steps "counter.x.even" count - 2 | -count
//! ```
//!
//! `at` gives file, line and column of a cell's source. `name` ends in the format: `unsigned`, `signed`, `analog`,
//! `binary`, `decimal` or `states 0x1 "JUDGE" 0x2 "FEED"`, after the word `output` where it is an output port.
//! `memory 0 in 1 "ram" width 8 words 16` comes before the cells `read 0 %4`, followed by `initial 0 0x12 0x0*15`, its
//! first words, and `write 0 enable %1 address %2 data %3 mask %4`, its ports; a mask may be missing. `property`
//! ends in `invariant`, `assumption` or `cover`, in the strict operation with its operands, or in `fits`, the bits that are kept of a result, their
//! reading, the operation with its operands, and `wraps` where a carry is meant to be lost; or in `quotient %1 signed`,
//! `remainder`, a division by 0 and its dividend, `read %3 unsigned words 10 from 0` or `write`, an address outside of a
//! memory; `between-steps` in formulas with `|` between them. The nets of a word of more than 64 bits follow each other, the lowest first: `name %7 %8 in 0
//! "acc" signed`.
//! Text in quotes is escaped as in Rust.

mod memory;
mod words;

use std::fmt::{self, Write as _};
use std::sync::Arc;

use crate::bits::Width;
use crate::cells::{
    Arithmetic, Cell, Claim, Format, NamedNet, Net, Netlist, Op, Property, ScopeData, ScopeId, Source, Word,
};
use crate::diag::{Code, Diagnostic, Diagnostics, Place};
use crate::formula::{Clause, Formula};
use words::{Words, digits};

/// Makes a two-operand operator.
type Make = fn(Net, Net) -> Op;

/// Two-operand operators and their words.
const BINARY: [(&str, Make); 17] = [
    ("and", Op::And),
    ("or", Op::Or),
    ("xor", Op::Xor),
    ("add", Op::Add),
    ("sub", Op::Sub),
    ("mul", Op::Mul),
    ("div", Op::Div),
    ("rem", Op::Rem),
    ("shift-left", Op::ShiftLeft),
    ("shift-right", Op::ShiftRight),
    ("shift-arithmetic", Op::ShiftArithmetic),
    ("carry", Op::Carry),
    ("borrow", Op::Borrow),
    ("add-overflow", Op::AddOverflow),
    ("sub-overflow", Op::SubOverflow),
    ("equal", Op::Equal),
    ("less-signed", Op::LessSigned),
];

impl fmt::Display for Net {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "%{}", self.0)
    }
}

impl fmt::Display for Op {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Op::Input => f.write_str("input"),
            Op::Const(value) => write!(f, "const {value:#x}"),
            Op::Register { next: Some(next), reset } => write!(f, "register reset {reset:#x} next {next}"),
            Op::Register { next: None, reset } => write!(f, "register reset {reset:#x}"),
            Op::Not(a) => write!(f, "not {a}"),
            Op::Mux { select, high, low } => write!(f, "mux {select} {high} {low}"),
            Op::Slice { of, low } => write!(f, "slice {of} {low}"),
            Op::Concat { high, low } => write!(f, "concat {high} {low}"),
            Op::ZeroExtend(a) => write!(f, "zero-extend {a}"),
            Op::SignExtend(a) => write!(f, "sign-extend {a}"),
            Op::Read { memory, address } => write!(f, "read {memory} {address}"),
            binary => {
                let mut operands = Vec::with_capacity(2);
                binary.visit_inputs(|net| operands.push(net));
                let [a, b] = operands[..] else { return Err(fmt::Error) };
                let (word, _) = BINARY.iter().find(|(_, make)| make(a, b) == binary).ok_or(fmt::Error)?;
                write!(f, "{word} {a} {b}")
            }
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Format::Unsigned => f.write_str("unsigned"),
            Format::Signed => f.write_str("signed"),
            Format::Analog => f.write_str("analog"),
            Format::Level => f.write_str("level"),
            Format::Binary => f.write_str("binary"),
            Format::Decimal => f.write_str("decimal"),
            Format::States(states) => {
                f.write_str("states")?;
                states.iter().try_for_each(|(value, name)| write!(f, " {value:#x} {name:?}"))
            }
        }
    }
}

/// Nets, each after a blank.
fn list(nets: impl Iterator<Item = Net>) -> String {
    nets.map(|net| format!(" {net}")).collect()
}

/// The nets of a word and its reading, after a blank.
fn operand(word: &Word) -> String {
    list(word.nets.iter().copied()) + " " + reading(word.signed)
}

fn reading(signed: bool) -> &'static str {
    if signed { "signed" } else { "unsigned" }
}

impl fmt::Display for Netlist {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, scope) in self.scopes.iter().enumerate() {
            match scope.parent {
                None => writeln!(f, "netlist {}", scope.name)?,
                Some(parent) => writeln!(f, "scope {index} in {} {:?}", parent.0, scope.name)?,
            }
        }
        for (index, memory) in self.memories.iter().enumerate() {
            memory::print(index, memory, f)?;
        }
        for (net, cell) in self.nets().zip(&self.cells) {
            write!(f, "{net}:{} = {}", cell.width.get(), cell.op)?;
            if let Some(Some(Source::File { file, line, column })) = self.sources.get(net.index()) {
                write!(f, " at {file:?} {line} {column}")?;
            }
            writeln!(f)?;
        }
        for named in &self.names {
            let output = if named.output { "output " } else { "" };
            writeln!(f, "name{} in {} {:?} {output}{}", list(named.nets()), named.scope.0, named.name, named.format)?;
        }
        for property in &self.properties {
            write!(f, "property {:?} never {}", property.name, property.never)?;
            match &property.claim {
                Claim::Invariant => writeln!(f, " invariant")?,
                Claim::Assumption => writeln!(f, " assumption")?,
                Claim::Cover => writeln!(f, " cover")?,
                Claim::Print { message, numbers, once } => {
                    write!(f, " print {}{:?}", if *once { "once " } else { "" }, message.to_string())?;
                    numbers.iter().try_for_each(|word| f.write_str(&self::operand(word)))?;
                    writeln!(f)?;
                }
                Claim::Fits { operator, left, right, bits, signed, wraps } => {
                    let (left, right, own) = (operand(left), operand(right), reading(*signed));
                    let wraps = if *wraps { " wraps" } else { "" };
                    writeln!(f, " fits {bits} {own} {}{left}{right}{wraps}", operator.name())?;
                }
                Claim::Defined { undefined, operand } => {
                    write!(f, " {}{}", undefined.name(), self::operand(operand))?;
                    match undefined.memory() {
                        Some((first, words)) => writeln!(f, " words {words} from {first}")?,
                        None => writeln!(f)?,
                    }
                }
                Claim::NoOverflow { operation, left, right } => {
                    let word = match operation {
                        Arithmetic::Add => "add",
                        Arithmetic::Sub => "sub",
                    };
                    let (l, r) = (reading(left.signed), reading(right.signed));
                    writeln!(f, " {word} {} {l} {} {r}", left.net, right.net)?;
                }
            }
        }
        for Clause { name, any } in &self.invariants {
            let any: Vec<String> = any.iter().map(Formula::to_string).collect();
            writeln!(f, "between-steps {name:?} {}", any.join(" | "))?;
        }
        Ok(())
    }
}

/// Reads the text form. Only the form is checked here; [`elaborate`](crate::elaborate) checks the netlist.
///
/// # Errors
/// Every line that cannot be read, once.
pub fn parse(text: &str) -> Result<Netlist, Diagnostics> {
    let mut parser =
        Parser { netlist: Netlist::new(""), named: false, next_net: Some(0), next_scope: Some(1), file: "".into() };
    let mut diagnostics = Vec::new();
    let mut report = |line: usize, message: String| {
        diagnostics.push(Diagnostic { code: Code::Syntax, place: Place::Line(line), message });
    };
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).peekable();
    match lines.peek() {
        None => report(1, "expected 'netlist NAME' in the first line".to_owned()),
        Some((index, line)) if line.split_whitespace().next() != Some("netlist") => {
            report(index + 1, format!("expected 'netlist NAME' first in '{line}'"));
            // Any other mistake has been reported.
            let (_, line) = lines.next().unwrap_or_default();
            _ = parser.line(line);
        }
        Some(_) => {}
    }
    for (index, line) in lines {
        if let Err(expected) = parser.line(line) {
            report(index + 1, format!("expected {expected} in '{line}'"));
        }
    }
    if diagnostics.is_empty() { Ok(parser.netlist) } else { Err(Diagnostics(diagnostics)) }
}

/// What was expected but not found.
type Expected = String;

/// What has been read. After a line whose number is wrong or cannot be read the next number is not known: the number
/// given is accepted, so that only this line is reported.
struct Parser {
    netlist: Netlist,
    /// The line `netlist` was there.
    named: bool,
    /// The number that the next net must have, if it is known.
    next_net: Option<u32>,
    /// The number that the next scope must have, if it is known.
    next_scope: Option<u32>,
    /// The file named last, so that it is kept once.
    file: Arc<str>,
}

impl Parser {
    fn line(&mut self, line: &str) -> Result<(), Expected> {
        let mut words = Words { rest: line.trim() };
        if words.rest.starts_with('%') { self.cell(&mut words) } else { self.other(&mut words) }
    }

    fn other(&mut self, words: &mut Words<'_>) -> Result<(), Expected> {
        match words.word()? {
            "netlist" if !self.named => {
                self.named = true;
                words.word()?.clone_into(&mut self.netlist.scopes[0].name);
            }
            "scope" => {
                let next = self.next_scope.take();
                let index: u32 = words.number()?;
                let next = next.unwrap_or(index);
                if index != next {
                    return Err(format!("scope {next} in an earlier one"));
                }
                self.next_scope = index.checked_add(1);
                words.keyword("in")?;
                let parent: u32 = words.number()?;
                if parent >= index {
                    return Err(format!("scope {next} in an earlier one"));
                }
                self.netlist.scopes.push(ScopeData { parent: Some(ScopeId(parent)), name: words.quoted()? });
            }
            "memory" => self.memory(words)?,
            "initial" => self.initial(words)?,
            "write" => self.write(words)?,
            "name" => {
                let (net, above) = (words.net()?, words.further_nets()?);
                words.keyword("in")?;
                let scope = ScopeId(words.number()?);
                let name = words.quoted()?;
                let output = words.optional("output");
                let format = words.format()?;
                self.netlist.names.push(NamedNet { net, above, scope, name, format, output });
            }
            "property" => {
                let name = words.quoted()?;
                words.keyword("never")?;
                let never = words.net()?;
                let claim = match words.word()? {
                    "invariant" => Claim::Invariant,
                    "assumption" => Claim::Assumption,
                    "cover" => Claim::Cover,
                    "print" => words.print()?,
                    "fits" => words.fits()?,
                    "add" => words.strict(Arithmetic::Add)?,
                    "sub" => words.strict(Arithmetic::Sub)?,
                    word => words.defined(word)?,
                };
                self.netlist.properties.push(Property { name, never, claim });
            }
            "between-steps" => {
                let name = words.quoted()?;
                let any = std::mem::take(&mut words.rest).split('|').map(Formula::parse);
                let any = any.collect::<Option<_>>().ok_or("formulas such as 'f + 2*a - 1', with '|' between them")?;
                self.netlist.invariants.push(Clause { name, any });
            }
            _ => {
                // It may have been meant for a cell or a scope.
                (self.next_net, self.next_scope) = (None, None);
                return Err(
                    "a cell, 'netlist' (once, first), 'scope', 'memory', 'initial', 'write', 'name', 'property' or 'between-steps'"
                        .to_owned()
                );
            }
        }
        words.end()
    }

    fn cell(&mut self, words: &mut Words<'_>) -> Result<(), Expected> {
        let next = self.next_net.take();
        let (head, rest) = words.rest.split_once('=').ok_or("'='")?;
        let (net, bits) = head.trim().split_once(':').ok_or("':' and a width")?;
        let net = Words { rest: net }.net()?;
        if let Some(next) = next.filter(|next| *next != net.0) {
            return Err(format!("the next net, %{next}"));
        }
        self.next_net = net.0.checked_add(1);
        let bits = digits(bits, 10).ok_or("a width")?;
        let width = Width::new(bits).map_err(|error| format!("a width of 1 to 64 bits ({error})"))?;
        words.rest = rest.trim_start();
        let op = words.op()?;
        self.netlist.cells.push(Cell { op, width });
        let source = if words.rest.is_empty() { None } else { Some(self.source(words)?) };
        self.netlist.sources.push(source);
        words.end()
    }
}

impl Parser {
    /// The source of a cell, at the end of its line.
    fn source(&mut self, words: &mut Words<'_>) -> Result<Source, Expected> {
        if words.keyword("at").is_err() {
            return Err("the end of the line, or 'at' and a source".to_owned());
        }
        let file = words.quoted()?;
        if *self.file != *file {
            self.file = file.into();
        }
        Ok(Source::File { file: Arc::clone(&self.file), line: words.number()?, column: words.number()? })
    }
}

/// The text form, as a string.
#[must_use]
pub fn print(netlist: &Netlist) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write!(text, "{netlist}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsl::Module;

    #[test]
    fn a_described_netlist_prints_as_one_line_a_cell() {
        let module = Module::new("counter");
        let m = module.top();
        let x = m.scope("x");
        let enable = m.input("enable", 1);
        let count = x.reg("count", 4).reset(3);
        let next = count.q.strict_add(m.lit(4, 1), enable);
        count.when(enable, next).else_hold();
        let netlist = module.finish().unwrap();
        assert_eq!(
            print(&netlist),
            r#"netlist counter
scope 1 in 0 "x"
%0:1 = input
%1:4 = register reset 0x3 next %7
%2:4 = const 0x1
%3:4 = add %1 %2
%4:1 = const 0x0
%5:1 = carry %1 %2
%6:1 = and %0 %5
%7:4 = mux %0 %3 %1
name %0 in 0 "enable" unsigned
name %1 in 1 "count" unsigned
name %6 in 1 "count_add_overflow" unsigned
property "counter.x.count" never %6 add %1 unsigned %2 unsigned
"#
        );
        assert_eq!(parse(&print(&netlist)).unwrap(), netlist);
    }

    #[test]
    fn a_line_that_cannot_be_read_is_named() {
        for (text, message) in [
            ("", "line 1: expected 'netlist NAME' in the first line [Syntax]"),
            ("netlist m\n%1:1 = input", "line 2: expected the next net, %0 in '%1:1 = input' [Syntax]"),
            (
                "netlist m\n%0:65 = input",
                "line 2: expected a width of 1 to 64 bits (a width of 65 bits is not possible: a register holds 1 to 64 bits) in '%0:65 = input' [Syntax]",
            ),
            ("netlist m\n%0:1 = spin %0", "line 2: expected an operator in '%0:1 = spin %0' [Syntax]"),
            ("netlist m\nname %0 in 0 \"a", "line 2: expected the end of the quotes in 'name %0 in 0 \"a' [Syntax]"),
        ] {
            assert_eq!(parse(text).unwrap_err().to_string(), message);
        }
    }
}
