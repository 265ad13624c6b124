//! Certificates that conditions cannot all hold, and their checker. The checker trusts nobody: it multiplies and adds
//! in exact arithmetic.
//!
//! A condition is a polynomial that is 0 or more. Products of two of them are 0 or more too, and so is every sum of
//! such with factors of 0 or more. If all variables drop out of the sum and a negative number is left, the conditions
//! contradict each other (Farkas; with products, the beginning of a Positivstellensatz).

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use std::collections::BTreeMap;

use super::poly::{Monomial, Poly};

/// A condition, or the product of two, with its factor in the sum.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct WeightedRow {
    /// Place of the condition in the list.
    pub(crate) row: usize,
    /// Place of the one that it is multiplied by.
    pub(crate) by: Option<usize>,
    /// 0 or more.
    pub(crate) factor: BigRational,
}

/// Why conditions cannot all hold.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Refutation {
    /// This sum is a negative number.
    Sum(Vec<WeightedRow>),
    /// One of the alternatives of this clause holds, and each contradicts the others.
    Cases {
        /// Place of the clause in the list.
        clause: usize,
        /// One for each alternative, which comes after all conditions so far.
        each: Vec<Refutation>,
    },
}

/// The product that a part stands for.
pub(crate) fn product(rows: &[Poly], row: usize, by: Option<usize>) -> Option<Poly> {
    let first = rows.get(row)?;
    let product = match by {
        Some(second) => first.times(rows.get(second)?),
        None => first.clone(),
    };
    (!product.is_lost()).then_some(product)
}

/// The refutation shows that `rows`, all of them 0 or more, cannot hold together with one alternative of every clause.
/// Each multiplication is taken off the `effort` that may still be made; where none is left, it shows nothing.
pub(crate) fn holds(refutation: &Refutation, rows: &mut Vec<Poly>, clauses: &[Vec<Poly>], effort: &mut usize) -> bool {
    match refutation {
        Refutation::Sum(parts) => is_negative(rows, parts, effort),
        Refutation::Cases { clause, each } => {
            let Some(clause) = clauses.get(*clause) else { return false };
            clause.len() == each.len()
                && clause.iter().zip(each).all(|(alternative, refutation)| {
                    rows.push(alternative.clone());
                    let held = holds(refutation, rows, clauses, effort);
                    rows.pop();
                    held
                })
        }
    }
}

fn is_negative(rows: &[Poly], parts: &[WeightedRow], effort: &mut usize) -> bool {
    let mut sum: BTreeMap<Monomial, BigRational> = BTreeMap::new();
    for part in parts {
        let terms = |row| rows.get(row).map_or(1, |row: &Poly| row.terms().len());
        let Some(left) = effort.checked_sub(terms(part.row) * part.by.map_or(1, terms)) else { return false };
        *effort = left;
        if part.factor.is_negative() {
            return false;
        }
        let Some(product) = product(rows, part.row, part.by) else { return false };
        for (monomial, coefficient) in product.terms() {
            let own = sum.entry(*monomial).or_insert_with(BigRational::zero);
            // To bring two fractions to one denominator takes about the square of its bits.
            let bits = usize::try_from(own.denom().bits() + part.factor.denom().bits()).unwrap_or(usize::MAX);
            let Some(left) = effort.checked_sub(bits.saturating_mul(bits) / 2048) else { return false };
            *effort = left;
            *own += &part.factor * BigRational::from(BigInt::from(*coefficient));
        }
    }
    sum.retain(|_, coefficient| !coefficient.is_zero());
    match (sum.len(), sum.get(&Monomial::ONE)) {
        (1, Some(number)) => number.is_negative(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::poly::Var;
    use super::*;

    fn part(row: usize, by: Option<usize>, factor: i64) -> WeightedRow {
        WeightedRow { row, by, factor: BigRational::from(BigInt::from(factor)) }
    }

    /// x - 1, y - 2, 1 - x*y: each 0 or more.
    fn rows() -> Vec<Poly> {
        let (x, y) = (Poly::from(Var(1)), Poly::from(Var(2)));
        vec![x.plus_number(-1), y.plus_number(-2), Poly::from(1).minus(&x.times(&y))]
    }

    #[test]
    fn a_sum_that_comes_to_a_negative_number_is_a_contradiction() {
        // (x - 1)(y - 2) + (1 - x*y) + 2 (x - 1) + (y - 2) = -1
        let right = vec![part(0, Some(1), 1), part(2, None, 1), part(0, None, 2), part(1, None, 1)];
        assert!(holds(&Refutation::Sum(right.clone()), &mut rows(), &[], &mut 1000));
        for place in 0..right.len() {
            let mut wrong = right.clone();
            wrong[place].factor += BigRational::from(BigInt::from(1));
            assert!(!holds(&Refutation::Sum(wrong), &mut rows(), &[], &mut 1000));
            let mut wrong = right.clone();
            wrong[place].factor = -wrong[place].factor.clone();
            assert!(!holds(&Refutation::Sum(wrong), &mut rows(), &[], &mut 1000));
        }
        assert!(!holds(&Refutation::Sum(right.clone()), &mut rows(), &[], &mut 5), "too much to multiply");
        assert!(!holds(&Refutation::Sum(vec![part(7, None, 1)]), &mut rows(), &[], &mut 1000));
        assert!(!holds(&Refutation::Sum(Vec::new()), &mut rows(), &[], &mut 1000));
    }

    #[test]
    fn every_alternative_of_a_clause_must_be_refuted() {
        let x = Poly::from(Var(1));
        let clauses = [vec![x.plus_number(-3), x.negated().plus_number(-3)]];
        let within = vec![x.plus_number(2), Poly::from(2).minus(&x)];
        let each = vec![
            Refutation::Sum(vec![part(1, None, 1), part(2, None, 1)]),
            Refutation::Sum(vec![part(0, None, 1), part(2, None, 1)]),
        ];
        let whole = Refutation::Cases { clause: 0, each: each.clone() };
        assert!(holds(&whole, &mut within.clone(), &clauses, &mut 1000));
        let half = Refutation::Cases { clause: 0, each: each[..1].to_vec() };
        assert!(!holds(&half, &mut within.clone(), &clauses, &mut 1000));
        assert!(!holds(&Refutation::Cases { clause: 1, each }, &mut within.clone(), &clauses, &mut 1000));
    }
}
