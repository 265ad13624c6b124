//! How words may be written.

use super::*;

#[test]
fn blanks_case_and_line_ends_do_not_matter() {
    let plain = ends("N5G01X-12.5Y.25F100\nG91X+1.Y-0\n");
    assert_eq!(plain, [[-1250.0, 25.0, 0.0], [-1150.0, 25.0, 0.0]]);
    for text in [
        "n5g01x-12.5y.25f100\ng91x+1.y-0\n",
        "N 5 G 0 1 X - 1 2 . 5 Y . 2 5 F 1 0 0\r\n G 9 1\tX + 1 .\t\tY - 0",
        "\u{feff}  N5 G1 X-12.50 Y0.25 F100.0 \r\n\r\nG91.0 X00001 Y-.0\r\n",
        "/N5 G01 X-12.5 Y.25 F100\n / G91 X1",
        "%\r\n\nO1234 (PART)\nN5 (first) G01 (line, ü, ;) X-12.5 Y.25 (μ)F100;all ( of this\n;\n()\nG91X1 ( )",
    ] {
        assert_eq!(ends(text), plain, "{text}");
    }
}

#[test]
fn numbers_are_read_in_full_and_not_as_single_precision() {
    let pulses = Reading { integers: Integers::Pulses, ..reading() };
    let moves = moves_of(&run_with("G0 X16777217 Y-1099511627776 Z0000000000000000000000000000001.", pulses).unwrap());
    assert_eq!(moves[0].segment.to, [16_777_217.0, -1_099_511_627_776.0, 100.0]);
}

#[test]
fn columns_are_counted_in_characters() {
    let (line, column, message) = fault("G0 X1\n(äöü) Q5\n");
    assert_eq!((line, column), (2, 7));
    assert!(message.starts_with("Q5 "), "{message}");
    assert_eq!(fault("\u{feff}X1").1, 1, "a byte order mark is no character of the line");
    assert_eq!(fault("\tX 1 ").1, 2);
}

#[test]
fn a_line_of_64_kib_is_read_and_one_byte_more_is_not() {
    let line = |length: usize| format!("G0 X1{}\nG0 X2", " ".repeat(length - 5));
    assert_eq!(ends(&line(65_536)).len(), 2);
    let message = "the line is longer than 65536 bytes: break it into blocks, or check that this is an NC program";
    assert_eq!(fault(line(65_537)), (1, 1, message.into()));
    assert_eq!(fault(vec![b' '; 65_537]), (1, 1, message.into()));
}

/// A program of endless blanks and lines, which counts what was asked of it.
struct Endless {
    read: usize,
}

impl std::io::Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        buffer.fill(b' ');
        self.read += buffer.len();
        Ok(buffer.len())
    }
}

#[test]
fn an_endless_line_is_given_up_after_64_kib() {
    let text = std::io::BufReader::new(Endless { read: 0 });
    let mut program = Program::new(text, reading()).unwrap();
    assert!(matches!(program.next(), Some(Err(ProgramError { kind: ProgramErrorKind::Overlong, .. }))));
    assert!(program.text.get_ref().read < 100_000);
    assert!(program.line.capacity() < 200_000);
}
