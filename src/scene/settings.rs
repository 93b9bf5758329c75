//! What to compute and how the result is shown.

use super::{Rgb, TextureId, Transform};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// The illumination model alone; no secondary rays but optional shadows.
    Local,
    /// Whitted 1980: shadow, mirror and refracted rays to a depth.
    #[default]
    Whitted,
    /// Path tracing of one scattering event: light from emitters only (`Path` with a depth of 1).
    Direct,
    /// Path tracing (Kajiya 1986).
    Path,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampler {
    /// Owen-scrambled Sobol' (Burley 2020).
    #[default]
    Sobol,
    /// Jittered strata.
    Stratified,
    Independent,
}

/// Reconstruction filter; radii in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    Box {
        radius: f32,
    },
    Tent {
        radius: f32,
    },
    Gaussian {
        radius: f32,
        sigma: f32,
    },
    Mitchell {
        radius: f32,
        b: f32,
        c: f32,
    },
    /// The four-term window (Harris 1978).
    BlackmanHarris {
        radius: f32,
    },
    /// sinc(x) sinc(x / radius), x in pixels.
    Lanczos {
        radius: f32,
    },
}

/// How the triangles of a mesh are shaded under `local` (row 8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// One evaluation a triangle, at its centroid with its own normal.
    Flat,
    /// One evaluation a corner, with its normal; the radiance is interpolated (Gouraud 1971).
    Gouraud,
    /// One evaluation a sample, with the interpolated normal (Phong 1975).
    #[default]
    Phong,
}

/// A part of the frame, in pixels from its upper left corner; not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// The image plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Pixels, 1 to 65,535 each.
    pub width: u32,
    pub height: u32,
    /// What of the frame is rendered; all of it if not given.
    pub crop: Option<Window>,
    pub filter: Filter,
    /// e of `unit = 2^e`: the radiance that one film unit stands for.
    pub unit_exponent: i32,
    /// How the picture is displayed, unless the command line says otherwise.
    pub tonemap: ToneMap,
    /// In stops.
    pub exposure: f32,
    /// Display encoding is light to the power 1/gamma; none: sRGB.
    pub gamma: Option<f32>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    #[default]
    Clamp,
    /// Divide by the image's maximum.
    Normalise,
    /// L / (1 + L) on luminance (Reinhard et al. 2002, equation 3).
    Reinhard,
    /// ACES 1.0 as fitted by Hill 2016.
    Aces,
    /// Sobotka 2022.
    Agx,
}

/// What a ray that leaves the scene sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// A vertical gradient from `bottom` (-y) to `top` (+y), flat if both are equal.
    Gradient { bottom: Rgb, top: Rgb },
    /// An image all around.
    Image(Environment),
}

/// An equirectangular image: its top row is +y, its centre +z, a quarter from the left +x (the latitude-longitude
/// convention of OpenEXR).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    pub texture: TextureId,
    /// Factor on the image.
    pub scale: Rgb,
    /// Rotation; only the linear part counts, without its scale.
    pub to_world: Transform,
}

impl Background {
    pub const BLACK: Self = Self::flat(Rgb::ZERO);

    /// The same in every direction.
    pub const fn flat(color: Rgb) -> Self {
        Self::Gradient { bottom: color, top: color }
    }

    /// False if it shines nowhere.
    pub fn shines(&self) -> bool {
        match self {
            Self::Gradient { bottom, top } => *bottom != Rgb::ZERO || *top != Rgb::ZERO,
            Self::Image(environment) => environment.scale != Rgb::ZERO,
        }
    }
}

/// What shadow rays do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadows {
    /// None is traced.
    Off,
    /// Whatever they meet stops them; panes are not met (row 22's assumption), but by paths.
    #[default]
    Opaque,
    /// Panes colour and weaken them.
    Filtered,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    pub integrator: Integrator,
    /// Samples a pixel, 1 to 2^24.
    pub samples: u32,
    pub seed: u32,
    pub sampler: Sampler,
    /// Scattering events, 0 to 64.
    pub max_depth: u32,
    /// Branches whose largest weight falls below this are cut (whitted).
    pub min_weight: f32,
    /// Scattering events from which on Russian roulette may end a path, 0 to 65; more than `max_depth`: never (path).
    pub rr_depth: u32,
    /// The camera sees neither what glows nor the background (path).
    pub hide_emitters: bool,
    /// The camera does not see the background, so that alpha (coverage) means something.
    pub transparent: bool,
    /// Auxiliary values (depth, normal, albedo, object, material) are kept.
    pub aovs: bool,
    /// Largest channel of what one contribution of scattered light may add to a pixel (path).
    pub clamp: Option<f32>,
    pub shadows: Shadows,
    /// Of objects that do not say otherwise; `local` only.
    pub shading: Shading,
}
