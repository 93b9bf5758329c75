// Interfaces between clear bodies that overlap (`shading/interior`): which of them are there, and between what.
#ifndef TRANSPORT_NESTED_GLSL
#define TRANSPORT_NESTED_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/interior.glsl"
#include "shading/math.glsl"
#include "shading/sampling.glsl"
#include "trace/spawn.glsl"
#include "trace/surface.glsl"
#include "transport/mis.glsl"
#include "transport/mod.glsl"

// Indices of rough glass are not between these, or no facet would refract.
const float ETA_BELOW = 0.999;
const float ETA_ABOVE = 1.001;

// Beer coefficient of the medium that a ray with this list is in.
vec3 medium_absorption(uint list) {
    uint rank = interior_top(list);
    if (rank == 0u) {
        return vec3(0.0);
    }
    uint at = header.media_table + 4u * (rank - 1u);
    return vec3(load_table(at + 1u), load_table(at + 2u), load_table(at + 3u));
}

// Prepares `closure` of an interface that `path` meets: its index becomes relative to what is on the outer side there.
// False if nothing is there, as a medium of higher rank is on both sides (or the same once more): the ray then goes on.
// `t`: of the hit.
bool meet_interface(PathState path, Surface surface, float t, inout Closure closure) {
    uint rank = closure.rank;
    if (rank == 0u) {
        return true;
    }
    bool entering = dot3(surface.normal_geometric, path.ray.direction) <= 0.0;
    uint rest = entering ? path.interior : interior_remove(path.interior, rank);
    uint outer = interior_top(rest);
    if (rank <= outer) {
        PathState on = path;
        on.interior = entering ? interior_add(path.interior, rank) : rest;
        on.path_id = hash_combine(path.path_id, LOBE_THROUGH);
        pass_surface(surface, t, false, on);
        on.ray = spawn_through(surface, path.ray.direction, path.ray.t_max);
        push_path(on);
        return false;
    }
    if (outer != 0u) {
        float eta = div(closure.eta, load_table(header.media_table + 4u * (outer - 1u)));
        if (closure.model == MODEL_ROUGH_DIELECTRIC && eta > ETA_BELOW && eta < ETA_ABOVE) {
            eta = eta < 1.0 ? ETA_BELOW : ETA_ABOVE;
        }
        closure.eta = eta;
    }
    return true;
}

#endif
