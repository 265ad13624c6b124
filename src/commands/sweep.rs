//! `stepwave sweep`: many geometries and hardware choices, a row each.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::models::options::{AnyOption, Shape, TOLERANCE};
use crate::models::{CurveKind, Millionths, Model};
use crate::nc::Direction;
use crate::netlist::did_you_mean;
use crate::report::heat::HeatMap;
use crate::study::{
    self, Cells, ColumnType, Dimension, Drawn, Grid, ParquetTable, Range, Row, Space, Stage, StudyError, Summary,
    Sweep, SweepPart, Variants, write_line,
};
use rayon::prelude::*;

mod free_curves;
mod kept;

use self::kept::Kept;
use super::geometry::invalid;
use super::progress::Progress;
use crate::Error;
use crate::cli::{Point, SpaceArgs, SweepArgs, SweepCommand, TableArgs, VariantArgs, known_register};
use crate::output::{self, Outputs, Sink, is_stream, temporary};

/// Geometries of the first chunk, and most of any.
const FIRST: u64 = 1 << 12;
const MOST: u64 = 1 << 15;
/// How long a chunk should take: a kill loses no more.
const CHUNK: Duration = Duration::from_secs(1);

/// Does a sweep, or joins parts of one.
pub(crate) fn run(args: &SweepArgs) -> Result<(), Error> {
    if let Some(SweepCommand::Merge { out, parts }) = &args.command {
        return merge(out, parts);
    }
    let model = args.bench.model(args.model.as_deref().unwrap_or_default())?;
    let [number, of] = args.outputs.shard.unwrap_or([1, 1]);
    let mut variants = variants(&args.variants)?;
    let radii = radii(model, &mut variants)?;
    let space = space(model, &args.space, radii)?;
    for (option, lists) in &args.variants.0 {
        let parts = lists.iter().flat_map(|list| list.split(','));
        let mut names = parts.filter_map(|part| part.split_once('=')).map(|(name, _)| name.trim());
        if let Shape::PerRegister { .. } = option.shape() {
            names.try_for_each(|name| known_register(model, option.name(), name))?;
        }
    }
    let sweep = Sweep::new(model, space, variants, SweepPart { number, of }, args.outputs.max_clocks)?;
    let sweep = if args.outputs.ripple { sweep.with_ripple() } else { sweep };
    let own = args.bench.files(&args.model);
    let inputs: Vec<&PathBuf> = args.space.file.iter().chain(&own).collect();
    let mut outputs = Outputs::reading(&inputs);
    let written = write(&sweep, &args.outputs, Outputs::reading(&inputs), &mut outputs);
    let text = written.map_err(|failure| match (failure, temporary::kept()) {
        (Error::Invalid(sentence), Some(kept)) => Error::Invalid(format!("{sentence}; {kept}")),
        (failure, _) => failure,
    })?;
    if args.by_ending.quiet || outputs.uses_stdout() { Ok(()) } else { output::print(&text) }
}

/// All geometries that the options tell.
fn space(model: &Model, args: &SpaceArgs, radii: Millionths) -> Result<Space, Error> {
    if let Some(file) = &args.file {
        return Ok(study::read_points(file, model, radii)?);
    }
    let cells = if let Some(cells) = free_curves::cells(model, args)? { cells } else { cells(model, args, radii)? };
    Ok(match args.samples {
        Some(count) if cells.count() <= u128::from(u64::MAX) => Space::Samples { cells, count, seed: args.seed },
        Some(_) => {
            let (count, most) = (cells.count(), u64::MAX);
            return invalid(format!(
                "a grid of {count} geometries is too large to draw from, {most} is the most: give narrower ranges, or a step \
                 such as 0..1000/10"
            ));
        }
        None => Space::Cells(cells),
    })
}

