//! Polynomials with whole coefficients: what a register holds, as a function of what it held before.

use std::fmt::Write as _;

/// A variable: an unknown whole number.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Var(pub(crate) u16);

impl Var {
    /// Its number in the table of variables.
    #[must_use]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// A product of up to four variables: their numbers plus 1 in 16 bits each, the greatest highest; 0 is the product of
/// none.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) struct Monomial(u64);

impl Monomial {
    /// The product of no variables.
    pub(crate) const ONE: Monomial = Monomial(0);

    /// How many variables are multiplied.
    pub(crate) fn degree(self) -> usize {
        self.vars().count()
    }

    /// The variables, each as often as it is a factor.
    pub(crate) fn vars(self) -> impl Iterator<Item = Var> {
        (0..4).filter_map(move |place| match self.0 >> (16 * place) & 0xffff {
            0 => None,
            #[allow(clippy::cast_possible_truncation, reason = "16 bits were cut out")]
            number => Some(Var((number - 1) as u16)),
        })
    }

    fn of(mut numbers: Vec<u16>) -> Option<Monomial> {
        if numbers.len() > 4 {
            return None;
        }
        numbers.sort_unstable();
        Some(Monomial(numbers.iter().fold(0, |packed, number| packed << 16 | (u64::from(*number) + 1))))
    }

    /// The product of both; `None` beyond four variables.
    pub(crate) fn times(self, other: Monomial) -> Option<Monomial> {
        if self == Monomial::ONE {
            return Some(other);
        }
        Monomial::of(self.vars().chain(other.vars()).map(|var| var.0).collect())
    }
}

/// A sum of products of variables with whole coefficients.
///
/// Whatever leads beyond 128 bits or four factors gives a polynomial that is [`lost`](Poly::is_lost): nothing is known
/// of its value, nothing may be concluded from it.
#[derive(Clone, PartialEq, Eq, Hash, Debug, Default)]
pub struct Poly {
    /// In the order of the products, none with coefficient 0.
    terms: Vec<(Monomial, i128)>,
    lost: bool,
}

impl From<i128> for Poly {
    fn from(number: i128) -> Poly {
        Poly { terms: if number == 0 { Vec::new() } else { vec![(Monomial::ONE, number)] }, lost: false }
    }
}

impl From<Var> for Poly {
    fn from(var: Var) -> Poly {
        Poly { terms: vec![(Monomial(u64::from(var.0) + 1), 1)], lost: false }
    }
}

impl Poly {
    pub(crate) fn lost() -> Poly {
        Poly { terms: Vec::new(), lost: true }
    }

    /// Nothing is known of its value.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.lost
    }

    /// The sum of these products.
    pub(crate) fn of(terms: impl IntoIterator<Item = (Monomial, i128)>) -> Poly {
        let mut terms: Vec<_> = terms.into_iter().collect();
        terms.sort_unstable_by_key(|(monomial, _)| *monomial);
        let mut sum: Vec<(Monomial, i128)> = Vec::with_capacity(terms.len());
        for (monomial, coefficient) in terms {
            match sum.last_mut() {
                Some((last, total)) if *last == monomial => match total.checked_add(coefficient) {
                    Some(both) => *total = both,
                    None => return Poly::lost(),
                },
                _ => sum.push((monomial, coefficient)),
            }
        }
        sum.retain(|(_, coefficient)| *coefficient != 0);
        Poly { terms: sum, lost: false }
    }

    /// Products and their coefficients.
    pub(crate) fn terms(&self) -> &[(Monomial, i128)] {
        &self.terms
    }

    /// The number that it is for all values of the variables; `None` if it depends on them.
    #[must_use]
    pub fn constant(&self) -> Option<i128> {
        match self.terms[..] {
            _ if self.lost => None,
            [] => Some(0),
            [(Monomial::ONE, number)] => Some(number),
            _ => None,
        }
    }

    /// The most factors of a product.
    pub(crate) fn degree(&self) -> usize {
        self.terms.iter().map(|(monomial, _)| monomial.degree()).max().unwrap_or(0)
    }

    /// Sum.
    #[must_use]
    pub fn plus(&self, other: &Poly) -> Poly {
        if self.lost || other.lost {
            return Poly::lost();
        }
        Poly::of(self.terms.iter().chain(&other.terms).copied())
    }

    /// Difference.
    #[must_use]
    pub fn minus(&self, other: &Poly) -> Poly {
        self.plus(&other.times_number(-1))
    }

    /// Negative.
    #[must_use]
    pub fn negated(&self) -> Poly {
        self.times_number(-1)
    }

    /// A number more.
    #[must_use]
    pub fn plus_number(&self, number: i128) -> Poly {
        self.plus(&Poly::from(number))
    }

    /// The polynomial times a number.
    #[must_use]
    pub fn times_number(&self, number: i128) -> Poly {
        let terms: Option<Vec<_>> = self
            .terms
            .iter()
            .map(|(monomial, coefficient)| Some((*monomial, coefficient.checked_mul(number)?)))
            .collect();
        match terms {
            Some(terms) if !self.lost => Poly::of(terms),
            _ => Poly::lost(),
        }
    }

