// The watertight ray-triangle test.
#ifndef TRACE_TRIANGLE_GLSL
#define TRACE_TRIANGLE_GLSL

#include "shading/math.glsl"
#include "trace/box_.glsl"
#include "trace/ray.glsl"

// Edge functions smaller than this (2^-86) count as 0, "on the edge": their products may have lost bits to subnormals.
const float EDGE_LEAST = 1.2924697e-26;
const vec3 TRIANGLE_MISS = vec3(-1.0, 0.0, 0.0);

// Twice the signed area of (p, q) as seen along the ray. `signed_area(q, p)` is exactly its negative, so a ray
// between two triangles that share an edge is on one side for one of them.
float signed_area(float px, float py, float qx, float qy) {
    float area = px * qy - py * qx;
    return abs(area) < EDGE_LEAST ? 0.0 : area;
}

// Where the ray meets the triangle `v0`, `v1`, `v2` (same space as the ray): (t, b1, b2) with the weights of corners
// 1 and 2 in 0..1 and t > 0 in units of the ray's direction; t = -1 for a miss. `slack`: the `axis_slack` of the mesh
// (`box_`, the bound, step 3). Both sides count. An edge value of 0 is
// inside, so a ray through a shared edge or corner hits at least one of the triangles there.
// Source: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", without the fallback to double
// precision (single precision never gets a sign wrong, only to 0). t is kept in the interval of the triangle's own
// box (`box_interval`), where it is except for triangles seen so edge-on that their weights are rounding noise.
vec3 intersect_triangle(LevelRay ray, vec3 slack, vec3 v0, vec3 v1, vec3 v2) {
    vec3 a = v0 - ray.origin;
    vec3 b = v1 - ray.origin;
    vec3 c = v2 - ray.origin;
    // Section 3.3: shear and permute.
    float az = component(a, ray.kz);
    float bz = component(b, ray.kz);
    float cz = component(c, ray.kz);
    float ax = component(a, ray.kx) - ray.sx * az;
    float ay = component(a, ray.ky) - ray.sy * az;
    float bx = component(b, ray.kx) - ray.sx * bz;
    float by = component(b, ray.ky) - ray.sy * bz;
    float cx = component(c, ray.kx) - ray.sx * cz;
    float cy = component(c, ray.ky) - ray.sy * cz;
    // Section 3.4: scaled barycentric coordinates.
    float u = signed_area(cx, cy, bx, by);
    float v = signed_area(ax, ay, cx, cy);
    float w = signed_area(bx, by, ax, ay);
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) {
        return TRIANGLE_MISS;
    }
    float sum = (u + v) + w;
    if (sum == 0.0) {
        return TRIANGLE_MISS;
    }
    float scale = rcp(sum);
    // rcp may err by an ulp: a weight is at most 1.
    float b0 = min_(u * scale, 1.0);
    float b1 = min_(v * scale, 1.0);
    float b2 = min_(w * scale, 1.0);
    vec3 low = vec3(
        min_(min_(a.x, b.x), c.x),
        min_(min_(a.y, b.y), c.y),
        min_(min_(a.z, b.z), c.z)
    );
    vec3 high = vec3(
        max_(max_(a.x, b.x), c.x),
        max_(max_(a.y, b.y), c.y),
        max_(max_(a.z, b.z), c.z)
    );
    vec2 interval = box_interval(ray, slack, low, high);
    if (interval.x > interval.y) {
        return TRIANGLE_MISS;
    }
    float t = clamp_(((b0 * az + b1 * bz) + b2 * cz) * ray.sz, interval.x, interval.y);
    return t > 0.0 ? vec3(t, b1, b2) : TRIANGLE_MISS;
}

#endif
