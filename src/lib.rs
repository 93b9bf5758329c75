//! gonio: the same scene, seed and sample count give the same bits on every device.
//!
//! One way through the house (ARCHITECTURE.md):
//! scene file -> `scene` -> `bake` -> `render` (schedules `transport`) -> `film` -> image, report.

pub mod bake;
pub mod bench;
pub mod cli;
pub mod film;
pub mod layout;
pub mod memory;
pub mod picture;
pub mod plot;
pub mod render;
pub mod scene;
pub mod shaders;
#[cfg_attr(not(test), deny(clippy::disallowed_methods, clippy::disallowed_types))]
pub mod shading;
#[cfg_attr(not(test), deny(clippy::disallowed_methods, clippy::disallowed_types))]
pub mod trace;
#[cfg_attr(not(test), deny(clippy::disallowed_methods, clippy::disallowed_types))]
pub mod transport;
pub mod verify;
pub mod watch;
