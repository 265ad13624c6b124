//! Values of inputs, clock by clock, from CSV.

use std::collections::HashSet;

use num_bigint::{BigInt, Sign};

use crate::netlist::bits::Bits;
use crate::netlist::cells::{NamedNet, Op};
use crate::netlist::{Design, Net, Netlist, did_you_mean};

/// Why a stimulus does not fit a design.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StimulusError {
    /// There is no such input.
    #[error("{place}: there is no input '{name}'{hint}; the inputs are: {inputs}")]
    NoInput {
        /// Line, column or option.
        place: String,
        /// What was given.
        name: String,
        /// What was perhaps meant.
        hint: String,
        /// All inputs.
        inputs: String,
    },
    /// An input is given twice.
    #[error("{place}: input '{name}' is given twice: leave one out")]
    Twice {
        /// Line, column or option.
        place: String,
        /// The input.
        name: String,
    },
    /// A row has more or fewer values than there are columns.
    #[error("line {line} has {given} values where the first line names {wanted} inputs")]
    Row {
        /// Number of the line, from 1.
        line: usize,
        /// Values in it.
        given: usize,
        /// Columns.
        wanted: usize,
    },
    /// A value is not a number.
    #[error("{place}: '{text}' is not a value for '{name}': give a decimal number, or one that begins with 0x or 0b")]
    Number {
        /// Line or option.
        place: String,
        /// The input.
        name: String,
        /// What was given.
        text: String,
    },
    /// A value does not fit in its input.
    #[error("{place}: {value} does not fit in '{name}', which has {width} bits: {least} to {greatest}")]
    TooWide {
        /// Line or option.
        place: String,
        /// The input.
        name: String,
        /// What was given.
        value: String,
        /// Its width.
        width: u32,
        /// Least value, as a signed number.
        least: String,
        /// Greatest value, as an unsigned number.
        greatest: String,
    },
    /// There is no first line.
    #[error("the first line must name inputs, separated by commas")]
    Empty,
}

/// Values of inputs: row 0 in the sample after reset, row k from right after edge k on; the last is held. An input of more
/// than 64 bits is several nets.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Stimulus {
    constants: Vec<(Net, u64)>,
    columns: Vec<Net>,
    rows: Vec<Vec<u64>>,
}

/// The inputs of a design, each with its nets and with its path without the name of the design.
pub(super) fn inputs(design: &Design) -> Vec<(&NamedNet, String)> {
    let netlist = design.netlist();
    let inner = |path: String| path.split_once('.').map(|(_, inner)| inner.to_owned()).unwrap_or(path);
    let is_input = |net: Net| matches!(netlist.cell(net).op, Op::Input);
    let mut taken: HashSet<Net> = HashSet::new();
    let mut found: Vec<(&NamedNet, String)> = Vec::new();
    for named in netlist.names.iter().filter(|named| named.nets().all(is_input)) {
        if !named.nets().any(|net| taken.contains(&net)) {
            taken.extend(named.nets());
            found.push((named, inner(netlist.path(named))));
        }
    }
    found.sort_by_key(|(named, _)| named.net);
    found
}

/// Sign, digits in lower case, and base of a number: decimal, or with 0x or 0b in front; a minus sign may come first.
fn digits(text: &str) -> Option<(bool, String, u32)> {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, text),
    };
    let lower = digits.to_ascii_lowercase();
    let (digits, radix) = match (lower.strip_prefix("0x"), lower.strip_prefix("0b")) {
        (Some(digits), _) => (digits, 16),
        (_, Some(digits)) => (digits, 2),
        _ => (lower.as_str(), 10),
    };
    // `from_str_radix` takes a sign of its own.
    let good = !digits.is_empty() && digits.chars().all(|c| c.is_digit(radix));
    good.then(|| (negative, digits.to_owned(), radix))
}

/// A number of up to 127 bits in decimal, or with 0x or 0b in front; a minus sign may come first.
pub(super) fn parsed(text: &str) -> Option<i128> {
    let (negative, digits, radix) = digits(text)?;
    let value = i128::from_str_radix(&digits, radix).ok()?;
    Some(if negative { -value } else { value })
}

