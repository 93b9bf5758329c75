#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Twins of warps, the tent filter, camera, texture coordinates and frames; numbers as in `src/verify/twins/warp.rs`.
#include "kernels/parity/harness.glsl"
#include "layout/records.glsl"
#include "shading/camera.glsl"
#include "shading/filter.glsl"
#include "shading/frame.glsl"
#include "shading/sampling.glsl"
#include "shading/texture.glsl"
#include "shading/warp.glsl"

// 512 x 256 pixels, of the kind that argument word 14 names.
Camera camera() {
    Camera c;
    c.eye = argument3(0u);
    c.kind = argument_u(14u);
    c.right = argument3(3u);
    c.scale_x = 0.00390625;
    c.up = argument3(6u);
    c.scale_y = 0.0078125;
    c.forward = argument3(9u);
    c.lens_radius = 0.125;
    c.focus_distance = 3.0;
    c.shift_x = 0.3;
    c.shift_y = -0.7;
    return c;
}

// A point of the lens from word 15.
vec2 on_lens() {
    return square_to_disk(vec2(unit_float(argument_u(15u)), unit_float(hash_u32(argument_u(15u)))));
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    // Sample points, as the samplers make them.
    vec2 u = vec2(unit_float(argument_u(0u)), unit_float(argument_u(1u)));
    vec3 v = argument3(0u);
    CameraRay ray;
    Frame frame;
    switch (function) {
    case 0u: result2(0u, square_to_disk(u)); break;
    case 1u: result2(0u, disk_to_square(argument2(0u))); break;
    case 2u: result3(0u, square_to_cosine_hemisphere(u)); break;
    case 3u: result2(0u, cosine_hemisphere_to_square(v)); break;
    case 4u: result3(0u, square_to_uniform_hemisphere(u)); break;
    case 5u: result3(0u, square_to_uniform_sphere(u)); break;
    case 6u: result2(0u, uniform_sphere_to_square(v)); break;
    case 7u: result2(0u, square_to_uniform_triangle(u)); result2(2u, uniform_triangle_to_square(u)); break;
    case 8u:
        result3(0u, vec3(cosine_hemisphere_pdf(v.z), uniform_hemisphere_pdf(v.z), uniform_sphere_pdf()));
        break;
    case 9u: result(0u, sample_tent(u.x)); break;
    case 10u:
        ray = camera_ray(camera(), argument(12u), argument(13u));
        result3(0u, ray.origin);
        result3(3u, ray.direction);
        break;
    case 11u: result(0u, finite_or_zero(v.x)); break;
    case 12u: result(0u, wrap_coordinate(v.x, argument_u(1u))); break;
    case 13u: result_u(0u, uint(wrap_texel(int(argument_u(0u)), int(argument_u(1u)) + 1, argument_u(2u)))); break;
    case 14u:
        frame = frame_from_tangent(v, argument3(3u));
        result3(0u, frame.tangent);
        result3(3u, frame.bitangent);
        break;
    case 15u:
        ray = through_lens(camera(), camera_ray(camera(), argument(12u), argument(13u)), on_lens());
        result3(0u, ray.origin);
        result3(3u, ray.direction);
        break;
    }
}
