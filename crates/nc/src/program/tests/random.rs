//! Programs by chance: nothing panics, and what is printed is read back.

use proptest::prelude::*;

use super::*;

/// A word with its number in thousandths, and how many blanks are around and in it.
#[derive(Debug, Clone)]
struct Written {
    letter: char,
    thousandths: i64,
    blanks: [usize; 3],
}

impl Written {
    fn text(&self) -> String {
        let [before, between, within] = self.blanks.map(|count| " ".repeat(count));
        let sign = if self.thousandths < 0 { "-" } else { "" };
        let size = self.thousandths.unsigned_abs();
        format!("{before}{}{between}{sign}{}{within}.{within}{:03}", self.letter, size / 1000, size % 1000)
    }
}

fn written() -> impl Strategy<Value = Written> {
    let number = -9_999_999_999_i64..=9_999_999_999;
    (prop::char::range('A', 'Z'), number, prop::array::uniform3(0..3_usize))
        .prop_map(|(letter, thousandths, blanks)| Written { letter, thousandths, blanks })
}

/// Pieces of programs, so that chance comes further than to the first character.
fn piece() -> impl Strategy<Value = String> {
    prop_oneof![
        4 => ("[GM]", prop::sample::select(vec!["0", "1", "2", "3", "4", "17", "18", "19", "20", "41", "40", "90", "91", "93", "94", "90.1"]))
            .prop_map(|(letter, code)| letter + code),
        6 => "[XYZIJKRFPDSTN]-?[0-9]{0,13}\\.?[0-9]{0,3}",
        2 => Just("\n".to_owned()),
        1 => "[ -~\n\t\r]{0,8}",
        1 => "\\PC{0,3}",
    ]
}

proptest! {
    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300), pulses: bool) {
        let integers = if pulses { Integers::Pulses } else { Integers::Units };
        check(&bytes, Reading { integers, ..reading() })?;
    }

    #[test]
    fn no_pieces_of_programs_panic(pieces in prop::collection::vec(piece(), 0..40), pulses: bool) {
        let integers = if pulses { Integers::Pulses } else { Integers::Units };
        let text = format!("G{} F1{}", pieces.len() % 4, pieces.concat());
        check(text.as_bytes(), Reading { integers, ..reading() })?;
    }

    #[test]
    fn words_are_read_back_as_they_were_written(list in prop::collection::vec(written(), 0..20)) {
        let text: String = list.iter().map(Written::text).collect();
        let mut words = Words::new(&text);
        let mut column = 1;
        for wanted in &list {
            let Ok(Some(word)) = words.next() else { panic!("{text:?} has no {wanted:?}") };
            prop_assert_eq!(word.letter, wanted.letter);
            prop_assert_eq!(word.value, wanted.thousandths as f64 / 1000.0);
            prop_assert_eq!(word.column, column + wanted.blanks[0] as u64);
            let bare = Written { blanks: [0; 3], ..wanted.clone() };
            prop_assert_eq!(word.name(), bare.text());
            column += wanted.text().len() as u64;
        }
        prop_assert!(words.next().is_ok_and(|word| word.is_none()));
    }

    #[test]
    fn moves_come_out_where_the_program_says(points in prop::collection::vec(prop::array::uniform3(-99_999..99_999_i32), 1..20)) {
        let text: String = points.iter().map(|[x, y, z]| format!("G1 F10 X{x} y{y}. Z {z}.0\n")).collect();
        let mut wanted: Vec<Point> = points.iter().map(|point| point.map(|value| f64::from(value) * 100.0)).collect();
        wanted.dedup();
        wanted.retain({
            let mut first = true;
            move |point| !std::mem::take(&mut first) || *point != [0.0; 3]
        });
        prop_assume!(!wanted.is_empty());
        prop_assert_eq!(ends(&text), wanted);
    }
}

/// Runs bytes as a program: errors name a place in the text, moves follow one another and stay within the limits.
fn check(bytes: &[u8], reading: Reading) -> Result<(), TestCaseError> {
    let lines = bytes.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
    let mut position = [0.0; 3];
    for event in Program::new(bytes, reading).unwrap() {
        match event {
            Err(ProgramError { line, column, kind }) => {
                prop_assert!((1..=lines).contains(&line));
                let text = bytes.split(|&byte| byte == b'\n').nth(usize::try_from(line).unwrap() - 1).unwrap();
                let length = String::from_utf8_lossy(text).chars().count() as u64;
                prop_assert!((1..=length + 1).contains(&column), "{column} of {length}: {kind}");
            }
            Ok(Event::Move(Move { segment, place, .. })) => {
                prop_assert!((1..=lines).contains(&place.line));
                prop_assert_eq!(segment.from, position);
                position = segment.to;
                prop_assert!(position.iter().all(|value| value.abs() <= PROGRAM_LIMIT as f64));
            }
            Ok(_) => {}
        }
    }
    Ok(())
}
