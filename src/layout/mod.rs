//! Every record that crosses the bus between host and device.
//!
//! Each file has a twin of the same name in `shaders/layout/`, with the same
//! struct and member names in the same order (GLSL `scalar` layout). The test
//! `tests/layout.rs` reflects the compiled SPIR-V and proves offsets, strides
//! and names equal. Rules: `#[repr(C)]`, `Pod` derived (it rejects hidden
//! padding), sizes in whole 16-byte words, no `bool`, `usize`, `Vec3A` or enum.
//! Padding members are named `_pad*` here and `pad*` in GLSL.

pub mod camera;
pub mod control;
pub mod emitter;
pub mod film;
pub mod geometry;
pub mod header;
pub mod light;
pub mod material;
pub mod path;
pub mod texture;

pub use camera::*;
pub use control::*;
pub use emitter::*;
pub use film::*;
pub use geometry::*;
pub use header::*;
pub use light::*;
pub use material::*;
pub use path::*;
pub use texture::*;

/// "None" wherever a record holds an index.
pub const INVALID: u32 = 0xffff_ffff;

/// The baked scene as the twins see it: one slice per array. In GLSL these are the `load_*` functions.
#[derive(Clone, Copy, Debug)]
pub struct SceneView<'a> {
    pub header: &'a SceneHeader,
    pub nodes: &'a [Node],
    pub triangles: &'a [Triangle],
    pub instances: &'a [Instance],
    pub top_instances: &'a [u32],
    pub faces: &'a [Face],
    pub vertices: &'a [Vertex],
    pub materials: &'a [Material],
    pub lights: &'a [Light],
    pub emitters: &'a [Emitter],
    pub environments: &'a [EnvironmentMap],
    pub textures: &'a [Texture],
    pub texels: &'a [u32],
    pub tables: &'a [f32],
}

impl<'a> SceneView<'a> {
    /// A scene of nothing but `tables`, for models that look something up.
    pub fn of_tables(header: &'a SceneHeader, tables: &'a [f32]) -> Self {
        Self {
            header,
            nodes: &[],
            triangles: &[],
            instances: &[],
            top_instances: &[],
            faces: &[],
            vertices: &[],
            materials: &[],
            lights: &[],
            emitters: &[],
            environments: &[],
            textures: &[],
            texels: &[],
            tables,
        }
    }
}

// The Rust side of the GLSL `load_*` functions, so that twins read alike.
macro_rules! loads {
    ($($name:ident: $array:ident -> $record:ty;)*) => {$(
        #[inline(always)]
        pub fn $name(scene: &SceneView, index: u32) -> $record {
            scene.$array[index as usize]
        }
    )*};
}

loads! {
    load_node: nodes -> Node;
    load_triangle: triangles -> Triangle;
    load_instance: instances -> Instance;
    load_top_instance: top_instances -> u32;
    load_face: faces -> Face;
    load_vertex: vertices -> Vertex;
    load_material: materials -> Material;
    load_light: lights -> Light;
    load_emitter: emitters -> Emitter;
    load_environment_map: environments -> EnvironmentMap;
    load_texture: textures -> Texture;
    load_texel: texels -> u32;
    load_table: tables -> f32;
}
