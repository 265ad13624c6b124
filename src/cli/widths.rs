//! The command line of `widths`.

use clap::Args;

use crate::study::Extent;

use super::names::model_name;
use super::{BenchArgs, HardwareArgs};

#[derive(Debug, Args)]
#[command(after_help = "How a width is known to be enough:\n  \
    proved      for every k, by the method of `stepwave prove`, with all registers as narrow at once\n  \
    proved at k at this k alone\n  \
    exhaustive  every geometry of the box was simulated, to its end\n  \
    12 of 16    every one was, but only 12 of 16 ran to their end: nothing is known of the others, which overflow or never end\n  \
    sampled     the extreme ones were, or their first clocks: corners, axes and next to them, greatest radii, largest and smallest weights\n  \
    enough      proved to be enough, but perhaps not least: the last column says how many bits a run needs\n\n\
    The command in the last column shows what happens one bit below.\n\n\
    --width N and --width REGISTER=N,… are the hardware that is judged: the column `given`. Where one is less than needed,\n\
    the run that shows it is named and the exit code is 1. Without --width, `given` is the default. What is needed\n\
    depends neither on that nor on --on-overflow, but for integrators (jv, jr) and the accumulations of stepgen (e): their\n\
    width is the scale of the run.\n\n\
    Examples:\n  \
    stepwave widths ppc-line --box 8\n  \
    stepwave widths ppc-line --box 0..300000x0..200000\n  \
    stepwave widths ppc-arc --box 20 --width f=21\n  \
    stepwave widths dda-line --box 0..200x-50..50\n  \
    stepwave widths cim-conic --box 4\n  \
    stepwave widths bresenham --box 6 --json")]
pub(crate) struct WidthsArgs {
    /// The model; `stepwave list` shows them. Or a netlist of one's own: F.net
    #[arg(value_parser = model_name(), hide_possible_values = true)]
    pub(crate) model: String,
    #[command(flatten)]
    pub(crate) bench: BenchArgs,
    /// Bits of the coordinates, or a range for each axis (0..255x0..255): every line from the origin to such a point, or
    /// every arc inside a quadrant with both ends on the circle; in bits also every helix over such an arc, and every
    /// quarter of an ellipse with such semi-axes and every arc of a parabola or hyperbola from or to the vertex, and
    /// every cubic Bezier curve of such control points, an axis at a time; of sampled-spline extreme ones of these
    #[arg(long = "box", value_name = "BITS|RANGExRANGE", allow_hyphen_values = true)]
    pub(crate) extent: Extent,
    #[command(flatten)]
    pub(crate) hardware: HardwareArgs,
    /// As JSON
    #[arg(long)]
    pub(crate) json: bool,
}
