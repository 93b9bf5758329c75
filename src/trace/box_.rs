//! Boxes: the strict interval that bounds every accepted hit, and the approximate node test that never loses one.
//!
//! The picture must not depend on the shape of the hierarchy, so boxes choose what is visited, never what is hit:
//!
//! * `box_interval` is strict. A primitive's hit counts only at a t inside the interval of the primitive's own box
//!   (grown by the slack below), which holds for every honest hit and forbids those that rounding invents far from a
//!   triangle seen edge-on.
//! * `approx_intersect_node` may round differently on every device, so its boxes are widened by more than all the
//!   rounding between the two. Whatever is accepted lies in a box that is visited.
//!
//! # The bound
//!
//! u = 2^-24; d the direction; o the origin; R = `root_reach`: max over axes of |p - o| + 255 step at the root of the mesh
//! (for a sphere: max |o| + 1), so that no point of the mesh is farther from the origin, on any axis; S = |d| / |d.kz| <= 1.
//!
//! 1. Triangle. A corner's sheared coordinate is fl(fl(v - o) - fl(S fl(v - o).kz)): off by at most 3 u R.
//!    The sign of an edge function is never wrong, because rounding is monotone (it may become 0), so the triangle
//!    that contains the ray in computed coordinates is accepted. Its point above the ray is the corners' weighted mean:
//!    inside the box, and off the ray per axis by that error. S is fl(d rcp(d.kz)) and the slabs use rcp(d), each
//!    within 2.3 u: 3.3 u R more; the slab's subtraction and product: 2 u R; the mean and its t: 5 u R. Sum: 13.3 u R.
//! 2. Sphere. The closest point to the centre is off by 17 u R (`sphere`); with the slabs 22 u R.
//! 3. So a slack of 16 u R covers a triangle, twice that a sphere. With R instead of each triangle's own distance it is
//!    the same for all of a mesh.
//! 4. Node, same level. Its planes contain the box (bake proves it in f64), and every node has |p - o| <= R and
//!    255 step <= 2 R, since a grid is less than twice as large as its box. To the slack of 16 u R comes the rounding of
//!    the slabs, 4 u R, and the node's own (two differences, two products, one sum), 6 u 3 R: 38 u R. Three slacks, 48 u R,
//!    are enough: `NODE_SLACKS`.
//! 5. Node of the top level. An object-space hit is off in object space by the transform's rounding,
//!    8 u (|O||o| + |O.w|) for the origin and direction and 8 u |O||x - o| for to_object being rounded itself, and by the
//!    slack in object space, at most 32 u |O||x - o| + 48 u extents, for a sphere 32 u (|O||x - o| + extents). In world
//!    units, with kappa = the largest row sum of |W||O|: relative 48 kappa u R + 22 u R, so `top_margin` = 128 kappa u;
//!    and an absolute part that bake adds to the box.

use super::ray::{LevelRay, lanes};
use crate::layout::Node;
use crate::shading::math::{max_, min_};
use glam::{Vec2, Vec3};
#[cfg(target_arch = "x86_64")]
use pulp::x86::V3;
#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::_CMP_NGT_UQ;
use wide::{f32x4, f32x8, i16x8, i32x8, u8x16};

/// 16 u: the slack in units of the reach (the bound, step 3).
pub const SLACK: f32 = 9.536743e-7;
/// 32 u: that of a sphere.
pub const SPHERE_SLACK: f32 = 1.9073486e-6;
/// Slacks by which the boxes of a mesh's nodes are wider (the bound, step 4).
pub const NODE_SLACKS: f32 = 3.0;

/// The sizes of a node's grid steps.
#[inline(always)]
fn node_steps(exponents: u32) -> Vec3 {
    Vec3::new(
        f32::from_bits((exponents & 255) << 23),
        f32::from_bits(((exponents >> 8) & 255) << 23),
        f32::from_bits(((exponents >> 16) & 255) << 23),
    )
}

/// How far from the ray's origin something below `root` is at most, on any axis: the bound's R.
#[inline(always)]
pub fn root_reach(root: &Node, ray: &LevelRay) -> f32 {
    let size = node_steps(root.exponents_imask) * 255.0;
    let x = (root.origin.x - ray.origin.x).abs() + size.x;
    let y = (root.origin.y - ray.origin.y).abs() + size.y;
    let z = (root.origin.z - ray.origin.z).abs() + size.z;
    max_(max_(x, y), z)
}

/// An extent along each axis in units of t: by how much sooner and later a ray is in a box grown by it.
#[inline(always)]
pub fn axis_slack(ray: &LevelRay, extent: f32) -> Vec3 {
    ray.inverse.abs() * extent
}

