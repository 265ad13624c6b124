//! The waves of a run: the files asked for, and the viewer's files next to them.

pub(crate) mod limited;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

#[cfg(feature = "cli")]
use clap::builder::StringValueParser;

use crate::netlist::cells::Format;
use crate::netlist::{Design, Net, Width};
use crate::testbench::{
    Columns, Observer, OverflowEvent, Running, SpeedRow, Taken, Testbench, Trigger, WaveWriter, Window, net_named,
};
use crate::trace::WaveBody;
use crate::trace::fst::{FstBody, FstHeader};
use crate::trace::gtkw::{View, side_files};
use crate::trace::probe::{Probe, Selection};
use crate::trace::surfer;
use crate::trace::timescale::ClockTime;
use crate::trace::vcd::{VcdBody, VcdHeader};

use self::limited::Limited;
use crate::Error;
#[cfg(feature = "cli")]
use crate::cli::{Format as FileFormat, all_registers, file_of, listed, whole};
use crate::output::{self, Outputs, SeekableSink, Sink};

/// Which waves a run writes, of which signals, over which clocks: on the command line, the options of a wave.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
#[cfg_attr(feature = "cli", command(next_help_heading = "Wave"))]
#[cfg_attr(feature = "cli", command(group(clap::ArgGroup::new("wave").multiple(true))))]
#[non_exhaustive]
pub struct WaveOptions {
    /// Write the wave as VCD, with a GTKWave save file and state-name files next to it
    #[cfg_attr(feature = "cli", arg(long, value_name = "FILE", value_parser = file_of(&[FileFormat::Vcd]), group = "wave"))]
    pub vcd: Option<PathBuf>,
    /// Write the wave as FST, with the same files next to it; next to a --vcd of the same name they take the whole
    /// name of the FST file (w.fst.gtkw beside w.gtkw)
    #[cfg_attr(feature = "cli", arg(long, value_name = "FILE", value_parser = file_of(&[FileFormat::Fst]), group = "wave"))]
    pub fst: Option<PathBuf>,
    /// Write a page that shows path, wave and step table under one cursor, for a browser
    #[cfg_attr(feature = "cli", arg(long, value_name = "FILE", value_parser = file_of(&[FileFormat::Html]), group = "wave"))]
    pub html: Option<PathBuf>,
    /// The viewer whose files are written next to the wave [default: gtkwave]
    #[cfg_attr(feature = "cli", arg(long, requires = "wave", value_name = "VIEWER"))]
    pub viewer: Option<Viewer>,
    /// Dump only names that match (leaf name or dotted path; may be repeated)
    #[cfg_attr(feature = "cli", arg(id = "trace", long = "trace", requires = "wave", value_name = "GLOB"))]
    #[cfg_attr(feature = "cli", arg(value_parser = listed(StringValueParser::new(), all_registers()), hide_possible_values = true))]
    pub signals: Vec<String>,
    /// Leave out names that match (may be repeated)
    #[cfg_attr(
        feature = "cli",
        arg(id = "trace_exclude", long = "trace-exclude", requires = "wave", value_name = "GLOB")
    )]
    #[cfg_attr(feature = "cli", arg(value_parser = listed(StringValueParser::new(), all_registers()), hide_possible_values = true))]
    pub excluded: Vec<String>,
    /// Dump at most this many levels of scopes; 1 is the top scope alone
    #[cfg_attr(feature = "cli", arg(id = "trace_depth", long = "trace-depth", requires = "wave", value_name = "N"))]
    #[cfg_attr(feature = "cli", arg(value_parser = whole::<u64>(1..)))]
    pub depth: Option<u64>,
    /// First clock of the wave
    #[cfg_attr(
        feature = "cli",
        arg(id = "trace_from", long = "trace-from", requires = "wave", value_name = "CLOCK", default_value_t = 0)
    )]
    pub from: u64,
    /// Last clock of the wave
    #[cfg_attr(feature = "cli", arg(id = "trace_to", long = "trace-to", requires = "wave", value_name = "CLOCK"))]
    pub to: Option<u64>,
    /// Begin the wave at the first clock on which this 1-bit signal is 1
    #[cfg_attr(feature = "cli", arg(id = "trace_on", long = "trace-on", requires = "wave", value_name = "SIGNAL"))]
    pub on: Option<String>,
    /// Dump the clock itself.
    #[cfg_attr(feature = "cli", arg(id = "no_clk", long = "no-clk", requires = "wave", action = clap::ArgAction::SetFalse))]
    #[cfg_attr(feature = "cli", arg(help = "Do not dump the clock (saves about 15 bytes a cycle)"))]
    pub clk: bool,
    /// Dump one sample a step, and those behind which a block is loaded, instead of every clock
    #[cfg_attr(feature = "cli", arg(id = "trace_steps", long = "trace-steps", requires = "wave"))]
    pub steps: bool,
    /// Of a program, dump also what changes at every clock: `clk`, and the phase of the pulse source
    #[cfg_attr(feature = "cli", arg(skip))]
    pub every_clock: bool,
    /// Along a curve, add a row that is not of the hardware: the speed over v_max.
    #[cfg_attr(feature = "cli", arg(skip))]
    pub speed: bool,
    /// Write a wave of more than 1 GB, or a page of more than 256 MB of changes
    #[cfg_attr(feature = "cli", arg(long, requires = "wave"))]
    pub large: bool,
    /// What is said of a wave that cannot be had.
    #[cfg_attr(feature = "cli", arg(skip))]
    pub(crate) remarks: Remarks,
}

