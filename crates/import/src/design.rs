//! A module of Yosys on its way to a netlist: which cell drives which bit, and in which order cells are written.

use std::collections::HashMap;
use std::sync::Arc;

use stepwave_netlist::Net;
use stepwave_netlist::cells::Source;

use crate::cells::{is_bitwise, is_register, is_remark, is_splittable, lane_of, refusal};
use crate::error::CellPlace;
use crate::json::{Cell, Module, Wire};
use crate::word::{Bit, Builder, Word};
use crate::{ImportError, Options, Unknown};

/// Bits of a word, at most: what a memory word or a multiplication of that many bits comes to is still of use.
pub(crate) const MOST_BITS: usize = 4096;

/// What is written in one go: a combinational cell or a bit of it, the output of a register with an asynchronous control,
/// or a read port of a memory.
#[derive(Clone, Debug)]
pub(crate) struct Node<'a> {
    pub(crate) name: &'a str,
    pub(crate) cell: &'a Cell,
    pub(crate) part: Part,
}

/// Which part of a cell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Part {
    /// All of a combinational cell.
    Whole,
    /// One bit of the result of a cell that can be taken apart.
    Lane(usize),
    /// The output of a register that an asynchronous control can change.
    Output,
    /// A read port of a memory.
    Port(usize),
}

/// A module that is being imported.
pub(crate) struct Design<'a> {
    pub(crate) module: &'a Module,
    pub(crate) options: &'a Options,
    pub(crate) builder: Builder,
    /// What each numbered net is.
    pub(crate) values: HashMap<u32, Bit>,
    /// Registers with an asynchronous control, by the name of the cell.
    pub(crate) states: HashMap<String, Word>,
    /// Memories, by the name of the cell.
    pub(crate) memory: HashMap<String, crate::memory::Parts>,
    /// The public name of a numbered net, with its bit, for messages.
    names: HashMap<u32, String>,
    /// The file of the last source.
    file: Arc<str>,
    /// Unknown bits so far.
    unknown: u64,
    /// What the user should know.
    pub(crate) notes: Vec<String>,
}

