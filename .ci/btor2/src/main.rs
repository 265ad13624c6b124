//! Exported BTOR2 in the model checker patronus.
//!
//! `btor2-judge values FILE.btor2 FILE.csv` simulates the model and compares every named net with a table of values, one
//! line a clock; it prints how many values were the same. `btor2-judge first FILE.btor2 CLOCKS` simulates and prints the
//! first clock in which a property is violated, or `none`. `btor2-judge check FILE.btor2 CLOCKS` does the same by bounded
//! model checking with Z3, whatever the inputs.

use std::collections::HashMap;
use std::error::Error;
use std::fs;

use baa::BitVecOps;
use patronus::btor2;
use patronus::expr::{Context, ExprRef};
use patronus::mc::{ModelCheckResult, bmc};
use patronus::sim::{InitKind, Interpreter, Simulator};
use patronus::smt::{CVC5, Solver};
use patronus::system::TransitionSystem;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// The model, and the names of its outputs: every symbol becomes one, for patronus forgets names of expressions that it
/// has seen before.
fn model(path: &str) -> Outcome<(Context, TransitionSystem, Vec<String>)> {
    let mut text = fs::read_to_string(path)?;
    let (mut outputs, mut names, mut last) = (String::new(), Vec::new(), 0);
    let mut own = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with(';')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [number, operator, .., symbol] = words[..] else { return Err(format!("{path}: {line}").into()) };
        last = number.parse()?;
        match (operator, symbol.parse::<u64>()) {
            ("bad" | "sort", _) | (_, Ok(_)) => {}
            ("output", Err(_)) => own.push(symbol.to_owned()),
            (_, Err(_)) => names.push((last, symbol.to_owned())),
        }
    }
    for (line, name) in &names {
        last += 1;
        outputs += &format!("{last} output {line} {name}\n");
    }
    text += &outputs;
    let mut context = Context::default();
    let system = btor2::parse_str(&mut context, &text, None).ok_or("patronus does not take it")?;
    own.extend(names.into_iter().map(|(_, name)| name));
    Ok((context, system, own))
}

fn value(simulator: &Interpreter, expression: ExprRef) -> Outcome<u64> {
    let value = simulator.get(expression);
    let value: baa::BitVecValue = value.try_into().map_err(|_| "an array")?;
    Ok(value.to_u64().ok_or("more than 64 bits")?)
}

fn values(path: &str, table: &str) -> Outcome<String> {
    let (context, system, names) = model(path)?;
    let outputs = names.iter().map(String::as_str).zip(system.outputs.iter().map(|output| output.expr));
    let outputs: HashMap<&str, ExprRef> = outputs.collect();
    let table = fs::read_to_string(table)?;
    let mut lines = table.lines();
    let columns: Vec<&str> = lines.next().ok_or("an empty table")?.split(',').collect();
    let mut simulator = Interpreter::new(&context, &system);
    simulator.init(InitKind::Zero);
    let mut compared = 0;
    for (clock, line) in lines.enumerate() {
        if clock > 0 {
            simulator.step();
        }
        for (name, wanted) in columns.iter().zip(line.split(',')) {
            let expression = outputs.get(name).ok_or_else(|| format!("{path} knows no {name}"))?;
            let (wanted, found) = (wanted.parse::<u64>()?, value(&simulator, *expression)?);
            if wanted != found {
                return Err(format!("{path}: {name} is {found} at clock {clock}, not {wanted}").into());
            }
            compared += 1;
        }
    }
    Ok(compared.to_string())
}

fn first(path: &str, clocks: u64) -> Outcome<String> {
    let (context, system, _) = model(path)?;
    let mut simulator = Interpreter::new(&context, &system);
    simulator.init(InitKind::Zero);
    for clock in 0..=clocks {
        if clock > 0 {
            simulator.step();
        }
        for &bad in &system.bad_states {
            if value(&simulator, bad)? != 0 {
                return Ok(clock.to_string());
            }
        }
    }
    Ok("none".to_owned())
}

fn check(path: &str, clocks: u64) -> Outcome<String> {
    let (mut context, system, _) = model(path)?;
    let mut solver = CVC5.start(None)?;
    match bmc(&mut context, &mut solver, &system, false, false, clocks)? {
        ModelCheckResult::Success => Ok("none".to_owned()),
        ModelCheckResult::Fail(witness) => Ok((witness.inputs.len() - 1).to_string()),
        ModelCheckResult::Unknown => Err("Z3 does not know".into()),
    }
}

fn main() -> Outcome<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let answer = match words[..] {
        ["values", path, table] => values(path, table)?,
        ["first", path, clocks] => first(path, clocks.parse()?)?,
        ["check", path, clocks] => check(path, clocks.parse()?)?,
        _ => return Err("see the head of this program".into()),
    };
    println!("{answer}");
    Ok(())
}
