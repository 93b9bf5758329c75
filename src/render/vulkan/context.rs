//! A device in use: queue, submissions, transfers.

use super::cache::PipelineCache;
use super::device::{DeviceChoice, DeviceInfo};
use super::error::call_failed;
use super::instance::Instance;
use super::kernel::{Bound, Kernel};
use super::memory::{Buffer, Place};
use super::record::Recorder;
use super::validation::Messages;
use crate::layout::Variant;
use crate::render::RenderError;
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings};
use std::cell::Cell;
use std::collections::HashMap;
use std::marker::PhantomData;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Longest wait for one submission. Ours take a fraction of a second and drivers report a device that hangs; but a software
/// device compiles at the first dispatch, and for a scene in many pages that takes minutes on a busy machine.
const TIMEOUT: Duration = Duration::from_secs(600);
/// Bytes that travel through the staging buffers at a time.
const STAGING: u64 = 8 << 20;
/// Timestamps one submission may take.
const QUERIES: u32 = 1024;

/// Some device of this process is stuck.
static ANY_STUCK: AtomicBool = AtomicBool::new(false);

/// Whether a device of this process was given up while it may have been at work. Threads of its driver may then be at work
/// until the process ends, which has to end without taking down what they use.
pub fn is_any_stuck() -> bool {
    ANY_STUCK.load(Ordering::Relaxed)
}

/// The logical device and its memory; every object made from it keeps it alive.
pub struct Device {
    raw: ash::Device,
    info: DeviceInfo,
    /// `None` only while dropping.
    allocator: Mutex<Option<Allocator>>,
    /// `None` until the device is set up.
    pipelines: Option<PipelineCache>,
    /// A submission was not seen to end: nothing may be destroyed any more.
    stuck: AtomicBool,
    instance: Arc<Instance>,
}

impl Device {
    fn new(instance: Arc<Instance>, info: DeviceInfo) -> Result<Arc<Device>, RenderError> {
        let physical = instance.physical_devices()?.get(info.index).copied();
        let physical =
            physical.ok_or_else(|| RenderError::NoDevice(format!("Vulkan device {} is gone", info.index)))?;
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(info.queue_family).queue_priorities(&[1.0])];
        let extensions: Vec<_> =
            info.portability_subset.then(|| ash::khr::portability_subset::NAME.as_ptr()).into_iter().collect();
        // Robust access: a bug of ours reads zeros or is dropped, and never harms another program.
        let features = vk::PhysicalDeviceFeatures::default().robust_buffer_access(true);
        let mut features_1_2 = vk::PhysicalDeviceVulkan12Features::default().scalar_block_layout(true);
        let create = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .enabled_features(&features)
            .push_next(&mut features_1_2);
        // SAFETY: `physical` is of this instance and has what is asked for: `missing` was empty.
        let raw = unsafe { instance.raw.create_device(physical, &create, None) }.map_err(|error| match error {
            vk::Result::ERROR_OUT_OF_HOST_MEMORY
            | vk::Result::ERROR_OUT_OF_DEVICE_MEMORY
            | vk::Result::ERROR_DEVICE_LOST
            | vk::Result::ERROR_TOO_MANY_OBJECTS => call_failed(format!("cannot open {}", info.name))(error),
            _ => RenderError::NoDevice(format!("cannot open {}: {error}", info.name)),
        })?;
        // `Drop` destroys what was made before a failure.
        let mut device =
            Device { raw, info, allocator: Mutex::new(None), pipelines: None, stuck: AtomicBool::new(false), instance };
        // SAFETY: `physical` is of this instance.
        let properties = unsafe { device.instance.raw.get_physical_device_properties(physical) };
        device.pipelines = Some(PipelineCache::load(&device.raw, &device.info, &properties)?);
        const MIB: u64 = 1 << 20;
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: device.instance.raw.clone(),
            device: device.raw.clone(),
            physical_device: physical,
            debug_settings: AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: AllocationSizes::new(32 * MIB, 16 * MIB),
        })
        .map_err(|error| RenderError::Failed(format!("cannot manage memory of {}: {error}", device.info.name)))?;
        *device.allocator.lock().unwrap_or_else(PoisonError::into_inner) = Some(allocator);
        Ok(Arc::new(device))
    }

    pub fn info(&self) -> &DeviceInfo {
        &self.info
    }

    pub(super) fn raw(&self) -> &ash::Device {
        &self.raw
    }

    /// Where compiled pipelines are looked up and kept.
    pub(super) fn pipeline_cache(&self) -> vk::PipelineCache {
        self.pipelines.as_ref().map_or(vk::PipelineCache::null(), PipelineCache::raw)
    }

    pub(super) fn allocator(&self) -> AllocatorGuard<'_> {
        AllocatorGuard(self.allocator.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// A submission was not seen to end.
    fn give_up(&self) {
        self.stuck.store(true, Ordering::Relaxed);
        ANY_STUCK.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_stuck(&self) -> bool {
        self.stuck.load(Ordering::Relaxed)
    }
}

/// The locked allocator.
pub(super) struct AllocatorGuard<'a>(MutexGuard<'a, Option<Allocator>>);

