//! Formulas over named numbers, in which authors write down what they claim of registers.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

/// A polynomial with whole coefficients of named numbers: registers by their names, and what else the reader of the
/// formula knows by a name.
///
/// ```
/// use stepwave_netlist::formula::{Formula, name};
///
/// let f = name("x") * name("b") - 2 * name("a") + 1;
/// assert_eq!(f.to_string(), "b*x - 2*a + 1");
/// assert_eq!(f.value(|name| Some(if name == "x" { 5 } else { 3 })), Some(10));
/// ```
#[derive(Clone, PartialEq, Eq, Debug, Default, Hash)]
pub struct Formula {
    /// Products of names, each in alphabetical order, and their coefficients, none of them 0.
    terms: BTreeMap<Vec<String>, i128>,
}

/// Something that holds: one of several formulas is 0 or more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clause {
    /// What it is about.
    pub name: String,
    /// At least one of them is 0 or more.
    pub any: Vec<Formula>,
}

impl Clause {
    /// The formula is 0 or more.
    #[must_use]
    pub fn at_least_zero(name: &str, formula: Formula) -> Clause {
        Clause { name: name.to_owned(), any: vec![formula] }
    }

    /// The two conditions that make the formula 0.
    #[must_use]
    pub fn zero(name: &str, formula: Formula) -> [Clause; 2] {
        [Clause::at_least_zero(name, formula.clone()), Clause::at_least_zero(name, -formula)]
    }

    /// One of the formulas is 0 or more.
    #[must_use]
    pub fn either(name: &str, any: impl IntoIterator<Item = Formula>) -> Clause {
        Clause { name: name.to_owned(), any: any.into_iter().collect() }
    }

    /// Whether it holds for these values of the names; `None` where a name has no value, or beyond 128 bits.
    #[must_use]
    pub fn holds(&self, of: impl Fn(&str) -> Option<i128>) -> Option<bool> {
        let values: Option<Vec<i128>> = self.any.iter().map(|formula| formula.value(&of)).collect();
        Some(values?.into_iter().any(|value| value >= 0))
    }
}

/// The number of this name.
#[must_use]
pub fn name(name: &str) -> Formula {
    Formula { terms: BTreeMap::from([(vec![name.to_owned()], 1)]) }
}

/// A number.
#[must_use]
pub fn number(number: i128) -> Formula {
    let mut formula = Formula::default();
    formula.include(Vec::new(), number);
    formula
}

impl Formula {
    fn include(&mut self, product: Vec<String>, coefficient: i128) {
        let sum = self.terms.get(&product).copied().unwrap_or(0).saturating_add(coefficient);
        if sum == 0 {
            self.terms.remove(&product);
        } else {
            self.terms.insert(product, sum);
        }
    }

    /// Products of names and their coefficients.
    pub fn terms(&self) -> impl Iterator<Item = (&[String], i128)> {
        self.terms.iter().map(|(product, coefficient)| (&product[..], *coefficient))
    }

    /// Every name in it, each once.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.terms.keys().flatten().map(String::as_str).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Its value for these values of the names; `None` where a name has no value, or beyond 128 bits.
    #[must_use]
    pub fn value(&self, of: impl Fn(&str) -> Option<i128>) -> Option<i128> {
        self.terms.iter().try_fold(0_i128, |sum, (product, coefficient)| {
            let product = product.iter().try_fold(*coefficient, |product, name| product.checked_mul(of(name)?))?;
            sum.checked_add(product)
        })
    }

