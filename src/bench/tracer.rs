//! Arrays of rays traced on a backend, and timed.

use super::rays::{RaySet, answer};
use crate::bake::SceneData;
use crate::layout::{BINDING_HITS, BINDING_SHADOWS_READ, Batch, Hit, Ray, SET_SCENE, SET_WORK, ShadowRay, WORKGROUP};
use crate::render::RenderError;
use crate::render::vulkan::{
    Bound, Buffer, Context, DeviceChoice, DeviceInfo, Kernel, Place, SceneBuffers, Submission, VulkanOptions, compile,
};
use crate::shaders::Fetch;
use rayon::prelude::*;
use std::time::Instant;

/// Rays a thread takes at a time.
const CPU_CHUNK: usize = 1024;
/// Seconds a dispatch should take: the design allows 0.1, and some parts of a picture cost more than others.
const DISPATCH_GOAL: f64 = 0.03;
/// Rays of the first dispatch on a device whose speed is unknown, of the shortest and of the longest.
const FIRST_DISPATCH: u32 = 1 << 12;
const LONGEST_DISPATCH: u32 = 1 << 20;
/// Dispatches of one submission: a quarter of a second or so.
const DISPATCHES: usize = 8;

/// What one run took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Seconds on the host's clock.
    pub wall: f64,
    /// Seconds on the device's; `None` where it has no clock.
    pub device: Option<f64>,
}

/// A backend with a scene, and one set of rays at a time.
pub enum Tracer<'a> {
    Cpu(CpuTracer<'a>),
    Vulkan(Box<VulkanTracer>),
}

impl Tracer<'_> {
    /// Brings the rays to the backend, warms it up and sizes its dispatches. Not timed.
    pub fn load(&mut self, set: &RaySet) -> Result<(), RenderError> {
        match self {
            Tracer::Cpu(tracer) => tracer.hits = vec![Hit::default(); set.rays.len()],
            Tracer::Vulkan(tracer) => tracer.load(set)?,
        }
        Ok(())
    }

    /// Traces all rays once.
    pub fn run(&mut self, set: &RaySet) -> Result<Timing, RenderError> {
        match self {
            Tracer::Cpu(tracer) => Ok(tracer.run(set)),
            Tracer::Vulkan(tracer) => Ok(tracer.run(set)?),
        }
    }

    /// What the last run found.
    pub fn hits(&mut self) -> Result<Vec<Hit>, RenderError> {
        match self {
            Tracer::Cpu(tracer) => Ok(std::mem::take(&mut tracer.hits)),
            Tracer::Vulkan(tracer) => Ok(tracer.download()?),
        }
    }

    /// Rays of a dispatch, on a device.
    pub fn dispatch_rays(&self) -> Option<u32> {
        match self {
            Tracer::Cpu(_) => None,
            Tracer::Vulkan(tracer) => tracer.work.as_ref().map(|work| work.chunk),
        }
    }

    /// Seconds to upload the scene, and to compile the two kernels (their first dispatches included).
    pub fn setup(&self) -> Option<Setup> {
        match self {
            Tracer::Cpu(_) => None,
            Tracer::Vulkan(tracer) => Some(tracer.setup),
        }
    }
}

/// The CPU's twins over all threads.
pub struct CpuTracer<'a> {
    data: &'a SceneData,
    pool: rayon::ThreadPool,
    hits: Vec<Hit>,
}

impl<'a> CpuTracer<'a> {
    /// `threads`: None for one per core.
    pub fn new(data: &'a SceneData, threads: Option<usize>) -> Result<Self, RenderError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
        let pool = pool.map_err(|error| RenderError::Failed(format!("cannot start the worker threads: {error}")))?;
        Ok(Self { data, pool, hits: Vec::new() })
    }

    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    fn run(&mut self, set: &RaySet) -> Timing {
        let scene = self.data.view();
        let hits = &mut self.hits;
        let trace = |(rays, hits): (&[Ray], &mut [Hit])| {
            for (ray, hit) in rays.iter().zip(hits) {
                *hit = answer(&scene, set.kind, ray);
            }
        };
        let start = Instant::now();
        self.pool.install(|| set.rays.par_chunks(CPU_CHUNK).zip(hits.par_chunks_mut(CPU_CHUNK)).for_each(trace));
        Timing { wall: start.elapsed().as_secs_f64(), device: None }
    }
}

/// Seconds before the first ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Setup {
    /// Opening the device and uploading the scene.
    pub upload_s: f64,
    /// Compiling the kernels, their first dispatches included: many drivers compile there.
    pub compile_s: f64,
}

/// A Vulkan device.
pub struct VulkanTracer {
    context: Context,
    scene: SceneBuffers,
    closest: Kernel,
    any: Kernel,
    setup: Setup,
    work: Option<Work>,
}

/// One set of rays on the device.
struct Work {
    bound: Bound,
    rays: Buffer,
    hits: Buffer,
    count: u32,
    /// Rays of a dispatch.
    chunk: u32,
}

