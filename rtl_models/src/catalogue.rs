//! The list of models, to which a user adds his own.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use stepwave_nc::{Curve, PulseBlock, Spline, SplineForm};

use crate::MODELS;
use crate::described::known;
use crate::error::ModelError;
use crate::machine::Words;
use crate::model::Model;
use crate::options::{ALL, AnyOption, Options, Shape};
use crate::program::{FASTEST_SPEED, Size};

/// Models, in the order of `stepwave list`.
#[derive(Clone, Debug)]
pub struct Catalogue {
    models: Vec<&'static Model>,
    options: Vec<&'static dyn AnyOption>,
}

/// The models of this crate.
#[must_use]
pub fn catalogue() -> Catalogue {
    let options = Catalogue { models: Vec::with_capacity(MODELS.len()), options: ALL.to_vec() };
    MODELS.iter().fold(options, |catalogue, model| catalogue.with(model))
}

#[cfg(test)]
mod tests;

static INSTALLED: OnceLock<Catalogue> = OnceLock::new();

/// The catalogue of this process: the one [installed](Catalogue::install), or else that of this crate.
#[must_use]
pub fn installed() -> &'static Catalogue {
    INSTALLED.get_or_init(catalogue)
}

/// The model of this name in the [installed] catalogue, or one that is [known](crate::know) besides.
///
/// # Errors
/// There is none; the message lists those there are.
pub fn find(name: &str) -> Result<&'static Model, ModelError> {
    let models = installed();
    models.iter().find(|model| model.name == name).or_else(|| known(name)).ok_or_else(|| ModelError::UnknownModel {
        name: name.to_owned(),
        known: models.iter().map(|model| model.name).collect::<Vec<_>>().join(", "),
    })
}

impl Catalogue {
    /// With one more model.
    #[must_use]
    pub fn with(mut self, model: &'static Model) -> Catalogue {
        self.models.push(model);
        for takes in model.options {
            if self.options.iter().all(|known| known.name() != takes.name()) {
                self.options.push(takes.option());
            }
        }
        self
    }

    /// Every model.
    pub fn iter(&self) -> impl Iterator<Item = &'static Model> + '_ {
        self.models.iter().copied()
    }

    /// Those that run programs, in the order of the list.
    pub fn machines(&self) -> impl Iterator<Item = &'static Model> + '_ {
        self.iter().filter(|model| model.is_buffered())
    }

    /// Number of models.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "there are always those of this crate")]
    pub fn len(&self) -> usize {
        self.models.len()
    }

    /// Every option that a model takes, in the order of the command line.
    #[must_use]
    pub fn options(&self) -> &[&'static dyn AnyOption] {
        &self.options
    }

    /// Makes these the models of the process, once, after a check of those that are not of this crate: names are unique,
    /// and with every value of every option a small curve is planned, wired and loaded.
    ///
    /// # Errors
    /// A model does not work, or models are installed or were looked up before.
    pub fn install(self) -> Result<(), ModelError> {
        for (index, model) in self.models.iter().enumerate().skip(MODELS.len()) {
            if self.models[..index].iter().any(|other| other.name == model.name) {
                return Err(ModelError::defect(model.name, "another model has this name".to_owned()));
            }
            check(model)?;
        }
        let twice = |_| ModelError::defect("catalogue", "it is installed twice, or too late".to_owned());
        INSTALLED.set(self).map_err(twice)
    }
}

/// Options that are tried: every word, and of numbers the least.
fn tried(model: &'static Model) -> Result<Vec<Options>, ModelError> {
    let mut tried = vec![Options::default()];
    for takes in model.options {
        let mut texts: Vec<String> = takes.words().iter().map(|(word, _)| (*word).to_owned()).collect();
        if let Shape::Numbers { least, .. } = takes.option().shape() {
            texts.push(least.to_string());
        }
        if let Shape::Text { some, .. } = takes.option().shape() {
            texts.extend(some.iter().map(|text| (*text).to_owned()));
        }
        for text in texts {
            let mut options = Options::default();
            options.set(takes.option().parse(&text).map_err(|reason| ModelError::defect(model.name, reason))?);
            tried.push(options);
        }
    }
    Ok(tried)
}