/// The t at which the ray enters and leaves a box, in (near, far) order; near > far: it does not meet it.
/// `low`, `high`: corners minus the ray's origin, finite. `slack`: `axis_slack` of what the box is grown by.
#[inline(always)]
pub fn box_interval(ray: &LevelRay, slack: Vec3, low: f32x4, high: f32x4) -> Vec2 {
    // All axes at a time. A minimum of zeros of both signs may have either, but the slack makes it something else.
    let inverse = lanes(ray.inverse);
    let t0 = low * inverse;
    let t1 = high * inverse;
    let [near_x, near_y, near_z, _] = (t0.fast_min(t1) - lanes(slack)).to_array();
    let [far_x, far_y, far_z, _] = (t0.fast_max(t1) + lanes(slack)).to_array();
    Vec2::new(max_(max_(near_x, near_y), near_z), min_(min_(far_x, far_y), far_z))
}

/// For each octant and set of inner children, by slot, the same set by priority: slot xor octant (Ylitie et al. 2017,
/// section 3.3). Rust only: devices shift the bits into place one by one.
const PRIORITIES: [[u8; 256]; 8] = {
    let mut table = [[0; 256]; 8];
    let mut at = 0;
    while at < 8 * 256 * 8 {
        let (octant, slots, slot) = (at >> 11, (at >> 3) & 255, at & 7);
        table[octant][slots] |= ((slots >> slot & 1) << (slot ^ octant)) as u8;
        at += 1;
    }
    table
};

