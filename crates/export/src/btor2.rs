//! BTOR2, the word-level language of hardware model checkers, of any design.
//!
//! A register is a state with its reset value as `init` and its next value as `next`; a property is a `bad`, an assumption a `constraint`. Paths of
//! nets are symbols: of the first name at the line of the net, of further ones at an `output`. Step k of a model
//! checker is sample k of an engine.

use std::collections::HashMap;
use std::fmt::Write as _;

use super::words::{Symbols, Term, leaves, term};
use super::{Checking, comment};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Claim, Net, Netlist, Op};
use stepwave_netlist::{Design, HasMemories};

/// The design as a BTOR2 model. An input that is held is a state without a first value. The same design gives the same
/// text.
///
/// # Errors
/// The design has a memory.
pub fn btor2(design: &Design, checking: &Checking<'_>) -> Result<String, HasMemories> {
    design.without_memories("model checkers")?;
    let netlist = design.netlist();
    let symbols = Symbols::new(netlist);
    let mut model =
        Model { netlist, text: comment(checking.comment, "; "), last: 0, known: HashMap::new(), lines: HashMap::new() };
    let mut held = Vec::new();
    for net in leaves(netlist) {
        let sort = model.sort(netlist.width(net).get());
        let symbol = symbols.nets[net.index()].as_deref();
        let line = match netlist.cell(net).op {
            Op::Register { reset, .. } => {
                let first = model.constant(netlist.width(net), reset, None);
                let state = model.line(&format!("state {sort}"), symbol);
                model.line(&format!("init {sort} {state} {first}"), None);
                state
            }
            _ if checking.held.contains(&net) => {
                held.push(net);
                model.line(&format!("state {sort}"), symbol)
            }
            _ => model.line(&format!("input {sort}"), symbol),
        };
        model.lines.insert(net, line);
    }
    let named = |net: &Net| symbols.nets[net.index()].is_some();
    for net in netlist.nets().filter(named) {
        if let Op::Const(value) = netlist.cell(net).op {
            let line = model.constant(netlist.width(net), value, symbols.nets[net.index()].as_deref());
            model.lines.insert(net, line);
        }
    }
    for &net in design.order() {
        let line = model.term(&term(netlist, net), symbols.nets[net.index()].as_deref());
        model.lines.insert(net, line);
    }
    for (net, path) in &symbols.further {
        let line = model.net(*net);
        model.line(&format!("output {line}"), Some(path));
    }
    let next = |&net: &Net| match netlist.cell(net).op {
        Op::Register { next: Some(next), .. } => Some((net, next)),
        _ => None,
    };
    for (state, next) in design.registers().iter().filter_map(next).chain(held.iter().map(|&net| (net, net))) {
        let sort = model.sort(netlist.width(state).get());
        let (state, next) = (model.net(state), model.net(next));
        model.line(&format!("next {sort} {state} {next}"), None);
    }
    for (property, name) in netlist.properties.iter().zip(&symbols.properties) {
        let never = model.net(property.never);
        match property.claim {
            Claim::Assumption => {
                let (sort, symbol) = (model.sort(1), Some(name.as_str()));
                let holds = model.line(&format!("not {sort} {never}"), None);
                model.line(&format!("constraint {holds}"), symbol);
            }
            ref claim if claim.is_goal() => _ = model.line(&format!("bad {never}"), Some(name)),
            _ => {}
        }
    }
    Ok(model.text)
}

/// Writing to a string cannot fail, so results of `writeln!` are dropped.
struct Model<'a> {
    netlist: &'a Netlist,
    text: String,
    /// Number of the last line.
    last: u64,
    /// Lines that several others share, by their text.
    known: HashMap<String, u64>,
    /// Of each net so far.
    lines: HashMap<Net, u64>,
}

impl Model<'_> {
    /// A line of its own.
    fn line(&mut self, words: &str, symbol: Option<&str>) -> u64 {
        self.last += 1;
        let symbol = symbol.map(|symbol| format!(" {symbol}")).unwrap_or_default();
        _ = writeln!(self.text, "{} {words}{symbol}", self.last);
        self.last
    }

    /// A line that may have been written already; one with a symbol is written in any case.
    fn shared(&mut self, words: String, symbol: Option<&str>) -> u64 {
        if let (None, Some(&line)) = (symbol, self.known.get(&words)) {
            return line;
        }
        let line = self.line(&words, symbol);
        self.known.insert(words, line);
        line
    }

    fn sort(&mut self, bits: u32) -> u64 {
        self.shared(format!("sort bitvec {bits}"), None)
    }

    fn constant(&mut self, width: Width, value: u64, symbol: Option<&str>) -> u64 {
        let sort = self.sort(width.get());
        self.shared(format!("constd {sort} {value}"), symbol)
    }

    /// The line of a net; unnamed constants are written where they are needed first.
    fn net(&mut self, net: Net) -> u64 {
        match (self.lines.get(&net), self.netlist.cell(net).op) {
            (Some(&line), _) => line,
            (None, Op::Const(value)) => self.constant(self.netlist.width(net), value, None),
            // None: everything that is read is live, and comes in the order of the design.
            (None, _) => 0,
        }
    }

    fn term(&mut self, term: &Term, symbol: Option<&str>) -> u64 {
        let (word, bits, operands, numbers) = match term {
            Term::Net(net) => return self.net(*net),
            Term::Zero(bits) => {
                let sort = self.sort(*bits);
                return self.shared(format!("constd {sort} 0"), None);
            }
            Term::Apply(word, bits, operands, numbers) => (word, *bits, operands, numbers),
        };
        let operands: Vec<u64> = operands.iter().map(|operand| self.term(operand, None)).collect();
        let mut words = format!("{} {}", word.btor2, self.sort(bits));
        let numbers = numbers.iter().map(|&number| u64::from(number));
        for number in operands.into_iter().chain(numbers) {
            _ = write!(words, " {number}");
        }
        self.shared(words, symbol)
    }
}
