//! The command line of `prove`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::HardwareArgs;
use super::endings::{Format, file_of};
use super::names::{all_widths, listed, model_name};
use super::values::{Narrower, parse_narrower};

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(
    after_help = "Verdicts: PROVED for all k, or at the k that are named; COUNTEREXAMPLE, replayed by the simulator, with the command that shows\n\
    it; NOT INDUCTIVE, with a step from a state that the invariants allow and that may be unreachable; UNKNOWN, with what\n\
    was tried. Exit code 0 only where everything is proved.\n\n\
    Examples:\n  \
    stepwave prove ppc-line\n  \
    stepwave prove ppc-line --narrower f=1 --vcd trap.vcd\n  \
    stepwave prove dda-line --preset half --certificate line.cert\n  \
    stepwave prove dpm-line --bits 12\n  \
    stepwave prove check line.cert"
)]
pub(crate) struct ProveArgs {
    #[command(subcommand)]
    pub(crate) check: Option<ProveCommand>,
    /// The model; `stepwave list` shows them
    #[arg(required = true, value_parser = model_name(), hide_possible_values = true)]
    pub(crate) model: Option<String>,
    #[command(flatten)]
    pub(crate) hardware: HardwareArgs,
    /// Take registers by so many bits narrower than by default: f=1
    #[arg(long, value_name = "REGISTER=BITS,…", hide_possible_values = true)]
    #[arg(value_parser = listed(parse_narrower, all_widths()))]
    pub(crate) narrower: Vec<Narrower>,
    /// Ask an SMT solver too, which reads SMT-LIB 2 from its input, about every geometry of --bits (default 2): 'z3 -in'
    #[arg(long, value_name = "COMMAND")]
    pub(crate) solver: Option<String>,
    /// Bits of coordinates, for --solver and for models that are proved at one width at a time (default: 1 to 16)
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=20))]
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
    /// Tell the invariants that were proved, and the paths on which something could not be shown
    #[arg(long)]
    pub(crate) details: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ProveCommand {
    /// Check a certificate alone: nothing is searched for, every step is multiplied out in exact arithmetic
    Check {
        /// The certificate
        file: PathBuf,
    },
}
