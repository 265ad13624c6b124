//! Linear equations in exact arithmetic.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{CheckedDiv, CheckedMul, CheckedSub, Signed, Zero};

use super::poly::{Monomial, Poly};

/// Factors of 0 or more with which the polynomials add up to -1. Numbers of 128 bits are nearly always enough, and much faster.
pub(crate) fn factors(polys: &[&Poly]) -> Option<Vec<BigRational>> {
    let equations = equations(polys);
    let found = solution(equations.clone()).or_else(|TooLarge| {
        let large = |row: Vec<i128>| row.into_iter().map(BigInt::from).collect();
        solution::<BigInt>(equations.into_iter().map(large).collect())
    });
    found.ok().flatten().filter(|factors| factors.iter().all(|factor| !factor.is_negative()))
}

/// A row for each product: its coefficient in each polynomial, and what the sum is to have.
fn equations(polys: &[&Poly]) -> Vec<Vec<i128>> {
    let mut monomials: Vec<Monomial> =
        polys.iter().flat_map(|poly| poly.terms()).map(|(monomial, _)| *monomial).collect();
    monomials.push(Monomial::ONE);
    monomials.sort_unstable();
    monomials.dedup();
    let row = |monomial: &Monomial| {
        let coefficient = |poly: &&Poly| {
            let term = poly.terms().iter().find(|(other, _)| other == monomial);
            term.map_or(0, |(_, coefficient)| *coefficient)
        };
        let wanted = if *monomial == Monomial::ONE { -1 } else { 0 };
        polys.iter().map(coefficient).chain([wanted]).collect()
    };
    monomials.iter().map(row).collect()
}

/// A number does not fit.
#[derive(Debug)]
struct TooLarge;

/// A solution of equations whose last column is what the others, each times its unknown, add up to; unknowns that nothing
/// determines are 0. `None` if there is none.
///
/// Fraction-free elimination (E. H. Bareiss, 1968): what is divided by is a factor of all numbers, and after each step the same
/// number is in front of every unknown that is solved for.
fn solution<T>(mut rows: Vec<Vec<T>>) -> Result<Option<Vec<BigRational>>, TooLarge>
where
    T: Clone + Zero + CheckedMul + CheckedSub + CheckedDiv + From<i8> + Into<BigInt>,
{
    let width = rows.first().map_or(0, |row| row.len().saturating_sub(1));
    let (mut pivots, mut before) = (Vec::new(), T::from(1));
    for column in 0..width {
        let start = pivots.len();
        let Some(found) = (start..rows.len()).find(|row| !rows[*row][column].is_zero()) else { continue };
        rows.swap(start, found);
        let pivot = rows[start].clone();
        let lead = &pivot[column];
        for row in rows.iter_mut().enumerate().filter(|(index, _)| *index != start).map(|(_, row)| row) {
            let factor = row[column].clone();
            for (value, own) in row.iter_mut().zip(&pivot).filter(|(value, own)| !(value.is_zero() && own.is_zero())) {
                let product = factor.checked_mul(own).ok_or(TooLarge)?;
                let left = lead.checked_mul(value).and_then(|value| value.checked_sub(&product)).ok_or(TooLarge)?;
                *value = left.checked_div(&before).ok_or(TooLarge)?;
            }
        }
        before = lead.clone();
        pivots.push(column);
    }
    if rows[pivots.len()..].iter().any(|row| !row[width].is_zero()) {
        return Ok(None);
    }
    let mut found = vec![BigRational::zero(); width];
    for (row, column) in rows.into_iter().zip(pivots) {
        found[column] = BigRational::new(row[width].clone().into(), before.clone().into());
    }
    Ok(Some(found))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// What is left of each equation.
    fn left(rows: &[Vec<i128>], found: &[BigRational]) -> Vec<BigRational> {
        let rational = |number: i128| BigRational::from(BigInt::from(number));
        let left = |row: &Vec<i128>| {
            let sum: BigRational = row.iter().zip(found).map(|(own, found)| rational(*own) * found).sum();
            sum - rational(row[found.len()])
        };
        rows.iter().map(left).collect()
    }

    proptest! {
        /// Equations made from a solution have one, in small numbers and in large ones the same.
        #[test]
        fn a_solution_solves(
            rows in prop::collection::vec(prop::collection::vec(-9_i128..10, 5), 1..8),
            own in prop::collection::vec(-7_i128..8, 5),
            scale in prop::sample::select(vec![1_i128, 1 << 60, 1 << 100]),
        ) {
            let mut rows = rows;
            for row in &mut rows {
                let sum: i128 = row.iter().zip(&own).map(|(a, b)| a * b).sum();
                row.push(sum);
                row.iter_mut().for_each(|value| *value *= scale);
            }
            let large = rows.iter().map(|row| row.iter().map(|value| BigInt::from(*value)).collect()).collect();
            let found = solution::<BigInt>(large).unwrap().unwrap();
            prop_assert!(left(&rows, &found).iter().all(Zero::is_zero));
            match solution(rows) {
                Ok(small) => prop_assert_eq!(small, Some(found)),
                Err(TooLarge) => prop_assert!(scale > 1),
            }
        }
    }

    #[test]
    fn equations_that_contradict_each_other_have_no_solution() {
        assert_eq!(solution(vec![vec![1_i128, 2, 3], vec![2, 4, 7]]).unwrap(), None);
        assert!(solution(vec![vec![0_i128, 0, 0]]).unwrap().is_some());
    }
}
