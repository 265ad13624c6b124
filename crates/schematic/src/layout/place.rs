//! How far down everything in a column is: in its order, without overlaps, and so that wires are straight where they can be.

use super::{Slot, What};

/// Rounds from left to right and back.
const ROUNDS: usize = 10;
/// Pixels that may be empty in all columns.
const EMPTY: i32 = 18;
/// Farther down than any drawing is high.
const FAR: i32 = 1 << 28;

/// Gives every slot its height.
pub(super) fn place(columns: &mut [Vec<Slot>], nets: usize) {
    for column in columns.iter_mut() {
        let wanted = vec![0; column.len()];
        let weights = vec![1; column.len()];
        settle(column, &wanted, &weights);
    }
    for round in 0..ROUNDS {
        if round % 2 == 0 {
            for at in 1..columns.len() {
                let (left, right) = columns.split_at_mut(at);
                follow(&mut right[0], Some(&left[at - 1]), None, nets);
            }
        } else {
            for at in (1..columns.len()).rev() {
                let (left, right) = columns.split_at_mut(at);
                follow(&mut left[at - 1], None, Some(&right[0]), nets);
            }
        }
    }
    for at in 0..columns.len() {
        let (before, rest) = columns.split_at_mut(at);
        let Some((now, after)) = rest.split_first_mut() else { continue };
        follow(now, before.last().map(Vec::as_slice), after.first().map(Vec::as_slice), nets);
    }
    close_up(columns);
}

/// Takes out of the drawing, from its top on, what is empty in all columns.
fn close_up(columns: &mut [Vec<Slot>]) {
    let mut slots: Vec<&mut Slot> = columns.iter_mut().flatten().collect();
    slots.sort_by_key(|slot| slot.y);
    let first = slots.first().map_or(0, |slot| slot.y);
    let (mut reached, mut up) = (first, first);
    for slot in slots {
        let empty = slot.y - reached - EMPTY;
        up += empty.max(0);
        reached = reached.max(slot.y + slot.height);
        slot.y -= up;
    }
}

/// Heights of the ends of each net at one side of a column.
fn heights(column: Option<&[Slot]>, nets: usize, right: bool) -> Vec<Vec<i32>> {
    let mut heights = vec![Vec::new(); nets];
    for slot in column.unwrap_or_default() {
        for pin in if right { &slot.right } else { &slot.left } {
            heights[pin.net].push(slot.y + pin.y);
        }
    }
    heights
}

/// Moves a column to where the columns next to it want it.
fn follow(column: &mut [Slot], left: Option<&[Slot]>, right: Option<&[Slot]>, nets: usize) {
    let (from, to) = (heights(left, nets, true), heights(right, nets, false));
    let (mut wanted, mut weights) = (Vec::new(), Vec::new());
    for slot in column.iter() {
        let at_left = slot.left.iter().flat_map(|pin| from[pin.net].iter().map(move |y| y - pin.y));
        let at_right = slot.right.iter().flat_map(|pin| to[pin.net].iter().map(move |y| y - pin.y));
        let mut all: Vec<i32> = at_left.chain(at_right).collect();
        all.sort_unstable();
        // One of the heights, so that one wire at least is straight. What is not connected follows what is above it.
        let is_first = weights.iter().all(|&weight| weight == 0);
        let adrift = if is_first { FAR } else { -FAR };
        wanted.push(all.get(all.len().saturating_sub(1) / 2).copied().unwrap_or(adrift));
        let pull = i32::try_from(all.len()).unwrap_or(i32::MAX).min(8);
        weights.push(if slot.what == What::Pass { pull * 3 } else { pull });
    }
    if weights.iter().all(|&weight| weight == 0) {
        wanted.fill(0);
    }
    settle(column, &wanted, &weights);
}

/// A run of slots that touch, and the heights that its slots want its first one at.
struct Group {
    first: usize,
    wants: Vec<(i32, i32)>,
    y: i32,
}

impl Group {
    /// The weighted median of what its slots want.
    fn settle(&mut self) {
        self.wants.sort_unstable();
        let all: i64 = self.wants.iter().map(|&(_, weight)| i64::from(weight)).sum();
        let mut seen = 0;
        for &(y, weight) in &self.wants {
            seen += i64::from(weight);
            if seen * 2 >= all {
                self.y = y;
                return;
            }
        }
    }
}

/// The heights nearest to those wanted, by weight, that keep the order and the distances.
fn settle(column: &mut [Slot], wanted: &[i32], weights: &[i32]) {
    // Heights as if nothing had an extent.
    let mut offsets = vec![0; column.len()];
    for at in 1..column.len() {
        offsets[at] = offsets[at - 1] + column[at - 1].height + column[at - 1].below(&column[at]);
    }
    let mut groups: Vec<Group> = Vec::new();
    for at in 0..column.len() {
        let y = wanted[at] - offsets[at];
        groups.push(Group { first: at, wants: vec![(y, weights[at])], y });
        while let [.., above, below] = groups.as_mut_slice() {
            if above.y <= below.y {
                break;
            }
            above.wants.append(&mut below.wants);
            above.settle();
            groups.pop();
        }
    }
    let ends = groups.iter().skip(1).map(|group| group.first).chain([column.len()]).collect::<Vec<_>>();
    for (group, end) in groups.iter().zip(ends) {
        for at in group.first..end {
            column[at].y = group.y + offsets[at];
        }
    }
}
