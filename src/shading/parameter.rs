//! What a texture's value does to a material (row 27).

use crate::layout::{
    CHANNEL_A, CHANNEL_B, CHANNEL_G, CHANNEL_R, PARAMETER_ANISOTROPIC, PARAMETER_CLEARCOAT, PARAMETER_CLEARCOAT_GLOSS,
    PARAMETER_COLOR, PARAMETER_EMISSION, PARAMETER_FLATNESS, PARAMETER_MASK, PARAMETER_METALLIC, PARAMETER_OPACITY,
    PARAMETER_ROUGHNESS, PARAMETER_ROUGHNESS_U, PARAMETER_ROUGHNESS_V, PARAMETER_SHEEN, PARAMETER_SHEEN_TINT,
    PARAMETER_SPEC_TINT, PARAMETER_SPEC_TRANS, PARAMETER_SPECULAR_COLOR, PARAMETER_WEIGHT,
};
use crate::shading::closure::Closure;
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

/// Multiplies one parameter of `closure` by `texel` times `scale`. `parameter`: `PARAMETER_*` but for normal and bump
/// maps; scalars take the first component. A mask covers all where `texel` reaches `scale`, and nothing elsewhere.
#[inline]
pub fn apply_parameter(closure: &mut Closure, parameter: u32, texel: Vec3, scale: f32) {
    let value = texel * scale;
    // k_t is what is not covered.
    let covered = 1.0 - closure.k_t;
    match parameter {
        PARAMETER_COLOR => closure.color *= value,
        PARAMETER_SPECULAR_COLOR => closure.specular_color *= value,
        PARAMETER_EMISSION => closure.emission *= value,
        PARAMETER_ROUGHNESS | PARAMETER_ROUGHNESS_U | PARAMETER_ROUGHNESS_V => {
            if parameter != PARAMETER_ROUGHNESS_V {
                closure.alpha_u = max_(closure.alpha_u * value.x, ALPHA_LEAST);
                closure.roughness = max_(closure.roughness * value.x, ALPHA_LEAST);
                closure.second_alpha_u = max_(closure.second_alpha_u * value.x, ALPHA_LEAST);
            }
            if parameter != PARAMETER_ROUGHNESS_U {
                closure.alpha_v = max_(closure.alpha_v * value.x, ALPHA_LEAST);
                closure.second_alpha_v = max_(closure.second_alpha_v * value.x, ALPHA_LEAST);
            }
        }
        PARAMETER_METALLIC => closure.metallic = clamp_(closure.metallic * value.x, 0.0, 1.0),
        PARAMETER_WEIGHT => closure.blend = clamp_(closure.blend * value.x, 0.0, 1.0),
        PARAMETER_OPACITY => closure.k_t = 1.0 - covered * clamp_(value.x, 0.0, 1.0),
        PARAMETER_MASK => closure.k_t = if covered * texel.x >= scale { 0.0 } else { 1.0 },
        PARAMETER_ANISOTROPIC => closure.anisotropic = clamp_(closure.anisotropic * value.x, 0.0, 1.0),
        PARAMETER_SPEC_TRANS => closure.spec_trans = clamp_(closure.spec_trans * value.x, 0.0, 1.0),
        PARAMETER_SPEC_TINT => closure.spec_tint = clamp_(closure.spec_tint * value.x, 0.0, 1.0),
        PARAMETER_SHEEN => closure.sheen = clamp_(closure.sheen * value.x, 0.0, 1.0),
        PARAMETER_SHEEN_TINT => closure.sheen_tint = clamp_(closure.sheen_tint * value.x, 0.0, 1.0),
        PARAMETER_FLATNESS => closure.flatness = clamp_(closure.flatness * value.x, 0.0, 1.0),
        PARAMETER_CLEARCOAT => closure.clearcoat = clamp_(closure.clearcoat * value.x, 0.0, 1.0),
        PARAMETER_CLEARCOAT_GLOSS => closure.clearcoat_gloss = clamp_(closure.clearcoat_gloss * value.x, 0.0, 1.0),
        // Normal and bump maps.
        _ => {}
    }
}
