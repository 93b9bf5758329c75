// Reflection tabulated for each direction of light (row 9), anisotropic if the table has several azimuths of light: multilinear
// between the directions of light, by angle, and within each between the directions of view. O_s is a factor.
//
// A view's azimuth counts from the light's, so that highlights lie on each other where light directions are mixed.
// The table from `table` on: five counts (`Tabulated`); light angles and view angles from the normal in radians, ascending, those
// of views from 0 to pi / 2; the cosines of the latter. Then for each light angle, for each light azimuth: values R, G, B
// for each view angle, for each view azimuth; steps of the integral of value times cosine over view angles; for each of their
// intervals its steps over azimuths. Samples take `wo` for the light: exact as far as the table is reciprocal.
#ifndef SHADING_TABULATED_GLSL
#define SHADING_TABULATED_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// Share of samples that are cosine-weighted; the others follow the table.
const float TABULATED_COSINE = 0.25;
// 1 - TABULATED_COSINE.
const float TABULATED_SPECULAR = 0.75;
// 1 / (1 - TABULATED_COSINE).
const float TABULATED_REST = 1.33333337;
// Most angles or azimuths.
const float TABULATED_MOST = 4096.0;

// What a table holds, and where.
struct Tabulated {
    uint light_angles;
    // In one of `fold` equal parts of a turn.
    uint light_azimuths;
    uint view_angles;
    // In a turn.
    uint view_azimuths;
    uint fold;
    // First of the light angles, of the view angles, of the cosines, of the first direction of light.
    uint lights;
    uint views;
    uint cosines;
    uint slices;
    // From one direction of light to the next.
    uint stride;
};

// A place in a grid of angles and azimuths: the row and column before it, and 0..1 how far it is to the next ones.
struct TabulatedPlace {
    uint row;
    uint column;
    float along;
    float around;
};

// A count in the table, at least 1.
uint tabulated_count(uint index) { return uint(clamp_(load_table(index), 1.0, TABULATED_MOST)); }

// The head of the material's table.
Tabulated tabulated(Closure closure) {
    uint light_angles = tabulated_count(closure.table);
    uint light_azimuths = tabulated_count(closure.table + 1u);
    uint view_angles = tabulated_count(closure.table + 2u);
    uint view_azimuths = tabulated_count(closure.table + 3u);
    uint fold = tabulated_count(closure.table + 4u);
    uint lights = closure.table + 5u;
    uint views = lights + light_angles;
    uint cosines = views + view_angles;
    uint slices = cosines + view_angles;
    uint stride = 3u * (view_angles * view_azimuths) + view_angles + (view_angles - 1u) * (view_azimuths + 1u);
    return Tabulated(light_angles, light_azimuths, view_angles, view_azimuths, fold, lights, views, cosines, slices, stride);
}

// Which interval of `count` ascending knots from `first` on has `x`: 0 to count - 2, also for what lies outside.
uint tabulated_interval(uint first, uint count, float x) {
    uint low = 0u;
    uint high = count - 1u;
    // Twelve halvings reach one of TABULATED_MOST knots.
    for (uint step_ = 0u; step_ < 12u; step_++) {
        uint middle = (low + high) >> 1u;
        if (middle > low) {
            bool below = load_table(first + middle) <= x;
            low = below ? middle : low;
            high = below ? high : middle;
        }
    }
    return low;
}

// 0..1 from the knot at `index` to the next.
float tabulated_share(uint index, float x) {
    float begin = load_table(index);
    float size = load_table(index + 1u) - begin;
    return size > 0.0 ? clamp_(div(x - begin, size), 0.0, 1.0) : 0.0;
}

// The azimuth of `w` in turns, above -1 and up to 1; 0 along the normal.
float tabulated_turns(vec3 w) { return w.x * w.x + w.y * w.y > 1.0e-14 ? atan2_(w.y, w.x) * INV_TWO_PI : 0.0; }

// Where the unit vector `w` lies among `angles` angles from `first` on and `azimuths` equal parts of a period.
// `periods`: its azimuth in periods.
TabulatedPlace tabulated_place(uint first, uint angles, uint azimuths, vec3 w, float periods) {
    float angle = atan2_(sqrt_(w.x * w.x + w.y * w.y), w.z);
    uint row = tabulated_interval(first, angles, angle);
    float along = angles > 1u ? tabulated_share(first + row, angle) : 0.0;
    float x = (periods - floor(periods)) * float(azimuths);
    float column = clamp_(floor(x), 0.0, float(azimuths) - 1.0);
    return TabulatedPlace(row, uint(column), along, clamp_(x - column, 0.0, 1.0));
}

// Number of a corner of the cell at a place. `corner`: bit 0 the next azimuth, bit 1 the next angle.
uint tabulated_corner(TabulatedPlace place, uint angles, uint azimuths, uint corner) {
    uint row = place.row + (corner >> 1u);
    uint column = place.column + (corner & 1u);
    uint last = angles - 1u;
    return (row > last ? last : row) * azimuths + (column < azimuths ? column : 0u);
}

