//! Names: what everything is called in Verilog, and how it is reached from a scope.
//!
//! A scope of the design is a named generate block of one module, so names and paths stay what they are in a wave. A
//! word that Verilog reserves is escaped (`\reg `), which keeps the name too. Names that the export adds (ports of
//! inner nets, wires for unnamed nets) occur nowhere in the design.

use std::collections::HashSet;

use crate::Options;
use crate::keywords::is_keyword;
use stepwave_netlist::cells::{NamedNet, Net, Netlist, Op, ScopeId};
use stepwave_netlist::dsl::is_identifier;

/// A port of the module.
pub(crate) struct Port {
    pub(crate) net: Net,
    pub(crate) name: String,
    /// It is the net's own name in the top scope; otherwise the net is joined to it.
    pub(crate) own: bool,
    /// The word of more than 64 bits of which it is a part; `name` is then a range of it.
    pub(crate) word: Option<WordPort>,
}

/// A port of more than 64 bits.
#[derive(Clone)]
pub(crate) struct WordPort {
    /// Its entry in `Netlist::names`.
    pub(crate) entry: usize,
    pub(crate) name: String,
    /// The lowest bit of the part.
    pub(crate) low: u32,
}

/// Every name of the module.
pub(crate) struct Names {
    pub(crate) module: String,
    pub(crate) clk: String,
    pub(crate) rst: String,
    pub(crate) inputs: Vec<Port>,
    pub(crate) outputs: Vec<Port>,
    /// Of each scope, by its index.
    pub(crate) scopes: Vec<String>,
    /// Of each entry of `Netlist::names`.
    pub(crate) named: Vec<String>,
    parents: Vec<Option<ScopeId>>,
    /// Entry in `Netlist::names` of the first name of each net.
    first: Vec<Option<usize>>,
    /// The prefix of the names of unnamed nets.
    prefix: String,
    /// Names that occur in each scope.
    taken: Vec<HashSet<String>>,
    /// Of each memory, in the top scope.
    pub(super) memories: Vec<String>,
    /// The variable of loops over a memory.
    pub(super) index: String,
}

/// The name, escaped where it is reserved. An escaped name ends at a blank.
pub(crate) fn escaped(name: &str) -> String {
    if is_keyword(name) { format!("\\{name} ") } else { name.to_owned() }
}

/// The name itself if it is free, or else the first of `name_1`, `name_2` … that is; taken then.
pub(crate) fn claim(taken: &mut HashSet<String>, name: &str) -> String {
    let fit: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let fit = if is_identifier(&fit) { fit } else { format!("_{fit}") };
    let numbered = (1u64..).map(|number| format!("{fit}_{number}"));
    let free = std::iter::once(fit.clone()).chain(numbered).find(|name| !taken.contains(name)).unwrap_or(fit);
    taken.insert(free.clone());
    free
}

/// The names of words whose parts are all inputs without other names, once for every input.
fn input_words(netlist: &Netlist, first: &[Option<usize>]) -> Vec<usize> {
    let mut seen = HashSet::new();
    let part = |net: Net| matches!(netlist.cell(net).op, Op::Input) && first[net.index()].is_none();
    let words = netlist.names.iter().enumerate().filter(|(_, entry)| entry.is_wide() && entry.nets().all(part));
    words
        .filter(|(_, entry)| {
            let free = entry.nets().all(|net| !seen.contains(&net));
            seen.extend(entry.nets());
            free
        })
        .map(|(index, _)| index)
        .collect()
}

impl Names {
    pub(crate) fn new(netlist: &Netlist, options: &Options<'_>) -> Names {
        let mut taken = vec![HashSet::new(); netlist.scopes.len()];
        let mut first = vec![None; netlist.cells.len()];
        let mut named = Vec::new();
        for (index, entry) in netlist.names.iter().enumerate() {
            named.push(claim(&mut taken[entry.scope.index()], &entry.name));
            if !entry.is_wide() {
                first[entry.net.index()].get_or_insert(index);
            }
        }
        let mut scopes = vec![claim(&mut HashSet::new(), &netlist.scopes[0].name)];
        for scope in &netlist.scopes[1..] {
            let around = scope.parent.unwrap_or(ScopeId::TOP);
            scopes.push(claim(&mut taken[around.index()], &scope.name));
        }
        let mut everywhere: HashSet<String> = taken.iter().flatten().chain(&scopes).cloned().collect();
        let mut prefix = "_".to_owned();
        while everywhere.iter().any(|name| name.starts_with(&prefix)) {
            prefix.push('_');
        }
        let clk = claim(&mut everywhere, "clk");
        let rst = claim(&mut everywhere, "rst");
        let mut port = |net: Net, may_own: bool| -> Port {
            let Some(index) = first[net.index()] else {
                let name = claim(&mut everywhere, &format!("n{}", net.index()));
                return Port { net, name, own: false, word: None };
            };
            let entry = &netlist.names[index];
            if may_own && entry.scope == ScopeId::TOP {
                return Port { net, name: named[index].clone(), own: true, word: None };
            }
            let path = netlist.path(entry);
            let inner = path.split_once('.').map_or(path.as_str(), |(_, inner)| inner);
            Port { net, name: claim(&mut everywhere, inner), own: false, word: None }
        };
        let is_input = |net: Net| matches!(netlist.cell(net).op, Op::Input);
        let words = input_words(netlist, &first);
        let mut inputs: Vec<Port> = netlist
            .nets()
            .filter(|net| {
                is_input(*net) && !words.iter().any(|entry| netlist.names[*entry].nets().any(|of| of == *net))
            })
            .map(|net| port(net, true))
            .collect();
        let mut seen = HashSet::new();
        let outputs = options.outputs.iter().filter(|&&net| seen.insert(net));
        let outputs = outputs.map(|&net| port(net, !is_input(net))).collect();
        let inner = |path: &str| path.split_once('.').map_or(path, |(_, inner)| inner).to_owned();
        for entry in words {
            let of = &netlist.names[entry];
            let own = of.scope == ScopeId::TOP;
            let name = if own { named[entry].clone() } else { claim(&mut everywhere, &inner(&netlist.path(of))) };
            let name = escaped(&name);
            for (low, net) in (0u32..).step_by(NamedNet::PART as usize).zip(of.nets()) {
                let range = format!("{name}[{}:{low}]", low + netlist.width(net).get() - 1);
                inputs.push(Port { net, name: range, own, word: Some(WordPort { entry, name: name.clone(), low }) });
            }
        }
        let paths = netlist.memories.iter().map(|memory| inner(&netlist.memory_path(memory)));
        let memories = paths.map(|path| claim(&mut everywhere, &path)).collect();
        let index = claim(&mut everywhere, "i");
        let parents = netlist.scopes.iter().map(|scope| scope.parent).collect();
        let all_escaped = |names: Vec<String>| names.iter().map(|name| escaped(name)).collect();
        let mut names = Names {
            module: escaped(&scopes[0]),
            clk,
            rst,
            inputs,
            outputs,
            scopes: all_escaped(scopes),
            named: all_escaped(named),
            parents,
            first,
            prefix,
            taken,
            memories: all_escaped(memories),
            index,
        };
        for port in names.inputs.iter_mut().chain(&mut names.outputs) {
            port.name = escaped(&port.name);
        }
        names
    }

