//! The whole scene: numbers its parts, shares what is the same, and fills in the header.

use super::bvh::{Bounds, Item, TOP_LEAF, Tree, item};
use super::emitter::{bake_emitters, bake_surroundings};
use super::filter::filter_table;
use super::geometry::{BakedMesh, bake_mesh};
use super::instance::{place, top_margin};
use super::light::{bake_light, unit};
use super::media::rank_media;
use super::model::{bake_blends, bake_material, casts_shadow};
use super::srgb::srgb_table;
use super::texture::{bake_textures, bind_textures};
use super::{BakeError, SceneData, Watch};
use crate::layout::{
    Camera, INSTANCE_FLAT, INSTANCE_GOURAUD, INSTANCE_MIRRORED, INSTANCE_NO_SHADOW, INTEGRATOR_LOCAL, INTEGRATOR_PATH,
    INTEGRATOR_WHITTED, INVALID, Instance, KIND_MESH, KIND_SPHERE, Node, SAMPLER_INDEPENDENT, SAMPLER_SOBOL,
    SAMPLER_STRATIFIED, SHADOWS_FILTERED, SHADOWS_OFF, SHADOWS_OPAQUE, STACK_SIZE, SceneHeader,
};
use crate::scene::{
    self, Film, Geometry, Integrator, Material, MaterialId, Mesh, Object, Projection, Sampler, Scene, Shading, Shadows,
};
use crate::shading::material::emission_material;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::time::Instant;

/// k of the film's fixed point (DESIGN, strict rule 8): 2^-22 of a film unit is the smallest step.
const FILM_BITS: i32 = 22;

/// Bakes a scene whose indices are valid (`scene::load` guarantees it).
pub fn bake(scene: &Scene) -> Result<SceneData, BakeError> {
    bake_watched(scene, &Watch::NONE)
}

/// The same while somebody looks on.
pub fn bake_watched(scene: &Scene, watch: &Watch) -> Result<SceneData, BakeError> {
    let start = Instant::now();
    let mut data = SceneData { header: header(scene)?, ..SceneData::default() };
    bake_tables(&scene.film.filter, &mut data);
    bake_textures(&scene.textures, &mut data);
    check_count("words of texels", data.texels.len())?;
    let default_material = bake_materials(scene, &mut data)?;
    data.lights = scene.lights.iter().map(|light| bake_light(light, &mut data.tables)).collect();
    data.times.materials_s = start.elapsed().as_secs_f64();
    let mut meshes = bake_meshes(scene, default_material, watch)?;
    for mesh in meshes.iter().flatten() {
        data.times.geometry_s += mesh.geometry_s;
        data.times.binary_s += mesh.tree.seconds[0];
        data.times.wide_s += mesh.tree.seconds[1];
    }
    let placing = Instant::now();
    let mut parts = place_objects(scene, &mut meshes, default_material, &mut data)?;
    parts.meshes = meshes;
    bake_light_sources(scene, &parts, &mut data)?;
    data.times.top_s = placing.elapsed().as_secs_f64();
    build_hierarchy(parts, &mut data, watch)?;
    data.header.instance_count = data.instances.len() as u32;
    data.header.light_count = data.lights.len() as u32;
    data.header.shadow_rays = shadow_rays(&data);
    data.header.level_count = if data.branches() { data.header.max_depth + 1 } else { 1 };
    let shadowless = data.instances.iter().any(|instance| instance.flags & INSTANCE_NO_SHADOW != 0);
    data.header.shadowless = u32::from(shadowless && data.header.integrator == INTEGRATOR_PATH);
    if data.header.shadows == SHADOWS_FILTERED && !data.has_panes() {
        data.header.shadows = SHADOWS_OPAQUE;
    }
    data.header.material_count = data.materials.len() as u32;
    data.place_heap()?;
    data.warnings.extend(unused_shading(scene));
    data.times.whole_s = start.elapsed().as_secs_f64();
    Ok(data)
}

