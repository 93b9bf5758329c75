//! The Vulkan backend: batches, rounds, and the way of the sums into the film.

use super::context::Context;
use super::device::{DeviceChoice, DeviceKind};
use super::memory::Place;
use super::pace::{self, Pace, Work};
use super::plan::{self, QueuePlan};
use super::queues::{Kernels, Queues};
use super::scene::{FetchChoice, SceneBuffers};
use super::validation::Messages;
use crate::bake::SceneData;
use crate::film::Rect;
use crate::layout::{AovPixel, Batch, Control, Features, FilmSum, SceneHeader};
use crate::render::{Bounce, Counters, Job, Pass, RenderError, Renderer};
use crate::shaders::Fetch;
use crate::watch::Watch;
use std::sync::Arc;

/// `VulkanOptions::group_from` where shading takes long, and where it does not: compiling takes seconds, and saves a third of
/// the time of shading.
const GROUP_FROM_CPU: u64 = 1 << 21;
const GROUP_FROM_GPU: u64 = 1 << 27;

/// What to render on and how.
#[derive(Clone, Debug, Default)]
pub struct VulkanOptions {
    /// Index, part of the name, or kind; `None` for the best there is (`DeviceChoice`).
    pub device: Option<String>,
    pub fetch: FetchChoice,
    /// Rays of a chunk at most, and a quarter of the samples of a batch. Pictures do not depend on it.
    pub chunk: Option<u32>,
    /// Bytes of a page of the scene, and of the film, at most. Pictures do not depend on it.
    pub page_limit: Option<u64>,
    /// Samples from which on each model gets a shade kernel of its own; None: when that pays. Pictures do not depend on it.
    pub group_from: Option<u64>,
    /// Ask for the validation layers, as `GONIO_VALIDATION=1` does.
    pub validate: bool,
}

/// The Vulkan backend.
pub struct VulkanRenderer {
    pub(super) context: Context,
    header: SceneHeader,
    scene: SceneBuffers,
    features: Features,
    kernels: Kernels,
    group_from: u64,
    /// Samples of all jobs so far.
    samples: u64,
    chunk: Option<u32>,
    page_limit: Option<u64>,
    /// Made for the first job, and again for a larger one.
    queues: Option<Queues>,
    pace: Pace,
}

/// What a job counted, and the control record it was last read from.
struct Tally {
    last: Control,
    counters: Counters,
    nan_count: u64,
    clamped_count: u64,
}

impl Tally {
    fn new(control: Control) -> Tally {
        Tally { last: control, counters: Counters::default(), nan_count: 0, clamped_count: 0 }
    }

    /// Reads the record after a submission; the result is its rounds, up to the one that was done.
    fn read(&mut self, queues: &Queues) -> Result<u32, RenderError> {
        let control = queues.read_control();
        if control.overflows != 0 {
            return Err(RenderError::Failed(format!(
                "{} rays found a queue full ({:?}): this is a bug of gonio",
                control.overflows, queues.plan
            )));
        }
        // 32-bit counters may wrap in a long job; differences do not.
        self.nan_count += u64::from(control.nan_count.wrapping_sub(self.last.nan_count));
        self.clamped_count += u64::from(control.clamped_count.wrapping_sub(self.last.clamped_count));
        self.counters.limited += u64::from(control.limited_count.wrapping_sub(self.last.limited_count));
        let wide = |words: [u32; 2]| u64::from(words[0]) | u64::from(words[1]) << 32;
        self.counters.closest_rays = wide(control.closest_rays);
        self.counters.shadow_rays = wide(control.shadow_rays);
        let worked = control.rounds.wrapping_sub(self.last.rounds);
        self.last = control;
        Ok(worked)
    }
}

