//! `stepwave sweep`: what may be written.

use std::path::PathBuf;

use crate::models::options::{AnyOption, Shape, WIDTH, all};
use crate::nc::{Drawn, NURBS_DEGREE, Opens, SplineForm};
use crate::study::{Grid, Range};
use clap::builder::StringValueParser;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, Subcommand};

use super::BenchArgs;
use super::endings::{Format, OutputArgs, file_of};
use super::hardware::proposals;
use super::names::{listed, model_name};
use super::values::{Point, opens, parse_point, whole};

/// A grid on the command line.
fn grid(text: &str) -> Result<Grid, String> {
    text.parse().map_err(|error: crate::study::StudyError| error.to_string())
}

/// Ranges apart by a comma, such as the semi-axes of ellipses.
fn ranges(text: &str) -> Result<Grid, String> {
    let ranges = text.split(',').map(range).collect::<Result<_, _>>();
    ranges.map(Grid)
}

fn range(text: &str) -> Result<Range, String> {
    text.parse().map_err(|error: crate::study::StudyError| error.to_string())
}

/// One part of several: `2/8`.
fn shard(text: &str) -> Result<[u64; 2], String> {
    let parts = text.split_once('/').and_then(|(number, of)| Some([number.parse().ok()?, of.parse().ok()?]));
    let fits = |[number, of]: &[u64; 2]| (1..=*of).contains(number) && *of <= 1 << 20;
    parts.filter(fits).ok_or_else(|| format!("invalid part '{text}': give I/N, from 1/N to N/N, such as 3/8"))
}

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(after_help = "Examples:\n  \
    stepwave sweep dda-line --to-grid 0..63x0..63 --width 6..8 --preset zero,half --csv lines.csv\n  \
    stepwave sweep ppc-arc --radius 1..100 --ccw --parquet circles.parquet\n  \
    stepwave sweep dda-arc --from 50,0 --to-grid -51..51x-51..51 --ccw --csv arcs.csv\n  \
    stepwave sweep dda-line --to-grid 1..127x1..127 --heat error_mean --plot mean.png\n  \
    stepwave sweep dda-line --to-grid 0..4095x0..4095 --samples 5000 --seed 7 --csv -\n  \
    stepwave sweep spline-dda --bezier 0,0,-20..20/4,-20..20/4,40,0 --csv - --plot curves.svg\n\
    \n\
    Geometries. A grid gives a geometry for every point; of arcs, helices and conics those of its\n\
    points that lie within 1 BLU of the curve, arcs and helices with --tolerance also farther off: the\n\
    arc is then one about the nearest whole centre, as in `stepwave run`. Grids of start points and of end points make a product.\n\
    Without an end point an arc or ellipse is a whole one. Of free curves each coordinate of each point is\n\
    a number or a range. Ranges are FIRST..LAST or FIRST..LAST/STEP, both ends in them.\n\
    \n\
    Hardware choices. Each takes a list with commas, numbers also ranges; every value of each goes with\n\
    every value of the others. Without --width each geometry has the least widths that hold it, as in\n\
    `stepwave run`. Data sampling has a clock of 1 MHz.\n\
    \n\
    Rows. One a run: index (all points of the grid count, those without a curve too), geometry (of free\n\
    curves p0_x, p0_y, p1_x, … of each point, of NURBS p0_w, …, degree and knots too), choices,\n\
    ending (done, trapped, stalled, limit, refused), clocks, steps, pulses and end point of each axis,\n\
    whether that is exact, error_max and error_mean (BLU, after all steps), v_mean (mean speed over\n\
    v_max, one BLU in each step that nothing delays; none where the end is missed), with --ripple\n\
    v_least, v_greatest and ripple of windows of 32 steps as in the report of `stepwave run`,\n\
    overflows and the first overflow's component, spacing_min and spacing_max (clocks between two pulses of an axis), and the\n\
    reason of a refusal. Rows are the same, byte for byte, whatever the number of threads\n\
    (RAYON_NUM_THREADS). The summary has the least and the greatest v_mean, and of lines of one\n\
    length, within a BLU, k_v, their ratio.\n\
    \n\
    A sweep that was killed leaves its rows next to the final file; the same words with --resume go on.\n\
    The exit code is 0 whatever the rows say.")]
pub(crate) struct SweepArgs {
    #[command(subcommand)]
    pub(crate) command: Option<SweepCommand>,
    /// The model; `stepwave list` shows them. Or a netlist of one's own: F.net
    #[arg(required = true, value_parser = model_name(), hide_possible_values = true)]
    pub(crate) model: Option<String>,
    #[command(flatten)]
    pub(crate) bench: BenchArgs,
    #[command(flatten)]
    pub(crate) space: SpaceArgs,
    #[command(flatten)]
    pub(crate) variants: VariantArgs,
    #[command(flatten)]
    pub(crate) outputs: TableArgs,
    #[command(flatten)]
    pub(crate) by_ending: OutputArgs,
}

