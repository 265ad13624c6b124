//! Which signal of one wave is which of the other.

use super::frame::Frames;
use super::{CompareError, Options};
use crate::pattern::{Glob, glob};
use crate::read::{Signal, Wave};
use std::collections::{HashMap, HashSet};
use stepwave_netlist::did_you_mean;

/// A signal under the name by which both sides are compared. One of the sides may lack it.
pub(crate) struct Pair<'w> {
    pub(crate) name: String,
    pub(crate) a: Option<&'w Signal>,
    pub(crate) b: Option<&'w Signal>,
}

/// Pairs the signals that the options select: those of A in the order of its file, then those that only B has.
pub(crate) fn pairs<'w>(frames: &Frames<'w>, options: &Options) -> Result<Vec<Pair<'w>>, CompareError> {
    let (a, b) = (frames.a.wave, frames.b.wave);
    let (names_a, names_b) = names(a, b, &options.map)?;
    let mut in_b: HashMap<&str, &'w Signal> = names_b.iter().map(String::as_str).zip(b.signals()).collect();
    let mut pairs = Vec::with_capacity(names_a.len());
    for (name, signal) in names_a.into_iter().zip(a.signals()) {
        let other = in_b.remove(name.as_str());
        pairs.push(Pair { name, a: Some(signal), b: other });
    }
    let left: Vec<bool> = names_b.iter().map(|name| in_b.contains_key(name.as_str())).collect();
    let only_b = names_b.into_iter().zip(b.signals()).zip(left).filter(|(_, left)| *left);
    pairs.extend(only_b.map(|((name, signal), _)| Pair { name, a: None, b: Some(signal) }));

    let select = globs(&options.signals)?;
    let ignore = globs(&options.ignore)?;
    pairs.retain(|pair| {
        let clock = pair.a.is_some_and(|a| frames.a.is_clock(a)) || pair.b.is_some_and(|b| frames.b.is_clock(b));
        let hit = |globs: &[Glob]| {
            let signals = || pair.a.into_iter().chain(pair.b);
            let one = |glob: &Glob| {
                glob.is_match(&pair.name) || signals().any(|s| glob.is_match(&s.path) || glob.is_match(s.leaf()))
            };
            globs.iter().any(one)
        };
        !clock && (select.is_empty() || hit(&select)) && !hit(&ignore)
    });
    if pairs.is_empty() {
        let known =
            || [a, b].into_iter().flat_map(Wave::signals).flat_map(|signal| [signal.path.as_str(), signal.leaf()]);
        let hints = options.signals.iter().map(|given| did_you_mean(given, known()));
        let hint = hints.into_iter().find(|hint| !hint.is_empty()).unwrap_or_default();
        return Err(CompareError::NothingToCompare { hint });
    }
    Ok(pairs)
}

fn globs(patterns: &[String]) -> Result<Vec<Glob>, CompareError> {
    let compile =
        |pattern: &String| glob(pattern).map_err(|reason| CompareError::BadGlob { pattern: pattern.clone(), reason });
    patterns.iter().map(compile).collect()
}

/// The names by which the signals of A and of B are compared.
fn names(a: &Wave, b: &Wave, map: &[(String, String)]) -> Result<(Vec<String>, Vec<String>), CompareError> {
    let mut names_a: Vec<String> = a.signals().iter().map(|signal| signal.path.clone()).collect();
    let mut names_b: Vec<String> = b.signals().iter().map(|signal| signal.path.clone()).collect();
    let mut used = vec![false; map.len()];
    for name in &mut names_a {
        let renamed = map.iter().enumerate().find_map(|(rule, (from, to))| Some((rule, rename(name, from, to)?)));
        if let Some((rule, new)) = renamed {
            used[rule] = true;
            *name = new;
        }
    }
    if let Some((_, (from, _))) = used.iter().zip(map).find(|(used, _)| !**used) {
        // Signals and the scopes that they are in.
        let prefixes =
            |path: &'_ str| path.match_indices('.').map(|(at, _)| at).chain([path.len()]).collect::<Vec<_>>();
        let known =
            a.signals().iter().flat_map(|signal| prefixes(&signal.path).into_iter().map(|at| &signal.path[..at]));
        return Err(CompareError::UnusedMap { from: from.clone(), hint: did_you_mean(from, known) });
    }
    let mut seen = HashSet::with_capacity(names_a.len());
    if let Some(twice) = names_a.iter().find(|name| !seen.insert(name.as_str())) {
        return Err(CompareError::MapCollision { name: twice.clone() });
    }
    if !names_b.iter().any(|name| seen.contains(name.as_str())) {
        strip(&mut names_a);
        strip(&mut names_b);
    }
    Ok((names_a, names_b))
}

/// What the rule `from=to` makes of a path: `from` is the whole path or its leading scopes; an empty one is the root.
fn rename(path: &str, from: &str, to: &str) -> Option<String> {
    if path == from {
        return Some(to.into());
    }
    let rest = if from.is_empty() { path } else { path.strip_prefix(from)?.strip_prefix('.')? };
    Some(if to.is_empty() { rest.into() } else { format!("{to}.{rest}") })
}

/// Takes off the leading scopes that all the paths share.
fn strip(paths: &mut [String]) {
    let scopes = |path: &str| path.rfind('.').map_or(0, |dot| dot + 1);
    let Some(first) = paths.first().cloned() else { return };
    let mut shared = scopes(&first);
    for path in &*paths {
        let same = first.bytes().zip(path.bytes()).take(shared).take_while(|(a, b)| a == b).count();
        let whole = first.as_bytes()[..same.min(scopes(path))].iter().rposition(|byte| *byte == b'.');
        shared = whole.map_or(0, |dot| dot + 1);
    }
    for path in paths {
        path.drain(..shared);
    }
}
