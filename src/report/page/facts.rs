//! What a page says of a run that is over.

use serde_json::{Value, json};

use super::record::rounded;
use crate::nc::Curve;
use crate::report::{Report, Subject};
use crate::testbench::{OverflowEvent, WorstError};

/// Points of the ideal curve.
const OUTLINE_POINTS: usize = 721;
/// Bytes of a program that is shown with its moves.
const MOST_TEXT: u64 = 1 << 22;

/// What is known of a run beyond its samples.
#[derive(Debug, Default)]
pub(crate) struct Facts {
    /// What was run, for people.
    pub(crate) headline: String,
    /// One line: what was run, and the choices made.
    pub(crate) title: String,
    /// The summary, as a terminal shows it.
    pub(crate) summary: String,
    /// What is wrong with the simulated hardware.
    pub(crate) failures: Vec<String>,
    /// What a reader of widths should know.
    pub(crate) warnings: Vec<String>,
    /// Clock in Hz, and one BLU in mm where there is one.
    pub(crate) clock_hz: f64,
    /// One BLU in mm; 0 of hardware that does not interpolate.
    pub(crate) blu_mm: f64,
    /// The clock of the last sample.
    pub(crate) clocks: u64,
    /// The first overflows.
    pub(crate) events: Vec<OverflowEvent>,
    /// The greatest path error of a curve.
    pub(crate) worst: Option<WorstError>,
    /// Points of the ideal curve: two coordinates, or all of a line.
    pub(crate) outline: Vec<Vec<f64>>,
    /// Text of the program.
    pub(crate) text: Option<String>,
}

impl Facts {
    /// The ideal curve of a run along one.
    pub(crate) fn of_curve(curve: &Curve) -> Vec<Vec<f64>> {
        if let Curve::Line(line) = curve {
            // Within 2^52.
            return [line.from(), line.to()].map(|end| end.iter().map(|&place| place as f64).collect()).to_vec();
        }
        curve.outline(OUTLINE_POINTS).into_iter().map(|point| point.map(rounded).to_vec()).collect()
    }

    pub(super) fn json(&self) -> Value {
        let event = |event: &OverflowEvent| json!({ "clock": event.clock(), "component": event.component(), "text": event.to_string() });
        let worst = self
            .worst
            .as_ref()
            .map(|worst| json!({ "error": worst.error, "step": worst.step, "position": worst.position }));
        json!({
            "headline": self.headline,
            "title": self.title,
            "summary": self.summary,
            "failures": self.failures,
            "warnings": self.warnings,
            "clock_hz": self.clock_hz,
            "blu_mm": self.blu_mm,
            "clocks": self.clocks,
            "events": self.events.iter().map(event).collect::<Vec<_>>(),
            "worst": worst,
            "outline": self.outline,
            "text": self.text.as_ref().map(|text| text.lines().collect::<Vec<_>>()),
        })
    }
}

/// The text of a program, where it can be read and is not too long.
fn text_of(file: &str) -> Option<String> {
    let size = std::fs::metadata(file).ok()?.len();
    let bytes = (size <= MOST_TEXT).then(|| std::fs::read(file).ok())??;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}

impl From<&Report> for Facts {
    fn from(report: &Report) -> Facts {
        let (worst, outline, text) = match &report.subject {
            Subject::Curve(of) => (of.worst.clone(), Facts::of_curve(&of.curve), None),
            Subject::Program(of) => (None, Vec::new(), text_of(&of.file)),
        };
        Facts {
            headline: report.headline(),
            title: report.title(),
            summary: report.summary(),
            failures: report.failures(),
            warnings: report.warnings(),
            clock_hz: report.clock_hz,
            blu_mm: report.blu_mm,
            clocks: report.outcome.clocks,
            events: report.overflows.clone(),
            worst,
            outline,
            text,
        }
    }
}
