// The unit square bent onto disks, hemispheres, spheres and triangles.
//
// Points `u` come from [0, 1)^2; hemispheres and spheres have their pole at +z. Densities are per solid angle, and
// uniform unless said otherwise.
#ifndef SHADING_WARP_GLSL
#define SHADING_WARP_GLSL

#include "shading/math.glsl"

// A point of the unit disk; concentric squares become concentric circles (Shirley and Chiu 1997, "A low distortion
// map between disk and square").
vec2 square_to_disk(vec2 u) {
    float a = 2.0 * u.x - 1.0;
    float b = 2.0 * u.y - 1.0;
    bool wide = abs(a) > abs(b);
    float radius = wide ? a : b;
    // The angle from the nearer axis, an eighth of a turn at most.
    float turns = 0.125 * div(wide ? b : a, radius);
    float major = radius * cos_turns(turns);
    float minor = radius * sin_turns(turns);
    return wide ? vec2(major, minor) : vec2(minor, major);
}

// The inverse of `square_to_disk`, within 1e-6 in the disk.
vec2 disk_to_square(vec2 p) {
    bool wide = abs(p.x) > abs(p.y);
    float major = wide ? p.x : p.y;
    float minor = wide ? p.y : p.x;
    float radius = sqrt_(dot2(p, p));
    // 8 / (2 pi): -1..1 for an eighth of a turn each way.
    float turned = 1.27323949 * atan2_(minor, abs(major));
    float a = 0.5 + 0.5 * (major < 0.0 ? -radius : radius);
    float b = 0.5 + 0.5 * (turned * radius);
    return wide ? vec2(a, b) : vec2(b, a);
}

// A direction with density cos / pi: the disk lifted onto the hemisphere (Malley's method).
vec3 square_to_cosine_hemisphere(vec2 u) {
    vec2 p = square_to_disk(u);
    return vec3(p.x, p.y, sqrt_(1.0 - dot2(p, p)));
}

// cos / pi; 0 below the horizon.
float cosine_hemisphere_pdf(float cos_theta) {
    return max_(cos_theta, 0.0) * INV_PI;
}

// The inverse of `square_to_cosine_hemisphere`, within 1e-6.
vec2 cosine_hemisphere_to_square(vec3 w) {
    return disk_to_square(vec2(w.x, w.y));
}

// A direction of the upper hemisphere: u.x is 1 - height, u.y the azimuth (Archimedes' hat box).
vec3 square_to_uniform_hemisphere(vec2 u) {
    // 1 - z^2 for z = 1 - u.x, without cancellation.
    float radius = sqrt_(u.x * (2.0 - u.x));
    return vec3(radius * cos_turns(u.y), radius * sin_turns(u.y), 1.0 - u.x);
}

// 1 / (2 pi); 0 below the horizon.
float uniform_hemisphere_pdf(float cos_theta) {
    return cos_theta > 0.0 ? INV_TWO_PI : 0.0;
}

// A direction: u.x is the height from the top downwards, u.y the azimuth.
vec3 square_to_uniform_sphere(vec2 u) {
    // 1 - z^2 for z = 1 - 2 u.x, without cancellation.
    float radius = 2.0 * sqrt_(u.x * (1.0 - u.x));
    return vec3(radius * cos_turns(u.y), radius * sin_turns(u.y), 1.0 - 2.0 * u.x);
}

// 1 / (4 pi).
float uniform_sphere_pdf() {
    return INV_FOUR_PI;
}

// The inverse of `square_to_uniform_sphere`, within 1e-6 (u.y is 0 at the poles, and 1 may stand for 0).
vec2 uniform_sphere_to_square(vec3 w) {
    float turns = INV_TWO_PI * atan2_(w.y, w.x);
    return vec2(0.5 - 0.5 * w.z, turns < 0.0 ? turns + 1.0 : turns);
}

// Barycentric coordinates of the second and third corner, both >= 0, sum < 1 (Heitz 2019, "A Low-Distortion Map
// Between Triangle and Square").
vec2 square_to_uniform_triangle(vec2 u) {
    if (u.y > u.x) {
        float half_ = 0.5 * u.x;
        return vec2(half_, u.y - half_);
    }
    float half_ = 0.5 * u.y;
    return vec2(u.x - half_, half_);
}

// The inverse of `square_to_uniform_triangle`.
vec2 uniform_triangle_to_square(vec2 b) {
    if (b.y > b.x) {
        return vec2(2.0 * b.x, b.y + b.x);
    }
    return vec2(b.x + b.y, 2.0 * b.y);
}

#endif