/// Shadow rays of one hit at most: to each light from each of its shading points, or to one emitter.
fn shadow_rays(data: &SceneData) -> u32 {
    let gouraud = data.instances.iter().any(|instance| instance.flags & INSTANCE_GOURAUD != 0);
    match data.header.integrator {
        INTEGRATOR_PATH => 1,
        _ => data.lights.len() as u32 * if gouraud { 3 } else { 1 },
    }
}

fn check_count(what: &'static str, count: usize) -> Result<(), BakeError> {
    // INVALID itself is no index.
    if count as u64 >= u64::from(INVALID) { Err(BakeError::TooLarge { what, count: count as u64 }) } else { Ok(()) }
}

/// Whether paths are traced.
fn traced(scene: &Scene) -> bool {
    matches!(scene.settings.integrator, Integrator::Direct | Integrator::Path)
}

/// Bakes all materials, and one more where an object or face names none. Returns the id of that one.
fn bake_materials(scene: &Scene, data: &mut SceneData) -> Result<MaterialId, BakeError> {
    for material in &scene.materials {
        let mut baked = bake_material(material, &scene.tables, traced(scene), &mut data.tables)?;
        bind_textures(material, &mut baked, data)?;
        data.materials.push(baked);
    }
    let nameless = |object: &Object| match object.geometry {
        Geometry::Sphere => object.material.is_none(),
        Geometry::Mesh(id) => object.material.is_none() && scene.meshes[id.0 as usize].face_materials.is_empty(),
    };
    let default = MaterialId(scene.materials.len() as u32);
    if scene.objects.iter().any(nameless) {
        data.materials.push(bake_material(&Material::grey("default"), &[], traced(scene), &mut data.tables)?);
    }
    rank_media(&scene.materials, data)?;
    bake_blends(&scene.materials, &mut data.materials)?;
    check_count("table entries", data.tables.len())?;
    Ok(default)
}

/// The table array: the sRGB decoding table first, then the filter's, if it has one.
fn bake_tables(filter: &scene::Filter, data: &mut SceneData) {
    data.tables = srgb_table();
    let filter = filter_table(filter);
    let h = &mut data.header;
    (h.filter_kind, h.filter_radius, h.filter_norm) = (filter.kind, filter.radius, filter.norm);
    h.filter_table = data.tables.len() as u32;
    data.tables.extend(filter.table);
}

/// The image around the scene and, for path tracing, everything that glows.
fn bake_light_sources(scene: &Scene, parts: &Parts, data: &mut SceneData) -> Result<(), BakeError> {
    let environment = bake_surroundings(scene, data);
    if data.header.integrator != INTEGRATOR_PATH {
        return Ok(());
    }
    if scene.ambient != Vec3::ZERO {
        data.warnings.push("ambient light has no effect under path and direct: light comes from what glows".to_owned());
    }
    let shines = |material: &crate::layout::Material| emission_material(material) != Vec3::ZERO;
    data.header.glows = u32::from(scene.background.shines() || data.materials.iter().any(shines));
    let world = parts.shown.iter().fold(Bounds::EMPTY, |all, &(_, own)| all.union(own));
    let primitives = |instance: usize| {
        let mesh = parts.shown[instance].0.and_then(|id| parts.meshes[id].as_ref());
        let mut primitives: Vec<u32> =
            mesh.map_or(Vec::new(), |mesh| mesh.triangles.iter().map(|t| t.primitive).collect());
        primitives.sort_unstable();
        primitives
    };
    bake_emitters(environment, &primitives, world, data)
}

/// Bakes each mesh that an object uses, once.
fn bake_meshes(
    scene: &Scene,
    default_material: MaterialId,
    watch: &Watch,
) -> Result<Vec<Option<BakedMesh>>, BakeError> {
    let mut used = vec![false; scene.meshes.len()];
    for object in &scene.objects {
        if let Geometry::Mesh(id) = object.geometry {
            used[id.0 as usize] = true;
        }
    }
    let one = |(mesh, &used): (&Mesh, &bool)| used.then(|| bake_mesh(mesh, default_material, watch)).transpose();
    scene.meshes.par_iter().zip(&used).map(one).collect()
}

/// What the two levels are built from.
struct Parts {
    meshes: Vec<Option<BakedMesh>>,
    /// Mesh and world box of each instance.
    shown: Vec<(Option<usize>, Bounds)>,
    growth: f64,
}

