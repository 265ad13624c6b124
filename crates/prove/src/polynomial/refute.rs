//! Looks for contradictions: which products of conditions to add up, found in floating point and worked out exactly.

use num_traits::Zero;
use rustc_hash::{FxHashMap, FxHashSet};

use super::farkas::{Refutation, WeightedRow, holds, product};
use super::poly::{Monomial, Poly};
use super::{exact, simplex};

/// How hard to look.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Effort {
    /// Sums of conditions: to leave out branches that cannot be taken.
    Sums,
    /// Products of two conditions too, and all alternatives of clauses: to prove a claim.
    All,
}

/// Products of two conditions that are tried at most.
const MOST_PRODUCTS: usize = 1400;
/// Sums of products that are looked for to show one contradiction.
const MOST_SUMS: usize = 300;
/// Depth to which clauses are split one inside another.
const DEEPEST: usize = 5;

/// A contradiction in `rows`, all 0 or more, of which those from `own` on are what matters most, and clauses of which
/// one alternative holds.
/// Looked for are at most `budget` sums of products, which are taken off it.
pub(crate) fn refute(
    rows: &[Poly],
    own: usize,
    clauses: &[Vec<Poly>],
    effort: Effort,
    budget: &mut usize,
) -> Option<Refutation> {
    if let Some(found) = sum(rows, &singles(rows)) {
        return Some(found);
    }
    if effort == Effort::Sums {
        return None;
    }
    let open: Vec<usize> = (0..clauses.len()).collect();
    let mut own_budget = (*budget).min(MOST_SUMS);
    *budget -= own_budget;
    let found = cases(&mut rows.to_vec(), own, clauses, &open, 0, &mut own_budget);
    *budget += own_budget;
    found
}

/// Sums, then products, then one clause after another split.
fn cases(
    rows: &mut Vec<Poly>,
    own: usize,
    clauses: &[Vec<Poly>],
    open: &[usize],
    depth: usize,
    budget: &mut usize,
) -> Option<Refutation> {
    *budget = budget.checked_sub(1)?;
    if depth > 0
        && let Some(found) = sum(rows, &singles(rows))
    {
        return Some(found);
    }
    if let Some(found) = sum(rows, &products(rows, own)) {
        return Some(found);
    }
    if depth == DEEPEST {
        return None;
    }
    // First the clauses of which most alternatives are out at once.
    let mut ranked: Vec<(usize, usize)> = Vec::new();
    for &clause in open {
        let mut alive = 0;
        for alternative in &clauses[clause] {
            rows.push(alternative.clone());
            alive += usize::from(sum(rows, &singles(rows)).is_none());
            rows.pop();
        }
        // A clause with an alternative that holds already changes nothing and need not be split.
        let idle = clauses[clause].iter().any(|alternative| rows.contains(alternative));
        if !idle {
            ranked.push((alive, clause));
        }
    }
    ranked.sort_unstable();
    'clause: for &(alive, clause) in &ranked {
        let rest: Vec<usize> = open.iter().copied().filter(|other| *other != clause).collect();
        let mut each = Vec::new();
        for alternative in &clauses[clause] {
            rows.push(alternative.clone());
            let found = cases(rows, own, clauses, &rest, depth + 1, budget);
            rows.pop();
            match found {
                Some(found) => each.push(found),
                // The other clauses were tried inside, but for those that are decided at once.
                None if alive > 1 || depth > 0 => return None,
                None => continue 'clause,
            }
        }
        return Some(Refutation::Cases { clause, each });
    }
    None
}

type Product = (usize, Option<usize>);

fn singles(rows: &[Poly]) -> Vec<Product> {
    (0..rows.len()).map(|row| (row, None)).collect()
}

