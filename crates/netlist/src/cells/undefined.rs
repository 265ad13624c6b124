//! Operations that have no result by the rules of a hardware language; in a netlist it is 0.

/// An operation without a result.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Undefined {
    /// A quotient by 0.
    Quotient,
    /// The remainder of a division by 0.
    Remainder,
    /// A word outside of a memory is read.
    Read {
        /// The lowest address.
        first: u64,
        /// Number of words.
        words: u64,
    },
    /// A word outside of a memory is written, which does nothing.
    Write {
        /// The lowest address.
        first: u64,
        /// Number of words.
        words: u64,
    },
}

impl Undefined {
    /// Its word in the text form and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Undefined::Quotient => "quotient",
            Undefined::Remainder => "remainder",
            Undefined::Read { .. } => "read",
            Undefined::Write { .. } => "write",
        }
    }

    /// What it is, in words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Undefined::Quotient | Undefined::Remainder => "division by zero",
            Undefined::Read { .. } => "read outside of a memory",
            Undefined::Write { .. } => "write outside of a memory",
        }
    }

    /// The lowest address and the number of words of a memory.
    #[must_use]
    pub fn memory(self) -> Option<(u64, u64)> {
        match self {
            Undefined::Quotient | Undefined::Remainder => None,
            Undefined::Read { first, words } | Undefined::Write { first, words } => Some((first, words)),
        }
    }
}
