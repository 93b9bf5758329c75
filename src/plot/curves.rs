//! Curves of the parts that models are made of: no material is needed for them.

use super::figure::{Axis, Color, Curve, Figure, Frame, STEPS, Side, Strip, palette};
use crate::bake::filter::filter_value;
use crate::bake::gaussian_scale;
use crate::film::display::{quantise, srgb_encode};
use crate::film::tone::tone_curve;
use crate::layout::{
    ATTENUATION_INVERSE_SQUARE, ATTENUATION_NONE, ATTENUATION_POLYNOMIAL, DISTRIBUTION_BECKMANN, DISTRIBUTION_GAUSSIAN,
    DISTRIBUTION_PHONG, DISTRIBUTION_TROWBRIDGE_REITZ, Light,
};
use crate::scene::{Filter, ToneMap};
use crate::shading::distribution::{facet_d, smith_g_correlated};
use crate::shading::fresnel::{fresnel_conductor3, fresnel_dielectric, fresnel_schlick3};
use crate::shading::light::{attenuate, spot_factor};
use crate::shading::lobe::cos_power;
use crate::shading::math::normalize3;
use crate::shading::microfacet::v_cavity_g;
use glam::Vec3;

/// The direction `degrees` from the normal, to the right in the plane of the picture.
pub fn direction(degrees: f64) -> Vec3 {
    let angle = degrees.to_radians();
    Vec3::new(libm::sin(angle) as f32, 0.0, libm::cos(angle) as f32)
}

fn cosine(degrees: f64) -> f32 {
    libm::cos(degrees.to_radians()) as f32
}

/// cos^n of the angle phi between R and V for each n (row 2).
pub fn cos_power_figure(exponents: &[f32]) -> Figure {
    let curve = |(i, n): (usize, &f32)| {
        Curve::sampled(format!("n = {n}"), i, [0.0, 90.0], |phi| f64::from(cos_power(cosine(phi), *n)))
    };
    let curves = exponents.iter().enumerate().map(curve).collect();
    let x = Axis::degrees("φ between R and V [°]", 0.0, 90.0);
    Figure::cartesian("Phong's highlight", "cosⁿ φ: the larger n, the narrower", x, "cosⁿ φ", curves)
}

/// A distribution of facets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facets {
    pub name: &'static str,
    /// `DISTRIBUTION_*`.
    pub kind: u32,
}

pub const FACETS: [Facets; 4] = [
    Facets { name: "beckmann", kind: DISTRIBUTION_BECKMANN },
    Facets { name: "gaussian", kind: DISTRIBUTION_GAUSSIAN },
    Facets { name: "trowbridge-reitz", kind: DISTRIBUTION_TROWBRIDGE_REITZ },
    Facets { name: "phong", kind: DISTRIBUTION_PHONG },
];

/// D against the angle between N and H, for each distribution and roughness (row 15). One roughness compares the
/// distributions, more of them the roughnesses of the first.
pub fn distribution_figure(facets: &[Facets], roughness: &[f32]) -> Figure {
    let cases = facets.iter().flat_map(|facets| roughness.iter().map(move |m| (facets, *m)));
    let curve = |(i, (facets, m)): (usize, (&Facets, f32))| {
        let scale = if facets.kind == DISTRIBUTION_GAUSSIAN { gaussian_scale(m) as f32 } else { 1.0 };
        let d = |a: f64| f64::from(facet_d(facets.kind, m, m, scale, direction(a)));
        Curve::sampled(format!("{}, m = {m}", facets.name), i, [0.0, 90.0], d)
    };
    let curves: Vec<Curve> = cases.enumerate().map(curve).collect();
    let x = Axis::degrees("α between N and H [°]", 0.0, 90.0);
    let note = "normalised: the integral of D cos α over the hemisphere is 1";
    Figure::cartesian("Distribution of facets", note, x, "D [1/sr]", curves)
}

