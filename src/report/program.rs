//! What a report has of a program alone: the account of all moves, and each move as it ends.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};
use stepwave_models::program::{After, Pacing};
use stepwave_models::{AXES, Promise};
use stepwave_nc::{FeedAxes, Side, ToolMove};

use super::json::cut_words;
use super::speed;
use super::table::aligned;
use super::{RelativeSpeed, Report};
use crate::program::{Greatest, LeftOut, SpeedAt, Speeds, Totals};
use crate::testbench::{BlockReport, Ending, Observer, ObserverError};

/// Most moves that a table for people shows.
pub const TABLE_MOVES: usize = 64;

/// What is known of a run of a program, beyond what every [`Report`] has.
#[derive(Debug)]
#[non_exhaustive]
pub struct OfProgram {
    /// Path of the file.
    pub file: String,
    /// One BLU of a rotary axis in degrees.
    pub blu_degrees: f64,
    /// The account of all moves.
    pub totals: Totals,
    /// Moves to which standing still was nearer than any pulse.
    pub left_out: LeftOut,
}

impl OfProgram {
    /// Before its run.
    pub(crate) fn new(file: &Path, blu_degrees: f64) -> OfProgram {
        let (totals, left_out) = (Totals::default(), LeftOut::default());
        OfProgram { file: file.display().to_string(), blu_degrees, totals, left_out }
    }

    /// Of the file the name alone, so that a wave is the same wherever its program lies.
    pub(super) fn title(&self, report: &Report) -> String {
        let widths = report.hardware.widths.iter().map(|(name, width)| format!("{name}={}", width.get()));
        let widths = widths.collect::<Vec<_>>().join(",");
        let file: String = self.file_name().chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect();
        // A netlist is the same wherever it is.
        let model = report.model;
        let name = if model.is_described() { super::geometry::file_name(model.source) } else { model.method_name() };
        let after = After::of(&report.hardware);
        let after = after.map(|After { smooth, period }| format!("; ramp after; smooth {smooth}; period {period}"));
        format!("program {file}; method {name}; width {widths}{}", after.unwrap_or_default())
    }

    pub(super) fn file_name(&self) -> String {
        let name = Path::new(&self.file).file_name();
        name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    }

    /// What the JSON report says of the program before the run.
    pub(super) fn head(&self, report: &Report) -> Value {
        let mut head = json!({
            "program": self.file,
            "method": report.model.method_name(),
            "clock_hz": report.clock_hz,
            "blu_mm": report.blu_mm,
        });
        if report.hardware.axes > 3 {
            head["blu_degrees"] = json!(self.blu_degrees);
        }
        if let Some(by) = pacing(report) {
            head["feed"] = json!(by);
        }
        head
    }

    /// Results that a program alone has, for the JSON report.
    pub(super) fn results(&self, report: &Report) -> Value {
        let (totals, left_out, outcome) = (&self.totals, &self.left_out, &report.outcome);
        let blu_um = report.blu_mm * 1000.0;
        let greatest = |greatest: Greatest| {
            (greatest.line > 0)
                .then(|| json!({ "blu": greatest.value, "um": greatest.value * blu_um, "line": greatest.line }))
        };
        json!({
            "moves": totals.moves,
            "seconds": outcome.clocks as f64 / report.clock_hz,
            "idle_clocks": outcome.clocks.saturating_sub(totals.clocks),
            "steps": totals.steps,
            "pulses": of_axes(&totals.pulses),
            "reached": outcome.reached,
            "position_counters": outcome.counters,
            "missed_end_points": totals.missed,
            "beyond_bound": totals.beyond,
            "left_out": { "moves": left_out.moves, "blu": left_out.farthest.value, "line": left_out.farthest.line },
            "path_error": greatest(totals.error),
            "compensated_contour_error": greatest(totals.off_compensated),
            "programmed_contour_error": greatest(totals.off_programmed),
            "speed": speeds(totals.speeds, report.clock_hz),
            "limited_feeds": totals.limited,
            "cut_words": { "count": report.cut.count, "words": cut_words(&report.cut) },
        })
    }

