//! Lines between columns: every net that has ends at both sides of a gap, or several at one, has a vertical trunk there.
//!
//! Where an end at the left and one at the right of another net are at one height, the first net's trunk is left of the
//! second's, or both would be on one line; where two nets want that of each other, one of them is cut in two, with a line
//! at a free height between.

use super::{Item, Plan, Slot, What, Wire};

/// Pixels between two trunks, and from a box to the first and the last of them.
const TRACK: i32 = 10;
const START: i32 = 8;
const END: i32 = 14;
/// Ends nearer than this are on one line.
const NEAR: i32 = 6;

/// A net in a gap between two columns: heights of its ends.
#[derive(Clone, Debug)]
struct Trunk {
    net: usize,
    left: Vec<i32>,
    right: Vec<i32>,
    /// A height at which it is joined with its other part, and whether that is at its right.
    joint: Option<(i32, bool)>,
    track: i32,
}

impl Trunk {
    fn ends(&self) -> impl Iterator<Item = i32> + '_ {
        let joint = self.joint.map(|(y, _)| y);
        self.left.iter().chain(&self.right).copied().chain(joint)
    }

    fn top(&self) -> i32 {
        self.ends().min().unwrap_or(0)
    }

    fn bottom(&self) -> i32 {
        self.ends().max().unwrap_or(0)
    }

    fn is_straight(&self) -> bool {
        self.top() == self.bottom()
    }

    /// Heights of its lines to the left and to the right.
    fn side(&self, right: bool) -> impl Iterator<Item = i32> + '_ {
        let joint = self.joint.filter(|&(_, at_right)| at_right == right).map(|(y, _)| y);
        if right { &self.right } else { &self.left }.iter().copied().chain(joint)
    }

    fn covers(&self, y: i32) -> bool {
        self.top() < y && y < self.bottom()
    }

    fn meets(&self, other: &Trunk) -> bool {
        self.top() - NEAR < other.bottom() && other.top() - NEAR < self.bottom()
    }
}

/// `a` has to be left of `b`: its line from the left and one of `b` to the right are at one height.
fn before(a: &Trunk, b: &Trunk) -> bool {
    let parts = a.net == b.net && a.joint.is_some_and(|(_, at_right)| at_right);
    parts || a.side(false).any(|y| b.side(true).any(|other| (y - other).abs() < NEAR))
}

/// Crossings where `a` is left of `b`.
fn cost(a: &Trunk, b: &Trunk) -> usize {
    a.side(true).filter(|&y| b.covers(y)).count() + b.side(false).filter(|&y| a.covers(y)).count()
}

/// The drawing of ordered columns whose heights are known.
pub(super) fn route(items: &[Item], columns: &[Vec<Slot>], nets: usize) -> Plan {
    let mut plan =
        Plan { at: vec![[0; 2]; items.len()], pins: vec![Default::default(); items.len()], ..Plan::default() };
    let mut wires: Vec<Wire> = (0..nets).map(|net| Wire { net, ..Wire::default() }).collect();
    let mut x = 0;
    for (at, column) in columns.iter().enumerate() {
        let before = at.checked_sub(1).map(|before| columns[before].as_slice());
        x = gap(before.unwrap_or_default(), column, nets, x, &mut wires);
        let width = column.iter().map(|slot| extent(items, slot)).max().unwrap_or(0);
        for slot in column {
            plan.size[1] = plan.size[1].max(slot.y + slot.height);
            match slot.what {
                What::Pass => wires[slot.left[0].net].lines.push([x, slot.y, x + width, slot.y]),
                What::Item(index) => {
                    plan.at[index] = [x, slot.y];
                    plan.pins[index] = [&slot.left, &slot.right].map(|pins| pins.iter().map(|pin| pin.net).collect());
                    let right = x + items[index].size[0];
                    for pin in slot.right.iter().filter(|_| right < x + width) {
                        wires[pin.net].lines.push([right, slot.y + pin.y, x + width, slot.y + pin.y]);
                    }
                    slot.left.iter().for_each(|pin| wires[pin.net].ends.push([x, slot.y + pin.y]));
                }
            }
        }
        x += width;
    }
    x = gap(columns.last().map_or(&[][..], Vec::as_slice), &[], nets, x, &mut wires);
    plan.size[0] = x;
    let read = |wire: &Wire| !wire.ends.is_empty();
    plan.wires = wires.into_iter().filter(read).collect();
    plan
}

