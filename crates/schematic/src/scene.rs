//! Scopes as nested boxes: which symbol is in which scope, which nets cross its frame, and the drawing of each scope.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use stepwave_netlist::cells::ScopeId;
use stepwave_netlist::{Net, Netlist};

use crate::closed::closed;
use crate::draft::{Drafts, Kind};
use crate::figure::{Figure, Font, Shape, Style, even, width};
use crate::fold::Fold;
use crate::layout::{Item, Pin, Plan, Side, lay_out};
use crate::symbol::Context;

/// Symbols that read a net of one bit, and one of more, by a wire; a net with more readers is written at each of them by
/// its name.
const MOST_WIRES: [usize; 2] = [5, 8];
/// Nets between groups that have a wire: those of the most bits.
const MOST_BETWEEN: usize = 40;
/// Pixels between the frame of a scope and what is in it, and the height of its title.
const PADDING: i32 = 12;
const TITLE: i32 = 20;

/// Symbols in their scopes.
pub(crate) struct Scene<'n> {
    pub(crate) fold: &'n Fold<'n>,
    pub(crate) drafts: &'n Drafts,
    /// The scope of each symbol.
    pub(crate) scopes: Vec<ScopeId>,
    /// Scopes of the netlist itself: those after them are groups.
    pub(crate) own: usize,
}

/// Where a net is, seen from a scope that is drawn.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Holder {
    Symbol(usize),
    Child(ScopeId),
    Outside,
}

/// A symbol that is drawn, or the closed scope that it is in.
type Place = (usize, Option<ScopeId>);

/// A scope that is drawn as the whole, and how deep.
pub(crate) struct View<'s> {
    pub(crate) scene: &'s Scene<'s>,
    root: ScopeId,
    /// Levels of scopes that are open.
    depth: usize,
    outputs: BTreeSet<Net>,
    /// Names of output ports, by the pin that they are at.
    ports: BTreeMap<Net, Vec<String>>,
    pub(crate) names: HashMap<Net, String>,
    /// Names that nets have in a scope.
    local: HashMap<(Net, ScopeId), String>,
    pub(crate) wired: BTreeSet<Net>,
    /// Nets between symbols or closed scopes that have no wire, and are written where they are read.
    pub(crate) wireless: BTreeSet<Net>,
    /// How many of these are from or to closed groups.
    pub(crate) unwired: usize,
    /// Symbols that read each net.
    readers: BTreeMap<Net, Vec<usize>>,
}

impl Scene<'_> {
    /// Scopes from the top to this one.
    pub(crate) fn line(&self, scope: ScopeId) -> Vec<ScopeId> {
        let mut line = vec![scope];
        while let Some(parent) = line.last().and_then(|last| self.fold.netlist.scopes[last.index()].parent) {
            line.push(parent);
        }
        line.reverse();
        line
    }

    pub(crate) fn is_inside(&self, scope: ScopeId, of: ScopeId) -> bool {
        self.line(scope).contains(&of)
    }

    /// Symbols in a scope of which scopes below this many levels are closed; a closed one counts as a symbol.
    pub(crate) fn count(&self, root: ScopeId, depth: usize) -> usize {
        let above = self.line(root).len();
        let mut closed = BTreeSet::new();
        let mut count = 0;
        for (index, &scope) in self.scopes.iter().enumerate() {
            let line = self.line(scope);
            if self.drafts.all[index].is_gone() || !line.contains(&root) {
                continue;
            }
            match line.get(above + depth) {
                Some(&hidden) => drop(closed.insert(hidden)),
                None => count += 1,
            }
        }
        count + closed.len()
    }

    /// Paths, without the name of the netlist, of the scopes with symbols that are this many levels below one and
    /// one more.
    pub(crate) fn inner(&self, root: ScopeId, depth: usize) -> Vec<String> {
        let path = |scope| self.fold.netlist.scope_path(scope);
        self.closed(root, depth).filter_map(|scope| Some(path(scope).split_once('.')?.1.to_owned())).collect()
    }

    /// The scopes with symbols that are this many levels below one and one more.
    pub(crate) fn closed(&self, root: ScopeId, depth: usize) -> impl Iterator<Item = ScopeId> + use<> {
        let above = self.line(root).len();
        let drawn = (0..self.scopes.len()).filter(|&index| !self.drafts.all[index].is_gone());
        let lines = drawn.map(|index| self.line(self.scopes[index])).filter(|line| line.contains(&root));
        let closed: BTreeSet<ScopeId> = lines.filter_map(|line| line.get(above + depth).copied()).collect();
        closed.into_iter()
    }

    /// Levels of scopes with symbols below a scope.
    pub(crate) fn levels(&self, root: ScopeId) -> usize {
        let above = self.line(root).len();
        let inside = self.scopes.iter().map(|&scope| self.line(scope)).filter(|line| line.contains(&root));
        inside.map(|line| line.len() - above).max().unwrap_or(0)
    }
}

