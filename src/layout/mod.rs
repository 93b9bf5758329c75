//! Every record that crosses the bus between host and device.
//!
//! They are declared here and nowhere else: `build.rs` reads these files and writes the structs and constants of
//! the shaders (`layout/records.glsl`), their specialisation constants (`layout/features.glsl`,
//! `layout/variant.glsl`) and the functions that load and store records by the 16-byte word (`layout/fetch.glsl`).
//! `tests/layout.rs` reflects the compiled SPIR-V and proves offsets, strides and names equal, and sends every
//! record through a device.
//!
//! Rules: `#[repr(C)]`, `Pod` derived (it rejects hidden padding), members of `u32`, `f32`, vectors, other records
//! and arrays of them; no `bool`, `usize`, `Vec3A` or enum. Records that kernels load are whole 16-byte words.
//! Padding is named `_pad*` here and `pad*` in GLSL. A constant is a number. A member that says "Kept if" a feature
//! is neither loaded nor stored in scenes without the feature.

pub mod bindings;
pub mod camera;
pub mod control;
pub mod emitter;
pub mod features;
pub mod film;
pub mod geometry;
pub mod header;
pub mod light;
pub mod material;
pub mod model;
pub mod path;
pub mod texture;

pub use bindings::*;
pub use camera::*;
pub use control::*;
pub use emitter::*;
pub use features::*;
pub use film::*;
pub use geometry::*;
pub use header::*;
pub use light::*;
pub use material::*;
pub use model::*;
pub use path::*;
pub use texture::*;

/// "None" wherever a record holds an index.
pub const INVALID: u32 = 0xffff_ffff;

/// The baked scene as the twins see it: one slice per array. In GLSL these are the `load_*` functions.
#[derive(Clone, Copy, Debug)]
pub struct SceneView<'a> {
    pub header: &'a SceneHeader,
    pub features: &'a Features,
    pub nodes: &'a [Node],
    pub triangles: &'a [Triangle],
    pub instances: &'a [Instance],
    pub top_instances: &'a [u32],
    pub faces: &'a [Face],
    pub vertices: &'a [Vertex],
    pub materials: &'a [Material],
    /// Blocks of the materials' models (`layout/model`).
    pub parameters: &'a [[u32; 4]],
    pub lights: &'a [Light],
    pub emitters: &'a [Emitter],
    pub environments: &'a [EnvironmentMap],
    pub textures: &'a [Texture],
    pub texels: &'a [u32],
    pub tables: &'a [f32],
}

impl<'a> SceneView<'a> {
    /// A scene of nothing but `tables`, for models that look something up.
    pub fn of_tables(header: &'a SceneHeader, features: &'a Features, tables: &'a [f32]) -> Self {
        Self {
            header,
            features,
            nodes: &[],
            triangles: &[],
            instances: &[],
            top_instances: &[],
            faces: &[],
            vertices: &[],
            materials: &[],
            parameters: &[],
            lights: &[],
            emitters: &[],
            environments: &[],
            textures: &[],
            texels: &[],
            tables,
        }
    }
}

/// A record as Rust lays it out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordLayout {
    pub name: &'static str,
    /// Bytes.
    pub size: usize,
    /// The array of the scene that holds such records.
    pub array: Option<&'static str>,
    pub members: &'static [MemberLayout],
}

/// A member of a record: its name and type as GLSL has them, and its first byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemberLayout {
    pub name: &'static str,
    pub offset: usize,
    pub kind: &'static str,
}

// The Rust side of what `build.rs` writes: `load_*`, the data heap, numbers of specialisation constants, all records.
include!(concat!(env!("OUT_DIR"), "/layout.rs"));
