//! The waves of a run: the files asked for, and the viewer's files beside them.

use std::ffi::OsStr;
use std::path::Path;

use stepwave::kernel::trace::fst::{FstBody, FstHeader};
use stepwave::kernel::trace::gtkw::{View, side_files};
use stepwave::kernel::trace::probe::{Probe, Selection};
use stepwave::kernel::trace::timescale::ClockTime;
use stepwave::kernel::trace::vcd::{Background, VcdBody, VcdHeader};
use stepwave::kernel::{Net, did_you_mean};
use stepwave::testbench::{Observer, OverflowEvent, Testbench, Trigger, WaveBody, WaveWriter, Window};

use crate::cli::TraceArgs;
use crate::failure::Failure;
use crate::output::{self, Outputs, SeekSink, Sink};

/// Where the waves go.
pub(super) struct Sinks<'a> {
    vcd: Option<(&'a Path, Sink)>,
    fst: Option<(&'a Path, SeekSink)>,
}

impl<'a> Sinks<'a> {
    /// Opens the outputs; nothing if no wave is asked for.
    ///
    /// # Errors
    /// An output cannot be written.
    pub(super) fn open(args: &'a TraceArgs, outputs: &mut Outputs) -> Result<Option<Sinks<'a>>, Failure> {
        let vcd = args.vcd.as_deref().map(|path| Ok::<_, Failure>((path, outputs.open(path)?))).transpose()?;
        let fst = args.fst.as_deref().map(|path| Ok::<_, Failure>((path, outputs.open_seekable(path)?))).transpose()?;
        Ok((vcd.is_some() || fst.is_some()).then_some(Sinks { vcd, fst }))
    }
}

/// Waves that are being written: the same samples of the same signals.
pub(super) struct Waves<'a> {
    vcd: Option<Wave<'a, VcdBody<Background<Sink>>>>,
    fst: Option<Wave<'a, FstBody<SeekSink>>>,
    probes: Vec<Probe>,
    clk: bool,
    time: ClockTime,
}

/// One of them.
struct Wave<'a, B> {
    path: &'a Path,
    writer: WaveWriter<B>,
}

impl<'a> Waves<'a> {
    /// Writes the headers.
    ///
    /// # Errors
    /// The options name no signal, or an output cannot be written.
    pub(super) fn new(
        bench: &Testbench,
        args: &TraceArgs,
        sinks: Sinks<'a>,
        time: ClockTime,
        title: &str,
    ) -> Result<Waves<'a>, Failure> {
        let depth = args.trace_depth.map(|depth| usize::try_from(depth).unwrap_or(usize::MAX));
        let selection = Selection::new(&args.trace, &args.trace_exclude, depth)?;
        let probes = selection.probes(bench.design(), bench.columns().nets())?;
        let trigger = match &args.trace_on {
            Some(name) => Trigger::Column(flag_column(bench, name)?),
            None => Trigger::Immediately,
        };
        let window = Window { from: args.trace_from, to: args.trace_to, trigger };
        let clk = !args.no_clk;
        let vcd = match sinks.vcd {
            Some((path, sink)) => {
                let header = VcdHeader { comment: title, probes: &probes, time, clk };
                Some(Wave { path, writer: WaveWriter::new(header.write(Background::new(sink))?, window) })
            }
            None => None,
        };
        let fst = match sinks.fst {
            Some((path, sink)) => {
                let header = FstHeader { probes: &probes, time, clk };
                Some(Wave { path, writer: WaveWriter::new(header.write(sink)?, window) })
            }
            None => None,
        };
        Ok(Waves { vcd, fst, probes, clk, time })
    }

    /// What takes the samples.
    pub(super) fn observers(&mut self) -> impl Iterator<Item = &mut dyn Observer> {
        let vcd = self.vcd.iter_mut().map(|wave| &mut wave.writer as &mut dyn Observer);
        vcd.chain(self.fst.iter_mut().map(|wave| &mut wave.writer as &mut dyn Observer))
    }

    /// Ends the waves and stages the files beside them.
    ///
    /// # Errors
    /// A wave is empty, or an output cannot be written.
    pub(super) fn finish(
        mut self,
        overflows: &[OverflowEvent],
        clocks: u64,
        outputs: &mut Outputs,
    ) -> Result<(), Failure> {
        let (vcd, fst) = (self.vcd.take(), self.fst.take());
        let vcd_stem = vcd.as_ref().and_then(|wave| wave.path.file_stem());
        // The files beside two waves of one stem would bear the same names.
        let twins = vcd_stem.is_some() && vcd_stem == fst.as_ref().and_then(|wave| wave.path.file_stem());
        if let Some(Wave { path, writer }) = vcd {
            let (written, background) = finish(writer, clocks)?;
            background.finish()?;
            self.beside(path, path.file_stem(), written, overflows, outputs)?;
        }
        if let Some(Wave { path, writer }) = fst {
            let (written, _) = finish(writer, clocks)?;
            let stem = if twins { path.file_name() } else { path.file_stem() };
            self.beside(path, stem, written, overflows, outputs)?;
        }
        Ok(())
    }

    /// Stages the files beside a wave.
    fn beside(
        &self,
        path: &Path,
        stem: Option<&OsStr>,
        (first_clock, last_clock): (u64, u64),
        overflows: &[OverflowEvent],
        outputs: &mut Outputs,
    ) -> Result<(), Failure> {
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
        let view = View {
            dump_name: &text(path.file_name()),
            stem: &text(stem),
            probes: &self.probes,
            clk: self.clk,
            time: self.time,
            last_clock,
            marks: &marks,
        };
        for file in side_files(&view) {
            outputs.write(&path.with_file_name(&file.name), &file.text)?;
        }
        Ok(())
    }
}

/// Ends a wave; tells its first and last clock.
fn finish<B: WaveBody>(writer: WaveWriter<B>, clocks: u64) -> Result<((u64, u64), B::Output), Failure> {
    let Some(written) = writer.written else {
        return Err(Failure::Trouble(format!(
            "the wave would be empty: no clock from 0 to {clocks} of this run falls into its window"
        )));
    };
    Ok((written, writer.finish()?))
}

/// Column of the 1-bit net of this name, path, or end of a path.
fn flag_column(bench: &Testbench, name: &str) -> Result<usize, Failure> {
    let refuse = |why: String| Err(Failure::Trouble(format!("--trace-on: {why}")));
    let netlist = bench.design().netlist();
    let end = format!(".{name}");
    let all = netlist.names.iter().map(|named| (netlist.path(named), named.net));
    let mut found: Vec<(String, Net)> = all.filter(|(path, _)| path == name || path.ends_with(&end)).collect();
    found.dedup_by_key(|(_, net)| *net);
    match found.as_slice() {
        [] => {
            let known = netlist.names.iter().map(|named| named.name.as_str());
            refuse(format!("there is no signal '{name}' in this netlist{}", did_you_mean(name, known)))
        }
        [(_, net)] if netlist.width(*net).get() == 1 => Ok(bench.columns().index(*net)),
        [(_, net)] => refuse(format!("{name} has {}, but a trigger is 1 bit wide", netlist.width(*net))),
        several => {
            let paths: Vec<&str> = several.iter().map(|(path, _)| path.as_str()).collect();
            refuse(format!("'{name}' is the name of several signals: give one of {}", paths.join(", ")))
        }
    }
}