fn extent(items: &[Item], slot: &Slot) -> i32 {
    match slot.what {
        What::Item(index) => items[index].size[0],
        What::Pass => 0,
    }
}

/// Routes a gap that begins at `x`; where it ends.
fn gap(left: &[Slot], right: &[Slot], nets: usize, x: i32, wires: &mut [Wire]) -> i32 {
    let mut trunks = trunks(left, right, nets);
    if trunks.is_empty() {
        return x + if left.is_empty() || right.is_empty() { 0 } else { START + END };
    }
    let order = ordered(&mut trunks);
    let tracks = tracks(&mut trunks, &order);
    let start = x + if left.is_empty() { 0 } else { START };
    let end = start + (tracks - 1).max(0) * TRACK + if right.is_empty() { START } else { END };
    let reach = [x, end];
    for at in 0..trunks.len() {
        draw(&trunks, at, start, reach, &mut wires[trunks[at].net]);
    }
    end
}

/// The nets with ends in a gap.
fn trunks(left: &[Slot], right: &[Slot], nets: usize) -> Vec<Trunk> {
    let mut all: Vec<Trunk> =
        (0..nets).map(|net| Trunk { net, left: Vec::new(), right: Vec::new(), joint: None, track: 0 }).collect();
    for slot in left {
        slot.right.iter().for_each(|pin| all[pin.net].left.push(slot.y + pin.y));
    }
    for slot in right {
        slot.left.iter().for_each(|pin| all[pin.net].right.push(slot.y + pin.y));
    }
    all.retain(|trunk| trunk.left.len() + trunk.right.len() > 1);
    all
}

/// An order from left to right in which no two nets share a line, with few crossings. Nets may be cut in two.
fn ordered(trunks: &mut Vec<Trunk>) -> Vec<usize> {
    let mut order: Vec<usize> = Vec::new();
    let mut open: Vec<usize> = (0..trunks.len()).collect();
    // Nets that go up begin with the highest at the left, those that go down with the lowest.
    open.sort_by_key(|&at| {
        let trunk = &trunks[at];
        let rises = trunk.right.iter().min() < trunk.left.iter().min();
        (if rises { trunk.top() } else { -trunk.bottom() }, at)
    });
    let mut relations = Relations::default();
    for index in 0..open.len() {
        relations.enter(trunks, open[index], &open[..index]);
    }
    while !open.is_empty() {
        let ready = open.iter().copied().filter(|&at| relations.before[at] == 0);
        let choice = ready.min_by_key(|&at| relations.excess[at]);
        // Where none is ready, some want that of each other: one that blocks another one is cut.
        let whole = |&at: &usize| trunks[at].joint.is_none() && !trunks[at].right.is_empty() && relations.after[at] > 0;
        match (choice, open.iter().copied().find(whole)) {
            (None, Some(at)) => {
                relations.leave(trunks, at, &open);
                open.push(cut(trunks, at));
                let others: Vec<usize> = open.iter().copied().filter(|&other| other != at).collect();
                relations.enter(trunks, at, &others[..others.len() - 1]);
                relations.enter(trunks, trunks.len() - 1, &open[..open.len() - 1]);
            }
            (chosen, _) => {
                let at = chosen.unwrap_or(open[0]);
                relations.leave(trunks, at, &open);
                open.retain(|&other| other != at);
                order.push(at);
            }
        }
    }
    improve(trunks, &mut order);
    order
}

/// What each net that has no place yet is to the others that have none.
#[derive(Default)]
struct Relations {
    /// Nets that must be at its left, and at its right.
    before: Vec<usize>,
    after: Vec<usize>,
    /// How many more crossings there are with it left of them than right of them.
    excess: Vec<i64>,
}

impl Relations {
    /// A net that others are compared with from now on.
    fn enter(&mut self, trunks: &[Trunk], at: usize, others: &[usize]) {
        self.before.resize(trunks.len(), 0);
        self.after.resize(trunks.len(), 0);
        self.excess.resize(trunks.len(), 0);
        (self.before[at], self.after[at], self.excess[at]) = (0, 0, 0);
        for &other in others {
            self.compare(trunks, at, other, 1);
            self.compare(trunks, other, at, 1);
        }
    }

    /// A net that the open ones are not compared with any more.
    fn leave(&mut self, trunks: &[Trunk], at: usize, open: &[usize]) {
        open.iter().filter(|&&other| other != at).for_each(|&other| self.compare(trunks, other, at, -1));
    }

