//! The JSON report.

use num_bigint::BigInt;
use serde_json::{Map, Value, json};
use stepwave_models::CutWord;
use stepwave_models::options::{Takes, WIDTH};
use stepwave_netlist::bits::Reading;

use super::geometry::in_force;
use super::{Report, Subject};
use crate::program::CutWords;
use crate::testbench::{Ending, OverflowEvent, OverflowTally, RegisterRange};

/// Version of the report's form; a change of meaning raises it.
const SCHEMA: u32 = 1;

/// A number as JSON; one beyond 64 bits to the 53 bits that a real number holds.
fn number(value: i128) -> Value {
    if let Ok(value) = i64::try_from(value) {
        return json!(value);
    }
    u64::try_from(value).map_or_else(|_| json!(value as f64), |value| json!(value))
}

/// A number of any size as JSON: one beyond 64 bits as a text of its digits.
pub(crate) fn large(value: &BigInt) -> Value {
    match (i64::try_from(value), u64::try_from(value)) {
        (Ok(value), _) => json!(value),
        (_, Ok(value)) => json!(value),
        _ => json!(value.to_string()),
    }
}

/// The word of a choice as JSON: a number where it is one.
fn choice(name: &str, word: &str) -> Value {
    // The systems of data sampling are names.
    if name == "system" {
        return json!(word);
    }
    let whole = word.parse::<i64>().map(|number| json!(number));
    whole.or_else(|_| word.parse::<f64>().map(|number| json!(number))).unwrap_or_else(|_| json!(word))
}

pub(crate) fn event(event: &OverflowEvent) -> Value {
    match event {
        OverflowEvent::Overflow { component, width, signed, operation, left, right, clock } => {
            let (exact, needed) = event.exact().unwrap_or_default();
            let operation = operation.name();
            json!({
                "component": component,
                "clock": clock,
                "width": width.get(),
                "signed": signed,
                "operation": operation,
                "left": number(*left),
                "right": number(*right),
                "exact": number(exact),
                "needed_width": if exact < 0 && !signed { Value::Null } else { json!(needed) },
            })
        }
        OverflowEvent::Wide { component, bits, signed, operation, left, right, clock } => {
            json!({
                "component": component,
                "clock": clock,
                "width": bits,
                "signed": signed,
                "operation": operation.name(),
                "left": large(left),
                "right": large(right),
                "exact": event.exact_wide().as_ref().map(large),
                "needed_width": event.needed_wide(),
            })
        }
        OverflowEvent::Undefined { component, undefined, operand, clock } => {
            let name = undefined.name();
            match undefined.memory() {
                None => {
                    json!({ "component": component, "clock": clock, "operation": name, "left": large(operand), "right": 0 })
                }
                Some((first, words)) => json!({
                    "component": component,
                    "clock": clock,
                    "operation": name,
                    "address": large(operand),
                    "first": first,
                    "words": words,
                }),
            }
        }
        OverflowEvent::Invariant { component, clock } => json!({ "component": component, "clock": clock }),
    }
}

/// The load words that were cut, each with its line of a program.
pub(super) fn cut_words(cut: &CutWords) -> Value {
    let word = |(line, word): &(u64, CutWord)| {
        let mut fields = json!({
            "register": word.register,
            "block": word.block,
            "value": number(word.value),
            "loaded": number(word.loaded),
            "width": word.width.get(),
        });
        if *line > 0 {
            fields["line"] = json!(line);
        }
        fields
    };
    cut.first.iter().map(word).collect()
}

pub(crate) fn tally(tally: &OverflowTally) -> Value {
    json!({
        "component": tally.first.component(),
        "count": tally.count,
        "first_clock": tally.first.clock(),
        "needed_width": tally.needed,
    })
}

/// The fields of both.
pub(crate) fn joined(mut fields: Value, more: Value) -> Value {
    if let (Some(fields), Value::Object(more)) = (fields.as_object_mut(), more) {
        fields.extend(more);
    }
    fields
}

impl Report {
    /// The report as JSON: see the README for its fields. The moves of a program are not kept: [`JsonFile`](super::JsonFile)
    /// writes them one by one.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut report = joined(self.json_head(), self.json_results());
        report["failures"] = json!(self.failures());
        report
    }

    /// What is known before the run.
    pub(super) fn json_head(&self) -> Value {
        let own = match &self.subject {
            Subject::Curve(of) => of.head(self),
            Subject::Program(of) => of.head(self),
        };
        let taken = in_force(self.model, &self.hardware).filter(|takes| takes.name() != WIDTH.name);
        let choices: Map<String, Value> =
            taken.map(|takes| (takes.name().replace('-', "_"), self.json_choice(*takes))).collect();
        let widths: Map<String, Value> =
            self.hardware.widths.iter().map(|(name, width)| ((*name).to_owned(), json!(width.get()))).collect();
        let mut head = json!({ "schema": SCHEMA, "choices": choices, "widths": widths, "engine": self.engine.name() });
        if !self.events.is_empty() {
            head["events"] = self.events.iter().map(ToString::to_string).collect();
        }
        joined(head, own)
    }

    /// The value of an option; of a program yes and no are true and false.
    fn json_choice(&self, takes: &'static dyn Takes) -> Value {
        match (self.hardware.text(takes.option()).as_str(), &self.subject) {
            ("yes", Subject::Program(_)) => json!(true),
            ("no", Subject::Program(_)) => json!(false),
            (text, _) => choice(takes.name(), text),
        }
    }

    /// What the run came to, but for failures.
    pub(super) fn json_results(&self) -> Value {
        let mut overflow = json!({
            "events": self.overflows.iter().map(event).collect::<Vec<_>>(),
            "components": self.tallies.iter().map(|tally| self.json_tally(tally)).collect::<Vec<_>>(),
        });
        let own = match &self.subject {
            Subject::Curve(of) => {
                overflow["count"] = json!(self.overflow_count);
                of.results(self)
            }
            Subject::Program(of) => of.results(self),
        };
        let ending = match self.outcome.ending {
            Ending::Done => "done",
            Ending::Trapped => "trapped",
            Ending::Stalled { .. } => "stalled",
            Ending::Endless { .. } => "endless",
            Ending::Limit => "limit",
        };
        let results = json!({
            "registers": self.ranges.iter().map(|range| self.json_register(range)).collect::<Vec<_>>(),
            "clocks": self.outcome.clocks,
            "overflow": overflow,
            "ending": ending,
        });
        let mut results = joined(results, own);
        if let Some(after) = self.after_json() {
            results["after"] = after;
        }
        results
    }

    /// A component that lost something, of own hardware with the line of the program.
    fn json_tally(&self, of: &OverflowTally) -> Value {
        let mut fields = tally(of);
        if self.model.is_described() && of.line > 0 {
            fields["line"] = json!(of.line);
        }
        fields
    }

    fn json_register(&self, range: &RegisterRange) -> Value {
        let register = json!({
            "name": range.name,
            "path": range.path,
            "width": range.width.get(),
            "signed": range.reading.is_signed(),
            "least": number(range.least),
            "greatest": number(range.greatest),
            "needed_width": self.needed_bits(range),
        });
        if self.program().is_some() {
            return register;
        }
        let of_curve = json!({
            "radix": if range.reading == Reading::Decimal { 10 } else { 2 },
            "stuck_bits": range.stuck_bits(),
            "limits": range.limits.iter().copied().map(number).collect::<Vec<_>>(),
        });
        joined(register, of_curve)
    }
}
