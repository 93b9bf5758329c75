//! Scenes of any size that need no file: `sphereflake:4`, `terrain:200k`, `hairball:1M`, `teapots:10M`.

use super::staging::bare_scene;
use crate::scene::{
    Attenuation, Background, Camera, Flaps, Geometry, IntensityUnit, Light, LightKind, Location, Material, MaterialId,
    Mesh, MeshId, Model, Object, Projection, Rgb, Scene, SceneError, Transform, shape,
};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;
use std::path::Path;

/// Triangles of `terrain`, `hairball` and `teapots` that do not say.
pub const DEFAULT_TRIANGLES: u64 = 200_000;
pub const DEFAULT_LEVEL: u64 = 4;
/// Cells along each side of a teapot's patches, and the triangles they make: 2 * 32 * 8^2, less 8 for each of the eight
/// patches that end in a pole.
pub const TEAPOT_STEPS: u32 = 8;
pub const TEAPOT_TRIANGLES: u64 = 4032;

/// What there is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Builtin {
    Sphereflake,
    Terrain,
    Hairball,
    Teapots,
}

impl Builtin {
    pub const ALL: [(&str, Self); 4] = [
        ("sphereflake", Self::Sphereflake),
        ("terrain", Self::Terrain),
        ("hairball", Self::Hairball),
        ("teapots", Self::Teapots),
    ];

    /// Smallest and largest size: levels of a sphereflake, triangles of the others.
    pub fn sizes(self) -> (u64, u64) {
        match self {
            Self::Sphereflake => (0, shape::SPHEREFLAKE_LEVELS.into()),
            Self::Terrain => (2, shape::TRIANGLES_MAX),
            Self::Hairball => (1, shape::TRIANGLES_MAX),
            Self::Teapots => (1, shape::TEAPOTS_MAX * TEAPOT_TRIANGLES),
        }
    }
}

/// How many teapots have about `triangles` triangles.
pub fn teapot_count(triangles: u64) -> u64 {
    ((triangles + TEAPOT_TRIANGLES / 2) / TEAPOT_TRIANGLES).clamp(1, shape::TEAPOTS_MAX)
}

/// The scene that `path` names, if it is the name of a built-in one: `NAME` or `NAME:SIZE`.
pub fn load(path: &Path) -> Option<Result<Scene, SceneError>> {
    let text = path.to_str()?;
    let (name, size) = text.split_once(':').map_or((text, None), |(name, size)| (name, Some(size)));
    let (_, kind) = Builtin::ALL.into_iter().find(|(known, _)| *known == name)?;
    Some(
        read_size(kind, name, size)
            .map(|size| build(path, kind, size))
            .map_err(|message| SceneError::bad(Location::file(path), message)),
    )
}

/// `200000`, `200k`, `4M`; none is the default.
fn read_size(kind: Builtin, name: &str, size: Option<&str>) -> Result<u64, String> {
    let (least, most) = kind.sizes();
    let Some(text) = size else {
        return Ok(if kind == Builtin::Sphereflake { DEFAULT_LEVEL } else { DEFAULT_TRIANGLES });
    };
    let (digits, factor) = match text.as_bytes().last() {
        Some(b'k') => (&text[..text.len() - 1], 1000),
        Some(b'M') => (&text[..text.len() - 1], 1_000_000),
        _ => (text, 1),
    };
    let number = digits.parse::<u64>().ok().and_then(|number| number.checked_mul(factor));
    match (number, kind) {
        (Some(number), _) if (least..=most).contains(&number) => Ok(number),
        (_, Builtin::Sphereflake) => Err(format!("{name}:LEVEL has a level from {least} to {most}, found {text:?}")),
        _ => Err(format!("{name}:TRIANGLES has a number from {least} to {most}, as in {name}:200k, found {text:?}")),
    }
}

fn build(path: &Path, kind: Builtin, size: u64) -> Scene {
    let mut scene = bare_scene(path);
    scene.ambient = Rgb::splat(0.1);
    scene.background = Background::Gradient { bottom: Rgb::new(0.55, 0.55, 0.55), top: Rgb::new(0.45, 0.6, 0.9) };
    match kind {
        Builtin::Sphereflake => sphereflake(&mut scene, size as u32),
        Builtin::Terrain => terrain(&mut scene, size),
        Builtin::Hairball => hairball(&mut scene, size),
        Builtin::Teapots => teapots(&mut scene, size),
    }
    scene
}

