//! What files and users call things never steers the terminal.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;

use super::{Folder, Ran};

fn wave(value: &str) -> String {
    format!(
        "$timescale 1 ns $end\n$scope module m\x1b[31mEVIL $end\n$var wire 1 ! clk $end\n\
         $var wire 4 \" q\x1b]0;pwn\x07 $end\n$var string 1 # s $end\n$upscope $end\n$enddefinitions $end\n\
         #0\n0!\nb0 \"\nsX #\n#5\n1!\n{value} \"\ns\u{202e}\u{9b}{value} #\n#10\n0!\n"
    )
}

fn steers(text: &str) -> bool {
    text.chars().any(|c| (c.is_control() && c != '\n') || ('\u{202a}'..='\u{202e}').contains(&c))
}

#[test]
fn names_and_values_of_a_wave_reach_the_terminal_as_escapes() {
    let folder = Folder::new();
    fs::write(folder.path("a\x1b[2J.vcd"), wave("b1")).unwrap();
    fs::write(folder.path("b\nstepwave: same.vcd"), wave("b10")).unwrap();
    let ran = folder.run_words(&["diff", "a\x1b[2J.vcd", "b\nstepwave: same.vcd"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(!steers(&ran.out) && !steers(&ran.err), "{ran:?}");
    assert!(ran.out.contains(r"signal m\x1b[31mEVIL.q\x1b]0;pwn\x07"), "{}", ran.out);
    assert_eq!(ran.err, "stepwave: a\\x1b[2J.vcd and b stepwave: same.vcd differ\n");
}

#[test]
fn words_that_are_quoted_in_an_error_reach_the_terminal_as_escapes() {
    let ran = Folder::new().run_words(&["run", "dda-line\x1b[31m\u{202e}", "--to", "1,1"]);
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains(r"dda-line\x1b[31m\u{202e}") && !steers(&ran.err), "{ran:?}");
}

#[test]
fn a_first_word_that_is_not_unicode_is_a_usage_error() {
    for words in [&[b"\xff".as_slice()] as &[&[u8]], &[b"diff\xff"], &[b"\xff\xfe", b"--help"], &[b"run", b"\xff"]] {
        let words = words.iter().map(|word| OsStr::from_bytes(word));
        let ran = Ran::new(Folder::new().command().args(words).output().expect("the program starts"));
        assert_eq!(ran.code, 2, "{ran:?}");
        assert!(ran.err.starts_with("stepwave: "), "{ran:?}");
    }
    let words = ["run".as_bytes(), b"dda-line\xff"].map(OsStr::from_bytes);
    let ran = Ran::new(Folder::new().command().args(words).output().expect("the program starts"));
    let message = "stepwave: 'dda-line\u{fffd}' is not Unicode: only names of files may be any bytes (see `stepwave run --help`)\n";
    assert_eq!((ran.code, ran.err.as_str()), (2, message));
}
