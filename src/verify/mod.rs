//! Proofs that a device computes what it must.

pub mod inputs;
pub mod probe;
pub mod twins;