impl<'s> View<'s> {
    pub(crate) fn new(scene: &'s Scene<'s>, root: ScopeId, depth: usize, outputs: &[Net]) -> View<'s> {
        let outputs = outputs.iter().copied().collect();
        let names = names(scene);
        let ports = ports(scene);
        let mut local = HashMap::new();
        for named in scene.fold.netlist.names.iter().filter(|named| !named.is_wide()) {
            local.entry((named.net, named.scope)).or_insert_with(|| named.name.clone());
        }
        let (wired, wireless, readers) = (BTreeSet::new(), BTreeSet::new(), BTreeMap::new());
        let mut view = View { scene, root, depth, outputs, ports, names, local, wired, wireless, unwired: 0, readers };
        view.find_wires();
        view
    }

    /// The symbol in this view whose pin a net is: itself, or the one that it was merged into.
    fn pin(&self, net: Net) -> Net {
        self.scene.drafts.of.get(&net).map_or(net, |&(_, pin)| pin)
    }

    /// The closed scope that a symbol is hidden in.
    fn hidden(&self, symbol: usize) -> Option<ScopeId> {
        let above = self.scene.line(self.root).len();
        self.scene.line(self.scene.scopes[symbol]).get(above + self.depth).copied()
    }

    fn is_shown(&self, symbol: usize) -> bool {
        self.scene.is_inside(self.scene.scopes[symbol], self.root)
    }

    fn find_wires(&mut self) {
        let mut readers: BTreeMap<Net, Vec<usize>> = BTreeMap::new();
        for (index, draft) in self.scene.drafts.all.iter().enumerate() {
            for net in draft.rows.iter().flat_map(|row| row.nets()) {
                let of = readers.entry(self.pin(net)).or_default();
                if of.last() != Some(&index) {
                    of.push(index);
                }
            }
        }
        let mut between = Vec::new();
        for (&net, symbols) in &readers {
            let Some(&(driver, _)) = self.scene.drafts.of.get(&net) else { continue };
            let place = |symbol: usize| self.hidden(symbol).map_or((symbol, None), |scope| (0, Some(scope)));
            let inside: BTreeSet<_> =
                symbols.iter().filter(|&&symbol| self.is_shown(symbol)).map(|&symbol| place(symbol)).collect();
            let here = self.is_shown(driver).then(|| place(driver));
            // What stays in a closed scope needs no wire.
            let only_hidden = inside.iter().all(|place| Some(*place) == here && place.1.is_some());
            let most = MOST_WIRES[usize::from(self.scene.fold.width(net) > 1)];
            let by_name = self.names.contains_key(&net) && inside.len() > most;
            if only_hidden || inside.is_empty() {
                continue;
            }
            if by_name {
                self.wireless.insert(net);
            } else {
                self.wired.insert(net);
                if self.is_of_group(net, &inside, here) {
                    between.push((self.scene.fold.width(net), std::cmp::Reverse(inside.len()), net));
                }
            }
        }
        // As bits and all that is narrow would hide the data.
        between.sort_unstable();
        let kept = between.iter().rev().take(MOST_BETWEEN).take_while(|(bits, ..)| *bits > 1).count();
        let left_out = &between[..between.len() - kept];
        for (_, _, net) in left_out {
            self.wired.remove(net);
            self.wireless.insert(*net);
        }
        self.unwired = left_out.len();
        for &output in &self.outputs {
            let pin = self.pin(output);
            self.wired.insert(pin);
            self.wireless.remove(&pin);
        }
        self.readers = readers;
    }

    /// A net from or to closed groups that needs no wire, as it has a name that is written where a symbol reads it, or none reads it.
    fn is_of_group(&self, net: Net, readers: &BTreeSet<Place>, driver: Option<Place>) -> bool {
        let in_group = |place: &Place| place.1.is_some_and(|scope| scope.index() >= self.scene.own);
        let places = || readers.iter().chain(&driver);
        (self.names.contains_key(&net) || places().all(in_group)) && places().any(in_group)
    }

    /// The whole drawing.
    pub(crate) fn figure(&self) -> Figure {
        self.scope(self.root, 0)
    }

    /// How a net is written in a scope: by its own name alone where it is of that scope.
    fn written(&self, net: Net, scope: ScopeId) -> Option<String> {
        self.local.get(&(net, scope)).or_else(|| self.names.get(&net)).cloned()
    }

    /// Whether a symbol that is outside of the view, or of this scope, has a net of it, or reads one.
    pub(crate) fn holder(&self, scope: ScopeId, level: usize, symbol: usize) -> Holder {
        let line = self.scene.line(self.scene.scopes[symbol]);
        let above = self.scene.line(self.root).len() + level;
        if line.get(above - 1) != Some(&scope) {
            return Holder::Outside;
        }
        line.get(above).map_or(Holder::Symbol(symbol), |&child| Holder::Child(child))
    }

    fn scope(&self, scope: ScopeId, level: usize) -> Figure {
        let is_root = scope == self.root;
        let name = |net: Net| self.written(net, scope);
        let is_wired = |net: Net| self.wired.contains(&self.pin(net));
        let context = &Context { fold: self.scene.fold, name: &name, is_wired: &is_wired };
        let mut figures: BTreeMap<Holder, (Figure, Side)> = BTreeMap::new();
        for (index, draft) in self.scene.drafts.all.iter().enumerate().filter(|(_, draft)| !draft.is_gone()) {
            let holder = self.holder(scope, level, index);
            let entry = match holder {
                Holder::Outside => continue,
                _ if figures.contains_key(&holder) => continue,
                Holder::Symbol(_) if draft.kind == Kind::Input => (context.figure(draft), Side::First),
                Holder::Symbol(_) => (self.pinned(context.figure(draft)), Side::Free),
                Holder::Child(child) if level < self.depth => (self.scope(child, level + 1), Side::Free),
                Holder::Child(child) => (closed(self, child, (scope, level), context, None), Side::Free),
            };
            figures.insert(holder, entry);
        }
        let mut all: Vec<(Figure, Side)> = figures.into_values().collect();
        for (net, enters) in self.crossing(&self.wired, scope, level) {
            if is_root {
                let side = if enters { Side::First } else { Side::Last };
                all.extend(self.called(net).into_iter().map(|name| (flag(net, name, enters, context), side)));
                continue;
            }
            all.push(match enters {
                true => (Figure { right: vec![(net, 0)], ..Figure::default() }, Side::First),
                false => (Figure { left: vec![(net, 0)], ..Figure::default() }, Side::Last),
            });
        }
        let turned = |child, order| closed(self, child, (scope, level), context, Some(order));
        let figure = composed(all, context, &turned);
        if is_root { figure } else { self.framed(scope, figure) }
    }

    /// The same with nets that were merged called by the pin that they have.
    fn pinned(&self, mut figure: Figure) -> Figure {
        figure.left.iter_mut().for_each(|(net, _)| *net = self.pin(*net));
        figure
    }

    /// Of some nets those that cross the frame of a scope, and whether they enter.
    pub(crate) fn crossing(&self, nets: &BTreeSet<Net>, scope: ScopeId, level: usize) -> Vec<(Net, bool)> {
        let mut crossing = Vec::new();
        for &net in nets {
            let Some(&(driver, _)) = self.scene.drafts.of.get(&net) else { continue };
            let inside = self.holder(scope, level, driver) != Holder::Outside;
            let mut readers = self.readers.get(&net).into_iter().flatten();
            let is_read = |outside: bool| {
                move |&&reader: &&usize| (self.holder(scope, level, reader) == Holder::Outside) == outside
            };
            let is_output = self.outputs.iter().any(|&output| self.pin(output) == net);
            let leaves = is_output || readers.clone().any(|reader| is_read(true)(&reader));
            if inside && leaves {
                crossing.push((net, false));
            } else if !inside && readers.any(|reader| is_read(false)(&reader)) {
                crossing.push((net, true));
            }
        }
        crossing
    }

    /// What ports of the whole a net has: each output that it is, or one with its own name.
    fn called(&self, net: Net) -> Vec<String> {
        let is_top = self.root == ScopeId::TOP;
        let own = || self.names.get(&net).cloned().unwrap_or_else(|| format!("net {}", net.index()));
        self.ports.get(&net).filter(|_| is_top).cloned().unwrap_or_else(|| vec![own()])
    }

    /// A scope with its frame and its name.
    fn framed(&self, scope: ScopeId, inner: Figure) -> Figure {
        let name = &self.scene.fold.netlist.scopes[scope.index()].name;
        let wide = even(inner.size[0].max(width(name, false) + 2 * PADDING));
        let high = even(inner.size[1]) + TITLE + PADDING;
        let mut figure = Figure { size: [wide, high], holds: true, ..Figure::default() };
        let (cells, flags) = (Vec::new(), Vec::new());
        figure.shapes.push(Shape::Frame { at: [0, 0, wide, high], style: Style::Scope, cells, flags });
        figure.text([PADDING, 14], Font::Title, name.clone());
        figure.shapes.extend(inner.shapes.into_iter().map(|shape| shape.moved([0, TITLE])));
        // Nets end where the inner drawing does: those at the right are drawn on to the frame.
        let end = inner.size[0];
        for &(net, y) in &inner.right {
            if end < wide {
                let lines = vec![[end, y + TITLE, wide, y + TITLE]];
                let bits = self.scene.fold.width(net);
                figure.shapes.push(Shape::Wire { net, bits, lines, dots: Vec::new(), ends: Vec::new() });
            }
        }
        figure.left = inner.left.iter().map(|&(net, y)| (net, y + TITLE)).collect();
        figure.right = inner.right.iter().map(|&(net, y)| (net, y + TITLE)).collect();
        figure
    }
}

