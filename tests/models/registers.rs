//! The page `docs/registers.md` follows from the declarations of registers, and these say what the netlists have.
//!
//! `STEPWAVE_BLESS=1 cargo test --test main models::registers` writes the page anew.

use std::fmt::Write as _;
use std::path::Path;

use stepwave_models::options::{FORM, Form};
use stepwave_models::{Model, Options, catalogue};
use stepwave_netlist::bits::Reading;

use super::digests::curves;

const HEAD: &str = "# The registers

Every register of every model by its declaration, from which `stepwave list` is made too: `cargo test` fails where this page
is old, and `STEPWAVE_BLESS=1 cargo test --test main models::registers` writes it anew. Widths are in bits: n holds the
largest magnitude of the geometry, or is what `--width` says; q is `--fraction`, k and p are in the pages of `stepgen`. With
`--radix 10` integrands, remainders and coefficients are binary-coded decimal. With `--form signed` registers whose
text names the signed form are in two's complement.
";

fn describe(text: &mut String, model: &Model) {
    let axes = model.curve().max_axes();
    write!(text, "\n## `{}`\n\n{}: {}.\n\n", model.name, model.title, model.curve().describe()).unwrap();
    text.push_str("| register | width | reading | holds | exists |\n|---|---|---|---|---|\n");
    for row in model.rows() {
        let declared = row.declaration;
        let reading = if declared.signed { "signed" } else { "unsigned" };
        let (when, rule) = (declared.when.words(model.options), declared.rule.to_string());
        let when = if when.is_empty() { "always" } else { &when };
        let cells = [&row.label(axes), &rule, reading, declared.about, when].map(|cell| cell.replace('|', "\\|"));
        writeln!(text, "| {} |", cells.join(" | ")).unwrap();
    }
}

#[test]
fn registers_page_is_that_of_the_catalogue() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/registers.md");
    let mut now = HEAD.to_owned();
    catalogue().iter().for_each(|model| describe(&mut now, model));
    if std::env::var_os("STEPWAVE_BLESS").is_some() {
        std::fs::write(&path, now).unwrap();
        return;
    }
    let recorded = std::fs::read_to_string(&path).unwrap();
    for (index, (now, recorded)) in now.lines().zip(recorded.lines()).enumerate() {
        assert_eq!(now, recorded, "line {} of docs/registers.md", index + 1);
    }
    assert_eq!(now.len(), recorded.len());
}

#[test]
fn registers_are_read_as_they_are_declared() {
    let (mut compared, mut odd) = (0, Vec::new());
    for model in catalogue().iter() {
        let default = Options::default();
        let signed = Options::default().with(&FORM, Form::Signed);
        for (curve, options) in curves(model).iter().flat_map(|curve| [(curve, &default), (curve, &signed)]) {
            let Ok(hardware) = model.plan(curve, options) else { continue };
            let machine = model.machine(&hardware).unwrap();
            for row in model.rows() {
                for name in row.names(hardware.axes) {
                    let always = row.declaration.when.words(model.options).is_empty();
                    let of_form = options == &signed && row.declaration.about.contains("signed form");
                    match machine.design.netlist().find(name).map(|named| named.format.reading() == Reading::Signed) {
                        Some(sign) if sign == (row.declaration.signed || of_form) => compared += 1,
                        None if !always => {}
                        found => odd.push(format!("{}: {name}: {found:?}", model.name)),
                    }
                }
            }
        }
    }
    assert_eq!(odd, [""; 0]);
    assert!(compared > 300, "{compared}");
}
