mod bounds;
pub mod gltf;
pub mod image;
mod meter;
pub mod ply;
mod polygon;
pub mod staging;
