//! `stepwave sweep`: what may be written.

use std::path::PathBuf;

use clap::builder::StringValueParser;
use clap::{Args, Subcommand};
use stepwave::models::{
    Adder, Beats, Compare, EndPoint, Form, Millionths, OnOverflow, Radix, StepTiming, System, Weights,
};
use stepwave::nc::Opens;
use stepwave::study::{Grid, Range};

use super::endings::{Format, file_of};
use super::names::{all_widths, list_of, listed, model_name, words};
use super::values::{Point, opens, parse_millionths, parse_point, parse_timing};

/// A grid on the command line.
fn grid(text: &str) -> Result<Grid, String> {
    text.parse().map_err(|error: stepwave::study::StudyError| error.to_string())
}

/// Ranges apart by a comma, such as the semi-axes of ellipses.
fn ranges(text: &str) -> Result<Grid, String> {
    let ranges = text.split(',').map(range).collect::<Result<_, _>>();
    ranges.map(Grid)
}

fn range(text: &str) -> Result<Range, String> {
    text.parse().map_err(|error: stepwave::study::StudyError| error.to_string())
}

/// One part of several: `2/8`.
fn shard(text: &str) -> Result<[u64; 2], String> {
    let parts = text.split_once('/').and_then(|(number, of)| Some([number.parse().ok()?, of.parse().ok()?]));
    let fits = |[number, of]: &[u64; 2]| (1..=*of).contains(number) && *of <= 1 << 20;
    parts.filter(fits).ok_or_else(|| format!("'{text}' is no part: give I/N, from 1/N to N/N, such as 3/8"))
}

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(after_help = "Examples:\n  \
    stepwave sweep dda-line --to-grid 0..63x0..63 --width 6..8 --preset zero,half --csv lines.csv\n  \
    stepwave sweep ppc-arc --radius 1..100 --ccw --parquet circles.parquet\n  \
    stepwave sweep dda-arc --from 50,0 --to-grid -51..51x-51..51 --ccw --csv arcs.csv\n  \
    stepwave sweep dda-line --to-grid 1..127x1..127 --heat error_mean --plot mean.png\n  \
    stepwave sweep dda-line --to-grid 0..4095x0..4095 --samples 5000 --seed 7 --csv -\n\
    \n\
    Geometries. A grid gives a geometry for every point; of arcs, helices and conics those of its\n\
    points that lie within 1 BLU of the curve, arcs and helices with --tolerance also farther off: the\n\
    arc is then one about the nearest whole centre, as in `stepwave run`. Grids of start points and of end points make a product.\n\
    Without an end point an arc or ellipse is a whole one. Ranges are FIRST..LAST or FIRST..LAST/STEP,\n\
    both ends in them.\n\
    \n\
    Hardware choices. Each takes a list with commas, numbers also ranges; every value of each goes with\n\
    every value of the others. Without --width each geometry has the least widths that hold it, as in\n\
    `stepwave run`. Data sampling has a clock of 1 MHz.\n\
    \n\
    Rows. One a run: index (all points of the grid count, those without a curve too), geometry, choices,\n\
    ending (done, trapped, stalled, limit, refused), clocks, steps, pulses and end point of each axis,\n\
    whether that is exact, error_max and error_mean (BLU, behind all steps), overflows and the first\n\
    overflow's component, spacing_min and spacing_max (clocks between two pulses of an axis), and the\n\
    reason of a refusal. Rows are the same, byte for byte, whatever the number of threads\n\
    (RAYON_NUM_THREADS).\n\
    \n\
    A sweep that was killed leaves its rows beside the final file; the same words with --resume go on.\n\
    The exit code is 0 whatever the rows say.")]
pub(crate) struct SweepArgs {
    #[command(subcommand)]
    pub(crate) command: Option<SweepCommand>,
    /// The model; `stepwave list` shows them
    #[arg(required = true, value_parser = model_name(), hide_possible_values = true)]
    pub(crate) model: Option<String>,
    #[command(flatten)]
    pub(crate) space: SpaceArgs,
    #[command(flatten)]
    pub(crate) variants: VariantArgs,
    #[command(flatten)]
    pub(crate) outputs: TableArgs,
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
    /// Clockwise; together with --ccw both ways
    #[arg(long)]
    pub(crate) cw: bool,
    /// Counter-clockwise
    #[arg(long)]
    pub(crate) ccw: bool,
    /// How far an arc may be left, in BLU: by an end point, whose radius may differ from that of the start by so much more
    /// than rounding makes, and by the chords of a coarse stage
    #[arg(long, value_name = "BLU", value_parser = parse_millionths)]
    pub(crate) tolerance: Option<Millionths>,
    /// So many random ones of the geometries, instead of all
    #[arg(long, value_name = "N", conflicts_with = "file", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) samples: Option<u64>,
    /// Tells this draw of --samples from others
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Geometries from a CSV file: to_x,to_y and what else is not by default (from_x, center_x, direction, …)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["from", "from_grid", "to", "to_grid", "radius", "center", "sizes", "opens", "cw", "ccw"])]
    pub(crate) file: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Hardware choices (lists; each model takes some, `stepwave list` tells which)")]
