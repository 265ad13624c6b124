//! Proofs that registers are wide enough, and that what is wanted comes about, for all geometries, and for all widths
//! at once where the netlists are a [`Family`].
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
//! Invariants come from the author of the netlist ([`Netlist::invariants`](crate::Netlist)) and from recorded runs. None
//! is believed: each must hold when the block stands loaded, and behind every step.

mod certificate;
mod counted;
mod decisions;
mod family;
mod farkas;
mod infer;
mod invariant_states;
mod obligations;
mod path;
mod poly;
mod proof;
#[cfg(test)]
mod random;
mod recount;
mod refute;
mod simplex;
mod system;
mod three_valued;
mod variables;

pub use certificate::{Certificate, CertificateError};
pub use counted::{Followed, Lost, Sample, Sum, Word, follow};
pub use family::{Family, FamilyError};
pub use infer::fit;
pub use invariant_states::InvariantStates;
pub use proof::{Proof, Row, check, prove, violated};
pub use recount::{AxisNets, recount};
pub use system::{Case, CaseError, Strobes, Symbol};
