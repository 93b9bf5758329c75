//! A stage for models that come without camera or lights: `gonio render bunny.obj` shows a good picture.
//!
//! An object is seen from the front right and slightly above, on a ground, under a key light that casts shadows, a fill
//! light that does not, and a light sky; a room is seen from inside. Everything is derived from the model's own bounds, so
//! its size and place do not matter.

use super::bounds::{Bounds, Room, free_distances};
use crate::scene::{
    Attenuation, Background, Camera, Film, Filter, Flaps, Geometry, Integrator, IntensityUnit, Light, LightKind,
    Material, MaterialId, MeshId, Object, Projection, RenderSettings, Rgb, Sampler, Scene, Shading, Shadows, ToneMap,
    Transform, shape,
};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::PI;
use std::path::Path;

/// 30 degrees: little perspective, as in a photograph of a product.
const FOV_Y: f32 = std::f32::consts::FRAC_PI_6;
/// 60 degrees, for rooms.
const FOV_Y_ROOM: f32 = std::f32::consts::FRAC_PI_3;
/// Part of the frame's half width that the model may fill.
const FILL: f64 = 0.88;
/// Irradiance of the key light over pi: what a white surface that faces it shows.
const KEY: f32 = 0.72;
const FILL_LIGHT: f32 = 0.18;
const AMBIENT: f32 = 0.1;

/// A scene with nothing in it, named after its file; `stage` gives it what it still lacks.
pub fn bare_scene(path: &Path) -> Scene {
    Scene {
        name: path.display().to_string(),
        film: Film {
            width: 1280,
            height: 720,
            crop: None,
            // No negative lobes: sampled ones would be noise at few samples a pixel.
            filter: Filter::Gaussian { radius: 1.5, sigma: 0.5 },
            unit_exponent: 0,
            tonemap: ToneMap::Clamp,
            exposure: 0.0,
            gamma: None,
        },
        settings: RenderSettings {
            integrator: Integrator::Whitted,
            samples: 16,
            seed: 0,
            sampler: Sampler::Sobol,
            max_depth: 8,
            min_weight: 0.003,
            rr_depth: 5,
            clamp: None,
            hide_emitters: false,
            transparent: false,
            aovs: false,
            shadows: Shadows::Opaque,
            shading: Shading::Phong,
        },
        camera: camera(DVec3::Z, DVec3::ZERO, FOV_Y),
        has_camera: false,
        background: Background::BLACK,
        ambient: Rgb::ZERO,
        materials: Vec::new(),
        textures: Vec::new(),
        tables: Vec::new(),
        meshes: Vec::new(),
        objects: Vec::new(),
        lights: Vec::new(),
        warnings: Vec::new(),
    }
}

/// Gives `scene` the camera, lights, ambient light, background and ground that it lacks. Cameras and lights of its own are
/// kept; the ground comes only where both are missing.
pub fn stage(scene: &mut Scene) {
    let bounds = Bounds::of(scene);
    let (no_camera, no_lights) = (!scene.has_camera, scene.lights.is_empty());
    let kind = bounds.room(scene);
    let room = kind != Room::None;
    if no_camera {
        scene.camera = if room { room_camera(scene, &bounds, kind) } else { object_camera(&scene.film, &bounds) };
        scene.has_camera = true;
    }
    if no_lights {
        match room {
            true => light_room(scene, &bounds),
            false => light_object(scene),
        }
        scene.ambient = Rgb::splat(if room { 2.0 * AMBIENT } else { AMBIENT });
        scene.background = Background::Gradient { bottom: Rgb::new(0.55, 0.55, 0.55), top: Rgb::new(0.72, 0.8, 0.92) };
    }
    if no_camera && no_lights && !room && bounds.wants_ground() {
        add_ground(scene, &bounds);
    }
}

/// Unit vector towards `azimuth` (from +z to +x) and `elevation`, radians.
fn towards(azimuth: f64, elevation: f64) -> DVec3 {
    let c = libm::cos(elevation);
    DVec3::new(libm::sin(azimuth) * c, libm::sin(elevation), libm::cos(azimuth) * c)
}

/// The front of a model is +z (as in glTF); thin ones are seen from their broad side.
fn object_camera(film: &Film, bounds: &Bounds) -> Camera {
    let size = bounds.size();
    let thin = 0.05 * size.max_element();
    let (azimuth, elevation): (f64, f64) = if size.y < thin {
        (30.0, 40.0)
    } else if size.z < thin {
        (12.0, 6.0)
    } else if size.x < thin {
        (78.0, 6.0)
    } else {
        (30.0, 20.0)
    };
    let back = towards(azimuth.to_radians(), elevation.to_radians());
    let distance = fit(film, bounds, back);
    camera(bounds.centre() + back * distance, bounds.centre(), FOV_Y)
}

/// How far from the centre of `bounds` along `back` a camera sees all of its points.
fn fit(film: &Film, bounds: &Bounds, back: DVec3) -> f64 {
    let (right, up) = frame(back);
    let tan_y = libm::tan(f64::from(FOV_Y) * 0.5) * FILL;
    let tan_x = tan_y * f64::from(film.width) / f64::from(film.height);
    let needed = |p: &DVec3| {
        let v = *p - bounds.centre();
        v.dot(back) + (v.dot(right).abs() / tan_x).max(v.dot(up).abs() / tan_y)
    };
    // A single point is seen from the distance its rounding allows.
    bounds.points().map(|p| needed(&p)).fold(0.0, f64::max).max(bounds.radius() * 1.1)
}

