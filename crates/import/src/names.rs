//! Names: scopes out of dots, words of the wave's alphabet, ports first and then in the order of the source.

use std::collections::HashMap;

use stepwave_netlist::cells::{Format, NamedNet, ScopeData, ScopeId};

use crate::design::Design;
use crate::json::{Name, Wire};

/// What a wave takes as a name: everything else becomes `_`.
pub(crate) fn cleaned(name: &str) -> String {
    let name = name.trim_start_matches('\\').trim();
    let mut clean: String = name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' }).collect();
    if clean.is_empty() || clean.starts_with(|c: char| c.is_ascii_digit()) {
        clean.insert(0, '_');
    }
    clean
}

/// Scopes and names that are taken.
#[derive(Debug)]
pub(crate) struct Scopes {
    ids: HashMap<(ScopeId, String), ScopeId>,
    taken: HashMap<(ScopeId, String), ()>,
}

impl Scopes {
    pub(crate) fn new() -> Scopes {
        Scopes { ids: HashMap::new(), taken: HashMap::new() }
    }

    /// The name itself, or with the first number that makes it new in the scope.
    pub(crate) fn fresh(&mut self, scope: ScopeId, name: &str) -> String {
        let numbered = std::iter::once(name.to_owned()).chain((2u32..).map(|number| format!("{name}_{number}")));
        let mut free = numbered.filter(|name| !self.taken.contains_key(&(scope, name.clone())));
        let name = free.next().unwrap_or_default();
        self.taken.insert((scope, name.clone()), ());
        name
    }

    fn scope(&mut self, scopes: &mut Vec<ScopeData>, parent: ScopeId, name: &str) -> ScopeId {
        if let Some(&id) = self.ids.get(&(parent, name.to_owned())) {
            return id;
        }
        let id = ScopeId(u32::try_from(scopes.len()).unwrap_or(u32::MAX));
        let own = self.fresh(parent, &cleaned(name));
        scopes.push(ScopeData { parent: Some(parent), name: own });
        self.ids.insert((parent, name.to_owned()), id);
        id
    }

    /// The scope and the name of its own for a dotted name.
    pub(crate) fn place(&mut self, scopes: &mut Vec<ScopeData>, name: &str) -> (ScopeId, String) {
        let parts: Vec<&str> = name.split('.').filter(|part| !part.is_empty()).collect();
        let (leaf, outer) = parts.split_last().map_or((name, &[][..]), |(leaf, outer)| (*leaf, outer));
        let scope = outer.iter().fold(ScopeId::TOP, |scope, name| self.scope(scopes, scope, name));
        let own = self.fresh(scope, &cleaned(leaf));
        (scope, own)
    }
}

impl Design<'_> {
    /// Gives every public net its name. The clock has none: it is the clock of the wave.
    pub(crate) fn name_nets(&mut self, scopes: &mut Scopes, clock: Option<u32>) {
        let module = self.module;
        let is_clock = |name: &Name| clock.is_some_and(|net| name.bits == [Wire::Net(net)]);
        let mut names: Vec<(&String, &Name)> =
            module.netnames.iter().filter(|(_, name)| !name.is_hidden() && !is_clock(name)).collect();
        let rank = |name: &str| match module.ports.get(name).map(|port| port.direction.as_str()) {
            Some("input") => 0,
            Some(_) => 1,
            None => 2 + name.matches('.').count(),
        };
        let outer = |name: &str| name.rsplit_once('.').map(|(outer, _)| outer.to_owned());
        names
            .sort_by_cached_key(|(name, of)| (rank(name).min(2), outer(name), rank(name), of.place(), (*name).clone()));
        for (name, of) in names {
            if of.bits.is_empty() {
                continue;
            }
            if clock.is_some_and(|net| of.bits.contains(&Wire::Net(net))) {
                self.notes.push(format!("'{name}' has the clock among its bits: it is not shown"));
                continue;
            }
            let word = self.word(&of.bits);
            let (scope, own) = scopes.place(&mut self.builder.netlist.scopes, name);
            let format = if of.is_signed() { Format::Signed } else { Format::Unsigned };
            if let Some((&net, above)) = word.parts.split_first() {
                let above = above.to_vec();
                let output = rank(name) == 1;
                self.builder.netlist.names.push(NamedNet { net, above, scope, name: own, format, output });
            }
        }
    }
}