/// The grid of geometries that have ends.
fn cells(model: &Model, args: &SpaceArgs, radii: Millionths) -> Result<Cells, Error> {
    let drawn = drawn(model, args)?;
    let points = |one: &Option<Point>, many: &Option<Grid>| {
        let one = one.as_ref().map(|Point(point)| point.iter().map(|&coordinate| Range::one(coordinate)).collect());
        one.or_else(|| many.as_ref().map(|Grid(ranges)| ranges.clone()))
    };
    let (mut from, to) = (points(&args.from, &args.from_grid), points(&args.to, &args.to_grid));
    let sizes = sizes(model, args, drawn)?;
    let who = model.name;
    let most = model.curve().max_axes();
    let least = drawn.axes().min(most);
    let axes = to.as_ref().or(from.as_ref()).map_or(least.min(2), Vec::len);
    for (option, points) in [("--to", &to), ("--from", &from)] {
        let count = points.as_ref().map_or(axes.max(least), Vec::len);
        if !(least..=most).contains(&count) || (drawn == Drawn::Line && count != axes) {
            let takes = model.curve().describe();
            return invalid(format!(
                "{option} has {count} {}, but {who} interpolates {takes}",
                if count == 1 { "coordinate" } else { "coordinates" }
            ));
        }
    }
    if drawn == Drawn::Line && to.is_none() {
        let grid = vec!["0..255"; least].join("x");
        return invalid(format!("the end points are missing: give {who} --to-grid such as {grid}"));
    }
    if drawn == Drawn::Line {
        from = from.or_else(|| Some(vec![Range::one(0); axes]));
    }
    if drawn.is_round() && from.is_none() && args.radius.is_none() {
        return invalid(format!("the start points are missing: give {who} --radius, --from or --from-grid"));
    }
    let center = center(args)?;
    let flags = [(args.cw, Direction::Clockwise), (args.ccw, Direction::CounterClockwise)];
    let directions = flags.into_iter().filter(|(given, _)| *given).map(|(_, direction)| direction).collect();
    Ok(Cells { drawn, sizes, from, to, center, directions, radii })
}

/// The radius and height, the semi-axes or the parameter: as many as the curve has.
fn sizes(model: &Model, args: &SpaceArgs, drawn: Drawn) -> Result<Vec<Range>, Error> {
    let mut sizes: Vec<Range> = args.sized().map(|(_, Grid(ranges))| ranges.clone()).unwrap_or_default();
    let own = args.radius.into_iter().chain(args.height);
    let wanted = drawn.sizes() + own.clone().count();
    sizes.extend(own);
    let who = model.name;
    if sizes.len() != wanted {
        return invalid(format!(
            "{} sizes were given where {who} takes {wanted}: see `stepwave sweep --help`",
            sizes.len()
        ));
    }
    Ok(sizes)
}

fn center(args: &SpaceArgs) -> Result<[i64; 2], Error> {
    match &args.center {
        None => Ok([0, 0]),
        Some(Point(point)) => match <[i64; 2]>::try_from(point.as_slice()) {
            Ok(center) => Ok(center),
            Err(_) => invalid(format!("--center has {} coordinates: give X,Y", point.len())),
        },
    }
}

/// Axes of the end points, if any are given.
fn to_axes(args: &SpaceArgs) -> Option<usize> {
    let one = args.to.as_ref().map(|Point(point)| point.len());
    one.or_else(|| args.to_grid.as_ref().map(|Grid(ranges)| ranges.len()))
}

/// What the model interpolates, if nothing was given that it has not.
fn drawn(model: &Model, args: &SpaceArgs) -> Result<Drawn, Error> {
    let (kind, sized) = (model.curve(), args.sized());
    let drawn = match kind.drawn() {
        [one] => *one,
        _ if kind == CurveKind::Move && !(args.cw || args.ccw || args.center.is_some() || args.radius.is_some()) => {
            Drawn::Line
        }
        _ if kind == CurveKind::Move && (args.height.is_some() || to_axes(args) == Some(3)) => Drawn::Helix,
        _ if kind == CurveKind::Move => Drawn::Arc,
        several => match sized {
            Some((drawn, _)) => drawn,
            None => {
                let options: Vec<&str> = several.iter().map(|drawn| drawn.option()).collect();
                let options = options.join(", ");
                return invalid(format!("the curves are missing: give {} one of {options}", model.name));
            }
        },
    };
    let superfluous = [
        (sized.is_some(), drawn.sizes() > 0, "sizes of conics"),
        (args.opens.is_some(), drawn.is_open(), "--opens"),
        (args.radius.is_some(), drawn.is_round(), "--radius"),
        (args.height.is_some(), drawn == Drawn::Helix, "--height"),
        (args.cw || args.ccw, drawn.turns(), "--cw or --ccw"),
        (args.center.is_some(), drawn.is_centered(), "--center"),
    ];
    if let Some((_, _, option)) = superfluous.into_iter().find(|(given, taken, _)| *given && !taken) {
        let takes = model.curve().describe();
        return invalid(format!("{} interpolates {takes}, which have no {option}: leave it out", model.name));
    }
    if drawn.turns() && !args.cw && !args.ccw {
        return invalid(format!("the direction is missing: give {} --cw, --ccw or both", model.name));
    }
    Ok(drawn)
}

