//! Symbols before their texts are written: which cells make one up, and what each reads.

use std::collections::HashMap;

use stepwave_netlist::cells::{Arithmetic, Claim, Op, WritePort};
use stepwave_netlist::{Net, Netlist};

use crate::fold::{Fold, is_operator};
use crate::formula::{Formula, Piece};

/// What a symbol looks like.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    Input,
    Register,
    Logic,
    Choice,
    Operator,
    Memory,
}

/// A symbol: cells that are drawn as one.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    pub(crate) kind: Kind,
    /// The sign of an operator.
    pub(crate) sign: String,
    pub(crate) rows: Vec<Row>,
    /// Nets that leave it.
    pub(crate) outputs: Vec<Net>,
    /// Cells that it is drawn for.
    pub(crate) cells: Vec<Net>,
    /// Paths of the flags that are raised by it.
    pub(crate) flags: Vec<String>,
}

/// A row of a box, or an operand of an operator.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// What it is to a memory.
    pub(crate) role: Option<Role>,
    /// When the value is taken.
    pub(crate) condition: Option<Formula>,
    pub(crate) value: Value,
}

/// What a row is to a memory, with the number of its port, from 0.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Role {
    /// What is written.
    Data(usize),
    /// Where it is written.
    Written(usize),
    /// Where is read.
    Read(usize),
}

/// What a row takes.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    /// A net that is drawn, and which bits of it.
    Wire(Net, String),
    Text(Formula),
}

impl Row {
    /// The nets that are drawn which it reads.
    pub(crate) fn nets(&self) -> Vec<Net> {
        let mut nets = match &self.value {
            Value::Wire(net, _) => vec![*net],
            Value::Text(formula) => formula.nets(),
        };
        nets.extend(self.condition.iter().flat_map(Formula::nets));
        nets
    }
}

/// All symbols of a netlist, in the order of its cells; nets that are another one's pin by a merger.
pub(crate) struct Drafts {
    pub(crate) all: Vec<Draft>,
    /// The symbol that each net leaves, and by which of its outputs.
    pub(crate) of: HashMap<Net, (usize, Net)>,
}

impl Drafts {
    pub(crate) fn new(fold: &Fold<'_>) -> Drafts {
        let mut drafts = Drafts { all: Vec::new(), of: HashMap::new() };
        let mut operators: HashMap<(bool, Net, Net), usize> = HashMap::new();
        let netlist = fold.netlist;
        for (memory, data) in netlist.memories.iter().enumerate() {
            let rows = data.writes.iter().enumerate().flat_map(|(number, port)| written(fold, number, *port)).collect();
            let draft = Draft { kind: Kind::Memory, sign: data.name.clone(), rows, ..Draft::empty() };
            debug_assert_eq!(drafts.all.len(), memory);
            drafts.all.push(draft);
        }
        for net in netlist.nets().filter(|net| fold.drawn[net.index()]) {
            let op = netlist.cell(net).op;
            if let Op::Read { memory, address } = op {
                drafts.read(fold, net, memory as usize, address);
            } else if is_operator(&op) {
                drafts.operator(fold, net, op, &mut operators);
            } else {
                let draft = plain(fold, net, op);
                drafts.add(draft);
            }
        }
        drafts.merge(fold);
        drafts.mark(netlist, fold);
        drafts
    }

    fn add(&mut self, draft: Draft) {
        for &net in &draft.outputs {
            self.of.insert(net, (self.all.len(), net));
        }
        self.all.push(draft);
    }

    fn read(&mut self, fold: &Fold<'_>, net: Net, memory: usize, address: Net) {
        let draft = &mut self.all[memory];
        let role = Some(Role::Read(draft.outputs.len()));
        draft.rows.push(Row { role, condition: None, value: value(fold, address) });
        draft.outputs.push(net);
        draft.cells.push(net);
        self.of.insert(net, (memory, net));
    }

