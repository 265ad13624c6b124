//! The unknowns of a proof: their names, and the ranges that they lie in by themselves.

use super::family::Family;
use super::poly::{Poly, Var};

/// An unknown whole number.
#[derive(Clone, Debug)]
struct Variable {
    name: String,
    /// Least and greatest value, as numbers or multiples of the scale; `None` where there is none.
    least: Option<Poly>,
    greatest: Option<Poly>,
    /// Bit of a number that is held bit by bit: 0 or 1.
    bit: bool,
}

/// A table of unknowns. The first is the [scale](Family::SCALE).
#[derive(Clone, Debug)]
pub(crate) struct Variables {
    all: Vec<Variable>,
    least_scale: i128,
}

impl Variables {
    /// With nothing but the scale.
    pub(crate) fn new(scale_name: String, least_scale: i128) -> Variables {
        let scale = Variable { name: scale_name, least: Some(Poly::from(least_scale)), greatest: None, bit: false };
        Variables { all: vec![scale], least_scale }
    }

    /// A new unknown; `None` beyond 65,534.
    pub(crate) fn add(&mut self, name: String, least: Option<Poly>, greatest: Option<Poly>) -> Option<Var> {
        let number = u16::try_from(self.all.len()).ok().filter(|number| *number < u16::MAX)?;
        let bit = least == Some(Poly::from(0)) && greatest == Some(Poly::from(1));
        self.all.push(Variable { name, least, greatest, bit });
        Some(Var(number))
    }

    /// A new unknown from 0 to `greatest`.
    pub(crate) fn fresh(&mut self, name: &str, greatest: Poly) -> Option<Var> {
        let name = format!("{name}.{}", self.all.len());
        self.add(name, Some(Poly::from(0)), Some(greatest))
    }

    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    pub(crate) fn name(&self, var: Var) -> String {
        self.all[var.index()].name.clone()
    }

    /// The unknown of this name.
    pub(crate) fn find(&self, name: &str) -> Option<Var> {
        let place = self.all.iter().position(|variable| variable.name == name)?;
        u16::try_from(place).ok().map(Var)
    }

    /// The conditions, each 0 or more, that the ranges of these unknowns are.
    pub(crate) fn ranges(&self, vars: impl Iterator<Item = Var>) -> Vec<Poly> {
        let mut rows = Vec::new();
        for var in vars {
            let Variable { least, greatest, .. } = &self.all[var.index()];
            let own = Poly::from(var);
            rows.extend(least.as_ref().map(|least| own.minus(least)));
            rows.extend(greatest.as_ref().map(|greatest| greatest.minus(&own)));
        }
        rows
    }

    /// Least and greatest value of a polynomial, as polynomials of the scale.
    fn interval(&self, poly: &Poly) -> (Option<Poly>, Option<Poly>) {
        let (mut least, mut greatest) = (Some(Poly::from(0)), Some(Poly::from(0)));
        for (monomial, coefficient) in poly.terms() {
            let (mut low, mut high) = (Some(Poly::from(1)), Some(Poly::from(1)));
            let single = monomial.degree() == 1;
            for var in monomial.vars() {
                let own = Poly::from(var);
                let Variable { least, greatest, .. } = &self.all[var.index()];
                let (a, b) = if var == Family::SCALE {
                    (Some(own.clone()), Some(own))
                } else {
                    (least.clone(), greatest.clone())
                };
                // Products of numbers of any sign are not bounded here.
                let usable = single || a.as_ref().is_some_and(|a| self.never_negative(a));
                low = low.zip(a.filter(|_| usable)).map(|(low, a)| low.times(&a));
                high = high.zip(b.filter(|_| usable)).map(|(high, b)| high.times(&b));
            }
            if *coefficient < 0 {
                std::mem::swap(&mut low, &mut high);
            }
            let add = |sum: Option<Poly>, part: Option<Poly>| {
                sum.zip(part).map(|(sum, part)| sum.plus(&part.times_number(*coefficient)))
            };
            (least, greatest) = (add(least, low), add(greatest, high));
        }
        (least, greatest)
    }

