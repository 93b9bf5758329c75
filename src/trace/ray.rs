//! A ray as one level of the hierarchy sees it.

use crate::layout::Instance;
use crate::shading::math::{max_, rcp_each};
use glam::{Vec3, Vec4};
use wide::f32x4;

/// Components of a direction smaller than this part of the largest one (2^-40) become 0, and their reciprocals that of
/// this part: no plane distance overflows, and the direction changes by far less than its own rounding.
const DIRECTION_LEAST: f32 = 9.094947e-13;
/// Farther away than this (2^40), in units of the level, nothing is hit: products of three lengths stay finite.
const ORIGIN_LIMIT: f32 = 1.0995116e12;
/// 2^-60.
const DUST: f32 = 8.6736174e-19;

/// A ray in world space or in an instance's object space, with what the box and triangle tests need of it.
#[derive(Clone, Copy, Debug)]
pub struct LevelRay {
    pub origin: Vec3,
    /// Not unit in object space: t keeps the units of the world direction.
    pub direction: Vec3,
    /// Reciprocal of each component (of `rcp`'s accuracy); large but finite where the component is 0.
    pub inverse: Vec3,
    /// Axis along which the direction is largest, and the two others in cyclic order.
    pub kz: u32,
    pub kx: u32,
    pub ky: u32,
    /// The shear that makes the direction the axis kz: direction.kx / direction.kz, direction.ky / direction.kz and
    /// 1 / direction.kz (Woop, Benthin and Wald 2013, section 3.2).
    pub sx: f32,
    pub sy: f32,
    pub sz: f32,
    /// Components kx, ky and kz of the origin. Rust only.
    pub permuted_origin: Vec3,
    /// In each of four bytes, bits 4, 2, 1: the x, y, z of `inverse` is not negative.
    pub octant: u32,
}

/// `v` in a register of four lanes, of which the last is for nothing. Rust only.
#[inline(always)]
pub fn lanes(v: Vec3) -> f32x4 {
    f32x4::new([v.x, v.y, v.z, 0.0])
}

/// Component `k` (0 to 2) of `v`.
#[inline(always)]
pub fn component(v: Vec3, k: u32) -> f32 {
    // No branch: along which axis a ray runs cannot be foretold.
    v.to_array()[(k as usize).min(2)]
}

/// `x`, or `least` with the sign of `x` if `x` is smaller.
#[inline(always)]
fn at_least(x: f32, least: f32) -> f32 {
    if x.abs() < least { if x < 0.0 { -least } else { least } } else { x }
}

/// The ray from `origin` along `direction` (largest component 2^-38 to 2^38), ready for one level.
#[inline(always)]
pub fn prepare_ray(origin: Vec3, direction: Vec3) -> LevelRay {
    let ax = direction.x.abs();
    let ay = direction.y.abs();
    let az = direction.z.abs();
    let longest = max_(max_(ax, ay), az);
    let least = longest * DIRECTION_LEAST;
    let d = Vec3::new(
        if ax < least { 0.0 } else { direction.x },
        if ay < least { 0.0 } else { direction.y },
        if az < least { 0.0 } else { direction.z },
    );
    let x = at_least(direction.x, least);
    let y = at_least(direction.y, least);
    let z = at_least(direction.z, least);
    let inverse = rcp_each(Vec3::new(x, y, z));
    let kz = if max_(ax, ay) > az { u32::from(!(ax > ay)) } else { 2 };
    let kx = if kz == 2 { 0 } else { kz + 1 };
    let ky = if kx == 2 { 0 } else { kx + 1 };
    let sz = component(inverse, kz);
    let sx = component(d, kx) * sz;
    let sy = component(d, ky) * sz;
    let bits = (if x < 0.0 { 0 } else { 4 }) | (if y < 0.0 { 0 } else { 2 }) | (if z < 0.0 { 0 } else { 1 });
    let permuted_origin = Vec3::new(component(origin, kx), component(origin, ky), component(origin, kz));
    LevelRay { origin, direction: d, inverse, kz, kx, ky, sx, sy, sz, permuted_origin, octant: bits * 0x0101_0101 }
}

/// Whether a ray starts close enough for the level's arithmetic: every component within 2^40.
#[inline(always)]
pub fn within_reach(origin: Vec3) -> bool {
    origin.x.abs() <= ORIGIN_LIMIT && origin.y.abs() <= ORIGIN_LIMIT && origin.z.abs() <= ORIGIN_LIMIT
}

/// The affine map of the rows `m`, applied to a point.
#[inline(always)]
pub fn transform_point(m: [Vec4; 3], p: Vec3) -> Vec3 {
    Vec3::new(
        ((m[0].x * p.x + m[0].y * p.y) + m[0].z * p.z) + m[0].w,
        ((m[1].x * p.x + m[1].y * p.y) + m[1].z * p.z) + m[1].w,
        ((m[2].x * p.x + m[2].y * p.y) + m[2].z * p.z) + m[2].w,
    )
}

/// Its linear part, applied to a vector.
#[inline(always)]
pub fn transform_vector(m: [Vec4; 3], v: Vec3) -> Vec3 {
    Vec3::new(
        (m[0].x * v.x + m[0].y * v.y) + m[0].z * v.z,
        (m[1].x * v.x + m[1].y * v.y) + m[1].z * v.z,
        (m[2].x * v.x + m[2].y * v.y) + m[2].z * v.z,
    )
}

/// The transpose of its linear part, applied to a vector: normals go to world space by `to_object`.
#[inline(always)]
pub fn transform_transposed(m: [Vec4; 3], v: Vec3) -> Vec3 {
    Vec3::new(
        (m[0].x * v.x + m[1].x * v.y) + m[2].x * v.z,
        (m[0].y * v.x + m[1].y * v.y) + m[2].y * v.z,
        (m[0].z * v.x + m[1].z * v.y) + m[2].z * v.z,
    )
}

/// A component smaller than 2^-60 becomes 0, so that no difference with a vertex (bake does the same to those) has
/// so few bits that the survival of subnormals could matter.
#[inline(always)]
fn without_dust(p: Vec3) -> Vec3 {
    Vec3::new(
        if p.x.abs() < DUST { 0.0 } else { p.x },
        if p.y.abs() < DUST { 0.0 } else { p.y },
        if p.z.abs() < DUST { 0.0 } else { p.z },
    )
}

/// Where a world-space ray starts in the instance's object space.
#[inline(always)]
pub fn object_origin(instance: &Instance, origin: Vec3) -> Vec3 {
    without_dust(transform_point(instance.to_object, origin))
}