/// Plans, wires and loads a small curve with every word of every option; a register that the model lists must be there
/// with one of them, as wide as it is planned.
fn check(model: &'static Model) -> Result<(), ModelError> {
    let Ok(curves) = model.curve().samples() else { return Ok(()) };
    let axes = curves.iter().map(Curve::axes).max().unwrap_or(0);
    let (mut missing, mut always) = (BTreeSet::new(), BTreeSet::new());
    for row in model.rows() {
        // Two that are never in one hardware may have one name.
        let conditional = !row.declaration.when.words(model.options).is_empty();
        for name in row.names(axes) {
            missing.insert(*name);
            if !conditional && !always.insert(*name) {
                return Err(ModelError::defect(model.name, format!("it lists the register {name} twice")));
            }
        }
    }
    for curve in &curves {
        missing = without_those_of(model, curve, missing)?;
    }
    let missing = without_those_of_programs(model, missing)?;
    // Of many, such as the units of a cascade, a small curve has only the first.
    let first = model.rows().filter_map(|row| row.names.first());
    match first.into_iter().find(|name| missing.contains(*name)) {
        Some(name) => Err(ModelError::defect(model.name, format!("it has no register {name} with any option"))),
        None => Ok(()),
    }
}

/// Plans, wires and loads a program of a free curve, if the model takes them whole; gives the registers that are still missing.
fn without_those_of_programs(
    model: &'static Model,
    mut missing: BTreeSet<&'static str>,
) -> Result<BTreeSet<&'static str>, ModelError> {
    let points = [[0, 0], [4, 0], [8, 4], [8, 8]];
    let curve = Spline::new(SplineForm::Bezier, &points).ok().and_then(|curve| PulseBlock::alone(&curve.into()));
    let (Some(moves), Some(block)) = (model.moves().ok().filter(|moves| moves.curves()), curve) else {
        return Ok(missing);
    };
    let defect = |error: ModelError| ModelError::defect(model.name, format!("with a free curve: {error}"));
    let mut size = Size::default();
    size.add(moves.crossing(), &block);
    let hardware = model.plan_program(&size, &Options::default()).map_err(defect)?;
    let machine = model.machine(&hardware).map_err(defect)?;
    missing.retain(|name| machine.design.netlist().find(name).is_none());
    let blocks = moves.words(&hardware, &block, FASTEST_SPEED).map_err(defect)?;
    let words: Vec<Words> = blocks.into_iter().map(|block| block.words).collect();
    machine.load(&hardware, &words).map_err(defect)?;
    Ok(missing)
}

/// Plans, wires and loads this curve with every word of every option; gives the registers that are still missing.
fn without_those_of(
    model: &'static Model,
    curve: &Curve,
    mut missing: BTreeSet<&'static str>,
) -> Result<BTreeSet<&'static str>, ModelError> {
    for options in tried(model)? {
        let words = options.words().join(" ");
        let defect = |error: ModelError| ModelError::defect(model.name, format!("with '{words}': {error}"));
        let hardware = match model.plan(curve, &options) {
            Ok(hardware) => hardware,
            // What a model refuses by a rule of its own is not a defect.
            Err(ModelError::Value { .. } | ModelError::Widths(_)) if !options.given().is_empty() => continue,
            Err(error) => return Err(defect(error)),
        };
        let machine = model.machine(&hardware).map_err(defect)?;
        let netlist = machine.design.netlist();
        missing.retain(|name| netlist.find(name).is_none());
        for (name, planned) in &hardware.widths {
            let Some(named) = netlist.find(name) else {
                return Err(ModelError::defect(model.name, format!("with '{words}': it has no register {name}")));
            };
            let bits = netlist.width(named.net).get();
            if bits != planned.get() {
                let what = format!("its register {name} has {bits} bits, but {} are planned", planned.get());
                return Err(ModelError::defect(model.name, what));
            }
        }
        let blocks = model.words(&hardware, curve).map_err(defect)?;
        if blocks.is_empty() {
            return Err(ModelError::defect(model.name, format!("with '{words}': it loads no block")));
        }
        machine.load(&hardware, &blocks).map_err(defect)?;
    }
    Ok(missing)
}
