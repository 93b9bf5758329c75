//! The wavefront on the device: kernels, queues, and the commands of a batch.

use super::context::Context;
use super::kernel::{Bound, Kernel};
use super::memory::{Buffer, Place};
use super::plan::QueuePlan;
use super::record::Recorder;
use super::scene::SceneBuffers;
use crate::layout::{
    BINDING_AOVS, BINDING_CHUNK, BINDING_CHUNK_READ, BINDING_CONTROL, BINDING_FILM, BINDING_FILM_READ, BINDING_HITS,
    BINDING_HITS_READ, BINDING_LEVELS, BINDING_LEVELS_READ, BINDING_ORDER, BINDING_SHADOWS, BINDING_SHADOWS_READ,
    BINDING_SLOTS, BINDING_SLOTS_READ, Batch, Control, DispatchArguments, Features, FilmSum, INVALID, MAX_SHADE_GROUPS,
    MODEL_BLEND, SET_SCENE, SET_WORK, Variant, WORKGROUP,
};
use crate::render::RenderError;
use crate::shaders::{self, Fetch};
use rayon::prelude::*;
use std::mem::offset_of;

/// The wavefront's kernels in the order in which they run.
struct Stages<T> {
    schedule: T,
    /// Of the chunk's camera rays, and of the rest.
    camera: T,
    extend: T,
    shadow: T,
    /// One for each group of paths.
    shade: Vec<T>,
    resolve: T,
}

/// Models that may be met in each group of paths: none where nothing was hit, then for each of the scene's `models` that one
/// alone. A blend is of any, and a light may be a blend.
fn shade_groups(models: u32) -> Vec<u32> {
    debug_assert!(models >> (MAX_SHADE_GROUPS - 1) == 0, "a group for each model and one for none");
    let blend = 1 << MODEL_BLEND;
    let of = |model: u32| if 1 << model == blend { models } else { 1 << model | models & blend };
    let hit = (0..u32::BITS).filter(|model| models >> model & 1 != 0).map(of);
    std::iter::once(models & blend).chain(hit).collect()
}

/// Compiles a kernel for `variant` and for scenes with no more than `features`.
pub fn compile(
    context: &Context,
    name: &str,
    fetch: Fetch,
    variant: &Variant,
    features: &Features,
) -> Result<Kernel, RenderError> {
    let words = shaders::kernel(name, fetch)
        .ok_or_else(|| RenderError::Failed(format!("this program was built without the kernel {name}")))?;
    let constants = [&variant.constants()[..], &features.constants()].concat();
    context.kernel(name, words, &constants, size_of::<Batch>())
}

/// The compiled kernels of a scene.
pub struct Kernels {
    stages: Stages<Kernel>,
    /// Whether each model has a shade kernel of its own.
    pub grouped: bool,
}

impl Kernels {
    /// Compiles for a scene and one way of fetching, and for nothing else. `grouped`: paths are shaded in groups by the model
    /// they hit. Faster where lanes run in lockstep, but there is more to compile.
    pub fn new(
        context: &Context,
        scene: &SceneBuffers,
        features: &Features,
        grouped: bool,
    ) -> Result<Kernels, RenderError> {
        let variant = Variant { shade_grouped: grouped, ..scene.variant() };
        let make = |name, variant: Variant| compile(context, name, scene.fetch(), &variant, features);
        let shade = |(shade_group, models): (u32, u32)| {
            let shade_model = if models.count_ones() == 1 { models.trailing_zeros() } else { INVALID };
            let features = Features { models, ..*features };
            compile(context, "shade", scene.fetch(), &Variant { shade_group, shade_model, ..variant }, &features)
        };
        let groups = if grouped { shade_groups(features.models) } else { vec![features.models] };
        let numbered: Vec<(u32, u32)> = (0..).zip(groups).collect();
        Ok(Kernels {
            stages: Stages {
                schedule: make("schedule", variant)?,
                camera: make("extend", Variant { extend_camera: true, ..variant })?,
                extend: make("extend", variant)?,
                shadow: make("shadow", variant)?,
                shade: numbered.into_par_iter().map(shade).collect::<Result<_, _>>()?,
                resolve: make("resolve", variant)?,
            },
            grouped,
        })
    }
}

/// Queues, film and the kernels bound to them.
pub struct Queues {
    pub plan: QueuePlan,
    pub control: Buffer,
    pub chunk: Buffer,
    pub hits: Buffer,
    slots: Buffer,
    pub film: Buffer,
    pub aovs: Buffer,
    /// `Control` for the host, after each submission.
    pub control_copy: Buffer,
    stages: Stages<Bound>,
}

