//! `Scene` to `SceneData`: the only folder that knows obvhs.

pub mod data;
pub mod srgb;

pub use data::SceneData;
