//! Light from things that have a size: which to sample, how, and how likely a ray that met one was to be such a sample.

use super::DIMENSION_LIGHT_LEAF;
use super::area_light::{
    area_to_solid_angle, sample_sphere_light, sample_triangle_light, solid_angle_ratio, sphere_pdf,
};
use super::local::emitted;
use super::resolve::resolve_material;
use crate::layout::{
    EMITTER_ENVIRONMENT, EMITTER_LIGHT, EMITTER_SPHERE, EMITTER_TEXTURED, Emitter, Hit, KIND_SPHERE, Ray, SceneView,
    T_INFINITE, load_instance, load_light, load_material, load_table,
};
use crate::shading::environment::sample_environment;
use crate::shading::light::{LightSample, no_light, sample_light};
use crate::shading::material::own_weight;
use crate::shading::math::{dot3, rcp};
use crate::shading::sampling::SampleKey;
use crate::shading::slide::slide_factor;
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_luminance};
use crate::shading::warp::square_to_uniform_triangle;
use crate::trace::ray::{transform_point, transform_vector};
use crate::trace::surface::{Surface, surface_at};
use glam::{Vec2, Vec3};

/// The emitter that two random numbers choose, 0..1 excluding 1, by its probability: Walker's alias method (Vose 1991,
/// "A Linear Algorithm For Generating Random Numbers With a Given Distribution"). There is at least one.
#[inline]
pub fn choose_emitter(scene: &SceneView, u: Vec2) -> u32 {
    let count = scene.header.emitter_count;
    let index = (u.x * count as f32) as u32;
    let place = if index < count { index } else { count - 1 };
    let entry = scene.header.emitter_table + 2 * place;
    if u.y < load_table(scene, entry) { place } else { load_table(scene, entry + 1) as u32 }
}

/// Radiance of the point of a textured emitter that `lit` was drawn to from `position` with `u`.
fn textured_radiance(
    scene: &SceneView,
    emitter: &Emitter,
    key: SampleKey,
    position: Vec3,
    u: Vec2,
    lit: &LightSample,
) -> Spectrum {
    let b = square_to_uniform_triangle(u);
    let ray = Ray { origin: position, direction: lit.wi, t_max: lit.distance, ..Ray::default() };
    let hit = Hit {
        t: lit.distance,
        b1: b.x,
        b2: b.y,
        instance: emitter.instance,
        primitive: emitter.primitive,
        ..Hit::default()
    };
    let mut surface = surface_at(scene, &ray, &hit);
    let closure = resolve_material(scene, lit.wi, &hit, key, DIMENSION_LIGHT_LEAF, &mut surface);
    spectrum_from_rgb(emitted(&surface, &closure, -lit.wi) * own_weight(closure.flags, closure.k_t))
}

/// Light of one emitter at `surface`, divided by the probability of choosing it. `u`: 0..1 each, excluding 1. `key`: of the
/// path.
pub fn sample_emitter(scene: &SceneView, emitter: &Emitter, key: SampleKey, surface: &Surface, u: Vec2) -> LightSample {
    let position = surface.position;
    if emitter.kind == EMITTER_ENVIRONMENT {
        let seen = sample_environment(scene, u);
        let pdf = emitter.density * seen.pdf_solid_angle;
        let radiance = spectrum_from_rgb(seen.radiance) * rcp(pdf);
        return LightSample { wi: seen.wi, distance: T_INFINITE, radiance, pdf_solid_angle: pdf };
    }
    if emitter.kind == EMITTER_LIGHT {
        let light = load_light(scene, emitter.instance);
        let mut lit = sample_light(&light, position);
        if light.slide != 0 {
            lit.radiance *= slide_factor(scene, &light, lit.wi);
        }
        lit.radiance *= rcp(emitter.density);
        return lit;
    }
    let mut lit = no_light();
    if emitter.kind == EMITTER_SPHERE {
        lit = sample_sphere_light(emitter, &load_instance(scene, emitter.instance), position, u);
    } else if emitter.instance != surface.instance || emitter.primitive != surface.primitive {
        lit = sample_triangle_light(emitter, position, u);
    }
    if (emitter.flags & EMITTER_TEXTURED) != 0 && lit.pdf_solid_angle > 0.0 {
        lit.radiance = textured_radiance(scene, emitter, key, position, u, &lit) * rcp(lit.pdf_solid_angle);
    }
    lit
}

/// Whether shadow rays are traced for an emitter.
pub fn casts_shadow(scene: &SceneView, emitter: &Emitter) -> bool {
    emitter.kind != EMITTER_LIGHT || load_light(scene, emitter.instance).casts_shadow != 0
}

/// Density per solid angle with which `sample_emitter`, its choice included, would have drawn the direction of a ray that
/// left `origin` and met a glowing surface of material `named` at `t`.
pub fn pdf_emitter(scene: &SceneView, origin: Vec3, direction: Vec3, t: f32, surface: &Surface, named: u32) -> f32 {
    let instance = load_instance(scene, surface.instance);
    // Without textures: what bake made the choice by.
    let material = load_material(scene, named);
    let shown = spectrum_from_rgb(material.emission * own_weight(material.flags, material.k_t));
    let density = instance.light_density * spectrum_luminance(shown);
    if surface.kind == KIND_SPHERE {
        let along = transform_vector(instance.to_object, direction);
        let start = transform_point(instance.to_object, origin);
        return (density * sphere_pdf(start, along * t)) * solid_angle_ratio(&instance, along);
    }
    area_to_solid_angle(density, t * t, dot3(surface.normal_geometric, direction).abs())
}
