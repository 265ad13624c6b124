//! The JSON of Yosys (`write_json`), as far as an import needs it.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::ImportError;

/// The whole file.
#[derive(Debug, Deserialize)]
pub(crate) struct File {
    #[serde(default)]
    pub(crate) modules: BTreeMap<String, Module>,
}

/// A module: after `flatten` the whole design is one.
#[derive(Debug, Deserialize)]
pub(crate) struct Module {
    #[serde(default)]
    attributes: BTreeMap<String, Value>,
    #[serde(default)]
    pub(crate) ports: BTreeMap<String, Port>,
    #[serde(default)]
    pub(crate) cells: BTreeMap<String, Cell>,
    #[serde(default)]
    pub(crate) netnames: BTreeMap<String, Name>,
}

/// A port of the design.
#[derive(Debug, Deserialize)]
pub(crate) struct Port {
    pub(crate) direction: String,
    pub(crate) bits: Vec<Wire>,
}

/// A cell: its kind, parameters, and what is on its pins.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Cell {
    #[serde(rename = "type")]
    pub(crate) kind: String,
    #[serde(default)]
    parameters: BTreeMap<String, Value>,
    #[serde(default)]
    attributes: BTreeMap<String, Value>,
    #[serde(default)]
    pub(crate) connections: BTreeMap<String, Vec<Wire>>,
}

/// A name of some bits.
#[derive(Debug, Deserialize)]
pub(crate) struct Name {
    #[serde(default)]
    hide_name: u8,
    pub(crate) bits: Vec<Wire>,
    #[serde(default)]
    signed: u8,
    #[serde(default)]
    attributes: BTreeMap<String, Value>,
}

/// A bit of a connection: the number of a net, or a constant as text.
#[derive(Clone, PartialEq, Eq, Debug, Deserialize)]
#[serde(untagged)]
pub(crate) enum Wire {
    Net(u32),
    Constant(String),
}

/// A parameter or an attribute: ones and zeros, a text, or a number.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Value {
    Text(String),
    Number(i64),
}

impl Value {
    /// The digits, most significant first.
    fn digits(&self) -> String {
        match self {
            Value::Text(text) => text.trim_end().to_owned(),
            Value::Number(number) => format!("{number:b}"),
        }
    }

    fn is_set(&self) -> bool {
        self.digits().contains('1')
    }
}

/// A line of a source file.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) struct Place {
    pub(crate) file: String,
    pub(crate) line: u32,
    pub(crate) column: u32,
}

/// The place of an attribute `src` that is a line of the cell's own: `a.v:0.0-0.0|a.v:11.5-11.98`.
///
/// Of a cell in a module that was flattened, older versions of Yosys list the places of its instances too; as they join
/// them, its own is in the middle. An instance that is left keeps its place as `instance_src`.
fn place(attributes: &BTreeMap<String, Value>) -> Option<Place> {
    let text = attributes.get("src").or(attributes.get("instance_src"));
    let Some(Value::Text(text)) = text else { return None };
    let places: Vec<Option<Place>> = text.split('|').map(one_place).collect();
    places.get(places.len() / 2).cloned().flatten().or_else(|| places.into_iter().flatten().next())
}

fn one_place(text: &str) -> Option<Place> {
    let (file, range) = text.rsplit_once(':')?;
    place_at(file, range.split('-').next()?)
}

/// A place of `LINE.COLUMN` in a file.
fn place_at(file: &str, from: &str) -> Option<Place> {
    let (line, column) = from.split_once('.').unwrap_or((from, "0"));
    let (line, column) = (line.parse().ok()?, column.parse().ok()?);
    (line > 0).then(|| Place { file: file.to_owned(), line, column })
}

impl Module {
    fn is_top(&self) -> bool {
        self.attributes.get("top").is_some_and(Value::is_set)
    }
}

impl Cell {
    /// The bits on a pin, least significant first; none where it is not connected.
    pub(crate) fn pin(&self, name: &str) -> &[Wire] {
        self.connections.get(name).map_or(&[], Vec::as_slice)
    }

