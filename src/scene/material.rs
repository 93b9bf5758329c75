//! Materials as written. Row numbers are those of the lecture's table.

use super::{Rgb, TextureId};

/// How much light a specular interface reflects (row 17).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// Index relative to the outside.
    Dielectric { eta: f32 },
    /// Complex index eta + i k per channel.
    Conductor { eta: Rgb, k: Rgb },
}

/// One Beckmann lobe: rms slope `m` > 0, weight >= 0 (row 15).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    pub m: f32,
    pub weight: f32,
}

/// The illumination model and its own parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    Lambert,
    /// (V.R)^n; `lafortune` normalises the lobe, else it is as printed in 1975.
    Phong {
        exponent: f32,
        lafortune: bool,
    },
    /// (N.H)^n.
    BlinnPhong {
        exponent: f32,
    },
    /// One or two lobes; `normalisation_1982` prints D as the paper does.
    CookTorrance {
        lobes: Vec<Lobe>,
        fresnel: Fresnel,
        normalisation_1982: bool,
    },
    Mirror,
    /// `absorption`: Beer coefficient per scene unit.
    Dielectric {
        eta: f32,
        absorption: Rgb,
    },
    /// Shown as it is, unlit.
    Emissive,
}

/// Non-refractive transparency (row 22).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transparency {
    /// I = (1 - k_t) I_1 + k_t I_2.
    Interpolated { k_t: f32 },
    /// I = I_1 + k_t O_t I_2.
    Filtered { k_t: f32, color: Rgb },
}

/// One material. Weights are >= 0; Cook-Torrance has k_d + k_s = 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: String,
    pub model: Model,
    /// O_d, or the reflectance of a mirror, or the radiance of `Emissive`.
    pub color: Rgb,
    pub color_texture: Option<TextureId>,
    /// O_s, or the factor on light refracted by a dielectric.
    pub specular_color: Rgb,
    pub k_a: f32,
    pub k_d: f32,
    pub k_s: f32,
    /// Weight of the mirror branch added to a local model under `whitted` (row 24).
    pub k_r: f32,
    pub transparency: Option<Transparency>,
    pub emission: Rgb,
    /// None: a transparent pane casts none (the lecture's assumption), everything else does.
    pub casts_shadow: Option<bool>,
}

impl Material {
    /// The house's default surface: a Lambert grey of 0.7.
    pub fn grey(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            model: Model::Lambert,
            color: Rgb::splat(0.7),
            color_texture: None,
            specular_color: Rgb::ONE,
            k_a: 1.0,
            k_d: 1.0,
            k_s: 0.0,
            k_r: 0.0,
            transparency: None,
            emission: Rgb::ZERO,
            casts_shadow: None,
        }
    }
}
