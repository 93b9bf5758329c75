//! Sizes of the wavefront's queues, and how a job is cut into batches.

use super::device::{DeviceInfo, DeviceKind};
use crate::film::Rect;
use crate::layout::{
    AovPixel, Batch, Features, FilmSum, Hit, MAX_SHADE_GROUPS, PathState, SHADOWS_FILTERED, SceneHeader, ShadowRay,
};
use crate::render::RenderError;
use crate::shaders::Fetch;
use std::ops::Range;

/// Sample slots of a batch where memory allows: enough to fill a large GPU; on CPU devices more only costs cache.
const BATCH_GPU: u32 = 1 << 17;
const BATCH_CPU: u32 = 1 << 16;

/// Samples of a pixel in a batch at most: resolve adds them up in one loop, and lavapipe of Mesa 22 ends all loops of an
/// invocation after 65,535 turns.
const BATCH_SAMPLES: u32 = 4096;
/// Samples of a pixel in a batch of part of the picture, if there are as many. Their first rays take the same way, and
/// devices that walk lanes in lockstep trace them in the time of one.
const SIDE_BY_SIDE: u32 = 16;

/// Entries of the queues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QueuePlan {
    /// Sample slots of a batch.
    pub batch: u32,
    /// Rays of a chunk at most, and entries of level 0.
    pub chunk: u32,
    /// Levels, one per scattering depth.
    pub levels: u32,
    /// Shadow rays waiting at most.
    pub shadows: u32,
    /// Queues of shadow rays: 2 if tracing them makes some.
    pub halves: u32,
}

impl QueuePlan {
    /// The largest queues of at most `most` slots that the device can hold. `chunk` lowers the rays of a chunk, and the
    /// slots of a batch to four times that.
    pub fn new(
        info: &DeviceInfo,
        fetch: Fetch,
        header: &SceneHeader,
        features: &Features,
        most: u64,
        chunk: Option<u32>,
    ) -> Result<QueuePlan, RenderError> {
        let target = if info.kind == DeviceKind::Cpu { BATCH_CPU } else { BATCH_GPU };
        let most = most.min(u64::from(chunk.unwrap_or(u32::MAX)) * 4);
        let mut batch = u64::from(target).min(most.next_power_of_two()) as u32;
        loop {
            let plan = Self::of_batch(batch, header, features, chunk);
            match plan.too_large(info, fetch) {
                None => return Ok(plan),
                Some(_) if batch > 64 => batch /= 2,
                Some(reason) => return Err(RenderError::TooLarge(reason)),
            }
        }
    }

    fn of_batch(batch: u32, header: &SceneHeader, features: &Features, chunk: Option<u32>) -> QueuePlan {
        // Four shadow rays for each slot is room for most scenes.
        let rays = header.shadow_rays.max(1);
        let fitting = (u64::from(batch) * 4 / u64::from(rays)).clamp(1, batch.into()) as u32;
        let chunk = fitting.min(chunk.unwrap_or(u32::MAX)).max(1);
        let plan =
            QueuePlan { batch, chunk, levels: header.level_count, shadows: chunk.saturating_mul(rays), halves: 1 };
        if features.shadows != SHADOWS_FILTERED {
            return plan;
        }
        // Room for a chunk beside as many that go on behind panes.
        QueuePlan { shadows: plan.shadows.saturating_mul(2), halves: 2, ..plan }
    }

    /// Entries of levels from 1 on: room for two branches of each ray of a full chunk.
    pub fn level_capacity(&self) -> u32 {
        self.chunk * 2
    }

