//! Names: of a net, or of several nets that make up a word of more than 64 bits.

use super::{Net, Netlist, ScopeId};
use crate::bits::Reading;

/// How a person wants to read a named net.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Format {
    /// Unsigned decimal.
    Unsigned,
    /// Two's-complement decimal.
    Signed,
    /// Two's-complement decimal, drawn as a curve.
    Analog,
    /// Unsigned decimal, drawn as a curve.
    Level,
    /// Ones and zeros.
    Binary,
    /// Decimal digits, 4 bits each.
    Decimal,
    /// A name for each value.
    States(Vec<(u64, String)>),
}

impl Format {
    /// Read as two's complement.
    #[must_use]
    pub fn is_signed(&self) -> bool {
        self.reading().is_signed()
    }

    /// What number the bits mean.
    #[must_use]
    pub fn reading(&self) -> Reading {
        match self {
            Format::Signed | Format::Analog => Reading::Signed,
            Format::Decimal => Reading::Decimal,
            Format::Unsigned | Format::Level | Format::Binary | Format::States(_) => Reading::Unsigned,
        }
    }
}

/// A name for a net, or for a word of more than 64 bits: nets of which all but the highest have 64 bits. A net may have
/// several names.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct NamedNet {
    /// The net; of a word its lowest 64 bits.
    pub net: Net,
    /// The nets above it, the lower first; none of a name of one net.
    pub above: Vec<Net>,
    /// Scope that the name belongs to.
    pub scope: ScopeId,
    /// The name, unique in its scope.
    pub name: String,
    /// How to show it.
    pub format: Format,
    /// It is an output port of the whole: an author's own, which logic inside may read too.
    pub output: bool,
}

impl NamedNet {
    /// A name of one net, no output port.
    #[must_use]
    pub fn new(net: Net, scope: ScopeId, name: &str, format: Format) -> NamedNet {
        NamedNet { net, above: Vec::new(), scope, name: name.to_owned(), format, output: false }
    }

    /// Bits of every net of a word but the highest.
    pub const PART: u32 = 64;

    /// A name of several nets.
    #[must_use]
    pub fn is_wide(&self) -> bool {
        !self.above.is_empty()
    }

    /// All its nets, the lowest first.
    pub fn nets(&self) -> impl DoubleEndedIterator<Item = Net> + Clone + '_ {
        std::iter::once(self.net).chain(self.above.iter().copied())
    }

    /// The same name of other nets.
    #[must_use]
    pub fn map(&self, mut go: impl FnMut(Net) -> Net) -> NamedNet {
        let net = go(self.net);
        NamedNet { net, above: self.above.iter().map(|&net| go(net)).collect(), ..self.clone() }
    }
}

/// An operand of any width: nets as those of a [`NamedNet`], with the reading that makes them a number.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Word {
    /// The lowest 64 bits first.
    pub nets: Vec<Net>,
    /// Two's complement.
    pub signed: bool,
}

impl Word {
    /// The same of other nets.
    #[must_use]
    pub fn map(self, go: impl FnMut(Net) -> Net) -> Word {
        Word { nets: self.nets.into_iter().map(go).collect(), signed: self.signed }
    }
}

impl Netlist {
    /// Bits of some nets together.
    pub fn bits(&self, nets: impl IntoIterator<Item = Net>) -> u32 {
        nets.into_iter().map(|net| self.width(net).get()).sum()
    }

    /// What is wrong with nets that are to make up a word, and exist.
    #[must_use]
    pub(crate) fn word_mistake(&self, nets: &[Net]) -> Option<String> {
        let (_, lower) = nets.split_last()?;
        let short = lower.iter().find(|net| self.width(**net).get() != NamedNet::PART)?;
        Some(format!(
            "{} is below another part of a word: all but its highest part have {} bits",
            self.describe(*short),
            NamedNet::PART
        ))
    }

    /// The bits of a word, the highest first, given the value of each net.
    pub fn digits(&self, named: &NamedNet, value: impl Fn(Net) -> u64) -> String {
        let part = |net| format!("{:01$b}", value(net), self.width(net).get() as usize);
        named.nets().rev().map(part).collect()
    }
}
