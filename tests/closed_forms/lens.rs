//! The thin lens.

use super::common::{empty_scene, object};
use super::picture;
use glam::{Vec2, Vec3};
use gonio::scene::*;

/// Distance of the picture's one thing from the lens.
const FAR: f32 = 5.0;

/// A glowing half plane, x > 0, at distance `FAR`, seen straight on by 32 x 8 pixels, 2 units wide there.
fn edge(lens: Option<Lens>, projection: Projection) -> Scene {
    let mut scene = empty_scene();
    (scene.film.width, scene.film.height) = (32, 8);
    scene.settings.samples = 1024;
    scene.materials = vec![Material { emission: Rgb::ONE, color: Rgb::ZERO, ..Material::grey("glow") }];
    scene.meshes = vec![shape::quad([20.0, 20.0], 1)];
    let upright = Transform::rotate(Vec3::X, std::f64::consts::FRAC_PI_2);
    scene.objects = vec![object(Geometry::Mesh(MeshId(0)), upright.then(Transform::translate(Vec3::X * 10.0)))];
    scene.camera = Camera {
        eye: Vec3::Z * FAR,
        target: Vec3::ZERO,
        up: Vec3::Y,
        projection,
        lens,
        shift: Vec2::ZERO,
        mirrored: false,
    };
    scene
}

fn perspective() -> Projection {
    // 2 units wide at distance 5: half a unit high.
    Projection::Perspective { fov_y: 2.0 * libm::atanf(0.25 / FAR) }
}

/// Part of the unit disk at x > -d: by how much a disk around d reaches beyond the edge at 0.
fn lit_part(d: f64) -> f64 {
    let d = d.clamp(-1.0, 1.0);
    0.5 + (d * (1.0 - d * d).sqrt() + d.asin()) / std::f64::consts::PI
}

#[test]
fn an_edge_out_of_focus_blurs_as_its_circle_of_confusion_says() {
    let in_front = Lens { radius: 0.5, focus_distance: 2.5 };
    let behind = Lens { radius: 0.6, focus_distance: 10.0 };
    for projection in [perspective(), Projection::Orthographic { height: 0.5 }] {
        for lens in [in_front, behind] {
            let scene = edge(Some(lens), projection);
            let pixels = picture(&scene);
            let confusion = f64::from(lens.radius) * (1.0 - f64::from(FAR / lens.focus_distance)).abs();
            for (index, pixel) in pixels.iter().enumerate() {
                // The pixel's middle where the edge is; across a pixel the profile is straight enough.
                let x = (index % 32) as f64 / 16.0 - 1.0 + 1.0 / 32.0;
                let wanted = lit_part(x / confusion);
                let found = f64::from(pixel[0]);
                // 1,024 points of a (0, 2)-sequence under an edge.
                assert!((found - wanted).abs() < 0.012, "{projection:?}, {lens:?}, x = {x}: {found}, not {wanted}");
            }
        }
    }
}

#[test]
fn what_is_in_focus_is_as_sharp_as_through_a_pinhole() {
    for projection in [perspective(), Projection::Orthographic { height: 0.5 }] {
        let lens = Lens { radius: 0.5, focus_distance: FAR };
        let seen = |lens| picture(&edge(lens, projection));
        let (sharp, pinhole) = (seen(Some(lens)), seen(None));
        for (index, (a, b)) in sharp.iter().zip(&pinhole).enumerate() {
            assert!((a[0] - b[0]).abs() < 1e-3, "pixel {index} of {projection:?}: {} and {}", a[0], b[0]);
        }
    }
}
