//! A design as one step of bits: what it takes from the state and the inputs, and the state after the next edge.

use stepwave_netlist::cells::{Memory, Net, Op};
use stepwave_netlist::{Design, Netlist};

use super::aig::{Graph, Literal};
use super::words::{Word, blast, constant, decoded, select};

/// The most bits of memories that are followed one by one.
pub const MOST_MEMORY_BITS: u64 = 1 << 16;

/// A memory is too large to be followed bit by bit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the memory {memory} has {bits} bits; with it the memories that the goals depend on have more than {MOST_MEMORY_BITS}, the most that are followed bit by bit: make it smaller, or leave out with --goal what depends on it"
)]
pub struct TooLarge {
    /// Path of the memory.
    pub memory: String,
    /// Its bits.
    pub bits: u64,
}

/// A bit of a register or of a memory.
pub(super) struct StateBit {
    /// The variable in the graph.
    pub(super) now: Literal,
    /// Its value after the next edge.
    pub(super) next: Literal,
    /// Its value before the first edge.
    pub(super) first: bool,
}

/// One step of a design.
pub(super) struct Template {
    pub(super) graph: Graph,
    pub(super) state: Vec<StateBit>,
    /// Inputs on which a root depends, with their variables.
    pub(super) inputs: Vec<(Net, Word)>,
    /// The bits that were asked for.
    pub(super) roots: Vec<Literal>,
    /// Registers all of whose bits are in the state.
    pub(super) registers: Vec<Word>,
    /// Nodes on which a root depends, now or after some edges, operands first.
    pub(super) cone: Vec<usize>,
}

/// Cells and memories on which nets depend, now or after some edges.
struct Cone {
    cells: Vec<bool>,
    memories: Vec<bool>,
}

impl Cone {
    fn of(netlist: &Netlist, roots: &[Net]) -> Cone {
        let mut cone = Cone { cells: vec![false; netlist.cells.len()], memories: vec![false; netlist.memories.len()] };
        let mut pending = roots.to_vec();
        while let Some(net) = pending.pop() {
            if std::mem::replace(&mut cone.cells[net.index()], true) {
                continue;
            }
            let op = netlist.cell(net).op;
            op.visit_inputs(|input| pending.push(input));
            match op {
                Op::Register { next: Some(next), .. } => pending.push(next),
                Op::Read { memory, .. } if !std::mem::replace(&mut cone.memories[memory as usize], true) => {
                    pending.extend(netlist.memories[memory as usize].writes.iter().flat_map(|port| port.nets()));
                }
                _ => {}
            }
        }
        cone
    }

    /// Memories in it, unless they are too large together.
    fn memories<'n>(&self, netlist: &'n Netlist) -> Result<Vec<Option<&'n Memory>>, TooLarge> {
        let mut all = 0u64;
        let within = |(memory, &used): (&'n Memory, &bool)| {
            let bits = memory.size.saturating_mul(u64::from(memory.width.get()));
            all = all.saturating_add(if used { bits } else { 0 });
            if all > MOST_MEMORY_BITS {
                return Err(TooLarge { memory: netlist.memory_path(memory), bits });
            }
            Ok(used.then_some(memory))
        };
        netlist.memories.iter().zip(&self.memories).map(within).collect()
    }
}

