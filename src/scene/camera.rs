//! The camera as written.

use super::Film;
use glam::{Vec2, Vec3};

/// How the image plane is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Full vertical field of view, radians.
    Perspective { fov_y: f32 },
    /// Height of the view in scene units.
    Orthographic { height: f32 },
}

/// A thin lens in the eye's plane, perpendicular to the view; what is at the distance of focus is sharp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Scene units, > 0.
    pub radius: f32,
    /// From the lens to the plane of focus along the view, scene units, > 0.
    pub focus_distance: f32,
}

/// Where the picture is taken from. `eye`, `target` differ and `up` is not parallel to the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: Vec3,
    pub target: Vec3,
    pub up: Vec3,
    pub projection: Projection,
    /// None: a pinhole, all is sharp.
    pub lens: Option<Lens>,
    /// The picture is a part of a larger one: this many of its own widths to the right of the middle, and heights above.
    pub shift: Vec2,
    /// Left and right are swapped, as in a mirror.
    pub mirrored: bool,
}

/// One of the cameras that a file has.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedCamera {
    /// May be empty.
    pub name: String,
    pub camera: Camera,
    /// Width of its frame over its height, where it says so.
    pub aspect: Option<f32>,
}

impl NamedCamera {
    /// The width of its frame, pixels, for the height of `film`; that of `film` where the camera does not say.
    pub fn width_of(&self, film: &Film) -> u32 {
        let width = self.aspect.map(|aspect| (f64::from(film.height) * f64::from(aspect)).round());
        width.map_or(film.width, |width| width.clamp(1.0, 65_535.0) as u32)
    }
}
