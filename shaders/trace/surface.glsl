// What a ray has hit.
#ifndef TRACE_SURFACE_GLSL
#define TRACE_SURFACE_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/math.glsl"
#include "trace/ray.glsl"

// 2^-19: bound of a surface point's error relative to the size of the numbers it was made from (32 roundings: the
// point's own, and those of bringing it into object space again).
const float POSITION_ERROR = 1.9073486e-6;
// Edges this close to parallel (sine) have no normal of their own in single precision.
const float FLAT_LEAST = 1.0e-7;

// A point on a surface, world space.
struct Surface {
    vec3 position;
    // Unit, leaves the side from which the corners are counter-clockwise in object space (the outside of a closed
    // mesh, and of a sphere); a mirroring transform keeps the outside outside.
    vec3 normal_geometric;
    // Unit, interpolated, on the same side as `normal_geometric`.
    vec3 normal;
    // v = 0 at the bottom of an image.
    vec2 uv;
    // Linear factor on the base colour.
    vec3 color;
    // The instance's material, or the face's.
    uint material;
    uint object;
    uint instance;
    uint primitive;
    // `KIND_*`.
    uint kind;
    // Bound of the distance between `position` and the surface as rays see it, world units.
    float error;
    // Width of the ray's cone here, and what it grows by per unit of distance.
    float cone_width;
    float cone_spread;
};

// `v` made unit; `otherwise` if it is (as good as) zero.
vec3 unit_or(vec3 v, vec3 otherwise) {
    vec3 n = normalize3(v);
    return dot3(n, n) > 0.5 ? n : otherwise;
}

// A normal of object space in world space (inverse transpose), unit.
vec3 world_normal(Instance instance, vec3 normal, vec3 otherwise) {
    return unit_or(transform_transposed(instance.to_object, normal), otherwise);
}

// The bound of `Surface.error` for a point whose object-space coordinates stay below `size`.
float position_error(Instance instance, vec3 size) {
    vec4 m[3] = instance.to_world;
    float x = ((abs(m[0].x) * size.x + abs(m[0].y) * size.y) + abs(m[0].z) * size.z) + abs(m[0].w);
    float y = ((abs(m[1].x) * size.x + abs(m[1].y) * size.y) + abs(m[1].z) * size.z) + abs(m[1].w);
    float z = ((abs(m[2].x) * size.x + abs(m[2].y) * size.y) + abs(m[2].z) * size.z) + abs(m[2].w);
    return max_(max_(x, y), z) * POSITION_ERROR;
}

// Longitude and latitude of a point on the unit sphere: u grows to the right as seen from outside with y up, 0.5
// towards +z; v from 0 at -y to 1 at +y.
vec2 sphere_uv(vec3 p) {
    float u = p.x == 0.0 && p.z == 0.0 ? 0.5 : 0.5 + atan2_(p.x, p.z) * INV_TWO_PI;
    return vec2(u, acos_(clamp_(-p.y, -1.0, 1.0)) * INV_PI);
}

#ifdef GONIO_FETCH
Surface sphere_surface(Instance instance, Ray ray, Hit hit) {
    vec3 origin = object_origin(instance, ray.origin);
    vec3 along = transform_vector(instance.to_object, ray.direction);
    vec3 point = unit_or(origin + along * hit.t, vec3(0.0, 0.0, 1.0));
    vec3 normal = world_normal(instance, point, vec3(0.0, 0.0, 1.0));
    return Surface(
        transform_point(instance.to_world, point),
        normal,
        normal,
        sphere_uv(point),
        vec3(1.0),
        instance.material,
        instance.object,
        hit.instance,
        0u,
        instance.kind,
        position_error(instance, vec3(1.0)),
        ray.cone_width + ray.cone_spread * hit.t,
        ray.cone_spread
    );
}

Surface triangle_surface(Instance instance, Ray ray, Hit hit) {
    Face face = load_face(instance.first_face + hit.primitive);
    Vertex p0 = load_vertex(face.i0);
    Vertex p1 = load_vertex(face.i1);
    Vertex p2 = load_vertex(face.i2);
    float b1 = hit.b1;
    float b2 = hit.b2;
    float b0 = max_((1.0 - b1) - b2, 0.0);
    vec3 point = (p0.position * b0 + p1.position * b1) + p2.position * b2;
    vec3 size = vec3(
        max_(max_(abs(p0.position.x), abs(p1.position.x)), abs(p2.position.x)),
        max_(max_(abs(p0.position.y), abs(p1.position.y)), abs(p2.position.y)),
        max_(max_(abs(p0.position.z), abs(p1.position.z)), abs(p2.position.z))
    );
    // Unit edges, so that the cross product of a tiny triangle is not lost.
    vec3 side = cross3(unit_or(p1.position - p0.position, vec3(0.0)), unit_or(p2.position - p0.position, vec3(0.0)));
    bool flat_ = max_(max_(abs(side.x), abs(side.y)), abs(side.z)) < FLAT_LEAST;
    vec3 geometric = world_normal(instance, flat_ ? p0.normal : side, vec3(0.0, 0.0, 1.0));
    vec3 smooth_ = (p0.normal * b0 + p1.normal * b1) + p2.normal * b2;
    vec3 normal = world_normal(instance, smooth_, geometric);
    return Surface(
        transform_point(instance.to_world, point),
        geometric,
        dot3(normal, geometric) < 0.0 ? -normal : normal,
        vec2((p0.u * b0 + p1.u * b1) + p2.u * b2, (p0.v * b0 + p1.v * b1) + p2.v * b2),
        (p0.color * b0 + p1.color * b1) + p2.color * b2,
        instance.material == INVALID ? face.material : instance.material,
        instance.object,
        hit.instance,
        hit.primitive,
        instance.kind,
        position_error(instance, size),
        ray.cone_width + ray.cone_spread * hit.t,
        ray.cone_spread
    );
}

// Where the texture coordinate u grows on `surface`, world space, any length; zero where it has no direction.
vec3 surface_tangent(Surface surface) {
    Instance instance = load_instance(surface.instance);
    if (instance.kind == KIND_SPHERE) {
        vec3 point = transform_point(instance.to_object, surface.position);
        return transform_vector(instance.to_world, vec3(point.z, 0.0, -point.x));
    }
    Face face = load_face(instance.first_face + surface.primitive);
    Vertex p0 = load_vertex(face.i0);
    Vertex p1 = load_vertex(face.i1);
    Vertex p2 = load_vertex(face.i2);
    float dv1 = p1.v - p0.v;
    float dv2 = p2.v - p0.v;
    float area = (p1.u - p0.u) * dv2 - (p2.u - p0.u) * dv1;
    vec3 along = (p1.position - p0.position) * dv2 - (p2.position - p0.position) * dv1;
    return transform_vector(instance.to_world, area < 0.0 ? -along : along);
}

// The surface at `hit`, which `trace_closest` found for `ray` (not a miss). The position is recomputed from the
// barycentric weights or, on a sphere, pushed onto it, and does not inherit the error of t.
Surface surface_at(Ray ray, Hit hit) {
    Instance instance = load_instance(hit.instance);
    if (HAS_SPHERES && instance.kind == KIND_SPHERE) {
        return sphere_surface(instance, ray, hit);
    }
    return triangle_surface(instance, ray, hit);
}
#endif

#endif
