//! `<shape>`: meshes from files and named shapes, with their materials and emitters.

use super::document::{Node, Result};
use super::object::Object;
use super::{Loader, MeshKey, serialized};
use crate::scene::load::{obj, ply};
use crate::scene::shape::repair_normals;
use crate::scene::{Geometry, MaterialId, Mesh, MeshId, Transform};
use glam::{DAffine3, DVec3, Vec2, Vec3};
use std::f64::consts::TAU;

/// Around a disk or cylinder, which are tessellated.
const SEGMENTS: u32 = 256;
/// Objects that instances of groups may make.
const OBJECTS_MAX: usize = 1 << 22;

impl Loader<'_> {
    /// Adds a shape to the scene, or what an instance shows.
    pub fn add_shape(&mut self, node: Node) -> Result<()> {
        let object = Object::open(self.document, node)?;
        match object.plugin.name {
            // Shown through its instances.
            "shapegroup" => Ok(()),
            "instance" => {
                let Some(child) = object.only("shape")? else {
                    return Err(self.document.bad(node, "an instance refers to a shapegroup"));
                };
                let group = Object::open(self.document, child.node)?;
                if group.plugin.name != "shapegroup" {
                    return Err(self
                        .document
                        .bad(child.written, format!("an instance shows a shapegroup, found {:?}", group.plugin.name)));
                }
                let place = object.transform("to_world")?;
                for shape in group.nested("shape") {
                    let shape = Object::open(self.document, shape.node)?;
                    if matches!(shape.plugin.name, "shapegroup" | "instance") {
                        return Err(self.document.bad(shape.node, "a shapegroup holds no groups and no instances"));
                    }
                    if let Some(emitter) = shape.only("emitter")? {
                        return Err(self.document.bad(emitter.written, "shapes of a shapegroup emit no light"));
                    }
                    self.add_object(&shape, place)?;
                }
                Ok(())
            }
            _ => self.add_object(&object, Transform::default()),
        }
    }

    fn add_object(&mut self, shape: &Object, place: Transform) -> Result<()> {
        if self.scene.objects.len() >= OBJECTS_MAX {
            return Err(self.document.bad(shape.node, format!("more than {OBJECTS_MAX} objects")));
        }
        let material = self.shape_material(shape)?;
        let (geometry, own) = self.geometry(shape)?;
        let transform = own.then(shape.transform("to_world")?).then(place);
        let name = self.document.attribute(shape.node, "id").unwrap_or(shape.plugin.name).to_owned();
        self.scene.objects.push(crate::scene::Object {
            name,
            geometry,
            transform,
            material: Some(material),
            casts_shadow: None,
            shading: None,
        });
        Ok(())
    }

    /// The material of a shape: its BSDF, or diffuse of 0.5 (0 for emitters), with the radiance of its emitter.
    fn shape_material(&mut self, shape: &Object) -> Result<MaterialId> {
        let emitter = shape.only("emitter")?;
        let bsdf = shape.only("bsdf")?;
        let Some(emitter) = emitter else {
            return match bsdf {
                Some(bsdf) => self.material(bsdf.node),
                None => Ok(self.default_material(0.5)),
            };
        };
        let base = match bsdf {
            Some(bsdf) => self.material(bsdf.node)?,
            None => self.default_material(0.0),
        };
        let mut material = self.scene.materials[base.0 as usize].clone();
        self.glow(emitter, &mut material)?;
        Ok(self.add_material(material))
    }

    /// The geometry of a shape and where it lies in the shape's own space.
    fn geometry(&mut self, shape: &Object) -> Result<(Geometry, Transform)> {
        let flip = shape.boolean("flip_normals")?.unwrap_or(false);
        let mut own = DAffine3::IDENTITY;
        let mut mesh = match shape.plugin.name {
            "sphere" => {
                let radius = shape.float_in("radius", 1e-12, 1e12)?.unwrap_or(1.0);
                own = DAffine3::from_translation(shape.vector("center")?.unwrap_or(DVec3::ZERO));
                own.matrix3 *= radius;
                if !flip {
                    return Ok((Geometry::Sphere, Transform(own)));
                }
                // The analytic sphere faces outwards.
                shape_mesh(crate::scene::shape::sphere_mesh(1.0, SEGMENTS))
            }
            "rectangle" => rectangle(),
            "cube" => cube(),
            "disk" => disk(),
            "cylinder" => {
                own = cylinder_place(shape)?;
                cylinder()
            }
            _ => return Ok((Geometry::Mesh(self.file_mesh(shape, flip)?), Transform(own))),
        };
        if flip {
            flip_normals(&mut mesh);
        }
        // Equal shapes are one mesh: a thousand rectangles share one hierarchy.
        let key = MeshKey { file: shape.plugin.name.to_owned(), flip, ..MeshKey::default() };
        let id = match self.meshes.get(&key) {
            Some(id) => *id,
            None => self.add_mesh(key, mesh),
        };
        Ok((Geometry::Mesh(id), Transform(own)))
    }

    /// The mesh of a shape that names a file; one that is used again is read once.
    fn file_mesh(&mut self, shape: &Object, flip: bool) -> Result<MeshId> {
        let Some(node) = shape.property("filename") else { return shape.required("filename", None) };
        let path = self.document.find_file(node, "value")?;
        let kind = shape.plugin.name;
        let flat = shape.boolean("face_normals")?.unwrap_or(false);
        let turned = shape.boolean("flip_tex_coords")?.unwrap_or(kind == "obj");
        let index =
            if kind == "serialized" { shape.integer("shape_index", 0, 1 << 20)?.unwrap_or(0) as u32 } else { 0 };
        let colored = match shape.only("bsdf")? {
            Some(bsdf) => self.shows_vertex_colors(bsdf.node, 0)?,
            None => false,
        };
        let mirrored = shape.transform("to_world")?.0.matrix3.determinant() < 0.0;
        let key = MeshKey { file: path.display().to_string(), index, flat, flip, turned, colored, mirrored };
        if let Some(id) = self.meshes.get(&key) {
            return Ok(*id);
        }
        let mut mesh = match kind {
            "obj" => obj::read_mesh(&path)?,
            "ply" => ply::read_mesh(&path)?,
            _ => serialized::read_mesh(&path, index)?,
        };
        // v = 0 is the top row in Mitsuba and the bottom row here.
        if !turned {
            mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
        }
        if !colored {
            mesh.colors.clear();
        }
        // Without vertex normals of its own, Mitsuba takes a face's sides from its corners where they come to lie.
        if mirrored && (flat || mesh.normals.is_empty()) {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        if flat {
            mesh.normals.clear();
        } else if mesh.normals.is_empty() {
            compute_vertex_normals(&mut mesh);
        } else {
            repair_normals(&mut mesh);
            agree_with_normals(&mut mesh);
        }
        if flip {
            flip_normals(&mut mesh);
        }
        if mesh.name.is_empty() {
            mesh.name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        }
        Ok(self.add_mesh(key, mesh))
    }

    /// Whether a material has a `mesh_attribute`: else the colours of a mesh have no meaning.
    fn shows_vertex_colors(&self, node: Node, nesting: u32) -> Result<bool> {
        if self.document.tag(node) == "texture" {
            return Ok(self.document.attribute(node, "type") == Some("mesh_attribute"));
        }
        let inner = |child: &Node| {
            let child = self.document.resolve(*child)?;
            let deeper = matches!(self.document.tag(child), "bsdf" | "texture") && nesting < super::bsdf::NESTING_MAX;
            Ok(deeper && self.shows_vertex_colors(child, nesting + 1)?)
        };
        self.document.children(node).iter().try_fold(false, |found, child| Ok(found || inner(child)?))
    }

    fn add_mesh(&mut self, key: MeshKey, mesh: Mesh) -> MeshId {
        let id = MeshId(self.scene.meshes.len() as u32);
        self.scene.meshes.push(mesh);
        self.meshes.insert(key, id);
        id
    }
}

