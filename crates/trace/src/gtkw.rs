//! The GTKWave save file and its state-name files, written next to every wave.
//!
//! A trace line must be GTKWave's own name of the signal, or the row vanishes without a message: vectors of type `reg`
//! and `wire` carry their range, `integer` and `parameter` do not.
//!
//! File names are written as if all files were in `/`, the save file too: GTKWave then takes the path from one to
//! the other, so that `gtkwave ANY/FOLDER/x.gtkw` finds the wave and the state names next to the save file from any
//! working folder. (Plain relative names are taken from the working folder.)
//!
//! Leading rows come first, then the data path, one group a scope; then the operands of a trap and the flags of the
//! properties, closed where none rose; last the scopes that hold inputs, which are the test bench's side of the
//! machine.
//!
//! GTKWave scales every analog row by itself, from the least to the greatest value that it takes, and a save file
//! cannot say otherwise. Rows of positions therefore have heights in proportion to their ranges, so that one BLU is
//! equally high in all of them, as well as whole rows allow. At reset a position counter is 0, at clock 1 the start is
//! loaded: where that is another place, the view begins at clock 1, and rows are scaled to what is in view.

use std::fmt::Write as _;

use super::probe::{Probe, Role};
use super::timescale::ClockTime;
use super::vcd::has_range;
use stepwave_netlist::cells::Format;

/// Flags of a row, as GTKWave writes them.
mod flag {
    pub(super) const HEXADECIMAL: &str = "@22";
    pub(super) const BINARY: &str = "@28";
    pub(super) const UNSIGNED: &str = "@24";
    pub(super) const SIGNED: &str = "@420";
    pub(super) const SIGNED_ANALOG: &str = "@88420";
    /// Scaled to what is in view.
    pub(super) const SIGNED_ANALOG_IN_VIEW: &str = "@8420";
    pub(super) const UNSIGNED_ANALOG: &str = "@88024";
    pub(super) const TRANSLATED: &str = "@2028";
    pub(super) const GROUP_OPEN: &str = "@800200";
    pub(super) const GROUP_CLOSE: &str = "@1000200";
    /// The same of a group that shows its title only.
    pub(super) const SHUT_GROUP_OPEN: &str = "@c00200";
    pub(super) const SHUT_GROUP_CLOSE: &str = "@1401200";
    /// One more row of height for the analog trace above.
    pub(super) const HEIGHT: &str = "@20200";
    /// A line of text in place of a row.
    pub(super) const TEXT: &str = "@200";
    /// Colour of the next row.
    pub(super) const RED: &str = "[color] 1";
}

/// Rows that the analog trace of the greatest range may get, and those it gets where all are alike.
const ANALOG_ROWS: std::ops::RangeInclusive<u64> = 3..=8;
const USUAL_ROWS: u64 = 5;
/// Width and height of the window in pixels; wider where the names and values need it.
const WINDOW: [usize; 2] = [1280, 900];
/// Least width of the waves, in pixels.
const LEAST_PANE: usize = 700;
/// Width of a letter of names and values, in pixels, and what frames of both panes take.
const LETTER: usize = 8;
const NAME_FRAME: usize = 40;
const WINDOW_FRAME: usize = 68;
/// Pixels by which a view is too wide for its pane that does not begin where the wave does.
const SCROLLED: usize = 8;
/// Pixels that show 2^-zoom units of time.
const ZOOM_PIXELS: f64 = 200.0;

/// What a save file shows.
#[derive(Clone, Debug)]
pub struct View<'a> {
    /// File name of the wave, without folder: the viewer looks in the folder of the save file.
    pub dump_name: &'a str,
    /// File name without extension, for the state-name files.
    pub stem: &'a str,
    /// Rows, in order, grouped by scope.
    pub probes: &'a [Probe],
    /// The wave holds the clock as `clk` in the top scope.
    pub clk: bool,
    /// Paths without the design's name that the wave is without and a reader may look for: a line names them.
    pub without: &'a [String],
    /// Time of a clock.
    pub time: ClockTime,
    /// Clock of the first sample in view.
    pub first_clock: u64,
    /// Clock of the last sample.
    pub last_clock: u64,
    /// Least and greatest value of the curves, by their column.
    pub ranges: &'a [(usize, [i64; 2])],
    /// Curves are scaled to what is in view, and not to the whole wave.
    pub scaled_in_view: bool,
    /// Paths without the design's name of the rows that come first.
    pub leading: &'a [&'a str],
    /// A flag rose.
    pub flagged: bool,
    /// Clocks to mark, at most 26, each with a label.
    pub marks: &'a [(u64, String)],
}

