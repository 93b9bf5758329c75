//! gonio: the same scene, seed and sample count give the same bits on every device.
//!
//! One way through the house (ARCHITECTURE.md):
//! scene file -> `scene` -> `bake` -> `render` (schedules `transport`) -> `film` -> image, report.

pub mod bake;
pub mod cli;
pub mod film;
pub mod layout;
pub mod render;
pub mod scene;
pub mod shaders;
pub mod shading;
pub mod trace;
pub mod transport;
pub mod verify;
