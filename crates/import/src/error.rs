//! Why a design cannot be imported.

use std::fmt;

/// A cell in words: its kind, its name or the register that it drives, and the line of the source.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct CellPlace {
    /// Kind of cell, as Yosys names it.
    pub kind: String,
    /// Name of the net that it drives, or of the cell.
    pub name: String,
    /// `file:line`, where the source is known.
    pub source: Option<String>,
}

impl fmt::Display for CellPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} '{}'", self.kind, self.name)?;
        match &self.source {
            Some(source) => write!(f, " ({source})"),
            None => Ok(()),
        }
    }
}

/// Why a design cannot be imported.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The text is not what Yosys writes.
    #[error("not the JSON that Yosys writes (write_json): {error}")]
    Json {
        /// What was found.
        error: String,
    },
    /// The module that is asked for does not exist.
    #[error("there is not {wanted}; the modules there are: {there}")]
    NoTop {
        /// What was asked for.
        wanted: String,
        /// The modules in the file.
        there: String,
    },
    /// A kind of cell that cannot be simulated on one clock.
    #[error("{cell}: {why}")]
    Cell {
        /// Which cell.
        cell: CellPlace,
        /// What is wrong with it, and the remedy.
        why: String,
    },
    /// There is more than one clock.
    #[error(
        "two clocks: {first} of {first_user}, and {second} of {second_user}; a design is simulated on one edge of one clock"
    )]
    Clocks {
        /// One of them, with its edge.
        first: String,
        /// A cell on it.
        first_user: Box<CellPlace>,
        /// The other.
        second: String,
        /// A cell on that.
        second_user: Box<CellPlace>,
    },
    /// The clock is not an input.
    #[error("the clock '{clock}' of {user} is {what}, not an input of the design: gate with an enable instead")]
    ComputedClock {
        /// Name of the net.
        clock: String,
        /// A cell on it.
        user: CellPlace,
        /// What drives it.
        what: String,
    },
    /// The clock is read as data.
    #[error("the clock '{clock}' is read as data by {user}: in a sample after its edge it has no one value")]
    ClockAsData {
        /// Name of the net.
        clock: String,
        /// What reads it.
        user: String,
    },
    /// Combinational logic depends on itself.
    #[error("a combinational loop through {}", cells.iter().map(ToString::to_string).collect::<Vec<_>>().join(", then "))]
    Loop {
        /// The cells of the loop, in order.
        cells: Vec<CellPlace>,
    },
    /// A bit has two drivers.
    #[error("net '{net}' is driven by {first} and by {second}")]
    TwoDrivers {
        /// Name of the net.
        net: String,
        /// One driver.
        first: String,
        /// Another.
        second: String,
    },
    /// A port that is input and output at once.
    #[error("port '{port}' is an inout: tristate nets cannot be simulated; split it into an input and an output")]
    Inout {
        /// Name of the port.
        port: String,
    },
    /// A word that is too wide.
    #[error("{what} has {bits} bits, more than the {most} that are imported")]
    TooWide {
        /// Which net or cell.
        what: String,
        /// Its width.
        bits: usize,
        /// The greatest width.
        most: usize,
    },
}
