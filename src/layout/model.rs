//! Models and their parameters: one block each.
//!
//! The constants and the blocks of this file are the table of models. `MODEL_WARD` has `WardBlock`, whose members are those of the
//! closure with the same names (`shading/closure`, which says what each means); a model without parameters has an empty
//! block. `build.rs` writes what packs a closure into its block and unpacks it, and refuses a model without a block.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

pub const MODEL_LAMBERT: u32 = 0;
pub const MODEL_PHONG: u32 = 1;
pub const MODEL_BLINN_PHONG: u32 = 2;
pub const MODEL_COOK_TORRANCE: u32 = 3;
pub const MODEL_MIRROR: u32 = 4;
pub const MODEL_DIELECTRIC: u32 = 5;
/// Shown as its own light, unlit.
pub const MODEL_EMISSIVE: u32 = 6;
pub const MODEL_OREN_NAYAR: u32 = 7;
pub const MODEL_WARD: u32 = 8;
pub const MODEL_ASHIKHMIN_SHIRLEY: u32 = 9;
pub const MODEL_KELEMEN: u32 = 10;
pub const MODEL_CONDUCTOR: u32 = 11;
pub const MODEL_ROUGH_CONDUCTOR: u32 = 12;
pub const MODEL_ROUGH_DIELECTRIC: u32 = 13;
pub const MODEL_THIN_DIELECTRIC: u32 = 14;
pub const MODEL_PLASTIC: u32 = 15;
pub const MODEL_ROUGH_PLASTIC: u32 = 16;
pub const MODEL_PRINCIPLED: u32 = 17;
pub const MODEL_MEASURED: u32 = 18;
pub const MODEL_NULL: u32 = 19;
/// Two materials, one after the other from `first_part` on: (1 - `blend`) of the first and `blend` of the second.
pub const MODEL_BLEND: u32 = 20;
/// Measured for directions of light (`shading/tabulated`).
pub const MODEL_TABULATED: u32 = 21;
/// Oren and Nayar's rough diffuse reflection without loss of energy.
pub const MODEL_EON: u32 = 22;

/// What surfaces that reflect lights have in common. 40 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Lit {
    pub color: Vec3,
    pub k_d: f32,
    pub specular_color: Vec3,
    pub k_s: f32,
    pub k_a: f32,
    pub k_r: f32,
}

/// How an interface reflects: as a dielectric, or with `MATERIAL_CONDUCTOR` or `MATERIAL_SCHLICK`. 40 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Interface {
    pub eta: f32,
    pub metal_eta: Vec3,
    pub metal_k: Vec3,
    pub f0: Vec3,
}

/// Parameters of `MODEL_LAMBERT`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LambertBlock {
    pub lit: Lit,
    pub _pad0: u32,
    pub _pad1: u32,
}

/// Parameters of `MODEL_PHONG`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PhongBlock {
    pub lit: Lit,
    pub exponent: f32,
    pub _pad0: u32,
}

/// Parameters of `MODEL_BLINN_PHONG`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BlinnPhongBlock {
    pub lit: Lit,
    pub exponent: f32,
    pub _pad0: u32,
}

/// Parameters of `MODEL_COOK_TORRANCE`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CookTorranceBlock {
    pub lit: Lit,
    pub fresnel: Interface,
    pub weight: f32,
    pub second_weight: f32,
    pub alpha_u: f32,
    pub alpha_v: f32,
    pub second_alpha_u: f32,
    pub second_alpha_v: f32,
    pub distribution: u32,
    pub second_distribution: u32,
    pub table: u32,
    pub _pad0: u32,
    pub _pad1: u32,
    pub _pad2: u32,
}

/// Parameters of `MODEL_MIRROR`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MirrorBlock {
    pub color: Vec3,
    pub _pad0: u32,
}

/// Parameters of `MODEL_DIELECTRIC`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DielectricBlock {
    pub color: Vec3,
    pub eta: f32,
    pub specular_color: Vec3,
    pub _pad0: u32,
}

