//! The rules of a VCD that every reader takes, checked line by line.

use std::collections::HashSet;

use stepwave_engine::EngineKind;

use super::{TICKS, cases, record};

/// The id codes in their order: `!` to `~`, then two characters, the first of which runs fastest.
fn id_code(mut index: usize) -> String {
    let mut id = String::new();
    loop {
        id.push(char::from(b'!' + u8::try_from(index % 94).expect("less than 94")));
        if index < 94 {
            return id;
        }
        index = index / 94 - 1;
    }
}

fn is_name(word: &str) -> bool {
    let letter = |c: char| c.is_ascii_alphabetic() || c == '_';
    word.starts_with(letter) && word.chars().all(|c| letter(c) || c.is_ascii_digit())
}

/// The waves of all cases as text.
fn texts() -> Vec<(&'static str, String)> {
    let text = |vcd| String::from_utf8(vcd).expect("text");
    cases().iter().map(|case| (case.what, text(record(case, EngineKind::Word).vcd))).collect()
}

#[test]
fn declarations_stand_in_order_each_on_one_line() {
    for (what, text) in texts() {
        let (head, body) = text.split_once("\n#").unwrap();
        let words: Vec<&str> = head.lines().map(|line| line.split(' ').next().unwrap()).collect();
        assert_eq!(words[..3], ["$version", "$comment", "$timescale"], "{what}");
        assert_eq!(words.last(), Some(&"$enddefinitions"), "{what}");
        let inner = &words[3..words.len() - 1];
        assert!(inner.iter().all(|word| ["$scope", "$var", "$upscope"].contains(word)), "{what}: {inner:?}");
        assert!(
            head.lines()
                .all(|line| line.ends_with(" $end")
                    && line.matches("$end").count() - line.matches("$enddef").count() == 1)
        );
        assert!(!text.contains("$date"), "{what}");
        assert!(body.starts_with("0\n$dumpvars\n"), "{what}");
    }
}

#[test]
fn scopes_open_and_close_below_one_top_and_names_are_unique_in_their_scope() {
    for (what, text) in texts() {
        let (mut open, mut seen, mut tops) = (Vec::new(), HashSet::new(), 0);
        for line in text.lines().take_while(|line| !line.starts_with("$enddefinitions")) {
            let words: Vec<&str> = line.split(' ').collect();
            match words[0] {
                "$scope" => {
                    assert_eq!((words[1], words.len()), ("module", 4), "{what}: {line}");
                    assert!(is_name(words[2]), "{what}: {line}");
                    tops += usize::from(open.is_empty());
                    open.push(words[2]);
                    assert!(seen.insert(open.join(".")), "{what}: {line} a second time");
                }
                "$upscope" => assert!(open.pop().is_some(), "{what}"),
                "$var" => {
                    // One blank before the range, none after the name otherwise.
                    assert!(is_name(words[4]) && [6, 7].contains(&words.len()), "{what}: {line}");
                    assert!(
                        !open.is_empty() && seen.insert(format!("{}.{}", open.join("."), words[4])),
                        "{what}: {line}"
                    );
                    let width: usize = words[2].parse().unwrap();
                    let range = (words.len() == 7).then(|| words[5]);
                    let ranged = width > 1 && ["reg", "wire"].contains(&words[1]);
                    assert_eq!(range, ranged.then(|| format!("[{}:0]", width - 1)).as_deref(), "{what}: {line}");
                }
                _ => {}
            }
        }
        assert_eq!((open.len(), tops), (0, 1), "{what}");
    }
}

#[test]
fn ids_count_up_from_the_exclamation_mark_without_gaps() {
    let mut most = 0;
    for (what, text) in texts() {
        let mut next = 0;
        let mut seen = HashSet::new();
        for line in text.lines().filter(|line| line.starts_with("$var")) {
            let id = line.split(' ').nth(3).unwrap();
            if seen.insert(id.to_owned()) {
                assert_eq!(id, id_code(next), "{what}: {line}");
                next += 1;
            }
        }
        most = most.max(next);
    }
    assert!(most > 94, "{most} ids: all of one character");
}

#[test]
fn times_increase_and_the_last_one_is_alone_after_the_last_cycle() {
    for case in cases() {
        let recording = record(&case, EngineKind::Word);
        let text = String::from_utf8(recording.vcd).unwrap();
        let times: Vec<u64> =
            text.lines().filter_map(|line| line.strip_prefix('#')).map(|t| t.parse().unwrap()).collect();
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{}: {times:?}", case.what);
        let end = recording.samples * TICKS;
        assert_eq!((times[0], times.last()), (0, Some(&end)), "{}", case.what);
        assert!(
            text.ends_with(&format!("\n#{end}\n")),
            "{}: the file ends in a newline behind the last time",
            case.what
        );
    }
}

#[test]
fn the_first_edge_is_one_period_after_the_start_and_each_cycle_has_two() {
    for (what, text) in texts() {
        let (mut time, mut edges) = (0, Vec::new());
        for line in text.lines().skip_while(|line| !line.starts_with('#')) {
            match line.strip_prefix('#') {
                Some(next) => time = next.parse().unwrap(),
                None if line == "0!" || line == "1!" => edges.push((time, line)),
                None => {}
            }
        }
        // Low from the start, high at 1, 2, 3 … periods, low half a period later.
        let expected =
            (0u64..).map(|n| (n * TICKS / 2 + u64::from(n > 0) * TICKS / 2, if n % 2 == 0 { "0!" } else { "1!" }));
        assert!(edges.iter().copied().eq(expected.take(edges.len())) && edges.len() > 3, "{what}: {edges:?}");
    }
}
