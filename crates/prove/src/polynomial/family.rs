//! One netlist for every width: netlists of the same structure whose widths, constants and slices grow alike.
//!
//! Built from the netlists of several k, of which any two have the same cells with the same operands. Each width is
//! then a fixed number or k and a fixed number; each constant a fixed number or a multiple of 2^k and a fixed number.
//! Two netlists fix these rules, and every further one is checked against them, so that a proof about the family is one
//! about each netlist that was given.

use super::poly::{Poly, Var};
use stepwave_netlist::Design;
use stepwave_netlist::cells::{Net, Netlist, Op};

/// A whole number that may grow with k.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Bits {
    /// Without k.
    pub(crate) fixed: i64,
    /// k is added.
    pub(crate) grows: bool,
}

/// A number that may grow with 2^k.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Number {
    scale: i128,
    fixed: i128,
}

/// Why netlists are not a family.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FamilyError {
    /// There are too few.
    #[error("one netlist is no family: give at least two widths")]
    TooFew,
    /// They differ in more than widths.
    #[error("the netlists of {first} and of {second} bits are not the same circuit: {what}")]
    Differs {
        /// Width of one.
        first: u32,
        /// Width of the other.
        second: u32,
        /// Where.
        what: String,
    },
}

/// Netlists of one structure.
#[derive(Clone, Debug)]
pub struct Family {
    /// The first netlist: the structure of all.
    design: Design,
    widths: Vec<Bits>,
    /// Values of constants and reset values.
    numbers: Vec<Number>,
    /// Lowest bits of slices.
    lows: Vec<Bits>,
    /// 2^(k + offset) is the variable of the width; no width is smaller than k + offset.
    offset: i64,
    ks: Vec<u32>,
}

impl Family {
    /// The variable of 2^(k + offset).
    pub(crate) const SCALE: Var = Var(0);

    /// A netlist by itself, with all widths as they are.
    #[must_use]
    pub fn single(design: &Design, k: u32) -> Family {
        let netlist = design.netlist();
        Family {
            design: design.clone(),
            widths: netlist.cells.iter().map(|cell| fixed(cell.width.get())).collect(),
            numbers: netlist
                .cells
                .iter()
                .map(|cell| Number { scale: 0, fixed: i128::from(literal(cell.op)) })
                .collect(),
            lows: netlist.cells.iter().map(|cell| fixed(low(cell.op))).collect(),
            offset: 0,
            ks: vec![k],
        }
    }

    /// The family of the netlists of these k, which are in ascending order.
    ///
    /// # Errors
    /// They are fewer than two, or not alike.
    pub fn of(members: &[(u32, Design)]) -> Result<Family, FamilyError> {
        let [(k, first), (other_k, second), ..] = members else { return Err(FamilyError::TooFew) };
        let step = i64::from(*other_k) - i64::from(*k);
        let bits = |of: fn(&Netlist, usize) -> u32, index| {
            let [low, high] = [first, second].map(|design| i64::from(of(design.netlist(), index)));
            Bits {
                fixed: if low == high { low } else { low - i64::from(*k) },
                grows: low != high && high - low == step,
            }
        };
        let cells = 0..first.netlist().cells.len();
        let same = cells.len() == second.netlist().cells.len();
        let mut family = Family::single(first, *k);
        if same {
            family.widths = cells.clone().map(|index| bits(width_at, index)).collect();
            family.lows = cells.clone().map(|index| bits(low_at, index)).collect();
            family.numbers = cells
                .map(|index| {
                    let [low, high] = [first, second].map(|d| i128::from(literal(d.netlist().cells[index].op)));
                    let span = (1_i128 << other_k) - (1 << k);
                    let scale = if (high - low) % span == 0 { (high - low) / span } else { 0 };
                    Number { scale, fixed: low - (scale << k) }
                })
                .collect();
        }
        let growing = family.widths.iter().chain(&family.lows).filter(|bits| bits.grows);
        family.offset = growing.map(|bits| bits.fixed).min().unwrap_or(0).min(-1);
        family.ks = members.iter().map(|(k, _)| *k).collect();
        for (other, design) in &members[1..] {
            family.check(*k, *other, design).map_err(|what| FamilyError::Differs {
                first: *k,
                second: *other,
                what,
            })?;
        }
        Ok(family)
    }

