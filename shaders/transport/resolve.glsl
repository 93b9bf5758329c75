// What a material is at a point: the only place that knows records, textures and vertex colours.
#ifndef TRANSPORT_RESOLVE_GLSL
#define TRANSPORT_RESOLVE_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/coordinate.glsl"
#include "shading/footprint.glsl"
#include "shading/math.glsl"
#include "shading/parameter.glsl"
#include "shading/sampling.glsl"
#include "shading/texture.glsl"
#include "trace/surface.glsl"
#include "trace/tangent.glsl"
#include "transport/mod.glsl"

// In the place of a leaf's number: one of them, at random.
const uint DRAWN = 0xffffffffu;

// Applies the textures of `material` to `closure`, at `surface`, found for `hit` along `direction` (unit); a normal or bump
// map turns `surface.normal`. One loop with one place that fetches, as each place is inlined and costs compile time.
void apply_textures(Material material, vec3 direction, Hit hit, inout Closure closure, inout Surface surface) {
    if (!HAS_TEXTURES || material.texture_count == 0u) {
        return;
    }
    UvGradients gradients = gradients_at(surface, hit);
    Footprint footprint = cone_footprint(gradients, surface.normal_geometric, direction, surface.cone_width);
    uint count = material.texture_count < TEXTURES_MOST ? material.texture_count : TEXTURES_MOST;
    for (uint index = 0u; index < TEXTURES_MOST; index++) {
        Texture texture_record = load_texture(material.first_texture + index);
        Detail detail = texture_detail(texture_record, footprint);
        vec2 uv = texture_uv(texture_record, surface.uv);
        bool raises = texture_record.parameter == PARAMETER_BUMP;
        // Heights are compared half a texel, or half of what is covered, to each side.
        float texels = max_(detail.width, 1.0);
        float reach_u = div(0.5 * texels, float(texture_record.width));
        float reach_v = div(0.5 * texels, float(texture_record.height));
        vec3 value = vec3(0.0);
        float height_u = 0.0;
        float height_v = 0.0;
        // To the right, to the left, above, below; other textures are read once, on the spot.
        uint taps = raises ? 4u : 1u;
        for (uint tap = 0u; tap < 4u; tap++) {
            float side = (tap & 1u) == 0u ? 1.0 : -1.0;
            vec2 reach = tap < 2u ? vec2(reach_u * side, 0.0) : vec2(0.0, reach_v * side);
            vec2 place = raises ? uv + reach : uv;
            value = channel_value(filter_texture(texture_record, place, detail), texture_record.channel);
            height_u = tap < 2u ? height_u + value.x * side : height_u;
            height_v = tap < 2u ? height_v : height_v + value.x * side;
            if (tap + 1u == taps) {
                break;
            }
        }
        if (raises) {
            UvGradients own = texture_gradients(texture_record, gradients);
            float rise_u = div(height_u, 2.0 * reach_u) * texture_record.scale;
            float rise_v = div(height_v, 2.0 * reach_v) * texture_record.scale;
            surface.normal = raised_normal(surface.normal, own, rise_u, rise_v);
        } else if (texture_record.parameter == PARAMETER_NORMAL) {
            UvGradients own = texture_gradients(texture_record, gradients);
            surface.normal = mapped_normal(surface.normal, own, value, texture_record.scale);
        } else {
            apply_parameter(closure, texture_record.parameter, value, texture_record.scale);
        }
        if (index + 1u == count) {
            break;
        }
    }
}

// One material of a blend: number `leaf`, or if that is `DRAWN` the one that `u` draws, 0..1 excluding 1. `share` is how much of
// the surface it is, 0 for the side that is not seen. `dimension`: as in `resolve_material`.
Closure resolve_part(vec3 direction, Hit hit, uint leaf, float u, uint dimension, inout Surface surface) {
    Material material = load_material(surface.material);
    // Drivers leave out what the one model of a group of paths excludes.
    if (SHADE_MODEL != INVALID && dimension == DIMENSION_LEAF) material.model = SHADE_MODEL;
    Closure closure = closure_of(material);
    uint leaf_count = closure.leaf_count;
    float rest = u;
    uint number = leaf;
    float covered = 1.0;
    float share = 1.0;
    for (uint level = 0u; level < MAX_LEAVES; level++) {
        closure.color *= surface.color;
        if (HAS_MODEL(MODEL_EMISSIVE) && closure.model == MODEL_EMISSIVE) {
            closure.emission *= surface.color;
        }
        apply_textures(material, direction, hit, closure, surface);
        // Where a blend has holes, what it blends has them too.
        if (HAS_MODEL(MODEL_BLEND) && covered < 1.0) {
            closure.k_t = 1.0 - covered * (1.0 - closure.k_t);
        }
        // Bake lets no blend be deeper.
        if (!HAS_MODEL(MODEL_BLEND) || closure.model != MODEL_BLEND || level + 1u == MAX_LEAVES) {
            break;
        }
        covered = 1.0 - closure.k_t;
        bool by_side = (closure.flags & MATERIAL_BY_SIDE) != 0u;
        bool behind = dot3(surface.normal_geometric, direction) > 0.0;
        float weight = clamp_(closure.blend, 0.0, 1.0);
        bool drawn = by_side ? behind : rest < weight;
        bool second = leaf == DRAWN ? drawn : number >= closure.first_leaves;
        float by_weight = second ? weight : 1.0 - weight;
        float seen = second == behind ? 1.0 : 0.0;
        share *= by_side ? seen : by_weight;
        number = second ? number - closure.first_leaves : number;
        // What is left of u is as random again.
        float left = second ? div(rest, weight) : div(rest - weight, 1.0 - weight);
        rest = by_side ? rest : left;
        surface.material = second ? closure.first_part + 1u : closure.first_part;
        material = load_material(surface.material);
        closure = closure_of(material);
    }
    closure.leaf_count = leaf_count;
    closure.share = share;
    return closure;
}

// The material of `surface`, found for `hit` along `direction` (unit), with its textures and vertex colour. Of a blend it is
// one that is none, drawn by the weights, (1 - `blend`) of the first and `blend` of the second, or by the side that is seen;
// `surface.material` names it.
// `key`: of the path, which draws with `dimension` at one surface at most.
Closure resolve_material(vec3 direction, Hit hit, SampleKey key, uint dimension, inout Surface surface) {
    bool blended = HAS_MODEL(MODEL_BLEND) && load_material(surface.material).model == MODEL_BLEND;
    float u = blended ? sample_1d(key, dimension) : 0.0;
    return resolve_part(direction, hit, DRAWN, u, dimension, surface);
}

#endif
