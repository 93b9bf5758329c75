//! The camera.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

pub const CAMERA_PERSPECTIVE: u32 = 0;
pub const CAMERA_ORTHOGRAPHIC: u32 = 1;

/// The camera. 80 bytes. A film point (x, y) in pixels of the full frame has
/// s = x * scale_x - 1 (left to right) and t = 1 - y * scale_y (bottom to top), both in -1..1.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Camera {
    pub eye: Vec3,
    /// `CAMERA_*`.
    pub kind: u32,
    /// From the centre of the image plane to its right edge (perspective: plane at distance 1 along `forward`).
    pub right: Vec3,
    /// 2 / width of the full frame.
    pub scale_x: f32,
    /// From the centre of the image plane to its upper edge.
    pub up: Vec3,
    /// 2 / height of the full frame.
    pub scale_y: f32,
    /// Unit viewing direction.
    pub forward: Vec3,
    /// Height of a pixel, world units: on the plane at distance 1 (perspective), anywhere (orthographic).
    pub pixel_size: f32,
    /// The thin lens, world units: its radius, 0 for a pinhole, and how far along `forward` it shows things sharp.
    pub lens_radius: f32,
    pub focus_distance: f32,
    /// Added to s and t: what is seen lies off the middle of a larger picture.
    pub shift_x: f32,
    pub shift_y: f32,
}
