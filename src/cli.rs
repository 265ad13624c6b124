//! The command line: what may be written, and how it is explained. Manual pages and completions come from it too.

use std::ffi::OsString;
use std::path::PathBuf;

use crate::models::Millionths;
use crate::nc::{Drawn, NURBS_DEGREE, Opens, SplineForm};
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::commands::diff::DiffArgs;

mod endings;
mod hardware;
mod lone;
mod machine;
mod names;
mod of_model;
mod own;
mod program;
mod proof;
mod run;
mod show;
mod signs;
mod sweep;
mod titled;
mod usage;
mod values;
mod widths;

use crate::simulation::FileOptions;
use crate::waves::{Viewer, WaveOptions};
pub(crate) use endings::{Format, OutputArgs, ShownArgs, by_ending, file_of};
pub(crate) use hardware::HardwareArgs;
pub(crate) use machine::{MachineArgs, Travel};
use names::model_name;
pub(crate) use names::{Registers, all_registers, known_register, listed, registers};
pub(crate) use of_model::help_of_model;
pub(crate) use own::{BenchArgs, CheckArgs, ImportArgs, SimArgs};
use program::MethodParser;
pub(crate) use program::{Method, ProgramArgs, TextArgs, Tool};
pub(crate) use proof::{ProveArgs, ProveCommand};
pub(crate) use run::MachineRun;
pub(crate) use show::{ShowArgs, by_value, one_axis};
pub(crate) use signs::with_signs;
pub(crate) use sweep::{SpaceArgs, SweepArgs, SweepCommand, TableArgs, VariantArgs};
pub(crate) use titled::Titled;
pub(crate) use usage::usage;
pub(crate) use values::{ClockArgs, Point, SimulationArgs, one_of, parse_decimals, parse_point, whole};
pub(crate) use widths::WidthsArgs;

/// Cycle-accurate simulator of numerical-control interpolator hardware
#[derive(Debug, Parser)]
#[command(version, about, max_term_width = 100)]
#[command(after_help = "Exit codes: 0 done and good; 1 the simulated hardware failed a check or a comparison \
                        differs; 2 bad input, or a file cannot be read or written.")]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

impl Cli {
    /// What the words say.
    ///
    /// # Errors
    /// They are not a command line, or ask for help.
    pub(crate) fn of(words: &[OsString]) -> Result<Cli, clap::Error> {
        let mut program = Cli::command();
        let mut matches = program.try_get_matches_from_mut(words)?;
        lone::check(&program, words)?;
        Cli::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut program))
    }
}

