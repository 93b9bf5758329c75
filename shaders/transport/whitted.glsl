// Ray tracing as a recursive local model. Source: Whitted 1980, "An Improved Illumination Model for Shaded Display".
#ifndef TRANSPORT_WHITTED_GLSL
#define TRANSPORT_WHITTED_GLSL

#include "shading/closure.glsl"
#include "layout/features.glsl"
#include "shading/delta.glsl"
#include "shading/dielectric.glsl"
#include "shading/frame.glsl"
#include "shading/fresnel.glsl"
#include "shading/material.glsl"
#include "shading/math.glsl"
#include "shading/sampling.glsl"
#include "shading/spectrum.glsl"
#include "trace/spawn.glsl"
#include "trace/surface.glsl"
#include "transport/local.glsl"
#include "transport/mod.glsl"
#include "transport/nested.glsl"

// Appends one branch, unless its weight is below the scene's threshold.
void push_branch(PathState path, Surface surface, vec3 wi, Spectrum weight, uint lobe) {
    PathState branch = path;
    branch.throughput = path.throughput * weight;
    if (spectrum_max(branch.throughput) < header.min_weight) {
        return;
    }
    branch.coverage = 0.0;
    branch.depth = path.depth + 1u;
    branch.path_id = hash_combine(path.path_id, lobe);
    branch.ray = spawn_ray(surface, wi, T_INFINITE);
    push_path(branch);
}

// Mirror direction of `wo` about the viewer's shading normal; about the geometric one where the first would point
// into the surface.
vec3 mirror_direction(Surface surface, vec3 wo) {
    vec3 normal = facing_normal(surface, wo);
    vec3 mirrored = normal * (2.0 * dot3(normal, wo)) - wo;
    vec3 geometric = surface.normal_geometric;
    float cos_geometric = dot3(geometric, wo);
    if (dot3(geometric, mirrored) * cos_geometric > 0.0) {
        return mirrored;
    }
    return geometric * (2.0 * cos_geometric) - wo;
}

// Follows the mirror branch of any material and both branches of a dielectric, each with its Fresnel weight.
// Without ranks media do not nest: a ray that leaves a dielectric is outside. Radiance is not scaled by eta^2 (Whitted's model).
void shade_whitted(PathState path, Surface surface, Closure closure) {
    vec3 wo = -path.ray.direction;
    bool refracting = is_refracting(closure.model);
    if (!refracting && is_hidden_back(surface, closure, wo)) {
        return;
    }
    vec3 normal = facing_normal(surface, wo);
    bool entering = dot3(surface.normal_geometric, wo) >= 0.0;
    float eta = entering ? closure.eta : rcp(closure.eta);
    Frame frame = frame_from_normal(normal);
    vec3 wo_local = to_local(frame, wo);
    bool thin = closure.model == MODEL_THIN_DIELECTRIC;
    float reflectance = 0.0;
    Spectrum reflected;
    if (refracting) {
        reflectance = thin ? thin_reflectance(wo_local.z, closure.eta) : fresnel_dielectric(wo_local.z, eta);
        reflected = vec4(reflectance);
    } else {
        reflected = mirror_weight(closure, dot3(normal, wo)) * own_weight(closure.flags, closure.k_t);
    }
    push_branch(path, surface, mirror_direction(surface, wo), reflected, LOBE_MIRROR);
    if (!refracting) {
        return;
    }
    Spectrum refracted = spectrum_from_rgb(closure.specular_color) * (1.0 - reflectance);
    PathState inside = path;
    vec3 wi = path.ray.direction;
    if (!thin) {
        Refraction refraction = refract_local(wo_local, eta);
        if (refraction.total) {
            return;
        }
        wi = to_world(frame, refraction.wt);
        inside.eta = entering ? closure.eta : 1.0;
        inside.absorption = entering ? closure.absorption : vec3(0.0);
        if (HAS_RANKS) {
            inside.interior = cross_interface(path.interior, closure.rank, entering);
            inside.absorption = medium_absorption(inside.interior);
        }
    }
    push_branch(inside, surface, wi, refracted, LOBE_REFRACT);
}

#endif
