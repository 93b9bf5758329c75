//! Flat, Gouraud and Phong shading of triangles (row 8).

mod common;
#[path = "common/device.rs"]
mod device;
#[path = "common/scenes.rs"]
mod scenes;

use common::{globe, scene_of};
use glam::Vec3;
use gonio::bake::{SceneData, bake};
use gonio::film::Image;
use gonio::layout::INVALID;
use gonio::render::cpu::CpuRenderer;
use gonio::render::vulkan::{FetchChoice, VulkanOptions, VulkanRenderer};
use gonio::render::{Bounce, Renderer};
use gonio::scene::*;

/// To the light.
const LIGHT: Vec3 = Vec3::new(0.48, 0.6, 0.64);

/// A coarse sphere under `local` with one directional light that a white surface facing it shows as 1.
fn coarse(shading: Shading, model: Model) -> Scene {
    let mut scene = scene_of(vec![globe(5)]);
    let glossy = !matches!(model, Model::Lambert);
    let weights = if glossy { (0.2, 0.8) } else { (1.0, 0.0) };
    scene.materials[0] = Material { model, color: Rgb::ONE, k_d: weights.0, k_s: weights.1, ..Material::grey("m") };
    scene.settings.integrator = Integrator::Local;
    scene.settings.shading = shading;
    scene.settings.shadows = Shadows::Off;
    scene.settings.samples = 1;
    scene.camera.projection = Projection::Perspective { fov_y: 0.45 };
    scene.lights.push(Light {
        name: "sun".into(),
        kind: LightKind::Directional { direction: -LIGHT },
        intensity: Rgb::ONE,
        unit: IntensityUnit::Lecture,
        attenuation: Attenuation::None,
        flaps: Flaps::NONE,
        casts_shadow: true,
        slide: None,
    });
    scene
}

fn picture(scene: &Scene) -> (SceneData, Image) {
    let data = bake(scene).unwrap();
    let image = scenes::render_cpu(scene, &data).resolve();
    (data, image)
}

/// What the sample of each pixel has hit, and the red it has shown.
fn hits(scene: &Scene) -> Vec<(Bounce, f32)> {
    let (data, image) = picture(scene);
    let mut renderer = CpuRenderer::new(&data, None).unwrap();
    let pixels = (0..image.height).flat_map(|y| (0..image.width).map(move |x| (x, y)));
    let seen = pixels.zip(&image.pixels).map(|((x, y), pixel)| (renderer.inspect(x, y, 0).unwrap()[0], pixel[0]));
    seen.filter(|(bounce, _)| bounce.hit.instance != INVALID).collect()
}

/// Two fixed-point steps of the film for each of three contributions.
const STEP: f32 = 2e-6;

#[test]
fn flat_shows_lambert_of_the_face_normal_on_all_of_a_face() {
    let scene = coarse(Shading::Flat, Model::Lambert);
    let mesh = &scene.meshes[0];
    let seen = hits(&scene);
    assert!(seen.len() > 300, "{}", seen.len());
    for (bounce, value) in seen {
        let [a, b, c] = mesh.triangles[bounce.hit.primitive as usize].map(|i| mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a).normalize();
        let expected = normal.dot(LIGHT).max(0.0);
        assert!((value - expected).abs() < STEP, "{bounce:?}: {value} for {expected}");
    }
}

#[test]
fn flat_has_one_highlight_value_on_each_face() {
    let model = Model::Phong { exponent: 6.0, lafortune: Some(false) };
    let mut faces = std::collections::BTreeMap::<u32, (f32, f32)>::new();
    for (bounce, value) in hits(&coarse(Shading::Flat, model)) {
        let range = faces.entry(bounce.hit.primitive).or_insert((value, value));
        *range = (range.0.min(value), range.1.max(value));
    }
    assert!(faces.len() > 20, "{}", faces.len());
    assert!(faces.values().all(|(low, high)| high - low < STEP), "{faces:?}");
}

