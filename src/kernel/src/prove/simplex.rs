//! Finds factors of 0 or more with which columns add up to a wanted column, in floating point: a guess that is worked
//! out exactly afterwards.

/// Columns of the same height, each sparse: (row, value).
pub(crate) type Columns = [Vec<(usize, f64)>];

/// Numbers nearer to 0 than this count as 0.
const TINY: f64 = 1e-9;

/// Which columns to take so that a sum of them with factors of 0 or more has 1 in row 0 and 0 in all others; at most
/// `height` many. `None` where there are none, or where the arithmetic was not good enough to find them.
///
/// The simplex algorithm, phase one: every row begins with a column of its own, which must go. Only row 0 wants
/// something, so that nearly every step is degenerate; a step that gains nothing takes a random column out of those
/// that could, so that none can go round forever.
pub(crate) fn support(columns: &Columns, height: usize) -> Option<Vec<usize>> {
    let width = columns.len() + 1;
    // Row by row, the wanted column last. The cost row stands below: what is still missing.
    let mut table = vec![0.0; (height + 1) * width];
    for (column, entries) in columns.iter().enumerate() {
        for &(row, value) in entries {
            table[row * width + column] = value;
        }
    }
    table[width - 1] = 1.0;
    let mut basis: Vec<Option<usize>> = vec![None; height];
    // A row whose own column is still there costs what it holds; only row 0 holds something.
    for column in 0..width {
        table[height * width + column] = (0..height).map(|row| table[row * width + column]).sum();
    }
    let mut random = 0x2545_F491_4F6C_DD1D_u64;
    let mut still = 0;
    for _ in 0..40 * (height + 10) {
        let missing = table[height * width + width - 1];
        if missing < TINY {
            return Some(basis.into_iter().flatten().collect());
        }
        let entering = entering(&table[height * width..][..width - 1], &mut random, still > 2)?;
        let leaving = leaving(&table, width, height, entering, &basis)?;
        let gained = table[leaving * width + width - 1] > TINY;
        still = if gained { 0 } else { still + 1 };
        pivot(&mut table, width, height, leaving, entering);
        basis[leaving] = Some(entering);
    }
    None
}

/// A column that lowers what is missing: the one that lowers it most, or any.
fn entering(costs: &[f64], random: &mut u64, any: bool) -> Option<usize> {
    let good = |cost: &f64| *cost > TINY;
    if !any {
        let best = costs.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        return good(best.1).then_some(best.0);
    }
    let count = costs.iter().filter(|cost| good(cost)).count();
    if count == 0 {
        return None;
    }
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    #[allow(clippy::cast_possible_truncation, reason = "a remainder below a count")]
    let chosen = (*random % count as u64) as usize;
    costs.iter().enumerate().filter(|(_, cost)| good(cost)).nth(chosen).map(|(column, _)| column)
}

/// The row whose column makes room: the first to come to 0; of several, one that still has its own column, and then
/// the one with the largest entry.
fn leaving(table: &[f64], width: usize, height: usize, entering: usize, basis: &[Option<usize>]) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for row in 0..height {
        let entry = table[row * width + entering];
        let held = table[row * width + width - 1];
        // A row at 0 whose own column is still there lets go of it by either sign.
        let usable = entry > TINY || basis[row].is_none() && held.abs() < TINY && entry < -TINY;
        if !usable {
            continue;
        }
        let ratio = (held / entry).abs();
        let better = best.is_none_or(|(other, least)| {
            if (ratio - least).abs() > TINY {
                return ratio < least;
            }
            let rank = |row: usize| (basis[row].is_none(), table[row * width + entering].abs());
            let (mine, theirs) = (rank(row), rank(other));
            mine.0 & !theirs.0 || mine.0 == theirs.0 && mine.1 > theirs.1
        });
        if better {
            best = Some((row, ratio));
        }
    }
    best.map(|(row, _)| row)
}

fn pivot(table: &mut [f64], width: usize, height: usize, row: usize, column: usize) {
    let entry = table[row * width + column];
    table[row * width..][..width].iter_mut().for_each(|value| *value /= entry);
    let pivot_row = table[row * width..][..width].to_vec();
    for other in (0..=height).filter(|other| *other != row) {
        let factor = table[other * width + column];
        if factor != 0.0 {
            for (value, own) in table[other * width..][..width].iter_mut().zip(&pivot_row) {
                *value -= factor * own;
            }
            table[other * width + column] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_columns_that_add_up() {
        // Row 0 wants 1: column 0 gives it but leaves 1 in row 1, which column 2 takes away.
        let columns = [vec![(0, 1.0), (1, 1.0)], vec![(1, 1.0)], vec![(1, -2.0)]];
        let mut support = support(&columns, 2).unwrap();
        support.sort_unstable();
        assert_eq!(support, [0, 2]);
    }

    #[test]
    fn says_where_there_are_none() {
        assert_eq!(support(&[vec![(0, 1.0), (1, 1.0)], vec![(1, 1.0)]], 2), None);
        assert_eq!(support(&[], 1), None);
        assert_eq!(support(&[vec![(0, -1.0)]], 1), None);
    }
}