// The options of a command are built where it is on the line: all of them take longer than a short run.
#[derive(Debug, Subcommand)]
#[command(defer = true)]
pub(crate) enum Command {
    /// Every model: name, method, curves, registers with default widths, options
    List(Titled<ListArgs>),
    /// Build a model's netlist, simulate it clock by clock, write waves, step table, report, picture
    Run(Box<Titled<RunArgs>>),
    /// A whole NC program through one machine: compensation, block buffer, feed; one wave, one step table, one report
    Program(Box<Titled<ProgramArgs>>),
    /// Many geometries and hardware choices, a row each: clocks, path error, overflow; CSV, Parquet and heat maps
    Sweep(Box<Titled<SweepArgs>>),
    /// Every method on one curve: steps, clocks, greatest error, widest register
    Compare(Box<Titled<CompareArgs>>),
    /// The least width of every register over a box of geometries, how it is known, and what happens one bit below
    Widths(Box<Titled<WidthsArgs>>),
    /// What a machine of a given size takes by each method: widths, clock, feed, path error
    Machine(Box<Titled<MachineArgs>>),
    /// Prove, for all geometries and widths: no register overflows, the end point is reached exactly
    Prove(Box<Titled<ProveArgs>>),
    /// First divergence of two wave files (VCD or FST, ours or anybody's)
    Diff(Titled<DiffArgs>),
    /// A wave in the terminal: VCD or FST, ours or anybody's, or that of the run of a model
    Show(Box<Titled<ShowArgs>>),
    /// Write a machine as Verilog, with a test bench that runs the geometry, or for model checkers and solvers
    Export(Box<Titled<ExportArgs>>),
    /// A design of one's own, in Verilog or VHDL, as a netlist
    Import(Box<Titled<ImportArgs>>),
    /// Every mistake of a netlist in the text form
    Check(Titled<CheckArgs>),
    /// Run a netlist by values of its inputs, clock by clock: wave and report
    Sim(Box<Titled<SimArgs>>),
    /// Re-simulate the recorded cases of a folder and compare bit by bit
    #[command(subcommand)]
    Golden(GoldenCommand),
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write manual pages for every command into a folder
    Man {
        /// The folder
        #[arg(default_value = ".")]
        dir: PathBuf,
    },
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stepwave list\n  stepwave list ppc-arc dda-arc\n  stepwave list dda-line --json")]
pub(crate) struct ListArgs {
    /// These models alone
    #[arg(value_parser = model_name(), hide_possible_values = true)]
    pub(crate) models: Vec<String>,
    /// As JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    stepwave compare --to 100,62\n  \
    stepwave compare --from 100,0 --to 0,100 --ccw --markdown\n  \
    stepwave compare dda-line dda.net --to 100,62")]
pub(crate) struct CompareArgs {
    /// Models to compare; netlists of one's own alone are compared with all models [default: all]
    #[arg(value_parser = model_name(), hide_possible_values = true)]
    pub(crate) models: Vec<String>,
    #[command(flatten)]
    pub(crate) bench: BenchArgs,
    #[command(flatten)]
    pub(crate) geometry: GeometryArgs,
    /// How far an end point may leave an arc: its radius may differ from that of the start by so many BLU more than
    /// rounding makes
    #[arg(long, value_name = "BLU", value_parser = values::parse_millionths)]
    pub(crate) tolerance: Option<Millionths>,
    /// A run that is not done after so many clocks is given up, and its row says so
    #[arg(long, value_name = "CLOCKS", default_value = "1000000000", value_parser = values::whole::<u64>(1..))]
    pub(crate) max_clocks: u64,
    /// A run that takes longer is given up, and its row says so
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = values::whole::<u64>(1..))]
    pub(crate) max_seconds: u64,
    /// As a Markdown table
    #[arg(long)]
    pub(crate) markdown: bool,
    /// Write a page that shows the path and the wave of every method, for a browser
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Html]), help_heading = "Outputs (- is standard output)")]
    pub(crate) html: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum GoldenCommand {
    /// Simulate every case anew and compare with its recorded files; exit 1 at a difference
    Check(GoldenArgs),
    /// Simulate every case and write its files
    Record(GoldenArgs),
}

/// The form of cases.toml.
const CASES: &str = "cases.toml lists the cases, each of them so:\n\n  \
    [[case]]\n  \
    name = \"line\"                      # of its files: line.vcd, line.gtkw, line.*.states, line.csv\n  \
    args = [\"ppc-line\", \"--to\", \"6,4\"]  # of `stepwave run`, without outputs\n  \
    source = \"where it comes from\"     # for readers; may be left out\n  \
    exit = 1                           # the exit code of the run, if not 0\n\n  \
    [[case]]\n  \
    name = \"part\"\n  \
    program = \"part.ngc\"               # an NC program in the folder\n  \
    args = [\"--method\", \"ppc\"]        # of `stepwave program`\n\n\
    Examples:\n  \
    stepwave golden record waves\n  \
    stepwave golden check waves line part";