impl VulkanRenderer {
    /// Opens the device, uploads the scene and compiles the kernels.
    pub fn new(data: &SceneData, options: VulkanOptions) -> Result<VulkanRenderer, RenderError> {
        let Ok(choice) = options.device.as_deref().unwrap_or("auto").parse::<DeviceChoice>();
        let mut context = Context::new(&choice, options.validate)?;
        let scene = SceneBuffers::upload(&mut context, data, options.fetch, options.page_limit)?;
        let cpu = context.info().kind == DeviceKind::Cpu;
        let group_from = options.group_from.unwrap_or(if cpu { GROUP_FROM_CPU } else { GROUP_FROM_GPU });
        Ok(VulkanRenderer {
            kernels: Kernels::new(&context, &scene, &data.features, group_from == 0)?,
            context,
            header: data.header,
            scene,
            features: data.features,
            group_from,
            samples: 0,
            chunk: options.chunk,
            page_limit: options.page_limit,
            queues: None,
            pace: Pace::new(1),
        })
    }

    /// How kernels read the scene.
    pub fn fetch(&self) -> Fetch {
        self.scene.fetch()
    }

    /// Pages of nodes, triangles and data.
    pub fn page_counts(&self) -> [usize; 3] {
        self.scene.page_counts()
    }

    /// The device in use, for the strictness probe.
    pub fn context_mut(&mut self) -> &mut Context {
        &mut self.context
    }

    /// What the validation layers have to say; also after the renderer is gone.
    pub fn messages(&self) -> Arc<Messages> {
        self.context.messages()
    }

    /// Queues for `slots` samples (or as many as fit) and a film of `pixels`.
    pub(super) fn ready(&mut self, slots: u64, pixels: u64) -> Result<(), RenderError> {
        let film_bytes = pixels * size_of::<FilmSum>() as u64;
        let aov_bytes = if self.features.has_aovs { pixels * size_of::<AovPixel>() as u64 } else { 0 };
        let plan =
            QueuePlan::new(self.context.info(), self.scene.fetch(), &self.header, &self.features, slots, self.chunk)?;
        if let Some(queues) = &self.queues
            && queues.plan.batch >= plan.batch
            && queues.film.size() >= film_bytes
            && queues.aovs.size() >= aov_bytes
        {
            return Ok(());
        }
        let batch = self.queues.as_ref().map_or(0, |queues| queues.plan.batch);
        let plan = if batch > plan.batch { self.queues.as_ref().map_or(plan, |queues| queues.plan) } else { plan };
        self.queues = None; // its memory first
        let film = self.context.buffer("film", film_bytes, Place::Device)?;
        let aovs = self.context.buffer("auxiliary values", aov_bytes, Place::Device)?;
        let queues = Queues::new(&self.context, &self.kernels, &self.scene, plan, film, aovs)?;
        self.context.submit("warming up", |r| queues.record_warm_up(r))?;
        self.pace = Pace::new(plan.chunk);
        self.queues = Some(queues);
        Ok(())
    }

    /// All samples of one band, its film read back.
    fn run_band(&mut self, band: Rect, job: &Job, tally: &mut Tally, watch: &Watch) -> Result<(), RenderError> {
        let queues = self.queues.as_ref().expect("made ready by the caller");
        if self.features.has_aovs {
            self.context.submit("clearing the auxiliary values", |r| r.clear(&queues.aovs, queues.aovs.size()))?;
        }
        let mut finished: Option<Batch> = None;
        for batch in plan::batches(band, job.samples.clone(), queues.plan.batch) {
            run_batch(&mut self.context, queues, &mut self.pace, tally, batch, finished, watch)?;
            watch.advance(batch.slot_count.into());
            finished = Some(batch);
        }
        if let Some(batch) = finished {
            self.context.submit("resolving the last batch", |r| {
                queues.record_resolve(r, &batch);
                queues.record_control_copy(r);
            })?;
            tally.read(queues)?;
        }
        Ok(())
    }

    /// A band's sums, and its auxiliary values if they are wanted.
    fn read_band(&mut self, sums: &mut [FilmSum], aovs: &mut [AovPixel]) -> Result<(), RenderError> {
        let queues = self.queues.as_ref().expect("made ready by the caller");
        let (from, aovs_from) = (queues.film.clone(), queues.aovs.clone());
        self.context.download_into(&from, 0, sums)?;
        self.context.download_into(&aovs_from, 0, aovs)
    }
}

