// Measured isotropic reflection (row 9) over Rusinkiewicz's angles theta_h, theta_d, phi_d of the half and difference vectors.
//
// The table from `table` on: MEASURED_H + 1 steps of the integral over theta_h that samples are drawn from, then planes R, G, B of
// 90 x 90 x 180 values as MERL stores them; the value of a cell holds in all of it. O_s is a factor.
// Sources: Matusik et al. 2003, "A Data-Driven Reflectance Model"; Rusinkiewicz 1998, "A New Change of Variables for
// Efficient BRDF Representation".
#ifndef SHADING_MEASURED_GLSL
#define SHADING_MEASURED_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// Cells in theta_h, of sizes that grow with the angle, in theta_d and in phi_d.
const uint MEASURED_H = 90u;
const uint MEASURED_D = 90u;
const uint MEASURED_P = 180u;
// 2 / pi.
const float INV_HALF_PI = 0.636619747;
// Share of samples that are cosine-weighted; as many follow the table.
const float MEASURED_COSINE = 0.5;

// A cell's number. `x`: 0..1 from the first to the last of `count` cells.
uint measured_cell(float x, uint count) {
    float last = float(count) - 1.0;
    return uint(clamp_(floor(x * float(count)), 0.0, last));
}

// The cell of theta_h: its number grows as the root of the angle. `wm`: unit, z > 0.
uint measured_cell_h(vec3 wm) {
    float theta = atan2_(sqrt_(wm.x * wm.x + wm.y * wm.y), wm.z);
    return measured_cell(sqrt_(max_(theta * INV_HALF_PI, 0.0)), MEASURED_H);
}

// sin^2 of the angle at which a cell of theta_h begins.
float measured_edge(uint cell) {
    float x = float(cell) * 0.0111111114;
    float sine = sin_((x * x) * HALF_PI);
    return sine * sine;
}

// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
Spectrum eval_measured(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    vec3 wm = normalize3(wo + wi);
    float across = sqrt_(wm.x * wm.x + wm.y * wm.y);
    // The frame of the half vector: x towards growing theta_h, y along phi_h.
    float cos_h = across > 1.0e-7 ? div(wm.x, across) : 1.0;
    float sin_h = across > 1.0e-7 ? div(wm.y, across) : 0.0;
    float along = wi.x * cos_h + wi.y * sin_h;
    float x = along * wm.z - wi.z * across;
    float y = wi.y * cos_h - wi.x * sin_h;
    float z = along * across + wi.z * wm.z;
    float theta_d = atan2_(sqrt_(x * x + y * y), z);
    float phi_d = atan2_(y, x);
    // Light and viewer may change places: phi_d and phi_d + pi are the same cell.
    float turn = phi_d * INV_PI;
    turn = turn < 0.0 ? turn + 1.0 : turn;
    uint cell = measured_cell_h(wm) * MEASURED_D + measured_cell(theta_d * INV_HALF_PI, MEASURED_D);
    cell = cell * MEASURED_P + measured_cell(turn, MEASURED_P);
    uint first = closure.table + (MEASURED_H + 1u);
    uint plane = MEASURED_H * (MEASURED_D * MEASURED_P);
    vec3 value = vec3(load_table(first + cell), load_table((first + plane) + cell), load_table((first + 2u * plane) + cell));
    return spectrum_from_rgb((closure.specular_color * value) * wi.z);
}

// Density of `sample_measured`; its integral over the upper side is below 1 by what falls under the horizon.
float pdf_measured(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    vec3 wm = normalize3(wo + wi);
    uint cell = measured_cell_h(wm);
    float share = load_table(closure.table + cell + 1u) - load_table(closure.table + cell);
    float size = measured_edge(cell + 1u) - measured_edge(cell);
    float facets = div(share * wm.z, PI * max_(size, 1.0e-12));
    float specular = div(max_(facets, 0.0), 4.0 * max_(dot3(wo, wm), 1.0e-7));
    return MEASURED_COSINE * (wi.z * INV_PI + specular);
}

// Cosine-weighted, or `wo` mirrored about a half vector of a cell drawn by what the table reflects there; what falls below
// the horizon is dropped. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
DirectionSample sample_measured(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    vec3 wi = square_to_cosine_hemisphere(u);
    if (u_lobe >= MEASURED_COSINE) {
        uint low = 0u;
        uint high = MEASURED_H;
        // Seven halvings reach one of 90 cells.
        for (uint step_ = 0u; step_ < 7u; step_++) {
            uint middle = (low + high) >> 1u;
            if (middle > low) {
                bool below = load_table(closure.table + middle) <= u.x;
                low = below ? middle : low;
                high = below ? high : middle;
            }
        }
        float begin = load_table(closure.table + low);
        float share = load_table(closure.table + low + 1u) - begin;
        float within = clamp_(div(u.x - begin, share), 0.0, 1.0);
        float sin2 = mix_(measured_edge(low), measured_edge(low + 1u), within);
        float sin_h = sqrt_(sin2);
        vec3 wm = vec3(sin_h * cos_turns(u.y), sin_h * sin_turns(u.y), sqrt_(max_(1.0 - sin2, 0.0)));
        wi = reflect_about(wo, wm);
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, pdf_measured(closure, wo, wi));
}

#endif