/// A file to be written next to the wave.
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
fn state_names(width: u32, names: &[(u64, String)]) -> String {
    let mask = u64::MAX >> 64u32.saturating_sub(width);
    names.iter().map(|(value, name)| format!("{:01$b} {name}\n", value & mask, width as usize)).collect()
}

fn save_file(view: &View<'_>, states: &[(&[(u64, String)], SideFile)]) -> String {
    let mut text = String::new();
    let mut line = |content: &str| {
        text.push_str(content);
        text.push('\n');
    };
    line(&format!("[dumpfile] \"/{}\"", view.dump_name));
    line(&format!("[savefile] \"/{}.gtkw\"", view.stem));
    let signals = signals_width(view);
    let window = WINDOW[0].max(signals + LEAST_PANE);
    line(&format!("[timestart] {}", time_of(view, view.first_clock)));
    line(&format!("[size] {window} {}", WINDOW[1]));
    line("[pos] -1 -1");
    // GTKWave forgets the start of the view where it could not scroll on from there.
    let frame = if view.scaled_in_view { WINDOW_FRAME - SCROLLED } else { WINDOW_FRAME };
    line(&zoom_and_markers(view, window - signals - frame));
    for (letter, (_, label)) in ('A'..='Z').zip(view.marks) {
        line(&format!("[markername] {letter}{label}"));
    }
    let top = view.probes.first().map_or("top", |probe| probe.scopes[0].as_str());
    line(&format!("[treeopen] {top}."));
    line(&format!("[signals_width] {signals}"));
    line("[sst_expanded] 0");
    let (first, rest) = leading(view);
    for probe in first {
        row(&mut line, view, probe, states);
    }
    if view.clk {
        line(flag::BINARY);
        line(&format!("{top}.clk"));
    }
    if let Some(text) = without(view) {
        line(flag::TEXT);
        line(&format!("-{text}"));
    }
    for (title, probes) in groups(&rest) {
        let shut = !view.flagged && probes.iter().all(|probe| probe.role == Role::Flag);
        let [open, close] =
            if shut { [flag::SHUT_GROUP_OPEN, flag::SHUT_GROUP_CLOSE] } else { [flag::GROUP_OPEN, flag::GROUP_CLOSE] };
        if let Some(title) = &title {
            line(open);
            line(&format!("-{title}"));
        }
        for probe in probes {
            row(&mut line, view, probe, states);
        }
        if let Some(title) = &title {
            line(close);
            line(&format!("-{title}"));
        }
    }
    text
}

/// The line that names what the wave is without.
fn without(view: &View<'_>) -> Option<String> {
    let names: Vec<&str> = view.without.iter().filter_map(|path| path.rsplit('.').next()).collect();
    (!names.is_empty()).then(|| format!("without {}", names.join(", ")))
}

/// The rows that come first, in their order, and the others.
pub(crate) fn leading<'a>(view: &View<'a>) -> (Vec<&'a Probe>, Vec<&'a Probe>) {
    let (mut first, rest): (Vec<_>, Vec<_>) =
        view.probes.iter().partition(|probe| leading_place(view, probe).is_some());
    first.sort_by_key(|probe| leading_place(view, probe));
    (first, rest)
}

/// The place of a row among those that come first.
fn leading_place(view: &View<'_>, probe: &Probe) -> Option<usize> {
    let inner = [&probe.scopes[1..], std::slice::from_ref(&probe.name)].concat().join(".");
    view.leading.iter().position(|path| *path == inner)
}

