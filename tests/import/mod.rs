//! Hardware of one's own: the JSON of Yosys becomes a netlist that does what the source does.

pub(crate) mod bench;
mod cells;
mod command;
mod overflow;
mod printed;
mod program;
mod refused;
mod undefined;
mod wide;

use serde_json::{Value, json};
use stepwave::engine::{EngineKind, Rows, Watch};
use stepwave::import::{ImportError, Imported, Options, import};
use stepwave::netlist::{Design, elaborate};

/// A module of ports, cells and names, each as Yosys writes it.
fn module(ports: Value, cells: Value, names: Value) -> String {
    let module = json!({ "attributes": { "top": "1" }, "ports": ports, "cells": cells, "netnames": names });
    json!({ "creator": "Yosys", "modules": { "t": module } }).to_string()
}

fn port(direction: &str, bits: impl IntoIterator<Item = u32>) -> Value {
    json!({ "direction": direction, "bits": bits.into_iter().collect::<Vec<_>>() })
}

fn name(bits: impl IntoIterator<Item = u32>) -> Value {
    json!({ "hide_name": 0, "bits": bits.into_iter().collect::<Vec<_>>(), "attributes": { "src": "t.v:3.1-3.9" } })
}

/// A cell with the parameters 1 that are named, and what is on its pins.
fn cell(kind: &str, ones: &[&str], pins: Value) -> Value {
    let parameters: serde_json::Map<_, _> = ones.iter().map(|one| ((*one).to_owned(), json!("1"))).collect();
    json!({ "type": kind, "parameters": parameters, "attributes": { "src": "t.v:7.3-7.9" }, "connections": pins })
}

fn imported(text: &str) -> Result<Imported, ImportError> {
    import(text, &Options::default())
}

fn design(text: &str) -> Design {
    elaborate(imported(text).expect("an import").netlist).expect("a netlist")
}

/// The samples of some signals by their names, in some clocks, which are the same on every engine; inputs change as given.
/// A word of more than 64 bits has a column for each of its nets, the lowest first.
fn samples(design: &Design, signals: &[&str], inputs: &[&[(&str, u64)]]) -> Vec<Vec<u64>> {
    let netlist = design.netlist();
    let named = |name: &str| netlist.find(name).unwrap_or_else(|| panic!("no {name}"));
    let columns = signals.iter().flat_map(|name| named(name).nets()).collect();
    let watch = Watch { columns, stops: Vec::new() };
    let runs = EngineKind::ALL.map(|kind| {
        let mut engine = kind.build(design, &watch);
        let mut rows = Rows::new(watch.columns.len(), inputs.len());
        for (clock, row) in inputs.iter().enumerate() {
            row.iter().for_each(|(name, value)| engine.set_input(named(name).net, *value));
            match clock {
                0 => engine.reset(&mut rows),
                _ => _ = engine.run(1, &mut rows),
            }
        }
        (0..inputs.len()).map(|row| rows.row(row).to_vec()).collect::<Vec<_>>()
    });
    assert_eq!(runs[0], runs[1]);
    assert_eq!(runs[0], runs[2]);
    runs[0].clone()
}
