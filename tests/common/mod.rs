//! Scenes and rays for the tests of trace and bake.
#![allow(dead_code, reason = "each test file uses its own part")]

use glam::{Vec2, Vec3};
use gonio::layout::{INVALID, Ray, T_INFINITE};
use gonio::scene::*;

/// A small generator (SplitMix64): tests are the same everywhere.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 0 to 1.
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / 16_777_216.0
    }

    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// In the cube of half width `r`.
    pub fn point(&mut self, r: f32) -> Vec3 {
        Vec3::new(self.range(-r, r), self.range(-r, r), self.range(-r, r))
    }

    pub fn direction(&mut self) -> Vec3 {
        loop {
            let p = self.point(1.0);
            if p.length_squared() > 0.01 && p.length_squared() < 1.0 {
                return p.normalize();
            }
        }
    }

    /// From the cube of half width `r` towards a point of the unit cube's vicinity.
    pub fn ray(&mut self, r: f32) -> Ray {
        let origin = self.point(r);
        ray(origin, (self.point(1.0) - origin).normalize())
    }
}

pub fn ray(origin: Vec3, direction: Vec3) -> Ray {
    Ray { origin, direction, t_max: T_INFINITE, skip_instance: INVALID, skip_primitive: INVALID, ..Ray::default() }
}

/// Loose triangles with corners within `size` of centres in the unit cube.
pub fn soup(random: &mut Random, count: u32, size: f32) -> Mesh {
    let mut mesh = Mesh { name: "soup".into(), ..Mesh::default() };
    for i in 0..count {
        let centre = random.point(1.0);
        for _ in 0..3 {
            mesh.positions.push(centre + random.point(size));
        }
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    mesh
}

/// A closed sphere of radius 1: `rows` by `2 rows` quads, poles of triangles.
pub fn globe(rows: u32) -> Mesh {
    let columns = 2 * rows;
    let mut mesh = Mesh { name: "globe".into(), ..Mesh::default() };
    mesh.positions.push(Vec3::new(0.0, -1.0, 0.0));
    for row in 1..rows {
        let latitude = (row as f32 / rows as f32 - 0.5) * std::f32::consts::PI;
        for column in 0..columns {
            let longitude = column as f32 / columns as f32 * std::f32::consts::TAU;
            let r = latitude.cos();
            mesh.positions.push(Vec3::new(r * longitude.sin(), latitude.sin(), r * longitude.cos()));
        }
    }
    mesh.positions.push(Vec3::new(0.0, 1.0, 0.0));
    let last = mesh.positions.len() as u32 - 1;
    let at = |row: u32, column: u32| 1 + (row - 1) * columns + column % columns;
    for column in 0..columns {
        mesh.triangles.push([0, at(1, column + 1), at(1, column)]);
        for row in 1..rows - 1 {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column + 1), at(row + 1, column)];
            mesh.triangles.push([a, b, c]);
            mesh.triangles.push([a, c, d]);
        }
        mesh.triangles.push([last, at(rows - 1, column), at(rows - 1, column + 1)]);
    }
    mesh.normals = mesh.positions.clone();
    mesh
}

pub fn object(geometry: Geometry, transform: Transform) -> Object {
    Object {
        name: "object".into(),
        geometry,
        transform,
        material: Some(MaterialId(0)),
        casts_shadow: None,
        shading: None,
    }
}

/// Each mesh once, where it is.
pub fn scene_of(meshes: Vec<Mesh>) -> Scene {
    let mut scene = empty_scene();
    for (i, mesh) in meshes.into_iter().enumerate() {
        scene.meshes.push(mesh);
        scene.objects.push(object(Geometry::Mesh(MeshId(i as u32)), Transform::default()));
    }
    scene
}

pub fn empty_scene() -> Scene {
    Scene {
        name: "test".into(),
        film: Film {
            width: 64,
            height: 32,
            crop: None,
            filter: Filter::Box { radius: 0.5 },
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
            max_depth: 4,
            min_weight: 0.001,
            rr_depth: 5,
            clamp: None,
            hide_emitters: false,
            transparent: false,
            aovs: false,
            shadows: Shadows::Opaque,
            shading: Shading::Phong,
        },
        has_camera: true,
        cameras: Vec::new(),
        camera: Camera {
            eye: Vec3::new(0.0, 0.0, 5.0),
            target: Vec3::ZERO,
            up: Vec3::Y,
            projection: Projection::Perspective { fov_y: 1.0 },
            lens: None,
            shift: Vec2::ZERO,
            mirrored: false,
        },
        background: Background::BLACK,
        ambient: Vec3::ZERO,
        materials: vec![Material::grey("grey")],
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

/// Clusters of four small triangles that shrink geometrically towards the origin, along x: a tree that follows their
/// sizes is as deep as they are many.
pub fn cascade(clusters: u32, factor: f32) -> Mesh {
    let mut mesh = Mesh { name: "cascade".into(), ..Mesh::default() };
    let mut radius = 1.0f32;
    for _ in 0..clusters {
        for i in 0..4u8 {
            let corner = Vec3::X * radius + Vec3::new(f32::from(i % 3), f32::from(i / 3), 0.0) * (0.02 * radius);
            let first = mesh.positions.len() as u32;
            let size = 0.004 * radius;
            mesh.positions
                .extend([Vec3::ZERO, Vec3::new(size, 0.0, size), Vec3::new(0.0, size, size)].map(|p| corner + p));
            mesh.triangles.push([first, first + 1, first + 2]);
        }
        radius *= factor;
    }
    mesh
}
