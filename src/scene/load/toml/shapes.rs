//! The shapes that need no file, from the keys of an object.

use super::document::{Node, Value};
use super::format::NOISE;
use super::keys::Range;
use super::reader::{Reader, Result, in_range, numbers};
use super::texture::{beside, refer};
use crate::scene::load::builtin::{Builtin, DEFAULT_TRIANGLES};
use crate::scene::load::image::{ColorSpace, load_texture};
use crate::scene::shape::{self, HeightGrid, Profile, ProfileKind};
use crate::scene::{Mesh, SceneError};

/// What `shape` names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeKind {
    Sphere,
    Quad,
    Box,
    Disk,
    Cylinder,
    Cone,
    Torus,
    Lathe,
    Teapot,
    HeightField,
    Terrain,
    Hairball,
    Sphereflake,
    Teapots,
    Mesh,
}

pub const SHAPE_KINDS: &[(&str, ShapeKind)] = &[
    ("sphere", ShapeKind::Sphere),
    ("quad", ShapeKind::Quad),
    ("box", ShapeKind::Box),
    ("disk", ShapeKind::Disk),
    ("cylinder", ShapeKind::Cylinder),
    ("cone", ShapeKind::Cone),
    ("torus", ShapeKind::Torus),
    ("lathe", ShapeKind::Lathe),
    ("teapot", ShapeKind::Teapot),
    ("heightfield", ShapeKind::HeightField),
    ("terrain", ShapeKind::Terrain),
    ("hairball", ShapeKind::Hairball),
    ("sphereflake", ShapeKind::Sphereflake),
    ("teapots", ShapeKind::Teapots),
    ("mesh", ShapeKind::Mesh),
];

/// The triangles of the shape `kind`; None for what is no single mesh: a file, a sphere without `segments` (which is
/// analytic), and many spheres or teapots.
pub fn tessellate(table: &Reader, kind: ShapeKind) -> Result<Option<Mesh>> {
    let number = |key: &str, default: f64| -> Result<f64> { Ok(table.number(key)?.unwrap_or(default)) };
    let around = || segments(table, 64, shape::SEGMENTS_MIN, shape::SEGMENTS_MAX);
    let along = || segments(table, 1, 1, shape::SEGMENTS_MAX);
    let capped = || -> Result<bool> { Ok(table.boolean("capped")?.unwrap_or(true)) };
    let mesh = match kind {
        ShapeKind::Mesh | ShapeKind::Sphereflake | ShapeKind::Teapots => return Ok(None),
        ShapeKind::Sphere if !table.has("segments") => return Ok(None),
        ShapeKind::Sphere => shape::sphere_mesh(number("radius", 1.0)?, around()?),
        ShapeKind::Quad => shape::quad(size::<2>(table)?, along()?),
        ShapeKind::Box => shape::cuboid(size::<3>(table)?, along()?),
        ShapeKind::Disk => {
            let kinds = [("square", shape::disk as fn(f64, u32) -> Mesh), ("polar", shape::polar_disk)];
            let disk = table.choice("coordinates", &kinds)?.unwrap_or(shape::disk);
            disk(number("radius", 1.0)?, around()?)
        }
        ShapeKind::Cylinder => shape::cylinder(number("radius", 1.0)?, number("height", 1.0)?, capped()?, around()?),
        ShapeKind::Cone => shape::cone(number("radius", 1.0)?, number("height", 1.0)?, capped()?, around()?),
        ShapeKind::Torus => {
            let (major, minor) = (number("major_radius", 1.0)?, number("minor_radius", 0.25)?);
            if minor >= major {
                let message = format!("\"minor_radius\" = {minor} must be less than \"major_radius\" = {major}");
                return Err(table.bad("minor_radius", message));
            }
            shape::torus(major, minor, around()?, table.integer("rings")?.unwrap_or(32))
        }
        ShapeKind::Lathe => {
            let profile = read_profile(table)?;
            shape::lathe(&profile, around()?).map_err(|message| table.bad("profile", message))?
        }
        ShapeKind::Teapot => shape::teapot(segments(table, 8, 1, 128)?),
        ShapeKind::HeightField => read_height_field(table)?,
        ShapeKind::Terrain => shape::terrain(triangles(table, Builtin::Terrain)?),
        ShapeKind::Hairball => shape::hairball(triangles(table, Builtin::Hairball)?),
    };
    Ok(Some(mesh))
}

