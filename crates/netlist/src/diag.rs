//! What is wrong with a netlist, said so that its author finds the place. Diagnostics are collected, never thrown:
//! one build reports all mistakes.

use std::fmt;

use crate::cells::Source;

/// The kind of a mistake, stable for tests and for people who search for it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Code {
    /// Two nets that must be equally wide are not.
    WidthMismatch,
    /// A condition, select or property is wider than one bit.
    NotOneBit,
    /// A slice or extension asks for bits that are not there.
    OutOfRange,
    /// A width outside 1 to 64.
    BadWidth,
    /// A constant or reset value does not fit its width.
    ValueTooWide,
    /// A register was never given a next value.
    UndrivenRegister,
    /// A register was given a next value twice.
    DrivenTwice,
    /// Two signals of one scope, or two scopes, have the same name.
    DuplicateName,
    /// A name that wave files cannot carry.
    BadName,
    /// An operand is created after its user, and no register is between them.
    Order,
    /// A signal of another module.
    ForeignSignal,
    /// A strict operator on a net that has no name to report.
    Unnamed,
    /// The text form of a netlist cannot be read.
    Syntax,
}

/// Where a mistake was made: a line of the model's source, of a netlist text, or just a component.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Place {
    /// Source line of the model, or of the file that it was imported from.
    Source(Source),
    /// Line of a netlist text, from 1.
    Line(usize),
    /// A component by its path.
    Component(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Source(source) => source.fmt(f),
            Place::Line(line) => write!(f, "line {line}"),
            Place::Component(path) => f.write_str(path),
        }
    }
}

/// One mistake: what, where, and how to put it right.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// Kind of the mistake.
    pub code: Code,
    /// Where it was made.
    pub place: Place,
    /// A sentence with the names and widths concerned.
    pub message: String,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} [{:?}]", self.place, self.message, self.code)
    }
}

/// All mistakes of one netlist; at least one.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostics(pub Vec<Diagnostic>);

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.0.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{diagnostic}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}
