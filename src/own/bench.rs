//! A bench file: what the ports of a netlist mean, so that it runs geometries as a model does.

mod conditions;
mod expression;
mod file;
mod geometry;
mod harness;
mod model;
mod program;
mod resolve;

use std::path::{Path, PathBuf};

use self::expression::Expression;
use self::file::Strobe;
use super::FileError;
use crate::models::CurveKind;
use crate::netlist::bits::Reading;
use crate::netlist::cells::{NamedNet, ScopeId};
use crate::netlist::{Net, Netlist, Width};
use crate::testbench::net_named;

pub(crate) use conditions::{Conditions, Fixed};
pub use model::{is_netlist, model};

/// Why a bench file does not describe hardware.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// The netlist or the bench file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// There is no bench file next to the netlist.
    #[error(
        "{netlist} has no bench file, which says what its ports mean: write {bench}, or name one with --bench; \
         `stepwave sim` runs a netlist without one"
    )]
    Missing {
        /// The netlist.
        netlist: String,
        /// Where its bench file is looked for.
        bench: String,
    },
    /// It is not TOML, or has a key that is not known.
    #[error("cannot read {file}: {message}")]
    Form {
        /// The file.
        file: String,
        /// What is wrong, with an extract.
        message: String,
    },
    /// A value is wrong.
    #[error("{file}:{line}: {message}")]
    Value {
        /// The file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        message: String,
    },
}

/// A 1-bit signal of the netlist, or its complement.
#[derive(Clone, Copy, Debug)]
struct Wire {
    net: Net,
    inverted: bool,
}

/// What ends a block.
#[derive(Clone, Debug)]
enum End {
    /// A signal is 1 once the block has been started.
    Done(Wire),
    /// A number of clocks, by an expression.
    Clocks { word: Word },
}

/// A word that is computed from the geometry.
#[derive(Clone, Debug)]
struct Word {
    /// Name for messages and among the words of a block: `load.xe`.
    name: &'static str,
    expression: Expression,
    /// As it is written.
    text: String,
    width: Width,
    reading: Reading,
    /// Bits of the input, whether it is signed, and which of its nets of up to 64 bits takes the word, the lowest first.
    bits: u32,
    of_signed: bool,
    part: u32,
}

/// An input, and the word on it.
#[derive(Clone, Debug)]
struct Loaded {
    input: Net,
    word: Word,
}

/// How an axis pulses.
#[derive(Clone, Copy, Debug)]
enum Pulses {
    /// A pulse is a rising edge, or each clock that the signal is 1; it is negative where the direction is 1.
    Strobe { pulse: Wire, negative: Option<Wire>, edges: bool },
    /// A signed number of pulses, -1, 0 or 1, in each clock.
    Signed(Net),
    /// One signal for each direction.
    UpDown { up: Wire, down: Wire, edges: bool },
    /// Two signals a quarter of a period apart; the first leads in the positive direction.
    Quadrature([Wire; 2]),
    /// A counter of pulses, of any width.
    Position(Net),
    /// It never pulses: the y axis of a machine of one axis, as a geometry has two.
    Still,
}

/// A netlist whose ports have a meaning.
#[derive(Clone, Debug)]
pub(crate) struct Bench {
    file: PathBuf,
    netlist: Netlist,
    curve: CurveKind,
    /// Arcs are loaded in parts between the axes through their centre.
    splits: bool,
    /// An expression reads the commanded speed.
    reads_speed: bool,
    reset: Option<Reset>,
    constants: Vec<(Net, u64)>,
    loads: Vec<Loaded>,
    start: Option<Wire>,
    strobe: Strobe,
    end: End,
    step: Option<Wire>,
    /// Signals of the step table; all registers where none are listed.
    table: Option<Vec<String>>,
    axes: Vec<Pulses>,
    /// Overflows that end a run, and that are announced, besides those of the options.
    strict: Vec<String>,
    wraps: Vec<String>,
}

/// The reset input, and how it is driven.
#[derive(Clone, Copy, Debug)]
struct Reset {
    input: Net,
    /// Its value while it resets.
    active: bool,
    /// Edges at which it resets.
    clocks: u64,
}

/// The signal of this name: of the top, by its path, or by the end of it.
fn word<'n>(netlist: &'n Netlist, name: &str) -> Result<&'n NamedNet, String> {
    let of_top = format!("{}.{name}", netlist.scopes[0].name);
    let found = netlist.names.iter().find(|named| named.name == name && named.scope == ScopeId::TOP);
    let found = found.or_else(|| netlist.names.iter().find(|named| netlist.path(named) == of_top));
    found.map_or_else(|| net_named(netlist, name).map_err(|error| error.to_string()), Ok)
}

/// The same of up to 64 bits.
fn signal<'n>(netlist: &'n Netlist, name: &str) -> Result<&'n NamedNet, String> {
    let found = word(netlist, name)?;
    if found.is_wide() {
        let bits = netlist.bits(found.nets());
        return Err(format!("'{name}' has {bits} bits: of signals that are not inputs a bench file takes up to 64"));
    }
    Ok(found)
}

/// The bench file next to a netlist.
pub(crate) fn next_to(netlist: &Path) -> PathBuf {
    netlist.with_extension("toml")
}