impl<'a> Design<'a> {
    pub(crate) fn new(module: &'a Module, options: &'a Options, builder: Builder) -> Design<'a> {
        let mut names = HashMap::new();
        let public = module.netnames.iter().filter(|(_, name)| !name.is_hidden());
        // The shortest name is the one of the outermost scope.
        let mut public: Vec<_> = public.collect();
        public.sort_by_key(|(name, _)| (name.matches('.').count(), name.len(), *name));
        for (name, of) in public {
            for (bit, wire) in of.bits.iter().enumerate() {
                if let Wire::Net(net) = wire {
                    let shown = || if of.bits.len() == 1 { name.clone() } else { format!("{name}[{bit}]") };
                    names.entry(*net).or_insert_with(shown);
                }
            }
        }
        Design {
            module,
            options,
            builder,
            values: HashMap::new(),
            states: HashMap::new(),
            memory: HashMap::new(),
            names,
            file: Arc::from(""),
            unknown: 0,
            notes: Vec::new(),
        }
    }

    /// Name of a numbered net for people.
    pub(crate) fn net_name(&self, net: u32) -> String {
        self.names.get(&net).cloned().unwrap_or_else(|| format!("net {net}"))
    }

    /// A cell for people.
    pub(crate) fn place(&self, name: &str, cell: &Cell) -> CellPlace {
        let output = ["Y", "Q", "RD_DATA"].iter().find_map(|pin| cell.pin(pin).first());
        let driven = match output {
            Some(Wire::Net(net)) => self.names.get(net).map(|name| name.split('[').next().unwrap_or(name).to_owned()),
            _ => None,
        };
        CellPlace { kind: cell.kind.clone(), name: driven.unwrap_or_else(|| name.to_owned()), source: cell.line() }
    }

    /// What is wrong with a cell.
    pub(crate) fn wrong(&self, name: &str, cell: &Cell, why: String) -> ImportError {
        ImportError::Cell { cell: self.place(name, cell), why }
    }

    /// The cells that follow are of the line of this cell.
    pub(crate) fn at(&mut self, cell: &Cell) {
        self.builder.source = cell.place().map(|place| {
            if *self.file != *place.file {
                self.file = place.file.as_str().into();
            }
            Source::File { file: Arc::clone(&self.file), line: place.line, column: place.column }
        });
    }

    /// What an unknown bit is taken for.
    pub(crate) fn unknown(&mut self) -> bool {
        self.unknown += 1;
        match self.options.unknown {
            Unknown::Zero => false,
            Unknown::One => true,
            Unknown::Random(seed) => {
                // The finaliser of MurmurHash3: each bit of the count decides about half of the results.
                let mut x = self.unknown ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
                x = (x ^ x >> 33).wrapping_mul(0xff51_afd7_ed55_8ccd);
                x = (x ^ x >> 33).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
                (x ^ x >> 33) & 1 == 1
            }
        }
    }

    /// A digit of a constant.
    pub(crate) fn digit(&mut self, digit: char) -> bool {
        match digit {
            '0' => false,
            '1' => true,
            _ => self.unknown(),
        }
    }

    /// What is on these wires, as a word. A net that nothing drives is unknown.
    pub(crate) fn word(&mut self, wires: &[Wire]) -> Word {
        let bits: Vec<Bit> = wires
            .iter()
            .map(|wire| match wire {
                Wire::Constant(text) => Bit::Constant(self.digit(text.chars().next().unwrap_or('x'))),
                Wire::Net(net) => self.values.get(net).copied().unwrap_or_else(|| {
                    let bit = Bit::Constant(self.unknown());
                    let name = self.net_name(*net);
                    self.notes.push(format!("'{name}' is driven by nothing: it is taken for {}", shown(bit)));
                    self.values.insert(*net, bit);
                    bit
                }),
            })
            .collect();
        self.builder.assemble(&bits)
    }

    /// A flag as a word with zeros above it.
    pub(crate) fn flag_word(&mut self, flag: Net, bits: u32) -> Word {
        self.builder.fit(&Word { parts: vec![flag], width: 1 }, bits, false)
    }

    /// Says what a pin drives.
    pub(crate) fn drive(&mut self, wires: &[Wire], word: &Word) {
        for (wire, bit) in wires.iter().zip(word.bits()) {
            if let Wire::Net(net) = wire {
                self.values.insert(*net, bit);
            }
        }
    }

    /// Every cell in parts, or the first that cannot be imported.
    pub(crate) fn nodes(&self) -> Result<Vec<Node<'a>>, ImportError> {
        let mut nodes = Vec::new();
        for (name, cell) in &self.module.cells {
            let kind = cell.kind.as_str();
            let widest =
                cell.connections.iter().filter(|(pin, _)| !pin.contains('_')).map(|(_, wires)| wires.len()).max();
            if let Some(bits) = widest.filter(|bits| *bits > MOST_BITS && kind != "$pmux" && kind != "$bmux") {
                return Err(ImportError::TooWide { what: self.place(name, cell).to_string(), bits, most: MOST_BITS });
            }
            let node = |part| Node { name, cell, part };
            if is_register(kind) {
                if is_asynchronous(cell) {
                    nodes.push(node(Part::Output));
                }
            } else if kind == "$mem_v2" {
                let ports = cell.number("RD_PORTS").and_then(|ports| usize::try_from(ports).ok()).unwrap_or(0);
                nodes.extend((0..ports).map(|port| node(Part::Port(port))));
            } else if is_remark(kind) || is_property(kind) {
                // Properties are read at the end, from words that are all there.
            } else if cell.pin("Y").is_empty() {
                return Err(self.wrong(name, cell, refusal(kind)));
            } else {
                nodes.push(node(Part::Whole));
            }
        }
        Ok(nodes)
    }

    /// The nodes in an order in which each comes after what it reads.
    pub(crate) fn ordered(&self, mut nodes: Vec<Node<'a>>) -> Result<Vec<Node<'a>>, ImportError> {
        loop {
            let (order, left) = self.levelled(&nodes)?;
            if left.is_empty() {
                return Ok(order.into_iter().map(|index| nodes[index].clone()).collect());
            }
            // A word may depend on itself where none of its bits does; arithmetic is taken apart only where nothing else is.
            let looped = self.looped(&nodes, &left)?;
            let splits = |node: &Node<'_>, sums: bool| {
                let kind = node.cell.kind.as_str();
                let fits = if sums { is_splittable(kind) } else { is_bitwise(kind) };
                node.part == Part::Whole && fits && node.cell.pin("Y").len() > 1
            };
            let any = |sums: bool| looped.iter().any(|&index| splits(&nodes[index], sums));
            if !any(true) {
                return Err(self.loop_through(&nodes, &looped));
            }
            let sums = !any(false);
            let mut in_loop = vec![false; nodes.len()];
            looped.iter().for_each(|&index| in_loop[index] = true);
            nodes = nodes
                .into_iter()
                .zip(in_loop)
                .flat_map(|(node, looped)| {
                    let lanes = if looped && splits(&node, sums) { node.cell.pin("Y").len() } else { 0 };
                    let single = (lanes == 0).then(|| node.clone());
                    single
                        .into_iter()
                        .chain((0..lanes).map(move |lane| Node { part: Part::Lane(lane), ..node.clone() }))
                })
                .collect();
        }
    }

    /// Indices of nodes in order, and those that are in a loop or after one.
    fn levelled(&self, nodes: &[Node<'a>]) -> Result<(Vec<usize>, Vec<usize>), ImportError> {
        let drivers = self.drivers(nodes)?;
        let mut waiting = vec![0usize; nodes.len()];
        let mut readers: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            let mut from: Vec<usize> = node.inputs().iter().filter_map(|wire| driver(&drivers, wire)).collect();
            from.sort_unstable();
            from.dedup();
            waiting[index] = from.len();
            from.into_iter().for_each(|from| readers[from].push(index));
        }
        let mut order: Vec<usize> = (0..nodes.len()).filter(|&index| waiting[index] == 0).collect();
        let mut at = 0;
        while at < order.len() {
            for &reader in &readers[order[at]] {
                waiting[reader] -= 1;
                if waiting[reader] == 0 {
                    order.push(reader);
                }
            }
            at += 1;
        }
        let left = (0..nodes.len()).filter(|&index| waiting[index] > 0).collect();
        Ok((order, left))
    }

    /// Of nodes in loops or after them, those that are in loops or between them.
    fn looped(&self, nodes: &[Node<'a>], left: &[usize]) -> Result<Vec<usize>, ImportError> {
        let drivers = self.drivers(nodes)?;
        let mut among = vec![false; nodes.len()];
        left.iter().for_each(|&index| among[index] = true);
        let from = |index: usize| {
            let mut from: Vec<usize> = nodes[index].inputs().iter().filter_map(|wire| driver(&drivers, wire)).collect();
            from.sort_unstable();
            from.dedup();
            from
        };
        // How many of them read each.
        let mut readers = vec![0usize; nodes.len()];
        left.iter().flat_map(|&index| from(index)).for_each(|index| readers[index] += 1);
        let mut ends: Vec<usize> = left.iter().copied().filter(|&index| readers[index] == 0).collect();
        while let Some(end) = ends.pop() {
            among[end] = false;
            for before in from(end).into_iter().filter(|&before| among[before]) {
                readers[before] -= 1;
                if readers[before] == 0 {
                    ends.push(before);
                }
            }
        }
        Ok(left.iter().copied().filter(|&index| among[index]).collect())
    }

    fn drivers(&self, nodes: &[Node<'a>]) -> Result<HashMap<u32, usize>, ImportError> {
        let mut drivers: HashMap<u32, usize> = HashMap::new();
        for (index, node) in nodes.iter().enumerate() {
            for wire in node.outputs() {
                let Wire::Net(net) = wire else { continue };
                let own = self.place(node.name, node.cell).to_string();
                if self.values.contains_key(net) {
                    let first = "an input or a register".to_owned();
                    return Err(ImportError::TwoDrivers { net: self.net_name(*net), first, second: own });
                }
                if let Some(other) = drivers.insert(*net, index) {
                    let first = self.place(nodes[other].name, nodes[other].cell).to_string();
                    return Err(ImportError::TwoDrivers { net: self.net_name(*net), first, second: own });
                }
            }
        }
        Ok(drivers)
    }

    /// The cells of one loop among nodes that are in loops or after them.
    fn loop_through(&self, nodes: &[Node<'a>], left: &[usize]) -> ImportError {
        let drivers = self.drivers(nodes).unwrap_or_default();
        let before = |index: usize| {
            nodes[index].inputs().iter().filter_map(|wire| driver(&drivers, wire)).find(|from| left.contains(from))
        };
        let mut path: Vec<usize> = left.first().copied().into_iter().collect();
        while let Some(from) = path.last().and_then(|&last| before(last)) {
            if let Some(begin) = path.iter().position(|&index| index == from) {
                path.drain(..begin);
                break;
            }
            path.push(from);
        }
        path.reverse();
        ImportError::Loop {
            cells: path.iter().map(|&index| self.place(nodes[index].name, nodes[index].cell)).collect(),
        }
    }
}

fn driver(drivers: &HashMap<u32, usize>, wire: &Wire) -> Option<usize> {
    match wire {
        Wire::Net(net) => drivers.get(net).copied(),
        Wire::Constant(_) => None,
    }
}

fn shown(bit: Bit) -> char {
    if bit == Bit::Constant(true) { '1' } else { '0' }
}

/// A register whose output changes without an edge.
pub(crate) fn is_asynchronous(cell: &Cell) -> bool {
    matches!(cell.kind.as_str(), "$adff" | "$adffe" | "$aldff" | "$aldffe" | "$dffsr" | "$dffsre")
}

/// Cells that claim something of a run.
pub(crate) fn is_property(kind: &str) -> bool {
    matches!(kind, "$assert" | "$assume" | "$cover" | "$check" | "$live" | "$fair")
}

impl<'a> Node<'a> {
    /// What it reads in the sample in which it is read itself.
    fn inputs(&self) -> Vec<&'a Wire> {
        let cell = self.cell;
        let pins = |names: &[&str]| names.iter().flat_map(|name| cell.pin(name)).collect::<Vec<_>>();
        match self.part {
            Part::Whole => {
                cell.connections.iter().filter(|(pin, _)| *pin != "Y").flat_map(|(_, wires)| wires).collect()
            }
            Part::Lane(lane) => {
                let width = cell.pin("Y").len().max(1);
                let of_pin = |pin: &'static str| -> Vec<&'a Wire> {
                    let wires = cell.pin(pin);
                    match (cell.kind.as_str(), pin) {
                        ("$pmux", "B") => wires.iter().skip(lane).step_by(width).collect(),
                        ("$mux" | "$pmux", "S") | ("$shl" | "$sshl" | "$shr" | "$sshr", "B") => wires.iter().collect(),
                        (kind, _) => wires.get(lane_of(kind, lane, wires.len())).into_iter().flatten().collect(),
                    }
                };
                ["A", "B", "S"].into_iter().flat_map(of_pin).collect()
            }
            Part::Output => pins(&["ARST", "ALOAD", "AD", "SET", "CLR"]),
            Part::Port(port) => {
                let bits = cell.bits("RD_CLK_ENABLE");
                if bits.get(port) == Some(&'1') {
                    cell.pin("RD_ARST").get(port).into_iter().collect()
                } else {
                    crate::memory::of_port(cell.pin("RD_ADDR"), cell.number("ABITS"), port).iter().collect()
                }
            }
        }
    }

    /// What it drives.
    pub(crate) fn outputs(&self) -> &'a [Wire] {
        let cell = self.cell;
        match self.part {
            Part::Whole => cell.pin("Y"),
            Part::Lane(lane) => &cell.pin("Y")[lane..=lane],
            Part::Output => cell.pin("Q"),
            Part::Port(port) => crate::memory::of_port(cell.pin("RD_DATA"), cell.number("WIDTH"), port),
        }
    }
}
