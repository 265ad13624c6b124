//! The command line of `prove`.

use std::path::PathBuf;

use crate::Error;
use crate::models::Model;
use crate::models::options::WRAPS;
use crate::study::Extent;
use crate::study::proof::symmetric_box;
use clap::{Args, Subcommand};

use super::endings::{Format, file_of};
use super::names::{all_widths, listed, model_name};
use super::values::{self, Narrower, parse_narrower, whole};
use super::{BenchArgs, HardwareArgs, ShownArgs};
use crate::waves::{Viewer, WaveOptions};

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(
    after_help = "Of hardware as it is by default, or so many bits narrower (--narrower), the verdict is about every k, the bits of\n\
    coordinates. With --width, --box or --travel it is about one hardware and the geometries of one box.\n\n\
    Verdicts: PROVED for all k, at the k that are named, or at these widths, there also by simulating every geometry of the\n\
    box (exhausted); COUNTEREXAMPLE, replayed by the simulator, with the command that shows it; NOT INDUCTIVE, with a step\n\
    from a state that the invariants allow and that may be unreachable; UNKNOWN, with what was tried. Where an overflow is\n\
    not excluded, nothing is called proved that holds only without one.\n\n\
    Exit codes: 0 all that the model claims is proved; 1 it is refuted, or a part is not proved; 2 bad input. What a model\n\
    does not claim is named and changes nothing. `prove check` ends likewise: 1 also for a certificate of a part.\n\n\
    Examples:\n  \
    stepwave prove ppc-line\n  \
    stepwave prove ppc-line --narrower f=1 --vcd trap.vcd --open\n  \
    stepwave prove ppc-line --width 12,f=14 --travel 1000,600\n  \
    stepwave prove dda-line --preset half --certificate line.cert\n  \
    stepwave prove dpm-line --bits 12\n  \
    stepwave prove check line.cert\n  \
    stepwave prove dda.net --set rst=0 --stimulus-out example.csv\n\n\
    Of a netlist (a path that ends in .net or holds a /) every property is decided at its own widths: that no operator loses a\n\
    carry that is not announced, and every assertion. Inputs take any value in every clock, but for those of --set, of\n\
    --stimulus, and of the reset and the constants of a bench file (F.toml next to F.net, or --bench; --no-bench leaves it out). A counterexample has the fewest clocks; `stepwave sim F.net --stimulus example.csv` shows it again. With --box or --travel, and a\n\
    bench file, every geometry of the box is run: stepwave prove dda.net --box 0..50x0..50"
)]
pub(crate) struct ProveArgs {
    #[command(subcommand)]
    pub(crate) check: Option<ProveCommand>,
    /// The model; `stepwave list` shows them. Or a netlist: F.net
    #[arg(required = true, value_parser = model_name(), hide_possible_values = true)]
    pub(crate) model: Option<String>,
    #[command(flatten)]
    pub(crate) bench: BenchArgs,
    #[command(flatten)]
    pub(crate) netlist: NetlistProofArgs,
    #[command(flatten)]
    pub(crate) hardware: HardwareArgs,
    /// Take registers by so many bits narrower than by default: f=1
    #[arg(long, value_name = "REGISTER=BITS,…", hide_possible_values = true)]
    #[arg(value_parser = listed(parse_narrower, all_widths()))]
    pub(crate) narrower: Vec<Narrower>,
    /// The geometries: those of coordinates of so many bits, or with ends in a range for each axis, as `stepwave widths` has
    /// them [default: those of --width N, else of every number of bits]
    #[arg(long = "box", value_name = "BITS|RANGE[xRANGE]", allow_hyphen_values = true)]
    pub(crate) extent: Option<Extent>,
    /// The geometries: those with ends within ±X and ±Y (default: X), in whole BLU
    #[arg(long, value_name = "X[,Y]", conflicts_with = "extent", allow_hyphen_values = true, value_parser = parse_travel)]
    pub(crate) travel: Option<Travel>,
    /// Ask an SMT solver too, which reads SMT-LIB 2 from its input, about every geometry of --bits (default 2): 'z3 -in'.
    /// Of a netlist: the questions that the verdicts rest on
    #[arg(long, value_name = "COMMAND")]
    pub(crate) solver: Option<String>,
    /// Seconds after which the solver is stopped, for each question
    #[arg(long, value_name = "SECONDS", default_value_t = 60, requires = "solver")]
    #[arg(value_parser = whole::<u64>(1..=86_400))]
    pub(crate) solver_seconds: u64,
    /// Bits of coordinates, for --solver and for models that are proved at one width at a time (default: 1 to 16)
    #[arg(long, value_name = "K", value_parser = whole::<u32>(1..=20))]
    pub(crate) bits: Option<u32>,
    /// Let remainder registers start from any value, not only from --preset
    #[arg(long, conflicts_with = "preset")]
    pub(crate) any_preset: bool,
    /// Write the proof for `stepwave prove check`
    #[arg(long, value_name = "FILE", value_parser = file_of(&[]))]
    pub(crate) certificate: Option<PathBuf>,
    /// Write the wave of a counterexample, or of a step that keeps the proof from being one, as VCD
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Vcd]))]
    pub(crate) vcd: Option<PathBuf>,
    /// The viewer whose files are written next to the wave [default: gtkwave]
    #[arg(long, requires = "vcd", value_name = "VIEWER")]
    pub(crate) viewer: Option<Viewer>,
    #[command(flatten)]
    pub(crate) by_ending: ShownArgs,
    /// Tell the invariants that were proved, and the paths on which something could not be shown
    #[arg(long, help_heading = None)]
    pub(crate) details: bool,
}

