// A ray as one level of the hierarchy sees it.
#ifndef TRACE_RAY_GLSL
#define TRACE_RAY_GLSL

#include "layout/records.glsl"
#include "shading/math.glsl"

// Components of a direction smaller than this part of the largest one (2^-40) become 0, and their reciprocals that of
// this part: no plane distance overflows, and the direction changes by far less than its own rounding.
const float DIRECTION_LEAST = 9.094947e-13;
// Farther away than this (2^40), in units of the level, nothing is hit: products of three lengths stay finite.
const float ORIGIN_LIMIT = 1.0995116e12;
// 2^-60.
const float DUST = 8.6736174e-19;

// A ray in world space or in an instance's object space, with what the box and triangle tests need of it.
struct LevelRay {
    vec3 origin;
    // Not unit in object space: t keeps the units of the world direction.
    vec3 direction;
    // Reciprocal of each component (of `rcp`'s accuracy); large but finite where the component is 0.
    vec3 inverse;
    // Axis along which the direction is largest, and the two others in cyclic order.
    uint kz;
    uint kx;
    uint ky;
    // The shear that makes the direction the axis kz: direction.kx / direction.kz, direction.ky / direction.kz and
    // 1 / direction.kz (Woop, Benthin and Wald 2013, section 3.2).
    float sx;
    float sy;
    float sz;
    // In each of four bytes, bits 4, 2, 1: the x, y, z of `inverse` is not negative.
    uint octant;
};

// Component `k` (0 to 2) of `v`.
float component(vec3 v, uint k) {
    return k == 0u ? v.x : (k == 1u ? v.y : v.z);
}

// `x`, or `least` with the sign of `x` if `x` is smaller.
float at_least(float x, float least) {
    return abs(x) < least ? (x < 0.0 ? -least : least) : x;
}

// The ray from `origin` along `direction` (largest component 2^-38 to 2^38), ready for one level.
LevelRay prepare_ray(vec3 origin, vec3 direction) {
    float ax = abs(direction.x);
    float ay = abs(direction.y);
    float az = abs(direction.z);
    float longest = max_(max_(ax, ay), az);
    float least = longest * DIRECTION_LEAST;
    vec3 d = vec3(
        ax < least ? 0.0 : direction.x,
        ay < least ? 0.0 : direction.y,
        az < least ? 0.0 : direction.z
    );
    float x = at_least(direction.x, least);
    float y = at_least(direction.y, least);
    float z = at_least(direction.z, least);
    vec3 inverse = vec3(rcp(x), rcp(y), rcp(z));
    uint kz = ax > ay ? (ax > az ? 0u : 2u) : (ay > az ? 1u : 2u);
    uint kx = kz == 2u ? 0u : kz + 1u;
    uint ky = kx == 2u ? 0u : kx + 1u;
    float sz = component(inverse, kz);
    float sx = component(d, kx) * sz;
    float sy = component(d, ky) * sz;
    uint bits = (x < 0.0 ? 0u : 4u) | (y < 0.0 ? 0u : 2u) | (z < 0.0 ? 0u : 1u);
    return LevelRay(origin, d, inverse, kz, kx, ky, sx, sy, sz, bits * 0x01010101u);
}

// Whether a ray starts close enough for the level's arithmetic: every component within 2^40.
bool within_reach(vec3 origin) {
    return abs(origin.x) <= ORIGIN_LIMIT && abs(origin.y) <= ORIGIN_LIMIT && abs(origin.z) <= ORIGIN_LIMIT;
}

// The affine map of the rows `m`, applied to a point.
vec3 transform_point(vec4 m[3], vec3 p) {
    return vec3(
        ((m[0].x * p.x + m[0].y * p.y) + m[0].z * p.z) + m[0].w,
        ((m[1].x * p.x + m[1].y * p.y) + m[1].z * p.z) + m[1].w,
        ((m[2].x * p.x + m[2].y * p.y) + m[2].z * p.z) + m[2].w
    );
}

// Its linear part, applied to a vector.
vec3 transform_vector(vec4 m[3], vec3 v) {
    return vec3(
        (m[0].x * v.x + m[0].y * v.y) + m[0].z * v.z,
        (m[1].x * v.x + m[1].y * v.y) + m[1].z * v.z,
        (m[2].x * v.x + m[2].y * v.y) + m[2].z * v.z
    );
}

// The transpose of its linear part, applied to a vector: normals go to world space by `to_object`.
vec3 transform_transposed(vec4 m[3], vec3 v) {
    return vec3(
        (m[0].x * v.x + m[1].x * v.y) + m[2].x * v.z,
        (m[0].y * v.x + m[1].y * v.y) + m[2].y * v.z,
        (m[0].z * v.x + m[1].z * v.y) + m[2].z * v.z
    );
}

// A component smaller than 2^-60 becomes 0, so that no difference with a vertex (bake does the same to those) has
// so few bits that the survival of subnormals could matter.
vec3 without_dust(vec3 p) {
    return vec3(
        abs(p.x) < DUST ? 0.0 : p.x,
        abs(p.y) < DUST ? 0.0 : p.y,
        abs(p.z) < DUST ? 0.0 : p.z
    );
}

// Where a world-space ray starts in the instance's object space.
vec3 object_origin(Instance instance, vec3 origin) {
    return without_dust(transform_point(instance.to_object, origin));
}

#endif