/// Makes the instances, and the faces and vertices of the meshes they show.
fn place_objects(
    scene: &Scene,
    meshes: &mut [Option<BakedMesh>],
    default_material: MaterialId,
    data: &mut SceneData,
) -> Result<Parts, BakeError> {
    let faces = meshes.iter().flatten().map(|mesh| mesh.faces.len()).sum();
    let vertices = meshes.iter().flatten().map(|mesh| mesh.vertices.len()).sum();
    check_count("vertices", vertices)?;
    check_count("faces", faces)?;
    let mut first_face = vec![0u32; meshes.len()];
    for (id, mesh) in meshes.iter_mut().enumerate() {
        let Some(mesh) = mesh else { continue };
        data.warnings.extend(mesh.warning.clone());
        first_face[id] = data.faces.len() as u32;
        let base = data.vertices.len() as u32;
        if base > 0 {
            mesh.faces.par_iter_mut().for_each(|face| {
                (face.i0, face.i1, face.i2) = (base + face.i0, base + face.i1, base + face.i2);
            });
        }
        append(&mut data.faces, std::mem::take(&mut mesh.faces), faces);
        append(&mut data.vertices, std::mem::take(&mut mesh.vertices), vertices);
    }
    let mut parts = Parts { meshes: Vec::new(), shown: Vec::new(), growth: 1.0 };
    for (index, object) in scene.objects.iter().enumerate() {
        let sphere = Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE };
        let (mesh, unit, bounds) = match object.geometry {
            Geometry::Sphere => (None, 1.0, sphere),
            Geometry::Mesh(id) => match &meshes[id.0 as usize] {
                Some(BakedMesh { tree: Tree { bounds: Some(bounds), .. }, unit, .. }) => {
                    (Some(id.0 as usize), *unit, *bounds)
                }
                // Nothing of it can be hit.
                _ => continue,
            },
        };
        let placement = place(&object.name, &object.transform, unit, &bounds, mesh.is_none())?;
        parts.growth = parts.growth.max(placement.growth);
        parts.shown.push((mesh, placement.world));
        let (shadowed, warning) = instance_shadow(scene, object);
        data.warnings.extend(warning);
        data.instances.push(Instance {
            to_world: placement.to_world,
            to_object: placement.to_object,
            kind: if mesh.is_some() { KIND_MESH } else { KIND_SPHERE },
            root: INVALID,
            first_face: mesh.map_or(0, |id| first_face[id]),
            material: match (object.material, mesh) {
                (Some(id), _) => id.0,
                (None, Some(_)) => INVALID,
                (None, None) => default_material.0,
            },
            flags: (if shadowed { 0 } else { INSTANCE_NO_SHADOW })
                | (if placement.mirrored { INSTANCE_MIRRORED } else { 0 })
                | instance_shading(scene, object)?,
            object: index as u32,
            ..Instance::default()
        });
    }
    check_count("instances", data.instances.len())?;
    Ok(parts)
}

/// Says so where a shading is asked for that the integrator does not honour.
fn unused_shading(scene: &Scene) -> Option<String> {
    let asked = |object: &Object| object.shading.unwrap_or(scene.settings.shading) != Shading::Phong;
    let unused = scene.settings.integrator != Integrator::Local && scene.objects.iter().any(asked);
    unused.then(|| "\"shading\" has an effect with integrator \"local\" only: all is shaded as \"phong\"".into())
}

/// The flag of an object's shading, which only `local` honours.
fn instance_shading(scene: &Scene, object: &Object) -> Result<u32, BakeError> {
    if scene.settings.integrator != Integrator::Local {
        return Ok(0);
    }
    let flag = match object.shading.unwrap_or(scene.settings.shading) {
        Shading::Flat => INSTANCE_FLAT,
        Shading::Gouraud => INSTANCE_GOURAUD,
        Shading::Phong => return Ok(0),
    };
    match object.geometry {
        Geometry::Sphere => Err(BakeError::Faceted { name: object.name.clone() }),
        Geometry::Mesh(_) => Ok(flag),
    }
}