/// What is said of a wave that cannot be had.
#[derive(Clone, Debug)]
pub(crate) struct Remarks {
    /// Of one without samples, before the reason.
    pub(crate) empty: String,
    /// Of one that is too large: what is to be done.
    pub(crate) remedies: String,
}

impl Default for Remarks {
    fn default() -> Remarks {
        Remarks { empty: "the wave would be empty".to_owned(), remedies: limited::REMEDIES.to_owned() }
    }
}

/// A program that shows waves, and is given a file of rows and formats next to each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Viewer {
    /// A save file, and files of state names
    #[default]
    Gtkwave,
    /// A command file, and mappings of state names in .surfer/mappings
    Surfer,
    /// The files of both
    Both,
}

impl Default for WaveOptions {
    fn default() -> WaveOptions {
        let (signals, excluded) = (Vec::new(), Vec::new());
        let (vcd, fst, html, viewer, depth, to, on) = (None, None, None, None, None, None, None);
        let (clk, steps, every_clock, speed, large) = (true, false, false, false, false);
        WaveOptions {
            vcd,
            fst,
            html,
            viewer,
            signals,
            excluded,
            depth,
            from: 0,
            to,
            on,
            clk,
            steps,
            every_clock,
            speed,
            large,
            remarks: Remarks::default(),
        }
    }
}

impl WaveOptions {
    /// A wave is to be written, as a file or in a page.
    #[must_use]
    pub fn wanted(&self) -> bool {
        self.vcd.is_some() || self.fst.is_some() || self.html.is_some()
    }

    /// Refuses a viewer where no wave is written into a file, next to which its files are.
    ///
    /// # Errors
    /// So it is.
    pub(crate) fn check_viewer(&self) -> Result<(), Error> {
        let mut files = self.vcd.iter().chain(&self.fst);
        if self.viewer.is_some() && files.all(|file| output::is_stream(file)) {
            return Err(Error::Invalid(
                "--viewer is about files next to a wave, and no wave is written into a file: give --vcd FILE"
                    .to_owned(),
            ));
        }
        Ok(())
    }
}

