//! A netlist as the block diagram that an engineer would draw, in SVG: scopes are nested boxes, registers and multiplexers
//! have a row for each value that they take, adders and comparators are signs in a circle, and data flows from left to
//! right.
//!
//! What a textbook does not draw is folded: slices, constants and small logic are written where they are read, overflow
//! flags mark the adder that raises them, and a net that many symbols read is written there by its name. Widths are at the
//! beginning of each wire; wires of more than one bit are thick.
//!
//! ```
//! use stepwave_netlist::dsl::Module;
//!
//! let module = Module::new("counter");
//! let m = module.top();
//! let enable = m.input("enable", 1);
//! let count = m.reg("count", 4);
//! count.when(enable, count.q.wrapping_add(m.lit(4, 1))).else_hold();
//! let outputs = [count.q.net()];
//!
//! let netlist = module.finish().unwrap();
//! let drawn = stepwave_schematic::draw(&netlist, &outputs, &stepwave_schematic::Part::default()).unwrap();
//! assert!(drawn.svg.contains(">+ 1<"));
//! ```

mod closed;
mod draft;
mod figure;
mod fold;
mod formula;
mod group;
mod layout;
mod places;
mod scene;
mod svg;
mod symbol;

use std::collections::VecDeque;

use stepwave_netlist::cells::ScopeId;
use stepwave_netlist::{Net, Netlist, did_you_mean};

/// Symbols that a drawing has at most where its depth is not given.
pub const MOST_SYMBOLS: usize = 135;
/// The same where groups are drawn for want of scopes.
const MOST_GROUPED: usize = 40;
/// Symbols that a drawing has at most.
pub const MOST_DRAWN: usize = 4000;

/// Scopes that a message names.
const MOST_LISTED: usize = 12;

/// What of a netlist is drawn.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Dotted path of the scope that is drawn; all where there is none.
    pub scope: Option<String>,
    /// Levels of scopes whose inside is drawn, 0 for boxes alone; as many as are readable where it is not given.
    pub depth: Option<usize>,
    /// Symbols that there may be, where fewer than [`MOST_DRAWN`].
    pub most: Option<usize>,
}

/// A drawing.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The file.
    pub svg: String,
    /// Dotted path of the scope that is drawn, beginning with the name of the netlist.
    pub scope: String,
    /// Levels of scopes whose inside is drawn.
    pub depth: usize,
    /// Levels of scopes that there are.
    pub levels: usize,
    /// Symbols, closed scopes among them.
    pub symbols: usize,
    /// Dotted paths, without the name of the netlist, of the scopes that are closed.
    pub scopes: Vec<String>,
    /// Nets from or to closed groups that have no wire.
    pub unwired: usize,
}

/// Why nothing is drawn.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum DrawError {
    /// No scope has this path.
    #[error("no scope is called '{path}'{hint}")]
    NoScope {
        /// The path.
        path: String,
        /// What may have been meant, or which scopes there are.
        hint: String,
    },
    /// There is nothing to draw: names alone, of nets that are drawn elsewhere.
    #[error("{scope} has no symbol in its block diagram: what it names, if anything, is drawn in other scopes")]
    Empty {
        /// What would be drawn.
        scope: String,
    },
    /// There would be too many symbols.
    #[error(
        "{scope} has {symbols} symbols in its block diagram, and {most} are the most: {}",
        if scopes.is_empty() {
            "it has no scopes or groups of which one could be drawn alone".to_owned()
        } else {
            format!("draw one scope alone, as `stepwave export` does with --schematic FILE --scope PATH, of {}", listed(scopes))
        }
    )]
    TooMany {
        /// What would be drawn.
        scope: String,
        /// Its symbols.
        symbols: usize,
        /// Symbols that there may be.
        most: usize,
        /// Paths of scopes in it.
        scopes: Vec<String>,
    },
}

impl Drawing {
    /// What is not shown, and how it is, where scopes are closed.
    #[must_use]
    pub fn closed(&self) -> Option<String> {
        let Drawing { depth, levels, unwired, .. } = self;
        (depth < levels).then(|| {
            let more = depth + 1;
            let names = listed(&self.scopes);
            let wires = match unwired {
                0 => String::new(),
                1 => "; 1 net of a closed group has no wire, and is named in its box".to_owned(),
                _ => format!("; {unwired} nets of closed groups have no wire, and are named in their boxes"),
            };
            format!("scopes {depth} of {levels} levels deep: --levels {more} opens more of them, --scope PATH draws one of {names} alone{wires}")
        })
    }
}

/// Draws a netlist, or a part of it, with outputs at its right.
///
/// # Errors
/// No scope has the path given, or one without symbols, or there are more symbols than [`MOST_DRAWN`].
pub fn draw(netlist: &Netlist, outputs: &[Net], part: &Part) -> Result<Drawing, DrawError> {
    with_scene(netlist, outputs, |scene, outputs, readable| {
        let root = part.scope.as_deref().map_or(Ok(ScopeId::TOP), |path| scope(scene, path))?;
        drawing(scene, outputs, root, readable, part)
    })
}

