//! `Scene` to `SceneData`: the only folder that knows obvhs.

pub mod data;

pub use data::SceneData;
