//! Which columns a sweep has, what a run puts into them, and the words that repeat the run.

use stepwave_models::{AXES, Model};
use stepwave_nc::{Description, Drawn};

use super::space::Space;
use super::table::{Column, ColumnType, Row, Value};
use super::{StudyError, Variants, free_curves};
use crate::testbench::{Ending, Measured, is_ended};

/// The columns of a sweep.
pub(super) struct Layout {
    pub(super) columns: Vec<Column>,
    drawn: Drawn,
    axes: usize,
    /// Most points of a free curve.
    points: usize,
    /// With the extremes of the speed and its ripple.
    pub(super) ripple: bool,
}

/// The columns of the extremes of the speed and its ripple; they come after that of the mean.
pub const RIPPLE: [&str; 3] = ["v_least", "v_greatest", "ripple"];

/// What the end of a run is called in a row.
fn word(ending: Option<Ending>) -> &'static str {
    match ending {
        Some(Ending::Done) => "done",
        Some(Ending::Trapped) => "trapped",
        Some(Ending::Stalled { .. }) => "stalled",
        Some(Ending::Endless { .. }) => "endless",
        Some(Ending::Limit) | None => "limit",
    }
}

impl Layout {
    /// # Errors
    /// There are no geometries.
    pub(super) fn new(model: &Model, space: &Space, variants: &Variants) -> Result<Layout, StudyError> {
        let none = || StudyError::Geometries("there are no geometries: give a grid or a file that has some".to_owned());
        let (drawn, axes) = space.drawn().ok_or_else(none)?;
        if axes > model.curve().max_axes() || axes < drawn.axes().min(model.curve().max_axes()) {
            let takes = model.curve().describe();
            let message = format!("{} interpolates {takes}; points of {axes} axes were given", model.name);
            return Err(StudyError::Geometries(message));
        }
        let mut columns = Vec::new();
        let mut add = |name: &str, kind| columns.push(Column { name: name.to_owned(), kind });
        let letters = &AXES[..axes];
        add("index", ColumnType::Whole);
        let points = space.points();
        if drawn.is_spline() {
            free_curves::columns(drawn, points, &mut add);
        }
        if drawn.sizes() > 0 {
            add("curve", ColumnType::Word);
            add("size_a", ColumnType::Whole);
            add("size_b", ColumnType::Whole);
            add("opens", ColumnType::Word);
        }
        for point in ["from", "to"] {
            letters.iter().for_each(|axis| add(&format!("{point}_{axis}"), ColumnType::Whole));
        }
        if drawn.is_centered() {
            add("center_x", ColumnType::Whole);
            add("center_y", ColumnType::Whole);
            add("direction", ColumnType::Word);
        }
        for (option, _) in variants.words() {
            add(&option.name().replace('-', "_"), ColumnType::Word);
        }
        add("ending", ColumnType::Word);
        add("clocks", ColumnType::Whole);
        add("steps", ColumnType::Whole);
        for number in ["pulses", "reached"] {
            letters.iter().for_each(|axis| add(&format!("{number}_{axis}"), ColumnType::Whole));
        }
        add("exact", ColumnType::Flag);
        add("error_max", ColumnType::Real);
        add("error_mean", ColumnType::Real);
        add("v_mean", ColumnType::Real);
        add("overflows", ColumnType::Whole);
        add("overflow", ColumnType::Word);
        for axis in letters {
            add(&format!("spacing_min_{axis}"), ColumnType::Whole);
            add(&format!("spacing_max_{axis}"), ColumnType::Whole);
        }
        add("reason", ColumnType::Word);
        Ok(Layout { columns, drawn, axes, points, ripple: false })
    }

    /// The same with columns for the extremes of the speed and its ripple.
    pub(super) fn with_ripple(mut self) -> Layout {
        let after = self.columns.iter().position(|column| column.name == "overflows").unwrap_or(self.columns.len());
        let more = RIPPLE.map(|name| Column { name: name.to_owned(), kind: ColumnType::Real });
        self.columns.splice(after..after, more);
        Layout { ripple: true, ..self }
    }

