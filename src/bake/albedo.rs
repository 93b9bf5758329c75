//! Tables that models look up: how much their lobes reflect in all, and constants without a closed form.
//!
//! The lobes are the twins' own, in strict single precision, averaged over a lattice of their samples in double: every
//! machine bakes the same bits.

use crate::layout::{
    ALBEDO_HEADER, ALBEDO_KNOTS, DISTRIBUTION_GAUSSIAN, Features, MATERIAL_SCHLICK, SceneHeader, SceneView,
};
use crate::shading::closure::Closure;
use crate::shading::dielectric::refract_local;
use crate::shading::distribution::{sample_facet, sample_reflecting, smith_g1};
use crate::shading::fresnel::{fresnel_closure, fresnel_dielectric};
use crate::shading::kelemen::eval_kelemen;
use crate::shading::lobe::{COS_MIN, reflect_about};
use crate::shading::math::{dot3, normalize3};
use crate::shading::microfacet::{pdf_beckmann, sample_beckmann};
use crate::shading::rough_conductor::{eval_rough_conductor, pdf_rough_conductor};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Points of the lattice, a Fibonacci number, and the one before it (Niederreiter 1992, section 5.1).
const LATTICE: (u32, u32) = (4181, 2584);
/// Views at a cosine of 0 are taken from here.
const COS_GRAZING: f64 = 1.0e-4;
/// Azimuths over which an anisotropic lobe is averaged.
const AZIMUTHS: u32 = 4;

/// The mean of `value` over views of each knot's cosine and the lattice's points.
fn tabulate(anisotropic: bool, value: impl Fn(Vec3, Vec2) -> f64 + Sync) -> Vec<f64> {
    let (count, step) = LATTICE;
    let azimuths = if anisotropic { AZIMUTHS } else { 1 };
    let knot = |k: u32| {
        let x = f64::from(k) / f64::from(ALBEDO_KNOTS - 1);
        let cos = (x * x).max(COS_GRAZING);
        let sin = libm::sqrt(1.0 - cos * cos);
        let mut sum = 0.0;
        for azimuth in 0..azimuths {
            let phi = FRAC_PI_2 * (f64::from(azimuth) + 0.5) / f64::from(azimuths);
            let wo = Vec3::new((sin * libm::cos(phi)) as f32, (sin * libm::sin(phi)) as f32, cos as f32);
            for i in 0..count {
                let u = (f64::from(i) + 0.5) / f64::from(count);
                let v =
                    (f64::from((u64::from(i) * u64::from(step) % u64::from(count)) as u32) + 0.5) / f64::from(count);
                sum += value(wo, Vec2::new(u as f32, v as f32));
            }
        }
        sum / f64::from(count * azimuths)
    };
    (0..ALBEDO_KNOTS).into_par_iter().map(knot).collect()
}

/// 2 integral E(mu) mu dmu of a table over the square roots of cosines, linear between its knots.
fn mean(table: &[f64]) -> f64 {
    let last = f64::from(ALBEDO_KNOTS - 1);
    let mut sum = 0.0;
    for (k, pair) in table.windows(2).enumerate() {
        let (a, h) = (k as f64 / last, 1.0 / last);
        // mu = x^2, 2 mu dmu = 4 x^3 dx; Simpson's rule is exact up to the third power, the fourth is negligible here.
        let at = |t: f64| {
            let x = a + h * t;
            4.0 * x * x * x * (pair[0] + (pair[1] - pair[0]) * t)
        };
        sum += h / 6.0 * (at(0.0) + 4.0 * at(0.5) + at(1.0));
    }
    sum
}

/// 2 integral f(mu) mu dmu.
fn cosine_mean(f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 1024;
    // mu = x^2 resolves grazing angles.
    let at = |i: u32| {
        let x = (f64::from(i) + 0.5) / f64::from(STEPS);
        4.0 * x * x * x * f(x * x)
    };
    (0..STEPS).map(at).sum::<f64>() / f64::from(STEPS)
}

/// The Gaussian's c, so that the integral of D cos over the hemisphere is 1.
pub fn gaussian_scale(alpha: f32) -> f64 {
    const STEPS: u32 = 4096;
    let alpha = f64::from(alpha);
    // e^-36 and less is nothing.
    let end = FRAC_PI_2.min(6.0 * alpha);
    let at = |i: u32| {
        let a = end * (f64::from(i) + 0.5) / f64::from(STEPS);
        libm::exp(-(a * a) / (alpha * alpha)) * libm::sin(a) * libm::cos(a)
    };
    1.0 / (TAU * end / f64::from(STEPS) * (0..STEPS).map(at).sum::<f64>())
}

/// Diffuse reflectance of a dielectric interface of relative index `eta`: what it reflects of light from everywhere.
pub fn diffuse_reflectance(eta: f32) -> f32 {
    cosine_mean(|mu| f64::from(fresnel_dielectric(mu as f32, eta))) as f32
}

