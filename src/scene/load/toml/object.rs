//! `[[object]]`: geometry, place, material and copies.

use super::format::OBJECT;
use super::names::Names;
use super::place::{check, read_copies, read_place};
use super::reader::{Reader, Result};
use super::settings::SHADINGS;
use super::shapes::{SHAPE_KINDS, ShapeKind, crease, tessellate, triangles};
use super::texture::{beside, refer};
use crate::scene::load::builtin::{Builtin, DEFAULT_LEVEL, TEAPOT_STEPS, teapot_count};
use crate::scene::load::load_file;
use crate::scene::shape::{self, compute_smooth_normals};
use crate::scene::{
    Geometry, Material, MaterialId, Mesh, MeshId, Model, OUT_OF_LIMITS, Object, Scene, SceneError, Shading, Transform,
};
use glam::DVec3;
use std::collections::HashMap;
use std::path::PathBuf;

/// Reads all objects of the document into `scene`, whose materials are those of the document.
pub fn read_objects(root: &Reader, materials: &Names, scene: &mut Scene) -> Result<()> {
    let tables = root.tables("object", &OBJECT)?;
    if tables.is_empty() {
        return Err(root.bad("object", "the scene has no [[object]]: there is nothing to draw"));
    }
    let mut objects = Objects {
        scene,
        is_lit: root.has("light"),
        materials,
        names: Names::new("object"),
        grey: None,
        files: HashMap::new(),
        units: HashMap::new(),
    };
    for (index, table) in tables.iter().enumerate() {
        table.attempt(|| objects.read(table, index));
    }
    Ok(())
}

/// A piece of geometry before its copies are made.
#[derive(Clone, Debug)]
struct Piece {
    /// Empty where the object is one piece.
    name: String,
    geometry: Geometry,
    transform: Transform,
    material: Option<MaterialId>,
}

/// One geometry in many places.
fn many(geometry: Geometry, places: Vec<Transform>) -> Vec<Piece> {
    places.into_iter().map(|transform| Piece { name: String::new(), geometry, transform, material: None }).collect()
}

/// The error for an object that single precision cannot carry, at what places it.
fn out_of_limits(table: &Reader, name: &str) -> SceneError {
    let key = ["transform", "matrix", "translate", "scale"].into_iter().find(|key| table.has(key));
    table.bad(key.unwrap_or("transform"), format!("object {name:?} {OUT_OF_LIMITS}"))
}

/// How normals of a file are treated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Normals {
    File,
    Flat,
    Smooth,
}

struct Objects<'s> {
    scene: &'s mut Scene,
    /// Whether the document has lights of its own.
    is_lit: bool,
    materials: &'s Names,
    names: Names,
    /// The house's default material, once something needs it.
    grey: Option<MaterialId>,
    /// Files are read once however many objects show them.
    files: HashMap<(PathBuf, Normals, u64), Vec<Piece>>,
    /// `Mesh::unit` of the meshes placed so far.
    units: HashMap<MeshId, f64>,
}

