//! `<shape>`: meshes from files and named shapes, with their materials and emitters.

use super::attribute::Shown;
use super::document::{Node, Result};
use super::object::Object;
use super::{Loader, MeshKey, serialized};
use crate::scene::load::{obj, ply};
use crate::scene::shape::repair_normals;
use crate::scene::{Geometry, MaterialId, Mesh, MeshId, OUT_OF_LIMITS, Transform};
use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};
use std::f64::consts::TAU;

/// Around a disk or cylinder, which are tessellated.
const SEGMENTS: u32 = 256;
/// Objects that instances of groups may make.
const OBJECTS_MAX: usize = 1 << 22;
/// Shapes within shapes.
const NESTING_MAX: u32 = 16;

impl Loader<'_> {
    /// Adds a shape to the scene, or what an instance shows.
    pub fn add_shape(&mut self, node: Node) -> Result<()> {
        self.add_shapes(node, 0)
    }

    fn add_shapes(&mut self, node: Node, nesting: u32) -> Result<()> {
        let object = Object::open(self.document, node)?;
        match object.plugin.name {
            // Shown through its instances.
            "shapegroup" => Ok(()),
            // What Mitsuba puts into one mesh looks the same apart; it can hold itself, so its depth has an end.
            "merge" if nesting < NESTING_MAX => {
                object.nested("shape").into_iter().try_for_each(|child| self.add_shapes(child.node, nesting + 1))
            }
            "merge" => Err(self.document.bad(node, "more than 16 shapes within each other; does one hold itself?")),
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
                    if matches!(shape.plugin.name, "shapegroup" | "instance" | "merge") {
                        return Err(self
                            .document
                            .bad(shape.node, "a shapegroup holds no groups, no instances and no merged shapes"));
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
        let (geometry, own) = self.geometry(shape)?;
        self.showing = match geometry {
            Geometry::Mesh(mesh) if self.pictured.contains_key(&mesh) => Some(mesh),
            _ => None,
        };
        let material = self.shape_material(shape);
        self.showing = None;
        let material = material?;
        let transform = own.then(shape.transform("to_world")?).then(place);
        let name = self.document.attribute(shape.node, "id").unwrap_or(shape.plugin.name).to_owned();
        let unit = match geometry {
            Geometry::Sphere => 1.0,
            Geometry::Mesh(id) => *self.units.entry(id).or_insert_with(|| self.scene.meshes[id.0 as usize].unit()),
        };
        if !transform.is_within_limits(unit) {
            let at = shape.property("to_world").unwrap_or(shape.node);
            return Err(self.document.bad(at, format!("object {name:?} {OUT_OF_LIMITS}")));
        }
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
        self.uncover(emitter.written, &mut material);
        Ok(self.add_material(material))
    }

    /// The geometry of a shape and where it lies in the shape's own space.
    fn geometry(&mut self, shape: &Object) -> Result<(Geometry, Transform)> {
        let flip = shape.boolean("flip_normals")?.unwrap_or(false);
        let shown = self.shown_attributes(shape)?;
        let mut own = DAffine3::IDENTITY;
        let mut mesh = match shape.plugin.name {
            "sphere" => {
                let radius = shape.float_in("radius", 1e-12, 1e12)?.unwrap_or(1.0);
                own = DAffine3::from_translation(shape.vector("center")?.unwrap_or(DVec3::ZERO));
                own.matrix3 = upright() * radius;
                if !flip {
                    return Ok((Geometry::Sphere, Transform(own)));
                }
                // The analytic sphere faces outwards. A mesh of ours has u = 0 towards +x.
                own.matrix3 = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y) * radius;
                crate::scene::shape::sphere_mesh(1.0, SEGMENTS)
            }
            "rectangle" => rectangle(),
            "cube" => cube(),
            "disk" => disk(),
            "cylinder" => {
                own = cylinder_place(shape)?;
                cylinder()
            }
            _ => return Ok((Geometry::Mesh(self.file_mesh(shape, flip, &shown)?), Transform(own))),
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
    fn file_mesh(&mut self, shape: &Object, flip: bool, shown: &Shown) -> Result<MeshId> {
        let Some(node) = shape.property("filename") else { return shape.required("filename", None) };
        let path = self.document.find_file(node, "value")?;
        let kind = shape.plugin.name;
        let flat = shape.boolean("face_normals")?.unwrap_or(false);
        let turned = shape.boolean("flip_tex_coords")?.unwrap_or(kind == "obj");
        let index =
            if kind == "serialized" { shape.integer("shape_index", 0, 1 << 20)?.unwrap_or(0) as u32 } else { 0 };
        let mirrored = shape.transform("to_world")?.0.matrix3.determinant() < 0.0;
        let file = path.display().to_string();
        let key = MeshKey { file, index, flat, flip, turned, shown: shown.clone(), mirrored };
        if let Some(id) = self.meshes.get(&key) {
            return Ok(*id);
        }
        let (mut mesh, attributes) = match kind {
            "obj" => (obj::read_mesh(&path)?, Vec::new()),
            "ply" if *shown != Shown::Nothing => ply::read_mesh_with_attributes(&path)?,
            "ply" => (ply::read_mesh(&path)?, Vec::new()),
            _ => {
                let mut mesh = serialized::read_mesh(&path, index)?;
                let values = std::mem::take(&mut mesh.colors);
                let colors = ply::Attribute { name: "vertex_color".to_owned(), on_faces: false, values };
                (mesh, if colors.values.is_empty() { Vec::new() } else { vec![colors] })
            }
        };
        // v = 0 is the top row in Mitsuba and the bottom row here.
        if !turned {
            mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
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
        let pictured = self.show_attributes(shape, shown, &mut mesh, attributes)?;
        let id = self.add_mesh(key, mesh);
        self.pictured.extend(pictured.map(|pictured| (id, pictured)));
        Ok(id)
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

/// Adds a quad with corners counter-clockwise; the first has u = 0 and, with u growing to the second, the v of `first`, 0 or 1.
fn add_quad(mesh: &mut Mesh, corners: [[f32; 3]; 4], first: f32) {
    let base = mesh.positions.len() as u32;
    let [a, b, c, d] = corners.map(Vec3::from_array);
    let normal = (b - a).cross(d - a).normalize();
    mesh.positions.extend([a, b, c, d]);
    mesh.normals.extend([normal; 4]);
    let last = 1.0 - first;
    mesh.uvs.extend([Vec2::new(0.0, first), Vec2::new(1.0, first), Vec2::new(1.0, last), Vec2::new(0.0, last)]);
    mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
}

/// -1 to 1 in x and y, facing +z.
fn rectangle() -> Mesh {
    let mut mesh = Mesh { name: "rectangle".to_owned(), ..Mesh::default() };
    // Mitsuba's v is 0 where y is -1.
    add_quad(&mut mesh, [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]], 1.0);
    mesh
}

/// -1 to 1 along each axis, every face with the whole uv square: corners and their uvs are those of Mitsuba 3.9's own table,
/// where the first of each face has (0, 1).
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
        add_quad(&mut mesh, face, 0.0);
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
    let matrix3 = DMat3::from_cols(x * radius, forward.cross(x) * radius, axis);
    Ok(DAffine3 { matrix3, translation: p0 })
}

/// Turns a sphere of ours, around y with u = 0.5 towards +z, to stand as Mitsuba's: around z with u = 0 towards +x.
fn upright() -> DMat3 {
    DMat3::from_cols(DVec3::NEG_Y, DVec3::Z, DVec3::NEG_X)
}
