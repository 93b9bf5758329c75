//! One sample, step by step.

use super::context::Context;
use super::queues::Queues;
use crate::layout::{Batch, Hit, PathState};
use crate::render::Bounce;
use crate::render::RenderError;

/// Every step of one sample, ordered by (depth, path id): the wavefront's own kernels run a batch of one slot, a round
/// at a time, and chunk and hits are read back after each.
pub fn run(context: &mut Context, queues: &Queues, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError> {
    let batch = Batch {
        crop_x: x,
        crop_y: y,
        crop_width: 1,
        crop_height: 1,
        pixel_count: 1,
        first_sample: sample,
        sample_count: 1,
        slot_count: 1,
        ..Batch::default()
    };
    let control = queues.fresh_control();
    context.submit("inspecting a sample", |r| {
        r.clear(&queues.aovs, queues.aovs.size());
        // Words that kernels of this scene do not store are told as 0.
        r.clear(&queues.chunk, queues.chunk.size());
        r.update(&queues.control, 0, bytemuck::bytes_of(&control));
        r.barrier();
        queues.record_chunk_limit(r, queues.plan.chunk);
        queues.record_start(r, &batch);
    })?;
    let mut bounces = Vec::new();
    loop {
        context.submit("inspecting a sample", |r| {
            queues.record_round(r, &batch);
            queues.record_control_copy(r);
        })?;
        let control = queues.read_control();
        if control.overflows != 0 {
            return Err(RenderError::Failed(format!(
                "{} rays found a queue full: this is a bug of gonio",
                control.overflows
            )));
        }
        let count = control.chunk_count as usize;
        if count > 0 {
            let paths: Vec<PathState> = context.download(&queues.chunk, 0, count)?;
            let hits: Vec<Hit> = context.download(&queues.hits, 0, count)?;
            bounces.extend(paths.into_iter().zip(hits).map(|(path, hit)| Bounce { path, hit }));
        }
        if control.done != 0 {
            bounces.sort_by_key(|bounce| (bounce.path.depth, bounce.path.path_id));
            return Ok(bounces);
        }
    }
}
