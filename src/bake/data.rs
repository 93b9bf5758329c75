//! The baked scene: flat arrays, ready to upload or to trace.

use super::BakeError;
use super::shapes::Shapes;
use crate::layout::{
    EMITTER_TEXTURED, Emitter, EnvironmentMap, Features, HeapStarts, INSTANCE_FLAT, INSTANCE_GOURAUD,
    INSTANCE_NO_SHADOW, INTEGRATOR_WHITTED, Instance, KIND_SPHERE, Light, Material, PARAMETER_MASK, PARAMETER_OPACITY,
    SHADOWS_FILTERED, SHADOWS_OPAQUE, SceneHeader, SceneView, T_INFINITE, Texture,
};
use crate::shading::material::is_refracting;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::ops::Deref;
use std::sync::Arc;

/// Everything a backend needs, finished: nothing of it changes any more.
#[derive(Clone, Debug, Default)]
pub struct SceneData(SceneArrays);

impl Deref for SceneData {
    type Target = SceneArrays;

    fn deref(&self) -> &SceneArrays {
        &self.0
    }
}

impl From<SceneArrays> for SceneData {
    /// Bake's last step: what the arrays use becomes the scene's features. Whoever else calls it answers for the indices: tests
    /// make scenes that no bake makes.
    fn from(mut arrays: SceneArrays) -> Self {
        arrays.features = arrays.used_features();
        Self(arrays)
    }
}

impl SceneData {
    /// A copy with something changed, for tests.
    #[must_use]
    pub fn altered(&self, change: impl FnOnce(&mut SceneArrays)) -> Self {
        let mut arrays = self.0.clone();
        change(&mut arrays);
        Self::from(arrays)
    }
}

/// What a baked scene consists of. Indices inside are absolute and valid.
#[derive(Clone, Debug, Default)]
pub struct SceneArrays {
    pub header: SceneHeader,
    /// What the scene's settings choose is chosen from the start; the rest is what the finished arrays use.
    pub features: Features,
    /// Hierarchies, triangles, faces and vertices; scenes with the same shapes share them.
    pub shapes: Arc<Shapes>,
    pub instances: Vec<Instance>,
    pub materials: Vec<Material>,
    /// Blocks of the materials' models.
    pub parameters: Vec<[u32; 4]>,
    pub lights: Vec<Light>,
    /// What `path` samples; empty for the other integrators.
    pub emitters: Vec<Emitter>,
    /// The image around the scene, or nothing.
    pub environments: Vec<EnvironmentMap>,
    pub textures: Vec<Texture>,
    /// 32-bit words of all images.
    pub texels: Vec<u32>,
    /// Filter tables, the sRGB decoding table (256 floats, first) and the like.
    pub tables: Vec<f32>,
    /// Dropped primitives and the like; printed once.
    pub warnings: Vec<String>,
    /// What baking took.
    pub times: BakeTimes,
}

/// Seconds by stage of baking. Meshes are baked side by side: their stages add up the seconds of all threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BakeTimes {
    /// Materials, lights, textures, tables.
    pub materials_s: f64,
    /// Faces, vertices and boxes of the meshes.
    pub geometry_s: f64,
    /// Binary hierarchies of the meshes.
    pub binary_s: f64,
    /// Their conversion to eight-wide ones.
    pub wide_s: f64,
    /// Instances, and the top level over them.
    pub top_s: f64,
    /// Nodes and triangles laid out as the traversal reads them.
    pub pack_s: f64,
    /// Everything, on the clock.
    pub whole_s: f64,
}

impl SceneArrays {
    /// Whether light goes straight on through something: by its material, or by holes that a texture cuts.
    pub fn has_panes(&self) -> bool {
        let cuts = |texture: &Texture| matches!(texture.parameter, PARAMETER_OPACITY | PARAMETER_MASK);
        self.textures.iter().any(cuts) || self.materials.iter().any(|material| material.k_t > 0.0)
    }

