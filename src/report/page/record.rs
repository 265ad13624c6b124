//! What a page keeps of a run while it lasts.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::io::ErrorKind;

use serde_json::{Value, json};
use stepwave_models::Port;
use stepwave_netlist::bits::Reading;
use stepwave_netlist::cells::Format;
use stepwave_netlist::{Net, Rows, Width};
use stepwave_trace::changes::Changes;
use stepwave_trace::probe::{Probe, Role};

use super::document::{Packed, Run};
use super::facts::Facts;
use super::track::{StepRows, Track};
use crate::Error;
use crate::report::program::{Units, move_json};
use crate::report::workpiece;
use crate::schematic::{self, DrawError, Drawing, Part};
use crate::testbench::{BlockReport, Observer, ObserverError, SpeedRow, Step, Testbench, WaveWriter};
use crate::waves::{self, Remarks, Shown, WaveOptions};

/// Symbols of a block diagram in a page, at most.
const MOST_SYMBOLS: usize = 300;

/// Looks on for a page.
pub(crate) struct RunRecord {
    writer: WaveWriter<Changes>,
    probes: Vec<Probe>,
    /// The net of each stream, but of a row of the test bench, and its width.
    nets: Vec<(Option<Net>, Width)>,
    /// The stream of each column.
    streams: HashMap<usize, usize>,
    interpolator: Option<Interpolator>,
    /// Paths without the design's name of the signals that come first.
    leading: &'static [&'static str],
    window: (u64, u64),
    limit: Limit,
    /// The block diagram, then those of the scopes that are closed in another one; or why there is none.
    diagrams: Result<Vec<Drawing>, DrawError>,
}

/// Bytes that a page may hold before they are packed, and what to do where it becomes larger.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limit {
    pub(crate) bytes: usize,
    pub(crate) remedy: &'static str,
}

/// What an interpolator has besides signals.
struct Interpolator {
    head: Value,
    track: Track,
    steps: StepRows,
    units: Units,
    /// Moves of a program that have begun, and those that have ended.
    begun: u64,
    moves: Vec<Value>,
}

impl RunRecord {
    /// Of hardware that does not interpolate.
    ///
    /// # Errors
    /// The options name no signal.
    pub(crate) fn of_design(shown: Shown<'_>, args: &WaveOptions, limit: Limit) -> Result<RunRecord, Error> {
        let outputs = schematic::outputs(shown.design.netlist());
        RunRecord::new(shown, [&[], &outputs], args, limit, None)
    }

    /// Of a machine that interpolates, with a clock in Hz, a BLU in mm, and one of rotary axes in degrees.
    ///
    /// # Errors
    /// The options name no signal.
    pub(crate) fn of_bench(
        bench: &Testbench,
        args: &WaveOptions,
        [clock_hz, blu_mm, blu_degrees]: [f64; 3],
        limit: Limit,
    ) -> Result<RunRecord, Error> {
        let machine = bench.machine();
        let table = machine.table.iter().map(|(_, port)| port);
        let ports = table.chain(&machine.positions).chain([&machine.loaded]);
        let ports: Vec<Net> = ports.map(|port| port.net).collect();
        let mut record = RunRecord::new(
            bench.into(),
            [&ports, &bench.ports()],
            args,
            limit,
            args.speed.then(|| SpeedRow::new(bench)),
        )?;
        let head = record.head(bench);
        let (track, steps) = (Track::new(bench, record.window), StepRows::default());
        let units = Units { clock_hz, blu_mm, blu_degrees };
        record.interpolator = Some(Interpolator { head, track, steps, units, begun: 0, moves: Vec::new() });
        Ok(record)
    }