#[derive(Debug, Args)]
#[command(after_help = CASES)]
pub(crate) struct GoldenArgs {
    /// Folder with cases.toml and the recorded waves
    #[arg(default_value = "waves")]
    pub(crate) dir: PathBuf,
    /// Only these cases
    #[arg(value_name = "CASE")]
    pub(crate) cases: Vec<String>,
    /// Only this case, without naming the folder before it (may be repeated)
    #[arg(long, value_name = "NAME")]
    pub(crate) case: Vec<String>,
    /// Refused: golden waves have the files of one viewer, which are compared too
    #[arg(long, hide = true)]
    pub(crate) viewer: Option<Viewer>,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    stepwave run dda-line --to 8,6 --vcd line.vcd\n  \
    stepwave run ppc-arc --from 5,0 --to 0,5 --ccw --steps - \n  \
    stepwave run ppc-line --to 6,4 --width f=3 --vcd trap.vcd")]
pub(crate) struct RunArgs {
    /// The model; `stepwave list` shows them. Or a netlist of one's own: F.net
    #[arg(value_parser = model_name(), hide_possible_values = true)]
    pub(crate) model: String,
    #[command(flatten)]
    pub(crate) of: MachineRun,
    #[command(flatten)]
    pub(crate) trace: WaveOptions,
    /// Add to the wave testbench.speed_e4, a row that is not of the hardware: v/v_max over the last 32 steps, in 10^-4
    #[arg(long, requires = "wave", help_heading = "Wave")]
    pub(crate) trace_speed: bool,
    #[command(flatten)]
    pub(crate) outputs: FileOptions,
    #[command(flatten)]
    pub(crate) by_ending: ShownArgs,
    /// Show registers in binary in the printed table
    #[arg(long, help_heading = "Outputs (- is standard output)")]
    pub(crate) bits: bool,
    /// Print the table of a DDA arc, conic or helix as textbooks do: in row k the J_V that step k used, not the one after it
    #[arg(long, help_heading = "Outputs (- is standard output)")]
    pub(crate) textbook: bool,
    /// Keep states of the run in this file; where it exists, begin at the last state before --trace-from instead of at
    /// clock 0
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Json]), help_heading = "Wave")]
    pub(crate) checkpoints: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    stepwave export dda-line --to 8,6 --verilog dda_line.v --testbench dda_line_tb.v\n  \
    stepwave export ppc-arc --from 5,0 --to 0,5 --ccw --width 16 --verilog -\n  \
    stepwave export --program part.ngc --method cim --verilog cim.v --testbench cim_tb.v\n\
    The wave of the test bench (Icarus Verilog, Verilator) holds the signals of `run --vcd`, so that\n\
    `stepwave diff` compares them clock by clock; --ignore '*.trap.*' leaves out the operands of a trap.\n\n  \
    stepwave export ppc-line --to 6,4 --width f=3 --smt2 line.smt2 && z3 line.smt2\n  \
    stepwave export ppc-line --to 7,7 --any-geometry=xe,ye --smt2 all.smt2 && cvc5 all.smt2\n\
    `sat` says that a property is violated: a register overflows. Clocks and names are those of `run --vcd`. The files\n\
    hold a loader next to the machine, which loads each block as `run` does.")]
