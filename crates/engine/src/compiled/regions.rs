//! Which cells need evaluating where: a cell that only one arm of a multiplexer depends on, or only the value that a
//! register takes under a condition, belongs into the branch that is taken then.
//!
//! A region is a list of conditions (`select` = 1 or 0) that hold in it. The region of a cell is what the regions of all
//! its users have in common, so it is evaluated whenever one of them is. Multiplexers of the same select in the same
//! region share its two branches.

use rustc_hash::FxHashMap as HashMap;

use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Cell, Net, Netlist, Op, WritePort};

/// The region without conditions.
pub(super) const ROOT: u32 = 0;
/// Of a cell that nothing needs.
const NOWHERE: u32 = u32::MAX;
/// Conditions of a region at most.
const DEEPEST: u32 = 48;

/// What happens at an edge.
#[derive(Clone, Copy, Debug)]
pub(super) enum Sink {
    /// The register of this index takes a value.
    Commit { index: usize, register: Net, value: Net },
    /// The register of this index, which is a constant, must take this value again.
    Guard { index: usize, value: Net, wanted: u64 },
    /// A port of a memory writes, if its enable is 1.
    Write { memory: usize, port: WritePort },
}

impl Sink {
    /// The nets that it reads.
    pub(super) fn nets(&self) -> Vec<Net> {
        match *self {
            Sink::Commit { value, .. } | Sink::Guard { value, .. } => vec![value],
            Sink::Write { port, .. } => port.nets(),
        }
    }
}

/// A register whose next value is wanted: its index, its net and that of its next value, and the constant that it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Next {
    pub(super) index: usize,
    pub(super) register: Net,
    pub(super) next: Net,
    pub(super) fixed: Option<u64>,
}

/// The two branches of a select in a region.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct Fork {
    /// What is looked at, in the region around.
    pub(super) condition: Net,
    /// Regions where it is 0 and 1.
    pub(super) branches: [u32; 2],
}

#[derive(Debug)]
struct Node {
    parent: u32,
    depth: u32,
    /// The select, as multiplexers name it, and its value here.
    select: Net,
    value: bool,
    sinks: Vec<Sink>,
    forks: Vec<Fork>,
    /// There are sinks here or further inside.
    has_sinks: bool,
}

/// The regions of a netlist.
#[derive(Debug)]
pub(super) struct Regions<'a> {
    netlist: &'a Netlist,
    nodes: Vec<Node>,
    forks: HashMap<(u32, Net), [u32; 2]>,
    /// Nets that are branched on.
    branching: Vec<bool>,
    /// Gates that are multiplexers with a constant: the operand that selects.
    gates: Vec<Option<Net>>,
    /// Region of each cell.
    of: Vec<u32>,
    /// Operators; where a condition decides a multiplexer, its users have its arm for an operand.
    ops: Vec<Op>,
}

impl<'a> Regions<'a> {
    /// A netlist with the constants 0 and 1 at its end, which gates have for operands where they are branched on.
    pub(super) fn with_constants(netlist: &Netlist) -> Netlist {
        let mut netlist = netlist.clone();
        netlist.cells.extend([0, 1].map(|value| Cell { op: Op::Const(value), width: Width::ONE }));
        netlist
    }

