//! OBJ, MTL, PLY and STL as programs write them.

mod dialects;
mod materials;
mod ply;
mod polygons;
mod support;
mod surfaces;
