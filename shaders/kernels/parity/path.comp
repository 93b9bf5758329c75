#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Twins of the environment's grid, of lights with a size and of a path's decisions; numbers as in
// `src/verify/twins/path.rs`.
#include "kernels/parity/harness.glsl"
#include "layout/records.glsl"
#include "shading/environment.glsl"
#include "shading/interior.glsl"
#include "shading/light.glsl"
#include "transport/area_light.glsl"
#include "transport/weight.glsl"

// Argument words 0 to 8: a triangle's corner and edges, or the rows of a linear map.
Emitter emitter() {
    Emitter e;
    e.corner = argument3(0u);
    e.kind = EMITTER_TRIANGLE;
    e.edge1 = argument3(3u);
    e.instance = 0u;
    e.edge2 = argument3(6u);
    e.primitive = 0u;
    e.normal = normalize3(cross3(e.edge1, e.edge2));
    e.density = 0.375;
    e.radiance = vec3(2.0, 1.0, 0.5);
    e.flags = argument_u(14u);
    return e;
}

Instance instance() {
    Instance r;
    for (uint row = 0u; row < 3u; row++) {
        vec4 v = vec4(argument3(3u * row), 0.25);
        r.to_world[row] = v;
        r.to_object[row] = v;
    }
    return r;
}

void result_light(LightSample lit) {
    result4(0u, vec4(lit.wi, lit.distance));
    result4(4u, vec4(lit.radiance.xyz, lit.pdf_solid_angle));
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    float a = argument(0u);
    float b = argument(1u);
    vec3 v = argument3(0u);
    vec4 rows[3] = vec4[3](vec4(v, 0.0), vec4(argument3(3u), 0.0), vec4(argument3(6u), 0.0));
    uint width = argument_u(3u) + 1u;
    uint height = argument_u(4u) + 1u;
    GridPlace place;
    Surface surface;
    Material material;
    uint list;
    switch (function) {
    case 0u: result(0u, sample_linear(a, b, argument(2u))); break;
    case 1u: result(0u, bilinear(a, b, argument(2u), argument(3u), argument(4u), argument(5u))); break;
    case 2u: result3(0u, rotate_to(rows, argument3(9u))); result3(3u, rotate_from(rows, argument3(9u))); break;
    case 3u: result3(0u, equirectangular_direction(argument2(0u))); break;
    case 4u: result2(0u, equirectangular_uv(v)); break;
    case 5u:
        place = grid_place(width, height, argument2(0u));
        result_u(0u, place.column);
        result_u(1u, place.row);
        result2(2u, vec2(place.x, place.y));
        result2(4u, grid_uv(width, height, place));
        break;
    case 6u: result(0u, gradient_pdf(argument2(0u), argument(2u))); break;
    case 7u: result(0u, power_heuristic(abs(a), abs(b))); break;
    case 8u: result(0u, area_to_solid_angle(abs(a), abs(b), argument(2u))); break;
    case 9u: result_light(sample_triangle_light(emitter(), argument3(9u), argument2(12u))); break;
    case 10u: result(0u, solid_angle_ratio(instance(), argument3(9u))); break;
    case 11u:
        result(0u, cone_height(1.0001 + dot3(v, v)));
        result3(1u, cone_point(v, 1.0001 + dot3(v, v), argument2(3u)));
        break;
    case 12u: result(0u, sphere_pdf(v, argument3(3u))); break;
    case 13u: result_light(sample_sphere_light(emitter(), instance(), argument3(9u), argument2(12u))); break;
    case 14u: result(0u, survival(abs(vec4(v, argument(3u))), argument(4u))); break;
    case 15u:
        surface.normal_geometric = v;
        result_u(0u, consistent(surface, argument3(3u), argument3(6u), argument3(9u), argument3(12u)) ? 1u : 0u);
        break;
    case 16u: result(0u, no_light().pdf_solid_angle); result3(1u, no_light().wi); break;
    case 17u:
        // Few ranks, so that those asked for are often there.
        list = argument_u(0u) & 0x03030303u;
        result_u(0u, interior_add(list, argument_u(1u) + 1u));
        result_u(1u, interior_remove(list, argument_u(1u) + 1u));
        result_u(2u, interior_top(list));
        result_u(3u, cross_interface(list, argument_u(3u), argument_u(4u) != 0u));
        break;
    }
}
