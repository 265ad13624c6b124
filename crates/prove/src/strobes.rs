//! What of a netlist a proof follows.

use stepwave_netlist::Net;

/// Nets, 1 bit each, by which the prover follows a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strobes {
    /// Input: this edge loads a block.
    pub load: Net,
    /// Input: this edge presets the positions too.
    pub preset_position: Net,
    /// A block has been loaded.
    pub loaded: Net,
    /// A step was completed.
    pub stepped: Net,
    /// The block has ended.
    pub done: Net,
}
