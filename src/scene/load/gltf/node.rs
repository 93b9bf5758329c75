//! The node hierarchy: where everything stands.

use super::accessor::Accessors;
use super::{Failure, Loader, Part};
use crate::scene::{
    Attenuation, Camera, Flaps, Geometry, IntensityUnit, Light, LightKind, NamedCamera, OUT_OF_LIMITS, Object,
    Projection, Rgb, Transform,
};
use glam::{DAffine3, DMat3, DQuat, DVec3, DVec4, Vec2, Vec3};
use gltf::json::camera::Type as CameraType;
use gltf::json::extensions::scene::khr_lights_punctual::Type as LightType;
use gltf::json::validation::Checked;
use gltf::json::{Index, Node, Root, accessor};

/// Objects of a scene, instances included.
const OBJECTS_MAX: usize = 1 << 22;
/// Candela to watts per steradian, lux to watts per square metre: the luminous efficacy of 555 nm (as glTF-Blender-IO).
const LUMENS_PER_WATT: f64 = 683.0;

/// The nodes of the scene, each with its transform to the world, parents first. Refuses nodes that are missing, have two
/// parents or are their own ancestors.
pub(super) fn flatten(root: &Root) -> Result<Vec<(usize, DAffine3)>, Failure> {
    let parents = parents(root)?;
    let mut stack: Vec<(usize, DAffine3)> = Vec::new();
    match root.scenes.get(root.scene.map_or(0, |scene| scene.value())) {
        Some(scene) => {
            for node in scene.nodes.iter().rev() {
                if node.value() >= root.nodes.len() {
                    let message = format!("refers to node {node}; there are {}", root.nodes.len());
                    return Err(Failure::new("scenes", message));
                }
                stack.push((node.value(), DAffine3::IDENTITY));
            }
        }
        None if root.scene.is_some() => {
            let message = format!("is {}; there are {} scenes", root.scene.map_or(0, |s| s.value()), root.scenes.len());
            return Err(Failure::new("scene", message));
        }
        None => {
            stack.extend((0..root.nodes.len()).rev().filter(|i| parents[*i].is_none()).map(|i| (i, DAffine3::IDENTITY)))
        }
    }
    let mut seen = vec![false; root.nodes.len()];
    let mut order = Vec::new();
    while let Some((index, parent)) = stack.pop() {
        if std::mem::replace(&mut seen[index], true) {
            return Err(Failure::new(format!("nodes[{index}]"), "is in the scene twice"));
        }
        let world = parent * local(&root.nodes[index], index)?;
        order.push((index, world));
        let children = root.nodes[index].children.iter().flatten().rev();
        stack.extend(children.map(|child| (child.value(), world)));
    }
    Ok(order)
}

fn parents(root: &Root) -> Result<Vec<Option<usize>>, Failure> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let place = format!("nodes[{index}].children");
            let Some(parent) = parents.get_mut(child.value()) else {
                return Err(Failure::new(place, format!("refers to node {child}; there are {}", root.nodes.len())));
            };
            if let Some(other) = parent.replace(index) {
                let message = format!("node {child} is also a child of node {other}");
                return Err(Failure::new(place, message));
            }
        }
    }
    // With one parent each, whatever hangs from no root hangs from itself.
    let mut reached = vec![false; parents.len()];
    let mut stack: Vec<usize> = (0..parents.len()).filter(|i| parents[*i].is_none()).collect();
    while let Some(index) = stack.pop() {
        reached[index] = true;
        stack.extend(root.nodes[index].children.iter().flatten().map(Index::value));
    }
    match reached.iter().position(|reached| !reached) {
        Some(index) => Err(Failure::new(format!("nodes[{index}]"), "is in a cycle: it is its own ancestor")),
        None => Ok(parents),
    }
}

/// Node to parent.
fn local(node: &Node, index: usize) -> Result<DAffine3, Failure> {
    let affine = match &node.matrix {
        Some(m) => {
            let m = m.map(f64::from);
            let column = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
            let matrix3 = DMat3::from_cols(column(0), column(1), column(2));
            DAffine3 { matrix3, translation: column(3) }
        }
        None => {
            let three =
                |v: Option<[f32; 3]>, default: f64| v.map_or(DVec3::splat(default), |v| Vec3::from(v).as_dvec3());
            let [x, y, z, w] = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |r| r.0.map(f64::from));
            compose(three(node.translation, 0.0), DVec4::new(x, y, z, w), three(node.scale, 1.0))
        }
    };
    if affine.is_finite() {
        return Ok(affine);
    }
    Err(Failure::new(format!("nodes[{index}]"), "its transform is not finite"))
}

