//! What is not right about a model is reported when it is installed.
//!
//! None of these installs succeeds, so that other tests of this process have the catalogue of this crate.

use stepwave_nc::Line;
use stepwave_netlist::dsl::Scope;

use super::catalogue;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::WIDTH;
use crate::parts::{Block, E, END, F, POSITION};
use crate::plan::Plan;
use crate::registers::{N, Reg, Rule, Where};
use crate::{Hardware, ModelError};

/// A line along x alone.
static ALONG_X: Model = Model {
    name: "along-x",
    title: "",
    method: "",
    source: "",
    registers: &[&E, &POSITION],
    options: &[&WIDTH],
    claims: None,
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    plan.n = 4;
    plan.positions(line.from().iter().zip(line.to()).map(|(&from, &to)| [from, to]));
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    wired(m, hardware, E);
}

fn wired(m: Scope<'_>, hardware: &Hardware, counter: Reg) {
    let block = Block::new(m);
    for axis in [0, 1] {
        hardware.axis(m, &block, axis, block.busy, m.lit(1, 0));
    }
    let last = hardware.counter(m, &block, counter).count(block.busy);
    block.close(block.load, block.busy, last);
}

fn load(_: &Line, _: &Hardware) -> Vec<Words> {
    vec![Words::new().set(E, 8).set_each(POSITION.pair(), [0, 0])]
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
    registers: &[&E, &POSITION],
    options: &[],
    claims: None,
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

#[test]
fn a_register_that_is_not_listed_is_refused_with_its_name() {
    static OTHER: Model = Model { name: "other", hardware: |m, hardware| wired(m, hardware, END.of(0)), ..PLAIN };
    let reason = refused(&OTHER);
    assert!(reason.starts_with("the model other does not work: ") && reason.contains("ex"), "{reason}");
}

#[test]
fn a_register_that_no_hardware_has_is_refused_with_its_name() {
    const NONE: Reg = Reg::new("none", N, "").hidden();
    static LISTED: Model = Model { name: "listed", registers: &[&E, &POSITION, &NONE], ..PLAIN };
    assert!(refused(&LISTED).ends_with("it has no register none"), "{}", refused(&LISTED));
}

#[test]
fn a_register_that_is_listed_twice_is_refused_with_its_name() {
    static TWICE: Model = Model { name: "twice", registers: &[&E, &POSITION, &E.about("again")], ..PLAIN };
    assert!(refused(&TWICE).ends_with("it lists the register e twice"), "{}", refused(&TWICE));
}

#[test]
fn two_registers_of_one_name_in_one_hardware_are_refused_whatever_their_conditions() {
    static EVER: Where = Where("always", |_| true);
    const FIRST: Reg = Reg::new("e", N, "one").when(&EVER);
    const SECOND: Reg = Reg::new("e", N, "another").when(&EVER);
    static TWO: Model = Model { name: "two", registers: &[&FIRST, &SECOND, &POSITION], ..PLAIN };
    assert!(refused(&TWO).ends_with("two of its registers have one name"), "{}", refused(&TWO));
}

#[test]
fn a_register_without_a_width_is_refused_with_its_name() {
    const OPEN: Reg = Reg::new("open", Rule::Planned("as it needs"), "");
    static WITHOUT: Model = Model { name: "without", registers: &[&OPEN, &E, &POSITION], ..PLAIN };
    assert!(refused(&WITHOUT).ends_with("its plan gives no width to the register open"), "{}", refused(&WITHOUT));
}

#[test]
fn a_register_of_another_width_than_planned_is_refused_with_both() {
    static WIDE: Model = Model {
        name: "wide",
        hardware: |m, hardware| {
            m.reg(A.name(), 9).set(m.lit(9, 0));
            wired(m, hardware, E);
        },
        registers: &[&E, &POSITION, &A],
        ..PLAIN
    };
    const A: Reg = Reg::new("a", N, "");
    assert!(refused(&WIDE).ends_with("its register a has 9 bits, but 4 are planned"), "{}", refused(&WIDE));
}

#[test]
fn every_model_of_the_crate_has_the_registers_that_it_lists() {
    for model in catalogue().iter() {
        assert_eq!(super::check(model), Ok(()), "{}", model.name);
    }
}

#[test]
fn a_word_for_a_register_that_does_not_exist_is_refused_with_its_name() {
    static WORD: Model = Model {
        name: "word",
        interpolates: Interpolates::Lines(2, Method { plan, load: |_, _| vec![Words::new().set(F, 1)] }),
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
