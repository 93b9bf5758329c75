#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Twins of Fresnel terms, microfacets, dielectrics and lights; numbers as in `src/verify/twins/shading.rs`.
#include "kernels/parity/harness.glsl"
#include "layout/records.glsl"
#include "shading/dielectric.glsl"
#include "shading/frame.glsl"
#include "shading/fresnel.glsl"
#include "shading/light.glsl"
#include "shading/lobe.glsl"
#include "shading/microfacet.glsl"

// A light of any kind around the origin; argument words 3 to 10 say which.
Light light() {
    Light l;
    l.position = vec3(0.5, 2.0, -1.0);
    l.kind = argument_u(3u);
    l.direction = argument3(5u);
    l.attenuation = argument_u(4u);
    l.intensity = vec3(3.0, 2.0, 0.25);
    l.cos_outer = argument(8u) * 0.5;
    l.c = vec3(0.25, 0.5, 0.125);
    l.cos_inner = argument(8u);
    l.flaps_min = vec3(-1.0, -T_INFINITE, -2.0);
    l.exponent = argument(9u);
    l.flaps_max = vec3(T_INFINITE, 3.0, 2.0);
    l.casts_shadow = 1u;
    return l;
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    float a = argument(0u);
    float b = argument(1u);
    vec3 v = argument3(0u);
    vec3 w = argument3(3u);
    Frame frame;
    Refraction refraction;
    LightSample lit;
    switch (function) {
    case 0u: result(0u, fresnel_dielectric(a, b)); break;
    case 1u: result(0u, fresnel_conductor(a, b, argument(2u))); break;
    case 2u: result3(0u, fresnel_conductor3(a, argument3(1u), argument3(4u))); break;
    case 3u: result(0u, tan2_theta(v)); break;
    case 4u: result(0u, beckmann_d(a, b)); break;
    case 5u: result(0u, beckmann_lobes_d_slope(abs(a), b, argument(2u), argument(3u), argument(4u))); break;
    case 6u: result(0u, v_cavity_g(a, b, argument(2u), argument(3u))); break;
    case 7u: result3(0u, sample_beckmann(argument2(0u), argument(2u))); break;
    case 8u: result(0u, pdf_beckmann(v, argument(3u))); break;
    case 9u:
        refraction = refract_local(v, argument(3u));
        result4(0u, vec4(refraction.wt, refraction.cos_t));
        result_u(4u, refraction.total ? 1u : 0u);
        break;
    case 10u: result4(0u, transmittance(abs(v), abs(argument(3u)))); break;
    case 11u: result(0u, cos_power(a, b)); break;
    case 12u: result3(0u, sample_cos_power(argument2(0u), argument(2u))); break;
    case 13u: result(0u, pdf_cos_power(a, b)); break;
    case 14u: result3(0u, reflect_about(v, w)); break;
    case 15u: result3(0u, turn_to(v, w)); break;
    case 16u:
        frame = frame_from_normal(v);
        result3(0u, to_local(frame, w));
        result3(3u, to_world(frame, w));
        break;
    case 17u: result(0u, attenuate(light(), abs(a), a * a)); result(1u, spot_factor(light(), argument(5u))); break;
    case 18u:
        lit = sample_light(light(), v);
        result4(0u, vec4(lit.wi, lit.distance));
        result4(4u, lit.radiance);
        break;
    }
}
