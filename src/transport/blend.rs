//! What the materials of a blend do together to light from one direction.
//!
//! A path draws one of them (`resolve_material`) to see what glows there, whether it goes on behind, and where it goes. Light from
//! a direction that is known is scattered by all of them: their weighted sum has less noise than one of them at random.

use super::DIMENSION_LEAF;
use super::local::{is_hidden_back, shading_frame};
use super::resolve::resolve_part;
use super::weight::consistent;
use crate::layout::{Hit, MAX_LEAVES, SceneView};
use crate::shading::closure::Closure;
use crate::shading::frame::to_local;
use crate::shading::material::{eval_closure, own_weight, pane_tint, pdf_closure};
use crate::shading::math::{div, rcp};
use crate::shading::spectrum::{Spectrum, spectrum_max, spectrum_zero};
use crate::trace::surface::Surface;
use glam::Vec3;

/// What a surface does to light from a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    /// f |cos theta_i|, per steradian.
    pub value: Spectrum,
    /// Density per solid angle with which a path that stays at the surface goes there.
    pub pdf: f32,
}

/// Nothing.
#[inline]
pub fn no_scattering() -> Scattering {
    Scattering { value: spectrum_zero(), pdf: 0.0 }
}

/// Probability that a path goes straight on through a pane rather than being scattered by it, 0..1: each as often as it is
/// bright.
#[inline]
pub fn pass_probability(closure: &Closure) -> f32 {
    if closure.k_t <= 0.0 {
        return 0.0;
    }
    let through = spectrum_max(pane_tint(closure));
    div(through, own_weight(closure.flags, closure.k_t) + through)
}

/// What all materials of a blend together do to light from `wi`, seen from `wo` (world): of a path that has not gone on through
/// one of them. `bare`: the surface as it is without their normal maps, found for `hit`. `hidden`: the path looks through what
/// glows.
pub fn eval_blend(scene: &SceneView, hit: &Hit, bare: &Surface, wo: Vec3, wi: Vec3, hidden: bool) -> Scattering {
    let mut sum = no_scattering();
    let mut stays = 0.0;
    for leaf in 0..MAX_LEAVES {
        let mut surface = *bare;
        let closure = resolve_part(scene, -wo, hit, leaf, 0.0, DIMENSION_LEAF, &mut surface);
        let looked_through = hidden && closure.emission != Vec3::ZERO;
        if closure.share > 0.0 && !looked_through {
            let stay = closure.share * (1.0 - pass_probability(&closure));
            stays += stay;
            let frame = shading_frame(scene, &surface, &closure, wo);
            let wo_local = to_local(frame, wo);
            let wi_local = to_local(frame, wi);
            let dark = is_hidden_back(&surface, &closure, wo);
            if !dark && consistent(&surface, wo, wi, wo_local, wi_local) {
                let own = closure.share * own_weight(closure.flags, closure.k_t);
                sum.value += eval_closure(scene, &closure, wo_local, wi_local) * own;
                sum.pdf += pdf_closure(scene, &closure, wo_local, wi_local) * stay;
            }
        }
        if leaf + 1 >= closure.leaf_count {
            break;
        }
    }
    if stays <= 0.0 {
        return no_scattering();
    }
    Scattering { value: sum.value * rcp(stays), pdf: sum.pdf * rcp(stays) }
}