    fn new(
        shown: Shown<'_>,
        [ports, outputs]: [&[Net]; 2],
        args: &WaveOptions,
        limit: Limit,
        speed: Option<SpeedRow>,
    ) -> Result<RunRecord, Error> {
        let mut probes = waves::probes(shown, args)?;
        let (design, all) = (shown.design.netlist(), shown.columns.nets());
        probes.extend(speed.iter().map(|_| SpeedRow::probe(&design.scopes[0].name, all.len())));
        let (mut nets, mut streams) = (Vec::new(), HashMap::new());
        let ports = ports.iter().map(|&net| (shown.columns.index(net), 0));
        let of_probes = probes.iter().flat_map(|probe| probe.columns.iter().map(|&column| (column, probe.width)));
        for (column, bits) in of_probes.chain(ports) {
            let net = all.get(column).copied();
            let width = net.map(|net| design.width(net)).or(Width::new(u64::from(bits)).ok());
            if let (Some(width), Entry::Vacant(free)) = (width, streams.entry(column)) {
                free.insert(nets.len());
                nets.push((net, width, column));
            }
        }
        let columns: Vec<(usize, Width)> = nets.iter().map(|&(_, width, column)| (column, width)).collect();
        let writer = WaveWriter::new(Changes::new(&columns, limit.bytes), waves::window(shown, args)?);
        let (writer, window) = (writer.with_speed(speed), (args.from, args.to.unwrap_or(u64::MAX)));
        let nets = nets.into_iter().map(|(net, width, _)| (net, width)).collect();
        let part = Part { most: Some(MOST_SYMBOLS), ..Part::default() };
        let diagrams = schematic::draw_all(design, outputs, &part);
        Ok(RunRecord { writer, probes, nets, streams, interpolator: None, leading: &[], window, limit, diagrams })
    }

    /// The same with signals that come first: their paths without the design's name.
    pub(crate) fn beginning_with(self, leading: &'static [&'static str]) -> RunRecord {
        RunRecord { leading, ..self }
    }

    /// The streams of what a step table and a path show.
    fn head(&self, bench: &Testbench) -> Value {
        let (machine, letters) = (bench.machine(), bench.hardware().letters());
        let stream = |port: &Port| self.streams.get(&bench.columns().index(port.net));
        let column = |name: &str, port: &Port| json!([name, stream(port), reading(port.reading)]);
        json!({
            "axes": letters,
            "table": machine.table.iter().map(|(name, port)| column(name, port)).collect::<Vec<_>>(),
            "counters": letters.iter().zip(&machine.positions).map(|(name, port)| column(name, port)).collect::<Vec<_>>(),
            "loaded": stream(&machine.loaded),
            "program": bench.blocks() == 0,
        })
    }

    /// The run, packed.
    ///
    /// # Errors
    /// No sample is in the window.
    pub(crate) fn finish(self, facts: &Facts) -> Result<Packed, Error> {
        let (written, recorded) = waves::finish(self.writer, facts.clocks, &Remarks::default().empty)?;
        let mut run = Run::new(&facts.headline);
        let nets = self.nets.iter().zip(&recorded.nets);
        let nets = nets.map(|(&(net, width), of)| {
            json!([net.map(Net::index), width.get(), run.stream(&of.times), run.stream(&of.values), of.order])
        });
        let nets: Vec<Value> = nets.collect();
        let mut meta = facts.json();
        meta["first"] = json!(written.clocks.0);
        meta["last"] = json!(written.clocks.1);
        meta["nets"] = json!(nets);
        match &self.diagrams {
            Ok(all) => {
                meta["diagrams"] = all.iter().map(|drawn| json!({ "scope": drawn.scope, "svg": drawn.svg })).collect();
            }
            Err(none) => meta["diagram_note"] = json!(none.to_string()),
        }
        meta["leading"] = json!(self.leading);
        meta["signals"] = self.probes.iter().map(|probe| signal(probe, &self.streams)).collect();
        if let Some(Interpolator { head, track, steps, moves, .. }) = self.interpolator {
            meta["interpolator"] = head;
            let pulses: Vec<usize> = track.pulses.iter().map(|pulses| run.stream(pulses)).collect();
            meta["path"] = json!({
                "start": track.start,
                "count": track.count,
                "clocks": run.stream(&track.clocks),
                "pulses": pulses,
            });
            let pulses: Vec<usize> = steps.pulses.iter().map(|pulses| run.stream(pulses)).collect();
            meta["steps"] = json!({
                "pulses": pulses,
                "count": steps.count,
                "clocks": run.stream(&steps.clocks),
                "numbers": run.stream(&steps.numbers),
                "blocks": run.stream(&steps.blocks),
            });
            meta["moves"] = Value::Array(moves);
        }
        Ok(run.packed(meta))
    }

    /// Ends a run whose page becomes too large.
    fn check(&self) -> Result<(), ObserverError> {
        let Some(Interpolator { track, steps, .. }) = &self.interpolator else { return Ok(()) };
        if track.bytes() + steps.bytes() > self.limit.bytes { Err(self.too_large("with its steps")) } else { Ok(()) }
    }

    fn too_large(&self, when: &str) -> ObserverError {
        let megabytes = self.limit.bytes >> 20;
        format!("the page has come to {megabytes} MB of changes {when}, and was given up: {}", self.limit.remedy).into()
    }
}

