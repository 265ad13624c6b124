//! The order of boxes and passing nets in each column, so that few nets cross.

use super::{Pin, Slot};

/// Rounds from left to right and back.
const ROUNDS: usize = 24;

/// Orders every column.
pub(super) fn order(columns: &mut [Vec<Slot>], nets: usize) {
    let mut best = columns.to_vec();
    let mut fewest = crossings(columns, nets);
    for round in 0..ROUNDS {
        if round % 2 == 0 {
            for at in 1..columns.len() {
                let (left, right) = columns.split_at_mut(at);
                sort(&mut right[0], &left[at - 1], nets, true);
            }
        } else {
            for at in (1..columns.len()).rev() {
                let (left, right) = columns.split_at_mut(at);
                sort(&mut left[at - 1], &right[0], nets, false);
            }
        }
        turn(columns, nets);
        if round % 4 == 3 {
            switch(columns, nets);
        }
        let now = crossings(columns, nets);
        if now < fewest {
            (fewest, best) = (now, columns.to_vec());
        }
    }
    columns.clone_from_slice(&best);
    switch(columns, nets);
    turn(columns, nets);
}

/// Gives the nets of boxes whose pins are free the order of where they come from and lead to.
fn turn(columns: &mut [Vec<Slot>], nets: usize) {
    for at in 0..columns.len() {
        for right in [false, true] {
            let next = if right { columns.get(at + 1) } else { at.checked_sub(1).map(|before| &columns[before]) };
            let there = next.map_or_else(|| vec![Vec::new(); nets], |next| ends(next, nets, !right));
            let here = ends(&columns[at], nets, right);
            // The place of the first pin of each box, as `ends` counts them.
            let mut first = 0;
            for slot in &mut columns[at] {
                let all = if right { &mut slot.right } else { &mut slot.left };
                let own = first;
                first += all.len().max(1);
                if !slot.free {
                    continue;
                }
                // A net that turns round in this gap comes from above the box or from below it, the nearest lane to the pin
                // that is nearest to it.
                let key = |pin: &Pin| {
                    let lanes = || here[pin.net].iter().copied();
                    let above = lanes().filter(|&lane| lane < own).max();
                    let below = lanes().filter(|&lane| lane >= own + all.len()).max();
                    match (there[pin.net].as_slice(), above, below) {
                        ([], Some(lane), _) => (0, usize::MAX - lane),
                        ([], None, lane) => (2, usize::MAX - lane.unwrap_or(0)),
                        (ends, ..) => (1, ends[(ends.len() - 1) / 2]),
                    }
                };
                let mut order: Vec<_> = all.iter().map(|pin| (key(pin), pin.net)).collect();
                order.sort_by_key(|of| of.0);
                all.iter_mut().zip(order).for_each(|(pin, (_, net))| pin.net = net);
            }
        }
    }
}

/// The pins of a slot at one side.
fn pins(slot: &Slot, right: bool) -> &[Pin] {
    if right { &slot.right } else { &slot.left }
}

/// Places of the ends of each net at one side of a column: pins are counted from the top.
fn ends(column: &[Slot], nets: usize, right: bool) -> Vec<Vec<usize>> {
    let mut ends = vec![Vec::new(); nets];
    let mut count = 0;
    for slot in column {
        for pin in pins(slot, right) {
            ends[pin.net].push(count);
            count += 1;
        }
        count += usize::from(pins(slot, right).is_empty());
    }
    ends
}

/// Sorts a column by where its nets are in the one next to it: at its left, if `from_left`.
fn sort(column: &mut Vec<Slot>, next: &[Slot], nets: usize, from_left: bool) {
    let there = ends(next, nets, from_left);
    let mut keyed: Vec<(Option<f64>, Slot)> = Vec::with_capacity(column.len());
    for slot in column.drain(..) {
        let mut places = Vec::new();
        for (index, pin) in pins(&slot, !from_left).iter().enumerate() {
            // A pin far down in a box wants the box higher up.
            let down = index as f64 / 64.0;
            places.extend(there[pin.net].iter().map(|&at| at as f64 - down));
        }
        places.sort_by(f64::total_cmp);
        let key = match places.len() {
            0 => None,
            count => Some(
                (places[(count - 1) / 2] + places[count / 2]) / 2.0 + places.iter().sum::<f64>() / count as f64 / 1e3,
            ),
        };
        keyed.push((key, slot));
    }
    // What is not connected stays where it is: at the key of the one before.
    let mut before = -1.0;
    for (key, _) in &mut keyed {
        before = *key.get_or_insert(before);
    }
    keyed.sort_by(|a, b| a.0.unwrap_or(0.0).total_cmp(&b.0.unwrap_or(0.0)));
    column.extend(keyed.into_iter().map(|(_, slot)| slot));
}

/// Wires between two columns: the places of their ends. A net with several ends is a star.
fn wires(left: &[Slot], right: &[Slot], nets: usize) -> Vec<(usize, usize)> {
    let (from, to) = (ends(left, nets, true), ends(right, nets, false));
    let mut wires = Vec::new();
    for (from, to) in from.iter().zip(&to) {
        let (Some(&first), Some(&begin)) = (from.first(), to.first()) else { continue };
        wires.extend(to.iter().map(|&end| (first, end)));
        wires.extend(from.iter().skip(1).map(|&start| (start, begin)));
    }
    wires
}

fn inversions(wires: &mut [(usize, usize)]) -> usize {
    wires.sort_unstable();
    let most = wires.iter().map(|wire| wire.1).max().unwrap_or(0) + 2;
    let (mut tree, mut seen, mut count) = (vec![0usize; most + 1], 0, 0);
    for &(_, end) in wires.iter() {
        let (mut at, mut not_greater) = (end + 1, 0);
        while at > 0 {
            not_greater += tree[at];
            at &= at - 1;
        }
        count += seen - not_greater;
        seen += 1;
        at = end + 1;
        while at <= most {
            tree[at] += 1;
            at += at & at.wrapping_neg();
        }
    }
    count
}

/// Crossings of all nets.
fn crossings(columns: &[Vec<Slot>], nets: usize) -> usize {
    columns.windows(2).map(|pair| inversions(&mut wires(&pair[0], &pair[1], nets))).sum()
}

/// Swaps neighbours in a column as long as that removes crossings.
fn switch(columns: &mut [Vec<Slot>], nets: usize) {
    for at in 0..columns.len() {
        let left = at.checked_sub(1).map(|before| ends(&columns[before], nets, true));
        let right = columns.get(at + 1).map(|after| ends(after, nets, false));
        for _ in 0..4 {
            let mut changed = false;
            for upper in 0..columns[at].len().saturating_sub(1) {
                let (a, b) = (&columns[at][upper], &columns[at][upper + 1]);
                let cost = |above: &Slot, below: &Slot| {
                    let at_left = left.as_ref().map_or(0, |ends| pair(&above.left, &below.left, ends));
                    let at_right = right.as_ref().map_or(0, |ends| pair(&above.right, &below.right, ends));
                    at_left + at_right
                };
                if cost(b, a) < cost(a, b) {
                    columns[at].swap(upper, upper + 1);
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
    }
}

/// Crossings of the wires of two slots, one above the other, to a column next to them.
fn pair(above: &[Pin], below: &[Pin], ends: &[Vec<usize>]) -> usize {
    let mut count = 0;
    for a in above {
        for b in below.iter().filter(|b| b.net != a.net) {
            for &end in &ends[a.net] {
                count += ends[b.net].iter().filter(|&&other| other < end).count();
            }
        }
    }
    count
}
