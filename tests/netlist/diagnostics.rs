//! Diagnostics: every kind of mistake once, and what is said of it.

use stepwave_netlist::dsl::{Module, Scope};
use stepwave_netlist::{Code, Diagnostics, Place, elaborate, text};

use super::mistakes;

const CODES: [Code; 13] = [
    Code::WidthMismatch,
    Code::NotOneBit,
    Code::OutOfRange,
    Code::BadWidth,
    Code::ValueTooWide,
    Code::UndrivenRegister,
    Code::DrivenTwice,
    Code::DuplicateName,
    Code::BadName,
    Code::Order,
    Code::ForeignSignal,
    Code::Unnamed,
    Code::Syntax,
];

/// What is said of a description in a module `m`.
fn described(describe: impl FnOnce(Scope<'_>)) -> Diagnostics {
    let module = Module::new("m");
    describe(module.top());
    module.finish().expect_err("a mistake is reported")
}

/// What is said of the lines after `netlist m`.
fn parsed(lines: &str) -> Diagnostics {
    match text::parse(&format!("netlist m\n{lines}")) {
        Ok(netlist) => elaborate(netlist).expect_err("a mistake is reported"),
        Err(diagnostics) => diagnostics,
    }
}

fn messages(diagnostics: &Diagnostics) -> Vec<&str> {
    diagnostics.0.iter().map(|diagnostic| diagnostic.message.as_str()).collect()
}

/// A line of this file, this many below `line`, as messages give it.
fn below(line: u32, lines: u32) -> String {
    format!("{}:{}", file!(), line + lines)
}

/// One mistake of each kind, and its message.
fn example(code: Code) -> (Diagnostics, String) {
    let (diagnostics, message) = match code {
        Code::WidthMismatch => (
            described(|m| m.reg("r", 4).set(m.scope("part").input("a", 3))),
            "next value of register m.r (4 bits): m.part.a (3 bits) is given where 4 bits are needed",
        ),
        Code::NotOneBit => (
            described(|m| {
                let (a, b) = (m.input("a", 4), m.input("b", 2));
                m.name("chosen", b.mux(a, a));
            }),
            "m.b (2 bits) selects, so it must be 1 bit",
        ),
        Code::OutOfRange => (
            described(|m| {
                m.name("part", m.input("a", 4).slice(2, 3));
            }),
            "a slice of 3 bits from bit 2 of m.a (4 bits) reaches past its top",
        ),
        Code::BadWidth => (
            described(|m| {
                let _ = m.input("a", 65);
            }),
            "a: a width of 65 bits is not possible: a register holds 1 to 64 bits",
        ),
        Code::ValueTooWide => (
            described(|m| {
                m.name("minus_nine", m.lit_signed(4, -9));
            }),
            "the value -9 does not fit in 4 bits",
        ),
        Code::UndrivenRegister => (
            described(|m| {
                let _ = m.scope("part").reg("r", 4);
            }),
            "register m.part.r (4 bits) never gets a next value",
        ),
        Code::DrivenTwice => {
            let first = below(line!(), 3);
            let twice = described(|m| {
                let r = m.reg("r", 4);
                r.when(m.input("load", 1), m.input("a", 4)).else_hold();
                r.set(m.input("b", 4));
            });
            return (twice, format!("register m.r (4 bits) has a next value already, given at {first}"));
        }
        Code::DuplicateName => {
            let first = below(line!(), 3);
            let twice = described(|m| {
                let part = m.scope("part");
                let a = part.input("a", 4);
                part.name("a", a);
            });
            return (twice, format!("'a' is already a name in m.part, given at {first}"));
        }
        Code::BadName => (
            described(|m| {
                let _ = m.input("2nd", 4);
            }),
            "invalid name '2nd': letters, digits and _ only, not beginning with a digit",
        ),
        Code::Order => (parsed("%0:4 = not %1\n%1:4 = input"), "net %0 reads a net that does not come before it"),
        Code::ForeignSignal => {
            let other = Module::new("other");
            let foreign = described(|m| {
                m.name("a", other.top().scope("part").input("x", 3));
            });
            (foreign, "other.part.x (3 bits) is a signal of another module, not of m")
        }
        Code::Unnamed => (
            described(|m| {
                m.name("sum", (!m.input("a", 4)).strict_add(m.input("b", 4), m.lit(1, 1)));
            }),
            "a strict operator needs a named left operand to report",
        ),
        Code::Syntax => (parsed("%0:4 = turn %0"), "expected an operator in '%0:4 = turn %0'"),
    };
    (diagnostics, message.to_owned())
}

#[test]
fn each_kind_of_mistake_is_reported_once_and_names_what_it_concerns() {
    for code in CODES {
        let (diagnostics, message) = example(code);
        let codes: Vec<Code> = diagnostics.0.iter().map(|diagnostic| diagnostic.code).collect();
        assert_eq!(codes, [code], "{diagnostics}");
        assert_eq!(messages(&diagnostics), [message]);
    }
}

#[test]
fn a_mistake_in_a_description_is_placed_at_the_line_that_made_it() {
    for code in CODES {
        let (diagnostics, _) = example(code);
        match (code, &diagnostics.0[0].place) {
            (Code::Order, place) => assert_eq!(*place, Place::Component("net %0".to_owned())),
            (Code::Syntax, place) => assert_eq!(*place, Place::Line(2)),
            (_, Place::Source(location)) => {
                assert!(location.file().ends_with("diagnostics.rs"), "{code:?} is placed at {location}");
            }
            (_, place) => panic!("{code:?} is placed at {place}"),
        }
    }
}

#[test]
fn a_mismatch_names_both_sides_with_their_paths_and_widths() {
    let cases: [(Diagnostics, &str); 6] = [
        (
            described(|m| {
                let _ = m.scope("x").input("a", 4) & m.scope("y").input("b", 5);
            }),
            "m.x.a (4 bits) and m.y.b (5 bits) are not equally wide",
        ),
        (
            described(|m| {
                let _ = m.input("a", 4).less_than(m.input("b", 1));
            }),
            "m.a (4 bits) and m.b (1 bit) are not equally wide",
        ),
        (
            described(|m| {
                let _ = m.input("s", 1).mux(m.input("a", 4), m.input("b", 3));
            }),
            "m.a (4 bits) and m.b (3 bits) are not equally wide",
        ),
        (
            described(|m| {
                let _ = m.input("a", 9).extend(8);
            }),
            "m.a (9 bits) cannot be extended to 8 bits",
        ),
        (
            described(|m| {
                let _ = m.input("a", 40).concat(m.input("b", 25));
            }),
            "a width of 65 bits is not possible: a register holds 1 to 64 bits",
        ),
        (described(|m| m.invariant("never", m.input("a", 2))), "a property is 1 bit wide, not 2 bits"),
    ];
    for (diagnostics, message) in cases {
        assert_eq!(messages(&diagnostics), [message]);
    }
}

#[test]
fn a_module_and_its_scopes_bear_names_that_a_wave_can_carry() {
    for name in ["two words", "", "1st", "é", "a.b"] {
        let diagnostics = Module::new(name).finish().unwrap_err();
        assert_eq!(diagnostics.0[0].code, Code::BadName, "'{name}'");
        let diagnostics = described(|m| {
            let _ = m.scope(name);
        });
        assert_eq!(diagnostics.0[0].code, Code::BadName, "'{name}'");
    }
    for name in ["a", "_", "A_1", "jrx"] {
        let module = Module::new(name);
        let _ = module.top().scope(name).input(name, 1);
        assert!(module.finish().is_ok(), "'{name}'");
    }
}

#[test]
fn a_description_with_many_mistakes_reports_all_of_them_at_once() {
    let said = described(mistakes::describe).to_string().replace('\\', "/");
    let want = include_str!("mistakes.expect");
    assert!(said.lines().eq(want.lines()), "mistakes.expect no longer holds what is said:\n{said}\n");
}

#[test]
fn one_mistake_does_not_hide_the_netlist_after_it() {
    // The mistaken cell is replaced by a constant of the width asked for, so its users bring no further complaints.
    let diagnostics = described(|m| {
        let sum = m.input("a", 4).wrapping_add(m.input("b", 5));
        let r = m.reg("r", 4);
        r.set(sum.wrapping_add(r.q));
        m.name("sum", sum);
    });
    assert_eq!(messages(&diagnostics), ["m.a (4 bits) and m.b (5 bits) are not equally wide"]);
}
