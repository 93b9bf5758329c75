//! How texture coordinates run over a surface, what a pixel's cone covers of them, and normals from textures (row 27).

use crate::layout::Texture;
use crate::shading::coordinate::finite_or_zero;
use crate::shading::frame::{frame_from_tangent, to_world};
use crate::shading::math::{HUGE, TINY, clamp_, cross3, div, dot3, max_, normalize3, rcp};
use glam::{Vec2, Vec3};

/// Smallest cosine between a cone and the surface it meets: the footprint is at most 1000 times as long as wide.
const COS_CONE_LEAST: f32 = 1.0e-3;
/// No footprint is longer than this many times the texture.
const COVERED_MOST: f32 = 65536.0;
/// A mapped normal keeps at least this cosine with the one it replaces: what a texture turns further away is a fault.
const COS_RELIEF_LEAST: f32 = 1.0e-3;

/// Change of u and of v per unit of distance along a surface: vectors in the plane across its normal. Zero where the
/// coordinates do not determine them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UvGradients {
    pub u: Vec3,
    pub v: Vec3,
}

/// The gradients of a surface that moves by `dp_du` and `dp_dv` per unit of u and v (any length), across `normal` (unit).
/// They follow mirrored transforms and mirrored coordinates.
#[inline]
pub fn uv_gradients(dp_du: Vec3, dp_dv: Vec3, normal: Vec3) -> UvGradients {
    let area = dot3(cross3(dp_du, dp_dv), normal);
    if area.abs() < TINY || area.abs() > HUGE {
        return UvGradients { u: Vec3::ZERO, v: Vec3::ZERO };
    }
    let scale = rcp(area);
    UvGradients { u: cross3(dp_dv, normal) * scale, v: cross3(normal, dp_du) * scale }
}

/// The gradients of a texture's own coordinates.
#[inline]
pub fn texture_gradients(texture: &Texture, gradients: UvGradients) -> UvGradients {
    UvGradients {
        u: gradients.u * texture.scale_u + gradients.v * texture.shear_u,
        v: gradients.v * texture.scale_v + gradients.u * texture.shear_v,
    }
}

/// What a pixel covers of the texture coordinates: the two axes of an ellipse, in full length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// The way the ray slants.
    pub along: Vec2,
    /// At right angles to it on the surface.
    pub across: Vec2,
}

/// A step on the surface as a difference of uvs, within bounds.
fn covered(gradients: UvGradients, offset: Vec3) -> Vec2 {
    let u = finite_or_zero(dot3(gradients.u, offset));
    let v = finite_or_zero(dot3(gradients.v, offset));
    Vec2::new(clamp_(u, -COVERED_MOST, COVERED_MOST), clamp_(v, -COVERED_MOST, COVERED_MOST))
}

/// The ellipse in which a cone of `width` around `direction` (unit) meets a surface with the normal `normal` (unit, either
/// side), in texture coordinates.
/// Source: Akenine-Moeller et al. 2021, "Improved Shader and Texture Level of Detail Using Ray Cones", section 4.
#[inline]
pub fn cone_footprint(gradients: UvGradients, normal: Vec3, direction: Vec3, width: f32) -> Footprint {
    let cosine = dot3(normal, direction);
    let frame = frame_from_tangent(normal, direction);
    let extent = div(width, max_(cosine.abs(), COS_CONE_LEAST));
    Footprint { along: covered(gradients, frame.tangent * extent), across: covered(gradients, frame.bitangent * width) }
}

/// `mapped` (unit), or what is nearest to it at the least cosine from `normal`.
fn within_relief(normal: Vec3, mapped: Vec3) -> Vec3 {
    let cosine = dot3(normal, mapped);
    if cosine < COS_RELIEF_LEAST {
        return normalize3(mapped + normal * (COS_RELIEF_LEAST - cosine));
    }
    mapped
}

/// The normal that a normal map says: `texel` 0..1 in each lane, (0.5, 0.5, 1) for `normal` itself; its first lane leans
/// towards growing u, its second towards growing v. `strength` scales both. `gradients`: of the texture's own coordinates.
#[inline]
pub fn mapped_normal(normal: Vec3, gradients: UvGradients, texel: Vec3, strength: f32) -> Vec3 {
    // dp_du is across the gradient of v, on the side where u grows.
    let tangent = cross3(gradients.v, normal);
    let grows = dot3(tangent, gradients.u);
    let frame = frame_from_tangent(normal, if grows < 0.0 { -tangent } else { tangent });
    let turned = if dot3(frame.bitangent, gradients.v) < 0.0 { -1.0 } else { 1.0 };
    let x = (2.0 * texel.x - 1.0) * strength;
    let y = (2.0 * texel.y - 1.0) * strength;
    let z = 2.0 * texel.z - 1.0;
    let mapped = normalize3(to_world(frame, Vec3::new(x, y * turned, z)));
    if dot3(mapped, mapped) > 0.5 { within_relief(normal, mapped) } else { normal }
}

/// The normal of a surface raised by a height that changes by `height_u` and `height_v` (world units) per unit of the
/// texture's own coordinates, whose `gradients` are given.
/// Source: Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU", equation 2: N minus the surface gradient.
#[inline]
pub fn raised_normal(normal: Vec3, gradients: UvGradients, height_u: f32, height_v: f32) -> Vec3 {
    let slope = gradients.u * height_u + gradients.v * height_v;
    let raised = normalize3(normal - slope);
    if dot3(raised, raised) > 0.5 { within_relief(normal, raised) } else { normal }
}