impl std::ops::Deref for AllocatorGuard<'_> {
    type Target = Allocator;
    fn deref(&self) -> &Allocator {
        self.0.as_ref().expect("present until the device is dropped")
    }
}

impl std::ops::DerefMut for AllocatorGuard<'_> {
    fn deref_mut(&mut self) -> &mut Allocator {
        self.0.as_mut().expect("present until the device is dropped")
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        let allocator = self.allocator.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        if self.is_stuck() {
            std::mem::forget(allocator);
            std::mem::forget(self.instance.clone());
            return;
        }
        drop(allocator); // frees memory, so it goes before the device
        if let Some(pipelines) = &self.pipelines {
            pipelines.store(&self.raw);
        }
        // SAFETY: every object of the device held an `Arc` of it, so none is left; destroying a null handle does nothing.
        unsafe {
            self.raw.destroy_pipeline_cache(self.pipeline_cache(), None);
            self.raw.destroy_device(None);
        }
    }
}

/// What one submission took.
#[derive(Clone, Debug, Default)]
pub struct Submission {
    /// From submit to the fence, on the host's clock.
    pub wall: Duration,
    /// Seconds on the device's clock, one per `Recorder::timestamp`; empty where the queue has no clock.
    pub times: Vec<f64>,
}

/// A device with its queue: one submission at a time, each waited for.
pub struct Context {
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    queries: Option<vk::QueryPool>,
    queue: vk::Queue,
    /// Two of each, so that the host copies to or from one while the device does with the other.
    upload: Option<[Buffer; 2]>,
    readback: Option<[Buffer; 2]>,
    /// What `run_kernel` has compiled, by SPIR-V and bytes of push constants.
    kernels: HashMap<(Vec<u32>, usize), Kernel>,
    device: Arc<Device>,
}

impl Context {
    /// Opens the loader and the device that `choice` means; `validate` as for `Instance::new`.
    pub fn new(choice: &DeviceChoice, validate: bool) -> Result<Context, RenderError> {
        let instance = Instance::new(validate)?;
        let devices = instance.devices()?;
        let info = choice.pick(&devices)?.clone();
        Self::on(instance, info)
    }

    /// Opens one device of `instance`.
    pub fn on(instance: Arc<Instance>, info: DeviceInfo) -> Result<Context, RenderError> {
        let device = Device::new(instance, info)?;
        let (raw, info) = (device.raw(), device.info());
        let failed = || call_failed(format!("cannot set up {}", info.name));
        // SAFETY: the queue was asked for when the device was made.
        let queue = unsafe { raw.get_device_queue(info.queue_family, 0) };
        // `Drop` destroys what was made before a failure.
        let mut context = Context {
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            queries: None,
            queue,
            upload: None,
            readback: None,
            kernels: HashMap::new(),
            device: device.clone(),
        };
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(info.queue_family);
        let queries = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(QUERIES);
        // SAFETY: the device is alive; the create infos are plain values.
        unsafe {
            context.pool = raw.create_command_pool(&pool, None).map_err(failed())?;
            let allocate = vk::CommandBufferAllocateInfo::default().command_pool(context.pool).command_buffer_count(1);
            context.commands = raw.allocate_command_buffers(&allocate).map_err(failed())?[0];
            context.fence = raw.create_fence(&vk::FenceCreateInfo::default(), None).map_err(failed())?;
            if info.limits.timestamp_bits > 0 {
                context.queries = Some(raw.create_query_pool(&queries, None).map_err(failed())?);
            }
        }
        Ok(context)
    }

    pub fn info(&self) -> &DeviceInfo {
        self.device.info()
    }

    /// What the validation layers have to say; also after the context is gone.
    pub fn messages(&self) -> Arc<Messages> {
        self.device.instance.messages()
    }

    /// True if a validation layer is at work.
    pub fn is_validated(&self) -> bool {
        self.device.instance.is_validated()
    }

    /// Makes one harmless mistake (a buffer without a use), to prove that the validation layer is heard.
    #[doc(hidden)]
    pub fn provoke_validation_message(&self) {
        let raw = self.device.raw();
        let info = vk::BufferCreateInfo::default().size(16);
        // SAFETY: no driver minds a buffer that is never bound or used; only the layer does.
        unsafe {
            if let Ok(buffer) = raw.create_buffer(&info, None) {
                raw.destroy_buffer(buffer, None);
            }
        }
    }

