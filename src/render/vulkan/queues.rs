//! The wavefront on the device: kernels, queues, and the commands of a batch.

use super::context::Context;
use super::kernel::{Bound, Kernel, WORKGROUP};
use super::memory::{Buffer, Place};
use super::plan::QueuePlan;
use super::record::Recorder;
use super::scene::SceneBuffers;
use crate::bake::SceneData;
use crate::layout::{
    Batch, Control, DispatchArguments, EMITTER_TEXTURED, FilmSum, INSTANCE_FLAT, INSTANCE_GOURAUD, INVALID,
    KIND_SPHERE, Light, MAX_SHADE_GROUPS, MODEL_BLEND, T_INFINITE,
};
use crate::render::RenderError;
use crate::shaders::{self, Fetch};
use glam::Vec3;
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

/// Every specialisation constant of a kernel that reads the scene (`shaders/kernels/bindings.glsl`).
pub fn specialisation(scene: &SceneBuffers, data: &SceneData) -> Vec<(u32, u32)> {
    let mut constants = vec![(0, WORKGROUP)];
    constants.extend(scene.constants());
    constants.extend(scene_constants(data));
    constants
}

/// Specialisation constants of which a kernel of one group has values of its own.
const MODELS_PRESENT: u32 = 6;
const SHADE_GROUP: u32 = 29;
const SHADE_MODEL: u32 = 30;
const SHADE_GROUPED: u32 = 31;
/// Whether an extend kernel makes camera rays.
const EXTEND_CAMERA: u32 = 32;

/// Bit n: a material has model n.
fn models(data: &SceneData) -> u32 {
    data.materials.iter().fold(0, |mask, material| mask | 1 << material.model)
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

/// Those that say what the scene uses.
fn scene_constants(data: &SceneData) -> [(u32, u32); 24] {
    let spheres = data.instances.iter().any(|instance| instance.kind == KIND_SPHERE);
    let facets = data.instances.iter().any(|instance| instance.flags & (INSTANCE_FLAT | INSTANCE_GOURAUD) != 0);
    let textures = data.materials.iter().any(|material| material.texture_count > 0);
    let open =
        |light: &Light| light.flaps_min.max_element() <= -T_INFINITE && light.flaps_max.min_element() >= T_INFINITE;
    let flaps = !data.lights.iter().all(open);
    [
        (5, data.shapes.stack_depth.max(1)),
        (MODELS_PRESENT, models(data)),
        (7, data.header.integrator),
        (8, data.header.sampling),
        (9, data.header.filter_kind),
        (10, u32::from(spheres)),
        (11, data.header.aovs),
        (12, data.emitters.iter().fold(0, |mask, emitter| mask | 1 << emitter.kind)),
        (13, u32::from(data.emitters.iter().any(|emitter| emitter.flags & EMITTER_TEXTURED != 0))),
        (14, data.header.environment_maps),
        (15, u32::from(data.has_panes())),
        (16, u32::from(data.materials.iter().any(|material| material.absorption != Vec3::ZERO))),
        (17, u32::from(facets)),
        (18, u32::from(textures)),
        (19, u32::from(data.instances.len() == 1)),
        (20, data.textures.iter().fold(0, |mask, texture| mask | 1 << texture.format)),
        (21, u32::from(data.header.camera.lens_radius > 0.0)),
        (22, u32::from(flaps)),
        (23, data.header.shadows),
        (24, data.header.nested),
        (25, u32::from(data.lights.iter().any(|light| light.slide != 0))),
        (26, data.header.shadowless),
        (27, data.header.hide_emitters),
        (28, u32::from(data.header.clamp > 0.0)),
    ]
}

/// The compiled kernels of a scene.
pub struct Kernels {
    stages: Stages<Kernel>,
    /// Whether each model has a shade kernel of its own.
    pub grouped: bool,
}

impl Kernels {
    /// Compiles for one way of fetching and the values of `specialisation`, and for nothing else. `grouped`: paths are shaded
    /// in groups by the model they hit. Faster where lanes run in lockstep, but there is more to compile.
    pub fn new(
        context: &Context,
        fetch: Fetch,
        constants: &[(u32, u32)],
        grouped: bool,
    ) -> Result<Kernels, RenderError> {
        let make = |name: &str, own: &[(u32, u32)]| {
            let words = shaders::kernel(name, fetch)
                .ok_or_else(|| RenderError::Failed(format!("this program was built without the kernel {name}")))?;
            let all = constants.iter().filter(|(id, _)| own.iter().all(|(other, _)| id != other)).chain(own);
            context.kernel(name, words, &all.copied().collect::<Vec<_>>(), size_of::<Batch>())
        };
        let grouping = (SHADE_GROUPED, u32::from(grouped));
        let models = constants.iter().find(|(id, _)| *id == MODELS_PRESENT).map_or(u32::MAX, |(_, models)| *models);
        let shade = |(group, models): (u32, u32)| {
            let model = if models.count_ones() == 1 { models.trailing_zeros() } else { INVALID };
            make("shade", &[grouping, (MODELS_PRESENT, models), (SHADE_GROUP, group), (SHADE_MODEL, model)])
        };
        let groups = if grouped { shade_groups(models) } else { vec![models] };
        let numbered: Vec<(u32, u32)> = (0..).zip(groups).collect();
        Ok(Kernels {
            stages: Stages {
                schedule: make("schedule", &[grouping])?,
                camera: make("extend", &[grouping, (EXTEND_CAMERA, 1)])?,
                extend: make("extend", &[grouping, (EXTEND_CAMERA, 0)])?,
                shadow: make("shadow", &[])?,
                shade: numbered.into_par_iter().map(shade).collect::<Result<_, _>>()?,
                resolve: make("resolve", &[])?,
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
        // Bindings of set 1 (`shaders/kernels/bindings.glsl`).
        let find = |set: u32, binding: u32| match (set, binding) {
            (0, _) => scene.find(binding),
            (1, 0) => vec![control.clone()],
            (1, 1 | 8) => vec![levels.clone()],
            (1, 2 | 9) => vec![chunk.clone()],
            (1, 3 | 10) => vec![hits.clone()],
            (1, 4 | 11) => vec![shadows.clone()],
            (1, 5 | 13) => vec![slots.clone()],
            (1, 6 | 14) => vec![film.clone()],
            (1, 7) => vec![aovs.clone()],
            (1, 12) => vec![order.clone()],
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