impl Objects<'_> {
    fn read(&mut self, table: &Reader, index: usize) -> Result<()> {
        let kind = table.required("shape", table.choice("shape", SHAPE_KINDS)?)?;
        let shape = table.text_of_choice("shape");
        table.warn_unused("shape", shape, &mut self.scene.warnings);
        let name = match table.text("name")? {
            Some(name) => self.names.declare(table, name)?,
            None => format!("{shape}.{index}"),
        };
        let material = self.read_material(table)?;
        let place = read_place(table)?;
        let casts_shadow = table.boolean("casts_shadow")?;
        let shading = table.choice("shading", &SHADINGS)?;
        let pieces = match (kind, tessellate(table, kind)?) {
            (ShapeKind::Mesh, _) => self.read_file(table)?,
            (ShapeKind::Sphereflake, _) => {
                let level = table.integer("level")?.unwrap_or(DEFAULT_LEVEL as u32);
                many(Geometry::Sphere, shape::sphereflake(level))
            }
            (ShapeKind::Teapots, _) => {
                let field = shape::teapot_field(teapot_count(triangles(table, Builtin::Teapots)?));
                many(self.add_mesh(shape::teapot(TEAPOT_STEPS)).geometry, field)
            }
            (_, Some(mesh)) => vec![self.add_mesh(mesh)],
            (_, None) if shading.unwrap_or(self.scene.settings.shading) != Shading::Phong => {
                let message = "a sphere without \"segments\" has no triangles to shade flat or by Gouraud's method";
                return Err(table.bad("shading", message));
            }
            (_, None) => {
                let radius = table.number("radius")?.unwrap_or(1.0);
                let transform = Transform(glam::DAffine3::from_scale(DVec3::splat(radius)));
                vec![Piece { name: String::new(), geometry: Geometry::Sphere, transform, material: None }]
            }
        };
        let copies = read_copies(table)?;
        for (number, copy) in copies.iter().enumerate() {
            let own = copy.table.map(|table| self.read_material(&table)).transpose()?.flatten();
            for piece in &pieces {
                let mut name = name.clone();
                if !piece.name.is_empty() {
                    name = format!("{name}/{}", piece.name);
                }
                if copies.len() > 1 {
                    name = format!("{name}[{number}]");
                }
                let transform = check(table, piece.transform.then(place).then(copy.transform))?;
                if !transform.is_within_limits(self.unit(piece.geometry)) {
                    return Err(out_of_limits(copy.table.as_ref().unwrap_or(table), &name));
                }
                let material = own.or(material).or(piece.material);
                let material = material.or_else(|| self.needs_material(piece.geometry).then(|| self.grey()));
                self.scene.objects.push(Object {
                    name,
                    geometry: piece.geometry,
                    transform,
                    material,
                    casts_shadow,
                    shading,
                });
            }
        }
        Ok(())
    }

    fn unit(&mut self, geometry: Geometry) -> f64 {
        match geometry {
            Geometry::Sphere => 1.0,
            Geometry::Mesh(id) => *self.units.entry(id).or_insert_with(|| self.scene.meshes[id.0 as usize].unit()),
        }
    }

    fn read_material(&self, table: &Reader) -> Result<Option<MaterialId>> {
        let Some(name) = table.text("material")? else { return Ok(None) };
        Ok(Some(MaterialId(self.materials.find(table, "material", name)? as u32)))
    }

    fn needs_material(&self, geometry: Geometry) -> bool {
        match geometry {
            Geometry::Sphere => true,
            Geometry::Mesh(id) => self.scene.meshes[id.0 as usize].face_materials.is_empty(),
        }
    }

    fn grey(&mut self) -> MaterialId {
        *self.grey.get_or_insert_with(|| {
            self.scene.materials.push(Material::grey("grey"));
            MaterialId(self.scene.materials.len() as u32 - 1)
        })
    }

    fn add_mesh(&mut self, mesh: Mesh) -> Piece {
        self.scene.meshes.push(mesh);
        let geometry = Geometry::Mesh(MeshId(self.scene.meshes.len() as u32 - 1));
        Piece { name: String::new(), geometry, transform: Transform::default(), material: None }
    }

    /// The pieces of the file that `table` names, read unless they are there already.
    fn read_file(&mut self, table: &Reader) -> Result<Vec<Piece>> {
        let file = beside(table.document, table.required("file", table.text("file")?)?);
        let kinds = [("file", Normals::File), ("flat", Normals::Flat), ("smooth", Normals::Smooth)];
        let normals = table.choice("normals", &kinds)?.unwrap_or(Normals::File);
        let crease = crease(table)?;
        let key = (file, normals, crease.to_bits());
        if let Some(pieces) = self.files.get(&key) {
            return Ok(pieces.clone());
        }
        if key.0.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
            return Err(table.bad("file", "\"file\" of a mesh must be OBJ, PLY, STL, glTF or GLB, found a TOML scene"));
        }
        let mut loaded = load_file(&key.0).map_err(|error| refer(table, "file", error))?;
        for mesh in &mut loaded.meshes {
            match normals {
                Normals::File => {}
                Normals::Flat => mesh.normals.clear(),
                Normals::Smooth => compute_smooth_normals(mesh, crease),
            }
        }
        // A scene that has lights has chosen.
        if !loaded.lights.is_empty() && !self.is_lit {
            let message = format!("{}: its {} lights are left out of this scene", loaded.name, loaded.lights.len());
            self.scene.warnings.push(message);
        }
        let pieces = self.merge(loaded);
        self.files.insert(key, pieces.clone());
        Ok(pieces)
    }

    /// Takes over what `other` shows; its camera, lights and settings are left behind. A material of the document stands for one
    /// of the same name in `other`.
    fn merge(&mut self, other: Scene) -> Vec<Piece> {
        let scene = &mut *self.scene;
        let (textures, materials, meshes, tables) = (
            scene.textures.len() as u32,
            scene.materials.len() as u32,
            scene.meshes.len() as u32,
            scene.tables.len() as u32,
        );
        let named = |(index, material): (usize, &Material)| {
            MaterialId(self.materials.get(&material.name).map_or(index as u32 + materials, |own| own as u32))
        };
        let places: Vec<MaterialId> = other.materials.iter().enumerate().map(named).collect();
        let place = |id: MaterialId| places[id.0 as usize];
        scene.textures.extend(other.textures);
        scene.tables.extend(other.tables);
        scene.materials.extend(other.materials.into_iter().map(|mut material| {
            for binding in &mut material.textures {
                binding.texture.0 += textures;
            }
            if let Model::Blend { a, b, .. } | Model::Sides { front: a, back: b } = &mut material.model {
                [a, b].into_iter().for_each(|id| *id = place(*id));
            }
            if let Model::Measured { table } = &mut material.model {
                table.0 += tables;
            }
            material
        }));
        scene.meshes.extend(other.meshes.into_iter().map(|mut mesh| {
            for id in &mut mesh.face_materials {
                *id = place(*id);
            }
            mesh
        }));
        scene.warnings.extend(other.warnings);
        let single = other.objects.len() == 1;
        let piece = |object: Object| Piece {
            name: if single { String::new() } else { object.name },
            geometry: match object.geometry {
                Geometry::Mesh(id) => Geometry::Mesh(MeshId(id.0 + meshes)),
                Geometry::Sphere => Geometry::Sphere,
            },
            transform: object.transform,
            material: object.material.map(place),
        };
        other.objects.into_iter().map(piece).collect()
    }
}
