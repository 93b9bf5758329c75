// Rays that start on a surface.
#ifndef TRACE_SPAWN_GLSL
#define TRACE_SPAWN_GLSL

#include "layout/records.glsl"
#include "shading/math.glsl"
#include "trace/surface.glsl"

// A ray that leaves `surface` along `direction` (unit) and ends at `t_max`. It starts off the surface by its error
// bound, along the geometric normal on the direction's side, so that rounding cannot put it on the wrong side of a
// neighbour; the triangle (or the sphere's own root) it leaves is named, not found by an epsilon. Its cone goes on as
// from a flat mirror: too narrow after a rough or convex surface, which costs noise and no sharpness.
// Source: after Waechter and Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection" (Ray Tracing Gems,
// chapter 6), with the bound of this surface's own arithmetic instead of a fixed number of ulps.
Ray spawn_ray(Surface surface, vec3 direction, float t_max) {
    bool inward = dot3(direction, surface.normal_geometric) < 0.0;
    float offset = inward ? -surface.error : surface.error;
    return Ray(
        surface.position + surface.normal_geometric * offset,
        t_max,
        direction,
        surface.instance,
        surface.primitive,
        inward ? 1u : 0u,
        surface.cone_width,
        surface.cone_spread
    );
}

// The same ray, gone on straight through `surface`: `direction` is its own, `t_max` counts from the surface.
Ray spawn_through(Surface surface, vec3 direction, float t_max) {
    return spawn_ray(surface, direction, t_max);
}

#endif