fn reading(reading: Reading) -> &'static str {
    match reading {
        Reading::Unsigned => "unsigned",
        Reading::Signed => "signed",
        Reading::Decimal => "decimal",
    }
}

/// A signal: its scopes and name, bits, reading, how it is drawn, what drives it, and its streams.
fn signal(probe: &Probe, places: &HashMap<usize, usize>) -> Value {
    let drawn = match (&probe.format, probe.role) {
        (Format::Analog | Format::Level, _) => "curve",
        (Format::Binary, _) => "binary",
        _ => "bus",
    };
    let role = match probe.role {
        Role::Register => "register",
        Role::Input => "input",
        Role::Wire => "wire",
        Role::Flag => "flag",
        Role::Constant => "constant",
    };
    let states: Vec<Value> = match &probe.format {
        Format::States(names) => names.iter().map(|(value, name)| json!([value.to_string(), name])).collect(),
        _ => Vec::new(),
    };
    let streams: Vec<Option<&usize>> = probe.columns.iter().map(|column| places.get(column)).collect();
    json!({
        "scopes": probe.scopes,
        "name": probe.name,
        "width": probe.width,
        "reading": reading(probe.format.reading()),
        "drawn": drawn,
        "role": role,
        "states": states,
        "nets": streams,
    })
}

impl Observer for RunRecord {
    fn wants_steps(&self) -> bool {
        self.interpolator.is_some()
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        if let Some(Interpolator { track, .. }) = &mut self.interpolator {
            track.samples(rows);
        }
        self.check()?;
        self.writer.samples(rows).map_err(|error| match error.downcast_ref::<std::io::Error>() {
            Some(full) if full.kind() == ErrorKind::FileTooLarge => self.too_large(&full.to_string()),
            _ => error,
        })
    }

    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        let (first, last) = self.window;
        if let Some(Interpolator { steps, begun, .. }) = &mut self.interpolator
            && (first..=last).contains(&step.clock)
        {
            steps.push(step, begun.saturating_sub(1));
        }
        Ok(())
    }

    fn block_begun(&mut self, _: &BlockReport) -> Result<(), ObserverError> {
        self.interpolator.iter_mut().for_each(|of| of.begun += 1);
        Ok(())
    }

    fn block_ended(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        if let Some(Interpolator { moves, units, .. }) = &mut self.interpolator {
            moves.push(page_move(block, *units));
        }
        Ok(())
    }
}

/// A move: what the report says of it, where its path error is greatest, and its programmed contour in x, y and z.
fn page_move(block: &BlockReport, units: Units) -> Value {
    let mut report = move_json(block, units);
    let mut field = |name: &str| report[name].take();
    let mut of_page = json!({});
    for name in ["line", "n", "kind", "begun", "clocks", "steps", "end_point", "path_error", "feed"] {
        of_page[name] = field(name);
    }
    of_page["worst_clock"] = json!(block.error_clock);
    of_page["outline"] = workpiece::outline(&block.of).into_iter().map(|point| point.map(rounded)).collect();
    of_page
}

/// A coordinate in BLU as it is drawn.
pub(super) fn rounded(coordinate: f64) -> f64 {
    (coordinate * 1e4).round() / 1e4
}
