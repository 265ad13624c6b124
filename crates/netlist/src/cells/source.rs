//! Where a cell comes from: a line of the program that described it, or of a file that was imported.

use std::fmt;
use std::panic::Location;
use std::sync::Arc;

use super::{Net, Netlist};

/// A source line.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Source {
    /// Of the program that described the netlist.
    Rust(&'static Location<'static>),
    /// Of a file in another language, as the tool that read it names it.
    File {
        /// Path of the file.
        file: Arc<str>,
        /// Line, from 1.
        line: u32,
        /// Column, from 1; 0 where it is not known.
        column: u32,
    },
}

impl Source {
    /// The line that called.
    #[track_caller]
    #[must_use]
    pub fn here() -> Source {
        Source::Rust(Location::caller())
    }

    /// Path of the file.
    #[must_use]
    pub fn file(&self) -> &str {
        match self {
            Source::Rust(location) => location.file(),
            Source::File { file, .. } => file,
        }
    }

    /// Line, from 1.
    #[must_use]
    pub fn line(&self) -> u32 {
        match self {
            Source::Rust(location) => location.line(),
            Source::File { line, .. } => *line,
        }
    }
}

/// `FILE:LINE`.
impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file(), self.line())
    }
}

impl Netlist {
    /// `file:line` of the source that a net was imported from.
    #[must_use]
    pub fn line_of(&self, net: Net) -> Option<String> {
        match self.sources.get(net.index()) {
            Some(Some(source @ Source::File { .. })) => Some(source.to_string()),
            _ => None,
        }
    }
}
