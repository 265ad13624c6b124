//! The GTKWave save file and its state-name files, written beside every wave.
//!
//! A trace line must be GTKWave's own name of the signal, or the row vanishes without a message: vectors of type `reg`
//! and `wire` carry their range, `integer` and `parameter` do not.

use std::fmt::Write as _;

use super::probe::{Probe, Role};
use super::timescale::ClockTime;
use super::vcd::has_range;
use crate::bits::{Bits, Width};
use crate::netlist::Format;

/// Flags of a row, as GTKWave writes them.
mod flag {
    pub(super) const BINARY: &str = "@28";
    pub(super) const UNSIGNED: &str = "@24";
    pub(super) const SIGNED: &str = "@420";
    pub(super) const SIGNED_ANALOG: &str = "@88420";
    pub(super) const TRANSLATED: &str = "@2028";
    pub(super) const GROUP_OPEN: &str = "@800200";
    pub(super) const GROUP_CLOSE: &str = "@1000200";
    /// One more row of height for the analog trace above.
    pub(super) const HEIGHT: &str = "@20200";
}

/// Extra rows that an analog trace gets.
const ANALOG_ROWS: usize = 4;
/// Pixels that a whole run is fitted into.
const FITTED_PIXELS: u64 = 800;

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
    line(&format!("[dumpfile] \"{}\"", view.dump_name));
    line("[timestart] 0");
    line("[size] 1280 760");
    line("[pos] -1 -1");
    line(&zoom_and_markers(view));
    for (letter, (_, label)) in ('A'..='Z').zip(view.marks) {
        line(&format!("[markername] {letter}{label}"));
    }
    let top = view.probes.first().map_or("top", |probe| probe.scopes[0].as_str());
    line(&format!("[treeopen] {top}."));
    if view.clk {
        line(flag::BINARY);
        line(&format!("{top}.clk"));
    }
    let mut group: &[String] = view.probes.first().map_or(&[], |probe| &probe.scopes[..1]);
    for probe in view.probes {
        if probe.scopes != group {
            if group.len() > 1 {
                line(flag::GROUP_CLOSE);
                line(&format!("-{}", group[1..].join(" ")));
            }
            group = &probe.scopes;
            if group.len() > 1 {
                line(flag::GROUP_OPEN);
                line(&format!("-{}", group[1..].join(" ")));
            }
        }
        let path = probe.path();
        let row = if has_range(probe) { format!("{path}[{}:0]", probe.width.get() - 1) } else { path };
        match &probe.format {
            Format::States(names) => {
                line(flag::TRANSLATED);
                if let Some((_, file)) = states.iter().find(|(known, _)| *known == names.as_slice()) {
                    line(&format!("^1 {}", file.name));
                }
                line(&row);
            }
            Format::Analog => {
                line(flag::SIGNED_ANALOG);
                line(&row);
                for _ in 0..ANALOG_ROWS {
                    line(flag::HEIGHT);
                    line("-");
                }
            }
            format => {
                line(match format {
                    Format::Signed => flag::SIGNED,
                    Format::Unsigned if probe.width.get() > 1 || probe.role == Role::Constant => flag::UNSIGNED,
                    _ => flag::BINARY,
                });
                line(&row);
            }
        }
    }
    if group.len() > 1 {
        line(flag::GROUP_CLOSE);
        line(&format!("-{}", group[1..].join(" ")));
    }
    text
}

/// `*ZOOM PRIMARY A … Z`: a pixel shows 2^-ZOOM ticks, so that the whole run fits; -1 is no marker.
fn zoom_and_markers(view: &View<'_>) -> String {
    let total = (view.last_clock + 1).saturating_mul(view.time.ticks());
    let fits = |zoom: i32| {
        // 2^zoom ticks a pixel.
        let pixels = if zoom >= 0 { total >> zoom } else { total << -zoom };
        pixels <= FITTED_PIXELS
    };
    let zoom = (-6..=60).find(|&zoom| fits(zoom)).unwrap_or(60);
    let at = |clock: u64| clock.saturating_mul(view.time.ticks());
    let mut text = format!("*{}.000000", -zoom);
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
            "[dumpfile] \"w.vcd\"\n[timestart] 0\n[size] 1280 760\n[pos] -1 -1\n*2.000000 30 30{nones}\n\
             [markername] Aoverflow\n[treeopen] m.\n@28\nm.clk\n@28\nm.busy\n@2028\n^1 w.beat.states\nm.beat[3:0]\n\
             @800200\n-x\n@24\nm.x.jrx[3:0]\n@88420\nm.x.x\n@20200\n-\n@20200\n-\n@20200\n-\n@20200\n-\n@1000200\n-x\n"
        );
        assert_eq!(files[0].text, expected);
    }
}
