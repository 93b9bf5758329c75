// The illumination model alone: I = emission + ambient + sum over lights, and what is seen through a pane.
#ifndef TRANSPORT_LOCAL_GLSL
#define TRANSPORT_LOCAL_GLSL

#include "shading/closure.glsl"
#include "layout/features.glsl"
#include "shading/frame.glsl"
#include "shading/light.glsl"
#include "shading/material.glsl"
#include "shading/math.glsl"
#include "shading/sampling.glsl"
#include "shading/slide.glsl"
#include "shading/spectrum.glsl"
#include "trace/spawn.glsl"
#include "trace/surface.glsl"
#include "transport/mod.glsl"
#include "transport/weight.glsl"

// Smallest cosine between shading normal and viewer; interpolated normals that face away are bent up to it.
const float COS_VIEW_MIN = 1.0e-3;
// A shadow ray ends this fraction short of its light, so that a lamp's own glass does not hide it.
const float SHADOW_END = 0.9999;

// Where a hit is shaded: at itself, or where `faceted` puts it.
struct ShadingPoint {
    Surface surface;
    // Where on its triangle that is.
    Hit hit;
    // Where its shadow rays start.
    Surface shadow_from;
    // Unit, to the viewer.
    vec3 wo;
    // Part of the hit's radiance that it stands for, 0..1.
    float share;
    // Keeps the dither of several points apart.
    uint dither;
};

// The shading normal a viewer at `wo` sees: on the viewer's side of the surface (both sides are shaded alike), and
// bent towards the viewer where interpolation has turned it away.
vec3 facing_normal(Surface surface, vec3 wo) {
    float side = dot3(surface.normal_geometric, wo) < 0.0 ? -1.0 : 1.0;
    vec3 normal = surface.normal * side;
    float cos_view = dot3(normal, wo);
    if (cos_view < COS_VIEW_MIN) {
        return normalize3(normal + wo * (COS_VIEW_MIN - cos_view));
    }
    return normal;
}

// The frame in which `closure` is shaded for a viewer at `wo`: z is the normal on the viewer's side, or for models that
// transmit the one that leaves the outside; x follows the texture coordinates where the model has a direction.
Frame shading_frame(Surface surface, Closure closure, vec3 wo) {
    vec3 facing = facing_normal(surface, wo);
    bool inside = (closure.flags & MATERIAL_TRANSMISSIVE) != 0u && dot3(surface.normal_geometric, wo) < 0.0;
    vec3 normal = inside ? -facing : facing;
    if ((closure.flags & MATERIAL_ANISOTROPIC) != 0u) {
        return frame_from_tangent(normal, surface_tangent(surface));
    }
    return frame_from_normal(normal);
}

// True if a viewer at `wo` sees the back of a surface that reflects on its front only.
bool is_hidden_back(Surface surface, Closure closure, vec3 wo) {
    return (closure.flags & MATERIAL_ONE_SIDED) != 0u && dot3(surface.normal_geometric, wo) < 0.0;
}

// Radiance the surface emits towards `wo`.
vec3 emitted(Surface surface, Closure closure, vec3 wo) {
    if ((closure.flags & MATERIAL_EMIT_ONE_SIDED) != 0u && dot3(surface.normal_geometric, wo) < 0.0) {
        return vec3(0.0);
    }
    return closure.emission;
}

// What the surface adds for one light, before any shadow: throughput * eval * radiance.
Spectrum light_contribution(Spectrum weight, Closure closure, Frame frame, vec3 wo, vec3 wi, Spectrum radiance) {
    return weight * eval_closure(closure, to_local(frame, wo), to_local(frame, wi)) * radiance;
}

// Adds emission, ambient and every light's share of the surface, as seen from `point.wo`.
// `key`: of the path. Directions in world space. Radiance along the ray's way back.
void shade_local(PathState path, SampleKey key, ShadingPoint point, Closure closure) {
    Surface surface = point.surface;
    vec3 wo = point.wo;
    Spectrum weight = path.throughput * (own_weight(closure.flags, closure.k_t) * point.share);
    bool hidden = is_hidden_back(surface, closure, wo);
    Spectrum reflected = spectrum_from_rgb(header.ambient) * ambient_closure(closure);
    if (hidden) {
        reflected = spectrum_zero();
    }
    Spectrum own = weight * (reflected + spectrum_from_rgb(emitted(surface, closure, wo)));
    // A mirror or a glass covers the background like anything else.
    float alpha = path.coverage * ((1.0 - closure.k_t) * point.share);
    uint dither = dither_hash(key, DITHER_SURFACE + point.dither);
    add_contribution(header.film_scale, path.slot, vec4(own.x, own.y, own.z, alpha), dither);

    if (!is_delta(closure) && !hidden && header.light_count != 0u) {
        Frame frame = shading_frame(surface, closure, wo);
        bool shadowless = false;
        if (HAS_SHADOWLESS) {
            shadowless = (load_instance(surface.instance).flags & INSTANCE_NO_SHADOW) != 0u;
        }
        for (uint index = 0u; index < header.light_count; index++) {
            Light light = load_light(index);
            LightSample lit = sample_light(light, surface.position);
            if (HAS_SLIDES && light.slide != 0u) lit.radiance *= slide_factor(light, lit.wi);
            Spectrum seen = light_contribution(weight, closure, frame, wo, lit.wi, lit.radiance);
            if (spectrum_max(seen) > 0.0) {
                vec4 contribution = vec4(seen.x, seen.y, seen.z, 0.0);
                uint light_dither = dither_hash(key, (DITHER_LIGHT + point.dither) + index);
                if (SHADOWS != SHADOWS_OFF && light.casts_shadow != 0u) {
                    // No ray tests what it leaves: behind it, the surface itself is in the way, if it casts shadows.
                    vec3 wo_local = to_local(frame, wo);
                    vec3 wi_local = to_local(frame, lit.wi);
                    if (shadowless || consistent(point.shadow_from, wo, lit.wi, wo_local, wi_local)) {
                        Ray ray = spawn_ray(point.shadow_from, lit.wi, lit.distance * SHADOW_END);
                        push_shadow(ShadowRay(ray, contribution, path.slot, light_dither, 0u, 1.0));
                    }
                } else {
                    add_contribution(header.film_scale, path.slot, contribution, light_dither);
                }
            }
            if (index + 1u == header.light_count) {
                break;
            }
        }
    }
}

// Lets the ray go on through a pane.
void shade_through(PathState path, Surface surface, Closure closure) {
    if (HAS_PANES && closure.k_t > 0.0) {
        vec4 tint = pane_tint(closure);
        PathState through = path;
        through.throughput = path.throughput * tint;
        through.coverage = path.coverage * closure.k_t;
        through.path_id = hash_combine(path.path_id, LOBE_THROUGH);
        through.ray = spawn_through(surface, path.ray.direction, path.ray.t_max);
        if (spectrum_max(through.throughput) >= header.min_weight) {
            push_path(through);
        }
    }
}

#endif
