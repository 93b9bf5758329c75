//! Instances: transforms rounded once, world boxes, and the top level's margin.

use super::BakeError;
use super::bvh::Bounds;
use crate::scene::{Transform, WORLD_LIMIT};
use glam::{DAffine3, DMat3, DVec3, Vec3, Vec4};

/// 2^-24, half the spacing of floats at 1.
const U: f64 = 1.0 / 16_777_216.0;

/// Where an object stands, as the traversal sees it.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    pub to_world: [Vec4; 3],
    pub to_object: [Vec4; 3],
    pub mirrored: bool,
    /// Contains every point that a ray can hit, the rounding of its way through object space included.
    pub world: Bounds,
    /// Largest row sum of |to_world| |to_object|, at least 1: how much rounding in object space grows in world space.
    pub growth: f64,
}

fn rows(m: &DAffine3) -> [Vec4; 3] {
    [0, 1, 2].map(|i| {
        let row = m.matrix3.row(i);
        Vec4::new(row.x as f32, row.y as f32, row.z as f32, m.translation[i] as f32)
    })
}

fn from_rows(rows: &[Vec4; 3]) -> DAffine3 {
    let r = rows.map(|row| row.as_dvec4());
    DAffine3 {
        matrix3: DMat3::from_cols(
            DVec3::new(r[0].x, r[1].x, r[2].x),
            DVec3::new(r[0].y, r[1].y, r[2].y),
            DVec3::new(r[0].z, r[1].z, r[2].z),
        ),
        translation: DVec3::new(r[0].w, r[1].w, r[2].w),
    }
}

fn abs(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

fn row_sums(m: &DMat3) -> f64 {
    let sums = abs(m) * DVec3::ONE;
    sums.x.max(sums.y).max(sums.z)
}

/// The next float at or beyond `x` in the direction of `up`.
fn outward(x: f64, up: bool) -> f32 {
    let y = x as f32;
    match up {
        true if f64::from(y) < x => y.next_up(),
        false if f64::from(y) > x => y.next_down(),
        _ => y,
    }
}

/// Places an object. `unit`: object-space coordinates are multiplied by it; `bounds`: of its shape, before that;
/// `round`: the shape is the unit sphere.
pub fn place(
    name: &str,
    transform: &Transform,
    unit: f64,
    bounds: &Bounds,
    round: bool,
) -> Result<Placement, BakeError> {
    let mut scaled = transform.0;
    scaled.matrix3 *= unit;
    let to_world = rows(&scaled);
    // The inverse of what was rounded, so that the two disagree by one rounding only.
    let world = from_rows(&to_world);
    let inverse = world.inverse();
    let to_object = rows(&inverse);
    let size = row_sums(&world.matrix3);
    let shrink = row_sums(&inverse.matrix3);
    let translation = world.translation.abs();
    let finite = to_world.iter().chain(&to_object).all(|row| row.is_finite());
    let reach = size * 2.0 + translation.max_element();
    if !finite || !(shrink < WORLD_LIMIT) || !(reach < WORLD_LIMIT) {
        return Err(BakeError::Placement { name: name.to_owned() });
    }

    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let (centre, half) = ((low + high) * 0.5, (high - low) * 0.5);
    let middle = world.matrix3 * centre + world.translation;
    let m = &world.matrix3;
    let extent = if round {
        let length = |v: DVec3| libm::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        DVec3::new(length(m.row(0)), length(m.row(1)), length(m.row(2)))
    } else {
        abs(m) * half
    };
    // The absolute part of the bound in `trace::box_`, step 5: |W| (8 u (|O||x| + |O.w|) + 48 u extents), and extents are at
    // most twice the size.
    let farthest = middle.abs() + extent;
    let object_size = low.abs().max(high.abs()).max_element();
    let in_object = abs(&inverse.matrix3) * farthest + inverse.translation.abs() + DVec3::splat(object_size);
    let grown = extent + abs(m) * in_object * (128.0 * U);
    let (low, high) = (middle - grown, middle + grown);
    Ok(Placement {
        to_world,
        to_object,
        mirrored: world.matrix3.determinant() < 0.0,
        world: Bounds {
            min: Vec3::new(outward(low.x, false), outward(low.y, false), outward(low.z, false)),
            max: Vec3::new(outward(high.x, true), outward(high.y, true), outward(high.z, true)),
        },
        growth: row_sums(&(abs(m) * abs(&inverse.matrix3))).max(1.0),
    })
}

/// `SceneHeader::top_margin` for the largest growth of all instances: 128 growth 2^-24 (`trace::box_`, step 5).
pub fn top_margin(growth: f64) -> f32 {
    outward(128.0 * growth * U, true)
}
