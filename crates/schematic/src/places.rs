//! Which scope each symbol is in: the one that it has a name in, or where its readers are.

use std::collections::HashMap;

use stepwave_netlist::Net;
use stepwave_netlist::cells::{NamedNet, ScopeId};

use crate::draft::{Drafts, Kind};
use crate::fold::Fold;

/// Finds the scope of every symbol.
pub(crate) struct Places<'p> {
    fold: &'p Fold<'p>,
    drafts: &'p Drafts,
}

impl<'p> Places<'p> {
    /// The scope of each symbol.
    pub(crate) fn scopes(fold: &'p Fold<'p>, drafts: &'p Drafts) -> Vec<ScopeId> {
        Places { fold, drafts }.found()
    }

    fn found(&self) -> Vec<ScopeId> {
        let netlist = self.fold.netlist;
        let mut named: HashMap<Net, Vec<&NamedNet>> = HashMap::new();
        for name in &netlist.names {
            name.nets().for_each(|net| named.entry(net).or_default().push(name));
        }
        let mut scopes: Vec<Option<ScopeId>> = vec![None; self.drafts.all.len()];
        for (index, draft) in self.drafts.all.iter().enumerate() {
            let of_memory = netlist.memories.get(index).map(|memory| memory.scope);
            let net = draft.outputs.first();
            scopes[index] = match (draft.kind, net) {
                (Kind::Memory, _) => of_memory,
                (Kind::Input, _) => Some(ScopeId::TOP),
                (_, Some(net)) => self.of_names(index, named.get(net).map_or(&[][..], Vec::as_slice), &named),
                (_, None) => Some(ScopeId::TOP),
            };
        }
        // What has no name is where its readers are.
        let mut readers: Vec<Vec<usize>> = vec![Vec::new(); scopes.len()];
        for (index, draft) in self.drafts.all.iter().enumerate() {
            for net in draft.rows.iter().flat_map(|row| row.nets()) {
                if let Some((driver, _)) = self.drafts.of.get(&net) {
                    readers[*driver].push(index);
                }
            }
        }
        for index in (0..scopes.len()).rev() {
            if scopes[index].is_none() {
                let of_readers = readers[index].iter().filter_map(|&reader| scopes[reader]);
                let common = of_readers.reduce(|a, b| self.common(a, b)).unwrap_or(ScopeId::TOP);
                scopes[index] = Some(
                    self.of_operands(index, &scopes)
                        .filter(|scope| self.depth(*scope) > self.depth(common))
                        .unwrap_or(common),
                );
            }
        }
        scopes.into_iter().map(|scope| scope.unwrap_or(ScopeId::TOP)).collect()
    }

    /// Of several scopes in which a net has a name, the one in which most of what drives it has one too.
    fn of_names(&self, index: usize, names: &[&NamedNet], named: &HashMap<Net, Vec<&NamedNet>>) -> Option<ScopeId> {
        let votes = |scope: ScopeId| {
            let nets = self.drafts.all[index].rows.iter().flat_map(|row| row.nets());
            nets.filter(|net| named.get(net).is_some_and(|names| names.iter().any(|name| name.scope == scope))).count()
        };
        let best = names.iter().enumerate().max_by_key(|(at, name)| (votes(name.scope), std::cmp::Reverse(*at)));
        best.map(|(_, name)| name.scope)
    }

    /// The one scope that everything a symbol reads is in, but for ports.
    fn of_operands(&self, index: usize, scopes: &[Option<ScopeId>]) -> Option<ScopeId> {
        let nets = self.drafts.all[index].rows.iter().flat_map(|row| row.nets());
        let drivers = nets.filter_map(|net| self.drafts.of.get(&net)).map(|(driver, _)| *driver);
        let mut drivers = drivers.filter(|&driver| self.drafts.all[driver].kind != Kind::Input);
        let first = scopes[drivers.next()?]?;
        drivers.all(|driver| scopes[driver] == Some(first)).then_some(first)
    }

    fn parent(&self, scope: ScopeId) -> Option<ScopeId> {
        self.fold.netlist.scopes[scope.index()].parent
    }

    fn depth(&self, scope: ScopeId) -> usize {
        std::iter::successors(Some(scope), |&scope| self.parent(scope)).count()
    }

    fn common(&self, a: ScopeId, b: ScopeId) -> ScopeId {
        let above: Vec<ScopeId> = std::iter::successors(Some(a), |&scope| self.parent(scope)).collect();
        let found = std::iter::successors(Some(b), |&scope| self.parent(scope)).find(|scope| above.contains(scope));
        found.unwrap_or(ScopeId::TOP)
    }
}
