//! The reference backend: the transport steps called in a loop, tiles shared out by rayon.

use super::{Bounce, Counters, Job, Pass, RenderError, Renderer};
use crate::bake::SceneData;
use crate::layout::{AovPixel, Batch, FilmSum, SceneView};
use crate::trace::traverse::trace_closest;
use crate::transport::Queues;
use crate::transport::begin::begin_path;
use crate::transport::film::resolve_sample;
use crate::transport::shade::shade;
use crate::transport::shadow::trace_shadow;
use crate::watch::Watch;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Pixels a task takes at a time; any value gives the same picture.
const TILE_PIXELS: usize = 256;

/// The CPU backend.
pub struct CpuRenderer<'a> {
    data: &'a SceneData,
    pool: rayon::ThreadPool,
    tile_pixels: usize,
}

/// What the samples of some pixels counted.
#[derive(Default)]
struct Tally {
    closest_rays: AtomicU64,
    shadow_rays: AtomicU64,
    nan_count: AtomicU64,
    limited_count: AtomicU64,
    clamped_count: AtomicU64,
}

/// Buffers of one worker, reused from sample to sample.
#[derive(Default)]
struct Worker {
    queues: Queues,
    closest_rays: u64,
    shadow_rays: u64,
    clamped_count: u64,
}

impl<'a> CpuRenderer<'a> {
    /// `threads`: None for one per core.
    pub fn new(data: &'a SceneData, threads: Option<usize>) -> Result<Self, RenderError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.unwrap_or(0))
            .build()
            .map_err(|error| RenderError::Failed(format!("cannot start the worker threads: {error}")))?;
        Ok(Self { data, pool, tile_pixels: TILE_PIXELS })
    }

    /// Sets how many pixels a task takes at a time (tests prove that it does not matter).
    #[must_use]
    pub fn with_tile_pixels(mut self, tile_pixels: usize) -> Self {
        self.tile_pixels = tile_pixels.max(1);
        self
    }
}

/// The job as a batch of one sample per pixel.
fn batch_of(job: &Job, sample: u32) -> Batch {
    let pixels = job.crop.width * job.crop.height;
    Batch {
        crop_x: job.crop.x,
        crop_y: job.crop.y,
        crop_width: job.crop.width,
        crop_height: job.crop.height,
        first_pixel: 0,
        pixel_count: pixels,
        first_sample: sample,
        sample_count: 1,
        slot_count: pixels,
        ..Batch::default()
    }
}

/// Runs one sample to its end; its sum is left in the worker's queues. `bounces` records every step.
fn run_sample(scene: &SceneView, batch: &Batch, slot: u32, worker: &mut Worker, mut bounces: Option<&mut Vec<Bounce>>) {
    worker.queues.sum = FilmSum::default();
    let path = begin_path(scene, batch, slot, &mut worker.queues);
    worker.queues.paths.push(path);
    while let Some(path) = worker.queues.paths.pop() {
        let hit = trace_closest(scene, &path.ray);
        worker.closest_rays += 1;
        if let Some(list) = bounces.as_deref_mut() {
            list.push(Bounce { path, hit });
        }
        shade(scene, &path, &hit, &mut worker.queues);
        while let Some(shadow) = worker.queues.shadows.pop() {
            worker.shadow_rays += 1;
            trace_shadow(scene, &shadow, &mut worker.queues);
        }
    }
}

impl Renderer for CpuRenderer<'_> {
    fn name(&self) -> String {
        match self.pool.current_num_threads() {
            1 => "cpu (1 thread)".to_owned(),
            n => format!("cpu ({n} threads)"),
        }
    }

    fn render(&mut self, job: &Job, watch: &Watch, pass: &mut Pass) -> Result<(), RenderError> {
        let scene = self.data.view();
        let pixel_count = job.crop.width as usize * job.crop.height as usize;
        let want_aovs = scene.features.has_aovs;
        let Pass { sums, aovs, .. } = pass;
        sums.clear();
        sums.resize(pixel_count, FilmSum::default());
        aovs.clear();
        aovs.resize(if want_aovs { pixel_count } else { 0 }, AovPixel::default());
        let tally = Tally::default();
        let tile = self.tile_pixels;
        let run_tile = |worker: &mut Worker, first: usize, sums: &mut [FilmSum], mut aovs: Option<&mut [AovPixel]>| {
            if watch.is_cancelled() {
                return;
            }
            for sample in job.samples.clone() {
                let batch = batch_of(job, sample);
                for (offset, sum) in sums.iter_mut().enumerate() {
                    if let Some(aovs) = aovs.as_deref() {
                        worker.queues.aov = aovs[offset];
                    }
                    run_sample(&scene, &batch, (first + offset) as u32, worker, None);
                    worker.clamped_count += u64::from(resolve_sample(sum, &worker.queues.sum));
                    if let Some(aovs) = aovs.as_deref_mut() {
                        aovs[offset] = worker.queues.aov;
                    }
                }
            }
            tally.closest_rays.fetch_add(std::mem::take(&mut worker.closest_rays), Ordering::Relaxed);
            tally.shadow_rays.fetch_add(std::mem::take(&mut worker.shadow_rays), Ordering::Relaxed);
            tally.clamped_count.fetch_add(std::mem::take(&mut worker.clamped_count), Ordering::Relaxed);
            tally.nan_count.fetch_add(std::mem::take(&mut worker.queues.nan_count), Ordering::Relaxed);
            tally.limited_count.fetch_add(std::mem::take(&mut worker.queues.limited_count), Ordering::Relaxed);
            watch.advance(sums.len() as i64 * i64::from(job.samples.end - job.samples.start));
        };
        self.pool.install(|| {
            if want_aovs {
                sums.par_chunks_mut(tile)
                    .zip(aovs.par_chunks_mut(tile))
                    .enumerate()
                    .for_each_init(Worker::default, |worker, (index, (sums, aovs))| {
                        run_tile(worker, index * tile, sums, Some(aovs))
                    });
            } else {
                sums.par_chunks_mut(tile)
                    .enumerate()
                    .for_each_init(Worker::default, |worker, (index, sums)| run_tile(worker, index * tile, sums, None));
            }
        });
        if watch.is_cancelled() {
            return Err(RenderError::Aborted);
        }
        pass.nan_count = tally.nan_count.into_inner();
        pass.clamped_count = tally.clamped_count.into_inner();
        pass.counters = Counters {
            closest_rays: tally.closest_rays.into_inner(),
            shadow_rays: tally.shadow_rays.into_inner(),
            limited: tally.limited_count.into_inner(),
            ..Counters::default()
        };
        Ok(())
    }

    fn inspect(&mut self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError> {
        let scene = self.data.view();
        let job = Job { crop: crate::film::Rect { x, y, width: 1, height: 1 }, samples: sample..sample + 1 };
        let mut bounces = Vec::new();
        run_sample(&scene, &batch_of(&job, sample), 0, &mut Worker::default(), Some(&mut bounces));
        bounces.sort_by_key(|bounce| (bounce.path.depth, bounce.path.path_id));
        Ok(bounces)
    }
}
