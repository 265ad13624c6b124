//! Lines of two axes from the origin.

use stepwave_nc::{Curve, Line};
use stepwave_netlist::formula::{Clause, name};

use super::extremes::{self, Reach};
use super::{Kind, coordinate, spread};
use crate::parts::POSITION;

/// Signs of the motion.
const QUADRANTS: [(&str, [i128; 2]); 4] = [("Q1", [1, 1]), ("Q2", [-1, 1]), ("Q3", [-1, -1]), ("Q4", [1, -1])];

/// Most bits of coordinates of which all lines are listed; of more, the extreme ones.
pub(super) const WHOLE: u32 = 8;

/// All lines.
pub(super) const ANY: &[&str] = &[""];
/// Those of either long axis, which is x at 45 degrees.
pub(super) const LONG: &[&str] = &[", x long", ", y long"];
/// Those of either longer axis, and those at 45 degrees.
pub(super) const LONGER: &[&str] = &[", x longer", ", y longer", ", 45 degrees"];

/// The lines of each quadrant, those of each of the `lengths` by themselves; if wanted, with half of the long travel,
/// rounded down, as a number of its own.
pub(super) fn kinds(lengths: &[&str], halved: bool) -> Vec<Kind> {
    let (a, b) = (|| name("|dx|"), || name("|dy|"));
    let mut kinds = Vec::new();
    for (quadrant, [x, y]) in QUADRANTS {
        for length in lengths {
            let mut premises = vec![Clause::at_least_zero("the line has a length", a() + b() - 1)];
            // Along an axis the sign is positive.
            if x < 0 {
                premises.push(Clause::at_least_zero("x moves", a() - 1));
            }
            if y < 0 {
                premises.push(Clause::at_least_zero("y moves", b() - 1));
            }
            let mut symbols = vec![coordinate("|dx|"), coordinate("|dy|")];
            if halved {
                let long = if *length == ", y long" { b() } else { a() };
                let rest = long - 2 * name("half");
                symbols.push(coordinate("half"));
                premises.push(Clause::at_least_zero("half is not more", rest.clone()));
                premises.push(Clause::at_least_zero("half is rounded down", -rest + 1));
            }
            match *length {
                ", x long" => premises.push(Clause::at_least_zero("x is long", a() - b())),
                ", x longer" => premises.push(Clause::at_least_zero("x is longer", a() - b() - 1)),
                ", y long" | ", y longer" => premises.push(Clause::at_least_zero("y is longer", b() - a() - 1)),
                ", 45 degrees" => premises.extend(Clause::zero("both are as long", a() - b())),
                _ => {}
            }
            let ends = [
                Clause::zero("x ends", POSITION.of(0).value() - x * a()),
                Clause::zero("y ends", POSITION.of(1).value() - y * b()),
            ];
            kinds.push(Kind {
                name: format!("{quadrant}{length}"),
                symbols,
                constants: [("sx", x), ("sy", y)].map(|(name, sign)| (name.to_owned(), i128::from(sign < 0))).to_vec(),
                by_mode: Vec::new(),
                premises,
                goals: ends.into_iter().flatten().collect(),
            });
        }
    }
    kinds
}

pub(super) fn symbols(kind: &str, curve: &Curve, halved: bool) -> Option<Vec<i128>> {
    let Curve::Line(line) = curve else { return None };
    let [dx, dy] = <[i64; 2]>::try_from(line.delta()).ok()?;
    let at_origin = line.from().iter().all(|coordinate| *coordinate == 0);
    let quadrant = match (dx < 0, dy < 0) {
        (false, false) => "Q1",
        (true, false) => "Q2",
        (true, true) => "Q3",
        (false, true) => "Q4",
    };
    let travels = [i128::from(dx).abs(), i128::from(dy).abs()];
    let half = halved.then(|| travels[0].max(travels[1]) / 2);
    (at_origin && kind.starts_with(quadrant)).then(|| travels.into_iter().chain(half).collect())
}

/// The line from the origin to a point.
pub(super) fn to(point: [i64; 2]) -> Option<Curve> {
    Line::new(vec![0, 0], point.to_vec()).ok().map(Curve::Line)
}

pub(super) fn curves(k: u32, most: usize) -> Vec<Curve> {
    let greatest = (1_i64 << k.min(52)) - 1;
    if k > WHOLE {
        return spread(extremes::lines([Reach::within(greatest); 2]).collect(), most);
    }
    let sides = || -greatest..=greatest;
    let points = sides().flat_map(|x| sides().map(move |y| [x, y])).filter(|point| *point != [0, 0]);
    spread(points.collect(), most).into_iter().filter_map(to).collect()
}
