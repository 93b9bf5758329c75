//! What was written: a scene as its author described it, in SI units and radians,
//! before anything is flattened for the device. Knows nothing of devices, files' syntax
//! lives in `load/`.

pub mod camera;
pub mod error;
pub mod light;
pub mod load;
pub mod material;
pub mod mesh;
pub mod settings;
pub mod shape;
pub mod table;
pub mod texture;
pub mod transform;

pub use camera::{Camera, Lens, NamedCamera, Projection};
pub use error::{Location, SceneError};
pub use light::{Attenuation, Flaps, IntensityUnit, Light, LightKind, Slide};
pub use material::{
    Channel, Distribution, Fresnel, Lobe, Masking, Material, Model, Parameter, Principled, TextureBinding,
    Transparency, WardNormalisation,
};
pub use mesh::Mesh;
pub use settings::{
    Background, Environment, Film, Filter, Integrator, RenderSettings, Sampler, Shading, Shadows, ToneMap, Window,
};
pub use table::{DirectionalTable, Table};
pub use texture::{Pattern, PatternKind, Texture, TextureData, Wrap};
pub use transform::{OUT_OF_LIMITS, Transform, WORLD_LIMIT};

use glam::Vec3;

/// Index into `Scene::materials`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);
/// Index into `Scene::textures`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u32);
/// Index into `Scene::tables`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TableId(pub u32);
/// Index into `Scene::meshes`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshId(pub u32);

/// Linear Rec. 709.
pub type Rgb = Vec3;

/// A whole scene. Indices in it are valid once `load` has returned it.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The file it came from, for messages.
    pub name: String,
    pub film: Film,
    pub settings: RenderSettings,
    pub camera: Camera,
    /// Whether the file has a camera: if not, `camera` means nothing until the scene is staged.
    pub has_camera: bool,
    /// All cameras of a file that may have several, in its order.
    pub cameras: Vec<NamedCamera>,
    pub background: Background,
    /// I_a.
    pub ambient: Rgb,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub tables: Vec<Table>,
    pub meshes: Vec<Mesh>,
    pub objects: Vec<Object>,
    pub lights: Vec<Light>,
    /// Whether the film's exposure is still to be measured; what it says until then means nothing.
    pub metered: bool,
    /// What loading chose where the user might have chosen otherwise; printed once, and no warning.
    pub notes: Vec<String>,
    /// What loading dropped, replaced or ignored; printed once.
    pub warnings: Vec<String>,
}

/// What an object shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Geometry {
    Mesh(MeshId),
    /// The analytic unit sphere at the origin, placed by the object's transform.
    Sphere,
}

/// One placed thing. Several objects may share a mesh: they are instances.
#[derive(Clone, Debug)]
pub struct Object {
    pub name: String,
    pub geometry: Geometry,
    pub transform: Transform,
    /// Overrides the mesh's own materials; a sphere always has one.
    pub material: Option<MaterialId>,
    /// Overrides the material's own answer.
    pub casts_shadow: Option<bool>,
    /// Overrides the scene's.
    pub shading: Option<Shading>,
}
