//! Scopes for what has none: the symbols of a flat netlist, such as a synthesiser leaves, in groups that can be closed and
//! opened as scopes can. What only one group reads is in it, names with a common beginning are together, and of the others
//! those are joined that share the most wires for their number of symbols.

use std::collections::{BTreeMap, BTreeSet};

use stepwave_netlist::cells::{ScopeData, ScopeId};
use stepwave_netlist::{Net, Netlist};

use crate::MOST_SYMBOLS;
use crate::draft::{Drafts, Kind};
use crate::fold::Fold;

/// Groups and symbols that a scope is split into at most, and symbols from which on a group is split again.
const GROUPS: usize = 16;
const MOST_IN_GROUP: usize = 60;
/// Symbols of names that begin alike, from which on they are a group.
const ALIKE: usize = 3;
/// Parts of names that are compared at most.
const MOST_PARTS: usize = 6;
/// What a wire weighs that has one reader; one with many readers weighs the less for each of them.
const WIRE: u64 = 1 << 20;

/// The netlist with a scope for each group, and the scope of each symbol; `None` where every scope can be read as it is.
pub(crate) fn grouped(fold: &Fold<'_>, drafts: &Drafts, scopes: &mut [ScopeId]) -> Option<Netlist> {
    let mut found = Groups { fold, drafts, scopes, all: fold.netlist.scopes.clone() };
    let before = found.all.len();
    for scope in (0..before).map(scope_id) {
        let own = found.own(scope);
        if own.len() > MOST_SYMBOLS {
            found.split(scope, own, 1);
        }
    }
    let all = found.all;
    (all.len() > before).then(|| Netlist { scopes: all, ..fold.netlist.clone() })
}

fn scope_id(index: usize) -> ScopeId {
    ScopeId(u32::try_from(index).unwrap_or(u32::MAX))
}

struct Groups<'g> {
    fold: &'g Fold<'g>,
    drafts: &'g Drafts,
    scopes: &'g mut [ScopeId],
    all: Vec<ScopeData>,
}

/// Symbols that are together, in order.
type Cluster = Vec<usize>;

