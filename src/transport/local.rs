//! The illumination model alone: I = emission + ambient + sum over lights, and what is seen through a pane.

use super::weight::consistent;
use super::{DITHER_LIGHT, DITHER_SURFACE, LOBE_THROUGH, Queues, add_contribution, push_path, push_shadow};
use crate::layout::{
    Hit, INSTANCE_NO_SHADOW, Light, MATERIAL_ANISOTROPIC, MATERIAL_EMIT_ONE_SIDED, MATERIAL_ONE_SIDED,
    MATERIAL_TRANSMISSIVE, PathState, SHADOWS_OFF, SceneView, ShadowRay, load_instance, load_light,
};
use crate::shading::closure::Closure;
use crate::shading::frame::{Frame, frame_from_normal, frame_from_tangent, to_local};
use crate::shading::light::sample_light;
use crate::shading::material::{ambient_closure, eval_closure, is_delta, own_weight, pane_tint};
use crate::shading::math::{dot3, normalize3};
use crate::shading::sampling::{SampleKey, dither_hash, hash_combine};
use crate::shading::slide::slide_factor;
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_max, spectrum_zero};
use crate::trace::spawn::{spawn_ray, spawn_through};
use crate::trace::surface::{Surface, surface_tangent};
use glam::{Vec3, Vec4};

/// Smallest cosine between shading normal and viewer; interpolated normals that face away are bent up to it.
pub const COS_VIEW_MIN: f32 = 1.0e-3;
/// A shadow ray ends this fraction short of its light, so that a lamp's own glass does not hide it.
pub const SHADOW_END: f32 = 0.9999;

/// Where a hit is shaded: at itself, or where `faceted` puts it.
#[derive(Clone, Copy, Debug)]
pub struct ShadingPoint {
    pub surface: Surface,
    /// Where on its triangle that is.
    pub hit: Hit,
    /// Where its shadow rays start.
    pub shadow_from: Surface,
    /// Unit, to the viewer.
    pub wo: Vec3,
    /// Part of the hit's radiance that it stands for, 0..1.
    pub share: f32,
    /// Keeps the dither of several points apart.
    pub dither: u32,
}

/// The shading normal a viewer at `wo` sees: on the viewer's side of the surface (both sides are shaded alike), and
/// bent towards the viewer where interpolation has turned it away.
pub fn facing_normal(surface: &Surface, wo: Vec3) -> Vec3 {
    let side = if dot3(surface.normal_geometric, wo) < 0.0 { -1.0 } else { 1.0 };
    let normal = surface.normal * side;
    let cos_view = dot3(normal, wo);
    if cos_view < COS_VIEW_MIN {
        return normalize3(normal + wo * (COS_VIEW_MIN - cos_view));
    }
    normal
}

/// The frame in which `closure` is shaded for a viewer at `wo`: z is the normal on the viewer's side, or for models that
/// transmit the one that leaves the outside; x follows the texture coordinates where the model has a direction.
pub fn shading_frame(scene: &SceneView, surface: &Surface, closure: &Closure, wo: Vec3) -> Frame {
    let facing = facing_normal(surface, wo);
    let inside = (closure.flags & MATERIAL_TRANSMISSIVE) != 0 && dot3(surface.normal_geometric, wo) < 0.0;
    let normal = if inside { -facing } else { facing };
    if (closure.flags & MATERIAL_ANISOTROPIC) != 0 {
        return frame_from_tangent(normal, surface_tangent(scene, surface));
    }
    frame_from_normal(normal)
}

/// True if a viewer at `wo` sees the back of a surface that reflects on its front only.
pub fn is_hidden_back(surface: &Surface, closure: &Closure, wo: Vec3) -> bool {
    (closure.flags & MATERIAL_ONE_SIDED) != 0 && dot3(surface.normal_geometric, wo) < 0.0
}

/// Radiance the surface emits towards `wo`.
pub fn emitted(surface: &Surface, closure: &Closure, wo: Vec3) -> Vec3 {
    if (closure.flags & MATERIAL_EMIT_ONE_SIDED) != 0 && dot3(surface.normal_geometric, wo) < 0.0 {
        return Vec3::ZERO;
    }
    closure.emission
}

