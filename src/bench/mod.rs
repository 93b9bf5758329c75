//! Throughput: the same rays on every backend, their hits verified bit for bit, their times told honestly.
//!
//! `rays` makes the rays once, on the CPU, with the renderer's own twins; `tracer` traces arrays of them on a backend;
//! `run` interleaves warm-up and timed runs; `image` does the same with whole samples; `stats` and `report` say what
//! was measured; `hierarchy` what was traced through; `export` hands the same work to other ray tracers.

pub mod export;
pub mod hierarchy;
pub mod image;
pub mod rays;
pub mod report;
pub mod run;
pub mod stats;
pub mod table;
pub mod tracer;
