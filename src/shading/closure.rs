//! What a material is at one point: the parameters of its model under their own names, textures applied.
//!
//! A closure never crosses the bus. What its model does not use means nothing. `build.rs` writes the struct in GLSL.

use crate::layout::*;
use glam::Vec3;

/// A material at one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Closure {
    /// `MODEL_*`.
    pub model: u32,
    /// `MATERIAL_*` bits.
    pub flags: u32,
    /// O_d; for a mirror its reflectance, for a dielectric the factor on reflected light.
    pub color: Vec3,
    /// O_s; for a dielectric the factor on refracted light.
    pub specular_color: Vec3,
    /// Weights of ambient, diffuse, specular and of the mirror branch, each >= 0.
    pub k_a: f32,
    pub k_d: f32,
    pub k_s: f32,
    pub k_r: f32,
    /// Phong's, Blinn's and (along the tangent) Ashikhmin's n, >= 0.
    pub exponent: f32,
    /// Ashikhmin's n across the tangent.
    pub exponent_v: f32,
    /// Oren and Nayar's roughness, radians.
    pub sigma: f32,
    /// `DISTRIBUTION_*` of the facets, or of the first of two lobes.
    pub distribution: u32,
    pub second_distribution: u32,
    /// Roughness along and across the tangent; Beckmann's slope m.
    pub alpha_u: f32,
    pub alpha_v: f32,
    /// The same of the second lobe.
    pub second_alpha_u: f32,
    pub second_alpha_v: f32,
    /// Weights of two lobes; the second is 0 for a single lobe.
    pub weight: f32,
    pub second_weight: f32,
    /// Index of refraction of a dielectric relative to the outside, at 587.6 nm.
    pub eta: f32,
    /// Complex index of a conductor, per channel.
    pub metal_eta: Vec3,
    pub metal_k: Vec3,
    /// Reflectance at normal incidence, for Schlick's Fresnel.
    pub f0: Vec3,
    /// First float of the model's own table in the table array.
    pub table: u32,
    /// Of a plastic: the coat's diffuse reflectance from inside.
    pub inner_reflectance: f32,
    /// Roughness of a principled material, and of `MODEL_EON`, 0..1.
    pub roughness: f32,
    /// A principled material's shares, 0..1 each.
    pub metallic: f32,
    pub anisotropic: f32,
    pub spec_trans: f32,
    pub spec_tint: f32,
    pub sheen: f32,
    pub sheen_tint: f32,
    pub flatness: f32,
    pub clearcoat: f32,
    pub clearcoat_gloss: f32,
    /// Of a blend: how much of its second material, and the first of its two in the array of materials.
    pub blend: f32,
    pub first_part: u32,
    /// Of a blend: how many materials the first of its two is made of in the end, and both together.
    pub first_leaves: u32,
    pub leaf_count: u32,
    /// How much of the surface it is, 0..1: 1 unless it is part of a blend.
    pub share: f32,
    /// Beer coefficient inside a dielectric, per scene unit.
    pub absorption: Vec3,
    /// Rank of the medium behind a clear body's surface, 0 if it has none (`shading/interior`).
    pub rank: u32,
    /// Radiance the surface adds by itself.
    pub emission: Vec3,
    /// k_t of non-refractive transparency, 0 (opaque) to 1; of a partly covering material what it does not cover.
    pub k_t: f32,
    /// O_t of filtered transparency.
    pub transmit_color: Vec3,
}

/// The closure of a material's constants, without its textures.
#[inline]
pub fn closure_of(scene: &SceneView, material: &Material) -> Closure {
    let mut closure = Closure {
        model: material.model,
        flags: material.flags,
        emission: material.emission,
        k_t: material.k_t,
        transmit_color: material.transmit_color,
        absorption: material.absorption,
        rank: material.rank,
        share: 1.0,
        ..Closure::default()
    };
    unpack_block(scene, material.block, &mut closure);
    closure
}

// `unpack_block` and `pack_block`, which `build.rs` writes from the blocks of `layout/model`.
include!(concat!(env!("OUT_DIR"), "/closure.rs"));
