//! `Scene` to `SceneData`: the only folder that knows obvhs.

pub mod data;
pub mod filter;

pub use data::SceneData;