/// Where the waves go.
pub(crate) struct Sinks<'a> {
    vcd: Option<(&'a Path, Sink)>,
    fst: Option<(&'a Path, SeekableSink)>,
    viewer: Viewer,
}

impl<'a> Sinks<'a> {
    /// Opens the outputs; nothing if no wave is asked for.
    ///
    /// # Errors
    /// An output cannot be written.
    pub(crate) fn open(args: &'a WaveOptions, outputs: &mut Outputs) -> Result<Option<Sinks<'a>>, Error> {
        let vcd = args.vcd.as_deref().map(|path| Ok::<_, Error>((path, outputs.open(path)?))).transpose()?;
        let fst = args.fst.as_deref().map(|path| Ok::<_, Error>((path, outputs.open_seekable(path)?))).transpose()?;
        args.check_viewer()?;
        Ok((vcd.is_some() || fst.is_some()).then_some(Sinks { vcd, fst, viewer: args.viewer.unwrap_or_default() }))
    }
}

/// What a wave can show: a design, the columns of its samples, and the columns that mark its steps.
#[derive(Clone, Copy)]
pub(crate) struct Shown<'b> {
    pub(crate) design: &'b Design,
    pub(crate) columns: &'b Columns,
    pub(crate) steps: Option<[Net; 2]>,
    /// What is left out unless it is named, and the clock with it.
    pub(crate) running: Option<&'b Running>,
}

impl<'b> From<&'b Testbench> for Shown<'b> {
    fn from(bench: &'b Testbench) -> Shown<'b> {
        let steps = Some([bench.machine().stepped.net, bench.machine().loaded.net]);
        Shown { design: bench.design(), columns: bench.columns(), steps, running: bench.running() }
    }
}

/// Waves that are being written: the same samples of the same signals.
pub(crate) struct Waves<'a> {
    vcd: Option<Wave<'a, VcdBody<Limited<Sink>>>>,
    fst: Option<Wave<'a, FstBody<Limited<SeekableSink>>>>,
    probes: Vec<Probe>,
    clk: bool,
    time: ClockTime,
    leading: &'static [&'static str],
    without: Vec<String>,
    viewer: Viewer,
    /// What is said of an empty one.
    empty: String,
}

/// One of them.
struct Wave<'a, B> {
    path: &'a Path,
    writer: WaveWriter<B>,
}

