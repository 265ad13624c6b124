//! Proofs at every width at once: netlists of several k as one [`Family`], read as whole numbers.
//!
//! Every register is read as a whole number, every operator as what it does to numbers: up to the first overflow that
//! is the netlist bit by bit. One step is followed along all its paths from *any* state in which the invariants hold;
//! what is left to show are contradictions between polynomials, and each is certified by a sum that is checked in exact
//! arithmetic (`farkas`). Looked for are such sums in floating point (`simplex`), but nothing that was found there
//! counts.
//!
//! ```text
//! netlists of several k ──► Family ──┐
//! case: symbols, words, goals ──► System ──► obligations ──► paths ──► contradictions ──► certificate
//! rows of recorded runs ──► infer ──► invariants ─┘
//! ```
//!
//! Invariants come from the author of the netlist ([`Netlist::invariants`](stepwave_netlist::Netlist)) and from
//! recorded runs. None is believed: each must hold when the block is loaded, and after every step.

mod certificate;
mod decisions;
mod exact;
mod family;
mod farkas;
mod infer;
mod invariant_states;
mod obligations;
mod path;
mod poly;
mod proof;
#[cfg(test)]
pub(crate) mod random;
mod refute;
mod simplex;
mod system;
mod variables;

pub use certificate::{Certificate, CertificateError};
pub use family::{Family, FamilyError};
pub use infer::fit;
pub use invariant_states::InvariantStates;
pub use proof::{Proof, Row, check, prove, violated};
pub use system::{Case, CaseError};
