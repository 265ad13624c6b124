//! The command file for Surfer and its mappings of state names, written next to a wave where they are asked for.
//!
//! `surfer --command-file w.sucl w.vcd` shows the rows of the GTKWave save file in the same order. Seen in Surfer 0.7, and
//! looked at there: a row that is added takes the focus only where a row has it, so the first is focused by `item_focus`; a
//! format or a colour is that of the focused row; the name of a divider is one word. Names of states are formats of their
//! own, found in `.surfer/mappings` of the folder in which Surfer is started, which is therefore that of the wave. A command
//! that draws a curve does not exist: positions are numbers.

use std::fmt::Write as _;

use super::gtkw::{SideFile, View, groups, leading};
use super::probe::{Probe, Role};
use stepwave_netlist::cells::Format;

/// The folder of mappings, next to the wave.
pub const MAPPINGS: &str = ".surfer/mappings";

/// The command file `STEM.sucl`, then the mappings that it refers to, whose names begin with [`MAPPINGS`].
#[must_use]
pub fn side_files(view: &View<'_>) -> Vec<SideFile> {
    let mut states: Vec<(&Probe, String)> = Vec::new();
    for probe in view.probes {
        if matches!(probe.format, Format::States(_)) && !states.iter().any(|(known, _)| alike(known, probe)) {
            let base = format!("{}.{}", plain(view.stem), probe.name);
            let free = |name: &String| states.iter().all(|(_, known)| known != name);
            let numbered = (1..).map(|again| format!("{base}.{again}"));
            let name = std::iter::once(base.clone()).chain(numbered).find(free);
            states.push((probe, name.unwrap_or(base)));
        }
    }
    let mut files = vec![SideFile { name: format!("{}.sucl", view.stem), text: commands(view, &states) }];
    for (probe, name) in &states {
        if let Format::States(names) = &probe.format {
            files.push(SideFile { name: format!("{MAPPINGS}/{name}"), text: mapping(name, probe.width, names) });
        }
    }
    files
}

/// Of one width, with the same names of states.
fn alike(a: &Probe, b: &Probe) -> bool {
    a.width == b.width && a.format == b.format
}

/// A text as one word, without what begins a comment or ends a command: two texts never have the same. What a word cannot
/// hold is its number in hexadecimal between two `~`.
fn plain(text: &str) -> String {
    let word = |c: char| match c {
        c if c.is_alphanumeric() || "._-".contains(c) => c.to_string(),
        c => format!("~{:x}~", u32::from(c)),
    };
    text.chars().map(word).collect()
}

/// A word for a POSIX shell.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-/".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) && !word.starts_with('-') {
        return word.to_owned();
    }
    // The name of a file may begin as an option does.
    let path = if word.starts_with('-') { format!("./{word}") } else { word.to_owned() };
    format!("'{}'", path.replace('\'', "'\\''"))
}

fn mapping(name: &str, width: u32, names: &[(u64, String)]) -> String {
    let mask = u64::MAX >> 64u32.saturating_sub(width);
    let mut text = format!("Name = {name}\nBits = {width}\n");
    for (value, state) in names {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "0b{:01$b} {state}", value & mask, width as usize);
    }
    text
}

fn commands(view: &View<'_>, states: &[(&Probe, String)]) -> String {
    // A comment is one line, whatever a name holds.
    let line = |word: &str| quoted(word).replace(char::is_control, "?");
    let [own, wave] = [line(&format!("{}.sucl", view.stem)), line(view.dump_name)];
    let mut text = format!("# In the folder of this file: surfer --command-file {own} {wave}\n");
    let (first, rest) = leading(view);
    let top = view.probes.first().map_or("top", |probe| probe.scopes[0].as_str());
    let mut is_first = true;
    let mut add = |text: &mut String, path: &str, format: Option<&str>, is_flag: bool| {
        let _ = writeln!(text, "variable_add {path}");
        if std::mem::take(&mut is_first) {
            text.push_str("item_focus a\n");
        }
        if let Some(format) = format {
            let _ = writeln!(text, "item_set_format {format}");
        }
        if is_flag {
            text.push_str("item_set_color Red\n");
        }
    };
    let mut row = |text: &mut String, probe: &Probe| {
        add(text, &probe.path(), format(probe, states), probe.role == Role::Flag);
    };
    first.into_iter().for_each(|probe| row(&mut text, probe));
    if view.clk {
        let clock = Probe {
            scopes: vec![top.to_owned()],
            name: "clk".to_owned(),
            width: 1,
            format: Format::Unsigned,
            role: Role::Wire,
            columns: Vec::new(),
        };
        row(&mut text, &clock);
    }
    for (title, probes) in groups(&rest) {
        if let Some(title) = title {
            let _ = writeln!(text, "divider_add {}", title.replace(|c: char| !c.is_alphanumeric(), "_"));
        }
        probes.into_iter().for_each(|probe| row(&mut text, probe));
    }
    for (clock, label) in view.marks {
        let _ = writeln!(text, "marker_set {} {}", plain(label), clock.saturating_mul(view.time.ticks()));
    }
    text.push_str("item_unfocus\nzoom_fit\n");
    text
}