    /// A buffer of `size` bytes with undefined contents.
    pub fn buffer(&self, name: &str, size: u64, place: Place) -> Result<Buffer, RenderError> {
        Buffer::new(&self.device, name, size, place)
    }

    /// A kernel from SPIR-V.
    pub fn kernel(
        &self,
        name: &str,
        words: &[u32],
        constants: &[(u32, u32)],
        push_bytes: usize,
    ) -> Result<Kernel, RenderError> {
        Kernel::new(&self.device, name, words, constants, push_bytes as u32)
    }

    /// Records, submits and waits. `what` is what errors say was being done.
    pub fn submit<'r>(&'r mut self, what: &str, record: impl FnOnce(&Recorder<'r>)) -> Result<Submission, RenderError> {
        self.submit_while(what, record, || ())
    }

    /// `submit`, with `meanwhile` on the host while the device works.
    fn submit_while<'r>(
        &'r mut self,
        what: &str,
        record: impl FnOnce(&Recorder<'r>),
        meanwhile: impl FnOnce(),
    ) -> Result<Submission, RenderError> {
        let raw = self.device.raw();
        let failed = || call_failed(what.to_owned());
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the last submission was waited for, so pool, fence and queries are idle.
        unsafe {
            raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()).map_err(failed())?;
            raw.begin_command_buffer(self.commands, &begin).map_err(failed())?;
            if let Some(queries) = self.queries {
                raw.cmd_reset_query_pool(self.commands, queries, 0, QUERIES);
            }
        }
        let recorder = Recorder {
            device: &self.device,
            commands: self.commands,
            queries: self.queries,
            query_count: QUERIES,
            next_query: Cell::new(0),
            lifetime: PhantomData,
        };
        recorder.barrier(); // what earlier submissions wrote
        record(&recorder);
        recorder.barrier(); // what the host reads
        let used = recorder.next_query.get();
        let start = Instant::now();
        // SAFETY: the command buffer was recorded above from things that live as long as 'r.
        unsafe {
            raw.end_command_buffer(self.commands).map_err(failed())?;
            let commands = [self.commands];
            let submit = vk::SubmitInfo::default().command_buffers(&commands);
            raw.queue_submit(self.queue, &[submit], self.fence).map_err(failed())?;
            meanwhile();
            // A second at a time: a process that is stopped and goes on later (Ctrl-Z) has waited for one of them only.
            let mut ended = Err(vk::Result::TIMEOUT);
            for _ in 0..TIMEOUT.as_secs() {
                ended = raw.wait_for_fences(&[self.fence], true, 1_000_000_000);
                if ended != Err(vk::Result::TIMEOUT) {
                    break;
                }
            }
            if let Err(error) = ended {
                // Whatever went wrong, the device may still be at work.
                self.device.give_up();
                return Err(match error {
                    vk::Result::TIMEOUT => RenderError::Lost(format!(
                        "the device was lost: {what} did not end within {} s",
                        TIMEOUT.as_secs()
                    )),
                    error => failed()(error),
                });
            }
            raw.reset_fences(&[self.fence]).map_err(failed())?;
        }
        Ok(Submission { wall: start.elapsed(), times: self.times(used)? })
    }

    fn times(&self, used: u32) -> Result<Vec<f64>, RenderError> {
        let Some(queries) = self.queries.filter(|_| used > 0) else {
            return Ok(Vec::new());
        };
        let mut ticks = vec![0u64; used as usize];
        // SAFETY: these queries were written by the submission that was just waited for.
        unsafe { self.device.raw().get_query_pool_results(queries, 0, &mut ticks, vk::QueryResultFlags::TYPE_64) }
            .map_err(call_failed("cannot read the device's clock"))?;
        let limits = self.info().limits;
        let mask = u64::MAX >> (64 - limits.timestamp_bits.clamp(1, 64));
        let seconds = |tick: &u64| (tick.wrapping_sub(ticks[0]) & mask) as f64 * limits.timestamp_ns * 1e-9;
        Ok(ticks.iter().map(seconds).collect())
    }

    fn staging(&mut self, place: Place) -> Result<[Buffer; 2], RenderError> {
        let (slot, name) = match place {
            Place::Upload => (&mut self.upload, "upload buffer"),
            _ => (&mut self.readback, "readback buffer"),
        };
        if let Some(buffers) = slot {
            return Ok(buffers.clone());
        }
        let make = || Buffer::new(&self.device, name, STAGING, place);
        Ok(slot.insert([make()?, make()?]).clone())
    }

    /// Writes `bytes` (whole 4-byte words) to a device buffer.
    pub fn upload(&mut self, to: &Buffer, offset: u64, bytes: &[u8]) -> Result<(), RenderError> {
        let staging = self.staging(Place::Upload)?;
        let mut parts = bytes.chunks(STAGING as usize).zip(staging.iter().cycle()).peekable();
        let fill = |next: Option<&(&[u8], &Buffer)>| next.into_iter().for_each(|(part, buffer)| buffer.write(part));
        fill(parts.peek());
        let mut at = offset;
        while let Some((part, buffer)) = parts.next() {
            let size = part.len() as u64;
            let what = format!("uploading {}", to.name());
            self.submit_while(&what, |r| r.copy(buffer, 0, to, at, size), || fill(parts.peek()))?;
            at += size;
        }
        Ok(())
    }

    /// Reads `count` records from byte `offset` of a device buffer on.
    pub fn download<T: Pod>(&mut self, from: &Buffer, offset: u64, count: usize) -> Result<Vec<T>, RenderError> {
        let mut data = bytemuck::zeroed_vec::<T>(count);
        self.download_into(from, offset, &mut data)?;
        Ok(data)
    }

    /// Reads as many records as `data` holds from byte `offset` of a device buffer on.
    pub fn download_into<T: Pod>(&mut self, from: &Buffer, offset: u64, data: &mut [T]) -> Result<(), RenderError> {
        let staging = self.staging(Place::Readback)?;
        let empty = |full: Option<(&mut [u8], &Buffer)>| full.into_iter().for_each(|(part, buffer)| buffer.read(part));
        let mut full = None;
        let mut at = offset;
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(data);
        for (part, buffer) in bytes.chunks_mut(STAGING as usize).zip(staging.iter().cycle()) {
            let (size, last) = (part.len() as u64, full.take());
            let what = format!("reading {}", from.name());
            self.submit_while(&what, |r| r.copy(from, at, buffer, 0, size), || empty(last))?;
            full = Some((part, buffer));
            at += size;
        }
        empty(full);
        Ok(())
    }

    /// Runs one kernel of workgroups of 64 over storage buffers at set 0, bindings 0..n, and returns the bytes of
    /// those that are not mere inputs, in order. For parity kernels and the strictness probe.
    pub fn run_kernel(
        &mut self,
        name: &str,
        words: &[u32],
        buffers: &[BufferSpec],
        push_constants: &[u8],
        groups: u32,
    ) -> Result<Vec<Vec<u8>>, RenderError> {
        let limit = self.info().limits.group_count;
        if groups > limit {
            return Err(RenderError::TooLarge(format!("{groups} workgroups of {name}; the device allows {limit}")));
        }
        let key = (words.to_vec(), push_constants.len());
        let kernel = match self.kernels.get(&key) {
            Some(kernel) => kernel.clone(),
            None => {
                let kernel = self.kernel(name, words, &Variant::default().constants(), push_constants.len())?;
                self.kernels.entry(key).or_insert(kernel).clone()
            }
        };
        let mut bound_buffers = Vec::new();
        for (at, spec) in buffers.iter().enumerate() {
            let size = match spec {
                BufferSpec::Input(bytes) | BufferSpec::InOut(bytes) => bytes.len() as u64,
                BufferSpec::Output(size) => *size,
            };
            let buffer = self.buffer(&format!("buffer {at} of {name}"), size, Place::Device)?;
            match spec {
                BufferSpec::Input(bytes) | BufferSpec::InOut(bytes) => self.upload(&buffer, 0, bytes)?,
                BufferSpec::Output(_) => drop(self.submit("clearing", |r| r.clear(&buffer, buffer.size()))?),
            }
            bound_buffers.push((buffer, size));
        }
        let bound = Bound::new(&kernel, |set, binding| {
            let buffer = bound_buffers.get(binding as usize).filter(|_| set == 0);
            buffer.map(|(buffer, _)| buffer.clone()).into_iter().collect()
        })?;
        self.submit(name, |r| r.dispatch(&bound, push_constants, groups))?;
        let mut outputs = Vec::new();
        for ((buffer, size), spec) in bound_buffers.iter().zip(buffers) {
            if !matches!(spec, BufferSpec::Input(_)) {
                outputs.push(self.download(buffer, 0, *size as usize)?);
            }
        }
        Ok(outputs)
    }
}

/// A storage buffer of `Context::run_kernel`. Lengths in bytes, whole 4-byte words.
#[derive(Clone, Copy, Debug)]
pub enum BufferSpec<'a> {
    Input(&'a [u8]),
    /// Starts as zeros.
    Output(u64),
    InOut(&'a [u8]),
}

impl Drop for Context {
    fn drop(&mut self) {
        if self.device.is_stuck() {
            return;
        }
        let raw = self.device.raw();
        // SAFETY: every submission was waited for; destroying a null handle does nothing.
        unsafe {
            if let Some(queries) = self.queries {
                raw.destroy_query_pool(queries, None);
            }
            raw.destroy_fence(self.fence, None);
            raw.destroy_command_pool(self.pool, None);
        }
    }
}