impl Queues {
    /// Allocates queues of `plan`'s sizes and binds everything.
    pub fn new(
        context: &Context,
        kernels: &Kernels,
        scene: &SceneBuffers,
        plan: QueuePlan,
        film: Buffer,
        aovs: Buffer,
    ) -> Result<Queues, RenderError> {
        let [levels, chunk, hits, order, shadows, slots] =
            plan.sizes().map(|(name, size)| context.buffer(name, size, Place::Device));
        let (levels, chunk, hits, order, shadows, slots) = (levels?, chunk?, hits?, order?, shadows?, slots?);
        let control = context.buffer("control record", size_of::<Control>() as u64, Place::Device)?;
        let control_copy = context.buffer("copy of the control record", control.size(), Place::Readback)?;
        let find = |set: u32, binding: u32| match (set, binding) {
            (SET_SCENE, _) => scene.find(binding),
            (SET_WORK, BINDING_CONTROL) => vec![control.clone()],
            (SET_WORK, BINDING_LEVELS | BINDING_LEVELS_READ) => vec![levels.clone()],
            (SET_WORK, BINDING_CHUNK | BINDING_CHUNK_READ) => vec![chunk.clone()],
            (SET_WORK, BINDING_HITS | BINDING_HITS_READ) => vec![hits.clone()],
            (SET_WORK, BINDING_SHADOWS | BINDING_SHADOWS_READ) => vec![shadows.clone()],
            (SET_WORK, BINDING_SLOTS | BINDING_SLOTS_READ) => vec![slots.clone()],
            (SET_WORK, BINDING_FILM | BINDING_FILM_READ) => vec![film.clone()],
            (SET_WORK, BINDING_AOVS) => vec![aovs.clone()],
            (SET_WORK, BINDING_ORDER) => vec![order.clone()],
            _ => Vec::new(),
        };
        let bind = |kernel: &Kernel| Bound::new(kernel, find);
        let Stages { schedule, camera, extend, shadow, shade, resolve } = &kernels.stages;
        let stages = Stages {
            schedule: bind(schedule)?,
            camera: bind(camera)?,
            extend: bind(extend)?,
            shadow: bind(shadow)?,
            shade: shade.iter().map(bind).collect::<Result<_, _>>()?,
            resolve: bind(resolve)?,
        };
        Ok(Queues { plan, control, chunk, hits, slots, film, aovs, control_copy, stages })
    }

    /// The control record at the start of a job.
    pub fn fresh_control(&self) -> Control {
        Control {
            level0_capacity: self.plan.chunk,
            level_capacity: self.plan.level_capacity(),
            shadow_capacity: self.plan.shadows,
            ..bytemuck::Zeroable::zeroed()
        }
    }

    /// Records: every kernel once over nothing, so that a driver which compiles at the first dispatch does it now.
    pub fn record_warm_up<'r>(&'r self, r: &Recorder<'r>) {
        let nothing = Batch { crop_width: 1, pixel_count: 1, sample_count: 1, ..Batch::default() };
        r.update(&self.control, 0, bytemuck::bytes_of(&self.fresh_control()));
        let Stages { schedule, camera, extend, shadow, shade, resolve } = &self.stages;
        for bound in [schedule, camera, extend, shadow, resolve].into_iter().chain(shade) {
            r.barrier();
            r.dispatch(bound, bytemuck::bytes_of(&nothing), 1);
        }
    }

    /// Records: the batch's samples have no light yet and are waiting for their camera rays.
    pub fn record_start<'r>(&'r self, r: &Recorder<'r>, batch: &Batch) {
        r.clear(&self.slots, u64::from(batch.slot_count) * size_of::<FilmSum>() as u64);
        r.update(&self.control, offset_of!(Control, camera_count) as u64, bytemuck::bytes_of(&batch.slot_count));
        r.barrier();
    }

    /// Records: how many rays the next chunks may hold.
    pub fn record_chunk_limit<'r>(&'r self, r: &Recorder<'r>, limit: u32) {
        r.update(&self.control, offset_of!(Control, chunk_limit) as u64, bytemuck::bytes_of(&limit));
        r.barrier();
    }

    /// Records: one round, with a timestamp after each stage (`pace::STAGES`).
    pub fn record_round<'r>(&'r self, r: &Recorder<'r>, batch: &Batch) {
        const _: () = assert!(size_of::<DispatchArguments>() == 12, "the arguments of vkCmdDispatchIndirect");
        let push = bytemuck::bytes_of(batch);
        r.dispatch(&self.stages.schedule, push, 1);
        r.timestamp();
        r.barrier();
        r.dispatch_indirect(&self.stages.camera, push, &self.control, offset_of!(Control, camera) as u64);
        r.dispatch_indirect(&self.stages.extend, push, &self.control, offset_of!(Control, extend) as u64);
        r.timestamp();
        r.dispatch_indirect(&self.stages.shadow, push, &self.control, offset_of!(Control, shadow) as u64);
        r.timestamp();
        r.barrier();
        for (group, shade) in self.stages.shade.iter().enumerate() {
            let arguments = offset_of!(Control, shade) + group * size_of::<DispatchArguments>();
            r.dispatch_indirect(shade, push, &self.control, arguments as u64);
        }
        r.timestamp();
        r.barrier();
    }

    /// Records: adds a finished batch to the film.
    pub fn record_resolve<'r>(&'r self, r: &Recorder<'r>, batch: &Batch) {
        r.dispatch(&self.stages.resolve, bytemuck::bytes_of(batch), batch.pixel_count.div_ceil(WORKGROUP));
        r.barrier();
    }

    /// Records: the control record's way to the host; `read_control` reads it afterwards.
    pub fn record_control_copy<'r>(&'r self, r: &Recorder<'r>) {
        r.copy(&self.control, 0, &self.control_copy, 0, size_of::<Control>() as u64);
    }

    /// The control record as of the last submission.
    pub fn read_control(&self) -> Control {
        let mut control: Control = bytemuck::Zeroable::zeroed();
        self.control_copy.read(bytemuck::bytes_of_mut(&mut control));
        control
    }
}
