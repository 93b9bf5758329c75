//! Surface materials.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

// The order of models here, in `match` and in `switch` is the same everywhere.
pub const MODEL_LAMBERT: u32 = 0;
pub const MODEL_PHONG: u32 = 1;
pub const MODEL_BLINN_PHONG: u32 = 2;
pub const MODEL_COOK_TORRANCE: u32 = 3;
pub const MODEL_MIRROR: u32 = 4;
pub const MODEL_DIELECTRIC: u32 = 5;
/// Shown as its base colour, unlit.
pub const MODEL_EMISSIVE: u32 = 6;

/// Material flag: the filtered form of non-refractive transparency, I_1 + k_t O_t I_2.
pub const MATERIAL_FILTERED: u32 = 1;
/// Material flag: Fresnel by complex index (eta + i k); else by eta alone.
pub const MATERIAL_CONDUCTOR: u32 = 2;
/// Material flag: Phong's lobe normalised by (n + 2) / 2 pi (Lafortune and Willems 1994); else as printed.
pub const MATERIAL_LAFORTUNE: u32 = 4;
/// Material flag: Cook-Torrance's D as the 1982 paper prints it, four times the normalised one.
pub const MATERIAL_D_1982: u32 = 8;

/// One material. 144 bytes. Colours are linear Rec. 709.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Material {
    /// O_d; for a mirror its reflectance; multiplied by its textures and the vertex colour.
    pub color: Vec3,
    /// `MODEL_*`.
    pub model: u32,
    /// O_s; for a dielectric the factor on refracted light.
    pub specular_color: Vec3,
    /// Phong's and Blinn's n, >= 0.
    pub exponent: f32,
    /// Weights of ambient, diffuse, specular and of the mirror branch, each >= 0.
    pub k_a: f32,
    pub k_d: f32,
    pub k_s: f32,
    pub k_r: f32,
    /// Index of refraction relative to the outside, per channel (a dielectric uses channel 0, at 587.6 nm).
    pub eta: Vec3,
    /// Beckmann slope of lobe 0.
    pub m0: f32,
    /// Extinction coefficient of a conductor, per channel.
    pub k: Vec3,
    pub m1: f32,
    /// Weights of the two Beckmann lobes; w1 = 0 for a single lobe.
    pub w0: f32,
    pub w1: f32,
    /// k_t of non-refractive transparency, 0 (opaque) to 1.
    pub k_t: f32,
    /// `MATERIAL_*` bits.
    pub flags: u32,
    /// O_t of filtered transparency.
    pub transmit_color: Vec3,
    /// Index of the first record in the texture array that belongs to the material.
    pub first_texture: u32,
    /// Beer coefficient inside a dielectric, per scene unit.
    pub absorption: Vec3,
    /// How many of them there are.
    pub texture_count: u32,
    /// Radiance the surface adds by itself (no other surface is lit by it under local and whitted).
    pub emission: Vec3,
    pub _pad1: u32,
}
