//! OBJ, MTL, PLY and STL as programs write them.

mod dialects;
mod materials;
mod ply;
mod polygons;
mod stl;
mod support;
mod surfaces;
