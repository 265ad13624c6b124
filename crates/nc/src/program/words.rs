//! A line of an NC program, taken apart into words.
//!
//! Written here and not taken from the crate `gcode` (0.7.0), because that keeps every number as `f32`, which cannot
//! represent 16,777,217 pulses exactly.

use std::borrow::Cow;

use super::error::{Fault, ProgramErrorKind};

/// The longest line, in bytes before its line end.
pub(super) const LINE_LIMIT: usize = 1 << 16;

/// The largest number of digits of a number.
pub(super) const DIGITS_LIMIT: usize = 32;

/// A letter with its number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Word<'l> {
    /// The letter, in upper case.
    pub(super) letter: char,
    /// The number.
    pub(super) value: f64,
    /// Whether the number is written without a decimal point.
    pub(super) integer: bool,
    /// The column of the letter, from 1, in characters.
    pub(super) column: u64,
    text: &'l str,
}

impl Word<'_> {
    /// The word as it is written, without blanks.
    pub(super) fn name(&self) -> String {
        self.text.split_whitespace().collect()
    }

    /// An error at the word.
    pub(super) fn fault(&self, kind: impl FnOnce(String) -> ProgramErrorKind) -> Fault {
        Fault { column: self.column, kind: kind(self.name()) }
    }

    /// The number, which must be a count.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole, not negative and within the limit"
    )]
    pub(super) fn count(&self) -> Result<u64, Fault> {
        if self.value < 0.0 {
            return Err(self.fault(|word| ProgramErrorKind::Negative { word }));
        }
        if self.value.fract() != 0.0 {
            return Err(self.fault(|word| ProgramErrorKind::NotInteger { word }));
        }
        Ok(self.limited()? as u64)
    }

    /// The number, which must be at most [`PROGRAM_LIMIT`](super::PROGRAM_LIMIT) in magnitude.
    pub(super) fn limited(&self) -> Result<f64, Fault> {
        if self.value.abs() <= super::PROGRAM_LIMIT as f64 {
            Ok(self.value)
        } else {
            Err(self.fault(|word| ProgramErrorKind::NumberBeyondLimit { word }))
        }
    }
}

/// A line as text. What is in comments says nothing and may be of any code; outside of them it is UTF-8 without control
/// characters.
pub(super) fn text(line: &[u8]) -> Result<Cow<'_, str>, Fault> {
    // No code that is in use for NC programs (Latin-1, GBK, Shift-JIS) has ; ( or ) as part of another character.
    let mut comments: Vec<(usize, usize)> = Vec::new();
    let mut at = 0;
    while let Some(start) = line[at..].iter().position(|byte| matches!(byte, b';' | b'(')).map(|start| at + start) {
        let end = match line[start] {
            b';' => line.len(),
            _ => line[start..].iter().position(|&byte| byte == b')').map_or(line.len(), |end| start + end + 1),
        };
        comments.push((start, end));
        at = end;
    }
    let mut whole = Cow::Borrowed("");
    let mut done = 0;
    for (start, end) in comments.into_iter().chain([(line.len(), line.len())]) {
        whole += words_alone(&line[done..start], &whole)?;
        whole += String::from_utf8_lossy(&line[start..end]);
        done = end;
    }
    Ok(whole)
}

/// The part of a line between two comments, which follows a text.
fn words_alone<'l>(part: &'l [u8], before: &str) -> Result<&'l str, Fault> {
    let column = |valid: &str| 1 + (before.chars().count() + valid.chars().count()) as u64;
    let (text, wrong) = match std::str::from_utf8(part) {
        Ok(text) => (text, None),
        Err(error) => {
            let (valid, rest) = part.split_at(error.valid_up_to());
            (std::str::from_utf8(valid).unwrap_or_default(), rest.first())
        }
    };
    if let Some(&byte) = wrong {
        return Err(Fault { column: column(text), kind: ProgramErrorKind::InvalidUtf8 { byte } });
    }
    match text.char_indices().find(|&(_, character)| character.is_control() && character != '\t') {
        None => Ok(text),
        Some((at, character)) => {
            Err(Fault { column: column(&text[..at]), kind: ProgramErrorKind::UnexpectedCharacter { character } })
        }
    }
}

/// Reads the words of a line one by one.
#[derive(Debug, Clone)]
pub(super) struct Words<'l> {
    rest: &'l str,
    column: u64,
}

