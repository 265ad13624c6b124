//! The hardware description language: the only writer of netlists.
//!
//! A [`Module`] is the builder; a [`Scope`] is an instance in its hierarchy; a [`Signal`] is a net with a reading
//! (unsigned or two's complement); a [`Register`] is closed by a chain of `when`s. A plain function that takes a scope
//! and signals is a part. There is no `+`: arithmetic has the names of Rust's integer methods, so that the reader
//! sees where the carry goes.
//!
//! Mistakes (unequal widths, a register without next value, a name used twice) never panic; they are collected and
//! come out of [`Module::finish`], each with the source line that made it. What only follows from a mistake is not
//! reported: a cell that breaks a rule is replaced by a constant of the width asked for; where that width is the
//! mistake, the constant is a *guess*, and what is made from a guess is one too, without a further diagnostic.

mod memory;
mod register;
mod signal;
mod strict;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use std::cell::RefCell;

use crate::bits::{Bits, Width};
use crate::cells::{Cell, Claim, Format, NamedNet, Net, Netlist, OnOverflow, Op, Property, ScopeData, ScopeId, Source};
use crate::diag::{Code, Diagnostic, Diagnostics, Place};
use crate::formula::{Clause, Formula};

pub use memory::Memory;
pub use register::{Chain, Register};
pub use signal::Signal;

/// A netlist under construction.
#[derive(Debug)]
pub struct Module {
    state: RefCell<Draft>,
    on_overflow: OnOverflow,
}

#[derive(Debug)]
struct Draft {
    netlist: Netlist,
    diagnostics: Vec<Diagnostic>,
    /// Where each name was given first.
    used_names: HashMap<(ScopeId, String), Place>,
    /// Where each register got its next value.
    driven: HashMap<Net, Place>,
    /// Nets whose width means nothing, because of a mistake that has been reported.
    guesses: HashSet<Net>,
}

impl Module {
    /// An empty module; its strict cells trap.
    #[track_caller]
    #[must_use]
    pub fn new(name: &str) -> Module {
        Module::with_overflow(name, OnOverflow::Trap)
    }

    /// An empty module whose strict cells do as `on_overflow` says when their exact result does not fit.
    #[track_caller]
    #[must_use]
    pub fn with_overflow(name: &str, on_overflow: OnOverflow) -> Module {
        let state = Draft {
            netlist: Netlist::new(name),
            diagnostics: Vec::new(),
            used_names: HashMap::default(),
            driven: HashMap::default(),
            guesses: HashSet::default(),
        };
        let module = Module { state: RefCell::new(state), on_overflow };
        module.check_name(name);
        module
    }

    /// A module that continues a finished netlist: its nets keep their numbers, and [`Scope::net`] makes
    /// signals of them. What is added is measured or shown; the netlist itself stays as it is. Its strict cells trap.
    #[must_use]
    pub fn continuing(netlist: Netlist) -> Module {
        let place = |net| place_of(&netlist, net);
        let nets = netlist.names.iter().map(|named| ((named.scope, named.name.clone()), place(named.net)));
        let scopes = netlist.scopes.iter().filter_map(|scope| {
            let place = Place::Component(scope.name.clone());
            Some(((scope.parent?, scope.name.clone()), place))
        });
        let used_names = nets.chain(scopes).collect();
        let (diagnostics, driven, guesses) = (Vec::new(), HashMap::default(), HashSet::default());
        let state = Draft { used_names, netlist, diagnostics, driven, guesses };
        Module { state: RefCell::new(state), on_overflow: OnOverflow::Trap }
    }