fn segments(table: &Reader, default: u32, min: u32, max: u32) -> Result<u32> {
    let segments = table.integer("segments")?.unwrap_or(default);
    if !(min..=max).contains(&segments) {
        let message = format!("\"segments\" of this shape must be an integer from {min} to {max}, found {segments}");
        return Err(table.bad("segments", message));
    }
    Ok(segments)
}

/// `triangles` of a shape that has any number of them.
pub fn triangles(table: &Reader, kind: Builtin) -> Result<u64> {
    let triangles = table.integer("triangles")?.map_or(DEFAULT_TRIANGLES, u64::from);
    let (least, most) = kind.sizes();
    if !(least..=most).contains(&triangles) {
        let message =
            format!("\"triangles\" of this shape must be an integer from {least} to {most}, found {triangles}");
        return Err(table.bad("triangles", message));
    }
    Ok(triangles)
}

fn size<const N: usize>(table: &Reader) -> Result<[f64; N]> {
    let Some(node) = table.node("size") else { return Ok([1.0; N]) };
    let size = in_range(node, Range::POSITIVE).map(|number| [number; N]);
    size.or_else(|| numbers(node, Range::POSITIVE)).ok_or_else(|| {
        let message = format!("\"size\" of this shape must be a number > 0 or {N} of them, found {}", node.found());
        table.bad("size", message)
    })
}

fn read_profile(table: &Reader) -> Result<Profile> {
    let nodes = table.required("profile", table.array("profile")?)?;
    let point = |node: &Node| -> Result<[f64; 2]> {
        let point = numbers::<2>(node, Range::ANY).filter(|[radius, _]| *radius >= 0.0);
        point.ok_or_else(|| {
            let found = match &node.value {
                Value::Array(items) => items.iter().map(Node::found).collect::<Vec<_>>().join(", "),
                _ => node.found(),
            };
            table.document.bad(node.place, format!("a profile point is [radius >= 0, height], found {found}"))
        })
    };
    let kinds = [("smooth", ProfileKind::Smooth), ("polyline", ProfileKind::Polyline)];
    Ok(Profile {
        points: nodes.iter().map(point).collect::<Result<_>>()?,
        kind: table.choice("curve", &kinds)?.unwrap_or_default(),
        steps: table.integer("steps")?.unwrap_or(8),
        crease: crease(table)?,
    })
}

/// `crease` in radians.
pub fn crease(table: &Reader) -> Result<f64> {
    Ok(table.number("crease")?.unwrap_or(45.0).to_radians())
}

fn read_height_field(table: &Reader) -> Result<Mesh> {
    table.exclusive("file", "noise")?;
    table.exclusive("file", "segments")?;
    let height = table.number("height")?.unwrap_or(1.0);
    let grid = match table.text("file")? {
        Some(file) => {
            let texture = load_texture(&beside(table.document, file), ColorSpace::Linear);
            HeightGrid::from_texture(&texture.map_err(|error| refer(table, "file", error))?)
        }
        None => {
            let noise = table.table("noise", &NOISE)?;
            let number = |key: &str, default: f64| -> Result<f64> {
                Ok(noise.map(|noise| noise.number(key)).transpose()?.flatten().unwrap_or(default))
            };
            let integer = |key: &str, default: u32| -> Result<u32> {
                Ok(noise.map(|noise| noise.integer(key)).transpose()?.flatten().unwrap_or(default))
            };
            let cells = segments(table, 128, 1, shape::SEGMENTS_MAX)?;
            let (octaves, seed) = (integer("octaves", 6)?, integer("seed", 0)?);
            shape::fractal_heights(cells + 1, number("features", 4.0)?, octaves, number("gain", 0.5)?, seed)
        }
    };
    let place = if table.has("file") { "file" } else { "shape" };
    shape::height_field(&grid, size::<2>(table)?, height).map_err(|message| -> SceneError { table.bad(place, message) })
}
