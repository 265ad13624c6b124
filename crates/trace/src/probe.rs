//! Which nets a wave shows: every name of a design, narrowed by patterns and depth.

use std::collections::{HashMap, HashSet};

use crate::pattern::{Glob, fits, glob};
use stepwave_netlist::cells::{Format, Net, Op};
use stepwave_netlist::did_you_mean;
use stepwave_netlist::{Design, Netlist};

/// What kind of thing drives a shown net.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// A clocked register.
    Register,
    /// An input, set by the test bench.
    Input,
    /// A combinational net.
    Wire,
    /// A combinational net that must never be 1: the flag of a property.
    Flag,
    /// A constant.
    Constant,
}

/// One name in a wave.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Probe {
    /// Scopes from the top inwards.
    pub scopes: Vec<String>,
    /// Its own name.
    pub name: String,
    /// Number of bits.
    pub width: u32,
    /// How to show it.
    pub format: Format,
    /// What drives it.
    pub role: Role,
    /// Columns of its nets in the rows that the wave is written from: of a word of more than 64 bits, the lowest 64 first.
    pub columns: Vec<usize>,
}

impl Probe {
    /// Dotted path, beginning with the design's name.
    #[must_use]
    pub fn path(&self) -> String {
        format!("{}.{}", self.scopes.join("."), self.name)
    }
}

/// A pattern for names that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum PatternError {
    /// The glob has a syntax error.
    #[error("invalid name pattern '{0}' ({1}): use * and ? as in a shell, such as 'jr*' or 'dda_line.x.*'")]
    Syntax(String, String),
    /// A pattern that is to keep signals keeps none.
    #[error("no signal is called '{pattern}'{hint}; `stepwave list` names the registers")]
    Unused {
        /// The pattern.
        pattern: String,
        /// The name that was perhaps meant.
        hint: String,
    },
    /// Nothing is left to show.
    #[error("no signal is left to trace: {patterns}; `stepwave list` names the registers")]
    NothingLeft {
        /// The patterns given.
        patterns: String,
    },
}

/// Narrows the names of a design. The default keeps all.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    include: Vec<Glob>,
    exclude: Vec<Glob>,
    depth: Option<usize>,
}

fn matchers(patterns: &[String]) -> Result<Vec<Glob>, PatternError> {
    let compile = |pattern: &String| glob(pattern).map_err(|reason| PatternError::Syntax(pattern.clone(), reason));
    patterns.iter().map(compile).collect()
}

fn matches(glob: &Glob, scopes: &[String], name: &str) -> bool {
    fits(glob, &format!("{}.{name}", scopes.join(".")))
}

impl Selection {
    /// Keeps the names that match one of `include` (all, if it is empty) and none of `exclude`, in at most `depth`
    /// levels of scopes (1 is the top scope alone). A pattern is compared with the leaf name, the dotted path, and the
    /// path without the design's name.
    ///
    /// # Errors
    /// A pattern has a syntax error.
    pub fn new(include: &[String], exclude: &[String], depth: Option<usize>) -> Result<Selection, PatternError> {
        Ok(Selection { include: matchers(include)?, exclude: matchers(exclude)?, depth })
    }

    fn keeps(&self, scopes: &[String], name: &str) -> bool {
        let any = |globs: &[Glob]| globs.iter().any(|glob| matches(glob, scopes, name));
        (self.include.is_empty() || any(&self.include))
            && !any(&self.exclude)
            && self.depth.is_none_or(|depth| scopes.len() <= depth)
    }

