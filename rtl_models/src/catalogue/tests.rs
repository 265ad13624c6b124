//! What is not right about a model is reported when it is installed.
//!
//! None of these installs succeeds, so that other tests of this process have the catalogue of this crate.

use stepwave_nc::Line;
use stepwave_netlist::dsl::Scope;

use super::catalogue;
use crate::machine::Words;
use crate::model::{Interpolates, Method, Model};
use crate::options::WIDTH;
use crate::parts::{Block, DownCounter, axis_counter};
use crate::plan::Plan;
use crate::{Hardware, ModelError};

/// A line along x alone.
static ALONG_X: Model = Model {
    name: "along-x",
    title: "",
    method: "",
    source: "",
    registers: &[],
    options: &[&WIDTH],
    claims: None,
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    plan.register("e", 5).positions(line.from().iter().zip(line.to()).map(|(&from, &to)| vec![from, to]));
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    wired(m, hardware, "e");
}

fn wired(m: Scope<'_>, hardware: &Hardware, counter: &str) {
    let block = Block::new(m);
    for letter in ["x", "y"] {
        axis_counter(m, &block, letter, hardware.bits(letter), block.busy, m.lit(1, 0));
    }
    let last = DownCounter::new(m, &block, counter, hardware.bits(counter)).count(block.busy);
    block.close(block.load, block.busy, last);
}

fn load(_: &Line, _: &Hardware) -> Vec<Words> {
    vec![vec![("e", 8), ("x", 0), ("y", 0)]]
}

fn refused(model: &'static Model) -> String {
    catalogue().with(model).install().unwrap_err().to_string()
}

#[test]
fn a_model_is_added_to_those_of_the_crate() {
    let own = catalogue().with(&ALONG_X);
    assert_eq!(own.len(), catalogue().len() + 1);
    assert_eq!(own.iter().last().unwrap().name, "along-x");
    assert_eq!(super::check(&ALONG_X), Ok(()));
}

#[test]
fn a_name_that_another_model_has_is_refused() {
    static NAMESAKE: Model = Model { name: "ppc-arc", ..PLAIN };
    assert_eq!(refused(&NAMESAKE), "the model ppc-arc does not work: another model has this name");
}

const PLAIN: Model = Model {
    name: "plain",
    title: "",
    method: "",
    source: "",
    registers: &[],
    options: &[],
    claims: None,
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

#[test]
fn a_register_that_was_not_planned_is_refused_with_its_name() {
    static TYPO: Model = Model { name: "typo", hardware: |m, hardware| wired(m, hardware, "ee"), ..PLAIN };
    let reason = refused(&TYPO);
    assert!(reason.starts_with("the model typo does not work: ") && reason.contains("ee"), "{reason}");
}

#[test]
fn a_word_for_a_register_that_does_not_exist_is_refused_with_its_name() {
    static WORD: Model = Model {
        name: "word",
        interpolates: Interpolates::Lines(2, Method { plan, load: |_, _| vec![vec![("f", 1)]] }),
        ..PLAIN
    };
    let reason = refused(&WORD);
    assert!(reason.starts_with("the model word does not work: ") && reason.contains('f'), "{reason}");
}

#[test]
fn a_model_that_loads_nothing_is_refused() {
    static NOTHING: Model =
        Model { name: "nothing", interpolates: Interpolates::Lines(2, Method { plan, load: |_, _| vec![] }), ..PLAIN };
    assert!(refused(&NOTHING).ends_with("it loads no block"), "{}", refused(&NOTHING));
}
