//! What a texture's value does to a material (row 27).

use crate::layout::{
    CHANNEL_A, CHANNEL_B, CHANNEL_G, CHANNEL_R, Material, PARAMETER_ANISOTROPIC, PARAMETER_CLEARCOAT,
    PARAMETER_CLEARCOAT_GLOSS, PARAMETER_COLOR, PARAMETER_EMISSION, PARAMETER_FLATNESS, PARAMETER_MASK,
    PARAMETER_METALLIC, PARAMETER_OPACITY, PARAMETER_ROUGHNESS, PARAMETER_ROUGHNESS_U, PARAMETER_ROUGHNESS_V,
    PARAMETER_SHEEN, PARAMETER_SHEEN_TINT, PARAMETER_SPEC_TINT, PARAMETER_SPEC_TRANS, PARAMETER_SPECULAR_COLOR,
    PARAMETER_WEIGHT,
};
use crate::shading::math::{clamp_, max_};
use glam::{Vec3, Vec4};

/// No texture makes a lobe narrower: below, distributions overflow.
const ALPHA_LEAST: f32 = 1.0e-3;

/// The channel of a texel as all three components, or its colour. `channel`: `CHANNEL_*`.
#[inline]
pub fn channel_value(texel: Vec4, channel: u32) -> Vec3 {
    match channel {
        CHANNEL_R => Vec3::splat(texel.x),
        CHANNEL_G => Vec3::splat(texel.y),
        CHANNEL_B => Vec3::splat(texel.z),
        CHANNEL_A => Vec3::splat(texel.w),
        // CHANNEL_RGB
        _ => Vec3::new(texel.x, texel.y, texel.z),
    }
}

/// `material` with one parameter multiplied by `texel` times `scale`. `parameter`: `PARAMETER_*` but for normal and bump
/// maps; scalars take the first component. A mask covers all where `texel` reaches `scale`, and nothing elsewhere.
#[inline]
pub fn apply_parameter(material: Material, parameter: u32, texel: Vec3, scale: f32) -> Material {
    let mut result = material;
    let value = texel * scale;
    // k_t is what is not covered.
    let covered = 1.0 - material.k_t;
    match parameter {
        PARAMETER_COLOR => result.color *= value,
        PARAMETER_SPECULAR_COLOR => result.specular_color *= value,
        PARAMETER_EMISSION => result.emission *= value,
        PARAMETER_ROUGHNESS | PARAMETER_ROUGHNESS_U | PARAMETER_ROUGHNESS_V => {
            if parameter != PARAMETER_ROUGHNESS_V {
                result.m0 = max_(material.m0 * value.x, ALPHA_LEAST);
                result.m1 = max_(material.m1 * value.x, ALPHA_LEAST);
            }
            if parameter != PARAMETER_ROUGHNESS_U {
                result.m0_v = max_(material.m0_v * value.x, ALPHA_LEAST);
                result.m1_v = max_(material.m1_v * value.x, ALPHA_LEAST);
            }
        }
        PARAMETER_METALLIC | PARAMETER_WEIGHT => result.extra = clamp_(material.extra * value.x, 0.0, 1.0),
        PARAMETER_OPACITY => result.k_t = 1.0 - covered * clamp_(value.x, 0.0, 1.0),
        PARAMETER_MASK => result.k_t = if covered * texel.x >= scale { 0.0 } else { 1.0 },
        // Where a principled material keeps them (`shading/principled`).
        PARAMETER_ANISOTROPIC => result.k.x = clamp_(material.k.x * value.x, 0.0, 1.0),
        PARAMETER_SPEC_TRANS => result.k.y = clamp_(material.k.y * value.x, 0.0, 1.0),
        PARAMETER_SPEC_TINT => result.k.z = clamp_(material.k.z * value.x, 0.0, 1.0),
        PARAMETER_SHEEN => result.w0 = clamp_(material.w0 * value.x, 0.0, 1.0),
        PARAMETER_SHEEN_TINT => result.w1 = clamp_(material.w1 * value.x, 0.0, 1.0),
        PARAMETER_FLATNESS => result.k_d = clamp_(material.k_d * value.x, 0.0, 1.0),
        PARAMETER_CLEARCOAT => result.k_s = clamp_(material.k_s * value.x, 0.0, 1.0),
        PARAMETER_CLEARCOAT_GLOSS => result.exponent = clamp_(material.exponent * value.x, 0.0, 1.0),
        // Normal and bump maps.
        _ => {}
    }
    result
}