/// G against the viewer's angle, in the plane of incidence, for light from each angle on the other side: of V-shaped
/// grooves, and (dashed) Smith's of a Beckmann surface (row 16).
pub fn masking_figure(incidence: &[f64], m: f32) -> Figure {
    let range = [-89.9, 89.9];
    let grooves = |theta: f64| {
        let wi = direction(-theta);
        move |angle: f64| {
            let wo = direction(angle);
            let h = normalize3(wo + wi);
            let v_h = f64::from(wo.x * h.x + wo.z * h.z) as f32;
            f64::from(v_cavity_g(h.z, wo.z, v_h, wi.z))
        }
    };
    let smith = |theta: f64| {
        let wi = direction(-theta);
        move |angle: f64| f64::from(smith_g_correlated(DISTRIBUTION_BECKMANN, m, m, direction(angle), wi))
    };
    let mut curves = Vec::new();
    for (i, theta) in incidence.iter().enumerate() {
        curves.push(Curve::sampled(format!("V-cavity, θ = {theta}°"), i, range, grooves(*theta)));
    }
    for (i, theta) in incidence.iter().enumerate() {
        curves.push(Curve::sampled(format!("Smith, θ = {theta}°"), i, range, smith(*theta)).dashed());
    }
    let frame = Frame::Cartesian {
        x: Axis { step: 30.0, ..Axis::degrees("angle of view [°], light from the left", -90.0, 90.0) },
        y: Axis { label: "G".into(), low: 0.0, high: 1.0, step: 0.2 },
        marks: Vec::new(),
    };
    let note = format!("V-shaped grooves: 1 up to a kink; Smith: of a Beckmann surface of m = {m}");
    Figure { title: "Masking and shadowing".into(), note, frame, curves }
}

/// What an interface is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    pub name: String,
    pub kind: InterfaceKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InterfaceKind {
    Dielectric {
        eta: f32,
    },
    /// Complex index per channel.
    Conductor {
        eta: Vec3,
        k: Vec3,
    },
}

impl Interface {
    pub fn dielectric(eta: f32) -> Self {
        Self { name: format!("η = {eta}"), kind: InterfaceKind::Dielectric { eta } }
    }

    /// The same after Cook and Torrance 1982, section "Spectral composition": colours known at normal incidence only go to
    /// white as the reflectance of a dielectric with their mean F(0) does.
    pub fn reflectance_1982(&self, degrees: f64) -> Vec3 {
        let color = self.reflectance(0.0);
        let root = libm::sqrt(luminance(color).min(0.999));
        let eta = ((1.0 + root) / (1.0 - root)) as f32;
        let [f0, f] = [0.0, degrees].map(|angle| fresnel_dielectric(cosine(angle), eta));
        color + (Vec3::ONE - color) * ((f - f0).max(0.0) / (1.0 - f0))
    }

    /// Reflectance at `degrees`, linear Rec. 709.
    pub fn reflectance(&self, degrees: f64) -> Vec3 {
        match self.kind {
            InterfaceKind::Dielectric { eta } => Vec3::splat(fresnel_dielectric(cosine(degrees), eta)),
            InterfaceKind::Conductor { eta, k } => fresnel_conductor3(cosine(degrees), eta, k),
        }
    }
}

/// Red, green and blue of curves that stand for channels.
const CHANNELS: [(&str, Color); 3] = [("red", [200, 30, 30]), ("green", [0, 140, 60]), ("blue", [30, 70, 200])];

fn luminance(rgb: Vec3) -> f64 {
    0.2126 * f64::from(rgb.x) + 0.7152 * f64::from(rgb.y) + 0.0722 * f64::from(rgb.z)
}

