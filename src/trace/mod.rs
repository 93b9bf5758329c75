//! Where a ray meets the scene, and how it leaves again.
//!
//! `ray` and `box_` prepare and cull, `triangle` and `sphere` decide, `traverse` walks the two levels of the
//! hierarchy, `surface` says what was hit and `spawn` starts the next ray there.

pub mod box_;
pub mod ray;
pub mod spawn;
pub mod sphere;
pub mod surface;
pub mod tangent;
pub mod traverse;
pub mod triangle;
