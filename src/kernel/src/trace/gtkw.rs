//! The GTKWave save file and its state-name files, written beside every wave.
//!
//! A trace line must be GTKWave's own name of the signal, or the row vanishes without a message: vectors of type `reg`
//! and `wire` carry their range, `integer` and `parameter` do not.
//!
//! File names are written as if all files stood in `/`, the save file too: GTKWave then takes the way from the one to
//! the other, so that `gtkwave ANY/FOLDER/x.gtkw` finds the wave and the state names beside the save file from any
//! working folder. (Plain relative names are taken from the working folder.)
//!
//! The data path comes first, one group a scope; then the flags of the properties; last the scopes that hold inputs,
//! which are the test bench's side of the machine.

use std::fmt::Write as _;

use super::probe::{Probe, Role};
use super::timescale::ClockTime;
use super::vcd::has_range;
use crate::bits::{Bits, Width};
use crate::netlist::Format;

/// Flags of a row, as GTKWave writes them.
mod flag {
    pub(super) const HEXADECIMAL: &str = "@22";
    pub(super) const BINARY: &str = "@28";
    pub(super) const UNSIGNED: &str = "@24";
    pub(super) const SIGNED: &str = "@420";
    pub(super) const SIGNED_ANALOG: &str = "@88420";
    pub(super) const TRANSLATED: &str = "@2028";
    pub(super) const GROUP_OPEN: &str = "@800200";
    pub(super) const GROUP_CLOSE: &str = "@1000200";
    /// One more row of height for the analog trace above.
    pub(super) const HEIGHT: &str = "@20200";
    /// Colour of the next row.
    pub(super) const RED: &str = "[color] 1";
}

/// Extra rows that an analog trace gets.
const ANALOG_ROWS: usize = 4;
/// Pixels that a whole run is fitted into.
const FITTED_PIXELS: u64 = 1000;
/// Pixels that show 2^-zoom units of time.
const ZOOM_PIXELS: u64 = 200;

/// What a save file shows.
#[derive(Clone, Debug)]
pub struct View<'a> {
    /// File name of the wave, without folder: the viewer looks beside the save file.
    pub dump_name: &'a str,
    /// File name without extension, for the state-name files.
    pub stem: &'a str,
    /// Rows, in order, grouped by scope.
    pub probes: &'a [Probe],
    /// The wave holds the clock as `clk` in the top scope.
    pub clk: bool,
    /// Time of a clock.
    pub time: ClockTime,
    /// Clock of the last sample.
    pub last_clock: u64,
    /// Clocks to mark, at most 26, each with a label.
    pub marks: &'a [(u64, String)],
}

/// A file to be written beside the wave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SideFile {
    /// File name without folder.
    pub name: String,
    /// Content.
    pub text: String,
}

/// The save file `STEM.gtkw`, then the state-name files that it refers to.
#[must_use]
pub fn side_files(view: &View<'_>) -> Vec<SideFile> {
    let mut states: Vec<(&[(u64, String)], SideFile)> = Vec::new();
    for probe in view.probes {
        if let Format::States(names) = &probe.format
            && !states.iter().any(|(known, _)| *known == names.as_slice())
        {
            let name = format!("{}.{}.states", view.stem, probe.name);
            states.push((names, SideFile { name, text: state_names(probe.width, names) }));
        }
    }
    let text = save_file(view, &states);
    let mut files = vec![SideFile { name: format!("{}.gtkw", view.stem), text }];
    files.extend(states.into_iter().map(|(_, file)| file));
    files
}

/// One line a state: the bits as GTKWave shows them in binary, and the name.
fn state_names(width: Width, names: &[(u64, String)]) -> String {
    names.iter().map(|(value, name)| format!("{} {name}\n", Bits::truncated(width, *value))).collect()
}

fn save_file(view: &View<'_>, states: &[(&[(u64, String)], SideFile)]) -> String {
    let mut text = String::new();
    let mut line = |content: &str| {
        text.push_str(content);
        text.push('\n');
    };
    line(&format!("[dumpfile] \"/{}\"", view.dump_name));
    line(&format!("[savefile] \"/{}.gtkw\"", view.stem));
    line("[timestart] 0");
    line("[size] 1280 900");
    line("[pos] -1 -1");
    line(&zoom_and_markers(view));
    for (letter, (_, label)) in ('A'..='Z').zip(view.marks) {
        line(&format!("[markername] {letter}{label}"));
    }
    let top = view.probes.first().map_or("top", |probe| probe.scopes[0].as_str());
    line(&format!("[treeopen] {top}."));
    line("[sst_expanded] 0");
    if view.clk {
        line(flag::BINARY);
        line(&format!("{top}.clk"));
    }
    for (title, probes) in groups(view.probes) {
        if let Some(title) = &title {
            line(flag::GROUP_OPEN);
            line(&format!("-{title}"));
        }
        for probe in probes {
            row(&mut line, probe, states);
        }
        if let Some(title) = &title {
            line(flag::GROUP_CLOSE);
            line(&format!("-{title}"));
        }
    }
    text
}

