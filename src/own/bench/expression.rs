//! Expressions of a geometry: integers, computed exactly.
//!
//! The operators, their precedence and their grouping are those of C; a comparison is 1 or 0, `/` rounds towards zero.

use crate::netlist::{Width, did_you_mean};

/// Deepest nesting of an expression: what people write has a few levels.
const DEEPEST: usize = 64;
/// Longest expression in bytes.
const LONGEST: usize = 4096;

/// An expression.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Expression {
    Number(i128),
    /// Index into the names that were known.
    Variable(usize),
    Unary(Unary, Box<Expression>),
    /// A number, and operators of one precedence with what follows them, from left to right.
    Chain(Box<Expression>, Vec<(Binary, Expression)>),
    /// Condition, and what there is if it is not 0, or else.
    Choice(Box<[Expression; 3]>),
    Call(Function, Vec<Expression>),
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Unary {
    Minus,
    Complement,
    Not,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Binary {
    LogicalOr,
    LogicalAnd,
    Or,
    Xor,
    And,
    Equal,
    Unequal,
    Less,
    AtMost,
    Greater,
    AtLeast,
    Left,
    Right,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
}

/// Binary operators, those that bind least first; of those that begin alike the longer is first.
const LEVELS: [&[(&str, Binary)]; 10] = [
    &[("||", Binary::LogicalOr)],
    &[("&&", Binary::LogicalAnd)],
    &[("|", Binary::Or)],
    &[("^", Binary::Xor)],
    &[("&", Binary::And)],
    &[("==", Binary::Equal), ("!=", Binary::Unequal)],
    &[("<=", Binary::AtMost), (">=", Binary::AtLeast), ("<", Binary::Less), (">", Binary::Greater)],
    &[("<<", Binary::Left), (">>", Binary::Right)],
    &[("+", Binary::Add), ("-", Binary::Subtract)],
    &[("*", Binary::Multiply), ("/", Binary::Divide), ("%", Binary::Remainder)],
];

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Function {
    Abs,
    Min,
    Max,
    Sign,
    Bits,
}

/// Functions, and whether they take several numbers.
const FUNCTIONS: [(&str, Function, bool); 5] = [
    ("abs", Function::Abs, false),
    ("min", Function::Min, true),
    ("max", Function::Max, true),
    ("sign", Function::Sign, false),
    ("bits", Function::Bits, false),
];

struct Parser<'a> {
    rest: &'a str,
    names: &'a [String],
    depth: usize,
}

impl<'a> Parser<'a> {
    fn space(&mut self) {
        self.rest = self.rest.trim_start();
    }

    /// Takes a sign, if it comes next.
    fn takes(&mut self, sign: &str) -> bool {
        self.space();
        let rest = self.rest.strip_prefix(sign);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    /// Takes an operator of a level, if one comes next that is not the beginning of a longer one.
    fn operator(&mut self, level: &[(&str, Binary)]) -> Option<Binary> {
        self.space();
        let signs = || LEVELS.iter().flat_map(|level| level.iter());
        let longest = signs().map(|(sign, _)| *sign).filter(|sign| self.rest.starts_with(sign)).max_by_key(|s| s.len());
        let (sign, operator) = level.iter().find(|(sign, _)| Some(*sign) == longest)?;
        self.rest = &self.rest[sign.len()..];
        Some(*operator)
    }

    fn deeper(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEEPEST { Err(format!("it is nested more than {DEEPEST} times")) } else { Ok(()) }
    }

    fn choice(&mut self) -> Result<Expression, String> {
        self.deeper()?;
        let condition = self.binary(0)?;
        let whole = if self.takes("?") {
            let yes = self.choice()?;
            if !self.takes(":") {
                return Err(self.expected("':' and what there is otherwise"));
            }
            Expression::Choice(Box::new([condition, yes, self.choice()?]))
        } else {
            condition
        };
        self.depth -= 1;
        Ok(whole)
    }

    fn binary(&mut self, level: usize) -> Result<Expression, String> {
        let Some(operators) = LEVELS.get(level) else { return self.unary() };
        let first = self.binary(level + 1)?;
        let mut others = Vec::new();
        while let Some(operator) = self.operator(operators) {
            others.push((operator, self.binary(level + 1)?));
        }
        Ok(if others.is_empty() { first } else { Expression::Chain(Box::new(first), others) })
    }

    fn unary(&mut self) -> Result<Expression, String> {
        let signs = [("-", Some(Unary::Minus)), ("~", Some(Unary::Complement)), ("!", Some(Unary::Not)), ("+", None)];
        for (sign, operator) in signs {
            if self.takes(sign) {
                self.deeper()?;
                let operand = self.unary()?;
                self.depth -= 1;
                return Ok(match operator {
                    Some(operator) => Expression::Unary(operator, Box::new(operand)),
                    None => operand,
                });
            }
        }
        self.primary()
    }

    fn primary(&mut self) -> Result<Expression, String> {
        if self.takes("(") {
            let inner = self.choice()?;
            return if self.takes(")") { Ok(inner) } else { Err(self.expected("')'")) };
        }
        let end = self.rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        if word.is_empty() {
            return Err(self.expected("a number, a name or '('"));
        }
        self.rest = rest;
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            let number = crate::own::stimulus::parsed(word);
            let known = number.ok_or_else(|| format!("'{word}' is not a number: give 12, 0x1f or 0b101"));
            return known.map(Expression::Number);
        }
        if let Some((_, function, several)) = FUNCTIONS.iter().find(|(name, ..)| *name == word) {
            return self.call(word, *function, *several);
        }
        let index = self.names.iter().position(|name| name == word);
        let functions = FUNCTIONS.iter().map(|(name, ..)| *name);
        index.map(Expression::Variable).ok_or_else(|| {
            let known = self.names.iter().map(String::as_str);
            let hint = did_you_mean(word, known.clone().chain(functions.clone()));
            let (known, functions) = (known.collect::<Vec<_>>().join(" "), functions.collect::<Vec<_>>().join(" "));
            format!("there is no '{word}'{hint}; there are: {known}, and the functions {functions}")
        })
    }

