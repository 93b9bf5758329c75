//! Interfaces between clear bodies that overlap (`shading/interior`): which of them are there, and between what.

use super::mis::pass_surface;
use super::{LOBE_THROUGH, Queues, push_path};
use crate::layout::{MODEL_ROUGH_DIELECTRIC, PathState, SceneView, load_table};
use crate::shading::closure::Closure;
use crate::shading::interior::{interior_add, interior_remove, interior_top};
use crate::shading::math::{div, dot3};
use crate::shading::sampling::hash_combine;
use crate::trace::spawn::spawn_through;
use crate::trace::surface::Surface;
use glam::Vec3;

/// Indices of rough glass are not between these, or no facet would refract.
const ETA_BELOW: f32 = 0.999;
const ETA_ABOVE: f32 = 1.001;

/// Beer coefficient of the medium that a ray with this list is in.
pub fn medium_absorption(scene: &SceneView, list: u32) -> Vec3 {
    let rank = interior_top(list);
    if rank == 0 {
        return Vec3::ZERO;
    }
    let at = scene.header.media_table + 4 * (rank - 1);
    Vec3::new(load_table(scene, at + 1), load_table(scene, at + 2), load_table(scene, at + 3))
}

/// Prepares `closure` of an interface that `path` meets: its index becomes relative to what is on the outer side there.
/// False if nothing is there, as a medium of higher rank is on both sides (or the same once more): the ray then goes on.
/// `t`: of the hit.
pub fn meet_interface(
    scene: &SceneView,
    path: &PathState,
    surface: &Surface,
    t: f32,
    closure: &mut Closure,
    queues: &mut Queues,
) -> bool {
    let rank = closure.rank;
    if rank == 0 {
        return true;
    }
    let entering = dot3(surface.normal_geometric, path.ray.direction) <= 0.0;
    let rest = if entering { path.interior } else { interior_remove(path.interior, rank) };
    let outer = interior_top(rest);
    if rank <= outer {
        let mut on = *path;
        on.interior = if entering { interior_add(path.interior, rank) } else { rest };
        on.path_id = hash_combine(path.path_id, LOBE_THROUGH);
        pass_surface(scene, surface, t, false, &mut on);
        on.ray = spawn_through(surface, path.ray.direction, path.ray.t_max);
        push_path(queues, on);
        return false;
    }
    if outer != 0 {
        let mut eta = div(closure.eta, load_table(scene, scene.header.media_table + 4 * (outer - 1)));
        if closure.model == MODEL_ROUGH_DIELECTRIC && eta > ETA_BELOW && eta < ETA_ABOVE {
            eta = if eta < 1.0 { ETA_BELOW } else { ETA_ABOVE };
        }
        closure.eta = eta;
    }
    true
}
