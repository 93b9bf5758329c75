// What surrounds the scene: a vertical gradient or an equirectangular image, seen and sampled.
//
// The image's grid: vertices are the centres of its texels (columns wrap round), and both poles; between them the
// density is bilinear, as the image itself is between texels, so it is zero only where the image is. Rows of cells next to
// the poles are half as high as the others.
#ifndef SHADING_ENVIRONMENT_GLSL
#define SHADING_ENVIRONMENT_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/texture.glsl"

// The largest float below 1.
const float BELOW_ONE = 0.99999994;
// 1 / (2 pi^2): area of the unit square of (u, v) over that of the sphere at the equator.
const float INV_TWO_PI_SQUARED = 0.0506605916;
// Sine of the angle from a pole below which no direction is drawn: the density has no limit there.
const float SIN_POLE = 1.0e-6;

// A direction to the environment.
struct EnvironmentSample {
    // Unit, world.
    vec3 wi;
    vec3 radiance;
    // 0 if the sample is to be dropped.
    float pdf_solid_angle;
};

// A point of the image's grid: the cell, and the place in it, 0..1 each way. Row 0 is at the upper pole.
struct GridPlace {
    uint column;
    uint row;
    float x;
    float y;
};

// x in [0, 1) with density proportional to a (1 - x) + b x, for a, b >= 0, not both 0. `u`: [0, 1).
float sample_linear(float u, float a, float b) {
    float low = div(a, a + b);
    float high = 1.0 - low;
    // The quadratic's root without cancellation.
    return min_(div(u, low + sqrt_((low * low) * (1.0 - u) + (high * high) * u)), BELOW_ONE);
}

// The bilinear function with values f00, f10 (x = 1), f01 (y = 1), f11 at the corners of the unit square.
float bilinear(float f00, float f10, float f01, float f11, float x, float y) {
    return mix_(mix_(f00, f10, x), mix_(f01, f11, x), y);
}

// `v` in the space of the rotation's rows.
vec3 rotate_to(vec4 rows[3], vec3 v) {
    return vec3(dot3(rows[0].xyz, v), dot3(rows[1].xyz, v), dot3(rows[2].xyz, v));
}

// `v`, given in the space of the rotation's rows, where they are given.
vec3 rotate_from(vec4 rows[3], vec3 v) {
    return (rows[0].xyz * v.x + rows[1].xyz * v.y) + rows[2].xyz * v.z;
}

// The unit direction at (u, v), both 0..1: u from -z over +x, +z and -x, v from +y down.
vec3 equirectangular_direction(vec2 uv) {
    float sin_theta = sin_turns(0.5 * uv.y);
    return vec3(sin_theta * sin_turns(uv.x), cos_turns(0.5 * uv.y), -sin_theta * cos_turns(uv.x));
}

// The inverse of `equirectangular_direction`.
vec2 equirectangular_uv(vec3 w) {
    float turns = atan2_(w.x, -w.z) * INV_TWO_PI;
    return vec2(turns < 0.0 ? turns + 1.0 : turns, acos_(w.y) * INV_PI);
}

// Where (u, v) lies in the grid of an image of this size.
GridPlace grid_place(uint width, uint height, vec2 uv) {
    float along = uv.x * float(width) - 0.5;
    float shifted = along < 0.0 ? along + float(width) : along;
    float left = min_(floor(shifted), float(width) - 1.0);
    float down = min_(max_(uv.y * float(height) + 0.5, 0.5), float(height) + 0.5);
    float above = min_(floor(down), float(height));
    uint row = uint(above);
    float y = down - above;
    // Of the rows at the poles there are the lower half of the first and the upper half of the last.
    float stretched = row == 0u ? max_(2.0 * y - 1.0, 0.0) : min_(2.0 * y, 1.0);
    bool polar = row == 0u || row == height;
    return GridPlace(uint(left), row, shifted - left, polar ? stretched : y);
}

// (u, v) of a point of the grid.
vec2 grid_uv(uint width, uint height, GridPlace place) {
    float along = (float(place.column) + 0.5) + place.x;
    float wrapped = along >= float(width) ? along - float(width) : along;
    bool first = place.row == 0u;
    float from = first ? 0.0 : float(place.row) - 0.5;
    float step_ = first || place.row == height ? 0.5 * place.y : place.y;
    return vec2(div(wrapped, float(width)), div(from + step_, float(height)));
}

// Density of the gradient's samples at `height`, 0 (-y) to 1 (+y). `luminance`: at both ends.
float gradient_pdf(vec2 luminance, float height) {
    return div(mix_(luminance.x, luminance.y, height), luminance.x + luminance.y) * INV_TWO_PI;
}

#ifdef GONIO_FETCH
// An interval of a CDF, and how far into it a number is, 0..1.
struct Interval {
    uint index;
    float rest;
};