/// Haines's lights, twice as far away as his sphere is small.
fn sphereflake(scene: &mut Scene, level: u32) {
    look(scene, [3.6, 2.9, 2.2], [0.0, 0.15, 0.0], 45.0);
    let gold = Material {
        model: Model::BlinnPhong { exponent: 60.0 },
        color: Rgb::new(0.9, 0.5, 0.12),
        specular_color: Rgb::new(1.0, 0.76, 0.4),
        k_d: 0.5,
        k_s: 0.3,
        k_r: 0.4,
        ..Material::grey("gold")
    };
    let gold = add_material(scene, gold);
    for transform in shape::sphereflake(level) {
        add_object(scene, Geometry::Sphere, transform, gold);
    }
    add_ground(scene, -1.0, 24.0, Rgb::new(0.36, 0.3, 0.25));
    for position in [[8.0, 4.0, 6.0], [2.0, 8.0, -8.0], [-6.0, 10.0, 2.0]] {
        add_light(scene, LightKind::Point { position: Vec3::from(position) }, 0.33);
    }
}

fn terrain(scene: &mut Scene, triangles: u64) {
    look(scene, [0.2, 0.32, 1.1], [0.0, 0.02, 0.1], 42.0);
    let mesh = add_mesh(scene, shape::terrain(triangles));
    let ground = add_material(scene, Material { color: Rgb::ONE, ..Material::grey("ground") });
    add_object(scene, mesh, Transform::default(), ground);
    add_sun(scene, [0.8, -0.75, -0.25], 1.0);
}

fn hairball(scene: &mut Scene, triangles: u64) {
    look(scene, [0.9, 0.75, 3.0], [0.0, -0.12, 0.0], 42.0);
    let mesh = add_mesh(scene, shape::hairball(triangles));
    let hair = Material {
        model: Model::Phong { exponent: 24.0, lafortune: None },
        color: Rgb::new(0.62, 0.3, 0.11),
        k_d: 0.75,
        k_s: 0.25,
        ..Material::grey("hair")
    };
    let hair = add_material(scene, hair);
    add_object(scene, mesh, Transform::default(), hair);
    add_ground(scene, -1.4, 16.0, Rgb::new(0.5, 0.52, 0.55));
    add_sun(scene, [0.6, -0.8, -0.55], 1.0);
}

/// Porcelain, plastics and metals, in no order.
fn teapots(scene: &mut Scene, triangles: u64) {
    let count = teapot_count(triangles);
    let size = shape::field_size(count) as f32;
    look(scene, [0.2 * size, 0.25 * size + 3.0, 0.68 * size + 5.0], [0.0, 0.0, 0.1 * size], 38.0);
    let mesh = add_mesh(scene, shape::teapot(TEAPOT_STEPS));
    let glossy = |name: &str, color: [f32; 3], k_r: f32| Material {
        model: Model::BlinnPhong { exponent: 120.0 },
        color: Rgb::from(color),
        k_d: 0.8,
        k_s: 0.25,
        k_r,
        ..Material::grey(name)
    };
    let metal = |name: &str, color: [f32; 3]| Material {
        specular_color: Rgb::from(color),
        k_d: 0.25,
        ..glossy(name, color, 0.65)
    };
    let palette = [
        glossy("porcelain", [0.85, 0.84, 0.8], 0.06),
        metal("copper", [0.95, 0.55, 0.38]),
        glossy("blue", [0.05, 0.14, 0.45], 0.06),
        glossy("celadon", [0.35, 0.55, 0.42], 0.06),
        metal("silver", [0.9, 0.9, 0.92]),
        glossy("red", [0.5, 0.03, 0.03], 0.06),
        glossy("black", [0.02, 0.02, 0.025], 0.1),
        metal("brass", [0.85, 0.68, 0.3]),
    ];
    let palette = palette.map(|material| add_material(scene, material));
    for (number, transform) in shape::teapot_field(count).into_iter().enumerate() {
        // Steps of a golden section through the palette: neighbours differ, rows do not repeat.
        let choice = (number as f64 * 0.618_033_988_749_894_9).fract() * palette.len() as f64;
        add_object(scene, mesh, transform, palette[choice as usize]);
    }
    add_ground(scene, 0.0, 3.0 * size + 40.0, Rgb::new(0.42, 0.4, 0.38));
    add_sun(scene, [0.55, -0.75, -0.4], 0.85);
}