/// Pixels that names and values take: values begin in one column, right of the longest name.
fn signals_width(view: &View<'_>) -> usize {
    // Titles of groups count too: `TITLE {`.
    let title = |probe: &Probe| probe.scopes[1..].join(" ").len() + 2;
    let name = |probe: &Probe| shown_name(&probe.name, probe).len().max(title(probe));
    let text = without(view).map_or(0, |text| text.len());
    let names = view.probes.iter().map(name).max().unwrap_or(0).max(text);
    let values = view.probes.iter().map(longest_value).max().unwrap_or(0);
    (names + 1 + values) * LETTER + NAME_FRAME
}

/// Letters of the longest value that a row can show.
fn longest_value(probe: &Probe) -> usize {
    let bits = probe.width;
    // Of n bits, at most as many digits as 2^n has; the logarithm of 2 is 0.30103.
    let digits = |bits: u32| bits as usize * 30_103 / 100_000 + 1;
    match &probe.format {
        Format::States(names) => {
            names.iter().map(|(_, name)| name.chars().count()).max().unwrap_or(0).max(bits as usize)
        }
        Format::Analog | Format::Signed => digits(bits - 1) + 1,
        Format::Decimal => bits.div_ceil(4) as usize,
        Format::Unsigned | Format::Level => digits(bits),
        Format::Binary => bits as usize,
    }
}

/// GTKWave's own name.
fn shown_name(name: &str, probe: &Probe) -> String {
    if has_range(probe) { format!("{name}[{}:0]", probe.width - 1) } else { name.to_owned() }
}

/// Rows of height of a curve: in proportion to its range, with the number for the greatest range with which all are
/// nearest to one scale.
fn analog_rows(view: &View<'_>, probe: &Probe) -> u64 {
    let ranges = view.ranges.iter().map(|(column, [least, greatest])| (*column, greatest.abs_diff(*least)));
    let ranges: Vec<(usize, u64)> = ranges.collect();
    let Some(greatest) = ranges.iter().map(|(_, range)| *range).max().filter(|range| *range > 0) else {
        return USUAL_ROWS;
    };
    // What a row is off its share, in parts of the whole, for each number of rows.
    let share = |rows: u64, range: u64| u128::from(rows) * u128::from(range);
    let rounded = |rows: u64, range: u64| {
        let share = share(rows, range) + u128::from(greatest / 2);
        u64::try_from(share / u128::from(greatest)).unwrap_or(rows).max(1)
    };
    let off = |rows: u64| {
        let of = |&(_, range): &(usize, u64)| {
            let whole = u128::from(rounded(rows, range)) * u128::from(greatest);
            whole.abs_diff(share(rows, range))
        };
        ranges.iter().filter(|(_, range)| *range > 0).map(of).max().unwrap_or(0)
    };
    let rows = ANALOG_ROWS.min_by_key(|&rows| (off(rows), rows.abs_diff(USUAL_ROWS))).unwrap_or(USUAL_ROWS);
    let own = ranges.iter().find(|(column, _)| probe.columns == [*column]);
    own.map_or(USUAL_ROWS, |(_, range)| rounded(rows, *range))
}