/// Rows with the title of their group, in the order in which they are shown; the top scope has no title.
fn groups(probes: &[Probe]) -> Vec<(Option<String>, Vec<&Probe>)> {
    let title = |probe: &Probe| (probe.scopes.len() > 1).then(|| probe.scopes[1..].join(" "));
    let mut flags = Vec::new();
    let mut groups: Vec<(Option<String>, Vec<&Probe>)> = Vec::new();
    for probe in probes {
        if probe.role == Role::Flag {
            flags.push(probe);
            continue;
        }
        let title = title(probe);
        match groups.iter_mut().find(|(known, _)| *known == title) {
            Some((_, rows)) => rows.push(probe),
            None => groups.push((title, vec![probe])),
        }
    }
    let inner_with_input = |(title, rows): &(Option<String>, Vec<&Probe>)| {
        title.is_some() && rows.iter().any(|probe| probe.role == Role::Input)
    };
    let (inputs, mut shown): (Vec<_>, Vec<_>) = groups.into_iter().partition(inner_with_input);
    if !flags.is_empty() {
        shown.push((Some("overflow".to_owned()), flags));
    }
    shown.extend(inputs);
    shown
}

fn row(line: &mut impl FnMut(&str), probe: &Probe, states: &[(&[(u64, String)], SideFile)]) {
    let path = probe.path();
    let name = if has_range(probe) { format!("{path}[{}:0]", probe.width.get() - 1) } else { path };
    match &probe.format {
        Format::States(names) => {
            line(flag::TRANSLATED);
            if let Some((_, file)) = states.iter().find(|(known, _)| *known == names.as_slice()) {
                line(&format!("^1 /{}", file.name));
            }
            line(&name);
        }
        Format::Analog => {
            line(flag::SIGNED_ANALOG);
            line(&name);
            for _ in 0..ANALOG_ROWS {
                line(flag::HEIGHT);
                line("-");
            }
        }
        format => {
            line(match format {
                Format::Signed => flag::SIGNED,
                // A digit of 4 bits looks alike in both.
                Format::Decimal => flag::HEXADECIMAL,
                Format::Unsigned if probe.width.get() > 1 || probe.role == Role::Constant => flag::UNSIGNED,
                _ => flag::BINARY,
            });
            if probe.role == Role::Flag {
                line(flag::RED);
            }
            line(&name);
        }
    }
}

/// `*ZOOM PRIMARY A … Z`: 200 pixels show 2^-ZOOM units of time, chosen so that the whole run fits; -1 is no marker.
/// GTKWave counts in the unit of the timescale, not in its ticks: 100 ns are 100.
fn zoom_and_markers(view: &View<'_>) -> String {
    let period = view.time.ticks().saturating_mul(u64::from(view.time.magnitude()));
    let total = (view.last_clock + 1).saturating_mul(period);
    let fits = |zoom: u32| (u128::from(total) * u128::from(ZOOM_PIXELS)) >> zoom <= u128::from(FITTED_PIXELS);
    let zoom = (0..=70).find(|&zoom| fits(zoom)).unwrap_or(70);
    let at = |clock: u64| clock.saturating_mul(period);
    let mut text = format!("*-{zoom}.000000");
    let primary = view.marks.first().map(|(clock, _)| at(*clock));
    let marks = (0..26).map(|index| view.marks.get(index).map(|(clock, _)| at(*clock)));
    for time in std::iter::once(primary).chain(marks) {
        // Writing to a string cannot fail.
        let _ = match time {
            Some(time) => write!(text, " {time}"),
            None => write!(text, " -1"),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::netlist::Net;

    fn probe(scopes: &[&str], name: &str, bits: u64, format: Format, role: Role) -> Probe {
        Probe {
            scopes: scopes.iter().map(|&scope| scope.to_owned()).collect(),
            name: name.to_owned(),
            net: Net(0),
            width: Width::new(bits).unwrap(),
            format,
            role,
            column: 0,
        }
    }

    #[test]
    fn every_row_bears_the_name_that_gtkwave_gives_it() {
        let states = Format::States(vec![(1, "JUDGE".into()), (2, "FEED".into())]);
        let probes = [
            probe(&["m"], "busy", 1, Format::Unsigned, Role::Register),
            probe(&["m"], "beat", 4, states, Role::Register),
            probe(&["m", "x"], "jrx", 4, Format::Unsigned, Role::Register),
            probe(&["m", "x"], "x", 5, Format::Analog, Role::Register),
        ];
        let view = View {
            dump_name: "w.vcd",
            stem: "w",
            probes: &probes,
            clk: true,
            time: ClockTime::from_hz(1e6).unwrap(),
            last_clock: 16,
            marks: &[(3, "overflow".into())],
        };
        let files = side_files(&view);
        assert_eq!(files[1], SideFile { name: "w.beat.states".into(), text: "0001 JUDGE\n0010 FEED\n".into() });
        let nones = " -1".repeat(25);
        let expected = format!(
            "[dumpfile] \"/w.vcd\"\n[savefile] \"/w.gtkw\"\n[timestart] 0\n[size] 1280 900\n[pos] -1 -1\n*-12.000000 3000 3000{nones}\n\
             [markername] Aoverflow\n[treeopen] m.\n[sst_expanded] 0\n@28\nm.clk\n@28\nm.busy\n@2028\n^1 /w.beat.states\nm.beat[3:0]\n\
             @800200\n-x\n@24\nm.x.jrx[3:0]\n@88420\nm.x.x\n@20200\n-\n@20200\n-\n@20200\n-\n@20200\n-\n@1000200\n-x\n"
        );
        assert_eq!(files[0].text, expected);
    }
}