    /// Counts `b` among those that `a` is compared with, or takes it off.
    fn compare(&mut self, trunks: &[Trunk], a: usize, b: usize, sign: i64) {
        let step = |count: &mut usize, is: bool| {
            if is {
                *count = count.saturating_add_signed(if sign > 0 { 1 } else { -1 });
            }
        };
        step(&mut self.before[a], before(&trunks[b], &trunks[a]));
        step(&mut self.after[a], before(&trunks[a], &trunks[b]));
        self.excess[a] += sign * excess(&trunks[a], &trunks[b]);
    }
}

/// How many more crossings there are with `a` left of `b` than the other way round.
fn excess(a: &Trunk, b: &Trunk) -> i64 {
    i64::try_from(cost(a, b)).unwrap_or(0) - i64::try_from(cost(b, a)).unwrap_or(0)
}

/// Swaps neighbours as long as that removes crossings.
fn improve(trunks: &[Trunk], order: &mut [usize]) {
    for _ in 0..order.len() {
        let mut changed = false;
        for at in 1..order.len() {
            let (a, b) = (&trunks[order[at - 1]], &trunks[order[at]]);
            if !before(a, b) && excess(a, b) > 0 {
                order.swap(at - 1, at);
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
}

/// Cuts a net: this one keeps the ends at the left, a new one has those at the right. The new one's index.
fn cut(trunks: &mut Vec<Trunk>, at: usize) -> usize {
    let taken: Vec<i32> = trunks.iter().flat_map(|trunk| trunk.ends().collect::<Vec<_>>()).collect();
    let is_free = |y: &i32| taken.iter().all(|end| (end - y).abs() >= NEAR + 2);
    let middle = i32::midpoint(trunks[at].top(), trunks[at].bottom()) / 2 * 2;
    let free = (0..).step_by(2).flat_map(|far| [middle + far, middle - far]).find(is_free).unwrap_or(middle);
    let right = std::mem::take(&mut trunks[at].right);
    trunks[at].joint = Some((free, true));
    let net = trunks[at].net;
    trunks.push(Trunk { net, left: Vec::new(), right, joint: Some((free, false)), track: 0 });
    trunks.len() - 1
}

/// Gives every trunk a track; how many there are. Nets whose trunks do not meet share one.
fn tracks(trunks: &mut [Trunk], order: &[usize]) -> i32 {
    let mut most = 0;
    for (place, &at) in order.iter().enumerate() {
        if trunks[at].is_straight() {
            trunks[at].track = -1;
            continue;
        }
        let mut track = 0;
        for &other in &order[..place] {
            let (a, b) = (&trunks[other], &trunks[at]);
            if a.track >= 0 && (a.meets(b) || before(a, b) || a.net == b.net) {
                track = track.max(a.track + 1);
            } else if a.track >= 0 && cost(a, b) != cost(b, a) {
                track = track.max(a.track);
            }
        }
        trunks[at].track = track;
        most = most.max(track + 1);
    }
    most
}

/// The lines of a trunk, and its dots.
fn draw(trunks: &[Trunk], at: usize, start: i32, [from, to]: [i32; 2], wire: &mut Wire) {
    let trunk = &trunks[at];
    if trunk.is_straight() {
        wire.lines.push([from, trunk.top(), to, trunk.top()]);
        return;
    }
    let x = start + trunk.track * TRACK;
    wire.lines.push([x, trunk.top(), x, trunk.bottom()]);
    for &y in &trunk.left {
        wire.lines.push([from, y, x, y]);
    }
    for &y in &trunk.right {
        wire.lines.push([x, y, to, y]);
    }
    if let Some((y, true)) = trunk.joint {
        let other = trunks.iter().find(|other| other.net == trunk.net && other.joint == Some((y, false)));
        wire.lines.push([x, y, start + other.map_or(0, |other| other.track) * TRACK, y]);
    }
    let mut heights: Vec<i32> = trunk.ends().collect();
    heights.sort_unstable();
    heights.dedup();
    for y in heights {
        let sides = [false, true].into_iter().filter(|&right| trunk.side(right).any(|end| end == y)).count();
        if sides + usize::from(y > trunk.top()) + usize::from(y < trunk.bottom()) > 2 {
            wire.dots.push([x, y]);
        }
    }
}