/// The hardware options that are given, each with its values.
fn variants(args: &VariantArgs) -> Result<Variants, StudyError> {
    let dimension = |(option, lists): &(&'static dyn AnyOption, Vec<String>)| {
        let dimensions = lists.iter().map(|list| Dimension::parse(*option, list)).collect::<Result<Vec<_>, _>>();
        Ok(dimensions?.into_iter().reduce(Dimension::and))
    };
    let dimensions = args.0.iter().filter_map(|given| dimension(given).transpose());
    dimensions.collect::<Result<_, _>>().map(Variants)
}

/// How far the two radii of an arc may differ beyond what rounding makes. As an option of hardware the tolerance stays
/// with models that have chords.
fn radii(model: &Model, variants: &mut Variants) -> Result<Millionths, Error> {
    let is_tolerance = |dimension: &Dimension| dimension.option.name() == TOLERANCE.name;
    let Some(place) = variants.0.iter().position(is_tolerance) else { return Ok(Millionths(0)) };
    let is_round = model.curve().drawn().iter().any(|drawn| drawn.is_round());
    if !is_round && model.takes(&TOLERANCE) {
        return Ok(Millionths(0));
    }
    if !is_round {
        let takes = model.curve().describe();
        return invalid(format!("{} interpolates {takes}, which have no --tolerance: leave it out", model.name));
    }
    let (given, _) = variants.at(0);
    if variants.0[place].len() > 1 {
        return invalid(
            "--tolerance is of the radii of arcs too, and the same for all runs: give one value".to_owned(),
        );
    }
    if !model.takes(&TOLERANCE) {
        variants.0.remove(place);
    }
    Ok(given.value(&TOLERANCE).unwrap_or(Millionths(0)))
}

/// A heat map being gathered.
struct Heat {
    map: HeatMap,
    column: usize,
    point: [usize; 2],
    worst: Option<Row>,
    runs: u64,
}

impl Heat {
    fn new(sweep: &Sweep, name: &str) -> Result<Heat, Error> {
        let numbers = sweep.columns().iter().filter(|column| column.kind != ColumnType::Word && column.name != "index");
        let known: Vec<&str> = numbers.map(|column| column.name.as_str()).collect();
        if !known.contains(&name) {
            let what = match sweep.column(name) {
                Some(_) => format!("the column '{name}' is not a measure"),
                None if study::RIPPLE.contains(&name) => {
                    format!("the column '{name}' is one of three more: give --ripple")
                }
                None => format!("there is no column '{name}'{}", did_you_mean(name, known.iter().copied())),
            };
            return Err(StudyError::Column { what, known: known.join(", ") }.into());
        }
        let Some((point, ranges)) = sweep.map() else {
            return invalid(
                "a heat map shows a grid of points: give --to-grid or --from-grid, or ranges for a point of free curves"
                    .to_owned(),
            );
        };
        let names = ["x", "y"].map(|axis| format!("{point}_{axis}"));
        let column = |name: &str| sweep.column(name).unwrap_or(0);
        Ok(Heat {
            map: HeatMap::new([&names[0], &names[1]], ranges),
            column: column(name),
            point: [column(&names[0]), column(&names[1])],
            worst: None,
            runs: 0,
        })
    }

    fn row(&mut self, row: &Row) {
        self.runs += 1;
        // Coordinates are within ±2^52, which a real number holds.
        #[expect(clippy::cast_possible_truncation, reason = "whole numbers within ±2^52")]
        let point = self.point.map(|place| row[place].number().unwrap_or(0.0) as i64);
        if self.map.point(point, row[self.column].number()) {
            self.worst = Some(row.clone());
        }
    }

