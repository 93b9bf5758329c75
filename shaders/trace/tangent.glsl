// How the texture coordinates of a surface run.
#ifndef TRACE_TANGENT_GLSL
#define TRACE_TANGENT_GLSL

#include "layout/records.glsl"
#include "shading/coordinate.glsl"
#include "shading/footprint.glsl"
#include "shading/math.glsl"
#include "trace/ray.glsl"
#include "trace/surface.glsl"

// Change of position per unit of u and of v. Zero where the coordinates do not determine it.
struct Tangents {
    vec3 dp_du;
    vec3 dp_dv;
};

// The tangents of a triangle with the edges `edge1` and `edge2` from corner 0, along which the coordinates change by
// `uv1` and `uv2`.
Tangents triangle_tangents(vec3 edge1, vec3 edge2, vec2 uv1, vec2 uv2) {
    float area = finite_or_zero(uv1.x * uv2.y - uv1.y * uv2.x);
    if (abs(area) < TINY || abs(area) > HUGE) {
        return Tangents(vec3(0.0), vec3(0.0));
    }
    float scale = rcp(area);
    return Tangents((edge1 * uv2.y - edge2 * uv1.y) * scale, (edge2 * uv1.x - edge1 * uv2.x) * scale);
}

// The tangents of the unit sphere at `p`, with longitude and latitude as coordinates (`sphere_uv`).
Tangents sphere_tangents(vec3 p) {
    float radius = sqrt_(p.x * p.x + p.z * p.z);
    // Zero at the poles.
    float slant = (p.y * PI) * rcp(radius);
    return Tangents(
        vec3(p.z * TWO_PI, 0.0, -(p.x * TWO_PI)),
        vec3(-(p.x * slant), radius * PI, -(p.z * slant))
    );
}

#ifdef GONIO_FETCH
// The gradients of the texture coordinates across the shading normal of `surface`, found for `hit`.
UvGradients gradients_at(Surface surface, Hit hit) {
    Instance instance = load_instance(hit.instance);
    Tangents tangents;
    if (instance.kind == KIND_SPHERE) {
        tangents = sphere_tangents(transform_point(instance.to_object, surface.position));
    } else {
        Face face = load_face(instance.first_face + hit.primitive);
        Vertex p0 = load_vertex(face.i0);
        Vertex p1 = load_vertex(face.i1);
        Vertex p2 = load_vertex(face.i2);
        tangents = triangle_tangents(
            p1.position - p0.position,
            p2.position - p0.position,
            vec2(p1.u - p0.u, p1.v - p0.v),
            vec2(p2.u - p0.u, p2.v - p0.v)
        );
    }
    return uv_gradients(
        transform_vector(instance.to_world, tangents.dp_du),
        transform_vector(instance.to_world, tangents.dp_dv),
        surface.normal
    );
}
#endif

#endif
