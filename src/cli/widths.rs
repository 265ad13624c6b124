//! The command line of `widths`.

use clap::Args;

use super::HardwareArgs;

#[derive(Debug, Args)]
#[command(after_help = "How a width is known to be enough:\n  \
    proved      for every k, by `stepwave prove` with all registers as narrow as the table says\n  \
    exhaustive  every geometry of the box was simulated\n  \
    sampled     some were, the extreme ones among them\n\n\
    The command in the last column shows what happens one bit below.\n\n\
    Examples:\n  \
    stepwave widths ppc-line --box 8\n  \
    stepwave widths bresenham --box 6 --json")]
pub(crate) struct WidthsArgs {
    /// The model; `stepwave list` shows them
    pub(crate) model: String,
    /// Bits of the coordinates: every line from the origin, or every arc inside a quadrant with both ends on the circle
    #[arg(long = "box", value_name = "BITS", value_parser = clap::value_parser!(u32).range(1..=16))]
    pub(crate) bits: u32,
    #[command(flatten)]
    pub(crate) hardware: HardwareArgs,
    /// As JSON
    #[arg(long)]
    pub(crate) json: bool,
}
