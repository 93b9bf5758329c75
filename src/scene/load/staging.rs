//! A stage for models that come without camera or lights: `gonio render bunny.obj` shows a good picture.
//!
//! An object is seen from the front right and slightly above, on a ground a little darker than itself, in a studio that is an
//! image all around; integrators that no image lights get lamps instead. A room is seen from inside. Light that the file has is
//! kept, and then there is no other. Everything is derived from the model's own bounds, so its size and place do not matter.

use super::bounds::{Bounds, Room, free_distances};
use super::controls::{Around, Controls};
use super::meter;
use super::reflectance::mean_reflectance;
use super::surroundings::{Surroundings, towards};
use crate::scene::{
    Attenuation, Background, Camera, Film, Filter, Flaps, Geometry, Integrator, IntensityUnit, Light, LightKind,
    Material, MaterialId, MeshId, Model, Object, Projection, RenderSettings, Rgb, Sampler, Scene, SceneError, Shading,
    Shadows, ToneMap, Transform, shape,
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
/// Samples a pixel under `path`: where images and lamps light the scene, what is left of the grain is a step of the display.
const SAMPLES_TRACED: u32 = 32;
/// What glows more than white paper in good light is a lamp, not a display.
const LAMP: f32 = 1.0;

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
        cameras: Vec::new(),
        background: Background::BLACK,
        ambient: Rgb::ZERO,
        materials: Vec::new(),
        textures: Vec::new(),
        tables: Vec::new(),
        meshes: Vec::new(),
        objects: Vec::new(),
        lights: Vec::new(),
        metered: false,
        notes: Vec::new(),
        warnings: Vec::new(),
    }
}

/// How scenes of other programs are computed and shown, as far as their files do not say.
pub fn prepare(scene: &mut Scene) {
    scene.film.tonemap = ToneMap::Aces;
    scene.settings.shadows = Shadows::Filtered;
    scene.metered = true;
}

/// Gives `scene` the camera, light and ground that it lacks, as `controls` want them, and chooses how it is computed. Cameras and
/// lights of its own are kept; the ground comes only where both are missing.
pub fn stage(scene: &mut Scene, controls: &Controls) -> Result<(), SceneError> {
    let bounds = Bounds::of(scene);
    let kind = bounds.room(scene);
    let room = kind != Room::None;
    let has_camera = scene.has_camera;
    if !has_camera {
        scene.camera = if room { room_camera(scene, &bounds, kind) } else { object_camera(&scene.film, &bounds) };
        scene.has_camera = true;
    }
    controls.aim(scene, bounds.centre());
    let (own, glows) = (scene.lights.len(), has_lamps(scene));
    let is_lit = own > 0 || glows || scene.background.shines();
    choose_integrator(scene, room && !glows && controls.surroundings.is_none(), controls);
    let traced = matches!(scene.settings.integrator, Integrator::Path | Integrator::Direct);
    let model = mean_reflectance(scene);
    if let Some(around) = &controls.surroundings {
        scene.background = controls.background(around, scene)?;
        if !traced {
            scene.ambient = Rgb::splat(AMBIENT);
        }
    } else if is_lit {
        keep_light(scene, own, glows, traced);
    } else if room {
        light_room(scene, &bounds);
        light_all_around(scene, 2.0 * AMBIENT, traced);
    } else if traced {
        scene.background = controls.background(&Around::Ours(Surroundings::Studio), scene)?;
    } else {
        light_object(scene);
        light_all_around(scene, AMBIENT, traced);
    }
    let wanted = !controls.cut_out
        && !has_camera
        && !room
        && (!is_lit || controls.surroundings.is_some())
        && bounds.wants_ground();
    if controls.ground.unwrap_or(wanted) {
        add_ground(scene, &bounds, ground_color(model));
    }
    Ok(())
}