    /// An adder and its carry are one symbol.
    fn operator(&mut self, fold: &Fold<'_>, net: Net, op: Op, known: &mut HashMap<(bool, Net, Net), usize>) {
        let family = match op {
            Op::Add(a, b) | Op::Carry(a, b) | Op::AddOverflow(a, b) => Some((true, a, b)),
            Op::Sub(a, b) | Op::Borrow(a, b) | Op::SubOverflow(a, b) => Some((false, a, b)),
            _ => None,
        };
        let sign = match op {
            Op::Add(..) => "+",
            Op::Sub(..) => "−",
            Op::Mul(..) => "×",
            Op::Div(..) => "÷",
            Op::Rem(..) => "mod",
            Op::ShiftLeft(..) => "<<",
            Op::ShiftRight(..) => ">>",
            Op::ShiftArithmetic(..) => ">>>",
            Op::Carry(..) => "carry +",
            Op::AddOverflow(..) => "ovf +",
            Op::SubOverflow(..) => "ovf −",
            _ => "<",
        };
        if let Some(&index) = family.and_then(|family| known.get(&family)) {
            let draft = &mut self.all[index];
            // The sum is the first of its outputs, whichever cell came first.
            if matches!(op, Op::Add(..) | Op::Sub(..)) {
                draft.outputs.insert(0, net);
                sign.clone_into(&mut draft.sign);
            } else {
                draft.outputs.push(net);
            }
            draft.cells.push(net);
            self.of.insert(net, (index, net));
            return;
        }
        family.map(|family| known.insert(family, self.all.len()));
        let mut rows = Vec::new();
        op.visit_inputs(|input| rows.push(Row { role: None, condition: None, value: operand(fold, input) }));
        let draft = Draft { kind: Kind::Operator, sign: sign.to_owned(), rows, ..Draft::empty() };
        self.add(Draft { outputs: vec![net], cells: vec![net], ..draft });
    }

    /// The sum and the difference of the same operands, both taken by one box, are one symbol.
    fn merge(&mut self, fold: &Fold<'_>) {
        let operands = |net: Net| match fold.netlist.cell(net).op {
            Op::Add(a, b) | Op::Sub(a, b) => Some((fold.under(a), fold.constant(b).ok_or(fold.under(b)))),
            _ => None,
        };
        for index in 0..self.all.len() {
            let taken: Vec<Net> = self.all[index]
                .rows
                .iter()
                .filter_map(|row| match row.value {
                    Value::Wire(net, _) => Some(net),
                    Value::Text(_) => None,
                })
                .collect();
            for &sum in &taken {
                for &difference in &taken {
                    let [Op::Add(..), Op::Sub(..)] = [sum, difference].map(|net| fold.netlist.cell(net).op) else {
                        continue;
                    };
                    let same = operands(sum) == operands(difference) && fold.width(sum) == fold.width(difference);
                    let alone =
                        [sum, difference].iter().all(|net| fold.named(*net).is_none() && fold.is_read_once(*net));
                    let (Some(&(kept, _)), Some(&(gone, _))) = (self.of.get(&sum), self.of.get(&difference)) else {
                        continue;
                    };
                    if same
                        && alone
                        && kept != gone
                        && self.all[gone].outputs == [difference]
                        && self.all[kept].outputs == [sum]
                    {
                        "±".clone_into(&mut self.all[kept].sign);
                        self.all[kept].cells.push(difference);
                        self.of.insert(difference, (kept, sum));
                        self.all[gone] = Draft::empty();
                    }
                }
            }
        }
    }

