//! What is refused, where and with which words.

use super::*;

/// The word, the limit and the remedy of every message; the errors of arcs are judged with the arcs.
#[test]
fn every_message_says_what_is_wrong_and_names_the_remedy() {
    let unsupported = "is not supported: rewrite the block with G00 to G03 along X, Y, Z, A, B, C, U, V or W, or remove the word if it does not matter here";
    for (text, line, column, message) in [
        ("G0 X1 G43.1 Z1", 1, 7, format!("G43.1 {unsupported}")),
        ("g0 x1\n g 30", 2, 2, format!("g30 {unsupported}")),
        ("G92 X0", 1, 1, format!("G92 {unsupported}")),
        ("G55", 1, 1, format!("G55 {unsupported}")),
        ("G1.5", 1, 1, format!("G1.5 {unsupported}")),
        ("G17.05", 1, 1, format!("G17.05 {unsupported}")),
        ("G-1", 1, 1, format!("G-1 {unsupported}")),
        ("G81 X1 R1", 1, 1, format!("G81 {unsupported}")),
        ("M98 P1", 1, 1, format!("M98 {unsupported}")),
        ("G0 X1 E5", 1, 7, format!("E5 {unsupported}")),
        ("G0 E-2", 1, 4, format!("E-2 {unsupported}")),
        ("X#5", 1, 1, "parameters (#) are not supported: write the number itself".into()),
        (" #5=1", 1, 2, "parameters (#) are not supported: write the number itself".into()),
        ("G0 X[1+2]", 1, 4, "expressions ([ ]) are not supported: write the number itself".into()),
        (
            "o100 sub",
            1,
            1,
            "o100 is not the number of the program, alone in front of its first block, and O words of flow control are \
             not supported: write the blocks out in the order in which they run"
                .into(),
        ),
        ("G0 X", 1, 4, "X has no number: write one after it, such as X1".into()),
        ("G0 X-", 1, 4, "X has no number: write one after it, such as X1".into()),
        ("G0 X. Y1", 1, 4, "X has no number: write one after it, such as X1".into()),
        ("G0 X(1)2", 1, 4, "X has no number: write one after it, such as X1".into()),
        ("G0 X1(1)2", 1, 9, "'2' does not belong here, only words such as X12.5 and comments do: remove it".into()),
        ("G0 X1.2.3", 1, 8, "'.' does not belong here, only words such as X12.5 and comments do: remove it".into()),
        ("G0 Xé", 1, 4, "X has no number: write one after it, such as X1".into()),
        ("G0 X1 é", 1, 7, "'é' does not belong here, only words such as X12.5 and comments do: remove it".into()),
        ("G0 X1\0", 1, 6, "'\\0' does not belong here, only words such as X12.5 and comments do: remove it".into()),
        ("G0 / X1", 1, 4, "'/' does not belong here, only words such as X12.5 and comments do: remove it".into()),
        ("G0 X1\n(a)\x07", 2, 4, "'\\u{7}' does not belong here, only words such as X12.5 and comments do: remove it".into()),
        ("G0 X1 H2", 1, 7, "H2 has nothing that uses it in this block: it belongs to G43, give that too or remove the word".into()),
        (
            "G41 D1\nG28",
            2,
            1,
            "G28 moves by the machine's zero while tool radius compensation is on: write G40 into a block in front of it".into(),
        ),
        (
            "G0 X1 G41 D1\nG53 Z0",
            2,
            1,
            "G53 moves by the machine's zero while tool radius compensation is on: write G40 into a block in front of it".into(),
        ),
        (
            "G53 Z0",
            1,
            5,
            "Z0 is given, but no G00, G01, G02 or G03 is in force: write the one that is meant into the block".into(),
        ),
        (
            "F1 G2 X1 I0.5\nG53 X2",
            2,
            1,
            "G53 moves in a straight line, and no G00 or G01 is in force: write the one that is meant into the block".into(),
        ),
        ("G0 (x", 1, 4, "the comment that begins here is not closed in its line: put a ) after it".into()),
        ("G0 (x(y))", 1, 6, "a ( inside a comment would begin a second one, which RS-274 does not allow: remove it".into()),
        (
            "% G0",
            1,
            3,
            "% marks the beginning and the end of a program and is alone in its line: break the line there".into(),
        ),
        (
            "G0 X1 %",
            1,
            7,
            "% marks the beginning and the end of a program and is alone in its line: break the line there".into(),
        ),
        ("G0 X000000000000000000000000000000001", 1, 4, "the number of X has more than 32 digits: round it".into()),
        ("T1.5", 1, 1, "T1.5 is not a whole number: the number of T counts, give it without a fraction".into()),
        ("T-1", 1, 1, "T-1 is negative and must be at least 0: remove the sign".into()),
        ("G43 H1.5", 1, 5, "H1.5 is not a whole number: the number of H counts, give it without a fraction".into()),
        ("S - 1", 1, 1, "S-1 is negative and must be at least 0: remove the sign".into()),
        ("G4 P-1", 1, 4, "P-1 is negative and must be at least 0: remove the sign".into()),
        ("G0 N5", 1, 4, "N5 must be the first word of its block: move it to the front".into()),
        (
            "G0 X1 Y2 x3",
            1,
            10,
            "x3 repeats the letter of X1, and one block takes it once: keep one of them, or break the block in two".into(),
        ),
        (
            "G0 G17 G1 X1",
            1,
            8,
            "G1 is of the same modal group as G0, and one block takes one of them: break the block in two".into(),
        ),
        (
            "M3 M5",
            1,
            4,
            "M5 is of the same modal group as M3, and one block takes one of them: break the block in two".into(),
        ),
        (
            "G0 X1 D1",
            1,
            7,
            "D1 has nothing that uses it in this block: it belongs to G41 or G42, give that too or remove the word".into(),
        ),
        (
            "P1",
            1,
            1,
            "P1 has nothing that uses it in this block: it belongs to G02, G03, G04 or G64, give that too or remove the word".into(),
        ),
        ("G17 Y1", 1, 5, "Y1 is given, but no G00, G01, G02 or G03 is in force: write the one that is meant into the block".into()),
        (
            "G90 G1 X1",
            1,
            5,
            "the block moves at a feed, but no F word has been given: write one into this block or one in front of it".into(),
        ),
        ("G1 X1 F0", 1, 7, "invalid feed F0, which must be more than 0: correct the F word".into()),
        ("F-10", 1, 1, "invalid feed F-10, which must be more than 0: correct the F word".into()),
        (
            "G0 X10995116277.77",
            1,
            4,
            "X = 1099511627777 BLU is beyond the limit of ±1099511627776 BLU: correct the word or choose a larger BLU".into(),
        ),
        (
            "G0 X10000000000\nG91\nY1 X1000000000",
            3,
            4,
            "X = 1100000000000 BLU is beyond the limit of ±1099511627776 BLU: correct the word or choose a larger BLU".into(),
        ),
        ("F1099511627777", 1, 1, "F1099511627777 is beyond the limit of 1099511627776: correct the word".into()),
        ("G4", 1, 1, "G4 needs the time in seconds as a P word of at least 0, such as P0.5: write one".into()),
        (
            "G0 X1 G41",
            1,
            7,
            "G41 needs a D word that names the tool, such as G41 D1: write one, and give its radius with `--tool D=RADIUS`".into(),
        ),
        (
            "G42 D7",
            1,
            5,
            "no radius is known for the tool of D7: give it with `--tool D=RADIUS`, such as `--tool 7=4mm`".into(),
        ),
        (
            "G41 D1\nG18",
            2,
            1,
            "G18 changes the plane while tool radius compensation is on: write G40 into a block in front of it".into(),
        ),
        ("", 1, 1, "the program ends and no block of it moved the tool: give it one with G00 to G03 and a coordinate".into()),
        ("%\n(nothing)\nM2", 3, 1, "the program ends and no block of it moved the tool: give it one with G00 to G03 and a coordinate".into()),
        ("G0 X0", 1, 1, "the program ends and no block of it moved the tool: give it one with G00 to G03 and a coordinate".into()),
    ] {
        assert_eq!(fault(text), (line, column, message), "{text}");
    }
}