    /// The names kept, in the order of the hierarchy: a scope's own names first, then its inner scopes. `columns` gives
    /// the column of each net; a net that is not among them is left out.
    ///
    /// # Errors
    /// Nothing is left, or a pattern that is to keep signals fits none.
    pub fn probes(&self, design: &Design, columns: &[Net]) -> Result<Vec<Probe>, PatternError> {
        let netlist = design.netlist();
        let column_of: HashMap<Net, usize> = columns.iter().enumerate().map(|(index, &net)| (net, index)).collect();
        let flags: HashSet<Net> = netlist.properties.iter().map(|property| property.never).collect();
        let mut scopes: Vec<Vec<String>> = Vec::new();
        for scope in &netlist.scopes {
            let mut path = scope.parent.map_or_else(Vec::new, |parent| scopes[parent.index()].clone());
            path.push(scope.name.clone());
            scopes.push(path);
        }
        let names = || netlist.names.iter().map(|named| (&scopes[named.scope.index()], named.name.as_str()));
        let fits = |glob: &&Glob| names().any(|(scopes, name)| matches(glob, scopes, name));
        if let Some(unused) = self.include.iter().find(|glob| !fits(glob)) {
            let pattern = unused.pattern().to_owned();
            let hint = did_you_mean(&pattern, names().map(|(_, name)| name));
            return Err(PatternError::Unused { pattern, hint });
        }
        let mut probes = Vec::new();
        for scope in depth_first(netlist) {
            for named in netlist.names.iter().filter(|named| named.scope.index() == scope) {
                let columns = named.nets().map(|net| column_of.get(&net).copied()).collect::<Option<Vec<usize>>>();
                let Some(columns) = columns else { continue };
                if !self.keeps(&scopes[scope], &named.name) {
                    continue;
                }
                let first = role(netlist.cell(named.net).op, flags.contains(&named.net));
                let alike = named.above.iter().all(|&net| role(netlist.cell(net).op, false) == first);
                probes.push(Probe {
                    scopes: scopes[scope].clone(),
                    name: named.name.clone(),
                    width: netlist.bits(named.nets()),
                    format: named.format.clone(),
                    role: if alike { first } else { Role::Wire },
                    columns,
                });
            }
        }
        if probes.is_empty() {
            let list = |word: &str, globs: &[Glob]| {
                globs.iter().map(|glob| format!("{word} '{}'", glob.pattern())).collect::<Vec<_>>()
            };
            let mut patterns = [list("keep", &self.include), list("leave out", &self.exclude)].concat();
            patterns.extend(self.depth.map(|depth| format!("depth {depth}")));
            return Err(PatternError::NothingLeft { patterns: patterns.join(", ") });
        }
        Ok(probes)
    }
}

/// The scopes in depth-first order: an inner scope comes directly after its parent's own names.
fn depth_first(netlist: &Netlist) -> Vec<usize> {
    let mut order: Vec<usize> = Vec::new();
    let mut pending = vec![0];
    while let Some(scope) = pending.pop() {
        order.push(scope);
        let inner = (0..netlist.scopes.len()).rev();
        pending.extend(inner.filter(|&i| netlist.scopes[i].parent.is_some_and(|parent| parent.index() == scope)));
    }
    order
}

fn role(op: Op, is_flag: bool) -> Role {
    match op {
        Op::Register { .. } => Role::Register,
        Op::Const(_) => Role::Constant,
        Op::Input => Role::Input,
        _ if is_flag => Role::Flag,
        _ => Role::Wire,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stepwave_netlist::dsl::Module;
    use stepwave_netlist::elaborate;

    fn names(selection: &Selection) -> Vec<String> {
        let module = Module::new("m");
        let m = module.top();
        let inner = m.scope("x");
        let jr = inner.input("jrx", 4);
        let a = m.input("a", 1);
        m.name("alias", jr);
        let columns = [jr.net(), a.net()];
        let design = elaborate(module.finish().unwrap()).unwrap();
        selection.probes(&design, &columns).unwrap().iter().map(Probe::path).collect()
    }

    #[test]
    fn names_come_scope_by_scope_and_patterns_match_leaf_path_and_inner_path() {
        assert_eq!(names(&Selection::default()), ["m.a", "m.alias", "m.x.jrx"]);
        for pattern in ["jr*", "m.x.*", "x.*"] {
            assert_eq!(names(&Selection::new(&[pattern.into()], &[], None).unwrap()), ["m.x.jrx"], "{pattern}");
        }
        assert_eq!(names(&Selection::new(&[], &["a*".into()], None).unwrap()), ["m.x.jrx"]);
        assert_eq!(names(&Selection::new(&[], &[], Some(1)).unwrap()), ["m.a", "m.alias"]);
    }

    #[test]
    fn a_bad_pattern_is_explained() {
        let error = Selection::new(&["a[".into()], &[], None).unwrap_err().to_string();
        assert!(error.starts_with("invalid name pattern 'a['"), "{error}");
    }
}
