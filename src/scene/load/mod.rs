mod bounds;
pub mod image;
pub mod ply;
mod polygon;
pub mod staging;
