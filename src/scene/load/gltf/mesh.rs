//! Primitives as meshes.

use super::Failure;
use super::accessor::Accessors;
use crate::scene::load::polygon::unroll_strip;
use crate::scene::{Mesh, shape};
use glam::{Vec2, Vec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};
use std::collections::BTreeSet;

/// Reads a primitive. None: it makes no triangles (points, lines, or nothing at all).
/// `place` names it; `weights` are those of its morph targets; `set` says which uvs its textures want.
pub(super) fn read(
    accessors: &Accessors,
    primitive: &Primitive,
    place: &str,
    weights: &[f32],
    set: Option<u32>,
    notes: &mut BTreeSet<String>,
) -> Result<Option<Mesh>, Failure> {
    let Checked::Valid(mode) = primitive.mode else {
        return Err(Failure::new(place, "unknown mode; allowed are 0 to 6"));
    };
    if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        notes.insert("points and lines are not drawn".to_owned());
        return Ok(None);
    }
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression"] {
        if primitive.extensions.as_ref().is_some_and(|e| e.others.contains_key(name)) {
            return Err(Failure::new(place, format!("compressed by {name}, which is not supported")));
        }
    }
    let attribute = |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
    let user = |name: &str| format!("{place}.attributes.{name}");
    let Some(position) = attribute(Semantic::Positions) else {
        notes.insert("a primitive without POSITION is not drawn".to_owned());
        return Ok(None);
    };
    let positions = vectors(accessors, position, &user("POSITION"))?;
    let mut mesh = Mesh { positions, ..Mesh::default() };
    let count = mesh.positions.len();
    let same_count = |n: usize, name: &str| match n == count {
        true => Ok(()),
        false => Err(Failure::new(user(name), format!("{n} elements; POSITION has {count}"))),
    };
    if let Some(index) = attribute(Semantic::Normals) {
        mesh.normals = vectors(accessors, index, &user("NORMAL"))?;
        same_count(mesh.normals.len(), "NORMAL")?;
    }
    if let Some(index) = attribute(Semantic::Colors(0)) {
        let colors = accessors.floats::<4>(index, &user("COLOR_0"), Some(1.0))?;
        same_count(colors.len(), "COLOR_0")?;
        let channel = |c: f32| if c > 0.0 { c.min(1e6) } else { 0.0 };
        mesh.colors = colors.iter().map(|c| Vec3::new(channel(c[0]), channel(c[1]), channel(c[2]))).collect();
    }
    let wanted = set.is_some();
    let set = set.unwrap_or(0);
    if let Some(index) = attribute(Semantic::TexCoords(set)) {
        let name = format!("TEXCOORD_{set}");
        let uvs = accessors.floats::<2>(index, &user(&name), None)?;
        same_count(uvs.len(), &name)?;
        mesh.uvs = uvs.into_iter().map(place_uv).collect();
    } else if wanted {
        notes.insert(format!("{place} has a texture but no TEXCOORD_{set}"));
    }
    morph(accessors, primitive, place, weights, &mut mesh)?;
    if let Some(i) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(Failure::new(user("POSITION"), format!("element {i} is not finite")));
    }
    let corners = match primitive.indices {
        Some(index) => accessors.integers(index, &format!("{place}.indices"))?,
        None => (0..count as u32).collect(),
    };
    if let Some(i) = corners.iter().position(|c| *c as usize >= count) {
        let message = format!("index {} at {i}; there are {count} vertices", corners[i]);
        return Err(Failure::new(format!("{place}.indices"), message));
    }
    mesh.triangles = triangles(mode, &corners);
    if corners.len() % 3 != 0 && mode == Mode::Triangles {
        notes.insert(format!("{place} has {} indices; the last few make no triangle", corners.len()));
    }
    shape::repair_normals(&mut mesh);
    Ok((!mesh.triangles.is_empty()).then_some(mesh))
}

fn vectors(accessors: &Accessors, index: Index<Accessor>, user: &str) -> Result<Vec<Vec3>, Failure> {
    Ok(accessors.floats::<3>(index, user, None)?.into_iter().map(Vec3::from_array).collect())
}

/// glTF's v points down the image, ours up.
fn place_uv([u, v]: [f32; 2]) -> Vec2 {
    let uv = Vec2::new(u, (1.0 - f64::from(v)) as f32);
    if uv.is_finite() { uv } else { Vec2::ZERO }
}

/// Adds the morph targets, each times its weight.
fn morph(
    accessors: &Accessors,
    primitive: &Primitive,
    place: &str,
    weights: &[f32],
    mesh: &mut Mesh,
) -> Result<(), Failure> {
    let targets = primitive.targets.iter().flatten().zip(weights).enumerate();
    for (i, (target, &weight)) in targets.filter(|(_, (_, weight))| **weight != 0.0) {
        let add = |index: Option<Index<Accessor>>, name: &str, to: &mut Vec<Vec3>| -> Result<(), Failure> {
            let (Some(index), false) = (index, to.is_empty()) else {
                return Ok(());
            };
            let user = format!("{place}.targets[{i}].{name}");
            let offsets = vectors(accessors, index, &user)?;
            if offsets.len() != to.len() {
                return Err(Failure::new(user, format!("{} elements; {} are needed", offsets.len(), to.len())));
            }
            to.iter_mut().zip(&offsets).for_each(|(v, offset)| *v += *offset * weight);
            Ok(())
        };
        add(target.positions, "POSITION", &mut mesh.positions)?;
        add(target.normals, "NORMAL", &mut mesh.normals)?;
    }
    Ok(())
}

/// glTF 2.0, section 3.7.2.1: topology types.
fn triangles(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    let mut out = Vec::new();
    match mode {
        Mode::TriangleStrip => unroll_strip(corners, &mut out),
        Mode::TriangleFan => out.extend(corners.windows(2).skip(1).map(|w| [w[0], w[1], corners[0]])),
        _ => out.extend(corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]])),
    }
    out
}
