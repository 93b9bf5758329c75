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
    /// Width of a pixel's cone at the origin, and what it grows by per unit of distance (in the middle of the picture).
    pub cone_width: f32,
    pub cone_spread: f32,
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
            cone_width: 0.0,
            cone_spread: camera.pixel_size,
        };
    }
    CameraRay {
        origin: camera.eye + offset,
        direction: normalize3(camera.forward),
        cone_width: camera.pixel_size,
        cone_spread: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::CAMERA_ORTHOGRAPHIC;

    /// 40 x 20 pixels at (1, 2, 3), looking along -z, 90 degrees wide.
    fn camera(kind: u32) -> Camera {
        Camera {
            eye: Vec3::new(1.0, 2.0, 3.0),
            kind,
            right: Vec3::X,
            scale_x: 2.0 / 40.0,
            up: Vec3::Y * 0.5,
            scale_y: 2.0 / 20.0,
            forward: Vec3::NEG_Z,
            ..Camera::default()
        }
    }

    #[test]
    fn perspective_rays_leave_the_eye_through_their_film_point() {
        for (x, y, want) in [
            (20.0, 10.0, Vec3::NEG_Z),
            (40.0, 10.0, Vec3::new(1.0, 0.0, -1.0)),
            (0.0, 10.0, Vec3::new(-1.0, 0.0, -1.0)),
            (20.0, 0.0, Vec3::new(0.0, 0.5, -1.0)),
            (0.0, 20.0, Vec3::new(-1.0, -0.5, -1.0)),
        ] {
            let ray = camera_ray(&camera(CAMERA_PERSPECTIVE), x, y);
            assert_eq!(ray.origin, Vec3::new(1.0, 2.0, 3.0));
            assert!((ray.direction - want.normalize()).length() < 3e-7, "({x}, {y}): {ray:?}");
        }
    }

    #[test]
    fn orthographic_rays_are_parallel_and_start_at_their_film_point() {
        for (x, y, origin) in [
            (20.0, 10.0, Vec3::new(1.0, 2.0, 3.0)),
            (40.0, 0.0, Vec3::new(2.0, 2.5, 3.0)),
            (0.0, 20.0, Vec3::new(0.0, 1.5, 3.0)),
        ] {
            let ray = camera_ray(&camera(CAMERA_ORTHOGRAPHIC), x, y);
            assert_eq!((ray.origin, ray.direction), (origin, Vec3::NEG_Z), "({x}, {y})");
        }
    }
}
