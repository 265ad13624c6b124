//! Layout: which net becomes a wire of its own, which is written where it is used, and in which scope.
//!
//! A *node* is a net, or the sum or difference with one more bit (`Wide`) from which its carry or overflow is taken. An
//! `Add` or `Sub` of the same operands is then the low part of that one adder.

use std::collections::HashMap;

use super::names::Names;
use stepwave_netlist::cells::{Net, Netlist, Op, ScopeId};
use stepwave_netlist::passes::constant;
use stepwave_netlist::{Design, Width};

/// Operators in one expression before it is cut by a wire.
const LARGEST: usize = 8;

/// What a net becomes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Form {
    /// Nothing depends on it.
    Dead,
    /// Declared under its own name.
    Named,
    /// Declared under a made-up name.
    Unnamed,
    /// Written where it is used.
    Inline,
    /// An arm of a register's next value, written as `if`.
    Arm,
}

/// The widened adder of a carry or an overflow.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Wide {
    /// Cell that it is named after.
    pub(super) of: Net,
    /// Operands.
    pub(super) left: Net,
    pub(super) right: Net,
    /// Subtracts.
    pub(super) subtract: bool,
    /// The added bit repeats the sign; otherwise it is 0.
    pub(super) signed: bool,
    /// First cell that uses it: it is declared in front of that.
    before: Net,
}

/// The layout of a design.
pub(super) struct Layout {
    pub(super) forms: Vec<Form>,
    /// Innermost scope around all users of a net; its own scope if it has a name.
    pub(super) places: Vec<ScopeId>,
    pub(super) wides: Vec<Wide>,
    pub(super) wide_places: Vec<ScopeId>,
    /// Values of nets that never change.
    known: Vec<Option<u64>>,
    /// Index into `wides` of what a cell is a part of.
    part_of: HashMap<Net, usize>,
}

/// How the nets are read, by net.
struct Uses {
    of: Vec<usize>,
    /// A slice or a sign extension reads it, for which it needs a name.
    is_cut: Vec<bool>,
    /// A register, a port, or a net with a name.
    is_root: Vec<bool>,
}

impl Uses {
    /// Only one expression reads the net, as a whole.
    fn are_one(&self, net: Net) -> bool {
        self.of[net.index()] == 1 && !self.is_root[net.index()] && !self.is_cut[net.index()]
    }
}

impl Layout {
    pub(super) fn new(design: &Design, names: &Names) -> Layout {
        let netlist = design.netlist();
        let count = netlist.cells.len();
        let (wides, part_of) = wides(design);
        let mut layout = Layout {
            forms: vec![Form::Dead; count],
            places: vec![ScopeId::TOP; count],
            wide_places: vec![ScopeId::TOP; wides.len()],
            wides,
            known: known(netlist),
            part_of,
        };
        layout.choose_forms(netlist, names, design.registers());
        layout.choose_places(netlist, names);
        layout
    }

    /// The widened adder that a cell is a part of.
    pub(super) fn wide_of(&self, net: Net) -> Option<&Wide> {
        self.part_of.get(&net).map(|&index| &self.wides[index])
    }

    /// The value of a net that never changes.
    pub(super) fn known(&self, net: Net) -> Option<u64> {
        self.known[net.index()]
    }

    /// What a multiplexer with a constant select passes on.
    pub(super) fn passed(&self, op: Op) -> Option<Net> {
        match op {
            Op::Mux { select, high, low } => self.known(select).map(|select| if select == 1 { high } else { low }),
            _ => None,
        }
    }

    /// Calls `visit` with every net that a node reads, and whether bits of it are cut out.
    fn operands(&self, netlist: &Netlist, net: Net, mut visit: impl FnMut(Net, bool)) {
        let cell = netlist.cell(net);
        if self.known(net).is_some() {
            return;
        }
        if let Some(passed) = self.passed(cell.op) {
            visit(passed, false);
            return;
        }
        if let Some(wide) = self.wide_of(net) {
            // Read by the adder in front of its first user.
            if wide.before == net {
                visit(wide.left, wide.signed);
                visit(wide.right, wide.signed);
            }
            return;
        }
        // A divisor is also compared with 0.
        if let Op::Read { address, .. } = cell.op {
            // Also compared with the size.
            visit(address, true);
            return;
        }
        if let Op::Div(a, b) | Op::Rem(a, b) = cell.op {
            visit(a, false);
            visit(b, true);
            return;
        }
        let cut = match cell.op {
            Op::Slice { of, .. } => cell.width < netlist.width(of),
            Op::SignExtend(of) => cell.width > netlist.width(of),
            _ => false,
        };
        cell.op.visit_inputs(|input| visit(input, cut));
    }