// Bilinear weight of a corner, 0..1.
float tabulated_weight(TabulatedPlace place, uint corner) {
    float along = corner >= 2u ? place.along : 1.0 - place.along;
    float around = (corner & 1u) != 0u ? place.around : 1.0 - place.around;
    return along * around;
}

// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
Spectrum eval_tabulated(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    Tabulated t = tabulated(closure);
    float turns = tabulated_turns(wi);
    TabulatedPlace light = tabulated_place(t.lights, t.light_angles, t.light_azimuths, wi, turns * float(t.fold));
    TabulatedPlace view = tabulated_place(t.views, t.view_angles, t.view_azimuths, wo, tabulated_turns(wo) - turns);
    vec3 sum = vec3(0.0, 0.0, 0.0);
    for (uint i = 0u; i < 4u; i++) {
        uint slice = t.slices + tabulated_corner(light, t.light_angles, t.light_azimuths, i) * t.stride;
        float share = tabulated_weight(light, i);
        for (uint j = 0u; j < 4u; j++) {
            uint at = slice + 3u * tabulated_corner(view, t.view_angles, t.view_azimuths, j);
            vec3 value = vec3(load_table(at), load_table(at + 1u), load_table(at + 2u));
            sum += value * (share * tabulated_weight(view, j));
        }
    }
    return spectrum_from_rgb((closure.specular_color * sum) * wi.z);
}

// Density of `sample_tabulated`.
float pdf_tabulated(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    Tabulated t = tabulated(closure);
    float turns = tabulated_turns(wo);
    TabulatedPlace light = tabulated_place(t.lights, t.light_angles, t.light_azimuths, wo, turns * float(t.fold));
    TabulatedPlace cell = tabulated_place(t.views, t.view_angles, t.view_azimuths, wi, tabulated_turns(wi) - turns);
    uint steps = 3u * (t.view_angles * t.view_azimuths);
    float chance = 0.0;
    for (uint i = 0u; i < 4u; i++) {
        uint slice = t.slices + tabulated_corner(light, t.light_angles, t.light_azimuths, i) * t.stride;
        uint row = slice + steps + cell.row;
        uint column = slice + steps + t.view_angles + cell.row * (t.view_azimuths + 1u) + cell.column;
        float rows = load_table(row + 1u) - load_table(row);
        float columns = load_table(column + 1u) - load_table(column);
        chance += tabulated_weight(light, i) * (rows * columns);
    }
    float high = load_table(t.cosines + cell.row) - load_table(t.cosines + cell.row + 1u);
    float specular = div(max_(chance, 0.0) * float(t.view_azimuths), max_(high, 1.0e-12) * TWO_PI);
    return TABULATED_COSINE * (wi.z * INV_PI) + TABULATED_SPECULAR * specular;
}

// Cosine-weighted, or drawn from the values for light from about `wo`. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, excluding 1,
// chooses, also among the directions of light next to `wo`.
DirectionSample sample_tabulated(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    vec3 wi = square_to_cosine_hemisphere(u);
    if (u_lobe >= TABULATED_COSINE && wo.z > 0.0) {
        Tabulated t = tabulated(closure);
        float turns = tabulated_turns(wo);
        TabulatedPlace light = tabulated_place(t.lights, t.light_angles, t.light_azimuths, wo, turns * float(t.fold));
        float choice = (u_lobe - TABULATED_COSINE) * TABULATED_REST;
        float first = tabulated_weight(light, 0u);
        float second = first + tabulated_weight(light, 1u);
        float third = second + tabulated_weight(light, 2u);
        uint upper = choice < third ? 2u : 3u;
        uint lower = choice < first ? 0u : 1u;
        uint corner = choice < second ? lower : upper;
        uint slice = t.slices + tabulated_corner(light, t.light_angles, t.light_azimuths, corner) * t.stride;
        uint rows = slice + 3u * (t.view_angles * t.view_azimuths);
        uint row = tabulated_interval(rows, t.view_angles, u.x);
        uint columns = rows + t.view_angles + row * (t.view_azimuths + 1u);
        uint column = tabulated_interval(columns, t.view_azimuths + 1u, u.y);
        float down = tabulated_share(rows + row, u.x);
        float around = tabulated_share(columns + column, u.y);
        float z = mix_(load_table(t.cosines + row), load_table(t.cosines + row + 1u), down);
        float azimuth = turns + (float(column) + around) * rcp(float(t.view_azimuths));
        float sine = sqrt_(max_((1.0 - z) * (1.0 + z), 0.0));
        wi = vec3(sine * cos_turns(azimuth), sine * sin_turns(azimuth), z);
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, pdf_tabulated(closure, wo, wi));
}

#endif