/// Area-free normal of a triangle, of twice its area.
fn area_vector(mesh: &Mesh, triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].as_dvec3());
    (b - a).cross(c - a)
}

/// Smooth normals everywhere, each face weighted by its angle at the vertex, as Mitsuba gives meshes without normals.
/// Source: Thürmer and Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets".
fn compute_vertex_normals(mesh: &mut Mesh) {
    let mut normals = vec![DVec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.triangles {
        let normal = area_vector(mesh, *triangle);
        let area = normal.length();
        if !(area > 0.0) {
            continue;
        }
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|i| mesh.positions[triangle[(k + i) % 3] as usize].as_dvec3());
            // The angle at a, whose sine and cosine are over the same product of lengths.
            let angle = libm::atan2(area, (b - a).dot(c - a));
            normals[triangle[k] as usize] += normal * (angle / area);
        }
    }
    mesh.normals = normals.iter().map(|n| n.as_vec3()).collect();
    repair_normals(mesh);
}

/// Turns triangles that the vertex normals contradict: Mitsuba takes a face's sides from them.
fn agree_with_normals(mesh: &mut Mesh) {
    for index in 0..mesh.triangles.len() {
        let triangle = mesh.triangles[index];
        let mean: DVec3 = triangle.iter().map(|i| mesh.normals[*i as usize].as_dvec3()).sum();
        if area_vector(mesh, triangle).dot(mean) < 0.0 {
            mesh.triangles[index].swap(1, 2);
        }
    }
}