fn look(scene: &mut Scene, eye: [f32; 3], target: [f32; 3], fov_y_degrees: f32) {
    let projection = Projection::Perspective { fov_y: fov_y_degrees.to_radians() };
    scene.has_camera = true;
    scene.camera = Camera {
        eye: Vec3::from(eye),
        target: Vec3::from(target),
        up: Vec3::Y,
        projection,
        lens: None,
        shift: Vec2::ZERO,
        mirrored: false,
    };
}

fn add_material(scene: &mut Scene, material: Material) -> MaterialId {
    scene.materials.push(material);
    MaterialId(scene.materials.len() as u32 - 1)
}

fn add_mesh(scene: &mut Scene, mesh: Mesh) -> Geometry {
    scene.meshes.push(mesh);
    Geometry::Mesh(MeshId(scene.meshes.len() as u32 - 1))
}

fn add_object(scene: &mut Scene, geometry: Geometry, transform: Transform, material: MaterialId) {
    // A name each would take more memory than the rest of a million objects.
    scene.objects.push(Object {
        name: String::new(),
        geometry,
        transform,
        material: Some(material),
        casts_shadow: None,
        shading: None,
    });
}

/// A square of side `size` at height `y`.
fn add_ground(scene: &mut Scene, y: f32, size: f32, color: Rgb) {
    let mesh = add_mesh(scene, shape::quad([size.into(); 2], 1));
    let material = add_material(scene, Material { color, ..Material::grey("ground") });
    add_object(scene, mesh, Transform::translate(Vec3::Y * y), material);
}

/// A light that shows a white surface which faces it as `shown`, at any distance.
fn add_light(scene: &mut Scene, kind: LightKind, shown: f32) {
    scene.lights.push(Light {
        name: format!("light.{}", scene.lights.len()),
        kind,
        intensity: Rgb::splat(shown * PI),
        unit: IntensityUnit::Radiometric,
        attenuation: Attenuation::None,
        flaps: Flaps::NONE,
        casts_shadow: true,
        slide: None,
    });
}

fn add_sun(scene: &mut Scene, direction: [f32; 3], shown: f32) {
    let d = Vec3::from(direction).as_dvec3();
    let direction = (d / libm::sqrt(d.x * d.x + d.y * d.y + d.z * d.z)).as_vec3();
    add_light(scene, LightKind::Directional { direction }, shown);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(name: &str) -> Scene {
        load(Path::new(name)).expect("a built-in name").expect("a size that is allowed")
    }

    fn refusal(name: &str) -> String {
        load(Path::new(name)).expect("a built-in name").expect_err("no size").to_string()
    }

    #[test]
    fn a_built_in_scene_has_about_the_size_its_name_says() {
        let triangles = |scene: &Scene| -> usize { scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum() };
        assert_eq!(scene("sphereflake:2").objects.len(), 91 + 1);
        assert_eq!(triangles(&scene("terrain:20k")), 20_000);
        assert_eq!(triangles(&scene("hairball:9600")), 9600 + 2);
        let field = scene("teapots:100k");
        assert_eq!(field.objects.len(), 25 + 1);
        assert_eq!(triangles(&field), TEAPOT_TRIANGLES as usize + 2);
    }

    #[test]
    fn other_names_are_no_built_in_scenes() {
        for name in ["terrain.toml", "teapot", "teapots2:4", "./terrain", "terrain/5", ""] {
            assert!(load(Path::new(name)).is_none(), "{name}");
        }
    }

    #[test]
    fn a_size_out_of_range_or_not_a_number_is_refused_with_what_is_allowed() {
        assert_eq!(refusal("sphereflake:8"), "sphereflake:8: sphereflake:LEVEL has a level from 0 to 7, found \"8\"");
        let allowed = "terrain:TRIANGLES has a number from 2 to 33554432, as in terrain:200k, found";
        for size in ["1", "", "k", "-5", "34M", "many", "1e5", "99999999999999999999M"] {
            assert_eq!(refusal(&format!("terrain:{size}")), format!("terrain:{size}: {allowed} {size:?}"));
        }
    }
}