    /// The regions for these registers and nets that are looked at in every sample.
    pub(super) fn new(netlist: &'a Netlist, registers: &[Next], observed: &[Net], worth: u32) -> Regions<'a> {
        let selects = |net: Net| !matches!(netlist.cell(net).op, Op::Const(_)) && netlist.width(net) == Width::ONE;
        let all = netlist.nets().map(selects).collect();
        let worth = Regions::with(netlist, registers, observed, all).worth(worth);
        Regions::with(netlist, registers, observed, worth)
    }

    fn with(netlist: &'a Netlist, registers: &[Next], observed: &[Net], branching: Vec<bool>) -> Regions<'a> {
        let root = Node {
            parent: ROOT,
            depth: 0,
            select: Net(u32::MAX),
            value: false,
            sinks: Vec::new(),
            forks: Vec::new(),
            has_sinks: true,
        };
        let mut regions = Regions {
            netlist,
            gates: gates(netlist),
            nodes: vec![root],
            forks: HashMap::default(),
            branching,
            of: vec![NOWHERE; netlist.cells.len()],
            ops: netlist.cells.iter().map(|cell| cell.op).collect(),
        };
        for &net in observed {
            regions.need(net, ROOT);
        }
        regions.ports();
        let users = regions.users(registers);
        for register in registers {
            regions.commit(*register, register.next, ROOT, &users);
        }
        for index in (0..netlist.cells.len()).rev() {
            if regions.of[index] != NOWHERE {
                regions.operands(index);
            }
        }
        regions
    }

    /// How many users each net has, cells and next values of registers.
    fn users(&self, registers: &[Next]) -> Vec<u32> {
        let mut users = vec![0; self.netlist.cells.len()];
        for cell in &self.netlist.cells {
            cell.op.visit_inputs(|input| users[input.index()] += 1);
        }
        for register in registers {
            users[register.next.index()] += 1;
        }
        users
    }

    /// A port of a memory with no other is a branch; others write in their order, after everything is evaluated.
    fn ports(&mut self) {
        let netlist = self.netlist;
        for (memory, of) in netlist.memories.iter().enumerate() {
            for port in &of.writes {
                let region = match netlist.cell(port.enable).op {
                    Op::Const(0) => continue,
                    Op::Const(_) => ROOT,
                    _ if of.writes.len() > 1 => ROOT,
                    _ => self.fork(ROOT, port.enable)[1],
                };
                self.need(port.enable, ROOT);
                let port = port.map(|net| if net == port.enable { net } else { self.need(net, region) });
                self.sink(region, Sink::Write { memory, port });
            }
        }
    }

    /// The value that a register takes, in the branches of the multiplexers that it goes through.
    fn commit(&mut self, register: Next, value: Net, region: u32, users: &[u32]) {
        let value = self.resolve(value, region);
        if value == register.register && register.fixed.is_none() {
            return;
        }
        if let Some([select, low, high]) = self.choice(value)
            && users[value.index()] == 1
            && self.branches(select, region)
        {
            let [without, with] = self.fork(region, select);
            self.commit(register, high, with, users);
            self.commit(register, low, without, users);
            return;
        }
        let Next { index, register, fixed, .. } = register;
        match (fixed, self.netlist.cell(value).op) {
            (Some(wanted), Op::Const(value)) if value == wanted => {}
            (Some(wanted), _) => {
                self.need(value, region);
                self.sink(region, Sink::Guard { index, value, wanted });
            }
            (None, _) => {
                self.need(value, region);
                self.sink(region, Sink::Commit { index, register, value });
            }
        }
    }

    fn sink(&mut self, region: u32, sink: Sink) {
        self.nodes[region as usize].sinks.push(sink);
        let mut region = region;
        while !self.nodes[region as usize].has_sinks {
            self.nodes[region as usize].has_sinks = true;
            region = self.nodes[region as usize].parent;
        }
    }

    /// A cell is in its region: all its users have been seen. Finds those of its operands.
    fn operands(&mut self, index: usize) {
        let op = self.netlist.cells[index].op;
        if let Op::Read { memory, .. } = op
            && !self.netlist.memories[memory as usize].writes.is_empty()
        {
            // Read before anything is written.
            self.of[index] = ROOT;
        }
        let region = self.of[index];
        let choice = self.choice(Net(u32::try_from(index).unwrap_or(u32::MAX)));
        self.ops[index] = match choice {
            Some([select, low, high]) if self.branches(select, region) => {
                let [without, with] = self.fork(region, select);
                Op::Mux { select: self.need(select, region), high: self.need(high, with), low: self.need(low, without) }
            }
            _ => op.map_inputs(|input| self.need(input, region)),
        };
    }

    /// A cell that gives one of two nets: what selects, and the nets where that is 0 and 1.
    fn choice(&self, net: Net) -> Option<[Net; 3]> {
        let [zero, one] = [2, 1].map(|place| Net(u32::try_from(self.ops.len() - place).unwrap_or(u32::MAX)));
        let other = |a: Net, b: Net, select: Net| if a == select { b } else { a };
        match (self.netlist.cell(net).op, self.gates[net.index()]) {
            (Op::Mux { select, high, low }, _) => Some([select, low, high]),
            (Op::And(a, b), Some(select)) => Some([select, zero, other(a, b, select)]),
            (Op::Or(a, b), Some(select)) => Some([select, other(a, b, select), one]),
            _ => None,
        }
    }

    fn branches(&self, select: Net, region: u32) -> bool {
        self.branching[select.index()] && self.nodes[region as usize].depth < DEEPEST
    }

    /// The regions inside of a region in which a net is 0 and 1.
    fn fork(&mut self, region: u32, select: Net) -> [u32; 2] {
        if let Some(&branches) = self.forks.get(&(region, select)) {
            return branches;
        }
        let depth = self.nodes[region as usize].depth + 1;
        let branches = [false, true].map(|value| {
            let node =
                Node { parent: region, depth, select, value, sinks: Vec::new(), forks: Vec::new(), has_sinks: false };
            self.nodes.push(node);
            u32::try_from(self.nodes.len() - 1).unwrap_or(u32::MAX)
        });
        self.forks.insert((region, select), branches);
        let condition = self.need(select, region);
        self.nodes[region as usize].forks.push(Fork { condition, branches });
        branches
    }

    /// What a net is in a region where some multiplexers are decided.
    fn resolve(&self, mut net: Net, region: u32) -> Net {
        while let Some([select, low, high]) = self.choice(net) {
            match self.decided(select, region) {
                Some(true) => net = high,
                Some(false) => net = low,
                None => break,
            }
        }
        net
    }

    fn decided(&self, select: Net, mut region: u32) -> Option<bool> {
        if !self.branching[select.index()] {
            return None;
        }
        while region != ROOT {
            let node = &self.nodes[region as usize];
            if node.select == select {
                return Some(node.value);
            }
            region = node.parent;
        }
        None
    }

    /// A net is looked at in a region; gives the one that it is there.
    fn need(&mut self, net: Net, region: u32) -> Net {
        let net = self.resolve(net, region);
        let of = &mut self.of[net.index()];
        *of = if *of == NOWHERE { region } else { common(&self.nodes, *of, region) };
        net
    }

    /// The selects in whose branches there is enough to do.
    fn worth(&self, least: u32) -> Vec<bool> {
        let mut work = vec![0u32; self.nodes.len()];
        for (index, &region) in self.of.iter().enumerate() {
            if region != NOWHERE {
                work[region as usize] += weight(self.ops[index]);
            }
        }
        let mut of_select = vec![0u32; self.netlist.cells.len()];
        for (index, node) in self.nodes.iter().enumerate().skip(1).rev() {
            let all = work[index] + u32::try_from(node.sinks.len()).unwrap_or(u32::MAX);
            work[node.parent as usize] += all;
            of_select[node.select.index()] += all;
        }
        of_select.into_iter().map(|work| work >= least).collect()
    }

    /// The operator of a cell, with the operands that it has in its region.
    pub(super) fn op(&self, net: Net) -> Op {
        self.ops[net.index()]
    }

    pub(super) fn of(&self, net: Net) -> u32 {
        self.of[net.index()]
    }

    pub(super) fn is_needed(&self, net: Net) -> bool {
        self.of[net.index()] != NOWHERE
    }

    /// The fork of a multiplexer, or of a gate that has become one, if it is branched on.
    pub(super) fn fork_of(&self, net: Net) -> Option<Fork> {
        let Op::Mux { select: condition, .. } = self.op(net) else { return None };
        let [select, ..] = self.choice(net)?;
        self.forks.get(&(self.of(net), select)).map(|&branches| Fork { condition, branches })
    }

    pub(super) fn sinks(&self, region: u32) -> &[Sink] {
        &self.nodes[region as usize].sinks
    }

    /// The forks of a region in which there are sinks.
    pub(super) fn forks(&self, region: u32) -> impl Iterator<Item = Fork> + '_ {
        let forks = self.nodes[region as usize].forks.iter().copied();
        forks.filter(|fork| fork.branches.iter().any(|&branch| self.nodes[branch as usize].has_sinks))
    }

    /// All regions inside of one, and itself, that have sinks in them.
    pub(super) fn inside(&self, region: u32) -> Vec<u32> {
        let mut all = vec![region];
        let mut next = 0;
        while let Some(&region) = all.get(next) {
            let branches = self.forks(region).flat_map(|fork| fork.branches);
            all.extend(branches.filter(|&branch| self.nodes[branch as usize].has_sinks));
            next += 1;
        }
        all
    }
}

/// What two regions have in common.
fn common(nodes: &[Node], mut a: u32, mut b: u32) -> u32 {
    while a != b {
        let [x, y] = [a, b].map(|region| &nodes[region as usize]);
        if x.depth >= y.depth {
            a = x.parent;
        } else {
            b = y.parent;
        }
    }
    a
}

/// Gates one operand of which selects between others elsewhere: where it is the controlling value, the other one is not
/// needed.
fn gates(netlist: &Netlist) -> Vec<Option<Net>> {
    let mut selects = vec![0u32; netlist.cells.len()];
    for cell in &netlist.cells {
        if let Op::Mux { select, .. } = cell.op {
            selects[select.index()] += 1;
        }
    }
    let gate = |cell: &Cell| match cell.op {
        Op::And(a, b) | Op::Or(a, b) if cell.width == Width::ONE => {
            let select = if selects[a.index()] >= selects[b.index()] { a } else { b };
            (selects[select.index()] > 0).then_some(select)
        }
        _ => None,
    };
    netlist.cells.iter().map(gate).collect()
}

/// What a cell takes, about.
fn weight(op: Op) -> u32 {
    match op {
        Op::Input | Op::Const(_) | Op::Register { .. } => 0,
        Op::Div(..) | Op::Rem(..) => 20,
        Op::Read { .. } | Op::Mul(..) => 3,
        _ => 1,
    }
}