#[test]
fn an_error_displays_its_line_and_column_in_front() {
    let error = run_with("G0 X1\n\nG0 Y", reading()).unwrap_err();
    assert_eq!(error.to_string(), "line 3, column 4: Y has no number: write one after it, such as Y1");
}

#[test]
fn bytes_that_are_not_text_are_reported_by_place_and_value() {
    let message = "the byte \\xff is not UTF-8 text: save the program as UTF-8 or ASCII";
    assert_eq!(fault(b"G0 X1\n(\xc3\xa4)\xff".as_slice()), (2, 4, message.into()));
    assert_eq!(fault(b"G0 \xff(\xff)".as_slice()), (1, 4, message.into()));
}

#[test]
fn a_column_after_a_comment_counts_its_characters() {
    assert_eq!(fault("(größe)X#1").1, 8);
    // Latin-1: a character is a byte.
    assert_eq!(fault(b"(gr\xf6\xdfe)X#1".as_slice()).1, 8);
}

#[test]
fn an_exponent_is_named_as_such_with_the_number_written_out() {
    for (text, line, column, plain) in [
        ("G0 X-2 Y-59\nG2 F10 I-1.28e-07 J2.0 X-2.0 Y-55.0", 2, 8, "I0 (-0.000000128 to six decimals)"),
        ("G1 X1e-05 Y2.5 F100", 1, 4, "X0.00001"),
        ("G1 X1.5E+2 F100", 1, 4, "X150"),
        ("G1 Y-2.5e0 F100", 1, 4, "Y-2.5"),
        ("G1 Y.25e1 F100", 1, 4, "Y2.5"),
        ("G1 Y1.0000005e0 F100", 1, 4, "Y1 (1.0000005 to six decimals)"),
        ("G0 X1e300", 1, 4, "a number within ±1099511627776"),
    ] {
        let message = format!("exponents are not part of RS-274: write {plain}");
        let (at_line, at_column, found) = fault(text);
        // Half a unit of the last of six decimals may round up or down.
        assert!(found == message || text.contains("0000005"), "{text}: {found}");
        assert_eq!((at_line, at_column), (line, column), "{text}");
    }
    // Not directly after the number it is a letter.
    assert!(fault("G0 X1 E5").2.starts_with("E5 is not supported"));
    assert!(fault("G0 X1e").2.starts_with("e has no number") || fault("G0 X1e").2.starts_with("E has no number"));
}

