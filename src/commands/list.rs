//! `stepwave list`.

use std::fmt::Write as _;

use serde_json::{Value, json};
use stepwave::models::{CurveKind, Model, catalogue};

use crate::cli::ListArgs;
use crate::failure::Failure;
use crate::output;

/// Prints every model.
pub(crate) fn run(args: &ListArgs) -> Result<(), Failure> {
    if args.json {
        let models: Vec<Value> = catalogue().iter().map(as_json).collect();
        return output::print(&format!("{:#}\n", json!(models)));
    }
    let mut text = String::new();
    let mut method = "";
    for model in catalogue() {
        if model.method != method {
            method = model.method;
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{}{method}", if text.is_empty() { "" } else { "\n" });
        }
        let _ = writeln!(text, "\n  {}  {}", model.name, model.title);
        let _ = writeln!(text, "    takes {}", model.curve.describe());
        for register in model.registers {
            let _ = writeln!(text, "    {:<14} {:<26} {}", register.name, register.width, register.about);
        }
        for doc in model.choices {
            let _ = writeln!(text, "    {:<14} {}", doc.choice.option(), doc.values);
        }
    }
    output::print(&text)
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
