//! From a point of the film to a ray.

use glam::Vec3;

use super::math::*;
use crate::layout::{CAMERA_PERSPECTIVE, Camera};

/// A ray into the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraRay {
    pub origin: Vec3,
    /// Unit.
    pub direction: Vec3,
}

/// The ray through a film point, in pixels of the full frame from its upper left corner (pixel centres at .5); points
/// outside the frame are fine. Perspective: all rays start at the eye. Orthographic: rays are parallel and start on
/// the image plane through the eye.
#[inline]
pub fn camera_ray(camera: &Camera, film_x: f32, film_y: f32) -> CameraRay {
    let s = film_x * camera.scale_x - 1.0;
    let t = 1.0 - film_y * camera.scale_y;
    let offset = camera.right * s + camera.up * t;
    if camera.kind == CAMERA_PERSPECTIVE {
        return CameraRay {
            origin: camera.eye,
            direction: normalize3(camera.forward + offset),
        };
    }
    CameraRay {
        origin: camera.eye + offset,
        direction: normalize3(camera.forward),
    }
}