pub(crate) struct VariantArgs {
    /// Widths of all magnitude registers, or of single ones: 8..12, or 8,f=9..11
    #[arg(long, value_name = "LIST", hide_possible_values = true)]
    #[arg(value_parser = listed(StringValueParser::new(), all_widths()))]
    pub(crate) width: Option<String>,
    /// Start values of the remainder registers: zero,half,full or numbers
    #[arg(long, value_name = "LIST", value_parser = words(&["zero", "half", "full"]), hide_possible_values = true)]
    pub(crate) preset: Option<String>,
    /// Left-shift normalisation: no,yes
    #[arg(long, value_name = "LIST", num_args = 0..=1, default_missing_value = "yes", value_parser = words(&["no", "yes"]), hide_possible_values = true)]
    pub(crate) normalize: Option<String>,
    /// Number systems: 2,10
    #[arg(long, value_name = "LIST", value_parser = list_of::<Radix>(), hide_possible_values = true)]
    pub(crate) radix: Option<String>,
    /// Adders: parallel,serial
    #[arg(long, value_name = "LIST", value_parser = list_of::<Adder>(), hide_possible_values = true)]
    pub(crate) adder: Option<String>,
    /// What ends a block: total,per-axis,longest,iterations
    #[arg(long, value_name = "LIST", value_parser = list_of::<EndPoint>(), hide_possible_values = true)]
    pub(crate) end_point: Option<String>,
    /// How the deviation of a line is kept: magnitude,signed
    #[arg(long, value_name = "LIST", value_parser = list_of::<Form>(), hide_possible_values = true)]
    pub(crate) form: Option<String>,
    /// Interval weights: mid,pre,post
    #[arg(long, value_name = "LIST", value_parser = list_of::<Weights>(), hide_possible_values = true)]
    pub(crate) weights: Option<String>,
    /// Clocks of a step: 4,1
    #[arg(long, value_name = "LIST", value_parser = list_of::<Beats>(), hide_possible_values = true)]
    pub(crate) beats: Option<String>,
    /// Feed overrides in percent, or none
    #[arg(long = "override", value_name = "LIST")]
    pub(crate) feed_override: Option<String>,
    /// Bits of each unit of a cascaded pulse multiplier, or none
    #[arg(long, value_name = "LIST")]
    pub(crate) cascade: Option<String>,
    /// Comparisons of a counter: ge,gt
    #[arg(long, value_name = "LIST", value_parser = list_of::<Compare>(), hide_possible_values = true)]
    pub(crate) compare: Option<String>,
    /// Bits of the phase accumulator whose changes are steps
    #[arg(long, value_name = "LIST")]
    pub(crate) pick_off: Option<String>,
    /// Times of step and direction outputs; may be repeated
    #[arg(long, value_name = "NAME=CLOCKS,…", value_parser = parse_timing)]
    pub(crate) timing: Vec<StepTiming>,
    /// Systems of data sampling: 7m,7360
    #[arg(long, value_name = "LIST", value_parser = list_of::<System>(), hide_possible_values = true)]
    pub(crate) system: Option<String>,
    /// Bits of the fraction of coarse points
    #[arg(long, value_name = "LIST")]
    pub(crate) fraction: Option<String>,
    /// Ways of a period of data sampling, in BLU
    #[arg(long, value_name = "LIST")]
    pub(crate) step: Option<String>,
    /// What cells do that must not overflow: trap,saturate,wrap
    #[arg(long, value_name = "LIST", value_parser = list_of::<OnOverflow>(), hide_possible_values = true)]
    pub(crate) on_overflow: Option<String>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Simulation and outputs (- is standard output)")]
pub(crate) struct TableArgs {
    /// A run that is not done after so many clocks is given up
    #[arg(long, value_name = "CLOCKS", default_value_t = (1 << 31) - 1,
        value_parser = clap::value_parser!(u64).range(1..=(1 << 31) - 1))]
    pub(crate) max_clocks: u64,
    /// Write the rows as CSV
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Csv]))]
    pub(crate) csv: Option<PathBuf>,
    /// Write the rows as Parquet
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Parquet]))]
    pub(crate) parquet: Option<PathBuf>,
    /// Column that --plot shows [default: error_max]
    #[arg(long, value_name = "COLUMN", requires = "plot")]
    pub(crate) heat: Option<String>,
    /// Draw a heat map over the grid, as PNG if the name ends in .png, else as SVG; of several runs of a point the greatest
    /// number shows; may be repeated
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Svg, Format::Png]))]
    pub(crate) plot: Vec<PathBuf>,
    /// Go on with what a killed sweep of the same words has left beside the final file; with nothing left, begin
    #[arg(long)]
    pub(crate) resume: bool,
    /// Do part I of N only: every N-th geometry, from the I-th on
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(crate) shard: Option<[u64; 2]>,
}
