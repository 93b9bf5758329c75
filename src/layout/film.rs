//! What the device keeps for the film.

use bytemuck::{Pod, Zeroable};

/// Four signed 64-bit fixed-point sums (r, g, b, alpha), each as two u32 (low, high) in two's complement. 32 bytes.
/// Kept once per sample slot of a batch and once per pixel of the crop.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct FilmSum {
    pub low: [u32; 4],
    pub high: [u32; 4],
}

/// Binary digits after the point of a film's sums.
pub const FRACTION_BITS: u32 = 22;

/// Auxiliary values of one pixel. 80 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AovPixel {
    /// Sums of the first hit's shading normal (world) in lanes 0-2; lane 3 unused. Scale 2^22.
    pub normal: FilmSum,
    /// Sums of the first hit's albedo in lanes 0-2; lane 3 unused. Scale 2^22.
    pub albedo: FilmSum,
    /// From sample 0: distance along the camera ray (`T_INFINITE` on a miss), object, material (`INVALID` on a miss).
    pub depth: f32,
    pub object: u32,
    pub material: u32,
    pub _pad0: u32,
}