/// Reflectance against the angle of incidence (row 17): the luminance of several interfaces, or of a single conductor its
/// three channels, with Schlick's approximation dashed.
pub fn fresnel_figure(interfaces: &[Interface]) -> Figure {
    let range = [0.0, 90.0];
    let curves: Vec<Curve> = match interfaces {
        [metal @ Interface { kind: InterfaceKind::Conductor { .. }, .. }] => {
            let f0 = metal.reflectance(0.0);
            let exact = CHANNELS.iter().enumerate().map(|(c, (name, color))| {
                let value = |a: f64| f64::from(metal.reflectance(a)[c]);
                Curve::sampled(format!("{} {name}", metal.name), c, range, value).colored(*color)
            });
            let schlick = CHANNELS.iter().enumerate().map(|(c, (name, color))| {
                let value = |a: f64| f64::from(fresnel_schlick3(cosine(a), f0)[c]);
                Curve::sampled(format!("Schlick {name}"), c, range, value).colored(*color).dashed()
            });
            exact.chain(schlick).collect()
        }
        several => {
            let curve = |(i, interface): (usize, &Interface)| {
                Curve::sampled(interface.name.clone(), i, range, |a| luminance(interface.reflectance(a)))
            };
            several.iter().enumerate().map(curve).collect()
        }
    };
    let frame = Frame::Cartesian {
        x: Axis::degrees("θ between N and L [°]", 0.0, 90.0),
        y: Axis { label: "F".into(), low: 0.0, high: 1.0, step: 0.2 },
        marks: Vec::new(),
    };
    let note = "unpolarised, from outside; at grazing angles everything is a mirror";
    Figure { title: "Fresnel reflectance".into(), note: note.into(), frame, curves }
}

/// The colour of F against the angle, as a display shows it: a metal's own at normal incidence, white at grazing (Cook
/// and Torrance 1982, figure 5); one metal alone also as that paper computes it.
pub fn ramp_figure(interfaces: &[Interface]) -> Figure {
    let code = |v: f32| quantise(srgb_encode(f64::from(v).clamp(0.0, 1.0)), 255) as u8;
    let strip = |name: &str, reflectance: &dyn Fn(f64) -> Vec3| Strip {
        name: name.into(),
        colors: (0..180).map(|i| reflectance((f64::from(i) + 0.5) / 2.0).to_array().map(code)).collect(),
    };
    let strips = match interfaces {
        [metal @ Interface { kind: InterfaceKind::Conductor { .. }, .. }] => vec![
            strip(&metal.name, &|angle| metal.reflectance(angle)),
            strip(&format!("{}, 1982", metal.name), &|angle| metal.reflectance_1982(angle)),
        ],
        several => several.iter().map(|one| strip(&one.name, &|angle| one.reflectance(angle))).collect(),
    };
    let x = Axis::degrees("θ between N and L [°]", 0.0, 90.0);
    let frame = Frame::Ramp { x, strips };
    let note = "white light reflected at θ, as sRGB: the colour fades to the light's own at grazing angles";
    Figure { title: "Colour of Fresnel reflectance".into(), note: note.into(), frame, curves: Vec::new() }
}

/// Lines of equal I_p of a directed light, cos^p γ cut at delta degrees, for each p (row 21).
pub fn spot_figure(exponents: &[f32], delta: f64) -> Figure {
    let edge = libm::cos(delta.to_radians()) as f32;
    let curve = |(i, p): (usize, &f32)| {
        let light = Light { exponent: *p, cos_outer: edge, cos_inner: edge, ..Light::default() };
        Curve::sampled(format!("p = {p}"), i, [-90.0, 90.0], |gamma| f64::from(spot_factor(&light, cosine(gamma))))
    };
    let curves = exponents.iter().enumerate().map(curve).collect();
    let frame = Frame::Polar { side: Side::Lower, unit: "I_p / I_L'".into(), max: 1.0, arrows: Vec::new() };
    let note = format!("I_p = I_L' (cos γ)^p, zero beyond the cone δ = {delta}°");
    Figure { title: "Directed light".into(), note, frame, curves }
}

/// c1, c2 and c3 of scenes/lecture/05-attenuation.toml.
pub const CAPPED: [f32; 3] = [0.6, 0.35, 0.05];