fn flip_normals(mesh: &mut Mesh) {
    mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    mesh.normals.iter_mut().for_each(|normal| *normal = -*normal);
}

/// Adds a quad with corners counter-clockwise; uvs as Mitsuba has them are (0, 0), (1, 0), (1, 1), (0, 1).
fn add_quad(mesh: &mut Mesh, corners: [[f32; 3]; 4]) {
    let base = mesh.positions.len() as u32;
    let [a, b, c, d] = corners.map(Vec3::from_array);
    let normal = (b - a).cross(d - a).normalize();
    mesh.positions.extend([a, b, c, d]);
    mesh.normals.extend([normal; 4]);
    mesh.uvs.extend([Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(1.0, 0.0), Vec2::new(0.0, 0.0)]);
    mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
}

/// -1 to 1 in x and y, facing +z.
fn rectangle() -> Mesh {
    let mut mesh = Mesh { name: "rectangle".to_owned(), ..Mesh::default() };
    add_quad(&mut mesh, [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]);
    mesh
}

/// -1 to 1 along each axis, every face with the whole uv square. The corner of uv (0, 0) and the way of u are those of
/// Mitsuba's own table.
fn cube() -> Mesh {
    let mut mesh = Mesh { name: "cube".to_owned(), ..Mesh::default() };
    let faces = [
        [[1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, -1.0, -1.0]],
        [[1.0, 1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
        [[1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]],
        [[1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]],
        [[-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]],
        [[1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, -1.0], [-1.0, 1.0, -1.0]],
    ];
    for face in faces {
        add_quad(&mut mesh, face);
    }
    mesh
}

/// Directions around the z axis from +x towards +y.
fn around(i: u32) -> DVec3 {
    let angle = TAU * f64::from(i) / f64::from(SEGMENTS);
    DVec3::new(libm::cos(angle), libm::sin(angle), 0.0)
}

/// Radius 1 around the z axis, facing +z; u is the radius, v the angle over a turn.
fn disk() -> Mesh {
    let mut mesh = Mesh { name: "disk".to_owned(), ..Mesh::default() };
    for i in 0..=SEGMENTS {
        let turn = f64::from(i) / f64::from(SEGMENTS);
        mesh.positions.extend([around(i).as_vec3(), Vec3::ZERO]);
        mesh.uvs.extend([Vec2::new(1.0, 1.0 - turn as f32), Vec2::new(0.0, 1.0 - turn as f32)]);
    }
    mesh.normals = vec![Vec3::Z; mesh.positions.len()];
    mesh.triangles = (0..SEGMENTS).map(|i| [2 * i, 2 * i + 2, 2 * i + 1]).collect();
    mesh
}

/// Radius 1 around the z axis from z = 0 to 1, without caps, facing outwards; u is the angle over a turn, v is z.
fn cylinder() -> Mesh {
    let mut mesh = Mesh { name: "cylinder".to_owned(), ..Mesh::default() };
    for i in 0..=SEGMENTS {
        let (normal, turn) = (around(i), i as f32 / SEGMENTS as f32);
        mesh.positions.extend([normal.as_vec3(), (normal + DVec3::Z).as_vec3()]);
        mesh.normals.extend([normal.as_vec3(); 2]);
        mesh.uvs.extend([Vec2::new(turn, 1.0), Vec2::new(turn, 0.0)]);
    }
    mesh.triangles =
        (0..SEGMENTS).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]).collect();
    mesh
}

fn cylinder_place(shape: &Object) -> Result<DAffine3> {
    let (p0, p1) = (shape.vector("p0")?.unwrap_or(DVec3::ZERO), shape.vector("p1")?.unwrap_or(DVec3::Z));
    let radius = shape.float_in("radius", 1e-12, 1e12)?.unwrap_or(1.0);
    let axis = p1 - p0;
    let length = libm::sqrt(axis.dot(axis));
    if !(length > 1e-12) {
        return Err(shape.bad("p1", "\"p0\" and \"p1\" are the same point"));
    }
    let forward = axis / length;
    let side = if forward.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
    let x = side - forward * side.dot(forward);
    let x = x / libm::sqrt(x.dot(x));
    let matrix3 = glam::DMat3::from_cols(x * radius, forward.cross(x) * radius, axis);
    Ok(DAffine3 { matrix3, translation: p0 })
}

/// A mesh of ours, which stands around y, turned to stand around z.
fn shape_mesh(mut mesh: Mesh) -> Mesh {
    let turn = |v: &mut Vec3| *v = Vec3::new(v.z, v.x, v.y);
    mesh.positions.iter_mut().for_each(turn);
    mesh.normals.iter_mut().for_each(turn);
    mesh
}
