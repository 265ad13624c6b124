//! `stepwave list`.

use std::fmt::Write as _;

use crate::models::options::{Shape, Takes};
use crate::models::{Model, find, installed};
use serde_json::{Value, json};

use crate::Error;
use crate::cli::ListArgs;
use crate::output;

/// Prints every model, by method, or those that are named.
pub(crate) fn run(args: &ListArgs) -> Result<(), Error> {
    let named = args.models.iter().map(|name| find(name));
    let named: Vec<&'static Model> = named.collect::<Result<_, _>>()?;
    let models = if named.is_empty() { installed().iter().collect() } else { named };
    if args.json {
        let models: Vec<Value> = models.into_iter().map(as_json).collect();
        return output::print_data(&format!("{:#}\n", json!(models)));
    }
    if !args.models.is_empty() {
        let mut text = String::new();
        let columns = Columns::new(&models);
        models.iter().for_each(|model| columns.describe(&mut text, model));
        return output::print(text.trim_start_matches('\n'));
    }
    let methods = by_method();
    let mut text = format!("{} models by method\n\n", models.len());
    let widest = methods.iter().map(|(method, _)| method.chars().count()).max().unwrap_or(0);
    // Writing to a string cannot fail.
    for (method, models) in &methods {
        let names: Vec<&str> = models.iter().map(|model| model.name).collect();
        let _ = writeln!(text, "  {method:<widest$}  {}", names.join(", "));
    }
    let _ =
        writeln!(text, "\nWidths are in bits; n holds the largest magnitude of the geometry, or is what --width says.");
    let columns = Columns::new(&models);
    for (method, models) in &methods {
        let _ = writeln!(text, "\n{method}\n{}", "─".repeat(method.chars().count()));
        for model in models {
            columns.describe(&mut text, model);
        }
    }
    output::print(&text)
}

/// The models of each method, methods in the order of their first model.
fn by_method() -> Vec<(&'static str, Vec<&'static Model>)> {
    let mut methods: Vec<(&'static str, Vec<&'static Model>)> = Vec::new();
    for model in installed().iter() {
        match methods.iter_mut().find(|(method, _)| *method == model.method) {
            Some((_, models)) => models.push(model),
            None => methods.push((model.method, vec![model])),
        }
    }
    methods
}

/// Widths of the columns, the same for all models.
struct Columns {
    name: usize,
    width: usize,
}

impl Columns {
    fn new(models: &[&'static Model]) -> Columns {
        let of_model = |model: &&'static Model| {
            let axes = model.curve().max_axes();
            model.rows().map(move |row| row.label(axes))
        };
        let options = models.iter().flat_map(|model| model.options).map(|takes| format!("--{}", takes.name()));
        let widest =
            |texts: &mut dyn Iterator<Item = String>| texts.map(|text| text.chars().count()).max().unwrap_or(0);
        let rules = |model: &&'static Model| model.rows().map(|row| row.declaration.rule.to_string());
        Columns {
            name: widest(&mut models.iter().flat_map(of_model).chain(options)),
            width: widest(&mut models.iter().flat_map(rules)),
        }
    }

    fn describe(&self, text: &mut String, model: &Model) {
        let Columns { name, width } = *self;
        let _ = writeln!(text, "\n  {}  {}", model.name, model.title);
        let _ = writeln!(text, "    takes {}", model.curve().describe());
        let _ = writeln!(text, "    registers");
        for row in model.rows() {
            let (label, rule) = (row.label(model.curve().max_axes()), row.declaration.rule.to_string());
            let when = row.declaration.when.words(model.options);
            let when = if when.is_empty() { when } else { format!(" ({when})") };
            let _ = writeln!(text, "      {label:<name$}  {rule:<width$}  {}{when}", row.declaration.about);
        }
        let _ = writeln!(text, "    options");
        for takes in model.options {
            let _ = writeln!(text, "      {:<name$}  {}", format!("--{}", takes.name()), takes.about());
        }
        let _ = writeln!(text, "    source {}", model.source);
    }
}

fn as_json(model: &Model) -> Value {
    let registers = model.rows().map(|row| {
        let (label, rule) = (row.label(model.curve().max_axes()), row.declaration.rule.to_string());
        let declared = row.declaration;
        let when = Some(declared.when.words(model.options)).filter(|words| !words.is_empty());
        json!({
            "name": label, "default_width": rule, "signed": declared.signed, "about": declared.about, "when": when,
        })
    });
    let options = model.options.iter().map(|takes| {
        json!({
            "option": format!("--{}", takes.name()),
            "values": values(*takes),
            "default": takes.default_value().map(|value| value.text().to_owned()),
            "about": takes.about(),
        })
    });
    json!({
        "name": model.name,
        "title": model.title,
        "method": model.method,
        "curve": { "kind": model.curve().name(), "max_axes": model.curve().max_axes() },
        "registers": registers.collect::<Vec<_>>(),
        "options": options.collect::<Vec<_>>(),
        "source": model.source,
    })
}

/// The words that a model takes for an option; none where it takes numbers alone.
fn values(takes: &'static dyn Takes) -> Vec<&'static str> {
    match takes.option().shape() {
        Shape::PerRegister { words, .. } => words.to_vec(),
        _ => takes.words().into_iter().map(|(word, _)| word).collect(),
    }
}