    /// The top scope.
    #[must_use]
    pub fn top(&self) -> Scope<'_> {
        Scope { module: self, id: ScopeId::TOP }
    }

    /// The finished netlist.
    ///
    /// # Errors
    /// All mistakes made while it was described.
    pub fn finish(self) -> Result<Netlist, Diagnostics> {
        let Draft { netlist, mut diagnostics, .. } = self.state.into_inner();
        for (net, cell) in netlist.nets().zip(&netlist.cells) {
            if matches!(cell.op, Op::Register { next: None, .. }) {
                let message = format!("register {} never gets a next value", netlist.describe(net));
                let place = place_of(&netlist, net);
                diagnostics.push(Diagnostic { code: Code::UndrivenRegister, place, message });
            }
        }
        if diagnostics.is_empty() { Ok(netlist) } else { Err(Diagnostics(diagnostics)) }
    }

    /// Appends a cell. A width that is not possible becomes a diagnostic and a guess, another broken rule a diagnostic
    /// and a constant 0 of the width asked for.
    #[track_caller]
    fn push(&self, op: Op, bits: u32) -> Net {
        let mut guessed = false;
        op.visit_inputs(|input| guessed |= self.is_guess(input));
        if guessed {
            return self.guess();
        }
        let width = match Width::new(u64::from(bits)) {
            Ok(width) => width,
            Err(error) => {
                self.report(Code::BadWidth, error.to_string());
                return self.guess();
            }
        };
        let mut cell = Cell { op, width };
        let checked = self.state.borrow().netlist.check_cell(&cell);
        if let Err((code, message)) = checked {
            self.report(code, message);
            cell.op = Op::Const(0);
        }
        self.append(cell)
    }

    #[track_caller]
    fn append(&self, cell: Cell) -> Net {
        let netlist = &mut self.state.borrow_mut().netlist;
        // More than 2^32 cells do not fit in memory.
        let net = Net(u32::try_from(netlist.cells.len()).unwrap_or(u32::MAX));
        netlist.cells.push(cell);
        netlist.sources.push(Some(Source::here()));
        net
    }

    /// A net in the place of one that cannot be.
    #[track_caller]
    fn guess(&self) -> Net {
        let net = self.append(Cell { op: Op::Const(0), width: Width::ONE });
        self.state.borrow_mut().guesses.insert(net);
        net
    }

    fn is_guess(&self, net: Net) -> bool {
        self.state.borrow().guesses.contains(&net)
    }

    #[track_caller]
    fn report(&self, code: Code, message: String) {
        let place = Place::Source(Source::here());
        self.state.borrow_mut().diagnostics.push(Diagnostic { code, place, message });
    }

    #[track_caller]
    fn check_name(&self, name: &str) {
        if !is_identifier(name) {
            let message = format!("invalid name '{name}': letters, digits and _ only, not beginning with a digit");
            self.report(Code::BadName, message);
        }
    }
}

fn place_of(netlist: &Netlist, net: Net) -> Place {
    match netlist.sources.get(net.index()) {
        Some(Some(source)) => Place::Source(source.clone()),
        _ => Place::Component(netlist.describe(net)),
    }
}

/// An instance in the hierarchy: the scope of a part's registers and named nets.
#[derive(Clone, Copy, Debug)]
pub struct Scope<'m> {
    module: &'m Module,
    id: ScopeId,
}