    /// What the summary says first: how far it came, and how well.
    pub(super) fn summary(&self, report: &Report) -> String {
        let (totals, clocks) = (&self.totals, report.outcome.clocks);
        let pulses = AXES.iter().zip(&totals.pulses).map(|(axis, pulses)| format!("{axis} {pulses}"));
        let pulses = pulses.collect::<Vec<_>>().join(", ");
        let seconds = clocks as f64 / report.clock_hz;
        let mut text = format!(
            "{} by {}: {} moves, {} steps in {clocks} clocks ({seconds:.3} s); pulses {pulses}\n",
            self.file,
            report.model.method_name(),
            totals.moves,
            totals.steps,
        );
        let exact = if report.end_exact() && report.outcome.ending != Ending::Done {
            format!("the run was given up after {} moves", totals.moves)
        } else if report.end_exact() {
            "every end point reached exactly".to_owned()
        } else {
            format!("{} end points missed", totals.missed)
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{exact}; {} overflow(s)", report.overflow_count);
        for sentence in report.cut_sentences() {
            let _ = writeln!(text, "warning: {sentence}");
        }
        let um = report.blu_mm * 1000.0;
        for (what, Greatest { value, line }) in [
            ("deviation from the commanded curve", totals.error),
            ("tool's centre off the compensated contour", totals.off_compensated),
            ("tool's edge off the programmed contour", totals.off_programmed),
        ] {
            if line > 0 {
                let _ = writeln!(text, "greatest {what}: {value:.3} BLU ({:.3} µm), line {line}", value * um);
            }
        }
        if self.left_out.moves > 0 {
            let LeftOut { moves, farthest: Greatest { value, line } } = self.left_out;
            let _ = writeln!(
                text,
                "left out: {moves} moves to which standing still is nearer than any pulse; the farthest goes {value:.3} BLU, \
                 line {line}"
            );
        }
        if let Some(sentence) = self.limited(report) {
            let _ = writeln!(text, "warning: {sentence}");
        }
        for sentence in report.announced() {
            let _ = writeln!(text, "warning: {sentence}");
        }
        if let (Some(least), Some(greatest)) = (totals.speeds.least, totals.speeds.greatest) {
            let words = |at: SpeedAt| format!("{:.4} (line {}, step {})", at.over(report.clock_hz), at.line, at.step);
            let (least, greatest) = (words(least), words(greatest));
            let mean = totals.speeds.mean(report.clock_hz).map(|mean| format!(", mean {mean:.4}")).unwrap_or_default();
            let _ = writeln!(text, "speed over v_max: {least} to {greatest}{mean}");
        }
        if let Some(by) = pacing(report) {
            let _ = writeln!(text, "feed: {by}");
        }
        text
    }

    /// A sentence about feeds that were not reached.
    pub(super) fn limited(&self, report: &Report) -> Option<String> {
        (self.totals.limited > 0).then(|| {
            if report.model.is_described() {
                return format!(
                    "{} moves are commanded to go more than a BLU a clock, or less than 2^-33: `rate` was at an end of its \
                     range, choose another --clock-hz or --blu",
                    self.totals.limited
                );
            }
            format!(
                "{} moves asked the pulse source for more than a pulse every second clock, or for less than its least: \
                 choose another --clock-hz, or --normalize where the method has it",
                self.totals.limited
            )
        })
    }
}

/// Speeds of a program over v_max; null where the hardware sets its own feed.
fn speeds(of: Speeds, clock_hz: f64) -> Value {
    let at = |at: SpeedAt| json!({ "value": at.over(clock_hz), "line": at.line, "step": at.step });
    json!({ "least": of.least.map(at), "mean": of.mean(clock_hz), "greatest": of.greatest.map(at) })
}

/// What sets the feed of own hardware, in words; `None` where our pulse source does.
fn pacing(report: &Report) -> Option<&'static str> {
    match report.model.moves().ok()?.pacing() {
        Pacing::Hardware { reads_speed: true } => Some("the hardware sets it, by the commanded speed in `rate`"),
        Pacing::Hardware { reads_speed: false } => Some("the hardware sets its own; F is reported as commanded"),
        Pacing::Feed | Pacing::Time => None,
    }
}

pub(super) fn of_axes(pulses: &[u64]) -> Value {
    AXES.iter().zip(pulses).map(|(axis, pulses)| ((*axis).to_owned(), json!(pulses))).collect()
}

/// The units of a move: clock in Hz, one BLU in mm, and of a rotary axis in degrees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    pub(super) clock_hz: f64,
    pub(super) blu_mm: f64,
    pub(super) blu_degrees: f64,
}

impl Units {
    /// Those of a run; without rotary axes, where it runs no program.
    pub(super) fn of(report: &Report) -> Units {
        let blu_degrees = report.program().map_or(0.0, |program| program.blu_degrees);
        Units { clock_hz: report.clock_hz, blu_mm: report.blu_mm, blu_degrees }
    }

    /// mm/min of a speed in BLU per second, or degrees a minute where rotary axes move alone.
    fn feed(self, of: &ToolMove, speed: f64) -> f64 {
        60.0 * speed * if of.feed_axes() == FeedAxes::Rotary { self.blu_degrees } else { self.blu_mm }
    }
}

