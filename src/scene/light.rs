//! Lights as written.

use super::{Rgb, TextureId};
use glam::Vec3;

/// What the number given for a light means (LECTURE, DESIGN section 5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntensityUnit {
    /// The lecture's I_p: radiant intensity (directional: irradiance) divided by pi.
    Lecture,
    /// W/sr (directional: W/m^2).
    #[default]
    Radiometric,
}

/// Fall-off with distance d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attenuation {
    /// 1 / d^2.
    InverseSquare,
    /// min(1, 1 / (c1 + c2 d + c3 d^2)).
    Polynomial {
        c1: f32,
        c2: f32,
        c3: f32,
    },
    None,
}

/// The light's shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    Point {
        position: Vec3,
    },
    /// `direction`: the way the light travels, unit.
    Directional {
        direction: Vec3,
    },
    /// Half angles in radians, `inner <= outer`; `exponent` is Warn's p (0: none).
    Spot {
        position: Vec3,
        direction: Vec3,
        inner: f32,
        outer: f32,
        exponent: f32,
    },
}

/// What stands in a spot's beam, beside its cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide {
    /// A picture that colours the light. A direction d from the light, whose axis is a, meets it at
    /// u = 1/2 + (d . right) / (d . a), v = 1/2 + (d . up) / (d . a); v = 0 is its bottom.
    pub texture: Option<TextureId>,
    pub right: Vec3,
    pub up: Vec3,
    /// Half angles in radians between which the light falls off linearly from all to nothing.
    pub ramp: Option<[f32; 2]>,
    /// No light beyond the picture; and as much more of it off the axis (1 / cos^3) as to light a plane across evenly.
    pub projector: bool,
}

/// The box of the world that a light reaches (Warn 1983: planes of constant x, y or z, `min <= max`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flaps {
    pub min: Vec3,
    pub max: Vec3,
}

impl Flaps {
    pub const NONE: Self = Self { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
}

/// One light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    pub name: String,
    pub kind: LightKind,
    /// In `unit`.
    pub intensity: Rgb,
    pub unit: IntensityUnit,
    pub attenuation: Attenuation,
    pub flaps: Flaps,
    pub casts_shadow: bool,
    /// Of spots only.
    pub slide: Option<Slide>,
}