struct Broken;

impl std::io::Read for Broken {
    fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
        Err(std::io::Error::other("the tape is torn"))
    }
}

#[test]
fn a_program_that_cannot_be_read_is_an_error_at_the_line_that_was_to_come() {
    let text = std::io::Read::chain("G0 X1\n".as_bytes(), std::io::BufReader::new(Broken));
    let outcome: Result<Vec<Event>, ProgramError> = Program::new(text, reading()).unwrap().collect();
    let error = outcome.unwrap_err();
    assert_eq!(error.to_string(), "line 2, column 1: the program cannot be read any further: the tape is torn");
}

#[test]
fn a_second_per_cent_sign_ends_a_program_even_if_nothing_is_between() {
    let (line, column, message) = fault("%\n%\nG0 X1");
    assert_eq!((line, column), (2, 1));
    assert!(message.starts_with("the program ends and no block of it moved"), "{message}");
}

#[test]
fn an_o_word_after_the_head_and_a_plane_that_stays_are_different_errors() {
    assert_eq!(fault("G0 X1\nO1234").1, 1);
    assert_eq!(fault("O1\nO2").0, 2);
    assert_eq!(fault("O1 G0 X1").0, 1);
    assert_eq!(fault("O<loop> sub").1, 1);
    assert_eq!(moves("G41 D1\nG17 G0 X1").len(), 1);
}

#[test]
fn a_reading_without_lengths_is_refused() {
    let new = |reading| Program::new("".as_bytes(), reading).err();
    for blu in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(new(Reading { blu, ..reading() }), Some(ReadingError::Blu { blu }));
    }
    let tools = BTreeMap::from([(3, -0.5)]);
    let error = new(Reading { tools, ..reading() }).unwrap();
    assert_eq!(
        error.to_string(),
        "tool 3 has a radius of -0.5 mm, but at least 0 is needed: give the other side by G41 or G42"
    );
    assert_eq!(
        new(Reading { blu: -0.5, ..reading() }).unwrap().to_string(),
        "invalid BLU of -0.5 mm: give more than 0, such as 0.001"
    );
}
