#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Twins of rays and of what they meet; numbers as in `src/verify/twins/trace.rs`.
#include "kernels/parity/harness.glsl"
#include "layout/records.glsl"
#include "trace/box_.glsl"
#include "trace/ray.glsl"
#include "trace/spawn.glsl"
#include "trace/sphere.glsl"
#include "trace/triangle.glsl"

vec4 argument4(uint k) { return vec4(argument3(k), argument(k + 3u)); }

// A surface at argument words 0 to 7: position, normal, error, primitive.
Surface surface() {
    Surface s;
    s.position = argument3(0u);
    s.normal_geometric = argument3(3u);
    s.error = argument(6u);
    s.instance = 7u;
    s.primitive = argument_u(7u);
    s.cone_width = 0.25;
    s.cone_spread = 0.125;
    return s;
}

// A ray from `origin` at the point of a triangle with the weights of argument words 12 and 13.
LevelRay aimed_ray(vec3 origin, vec3 v0, vec3 v1, vec3 v2) {
    float b1 = argument(12u);
    float b2 = argument(13u);
    vec3 target = (v0 * ((1.0 - b1) - b2) + v1 * b1) + v2 * b2;
    return prepare_ray(origin, target - origin);
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    vec3 v = argument3(0u);
    vec3 w = argument3(3u);
    vec4 m[3] = vec4[3](argument4(0u), argument4(4u), argument4(8u));
    vec3 p = argument3(12u);
    Instance instance;
    Node root;
    LevelRay ray = prepare_ray(v, w);
    Ray spawned;
    switch (function) {
    case 0u: result(0u, component(v, argument_u(3u))); break;
    case 1u:
        result3(0u, ray.direction);
        result3(3u, ray.inverse);
        result_u(6u, ray.kz);
        result_u(7u, ray.octant);
        break;
    case 2u: result3(0u, vec3(ray.sx, ray.sy, ray.sz)); result_u(3u, ray.kx); result_u(4u, ray.ky); break;
    case 3u: result_u(0u, within_reach(v) ? 1u : 0u); break;
    case 4u: result3(0u, transform_point(m, p)); result3(3u, transform_vector(m, p)); break;
    case 5u:
        instance.to_object = m;
        result3(0u, transform_transposed(m, p));
        result3(3u, object_origin(instance, p));
        break;
    case 6u:
        ray = prepare_ray(vec3(0.0), v);
        root.origin = w;
        root.exponents_imask = 0x00686868u + (argument_u(10u) & 0x000f0f0fu);
        result2(0u, box_interval(ray, axis_slack(ray, argument(9u)), w, argument3(6u)));
        result3(2u, axis_slack(ray, argument(9u)));
        result(5u, root_reach(root, ray));
        break;
    case 7u:
        ray = aimed_ray(v, w, argument3(6u), argument3(9u));
        result3(0u, intersect_triangle(ray, axis_slack(ray, SLACK), w, argument3(6u), argument3(9u)));
        break;
    case 8u:
        ray = prepare_ray(v, w * argument(6u));
        result(0u, intersect_sphere(ray, (argument_u(7u) & 1u) != 0u, (argument_u(7u) & 2u) != 0u));
        break;
    case 9u:
    case 10u:
        spawned = function == 9u ? spawn_ray(surface(), argument3(8u), argument(11u)) : spawn_through(surface(), argument3(8u), argument(11u));
        result4(0u, vec4(spawned.origin, spawned.t_max));
        result_u(4u, spawned.skip_instance);
        result_u(5u, spawned.skip_primitive);
        result_u(6u, spawned.skip_inward);
        result(7u, spawned.direction.z);
        break;
    }
}
