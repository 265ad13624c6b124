//! The box of a scope whose inside is not shown: its name, what is in it, its pins, and the nets that it has without a wire.

use stepwave_netlist::Net;
use stepwave_netlist::cells::{Op, ScopeId};

use crate::draft::Kind;
use crate::figure::{Figure, Font, Shape, even, pixels, width};
use crate::scene::{Holder, View};
use crate::symbol::Context;

/// Characters of a line of names.
const LONGEST: usize = 44;
/// From one small line to the next.
const LINE: i32 = 12;

/// The box of a scope in another one, which is this many levels below the whole; with its pins at the left and at the right
/// in this order, where there is one.
pub(crate) fn closed(
    view: &View<'_>,
    child: ScopeId,
    (around, level): (ScopeId, usize),
    context: &Context<'_>,
    order: Option<[Vec<Net>; 2]>,
) -> Figure {
    let scene = view.scene;
    let within = |index: &usize| view.holder(around, level, *index) == Holder::Child(child);
    let symbols: Vec<usize> = (0..scene.drafts.all.len()).filter(within).collect();
    let drafts = || symbols.iter().map(|&symbol| &scene.drafts.all[symbol]);
    let cells: Vec<Net> = drafts().flat_map(|draft| draft.cells.iter().copied()).collect();
    let flags: Vec<String> = drafts().flat_map(|draft| draft.flags.iter().cloned()).collect();
    let label = |net: &Net| view.names.get(net).cloned().unwrap_or_default();
    let [left, right] = order.unwrap_or_else(|| sides(view.crossing(&view.wired, child, level + 1)));
    let wireless = sides(view.crossing(&view.wireless, child, level + 1));
    let lines = [("reads", &wireless[0]), ("gives", &wireless[1])];
    let notes: Vec<String> = lines.into_iter().filter_map(|(verb, nets)| note(view, verb, nets)).collect();

    let name = &scene.fold.netlist.scopes[child.index()].name;
    let memories = drafts().filter(|draft| draft.kind == Kind::Memory).count();
    let count = count(view, memories, &cells, symbols.len());
    let small = notes.iter().chain([&count]).map(|note| width(note, true)).max().unwrap_or(0);
    let longest = |nets: &[Net]| nets.iter().map(|net| width(&label(net), false)).max().unwrap_or(0);
    let pins = longest(&left) + longest(&right) + 24;
    let wide = even((width(name, false).max(small) + 16).max(pins + 16));
    let top = 40 + LINE * pixels(notes.len());
    let high = top + (16 * pixels(left.len())).max(26 * pixels(right.len()));
    let mut figure = Figure { size: [wide, high], holds: true, closed: Some(child), ..Figure::default() };
    let about = about(view, &count, &wireless);
    let path = scene.fold.netlist.scope_path(child);
    figure.shapes.push(Shape::Closed { at: [0, 0, wide, high], path, about, cells, flags });
    figure.text([8, 14], Font::Title, name.clone());
    for (text, at) in std::iter::once(count).chain(notes).zip(0..) {
        figure.text([8, 26 + LINE * at], Font::Small, text);
    }
    for (at, &net) in left.iter().enumerate() {
        let y = top + 16 * pixels(at);
        figure.text([8, y + 4], Font::Text, label(&net));
        figure.left.push((net, y));
    }
    for (at, &net) in right.iter().enumerate() {
        let (y, text) = (top + 26 * pixels(at), label(&net));
        figure.text([wide - 8 - width(&text, false), y + 4], Font::Text, text);
        context.stub(&mut figure, net, y, wide);
    }
    figure.reached()
}

/// Nets that enter, and nets that leave.
fn sides(crossing: Vec<(Net, bool)>) -> [Vec<Net>; 2] {
    let (enter, leave): (Vec<_>, Vec<_>) = crossing.into_iter().partition(|crossing| crossing.1);
    [enter, leave].map(|nets| nets.into_iter().map(|(net, _)| net).collect())
}

/// What is in a scope.
fn count(view: &View<'_>, memories: usize, cells: &[Net], symbols: usize) -> String {
    let of = |count: usize, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
    let netlist = view.scene.fold.netlist;
    let registers = cells.iter().filter(|&&net| matches!(netlist.cell(net).op, Op::Register { .. })).count();
    let held = if memories == 0 { String::new() } else { of(memories, "memory, ", "memories, ") };
    held + &format!("{}, {}", of(registers, "register", "registers"), of(symbols, "symbol", "symbols"))
}

/// The nets without a wire as a line of the box: the widest of them, and how many more there are.
fn note(view: &View<'_>, verb: &str, nets: &[Net]) -> Option<String> {
    let mut nets: Vec<Net> = nets.to_vec();
    nets.sort_by_key(|&net| (std::cmp::Reverse(view.scene.fold.width(net)), net));
    let names: Vec<&String> = nets.iter().filter_map(|net| view.names.get(net)).collect();
    let mut text = String::new();
    let mut shown = 0;
    for name in names {
        let next = if text.is_empty() { name.clone() } else { format!("{text}, {name}") };
        if !text.is_empty() && next.chars().count() > LONGEST {
            break;
        }
        (text, shown) = (next, shown + 1);
    }
    match (shown, nets.len() - shown) {
        (0, 0) => None,
        (0, 1) => Some(format!("{verb} 1 net without a name")),
        (0, more) => Some(format!("{verb} {more} nets without names")),
        (_, 0) => Some(format!("{verb} {text}")),
        (_, more) => Some(format!("{verb} {text} and {more} more")),
    }
}

/// All of it, for a reader who points at the box.
fn about(view: &View<'_>, count: &str, wireless: &[Vec<Net>; 2]) -> String {
    let name = |net: &Net| view.names.get(net).cloned().unwrap_or_else(|| format!("net {}", net.index()));
    let list = |nets: &[Net]| nets.iter().map(name).collect::<Vec<_>>().join(", ");
    let mut about = count.to_owned();
    for (verb, nets) in [("reads", &wireless[0]), ("gives", &wireless[1])] {
        if !nets.is_empty() {
            about += &format!("\n{verb} without a wire: {}", list(nets));
        }
    }
    about
}