/// Whether an object glows so that it lights others.
fn has_lamps(scene: &Scene) -> bool {
    let is_lamp = |id: &MaterialId| {
        let material = &scene.materials[id.0 as usize];
        let shown = if matches!(material.model, Model::Emissive) { material.color } else { material.emission };
        shown.max_element() > LAMP
    };
    scene.objects.iter().any(|object| match (object.material, object.geometry) {
        (Some(id), _) => is_lamp(&id),
        (None, Geometry::Mesh(mesh)) => scene.meshes[mesh.0 as usize].face_materials.iter().any(&is_lamp),
        (None, Geometry::Sphere) => false,
    })
}

/// By the scene alone, never by the time that something takes. A room without lamps is lit by points, whose light from wall to
/// wall would show grain.
fn choose_integrator(scene: &mut Scene, lit_by_points: bool, controls: &Controls) {
    let chosen = if lit_by_points { Integrator::Whitted } else { Integrator::Path };
    let settings = &mut scene.settings;
    settings.integrator = controls.integrator.unwrap_or(chosen);
    if matches!(settings.integrator, Integrator::Path | Integrator::Direct) {
        settings.samples = SAMPLES_TRACED;
    }
}

/// The file's own light alone lights the scene; says so.
fn keep_light(scene: &mut Scene, lights: usize, glows: bool, traced: bool) {
    let level = meter::light_level(scene);
    if level > 0.0 {
        // What other programs light with an environment would be black in our shadows.
        scene.ambient = if traced { scene.ambient } else { Rgb::splat(0.06 * level as f32) };
        if scene.film.unit_exponent == 0 {
            scene.film.unit_exponent = meter::unit_exponent(level);
        }
    }
    let what = match (lights, glows) {
        (0, _) => "what glows in the file".to_owned(),
        (1, _) => "the file's own light".to_owned(),
        (n, _) => format!("the file's own {n} lights"),
    };
    scene.notes.push(format!("{}: lit by {what} alone; --environment sky adds daylight", scene.name));
}

/// For integrators that no image lights: ambient light and a pale sky. Under the others the sky of a room is behind its windows.
fn light_all_around(scene: &mut Scene, ambient: f32, traced: bool) {
    if !traced {
        scene.ambient = Rgb::splat(ambient);
    }
    scene.background = Background::Gradient { bottom: Rgb::new(0.55, 0.55, 0.55), top: Rgb::new(0.72, 0.8, 0.92) };
}

/// A little darker than a model of this reflectance, so that neither white stands on white nor black on black.
fn ground_color(model: f64) -> Rgb {
    Rgb::splat((0.5 * model).clamp(0.1, 0.36) as f32)
}

/// Degrees from +z to +x of the direction from which the camera looks.
pub(super) fn azimuth_of(camera: &Camera) -> f64 {
    let back = (camera.eye.as_dvec3() - camera.target.as_dvec3()).normalize_or(DVec3::Z);
    let is_level = back.x.abs().max(back.z.abs()) > 1e-3;
    if is_level { libm::atan2(back.x, back.z).to_degrees() } else { 0.0 }
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
    camera_from(film, bounds, azimuth, elevation)
}

/// A camera that sees all of `bounds` from `azimuth` (from +z to +x) and `elevation`, degrees.
pub(super) fn camera_from(film: &Film, bounds: &Bounds, azimuth: f64, elevation: f64) -> Camera {
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
    let azimuth = azimuth_of(&scene.camera).to_radians();
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
pub(super) fn add_ground(scene: &mut Scene, bounds: &Bounds, color: Rgb) {
    /// Radii of the model: at a downward view of 5 degrees the ground is 15 away.
    const REACH: f64 = 60.0;
    let mut mesh = shape::disk(1.0, 96);
    mesh.name = "ground".to_owned();
    // In single precision, as a scene file would say it.
    let radius = f64::from((bounds.radius() * REACH) as f32);
    // A little below, so that a flat bottom does not lie in the same plane; far from the origin at least its rounding.
    let gap = (bounds.radius() * 1e-4).max(bounds.low().abs().max_element() * 1e-6);
    let centre = bounds.centre().with_y(bounds.low().y - gap).as_vec3().as_dvec3();
    let ground = Material { color, ..Material::grey("ground") };
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
