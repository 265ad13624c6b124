//! Certificates as text, for a file: variables are numbers (`v3`), in the order of the case.
//!
//! ```text
//! modes 0
//! equal v7 v1 + v2 - v8
//! clause v9 + v2 | -v9
//! answer -
//! answer (1*3 1/2*4*7)
//! answer [2 (1*3) (1*5)]
//! ```
//!
//! After `modes` come the values of the mode registers, and where changes of these are counted, their number.
//! `answer` is `-` where nothing was shown, a sum of factors and conditions (`factor*row` or `factor*row*row`) in round
//! brackets, or in square brackets the number of a clause and an answer for each of its alternatives.

use std::fmt::{self, Write as _};
use std::str::FromStr;

use num_bigint::BigInt;
use num_rational::BigRational;

use super::farkas::{Refutation, WeightedRow};
use super::obligations::Invariants;
use super::poly::{Poly, Var};
use stepwave_netlist::formula::Formula;

/// All that a proof needs to be checked: invariants, and the contradictions in the order in which the obligations ask
/// for them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Certificate {
    pub(super) invariants: Vec<Invariants>,
    /// `None` where nothing was shown.
    pub(super) answers: Vec<Option<Refutation>>,
}

/// A certificate that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line} of the certificate cannot be read: '{text}'")]
pub struct CertificateError {
    /// Number of the line, from 1.
    pub line: usize,
    /// The line.
    pub text: String,
}

fn variable(var: Var) -> String {
    format!("v{}", var.index())
}

fn write_answer(text: &mut String, answer: &Refutation) {
    // Writing to a string cannot fail.
    match answer {
        Refutation::Sum(parts) => {
            let part = |part: &WeightedRow| match part.by {
                Some(by) => format!("{}*{}*{by}", part.factor, part.row),
                None => format!("{}*{}", part.factor, part.row),
            };
            let _ = write!(text, "({})", parts.iter().map(part).collect::<Vec<_>>().join(" "));
        }
        Refutation::Cases { clause, each } => {
            let _ = write!(text, "[{clause}");
            for answer in each {
                text.push(' ');
                write_answer(text, answer);
            }
            text.push(']');
        }
    }
}

impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for own in &self.invariants {
            let modes: Vec<String> = own.modes.iter().map(ToString::to_string).collect();
            writeln!(f, "{}", ["modes".to_owned()].into_iter().chain(modes).collect::<Vec<_>>().join(" "))?;
            for (var, poly) in &own.equalities {
                writeln!(f, "equal {} {}", variable(*var), poly.display(variable))?;
            }
            for clause in &own.clauses {
                let any: Vec<String> = clause.iter().map(|poly| poly.display(variable)).collect();
                writeln!(f, "clause {}", any.join(" | "))?;
            }
        }
        for answer in &self.answers {
            let mut text = String::new();
            match answer {
                Some(answer) => write_answer(&mut text, answer),
                None => text.push('-'),
            }
            writeln!(f, "answer {text}")?;
        }
        Ok(())
    }
}

impl FromStr for Certificate {
    type Err = CertificateError;

    fn from_str(text: &str) -> Result<Certificate, CertificateError> {
        let mut certificate = Certificate::default();
        for (index, line) in text.lines().enumerate() {
            if line.trim().is_empty() {
                continue;
            }
            let read = (line.len() <= LONGEST_LINE).then(|| certificate.read(line.trim())).flatten();
            read.ok_or_else(|| CertificateError { line: index + 1, text: line.chars().take(60).collect() })?;
        }
        Ok(certificate)
    }
}

impl Certificate {
    fn read(&mut self, line: &str) -> Option<()> {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        match word {
            "modes" => {
                let modes: Option<Vec<i128>> = rest.split_whitespace().map(|mode| mode.parse().ok()).collect();
                let modes = modes.filter(|_| self.invariants.len() < MOST)?;
                self.invariants.push(Invariants { modes, ..Invariants::default() });
            }
            "equal" => {
                let (var, poly) = rest.split_once(' ')?;
                let own = &mut self.invariants.last_mut()?.equalities;
                // Each variable equals one thing.
                let var = read_variable(var)?;
                let is_new = own.len() < MOST && own.iter().all(|(other, _)| *other != var);
                is_new.then_some(())?;
                own.push((var, read_poly(poly)?));
            }
            "clause" => {
                let any: Option<Vec<Poly>> = rest.split('|').map(read_poly).collect();
                let own = &mut self.invariants.last_mut()?.clauses;
                let any = any.filter(|any| any.len() <= MOST && own.len() < MOST)?;
                own.push(any);
            }
            "answer" if rest == "-" => self.answers.push(None),
            "answer" => {
                let mut rest = rest;
                let answer = read_answer(&mut rest, 0)?;
                rest.trim().is_empty().then(|| self.answers.push(Some(answer)))?;
            }
            _ => return None,
        }
        Some(())
    }

