//! Files in a folder of their own, and what gonio makes of them.

#[path = "../common/scenes.rs"]
pub mod scenes;

use glam::{Vec2, Vec3};
use gonio::bake::bake;
use gonio::scene::load::load;
use gonio::scene::{Background, Camera, Filter, Integrator, Mesh, Projection, Rgb, Scene, SceneError};
use std::path::PathBuf;

pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new(files: &[(&str, &[u8])]) -> Self {
        let folder = Self(tempfile::tempdir().expect("a temporary folder"));
        for (name, bytes) in files {
            folder.file(name, bytes);
        }
        folder
    }

    pub fn file(&self, name: &str, bytes: &[u8]) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a new folder");
        std::fs::write(path, bytes).expect("writable");
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A picture of one row or more of grey or coloured texels, from the top.
    pub fn picture(&self, name: &str, width: u32, texels: &[[u8; 4]]) {
        let height = texels.len() as u32 / width;
        let picture = image::RgbaImage::from_raw(width, height, texels.as_flattened().to_vec()).expect("a picture");
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a new folder");
        picture.save(path).expect("writable");
    }

    #[track_caller]
    pub fn load(&self, name: &str) -> Scene {
        self.try_load(name).unwrap_or_else(|error| panic!("{error}"))
    }

    pub fn try_load(&self, name: &str) -> Result<Scene, SceneError> {
        load(&self.path(name), &[])
    }

    /// The message of the error that the file `name` must be, without the folder.
    #[track_caller]
    pub fn refused(&self, name: &str) -> String {
        let message = self.try_load(name).expect_err("a bad file").to_string();
        message.replace(&format!("{}/", self.0.path().display()), "")
    }
}

#[track_caller]
pub fn load_one(name: &str, bytes: impl AsRef<[u8]>) -> Scene {
    Folder::new(&[(name, bytes.as_ref())]).load(name)
}

/// Corners of all triangles, in order.
pub fn corners(mesh: &Mesh) -> Vec<Vec3> {
    mesh.triangles.iter().flatten().map(|corner| mesh.positions[*corner as usize]).collect()
}

/// The square from -1 to 1 seen along -z, in the middles of `SIDE` x `SIDE` pixels, row by row from the top.
pub const SIDE: usize = 32;

/// The picture of the first object alone, unlit by the stage's lamps, under a sky of radiance `sky` if it is path traced.
#[track_caller]
pub fn look(mut scene: Scene, integrator: Integrator, sky: f32, samples: u32) -> Vec<Vec3> {
    scene.objects.truncate(1);
    scene.lights.clear();
    (scene.film.width, scene.film.height, scene.film.filter) = (SIDE as u32, SIDE as u32, Filter::Box { radius: 0.5 });
    (scene.settings.integrator, scene.settings.samples) = (integrator, samples);
    scene.background = Background::Gradient { bottom: Rgb::splat(sky), top: Rgb::splat(sky) };
    scene.camera = Camera {
        eye: Vec3::new(0.0, 0.0, 9.0),
        target: Vec3::ZERO,
        up: Vec3::Y,
        projection: Projection::Orthographic { height: 2.0 },
        lens: None,
        shift: Vec2::ZERO,
        mirrored: false,
    };
    let data = bake(&scene).expect("bakes");
    let pixels = scenes::render_cpu(&scene, &data).resolve().pixels;
    pixels.iter().map(|pixel| Vec3::new(pixel[0], pixel[1], pixel[2])).collect()
}

/// The mean of a picture over columns and rows.
pub fn mean(picture: &[Vec3], columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> Vec3 {
    let count = (columns.len() * rows.len()) as f32;
    rows.flat_map(|row| columns.clone().map(move |column| picture[row * SIDE + column])).sum::<Vec3>() / count
}

#[track_caller]
pub fn near(found: Vec3, expected: Vec3, tolerance: f32) {
    assert!((found - expected).abs().max_element() <= tolerance, "{found}, expected {expected}");
}