/// Every condition, and products of two: first those of conditions that matter most.
fn products(rows: &[Poly], own: usize) -> Vec<Product> {
    let most = rows[own..].iter().map(Poly::degree).max().unwrap_or(1).max(2);
    let factors = factors(rows);
    let mut chosen = singles(rows);
    let room = MOST_PRODUCTS.saturating_sub(chosen.len());
    let pairs = factors.iter().enumerate().flat_map(|(place, row)| factors[..=place].iter().map(move |by| (*by, *row)));
    let low = |(row, by): &(usize, usize)| rows[*row].degree() + rows[*by].degree() <= most;
    // A late condition with all others comes before two early ones.
    let mut pairs: Vec<(usize, usize)> = pairs.filter(low).collect();
    pairs.sort_by_key(|(first, second)| std::cmp::Reverse((*second >= own, *first >= own)));
    chosen.extend(pairs.into_iter().take(room).map(|(row, by)| (row, Some(by))));
    chosen
}

/// Conditions that are worth multiplying, each once: those of numbers that others speak of too.
fn factors(rows: &[Poly]) -> Vec<usize> {
    let mut met: FxHashSet<super::poly::Var> = FxHashSet::default();
    for row in rows {
        let vars = row.vars();
        if vars.len() > 1 || row.degree() > 1 {
            met.extend(vars);
        }
    }
    let mut seen = FxHashSet::default();
    (0..rows.len())
        .filter(|place| {
            let row = &rows[*place];
            row.constant().is_none() && row.vars().iter().all(|var| met.contains(var)) && seen.insert(row)
        })
        .collect()
}

/// A sum of these products that is a negative number.
fn sum(rows: &[Poly], candidates: &[Product]) -> Option<Refutation> {
    let mut seen = FxHashSet::default();
    let mut columns: Vec<(Product, Poly)> = Vec::with_capacity(candidates.len());
    for &(row, by) in candidates {
        let Some(poly) = product(rows, row, by) else { continue };
        if poly.constant().is_some_and(|number| number >= 0) || !seen.insert(poly.clone()) {
            continue;
        }
        columns.push(((row, by), poly));
    }
    prune(&mut columns);
    let mut numbers: FxHashMap<Monomial, usize> = std::iter::once((Monomial::ONE, 0)).collect();
    let sparse: Vec<Vec<(usize, f64)>> = columns
        .iter()
        .map(|(_, poly)| {
            let entry = |(monomial, coefficient): &(Monomial, i128)| {
                let next = numbers.len();
                let row = *numbers.entry(*monomial).or_insert(next);
                // The sum is to be -1.
                let sign = if row == 0 { -1.0 } else { 1.0 };
                (row, sign * *coefficient as f64)
            };
            poly.terms().iter().map(entry).collect()
        })
        .collect();
    let support = simplex::support(&sparse, numbers.len())?;
    let polys: Vec<&Poly> = support.iter().map(|column| &columns[*column].1).collect();
    let factors = exact::factors(&polys)?;
    let parts = support.iter().zip(factors).filter(|(_, factor)| !factor.is_zero());
    let parts = parts.map(|(column, factor)| {
        let ((row, by), _) = columns[*column];
        WeightedRow { row, by, factor }
    });
    let found = Refutation::Sum(parts.collect());
    holds(&found, &mut rows.to_vec(), &[], &mut { usize::MAX }).then_some(found)
}

