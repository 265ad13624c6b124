//! Texts that hardware prints: `{` and `}` enclose fields in which numbers are shown, `{{` and `}}` are braces.
//!
//! A field is `{BITS:JUSTIFY PADDING WIDTH STYLE}`, the format strings of the cell `$print` of Yosys: `{8:> 3d-u}` shows a
//! number of 8 bits at the right of 3 places padded with blanks, in decimal and unsigned. JUSTIFY is `>`, `<`, or `=` for
//! padding after the sign; STYLE is a base `b o d h H`, a sign (`-` of negative numbers alone, `+`, or a blank), `#` for
//! the prefix of the base, `_` for groups of four digits, and `u` or `s`; or `c` for characters, `t` for the time. `{BITS:U}`
//! is a Unicode character. `$display` of Verilog becomes such texts.

use std::fmt;

use num_bigint::BigUint;

/// A text with fields.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Message {
    text: String,
    pieces: Vec<Piece>,
}

#[derive(Clone, PartialEq, Eq, Debug)]
enum Piece {
    Text(String),
    Field(Field),
}

#[derive(Clone, PartialEq, Eq, Debug)]
struct Field {
    bits: u32,
    justify: char,
    padding: char,
    width: usize,
    style: Style,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Style {
    Number { base: char, sign: char, prefix: bool, groups: bool, signed: bool },
    Characters,
    Unicode,
    Time,
}

/// Most places of a field.
const MOST_PLACES: usize = 1 << 16;

impl Message {
    /// Reads a text.
    ///
    /// # Errors
    /// What was expected and not found.
    pub fn parse(text: &str) -> Result<Message, String> {
        let mut pieces = Vec::new();
        let mut plain = String::new();
        let mut rest = text;
        while let Some(at) = rest.find(['{', '}']) {
            plain += &rest[..at];
            let (brace, after) = (&rest[at..=at], &rest[at + 1..]);
            if let Some(after) = after.strip_prefix(brace) {
                plain += brace;
                rest = after;
                continue;
            }
            let field = (brace == "{").then(|| after.split_once('}')).flatten();
            let (field, after) = field.ok_or("'{{', '}}' or a field such as '{8:> 3d-u}'")?;
            if !plain.is_empty() {
                pieces.push(Piece::Text(std::mem::take(&mut plain)));
            }
            let read = Field::parse(field);
            pieces
                .push(Piece::Field(read.ok_or_else(|| format!("a field such as '{{8:> 3d-u}}', not '{{{field}}}'"))?));
            rest = after;
        }
        plain += rest;
        if !plain.is_empty() {
            pieces.push(Piece::Text(plain));
        }
        Ok(Message { text: text.to_owned(), pieces })
    }

    /// The bits of each number that it shows, in order.
    pub fn numbers(&self) -> impl Iterator<Item = u32> + '_ {
        self.pieces.iter().filter_map(|piece| match piece {
            Piece::Field(field) if field.style != Style::Time => Some(field.bits),
            _ => None,
        })
    }

