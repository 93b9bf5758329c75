//! Proofs that a device computes what it must, and that what it computes is right.

pub mod inputs;
pub mod mitsuba;
pub mod probe;
pub mod report;
pub mod twins;
