//! Conics of a box: quarters of ellipses, and arcs of parabolas and hyperbolas from or to the vertex.

use stepwave_nc::{Conic, Curve, Direction, Opens};

use super::sizes;

const OPENS: [Opens; 4] = [Opens::PlusX, Opens::MinusX, Opens::PlusY, Opens::MinusY];
/// Of the extreme conics, arcs of one open curve that are taken from the nearest end and from the farthest.
const ENDS: usize = 3;

/// Quarters of ellipses with semi-axes of k bits, and arcs of parabolas and hyperbolas from or to the vertex, whose other
/// end has coordinates of k bits and lies on the curve exactly; all of them, or those of the extreme sizes and ends.
pub(super) fn conics(k: u32, all: bool) -> Vec<Curve> {
    let greatest = (1_i64 << k) - 1;
    let sizes = sizes(k, all);
    let mut conics: Vec<Conic> = Vec::new();
    for &a in &sizes {
        parabolas(a, greatest, all, &mut conics);
        for &b in &sizes {
            hyperbolas([a, b], greatest, all, &mut conics);
            ellipses([a, b], &mut conics);
        }
    }
    if !all {
        // Sizes that leave ends on the curve: (5m, 4n) is one of the hyperbola of semi-axes 3m and 3n, (c, c) of y² = cx.
        let [most, less] = [greatest / 5, greatest / 10 + 1];
        for [m, n] in [[most, most], [most, 1], [1, most], [most, less], [less, most]] {
            if m > 0 && n > 0 {
                hyperbolas([3 * m, 3 * n], greatest, false, &mut conics);
            }
        }
        let square = greatest.isqrt();
        [square, square * square].iter().for_each(|c| parabolas(*c, greatest, false, &mut conics));
    }
    conics.into_iter().map(Curve::Conic).collect()
}

/// The first and the last of some, or all of them.
fn ends<T: Copy>(found: Vec<T>, all: bool) -> Vec<T> {
    if all || found.len() <= 2 * ENDS {
        return found;
    }
    [&found[..ENDS], &found[found.len() - ENDS..]].concat()
}

/// Along the axis to which a curve opens, and across it.
fn place(opens: Opens, along: i64, across: i64) -> [i64; 2] {
    let along = along * opens.sign();
    if opens.axis() == 0 { [along, across] } else { [across, along] }
}

fn parabolas(c: i64, greatest: i64, all: bool, conics: &mut Vec<Conic>) {
    let along = |across: i64| {
        let along = i128::from(across).pow(2) / i128::from(c);
        (along * i128::from(c) == i128::from(across).pow(2)).then_some(along)
    };
    let on = |across: i64| along(across).and_then(|along| i64::try_from(along).ok()).filter(|along| *along <= greatest);
    let found: Vec<[i64; 2]> = (1..=greatest).filter_map(|across| Some([on(across)?, across])).collect();
    for [along, across] in ends(found, all) {
        for (opens, side) in OPENS.into_iter().flat_map(|opens| [(opens, 1), (opens, -1)]) {
            let end = place(opens, along, side * across);
            let motions = [([0, 0], end), (end, [0, 0])];
            conics.extend(
                motions.iter().filter_map(|(from, to)| Conic::parabola(c, Some(opens), *from, *to, [0, 0]).ok()),
            );
        }
    }
}

/// Of one real semi-axis and another one.
fn hyperbolas([real, other]: [i64; 2], greatest: i64, all: bool, conics: &mut Vec<Conic>) {
    let squared = |value: i64| i128::from(value).pow(2);
    // (along/real)² - (across/other)² = 1. All products are below 2^(4k + 1).
    let across = |along: i64| {
        let square = squared(other) * (squared(along) - squared(real));
        let across = (square % squared(real) == 0).then(|| square / squared(real))?;
        let root = i64::try_from(across.isqrt()).ok()?;
        (squared(root) == across && root <= greatest).then_some(root)
    };
    let found: Vec<[i64; 2]> = (real + 1..=greatest).filter_map(|along| Some([along, across(along)?])).collect();
    for [along, across] in ends(found, all) {
        for (opens, side) in OPENS.into_iter().flat_map(|opens| [(opens, 1), (opens, -1)]) {
            let (vertex, end) = (place(opens, real, 0), place(opens, along, side * across));
            let motions = [(vertex, end), (end, vertex)];
            let branch = |(from, to): &([i64; 2], [i64; 2])| {
                Conic::hyperbola([real, other], Some(opens), *from, *to, [0, 0]).ok()
            };
            conics.extend(motions.iter().filter_map(branch));
        }
    }
}

fn ellipses([a, b]: [i64; 2], conics: &mut Vec<Conic>) {
    let corners = [[a, 0], [0, b], [-a, 0], [0, -b]];
    for place in 0..4 {
        let [from, to] = [corners[place], corners[(place + 1) % 4]];
        let motions = [(from, to, Direction::CounterClockwise), (to, from, Direction::Clockwise)];
        conics.extend(
            motions
                .iter()
                .filter_map(|&(from, to, direction)| Conic::ellipse([a, b], from, to, [0, 0], direction).ok()),
        );
    }
}