    /// Gives registers and adders the flags that they raise.
    fn mark(&mut self, netlist: &Netlist, fold: &Fold<'_>) {
        for property in &netlist.properties {
            let (left, right, operation) = match &property.claim {
                Claim::NoOverflow { operation, left, right } => (left.net, right.net, Some(*operation)),
                Claim::Fits { left, right, .. } => (left.nets[0], right.nets[0], None),
                _ => continue,
            };
            let Some(path) = netlist.name_of(property.never).map(|named| netlist.path(named)) else { continue };
            let [left, right] = [left, right].map(|net| fold.under(net));
            let alike = |a: Net, b: Net| a == b || fold.constant(a).is_some() && fold.constant(a) == fold.constant(b);
            for draft in &mut self.all {
                let is_operator = draft.cells.iter().any(|&cell| match (netlist.cell(cell).op, operation) {
                    (Op::Add(a, b), Some(Arithmetic::Add) | None) | (Op::Sub(a, b), Some(Arithmetic::Sub) | None) => {
                        fold.under(a) == left && alike(fold.under(b), right)
                    }
                    (Op::Mul(a, b) | Op::ShiftLeft(a, b), None) => fold.under(a) == left && alike(fold.under(b), right),
                    _ => false,
                });
                let is_register = operation.is_some() && draft.kind == Kind::Register && draft.outputs == [left];
                if is_operator || is_register {
                    draft.flags.push(path.clone());
                }
            }
        }
    }
}

impl Draft {
    fn empty() -> Draft {
        let (sign, rows, outputs) = (String::new(), Vec::new(), Vec::new());
        Draft { kind: Kind::Logic, sign, rows, outputs, cells: Vec::new(), flags: Vec::new() }
    }

    /// It was merged into another one.
    pub(crate) fn is_gone(&self) -> bool {
        self.cells.is_empty() && self.kind != Kind::Memory
    }
}

fn plain(fold: &Fold<'_>, net: Net, op: Op) -> Draft {
    let (kind, rows) = match op {
        Op::Input => (Kind::Input, Vec::new()),
        Op::Register { next: Some(next), .. } => {
            let mut rows = rows(fold, next);
            // A register that keeps its value needs no row for it.
            if rows.len() > 1
                && matches!(rows.last(), Some(Row { value: Value::Wire(kept, bits), .. }) if *kept == net && bits.is_empty())
            {
                rows.pop();
            }
            (Kind::Register, rows)
        }
        Op::Mux { .. } if fold.choices(net).len() > 1 => (Kind::Choice, rows(fold, net)),
        _ => (Kind::Logic, vec![Row { role: None, condition: None, value: Value::Text(fold.inner(net)) }]),
    };
    Draft { kind, rows, outputs: vec![net], cells: vec![net], ..Draft::empty() }
}

fn rows(fold: &Fold<'_>, net: Net) -> Vec<Row> {
    let condition = |(select, high): (Net, bool)| if high { fold.formula(select) } else { fold.inverted(select) };
    let row = |choice: &crate::fold::Choice| Row {
        role: None,
        condition: choice.condition.map(condition),
        value: value(fold, choice.value),
    };
    fold.choices(net).iter().map(row).collect()
}

/// What writes a memory.
fn written(fold: &Fold<'_>, number: usize, port: WritePort) -> Vec<Row> {
    let condition = (fold.constant(port.enable) != Some(1)).then(|| fold.formula(port.enable));
    let data = Row { role: Some(Role::Data(number)), condition, value: value(fold, port.data) };
    vec![data, Row { role: Some(Role::Written(number)), condition: None, value: value(fold, port.address) }]
}

/// A net as a wire, if it is one or bits of one, else as a text.
fn value(fold: &Fold<'_>, net: Net) -> Value {
    let formula = fold.formula(net);
    match formula.pieces.as_slice() {
        [Piece::Net(base)] => Value::Wire(*base, String::new()),
        [Piece::Net(base), Piece::Text(bits)] if bits.starts_with('[') => Value::Wire(*base, bits.clone()),
        _ => Value::Text(formula),
    }
}

/// An operand: a wire, or a constant.
fn operand(fold: &Fold<'_>, net: Net) -> Value {
    match (value(fold, net), fold.base(net)) {
        (Value::Text(text), Some(base)) if fold.constant(net).is_none() => {
            let is_sign = text.nets() == [base];
            Value::Wire(base, if is_sign { format!("[{}]", fold.width(base) - 1) } else { String::new() })
        }
        (value, _) => value,
    }
}