/// Takes out what has a product that nothing can take away again: of one sign in all columns.
fn prune(columns: &mut Vec<(Product, Poly)>) {
    loop {
        let mut signs: FxHashMap<Monomial, (bool, bool)> = FxHashMap::default();
        for (_, poly) in columns.iter() {
            for (monomial, coefficient) in poly.terms().iter().filter(|(monomial, _)| *monomial != Monomial::ONE) {
                let sign = signs.entry(*monomial).or_default();
                if *coefficient > 0 { sign.0 = true } else { sign.1 = true }
            }
        }
        let before = columns.len();
        columns.retain(|(_, poly)| {
            poly.terms().iter().all(|(monomial, _)| *monomial == Monomial::ONE || signs[monomial] == (true, true))
        });
        if columns.len() == before {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::poly::Var;
    use super::*;

    fn var(number: u16) -> Poly {
        Poly::from(Var(number))
    }

    #[test]
    fn a_product_of_two_conditions_is_found_where_one_is_needed() {
        // x >= 1, y >= 2, x*y <= 1.
        let rows = [var(1).plus_number(-1), var(2).plus_number(-2), Poly::from(1).minus(&var(1).times(&var(2)))];
        assert_eq!(refute(&rows, 0, &[], Effort::Sums, &mut 9), None);
        let found = refute(&rows, 0, &[], Effort::All, &mut 9).unwrap();
        assert!(holds(&found, &mut rows.to_vec(), &[], &mut { usize::MAX }));
        // x*y <= 2 can be.
        let rows = [var(1).plus_number(-1), var(2).plus_number(-2), Poly::from(2).minus(&var(1).times(&var(2)))];
        assert_eq!(refute(&rows, 0, &[], Effort::All, &mut 9), None);
    }

    #[test]
    fn a_sum_of_many_products_is_found_where_nearly_every_step_towards_it_gains_nothing() {
        // An arc from (xs, ys) to (xt, yt) has come to (x, y), x to its end, so that 2f is x*x - x + y*y + y less the
        // same of the start; f - y is below the range of four times 2h.
        let [h, xs, ys, xt, yt, f, x, y] = [0, 1, 2, 3, 4, 5, 6, 7].map(var);
        let square = |a: &Poly| a.times(a);
        let circle = square(&xs).plus(&square(&ys)).minus(&square(&xt)).minus(&square(&yt));
        let gain = square(&x).minus(&x).plus(&square(&y)).plus(&y);
        let twice = gain.minus(&square(&xs).minus(&xs).plus(&square(&ys)).plus(&ys)).minus(&f.times_number(2));
        let most = h.times_number(2).plus_number(-1);
        let mut rows = vec![h.plus_number(-4)];
        rows.extend([&xs, &ys, &xt, &yt, &x, &y].into_iter().flat_map(|a| [a.clone(), most.minus(a)]));
        rows.extend([f.plus(&h.times_number(4)), h.times_number(4).minus(&f).plus_number(-1)]);
        rows.extend([x.plus(&h.times_number(4)), y.plus(&h.times_number(4)), xt.minus(&x), y.minus(&yt)]);
        rows.extend([circle.clone(), circle.negated(), twice.clone(), twice.negated()]);
        rows.extend([xt.minus(&xs), ys.minus(&yt), ys.clone(), xt.clone(), y.clone()].map(|a| a.plus_number(-1)));
        rows.extend([x.minus(&f), y.minus(&x), y.minus(&x).minus(&yt).plus(&xt).plus_number(-1)]);
        let own = rows.len();
        rows.extend([x.minus(&xt), y.minus(&yt).plus_number(-1), y.minus(&x).plus_number(-1)]);
        rows.push(y.minus(&f).minus(&h.times_number(4)).plus_number(-1));
        let found = refute(&rows, own, &[], Effort::All, &mut 1).unwrap();
        assert!(holds(&found, &mut rows.clone(), &[], &mut { usize::MAX }));
        // Without the circle f may be anything.
        rows.retain(|row| *row != circle && *row != circle.negated());
        assert_eq!(refute(&rows, own - 2, &[], Effort::All, &mut 1), None);
    }

    #[test]
    fn clauses_are_taken_apart() {
        let x = var(1);
        let clauses = [vec![x.plus_number(-3), x.negated().plus_number(-3)]];
        let within = [x.plus_number(2), Poly::from(2).minus(&x)];
        let found = refute(&within, 0, &clauses, Effort::All, &mut 9).unwrap();
        assert!(holds(&found, &mut within.to_vec(), &clauses, &mut { usize::MAX }));
        assert_eq!(refute(&within[..1], 0, &clauses, Effort::All, &mut 9), None);
    }
}
