//! A kernel: SPIR-V made into a pipeline, and the same bound to buffers.

use super::context::Device;
use super::error::call_failed;
use super::memory::Buffer;
use super::reflect::{self, Binding, BindingKind};
use crate::render::RenderError;
use crate::shaders;
use ash::vk;
use std::sync::Arc;

/// Bytes of a uniform buffer that every device allows.
const UNIFORM_RANGE: u64 = 16_384;

/// A compute pipeline; a cheap handle to share.
#[derive(Clone)]
pub struct Kernel(Arc<Inner>);

struct Inner {
    name: String,
    bindings: Vec<Binding>,
    push_bytes: u32,
    set_layouts: Vec<vk::DescriptorSetLayout>,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    device: Arc<Device>,
}

impl Kernel {
    /// Compiles `words` with specialisation `constants` (id, value) for push constants of `push_bytes` bytes, and with
    /// every float control the device offers.
    pub(super) fn new(
        device: &Arc<Device>,
        name: &str,
        words: &[u32],
        constants: &[(u32, u32)],
        push_bytes: u32,
    ) -> Result<Kernel, RenderError> {
        let invalid = |error| RenderError::Failed(format!("kernel {name}: {error}"));
        let words = shaders::specialise(words, constants).map_err(invalid)?;
        let words = shaders::REWRITE.get().map_or_else(|| words.clone(), |rewrite| rewrite(&words));
        let bindings = reflect::bindings(&words).map_err(invalid)?;
        check_limits(device, name, &bindings)?;
        // From here on `Drop` cleans up whatever was made before a failure.
        let mut inner = Inner {
            name: name.to_owned(),
            push_bytes,
            set_layouts: Vec::new(),
            layout: vk::PipelineLayout::null(),
            pipeline: vk::Pipeline::null(),
            device: device.clone(),
            bindings,
        };
        inner.make_layouts()?;
        let words = shaders::with_float_controls(&words, device.info().float_controls);
        inner.make_pipeline(&words)?;
        Ok(Kernel(Arc::new(inner)))
    }

    pub fn name(&self) -> &str {
        &self.0.name
    }

    pub fn bindings(&self) -> &[Binding] {
        &self.0.bindings
    }

    pub(super) fn push_bytes(&self) -> u32 {
        self.0.push_bytes
    }

    pub(super) fn layout(&self) -> vk::PipelineLayout {
        self.0.layout
    }

    pub(super) fn pipeline(&self) -> vk::Pipeline {
        self.0.pipeline
    }
}

/// One message per limit instead of a driver's crash.
fn check_limits(device: &Device, name: &str, bindings: &[Binding]) -> Result<(), RenderError> {
    let limits = device.info().limits;
    let count = |kind| -> u32 { bindings.iter().filter(|b| b.kind == kind).map(|b| b.count).sum() };
    let (storage, texel) = (count(BindingKind::StorageBuffer), count(BindingKind::TexelBuffer));
    for (what, needed, limit) in [
        ("storage buffers", storage, limits.stage_storage_buffers),
        ("texel buffers", texel, limits.stage_texel_buffers),
        ("bindings", storage + texel + count(BindingKind::UniformBuffer), limits.stage_resources),
    ] {
        if needed > limit {
            return Err(RenderError::Failed(format!("kernel {name} binds {needed} {what}; the device allows {limit}")));
        }
    }
    Ok(())
}

impl Inner {
    fn make_layouts(&mut self) -> Result<(), RenderError> {
        let raw = self.device.raw();
        let failed = || call_failed(format!("cannot lay out kernel {}", self.name));
        let sets = self.bindings.last().map_or(0, |binding| binding.set + 1);
        for set in 0..sets {
            let bindings: Vec<_> = self
                .bindings
                .iter()
                .filter(|binding| binding.set == set)
                .map(|binding| {
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(binding.binding)
                        .descriptor_type(descriptor_type(binding.kind))
                        .descriptor_count(binding.count)
                        .stage_flags(vk::ShaderStageFlags::COMPUTE)
                })
                .collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the device is alive; `info` points to locals.
            self.set_layouts.push(unsafe { raw.create_descriptor_set_layout(&info, None) }.map_err(failed())?);
        }
        let push =
            [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size: self.push_bytes }];
        let mut info = vk::PipelineLayoutCreateInfo::default().set_layouts(&self.set_layouts);
        if self.push_bytes > 0 {
            info = info.push_constant_ranges(&push);
        }
        // SAFETY: as above.
        self.layout = unsafe { raw.create_pipeline_layout(&info, None) }.map_err(failed())?;
        Ok(())
    }

    fn make_pipeline(&mut self, words: &[u32]) -> Result<(), RenderError> {
        let raw = self.device.raw();
        let failed = || call_failed(format!("cannot compile kernel {}", self.name));
        let info = vk::ShaderModuleCreateInfo::default().code(words);
        // SAFETY: our build made `words` (or a test did, through the same compiler) and `reflect` parsed them.
        let module = unsafe { raw.create_shader_module(&info, None) }.map_err(failed())?;
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"main");
        let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(self.layout);
        let start = std::time::Instant::now();
        // SAFETY: module, layout and cache are of this device; the module is not needed afterwards.
        let pipelines = unsafe {
            let pipelines = raw.create_compute_pipelines(self.device.pipeline_cache(), &[info], None);
            raw.destroy_shader_module(module, None);
            pipelines
        };
        self.pipeline = pipelines.map_err(|(_, error)| failed()(error))?[0];
        log::debug!("kernel {}: pipeline made in {:.3} s", self.name, start.elapsed().as_secs_f64());
        Ok(())
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        if self.device.is_stuck() {
            return;
        }
        let raw = self.device.raw();
        // SAFETY: every submission is waited for; destroying a null handle does nothing.
        unsafe {
            raw.destroy_pipeline(self.pipeline, None);
            raw.destroy_pipeline_layout(self.layout, None);
            for layout in &self.set_layouts {
                raw.destroy_descriptor_set_layout(*layout, None);
            }
        }
    }
}

fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::UniformBuffer => vk::DescriptorType::UNIFORM_BUFFER,
        BindingKind::TexelBuffer => vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
    }
}

/// A kernel with its buffers, which it keeps alive.
pub struct Bound {
    kernel: Kernel,
    pool: vk::DescriptorPool,
    /// (set number, set).
    sets: Vec<(u32, vk::DescriptorSet)>,
    _buffers: Vec<Buffer>,
}

impl Bound {
    /// Asks `find(set, binding)` for each binding of the kernel; a list shorter than a descriptor array is filled up
    /// with its first buffer.
    pub fn new(kernel: &Kernel, mut find: impl FnMut(u32, u32) -> Vec<Buffer>) -> Result<Bound, RenderError> {
        let mut bound =
            Bound { kernel: kernel.clone(), pool: vk::DescriptorPool::null(), sets: Vec::new(), _buffers: Vec::new() };
        if !kernel.bindings().is_empty() {
            bound.allocate()?;
        }
        for binding in kernel.bindings() {
            let buffers = find(binding.set, binding.binding);
            bound.write(*binding, &buffers)?;
            bound._buffers.extend(buffers);
        }
        Ok(bound)
    }

    fn allocate(&mut self) -> Result<(), RenderError> {
        let inner = &self.kernel.0;
        let failed = || call_failed(format!("cannot bind kernel {}", inner.name));
        let mut used: Vec<u32> = inner.bindings.iter().map(|binding| binding.set).collect();
        used.dedup();
        let sizes: Vec<_> = inner
            .bindings
            .iter()
            .map(|b| vk::DescriptorPoolSize { ty: descriptor_type(b.kind), descriptor_count: b.count })
            .collect();
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(used.len() as u32).pool_sizes(&sizes);
        let layouts: Vec<_> = used.iter().map(|set| inner.set_layouts[*set as usize]).collect();
        // SAFETY: the device is alive, the layouts are its own, and the pool has room for just these sets.
        let sets = unsafe {
            self.pool = inner.device.raw().create_descriptor_pool(&info, None).map_err(failed())?;
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(self.pool).set_layouts(&layouts);
            inner.device.raw().allocate_descriptor_sets(&info).map_err(failed())?
        };
        self.sets = used.into_iter().zip(sets).collect();
        Ok(())
    }

    fn write(&mut self, binding: Binding, buffers: &[Buffer]) -> Result<(), RenderError> {
        let device = &self.kernel.0.device;
        let place = format!("set {} binding {} of kernel {}", binding.set, binding.binding, self.kernel.name());
        if buffers.is_empty() || buffers.len() > binding.count as usize {
            return Err(RenderError::Failed(format!("{} buffers for {place}", buffers.len())));
        }
        let all: Vec<_> = (0..binding.count as usize).map(|at| buffers.get(at).unwrap_or(&buffers[0])).collect();
        debug_assert!(all.iter().all(|buffer| buffer.is_of(device)), "{place}: a buffer of another device");
        let set = self.sets.iter().find(|set| set.0 == binding.set).map_or(vk::DescriptorSet::null(), |set| set.1);
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding.binding)
            .descriptor_type(descriptor_type(binding.kind));
        let limits = device.info().limits;
        match binding.kind {
            BindingKind::StorageBuffer | BindingKind::UniformBuffer => {
                let (what, limit) = match binding.kind {
                    BindingKind::UniformBuffer => ("uniform", UNIFORM_RANGE),
                    _ => ("storage", limits.storage_range),
                };
                if let Some(buffer) = all.iter().find(|buffer| buffer.size() > limit) {
                    return Err(RenderError::Failed(format!(
                        "{} has {} bytes; a {what} buffer of this device holds {limit}",
                        buffer.name(),
                        buffer.size()
                    )));
                }
                let infos: Vec<_> = all
                    .iter()
                    .map(|buffer| vk::DescriptorBufferInfo { buffer: buffer.raw(), offset: 0, range: vk::WHOLE_SIZE })
                    .collect();
                // SAFETY: set and buffers are of this device, and `Bound` keeps the buffers alive.
                unsafe { device.raw().update_descriptor_sets(&[write.buffer_info(&infos)], &[]) };
            }
            BindingKind::TexelBuffer => {
                let views = all.iter().map(|buffer| buffer.view()).collect::<Result<Vec<_>, _>>()?;
                // SAFETY: as above; a view lives as long as its buffer.
                unsafe { device.raw().update_descriptor_sets(&[write.texel_buffer_view(&views)], &[]) };
            }
        }
        Ok(())
    }

    pub fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    pub(super) fn sets(&self) -> &[(u32, vk::DescriptorSet)] {
        &self.sets
    }
}

impl Drop for Bound {
    fn drop(&mut self) {
        let device = &self.kernel.0.device;
        if !device.is_stuck() {
            // SAFETY: every submission is waited for; destroying a null handle does nothing.
            unsafe { device.raw().destroy_descriptor_pool(self.pool, None) };
        }
    }
}
