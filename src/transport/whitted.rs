//! Ray tracing as a recursive local model. Source: Whitted 1980, "An Improved Illumination Model for Shaded Display".

use super::local::{facing_normal, is_hidden_back};
use super::nested::medium_absorption;
use super::{LOBE_MIRROR, LOBE_REFRACT, Queues, push_path};
use crate::layout::{MODEL_THIN_DIELECTRIC, PathState, SceneView, T_INFINITE};
use crate::shading::closure::Closure;
use crate::shading::delta::thin_reflectance;
use crate::shading::dielectric::refract_local;
use crate::shading::frame::{frame_from_normal, to_local, to_world};
use crate::shading::fresnel::fresnel_dielectric;
use crate::shading::interior::cross_interface;
use crate::shading::material::{is_refracting, mirror_weight, own_weight};
use crate::shading::math::{dot3, rcp};
use crate::shading::sampling::hash_combine;
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_max};
use crate::trace::spawn::spawn_ray;
use crate::trace::surface::Surface;
use glam::{Vec3, Vec4};

/// Appends one branch, unless its weight is below the scene's threshold.
pub fn push_branch(
    scene: &SceneView,
    path: &PathState,
    surface: &Surface,
    wi: Vec3,
    weight: Spectrum,
    lobe: u32,
    queues: &mut Queues,
) {
    let mut branch = *path;
    branch.throughput = path.throughput * weight;
    if spectrum_max(branch.throughput) < scene.header.min_weight {
        return;
    }
    branch.coverage = 0.0;
    branch.depth = path.depth + 1;
    branch.path_id = hash_combine(path.path_id, lobe);
    branch.ray = spawn_ray(surface, wi, T_INFINITE);
    push_path(queues, branch);
}

/// Mirror direction of `wo` about the viewer's shading normal; about the geometric one where the first would point
/// into the surface.
pub fn mirror_direction(surface: &Surface, wo: Vec3) -> Vec3 {
    let normal = facing_normal(surface, wo);
    let mirrored = normal * (2.0 * dot3(normal, wo)) - wo;
    let geometric = surface.normal_geometric;
    let cos_geometric = dot3(geometric, wo);
    if dot3(geometric, mirrored) * cos_geometric > 0.0 {
        return mirrored;
    }
    geometric * (2.0 * cos_geometric) - wo
}

/// Follows the mirror branch of any material and both branches of a dielectric, each with its Fresnel weight.
/// Without ranks media do not nest: a ray that leaves a dielectric is outside. Radiance is not scaled by eta^2 (Whitted's model).
pub fn shade_whitted(scene: &SceneView, path: &PathState, surface: &Surface, closure: &Closure, queues: &mut Queues) {
    let wo = -path.ray.direction;
    let refracting = is_refracting(closure.model);
    if !refracting && is_hidden_back(surface, closure, wo) {
        return;
    }
    let normal = facing_normal(surface, wo);
    let entering = dot3(surface.normal_geometric, wo) >= 0.0;
    let eta = if entering { closure.eta } else { rcp(closure.eta) };
    let frame = frame_from_normal(normal);
    let wo_local = to_local(frame, wo);
    let thin = closure.model == MODEL_THIN_DIELECTRIC;
    let mut reflectance = 0.0;
    let reflected = if refracting {
        reflectance =
            if thin { thin_reflectance(wo_local.z, closure.eta) } else { fresnel_dielectric(wo_local.z, eta) };
        Vec4::splat(reflectance)
    } else {
        mirror_weight(closure, dot3(normal, wo)) * own_weight(closure.flags, closure.k_t)
    };
    push_branch(scene, path, surface, mirror_direction(surface, wo), reflected, LOBE_MIRROR, queues);
    if !refracting {
        return;
    }
    let refracted = spectrum_from_rgb(closure.specular_color) * (1.0 - reflectance);
    let mut inside = *path;
    let mut wi = path.ray.direction;
    if !thin {
        let refraction = refract_local(wo_local, eta);
        if refraction.total {
            return;
        }
        wi = to_world(frame, refraction.wt);
        inside.eta = if entering { closure.eta } else { 1.0 };
        inside.absorption = if entering { closure.absorption } else { Vec3::ZERO };
        if scene.features.has_ranks {
            inside.interior = cross_interface(path.interior, closure.rank, entering);
            inside.absorption = medium_absorption(scene, inside.interior);
        }
    }
    push_branch(scene, &inside, surface, wi, refracted, LOBE_REFRACT, queues);
}
