//! The baked scene: flat arrays, ready to upload or to trace.

use super::BakeError;
use super::shapes::Shapes;
use crate::layout::{
    Emitter, EnvironmentMap, INTEGRATOR_WHITTED, Instance, Light, Material, PARAMETER_MASK, PARAMETER_OPACITY,
    SceneHeader, SceneView, Texture,
};
use crate::shading::material::is_refracting;
use serde::{Deserialize, Serialize};
use std::ops::Deref;
use std::sync::Arc;

/// One array of the data heap, as it is uploaded.
#[derive(Clone, Copy, Debug)]
pub struct HeapPiece<'a> {
    /// Where it begins, in 16-byte words of the heap.
    pub first_word: u32,
    /// Its records; the last word is not always full.
    pub bytes: &'a [u8],
}

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
    /// Bake's last step. Whoever else calls it answers for the indices: tests make scenes that no bake makes.
    fn from(arrays: SceneArrays) -> Self {
        Self(arrays)
    }
}

impl SceneData {
    /// A copy with something changed, for tests.
    #[must_use]
    pub fn altered(&self, change: impl FnOnce(&mut SceneArrays)) -> Self {
        let mut arrays = self.0.clone();
        change(&mut arrays);
        Self(arrays)
    }
}

/// What a baked scene consists of. Indices inside are absolute and valid.
#[derive(Clone, Debug, Default)]
pub struct SceneArrays {
    /// `first_*` members of the header are offsets into the heap that `heap_pieces` describes.
    pub header: SceneHeader,
    /// Hierarchies, triangles, faces and vertices; scenes with the same shapes share them.
    pub shapes: Arc<Shapes>,
    pub instances: Vec<Instance>,
    pub materials: Vec<Material>,
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

    /// Whether more than one ray may go on from where one ends: in Whitted's model, behind glass and panes.
    pub fn branches(&self) -> bool {
        let whitted = self.header.integrator == INTEGRATOR_WHITTED;
        whitted && (self.has_panes() || self.materials.iter().any(is_refracting))
    }

    /// The arrays as the twins take them.
    pub fn view(&self) -> SceneView<'_> {
        SceneView {
            header: &self.header,
            nodes: &self.shapes.nodes,
            triangles: &self.shapes.triangles,
            instances: &self.instances,
            top_instances: &self.shapes.top_instances,
            faces: &self.shapes.faces,
            vertices: &self.shapes.vertices,
            materials: &self.materials,
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
        let mut header = self.header;
        (header.top_root, header.aovs) = (0, 0);
        let first = [
            &mut header.first_instance,
            &mut header.first_top_instance,
            &mut header.first_face,
            &mut header.first_vertex,
            &mut header.first_material,
            &mut header.first_light,
            &mut header.first_texture,
            &mut header.first_texel,
            &mut header.first_table,
            &mut header.first_emitter,
            &mut header.first_environment_map,
        ];
        first.into_iter().for_each(|offset| *offset = 0);
        let instances: Vec<Instance> =
            self.instances.iter().map(|instance| Instance { root: 0, ..*instance }).collect();
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"gonio scene 1");
        // Of the heap, all but the instances, which name their roots, and the order of the top level.
        let [_, _, rest @ ..] = self.heap_arrays();
        let placed = [bytemuck::bytes_of(&header), bytemuck::cast_slice(&instances)];
        for bytes in placed.into_iter().chain(rest) {
            hasher.update(&(bytes.len() as u64).to_le_bytes());
            hasher.update(bytes);
        }
        *hasher.finalize().as_bytes()
    }

    /// The data heap: all arrays but nodes and triangles, one after the other, each from a whole 16-byte word on. Four
    /// top-level instances, texels or table entries share a word. `first_*` of the header are these `first_word`s.
    pub fn heap_pieces(&self) -> [HeapPiece<'_>; 11] {
        let mut next = 0;
        self.heap_arrays().map(|bytes| {
            let piece = HeapPiece { first_word: next, bytes };
            next += bytes.len().div_ceil(16) as u32;
            piece
        })
    }

    /// Size of the data heap in 16-byte words.
    pub fn heap_words(&self) -> u64 {
        self.heap_arrays().iter().map(|bytes| bytes.len().div_ceil(16) as u64).sum()
    }

    /// Writes the places of the heap's arrays into the header.
    pub(super) fn place_heap(&mut self) -> Result<(), BakeError> {
        if self.heap_words() > u64::from(u32::MAX) {
            return Err(BakeError::TooLarge { what: "words of data", count: self.heap_words() });
        }
        let first = self.heap_pieces().map(|piece| piece.first_word);
        let h = &mut self.header;
        [
            h.first_instance,
            h.first_top_instance,
            h.first_face,
            h.first_vertex,
            h.first_material,
            h.first_light,
            h.first_texture,
            h.first_texel,
            h.first_table,
            h.first_emitter,
            h.first_environment_map,
        ] = first;
        Ok(())
    }

    fn heap_arrays(&self) -> [&[u8]; 11] {
        [
            bytemuck::cast_slice(&self.instances),
            bytemuck::cast_slice(&self.shapes.top_instances),
            bytemuck::cast_slice(&self.shapes.faces),
            bytemuck::cast_slice(&self.shapes.vertices),
            bytemuck::cast_slice(&self.materials),
            bytemuck::cast_slice(&self.lights),
            bytemuck::cast_slice(&self.textures),
            bytemuck::cast_slice(&self.texels),
            bytemuck::cast_slice(&self.tables),
            bytemuck::cast_slice(&self.emitters),
            bytemuck::cast_slice(&self.environments),
        ]
    }
}
