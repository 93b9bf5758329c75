//! What a material is at a point: the only place that knows records, textures and vertex colours.

use crate::layout::{
    Hit, MATERIAL_BY_SIDE, MAX_LEAVES, MODEL_BLEND, MODEL_EMISSIVE, Material, PARAMETER_BUMP, PARAMETER_NORMAL,
    SceneView, TEXTURES_MOST, load_material, load_texture,
};
use crate::shading::closure::{Closure, closure_of};
use crate::shading::coordinate::texture_uv;
use crate::shading::footprint::{cone_footprint, mapped_normal, raised_normal, texture_gradients};
use crate::shading::math::{clamp_, div, dot3, max_};
use crate::shading::parameter::{apply_parameter, channel_value};
use crate::shading::sampling::{SampleKey, sample_1d};
use crate::shading::texture::{filter_texture, texture_detail};
use crate::trace::surface::Surface;
use crate::trace::tangent::gradients_at;
use glam::{Vec2, Vec3};

/// In the place of a leaf's number: one of them, at random.
pub const DRAWN: u32 = 0xffff_ffff;

/// Applies the textures of `material` to `closure`, at `surface`, found for `hit` along `direction` (unit); a normal or bump
/// map turns `surface.normal`. One loop with one place that fetches, as each place is inlined and costs compile time.
fn apply_textures(
    scene: &SceneView,
    material: &Material,
    direction: Vec3,
    hit: &Hit,
    closure: &mut Closure,
    surface: &mut Surface,
) {
    if !scene.features.has_textures || material.texture_count == 0 {
        return;
    }
    let gradients = gradients_at(scene, surface, hit);
    let footprint = cone_footprint(gradients, surface.normal_geometric, direction, surface.cone_width);
    let count = if material.texture_count < TEXTURES_MOST { material.texture_count } else { TEXTURES_MOST };
    for index in 0..count {
        let texture = load_texture(scene, material.first_texture + index);
        let detail = texture_detail(&texture, footprint);
        let uv = texture_uv(&texture, surface.uv);
        let raises = texture.parameter == PARAMETER_BUMP;
        // Heights are compared half a texel, or half of what is covered, to each side.
        let texels = max_(detail.width, 1.0);
        let reach_u = div(0.5 * texels, texture.width as f32);
        let reach_v = div(0.5 * texels, texture.height as f32);
        let mut value = Vec3::ZERO;
        let mut height_u = 0.0;
        let mut height_v = 0.0;
        // To the right, to the left, above, below; other textures are read once, on the spot.
        let taps = if raises { 4 } else { 1 };
        for tap in 0..taps {
            let side = if (tap & 1) == 0 { 1.0 } else { -1.0 };
            let reach = if tap < 2 { Vec2::new(reach_u * side, 0.0) } else { Vec2::new(0.0, reach_v * side) };
            let place = if raises { uv + reach } else { uv };
            value = channel_value(filter_texture(scene, &texture, place, detail), texture.channel);
            height_u = if tap < 2 { height_u + value.x * side } else { height_u };
            height_v = if tap < 2 { height_v } else { height_v + value.x * side };
        }
        if raises {
            let own = texture_gradients(&texture, gradients);
            let rise_u = div(height_u, 2.0 * reach_u) * texture.scale;
            let rise_v = div(height_v, 2.0 * reach_v) * texture.scale;
            surface.normal = raised_normal(surface.normal, own, rise_u, rise_v);
        } else if texture.parameter == PARAMETER_NORMAL {
            let own = texture_gradients(&texture, gradients);
            surface.normal = mapped_normal(surface.normal, own, value, texture.scale);
        } else {
            apply_parameter(closure, texture.parameter, value, texture.scale);
        }
    }
}

/// The material of `surface`, found for `hit` along `direction` (unit), with its textures and vertex colour. Of a blend it is
/// one that is none, drawn by the weights, (1 - `blend`) of the first and `blend` of the second, or by the side that is seen;
/// `surface.material` names it.
/// `key`: of the path, which draws with `dimension` at one surface at most.
pub fn resolve_material(
    scene: &SceneView,
    direction: Vec3,
    hit: &Hit,
    key: SampleKey,
    dimension: u32,
    surface: &mut Surface,
) -> Closure {
    let blended = scene.features.has_model(MODEL_BLEND) && load_material(scene, surface.material).model == MODEL_BLEND;
    let u = if blended { sample_1d(key, dimension) } else { 0.0 };
    resolve_part(scene, direction, hit, DRAWN, u, dimension, surface)
}

/// One material of a blend: number `leaf`, or if that is `DRAWN` the one that `u` draws, 0..1 excluding 1. `share` is how much of
/// the surface it is, 0 for the side that is not seen. `dimension`: as in `resolve_material`.
pub fn resolve_part(
    scene: &SceneView,
    direction: Vec3,
    hit: &Hit,
    leaf: u32,
    u: f32,
    _dimension: u32,
    surface: &mut Surface,
) -> Closure {
    let mut material = load_material(scene, surface.material);
    let mut closure = closure_of(scene, &material);
    let leaf_count = closure.leaf_count;
    let mut rest = u;
    let mut number = leaf;
    let mut covered = 1.0;
    let mut share = 1.0;
    for level in 0..MAX_LEAVES {
        closure.color *= surface.color;
        if closure.model == MODEL_EMISSIVE {
            closure.emission *= surface.color;
        }
        apply_textures(scene, &material, direction, hit, &mut closure, surface);
        // Where a blend has holes, what it blends has them too.
        if covered < 1.0 {
            closure.k_t = 1.0 - covered * (1.0 - closure.k_t);
        }
        // Bake lets no blend be deeper.
        if closure.model != MODEL_BLEND || level + 1 == MAX_LEAVES {
            break;
        }
        covered = 1.0 - closure.k_t;
        let by_side = (closure.flags & MATERIAL_BY_SIDE) != 0;
        let behind = dot3(surface.normal_geometric, direction) > 0.0;
        let weight = clamp_(closure.blend, 0.0, 1.0);
        let drawn = if by_side { behind } else { rest < weight };
        let second = if leaf == DRAWN { drawn } else { number >= closure.first_leaves };
        let by_weight = if second { weight } else { 1.0 - weight };
        let seen = if second == behind { 1.0 } else { 0.0 };
        share *= if by_side { seen } else { by_weight };
        number = if second { number.wrapping_sub(closure.first_leaves) } else { number };
        // What is left of u is as random again.
        let left = if second { div(rest, weight) } else { div(rest - weight, 1.0 - weight) };
        rest = if by_side { rest } else { left };
        surface.material = if second { closure.first_part + 1 } else { closure.first_part };
        material = load_material(scene, surface.material);
        closure = closure_of(scene, &material);
    }
    closure.leaf_count = leaf_count;
    closure.share = share;
    closure
}
