//! Equalities that hold in every row of recorded runs: candidates for invariants, to be proved like any other.

use std::collections::HashSet;

use super::poly::{Monomial, Poly, Var};
use stepwave_netlist::formula::{Formula, name, number};

/// A variable and what it always equals.
pub(crate) type Equality = (Var, Poly);

/// A prime near 2^61, in whose remainders ranks are worked out.
const PRIME: u64 = (1 << 61) - 1;
/// Rows that are looked at for each column.
const ROWS_A_COLUMN: usize = 40;

/// What was found in the rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Found {
    /// No polynomial uses a variable that has one.
    pub(crate) equalities: Vec<Equality>,
    /// Polynomials that are 0, of a variable that is left and that they give only as a multiple: 2f - x*x + y.
    pub(crate) zeros: Vec<Poly>,
}

/// Variables of `defined`, each as a polynomial of degree 1, and then 2, of those that are left; `flags` are not
/// multiplied. `rows` are values of all variables; earlier ones of `defined` are defined first.
pub(crate) fn equalities(rows: &[Vec<i128>], defined: &[Var], free: &[Var], flags: &[Var]) -> Found {
    let (mut found, mut zeros): (Vec<Equality>, Vec<Poly>) = (Vec::new(), Vec::new());
    let mut left: Vec<Var> = defined.to_vec();
    for degree in [1, 2] {
        if degree > 1 {
            left.retain(|var| !flags.contains(var));
        }
        let columns = monomials(free, &left, degree);
        let mut new: Vec<Equality> = Vec::new();
        for relation in relations(rows, &columns) {
            // In the relation, one variable that occurs by itself with the coefficient ±1, and in no other product.
            let relation = relation.replaced(|var| new.iter().find(|(other, _)| *other == var).map(|(_, poly)| poly));
            let Some(var) = left.iter().copied().find(|var| matches!(relation.linear_in(*var), Some(1 | -1))) else {
                let is_multiple = |var: &Var| relation.linear_in(*var).is_some_and(|factor| factor != 0);
                zeros.extend(Some(relation.clone()).filter(|_| left.iter().any(is_multiple)));
                continue;
            };
            let own = relation.linear_in(var).unwrap_or(1);
            let value = Poly::from(var).minus(&relation.times_number(own));
            for (_, poly) in &mut new {
                *poly = poly.replaced(|other| (other == var).then_some(&value));
            }
            left.retain(|other| *other != var);
            new.push((var, value));
        }
        let value = |var: Var| new.iter().find(|(other, _)| *other == var).map(|(_, value)| value);
        for poly in found.iter_mut().map(|(_, poly)| poly).chain(&mut zeros) {
            *poly = poly.replaced(value);
        }
        found.extend(new);
    }
    found.retain(|(_, poly)| !poly.is_lost());
    zeros.retain(|zero| !zero.is_lost() && zero.constant().is_none());
    Found { equalities: found, zeros }
}

/// The formula, of degree 2 at most, that gives the last number of every row from those before it, which have these
/// names; `None` if no formula fits.
#[must_use]
pub fn fit(names: &[&str], rows: &[Vec<i128>]) -> Option<Formula> {
    let free: Vec<Var> = (0..names.len()).filter_map(|place| u16::try_from(place).ok()).map(Var).collect();
    let wanted = Var(u16::try_from(names.len()).ok()?);
    let found = equalities(rows, &[wanted], &free, &[]);
    let (_, poly) = found.equalities.first()?;
    let term = |(monomial, coefficient): &(Monomial, i128)| {
        monomial.vars().fold(number(*coefficient), |product, var| product * name(names[var.index()]))
    };
    Some(poly.terms().iter().map(term).fold(number(0), |sum, term| sum + term))
}