    fn call(&mut self, name: &str, function: Function, several: bool) -> Result<Expression, String> {
        if !self.takes("(") {
            return Err(self.expected(&format!("'(' after the function {name}")));
        }
        let mut operands = vec![self.choice()?];
        while self.takes(",") {
            operands.push(self.choice()?);
        }
        if !self.takes(")") {
            return Err(self.expected("')'"));
        }
        match (several, operands.len()) {
            (false, 1) | (true, 2..) => Ok(Expression::Call(function, operands)),
            (false, count) => Err(format!("{name} takes one number, not {count}")),
            (true, _) => Err(format!("{name} takes two numbers or more")),
        }
    }

    fn expected(&self, what: &str) -> String {
        match self.rest.trim() {
            "" => format!("{what} is missing at its end"),
            rest => format!("{what} is missing before '{}'", rest.chars().take(20).collect::<String>()),
        }
    }
}

impl Expression {
    /// Parses a text in which these names stand for numbers.
    pub(super) fn parse(text: &str, names: &[String]) -> Result<Expression, String> {
        if text.len() > LONGEST {
            return Err(format!("it has {} bytes; at most {LONGEST} are read", text.len()));
        }
        let mut parser = Parser { rest: text, names, depth: 0 };
        let expression = parser.choice()?;
        parser.space();
        if parser.rest.is_empty() { Ok(expression) } else { Err(parser.expected("an operator")) }
    }

    /// Its value for these values of the names.
    pub(super) fn value(&self, values: &[i128]) -> Result<i128, String> {
        Ok(match self {
            Expression::Number(number) => *number,
            Expression::Variable(index) => values.get(*index).copied().unwrap_or(0),
            Expression::Unary(operator, operand) => {
                let value = operand.value(values)?;
                match operator {
                    Unary::Minus => value.checked_neg().ok_or_else(too_large)?,
                    Unary::Complement => !value,
                    Unary::Not => i128::from(value == 0),
                }
            }
            Expression::Chain(first, others) => others
                .iter()
                .try_fold(first.value(values)?, |left, (operator, right)| binary(*operator, left, right, values))?,
            Expression::Choice(parts) => {
                let [condition, yes, no] = &**parts;
                if condition.value(values)? != 0 { yes.value(values)? } else { no.value(values)? }
            }
            Expression::Call(function, operands) => {
                let numbers = operands.iter().map(|operand| operand.value(values)).collect::<Result<Vec<_>, _>>()?;
                call(*function, &numbers)?
            }
        })
    }

    /// The names that it reads, by their index.
    pub(super) fn reads(&self, index: usize) -> bool {
        match self {
            Expression::Number(_) => false,
            Expression::Variable(own) => *own == index,
            Expression::Unary(_, operand) => operand.reads(index),
            Expression::Chain(first, others) => {
                first.reads(index) || others.iter().any(|(_, operand)| operand.reads(index))
            }
            Expression::Choice(parts) => parts.iter().any(|part| part.reads(index)),
            Expression::Call(_, operands) => operands.iter().any(|operand| operand.reads(index)),
        }
    }
}

fn too_large() -> String {
    "it has more than 127 bits".to_owned()
}

fn call(function: Function, numbers: &[i128]) -> Result<i128, String> {
    let first = numbers.first().copied().unwrap_or(0);
    Ok(match function {
        Function::Abs => first.checked_abs().ok_or_else(too_large)?,
        Function::Sign => first.signum(),
        Function::Bits => Width::needed_unsigned(first.unsigned_abs()).into(),
        Function::Min => numbers.iter().copied().min().unwrap_or(first),
        Function::Max => numbers.iter().copied().max().unwrap_or(first),
    })
}