/// A port of the whole: an output, or a net from or to what is not shown.
fn flag(net: Net, name: String, enters: bool, context: &Context<'_>) -> Figure {
    let wide = even(width(&name, false) + 16);
    let mut figure = Figure { size: [wide, 24], ..Figure::default() };
    let frame = Shape::Frame { at: [0, 2, wide, 20], style: Style::Port, cells: Vec::new(), flags: Vec::new() };
    figure.shapes.push(frame);
    figure.text([8, 16], Font::Text, name);
    if enters {
        context.stub(&mut figure, net, 12, wide);
    } else {
        figure.left.push((net, 12));
    }
    figure
}

/// The box of a closed scope with its pins in another order.
type Turned<'t> = &'t dyn Fn(ScopeId, [Vec<Net>; 2]) -> Figure;

/// Figures placed and connected. Ports without a size become pins of the whole.
fn composed(all: Vec<(Figure, Side)>, context: &Context<'_>, turned: Turned<'_>) -> Figure {
    let mut nets: Vec<Net> = Vec::new();
    let mut number = |net: Net| {
        nets.iter().position(|&other| other == net).unwrap_or_else(|| {
            nets.push(net);
            nets.len() - 1
        })
    };
    let mut items = Vec::new();
    for (figure, side) in &all {
        let mut pins = |pins: &[(Net, i32)]| pins.iter().map(|&(net, y)| Pin { net: number(net), y }).collect();
        let (left, right) = (pins(&figure.left), pins(&figure.right));
        let (holds, free) = (figure.holds, figure.closed.is_some());
        items.push(Item { size: figure.size, left, right, side: *side, holds, free });
    }
    let Plan { size, at, pins, wires } = lay_out(&items);
    let mut whole = Figure { size, ..Figure::default() };
    let is_port = |figure: &Figure| figure.shapes.is_empty();
    let mut ports = Vec::new();
    for (((figure, _), place), pins) in all.into_iter().zip(at).zip(pins) {
        let order = || pins.map(|pins| pins.into_iter().map(|pin| nets[pin]).collect());
        let figure = if let Some(child) = figure.closed { turned(child, order()) } else { figure };
        if is_port(&figure) {
            // A net that enters leaves its port at the right.
            whole.left.extend(figure.right.iter().map(|&(net, y)| (net, place[1] + y)));
            whole.right.extend(figure.left.iter().map(|&(net, y)| (net, place[1] + y)));
            ports.extend(figure.left.iter().map(|_| place));
        }
        whole.shapes.extend(figure.shapes.into_iter().map(|shape| shape.moved(place)));
    }
    for wire in wires {
        let net = nets[wire.net];
        let bits = context.fold.width(net);
        let ends = wire.ends.into_iter().filter(|end| !ports.contains(end)).collect();
        whole.shapes.push(Shape::Wire { net, bits, lines: wire.lines, dots: wire.dots, ends });
    }
    whole
}

