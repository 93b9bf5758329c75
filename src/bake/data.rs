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

    /// BLAKE3 of everything that reaches a sample. The shape of the BVH, the order of its triangles and where arrays
    /// lie in the heap do not, and are left out; so is nothing else.
    pub fn digest(&self) -> [u8; 32] {
        let mut header = self.header;
        header.top_root = 0;
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
        ];
        first.into_iter().for_each(|offset| *offset = 0);
        let instances: Vec<Instance> = self.instances.iter().map(|instance| Instance { root: 0, ..*instance }).collect();
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"gonio scene 1");
        for bytes in [
            bytemuck::bytes_of(&header),
            bytemuck::cast_slice(&instances),
            bytemuck::cast_slice(&self.faces),
            bytemuck::cast_slice(&self.vertices),
            bytemuck::cast_slice(&self.materials),
            bytemuck::cast_slice(&self.lights),
            bytemuck::cast_slice(&self.textures),
            bytemuck::cast_slice(&self.texels),
            bytemuck::cast_slice(&self.tables),
        ] {
            hasher.update(&(bytes.len() as u64).to_le_bytes());
            hasher.update(bytes);
        }
        *hasher.finalize().as_bytes()
    }
}
