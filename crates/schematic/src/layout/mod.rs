//! Places boxes with pins in columns from left to right, and routes the nets between them at right angles.
//!
//! The steps are those of layered drawings: feedback is chosen ([`rank`]), boxes get columns, nets that pass a column get a
//! place in it, columns are ordered so that few nets cross ([`order`]), heights follow the wires ([`place`]), and between
//! two columns every net has a vertical trunk of its own ([`route`]). A net is one tree whatever its number of readers, and
//! between two boxes of a column it has a lane of its own, so that no wire is laid through a box. All lengths are pixels.

mod order;
mod place;
mod rank;
mod route;

/// A box to be placed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Item {
    /// Width and height.
    pub(crate) size: [i32; 2],
    /// Nets that enter at the left, and at which height.
    pub(crate) left: Vec<Pin>,
    /// Nets that leave at the right.
    pub(crate) right: Vec<Pin>,
    /// Where it has to be.
    pub(crate) side: Side,
    /// Its outputs change at edges alone: where a loop must be drawn backwards, it is here.
    pub(crate) holds: bool,
    /// The nets of a side may have each other's places.
    pub(crate) free: bool,
}

/// Where a net meets a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pin {
    /// The net.
    pub(crate) net: usize,
    /// Pixels below the top of the box.
    pub(crate) y: i32,
}

/// Where a box has to be.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum Side {
    /// Anywhere.
    #[default]
    Free,
    /// In the first column.
    First,
    /// In the last column.
    Last,
}

/// A drawing: where each box is, and the lines of each net.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    /// Width and height of all.
    pub(crate) size: [i32; 2],
    /// Left and top of each box.
    pub(crate) at: Vec<[i32; 2]>,
    /// The nets at the left and at the right of each box, from the top.
    pub(crate) pins: Vec<[Vec<usize>; 2]>,
    /// The nets that have a wire.
    pub(crate) wires: Vec<Wire>,
}

/// A net as lines.
#[derive(Clone, Debug, Default)]
pub(crate) struct Wire {
    /// The net.
    pub(crate) net: usize,
    /// Its lines: x and y of both ends.
    pub(crate) lines: Vec<[i32; 4]>,
    /// Where three and more of them meet.
    pub(crate) dots: Vec<[i32; 2]>,
    /// Where it enters a box.
    pub(crate) ends: Vec<[i32; 2]>,
}

/// What has a place in a column: a box, or a net that passes.
#[derive(Clone, Debug)]
struct Slot {
    what: What,
    y: i32,
    height: i32,
    left: Vec<Pin>,
    right: Vec<Pin>,
    free: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum What {
    Item(usize),
    Pass,
}

impl Slot {
    fn of(index: usize, item: &Item) -> Slot {
        let (left, right) = (item.left.clone(), item.right.clone());
        Slot { what: What::Item(index), y: 0, height: item.size[1], left, right, free: item.free }
    }

    fn pass(net: usize) -> Slot {
        let pin = Pin { net, y: 0 };
        Slot { what: What::Pass, y: 0, height: 0, left: vec![pin], right: vec![pin], free: false }
    }

    /// Pixels between this one and the next of its column.
    fn below(&self, next: &Slot) -> i32 {
        match (self.what, next.what) {
            (What::Pass, What::Pass) => 10,
            (What::Item(_), What::Item(_)) => 18,
            _ => 14,
        }
    }
}

/// Places boxes and routes their nets. A net has one box that it leaves; nets without a reader have no wire.
pub(crate) fn lay_out(items: &[Item]) -> Plan {
    if items.is_empty() {
        return Plan::default();
    }
    let nets =
        items.iter().flat_map(|item| item.left.iter().chain(&item.right)).map(|pin| pin.net + 1).max().unwrap_or(0);
    let ranks = rank::ranks(items, nets);
    let mut columns = rank::columns(items, nets, &ranks);
    order::order(&mut columns, nets);
    place::place(&mut columns, nets);
    route::route(items, &columns, nets)
}