/// The value of each net of an input, the lowest first, appended to `values`.
pub(super) fn value(
    netlist: &Netlist,
    input: &NamedNet,
    name: &str,
    text: &str,
    place: &str,
    values: &mut Vec<u64>,
) -> Result<(), StimulusError> {
    let (place, name) = (place.to_owned(), name.to_owned());
    if let (false, Some(value)) = (input.is_wide(), parsed(text))
        && let Some(bits) = Bits::exact(netlist.width(input.net), value, value < 0)
    {
        values.push(bits.value());
        return Ok(());
    }
    let Some((negative, digits, radix)) = digits(text) else {
        return Err(StimulusError::Number { place, name, text: text.to_owned() });
    };
    let width = netlist.bits(input.nets());
    let magnitude = BigInt::parse_bytes(digits.as_bytes(), radix).unwrap_or_default();
    let value = if negative { -magnitude } else { magnitude };
    let count = |bits: u32| BigInt::from(1) << bits;
    let (least, greatest) = (-count(width - 1), count(width) - 1);
    if value < least || value > greatest {
        let (least, greatest, value) = (least.to_string(), greatest.to_string(), text.to_owned());
        return Err(StimulusError::TooWide { place, name, value, width, least, greatest });
    }
    let value = if value.sign() == Sign::Minus { value + count(width) } else { value };
    let mut parts = value.to_u64_digits().1;
    parts.resize(input.nets().count(), 0);
    values.extend(parts);
    Ok(())
}

impl Stimulus {
    /// Constant values, given as `NAME=VALUE`: one a word.
    ///
    /// # Errors
    /// There is no such input, it is given twice, or the value does not fit.
    pub fn constants<'a>(
        design: &Design,
        given: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Stimulus, StimulusError> {
        let mut stimulus = Stimulus::default();
        for (name, text) in given {
            let place = format!("--set {name}={text}");
            let input = stimulus.input(design, name, &place)?;
            let mut values = Vec::new();
            value(design.netlist(), input, name, text, &place, &mut values)?;
            stimulus.constants.extend(input.nets().zip(values));
        }
        Ok(stimulus)
    }

    /// The same with the columns of a table in CSV: its first line names inputs.
    ///
    /// # Errors
    /// There is no such input, one is given twice, a row has another number of values, or a value does not fit.
    pub fn table(mut self, design: &Design, csv: &str) -> Result<Stimulus, StimulusError> {
        let lines = csv.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
        let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let (line, head) = lines.next().ok_or(StimulusError::Empty)?;
        let head = head.trim_start_matches('\u{feff}');
        let names: Vec<&str> = head.split(',').map(unquoted).collect();
        let mut inputs = Vec::new();
        for name in &names {
            let input = self.input(design, name, &format!("line {line}"))?;
            self.columns.extend(input.nets());
            inputs.push(input);
        }
        for (line, row) in lines {
            let texts: Vec<&str> = row.split(',').map(unquoted).collect();
            if texts.len() != names.len() {
                return Err(StimulusError::Row { line, given: texts.len(), wanted: names.len() });
            }
            let place = format!("line {line}");
            let mut values = Vec::with_capacity(self.columns.len());
            for ((input, name), text) in inputs.iter().zip(&names).zip(texts) {
                value(design.netlist(), input, name, text, &place, &mut values)?;
            }
            self.rows.push(values);
        }
        Ok(self)
    }

    /// The input of this name, which has no value yet.
    fn input<'d>(&self, design: &'d Design, name: &str, place: &str) -> Result<&'d NamedNet, StimulusError> {
        let inputs = inputs(design);
        let Some((input, _)) = inputs.iter().find(|(_, own)| own == name) else {
            let names: Vec<&str> = inputs.iter().map(|(_, name)| name.as_str()).collect();
            return Err(StimulusError::NoInput {
                place: place.to_owned(),
                name: name.to_owned(),
                hint: did_you_mean(name, names.iter().copied()),
                inputs: if names.is_empty() { "none".to_owned() } else { names.join(", ") },
            });
        };
        let constants = self.constants.iter().map(|(net, _)| net);
        if constants.chain(&self.columns).any(|other| *other == input.net) {
            return Err(StimulusError::Twice { place: place.to_owned(), name: name.to_owned() });
        }
        Ok(input)
    }

    /// Rows of the table.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Nets of all inputs that it has values for.
    pub(super) fn inputs(&self) -> impl Iterator<Item = Net> + '_ {
        self.constants.iter().map(|(net, _)| *net).chain(self.columns.iter().copied())
    }

    /// Inputs that do not change.
    pub(super) fn held(&self) -> impl Iterator<Item = (Net, u64)> + '_ {
        self.constants.iter().copied()
    }

    /// What changes with row k; nothing after the last row.
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = (Net, u64)> + '_ {
        let values = self.rows.get(row).into_iter().flatten();
        self.columns.iter().copied().zip(values.copied())
    }
}

fn unquoted(text: &str) -> &str {
    let text = text.trim();
    text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text)
}