/// Translation times rotation (a quaternion x, y, z, w of any length but 0) times scale.
fn compose(translation: DVec3, rotation: DVec4, scale: DVec3) -> DAffine3 {
    let length = libm::sqrt(rotation.dot(rotation));
    let q = if length > 0.0 { rotation / length } else { DVec4::W };
    let matrix3 = DMat3::from_quat(DQuat::from_vec4(q)) * DMat3::from_diagonal(scale);
    DAffine3 { matrix3, translation }
}

impl Loader<'_> {
    /// Adds what node `index` carries, standing at `world`.
    pub(super) fn add_node(&mut self, index: usize, world: DAffine3) -> Result<(), Failure> {
        let node = &self.root.nodes[index];
        let place = format!("nodes[{index}]");
        let name = node.name.clone().unwrap_or_else(|| place.clone());
        if let Some(mesh) = node.mesh {
            let instances = self.instances(node, &place)?;
            let parts = self.mesh_parts(mesh.value(), node.weights.as_deref(), &place)?;
            for instance in instances {
                self.add_objects(&parts, &place, &name, world * instance)?;
            }
        }
        if let Some(camera) = node.camera {
            self.add_camera(camera.value(), world, &name, &place)?;
        }
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        if let Some(light) = light {
            self.add_light(light.light.value(), &name, world, &place)?;
        }
        if node.skin.is_some() {
            self.notes.insert("skins are ignored: skinned meshes keep their bind pose".to_owned());
        }
        Ok(())
    }

    /// Shows `parts` at `world`. `place` is what places them in the document.
    pub(super) fn add_objects(
        &mut self,
        parts: &[Part],
        place: &str,
        name: &str,
        world: DAffine3,
    ) -> Result<(), Failure> {
        let transform = Transform(world);
        let size = world.matrix3.to_cols_array().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        // Collapsed to a plane or a point, often to hide it.
        if transform.determinant().abs() <= 1e-12 * size * size * size || !world.is_finite() {
            self.notes.insert(format!("node {name} is scaled to nothing and left out"));
            return Ok(());
        }
        if self.scene.objects.len() + parts.len() > OBJECTS_MAX {
            return Err(Failure::new("nodes", format!("more than {OBJECTS_MAX} objects")));
        }
        for (mesh, material) in parts {
            let unit = self.units.entry(*mesh).or_insert_with(|| self.scene.meshes[mesh.0 as usize].unit());
            if !transform.is_within_limits(*unit) {
                return Err(Failure::new(place, format!("object {name:?} {OUT_OF_LIMITS}")));
            }
            self.scene.objects.push(Object {
                name: name.to_owned(),
                geometry: Geometry::Mesh(*mesh),
                transform,
                material: Some(*material),
                casts_shadow: None,
                shading: None,
            });
        }
        Ok(())
    }

    /// EXT_mesh_gpu_instancing: the transforms of all instances; one of identity without it.
    fn instances(&self, node: &Node, place: &str) -> Result<Vec<DAffine3>, Failure> {
        let extension = node.extensions.as_ref().and_then(|e| e.others.get("EXT_mesh_gpu_instancing"));
        let Some(attributes) = extension.and_then(|e| e.get("attributes")?.as_object()) else {
            return Ok(vec![DAffine3::IDENTITY]);
        };
        let place = format!("{place}.extensions.EXT_mesh_gpu_instancing");
        let index = |name: &str| -> Result<Option<Index<accessor::Accessor>>, Failure> {
            let Some(value) = attributes.get(name) else {
                return Ok(None);
            };
            match value.as_u64().and_then(|i| u32::try_from(i).ok()) {
                Some(i) => Ok(Some(Index::new(i))),
                None => Err(Failure::new(&*place, format!("{name} is not the index of an accessor"))),
            }
        };
        let accessors = Accessors { root: self.root, buffers: self.buffers };
        let vectors = |name: &str| -> Result<Option<Vec<DVec3>>, Failure> {
            let Some(index) = index(name)? else {
                return Ok(None);
            };
            let read = accessors.floats::<3>(index, &format!("{place}.{name}"), None)?;
            Ok(Some(read.into_iter().map(|v| Vec3::from(v).as_dvec3()).collect()))
        };
        let (translations, scales) = (vectors("TRANSLATION")?, vectors("SCALE")?);
        let rotations = match index("ROTATION")? {
            Some(index) => Some(accessors.floats::<4>(index, &format!("{place}.ROTATION"), None)?),
            None => None,
        };
        let counts =
            [translations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len)];
        let mut counts = counts.into_iter().flatten();
        let Some(count) = counts.next() else {
            return Ok(vec![DAffine3::IDENTITY]);
        };
        if counts.any(|other| other != count) {
            return Err(Failure::new(place, "its attributes have different counts"));
        }
        let instance = |i: usize| {
            let rotation = rotations.as_ref().map_or(DVec4::W, |r| DVec4::from_array(r[i].map(f64::from)));
            compose(
                translations.as_ref().map_or(DVec3::ZERO, |t| t[i]),
                rotation,
                scales.as_ref().map_or(DVec3::ONE, |s| s[i]),
            )
        };
        Ok((0..count).map(instance).collect())
    }

    /// The first camera is taken, unless the user wants another.
    fn add_camera(&mut self, index: usize, world: DAffine3, name: &str, place: &str) -> Result<(), Failure> {
        let Some(camera) = self.root.cameras.get(index) else {
            let message = format!("refers to camera {index}; there are {}", self.root.cameras.len());
            return Err(Failure::new(place, message));
        };
        let name = camera.name.clone().unwrap_or_else(|| name.to_owned());
        let place = format!("cameras[{index}]");
        let mut aspect = None;
        let projection = match (&camera.type_, &camera.perspective, &camera.orthographic) {
            (Checked::Valid(CameraType::Perspective), Some(p), _) => {
                // Our field of view is vertical too; the frame's shape is the camera's if it has one.
                aspect = p.aspect_ratio.filter(|a| (0.01..=100.0).contains(a));
                if !(p.yfov > 1e-4 && p.yfov < std::f32::consts::PI) {
                    return Err(Failure::new(place, format!("a yfov of {} radians; allowed are 0 to pi", p.yfov)));
                }
                Projection::Perspective { fov_y: p.yfov }
            }
            (Checked::Valid(CameraType::Orthographic), _, Some(o)) => {
                let height = 2.0 * o.ymag.abs();
                if !(height > 0.0 && height.is_finite()) {
                    return Err(Failure::new(place, format!("a ymag of {}", o.ymag)));
                }
                Projection::Orthographic { height }
            }
            _ => {
                return Err(Failure::new(place, "is neither perspective nor orthographic"));
            }
        };
        let (forward, up) = (-world.matrix3.z_axis, world.matrix3.y_axis);
        if forward.cross(up).length() <= 1e-9 * forward.length() * up.length() || !world.is_finite() {
            return Err(Failure::new(place, "its node has no direction"));
        }
        let eye = world.translation;
        // Far enough away that rounding does not bend the direction.
        let reach = eye.abs().max_element().max(1.0);
        let camera = Camera {
            eye: eye.as_vec3(),
            target: (eye + forward / forward.length() * reach).as_vec3(),
            up: (up / up.length()).as_vec3(),
            projection,
            lens: None,
            shift: Vec2::ZERO,
            mirrored: false,
        };
        let named = NamedCamera { name, camera, aspect };
        if !self.scene.has_camera {
            (self.scene.camera, self.scene.has_camera) = (camera, true);
            self.scene.film.width = named.width_of(&self.scene.film);
        }
        self.scene.cameras.push(named);
        Ok(())
    }

    /// KHR_lights_punctual: photometric units, over 683 lumens per watt.
    fn add_light(&mut self, index: usize, name: &str, world: DAffine3, place: &str) -> Result<(), Failure> {
        let lights = self.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let lights = lights.map_or(&[][..], |l| &l.lights);
        let Some(light) = lights.get(index) else {
            let message = format!("refers to light {index}; there are {}", lights.len());
            return Err(Failure::new(place, message));
        };
        let position = world.translation.as_vec3();
        let forward = -world.matrix3.z_axis;
        let direction = (forward / forward.length()).as_vec3();
        let direction = if direction.is_finite() { direction } else { Vec3::NEG_Z };
        let Checked::Valid(kind) = light.type_ else {
            let message = "unknown type; allowed are directional, point, spot";
            return Err(Failure::new(format!("lights[{index}]"), message));
        };
        let (kind, attenuation) = match kind {
            LightType::Directional => (LightKind::Directional { direction }, Attenuation::None),
            LightType::Point => (LightKind::Point { position }, Attenuation::InverseSquare),
            LightType::Spot => {
                let spot = light.spot.clone().unwrap_or_default();
                let outer = spot.outer_cone_angle.clamp(1e-3, std::f32::consts::FRAC_PI_2);
                let inner = spot.inner_cone_angle.clamp(0.0, outer);
                (LightKind::Spot { position, direction, inner, outer, exponent: 0.0 }, Attenuation::InverseSquare)
            }
        };
        let radiometric = f64::from(light.intensity) / LUMENS_PER_WATT;
        let channel = |c: f32| {
            let v = f64::from(c) * radiometric;
            if v > 0.0 { v.min(1e12) as f32 } else { 0.0 }
        };
        self.scene.lights.push(Light {
            name: light.name.clone().unwrap_or_else(|| name.to_owned()),
            kind,
            intensity: Rgb::from_array(light.color.map(channel)),
            unit: IntensityUnit::Radiometric,
            attenuation,
            flaps: Flaps::NONE,
            casts_shadow: true,
            slide: None,
        });
        Ok(())
    }
}