    fn choose_forms(&mut self, netlist: &Netlist, names: &Names, registers: &[Net]) {
        let uses = self.uses(netlist, names, registers);
        let mut size = vec![1usize; netlist.cells.len()];
        for net in netlist.nets() {
            let index = net.index();
            let op = netlist.cell(net).op;
            let is_part = self.wide_of(net).is_some();
            let mut total = 1;
            if !is_part {
                op.visit_inputs(|input| {
                    total += if self.forms[input.index()] == Form::Inline { size[input.index()] } else { 0 };
                });
            }
            size[index] = total;
            self.forms[index] = match op {
                Op::Input | Op::Register { .. } if names.first(net).is_some() => Form::Named,
                Op::Input | Op::Register { .. } => Form::Unnamed,
                _ if names.first(net).is_some() => Form::Named,
                _ if uses.of[index] == 0 && !uses.is_root[index] => Form::Dead,
                _ if self.known(net).is_some() => Form::Inline,
                // A part of a name is as short as a name.
                Op::Slice { of, .. } if netlist.cell(net).width < netlist.width(of) => Form::Inline,
                Op::Add(..) | Op::Sub(..) | Op::Carry(..) if is_part => Form::Inline,
                Op::Not(_) if total == 1 && !uses.is_cut[index] => Form::Inline,
                _ if uses.are_one(net) && total <= LARGEST => Form::Inline,
                _ => Form::Unnamed,
            };
        }
        self.choose_arms(netlist, registers, &uses);
    }

    fn uses(&self, netlist: &Netlist, names: &Names, registers: &[Net]) -> Uses {
        let mut uses = vec![0usize; netlist.cells.len()];
        let mut cut = vec![false; netlist.cells.len()];
        let mut root = vec![false; netlist.cells.len()];
        for named in &netlist.names {
            named.nets().for_each(|net| root[net.index()] = true);
        }
        for port in names.inputs.iter().chain(&names.outputs) {
            root[port.net.index()] = true;
        }
        for &register in registers {
            root[register.index()] = true;
            if let Op::Register { next: Some(next), .. } = netlist.cell(register).op {
                uses[next.index()] += 1;
            }
        }
        for net in netlist.memories.iter().flat_map(|memory| &memory.writes).flat_map(|port| port.nets()) {
            uses[net.index()] += 1;
            cut[net.index()] |= netlist.width(net).get() > 1;
        }
        // Users come after what they use, so that all uses of a net are known when it is its turn.
        for net in netlist.nets().collect::<Vec<_>>().into_iter().rev() {
            let index = net.index();
            if root[index] || uses[index] > 0 || self.wide_of(net).is_some() {
                self.operands(netlist, net, |input, cuts| {
                    uses[input.index()] += 1;
                    cut[input.index()] |= cuts && netlist.width(input).get() > 1;
                });
            }
        }
        Uses { of: uses, is_cut: cut, is_root: root }
    }

    /// The chains of multiplexers in front of registers become branches of their `if`s.
    fn choose_arms(&mut self, netlist: &Netlist, registers: &[Net], uses: &Uses) {
        for &register in registers {
            let mut next = match netlist.cell(register).op {
                Op::Register { next: Some(next), .. } => next,
                _ => continue,
            };
            // Also where the chain was cut for its size, but not where another reads it.
            while let Op::Mux { select, low, .. } = netlist.cell(next).op {
                if !uses.are_one(next) || self.known(select) == Some(1) {
                    break;
                }
                self.forms[next.index()] = Form::Arm;
                next = low;
            }
        }
    }