/// Right and up of a camera that looks against `back`.
fn frame(back: DVec3) -> (DVec3, DVec3) {
    let right = DVec3::Y.cross(back);
    let right = if right.length() > 1e-6 { right / right.length() } else { DVec3::X };
    (right, back.cross(right))
}

fn camera(eye: DVec3, target: DVec3, fov_y: f32) -> Camera {
    Camera {
        eye: eye.as_vec3(),
        target: target.as_vec3(),
        up: Vec3::Y,
        projection: Projection::Perspective { fov_y },
        lens: None,
        shift: Vec2::ZERO,
        mirrored: false,
    }
}

/// From where the view across the room's middle is longest, or, if a side is missing, through it from outside.
fn room_camera(scene: &Scene, bounds: &Bounds, kind: Room) -> Camera {
    let centre = bounds.centre();
    // Front first: it wins where distances are equal.
    let ways = [DVec3::Z, DVec3::X, DVec3::NEG_Z, DVec3::NEG_X];
    let free = free_distances(scene, centre, ways);
    if let Some(open) = free.iter().position(Option::is_none)
        && kind == Room::Open
    {
        let distance = fit(&scene.film, bounds, ways[open]);
        return camera(centre + ways[open] * distance, centre, FOV_Y);
    }
    // A window ends the room where its walls do.
    let walls = ways.map(|way| 0.5 * bounds.size().dot(way.abs()));
    let lengths: [f64; 4] = std::array::from_fn(|i| free[i].unwrap_or(walls[i]).min(walls[i]));
    let best = (0..4).fold(0, |best, i| if lengths[i] > lengths[best] { i } else { best });
    let eye = centre + ways[best] * (0.9 * lengths[best]).max(bounds.radius() * 1e-3);
    camera(eye, centre, FOV_Y_ROOM)
}

fn light(name: &str, kind: LightKind, irradiance: f32, attenuation: Attenuation, casts_shadow: bool) -> Light {
    Light {
        name: name.to_owned(),
        kind,
        intensity: Rgb::splat(irradiance),
        unit: IntensityUnit::Radiometric,
        attenuation,
        flaps: Flaps::NONE,
        casts_shadow,
        slide: None,
    }
}

/// Directional lights are the same at every size: the key from the upper left behind the camera, the fill from its right.
fn light_object(scene: &mut Scene) {
    let back = (scene.camera.eye.as_dvec3() - scene.camera.target.as_dvec3()).normalize_or(DVec3::Z);
    let azimuth = if back.x.abs().max(back.z.abs()) > 1e-3 { libm::atan2(back.x, back.z) } else { 0.0 };
    let lights = [("key", -50.0_f64, 50.0_f64, KEY, true), ("fill", 55.0, 20.0, FILL_LIGHT, false)];
    for (name, turn, elevation, strength, shadow) in lights {
        let direction = -towards(azimuth + turn.to_radians(), elevation.to_radians()).as_vec3();
        let irradiance = strength * PI as f32;
        scene.lights.push(light(name, LightKind::Directional { direction }, irradiance, Attenuation::None, shadow));
    }
}

/// A lamp under the ceiling and a shadowless one beside the camera; their strength grows with the square of the room.
fn light_room(scene: &mut Scene, bounds: &Bounds) {
    let centre = bounds.centre();
    let [ceiling] = free_distances(scene, centre, [DVec3::Y]);
    let ceiling = ceiling.unwrap_or(bounds.size().y * 0.5);
    let reach = bounds.size().max_element() * 0.5;
    let eye = scene.camera.eye;
    let lamp = (centre + DVec3::Y * (0.8 * ceiling)).as_vec3();
    let lights = [("lamp", lamp, KEY, true), ("fill", eye, FILL_LIGHT, false)];
    for (name, position, strength, shadow) in lights {
        let intensity = f64::from(strength) * PI * reach * reach;
        let kind = LightKind::Point { position };
        scene.lights.push(light(name, kind, intensity as f32, Attenuation::InverseSquare, shadow));
    }
}

/// A disk under the model, wide enough that the default camera never sees its rim.
fn add_ground(scene: &mut Scene, bounds: &Bounds) {
    /// Radii of the model: at a downward view of 5 degrees the ground is 15 away.
    const REACH: f64 = 60.0;
    let mut mesh = shape::disk(1.0, 96);
    mesh.name = "ground".to_owned();
    let radius = bounds.radius() * REACH;
    // A little below, so that a flat bottom does not lie in the same plane; far from the origin at least its rounding.
    let gap = (bounds.radius() * 1e-4).max(bounds.low().abs().max_element() * 1e-6);
    let centre = bounds.centre().with_y(bounds.low().y - gap);
    let ground = Material { color: Rgb::splat(0.55), ..Material::grey("ground") };
    scene.materials.push(ground);
    scene.meshes.push(mesh);
    scene.objects.push(Object {
        name: "ground".to_owned(),
        geometry: Geometry::Mesh(MeshId(scene.meshes.len() as u32 - 1)),
        transform: Transform(glam::DAffine3 {
            matrix3: glam::DMat3::from_diagonal(DVec3::new(radius, 1.0, radius)),
            translation: centre,
        }),
        material: Some(MaterialId(scene.materials.len() as u32 - 1)),
        casts_shadow: None,
        shading: None,
    });
}
