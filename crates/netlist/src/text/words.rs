//! A line of the text form, taken word by word.

use std::str::CharIndices;

use super::{BINARY, Expected};
use crate::cells::{Arithmetic, Claim, Format, Net, Op, Operand, Operator, Undefined, Word};
use crate::message::Message;

/// A number, written in digits and nothing else.
pub(super) fn digits(word: &str, radix: u32) -> Option<u64> {
    let all = word.chars().all(|c| c.is_digit(radix));
    u64::from_str_radix(word, radix).ok().filter(|_| all)
}

/// The rest of a line, taken word by word.
pub(super) struct Words<'a> {
    pub(super) rest: &'a str,
}

impl<'a> Words<'a> {
    pub(super) fn word(&mut self) -> Result<&'a str, Expected> {
        let (word, rest) = self.rest.split_once(' ').unwrap_or((self.rest, ""));
        self.rest = rest.trim_start();
        if word.is_empty() { Err("more words".to_owned()) } else { Ok(word) }
    }

    pub(super) fn keyword(&mut self, keyword: &str) -> Result<(), Expected> {
        if self.word()? == keyword { Ok(()) } else { Err(format!("'{keyword}'")) }
    }

    /// Takes a word if it is next.
    pub(super) fn optional(&mut self, keyword: &str) -> bool {
        let is_next = self.rest.split(' ').next() == Some(keyword);
        if is_next {
            self.rest = self.rest[keyword.len()..].trim_start();
        }
        is_next
    }

    pub(super) fn number<T: TryFrom<u64>>(&mut self) -> Result<T, Expected> {
        let number = digits(self.word()?, 10).and_then(|number| T::try_from(number).ok());
        number.ok_or_else(|| "a number".to_owned())
    }

    pub(super) fn value(&mut self) -> Result<u64, Expected> {
        let word = self.word()?;
        let value = word.strip_prefix("0x").ok_or("a value that begins with 0x")?;
        digits(value, 16).ok_or_else(|| "a hexadecimal value of at most 64 bits".to_owned())
    }

    pub(super) fn net(&mut self) -> Result<Net, Expected> {
        let number = self.word()?.strip_prefix('%').and_then(|number| digits(number, 10));
        number.and_then(|number| u32::try_from(number).ok()).map(Net).ok_or_else(|| "a net such as %4".to_owned())
    }

    pub(super) fn op(&mut self) -> Result<Op, Expected> {
        Ok(match self.word()? {
            "input" => Op::Input,
            "const" => Op::Const(self.value()?),
            "register" => {
                self.keyword("reset")?;
                let reset = self.value()?;
                let next = if self.rest.is_empty() || self.rest.starts_with("at ") {
                    None
                } else {
                    self.keyword("next")?;
                    Some(self.net()?)
                };
                Op::Register { next, reset }
            }
            "not" => Op::Not(self.net()?),
            "mux" => Op::Mux { select: self.net()?, high: self.net()?, low: self.net()? },
            "slice" => Op::Slice { of: self.net()?, low: self.number()? },
            "concat" => Op::Concat { high: self.net()?, low: self.net()? },
            "zero-extend" => Op::ZeroExtend(self.net()?),
            "sign-extend" => Op::SignExtend(self.net()?),
            "read" => Op::Read { memory: self.number()?, address: self.net()? },
            word => {
                let (_, make) = BINARY.iter().find(|(known, _)| *known == word).ok_or("an operator")?;
                make(self.net()?, self.net()?)
            }
        })
    }

    pub(super) fn quoted(&mut self) -> Result<String, Expected> {
        let inner = self.rest.strip_prefix('"').ok_or("a name in quotes")?;
        let mut name = String::new();
        let mut chars = inner.char_indices();
        while let Some((index, c)) = chars.next() {
            match c {
                '"' => {
                    self.rest = inner[index + 1..].trim_start();
                    return Ok(name);
                }
                '\\' => name.push(escaped(&mut chars).ok_or("an escape of Rust's strings, and the end of the quotes")?),
                c => name.push(c),
            }
        }
        Err("the end of the quotes".to_owned())
    }

    pub(super) fn signed(&mut self) -> Result<bool, Expected> {
        match self.word()? {
            "signed" => Ok(true),
            "unsigned" => Ok(false),
            _ => Err("'signed' or 'unsigned'".to_owned()),
        }
    }

    fn operands(&mut self) -> Result<(Operand, Operand), Expected> {
        let left = Operand { net: self.net()?, signed: self.signed()? };
        Ok((left, Operand { net: self.net()?, signed: self.signed()? }))
    }

    pub(super) fn fits(&mut self) -> Result<Claim, Expected> {
        let bits = self.number().ok().filter(|bits| *bits > 0).ok_or("a number of bits from 1 on")?;
        let (signed, operator) = (self.signed()?, self.operator()?);
        let (left, right) = (self.operand_word()?, self.operand_word()?);
        Ok(Claim::Fits { operator, left, right, bits, signed, wraps: self.wraps()? })
    }

    /// An operation without a result, by its word.
    pub(super) fn defined(&mut self, word: &str) -> Result<Claim, Expected> {
        let known = ["quotient", "remainder", "read", "write"];
        if !known.contains(&word) {
            return Err(
                "'invariant', 'assumption', 'cover', 'print', 'fits', 'add', 'sub', 'quotient', 'remainder', 'read' or 'write'"
                    .to_owned(),
            );
        }
        let operand = self.operand_word()?;
        let undefined = match word {
            "quotient" => Undefined::Quotient,
            "remainder" => Undefined::Remainder,
            _ => {
                self.keyword("words")?;
                let words = self.number()?;
                self.keyword("from")?;
                let first = self.number()?;
                if word == "read" { Undefined::Read { first, words } } else { Undefined::Write { first, words } }
            }
        };
        Ok(Claim::Defined { undefined, operand })
    }

    /// A text that is printed, and its numbers.
    pub(super) fn print(&mut self) -> Result<Claim, Expected> {
        let once = self.rest.starts_with("once");
        if once {
            self.keyword("once")?;
        }
        let message = Message::parse(&self.quoted()?)?;
        let mut numbers = Vec::new();
        while self.rest.starts_with('%') {
            numbers.push(self.operand_word()?);
        }
        Ok(Claim::Print { message, numbers, once })
    }

    fn operand_word(&mut self) -> Result<Word, Expected> {
        let mut nets = vec![self.net()?];
        nets.extend(self.further_nets()?);
        Ok(Word { nets, signed: self.signed()? })
    }

    /// The nets that follow.
    pub(super) fn further_nets(&mut self) -> Result<Vec<Net>, Expected> {
        let mut nets = Vec::new();
        while self.rest.starts_with('%') {
            nets.push(self.net()?);
        }
        Ok(nets)
    }

    fn operator(&mut self) -> Result<Operator, Expected> {
        let word = self.word()?;
        let operator = Operator::ALL.into_iter().find(|operator| operator.name() == word);
        operator.ok_or_else(|| "'add', 'sub', 'neg', 'mul', 'shift-left' or 'power'".to_owned())
    }

    /// The word `wraps`, or the end.
    fn wraps(&mut self) -> Result<bool, Expected> {
        let wraps = !self.rest.is_empty();
        if wraps {
            self.keyword("wraps")?;
        }
        Ok(wraps)
    }

    pub(super) fn strict(&mut self, operation: Arithmetic) -> Result<Claim, Expected> {
        let (left, right) = self.operands()?;
        Ok(Claim::NoOverflow { operation, left, right })
    }

    pub(super) fn format(&mut self) -> Result<Format, Expected> {
        Ok(match self.word()? {
            "unsigned" => Format::Unsigned,
            "signed" => Format::Signed,
            "analog" => Format::Analog,
            "level" => Format::Level,
            "binary" => Format::Binary,
            "decimal" => Format::Decimal,
            "states" => {
                let mut states = Vec::new();
                while !self.rest.is_empty() {
                    states.push((self.value()?, self.quoted()?));
                }
                Format::States(states)
            }
            _ => return Err("a format".to_owned()),
        })
    }

    pub(super) fn end(&self) -> Result<(), Expected> {
        if self.rest.is_empty() { Ok(()) } else { Err("the end of the line".to_owned()) }
    }
}

/// The character after a backslash: those escapes that the `Debug` form of a string uses.
fn escaped(chars: &mut CharIndices<'_>) -> Option<char> {
    Some(match chars.next()?.1 {
        'n' => '\n',
        'r' => '\r',
        't' => '\t',
        '0' => '\0',
        'u' => {
            let (_, '{') = chars.next()? else { return None };
            let code: String = chars.map(|(_, c)| c).take_while(|&c| c != '}').collect();
            char::from_u32(u32::try_from(digits(&code, 16)?).ok()?)?
        }
        c @ ('"' | '\\' | '\'') => c,
        _ => return None,
    })
}