    /// Every variable is one of the first `count`.
    pub(super) fn fits(&self, count: usize) -> bool {
        self.invariants.iter().all(|own| {
            let equalities = own.equalities.iter().flat_map(|(var, poly)| [vec![*var], poly.vars()].concat());
            let clauses = own.clauses.iter().flatten().flat_map(Poly::vars);
            equalities.chain(clauses).all(|var| var.index() < count)
        })
    }
}

fn read_variable(text: &str) -> Option<Var> {
    text.strip_prefix('v')?.parse().ok().filter(|number| *number < u16::MAX).map(Var)
}

/// Letters of a line, at most: of the models here the longest has some hundreds.
const LONGEST_LINE: usize = 1 << 14;
/// Terms of a polynomial, parts of a sum, alternatives and invariants of one combination of modes, at most.
const MOST: usize = 256;
/// Digits of a number, at most.
const MOST_DIGITS: usize = 60;

fn read_poly(text: &str) -> Option<Poly> {
    let formula = Formula::parse(text)?;
    if formula.terms().take(MOST + 1).count() > MOST {
        return None;
    }
    let mut sum = Poly::from(0);
    for (product, coefficient) in formula.terms() {
        let mut term = Poly::from(coefficient);
        for name in product {
            term = term.times(&Poly::from(read_variable(name)?));
        }
        sum = sum.plus(&term);
    }
    (!sum.is_lost()).then_some(sum)
}

/// Brackets inside brackets, at most.
const DEEPEST: usize = 32;

/// Takes an answer from the beginning of a text.
fn read_answer(text: &mut &str, depth: usize) -> Option<Refutation> {
    if let Some(rest) = text.strip_prefix('(') {
        let (parts, rest) = rest.split_once(')')?;
        *text = rest;
        let parts: Vec<WeightedRow> = parts.split_whitespace().map(read_part).collect::<Option<_>>()?;
        return (parts.len() <= MOST).then_some(Refutation::Sum(parts));
    }
    let rest = text.strip_prefix('[').filter(|_| depth < DEEPEST)?;
    let end = rest.find([' ', ']'])?;
    let (clause, mut rest) = (rest[..end].parse().ok()?, &rest[end..]);
    let mut each = Vec::new();
    loop {
        rest = rest.trim_start();
        if let Some(rest) = rest.strip_prefix(']') {
            *text = rest;
            return Some(Refutation::Cases { clause, each });
        }
        each.push(read_answer(&mut rest, depth + 1)?);
    }
}

fn read_part(text: &str) -> Option<WeightedRow> {
    let mut words = text.split('*');
    let factor = words.next()?;
    let (above, below) = factor.split_once('/').unwrap_or((factor, "1"));
    if above.len().max(below.len()) > MOST_DIGITS {
        return None;
    }
    let (above, below): (BigInt, BigInt) = (above.parse().ok()?, below.parse().ok()?);
    if below <= BigInt::from(0) {
        return None;
    }
    let row = words.next()?.parse().ok()?;
    let by = words.next().map(str::parse).transpose().ok()?;
    words.next().is_none().then_some(WeightedRow { row, by, factor: BigRational::new(above, below) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again_and_nonsense_is_not() {
        let text = "modes 0 1\nequal v7 v2*v1 - 3*v8 + v2\nclause v9 + v2 | -v9\nanswer -\nanswer (1*3 1/2*4*7)\n\
                    answer [2 (1*3) [0 (5*1) ()]]\n";
        let certificate: Certificate = text.parse().unwrap();
        assert_eq!(certificate.to_string(), text);
        assert!(certificate.fits(10) && !certificate.fits(9));
        let twice = "modes 0\nequal v1 2\nequal v1 2";
        let many = format!("modes 0\nclause {}", vec!["v1"; 300].join(" | "));
        let long = format!("answer ({})", vec!["1*3"; 300].join(" "));
        let huge = format!("answer (1{}*3)", "0".repeat(100));
        let deep = format!("answer (1/1{}*3)", "0".repeat(100));
        for wrong in [twice, &many, &long, &huge, &deep] {
            assert!(wrong.parse::<Certificate>().is_err(), "{wrong}");
        }
        for wrong in
            ["equal v1 v2", "modes x", "answer", "answer (1*2", "answer [1 (1*2)", "answer (1/0*2)", "clause", "x"]
        {
            assert!(wrong.parse::<Certificate>().is_err(), "{wrong}");
        }
        let deep = format!("answer {}", "[0 ".repeat(100));
        assert_eq!(deep.parse::<Certificate>().unwrap_err().line, 1);
    }
}