/// Output ports that the netlist declares, by the pin of each.
fn ports(scene: &Scene<'_>) -> BTreeMap<Net, Vec<String>> {
    let mut ports: BTreeMap<Net, Vec<String>> = BTreeMap::new();
    for named in scene.fold.netlist.names.iter().filter(|named| named.output) {
        for net in named.nets() {
            let pin = scene.drafts.of.get(&net).map_or(net, |&(_, pin)| pin);
            ports.entry(pin).or_default().push(scene.fold.part(named, net));
        }
    }
    ports
}

/// How each net that is drawn is written: its own name, with that of its scope where others have the same.
fn names(scene: &Scene<'_>) -> HashMap<Net, String> {
    let netlist: &Netlist = scene.fold.netlist;
    let drawn = || netlist.nets().filter(|net| scene.fold.drawn[net.index()]);
    let mut count: HashMap<&str, usize> = HashMap::new();
    for named in drawn().filter_map(|net| scene.fold.named(net)) {
        *count.entry(&named.name).or_default() += 1;
    }
    let written = |net: Net| {
        let named = scene.fold.named(net)?;
        if named.is_wide() {
            return Some((net, scene.fold.part(named, net)));
        }
        let is_unique = count.get(named.name.as_str()) == Some(&1) || named.scope == ScopeId::TOP;
        let scope = &netlist.scopes[named.scope.index()].name;
        Some((net, if is_unique { named.name.clone() } else { format!("{scope}.{}", named.name) }))
    };
    drawn().filter_map(written).collect()
}
