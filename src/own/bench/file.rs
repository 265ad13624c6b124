//! The form of a bench file, in TOML.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

/// A bench file as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    /// Name of the clock, for readers: a netlist has one.
    pub(super) clock: Option<Spanned<String>>,
    pub(super) reset: Option<Reset>,
    /// Constants on inputs.
    #[serde(default)]
    pub(super) set: BTreeMap<String, Spanned<Value>>,
    pub(super) max_axes: Option<Spanned<u64>>,
    pub(super) curves: Option<Spanned<Curves>>,
    pub(super) split: Option<Spanned<Split>>,
    /// What is on inputs for a block.
    #[serde(default)]
    pub(super) load: BTreeMap<String, Spanned<Value>>,
    pub(super) start: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) strobe: Strobe,
    pub(super) done: Option<Spanned<String>>,
    /// Clocks of a block, of hardware that does not say when it has ended.
    pub(super) clocks: Option<Spanned<Value>>,
    pub(super) step: Option<Spanned<String>>,
    pub(super) table: Option<Spanned<Vec<String>>>,
    /// Signals that are 1 in every clock of the runs that a proof without geometries looks at.
    pub(super) assume: Option<Spanned<Vec<String>>>,
    /// Overflows that end a run.
    #[serde(default)]
    pub(super) strict: Vec<String>,
    /// Overflows that are announced.
    #[serde(default)]
    pub(super) wraps: Vec<String>,
    #[serde(default)]
    pub(super) axis: BTreeMap<String, Spanned<Axis>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Reset {
    pub(super) port: Spanned<String>,
    #[serde(default = "one")]
    pub(super) active: Spanned<u64>,
    #[serde(default = "one")]
    pub(super) clocks: Spanned<u64>,
}

fn one() -> Spanned<u64> {
    Spanned::new(0..0, 1)
}

/// A number, or the text of one or of an expression.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "a whole number below 2^63, or a number of any size or an expression in quotes")]
pub(super) enum Value {
    Number(i64),
    Text(String),
}

impl Value {
    pub(super) fn text(&self) -> String {
        match self {
            Value::Number(number) => number.to_string(),
            Value::Text(text) => text.clone(),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Curves {
    Lines,
    Arcs,
    Both,
}

/// Where arcs are split.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Split {
    /// Nowhere.
    None,
    /// Where they cross an axis through their centre.
    Quadrants,
}

/// How long `start` is 1.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Strobe {
    /// For one clock.
    #[default]
    Pulse,
    /// Until the block has ended.
    Level,
}

/// What of a 1-bit signal is a pulse.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Count {
    /// A rising edge.
    Edges,
    /// Each clock in which it is 1.
    Clocks,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Axis {
    pub(super) step: Option<String>,
    pub(super) pulse: Option<String>,
    pub(super) up: Option<String>,
    pub(super) down: Option<String>,
    pub(super) quadrature: Option<[String; 2]>,
    pub(super) position: Option<String>,
    pub(super) direction: Option<String>,
    pub(super) negative: Option<String>,
    pub(super) count: Option<Count>,
}