#[derive(Debug, Subcommand)]
pub(crate) enum SweepCommand {
    /// Join the parts of a sweep (--shard) to the very file that the whole sweep writes
    Merge {
        /// The file to write; Parquet if its name ends in .parquet, else CSV; - is standard output
        #[arg(value_parser = file_of(&[Format::Csv, Format::Parquet]))]
        out: PathBuf,
        /// All parts, CSV or Parquet, in any order
        #[arg(required = true)]
        parts: Vec<PathBuf>,
    },
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Geometries, in BLU")]
pub(crate) struct SpaceArgs {
    /// Start point [default: the origin; of a circle, ellipse or hyperbola its first vertex]
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true, value_parser = parse_point)]
    pub(crate) from: Option<Point>,
    /// Start points: a range for each axis
    #[arg(long, value_name = "RANGExRANGE…", allow_hyphen_values = true, value_parser = grid, conflicts_with = "from")]
    pub(crate) from_grid: Option<Grid>,
    /// End point
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true, value_parser = parse_point)]
    pub(crate) to: Option<Point>,
    /// End points: a range for each axis, such as 0..255x0..255
    #[arg(long, value_name = "RANGExRANGE…", allow_hyphen_values = true, value_parser = grid, conflicts_with = "to")]
    pub(crate) to_grid: Option<Grid>,
    /// Radii of circles or helices that begin at (R, 0) about the centre
    #[arg(long, value_name = "RANGE", value_parser = range, conflicts_with_all = ["from", "from_grid"])]
    pub(crate) radius: Option<Range>,
    /// Ways in z of helices of one turn
    #[arg(long, value_name = "RANGE", allow_hyphen_values = true, value_parser = range, requires = "radius",
        conflicts_with_all = ["to", "to_grid"])]
    pub(crate) height: Option<Range>,
    /// Centre of arcs or conics, vertex of parabolas [default: the origin]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = parse_point)]
    pub(crate) center: Option<Point>,
    /// Ellipses with these semi-axes along x and y
    #[arg(long, value_name = "RANGE,RANGE", value_parser = ranges, group = "sizes")]
    pub(crate) ellipse: Option<Grid>,
    /// Parabolas y² = Cx about --center, or those that open elsewhere
    #[arg(long, value_name = "RANGE", value_parser = ranges, group = "sizes")]
    pub(crate) parabola: Option<Grid>,
    /// Branches of hyperbolas x²/A² - y²/B² = 1, or of those that open elsewhere
    #[arg(long, value_name = "RANGE,RANGE", value_parser = ranges, group = "sizes")]
    pub(crate) hyperbola: Option<Grid>,
    /// Where parabolas or hyperbolas open to [default: where both ends lie on them]
    #[arg(long, value_name = "WHERE", allow_hyphen_values = true, value_parser = opens())]
    pub(crate) opens: Option<Opens>,
    #[command(flatten)]
    pub(crate) free: FreeCurveArgs,
    /// Clockwise; together with --ccw both ways
    #[arg(long)]
    pub(crate) cw: bool,
    /// Counter-clockwise
    #[arg(long)]
    pub(crate) ccw: bool,
    /// So many random ones of the geometries, instead of all
    #[arg(long, value_name = "N", conflicts_with = "file", value_parser = whole::<u64>(1..))]
    pub(crate) samples: Option<u64>,
    /// Tells this draw of --samples from others
    #[arg(long, default_value_t = 1, value_parser = whole::<u64>(0..))]
    pub(crate) seed: u64,
    /// Geometries from a CSV file: to_x,to_y and what else is not by default (from_x, center_x, direction, …); of free curves
    /// curve (bezier, hermite, catmull-rom, b-spline) and p0_x,p0_y,p1_x,…, of NURBS p0_w,…, degree and knots
    #[arg(long, value_name = "FILE", conflicts_with_all = ["from", "from_grid", "to", "to_grid", "radius", "center", "sizes", "opens", "cw", "ccw"])]
    pub(crate) file: Option<PathBuf>,
}

/// Free curves, each coordinate of each point in a range.
#[derive(Debug, Args)]
pub(crate) struct FreeCurveArgs {
    /// Bezier curves with three or four control points in these ranges
    #[arg(long, value_name = "RANGE,RANGE,…", allow_hyphen_values = true, value_parser = ranges, group = "sizes")]
    pub(crate) bezier: Option<Grid>,
    /// Cubic segments from a point with a tangent to a point with a tangent
    #[arg(long, value_name = "RANGE,RANGE,…", allow_hyphen_values = true, value_parser = ranges, group = "sizes")]
    pub(crate) hermite: Option<Grid>,
    /// Catmull-Rom splines through points in these ranges
    #[arg(long, value_name = "RANGE,RANGE,…", allow_hyphen_values = true, value_parser = ranges, group = "sizes")]
    pub(crate) points: Option<Grid>,
    /// Uniform cubic B-splines along --points instead
    #[arg(long, requires = "points")]
    pub(crate) b_spline: bool,
    /// NURBS with control points and weights in these ranges; a weight may be 0.5..2/0.25
    #[arg(long, value_name = "RANGE,RANGE,W,…", allow_hyphen_values = true, group = "sizes")]
    pub(crate) nurbs: Option<String>,
    /// Degree of the NURBS [default: 3, or as many as the points allow]
    #[arg(long, requires = "nurbs", value_name = "P", value_parser = whole::<u32>(1..=NURBS_DEGREE as u64))]
    pub(crate) degree: Option<u32>,
    /// Knots of the NURBS [default: uniform, those at the ends degree + 1 times]
    #[arg(long, requires = "nurbs", value_name = "U,U,…", allow_hyphen_values = true)]
    pub(crate) knots: Option<String>,
}