/// A node's eight children along a ray. On axis k it enters child i at t = `near[k][i]` `scale[k]` + `low[k]` and leaves it at
/// `far[k][i]` `scale[k]` + `high[k]`; planes are bytes, child 0 in the lowest. Rust only.
pub struct Slabs<'a> {
    near: [&'a [u32; 2]; 3],
    far: [&'a [u32; 2]; 3],
    scale: [f32; 4],
    low: [f32; 4],
    high: [f32; 4],
    meta: &'a [u32; 2],
}

/// What tests eight children at once: the registers that a machine has. Rust only.
pub trait Eight: Copy {
    /// `node_steps`; the fourth lane is for nothing.
    fn steps(self, exponents: u32) -> f32x4;

    /// One bit a child: whether the ray may be in it at a t from 0 to `t_max`; and the bits that those children set (`meta`),
    /// of which the lower 24 stand for primitives. Written as "unless it misses": a NaN would be visited.
    fn approx_met(self, slabs: &Slabs, t_max: f32) -> (u32, u32);
}

/// With what every machine has.
#[derive(Clone, Copy)]
pub struct Portable;

impl Eight for Portable {
    #[inline(always)]
    fn steps(self, exponents: u32) -> f32x4 {
        let [x, y, z] = node_steps(exponents).to_array();
        f32x4::new([x, y, z, 0.0])
    }

    #[inline(always)]
    fn approx_met(self, slabs: &Slabs, t_max: f32) -> (u32, u32) {
        let splat = f32x8::splat;
        let planes = |words: &[u32; 2], k: usize, start: f32| {
            let bytes: u8x16 = bytemuck::cast([words[0].to_le(), words[1].to_le(), 0, 0]);
            f32x8::from_i32x8(i32x8::from_i16x8(i16x8::from_u8x16_low(bytes))) * splat(slabs.scale[k]) + splat(start)
        };
        let enter = planes(slabs.near[0], 0, slabs.low[0])
            .fast_max(planes(slabs.near[1], 1, slabs.low[1]))
            .fast_max(planes(slabs.near[2], 2, slabs.low[2]));
        let leave = planes(slabs.far[0], 0, slabs.high[0])
            .fast_min(planes(slabs.far[1], 1, slabs.high[1]))
            .fast_min(planes(slabs.far[2], 2, slabs.high[2]));
        let met = !enter.fast_max(f32x8::ZERO).simd_gt(leave.fast_min(splat(t_max))).to_bitmask() & 255;
        let meta = u64::from(slabs.meta[0]) | u64::from(slabs.meta[1]) << 32;
        let bits = (0..8).filter(|child| met >> child & 1 != 0).map(|child| (meta >> (8 * child)) as u32);
        (met, bits.fold(0, |all, byte| all | ((byte >> 5) & 7) << (byte & 31)))
    }
}

/// With AVX2.
#[cfg(target_arch = "x86_64")]
impl Eight for V3 {
    #[inline(always)]
    fn steps(self, exponents: u32) -> f32x4 {
        let bytes = self.sse2._mm_cvtsi32_si128(exponents as i32);
        bytemuck::cast(self.sse2._mm_slli_epi32::<23>(self.sse4_1._mm_cvtepu8_epi32(bytes)))
    }

    #[inline(always)]
    fn approx_met(self, slabs: &Slabs, t_max: f32) -> (u32, u32) {
        let (avx, avx2, splat) = (self.avx, self.avx2, |x: f32| self.avx._mm256_set1_ps(x));
        let bytes = |words: &[u32; 2]| avx2._mm256_cvtepu8_epi32(self.sse2._mm_set_epi64x(0, bytemuck::cast(*words)));
        let planes = |words: &[u32; 2], k: usize, start: f32| {
            let planes = avx._mm256_cvtepi32_ps(bytes(words));
            avx._mm256_add_ps(avx._mm256_mul_ps(planes, splat(slabs.scale[k])), splat(start))
        };
        let enter = avx._mm256_max_ps(planes(slabs.near[0], 0, slabs.low[0]), planes(slabs.near[1], 1, slabs.low[1]));
        let enter = avx._mm256_max_ps(avx._mm256_max_ps(enter, planes(slabs.near[2], 2, slabs.low[2])), splat(0.0));
        let leave = avx._mm256_min_ps(planes(slabs.far[0], 0, slabs.high[0]), planes(slabs.far[1], 1, slabs.high[1]));
        let leave = avx._mm256_min_ps(avx._mm256_min_ps(leave, planes(slabs.far[2], 2, slabs.high[2])), splat(t_max));
        let met = avx._mm256_cmp_ps::<_CMP_NGT_UQ>(enter, leave);

        let meta = bytes(slabs.meta);
        let place = avx2._mm256_and_si256(meta, avx._mm256_set1_epi32(31));
        let bits = avx2._mm256_sllv_epi32(avx2._mm256_srli_epi32::<5>(meta), place);
        let bits = avx2._mm256_and_si256(bits, avx._mm256_castps_si256(met));
        let bits = self.sse2._mm_or_si128(avx._mm256_castsi256_si128(bits), avx2._mm256_extracti128_si256::<1>(bits));
        let bits = self.sse2._mm_or_si128(bits, self.sse2._mm_unpackhi_epi64(bits, bits));
        let bits = self.sse2._mm_or_si128(bits, self.sse2._mm_shuffle_epi32::<1>(bits));
        (avx._mm256_movemask_ps(met) as u32, self.sse2._mm_cvtsi128_si32(bits) as u32)
    }
}

/// Which of a node's eight children the ray may meet at a t from 0 to `t_max` (both included), as bits that they set: inner
/// children that of their priority in the top byte (Ylitie et al. 2017, section 3.3: slot xor octant), leaves one bit a
/// primitive in the lower 24. `widening`: the `axis_slack` by which boxes
/// are wider. All eight at a time here.
/// Source: Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
/// section 3; the widening is ours (the bound above).
#[inline(always)]
#[allow(clippy::disallowed_methods, reason = "it chooses what to visit, never what is hit")]
pub fn approx_intersect_node(eight: impl Eight, node: &Node, ray: &LevelRay, widening: Vec3, t_max: f32) -> u32 {
    // The corner and, in the fourth lane, which nothing reads, whatever comes.
    let [x, y, z, exponents, ..] = *bytemuck::cast_ref::<Node, [f32; 20]>(node);
    let corner = f32x4::new([x, y, z, exponents]) - lanes(ray.origin);
    let exponents = node.exponents_imask;
    let step = eight.steps(exponents);
    let (inverse, error) = (lanes(ray.inverse), lanes(widening));
    let scale = (step * inverse).to_array();
    let start = corner * inverse;
    let low = (start - error).to_array();
    let high = (start + error).to_array();

    // Near and far planes by the sign of the direction; no swapping per child.
    let (near_x, far_x) = if ray.octant & 4 == 0 { (&node.max_x, &node.min_x) } else { (&node.min_x, &node.max_x) };
    let (near_y, far_y) = if ray.octant & 2 == 0 { (&node.max_y, &node.min_y) } else { (&node.min_y, &node.max_y) };
    let (near_z, far_z) = if ray.octant & 1 == 0 { (&node.max_z, &node.min_z) } else { (&node.min_z, &node.max_z) };
    let (near, far) = ([near_x, near_y, near_z], [far_x, far_y, far_z]);
    let (met, bits) = eight.approx_met(&Slabs { near, far, scale, low, high, meta: &node.child_meta }, t_max);
    let inner = PRIORITIES[(ray.octant & 7) as usize][(met & exponents >> 24) as usize];
    u32::from(inner) << 24 | bits & 0x00ff_ffff
}
