#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Twins of textures, patterns and what they do to materials and normals; numbers as in `src/verify/twins/texture.rs`.
#include "kernels/parity/harness.glsl"
#include "layout/records.glsl"
#include "shading/coordinate.glsl"
#include "shading/footprint.glsl"
#include "shading/parameter.glsl"
#include "shading/pattern.glsl"
#include "shading/texture.glsl"
#include "trace/tangent.glsl"

// A texture whose size argument word 0 gives, and words 1 to 3 its scale and shear.
Texture texture_at() {
    Texture t;
    t.width = argument_u(0u) + 1u;
    t.height = (argument_u(0u) >> 1u) + 1u;
    t.level_count = argument_u(0u) & 7u;
    t.format = argument_u(0u) & 3u;
    t.scale_u = argument(1u);
    t.scale_v = argument(2u);
    t.shear_u = argument(3u);
    t.shear_v = 0.25;
    t.offset_u = 0.5;
    t.offset_v = -2.0;
    return t;
}

// The gradients at words 3 to 8, across the normal at word 0.
UvGradients gradients() {
    return uv_gradients(argument3(3u), argument3(6u), argument3(0u));
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    vec3 v = argument3(0u);
    vec2 uv = argument2(0u);
    switch (function) {
    case 0u:
        result2(0u, texture_uv(texture_at(), argument2(4u)));
        result2(2u, texture_vector(texture_at(), argument2(4u)));
        break;
    case 1u: {
        Detail detail = texture_detail(texture_at(), Footprint(argument2(4u), argument2(6u)));
        result3(0u, vec3(detail.spacing, detail.width));
        result_u(3u, detail.probes);
        break;
    }
    case 2u: {
        Texture scaled = texture_at();
        scaled.scale_u = 2.0;
        scaled.scale_v = -0.5;
        scaled.shear_u = 0.25;
        scaled.shear_v = 3.0;
        UvGradients own = texture_gradients(scaled, gradients());
        result3(0u, own.u);
        result3(3u, own.v);
        break;
    }
    case 3u: {
        Footprint footprint = cone_footprint(gradients(), v, argument3(9u), abs(argument(12u)));
        result4(0u, vec4(footprint.along, footprint.across));
        break;
    }
    case 4u: result3(0u, mapped_normal(v, gradients(), argument3(9u), argument(12u))); break;
    case 5u: result3(0u, raised_normal(v, gradients(), argument(9u), argument(10u))); break;
    case 6u: {
        Tangents tangents = triangle_tangents(v, argument3(3u), argument2(6u), argument2(8u));
        result3(0u, tangents.dp_du);
        result3(3u, tangents.dp_dv);
        break;
    }
    case 7u: {
        Tangents tangents = sphere_tangents(v);
        result3(0u, tangents.dp_du);
        result3(3u, tangents.dp_dv);
        break;
    }
    case 8u: {
        float width = abs(argument(2u));
        result3(0u, vec3(square_mean(uv.x, width), checker(uv, width), zone_plate(uv)));
        break;
    }
    case 9u: {
        float fractal = fractal_noise(uv, argument_u(5u), argument(2u), argument_u(4u), argument(3u));
        result2(0u, vec2(gradient_noise(uv, argument_u(4u)), fractal));
        break;
    }
    case 10u: {
        float covered_width = abs(argument(3u));
        result(0u, pattern_share(argument_u(6u), uv, argument_u(5u), argument(2u), argument_u(4u), covered_width));
        break;
    }
    case 11u: result3(0u, channel_value(vec4(v, argument(3u)), argument_u(4u))); break;
    case 12u: {
        Material m;
        m.color = vec3(0.75, 0.5, 0.1);
        m.specular_color = vec3(1.0, 0.9, 0.8);
        m.emission = vec3(3.0, 2.0, 1.0);
        m.m0 = 0.25;
        m.m1 = 0.5;
        m.k_t = 0.25;
        m.m0_v = 0.125;
        m.m1_v = 0.375;
        m.extra = 0.75;
        m.k = vec3(0.5, 0.25, 0.125);
        m.w0 = 0.75;
        m.w1 = 0.875;
        m.k_d = 0.375;
        m.k_s = 0.625;
        m.exponent = 1.0;
        Material applied = apply_parameter(m, argument_u(3u), v, argument(4u));
        result4(0u, vec4(applied.color, applied.specular_color.x));
        result3(4u, vec3(applied.emission.y, applied.m0 + applied.m1_v,
                (applied.k_t + applied.extra) + ((applied.k.x + applied.k.y) + applied.k.z)));
        result(7u, ((applied.w0 + applied.w1) + (applied.k_d + applied.k_s)) + applied.exponent);
        break;
    }
    }
}