/// Runs one batch to its end: submissions of some rounds each until nothing is pending. `finished` is the batch before,
/// which the first submission resolves.
fn run_batch(
    context: &mut Context,
    queues: &Queues,
    pace: &mut Pace,
    tally: &mut Tally,
    batch: Batch,
    finished: Option<Batch>,
    watch: &Watch,
) -> Result<(), RenderError> {
    let (mut recorded, mut worked) = (0, 0);
    loop {
        if watch.is_cancelled() {
            return Err(RenderError::Aborted);
        }
        let (rounds, limit) = (pace.rounds(recorded), pace.chunk_limit());
        let submission = context.submit("tracing a batch", |r| {
            r.timestamp();
            queues.record_chunk_limit(r, limit);
            if recorded == 0 {
                if let Some(finished) = finished {
                    queues.record_resolve(r, &finished);
                }
                queues.record_start(r, &batch);
            }
            r.timestamp();
            for _ in 0..rounds {
                queues.record_round(r, &batch);
            }
            queues.record_control_copy(r);
        })?;
        let rays_before = tally.counters.closest_rays;
        let now = tally.read(queues)?;
        let times = pace::split(&submission.times);
        if let Some((lead, stages)) = times {
            tally.counters.other_s += lead + stages.schedule;
            tally.counters.extend_s += stages.extend;
            tally.counters.shadow_s += stages.shadow;
            tally.counters.shade_s += stages.shade;
        }
        let work = Work {
            rounds: now,
            rays: tally.counters.closest_rays - rays_before,
            wall: submission.wall.as_secs_f64(),
            stages: times.map(|(_, stages)| stages),
        };
        log::trace!("batch of {}: {rounds} rounds, chunks of {limit}: {work:?}", batch.slot_count);
        pace.learn(&work);
        recorded += rounds;
        worked += now;
        if tally.last.done != 0 {
            pace.batch_ended(worked);
            return Ok(());
        }
    }
}

impl Renderer for VulkanRenderer {
    fn name(&self) -> String {
        self.context.info().to_string()
    }

    fn render(&mut self, job: &Job, watch: &Watch, pass: &mut Pass) -> Result<(), RenderError> {
        let bands =
            plan::bands(self.context.info(), self.scene.fetch(), job.crop, self.features.has_aovs, self.page_limit);
        let pixels = bands.iter().map(|band| band.area() as u64).max().unwrap_or(0);
        let samples = u64::from(job.samples.end.saturating_sub(job.samples.start));
        self.samples = self.samples.saturating_add(job.crop.area() as u64 * samples);
        if !self.kernels.grouped && self.samples >= self.group_from {
            self.queues = None; // they hold the old ones
            self.kernels = Kernels::new(&self.context, &self.scene, &self.features, true)?;
        }
        self.ready(pixels * samples, pixels)?;
        let queues = self.queues.as_ref().expect("just made ready");
        let control = queues.fresh_control();
        let buffer = queues.control.clone();
        self.context.upload(&buffer, 0, bytemuck::bytes_of(&control))?;
        let mut tally = Tally::new(control);
        // Bands are whole rows from the top: one after the other they are the crop.
        let Pass { sums, aovs, .. } = pass;
        sums.resize(job.crop.area(), FilmSum::default());
        aovs.resize(if self.features.has_aovs { sums.len() } else { 0 }, AovPixel::default());
        let mut at = 0;
        for band in bands {
            self.run_band(band, job, &mut tally, watch)?;
            let place = at..at + band.area();
            at = place.end;
            self.read_band(&mut sums[place.clone()], aovs.get_mut(place).unwrap_or_default())?;
        }
        log::debug!("{} rays in {} rounds", tally.counters.closest_rays, tally.last.rounds);
        (pass.nan_count, pass.clamped_count, pass.counters) = (tally.nan_count, tally.clamped_count, tally.counters);
        Ok(())
    }

    fn inspect(&mut self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError> {
        self.ready(1, 1)?;
        let queues = self.queues.as_ref().expect("just made ready");
        super::inspect::run(&mut self.context, queues, x, y, sample)
    }
}