/// The name of the format of a row; none where Surfer's own is right.
fn format<'s>(probe: &Probe, states: &'s [(&Probe, String)]) -> Option<&'s str> {
    match &probe.format {
        Format::States(_) => states.iter().find(|(known, _)| alike(known, probe)).map(|(_, name)| name.as_str()),
        _ if probe.width == 1 => None,
        Format::Analog | Format::Signed => Some("Signed"),
        Format::Unsigned | Format::Level => Some("Unsigned"),
        Format::Binary => Some("Binary"),
        // A digit of 4 bits looks alike in both.
        Format::Decimal => Some("Hexadecimal"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gtkw::tests::{probe, view};

    #[test]
    fn every_row_is_added_in_the_order_of_the_save_file_with_its_format() {
        let states = Format::States(vec![(1, "JUDGE".into()), (2, "FEED".into())]);
        let probes = [
            probe(&["m"], "busy", 1, Format::Unsigned, Role::Register),
            probe(&["m"], "beat", 4, states, Role::Register),
            probe(&["m", "x", "sum"], "jrx", 4, Format::Unsigned, Role::Register),
            probe(&["m", "x", "sum"], "x", 5, Format::Analog, Role::Register),
            probe(&["m", "x", "sum"], "x_overflow", 1, Format::Unsigned, Role::Flag),
        ];
        let marks = [(3, "overflow".into())];
        let view = View {
            dump_name: "a b.vcd",
            stem: "a b",
            leading: &["x.sum.x"],
            flagged: true,
            marks: &marks,
            ..view(&probes)
        };
        let files = side_files(&view);
        let expected = "# In the folder of this file: surfer --command-file 'a b.sucl' 'a b.vcd'\n\
            variable_add m.x.sum.x\nitem_focus a\nitem_set_format Signed\nvariable_add m.clk\nvariable_add m.busy\n\
            variable_add m.beat\nitem_set_format a~20~b.beat\ndivider_add x_sum\nvariable_add m.x.sum.jrx\n\
            item_set_format Unsigned\ndivider_add overflow\nvariable_add m.x.sum.x_overflow\nitem_set_color Red\n\
            marker_set overflow 30\nitem_unfocus\nzoom_fit\n";
        assert_eq!((files[0].name.as_str(), files[0].text.as_str()), ("a b.sucl", expected));
        let text = "Name = a~20~b.beat\nBits = 4\n0b0001 JUDGE\n0b0010 FEED\n".to_owned();
        assert_eq!(files[1..], [SideFile { name: ".surfer/mappings/a~20~b.beat".into(), text }]);
    }

    #[test]
    fn names_that_differ_in_a_blank_have_mappings_of_their_own_and_every_command_is_a_line() {
        let states = || Format::States(vec![(1, "JUDGE".into())]);
        let probes = [probe(&["m"], "beat", 4, states(), Role::Register)];
        let mapping = |stem: &str| side_files(&View { stem, ..view(&probes) })[1].name.clone();
        let names = ["a b", "a_b", "a\tb", "a~20~b", "a#b", "a;b"].map(mapping);
        let different: std::collections::BTreeSet<&String> = names.iter().collect();
        assert_eq!(different.len(), names.len(), "{names:?}");
        assert!(names.iter().all(|name| !name.contains([' ', '#', ';'])), "{names:?}");
        // Others of the same name in one wave too.
        let again = |name: &str, state: &str| {
            probe(&["m", name], "beat", 4, Format::States(vec![(1, state.into())]), Role::Register)
        };
        let probes = [again("x", "A"), again("y", "B"), again("z", "C")];
        let files: Vec<String> = side_files(&view(&probes)).into_iter().skip(1).map(|file| file.name).collect();
        let stem = view(&probes).stem;
        assert_eq!(files, ["", ".1", ".2"].map(|end| format!("{MAPPINGS}/{stem}.beat{end}")));
        // An end of a line in a name begins no command, and a quotation mark ends no word.
        let odd = View { stem: "a\nvariable_add it's", dump_name: "-w.vcd", ..view(&probes) };
        let text = &side_files(&odd)[0].text;
        let first = text.lines().next().unwrap();
        assert_eq!(
            first,
            "# In the folder of this file: surfer --command-file 'a?variable_add it'\\''s.sucl' './-w.vcd'"
        );
    }
}
