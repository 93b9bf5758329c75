// Triangles and spheres that glow, as seen from a point: sampling and density.
#ifndef TRANSPORT_AREA_LIGHT_GLSL
#define TRANSPORT_AREA_LIGHT_GLSL

#include "layout/records.glsl"
#include "shading/frame.glsl"
#include "shading/light.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"
#include "trace/ray.glsl"

// A triangle seen under a smaller cosine is not sampled: its light through so thin a slit is nothing.
const float COS_LEAST = 1.0e-6;
// From closer to the unit sphere than this squared distance from its centre, or from inside, points are drawn on all of
// it; from farther away in the cone of its visible cap.
const float OUTSIDE = 1.0001;

// Density per solid angle of a point drawn with `density` per area, seen at squared distance `distance2` under the
// cosine `cos_light` between the surface's normal and the direction to it.
float area_to_solid_angle(float density, float distance2, float cos_light) {
    return cos_light < COS_LEAST ? 0.0 : div(density * distance2, cos_light);
}

// A point of a triangle, uniform on its area, as seen from `position`. `u`: 0..1 each, excluding 1.
LightSample sample_triangle_light(Emitter emitter, vec3 position, vec2 u) {
    vec2 b = square_to_uniform_triangle(u);
    vec3 to_light = (emitter.corner - position) + (emitter.edge1 * b.x + emitter.edge2 * b.y);
    float distance = length3(to_light);
    vec3 wi = to_light * rcp(distance);
    float cos_signed = -dot3(emitter.normal, wi);
    bool one_sided = (emitter.flags & EMITTER_ONE_SIDED) != 0u;
    float cos_light = one_sided ? cos_signed : abs(cos_signed);
    float pdf = area_to_solid_angle(emitter.density, distance * distance, cos_light);
    if (pdf <= 0.0) {
        return no_light();
    }
    Spectrum radiance = spectrum_from_rgb(emitter.radiance) * rcp(pdf);
    return LightSample(wi, distance, radiance, pdf);
}

// Solid angle at `direction` (object space, any length) over that of its image under the instance's transform.
float solid_angle_ratio(Instance instance, vec3 direction) {
    vec3 image = transform_vector(instance.to_world, direction);
    // Scaled to unit length first, so that neither tiny nor huge transforms leave the range of floats.
    float scale = div(length3(direction), length3(image));
    vec3 x = instance.to_world[0].xyz * scale;
    vec3 y = instance.to_world[1].xyz * scale;
    vec3 z = instance.to_world[2].xyz * scale;
    float determinant = (x.x * (y.y * z.z - y.z * z.y) + x.y * (y.z * z.x - y.x * z.z)) + x.z * (y.x * z.y - y.y * z.x);
    return rcp(abs(determinant));
}

// 1 - cos of the half angle of the cone that the unit sphere fills from squared distance `distance2` (> 1).
float cone_height(float distance2) {
    float sin2 = rcp(distance2);
    return sin2 * rcp(1.0 + sqrt_(max_(1.0 - sin2, 0.0)));
}

// The way from `origin` to the point of the unit sphere that the direction `u` of the cone of its visible cap meets first.
// Source: Shirley, Wang and Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting Calculations"; the root of the
// sphere's quadratic that does not cancel, so that directions are right also from just above the sphere.
vec3 cone_point(vec3 origin, float distance2, vec2 u) {
    float height = u.x * cone_height(distance2);
    float cos_theta = 1.0 - height;
    float sin2_theta = height * (2.0 - height);
    float sin_theta = sqrt_(sin2_theta);
    float distance = sqrt_(distance2);
    float half_chord = sqrt_(max_(1.0 - sin2_theta * distance2, 0.0));
    float reach = div(distance2 - 1.0, cos_theta * distance + half_chord);
    Frame to_centre = frame_from_normal(origin * -rcp(distance));
    return to_world(to_centre, vec3(sin_theta * cos_turns(u.y), sin_theta * sin_turns(u.y), cos_theta) * reach);
}

// Density per solid angle of object space with which `sample_sphere_light` draws the point that `to_point` (not zero)
// leads to from `origin`, all in the sphere's object space.
float sphere_pdf(vec3 origin, vec3 to_point) {
    float distance2 = dot3(origin, origin);
    if (distance2 > OUTSIDE) {
        return INV_TWO_PI * rcp(cone_height(distance2));
    }
    float length_ = length3(to_point);
    vec3 normal = origin + to_point;
    float cos_light = abs(dot3(normal, to_point)) * rcp(length_);
    return area_to_solid_angle(INV_FOUR_PI, length_ * length_, cos_light);
}

// A point of the sphere (under a transform: of the ellipsoid) that `instance` places, as seen from `position`.
LightSample sample_sphere_light(Emitter emitter, Instance instance, vec3 position, vec2 u) {
    vec3 origin = transform_point(instance.to_object, position);
    float distance2 = dot3(origin, origin);
    bool outside = distance2 > OUTSIDE;
    if (!outside && (emitter.flags & EMITTER_ONE_SIDED) != 0u) {
        return no_light();
    }
    vec3 to_point = outside ? cone_point(origin, distance2, u) : square_to_uniform_sphere(u) - origin;
    vec3 to_light = transform_vector(instance.to_world, to_point);
    float distance = length3(to_light);
    vec3 wi = to_light * rcp(distance);
    float pdf = (emitter.density * sphere_pdf(origin, to_point)) * solid_angle_ratio(instance, to_point);
    if (pdf <= 0.0 || distance <= 0.0) {
        return no_light();
    }
    return LightSample(wi, distance, spectrum_from_rgb(emitter.radiance) * rcp(pdf), pdf);
}

#endif
