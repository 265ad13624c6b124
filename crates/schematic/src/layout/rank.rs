//! Which column each box is in, and which nets pass which columns.

use super::{Item, Side, Slot};

/// What it costs to draw a wire of combinational logic backwards, where one out of a register costs 1.
const BACKWARDS: i32 = 4;
/// Rounds in which boxes move towards what they are connected with.
const ROUNDS: usize = 8;

/// A wire from a box to another one.
#[derive(Clone, Copy, Debug)]
struct Edge {
    from: usize,
    to: usize,
}

/// The box that each net leaves.
fn drivers(items: &[Item], nets: usize) -> Vec<Option<usize>> {
    let mut drivers = vec![None; nets];
    for (index, item) in items.iter().enumerate() {
        item.right.iter().for_each(|pin| drivers[pin.net] = Some(index));
    }
    drivers
}

fn edges(items: &[Item], nets: usize) -> Vec<Edge> {
    let drivers = drivers(items, nets);
    let mut edges = Vec::new();
    for (to, item) in items.iter().enumerate() {
        edges.extend(item.left.iter().filter_map(|pin| drivers[pin.net]).map(|from| Edge { from, to }));
    }
    edges.retain(|edge| edge.from != edge.to);
    edges
}

/// The column of each box.
pub(super) fn ranks(items: &[Item], nets: usize) -> Vec<usize> {
    let edges = edges(items, nets);
    let place = sequence(items, &edges);
    let forward: Vec<Edge> = edges.into_iter().filter(|edge| place[edge.from] < place[edge.to]).collect();
    let mut by_place: Vec<usize> = (0..items.len()).collect();
    by_place.sort_by_key(|&item| place[item]);
    let (mut before, mut after) = (vec![Vec::new(); items.len()], vec![Vec::new(); items.len()]);
    for edge in &forward {
        before[edge.to].push(edge.from);
        after[edge.from].push(edge.to);
    }
    let mut ranks = vec![0; items.len()];
    let first = usize::from(items.iter().any(|item| item.side == Side::First));
    for &item in &by_place {
        let least = if items[item].side == Side::First { 0 } else { first };
        ranks[item] = before[item].iter().map(|&from| ranks[from] + 1).max().unwrap_or(0).max(least);
    }
    let last = (0..items.len()).filter(|&item| items[item].side != Side::Last).map(|item| ranks[item]).max();
    let last = last.map_or(0, |last| last + 1);
    (0..items.len()).filter(|&item| items[item].side == Side::Last).for_each(|item| ranks[item] = last);
    for round in 0..ROUNDS {
        let turn: Vec<usize> = if round % 2 == 0 { by_place.iter().rev().copied().collect() } else { by_place.clone() };
        for item in turn.into_iter().filter(|&item| items[item].side == Side::Free) {
            closer(item, &mut ranks, &before, &after, first, last);
        }
    }
    ranks
}

/// Moves a box to where its wires are shortest, between those that drive it and those that it drives.
fn closer(item: usize, ranks: &mut [usize], before: &[Vec<usize>], after: &[Vec<usize>], first: usize, last: usize) {
    let least = before[item].iter().map(|&from| ranks[from] + 1).max().unwrap_or(first);
    let Some(next) = after[item].iter().map(|&to| ranks[to]).min() else { return };
    let most = next.min(last).saturating_sub(1).max(least);
    // Its readers pull as one: a net is one wire until it forks.
    let pull = before[item].len();
    ranks[item] = if pull > 1 { least } else { most };
}

/// An order in which few wires lead backwards, wires out of registers rather than others: boxes without wires into them
/// come first, those without wires out of them last, of the others the one that drives most and is driven least.
fn sequence(items: &[Item], edges: &[Edge]) -> Vec<usize> {
    let weight = |edge: &Edge| if items[edge.from].holds { 1 } else { BACKWARDS };
    let (mut into, mut out) = (vec![0; items.len()], vec![0; items.len()]);
    let mut around = vec![Vec::new(); items.len()];
    for edge in edges {
        into[edge.to] += weight(edge);
        out[edge.from] += weight(edge);
        around[edge.from].push(*edge);
        around[edge.to].push(*edge);
    }
    let mut left: Vec<usize> = (0..items.len()).collect();
    let (mut front, mut back) = (Vec::new(), Vec::new());
    while !left.is_empty() {
        let sink = left.iter().position(|&item| out[item] == 0 && into[item] > 0 || items[item].side == Side::Last);
        let source = left.iter().position(|&item| into[item] == 0 || items[item].side == Side::First);
        let most = (0..left.len()).max_by_key(|&at| (out[left[at]] - into[left[at]], std::cmp::Reverse(left[at])));
        let (at, is_last) = match (source, sink) {
            (Some(at), _) => (at, false),
            (None, Some(at)) => (at, true),
            (None, None) => (most.unwrap_or(0), false),
        };
        let item = left.remove(at);
        if is_last {
            back.push(item)
        } else {
            front.push(item)
        }
        for edge in &around[item] {
            if edge.from == item { into[edge.to] -= weight(edge) } else { out[edge.from] -= weight(edge) }
        }
    }
    let mut place = vec![0; items.len()];
    front.into_iter().chain(back.into_iter().rev()).enumerate().for_each(|(at, item)| place[item] = at);
    place
}

/// The columns: boxes, and nets that pass them.
pub(super) fn columns(items: &[Item], nets: usize, ranks: &[usize]) -> Vec<Vec<Slot>> {
    let count = ranks.iter().max().map_or(0, |last| last + 1);
    let mut columns = vec![Vec::new(); count];
    for (index, item) in items.iter().enumerate() {
        columns[ranks[index]].push(Slot::of(index, item));
    }
    let drivers = drivers(items, nets);
    // The first and the last column in which a reader of each net is.
    let mut reach: Vec<Option<(usize, usize)>> = vec![None; nets];
    for (index, item) in items.iter().enumerate() {
        for pin in &item.left {
            let (least, most) = reach[pin.net].unwrap_or((usize::MAX, 0));
            reach[pin.net] = Some((least.min(ranks[index]), most.max(ranks[index])));
        }
    }
    for net in 0..nets {
        let (Some(driver), Some((least, most))) = (drivers[net], reach[net]) else { continue };
        let from = ranks[driver];
        let backwards = least..from + 1;
        let forwards = from + 1..most;
        // A net that leads forwards only has no lane in the column of its driver.
        for column in backwards.chain(forwards) {
            columns[column].push(Slot::pass(net));
        }
    }
    columns
}