    /// Product.
    #[must_use]
    pub fn times(&self, other: &Poly) -> Poly {
        if self.lost || other.lost {
            return Poly::lost();
        }
        let mut terms = Vec::with_capacity(self.terms.len() * other.terms.len());
        for (a, m) in &self.terms {
            for (b, n) in &other.terms {
                match (a.times(*b), m.checked_mul(*n)) {
                    (Some(monomial), Some(coefficient)) => terms.push((monomial, coefficient)),
                    _ => return Poly::lost(),
                }
            }
        }
        Poly::of(terms)
    }

    /// With a polynomial in place of each variable for which `value` has one.
    #[must_use]
    pub fn replaced<'a>(&self, value: impl Fn(Var) -> Option<&'a Poly>) -> Poly {
        if self.lost {
            return Poly::lost();
        }
        let untouched = |monomial: &Monomial| monomial.vars().all(|var| value(var).is_none());
        let mut sum = Poly::of(self.terms.iter().filter(|(monomial, _)| untouched(monomial)).copied());
        for (monomial, coefficient) in self.terms.iter().filter(|(monomial, _)| !untouched(monomial)) {
            let mut product = Poly::from(*coefficient);
            for var in monomial.vars() {
                product = match value(var) {
                    Some(poly) => product.times(poly),
                    None => product.times(&Poly::from(var)),
                };
            }
            sum = sum.plus(&product);
        }
        sum
    }

    /// Its value where the variables have these; `None` beyond 128 bits.
    #[must_use]
    pub fn value(&self, of: impl Fn(Var) -> i128) -> Option<i128> {
        if self.lost {
            return None;
        }
        self.terms.iter().try_fold(0_i128, |sum, (monomial, coefficient)| {
            let product = monomial.vars().try_fold(*coefficient, |product, var| product.checked_mul(of(var)))?;
            sum.checked_add(product)
        })
    }

    /// The variables that it depends on, each once.
    pub(crate) fn vars(&self) -> Vec<Var> {
        let mut vars: Vec<Var> = self.terms.iter().flat_map(|(monomial, _)| monomial.vars()).collect();
        vars.sort_unstable();
        vars.dedup();
        vars
    }

    /// Coefficient of a variable by itself, if the variable is not a factor of another product.
    pub(crate) fn linear_in(&self, var: Var) -> Option<i128> {
        let mut with = self.terms.iter().filter(|(monomial, _)| monomial.vars().any(|other| other == var));
        match (with.next(), with.next()) {
            (Some((monomial, coefficient)), None) if monomial.degree() == 1 => Some(*coefficient),
            _ => None,
        }
    }

    /// In the words of algebra, with these names: `xe*y - ye*x + 1`.
    #[must_use]
    pub fn display(&self, name: impl Fn(Var) -> String) -> String {
        if self.lost {
            return "(unknown)".to_owned();
        }
        let mut text = String::new();
        // Products before the number, as one writes them.
        for (monomial, coefficient) in self.terms.iter().rev() {
            let sign = match (text.is_empty(), *coefficient < 0) {
                (true, true) => "-",
                (true, false) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            };
            let factors: Vec<String> = monomial.vars().map(&name).collect();
            let product = match (coefficient.unsigned_abs(), factors.is_empty()) {
                (1, false) => factors.join("*"),
                (number, true) => number.to_string(),
                (number, false) => format!("{number}*{}", factors.join("*")),
            };
            // Writing to a string cannot fail.
            let _ = write!(text, "{sign}{product}");
        }
        if text.is_empty() { "0".to_owned() } else { text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn var(number: u16) -> Poly {
        Poly::from(Var(number))
    }

    fn name(var: Var) -> String {
        ["x", "y", "z"][var.index()].to_owned()
    }

    #[test]
    fn products_and_sums_come_to_a_normal_form() {
        let (x, y) = (var(0), var(1));
        let square = x.plus(&y).times(&x.minus(&y));
        assert_eq!(square, x.times(&x).minus(&y.times(&y)));
        assert_eq!(square.plus_number(-3).display(name), "-y*y + x*x - 3");
        assert_eq!(square.value(|v| [7, 3, 0][v.index()]), Some(40));
        assert_eq!(x.minus(&x).constant(), Some(0));
    }

    #[test]
    fn what_leads_too_far_is_lost_and_says_so() {
        let fourth = var(0).times(&var(0)).times(&var(1)).times(&var(1));
        assert!(!fourth.is_lost() && fourth.degree() == 4);
        assert!(fourth.times(&var(2)).is_lost());
        let large = Poly::from(i128::MAX);
        assert!(large.plus_number(1).is_lost() && large.times_number(2).constant().is_none());
    }

    #[test]
    fn a_variable_is_replaced_in_every_product() {
        let (x, y, z) = (var(0), var(1), var(2));
        let poly = x.times(&x).plus(&x.times(&y)).plus(&z);
        let sum = y.plus_number(1);
        let replaced = poly.replaced(|v| (v == Var(0)).then_some(&sum));
        assert_eq!(replaced, sum.times(&sum).plus(&sum.times(&y)).plus(&z));
        assert_eq!((poly.linear_in(Var(2)), poly.linear_in(Var(0)), poly.linear_in(Var(1))), (Some(1), None, None));
    }
}