/// Draws a part of a netlist, and alone every scope that is closed in one of these drawings: the whole comes first, a scope
/// after the drawing in which it is closed. Scopes of more symbols than there may be are left out.
///
/// # Errors
/// As those of [`draw`].
pub fn draw_all(netlist: &Netlist, outputs: &[Net], part: &Part) -> Result<Vec<Drawing>, DrawError> {
    with_scene(netlist, outputs, |scene, outputs, readable| {
        let root = part.scope.as_deref().map_or(Ok(ScopeId::TOP), |path| scope(scene, path))?;
        let whole = drawing(scene, outputs, root, readable, part)?;
        let mut pending = VecDeque::from_iter(scene.closed(root, whole.depth));
        let mut all = vec![whole];
        let inner = Part { most: part.most, ..Part::default() };
        while let Some(root) = pending.pop_front() {
            if let Ok(drawn) = drawing(scene, outputs, root, readable, &inner) {
                pending.extend(scene.closed(root, drawn.depth));
                all.push(drawn);
            }
        }
        Ok(all)
    })
}

/// Puts the symbols of a netlist into scopes, for drawings of its parts; with all outputs, and how many symbols are readable.
fn with_scene<R>(netlist: &Netlist, outputs: &[Net], go: impl FnOnce(&scene::Scene<'_>, &[Net], usize) -> R) -> R {
    let own = netlist.scopes.len();
    let outputs = with_declared(netlist, outputs);
    let flat = fold::Fold::new(netlist, &outputs);
    let drafts = draft::Drafts::new(&flat);
    let mut scopes = places::Places::scopes(&flat, &drafts);
    let grouped = group::grouped(&flat, &drafts, &mut scopes);
    let fold = flat.with_scopes(grouped.as_ref().unwrap_or(netlist));
    let readable = if grouped.is_some() { MOST_GROUPED } else { MOST_SYMBOLS };
    go(&scene::Scene { fold: &fold, drafts: &drafts, scopes, own }, &outputs, readable)
}

/// Draws a scope as deep as is asked for, or readable.
fn drawing(
    scene: &scene::Scene<'_>,
    outputs: &[Net],
    root: ScopeId,
    readable: usize,
    part: &Part,
) -> Result<Drawing, DrawError> {
    let path = scene.fold.netlist.scope_path(root);
    let levels = scene.levels(root);
    let deepest = || (0..=levels).rev().find(|&depth| scene.count(root, depth) <= readable).unwrap_or(0);
    let depth = part.depth.map_or_else(deepest, |depth| depth.min(levels));
    let symbols = scene.count(root, depth);
    let most = part.most.unwrap_or(MOST_DRAWN).min(MOST_DRAWN);
    if symbols == 0 {
        return Err(DrawError::Empty { scope: path });
    }
    if symbols > most {
        return Err(DrawError::TooMany { scope: path, symbols, most, scopes: scene.inner(root, 0) });
    }
    let scopes = scene.inner(root, depth);
    let view = scene::View::new(scene, root, depth, outputs);
    let svg = svg::svg(&view.figure(), &path);
    Ok(Drawing { svg, scope: path, depth, levels, symbols, scopes, unwired: view.unwired })
}

/// Some names, with commas.
fn listed(names: &[String]) -> String {
    let more = if names.len() > MOST_LISTED { ", …" } else { "" };
    names.iter().take(MOST_LISTED).map(String::as_str).collect::<Vec<_>>().join(", ") + more
}

/// These outputs, and those that the netlist declares.
fn with_declared(netlist: &Netlist, outputs: &[Net]) -> Vec<Net> {
    let declared = netlist.names.iter().filter(|named| named.output).flat_map(|named| named.nets());
    outputs.iter().copied().chain(declared).collect()
}

/// The outputs of a netlist of which no more is known: those that it declares, or nets with a name at the top that nothing
/// reads.
#[must_use]
pub fn outputs(netlist: &Netlist) -> Vec<Net> {
    let declared = with_declared(netlist, &[]);
    if !declared.is_empty() {
        return declared;
    }
    let fold = fold::Fold::new(netlist, &[]);
    let flags: Vec<Net> = netlist.properties.iter().map(|property| property.never).collect();
    let at_top = netlist.names.iter().filter(|named| named.scope == ScopeId::TOP).flat_map(|named| named.nets());
    at_top.filter(|net| fold.is_unread(*net) && !flags.contains(net)).collect()
}

/// The scope of a path, with the name of the netlist or without.
fn scope(scene: &scene::Scene<'_>, path: &str) -> Result<ScopeId, DrawError> {
    let netlist = scene.fold.netlist;
    let all: Vec<(ScopeId, String)> =
        (0..).map(ScopeId).take(netlist.scopes.len()).map(|scope| (scope, netlist.scope_path(scope))).collect();
    let inner = |full: &str| full.split_once('.').map(|(_, inner)| inner.to_owned());
    let found = all.iter().find(|(_, full)| full == path || inner(full).as_deref() == Some(path));
    found.map(|found| found.0).ok_or_else(|| {
        let known = all.iter().filter(|(scope, _)| scene.count(*scope, 0) > 0);
        let known: Vec<String> = known.filter_map(|(_, full)| inner(full)).collect();
        let guess = did_you_mean(path, known.iter().map(String::as_str));
        let list =
            if known.is_empty() { ": it has none".to_owned() } else { format!("; there are {}", listed(&known)) };
        DrawError::NoScope { path: path.to_owned(), hint: if guess.is_empty() { list } else { guess } }
    })
}
