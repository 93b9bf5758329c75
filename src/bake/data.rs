//! The baked scene: flat arrays, ready to upload or to trace.

use crate::layout::{Face, Instance, Light, Material, Node, SceneHeader, SceneView, Texture, Triangle, Vertex};

/// Everything a backend needs. Indices inside are absolute and valid.
#[derive(Clone, Debug, Default)]
pub struct SceneData {
    /// `first_*` members of the header are offsets into the heap that `heap_layout` describes.
    pub header: SceneHeader,
    /// Top-level and mesh BVHs, one after the other.
    pub nodes: Vec<Node>,
    /// In traversal order.
    pub triangles: Vec<Triangle>,
    pub instances: Vec<Instance>,
    /// Instance of each primitive of the top-level BVH.
    pub top_instances: Vec<u32>,
    pub faces: Vec<Face>,
    pub vertices: Vec<Vertex>,
    pub materials: Vec<Material>,
    pub lights: Vec<Light>,
    pub textures: Vec<Texture>,
    /// 32-bit words of all images.
    pub texels: Vec<u32>,
    /// Filter tables, the sRGB decoding table (256 floats, first) and the like.
    pub tables: Vec<f32>,
    /// Entries the traversal stack needs in the worst case (top level + deepest mesh).
    pub stack_depth: u32,
    /// Dropped primitives and the like; printed once.
    pub warnings: Vec<String>,
}

impl SceneData {
    /// The arrays as the twins take them.
    pub fn view(&self) -> SceneView<'_> {
        SceneView {
            header: &self.header,
            nodes: &self.nodes,
            triangles: &self.triangles,
            instances: &self.instances,
            top_instances: &self.top_instances,
            faces: &self.faces,
            vertices: &self.vertices,
            materials: &self.materials,
            lights: &self.lights,
            textures: &self.textures,
            texels: &self.texels,
            tables: &self.tables,
        }
    }
}