/// What is asked of a netlist.
#[derive(Debug, Args)]
#[command(next_help_heading = "Netlists")]
pub(crate) struct NetlistProofArgs {
    /// Prove only properties with this name, or path (may be repeated)
    #[arg(long, value_name = "GLOB")]
    pub(crate) goal: Vec<String>,
    /// A constant on an input (may be repeated)
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true, value_parser = values::parse_setting)]
    pub(crate) set: Vec<(String, String)>,
    /// Values of inputs in the first clocks, as CSV: its inputs have them in its rows, and are free after the last
    #[arg(long, value_name = "FILE")]
    pub(crate) stimulus: Option<PathBuf>,
    /// Hold this input of --stimulus at the value of the last row (may be repeated)
    #[arg(long, value_name = "GLOB", requires = "stimulus")]
    pub(crate) hold: Vec<String>,
    /// The last clock in which a violation is looked for [default: none]
    #[arg(long, value_name = "CLOCK", value_parser = whole::<u64>(0..))]
    pub(crate) bound: Option<u64>,
    /// Seconds after which the search ends [default: 60]
    #[arg(long, value_name = "SECONDS", value_parser = whole::<u64>(1..=864_000))]
    pub(crate) time: Option<u64>,
    /// Memory at which the search ends [default: 4096]
    #[arg(long, value_name = "MB", value_parser = whole::<u64>(16..=65_536))]
    pub(crate) memory: Option<u64>,
    /// Write the inputs of the first counterexample as a stimulus of `stepwave sim`
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Csv]))]
    pub(crate) stimulus_out: Option<PathBuf>,
    /// Look at runs that the bench file next to the netlist does not allow, too
    #[arg(long, conflicts_with = "bench")]
    pub(crate) no_bench: bool,
    /// The command of --solver reads clauses in the form of DIMACS, as SAT solvers do, and not SMT-LIB 2
    #[arg(long, requires = "solver")]
    pub(crate) dimacs: bool,
    /// Write the verdicts as JSON
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Json]))]
    pub(crate) json: Option<PathBuf>,
}

impl NetlistProofArgs {
    /// The first option that is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            (!self.goal.is_empty(), "--goal"),
            (!self.set.is_empty(), "--set"),
            (self.stimulus.is_some(), "--stimulus"),
            (self.bound.is_some(), "--bound"),
            (self.time.is_some(), "--time"),
            (self.memory.is_some(), "--memory"),
            (self.stimulus_out.is_some(), "--stimulus-out"),
            (self.json.is_some(), "--json"),
            (self.no_bench, "--no-bench"),
            (self.dimacs, "--dimacs"),
        ];
        given.into_iter().find(|(given, _)| *given).map(|(_, option)| option)
    }
}

impl ProveArgs {
    /// The wave of a counterexample, if one is wanted.
    pub(crate) fn waves(&self) -> WaveOptions {
        WaveOptions { vcd: self.vcd.clone(), viewer: self.viewer, ..WaveOptions::default() }
    }

    /// The first option that is given and that only a model takes.
    pub(crate) fn of_models(&self) -> Option<String> {
        let options = self.hardware.choices();
        let option = options.given().iter().map(|value| value.option().name()).find(|name| *name != WRAPS.name);
        let of_proofs = self.of_proofs().filter(|option| *option != "--solver");
        of_proofs.map(str::to_owned).or_else(|| option.map(|name| format!("--{name}")))
    }

    /// The first option that is given and that only proofs of models take.
    pub(crate) fn of_proofs(&self) -> Option<&'static str> {
        let given = [
            (!self.narrower.is_empty(), "--narrower"),
            (self.solver.is_some(), "--solver"),
            (self.bits.is_some(), "--bits"),
            (self.any_preset, "--any-preset"),
            (self.certificate.is_some(), "--certificate"),
            (self.details, "--details"),
        ];
        given.into_iter().find(|(given, _)| *given).map(|(_, option)| option)
    }
}

/// The box of `--travel`: X, or X and Y, in BLU.
#[derive(Clone, Debug)]
pub(crate) struct Travel(Vec<i64>);

fn parse_travel(text: &str) -> Result<Travel, String> {
    let number = |word: &str| {
        let word = word.trim();
        word.parse::<i64>().map_err(|_| format!("invalid travel '{word}': give whole BLU, such as 100 or 100,62"))
    };
    let travel: Vec<i64> = match text.split_once(',') {
        Some((x, y)) => vec![number(x)?, number(y)?],
        None => vec![number(text)?],
    };
    symmetric_box(&travel).map_err(|error| error.to_string())?;
    Ok(Travel(travel))
}

impl ProveArgs {
    /// The box that is given for geometries of this model, by --box or by --travel.
    ///
    /// # Errors
    /// It holds none.
    pub(crate) fn extent_for(&self, model: &Model) -> Result<Option<Extent>, Error> {
        let of_travel = |Travel(travel): &Travel| match travel[..] {
            [x] => symmetric_box(&vec![x; model.curve().max_axes().min(2)]),
            _ => symmetric_box(travel),
        };
        match &self.extent {
            Some(extent) => Ok(Some(extent.clone())),
            None => Ok(self.travel.as_ref().map(of_travel).transpose()?),
        }
    }
}

#[derive(Debug, Subcommand)]
pub(crate) enum ProveCommand {
    /// Check a certificate alone: nothing is searched for, every step is multiplied out in exact arithmetic
    Check {
        /// The certificate
        file: PathBuf,
    },
}