    /// The row of a run, or of a refusal with its reason.
    pub(super) fn row(&self, index: u64, site: &Description, words: &[&str], run: Result<Measured, String>) -> Row {
        let word_of = |text: &str| Value::Word(text.to_owned());
        let mut row = vec![index.into()];
        if self.drawn.is_spline() {
            row.extend(free_curves::values(site, self.points));
        }
        if self.drawn.sizes() > 0 {
            row.extend([word_of(site.drawn.name()), size(site, 0), size(site, 1)]);
            row.push(site.drawn.opens().map(|opens| opens.to_string()).into());
        }
        row.extend(site.from.iter().chain(&site.to).map(|&coordinate| Value::Whole(coordinate)));
        if self.drawn.is_centered() {
            row.extend(site.center.map(Value::Whole));
            row.push(if site.drawn.turns() { word_of(turn(site)) } else { Value::None });
        }
        row.extend(words.iter().map(|text| word_of(text)));
        let cut = run.iter().flat_map(|run| &run.cut).map(ToString::to_string).collect::<Vec<String>>();
        match run {
            Err(reason) => {
                row.push(word_of("refused"));
                row.resize(self.columns.len() - 1, Value::None);
                row.push(reason.into());
            }
            Ok(run) if run.ending.is_none() => {
                row.push(word_of(word(None)));
                row.resize(self.columns.len() - 1, Value::None);
                row.push(Value::Word([vec![format!("not done after {} clocks", run.clocks)], cut].concat().join("; ")));
            }
            Ok(run) => {
                row.extend([word_of(word(run.ending)), run.clocks.into(), run.steps.into()]);
                row.extend(run.pulses.iter().map(|&count| Value::from(count)));
                row.extend(run.reached.iter().map(|&place| Value::Whole(place)));
                row.push(Value::Flag(is_ended(site, &run.reached, &run.pulses)));
                row.extend([run.greatest.into(), run.mean.into(), run.speed.into()]);
                if self.ripple {
                    let [least, greatest] = run.extremes.map_or([None; 2], |extremes| extremes.map(Some));
                    row.extend([least.into(), greatest.into(), run.ripple.into()]);
                }
                row.extend([run.overflows.into(), run.component.into()]);
                for axis in 0..self.axes {
                    let gaps = run.spacing.get(axis).copied().flatten();
                    row.extend([0, 1].map(|end| Value::from(gaps.map(|gaps| gaps[end]))));
                }
                row.push(if cut.is_empty() { Value::None } else { Value::Word(cut.join("; ")) });
            }
        }
        row
    }
}

fn size(site: &Description, index: usize) -> Value {
    site.sizes.get(index).map_or(Value::None, |&size| Value::Whole(size))
}

fn turn(site: &Description) -> &'static str {
    if site.direction == stepwave_nc::Direction::Clockwise { "cw" } else { "ccw" }
}

/// The words that repeat the run of a row alone: `stepwave run dda-line --to 8,6 --width 4`.
#[must_use]
pub fn words(model: &Model, columns: &[Column], row: &[Value]) -> String {
    let value = |name: &str| {
        let column = columns.iter().position(|column| column.name == name)?;
        match row.get(column)? {
            Value::None | Value::Real(_) => None,
            Value::Whole(number) => Some(number.to_string()),
            Value::Flag(flag) => Some(flag.to_string()),
            Value::Word(word) => Some(word.clone()),
        }
    };
    let point = |name: &str| {
        let coordinates: Vec<String> = AXES.iter().map_while(|axis| value(&format!("{name}_{axis}"))).collect();
        Some(coordinates.join(",")).filter(|_| !coordinates.is_empty())
    };
    let moved = |text: &String| text.split(',').any(|coordinate| coordinate != "0");
    let mut words = format!("stepwave run {}", model.name);
    let mut add = |option: &str, text: Option<String>| {
        if let Some(text) = text {
            words += &format!(" --{option} {text}");
        }
    };
    let free = free_curves::options(columns, value);
    let is_free = free.is_some();
    if let Some(options) = free {
        options.into_iter().for_each(|(option, text)| add(&option, Some(text)));
    } else if let Some(curve) = value("curve") {
        let sizes: Vec<String> = ["size_a", "size_b"].into_iter().filter_map(value).collect();
        add(&curve, Some(sizes.join(",")));
        add("opens", value("opens"));
    }
    add("from", point("from").filter(|from| moved(from) && !is_free));
    add("to", point("to").filter(|_| !is_free));
    add("center", point("center").filter(moved));
    if let Some(direction) = value("direction") {
        add(&direction, Some(String::new()));
    }
    for doc in model.options {
        let option = doc.name().trim_start_matches('-');
        match (option, value(&option.replace('-', "_"))) {
            ("normalize", Some(word)) => add(option, (word == "yes").then(String::new)),
            (_, Some(word)) => add(option, Some(word).filter(|word| word != "none")),
            (_, None) => {}
        }
    }
    words.split_whitespace().collect::<Vec<_>>().join(" ")
}