    /// Reads a formula as [`Display`](fmt::Display) writes it; `None` if the text is not a formula.
    #[must_use]
    pub fn parse(text: &str) -> Option<Formula> {
        let text = text.trim();
        let (mut sign, rest) = text.strip_prefix('-').map_or((1, text), |rest| (-1, rest));
        let mut formula = Formula::default();
        let mut words = rest.split(' ').filter(|word| !word.is_empty());
        loop {
            let (mut product, mut coefficient) = (Vec::new(), sign);
            for factor in words.next()?.split('*') {
                match factor.parse::<i128>() {
                    Ok(number) => coefficient = number.checked_mul(coefficient)?,
                    Err(_) if factor.is_empty() || factor.contains(['+', '-']) => return None,
                    Err(_) => product.push(factor.to_owned()),
                }
            }
            product.sort_unstable();
            formula.include(product, coefficient);
            sign = match words.next() {
                None => return Some(formula),
                Some("+") => 1,
                Some("-") => -1,
                Some(_) => return None,
            };
        }
    }
}

impl From<i128> for Formula {
    fn from(value: i128) -> Formula {
        number(value)
    }
}

impl Add for Formula {
    type Output = Formula;

    fn add(mut self, other: Formula) -> Formula {
        for (product, coefficient) in other.terms {
            self.include(product, coefficient);
        }
        self
    }
}

impl Neg for Formula {
    type Output = Formula;

    fn neg(mut self) -> Formula {
        self.terms.values_mut().for_each(|coefficient| *coefficient = -*coefficient);
        self
    }
}

impl Sub for Formula {
    type Output = Formula;

    fn sub(self, other: Formula) -> Formula {
        self + -other
    }
}

impl Mul for Formula {
    type Output = Formula;

    fn mul(self, other: Formula) -> Formula {
        let mut formula = Formula::default();
        for (a, m) in &self.terms {
            for (b, n) in &other.terms {
                let mut product = [&a[..], &b[..]].concat();
                product.sort_unstable();
                formula.include(product, m.saturating_mul(*n));
            }
        }
        formula
    }
}

impl Add<i128> for Formula {
    type Output = Formula;

    fn add(self, other: i128) -> Formula {
        self + number(other)
    }
}

impl Sub<i128> for Formula {
    type Output = Formula;

    fn sub(self, other: i128) -> Formula {
        self + number(-other)
    }
}

impl Mul<Formula> for i128 {
    type Output = Formula;

    fn mul(self, other: Formula) -> Formula {
        number(self) * other
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut first = true;
        // Longer products first, the number last.
        let mut terms: Vec<_> = self.terms.iter().collect();
        terms.sort_by_key(|(product, _)| std::cmp::Reverse(product.len()));
        for (product, coefficient) in terms {
            f.write_str(match (first, *coefficient < 0) {
                (true, true) => "-",
                (true, false) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            })?;
            first = false;
            match (coefficient.unsigned_abs(), product.is_empty()) {
                (1, false) => f.write_str(&product.join("*"))?,
                (number, true) => write!(f, "{number}")?,
                (number, false) => write!(f, "{number}*{}", product.join("*"))?,
            }
        }
        if first { f.write_str("0") } else { Ok(()) }
    }
}

/// A number that describes a geometry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its name in formulas.
    pub name: String,
    /// Its least value, a formula of `2^k`.
    pub least: Formula,
    /// Its greatest value, a formula of `2^k`.
    pub greatest: Formula,
}

/// A name for a number that depends on what a mode register holds, and on nothing else.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ByMode {
    /// The name in formulas.
    pub name: String,
    /// The register, by its name.
    pub register: String,
    /// The number where the register holds 0, 1, and so on.
    pub values: Vec<i128>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        for formula in [
            number(0),
            number(-3),
            name("f") - 1,
            -name("f") - 2 * name("x") * name("b"),
            7 * name("x") * name("x") + 5,
        ] {
            assert_eq!(Formula::parse(&formula.to_string()), Some(formula.clone()), "{formula}");
        }
        for wrong in ["", "-", "a +", "a b", "+ a", "a - - b", "2**a"] {
            assert_eq!(Formula::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn equal_products_are_one() {
        let formula = name("a") * name("b") - name("b") * name("a");
        assert_eq!((formula.to_string().as_str(), formula.names()), ("0", vec![]));
        assert_eq!(name("a").value(|_| None), None);
        assert_eq!((name("a") * name("a")).value(|_| Some(i128::MAX)), None);
    }
}