impl<'a> Waves<'a> {
    /// Writes the headers. With `speed` that row is the last.
    ///
    /// # Errors
    /// The options name no signal, or an output cannot be written.
    pub(crate) fn new<'b>(
        shown: impl Into<Shown<'b>>,
        args: &WaveOptions,
        sinks: Sinks<'a>,
        time: ClockTime,
        title: &str,
        speed: Option<SpeedRow>,
    ) -> Result<Waves<'a>, Error> {
        let shown = shown.into();
        let mut probes = probes(shown, args)?;
        let design = &shown.design.netlist().scopes[0].name;
        probes.extend(speed.iter().map(|_| SpeedRow::probe(design, shown.columns.nets().len())));
        let window = window(shown, args)?;
        let clk = args.clk && shown.running.is_none();
        let narrow = |probe: &Probe| match probe.columns[..] {
            [column] => Some((column, Width::new(u64::from(probe.width)).ok()?)),
            _ => None,
        };
        let curves = probes.iter().filter(|probe| probe.format == Format::Analog).filter_map(narrow);
        let curves: Vec<(usize, Width)> = curves.collect();
        let without = without(shown, &probes)?;
        let mut comment = match without.join(", ") {
            none if none.is_empty() => title.to_owned(),
            names => format!("{title}; without {names}, which --every-clock shows"),
        };
        if speed.is_some() {
            comment += &format!("; {} is of the test bench: v/v_max over 32 steps in 10^-4", SpeedRow::NAME.join("."));
        }
        let vcd = match sinks.vcd {
            Some((path, sink)) => {
                let states = output::is_stream(path);
                let header = VcdHeader { comment: &comment, probes: &probes, time, clk, states };
                Some(Wave {
                    path,
                    writer: WaveWriter::new(
                        header.write(Limited::new(sink, args.large, &args.remarks.remedies))?,
                        window,
                    )
                    .looking_at(curves.clone())
                    .with_speed(speed.clone()),
                })
            }
            None => None,
        };
        let fst = match sinks.fst {
            Some((path, sink)) => {
                let header = FstHeader { probes: &probes, time, clk };
                Some(Wave {
                    path,
                    writer: WaveWriter::new(
                        header.write(Limited::new(sink, args.large, &args.remarks.remedies))?,
                        window,
                    )
                    .looking_at(curves)
                    .with_speed(speed),
                })
            }
            None => None,
        };
        let empty = args.remarks.empty.clone();
        Ok(Waves { vcd, fst, probes, clk, time, leading: &[], without, viewer: sinks.viewer, empty })
    }

    /// The same with rows that come first: their paths without the design's name.
    pub(crate) fn beginning_with(self, leading: &'static [&'static str]) -> Waves<'a> {
        Waves { leading, ..self }
    }

    /// What takes the samples.
    pub(crate) fn observers(&mut self) -> impl Iterator<Item = &mut dyn Observer> {
        let vcd = self.vcd.iter_mut().map(|wave| &mut wave.writer as &mut dyn Observer);
        vcd.chain(self.fst.iter_mut().map(|wave| &mut wave.writer as &mut dyn Observer))
    }

    /// Ends the waves and stages the files next to them.
    ///
    /// # Errors
    /// A wave is empty, or an output cannot be written.
    pub(crate) fn finish(
        mut self,
        overflows: &[OverflowEvent],
        clocks: u64,
        outputs: &mut Outputs,
    ) -> Result<(), Error> {
        let (vcd, fst) = (self.vcd.take(), self.fst.take());
        let stems = stems([vcd.as_ref().map(|wave| wave.path), fst.as_ref().map(|wave| wave.path)]);
        if let Some(Wave { path, writer }) = vcd {
            let (written, _) = finish(writer, clocks, &self.empty)?;
            self.viewer_files(path, stems[0], written, overflows, outputs)?;
        }
        if let Some(Wave { path, writer }) = fst {
            let (written, _) = finish(writer, clocks, &self.empty)?;
            self.viewer_files(path, stems[1], written, overflows, outputs)?;
        }
        Ok(())
    }

    /// Stages the files next to a wave.
    fn viewer_files(
        &self,
        path: &Path,
        stem: Option<&OsStr>,
        Written { clocks: (first_clock, last_clock), taken }: Written,
        overflows: &[OverflowEvent],
        outputs: &mut Outputs,
    ) -> Result<(), Error> {
        if output::is_stream(path) {
            return Ok(());
        }
        let text = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let marks: Vec<(u64, String)> = overflows
            .iter()
            .filter(|event| (first_clock..=last_clock).contains(&event.clock()))
            .take(1)
            .map(|event| (event.clock(), "overflow".to_owned()))
            .collect();
        // At reset a position counter is not yet where the machine is.
        let jumps = taken.iter().any(|taken| taken.reset.zip(taken.first).is_some_and(|(reset, first)| reset != first));
        let column_range = |taken: &Taken| taken.range.map(|range| (taken.column, range));
        let ranges: Vec<(usize, [i64; 2])> = taken.iter().filter_map(column_range).collect();
        let view = View {
            dump_name: &text(path.file_name()),
            stem: &text(stem),
            probes: &self.probes,
            clk: self.clk,
            without: &self.without,
            time: self.time,
            first_clock: if jumps { 1 } else { first_clock },
            last_clock,
            ranges: &ranges,
            scaled_in_view: jumps,
            leading: self.leading,
            flagged: !marks.is_empty(),
            marks: &marks,
        };
        let mut files = Vec::new();
        if self.viewer != Viewer::Surfer {
            files.extend(side_files(&view));
        }
        if self.viewer != Viewer::Gtkwave {
            files.extend(surfer::side_files(&view));
        }
        if files.iter().any(|file| file.name.starts_with(surfer::MAPPINGS)) {
            output::make_folder(&path.with_file_name(surfer::MAPPINGS))?;
        }
        files.iter().try_for_each(|file| outputs.write(&path.with_file_name(&file.name), &file.text))
    }
}

/// What the names of the files next to a VCD and an FST begin with: the name of the wave without its ending, or with it for an FST
/// next to a VCD of the same name, whose files would have the same names.
pub(crate) fn stems(waves: [Option<&Path>; 2]) -> [Option<&OsStr>; 2] {
    let [vcd, fst] = waves.map(|wave| wave.and_then(Path::file_stem));
    [vcd, if vcd.is_some() && vcd == fst { waves[1].and_then(Path::file_name) } else { fst }]
}

