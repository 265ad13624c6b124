//! Finds factors of 0 or more with which columns add up to a wanted column, in floating point: a guess that is worked
//! out exactly afterwards.

/// Columns of the same height, each sparse: (row, value).
pub(crate) type Columns = [Vec<(usize, f64)>];

/// Numbers nearer to 0 than this count as 0.
const TINY: f64 = 1e-9;

/// Which columns to take so that a sum of them with factors of 0 or more has 1 in row 0 and 0 in all others; at most
/// `height` many. `None` if there are none, or if the arithmetic was not good enough to find them.
///
/// The simplex algorithm, phase one: every row begins with a column of its own, which must go. Only row 0 wants
/// something, so that nearly every step would gain nothing and could cycle forever: so each row demands a little of
/// its own in addition, infinitely less than anything in the columns, by which every step gains.
pub(crate) fn support(columns: &Columns, height: usize) -> Option<Vec<usize>> {
    let width = columns.len() + 2;
    let (wanted, little) = (columns.len(), columns.len() + 1);
    // Row by row, the wanted column and the little ones last. The cost row is below: what is still missing.
    let mut table = vec![0.0; (height + 1) * width];
    for (column, entries) in columns.iter().enumerate() {
        for &(row, value) in entries {
            table[row * width + column] = value;
        }
    }
    table[wanted] = 1.0;
    let mut random = 0x2545_F491_4F6C_DD1D_u64;
    for row in 0..height {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        #[allow(clippy::cast_precision_loss, reason = "any number from 1 to 2")]
        let any = 1.0 + (random >> 12) as f64 / (1_u64 << 52) as f64;
        table[row * width + little] = any;
    }
    let mut basis: Vec<Option<usize>> = vec![None; height];
    // A row whose own column is still there costs what it holds; only row 0 holds something.
    for column in 0..width {
        table[height * width + column] = (0..height).map(|row| table[row * width + column]).sum();
    }
    for _ in 0..40 * (height + 10) {
        if table[height * width + wanted] < TINY {
            return Some(basis.into_iter().flatten().collect());
        }
        let entering = entering(&table[height * width..][..columns.len()])?;
        let leaving = leaving(&table, width, height, entering)?;
        pivot(&mut table, width, height, leaving, entering);
        basis[leaving] = Some(entering);
    }
    None
}

/// The column that lowers what is missing most.
fn entering(costs: &[f64]) -> Option<usize> {
    let best = costs.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    (*best.1 > TINY).then_some(best.0)
}

/// The row whose column makes room: the first to come to 0, of several the first by the little that it wants.
fn leaving(table: &[f64], width: usize, height: usize, entering: usize) -> Option<usize> {
    let mut best: Option<(usize, [f64; 2])> = None;
    for row in 0..height {
        let own = &table[row * width..][..width];
        if own[entering] <= TINY {
            continue;
        }
        let ratio = [own[width - 2], own[width - 1]].map(|held| held / own[entering]);
        let sooner =
            best.is_none_or(
                |(_, least)| {
                    if (ratio[0] - least[0]).abs() > TINY { ratio[0] < least[0] } else { ratio[1] < least[1] }
                },
            );
        if sooner {
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
