//! Geometries from a file: one a line, in columns named as those of a sweep.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use stepwave_models::{AXES, CurveKind, Millionths, Model};
use stepwave_nc::{Description, Direction, Drawn, Opens};
use stepwave_netlist::did_you_mean;

use super::space::Space;
use super::table::fields;
use super::{StudyError, free_curves};

/// Reads geometries for a model: `to_x,to_y` and every other column that is not as by default: `from_x`, `center_x`,
/// `direction` (`cw`, `ccw`), and of conics `curve`, `size_a`, `size_b`, `opens`. Free curves have `curve` and the points
/// `p0_x,p0_y,p1_x,…` instead, NURBS also their weights `p0_w,…`, `degree` and `knots`. The two radii of an arc may differ by
/// `radii` BLU beyond what rounding makes.
///
/// # Errors
/// The file cannot be read, or has a mistake, which is reported with its line.
pub fn read_points(file: &Path, model: &Model, radii: Millionths) -> Result<Space, StudyError> {
    let text = std::fs::read_to_string(file).map_err(|error| StudyError::reading(file, error))?;
    let mistake = |line: usize, what: String| StudyError::Points { file: file.display().to_string(), line, what };
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let (_, first) = lines.next().ok_or_else(|| {
        mistake(1, "a heading is missing: begin with to_x,to_y, or of free curves with p0_x,p0_y".to_owned())
    })?;
    let heading: Vec<String> = fields(first).iter().map(|name| name.trim().to_owned()).collect();
    let free = model.curve().drawn().iter().all(|drawn| drawn.is_spline());
    let points = (0..).take_while(|point| heading.contains(&format!("p{point}_x"))).count();
    let known = if free { free_curves::known(model.curve(), points.max(2)) } else { known(model) };
    if let Some(unknown) = heading.iter().find(|name| !known.contains(name)) {
        let hint = did_you_mean(unknown, known.iter().map(String::as_str));
        let message =
            format!("there is no column '{unknown}' for {}{hint}: its columns are {}", model.name, known.join(", "));
        return Err(mistake(1, message));
    }
    if heading.iter().enumerate().any(|(place, name)| heading[..place].contains(name)) {
        return Err(mistake(1, "a column is given twice".to_owned()));
    }
    let axes = AXES.iter().take_while(|axis| heading.contains(&format!("to_{axis}"))).count();
    if axes < 2 && !free {
        return Err(mistake(1, "the columns to_x and to_y are missing".to_owned()));
    }
    if free && points < 2 {
        return Err(mistake(1, "the columns p0_x, p0_y, p1_x, … are missing".to_owned()));
    }
    let site = |(index, line): (usize, &str)| {
        let words = fields(line);
        if words.len() != heading.len() {
            let count = words.len();
            return Err(mistake(index + 1, format!("{count} values under {} columns", heading.len())));
        }
        let line = Line { heading: &heading, words: &words, axes, radii };
        let site = match free {
            true => free_curves::of_words(model.curve(), points, |name| line.word(name)),
            false => line.site(model.curve()),
        };
        site.map_err(|what| mistake(index + 1, what))
    };
    let points = lines.map(site).collect::<Result<_, _>>()?;
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    Ok(Space::Points { points, content: hasher.finish() })
}

/// Columns that a model's geometries may have.
fn known(model: &Model) -> Vec<String> {
    let axes = &AXES[..model.curve().max_axes()];
    let mut known: Vec<String> = Vec::new();
    if model.curve().drawn().iter().any(|drawn| drawn.sizes() > 0) {
        known.extend(["curve", "size_a", "size_b", "opens"].map(str::to_owned));
    }
    known.extend(["from", "to"].iter().flat_map(|point| axes.iter().map(move |axis| format!("{point}_{axis}"))));
    if model.curve().drawn().iter().any(|drawn| drawn.is_centered()) {
        known.extend(["center_x", "center_y", "direction"].map(str::to_owned));
    }
    known
}

/// A coordinate in a column.
pub(super) fn whole(name: &str, word: &str) -> Result<i64, String> {
    word.parse().map_err(|_| format!("expected a whole number of BLU for {name}, not '{word}'"))
}

/// One line of the file.
struct Line<'a> {
    heading: &'a [String],
    words: &'a [String],
    axes: usize,
    radii: Millionths,
}

impl Line<'_> {
    fn word(&self, name: &str) -> Option<&str> {
        let place = self.heading.iter().position(|known| known == name)?;
        self.words.get(place).map(|word| word.trim()).filter(|word| !word.is_empty())
    }

    fn number(&self, name: &str) -> Result<i64, String> {
        self.word(name).map_or(Ok(0), |word| whole(name, word))
    }

    fn point(&self, name: &str, axes: usize) -> Result<Vec<i64>, String> {
        AXES[..axes].iter().map(|axis| self.number(&format!("{name}_{axis}"))).collect()
    }

    fn site(&self, kind: CurveKind) -> Result<Description, String> {
        let opens = match self.word("opens") {
            None => None,
            Some(word) => {
                let known = Opens::ALL.into_iter().find(|opens| opens.to_string() == word);
                Some(known.ok_or_else(|| format!("'{word}' in opens is none of +x, -x, +y, -y"))?)
            }
        };
        let drawn = match kind.drawn() {
            [one] => *one,
            // All lines of a file are of one kind: arcs where it has a column for their direction.
            _ if kind == CurveKind::Move && self.heading.iter().all(|name| name != "direction") => Drawn::Line,
            _ if kind == CurveKind::Move && self.axes == 3 => Drawn::Helix,
            _ if kind == CurveKind::Move => Drawn::Arc,
            several => {
                let named = several.iter().find(|drawn| Some(drawn.name()) == self.word("curve"));
                let names = || several.iter().map(|drawn| drawn.name()).collect::<Vec<_>>().join(", ");
                named.ok_or_else(|| format!("curve is none of {}", names()))?.opening(opens)
            }
        };
        let direction = match self.word("direction") {
            Some("cw") => Direction::Clockwise,
            Some("ccw") => Direction::CounterClockwise,
            None if !drawn.turns() => Direction::CounterClockwise,
            word => return Err(format!("'{}' in direction is neither cw nor ccw", word.unwrap_or(""))),
        };
        let sizes = ["size_a", "size_b"].iter().take(drawn.sizes()).map(|name| self.number(name));
        let sizes = sizes.collect::<Result<_, _>>()?;
        let (from, to) = (self.point("from", self.axes)?, self.point("to", self.axes)?);
        let center = [self.number("center_x")?, self.number("center_y")?];
        Ok(Description { drawn, sizes, from, to, center, direction, radii: self.radii.units() })
    }
}