impl<'m> Scope<'m> {
    /// A scope inside this one.
    #[track_caller]
    #[must_use]
    pub fn scope(self, name: &str) -> Scope<'m> {
        self.claim_name(name);
        let scopes = &mut self.module.state.borrow_mut().netlist.scopes;
        let id = ScopeId(u32::try_from(scopes.len()).unwrap_or(u32::MAX));
        scopes.push(ScopeData { parent: Some(self.id), name: name.to_owned() });
        Scope { module: self.module, id }
    }

    /// A net that the module has already, in two's complement if `signed`; one that it has not is a mistake.
    #[track_caller]
    #[must_use]
    pub fn net(self, net: Net, signed: bool) -> Signal<'m> {
        if net.index() < self.module.state.borrow().netlist.cells.len() {
            return Signal::new(self, net, signed);
        }
        self.module.report(Code::ForeignSignal, format!("there is no net {}", net.index()));
        Signal::new(self, self.module.guess(), signed)
    }

    /// An unsigned input.
    #[track_caller]
    #[must_use]
    pub fn input(self, name: &str, bits: u32) -> Signal<'m> {
        self.name(name, self.of_width(name, Op::Input, bits, false))
    }

    /// A two's-complement input.
    #[track_caller]
    #[must_use]
    pub fn input_signed(self, name: &str, bits: u32) -> Signal<'m> {
        self.name(name, self.of_width(name, Op::Input, bits, true))
    }

    /// An input of decimal digits, 4 bits each.
    #[track_caller]
    #[must_use]
    pub fn input_decimal(self, name: &str, bits: u32) -> Signal<'m> {
        self.show(name, self.of_width(name, Op::Input, bits, false), Format::Decimal)
    }

    /// An unsigned register, 0 at reset.
    #[track_caller]
    pub fn reg(self, name: &str, bits: u32) -> Register<'m> {
        self.register(name, bits, false)
    }

    /// A two's-complement register, 0 at reset.
    #[track_caller]
    pub fn reg_signed(self, name: &str, bits: u32) -> Register<'m> {
        self.register(name, bits, true)
    }

    #[track_caller]
    fn register(self, name: &str, bits: u32, signed: bool) -> Register<'m> {
        let op = Op::Register { next: None, reset: 0 };
        let q = self.of_width(name, op, bits, signed);
        self.name(name, q);
        Register { q }
    }

    /// An unsigned register of any number of bits, 0 at reset: the lowest 64 bits first, of one name.
    #[track_caller]
    pub fn wide_reg(self, name: &str, bits: u32) -> Vec<Register<'m>> {
        if bits <= NamedNet::PART {
            return vec![self.reg(name, bits)];
        }
        let parts = (0..bits).step_by(NamedNet::PART as usize).map(|low| (bits - low).min(NamedNet::PART));
        let op = || Op::Register { next: None, reset: 0 };
        let parts: Vec<_> = parts.map(|bits| Register { q: self.of_width(name, op(), bits, false) }).collect();
        self.claim_name(name);
        let above = parts[1..].iter().map(|part| part.q.net()).collect();
        let format = Format::Unsigned;
        let named = NamedNet { above, ..NamedNet::new(parts[0].q.net(), self.id, name, format) };
        self.module.state.borrow_mut().netlist.names.push(named);
        parts
    }

    /// An unsigned constant.
    #[track_caller]
    #[must_use]
    pub fn lit(self, bits: u32, value: u64) -> Signal<'m> {
        self.new_signal(Op::Const(value), bits, false)
    }

    /// A two's-complement constant.
    #[track_caller]
    #[must_use]
    pub fn lit_signed(self, bits: u32, value: i64) -> Signal<'m> {
        // The diagnostic of the cell says that there is no such width.
        let width = Width::new(u64::from(bits)).unwrap_or(Width::MAX);
        let constant = Bits::exact(width, i128::from(value), true);
        if constant.is_none() {
            self.module.report(Code::ValueTooWide, format!("the value {value} does not fit in {width}"));
        }
        self.new_signal(Op::Const(constant.map_or(0, Bits::value)), bits, true)
    }

    /// Gives a net a name in this scope, shown as its reading says; returns it.
    #[track_caller]
    pub fn name(self, name: &str, signal: Signal<'m>) -> Signal<'m> {
        let format = if signal.is_signed() { Format::Signed } else { Format::Unsigned };
        self.show(name, signal, format)
    }

    /// Gives a net a name in this scope, shown in the given format; returns it.
    #[track_caller]
    pub fn show(self, name: &str, signal: Signal<'m>, format: Format) -> Signal<'m> {
        self.claim_name(name);
        let signal = self.own(signal);
        let named = NamedNet::new(signal.net(), self.id, name, format);
        self.module.state.borrow_mut().netlist.names.push(named);
        signal
    }

    /// Claims that a net is 1 at every clock: the simulator watches it, a prover proves it.
    #[track_caller]
    pub fn invariant(self, name: &str, holds: Signal<'m>) {
        let never = !self.own(holds);
        let name = format!("{}.{name}", self.module.state.borrow().netlist.scope_path(self.id));
        self.add_property(Property { name, never: never.net(), claim: Claim::Invariant });
    }

    /// Claims that one of the formulas, of leaf names of this module, is 0 or more between two steps of a block. No
    /// hardware comes of it: tests check it in recorded runs, and a prover uses it once it has proved it.
    pub fn between_steps(self, name: &str, any: impl IntoIterator<Item = Formula>) {
        let name = format!("{}.{name}", self.module.state.borrow().netlist.scope_path(self.id));
        self.module.state.borrow_mut().netlist.invariants.push(Clause::either(&name, any));
    }

    #[track_caller]
    fn add_property(self, property: Property) {
        let width = self.module.state.borrow().netlist.width(property.never);
        if self.module.is_guess(property.never) {
            // Its mistake has been reported.
        } else if width == Width::ONE {
            self.module.state.borrow_mut().netlist.properties.push(property);
        } else {
            self.module.report(Code::NotOneBit, format!("a property is 1 bit wide, not {width}"));
        }
    }

    #[track_caller]
    fn new_signal(self, op: Op, bits: u32, signed: bool) -> Signal<'m> {
        Signal::new(self, self.module.push(op, bits), signed)
    }

    /// A signal that is declared with a name and a width: where no register can have it, the diagnostic has the name.
    #[track_caller]
    fn of_width(self, name: &str, op: Op, bits: u32, signed: bool) -> Signal<'m> {
        match Width::new(u64::from(bits)) {
            Ok(_) => self.new_signal(op, bits, signed),
            Err(error) => {
                self.module.report(Code::BadWidth, format!("{name}: {error}"));
                Signal::new(self, self.module.guess(), signed)
            }
        }
    }

    /// The signal, if it is of this module; else a diagnostic and a guess. Every signal that comes from outside goes
    /// through this: the nets of modules are numbered alike.
    #[track_caller]
    fn own(self, signal: Signal<'m>) -> Signal<'m> {
        if std::ptr::eq(self.module, signal.scope().module) {
            return signal;
        }
        let foreign = signal.scope().module.state.borrow().netlist.describe(signal.net());
        let here = self.module.state.borrow().netlist.scope_path(ScopeId::TOP);
        self.module.report(Code::ForeignSignal, format!("{foreign} is a signal of another module, not of {here}"));
        Signal::new(self, self.module.guess(), signal.is_signed())
    }

    #[track_caller]
    fn claim_name(self, name: &str) {
        self.module.check_name(name);
        let here = Place::Source(Source::here());
        let before = self.module.state.borrow().used_names.get(&(self.id, name.to_owned())).cloned();
        if let Some(first) = before {
            let scope = self.module.state.borrow().netlist.scope_path(self.id);
            self.module.report(Code::DuplicateName, format!("'{name}' is already a name in {scope}, given at {first}"));
        } else {
            self.module.state.borrow_mut().used_names.insert((self.id, name.to_owned()), here);
        }
    }
}