/// Parameters of `MODEL_OREN_NAYAR`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct OrenNayarBlock {
    pub lit: Lit,
    pub sigma: f32,
    pub _pad0: u32,
}

/// Parameters of `MODEL_WARD`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct WardBlock {
    pub lit: Lit,
    pub alpha_u: f32,
    pub alpha_v: f32,
}

/// Parameters of `MODEL_ASHIKHMIN_SHIRLEY`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AshikhminShirleyBlock {
    pub lit: Lit,
    pub exponent: f32,
    pub exponent_v: f32,
}

/// Parameters of `MODEL_KELEMEN`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct KelemenBlock {
    pub lit: Lit,
    pub eta: f32,
    pub alpha_u: f32,
    pub table: u32,
    pub _pad0: u32,
    pub _pad1: u32,
    pub _pad2: u32,
}

/// Parameters of `MODEL_CONDUCTOR`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ConductorBlock {
    pub specular_color: Vec3,
    pub fresnel: Interface,
    pub _pad0: u32,
    pub _pad1: u32,
    pub _pad2: u32,
}

/// Parameters of `MODEL_ROUGH_CONDUCTOR`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RoughConductorBlock {
    pub lit: Lit,
    pub fresnel: Interface,
    pub alpha_u: f32,
    pub alpha_v: f32,
    pub distribution: u32,
    pub table: u32,
}

/// Parameters of `MODEL_ROUGH_DIELECTRIC`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RoughDielectricBlock {
    pub color: Vec3,
    pub eta: f32,
    pub specular_color: Vec3,
    pub distribution: u32,
    pub alpha_u: f32,
    pub alpha_v: f32,
    pub _pad0: u32,
    pub _pad1: u32,
}

/// Parameters of `MODEL_THIN_DIELECTRIC`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ThinDielectricBlock {
    pub color: Vec3,
    pub eta: f32,
    pub specular_color: Vec3,
    pub _pad0: u32,
}

/// Parameters of `MODEL_PLASTIC`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PlasticBlock {
    pub lit: Lit,
    pub eta: f32,
    pub inner_reflectance: f32,
}

/// Parameters of `MODEL_ROUGH_PLASTIC`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RoughPlasticBlock {
    pub lit: Lit,
    pub eta: f32,
    pub alpha_u: f32,
    pub distribution: u32,
    pub table: u32,
    pub _pad0: u32,
    pub _pad1: u32,
}

/// Parameters of `MODEL_PRINCIPLED`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PrincipledBlock {
    pub lit: Lit,
    pub eta: f32,
    pub roughness: f32,
    pub metallic: f32,
    pub anisotropic: f32,
    pub spec_trans: f32,
    pub spec_tint: f32,
    pub sheen: f32,
    pub sheen_tint: f32,
    pub flatness: f32,
    pub clearcoat: f32,
    pub clearcoat_gloss: f32,
    pub _pad0: u32,
    pub _pad1: u32,
    pub _pad2: u32,
}

/// Parameters of `MODEL_MEASURED`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MeasuredBlock {
    pub lit: Lit,
    pub table: u32,
    pub _pad0: u32,
}

/// Parameters of `MODEL_BLEND`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BlendBlock {
    pub blend: f32,
    pub first_part: u32,
    pub first_leaves: u32,
    pub leaf_count: u32,
}

/// Parameters of `MODEL_TABULATED`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TabulatedBlock {
    pub lit: Lit,
    pub table: u32,
    pub _pad0: u32,
}

/// Parameters of `MODEL_EON`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct EonBlock {
    pub lit: Lit,
    pub roughness: f32,
    pub _pad0: u32,
}

/// `MODEL_EMISSIVE` has no parameters.
pub struct EmissiveBlock;

/// `MODEL_NULL` has no parameters.
pub struct NullBlock;
