//! A sample's beginning.

use super::generate::generate;
use super::{Queues, miss_aov};
use crate::layout::{Batch, PathState, SceneView};

/// The state of the sample in `slot` before its first ray is traced; its auxiliary channels begin with nothing met.
pub fn begin_path(scene: &SceneView, batch: &Batch, slot: u32, queues: &mut Queues) -> PathState {
    let path = generate(scene, batch, slot);
    if scene.features.has_aovs {
        miss_aov(queues, &path);
    }
    path
}