#[command(group(clap::ArgGroup::new("exports").required(true).multiple(true)))]
#[command(group(clap::ArgGroup::new("checked").multiple(true)))]
pub(crate) struct ExportArgs {
    /// The model; `stepwave list` shows them. Or a netlist of one's own: F.net
    #[arg(value_parser = model_name(), hide_possible_values = true)]
    #[arg(required_unless_present = "program")]
    pub(crate) model: Option<String>,
    #[command(flatten)]
    pub(crate) bench: BenchArgs,
    /// An NC program in place of a model and its geometry: the machine of --method, which runs all of it
    #[arg(long, value_name = "FILE", requires = "method", conflicts_with_all = ["model", "any_geometry"])]
    pub(crate) program: Option<PathBuf>,
    /// Family of the machine that runs the program, or a netlist of one's own: F.net
    #[arg(long, requires = "program", conflicts_with = "model", value_parser = MethodParser)]
    pub(crate) method: Option<Method>,
    #[command(flatten)]
    pub(crate) text: TextArgs,
    #[command(flatten)]
    pub(crate) geometry: GeometryArgs,
    #[command(flatten)]
    pub(crate) hardware: HardwareArgs,
    #[command(flatten)]
    pub(crate) clock: ClockArgs,
    #[command(flatten)]
    pub(crate) by_ending: OutputArgs,
    /// Write the netlist in the text form, which `stepwave sim` and `check` read
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Netlist]), group = "exports", help_heading = "Outputs (- is standard output)")]
    pub(crate) netlist: Option<PathBuf>,
    /// Write the netlist as a Verilog module
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Verilog]), group = "exports", help_heading = "Outputs (- is standard output)")]
    pub(crate) verilog: Option<PathBuf>,
    /// Write a Verilog test bench that loads and runs the geometry as `run` does, or the program as `program` does
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Verilog]), group = "exports", help_heading = "Outputs (- is standard output)")]
    pub(crate) testbench: Option<PathBuf>,
    /// Write a module with four pins around the Verilog, for place and route: inputs come from a shift register, outputs go
    /// into a signature register
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Verilog]), group = "exports", help_heading = "Outputs (- is standard output)")]
    #[arg(requires = "verilog")]
    pub(crate) harness: Option<PathBuf>,
    /// Leave the overflow flags out of the ports of the Verilog, so that synthesis leaves out what finds them
    #[arg(long, requires = "verilog")]
    pub(crate) no_flags: bool,
    /// Write the netlist and its properties as BTOR2, for model checkers
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Btor2]), groups = ["exports", "checked"], help_heading = "Outputs (- is standard output)")]
    pub(crate) btor2: Option<PathBuf>,
    /// Write an SMT-LIB 2 script that asks whether a property is violated within --depth clocks, for solvers
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::SmtLib]), groups = ["exports", "checked"], help_heading = "Outputs (- is standard output)")]
    pub(crate) smt2: Option<PathBuf>,
    /// Draw the netlist as a block diagram: scopes as boxes, registers, adders and wires with their widths. A netlist of
    /// one's own is drawn without a bench file and without a geometry too
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Svg]), group = "exports", help_heading = "Outputs (- is standard output)")]
    pub(crate) schematic: Option<PathBuf>,
    /// Draw this scope alone
    #[arg(long, value_name = "PATH", requires = "schematic", help_heading = "Block diagram")]
    pub(crate) scope: Option<String>,
    /// Draw the inside of scopes this many levels deep, those below as boxes [default: as deep as is readable]
    #[arg(long, value_name = "LEVELS", value_parser = values::whole::<usize>(0..), requires = "schematic", help_heading = "Block diagram")]
    pub(crate) levels: Option<usize>,
    /// Leave these load words open, or all: any values, also such as no geometry gives, loaded in the first clock and never
    /// again. What is known of them is for you to add
    #[arg(long, requires = "checked", value_name = "WORDS", help_heading = "Model checking")]
    #[arg(num_args = 0..=1, require_equals = true, default_missing_value = "all", value_delimiter = ',')]
    pub(crate) any_geometry: Vec<String>,
    /// Last clock of the question in --smt2 [default: that of the run, at most 1000]
    #[arg(long, requires = "smt2", value_name = "CLOCKS", help_heading = "Model checking")]
    #[arg(value_parser = values::whole::<u64>(0..=100_000))]
    pub(crate) depth: Option<u64>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Geometry, in BLU")]