impl Groups<'_> {
    /// Symbols in a scope itself, but inputs.
    fn own(&self, scope: ScopeId) -> Cluster {
        let is_own = |&index: &usize| {
            let draft = &self.drafts.all[index];
            self.scopes[index] == scope && !draft.is_gone() && draft.kind != Kind::Input
        };
        (0..self.drafts.all.len()).filter(is_own).collect()
    }

    /// Puts symbols of a scope into scopes of their own. Names are compared by this many of their parts.
    fn split(&mut self, scope: ScopeId, members: Cluster, parts: usize) {
        // Where all begin alike more of the names is compared, and then wires alone.
        let depths = (parts..=parts.max(MOST_PARTS)).map(Some).chain([None]);
        let mut tried = depths.map(|parts| {
            let named = parts.map_or_else(Vec::new, |parts| self.alike(&members, parts));
            (parts.unwrap_or(MOST_PARTS), self.joined(self.absorbed(&members, named)))
        });
        let several = |clusters: &[Cluster]| clusters.iter().filter(|cluster| cluster.len() > 1).count() > 1;
        let Some((parts, clusters)) = tried.find(|(_, clusters)| several(clusters)) else { return };
        drop(tried);
        // The names of scopes that are there already are not for groups.
        let mut taken: BTreeSet<String> =
            self.all.iter().filter(|other| other.parent == Some(scope)).map(|other| other.name.clone()).collect();
        for cluster in clusters.into_iter().filter(|cluster| cluster.len() > 1) {
            let base = self.title(&cluster, parts);
            let names = (1..).map(|number| if number == 1 { base.clone() } else { format!("{base}_{number}") });
            let name = names.into_iter().find(|name| taken.insert(name.clone())).unwrap_or_default();
            let child = scope_id(self.all.len());
            self.all.push(ScopeData { parent: Some(scope), name });
            cluster.iter().for_each(|&symbol| self.scopes[symbol] = child);
            if cluster.len() > MOST_IN_GROUP {
                self.split(child, cluster, parts + 1);
            }
        }
    }

    fn name(&self, symbol: usize) -> Option<&str> {
        let draft = &self.drafts.all[symbol];
        match draft.kind {
            Kind::Memory => Some(&draft.sign),
            _ => self.fold.named(*draft.outputs.first()?).map(|named| named.name.as_str()),
        }
    }

    /// The first parts of a name, where something follows them.
    fn beginning(&self, symbol: usize, parts: usize) -> Option<String> {
        let words: Vec<&str> = self.name(symbol)?.split(['.', '_', '[']).filter(|word| !word.is_empty()).collect();
        (words.len() > parts).then(|| words[..parts].join("_"))
    }

    /// Clusters of names that begin alike; a memory is with the names that begin with its own.
    fn alike(&self, members: &[usize], parts: usize) -> Vec<Cluster> {
        let mut found: BTreeMap<String, Cluster> = BTreeMap::new();
        for &symbol in members {
            let whole = self.name(symbol).map(str::to_owned);
            if let Some(beginning) = self.beginning(symbol, parts).or(whole) {
                found.entry(beginning).or_default().push(symbol);
            }
        }
        found.into_values().filter(|cluster| cluster.len() >= ALIKE).collect()
    }

    /// Every member in a cluster: what only one cluster reads is in that.
    fn absorbed(&self, members: &[usize], named: Vec<Cluster>) -> Vec<Cluster> {
        let mut cluster_of: BTreeMap<usize, usize> = BTreeMap::new();
        for (at, cluster) in named.iter().enumerate() {
            cluster.iter().for_each(|&symbol| _ = cluster_of.insert(symbol, at));
        }
        let mut count = named.len();
        let readers = self.readers();
        // What is read comes before its reader, but for registers, which are roots.
        for &symbol in members.iter().rev() {
            if cluster_of.contains_key(&symbol) {
                continue;
            }
            let is_root = matches!(self.drafts.all[symbol].kind, Kind::Register | Kind::Memory);
            let outputs = self.drafts.all[symbol].outputs.iter();
            let of_readers = outputs.flat_map(|net| readers.get(net).into_iter().flatten());
            let clusters: BTreeSet<Option<usize>> = of_readers.map(|reader| cluster_of.get(reader).copied()).collect();
            let only = (clusters.len() == 1).then(|| clusters.first().copied().flatten()).flatten();
            let own = only.filter(|_| !is_root).unwrap_or_else(|| {
                count += 1;
                count - 1
            });
            cluster_of.insert(symbol, own);
        }
        let mut clusters = vec![Cluster::new(); count];
        for &symbol in members {
            clusters[cluster_of[&symbol]].push(symbol);
        }
        clusters
    }

    /// Symbols that read each net.
    fn readers(&self) -> BTreeMap<Net, Vec<usize>> {
        let mut readers: BTreeMap<Net, Vec<usize>> = BTreeMap::new();
        for (index, draft) in self.drafts.all.iter().enumerate() {
            for net in draft.rows.iter().flat_map(|row| row.nets()) {
                let pin = self.drafts.of.get(&net).map_or(net, |&(_, pin)| pin);
                let of = readers.entry(pin).or_default();
                if of.last() != Some(&index) {
                    of.push(index);
                }
            }
        }
        readers
    }

    /// Joins clusters that share wires until few are left: in rounds, each with the one that is nearest to it.
    fn joined(&self, mut clusters: Vec<Cluster>) -> Vec<Cluster> {
        let readers = self.readers();
        while clusters.len() > GROUPS {
            let mut pairs = self.pairs(&clusters, &readers);
            if pairs.is_empty() {
                // Nothing is connected: the smallest are joined in their order.
                clusters.sort_by_key(|cluster| (cluster.len(), cluster.first().copied()));
                let first = clusters.remove(0);
                clusters[0].extend(first);
                clusters[0].sort_unstable();
                continue;
            }
            pairs.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
            let mut used = vec![false; clusters.len()];
            let mut left = clusters.len();
            for (_, [a, b]) in pairs {
                if left > GROUPS && !used[a] && !used[b] {
                    (used[a], used[b]) = (true, true);
                    let other = std::mem::take(&mut clusters[b]);
                    clusters[a].extend(other);
                    clusters[a].sort_unstable();
                    left -= 1;
                }
            }
            clusters.retain(|cluster| !cluster.is_empty());
        }
        clusters
    }

    /// Pairs of clusters with a wire between them, and how near they are: wires for each symbol of both.
    fn pairs(&self, clusters: &[Cluster], readers: &BTreeMap<Net, Vec<usize>>) -> Vec<(u64, [usize; 2])> {
        let mut cluster_of = BTreeMap::new();
        for (at, cluster) in clusters.iter().enumerate() {
            cluster.iter().for_each(|&symbol| _ = cluster_of.insert(symbol, at));
        }
        let mut shared: BTreeMap<[usize; 2], u64> = BTreeMap::new();
        for (net, symbols) in readers {
            let driver = self.drafts.of.get(net).and_then(|(driver, _)| cluster_of.get(driver));
            let Some(driver) = driver else { continue };
            let bits = if self.fold.width(*net) > 1 { 2 } else { 1 };
            for reader in symbols.iter().filter_map(|symbol| cluster_of.get(symbol)).filter(|other| *other != driver) {
                let pair = [*driver.min(reader), *driver.max(reader)];
                *shared.entry(pair).or_default() += bits * WIRE / symbols.len() as u64;
            }
        }
        let size = |at: usize| clusters[at].len() as u64;
        shared.into_iter().map(|([a, b], wires)| (wires / (size(a) * size(b)), [a, b])).collect()
    }

    /// What most of a group is called: the beginnings of names, or the widest register.
    fn title(&self, cluster: &[usize], parts: usize) -> String {
        let mut count: BTreeMap<String, usize> = BTreeMap::new();
        cluster.iter().filter_map(|&symbol| self.beginning(symbol, parts)).for_each(|name| {
            *count.entry(name).or_default() += 1;
        });
        let mut alike: Vec<(usize, String)> =
            count.into_iter().filter(|(_, count)| *count >= ALIKE).map(|(name, count)| (count, name)).collect();
        alike.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        if !alike.is_empty() {
            return alike.into_iter().take(2).map(|(_, name)| name).collect::<Vec<_>>().join("+");
        }
        let weight = |symbol: &usize| {
            let draft = &self.drafts.all[*symbol];
            let holds = matches!(draft.kind, Kind::Register | Kind::Memory);
            (holds, draft.outputs.first().map_or(0, |net| self.fold.width(*net)), std::cmp::Reverse(*symbol))
        };
        let named = cluster.iter().filter(|symbol| self.name(**symbol).is_some());
        named.max_by_key(|symbol| weight(symbol)).and_then(|symbol| self.name(*symbol)).unwrap_or("logic").to_owned()
    }
}
