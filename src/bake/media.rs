//! Media that nest: the clear bodies of a scene in the order of their priorities.

use super::model::Baked;
use super::{BakeError, SceneArrays};
use crate::layout::{INTEGRATOR_LOCAL, MODEL_DIELECTRIC, MODEL_ROUGH_DIELECTRIC};
use crate::scene;

/// Ranks fit into a byte (`shading/interior`).
const MOST: usize = 255;

/// Gives each clear body its rank, and the table of media its index and Beer coefficient, if any material of the scene has a
/// priority. `baked` begins with the materials of the scene, in their order.
pub fn rank_media(materials: &[scene::Material], baked: &mut [Baked], data: &mut SceneArrays) -> Result<(), BakeError> {
    if data.features.integrator == INTEGRATOR_LOCAL || materials.iter().all(|material| material.priority.is_none()) {
        return Ok(());
    }
    let clear = |index: &usize| matches!(baked[*index].closure.model, MODEL_DIELECTRIC | MODEL_ROUGH_DIELECTRIC);
    let mut order: Vec<usize> = (0..materials.len()).filter(clear).collect();
    if order.len() > MOST {
        return Err(BakeError::Media { count: order.len(), most: MOST });
    }
    order.sort_by_key(|index| materials[*index].priority.unwrap_or(0));
    data.features.has_ranks = !order.is_empty();
    data.header.media_table = data.tables.len() as u32;
    for (rank, index) in (1u16..).zip(order) {
        let closure = &mut baked[index].closure;
        closure.rank = u32::from(rank);
        data.tables.extend([closure.eta, closure.absorption.x, closure.absorption.y, closure.absorption.z]);
    }
    Ok(())
}