    /// The features with all that the arrays decide.
    fn used_features(&self) -> Features {
        let facets = INSTANCE_FLAT | INSTANCE_GOURAUD;
        let has_shadowless = self.instances.iter().any(|instance| instance.flags & INSTANCE_NO_SHADOW != 0);
        let shadows = match self.features.shadows {
            SHADOWS_FILTERED if !self.has_panes() => SHADOWS_OPAQUE,
            chosen => chosen,
        };
        let open =
            |light: &Light| light.flaps_min.max_element() <= -T_INFINITE && light.flaps_max.min_element() >= T_INFINITE;
        let bits = |kinds: &mut dyn Iterator<Item = u32>| kinds.fold(0, |mask, kind| mask | 1 << kind);
        Features {
            shadows,
            models: bits(&mut self.materials.iter().map(|material| material.model)),
            emitters: bits(&mut self.emitters.iter().map(|emitter| emitter.kind)),
            formats: bits(&mut self.textures.iter().map(|texture| texture.format)),
            has_spheres: self.instances.iter().any(|instance| instance.kind == KIND_SPHERE),
            is_one_instance: self.instances.len() == 1,
            has_facets: self.instances.iter().any(|instance| instance.flags & facets != 0),
            has_textures: self.materials.iter().any(|material| material.texture_count > 0),
            has_textured_emitters: self.emitters.iter().any(|emitter| emitter.flags & EMITTER_TEXTURED != 0),
            has_environment_map: !self.environments.is_empty(),
            has_panes: self.has_panes(),
            has_absorption: self.materials.iter().any(|material| material.absorption != Vec3::ZERO),
            has_lens: self.header.camera.lens_radius > 0.0,
            has_flaps: !self.lights.iter().all(open),
            has_slides: self.lights.iter().any(|light| light.slide != 0),
            has_shadowless,
            has_passing: has_shadowless || shadows == SHADOWS_FILTERED,
            has_clamp: self.header.clamp > 0.0,
            ..self.features
        }
    }

    /// Whether more than one ray may go on from where one ends: in Whitted's model, behind glass and panes.
    pub fn branches(&self) -> bool {
        let whitted = self.features.integrator == INTEGRATOR_WHITTED;
        whitted && (self.has_panes() || self.materials.iter().any(|material| is_refracting(material.model)))
    }

    /// The arrays as the twins take them.
    pub fn view(&self) -> SceneView<'_> {
        SceneView {
            header: &self.header,
            features: &self.features,
            nodes: &self.shapes.nodes,
            triangles: &self.shapes.triangles,
            instances: &self.instances,
            top_instances: &self.shapes.top_instances,
            faces: &self.shapes.faces,
            vertices: &self.shapes.vertices,
            materials: &self.materials,
            parameters: &self.parameters,
            lights: &self.lights,
            emitters: &self.emitters,
            environments: &self.environments,
            textures: &self.textures,
            texels: &self.texels,
            tables: &self.tables,
        }
    }

    /// BLAKE3 of everything that reaches a sample. The shape of the BVH, the order of its triangles, where arrays lie in the
    /// heap and whether auxiliary values are kept do not, and are left out; so is nothing else.
    pub fn digest(&self) -> [u8; 32] {
        let header = SceneHeader { top_root: 0, first: HeapStarts::default(), ..self.header };
        let features = Features { has_aovs: false, ..self.features }.constants().map(|(_, value)| value);
        let instances: Vec<Instance> =
            self.instances.iter().map(|instance| Instance { root: 0, ..*instance }).collect();
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"gonio scene 2");
        // Of the heap, all but the instances, which name their roots, and the order of the top level.
        let view = SceneView { instances: &instances, top_instances: &[], ..self.view() };
        let placed = [bytemuck::bytes_of(&header), bytemuck::cast_slice(&features)];
        for bytes in placed.into_iter().chain(view.heap()) {
            hasher.update(&(bytes.len() as u64).to_le_bytes());
            hasher.update(bytes);
        }
        *hasher.finalize().as_bytes()
    }

    /// Size of the data heap in 16-byte words. Each array begins with a whole word; four top-level instances, texels or table
    /// entries share one.
    pub fn heap_words(&self) -> u64 {
        self.view().heap().iter().map(|bytes| bytes.len().div_ceil(16) as u64).sum()
    }

    /// Writes the places of the heap's arrays into the header.
    pub(super) fn place_heap(&mut self) -> Result<(), BakeError> {
        if self.heap_words() > u64::from(u32::MAX) {
            return Err(BakeError::TooLarge { what: "words of data", count: self.heap_words() });
        }
        let mut next = 0;
        self.header.first = HeapStarts::from(self.view().heap().map(|bytes| {
            let first = next;
            next += bytes.len().div_ceil(16) as u32;
            first
        }));
        Ok(())
    }
}