    /// A parameter that is a flag.
    pub(crate) fn flag(&self, name: &str) -> bool {
        self.parameters.get(name).is_some_and(Value::is_set)
    }

    /// A parameter that is a polarity: 1 unless it says 0.
    pub(crate) fn polarity(&self, name: &str) -> bool {
        self.parameters.get(name).is_none_or(Value::is_set)
    }

    /// A parameter as text: a flavour, a format.
    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        match self.parameters.get(name) {
            Some(Value::Text(text)) => Some(text),
            _ => None,
        }
    }

    /// The digits of a parameter, least significant first, as `0`, `1`, `x` or `z`.
    pub(crate) fn bits(&self, name: &str) -> Vec<char> {
        self.parameters.get(name).map(|value| value.digits().chars().rev().collect()).unwrap_or_default()
    }

    /// A parameter as a signed number, if it fits.
    pub(crate) fn number(&self, name: &str) -> Option<i64> {
        match self.parameters.get(name)? {
            Value::Number(number) => Some(*number),
            Value::Text(text) => {
                let text = text.trim_end();
                let negative = text.len() == 32 && text.starts_with('1');
                let value = i64::from_str_radix(text, 2).ok()?;
                Some(if negative { value - (1 << 32) } else { value })
            }
        }
    }

    pub(crate) fn place(&self) -> Option<Place> {
        place(&self.attributes)
    }

    /// The line of the source by the name of its file alone, for names: `FILE:LINE`.
    pub(crate) fn short_line(&self) -> Option<String> {
        let place = self.place()?;
        let file = place.file.rsplit('/').next().unwrap_or(&place.file);
        Some(format!("{file}:{}", place.line))
    }

    /// The line of the source: `FILE:LINE`. The place of an assertion of older versions of Yosys begins with what is before it.
    pub(crate) fn line(&self) -> Option<String> {
        let last = || {
            let Some(Value::Text(text)) = self.attributes.get("src") else { return None };
            let (file, range) = text.split('|').next_back()?.rsplit_once(':')?;
            place_at(file, range.split('-').next_back()?)
        };
        let is_old = matches!(self.kind.as_str(), "$assert" | "$assume" | "$cover");
        let place = if is_old { last() } else { None };
        place.or_else(|| self.place()).map(|place| format!("{}:{}", place.file, place.line))
    }
}

impl Name {
    /// Made up by Yosys.
    pub(crate) fn is_hidden(&self) -> bool {
        self.hide_name != 0
    }

    pub(crate) fn is_signed(&self) -> bool {
        self.signed != 0
    }

    pub(crate) fn place(&self) -> Option<Place> {
        place(&self.attributes)
    }

    /// Initial value, least significant digit first.
    pub(crate) fn init(&self) -> Vec<char> {
        self.attributes.get("init").map(|value| value.digits().chars().rev().collect()).unwrap_or_default()
    }

    /// An attribute of the source is set: `(* name *)`.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.attributes.get(name).is_some_and(Value::is_set)
    }
}

/// The module that is to be imported: the one of this name, the one marked as top, or the only one.
///
/// # Errors
/// The text is something else, or no module is meant.
pub(crate) fn top(text: &str, name: Option<&str>) -> Result<(String, Module), ImportError> {
    let mut file: File = serde_json::from_str(text).map_err(|error| ImportError::Json { error: error.to_string() })?;
    let mut names: Vec<String> = file.modules.keys().cloned().collect();
    let chosen = match name {
        Some(name) => names.iter().find(|own| *own == name).cloned(),
        None if names.len() == 1 => names.pop(),
        None => names.iter().find(|name| file.modules[*name].is_top()).cloned(),
    };
    chosen.and_then(|name| file.modules.remove_entry(&name)).ok_or_else(|| ImportError::NoTop {
        wanted: name.map_or_else(|| "a module marked as top".to_owned(), |name| format!("module '{name}'")),
        there: if names.is_empty() { "none".to_owned() } else { names.join(", ") },
    })
}
