//! The report of a program: a table for people, and JSON written move by move, so that its length costs no memory.

use std::fmt::Write as _;
use std::io::{self, Write};

use serde_json::{Map, Value, json};
use stepwave_engine::EngineKind;
use stepwave_models::options::WIDTH;
use stepwave_models::{Hardware, Model, Promise};
use stepwave_nc::Side;

use super::json::{cut_word, event, number, tally};
use crate::program::{Greatest, Losses, Pace, Totals};
use crate::testbench::{
    BlockReport, Ending, Observer, ObserverError, Outcome, OverflowEvent, OverflowTally, RegisterRange,
};

/// Version of the report's form; a change of meaning raises it.
const SCHEMA: u32 = 1;
/// Most moves that a table for people shows.
pub const TABLE_MOVES: usize = 64;
/// Most load words that were cut that a table for people shows.
const SHOWN_CUTS: usize = 8;

/// What is known of a program before it runs.
#[derive(Clone, Copy, Debug)]
pub struct ProgramHead<'a> {
    /// Name of the file.
    pub file: &'a str,
    /// The model of the machine.
    pub model: &'static Model,
    /// The hardware, with every choice made.
    pub hardware: &'a Hardware,
    /// What simulates it.
    pub engine: EngineKind,
    /// Clock, BLU and rapid feed.
    pub pace: Pace,
}

/// What is known of it behind its end.
#[derive(Debug)]
pub struct ProgramTail<'a> {
    /// How it ended.
    pub outcome: &'a Outcome,
    /// The account of all moves.
    pub totals: &'a Totals,
    /// What the machine was not given as the program has it.
    pub losses: &'a Losses,
    /// What each register held.
    pub ranges: &'a [RegisterRange],
    /// The first overflows in full.
    pub overflows: &'a [OverflowEvent],
    /// The overflows of each component.
    pub tallies: &'a [OverflowTally],
}

impl ProgramHead<'_> {
    /// One line for the wave's header; of the file the name alone, so that a wave is the same wherever its program lies.
    #[must_use]
    pub fn title(&self) -> String {
        let widths = self.hardware.widths.iter().map(|(name, width)| format!("{name}={}", width.get()));
        let widths = widths.collect::<Vec<_>>().join(",");
        let file: String = self.file_name().chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect();
        format!("program {file}; method {}; width {widths}", self.model.method_name())
    }

    /// Name of the file and method, for people.
    #[must_use]
    pub fn headline(&self) -> String {
        format!("{} by {}", self.file_name(), self.model.title.to_lowercase())
    }

    fn file_name(&self) -> String {
        let name = std::path::Path::new(self.file).file_name();
        name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    }

    fn feed(&self, speed: f64) -> f64 {
        60.0 * speed * self.pace.blu_mm
    }

    fn choices(&self) -> Map<String, Value> {
        let named = self.model.options.iter().filter(|takes| takes.name() != WIDTH.name).map(|takes| {
            let value = match self.hardware.text(takes.option()).as_str() {
                "yes" => json!(true),
                "no" => json!(false),
                text => super::json::choice(takes.name(), text),
            };
            (takes.name().replace('-', "_"), value)
        });
        named.collect()
    }
}

/// Writes the report of a program as JSON.
pub struct ProgramJson<'a, W: Write> {
    head: ProgramHead<'a>,
    out: W,
    moves: u64,
}

