//! Wavefront OBJ: polygons with texture coordinates, normals, vertex colours and the materials of MTL files.
//!
//! Source: Alias|Wavefront, Advanced Visualizer manual, appendix B "Object files (.obj)", 1995. Free-form curves and
//! surfaces, points and lines are skipped with a warning; groups and objects become one mesh, for one BVH. Colours behind
//! the coordinates of a vertex are in no standard; what writes them writes sRGB.

mod map;
mod material;
mod mtl;
mod reader;
mod statement;

use super::staging::bare_scene;
use crate::scene::{Geometry, Mesh, MeshId, Object, Scene, SceneError, Transform};
use reader::Reader;
use statement::Statements;
use std::path::Path;

/// Loads the file as a scene of one mesh. `load::load` stages it.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let mut scene = bare_scene(path);
    let mut reader = Reader::new(path, &mut scene);
    let mut statements = Statements::open(path)?;
    while let Some(statement) = statements.next()? {
        reader.read(&statement)?;
    }
    let (mesh, material) = reader.finish(true)?;
    scene.objects.push(Object {
        name: mesh.name.clone(),
        geometry: Geometry::Mesh(MeshId(0)),
        transform: Transform::default(),
        material,
        casts_shadow: None,
        shading: None,
    });
    scene.meshes.push(mesh);
    Ok(scene)
}

/// Reads the mesh in the file `path` and no materials; without normals if it has none.
pub fn read_mesh(path: &Path) -> Result<Mesh, SceneError> {
    let mut scene = bare_scene(path);
    let mut reader = Reader::new(path, &mut scene);
    let mut statements = Statements::open(path)?;
    while let Some(statement) = statements.next()? {
        if !matches!(statement.keyword(), b"mtllib" | b"usemtl") {
            reader.read(&statement)?;
        }
    }
    reader.finish(false).map(|(mesh, _)| mesh)
}