#[test]
fn gouraud_interpolates_what_the_corners_show() {
    let scene = coarse(Shading::Gouraud, Model::Lambert);
    let mesh = &scene.meshes[0];
    for (bounce, value) in hits(&scene) {
        let corners = mesh.triangles[bounce.hit.primitive as usize];
        let [a, b, c] = corners.map(|i| mesh.normals[i as usize].normalize().dot(LIGHT).max(0.0));
        let (b1, b2) = (bounce.hit.b1, bounce.hit.b2);
        let expected = a * (1.0 - b1 - b2) + b * b1 + c * b2;
        assert!((value - expected).abs() < STEP, "{bounce:?}: {value} for {expected}");
    }
}

#[test]
fn gouraud_takes_the_view_and_the_texture_at_each_corner() {
    let model = Model::Phong { exponent: 3.0, lafortune: Some(false) };
    let mut scene = coarse(Shading::Gouraud, model);
    scene.materials[0].k_d = 0.0;
    let mesh = &scene.meshes[0];
    let lobe = |corner: usize| {
        let (point, normal) = (mesh.positions[corner], mesh.normals[corner].normalize());
        let to_eye = (scene.camera.eye - point).normalize();
        let mirrored = normal * (2.0 * normal.dot(LIGHT)) - LIGHT;
        // Corners that face away from the eye are bent towards it, and left out here.
        let seen = normal.dot(to_eye) > 0.01;
        seen.then(|| if normal.dot(LIGHT) > 0.0 { 0.8 * to_eye.dot(mirrored).max(0.0).powi(3) } else { 0.0 })
    };
    let mut checked = 0;
    for (bounce, value) in hits(&scene) {
        let corners = mesh.triangles[bounce.hit.primitive as usize].map(|i| lobe(i as usize));
        let [Some(a), Some(b), Some(c)] = corners else { continue };
        let (b1, b2) = (bounce.hit.b1, bounce.hit.b2);
        let expected = a * (1.0 - b1 - b2) + b * b1 + c * b2;
        assert!((value - expected).abs() < 1e-5, "{bounce:?}: {value} for {expected}");
        checked += 1;
    }
    assert!(checked > 300, "{checked}");
}

#[test]
fn gouraud_loses_the_highlight_that_phong_shows() {
    let model = || Model::Phong { exponent: 200.0, lafortune: Some(false) };
    let brightest = |shading| hits(&coarse(shading, model())).iter().map(|(_, v)| *v).fold(0.0, f32::max);
    let (gouraud, phong) = (brightest(Shading::Gouraud), brightest(Shading::Phong));
    assert!(gouraud < 0.3 && phong > 0.8, "{gouraud} {phong}");
}

#[test]
fn a_corner_in_shadow_darkens_its_share_of_the_triangle() {
    let lit = {
        let mut scene = coarse(Shading::Gouraud, Model::Lambert);
        let corners = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        let shade = [Vec3::new(-0.1, -0.1, 0.0), Vec3::new(0.1, -0.1, 0.0), Vec3::new(0.0, 0.1, 0.0)];
        let mesh = |positions: Vec<Vec3>| Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() };
        scene.meshes = vec![mesh(corners.to_vec()), mesh(shade.map(|p| p + corners[0] + LIGHT).to_vec())];
        scene.objects.push(Object { geometry: Geometry::Mesh(MeshId(1)), ..scene.objects[0].clone() });
        scene
    };
    let shadowed = {
        let mut scene = lit.clone();
        scene.settings.shadows = Shadows::Opaque;
        scene
    };
    let full = LIGHT.z;
    let (with, without) = (hits(&shadowed), hits(&lit));
    let on_floor = |(bounce, _): &&(Bounce, f32)| bounce.hit.instance == 0;
    assert!(without.iter().filter(on_floor).all(|(_, v)| (v - full).abs() < STEP));
    for (bounce, value) in with.iter().filter(on_floor) {
        let expected = full * (bounce.hit.b1 + bounce.hit.b2);
        assert!((value - expected).abs() < STEP, "{bounce:?}: {value} for {expected}");
    }
}