/// What a wave holds.
pub(crate) struct Written {
    /// First and last.
    pub(crate) clocks: (u64, u64),
    /// What its curves took.
    taken: Vec<Taken>,
}

/// Ends a wave; returns what it holds. `empty` is said where that is nothing.
///
/// # Errors
/// It is empty, or its output cannot be written.
pub(crate) fn finish<B: WaveBody>(
    mut writer: WaveWriter<B>,
    clocks: u64,
    empty: &str,
) -> Result<(Written, B::Output), Error> {
    writer.end(clocks)?;
    let Some(written) = writer.written else {
        return Err(Error::Invalid(format!("{empty}: no clock from 0 to {clocks} of this run falls into its window")));
    };
    let taken = std::mem::take(&mut writer.taken);
    Ok((Written { clocks: written, taken }, writer.finish()?))
}

/// The samples that the options choose.
///
/// # Errors
/// They name no signal.
pub(crate) fn window(shown: Shown<'_>, args: &WaveOptions) -> Result<Window, Error> {
    let trigger = match &args.on {
        Some(name) => Trigger::Column(flag_column(shown, name)?),
        None => Trigger::Immediately,
    };
    let steps = shown.steps.filter(|_| args.steps).map(|nets| nets.map(|net| shown.columns.index(net)));
    Ok(Window { from: args.from, to: args.to, trigger, steps })
}

/// The signals that the options choose.
///
/// # Errors
/// They name none.
pub(crate) fn probes<'b>(shown: impl Into<Shown<'b>>, args: &WaveOptions) -> Result<Vec<Probe>, Error> {
    let depth = args.depth.map(|depth| usize::try_from(depth).unwrap_or(usize::MAX));
    let selection = Selection::new(&args.signals, &args.excluded, depth)?;
    let shown = shown.into();
    let mut probes = selection.probes(shown.design, shown.columns.nets())?;
    let left = left_out(shown, &probes, &args.signals);
    if left.len() < probes.len() {
        probes.retain(|probe| !left.contains(&probe.path()));
    }
    Ok(probes)
}

/// Paths of those of the probes that run with the phase of the pulse source and that no pattern names in full.
fn left_out(shown: Shown<'_>, probes: &[Probe], patterns: &[String]) -> Vec<String> {
    let Some(running) = shown.running else { return Vec::new() };
    let paths = probes.iter().filter(|probe| runs(probe, shown.columns, running)).map(Probe::path);
    let names = |path: &str, pattern: &String| path == pattern || path.ends_with(&format!(".{pattern}"));
    paths.filter(|path| !patterns.iter().any(|pattern| names(path, pattern))).collect()
}

/// What a wave with these probes is without, by its inner path: the clock, and what runs with the phase of the pulse
/// source.
fn without(shown: Shown<'_>, probes: &[Probe]) -> Result<Vec<String>, Error> {
    if shown.running.is_none() {
        return Ok(Vec::new());
    }
    let all = Selection::default().probes(shown.design, shown.columns.nets())?;
    let missing =
        left_out(shown, &all, &[]).into_iter().filter(|path| probes.iter().all(|probe| probe.path() != *path));
    let inner = missing.map(|path| path.split_once('.').map_or(path.clone(), |(_, inner)| inner.to_owned()));
    Ok(std::iter::once("clk".to_owned()).chain(inner).collect())
}

/// A probe shows what runs with the phase of the pulse source.
pub(crate) fn runs(probe: &Probe, columns: &Columns, running: &Running) -> bool {
    probe.columns.iter().any(|&column| running.nets.contains(&columns.nets()[column]))
}

/// Column of the 1-bit net of this name, path, or end of a path.
fn flag_column(shown: Shown<'_>, name: &str) -> Result<usize, Error> {
    let refuse = |why: String| Error::Invalid(format!("--trace-on: {why}"));
    let netlist = shown.design.netlist();
    let named = net_named(netlist, name).map_err(|error| refuse(error.to_string()))?;
    let bits = netlist.bits(named.nets());
    if bits != 1 {
        return Err(refuse(format!("{name} has {bits} bits, but a trigger is 1 bit wide")));
    }
    Ok(shown.columns.index(named.net))
}
