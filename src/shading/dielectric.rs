//! Refraction and absorption of clear bodies (row 23).

use crate::shading::fresnel::refraction_root;
use crate::shading::lobe::reflect_local;
use crate::shading::math::{exp_, normalize3, rcp, sqrt_};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb};
use glam::Vec3;

/// What `refract_local` returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refraction {
    /// Unit, local frame, leaving the surface on the other side (z < 0); the mirror direction on total reflection.
    pub wt: Vec3,
    /// Cosine between wt and -N, 0..1; 0 on total reflection.
    pub cos_t: f32,
    /// Total internal reflection: nothing is transmitted.
    pub total: bool,
}

/// The refracted direction: T = (eta_i/eta_t cos theta_i - cos theta_t) N - eta_i/eta_t L.
/// `wo`: unit, local frame, z > 0: where the light comes from (or the viewer, for a ray traced backwards).
/// `eta`: index on the transmitted side over index on the incident side, > 0.
/// Source: Snell's law; Whitted 1980, "An Improved Illumination Model for Shaded Display".
#[inline]
pub fn refract_local(wo: Vec3, eta: f32) -> Refraction {
    let root = refraction_root(wo.z, eta);
    if root <= 0.0 {
        return Refraction { wt: reflect_local(wo), cos_t: 0.0, total: true };
    }
    let ratio = rcp(eta);
    // cos^2 theta_t = 1 - ratio^2 (1 - cos^2 theta_i) = root / eta^2
    let cos_t = sqrt_(root) * ratio;
    // N is z, so T's normal part, ratio cos_i - cos_t - ratio wo.z, is -cos_t.
    // Normalised, so that errors do not add up over many surfaces.
    let wt = normalize3(Vec3::new(-(ratio * wo.x), -(ratio * wo.y), -cos_t));
    Refraction { wt, cos_t: -wt.z, total: false }
}

/// One channel of `transmittance`.
#[inline]
fn transmittance1(absorption: f32, distance: f32) -> f32 {
    let depth = absorption * distance;
    if depth > 60.0 { 0.0 } else { exp_(-depth) }
}

/// Beer's law: e^(-absorption distance) per channel, 0..1; below e^-60 it is 0.
/// `absorption`: per scene unit, >= 0. `distance`: scene units, >= 0, up to `T_INFINITE`.
#[inline]
pub fn transmittance(absorption: Vec3, distance: f32) -> Spectrum {
    spectrum_from_rgb(Vec3::new(
        transmittance1(absorption.x, distance),
        transmittance1(absorption.y, distance),
        transmittance1(absorption.z, distance),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shading::fresnel::fresnel_dielectric;

    fn at_degrees(degrees: f64, phi: f64) -> Vec3 {
        let (sin, cos) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
        Vec3::new((sin * libm::cos(phi)) as f32, (sin * libm::sin(phi)) as f32, cos as f32)
    }

    #[test]
    fn light_is_refracted_as_the_lecture_writes_it() {
        for degrees in [0.0, 1.0, 10.0, 30.0, 41.0, 60.0, 89.0] {
            for eta in [1.0 / 1.5, 1.0, 1.33, 1.5, 2.417] {
                let wo = at_degrees(degrees, 0.7);
                let refraction = refract_local(wo, eta);
                let l = wo.as_dvec3();
                let ratio = 1.0 / f64::from(eta);
                let square = 1.0 - ratio * ratio * (1.0 - l.z * l.z);
                assert_eq!(refraction.total, square < 0.0, "{degrees} {eta}");
                if refraction.total {
                    continue;
                }
                // T = (eta_i/eta_t cos theta_i - cos theta_t) N - eta_i/eta_t L
                let cos_t = libm::sqrt(square);
                let t = glam::DVec3::Z * (ratio * l.z - cos_t) - l * ratio;
                assert!((refraction.wt.as_dvec3() - t).length() < 1e-6, "{degrees} {eta}: {} {t}", refraction.wt);
                assert!((f64::from(refraction.cos_t) - cos_t).abs() < 1e-6);
                assert!((refraction.wt.length() - 1.0).abs() < 2e-7);
            }
        }
    }

    #[test]
    fn light_is_totally_reflected_beyond_41_81_degrees_in_glass() {
        assert!(!refract_local(at_degrees(41.80, 0.0), 1.0 / 1.5).total);
        let beyond = refract_local(at_degrees(41.82, 0.0), 1.0 / 1.5);
        assert!(beyond.total);
        assert_eq!(beyond.wt, reflect_local(at_degrees(41.82, 0.0)));
        // It never happens into the denser side.
        assert!(!refract_local(at_degrees(89.999, 0.0), 1.5).total);
    }

    #[test]
    fn refraction_is_total_exactly_where_fresnel_reflects_everything() {
        for step in 0..=20_000 {
            let cos_i = step as f32 / 20_000.0;
            let wo = Vec3::new(libm::sqrtf(1.0 - cos_i * cos_i), 0.0, cos_i);
            let eta = 1.0 / 1.5;
            assert_eq!(refract_local(wo, eta).total, fresnel_dielectric(cos_i, eta) == 1.0, "cos {cos_i}");
        }
    }

    #[test]
    fn a_ray_comes_back_along_its_own_path() {
        let wo = at_degrees(50.0, 1.1);
        let inside = refract_local(wo, 1.5);
        // Seen from inside, the normal is -z: the frame's z is turned over.
        let turned = Vec3::new(1.0, 1.0, -1.0);
        let back = refract_local(inside.wt * turned, 1.0 / 1.5).wt * turned;
        assert!((back - wo).length() < 1e-6, "{back} {wo}");
    }

    #[test]
    fn absorption_multiplies_over_distance() {
        let absorption = Vec3::new(0.0, 0.5, 2.0);
        let once = transmittance(absorption, 1.5);
        assert_eq!((once.x, once.w), (1.0, 0.0));
        assert!((once.y - 0.472_366_55).abs() < 1e-6 && (once.z - 0.049_787_07).abs() < 1e-7);
        let twice = transmittance(absorption, 3.0);
        assert!((twice.y - once.y * once.y).abs() < 1e-6);
        let far = transmittance(absorption, crate::layout::T_INFINITE);
        assert_eq!((far.x, far.y, far.z), (1.0, 0.0, 0.0));
        assert_eq!(transmittance(absorption, 35.0).z, 0.0, "e^-70 is nothing");
        assert!(transmittance(absorption, 29.0).z > 0.0);
    }
}