/// A move in the JSON report.
pub(super) fn move_json(block: &BlockReport, units: Units) -> Value {
    let clock_hz = units.clock_hz;
    let mut report = json!({
        "line": block.of.place.line,
        "n": block.of.place.number,
        "kind": block.kind(),
        "begun": block.begun,
        "clocks": block.clocks,
        "seconds": block.clocks as f64 / clock_hz,
        "steps": block.steps,
        "pulses": of_axes(&block.pulses),
        "end_point": { "wanted": block.wanted, "reached": block.reached, "exact": block.end_exact() },
        "length": block.length,
        "compensation": match block.of.side {
            Side::On => json!(null),
            Side::Left(radius) => json!({ "side": "left", "radius": radius }),
            Side::Right(radius) => json!({ "side": "right", "radius": radius }),
        },
        "path_error": { "greatest": block.error, "bound": block.promise.map(Promise::bound), "within_bound": block.within_bound() },
        "compensated_contour_error": block.off_compensated,
        "compensated_contour_bound": block.contour_bound,
        "programmed_contour_error": block.off_programmed,
        "feed": {
            "source_hz": block.source_hz,
            "limited": block.limited,
            "ripple": move_ripple(block),
        },
    });
    let unit = if block.of.feed_axes() == FeedAxes::Rotary { "degrees_per_min" } else { "mm_per_min" };
    for (what, speed) in [("commanded", block.commanded), ("reached", block.reached_feed(clock_hz))] {
        report["feed"][format!("{what}_{unit}")] = json!(speed.map(|speed| units.feed(&block.of, speed)));
    }
    speed::put(relative_speed(block, clock_hz), &mut report["feed"]);
    report
}

/// How unevenly a move went.
fn move_ripple(block: &BlockReport) -> Option<f64> {
    block.speed()?.ripple(block.end_exact().then_some(block.length))
}

/// Speed of a move over v_max: one BLU in each pulse of the pulse source; `None` where the hardware sets its own feed.
fn relative_speed(block: &BlockReport, clock_hz: f64) -> Option<RelativeSpeed> {
    let length = block.end_exact().then_some(block.length);
    Some(RelativeSpeed::new(&block.speed()?, clock_hz / block.source_hz?, length))
}

/// The table of a program for people, kept up to 64 moves.
pub struct MoveTable {
    units: Units,
    /// The heading, and a row a move.
    rows: Vec<Vec<String>>,
    moves: usize,
}

impl MoveTable {
    /// Without rows; for a clock in Hz, a BLU in mm, and one of rotary axes in degrees.
    #[must_use]
    pub fn new(clock_hz: f64, blu_mm: f64, blu_degrees: f64) -> MoveTable {
        let heads =
            ["line", "kind", "clocks", "ms", "pulses", "end", "error", "off contour", "feed F → reached", "ripple"];
        MoveTable {
            units: Units { clock_hz, blu_mm, blu_degrees },
            rows: vec![heads.map(str::to_owned).to_vec()],
            moves: 0,
        }
    }

    /// The table, or `None` if there were more than [`TABLE_MOVES`] moves.
    #[must_use]
    pub fn render(&self) -> Option<String> {
        (self.moves <= TABLE_MOVES).then(|| aligned(&self.rows).concat())
    }
}

impl Observer for MoveTable {
    fn wants_steps(&self) -> bool {
        false
    }

    fn block_ended(&mut self, report: &BlockReport) -> Result<(), ObserverError> {
        self.moves += 1;
        if self.moves > TABLE_MOVES {
            return Ok(());
        }
        let (units, clock_hz) = (self.units, self.units.clock_hz);
        let feed = report
            .commanded
            .map_or_else(|| "rapid".to_owned(), |speed| format!("{:.1}", units.feed(&report.of, speed)));
        let reached = report
            .reached_feed(clock_hz)
            .map_or_else(|| "-".to_owned(), |speed| format!("{:.1}", units.feed(&report.of, speed)));
        let numbers = |of: &mut dyn Iterator<Item = String>, between| of.collect::<Vec<_>>().join(between);
        let place = report.of.place;
        self.rows.push(vec![
            place.number.map_or_else(|| place.line.to_string(), |number| format!("N{number}")),
            report.kind().to_owned(),
            report.clocks.to_string(),
            format!("{:.3}", report.clocks as f64 / clock_hz * 1000.0),
            numbers(&mut report.pulses.iter().map(u64::to_string), "/"),
            format!(
                "({}){}",
                numbers(&mut report.reached.iter().map(i64::to_string), ", "),
                if report.end_exact() { "" } else { " missed" }
            ),
            format!("{:.3}", report.error),
            report.off_programmed.map_or_else(|| "-".to_owned(), |off| format!("{off:.3}")),
            format!("{feed} → {reached}{}", if report.limited { " limited" } else { "" }),
            // Up to 32 steps are one window, which says nothing of it.
            move_ripple(report)
                .filter(|_| report.steps > 32)
                .map_or_else(|| "-".to_owned(), |ripple| format!("{:.1} %", ripple * 100.0)),
        ]);
        Ok(())
    }
}