fn binary(operator: Binary, a: i128, right: &Expression, values: &[i128]) -> Result<i128, String> {
    // What C does not compute, and what need not be possible.
    match operator {
        Binary::LogicalOr if a != 0 => return Ok(1),
        Binary::LogicalAnd if a == 0 => return Ok(0),
        _ => {}
    }
    let b = right.value(values)?;
    let truth = |holds: bool| Some(i128::from(holds));
    let exact = match operator {
        Binary::LogicalOr | Binary::LogicalAnd => truth(b != 0),
        Binary::Or => Some(a | b),
        Binary::Xor => Some(a ^ b),
        Binary::And => Some(a & b),
        Binary::Equal => truth(a == b),
        Binary::Unequal => truth(a != b),
        Binary::Less => truth(a < b),
        Binary::AtMost => truth(a <= b),
        Binary::Greater => truth(a > b),
        Binary::AtLeast => truth(a >= b),
        Binary::Left | Binary::Right if b < 0 => return Err(format!("it shifts by {b} bits: give 0 or more")),
        Binary::Left if a == 0 => Some(0),
        Binary::Left => u32::try_from(b).ok().filter(|&by| by < 127).and_then(|by| a.checked_mul(1_i128 << by)),
        Binary::Right => Some(a >> b.min(127)),
        Binary::Add => a.checked_add(b),
        Binary::Subtract => a.checked_sub(b),
        Binary::Multiply => a.checked_mul(b),
        Binary::Divide | Binary::Remainder if b == 0 => return Err("it divides by 0".to_owned()),
        Binary::Divide => a.checked_div(b),
        Binary::Remainder => a.checked_rem(b),
    };
    exact.ok_or_else(too_large)
}

#[cfg(test)]
mod tests {
    use super::Expression;

    fn value(text: &str) -> Result<i128, String> {
        let names = ["dx".to_owned(), "dy".to_owned()];
        Expression::parse(text, &names)?.value(&[-8, 6])
    }

    #[test]
    fn operators_bind_and_compute_as_in_c() {
        let expected = [
            ("(dx < 0) | (dy < 0) << 1", 1),
            ("1 + 2 * 3 - 4 / 3", 6),
            ("-7 / 2 * 10 + -7 % 2", -31),
            ("1 << 2 + 1", 8),
            ("5 & 3 == 3", 1),
            ("1 | 2 ^ 3 & 6", 1),
            ("dx < 0 ? abs(dx) : dy ? 1 : 2", 8),
            ("0 ? 1 : 0 ? 2 : 3", 3),
            ("max(abs(dx), dy, 3) + min(dx, dy)", 0),
            ("sign(dx) + bits(255) + bits(0) + bits(dx)", 12),
            ("~dx + !dx + !0", 8),
            ("- - 3 + 0x1F + 0b11 + 1_0", 0),
            ("2 > 1 && 0 || 1 >= 1 && 3 != 4", 1),
            ("dy && 0 || dx == 0 || dx <= -8", 1),
            ("0 && 1 / 0", 0),
            ("-5 >> 1", -3),
            ("-5 >> 500", -1),
            ("1 << 126 >> 126", 1),
        ];
        for (text, expected) in expected {
            match value(text) {
                Err(message) if text.contains('_') => assert!(message.contains("'1_0' is not a number"), "{message}"),
                found => assert_eq!(found, Ok(expected), "{text}"),
            }
        }
    }

    #[test]
    fn what_cannot_be_read_or_computed_is_a_sentence() {
        let expected = [
            ("", "a number, a name or '(' is missing at its end"),
            ("dx +", "a number, a name or '(' is missing at its end"),
            ("(dx", "')' is missing at its end"),
            ("dx dy", "an operator is missing before 'dy'"),
            ("dx ? 1", "':' and what there is otherwise is missing at its end"),
            (
                "ddx",
                "there is no 'ddx' (did you mean 'dx'?); there are: dx dy, and the functions abs min max sign bits",
            ),
            ("abs dx", "'(' after the function abs is missing before 'dx'"),
            ("abs(dx, 1)", "abs takes one number, not 2"),
            ("max(dx)", "max takes two numbers or more"),
            ("1 / (dx + 8)", "it divides by 0"),
            ("dx % 0", "it divides by 0"),
            ("1 << dx", "it shifts by -8 bits: give 0 or more"),
            ("1 << 127", "it has more than 127 bits"),
            ("dx = 1", "an operator is missing before '= 1'"),
        ];
        for (text, expected) in expected {
            assert_eq!(value(text), Err(expected.to_owned()), "{text}");
        }
        for text in ["(".repeat(1000), "-".repeat(1000), "0 ? 1 : ".repeat(500)] {
            assert_eq!(value(&text), Err("it is nested more than 64 times".to_owned()));
        }
        assert_eq!(value(&"1+".repeat(3000)), Err("it has 6000 bytes; at most 4096 are read".to_owned()));
        assert_eq!(value(&("1+".repeat(2000) + "1")), Ok(2001));
    }
}