/// Whether an object casts shadows: what it says, else what its material says. Shadow rays know instances, not
/// faces: a mesh of both kinds of faces casts with all of them, and says so.
fn instance_shadow(scene: &Scene, object: &Object) -> (bool, Option<String>) {
    let met = traced(scene) || scene.settings.shadows == Shadows::Filtered;
    let of = |id: MaterialId| casts_shadow(&scene.materials[id.0 as usize], met);
    if let Some(casts) = object.casts_shadow {
        return (casts, None);
    }
    if let Some(id) = object.material {
        return (of(id), None);
    }
    let Geometry::Mesh(id) = object.geometry else {
        return (true, None);
    };
    let faces = &scene.meshes[id.0 as usize].face_materials;
    let mut used = vec![false; scene.materials.len()];
    faces.iter().for_each(|id| used[id.0 as usize] = true);
    let answers: Vec<bool> = (0..used.len()).filter(|&i| used[i]).map(|i| of(MaterialId(i as u32))).collect();
    let casts = answers.is_empty() || answers.contains(&true);
    let mixed = casts && answers.contains(&false);
    let warning = mixed.then(|| {
        format!("object \"{}\": some of its materials cast no shadow and some do; all of it casts one", object.name)
    });
    (casts, warning)
}

/// Appends `more` to `all`, which is to have `total` items in the end. The first part of a scene moves without a copy: large
/// arrays grow in place.
fn append<T>(all: &mut Vec<T>, mut more: Vec<T>, total: usize) {
    if all.is_empty() {
        std::mem::swap(all, &mut more);
    }
    all.reserve_exact(total - all.len());
    all.append(&mut more);
}

/// Builds the top level and lays all hierarchies out in one array.
fn build_hierarchy(mut parts: Parts, data: &mut SceneData, watch: &Watch) -> Result<(), BakeError> {
    data.header.top_margin = top_margin(parts.growth);
    data.header.top_root = INVALID;
    if parts.shown.is_empty() {
        return Ok(());
    }
    let start = Instant::now();
    let boxes: Vec<Item> = (0..).zip(&parts.shown).map(|(index, &(_, world))| item(world, index)).collect();
    let top = Tree::build(boxes, TOP_LEAF, watch)?;
    let meshes = parts.meshes.iter().flatten().map(|mesh| mesh.tree.stack);
    data.stack_depth = meshes.fold(top.stack, u32::max);
    if data.stack_depth > STACK_SIZE {
        return Err(BakeError::Deep(data.stack_depth));
    }
    data.times.top_s += start.elapsed().as_secs_f64();

    let start = Instant::now();
    let triangles = parts.meshes.iter().flatten().map(|mesh| mesh.triangles.len()).sum();
    check_count("triangles", triangles)?;
    let nodes = parts.meshes.iter().flatten().map(|mesh| mesh.tree.nodes.len()).sum::<usize>() + top.nodes.len();
    check_count("nodes", nodes)?;
    let mut roots = vec![INVALID; parts.meshes.len()];
    for (id, mesh) in parts.meshes.iter_mut().enumerate() {
        let Some(mesh) = mesh.as_mut().filter(|mesh| !mesh.is_empty()) else {
            continue;
        };
        let first = (data.nodes.len() as u32, data.triangles.len() as u32);
        roots[id] = first.0;
        append(&mut data.nodes, shifted(std::mem::take(&mut mesh.tree.nodes), first.1), nodes);
        append(&mut data.triangles, std::mem::take(&mut mesh.triangles), triangles);
    }
    // The top level last, so that the nodes of a large mesh need not make room for it.
    data.header.top_root = data.nodes.len() as u32;
    append(&mut data.nodes, top.nodes, nodes);
    data.top_instances = top.order;
    for (instance, (mesh, _)) in data.instances.iter_mut().zip(&parts.shown) {
        instance.root = mesh.map_or(INVALID, |id| roots[id]);
    }
    data.times.pack_s += start.elapsed().as_secs_f64();
    Ok(())
}

/// Nodes of a hierarchy whose primitives begin at `first` in the scene's array.
fn shifted(mut nodes: Vec<Node>, first: u32) -> Vec<Node> {
    if first != 0 {
        nodes.par_iter_mut().for_each(|node| node.primitive_base += first);
    }
    nodes
}

