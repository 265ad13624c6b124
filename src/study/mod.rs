//! Studies of many geometries: proofs.

pub mod proof;