/// A name that every wave viewer and Verilog take: `[A-Za-z_][A-Za-z0-9_]*`.
pub fn is_identifier(name: &str) -> bool {
    let mut chars = name.chars();
    chars.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && chars.all(|c| c.is_ascii_alphanumeric() || c == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(module: Module) -> Vec<Code> {
        module.finish().expect_err("mistakes expected").0.iter().map(|d| d.code).collect()
    }

    #[test]
    fn unequal_widths_are_a_diagnostic_that_names_both_nets_and_the_line() {
        let module = Module::new("bad");
        let m = module.top();
        let _ = m.input("a", 4).wrapping_add(m.input("b", 5));
        let diagnostics = module.finish().unwrap_err();
        let text = diagnostics.to_string();
        assert!(text.contains("bad.a (4 bits) and bad.b (5 bits) are not equally wide"), "{text}");
        assert!(text.contains("dsl/mod.rs:"), "{text}");
        assert_eq!(diagnostics.0.len(), 1);
    }

    #[test]
    fn a_register_without_next_value_and_one_with_two_are_diagnostics() {
        let module = Module::new("bad");
        let m = module.top();
        let _ = m.reg("idle", 3);
        let twice = m.reg("twice", 3);
        twice.set(m.lit(3, 1));
        twice.set(m.lit(3, 2));
        assert_eq!(codes(module), [Code::DrivenTwice, Code::UndrivenRegister]);
    }

    #[test]
    fn names_are_unique_in_their_scope_and_fit_for_waves() {
        let module = Module::new("bad");
        let m = module.top();
        let a = m.input("a", 1);
        let inner = m.scope("inner");
        inner.name("a", a);
        m.name("a", a);
        m.name("a b", a);
        m.name("1st", a);
        assert_eq!(codes(module), [Code::DuplicateName, Code::BadName, Code::BadName]);
    }

    #[test]
    fn a_module_goes_on_where_a_netlist_ended_and_knows_its_names_and_nets() {
        let first = Module::new("counter");
        let count = first.top().scope("part").reg("count", 3);
        count.set(count.q.wrapping_add(first.top().lit(3, 1)));
        let count = count.q.net();
        let before = first.finish().unwrap();

        let more = Module::continuing(before.clone());
        let m = more.top().scope("gauge");
        let twice = m.net(count, false).extend(4);
        m.name("twice", twice.wrapping_add(twice));
        let after = more.finish().unwrap();
        assert_eq!(after.cells[..before.cells.len()], before.cells);
        assert_eq!(after.find("twice").map(|named| after.path(named)), Some("counter.gauge.twice".to_owned()));

        let wrong = Module::continuing(before.clone());
        let _ = wrong.top().scope("part");
        let _ = wrong.top().net(Net(99), false);
        assert_eq!(codes(wrong), [Code::DuplicateName, Code::ForeignSignal]);
    }

    #[test]
    fn impossible_widths_and_values_are_diagnostics_not_panics() {
        let module = Module::new("bad");
        let m = module.top();
        let _ = m.reg("none", 0);
        let _ = m.lit(3, 8);
        let _ = m.lit_signed(3, 4);
        let _ = m.lit(4, 1).slice(3, 2);
        let _ = m.lit(40, 1).concat(m.lit(40, 1));
        let expected = [Code::BadWidth, Code::ValueTooWide, Code::ValueTooWide, Code::OutOfRange, Code::BadWidth];
        assert_eq!(codes(module), expected);
    }
}