/// All of the header that does not depend on the arrays.
fn header(scene: &Scene) -> Result<SceneHeader, BakeError> {
    let settings = &scene.settings;
    let exponent = FILM_BITS - scene.film.unit_exponent;
    if !(-100..=100).contains(&scene.film.unit_exponent) {
        return Err(BakeError::FilmUnit(scene.film.unit_exponent));
    }
    let max_depth = if settings.integrator == Integrator::Direct { 1 } else { settings.max_depth };
    Ok(SceneHeader {
        camera: camera(&scene.camera, &scene.film)?,
        ambient: scene.ambient,
        integrator: match settings.integrator {
            Integrator::Local => INTEGRATOR_LOCAL,
            Integrator::Whitted => INTEGRATOR_WHITTED,
            Integrator::Direct | Integrator::Path => INTEGRATOR_PATH,
        },
        max_depth,
        min_weight: settings.min_weight,
        seed: settings.seed,
        sampling: match settings.sampler {
            Sampler::Sobol => SAMPLER_SOBOL,
            Sampler::Stratified => SAMPLER_STRATIFIED,
            Sampler::Independent => SAMPLER_INDEPENDENT,
        },
        // For the sampler that needs them only: otherwise films made with --spp and --samples would differ in their digest.
        strata: if settings.sampler == Sampler::Stratified { strata(settings.samples) } else { 1 },
        shadows: match settings.shadows {
            Shadows::Off => SHADOWS_OFF,
            Shadows::Opaque => SHADOWS_OPAQUE,
            Shadows::Filtered => SHADOWS_FILTERED,
        },
        film_scale: libm::ldexp(1.0, exponent) as f32,
        rr_depth: settings.rr_depth,
        // Only paths have scattered light to limit.
        clamp: if traced(scene) { settings.clamp.unwrap_or(0.0) } else { 0.0 },
        hide_background: u32::from(settings.hide_emitters && traced(scene)),
        hide_emitters: u32::from(settings.hide_emitters && traced(scene)),
        ..SceneHeader::default()
    })
}

/// Strata per axis: the largest square that `samples` fill.
fn strata(samples: u32) -> u32 {
    (libm::sqrt(f64::from(samples)) as u32).max(1)
}

/// The camera's record (`layout::Camera`) from where it stands.
fn camera(camera: &scene::Camera, film: &Film) -> Result<Camera, BakeError> {
    let cross = |a: DVec3, b: DVec3| DVec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    let normalise = |v: DVec3| {
        let length = libm::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        (length > 0.0 && length.is_finite()).then(|| v / length)
    };
    let view = camera.target.as_dvec3() - camera.eye.as_dvec3();
    let forward = normalise(view).ok_or(BakeError::Camera("looks at its own position"))?;
    let right =
        normalise(cross(forward, camera.up.as_dvec3())).ok_or(BakeError::Camera("looks along its up vector"))?;
    let up = cross(right, forward);
    let right = if camera.mirrored { -right } else { right };
    let (kind, half_height) = match camera.projection {
        Projection::Perspective { fov_y } => (crate::layout::CAMERA_PERSPECTIVE, libm::tan(f64::from(fov_y) * 0.5)),
        Projection::Orthographic { height } => (crate::layout::CAMERA_ORTHOGRAPHIC, f64::from(height) * 0.5),
    };
    let half_width = half_height * f64::from(film.width) / f64::from(film.height);
    Ok(Camera {
        eye: camera.eye,
        kind,
        right: (right * half_width).as_vec3(),
        scale_x: (2.0 / f64::from(film.width)) as f32,
        up: (up * half_height).as_vec3(),
        scale_y: (2.0 / f64::from(film.height)) as f32,
        forward: unit(forward),
        pixel_size: (2.0 * half_height / f64::from(film.height)) as f32,
        lens_radius: camera.lens.map_or(0.0, |lens| lens.radius),
        focus_distance: camera.lens.map_or(0.0, |lens| lens.focus_distance),
        shift_x: 2.0 * camera.shift.x,
        shift_y: 2.0 * camera.shift.y,
    })
}