impl FreeCurveArgs {
    /// What is drawn, where one of them says it.
    pub(crate) fn drawn(&self) -> Option<Drawn> {
        let through = if self.b_spline { SplineForm::BSpline } else { SplineForm::CatmullRom };
        let drawn = [
            self.bezier.as_ref().map(|_| Drawn::Spline(SplineForm::Bezier)),
            self.hermite.as_ref().map(|_| Drawn::Spline(SplineForm::Hermite)),
            self.points.as_ref().map(|_| Drawn::Spline(through)),
            self.nurbs.as_ref().map(|_| Drawn::Nurbs),
        ];
        drawn.into_iter().flatten().next()
    }
}

impl SpaceArgs {
    /// What is drawn, and its sizes, where these are given.
    pub(crate) fn sized(&self) -> Option<(Drawn, &Grid)> {
        let conics = [
            self.ellipse.as_ref().map(|sizes| (Drawn::Ellipse, sizes)),
            self.parabola.as_ref().map(|sizes| (Drawn::Parabola(self.opens), sizes)),
            self.hyperbola.as_ref().map(|sizes| (Drawn::Hyperbola(self.opens), sizes)),
        ];
        conics.into_iter().flatten().next()
    }
}

/// Lists of values of hardware options.
#[derive(Debug)]
pub(crate) struct VariantArgs(pub(crate) Vec<(&'static dyn AnyOption, Vec<String>)>);

fn list(option: &'static dyn AnyOption) -> Arg {
    let (value_name, values) = match option.shape() {
        Shape::Words(words) => ("LIST", words.join(",")),
        Shape::Numbers { values, .. } | Shape::PerRegister { values, .. } | Shape::Text { values, .. } => {
            ("LIST", values.to_owned())
        }
        Shape::Commas => (option.value_name(), "may be repeated".to_owned()),
    };
    let help = option.help();
    let help = help.split_once(" [default").map_or(help, |(help, _)| help);
    let arg = Arg::new(option.name()).long(option.name()).help(format!("{help} [{values}]")).value_name(value_name);
    let arg = arg.value_parser(listed(StringValueParser::new(), proposals(option))).hide_possible_values(true);
    let arg = if option.name() == WIDTH.name { arg.short('w') } else { arg };
    let arg = if option.shape() == Shape::Commas { arg.action(ArgAction::Append) } else { arg };
    if option.value_name().is_empty() { arg.num_args(0..=1).default_missing_value("yes") } else { arg }
}

impl Args for VariantArgs {
    fn augment_args(command: Command) -> Command {
        let heading = "Hardware choices (lists; each model takes some, `stepwave list` shows which)";
        command.next_help_heading(heading).args(all().iter().map(|option| list(*option)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        VariantArgs::augment_args(command)
    }
}

impl FromArgMatches for VariantArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<VariantArgs, clap::Error> {
        let given = |option: &&'static dyn AnyOption| {
            let texts = matches.get_many::<String>(option.name())?.cloned().collect();
            Some((*option, texts))
        };
        Ok(VariantArgs(all().iter().filter_map(given).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = VariantArgs::from_arg_matches(matches)?;
        Ok(())
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Simulation and outputs (- is standard output)")]
pub(crate) struct TableArgs {
    /// A run that is not done after so many clocks is given up
    #[arg(long, value_name = "CLOCKS", default_value_t = (1 << 31) - 1,
        value_parser = whole::<u64>(1..=(1 << 31) - 1))]
    pub(crate) max_clocks: u64,
    /// Write the rows as CSV
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Csv]))]
    pub(crate) csv: Option<PathBuf>,
    /// Write the rows as Parquet
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Parquet]))]
    pub(crate) parquet: Option<PathBuf>,
    /// Columns v_least, v_greatest and ripple: the speed over v_max of the slowest and of the fastest 32 steps, and their
    /// difference over the mean. Each run is then done alone, which takes longer than many at once
    #[arg(long)]
    pub(crate) ripple: bool,
    /// Column that --plot shows [default: error_max]
    #[arg(long, value_name = "COLUMN", requires = "plot")]
    pub(crate) heat: Option<String>,
    /// Draw a heat map over the grid, as PNG if the name ends in .png, else as SVG; of several runs of a point the greatest
    /// number shows; may be repeated
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Svg, Format::Png]))]
    pub(crate) plot: Vec<PathBuf>,
    /// Go on with what a killed sweep of the same words has left next to the final file; with nothing left, begin
    #[arg(long)]
    pub(crate) resume: bool,
    /// Do part I of N only: every N-th geometry, from the I-th on
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(crate) shard: Option<[u64; 2]>,
}
