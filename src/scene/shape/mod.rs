//! Named shapes as triangle meshes: unit normals, uvs in [0, 1], triangles counter-clockwise seen from outside, y up.
//!
//! | shape | where it lies |
//! |---|---|
//! | `quad`, `disk` | centred at the origin in the plane y = 0, facing +y |
//! | `cuboid`, `sphere_mesh`, `torus` | centred at the origin, the torus around the y axis |
//! | `cylinder`, `cone`, `lathe`, `teapot` | around the y axis; the first two and the teapot stand on y = 0 |
//! | `height_field`, `terrain` | centred over the origin, heights along y |
//! | `sphereflake`, `hairball` | around the origin |
//! | `teapot_field` | on y = 0, centred on the origin |
//!
//! Vertices are computed in f64, transcendental functions by `libm`, and rounded once, so the meshes are the same bits
//! on every machine. Vertices along creases and texture seams are doubled, at bit-equal positions.
//!
//! Sizes are finite and positive and segment counts lie between the bounds given below; a reader of user input checks
//! that first (sizes by `check_size`). Shapes made from user data return the reason for a refusal instead.

mod flat;
mod grid;
mod hairball;
mod height_field;
mod lathe;
mod noise;
mod normals;
mod round;
mod sphereflake;
mod teapot;
mod teapot_data;
mod teapots;
mod terrain;

pub use flat::{cuboid, quad};
pub use hairball::hairball;
pub use height_field::{HeightGrid, height_field};
pub use lathe::{Profile, ProfileKind, lathe};
pub use noise::fractal_heights;
pub use normals::{BY_CREASE, compute_group_normals, compute_smooth_normals, repair_normals};
pub use round::{cone, cylinder, disk, polar_disk, sphere_mesh, torus};
pub use sphereflake::{SPHEREFLAKE_LEVELS, sphereflake};
pub use teapot::{TEAPOT_PATCHES, teapot, teapot_control_points};
pub use teapots::{TEAPOTS_MAX, field_size, teapot_field};
pub use terrain::{TRIANGLES_MAX, terrain};

/// Fewest segments around an axis.
pub const SEGMENTS_MIN: u32 = 3;
/// Most segments along any direction of a shape: 2^12 squared cells are 33 million triangles.
pub const SEGMENTS_MAX: u32 = 4096;

/// `size`, if it is a length a shape can have.
pub fn check_size(size: f64) -> Result<f64, String> {
    if (1e-30..=1e30).contains(&size) {
        return Ok(size);
    }
    Err(format!("a size of {size}; allowed are 1e-30 to 1e30"))
}
