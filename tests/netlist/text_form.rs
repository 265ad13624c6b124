//! The text form: what is refused, and that a line which cannot be read does not spoil those after it.

use std::collections::HashMap;

use stepwave_netlist::passes::simplify;
use stepwave_netlist::{elaborate, text};

/// What is said of a text, line by line, without the code that all of them have.
fn said(text: &str) -> Vec<String> {
    let said = text::parse(text).expect_err("a mistake is reported").to_string();
    said.lines().map(|line| line.strip_suffix(" [Syntax]").unwrap().to_owned()).collect()
}

/// A netlist in which every line is needed by a later one.
const GOOD: &str = "netlist m
scope 1 in 0 \"x\"
scope 2 in 1 \"y\"
%0:4 = input
%1:4 = register reset 0x3 next %4
%2:4 = const 0x1
%3:1 = carry %1 %2
%4:4 = add %1 %2
%5:1 = not %3
name %0 in 0 \"a\" unsigned
name %1 in 2 \"count\" states 0x1 \"ONE\" 0x2 \"TWO\"
property \"m.count\" never %3 add %1 unsigned %2 unsigned
";

#[test]
fn one_line_that_cannot_be_read_is_one_mistake() {
    let lines: Vec<&str> = GOOD.lines().collect();
    assert!(elaborate(text::parse(GOOD).unwrap()).is_ok());
    for (index, line) in lines.iter().enumerate() {
        // Spoiled in the middle, at its beginning, and at its end.
        let spoiled = [
            line.replacen(' ', " ?", 1),
            format!("?{line}"),
            format!("{line} ?"),
            line.chars().take(5).collect(),
            line.replacen([':', '"'], "?", 1),
        ];
        for spoiled in spoiled.iter().filter(|spoiled| *spoiled != line) {
            let mut changed: Vec<&str> = lines.clone();
            changed[index] = spoiled;
            if let Err(diagnostics) = text::parse(&changed.join("\n")) {
                assert_eq!(diagnostics.0.len(), 1, "line '{spoiled}':\n{diagnostics}");
                assert!(diagnostics.to_string().starts_with(&format!("line {}: ", index + 1)), "{diagnostics}");
            } else {
                // No name at all is one, of one character more.
                assert_eq!((index, spoiled.as_str()), (0, "netlist ?m"));
            }
        }
    }
}

#[test]
fn a_line_that_is_missing_or_doubled_is_one_mistake() {
    let lines: Vec<&str> = GOOD.lines().collect();
    for index in 0..9 {
        let mut missing = lines.clone();
        missing.remove(index);
        let mut doubled = lines.clone();
        doubled.insert(index, lines[index]);
        let mut texts = vec![doubled];
        // The numbers of the last scope and of the last cell are missed by nobody.
        if ![2, 8].contains(&index) {
            texts.push(missing);
        }
        for text in texts {
            let said = said(&text.join("\n"));
            assert_eq!(said.len(), 1, "without or twice '{}': {said:?}", lines[index]);
        }
    }
}

#[test]
fn the_first_line_names_the_netlist() {
    let expected = |line: &str| vec![format!("line 1: expected 'netlist NAME' first in '{line}'")];
    for line in ["%0:1 = input", "scope 1 in 0 \"x\"", "name %0 in 0 \"a\" unsigned", "nonsense", "netlists m"] {
        // With the name after it, and without one.
        assert_eq!(said(&format!("{line}\nnetlist m\n")), expected(line));
        assert_eq!(said(&format!("{line}\n")), expected(line));
    }
    assert_eq!(said("\n\n"), ["line 1: expected 'netlist NAME' in the first line"]);
    assert_eq!(said("netlist\n%0:1 = input\n"), ["line 1: expected more words in 'netlist'"]);
    // Empty lines are no lines.
    assert!(text::parse("\n  \nnetlist m\n").is_ok());
}

#[test]
fn the_source_line_of_a_cell_is_printed_parsed_and_reported() {
    let lines = [
        "netlist m",
        r#"%0:4 = input at "my \"adder\".v" 3 17"#,
        r#"%1:4 = register reset 0x0 next %2 at "dda.v" 12 0"#,
        r#"%2:4 = add %0 %1 at "dda.v" 14 9"#,
        "%3:4 = not %2",
    ];
    let netlist = text::parse(&lines.join("\n")).unwrap();
    assert_eq!(text::print(&netlist), lines.join("\n") + "\n");
    assert_eq!(netlist.sources[2].as_ref().unwrap().to_string(), "dda.v:14");
    let simplified = simplify(&netlist, &HashMap::new());
    assert_eq!(simplified.netlist.sources, netlist.sources);

    let wrong = text::parse("netlist m\n%0:4 = register reset 0x0 at \"dda.v\" 7 1\n").unwrap();
    let message = elaborate(wrong).unwrap_err().to_string();
    assert_eq!(message, "dda.v:7: register %0 never gets a next value [UndrivenRegister]");

    for line in
        ["%0:4 = input on", "%0:4 = input at dda.v 1 2", "%0:4 = input at \"dda.v\" 1", "%0:4 = input at \"d\" 1 2 3"]
    {
        let said = said(&format!("netlist m\n{line}\n"));
        assert!(said.len() == 1 && said[0].starts_with("line 2: "), "{line}: {said:?}");
    }
}

#[test]
fn numbers_are_digits_and_nothing_else() {
    for line in [
        "%+0:4 = input",
        "%0:+4 = input",
        "%0: 4 = input",
        "%0:4 = const 0x+3",
        "%0:4 = const 0x-3",
        "%0:4 = const 0x",
        "%0:4 = const 0x0x3",
        "%0:4 = const 3",
        "%0:4 = register reset 0x+3 next %0",
        "%0:4 = register reset 0x3 next %+0",
        "%0:4 = not %+0",
        "%0:4 = not %-0",
        "%0:4 = not %",
        "%0:4 = not %4294967296",
        "%0:2 = slice %0 +1",
        "%0:2 = slice %0 256",
        "scope +1 in 0 \"x\"",
        "scope 1 in +0 \"x\"",
        "name %+0 in 0 \"a\" unsigned",
        "name %0 in +0 \"a\" unsigned",
        "name %0 in 0 \"a\" states 0x+1 \"ONE\"",
        "name %0 in 0 \"\\u{+41}\" unsigned",
        "name %0 in 0 \"\\u41}\" unsigned",
        "name %0 in 0 \"\\u{{41}\" unsigned",
        "name %0 in 0 \"\\u{41\" unsigned",
        "property \"p\" never %+0 invariant",
    ] {
        let said = said(&format!("netlist m\n{line}\n"));
        assert!(said.len() == 1 && said[0].starts_with("line 2: "), "{line}: {said:?}");
    }
}