impl Template {
    /// One step of what these nets of one bit depend on.
    pub(super) fn new(design: &Design, roots: &[Net]) -> Result<Template, TooLarge> {
        let netlist = design.netlist();
        let cone = Cone::of(netlist, roots);
        let used = cone.memories(netlist)?;
        let mut graph = Graph::new();
        let memories: Vec<Vec<Word>> =
            used.iter().map(|memory| memory.map_or_else(Vec::new, |memory| contents(&mut graph, memory))).collect();
        let mut words: Vec<Word> = Vec::with_capacity(netlist.cells.len());
        let mut inputs = Vec::new();
        for (net, cell) in netlist.nets().zip(&netlist.cells) {
            let word = match cone.cells[net.index()] {
                true => blast(&mut graph, cell.op, cell.width, &|of: Net| words[of.index()].clone(), &memories),
                false => Word::new(),
            };
            if matches!(cell.op, Op::Input) && !word.is_empty() {
                inputs.push((net, word.clone()));
            }
            words.push(word);
        }
        let (mut state, mut registers) = (Vec::new(), Vec::new());
        for (cell, now) in netlist.cells.iter().zip(&words).filter(|(_, now)| !now.is_empty()) {
            if let Op::Register { next: Some(next), reset } = cell.op {
                push(&mut state, now, &words[next.index()], &constant(cell.width, reset));
                registers.push(now.clone());
            }
        }
        for (memory, now) in used.iter().zip(&memories) {
            let Some(memory) = memory else { continue };
            let next = written(&mut graph, memory, now, &words);
            for ((now, next), first) in now.iter().zip(&next).zip(memory.first_contents()) {
                push(&mut state, now, next, &constant(memory.width, first));
            }
        }
        let roots = roots.iter().map(|net| words[net.index()][0]).collect();
        let mut template = Template { graph, state, inputs, roots, registers, cone: Vec::new() };
        let (cone, kept) = template.reached(&template.roots);
        let mut number = 0..;
        template.state.retain(|_| number.next().is_some_and(|bit: usize| kept[bit]));
        template.registers.retain(|word| word.iter().all(|bit| cone[bit.node()]));
        template.cone = (0..cone.len()).filter(|&node| cone[node]).collect();
        let reached = |word: &Word| word.iter().any(|bit| cone[bit.node()]);
        template.inputs.retain(|(_, word)| reached(word));
        Ok(template)
    }

    /// Asks for some bits more, of registers alone, before the root of this number.
    pub(super) fn insert(&mut self, before: usize, bits: &[Literal]) {
        self.roots.splice(before..before, bits.iter().copied());
        let (cone, _) = self.reached(&self.roots);
        self.cone = (0..cone.len()).filter(|&node| cone[node]).collect();
    }

    /// Nodes, and bits of the state by their numbers, on which some literals depend, now or after some edges.
    pub(super) fn reached(&self, literals: &[Literal]) -> (Vec<bool>, Vec<bool>) {
        let mut bit_of = vec![None; self.graph.len()];
        self.state.iter().enumerate().for_each(|(number, bit)| bit_of[bit.now.node()] = Some(number));
        let (mut nodes, mut bits) = (vec![false; self.graph.len()], vec![false; self.state.len()]);
        let mut pending: Vec<usize> = literals.iter().map(|literal| literal.node()).collect();
        while let Some(node) = pending.pop() {
            if std::mem::replace(&mut nodes[node], true) {
                continue;
            }
            pending.extend(self.graph.operands(node).into_iter().flatten().map(Literal::node));
            if let Some(number) = bit_of[node] {
                bits[number] = true;
                pending.push(self.state[number].next.node());
            }
        }
        (nodes, bits)
    }
}

fn push(state: &mut Vec<StateBit>, now: &[Literal], next: &[Literal], first: &[Literal]) {
    let bits = now.iter().zip(next).zip(first);
    state.extend(bits.map(|((&now, &next), &first)| StateBit { now, next, first: first == Literal::TRUE }));
}

/// Variables for every word of a memory.
fn contents(graph: &mut Graph, memory: &Memory) -> Vec<Word> {
    (0..memory.size).map(|_| graph.variables(memory.width.get())).collect()
}

/// The words of a memory after the next edge: port after port, so that the last wins.
fn written(graph: &mut Graph, memory: &Memory, now: &[Word], words: &[Word]) -> Vec<Word> {
    let mut after = now.to_vec();
    for port in &memory.writes {
        let word = |net: Net| &words[net.index()];
        let lines = decoded(graph, word(port.enable)[0], word(port.address), now.len());
        for (old, &line) in after.iter_mut().zip(&lines) {
            let written = match port.mask {
                None => word(port.data).clone(),
                Some(mask) => {
                    let bits = word(mask).iter().zip(word(port.data)).zip(old.iter());
                    bits.map(|((&mask, &data), &old)| graph.mux(mask, data, old)).collect()
                }
            };
            *old = select(graph, line, &written, old);
        }
    }
    after
}
