//! Proofs about netlists: that registers are wide enough and that the goals hold, for every geometry of a box.
//!
//! There are three kinds. [`polynomial`] reads every register as a whole number and proves *every width at once*, with a
//! certificate that is checked without a search; it is the one to try first. [`bitwise`] follows the bits of *one
//! width*, clock by clock, for machines whose counters run by themselves. [`sat`] takes any netlist at its own widths.
//!
//! A down-counter of two bits, from netlist to certificate: for every load it never counts below 0 and it ends.
//!
//! ```
//! use stepwave_netlist::formula::{Symbol, name, number};
//! use stepwave_netlist::{dsl::Module, elaborate};
//! use stepwave_prove::{Case, Certificate, Family, Row, Strobes, check, prove};
//!
//! let module = Module::new("counter");
//! let m = module.top();
//! let (load, preset_position, start) = (m.input("load", 1), m.input("preset_position", 1), m.input("start", 2));
//! let (count, loaded, stepped) = (m.reg("count", 2), m.reg("loaded", 1), m.reg("stepped", 1));
//! let busy = !count.q.is_zero();
//! let next = count.q.strict_sub(m.lit(2, 1), busy & !load);
//! count.when(load, start).when(busy, next).else_hold();
//! loaded.set(load);
//! stepped.set(busy & !load);
//! let done = m.name("done", !busy);
//! m.between_steps("running", [name("count") - 1]);
//!
//! let strobes = Strobes {
//!     load: load.net(),
//!     preset_position: preset_position.net(),
//!     loaded: loaded.q.net(),
//!     stepped: stepped.q.net(),
//!     done: done.net(),
//! };
//! let design = elaborate(module.finish().unwrap()).unwrap();
//!
//! let case = Case {
//!     name: "any start".to_owned(),
//!     symbols: vec![Symbol { name: "n".to_owned(), least: number(1), greatest: number(3) }],
//!     words: vec![("start".to_owned(), name("n"))],
//!     rank: Some(name("count")), // falls with every step, and is never below 0
//!     ..Case::default()
//! };
//! let family = Family::single(&design, 2);
//! // One state of a recorded run, as an engine shows it: n = 3, and the registers right after the load.
//! let rows = [Row { k: 2, symbols: vec![3], registers: vec![3, 1, 0], steps: 0 }];
//! let (proof, certificate) = prove(&family, strobes, &case, &rows).unwrap();
//! assert!(proof.holds(), "{proof:#?}");
//!
//! // The certificate is text; checking it multiplies out its sums and needs no search.
//! let certificate: Certificate = certificate.to_string().parse().unwrap();
//! assert!(check(&family, strobes, &case, &certificate).unwrap().holds());
//! ```

pub mod bitwise;
pub mod polynomial;
pub mod sat;
mod strobes;

pub use bitwise::{AxisNets, Followed, KnownSample, LoadWord, Lost, Sum, follow, recount};
pub use polynomial::{
    Case, CaseError, Certificate, CertificateError, Family, FamilyError, InvariantStates, Proof, Row, check, fit,
    prove, violated,
};
pub use strobes::Strobes;