impl VulkanTracer {
    /// Opens the device, uploads the scene and compiles the kernels.
    pub fn new(data: &SceneData, options: &VulkanOptions) -> Result<Self, RenderError> {
        let start = Instant::now();
        let Ok(choice) = options.device.as_deref().unwrap_or("auto").parse::<DeviceChoice>();
        let mut context = Context::new(&choice, options.validate)?;
        let scene = SceneBuffers::upload(&mut context, data, options.fetch, options.page_limit)?;
        let upload_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let compile = |name| compile(&context, name, scene.fetch(), &scene.variant(), &data.features);
        let (closest, any) = (compile("bench_closest")?, compile("bench_any")?);
        let mut tracer = Self { context, scene, closest, any, setup: Setup::default(), work: None };
        for any in [false, true] {
            let mut work = tracer.bind(any, 1)?;
            work.count = 0;
            tracer.dispatch(&work, 0..1)?;
        }
        tracer.setup = Setup { upload_s, compile_s: start.elapsed().as_secs_f64() };
        Ok(tracer)
    }

    pub fn info(&self) -> &DeviceInfo {
        self.context.info()
    }

    pub fn fetch(&self) -> Fetch {
        self.scene.fetch()
    }

    /// Buffers for `count` rays, bound to the kernel.
    fn bind(&mut self, any: bool, count: usize) -> Result<Work, RenderError> {
        let bytes = |record: usize| (count * record) as u64;
        let rays = self.context.buffer("rays", bytes(size_of::<ShadowRay>()), Place::Device)?;
        let hits = self.context.buffer("hits", bytes(size_of::<Hit>()), Place::Device)?;
        let scene = &self.scene;
        let find = |set: u32, binding: u32| match (set, binding) {
            (SET_SCENE, _) => scene.find(binding),
            (SET_WORK, BINDING_HITS) => vec![hits.clone()],
            (SET_WORK, BINDING_SHADOWS_READ) => vec![rays.clone()],
            _ => Vec::new(),
        };
        let bound = Bound::new(if any { &self.any } else { &self.closest }, find)?;
        self.context.submit("clearing the hits", |r| {
            r.clear(&rays, rays.size());
            r.clear(&hits, hits.size());
        })?;
        Ok(Work { bound, rays, hits, count: count as u32, chunk: FIRST_DISPATCH })
    }

    fn load(&mut self, set: &RaySet) -> Result<(), RenderError> {
        self.work = None; // its memory first
        let mut work = self.bind(set.kind.is_any(), set.rays.len().max(1))?;
        work.count = set.rays.len() as u32;
        for (at, part) in set.rays.chunks(1 << 16).enumerate() {
            let records: Vec<ShadowRay> =
                part.iter().map(|ray| ShadowRay { ray: *ray, ..ShadowRay::default() }).collect();
            let offset = (at << 16) * size_of::<ShadowRay>();
            self.context.upload(&work.rays, offset as u64, bytemuck::cast_slice(&records))?;
        }
        // Longer dispatches until one takes long enough to tell how many rays fit into the goal.
        let groups = self.context.info().limits.group_count;
        let longest = LONGEST_DISPATCH.min(groups.saturating_mul(WORKGROUP));
        loop {
            let middle = (work.count - work.chunk.min(work.count)) / 2;
            let submission = self.dispatch(&work, middle..middle + work.chunk.min(work.count))?;
            let seconds = submission.times.last().copied().unwrap_or(submission.wall.as_secs_f64());
            if work.chunk >= work.count.min(longest) || seconds > DISPATCH_GOAL / 2.0 {
                let fitting = f64::from(work.chunk) * DISPATCH_GOAL / seconds.max(1e-6);
                work.chunk =
                    (fitting as u32).clamp(FIRST_DISPATCH / 4, longest).next_multiple_of(WORKGROUP).min(longest);
                break;
            }
            work.chunk *= 4;
        }
        self.work = Some(work);
        Ok(())
    }

    /// One submission of one dispatch.
    fn dispatch(&mut self, work: &Work, rays: std::ops::Range<u32>) -> Result<Submission, RenderError> {
        let batch = Batch {
            first_pixel: rays.start,
            slot_count: rays.len().min(work.count as usize) as u32,
            ..Batch::default()
        };
        self.context.submit("tracing rays", |r| {
            r.timestamp();
            r.dispatch(&work.bound, bytemuck::bytes_of(&batch), (rays.len() as u32).div_ceil(WORKGROUP));
            r.timestamp();
        })
    }

    fn run(&mut self, set: &RaySet) -> Result<Timing, RenderError> {
        let work = self.work.as_ref().expect("loaded by the caller");
        debug_assert_eq!(work.count as usize, set.rays.len(), "the rays that were loaded");
        let firsts: Vec<u32> = (0..work.count).step_by(work.chunk as usize).collect();
        let mut timing = Timing { wall: 0.0, device: Some(0.0) };
        for some in firsts.chunks(DISPATCHES) {
            let submission = self.context.submit("tracing rays", |r| {
                r.timestamp();
                for &first_pixel in some {
                    let slot_count = work.chunk.min(work.count - first_pixel);
                    let batch = Batch { first_pixel, slot_count, ..Batch::default() };
                    r.dispatch(&work.bound, bytemuck::bytes_of(&batch), slot_count.div_ceil(WORKGROUP));
                }
                r.timestamp();
            })?;
            timing.wall += submission.wall.as_secs_f64();
            timing.device = timing.device.zip(submission.times.last()).map(|(sum, last)| sum + last);
        }
        Ok(timing)
    }

    fn download(&mut self) -> Result<Vec<Hit>, RenderError> {
        let Some(work) = &self.work else { return Ok(Vec::new()) };
        let (hits, count) = (work.hits.clone(), work.count as usize);
        self.context.download(&hits, 0, count)
    }
}