    fn picture(&self, sweep: &Sweep) -> Picture {
        let (model, columns) = (sweep.model(), sweep.columns());
        let what = columns[self.column].name.clone();
        let unit = match what.split('_').next().unwrap_or_default() {
            "error" | "reached" | "from" | "to" | "center" | "size" => "BLU",
            "spacing" => "clocks",
            _ => "",
        };
        let worst = self.worst.as_ref().map_or_else(String::new, |row| study::words(model, columns, row));
        let title = format!("{}: {what} of {} runs", model.name, self.runs);
        let line = self
            .map
            .worst()
            .map_or_else(String::new, |(number, [x, y])| format!("greatest {what} {number} at ({x}, {y}): {worst}\n"));
        Picture { title, what, unit, worst, line }
    }

    /// The file.
    fn bytes(&self, picture: &Picture, as_png: bool) -> Vec<u8> {
        let Picture { title, what, unit, worst, .. } = picture;
        if as_png {
            self.map.png(title, what, unit, worst)
        } else {
            self.map.svg(title, what, unit, worst).into_bytes()
        }
    }
}

/// The words of a heat map.
struct Picture {
    title: String,
    what: String,
    unit: &'static str,
    /// The command that repeats the worst run.
    worst: String,
    /// What is printed of it.
    line: String,
}

/// Where the rows of a sweep go.
struct Tables {
    stage: Option<Kept>,
    stream: Option<Sink>,
    summary: Summary,
    heat: Option<Heat>,
}

impl Tables {
    /// Shows rows to everybody but the stage.
    fn show(&mut self, row: &Row) {
        self.summary.row(row);
        if let Some(heat) = &mut self.heat {
            heat.row(row);
        }
    }

    /// Takes the rows of some geometries.
    fn take(&mut self, geometries: u64, rows: Vec<Row>) -> Result<(), Error> {
        rows.iter().for_each(|row| self.show(row));
        let lines = |rows: &[Row]| {
            let mut lines = String::new();
            rows.iter().for_each(|row| write_line(row, &mut lines));
            lines
        };
        let texts: Vec<String> = rows.par_chunks(4096).map(lines).collect();
        if let Some(stage) = &mut self.stage {
            stage.append(geometries, rows.len() as u64, &texts)?;
        }
        if let Some(stream) = &mut self.stream {
            texts.iter().try_for_each(|text| stream.write_all(text.as_bytes()))?;
        }
        Ok(())
    }

    /// Takes the rows that a killed sweep has left; gives the geometries done.
    fn recall(&mut self) -> Result<u64, Error> {
        let Some(mut stage) = self.stage.take() else { return Ok(0) };
        stage.replay(|row| {
            self.show(&row);
            if let Some(stream) = &mut self.stream {
                let mut line = String::new();
                write_line(&row, &mut line);
                stream.write_all(line.as_bytes())?;
            }
            Ok::<(), Error>(())
        })?;
        let geometries = stage.done();
        self.stage = Some(stage);
        Ok(geometries)
    }
}

/// Tries all outputs before the first run, though some are written at the end only; gives the file of the CSV, if it is
/// one, and the file next to which the rows are gathered.
fn tried(args: &TableArgs, mut claims: Outputs) -> Result<[Option<PathBuf>; 2], Error> {
    if args.parquet.as_deref().is_some_and(is_stream) {
        return invalid("Parquet rows are gathered next to their file before they are written: name a file".to_owned());
    }
    let mut claim = |path: &Option<PathBuf>| path.as_deref().map(|path| claims.claim(path)).transpose();
    let csv = claim(&args.csv)?.filter(|_| !args.csv.as_deref().is_some_and(is_stream));
    let parquet = claim(&args.parquet)?;
    args.plot.iter().try_for_each(|path| claims.claim(path).map(drop))?;
    let stage = csv.clone().or(parquet);
    match &stage {
        Some(target) => Stage::files(target).iter().try_for_each(|path| claims.keep_free(path))?,
        None if args.resume => {
            return invalid("--resume goes on next to the final file: give --csv FILE or --parquet FILE".to_owned());
        }
        None => {}
    }
    Ok([csv, stage])
}