pub(crate) struct GeometryArgs {
    /// Start point [default: the origin]
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true, value_parser = values::parse_point)]
    pub(crate) from: Option<Point>,
    /// End point
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true, value_parser = values::parse_point)]
    pub(crate) to: Option<Point>,
    /// Centre of an arc or conic, vertex of a parabola [default: the origin]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = values::parse_point)]
    pub(crate) center: Option<Point>,
    /// Ellipse with these semi-axes along x and y
    #[arg(long, value_name = "A,B", allow_hyphen_values = true, value_parser = values::parse_pair, group = "drawn")]
    pub(crate) ellipse: Option<[i64; 2]>,
    /// Parabola y² = Cx about --center, or one that opens elsewhere
    #[arg(long, value_name = "C", allow_hyphen_values = true, group = "drawn")]
    pub(crate) parabola: Option<i64>,
    /// Branch of the hyperbola x²/A² - y²/B² = 1, or of one that opens elsewhere
    #[arg(long, value_name = "A,B", allow_hyphen_values = true, value_parser = values::parse_pair, group = "drawn")]
    pub(crate) hyperbola: Option<[i64; 2]>,
    /// Bezier curve with these three or four control points
    #[arg(long, value_name = "X0,Y0,X1,Y1,X2,Y2[,X3,Y3]", allow_hyphen_values = true, value_parser = values::parse_point, group = "drawn")]
    pub(crate) bezier: Option<Point>,
    /// Cubic segment from a point with a tangent to a point with a tangent
    #[arg(long, value_name = "X0,Y0,TX0,TY0,X1,Y1,TX1,TY1", allow_hyphen_values = true, value_parser = values::parse_point, group = "drawn")]
    pub(crate) hermite: Option<Point>,
    /// Catmull-Rom spline through the points in a CSV file of x,y, or given as X,Y,X,Y,…
    #[arg(long, value_name = "POINTS", allow_hyphen_values = true, group = "drawn")]
    pub(crate) points: Option<String>,
    /// Uniform cubic B-spline along --points instead
    #[arg(long, requires = "points")]
    pub(crate) b_spline: bool,
    /// NURBS with these control points and weights, or those in a CSV file of x,y,w
    #[arg(long, value_name = "X,Y,W,…|FILE", allow_hyphen_values = true, group = "drawn")]
    pub(crate) nurbs: Option<String>,
    /// Degree of a NURBS [default: 3, or as many as the points allow]
    #[arg(long, requires = "nurbs", value_name = "P", value_parser = values::whole::<u32>(1..=NURBS_DEGREE as u64))]
    pub(crate) degree: Option<u32>,
    /// Knots of a NURBS [default: uniform, those at the ends degree + 1 times]
    #[arg(long, requires = "nurbs", value_name = "U,U,…", allow_hyphen_values = true)]
    pub(crate) knots: Option<String>,
    /// Where a parabola or the branch of a hyperbola opens to [default: where both ends lie on it]
    #[arg(long, value_name = "WHERE", allow_hyphen_values = true, value_parser = values::opens())]
    pub(crate) opens: Option<Opens>,
    /// Clockwise arc (G02, SR); on a parabola or hyperbola the ends alone say the way
    #[arg(long, conflicts_with = "ccw")]
    pub(crate) cw: bool,
    /// Counter-clockwise arc (G03, NR); on a parabola or hyperbola the ends alone say the way
    #[arg(long)]
    pub(crate) ccw: bool,
}

/// What --points is given is the name of a file, not points.
pub(crate) fn names_points(given: &str) -> bool {
    parse_point(given).is_err()
}

/// What --nurbs is given is the name of a file, not points with weights.
pub(crate) fn names_nurbs(given: &str) -> bool {
    parse_decimals(given).is_err()
}

impl GeometryArgs {
    /// The file of points, if one is read.
    pub(crate) fn file(&self) -> Option<PathBuf> {
        let points = self.points.as_ref().filter(|given| names_points(given));
        points.or(self.nurbs.as_ref().filter(|given| names_nurbs(given))).map(PathBuf::from)
    }

    /// What is drawn, where an option says it.
    pub(crate) fn drawn(&self) -> Option<Drawn> {
        let through = if self.b_spline { SplineForm::BSpline } else { SplineForm::CatmullRom };
        let given = [
            self.ellipse.map(|_| Drawn::Ellipse),
            self.parabola.map(|_| Drawn::Parabola(self.opens)),
            self.hyperbola.map(|_| Drawn::Hyperbola(self.opens)),
            self.bezier.as_ref().map(|_| Drawn::Spline(SplineForm::Bezier)),
            self.hermite.as_ref().map(|_| Drawn::Spline(SplineForm::Hermite)),
            self.points.as_ref().map(|_| Drawn::Spline(through)),
            self.nurbs.as_ref().map(|_| Drawn::Nurbs),
        ];
        given.into_iter().flatten().next()
    }
}
