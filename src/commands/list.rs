//! `stepwave list`.

use std::fmt::Write as _;

use serde_json::{Value, json};
use stepwave::models::{CurveKind, Model, catalogue};

use crate::cli::ListArgs;
use crate::failure::Failure;
use crate::output;

/// Prints every model, by method.
pub(crate) fn run(args: &ListArgs) -> Result<(), Failure> {
    if args.json {
        let models: Vec<Value> = catalogue().iter().map(as_json).collect();
        return output::print_data(&format!("{:#}\n", json!(models)));
    }
    let methods = by_method();
    let mut text = format!("{} models by method\n\n", catalogue().len());
    let widest = methods.iter().map(|(method, _)| method.chars().count()).max().unwrap_or(0);
    // Writing to a string cannot fail.
    for (method, models) in &methods {
        let names: Vec<&str> = models.iter().map(|model| model.name).collect();
        let _ = writeln!(text, "  {method:<widest$}  {}", names.join(", "));
    }
    let _ =
        writeln!(text, "\nWidths are in bits; n holds the largest magnitude of the geometry, or is what --width says.");
    let columns = Columns::new();
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
    for model in catalogue() {
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
    fn new() -> Columns {
        let registers = || catalogue().iter().flat_map(|model| model.registers);
        let options = catalogue().iter().flat_map(|model| model.choices).map(|doc| doc.choice.option());
        let widest = |texts: &mut dyn Iterator<Item = &str>| texts.map(|text| text.chars().count()).max().unwrap_or(0);
        Columns {
            name: widest(&mut registers().map(|register| register.name).chain(options)),
            width: widest(&mut registers().map(|register| register.width)),
        }
    }

    fn describe(&self, text: &mut String, model: &Model) {
        let Columns { name, width } = *self;
        let _ = writeln!(text, "\n  {}  {}", model.name, model.title);
        let _ = writeln!(text, "    takes {}", model.curve.describe());
        let _ = writeln!(text, "    registers");
        for register in model.registers {
            let _ = writeln!(text, "      {:<name$}  {:<width$}  {}", register.name, register.width, register.about);
        }
        let _ = writeln!(text, "    options");
        for doc in model.choices {
            let _ = writeln!(text, "      {:<name$}  {}", doc.choice.option(), doc.values);
        }
        let _ = writeln!(text, "    source {}", model.source);
    }
}

fn as_json(model: &Model) -> Value {
    let kind = match model.curve {
        CurveKind::Line { .. } => "line",
        CurveKind::Arc => "arc",
        CurveKind::Conic => "conic",
        CurveKind::Helix => "helix",
    };
    let registers = model
        .registers
        .iter()
        .map(|register| json!({ "name": register.name, "default_width": register.width, "about": register.about }));
    let options = model.choices.iter().map(|doc| json!({ "option": doc.choice.option(), "values": doc.values }));
    json!({
        "name": model.name,
        "title": model.title,
        "method": model.method,
        "curve": { "kind": kind, "max_axes": model.curve.max_axes() },
        "registers": registers.collect::<Vec<_>>(),
        "options": options.collect::<Vec<_>>(),
        "source": model.source,
    })
}
