// Light from things that have a size: which to sample, how, and how likely a ray that met one was to be such a sample.
#ifndef TRANSPORT_EMITTER_GLSL
#define TRANSPORT_EMITTER_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/environment.glsl"
#include "shading/light.glsl"
#include "shading/material.glsl"
#include "shading/math.glsl"
#include "shading/slide.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"
#include "trace/ray.glsl"
#include "trace/surface.glsl"
#include "transport/area_light.glsl"
#include "transport/local.glsl"
#include "transport/resolve.glsl"

// The emitter that two random numbers choose, 0..1 excluding 1, by its probability: Walker's alias method (Vose 1991,
// "A Linear Algorithm For Generating Random Numbers With a Given Distribution"). There is at least one.
uint choose_emitter(vec2 u) {
    uint count = header.emitter_count;
    uint index = uint(u.x * float(count));
    uint place = index < count ? index : count - 1u;
    uint entry = header.emitter_table + 2u * place;
    return u.y < load_table(entry) ? place : uint(load_table(entry + 1u));
}

// Radiance of the point of a textured emitter that `lit` was drawn to from `position` with `u`.
Spectrum textured_radiance(Emitter emitter, SampleKey key, vec3 position, vec2 u, LightSample lit) {
    vec2 b = square_to_uniform_triangle(u);
    Ray ray = Ray(position, lit.distance, lit.wi, 0u, 0u, 0u, 0.0, 0.0);
    Hit hit = Hit(lit.distance, b.x, b.y, emitter.instance, emitter.primitive, 0u, 0u, 0u);
    Surface surface = surface_at(ray, hit);
    Closure closure = resolve_material(lit.wi, hit, key, DIMENSION_LIGHT_LEAF, surface);
    return spectrum_from_rgb(emitted(surface, closure, -lit.wi) * own_weight(closure.flags, closure.k_t));
}

// Light of one emitter at `surface`, divided by the probability of choosing it. `u`: 0..1 each, excluding 1. `key`: of the
// path.
LightSample sample_emitter(Emitter emitter, SampleKey key, Surface surface, vec2 u) {
    vec3 position = surface.position;
    if (HAS_EMITTER(EMITTER_ENVIRONMENT) && emitter.kind == EMITTER_ENVIRONMENT) {
        EnvironmentSample seen = sample_environment(u);
        float pdf = emitter.density * seen.pdf_solid_angle;
        Spectrum radiance = spectrum_from_rgb(seen.radiance) * rcp(pdf);
        return LightSample(seen.wi, T_INFINITE, radiance, pdf);
    }
    if (HAS_EMITTER(EMITTER_LIGHT) && emitter.kind == EMITTER_LIGHT) {
        Light light = load_light(emitter.instance);
        LightSample lit = sample_light(light, position);
        if (HAS_SLIDES && light.slide != 0u) lit.radiance *= slide_factor(light, lit.wi);
        lit.radiance *= rcp(emitter.density);
        return lit;
    }
    LightSample lit = no_light();
    if (HAS_EMITTER(EMITTER_SPHERE) && emitter.kind == EMITTER_SPHERE) {
        lit = sample_sphere_light(emitter, load_instance(emitter.instance), position, u);
    } else if (emitter.instance != surface.instance || emitter.primitive != surface.primitive) {
        lit = sample_triangle_light(emitter, position, u);
    }
    if (HAS_TEXTURED_EMITTERS && (emitter.flags & EMITTER_TEXTURED) != 0u && lit.pdf_solid_angle > 0.0) {
        lit.radiance = textured_radiance(emitter, key, position, u, lit) * rcp(lit.pdf_solid_angle);
    }
    return lit;
}

// Whether shadow rays are traced for an emitter.
bool casts_shadow(Emitter emitter) {
    return !HAS_EMITTER(EMITTER_LIGHT) || emitter.kind != EMITTER_LIGHT || load_light(emitter.instance).casts_shadow != 0u;
}

// Density per solid angle with which `sample_emitter`, its choice included, would have drawn the direction of a ray that
// left `origin` and met a glowing surface of material `named` at `t`.
float pdf_emitter(vec3 origin, vec3 direction, float t, Surface surface, uint named) {
    Instance instance = load_instance(surface.instance);
    // Without textures: what bake made the choice by.
    Material material = load_material(named);
    Spectrum shown = spectrum_from_rgb(material.emission * own_weight(material.flags, material.k_t));
    float density = instance.light_density * spectrum_luminance(shown);
    if (HAS_EMITTER(EMITTER_SPHERE) && surface.kind == KIND_SPHERE) {
        vec3 along = transform_vector(instance.to_object, direction);
        vec3 start = transform_point(instance.to_object, origin);
        return (density * sphere_pdf(start, along * t)) * solid_angle_ratio(instance, along);
    }
    return area_to_solid_angle(density, t * t, abs(dot3(surface.normal_geometric, direction)));
}

#endif