/// Does all runs and writes every output; gives the summary. `claims` are the outputs that are written at the end.
fn write(sweep: &Sweep, args: &TableArgs, claims: Outputs, outputs: &mut Outputs) -> Result<String, Error> {
    let heat = (!args.plot.is_empty()).then(|| Heat::new(sweep, args.heat.as_deref().unwrap_or("error_max")));
    let heat = heat.transpose()?;
    let [csv, stage] = tried(args, claims)?;
    let streamed = args.csv.is_some() && csv.is_none();
    let mut stream = args.csv.as_deref().filter(|_| streamed).map(|path| outputs.open(path)).transpose()?;
    let to_stdout = args.plot.iter().filter(|path| *path == Path::new("-"));
    let mut to_stdout = to_stdout.map(|path| outputs.open(path)).collect::<Result<Vec<_>, _>>()?;
    let stage = stage.map(|target| Kept::open(&target, sweep, args.resume)).transpose()?;
    if let Some(stream) = &mut stream {
        writeln!(stream, "{}", study::heading(sweep.columns()))?;
    }
    let mut tables = Tables { stage, stream, summary: Summary::new(sweep.columns()), heat };
    let begun = tables.recall()?;
    let recalled = tables.summary.rows();
    all_rows(sweep, begun, &mut tables)?;

    let Tables { mut stage, stream, summary, heat } = tables;
    if summary.rows() == 0 && sweep.part() == SweepPart::WHOLE {
        stage.map(Kept::discard).transpose()?;
        return invalid("no point of the grid lies within 1 BLU of such a curve: give another grid".to_owned());
    }
    let mut text = summary.text(sweep.model(), sweep.columns());
    if let (Some(path), Some(stage)) = (&args.parquet, &mut stage) {
        let mut table = ParquetTable::new(sweep, outputs.open(path)?)?;
        stage.replay(|row| table.row(row))?;
        table.finish()?.flush()?;
    }
    if let Some(heat) = heat {
        let picture = heat.picture(sweep);
        for path in &args.plot {
            let as_png = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
            let mut sink = match to_stdout.pop_if(|_| path == Path::new("-")) {
                Some(sink) => sink,
                None => outputs.open(path)?,
            };
            sink.write_all(&heat.bytes(&picture, as_png))?;
            sink.flush()?;
        }
        text += &picture.line;
    }
    if let Some(mut stream) = stream {
        stream.flush()?;
    }
    outputs.commit_all()?;
    stage.map(|stage| stage.finish(csv.is_some())).transpose()?;
    if recalled > 0 {
        text += &format!("{recalled} of the runs were done before\n");
    }
    Ok(text)
}

/// Does the runs that are not done, a chunk at a time.
fn all_rows(sweep: &Sweep, begun: u64, tables: &mut Tables) -> Result<(), Error> {
    let all = sweep.geometries();
    let progress = Progress::of(all, "geometries");
    progress.begin_at(begun);
    // Runs, not geometries, are what takes time.
    let variants = sweep.variants().max(1);
    let (mut done, mut size) = (begun, (FIRST / variants).max(1));
    while done < all {
        let (start, end) = (Instant::now(), all.min(done + size));
        let rows = sweep.rows(done..end)?;
        tables.take(end - done, rows)?;
        done = end;
        progress.set(done);
        let taken = start.elapsed();
        size = if taken > 2 * CHUNK {
            size / 2
        } else if taken < CHUNK / 2 {
            size * 2
        } else {
            size
        };
        size = size.clamp(1, (MOST / variants).max(1));
    }
    Ok(())
}

/// Joins parts.
fn merge(out: &Path, parts: &[PathBuf]) -> Result<(), Error> {
    let mut outputs = Outputs::reading(parts);
    let as_parquet = out.extension().is_some_and(|extension| extension == "parquet");
    let rows = study::merge(parts, outputs.open(out)?, as_parquet)?;
    let quiet = outputs.uses_stdout();
    outputs.commit()?;
    if quiet { Ok(()) } else { output::print(&format!("{rows} rows of {} parts\n", parts.len())) }
}