    /// The entry in `Netlist::names` by which a net is meant.
    pub(crate) fn first(&self, net: Net) -> Option<usize> {
        self.first[net.index()]
    }

    /// The entry is an input of more than 64 bits of the top scope.
    pub(super) fn is_own_port(&self, entry: usize) -> bool {
        self.inputs.iter().any(|port| port.own && port.word.as_ref().is_some_and(|word| word.entry == entry))
    }

    /// The name is a reserved word.
    pub(super) fn is_escaped(&self, entry: usize) -> bool {
        self.named[entry].starts_with('\\')
    }

    /// The name of a net that has none, or a further one.
    pub(super) fn unnamed(&self, net: Net) -> String {
        format!("{}n{}", self.prefix, net.index())
    }

    /// The name of the sum or difference with one more bit from which a carry or an overflow is taken.
    pub(super) fn wide(&self, net: Net) -> String {
        format!("{}sum{}", self.prefix, net.index())
    }

    /// A name of an inner scope is also that of something in a scope around it.
    pub(super) fn hide_others(&self) -> bool {
        let around = |scope: ScopeId| self.scope_path(scope).into_iter().filter(move |other| *other != scope);
        (0u32..)
            .map(ScopeId)
            .zip(&self.taken)
            .any(|(scope, names)| around(scope).any(|other| !self.taken[other.index()].is_disjoint(names)))
    }

    /// Scopes from the top to this one.
    fn scope_path(&self, scope: ScopeId) -> Vec<ScopeId> {
        let mut path = vec![scope];
        while let Some(parent) = path.last().and_then(|scope| self.parents[scope.index()]) {
            path.push(parent);
        }
        path.reverse();
        path
    }

    /// The innermost scope around both.
    pub(super) fn common(&self, a: ScopeId, b: ScopeId) -> ScopeId {
        let (a, b) = (self.scope_path(a), self.scope_path(b));
        a.iter().zip(&b).take_while(|(a, b)| a == b).last().map_or(ScopeId::TOP, |(scope, _)| *scope)
    }

    /// The path of an entry of `Netlist::names` from the top scope.
    pub(crate) fn path(&self, netlist: &Netlist, entry: usize) -> String {
        let scopes = &self.scope_path(netlist.names[entry].scope)[1..];
        let scopes: String = scopes.iter().map(|scope| format!("{}.", self.scopes[scope.index()])).collect();
        scopes + &self.named[entry]
    }

    /// A path to an entry of `Netlist::names` from inside a scope; `None` where a name in between hides it. It begins at the
    /// innermost scope around both, or at the top where Yosys would not find a scope that comes later in a scope.
    pub(super) fn path_from(&self, netlist: &Netlist, entry: usize, from: ScopeId) -> Option<String> {
        let target = netlist.names[entry].scope;
        let common = self.common(from, target);
        let inner = common != ScopeId::TOP && target != common;
        let starts = if inner { [ScopeId::TOP, common] } else { [common, common] };
        starts.into_iter().find_map(|start| self.path_below(netlist, entry, from, start))
    }

    /// The path to an entry from a scope around both it and the place where it is read.
    fn path_below(&self, netlist: &Netlist, entry: usize, from: ScopeId, start: ScopeId) -> Option<String> {
        let depth = self.scope_path(start).len();
        let down = &self.scope_path(netlist.names[entry].scope)[depth..];
        let path: String = down.iter().map(|scope| format!("{}.", self.scopes[scope.index()])).collect();
        let path = path + &self.named[entry];
        let head = down.first().map_or(&self.named[entry], |scope| &self.scopes[scope.index()]);
        let head = head.trim_start_matches('\\').trim_end();
        let between = &self.scope_path(from)[depth..];
        let hidden = between.iter().any(|scope| self.taken[scope.index()].contains(head));
        (!hidden).then_some(path)
    }
}