    fn choose_places(&mut self, netlist: &Netlist, names: &Names) {
        let mut places: Vec<Option<ScopeId>> = vec![None; netlist.cells.len()];
        let mut wide_places: Vec<Option<ScopeId>> = vec![None; self.wides.len()];
        let join = |place: &mut Option<ScopeId>, with: ScopeId| {
            *place = Some(place.map_or(with, |place| names.common(place, with)));
        };
        let own = |net: Net| names.first(net).map(|entry| netlist.names[entry].scope);
        for (net, cell) in netlist.nets().zip(&netlist.cells) {
            if let Op::Register { next: Some(next), .. } = cell.op {
                join(&mut places[next.index()], own(net).unwrap_or(ScopeId::TOP));
            }
        }
        for net in netlist.memories.iter().flat_map(|memory| &memory.writes).flat_map(|port| port.nets()) {
            join(&mut places[net.index()], ScopeId::TOP);
        }
        for named in netlist.names.iter().filter(|named| named.is_wide()) {
            named.nets().for_each(|net| join(&mut places[net.index()], named.scope));
        }
        for port in &names.outputs {
            join(&mut places[port.net.index()], ScopeId::TOP);
        }
        for net in netlist.nets().collect::<Vec<_>>().into_iter().rev() {
            if self.forms[net.index()] == Form::Dead {
                continue;
            }
            let used = places[net.index()].unwrap_or(ScopeId::TOP);
            let place = match (own(net), netlist.cell(net).op) {
                (Some(scope), _) => scope,
                (None, Op::Input | Op::Register { .. }) => ScopeId::TOP,
                (None, _) => used,
            };
            self.places[net.index()] = place;
            let Some(&wide) = self.part_of.get(&net) else {
                self.operands(netlist, net, |input, _| join(&mut places[input.index()], place));
                continue;
            };
            join(&mut wide_places[wide], place);
            // All other parts came before this one, from the end.
            let place = wide_places[wide].unwrap_or(ScopeId::TOP);
            self.operands(netlist, net, |input, _| join(&mut places[input.index()], place));
        }
        self.wide_places = wide_places.into_iter().map(|place| place.unwrap_or(ScopeId::TOP)).collect();
    }

    /// The widened adders declared in front of a cell.
    pub(super) fn wide_before(&self, net: Net) -> Option<(usize, &Wide)> {
        let index = *self.part_of.get(&net)?;
        (self.wides[index].before == net).then(|| (index, &self.wides[index]))
    }
}

/// The values of all that follows from constants. Icarus Verilog 11 compiles a shift by or of a name that it finds to be
/// constant to something that it cannot read; with a number it does not.
fn known(netlist: &Netlist) -> Vec<Option<u64>> {
    let mut known: Vec<Option<u64>> = Vec::with_capacity(netlist.cells.len());
    for cell in &netlist.cells {
        let of = |net: Net| Some((known.get(net.index()).copied().flatten()?, netlist.width(net)));
        known.push(match cell.op {
            // 1 divides everything, and a remainder by 0 is 0.
            Op::Rem(..) if cell.width == Width::ONE => Some(0),
            op => constant::value(op, cell.width, of),
        });
    }
    known
}

/// The widened adders of all live carries and overflows, and the cells that are parts of them.
fn wides(design: &Design) -> (Vec<Wide>, HashMap<Net, usize>) {
    let netlist = design.netlist();
    let mut live = design.order().to_vec();
    live.sort_unstable();
    let mut wides: Vec<Wide> = Vec::new();
    let mut part_of = HashMap::new();
    // By operands and operation; where both are needed, sums are taken from that of the carry.
    let mut found: HashMap<(Net, Net, bool, bool), usize> = HashMap::new();
    for &net in &live {
        let (left, right, subtract, signed) = match netlist.cell(net).op {
            Op::Carry(a, b) => (a, b, false, false),
            Op::AddOverflow(a, b) => (a, b, false, true),
            Op::SubOverflow(a, b) => (a, b, true, true),
            _ => continue,
        };
        let index = *found.entry((left, right, subtract, signed)).or_insert(wides.len());
        if index == wides.len() {
            wides.push(Wide { of: net, left, right, subtract, signed, before: net });
        }
        part_of.insert(net, index);
    }
    for &net in &live {
        let (left, right, subtract) = match netlist.cell(net).op {
            Op::Add(a, b) => (a, b, false),
            Op::Sub(a, b) => (a, b, true),
            _ => continue,
        };
        let twin = |signed: bool| found.get(&(left, right, subtract, signed));
        if let Some(&index) = twin(false).or_else(|| twin(true)) {
            part_of.insert(net, index);
            wides[index].before = wides[index].before.min(net);
        }
    }
    (wides, part_of)
}