impl<'a, W: Write> ProgramJson<'a, W> {
    /// Writes what is known before the program runs.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn new(head: ProgramHead<'a>, mut out: W) -> io::Result<ProgramJson<'a, W>> {
        let widths: Map<String, Value> =
            head.hardware.widths.iter().map(|(name, width)| ((*name).to_owned(), json!(width.get()))).collect();
        let fields = json!({
            "schema": SCHEMA,
            "program": head.file,
            "method": head.model.method_name(),
            "choices": head.choices(),
            "widths": widths,
            "engine": head.engine.name(),
            "clock_hz": head.pace.clock_hz,
            "blu_mm": head.pace.blu_mm,
        });
        writeln!(out, "{{")?;
        write_fields(&mut out, &fields)?;
        write!(out, "  \"blocks\": [")?;
        Ok(ProgramJson { head, out, moves: 0 })
    }

    /// Writes what is known behind its end.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish(mut self, tail: &ProgramTail<'_>, failures: &[String]) -> io::Result<()> {
        writeln!(self.out, "\n  ],")?;
        let (totals, losses, outcome) = (tail.totals, tail.losses, tail.outcome);
        let blu_um = self.head.pace.blu_mm * 1000.0;
        let greatest = |greatest: Greatest| {
            (greatest.line > 0)
                .then(|| json!({ "blu": greatest.value, "um": greatest.value * blu_um, "line": greatest.line }))
        };
        let registers = tail.ranges.iter().map(|range| {
            json!({
                "name": range.name,
                "path": range.path,
                "width": range.width.get(),
                "signed": range.reading.is_signed(),
                "least": number(range.least),
                "greatest": number(range.greatest),
                "needed_width": range.needed(),
            })
        });
        let fields = json!({
            "moves": totals.moves,
            "clocks": outcome.clocks,
            "seconds": outcome.clocks as f64 / self.head.pace.clock_hz,
            "idle_clocks": outcome.clocks.saturating_sub(totals.clocks),
            "steps": totals.steps,
            "pulses": { "x": totals.pulses[0], "y": totals.pulses[1], "z": totals.pulses[2] },
            "reached": outcome.reached,
            "position_counters": outcome.counters,
            "missed_end_points": totals.missed,
            "beyond_bound": totals.beyond,
            "left_out": { "moves": losses.left_out, "blu": losses.off_left_out.value, "line": losses.off_left_out.line },
            "path_error": greatest(totals.error),
            "compensated_contour_error": greatest(totals.off_compensated),
            "programmed_contour_error": greatest(totals.off_programmed),
            "limited_feeds": totals.limited,
            "registers": registers.collect::<Vec<_>>(),
            "cut_words": {
                "count": losses.cut_words,
                "words": losses.cut.iter().map(|(line, word)| {
                    let mut word = cut_word(word);
                    word["line"] = json!(line);
                    word
                }).collect::<Vec<_>>(),
            },
            "overflow": {
                "events": tail.overflows.iter().map(event).collect::<Vec<_>>(),
                "components": tail.tallies.iter().map(tally).collect::<Vec<_>>(),
            },
            "ending": match outcome.ending {
                Ending::Done => "done",
                Ending::Limit => "limit",
                _ => "trapped",
            },
        });
        write_fields(&mut self.out, &fields)?;
        writeln!(self.out, "  \"failures\": {}\n}}", json!(failures))?;
        self.out.flush()
    }
}

/// The fields of an object, a line each, with a comma behind the last.
fn write_fields(out: &mut impl Write, fields: &Value) -> io::Result<()> {
    for (name, value) in fields.as_object().into_iter().flatten() {
        writeln!(out, "  {}: {value},", json!(name))?;
    }
    Ok(())
}

impl<W: Write> Observer for ProgramJson<'_, W> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn block_ended(&mut self, report: &BlockReport) -> Result<(), ObserverError> {
        let head = &self.head;
        let clock_hz = head.pace.clock_hz;
        let block = json!({
            "line": report.of.place.line,
            "n": report.of.place.number,
            "kind": report.kind(),
            "begun": report.begun,
            "clocks": report.clocks,
            "seconds": report.clocks as f64 / clock_hz,
            "steps": report.steps,
            "pulses": { "x": report.pulses[0], "y": report.pulses[1], "z": report.pulses[2] },
            "end_point": { "wanted": report.wanted, "reached": report.reached, "exact": report.end_exact() },
            "length": report.length,
            "compensation": match report.of.side {
                Side::On => json!(null),
                Side::Left(radius) => json!({ "side": "left", "radius": radius }),
                Side::Right(radius) => json!({ "side": "right", "radius": radius }),
            },
            "path_error": { "greatest": report.error, "bound": report.promise.map(Promise::bound), "within_bound": report.within_bound() },
            "compensated_contour_error": report.off_compensated,
            "compensated_contour_bound": report.contour_bound,
            "programmed_contour_error": report.off_programmed,
            "feed": {
                "commanded_mm_per_min": report.commanded.map(|speed| head.feed(speed)),
                "reached_mm_per_min": head.feed(report.reached_feed(clock_hz)),
                "source_hz": report.source_hz,
                "limited": report.limited,
                "ripple": report.ripple.value(),
            },
        });
        let comma = if self.moves == 0 { "" } else { "," };
        self.moves += 1;
        write!(self.out, "{comma}\n    {block}")?;
        Ok(())
    }
}

impl ProgramTail<'_> {
    /// Sentences that say what is wrong with the machine; none if all is good.
    #[must_use]
    pub fn failures(&self, hardware: &Hardware) -> Vec<String> {
        let line = self.totals.line;
        match (self.outcome.ending, self.overflows.last()) {
            (Ending::Trapped, Some(event)) => vec![format!("line {line}: {event}{}", super::way_out(event, hardware))],
            (Ending::Limit, _) => {
                let clocks = self.outcome.clocks;
                let cut = if self.losses.cut_words > 0 { ", with a load word that was cut" } else { "" };
                vec![format!(
                    "line {line}: given up at clock {clocks}{cut}: give a greater --max-clocks, or leave it out"
                )]
            }
            _ => [self.totals.failures.clone(), super::wrong_counters(self.outcome, hardware)].concat(),
        }
    }
}

/// The table of a program for people, kept up to 64 moves.
pub struct ProgramTable<'a> {
    head: ProgramHead<'a>,
    rows: Vec<[String; 10]>,
    moves: usize,
}