#[test]
fn corners_of_a_closed_mesh_do_not_shadow_themselves() {
    let shadowed = |shadows| {
        let mut scene = coarse(Shading::Gouraud, Model::Lambert);
        scene.settings.shadows = shadows;
        // Large and far from the origin: rounding is at its worst.
        let place = glam::DAffine3::from_scale_rotation_translation(
            glam::DVec3::splat(3.0),
            glam::DQuat::from_rotation_y(0.3),
            glam::DVec3::new(700.0, -300.0, 500.0),
        );
        scene.objects[0].transform = Transform(place);
        scene.camera.target = Vec3::new(700.0, -300.0, 500.0);
        scene.camera.eye = scene.camera.target + Vec3::new(0.0, 0.0, 15.0);
        let mesh = scene.meshes[0].clone();
        let turned = place.matrix3.as_mat3();
        // Triangles all of whose corners see the light well above their own plane.
        let clear = move |primitive: u32| {
            let [a, b, c] = mesh.triangles[primitive as usize].map(|i| turned * mesh.positions[i as usize]);
            (b - a).cross(c - a).normalize().dot(LIGHT) > 0.75
        };
        hits(&scene).into_iter().filter(move |(bounce, _)| clear(bounce.hit.primitive)).collect::<Vec<_>>()
    };
    let (with, without) = (shadowed(Shadows::Opaque), shadowed(Shadows::Off));
    assert!(with.len() > 80, "{}", with.len());
    for ((bounce, a), (_, b)) in with.iter().zip(&without) {
        assert!((a - b).abs() < STEP, "{bounce:?}: {a} {b}");
    }
}

#[test]
fn an_object_overrides_the_scenes_shading_and_other_integrators_say_that_they_have_none() {
    let mut scene = coarse(Shading::Flat, Model::Lambert);
    let (flat, _) = picture(&scene);
    scene.objects[0].shading = Some(Shading::Phong);
    let (phong, _) = picture(&scene);
    let flags = |data: &SceneData| data.instances[0].flags;
    assert_eq!((flags(&flat), flags(&phong)), (gonio::layout::INSTANCE_FLAT, 0));
    scene.objects[0].shading = Some(Shading::Gouraud);
    assert_eq!(flags(&picture(&scene).0), gonio::layout::INSTANCE_GOURAUD);
    scene.settings.integrator = Integrator::Whitted;
    let (whitted, _) = picture(&scene);
    assert_eq!(flags(&whitted), 0);
    assert!(whitted.warnings[0].contains("integrator \"local\" only"), "{:?}", whitted.warnings);
}

#[test]
fn an_analytic_sphere_cannot_be_faceted() {
    for shading in [Shading::Flat, Shading::Gouraud] {
        let mut scene = coarse(shading, Model::Lambert);
        scene.objects[0].geometry = Geometry::Sphere;
        let message = bake(&scene).unwrap_err().to_string();
        assert!(message.contains("analytic sphere") && message.contains("segments"), "{message}");
        scene.settings.shading = Shading::Phong;
        assert!(bake(&scene).is_ok());
    }
}

#[test]
fn every_shading_is_the_same_on_cpu_and_device() {
    if device::context().is_none() {
        return;
    }
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        for projection in [Projection::Perspective { fov_y: 0.5 }, Projection::Orthographic { height: 2.4 }] {
            let mut scene = coarse(shading, Model::Phong { exponent: 9.0, lafortune: Some(false) });
            scene.settings.shadows = Shadows::Opaque;
            scene.settings.samples = 2;
            scene.camera.projection = projection;
            scene.ambient = Rgb::new(0.1, 0.2, 0.3);
            scene.materials[0].transparency = Some(Transparency::Interpolated { k_t: 0.25 });
            scene.materials[0].casts_shadow = Some(true);
            let data = bake(&scene).unwrap();
            let reference = scenes::render_cpu(&scene, &data);
            let options = VulkanOptions { validate: true, fetch: FetchChoice::Storage, ..VulkanOptions::default() };
            let renderer = VulkanRenderer::new(&data, options).unwrap();
            let messages = renderer.messages();
            let mut renderer = device::Validated::new(renderer, messages);
            let film = scenes::render(&mut *renderer, &scene, &data, 0..2);
            scenes::assert_same(&reference, &film, &format!("{shading:?} {projection:?}"));
        }
    }
}
