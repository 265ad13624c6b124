//! `stepwave show --follow`, in a pseudo-terminal.

use std::fs::File;
use std::io::{Read, Write};
use std::process::{Child, Stdio};

use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{LocalModes, tcgetattr};

use super::Folder;

/// What the terminal has shown until a text has come.
fn until(terminal: &mut File, text: &str) -> String {
    let (mut shown, mut bytes) = (Vec::new(), [0; 4096]);
    loop {
        let read = terminal.read(&mut bytes).unwrap_or(0);
        shown.extend_from_slice(&bytes[..read]);
        let all = String::from_utf8_lossy(&shown).into_owned();
        if all.contains(text) {
            return all;
        }
        assert!(read > 0, "'{text}' is missing: {all}");
    }
}

/// `show line.vcd --follow` with these words more, in a pseudo-terminal; and the terminal as the program has it.
fn followed(folder: &Folder, words: &str) -> (Child, File, impl Fn() -> File) {
    let open = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&open).unwrap();
    unlockpt(&open).unwrap();
    let name = ptsname(&open, Vec::new()).unwrap().into_string().unwrap();
    let slave = move || File::options().read(true).write(true).open(&name).unwrap();
    let mut command = folder.command();
    command.args(["show", "line.vcd", "--follow", "--ascii", "--columns", "80"]).args(words.split_whitespace());
    command.env("NO_COLOR", "1").stdin(Stdio::from(slave())).stdout(Stdio::from(slave())).stderr(Stdio::from(slave()));
    let modes = tcgetattr(slave()).unwrap().local_modes;
    assert!(modes.contains(LocalModes::ICANON | LocalModes::ECHO));
    (command.spawn().unwrap(), File::from(open), slave)
}

#[test]
fn keys_move_the_window_and_the_terminal_is_as_before_in_the_end() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 30,20 --vcd line.vcd");
    let (mut child, mut terminal, slave) = followed(&folder, "--signals beat");
    // 200 steps of four clocks, and one before them.
    let first = until(&mut terminal, "clock 0 of 201");
    assert!(first.contains("IDLE") && first.contains("JUDGE"), "{first}");
    for (sent, place, state) in [
        ("\x1b[C", "clock 1 of 201", "|JUDGE  |FEED"),
        ("\x1b[C\x1b[C", "clock 3 of 201", "|COMPUTE"),
        ("\x1b[D", "clock 2 of 201", "|FEED"),
        ("x\x1b[H", "clock 0 of 201", "|IDLE"),
    ] {
        terminal.write_all(sent.as_bytes()).unwrap();
        let shown = until(&mut terminal, place);
        assert!(shown.contains(state), "{sent:?}: {shown}");
    }
    terminal.write_all(b"G").unwrap();
    let last = until(&mut terminal, " of 201");
    assert!(last.contains("clock 19") || last.contains("clock 18"), "{last}");
    terminal.write_all(b"q").unwrap();
    assert!(child.wait().unwrap().success());
    assert!(tcgetattr(slave()).unwrap().local_modes.contains(LocalModes::ICANON | LocalModes::ECHO));
}

#[test]
fn nothing_after_the_last_clock_that_is_asked_for_is_shown() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 30,20 --vcd line.vcd");
    let (mut child, mut terminal, _slave) = followed(&folder, "--signals beat --from 5 --to 7");
    // JUDGE, FEED and COMPUTE, of which no more fits to be shown than these three.
    for sent in ["", "\x1b[C", "G"] {
        terminal.write_all(sent.as_bytes()).unwrap();
        let shown = until(&mut terminal, " of 7");
        assert!(shown.contains("COMPUTE") && !shown.contains("COMPARE"), "{sent:?}: {shown}");
    }
    terminal.write_all(b"q").unwrap();
    assert!(child.wait().unwrap().success());
}

#[test]
fn without_a_terminal_it_is_refused() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 3,2 --vcd line.vcd");
    let ran = folder.run("show line.vcd --follow");
    assert!(ran.code == 2 && ran.err.contains("--follow takes keys from a terminal"), "{ran:?}");
    let ran = folder.run("show line.vcd --follow --svg a.svg");
    assert!(ran.code == 2 && ran.err.contains("cannot be used with"), "{ran:?}");
}