/// What the surface adds for one light, before any shadow: throughput * eval * radiance.
pub fn light_contribution(
    scene: &SceneView,
    weight: Spectrum,
    closure: &Closure,
    frame: Frame,
    wo: Vec3,
    wi: Vec3,
    radiance: Spectrum,
) -> Spectrum {
    weight * eval_closure(scene, closure, to_local(frame, wo), to_local(frame, wi)) * radiance
}

/// Adds emission, ambient and every light's share of the surface, as seen from `point.wo`.
/// `key`: of the path. Directions in world space. Radiance along the ray's way back.
pub fn shade_local(
    scene: &SceneView,
    path: &PathState,
    key: SampleKey,
    point: &ShadingPoint,
    closure: &Closure,
    queues: &mut Queues,
) {
    let surface = &point.surface;
    let wo = point.wo;
    let weight = path.throughput * (own_weight(closure.flags, closure.k_t) * point.share);
    let hidden = is_hidden_back(surface, closure, wo);
    let mut reflected = spectrum_from_rgb(scene.header.ambient) * ambient_closure(closure);
    if hidden {
        reflected = spectrum_zero();
    }
    let own = weight * (reflected + spectrum_from_rgb(emitted(surface, closure, wo)));
    // A mirror or a glass covers the background like anything else.
    let alpha = path.coverage * ((1.0 - closure.k_t) * point.share);
    let dither = dither_hash(key, DITHER_SURFACE + point.dither);
    add_contribution(queues, scene.header.film_scale, path.slot, Vec4::new(own.x, own.y, own.z, alpha), dither);

    if !is_delta(closure) && !hidden {
        let frame = shading_frame(scene, surface, closure, wo);
        let mut shadowless = false;
        if scene.features.has_shadowless {
            shadowless = (load_instance(scene, surface.instance).flags & INSTANCE_NO_SHADOW) != 0;
        }
        for index in 0..scene.header.light_count {
            let light: Light = load_light(scene, index);
            let mut lit = sample_light(&light, surface.position);
            if light.slide != 0 {
                lit.radiance *= slide_factor(scene, &light, lit.wi);
            }
            let seen = light_contribution(scene, weight, closure, frame, wo, lit.wi, lit.radiance);
            if spectrum_max(seen) > 0.0 {
                let contribution = Vec4::new(seen.x, seen.y, seen.z, 0.0);
                let light_dither = dither_hash(key, (DITHER_LIGHT + point.dither) + index);
                if scene.features.shadows != SHADOWS_OFF && light.casts_shadow != 0 {
                    // No ray tests what it leaves: behind it, the surface itself is in the way, if it casts shadows.
                    let (wo_local, wi_local) = (to_local(frame, wo), to_local(frame, lit.wi));
                    if shadowless || consistent(&point.shadow_from, wo, lit.wi, wo_local, wi_local) {
                        let ray = spawn_ray(&point.shadow_from, lit.wi, lit.distance * SHADOW_END);
                        let (slot, dither) = (path.slot, light_dither);
                        push_shadow(queues, ShadowRay { ray, contribution, slot, dither, layer: 0, weight: 1.0 });
                    }
                } else {
                    add_contribution(queues, scene.header.film_scale, path.slot, contribution, light_dither);
                }
            }
        }
    }
}

/// Lets the ray go on through a pane.
pub fn shade_through(scene: &SceneView, path: &PathState, surface: &Surface, closure: &Closure, queues: &mut Queues) {
    if closure.k_t > 0.0 {
        let tint = pane_tint(closure);
        let mut through = *path;
        through.throughput = path.throughput * tint;
        through.coverage = path.coverage * closure.k_t;
        through.path_id = hash_combine(path.path_id, LOBE_THROUGH);
        through.ray = spawn_through(surface, path.ray.direction, path.ray.t_max);
        if spectrum_max(through.throughput) >= scene.header.min_weight {
            push_path(queues, through);
        }
    }
}
