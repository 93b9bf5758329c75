//! Vertex normals that lean away from their face.

use super::common::empty_scene;
use super::{assert_mean, light, look_down, matte, mean, same_on_the_device};
use glam::Vec3;
use gonio::scene::*;

/// A square seen from above whose normals lean 60 degrees to +x, and a light so many degrees from the vertical to that side.
fn leaning(integrator: Integrator, degrees: f32) -> Scene {
    let mut scene = empty_scene();
    scene.settings = RenderSettings { integrator, samples: 4, max_depth: 1, ..scene.settings };
    scene.materials = vec![matte(Rgb::ONE)];
    super::level(&mut scene, 0.0, 0);
    let (sin, cos) = (60.0_f32.to_radians().sin(), 60.0_f32.to_radians().cos());
    scene.meshes[0].normals = vec![Vec3::new(sin, cos, 0.0); scene.meshes[0].positions.len()];
    let (sin, cos) = (degrees.to_radians().sin(), degrees.to_radians().cos());
    let direction = -Vec3::new(sin, cos, 0.0);
    scene.lights = vec![light(LightKind::Directional { direction }, std::f32::consts::PI)];
    look_down(&mut scene, 1.0, 1.0);
    scene
}

#[test]
fn a_surface_is_not_lit_from_behind_its_face_whatever_its_normals_say() {
    for integrator in [Integrator::Local, Integrator::Whitted, Integrator::Direct, Integrator::Path] {
        let what = format!("{integrator:?}");
        let behind = leaning(integrator, 100.0);
        assert_eq!(mean(&behind).value, 0.0, "{what}: 40 degrees from the normal, but below the square");
        assert_mean(mean(&leaning(integrator, 80.0)), f64::from(20.0_f32).to_radians().cos(), &what);
        if !same_on_the_device(&behind, &what) {
            return;
        }
    }
}