    /// The text with these numbers, each as binary digits, the most significant first, and this time.
    pub fn shown<'d>(&self, numbers: impl IntoIterator<Item = &'d str>, time: u64) -> String {
        let mut numbers = numbers.into_iter();
        let mut shown = String::new();
        for piece in &self.pieces {
            match piece {
                Piece::Text(text) => shown += text,
                Piece::Field(field) if field.style == Style::Time => shown += &field.padded("", &time.to_string()),
                Piece::Field(field) => shown += &field.shown(numbers.next().unwrap_or("")),
            }
        }
        shown
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Field {
    fn parse(text: &str) -> Option<Field> {
        let (bits, form) = text.split_once(':')?;
        let bits = bits.parse().ok()?;
        if form == "U" {
            return Some(Field { bits, justify: '<', padding: ' ', width: 0, style: Style::Unicode });
        }
        let mut form = form.chars().peekable();
        let justify = form.next().filter(|c| "><=".contains(*c))?;
        let padding = form.next().filter(|c| " 0".contains(*c))?;
        let mut width = 0;
        while let Some(digit) = form.peek().and_then(|c| c.to_digit(10)) {
            width = (10 * width + usize::try_from(digit).ok()?).min(MOST_PLACES);
            form.next();
        }
        let style = match form.next()? {
            'c' => Style::Characters,
            't' | 'r' => Style::Time,
            base if "bodhH".contains(base) => Style::Number {
                base,
                sign: form.next_if(|c| "-+ ".contains(*c)).unwrap_or('-'),
                prefix: form.next_if_eq(&'#').is_some(),
                groups: form.next_if_eq(&'_').is_some(),
                signed: form.next().filter(|c| "us".contains(*c))? == 's',
            },
            _ => return None,
        };
        form.next().is_none().then_some(Field { bits, justify, padding, width, style })
    }

    /// Of binary digits, the most significant first.
    fn shown(&self, digits: &str) -> String {
        let byte = |part: &[u8]| part.iter().fold(0u32, |value, digit| value << 1 | u32::from(*digit == b'1'));
        let bytes = digits.as_bytes().rchunks(8).rev().map(byte);
        match self.style {
            Style::Number { base, sign, prefix, groups, signed } => {
                // In another base a number is its bits.
                let negative = signed && base == 'd' && digits.starts_with('1');
                let bits = BigUint::parse_bytes(digits.as_bytes(), 2).unwrap_or_default();
                let magnitude = if negative { (BigUint::from(1u8) << digits.len()) - bits } else { bits };
                let mut number = magnitude.to_str_radix(radix(base));
                if base == 'H' {
                    number = number.to_uppercase();
                }
                if groups {
                    number = grouped(&number);
                }
                let mut front = if negative { "-".to_owned() } else { sign.to_string().replace('-', "") };
                if prefix && base != 'd' {
                    front += &format!("0{}", letter(base));
                }
                self.padded(&front, &number)
            }
            Style::Characters => {
                let text: String = bytes.filter(|&byte| byte != 0).filter_map(char::from_u32).collect();
                self.padded("", &text)
            }
            Style::Unicode => char::from_u32(byte(digits.as_bytes())).map_or_else(String::new, String::from),
            Style::Time => String::new(),
        }
    }

    fn padded(&self, front: &str, text: &str) -> String {
        let count = self.width.saturating_sub(front.chars().count() + text.chars().count());
        let padding = self.padding.to_string().repeat(count);
        match self.justify {
            '<' => format!("{front}{text}{padding}"),
            '=' => format!("{front}{padding}{text}"),
            _ => format!("{padding}{front}{text}"),
        }
    }
}

fn radix(base: char) -> u32 {
    match base {
        'b' => 2,
        'o' => 8,
        'h' | 'H' => 16,
        _ => 10,
    }
}

/// The letter after the 0 of a prefix.
fn letter(base: char) -> char {
    match base {
        'h' => 'x',
        'H' => 'X',
        other => other,
    }
}

/// An underscore between groups of four digits.
fn grouped(number: &str) -> String {
    let groups: Vec<&[u8]> = number.as_bytes().rchunks(4).rev().collect();
    groups.iter().map(|group| String::from_utf8_lossy(group)).collect::<Vec<_>>().join("_")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(form: &str, digits: &str) -> String {
        Message::parse(form).unwrap().shown([digits], 7)
    }

    #[test]
    fn fields_show_numbers_as_verilog_does() {
        let cases = [
            ("{8:> 3d-u}", "00000101", "  5"),
            ("{8:> 4d-s}", "11111011", "  -5"),
            ("{8:=05d-s}", "11111011", "-0005"),
            ("{8:<05d+s}|", "00000101", "+5000|"),
            ("{8:>02h-u}", "00001010", "0a"),
            ("{8:>02h-s}", "10011100", "9c"),
            ("{8:> 0H-u}", "10101111", "AF"),
            ("{12:> 0h#u}", "101011110000", "0xaf0"),
            ("{9:> 0o-u}", "001000111", "107"),
            ("{10:> 0b_u}", "0011110000", "1111_0000"),
            ("{16:> 5c}", "0100111101001011", "   OK"),
            ("{32:U}", "00000000000000000010001000001001", "∉"),
            ("a{{{4:> 0d-u}}}", "1111", "a{15}"),
            ("{4:> 5t}{4:> 0d-s}", "1000", "    7-8"),
            ("{1:> 0d-u}", "0", "0"),
        ];
        for (form, digits, expected) in cases {
            assert_eq!(shown(form, digits), expected, "{form}");
        }
        let large = format!("1{}", "0".repeat(100));
        assert_eq!(shown("{101:> 0d-u}", &large), (1u128 << 100).to_string());
    }

    #[test]
    fn a_message_counts_its_numbers_and_keeps_its_text() {
        let text = "a {4:> 2d-u} {0:> 20t} {70:>018h-u}\n";
        let message = Message::parse(text).unwrap();
        assert_eq!(message.numbers().collect::<Vec<_>>(), [4, 70]);
        assert_eq!(message.to_string(), text);
    }

    #[test]
    fn what_is_no_field_is_refused() {
        for text in ["{", "}", "{8}", "{8:}", "{8:> 3}", "{8:> 3d}", "{8:? 3d-u}", "{8:> 3d-u+}", "{x:> 3d-u}"] {
            assert!(Message::parse(text).is_err(), "{text}");
        }
    }
}
