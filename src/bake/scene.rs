//! The whole scene: numbers its parts, shares what is the same, and fills in the header.

use super::emitter::{bake_emitters, bake_surroundings};
use super::filter::filter_table;
use super::light::{bake_light, unit};
use super::media::rank_media;
use super::model::{Baked, bake_blends, bake_material, casts_shadow, pack_materials};
use super::shapes::{Shapes, bake_shapes, shapes_key};
use super::srgb::srgb_table;
use super::texture::{bake_textures, bind_textures};
use super::{BakeError, BakeTimes, SceneArrays, SceneData};
use crate::layout::{
    Camera, FRACTION_BITS, Features, INSTANCE_FLAT, INSTANCE_GOURAUD, INSTANCE_MIRRORED, INSTANCE_NO_SHADOW,
    INTEGRATOR_LOCAL, INTEGRATOR_PATH, INTEGRATOR_WHITTED, INVALID, Instance, KIND_MESH, KIND_SPHERE,
    SAMPLER_INDEPENDENT, SAMPLER_SOBOL, SAMPLER_STRATIFIED, SHADOWS_FILTERED, SHADOWS_OFF, SHADOWS_OPAQUE, SceneHeader,
};
use crate::scene::{
    self, Film, Geometry, Integrator, Material, MaterialId, Object, Projection, Sampler, Scene, Shading, Shadows,
};
use crate::watch::Watch;
use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
use std::sync::Arc;
use std::time::Instant;

/// Bakes a scene whose indices are valid (`scene::load` guarantees it).
pub fn bake(scene: &Scene) -> Result<SceneData, BakeError> {
    bake_watched(scene, &Watch::default())
}

/// The same while somebody looks on.
pub fn bake_watched(scene: &Scene, watch: &Watch) -> Result<SceneData, BakeError> {
    bake_with(scene, |times| bake_shapes(scene, default_material(scene), times, watch).map(Arc::new))
}

/// Bakes scenes one after the other, such as the panels of a file: one that has the shapes of the last one shares them.
#[derive(Debug, Default)]
pub struct Baker {
    last: Option<([u8; 32], Arc<Shapes>)>,
}

impl Baker {
    /// One that goes on from a scene that is baked.
    pub fn after(scene: &Scene, data: &SceneData) -> Self {
        Self { last: Some((shapes_key(scene, default_material(scene)), data.shapes.clone())) }
    }

    /// As `bake_watched`.
    pub fn bake(&mut self, scene: &Scene, watch: &Watch) -> Result<SceneData, BakeError> {
        bake_with(scene, |times| {
            let key = shapes_key(scene, default_material(scene));
            // What is of no more use makes room before there is more.
            self.last.take_if(|(last, _)| *last != key);
            if let Some((_, shapes)) = &self.last {
                return Ok(shapes.clone());
            }
            let shapes = Arc::new(bake_shapes(scene, default_material(scene), times, watch)?);
            self.last = Some((key, shapes.clone()));
            Ok(shapes)
        })
    }
}

/// Bakes a scene with the shapes that `shapes` gives.
fn bake_with(
    scene: &Scene,
    shapes: impl FnOnce(&mut BakeTimes) -> Result<Arc<Shapes>, BakeError>,
) -> Result<SceneData, BakeError> {
    let start = Instant::now();
    let mut data = SceneArrays { header: header(scene)?, features: chosen_features(scene), ..SceneArrays::default() };
    bake_tables(&scene.film.filter, &mut data);
    bake_textures(&scene.textures, &mut data);
    check_count("words of texels", data.texels.len())?;
    bake_materials(scene, &mut data)?;
    data.lights = scene.lights.iter().map(|light| bake_light(light, &mut data.tables)).collect();
    data.times.materials_s = start.elapsed().as_secs_f64();
    data.shapes = shapes(&mut data.times)?;
    data.warnings.extend_from_slice(&data.shapes.warnings);
    (data.header.top_root, data.header.top_margin) = (data.shapes.top_root, data.shapes.top_margin);
    let placing = Instant::now();
    bake_instances(scene, &mut data)?;
    bake_light_sources(scene, &mut data)?;
    data.times.top_s += placing.elapsed().as_secs_f64();
    data.header.instance_count = data.instances.len() as u32;
    data.header.light_count = data.lights.len() as u32;
    data.header.level_count = if data.branches() { data.header.max_depth + 1 } else { 1 };
    data.header.shadow_rays = shadow_rays(&data);
    data.header.material_count = data.materials.len() as u32;
    data.place_heap()?;
    data.warnings.extend(unused_shading(scene));
    data.times.whole_s = start.elapsed().as_secs_f64();
    Ok(SceneData::from(data))
}

/// Shadow rays of one hit at most: to each light from each of its shading points, or to one emitter, and one that goes on behind
/// an object without a shadow.
fn shadow_rays(data: &SceneArrays) -> u32 {
    let any = |flag| data.instances.iter().any(|instance| instance.flags & flag != 0);
    match data.features.integrator {
        INTEGRATOR_PATH => 1 + u32::from(any(INSTANCE_NO_SHADOW)),
        _ => data.lights.len() as u32 * if any(INSTANCE_GOURAUD) { 3 } else { 1 },
    }
}

pub(super) fn check_count(what: &'static str, count: usize) -> Result<(), BakeError> {
    // INVALID itself is no index.
    if count as u64 >= u64::from(INVALID) { Err(BakeError::TooLarge { what, count: count as u64 }) } else { Ok(()) }
}

/// Whether paths are traced.
fn traced(scene: &Scene) -> bool {
    matches!(scene.settings.integrator, Integrator::Direct | Integrator::Path)
}