    /// Names and bytes of the queues: levels, chunk, hits, what is shaded together, shadow rays, slots.
    pub fn sizes(&self) -> [(&'static str, u64); 6] {
        let level_entries = u64::from(self.chunk) + u64::from(self.levels - 1) * u64::from(self.level_capacity());
        [
            ("ray queue", level_entries * size_of::<PathState>() as u64),
            ("ray chunk", u64::from(self.chunk) * size_of::<PathState>() as u64),
            ("hits", u64::from(self.chunk) * size_of::<Hit>() as u64),
            ("order of shading", u64::from(self.chunk) * u64::from(MAX_SHADE_GROUPS) * size_of::<u32>() as u64),
            ("shadow ray queue", u64::from(self.shadows) * u64::from(self.halves) * size_of::<ShadowRay>() as u64),
            ("sample slots", u64::from(self.batch) * size_of::<FilmSum>() as u64),
        ]
    }

    fn too_large(&self, info: &DeviceInfo, fetch: Fetch) -> Option<String> {
        let limit = binding_limit(info, fetch);
        let sizes = self.sizes();
        if let Some((name, size)) = sizes.iter().find(|(_, size)| *size > limit) {
            return Some(format!("the {name} takes {size} bytes; a buffer of this device holds {limit}"));
        }
        let total: u64 = sizes.iter().map(|(_, size)| size).sum();
        let share = info.limits.heap / 4; // the scene and the film want memory too
        (total > share).then(|| format!("the queues take {total} bytes; a quarter of the device's memory is {share}"))
    }
}

/// Bytes a queue or a film may have: they are bound as storage buffers and, where kernels fetch so, as texel buffers.
fn binding_limit(info: &DeviceInfo, fetch: Fetch) -> u64 {
    let limits = info.limits;
    let texel = if fetch == Fetch::Texel { limits.texel_elements.saturating_mul(16) } else { u64::MAX };
    limits.storage_range.min(limits.allocation).min(texel)
}

/// Cuts `crop` into bands of whole rows whose film (and auxiliary values) one buffer of the device holds. `most` lowers the
/// bytes of that buffer.
pub fn bands(info: &DeviceInfo, fetch: Fetch, crop: Rect, aovs: bool, most: Option<u64>) -> Vec<Rect> {
    let bytes = binding_limit(info, fetch).min(info.limits.heap / 8).min(most.unwrap_or(u64::MAX));
    let pixel = if aovs { size_of::<AovPixel>() } else { size_of::<FilmSum>() } as u64;
    bands_of(crop, bytes / pixel)
}

fn bands_of(crop: Rect, pixels: u64) -> Vec<Rect> {
    let rows = (pixels / u64::from(crop.width.max(1))).clamp(1, crop.height.max(1).into()) as u32;
    (0..crop.height)
        .step_by(rows as usize)
        .map(|y| Rect { y: crop.y + y, height: rows.min(crop.height - y), ..crop })
        .collect()
}

/// Cuts a band's samples into batches of at most `slots`: `SIDE_BY_SIDE` samples of some pixels where the band is large,
/// more of all pixels where it is small.
pub fn batches(band: Rect, samples: Range<u32>, slots: u32) -> impl Iterator<Item = Batch> {
    let pixels = band.width * band.height;
    let wanted = (slots / pixels.max(1)).max(SIDE_BY_SIDE).min(samples.end.saturating_sub(samples.start));
    let sample_step = wanted.min(slots).clamp(1, BATCH_SAMPLES);
    let pixel_step = (slots / sample_step).max(1);
    samples.clone().step_by(sample_step as usize).flat_map(move |first_sample| {
        let sample_count = sample_step.min(samples.end - first_sample);
        (0..pixels).step_by(pixel_step as usize).map(move |first_pixel| {
            let pixel_count = pixel_step.min(pixels - first_pixel);
            Batch {
                crop_x: band.x,
                crop_y: band.y,
                crop_width: band.width,
                crop_height: band.height,
                first_pixel,
                pixel_count,
                first_sample,
                sample_count,
                slot_count: pixel_count * sample_count,
                is_first: u32::from(first_sample == samples.start),
                ..Batch::default()
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    fn covered(band: Rect, samples: Range<u32>, slots: u32) -> HashSet<(u32, u32)> {
        let mut seen = HashSet::new();
        let first = samples.start;
        for batch in batches(band, samples, slots) {
            assert!(batch.slot_count <= slots, "{batch:?}");
            assert_eq!(batch.is_first == 1, batch.first_sample == first, "{batch:?}");
            for slot in 0..batch.slot_count {
                let pixel = batch.first_pixel + slot / batch.sample_count;
                let sample = batch.first_sample + slot % batch.sample_count;
                assert!(seen.insert((pixel, sample)), "twice: pixel {pixel}, sample {sample}");
            }
        }
        seen
    }

    #[test]
    fn batches_cover_every_sample_of_every_pixel_once() {
        let band = Rect { x: 3, y: 5, width: 7, height: 11 };
        for slots in [1, 2, 64, 76, 77, 78, 154, 1000] {
            let seen = covered(band, 4..13, slots);
            assert_eq!(seen.len(), 77 * 9, "slots {slots}");
            assert!(seen.iter().all(|(pixel, sample)| *pixel < 77 && (4..13).contains(sample)));
        }
    }

    #[test]
    fn bands_are_whole_rows_that_cover_the_crop() {
        let crop = Rect { x: 2, y: 10, width: 8, height: 5 };
        let rows: Vec<_> = bands_of(crop, 17).iter().map(|band| (band.x, band.y, band.width, band.height)).collect();
        assert_eq!(rows, [(2, 10, 8, 2), (2, 12, 8, 2), (2, 14, 8, 1)]);
    }

    #[test]
    fn many_lights_make_chunks_small_instead_of_losing_shadow_rays() {
        let header = SceneHeader { shadow_rays: 1000, level_count: 4, ..SceneHeader::default() };
        let plan = QueuePlan::of_batch(1 << 16, &header, &Features::default(), None);
        assert_eq!((plan.chunk, plan.shadows, plan.levels), (262, 262_000, 4));
        let plan =
            QueuePlan::of_batch(64, &SceneHeader { shadow_rays: 1_000_000, ..header }, &Features::default(), None);
        assert_eq!((plan.chunk, plan.shadows), (1, 1_000_000));
    }
}