/// Products of up to `degree` variables: what is free by itself first, products of two, and what is to be defined last,
/// so that it is expressed by the others.
fn monomials(free: &[Var], left: &[Var], degree: usize) -> Vec<Monomial> {
    let singles: Vec<Monomial> = free.iter().chain(left).map(|var| Poly::from(*var).terms()[0].0).collect();
    let (given, defined) = singles.split_at(free.len());
    let mut all = vec![Monomial::ONE];
    all.extend(given);
    if degree > 1 {
        for (index, a) in singles.iter().enumerate() {
            all.extend(singles[index..].iter().filter_map(|b| a.times(*b)));
        }
    }
    all.extend(defined);
    all
}

/// Independent relations between the columns that hold in all rows, with small whole coefficients; each expresses one
/// column by earlier ones.
fn relations(rows: &[Vec<i128>], columns: &[Monomial]) -> Vec<Poly> {
    let step = (rows.len() / (ROWS_A_COLUMN * columns.len()).max(1)).max(1);
    let mut echelon = Echelon::default();
    for row in rows.iter().step_by(step) {
        echelon.take_in(columns, row);
    }
    loop {
        let found = echelon.relations(columns);
        let holds = |relation: &Poly, row: &[i128]| relation.value(|var| row[var.index()]) == Some(0);
        // A row that was left out may select the relation that holds in all rows.
        let better = found.iter().find_map(|relation| rows.iter().find(|row| !holds(relation, row)));
        if !better.is_some_and(|row| echelon.take_in(columns, row)) {
            return found.into_iter().filter(|relation| rows.iter().all(|row| holds(relation, row))).collect();
        }
    }
}

/// A matrix in echelon form, grown row by row, each row scaled to begin with 1.
#[derive(Default)]
struct Echelon(Vec<(usize, Vec<u64>)>);

impl Echelon {
    /// Takes in a row, unless others say the same together.
    fn take_in(&mut self, columns: &[Monomial], row: &[i128]) -> bool {
        let mut values: Vec<u64> = columns.iter().map(|monomial| remainder(*monomial, row)).collect();
        for (lead, own) in &self.0 {
            let factor = values[*lead];
            if factor != 0 {
                for (value, own) in values.iter_mut().zip(own) {
                    *value = minus(*value, times(factor, *own));
                }
            }
        }
        let Some(lead) = values.iter().position(|value| *value != 0) else { return false };
        let inverse = power(values[lead], PRIME - 2);
        values.iter_mut().for_each(|value| *value = times(*value, inverse));
        for (_, other) in &mut self.0 {
            let factor = other[lead];
            if factor != 0 {
                for (value, own) in other.iter_mut().zip(&values) {
                    *value = minus(*value, times(factor, *own));
                }
            }
        }
        self.0.push((lead, values));
        true
    }

    /// Independent relations that hold in the rows taken in, but for those with large coefficients.
    fn relations(&self, columns: &[Monomial]) -> Vec<Poly> {
        let leads: HashSet<usize> = self.0.iter().map(|(lead, _)| *lead).collect();
        let relation = |free: usize| {
            // columns[free] = sum of echelon[free] * columns[lead].
            let own = self.0.iter().filter(|(_, values)| values[free] != 0);
            let fractions: Option<Vec<(Monomial, (i128, i128))>> =
                own.map(|(lead, values)| Some((columns[*lead], fraction(values[free])?))).collect();
            let fractions = fractions?;
            let common = fractions.iter().fold(1_i128, |common, (_, (_, below))| lcm(common, *below));
            let terms = fractions.iter().map(|(monomial, (above, below))| (*monomial, -above * (common / below)));
            Some(Poly::of(terms.chain([(columns[free], common)])))
        };
        (0..columns.len()).filter(|column| !leads.contains(column)).filter_map(relation).collect()
    }
}

fn remainder(monomial: Monomial, row: &[i128]) -> u64 {
    monomial.vars().fold(1, |product, var| times(product, reduced(row[var.index()])))
}

fn reduced(number: i128) -> u64 {
    u64::try_from(number.rem_euclid(i128::from(PRIME))).unwrap_or(0)
}

fn times(a: u64, b: u64) -> u64 {
    u64::try_from(u128::from(a) * u128::from(b) % u128::from(PRIME)).unwrap_or(0)
}

fn minus(a: u64, b: u64) -> u64 {
    if a >= b { a - b } else { a + (PRIME - b) }
}

