//! The same work for any other ray tracer: triangles, rays and hits as raw arrays (README, "Benchmark").

use super::hierarchy::{diagonal, triangles_below};
use super::rays::RaySet;
use crate::bake::SceneData;
use crate::film::{FilmError, OutputFile};
use crate::layout::{INSTANCE_NO_SHADOW, INVALID, Instance, KIND_MESH, Ray};
use glam::{DVec3, Vec3};
use std::collections::HashMap;
use std::io::{self, Write};
use std::path::Path;

/// Changes whenever a file changes its layout.
pub const SCHEMA: u32 = 1;
/// Where a ray that leaves a surface may begin to count hits, over the scene's diagonal: for tracers that cannot name the
/// triangle they leave.
const LEAVE: f64 = 1e-6;

/// Writes a scene and its rays into `folder`, which is made when needed. `name`: what `scene.json` calls the scene.
pub fn export(folder: &Path, name: &str, data: &SceneData, sets: &[RaySet]) -> Result<(), FilmError> {
    std::fs::create_dir_all(folder).map_err(|error| FilmError::write(folder, error))?;
    let write = |file: &str, fill: &mut dyn FnMut(&mut OutputFile) -> io::Result<()>| {
        let mut out = OutputFile::open(&folder.join(file))?;
        fill(&mut out).map_err(|error| FilmError::write(&folder.join(file), error))?;
        out.commit()
    };
    let (mut triangles, mut spheres) = (0u64, 0u64);
    let meshes = meshes(data);
    write("triangles.f32", &mut |out| {
        each_triangle(data, &meshes, |_, instance, place| {
            triangles += 1;
            let triangle = &data.shapes.triangles[place as usize];
            let world = [triangle.v0, triangle.v1, triangle.v2].map(|corner| to_world(instance, corner));
            out.write_all(bytemuck::bytes_of(&world))
        })
    })?;
    write("triangles.u32", &mut |out| {
        each_triangle(data, &meshes, |id, instance, place| {
            let words = [id, data.shapes.triangles[place as usize].primitive, casts_shadow(instance)];
            out.write_all(bytemuck::bytes_of(&words))
        })
    })?;
    write("spheres.f32", &mut |out| {
        each_sphere(data, |_, instance| {
            spheres += 1;
            out.write_all(bytemuck::bytes_of(&instance.to_world))
        })
    })?;
    write("spheres.u32", &mut |out| {
        each_sphere(data, |id, instance| out.write_all(bytemuck::bytes_of(&[id, casts_shadow(instance)])))
    })?;
    let diagonal = diagonal(data);
    for set in sets {
        let kind = set.kind.name();
        write(&format!("{kind}.rays.f32"), &mut |out| {
            set.rays.iter().try_for_each(|ray| out.write_all(bytemuck::bytes_of(&ray_words(ray, diagonal))))
        })?;
        write(&format!("{kind}.skip.u32"), &mut |out| {
            let skip = |ray: &Ray| [ray.skip_instance, ray.skip_primitive];
            set.rays.iter().try_for_each(|ray| out.write_all(bytemuck::bytes_of(&skip(ray))))
        })?;
        write(&format!("{kind}.hits.u32"), &mut |out| {
            set.hits.iter().try_for_each(|hit| match set.kind.is_any() {
                true => out.write_all(bytemuck::bytes_of(&u32::from(hit.instance != INVALID))),
                false => out.write_all(bytemuck::bytes_of(&[hit.instance, hit.primitive])),
            })
        })?;
        if !set.kind.is_any() {
            write(&format!("{kind}.hits.f32"), &mut |out| {
                set.hits.iter().try_for_each(|hit| out.write_all(bytemuck::bytes_of(&[hit.t, hit.b1, hit.b2])))
            })?;
        }
    }
    // Last: a folder with this file in it is whole.
    let kind =
        |set: &RaySet| serde_json::json!({ "kind": set.kind.name(), "rays": set.rays.len(), "any": set.kind.is_any() });
    let document = serde_json::json!({
        "schema": SCHEMA,
        "gonio": env!("CARGO_PKG_VERSION"),
        "scene": name,
        "triangles": triangles,
        "spheres": spheres,
        "diagonal": diagonal,
        "sets": sets.iter().map(kind).collect::<Vec<_>>(),
    });
    write("scene.json", &mut |out| writeln!(out, "{document:#}"))
}

/// Places of each mesh's triangles, by its root.
fn meshes(data: &SceneData) -> HashMap<u32, Vec<u32>> {
    let mut meshes = HashMap::new();
    for instance in data.instances.iter().filter(|instance| instance.kind == KIND_MESH) {
        meshes.entry(instance.root).or_insert_with(|| triangles_below(data, instance.root));
    }
    meshes
}

/// Every triangle as often as it is placed: number and record of its instance, place in the triangle array.
fn each_triangle(
    data: &SceneData,
    meshes: &HashMap<u32, Vec<u32>>,
    mut visit: impl FnMut(u32, &Instance, u32) -> io::Result<()>,
) -> io::Result<()> {
    for (id, instance) in (0..).zip(&data.instances) {
        // A sphere has no root.
        for &place in meshes.get(&instance.root).into_iter().flatten() {
            visit(id, instance, place)?;
        }
    }
    Ok(())
}

fn each_sphere(data: &SceneData, mut visit: impl FnMut(u32, &Instance) -> io::Result<()>) -> io::Result<()> {
    let mut spheres = (0..).zip(&data.instances).filter(|(_, instance)| instance.kind != KIND_MESH);
    spheres.try_for_each(|(id, instance)| visit(id, instance))
}

fn casts_shadow(instance: &Instance) -> u32 {
    u32::from(instance.flags & INSTANCE_NO_SHADOW == 0)
}

/// A corner in world space, computed in double precision and rounded once.
fn to_world(instance: &Instance, corner: Vec3) -> Vec3 {
    let p = corner.as_dvec3();
    let row = |i: usize| {
        let m = instance.to_world[i].as_dvec4();
        m.x * p.x + m.y * p.y + m.z * p.z + m.w
    };
    DVec3::new(row(0), row(1), row(2)).as_vec3()
}

/// Origin, shortest t, direction, longest t.
fn ray_words(ray: &Ray, diagonal: f64) -> [f32; 8] {
    let least = if ray.skip_instance == INVALID { 0.0 } else { (diagonal * LEAVE) as f32 };
    let (o, d) = (ray.origin, ray.direction);
    [o.x, o.y, o.z, least, d.x, d.y, d.z, ray.t_max]
}