    /// The netlist of k = `k` is one of the family; else where it is not.
    fn check(&self, own: u32, k: u32, design: &Design) -> Result<(), String> {
        let (ours, theirs) = (self.design.netlist(), design.netlist());
        if ours.cells.len() != theirs.cells.len() {
            return Err(format!("{} cells and {}", ours.cells.len(), theirs.cells.len()));
        }
        if ours.names != theirs.names || ours.properties != theirs.properties {
            return Err("names or claims differ".to_owned());
        }
        for net in ours.nets() {
            let (a, b) = (ours.cell(net).op, theirs.cell(net).op);
            let index = net.index();
            let at = |bits: Bits| bits.fixed + if bits.grows { i64::from(k) } else { 0 };
            let number = self.numbers[index].fixed + (self.numbers[index].scale << k);
            if shape(a) != shape(b)
                || at(self.widths[index]) != i64::from(width_at(theirs, index))
                || at(self.lows[index]) != i64::from(low_at(theirs, index))
                || number != i128::from(literal(b))
            {
                return Err(format!("{} with k = {own}, {} with k = {k}", ours.describe(net), theirs.describe(net)));
            }
        }
        Ok(())
    }

    /// The structure.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Its netlist.
    pub(crate) fn netlist(&self) -> &Netlist {
        self.design.netlist()
    }

    /// The k of the netlists that were given, in ascending order.
    #[must_use]
    pub fn ks(&self) -> &[u32] {
        &self.ks
    }

    pub(crate) fn width(&self, net: Net) -> Bits {
        self.widths[net.index()]
    }

    pub(crate) fn low(&self, net: Net) -> Bits {
        self.lows[net.index()]
    }

    /// The value of a constant, or the reset value of a register.
    pub(crate) fn number(&self, net: Net) -> Poly {
        let Number { scale, fixed } = self.numbers[net.index()];
        self.power(Bits { fixed: 0, grows: true }).times_number(scale).plus_number(fixed)
    }

    /// 2 to the number of bits.
    pub(crate) fn power(&self, bits: Bits) -> Poly {
        let (rest, scale) = if bits.grows {
            (bits.fixed - self.offset, Poly::from(Family::SCALE))
        } else {
            (bits.fixed, Poly::from(1))
        };
        match u32::try_from(rest) {
            Ok(rest) if rest < 120 => scale.times_number(1 << rest),
            _ => Poly::from(i128::MAX).plus_number(1), // lost
        }
    }

    /// 2^k.
    #[must_use]
    pub fn two_to_k(&self) -> Poly {
        match self.ks[..] {
            [k] => Poly::from(1 << k),
            _ => self.power(Bits { fixed: 0, grows: true }),
        }
    }

    /// 2^(k-1).
    pub(crate) fn half(&self) -> Poly {
        match self.ks[..] {
            [k] => Poly::from(1 << k.saturating_sub(1)),
            _ => self.power(Bits { fixed: -1, grows: true }),
        }
    }

    /// The value of the width's variable in the netlist of this k.
    #[must_use]
    pub fn scale_at(&self, k: u32) -> i128 {
        u32::try_from(i64::from(k) + self.offset).map_or(1, |bits| 1_i128 << bits)
    }

    /// [`SCALE`](Family::SCALE) in words.
    pub(crate) fn scale_name(&self) -> String {
        format!("2^(k-{})", -self.offset)
    }

    /// The least value of [`SCALE`](Family::SCALE).
    pub(crate) fn least_scale(&self) -> i128 {
        self.scale_at(self.ks[0])
    }
}

fn fixed(bits: u32) -> Bits {
    Bits { fixed: i64::from(bits), grows: false }
}

fn width_at(netlist: &Netlist, index: usize) -> u32 {
    netlist.cells[index].width.get()
}

fn low_at(netlist: &Netlist, index: usize) -> u32 {
    low(netlist.cells[index].op)
}

fn literal(op: Op) -> u64 {
    match op {
        Op::Const(value) | Op::Register { reset: value, .. } => value,
        _ => 0,
    }
}

fn low(op: Op) -> u32 {
    if let Op::Slice { low, .. } = op { u32::from(low) } else { 0 }
}

/// The operator without what may grow with the width.
fn shape(op: Op) -> Op {
    match op {
        Op::Const(_) => Op::Const(0),
        Op::Register { next, .. } => Op::Register { next, reset: 0 },
        Op::Slice { of, .. } => Op::Slice { of, low: 0 },
        other => other,
    }
}