impl<'a> ProgramTable<'a> {
    /// Without rows.
    #[must_use]
    pub fn new(head: ProgramHead<'a>) -> ProgramTable<'a> {
        ProgramTable { head, rows: Vec::new(), moves: 0 }
    }

    /// The table, or where the program is longer a sentence; and the summary.
    #[must_use]
    pub fn text(&self, tail: &ProgramTail<'_>) -> String {
        let mut text = String::new();
        if self.moves <= TABLE_MOVES {
            let heads =
                ["line", "kind", "clocks", "ms", "pulses", "end", "error", "off contour", "feed F → reached", "ripple"];
            let heads = heads.map(str::to_owned);
            let all = || std::iter::once(&heads).chain(&self.rows);
            let widths: Vec<usize> = (0..heads.len())
                .map(|column| all().map(|row| row[column].chars().count()).max().unwrap_or(0))
                .collect();
            for row in all() {
                let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:>width$}"));
                // Writing to a string cannot fail.
                let _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join("  "));
            }
        } else {
            let _ = writeln!(text, "more than {TABLE_MOVES} moves: --json FILE writes the report of each");
        }
        let (totals, losses, outcome, pace) = (tail.totals, tail.losses, tail.outcome, self.head.pace);
        let [x, y, z] = totals.pulses;
        let seconds = outcome.clocks as f64 / pace.clock_hz;
        let _ = writeln!(
            text,
            "\n{} by {}: {} moves, {} steps in {} clocks ({seconds:.3} s); pulses x {x}, y {y}, z {z}",
            self.head.file,
            self.head.model.method_name(),
            totals.moves,
            totals.steps,
            outcome.clocks,
        );
        let exact = if totals.missed == 0 {
            "every end point reached exactly".to_owned()
        } else {
            format!("{} end points missed", totals.missed)
        };
        let _ = writeln!(text, "{exact}; {} overflow(s)", tail.tallies.iter().map(|tally| tally.count).sum::<u64>());
        for (line, word) in tail.losses.cut.iter().take(SHOWN_CUTS) {
            let _ = writeln!(text, "warning: line {line}: {word}");
        }
        if losses.cut_words > SHOWN_CUTS as u64 {
            let _ = writeln!(text, "warning: {} load words did not fit; --json FILE lists more", losses.cut_words);
        }
        let um = pace.blu_mm * 1000.0;
        for (what, greatest) in [
            ("deviation from the commanded curve", totals.error),
            ("tool's centre off the compensated contour", totals.off_compensated),
            ("tool's edge off the programmed contour", totals.off_programmed),
        ] {
            if greatest.line > 0 {
                let (value, line) = (greatest.value, greatest.line);
                let _ = writeln!(text, "greatest {what}: {value:.3} BLU ({:.3} µm), line {line}", value * um);
            }
        }
        notes(&mut text, totals, losses);
        let chosen = tail.ranges.iter().filter(|range| self.head.hardware.widths.contains_key(range.name.as_str()));
        let spare = chosen.map(|range| format!("{} {}/{}", range.name, range.needed(), range.width.get()));
        let _ = writeln!(text, "bits needed/given: {}", spare.collect::<Vec<_>>().join(", "));
        text
    }
}

/// What is to be said of moves that were left out, and of feeds that were not reached.
fn notes(text: &mut String, totals: &Totals, losses: &Losses) {
    if losses.left_out > 0 {
        let (moves, Greatest { value, line }) = (losses.left_out, losses.off_left_out);
        let _ = writeln!(
            text,
            "left out: {moves} moves to which standing still is nearer than any pulse; the farthest goes {value:.3} BLU, \
             line {line}"
        );
    }
    if totals.limited > 0 {
        let _ = writeln!(
            text,
            "warning: {} moves asked the pulse source for more than a pulse every second clock, or for less than its \
             least: choose another --clock-hz, or --normalize where the method has it",
            totals.limited
        );
    }
}

impl Observer for ProgramTable<'_> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn block_ended(&mut self, report: &BlockReport) -> Result<(), ObserverError> {
        self.moves += 1;
        if self.moves > TABLE_MOVES {
            return Ok(());
        }
        let clock_hz = self.head.pace.clock_hz;
        let feed = report.commanded.map_or_else(|| "rapid".to_owned(), |speed| format!("{:.1}", self.head.feed(speed)));
        let reached = self.head.feed(report.reached_feed(clock_hz));
        let [x, y, z] = report.reached;
        let place = report.of.place;
        self.rows.push([
            place.number.map_or_else(|| place.line.to_string(), |number| format!("N{number}")),
            report.kind().to_owned(),
            report.clocks.to_string(),
            format!("{:.3}", report.clocks as f64 / clock_hz * 1000.0),
            report.pulses.map(|count| count.to_string()).join("/"),
            format!("({x}, {y}, {z}){}", if report.end_exact() { "" } else { " missed" }),
            format!("{:.3}", report.error),
            report.off_programmed.map_or_else(|| "-".to_owned(), |off| format!("{off:.3}")),
            format!("{feed} → {reached:.1}{}", if report.limited { " limited" } else { "" }),
            report.ripple.value().map_or_else(|| "-".to_owned(), |ripple| format!("{:.1} %", ripple * 100.0)),
        ]);
        Ok(())
    }
}