    /// A polynomial of the scale alone is 0 or more, for every scale.
    fn never_negative(&self, poly: &Poly) -> bool {
        let shifted = Poly::from(Family::SCALE).plus_number(self.least_scale);
        let poly = poly.replaced(|var| (var == Family::SCALE).then_some(&shifted));
        !poly.is_lost()
            && poly
                .terms()
                .iter()
                .all(|(monomial, coefficient)| *coefficient >= 0 && monomial.vars().all(|var| var == Family::SCALE))
    }

    /// The polynomial is 0 or more (`true`) or below 0 (`false`) by the ranges of its unknowns alone.
    pub(crate) fn sign(&self, poly: &Poly) -> Option<bool> {
        let (least, greatest) = self.interval(poly);
        if least.is_some_and(|least| self.never_negative(&least)) {
            return Some(true);
        }
        let below = greatest.map(|greatest| greatest.negated().plus_number(-1));
        below.is_some_and(|below| self.never_negative(&below)).then_some(false)
    }

    /// The polynomial lies between -`limit` and `limit`, neither reached, by the ranges of its unknowns alone.
    pub(crate) fn is_between(&self, poly: &Poly, limit: &Poly) -> bool {
        self.sign(&limit.minus(poly).plus_number(-1)) == Some(true)
            && self.sign(&limit.plus(poly).plus_number(-1)) == Some(true)
    }

    /// number / below % own, of a number that is a sum of bits (unknowns of 0 or 1) times different powers of two and a
    /// number that has none of these bits; `below` and `own` are powers of two.
    pub(crate) fn bits_of(&self, number: &Poly, below: i128, own: i128) -> Option<Poly> {
        let mut taken = 0_i128;
        let mut inside = Poly::from(0);
        for (monomial, coefficient) in number.terms() {
            let is_bit = monomial.degree() == 1 && monomial.vars().all(|var| self.all[var.index()].bit);
            let usable = *coefficient > 0 && (monomial.degree() == 0 || is_bit && coefficient.count_ones() == 1);
            if !usable || taken & coefficient != 0 {
                return None;
            }
            taken |= coefficient;
            if monomial.degree() == 0 {
                inside = inside.plus_number(coefficient / below % own);
            } else if *coefficient >= below && *coefficient < below.checked_mul(own)? {
                inside = inside.plus(&Poly::of([(*monomial, coefficient / below)]));
            }
        }
        Some(inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_decide_signs_for_every_scale() {
        let mut variables = Variables::new("2^k".to_owned(), 4);
        let scale = Poly::from(Family::SCALE);
        let x = variables.add("x".to_owned(), Some(Poly::from(0)), Some(scale.plus_number(-1))).unwrap();
        let x = Poly::from(x);
        assert_eq!(variables.sign(&scale.minus(&x).plus_number(-1)), Some(true));
        assert_eq!(variables.sign(&x.minus(&scale)), Some(false));
        assert_eq!(variables.sign(&x.plus_number(-1)), None);
        assert_eq!(variables.sign(&scale.plus_number(-4)), Some(true));
        assert_eq!(variables.sign(&scale.plus_number(-5)), None);
        assert!(variables.is_between(&x, &scale) && !variables.is_between(&x.plus_number(1), &scale));
        // x times itself is below the square of the scale.
        assert_eq!(variables.sign(&scale.times(&scale).minus(&x.times(&x))), Some(true));
    }

    #[test]
    fn bits_are_read_out_of_a_sum_of_bits() {
        let mut variables = Variables::new("2^k".to_owned(), 1);
        let [a, b] = ["a", "b"]
            .map(|name| Poly::from(variables.add(name.to_owned(), Some(Poly::from(0)), Some(Poly::from(1))).unwrap()));
        let number = a.plus(&b.times_number(4)).plus_number(2);
        assert_eq!(variables.bits_of(&number, 1, 2), Some(a.clone()));
        assert_eq!(variables.bits_of(&number, 2, 2), Some(Poly::from(1)));
        assert_eq!(variables.bits_of(&number, 2, 4), Some(b.times_number(2).plus_number(1)));
        assert_eq!(variables.bits_of(&number.plus(&a), 1, 2), None);
        assert_eq!(variables.bits_of(&a.plus_number(1), 1, 2), None);
    }
}