// The interval 0..count of a CDF, whose count + 1 values begin at table entry `first`, that holds `u` (below 1). No
// interval of probability 0 is found.
Interval find_interval(uint first, uint count, float u) {
    uint low = 0u;
    uint high = count;
    // 2^17 entries: more than an image has rows or columns.
    for (uint i = 0u; i < 17u; i++) {
        if (high - low <= 1u) {
            break;
        }
        uint middle = (low + high) >> 1u;
        if (load_table(first + middle) <= u) {
            low = middle;
        } else {
            high = middle;
        }
    }
    float below = load_table(first + low);
    float above = load_table(first + low + 1u);
    return Interval(low, min_(div(u - below, above - below), BELOW_ONE));
}

// Density of (u, v) at the four corners of a cell: upper left, upper right, lower left, lower right.
vec4 cell_corners(EnvironmentMap map, uint column, uint row) {
    uint right = column + 1u == map.width ? 0u : column + 1u;
    uint upper = map.first_table + row * map.width;
    uint lower = upper + map.width;
    return vec4(
        load_table(upper + column),
        load_table(upper + right),
        load_table(lower + column),
        load_table(lower + right)
    );
}

// The image's radiance at (u, v).
vec3 map_radiance(EnvironmentMap map, vec2 uv) {
    // Textures count v from the bottom.
    vec4 texel = sample_texture(load_texture(map.texture), vec2(uv.x, 1.0 - uv.y));
    return texel.xyz * map.scale;
}

// Radiance where a ray leaves the scene along `direction` (unit).
Spectrum background(vec3 direction) {
    if (HAS_ENVIRONMENT_MAP) {
        EnvironmentMap map = load_environment_map(0u);
        vec2 uv = equirectangular_uv(rotate_to(map.to_local, direction));
        return spectrum_from_rgb(map_radiance(map, uv));
    }
    float height = direction.y * 0.5 + 0.5;
    return spectrum_from_rgb(mix3_(header.background_bottom, header.background_top, height));
}

// Luminance of the gradient towards -y and +y.
vec2 gradient_luminance() {
    float bottom = spectrum_luminance(spectrum_from_rgb(header.background_bottom));
    float top = spectrum_luminance(spectrum_from_rgb(header.background_top));
    return vec2(bottom, top);
}

// A direction drawn in proportion to the environment's luminance. `u`: 0..1 each, excluding 1.
EnvironmentSample sample_environment(vec2 u) {
    if (HAS_ENVIRONMENT_MAP) {
        EnvironmentMap map = load_environment_map(0u);
        uint cdfs = map.first_table + (map.height + 2u) * map.width;
        Interval row = find_interval(cdfs + (map.height + 1u) * (map.width + 1u), map.height + 1u, u.y);
        Interval column = find_interval(cdfs + row.index * (map.width + 1u), map.width, u.x);
        vec4 corners = cell_corners(map, column.index, row.index);
        float y = sample_linear(row.rest, corners.x + corners.y, corners.z + corners.w);
        float x = sample_linear(column.rest, mix_(corners.x, corners.z, y), mix_(corners.y, corners.w, y));
        vec2 uv = grid_uv(map.width, map.height, GridPlace(column.index, row.index, x, y));
        float density = bilinear(corners.x, corners.y, corners.z, corners.w, x, y);
        float sin_theta = sin_turns(0.5 * uv.y);
        return EnvironmentSample(
            rotate_from(map.to_local, equirectangular_direction(uv)),
            map_radiance(map, uv),
            sin_theta > SIN_POLE ? div(density * INV_TWO_PI_SQUARED, sin_theta) : 0.0
        );
    }
    vec2 luminance = gradient_luminance();
    float height = sample_linear(u.x, luminance.x, luminance.y);
    // 1 - y^2 for y = 2 height - 1, without cancellation.
    float radius = 2.0 * sqrt_(height * (1.0 - height));
    return EnvironmentSample(
        vec3(radius * cos_turns(u.y), 2.0 * height - 1.0, radius * sin_turns(u.y)),
        mix3_(header.background_bottom, header.background_top, height),
        gradient_pdf(luminance, height)
    );
}

// Density of `sample_environment` at `direction` (unit, world), per solid angle; its integral is 1.
float pdf_environment(vec3 direction) {
    if (HAS_ENVIRONMENT_MAP) {
        EnvironmentMap map = load_environment_map(0u);
        vec3 local = rotate_to(map.to_local, direction);
        GridPlace place = grid_place(map.width, map.height, equirectangular_uv(local));
        vec4 corners = cell_corners(map, place.column, place.row);
        float density = bilinear(corners.x, corners.y, corners.z, corners.w, place.x, place.y);
        float sin_theta = sqrt_(local.x * local.x + local.z * local.z);
        return sin_theta > SIN_POLE ? div(density * INV_TWO_PI_SQUARED, sin_theta) : 0.0;
    }
    return gradient_pdf(gradient_luminance(), direction.y * 0.5 + 0.5);
}

#endif

#endif
