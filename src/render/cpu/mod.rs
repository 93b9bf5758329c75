//! The reference backend: rayon over tiles.