/// How light falls off with distance (row 5): 1 / d^2, 1 / (c1 + c2 d + c3 d^2) capped at 1, not at all.
pub fn attenuation_figure([c1, c2, c3]: [f32; 3]) -> Figure {
    const FARTHEST: f64 = 8.0;
    let polynomial = Light { c: Vec3::new(c1, c2, c3), attenuation: ATTENUATION_POLYNOMIAL, ..Light::default() };
    let laws = [
        ("1 / d²".to_owned(), Light { attenuation: ATTENUATION_INVERSE_SQUARE, ..polynomial }),
        (format!("c = {c1}, {c2}, {c3}"), polynomial),
        ("none".to_owned(), Light { attenuation: ATTENUATION_NONE, ..polynomial }),
    ];
    let curve = |(i, (name, light)): (usize, (String, Light))| {
        // At the lamp itself 1 / d^2 has no value.
        let fall = |d: f64| f64::from(attenuate(&light, d.max(1.0e-3) as f32, (d * d).max(1.0e-6) as f32));
        Curve::sampled(name, i, [0.0, FARTHEST], fall)
    };
    let frame = Frame::Cartesian {
        x: Axis { label: "distance d".into(), low: 0.0, high: FARTHEST, step: 1.0 },
        y: Axis { label: "f_att".into(), low: 0.0, high: 1.2, step: 0.2 },
        marks: Vec::new(),
    };
    let note = "min(1, 1 / (c₁ + c₂ d + c₃ d²)) beside the law of physics, which has no bound";
    let curves = laws.into_iter().enumerate().map(curve).collect();
    Figure { title: "Attenuation".into(), note: note.into(), frame, curves }
}

/// Reconstruction filters of their usual widths along one axis, each of integral 1 (row 26).
pub fn filter_figure() -> Figure {
    let filters = [
        ("box", Filter::Box { radius: 0.5 }),
        ("tent", Filter::Tent { radius: 1.0 }),
        ("gaussian", Filter::Gaussian { radius: 1.5, sigma: 0.5 }),
        ("mitchell", Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 }),
        ("blackman-harris", Filter::BlackmanHarris { radius: 2.0 }),
    ];
    // The box ends half way between two points.
    const REACH: f64 = 2.4;
    let curve = |(i, (name, filter)): (usize, (&str, Filter))| {
        let mut curve = Curve::sampled(name, i, [-REACH, REACH], |x| filter_value(&filter, x));
        let area = curve.points.iter().map(|point| point[1]).sum::<f64>() * 2.0 * REACH / STEPS as f64;
        curve.points.iter_mut().for_each(|point| point[1] /= area);
        curve
    };
    let frame = Frame::Cartesian {
        x: Axis { label: "distance from the pixel's centre [pixels]".into(), low: -REACH, high: REACH, step: 0.5 },
        y: Axis { label: "weight".into(), low: -0.2, high: 1.2, step: 0.2 },
        marks: Vec::new(),
    };
    let note = "what a sample counts for a pixel; negative weights sharpen";
    let curves = filters.into_iter().enumerate().map(curve).collect();
    Figure { title: "Filters".into(), note: note.into(), frame, curves }
}

/// What a display shows of grey light, against its stops from 1 (row 6).
pub fn tone_figure(exposure: f64) -> Figure {
    let curves =
        [("clamp", ToneMap::Clamp), ("reinhard", ToneMap::Reinhard), ("aces", ToneMap::Aces), ("agx", ToneMap::Agx)];
    let curve = |(i, (name, curve)): (usize, (&str, ToneMap))| {
        let shown = |stops: f64| srgb_encode(tone_curve(curve, [libm::exp2(stops + exposure); 3])[1]);
        Curve { color: palette(i), ..Curve::sampled(name, i, [-8.0, 8.0], shown) }
    };
    let frame = Frame::Cartesian {
        x: Axis { label: "light in the film, stops from 1 (log₂)".into(), low: -8.0, high: 8.0, step: 2.0 },
        y: Axis { label: "stored value, sRGB".into(), low: 0.0, high: 1.0, step: 0.2 },
        marks: vec![super::figure::Mark { name: "grey .18".into(), x: libm::log2(0.18) - exposure }],
    };
    let note = match exposure {
        0.0 => "grey light".to_owned(),
        _ => format!("grey light, exposure {} stops", super::figure::number(exposure)),
    };
    let curves = curves.into_iter().enumerate().map(curve).collect();
    Figure { title: "Tone curves".into(), note, frame, curves }
}