/// Bakes all materials, and one more where an object or face names none (`default_material`).
fn bake_materials(scene: &Scene, data: &mut SceneArrays) -> Result<(), BakeError> {
    let mut baked = Vec::new();
    for material in &scene.materials {
        let closure = bake_material(material, &scene.tables, traced(scene), &mut data.tables)?;
        baked.push(Baked { closure, ..Baked::default() });
        bind_textures(material, baked.last_mut().expect("just pushed"), data)?;
    }
    let nameless = |object: &Object| match object.geometry {
        Geometry::Sphere => object.material.is_none(),
        Geometry::Mesh(id) => object.material.is_none() && scene.meshes[id.0 as usize].face_materials.is_empty(),
    };
    if scene.objects.iter().any(nameless) {
        let closure = bake_material(&Material::grey("default"), &[], traced(scene), &mut data.tables)?;
        baked.push(Baked { closure, ..Baked::default() });
    }
    rank_media(&scene.materials, &mut baked, data)?;
    bake_blends(&scene.materials, &mut baked)?;
    pack_materials(&baked, data);
    check_count("table entries", data.tables.len())
}

/// The material of objects and faces that name none: one after the scene's own.
fn default_material(scene: &Scene) -> MaterialId {
    MaterialId(scene.materials.len() as u32)
}

/// The table array: the sRGB decoding table first, then the filter's, if it has one.
fn bake_tables(filter: &scene::Filter, data: &mut SceneArrays) {
    data.tables = srgb_table();
    let filter = filter_table(filter);
    data.features.filter = filter.kind;
    let h = &mut data.header;
    (h.filter_radius, h.filter_norm, h.filter_table) = (filter.radius, filter.norm, data.tables.len() as u32);
    data.tables.extend(filter.table);
}

/// The image around the scene and, for path tracing, everything that glows.
fn bake_light_sources(scene: &Scene, data: &mut SceneArrays) -> Result<(), BakeError> {
    let environment = bake_surroundings(scene, data);
    if data.features.integrator != INTEGRATOR_PATH {
        return Ok(());
    }
    if scene.ambient != Vec3::ZERO {
        data.warnings.push("ambient light has no effect under path and direct: light comes from what glows".to_owned());
    }
    let shines = |material: &crate::layout::Material| material.emission != Vec3::ZERO;
    data.features.has_glow = scene.background.shines() || data.materials.iter().any(shines);
    bake_emitters(environment, data)
}

/// Makes the instances: the placed shapes with what the scene's settings and materials say of them.
fn bake_instances(scene: &Scene, data: &mut SceneArrays) -> Result<(), BakeError> {
    for placed in &data.shapes.placed {
        let object = &scene.objects[placed.object as usize];
        let (shadowed, warning) = instance_shadow(scene, object);
        data.warnings.extend(warning);
        let mesh = placed.mesh.as_ref();
        data.instances.push(Instance {
            to_world: placed.to_world,
            to_object: placed.to_object,
            kind: if mesh.is_some() { KIND_MESH } else { KIND_SPHERE },
            root: mesh.map_or(INVALID, |mesh| mesh.root),
            first_face: mesh.map_or(0, |mesh| mesh.first_face),
            material: match (object.material, mesh) {
                (Some(id), _) => id.0,
                (None, Some(_)) => INVALID,
                (None, None) => default_material(scene).0,
            },
            flags: (if shadowed { 0 } else { INSTANCE_NO_SHADOW })
                | (if placed.mirrored { INSTANCE_MIRRORED } else { 0 })
                | instance_shading(scene, object)?,
            object: placed.object,
            ..Instance::default()
        });
    }
    Ok(())
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

/// The features that the scene's settings choose; `SceneData` adds what its arrays use.
fn chosen_features(scene: &Scene) -> Features {
    let settings = &scene.settings;
    let hides_emitters = settings.hide_emitters && traced(scene);
    Features {
        integrator: match settings.integrator {
            Integrator::Local => INTEGRATOR_LOCAL,
            Integrator::Whitted => INTEGRATOR_WHITTED,
            Integrator::Direct | Integrator::Path => INTEGRATOR_PATH,
        },
        sampler: match settings.sampler {
            Sampler::Sobol => SAMPLER_SOBOL,
            Sampler::Stratified => SAMPLER_STRATIFIED,
            Sampler::Independent => SAMPLER_INDEPENDENT,
        },
        shadows: match settings.shadows {
            Shadows::Off => SHADOWS_OFF,
            Shadows::Opaque => SHADOWS_OPAQUE,
            Shadows::Filtered => SHADOWS_FILTERED,
        },
        has_aovs: settings.aovs,
        hides_background: settings.transparent || hides_emitters,
        hides_emitters,
        ..Features::zeroed()
    }
}

/// All of the header that does not depend on the arrays.
fn header(scene: &Scene) -> Result<SceneHeader, BakeError> {
    let settings = &scene.settings;
    let exponent = FRACTION_BITS as i32 - scene.film.unit_exponent;
    if !(-100..=100).contains(&scene.film.unit_exponent) {
        return Err(BakeError::FilmUnit(scene.film.unit_exponent));
    }
    let max_depth = if settings.integrator == Integrator::Direct { 1 } else { settings.max_depth };
    Ok(SceneHeader {
        camera: camera(&scene.camera, &scene.film)?,
        ambient: scene.ambient,
        max_depth,
        min_weight: settings.min_weight,
        seed: settings.seed,
        // For the sampler that needs them only: otherwise films made with --spp and --samples would differ in their digest.
        strata: if settings.sampler == Sampler::Stratified { strata(settings.samples) } else { 1 },
        film_scale: libm::ldexp(1.0, exponent) as f32,
        rr_depth: settings.rr_depth,
        // Only paths have scattered light to limit.
        clamp: if traced(scene) { settings.clamp.unwrap_or(0.0) } else { 0.0 },
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
