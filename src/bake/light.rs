//! Lights as the device reads them.

use crate::layout::{
    ATTENUATION_INVERSE_SQUARE, ATTENUATION_NONE, ATTENUATION_POLYNOMIAL, LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT,
    Light, SLIDE_ENTRIES, T_INFINITE,
};
use crate::scene::{self, Attenuation, IntensityUnit, LightKind, Slide};
use glam::{DVec3, Vec3};

/// `v` made unit in double precision; +z if it has no direction.
pub fn unit(v: DVec3) -> Vec3 {
    let length = libm::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    let n = v / length;
    if n.is_finite() { n.as_vec3() } else { Vec3::Z }
}

/// The order of `shading/slide`.
fn slide_table(slide: &Slide) -> [f32; SLIDE_ENTRIES as usize] {
    let (right, up) = (slide.right, slide.up);
    // Indices below 2^24 are exact floats.
    let texture = slide.texture.map_or(-1.0, |id| id.0 as f32);
    let (end, slope) = match slide.ramp {
        Some([inner, outer]) if outer > inner => (outer, (1.0 / (f64::from(outer) - f64::from(inner))) as f32),
        _ => (0.0, 0.0),
    };
    let projector = if slide.projector { 1.0 } else { 0.0 };
    [right.x, right.y, right.z, up.x, up.y, up.z, texture, end, slope, projector]
}

/// One light; what describes its slide is appended to `tables`. The lecture's intensities are radiometric ones divided by pi
/// (DESIGN, section 5).
pub fn bake_light(light: &scene::Light, tables: &mut Vec<f32>) -> Light {
    let factor = match light.unit {
        IntensityUnit::Lecture => std::f64::consts::PI,
        IntensityUnit::Radiometric => 1.0,
    };
    let (near, far) = (Vec3::splat(-T_INFINITE), Vec3::splat(T_INFINITE));
    let mut baked = Light {
        flaps_min: light.flaps.min.clamp(near, far),
        flaps_max: light.flaps.max.clamp(near, far),
        intensity: (light.intensity.as_dvec3() * factor).as_vec3(),
        casts_shadow: u32::from(light.casts_shadow),
        ..Light::default()
    };
    match light.kind {
        LightKind::Point { position } => {
            baked.kind = LIGHT_POINT;
            baked.position = position;
        }
        LightKind::Directional { direction } => {
            baked.kind = LIGHT_DIRECTIONAL;
            baked.direction = unit(direction.as_dvec3());
        }
        LightKind::Spot { position, direction, inner, outer, exponent } => {
            baked.kind = LIGHT_SPOT;
            baked.position = position;
            baked.direction = unit(direction.as_dvec3());
            baked.cos_inner = libm::cos(f64::from(inner)) as f32;
            baked.cos_outer = libm::cos(f64::from(outer)) as f32;
            baked.exponent = exponent;
        }
    }
    match light.attenuation {
        Attenuation::InverseSquare => baked.attenuation = ATTENUATION_INVERSE_SQUARE,
        Attenuation::Polynomial { c1, c2, c3 } => {
            baked.attenuation = ATTENUATION_POLYNOMIAL;
            baked.c = Vec3::new(c1, c2, c3);
        }
        Attenuation::None => baked.attenuation = ATTENUATION_NONE,
    }
    if let Some(slide) = &light.slide {
        (baked.slide, baked.table) = (1, tables.len() as u32);
        tables.extend(slide_table(slide));
    }
    baked
}