fn power(mut base: u64, mut exponent: u64) -> u64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = times(result, base);
        }
        base = times(base, base);
        exponent >>= 1;
    }
    result
}

/// The fraction of small numbers that has this remainder.
fn fraction(remainder: u64) -> Option<(i128, i128)> {
    const MOST: i128 = 1 << 20;
    let (mut a, mut b) = (i128::from(PRIME), i128::from(remainder));
    let (mut s, mut t) = (0_i128, 1_i128);
    while b > MOST {
        let quotient = a / b;
        (a, b) = (b, a - quotient * b);
        (s, t) = (t, s - quotient * t);
    }
    let (above, below) = if t < 0 { (-b, -t) } else { (b, t) };
    (below > 0 && below <= MOST).then_some((above, below))
}

fn lcm(a: i128, b: i128) -> i128 {
    let gcd = |mut a: i128, mut b: i128| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    a / gcd(a, b) * b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_variable_that_is_a_product_of_others_is_found() {
        // v1 = free, v2 = free, v3 = v1*v2 - 2*v2 + 1, v4 = v1 + v2, v5 = 7.
        let rows: Vec<Vec<i128>> = (0..60_i128)
            .map(|i| {
                let (a, b) = (i * 7 % 13, i * i % 11);
                vec![0, a, b, a * b - 2 * b + 1, a + b, 7]
            })
            .collect();
        let [a, b, product, sum, seven] = [1, 2, 3, 4, 5].map(Var);
        let Found { equalities: found, zeros } = equalities(&rows, &[seven, sum, product], &[a, b], &[]);
        assert!(zeros.is_empty());
        let value = |var| found.iter().find(|(other, _)| *other == var).map(|(_, poly)| poly.clone()).unwrap();
        let (a, b) = (Poly::from(a), Poly::from(b));
        assert_eq!(value(seven), Poly::from(7));
        assert_eq!(value(sum), a.plus(&b));
        assert_eq!(value(product), a.times(&b).minus(&b.times_number(2)).plus_number(1));
    }

    #[test]
    fn a_variable_that_is_half_of_others_is_found_as_a_polynomial_that_is_0() {
        // v1 = free, v3 = (v1*v1 - v1) / 2 + v2, v2 = v1 + 3.
        let rows: Vec<Vec<i128>> = (0..40).map(|i| vec![0, i, i + 3, i * (i - 1) / 2 + i + 3]).collect();
        let [a, sum, half] = [1, 2, 3].map(Var);
        let found = equalities(&rows, &[sum, half], &[a], &[]);
        let (a, half) = (Poly::from(a), Poly::from(half));
        assert_eq!(found.equalities, [(sum, a.plus_number(3))]);
        let zero = half.times_number(2).minus(&a.times(&a)).minus(&a).plus_number(-6);
        assert!(found.zeros == [zero.clone()] || found.zeros == [zero.negated()], "{:?}", found.zeros);
    }

    #[test]
    fn a_relation_is_found_though_the_rows_looked_at_first_suggest_another() {
        // Every other row has v1 = v2; all have v3 = v2 + 1.
        let rows: Vec<Vec<i128>> = (0..2000).map(|i| vec![0, i / 2, i / 2 + i % 2, i / 2 + i % 2 + 1]).collect();
        let [a, b, more] = [1, 2, 3].map(Var);
        // No products, among which more rows would be looked at.
        let found = equalities(&rows, &[more, b], &[a], &[more, b]);
        let more = found.equalities.iter().find(|(var, _)| *var == more).map(|(_, poly)| poly.clone());
        assert_eq!(more, Some(Poly::from(b).plus_number(1)), "{found:?}");
    }

    #[test]
    fn fractions_come_back_from_their_remainders() {
        for (above, below) in [(1, 2), (-3, 7), (0, 1), (5, 1), (-1, 1)] {
            let remainder = times(reduced(above), power(reduced(below), PRIME - 2));
            assert_eq!(fraction(remainder), Some((above, below)));
        }
    }
}
