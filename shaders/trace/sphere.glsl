// The analytic unit sphere.
#ifndef TRACE_SPHERE_GLSL
#define TRACE_SPHERE_GLSL

#include "shading/math.glsl"
#include "trace/box_.glsl"
#include "trace/ray.glsl"

// Where the ray meets the unit sphere at the origin of its space: the smallest t > 0 among the roots that count, in
// units of the ray's direction (not unit here); -1 for none. `near_counts`, `far_counts`: a ray that leaves the sphere
// says by side, not by an epsilon, which roots are its own start (`Ray.skip_inward`).
// Source: Haines, Guenther and Akenine-Moeller 2019, "Precision Improvements for Ray/Sphere Intersection" (Ray Tracing
// Gems, chapter 7): the discriminant from the point of closest approach (equation 5), the roots without cancellation
// (equations 9 and 10). The closest point is off per axis by at most 2^-24 (|o| + 16 |d| (|o.kz| + 1) / |d.kz|).
float intersect_sphere(LevelRay ray, bool near_counts, bool far_counts) {
    vec3 o = ray.origin;
    vec3 d = ray.direction;
    float a = dot3(d, d);
    float b = -dot3(o, d);
    float scale = rcp(a);
    vec3 closest = o + d * (b * scale);
    float discriminant = 1.0 - dot3(closest, closest);
    if (discriminant < 0.0) {
        return -1.0;
    }
    float root = sqrt_(a * discriminant);
    float q = b < 0.0 ? b - root : b + root;
    if (q == 0.0) {
        return -1.0;
    }
    float c = dot3(o, o) - 1.0;
    float t0 = c * rcp(q);
    float t1 = q * scale;
    float near = b < 0.0 ? t1 : t0;
    float far = b < 0.0 ? t0 : t1;
    float reach = max_(max_(abs(o.x), abs(o.y)), abs(o.z)) + 1.0;
    vec3 slack = axis_slack(ray, reach * SPHERE_SLACK);
    vec2 interval = box_interval(ray, slack, vec3(-1.0) - o, vec3(1.0) - o);
    if (interval.x > interval.y) {
        return -1.0;
    }
    near = clamp_(near, interval.x, interval.y);
    far = clamp_(far, interval.x, interval.y);
    if (near_counts && near > 0.0) {
        return near;
    }
    if (far_counts && far > 0.0) {
        return far;
    }
    return -1.0;
}

#endif
