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
        Closure c = no_closure();
        c.color = vec3(0.75, 0.5, 0.1);
        c.specular_color = vec3(1.0, 0.9, 0.8);
        c.emission = vec3(3.0, 2.0, 1.0);
        c.alpha_u = 0.25;
        c.alpha_v = 0.125;
        c.second_alpha_u = 0.5;
        c.second_alpha_v = 0.375;
        c.k_t = 0.25;
        c.blend = 0.9375;
        c.roughness = 0.1875;
        c.metallic = 0.75;
        c.anisotropic = 0.5;
        c.spec_trans = 0.25;
        c.spec_tint = 0.125;
        c.sheen = 0.75;
        c.sheen_tint = 0.875;
        c.flatness = 0.375;
        c.clearcoat = 0.625;
        c.clearcoat_gloss = 1.0;
        apply_parameter(c, argument_u(3u), v, argument(4u));
        result4(0u, vec4(c.color, c.specular_color.x));
        result3(4u, vec3(c.emission.y + c.roughness, c.alpha_u + c.second_alpha_v,
                (c.k_t + c.blend) + ((c.anisotropic + c.spec_trans) + (c.spec_tint + c.metallic))));
        result(7u, ((c.sheen + c.sheen_tint) + (c.flatness + c.clearcoat)) + (c.clearcoat_gloss + (c.second_alpha_u + c.alpha_v)));
        break;
    }
    }
}