/// The header that all these tables begin with; the Gaussian's constants are in it.
fn header(closure: &Closure) -> Vec<f32> {
    let mut header = vec![0.0; ALBEDO_HEADER as usize];
    let lobes = [(closure.distribution, closure.alpha_u), (closure.second_distribution, closure.second_alpha_u)];
    for (lobe, (kind, alpha)) in lobes.into_iter().enumerate() {
        header[lobe] = if kind == DISTRIBUTION_GAUSSIAN { gaussian_scale(alpha) as f32 } else { 1.0 };
    }
    header
}

/// Appends the table of the constants only.
pub fn constant_table(closure: &mut Closure, tables: &mut Vec<f32>) {
    closure.table = tables.len() as u32;
    tables.extend(header(closure));
}

fn finish(closure: &mut Closure, header: &[f32], table: &[f64], tables: &mut Vec<f32>) {
    closure.table = tables.len() as u32;
    tables.extend(header);
    tables.extend(table.iter().map(|&e| e as f32));
}

/// Appends the albedo of a rough conductor's facets that absorb nothing (`MATERIAL_COMPENSATE`).
pub fn conductor_table(closure: &mut Closure, tables: &mut Vec<f32>) {
    let mut header = header(closure);
    let white = Closure { flags: MATERIAL_SCHLICK, f0: Vec3::ONE, specular_color: Vec3::ONE, table: 0, ..*closure };
    let (scene_header, features) = (SceneHeader::default(), Features::default());
    let constants = header.clone();
    let kind = closure.distribution;
    let table = tabulate(closure.alpha_u != closure.alpha_v, |wo, u| {
        let scene = SceneView::of_tables(&scene_header, &features, &constants);
        let wi = reflect_about(wo, sample_reflecting(kind, white.alpha_u, white.alpha_v, wo, u));
        let pdf = pdf_rough_conductor(&scene, &white, wo, wi);
        if pdf <= 0.0 {
            return 0.0;
        }
        f64::from(eval_rough_conductor(&scene, &white, wo, wi).x) / f64::from(pdf)
    });
    header[2] = mean(&table) as f32;
    for channel in 0..3 {
        header[3 + channel] = cosine_mean(|mu| f64::from(fresnel_closure(closure, mu as f32)[channel])) as f32;
    }
    finish(closure, &header, &table, tables);
}

/// Appends the albedo of the specular part of Kelemen's model.
pub fn kelemen_table(closure: &mut Closure, tables: &mut Vec<f32>) {
    let mut header = header(closure);
    let zeros = [0.0; (ALBEDO_HEADER + ALBEDO_KNOTS) as usize];
    let (scene_header, features) = (SceneHeader::default(), Features::default());
    let specular = Closure { color: Vec3::ZERO, specular_color: Vec3::ONE, table: 0, ..*closure };
    let table = tabulate(false, |wo, u| {
        let wm = sample_beckmann(u, specular.alpha_u);
        let (wi, cos) = (reflect_about(wo, wm), dot3(wo, wm));
        let pdf = f64::from(pdf_beckmann(wm, specular.alpha_u)) / (4.0 * f64::from(cos));
        if cos <= COS_MIN || pdf <= 0.0 {
            return 0.0;
        }
        f64::from(eval_kelemen(&SceneView::of_tables(&scene_header, &features, &zeros), &specular, wo, wi).x) / pdf
    });
    header[2] = mean(&table) as f32;
    finish(closure, &header, &table, tables);
}

/// Appends the transmittance of a rough plastic's coat, and its reflectance from inside, as Mitsuba 3 defines them: by
/// facets seen from outside, each with the masking of the direction it sends light to.
pub fn plastic_table(closure: &mut Closure, tables: &mut Vec<f32>) {
    let mut header = header(closure);
    let (kind, alpha, eta) = (closure.distribution, closure.alpha_u, closure.eta);
    let facet = |wo: Vec3, u: Vec2| {
        let wm = sample_facet(kind, alpha, alpha, wo, u);
        (wm, dot3(wo, wm).clamp(0.0, 1.0))
    };
    let transmittance = tabulate(false, |wo, u| {
        let (wm, cos) = facet(wo, u);
        let refracted = refract_local(Vec3::new(libm::sqrtf(1.0 - cos * cos), 0.0, cos), eta);
        if refracted.total {
            return 0.0;
        }
        let wi = normalize3(wm * (cos / eta - refracted.cos_t) - wo * (1.0 / eta));
        if wi.z >= -COS_MIN {
            return 0.0;
        }
        f64::from((1.0 - fresnel_dielectric(cos, eta)) * smith_g1(kind, alpha, alpha, wi))
    });
    let inner = tabulate(false, |wo, u| {
        let (wm, cos) = facet(wo, u);
        let wi = reflect_about(wo, wm);
        if wi.z <= COS_MIN {
            return 0.0;
        }
        f64::from(fresnel_dielectric(cos, 1.0 / eta) * smith_g1(kind, alpha, alpha, wi))
    });
    header[2] = mean(&transmittance) as f32;
    header[6] = mean(&inner) as f32;
    finish(closure, &header, &transmittance, tables);
}