/// Rows with the title of their group, in the order in which they are shown; the top scope has no title.
pub(crate) fn groups<'a>(probes: &[&'a Probe]) -> Vec<(Option<String>, Vec<&'a Probe>)> {
    let title = |probe: &Probe| (probe.scopes.len() > 1).then(|| probe.scopes[1..].join(" "));
    let mut flags = Vec::new();
    let mut groups: Vec<(Option<String>, Vec<&'a Probe>)> = Vec::new();
    for &probe in probes {
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
    let inner_with_input = |(title, rows): &(Option<String>, Vec<&'a Probe>)| {
        title.is_some() && rows.iter().any(|probe| probe.role == Role::Input)
    };
    let (inputs, mut shown): (Vec<_>, Vec<_>) = groups.into_iter().partition(inner_with_input);
    if !flags.is_empty() {
        shown.push((Some("overflow".to_owned()), flags));
    }
    shown.extend(inputs);
    shown
}

fn row(line: &mut impl FnMut(&str), view: &View<'_>, probe: &Probe, states: &[(&[(u64, String)], SideFile)]) {
    let name = shown_name(&probe.path(), probe);
    match &probe.format {
        Format::States(names) => {
            line(flag::TRANSLATED);
            if let Some((_, file)) = states.iter().find(|(known, _)| *known == names.as_slice()) {
                line(&format!("^1 /{}", file.name));
            }
            line(&name);
        }
        Format::Analog => {
            line(if view.scaled_in_view { flag::SIGNED_ANALOG_IN_VIEW } else { flag::SIGNED_ANALOG });
            line(&name);
            for _ in 1..analog_rows(view, probe) {
                line(flag::HEIGHT);
                line("-");
            }
        }
        Format::Level => {
            line(flag::UNSIGNED_ANALOG);
            line(&name);
            for _ in 1..USUAL_ROWS {
                line(flag::HEIGHT);
                line("-");
            }
        }
        format => {
            line(match format {
                Format::Signed => flag::SIGNED,
                // A digit of 4 bits looks alike in both.
                Format::Decimal => flag::HEXADECIMAL,
                Format::Unsigned if probe.width > 1 || probe.role == Role::Constant => flag::UNSIGNED,
                _ => flag::BINARY,
            });
            if probe.role == Role::Flag {
                line(flag::RED);
            }
            line(&name);
        }
    }
}

/// Time of a clock. GTKWave counts in the unit of the timescale, not in its ticks: 100 ns are 100.
fn time_of(view: &View<'_>, clock: u64) -> u64 {
    let period = view.time.ticks().saturating_mul(u64::from(view.time.magnitude()));
    clock.saturating_mul(period)
}

/// `*ZOOM PRIMARY A … Z`: 200 pixels show 2^-ZOOM units of time, chosen so that the whole run fills a pane of that many
/// pixels; -1 means no marker.
// An approximation of a picture.
#[allow(clippy::cast_precision_loss)]
fn zoom_and_markers(view: &View<'_>, pixels: usize) -> String {
    let total = time_of(view, (view.last_clock + 1).saturating_sub(view.first_clock));
    let zoom = (total as f64 * ZOOM_PIXELS / pixels as f64).log2().max(0.0);
    let at = |clock: u64| time_of(view, clock);
    let mut text = format!("*{:.6}", -zoom);
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
pub(crate) mod tests {
    use super::*;

    pub(crate) fn probe(scopes: &[&str], name: &str, width: u32, format: Format, role: Role) -> Probe {
        Probe {
            scopes: scopes.iter().map(|&scope| scope.to_owned()).collect(),
            name: name.to_owned(),
            width,
            format,
            role,
            columns: vec![0],
        }
    }

    /// 17 clocks at 1 MHz of these.
    pub(crate) fn view(probes: &[Probe]) -> View<'_> {
        View {
            dump_name: "w.vcd",
            stem: "w",
            probes,
            clk: true,
            without: &[],
            time: ClockTime::from_hz(1e6).unwrap(),
            first_clock: 0,
            last_clock: 16,
            ranges: &[],
            scaled_in_view: false,
            leading: &[],
            flagged: false,
            marks: &[],
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
        let marks = [(3, "overflow".into())];
        let view = View { marks: &marks, ..view(&probes) };
        let files = side_files(&view);
        assert_eq!(files[1], SideFile { name: "w.beat.states".into(), text: "0001 JUDGE\n0010 FEED\n".into() });
        let nones = " -1".repeat(25);
        let expected = format!(
            "[dumpfile] \"/w.vcd\"\n[savefile] \"/w.gtkw\"\n[timestart] 0\n[size] 1280 900\n[pos] -1 -1\n*-11.658184 3000 3000{nones}\n\
             [markername] Aoverflow\n[treeopen] m.\n[signals_width] 160\n[sst_expanded] 0\n@28\nm.clk\n@28\nm.busy\n@2028\n^1 /w.beat.states\nm.beat[3:0]\n\
             @800200\n-x\n@24\nm.x.jrx[3:0]\n@88420\nm.x.x\n@20200\n-\n@20200\n-\n@20200\n-\n@20200\n-\n@1000200\n-x\n"
        );
        assert_eq!(files[0].text, expected);
    }
}
