//! From a point of the film to a ray.

use glam::{Vec2, Vec3};

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
    let s = (film_x * camera.scale_x - 1.0) + camera.shift_x;
    let t = (1.0 - film_y * camera.scale_y) + camera.shift_y;
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

/// The pinhole's ray `through` a film point, sent through point `p` (in the unit disk) of the thin lens instead: it meets
/// the other in the plane of focus. Source: Cook, Porter and Carpenter 1984, "Distributed Ray Tracing"; Pharr, Jakob and
/// Humphreys 2023, "Physically Based Rendering", section 5.2.3. The cone stays the pinhole's.
#[inline]
pub fn through_lens(camera: &Camera, through: CameraRay, p: Vec2) -> CameraRay {
    let to_focus = through.direction * div(camera.focus_distance, dot3(through.direction, camera.forward));
    let right = normalize3(camera.right) * (camera.lens_radius * p.x);
    let up = normalize3(camera.up) * (camera.lens_radius * p.y);
    let on_lens = right + up;
    CameraRay {
        origin: through.origin + on_lens,
        direction: normalize3(to_focus - on_lens),
        cone_width: through.cone_width,
        cone_spread: through.cone_spread,
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
    fn a_shifted_picture_is_a_part_of_a_larger_one() {
        for kind in [CAMERA_PERSPECTIVE, CAMERA_ORTHOGRAPHIC] {
            let shifted = Camera { shift_x: 0.5, shift_y: -0.25, ..camera(kind) };
            // Half of half the width to the right and a quarter of half the height down.
            assert_eq!(camera_ray(&shifted, 20.0, 10.0), camera_ray(&camera(kind), 30.0, 12.5));
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

    #[test]
    fn rays_through_all_of_the_lens_meet_in_the_plane_of_focus() {
        for kind in [CAMERA_PERSPECTIVE, CAMERA_ORTHOGRAPHIC] {
            let camera = Camera { lens_radius: 0.5, focus_distance: 4.0, ..camera(kind) };
            for (x, y) in [(20.0, 10.0), (3.0, 17.5), (40.0, 0.0)] {
                let pinhole = camera_ray(&camera, x, y);
                let focus = pinhole.origin + pinhole.direction * (4.0 / -pinhole.direction.z);
                for p in [Vec2::ZERO, Vec2::X, Vec2::NEG_Y, Vec2::new(-0.6, 0.7)] {
                    let ray = through_lens(&camera, pinhole, p);
                    assert_eq!(ray.origin, pinhole.origin + Vec3::new(0.5 * p.x, 0.5 * p.y, 0.0));
                    assert!((ray.direction.length() - 1.0).abs() < 3e-7);
                    let there = ray.origin + ray.direction * (4.0 / -ray.direction.z);
                    assert!((there - focus).length() < 2e-6, "({x}, {y}) through {p}: {there}, not {focus}");
                }
            }
        }
    }
}
