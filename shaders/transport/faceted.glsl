// Flat and Gouraud shading (row 8): a triangle is shaded at its centroid or at its corners instead of at the hit.
// Source: Gouraud 1971, "Continuous Shading of Curved Surfaces".
#ifndef TRANSPORT_FACETED_GLSL
#define TRANSPORT_FACETED_GLSL

#include "shading/math.glsl"
#include "trace/surface.glsl"
#include "transport/local.glsl"
#include "transport/mod.glsl"

// Barycentric weight of the centroid, 1/3.
const float THIRD = 0.33333334;
// A shadow ray leaves a corner along its normal by this many error bounds: one above each triangle there whose normal
// is within 75 degrees of the corner's.
const float CORNER_LIFT = 4.0;

// Whether an instance with these flags is shaded elsewhere than at its hits.
bool faceted(uint flags) {
    return (flags & (INSTANCE_FLAT | INSTANCE_GOURAUD)) != 0u;
}

// At how many points a hit is shaded.
uint shading_points(uint flags) {
    return (flags & INSTANCE_GOURAUD) != 0u ? 3u : 1u;
}

// Unit direction from `position` to the camera. What is shaded at a corner or centroid is seen from there, not along
// the ray, so that it is the same for every ray that hits the triangle.
vec3 to_camera(vec3 position) {
    Camera camera = header.camera;
    if (camera.kind == CAMERA_PERSPECTIVE) {
        return normalize3(camera.eye - position);
    }
    return -normalize3(camera.forward);
}

// Point number `index` at which `hit` of `ray` is shaded. `here`: the surface there. `flags`: of the hit instance.
ShadingPoint shading_point(Ray ray, Hit hit, Surface here, uint flags, uint index) {
    if (!faceted(flags)) {
        return ShadingPoint(here, hit, here, -ray.direction, 1.0, 0u);
    }
    Hit at = hit;
    float share = 1.0;
    if ((flags & INSTANCE_FLAT) != 0u) {
        at.b1 = THIRD;
        at.b2 = THIRD;
    }
    if ((flags & INSTANCE_GOURAUD) != 0u) {
        at.b1 = index == 1u ? 1.0 : 0.0;
        at.b2 = index == 2u ? 1.0 : 0.0;
        share = index == 1u ? hit.b1 : index == 2u ? hit.b2 : max_((1.0 - hit.b1) - hit.b2, 0.0);
    }
    Surface surface = surface_at(ray, at);
    vec3 wo = to_camera(surface.position);
    if ((flags & INSTANCE_FLAT) != 0u) {
        surface.normal = surface.normal_geometric;
    }
    // A corner beyond the silhouette keeps its normal, and so its diffuse light; the view is bent.
    float side = dot3(surface.normal_geometric, wo) < 0.0 ? -1.0 : 1.0;
    vec3 normal = surface.normal * side;
    float cos_view = dot3(normal, wo);
    if (cos_view < COS_VIEW_MIN) {
        wo = normalize3(wo + normal * (COS_VIEW_MIN - cos_view));
    }
    Surface shadow_from = surface;
    if ((flags & INSTANCE_GOURAUD) != 0u) {
        // The same shadow ray for every triangle that shares the corner, or the picture would break at its edges.
        shadow_from.normal_geometric = surface.normal;
        shadow_from.primitive = INVALID;
        shadow_from.error = surface.error * CORNER_LIFT;
    }
    return ShadingPoint(surface, at, shadow_from, wo, share, index * DITHER_CORNER);
}

#endif