impl<'l> Words<'l> {
    pub(super) fn new(line: &'l str) -> Words<'l> {
        Words { rest: line, column: 1 }
    }

    fn peek(&self) -> Option<char> {
        self.rest.chars().next()
    }

    fn step(&mut self) -> Option<char> {
        let character = self.peek()?;
        self.rest = &self.rest[character.len_utf8()..];
        self.column += 1;
        Some(character)
    }

    fn step_if(&mut self, wanted: impl FnOnce(char) -> bool) -> Option<char> {
        if self.peek().is_some_and(wanted) { self.step() } else { None }
    }

    fn fault<T>(&self, kind: ProgramErrorKind) -> Result<T, Fault> {
        Err(Fault { column: self.column, kind })
    }

    fn blanks(&mut self) {
        while self.step_if(|character| matches!(character, ' ' | '\t')).is_some() {}
    }

    /// Passes blanks and comments.
    fn space(&mut self) -> Result<(), Fault> {
        loop {
            self.blanks();
            match self.peek() {
                Some(';') => self.rest = "",
                Some('(') => self.comment()?,
                _ => return Ok(()),
            }
        }
    }

    fn comment(&mut self) -> Result<(), Fault> {
        let column = self.column;
        self.step();
        loop {
            match self.peek() {
                None => return Err(Fault { column, kind: ProgramErrorKind::OpenComment }),
                Some('(') => return self.fault(ProgramErrorKind::NestedComment),
                Some(')') => {
                    self.step();
                    return Ok(());
                }
                Some(_) => self.step(),
            };
        }
    }

    /// Passes a sign such as % or / in front of the words.
    pub(super) fn sign(&mut self, sign: char) -> bool {
        self.blanks();
        self.step_if(|character| character == sign).is_some()
    }

    /// The column of what is left of the line, after blanks and comments; nothing where nothing is left.
    pub(super) fn left(&mut self) -> Result<Option<u64>, Fault> {
        self.space()?;
        Ok(self.peek().map(|_| self.column))
    }

    /// The next word; nothing after the last.
    pub(super) fn next(&mut self) -> Result<Option<Word<'l>>, Fault> {
        self.space()?;
        let (start, column) = (self.rest, self.column);
        let Some(letter) = self.step_if(|character| character.is_ascii_alphabetic()) else {
            return match self.peek() {
                None => Ok(None),
                Some('%') => self.fault(ProgramErrorKind::PercentInBlock),
                Some('#') => self.fault(ProgramErrorKind::Parameter),
                Some('[' | ']') => self.fault(ProgramErrorKind::Expression),
                Some(character) => self.fault(ProgramErrorKind::UnexpectedCharacter { character }),
            };
        };
        let letter = letter.to_ascii_uppercase();
        let digits = self.digits();
        let kind = match self.peek() {
            _ if digits.bytes().filter(u8::is_ascii_digit).count() > DIGITS_LIMIT => {
                ProgramErrorKind::TooManyDigits { letter }
            }
            after => match digits.parse() {
                Ok(value) => {
                    if let Some(plain) = self.exponent(letter, value, &start[..start.len() - self.rest.len()]) {
                        return Err(Fault { column, kind: plain });
                    }
                    let text = start[..start.len() - self.rest.len()].trim_end();
                    return Ok(Some(Word { letter, value, integer: !digits.contains('.'), column, text }));
                }
                Err(_) if letter == 'O' => ProgramErrorKind::FlowControl { word: letter.to_string() },
                Err(_) if after == Some('#') => ProgramErrorKind::Parameter,
                Err(_) if after == Some('[') => ProgramErrorKind::Expression,
                Err(_) => ProgramErrorKind::NumberExpected { letter },
            },
        };
        Err(Fault { column, kind })
    }

    /// What is wrong if an exponent follows directly after the number that a word ends with.
    fn exponent(&self, letter: char, mantissa: f64, word: &str) -> Option<ProgramErrorKind> {
        let power = self.rest.strip_prefix(['e', 'E'])?;
        let unsigned = power.strip_prefix(['+', '-']).unwrap_or(power);
        let digits = unsigned.len() - unsigned.trim_start_matches(|digit: char| digit.is_ascii_digit()).len();
        let after = unsigned[digits..].trim_start_matches([' ', '\t']);
        // What has a fraction itself, or is beyond all floating-point numbers, is a word with the letter E.
        if !(1..=3).contains(&digits) || after.starts_with(['.', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9']) {
            return None;
        }
        if word.ends_with([' ', '\t']) {
            return None;
        }
        let power = &power[..power.len() - unsigned.len() + digits];
        // Shortest decimals, so that it is what was written.
        let value = format!("{mantissa}e{power}").parse().unwrap_or(f64::INFINITY);
        Some(ProgramErrorKind::Exponent { word: format!("{word}e{power}"), plain: plain(letter, value) })
    }

    /// The characters of a number without the blanks between them; at most one digit more than allowed is kept.
    fn digits(&mut self) -> String {
        let mut digits = String::new();
        let mut point = false;
        loop {
            self.blanks();
            let first = digits.is_empty();
            let next = self.step_if(|character| match character {
                '+' | '-' => first,
                '.' => !point,
                character => character.is_ascii_digit(),
            });
            match next {
                None => return digits,
                Some(character) => {
                    point |= character == '.';
                    if digits.len() <= DIGITS_LIMIT + 2 {
                        digits.push(character);
                    }
                }
            }
        }
    }
}

/// A number without exponent: to six decimals, and in full where that is not the same.
fn plain(letter: char, value: f64) -> String {
    if value.abs() > super::PROGRAM_LIMIT as f64 {
        return format!("a number within \u{b1}{}", super::PROGRAM_LIMIT);
    }
    let rounded = format!("{value:.6}");
    let rounded = rounded.trim_end_matches('0').trim_end_matches('.');
    let rounded = if rounded == "-0" { "0" } else { rounded };
    if rounded.parse() == Ok(value) {
        return format!("{letter}{rounded}");
    }
    let exact = if value.abs() < 1e-30 { "nearly 0".to_owned() } else { value.to_string() };
    format!("{letter}{rounded} ({exact} to six decimals)")
}
