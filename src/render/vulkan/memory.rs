//! Buffers: every byte on the device comes from here.

use super::context::Device;
use super::error::call_failed;
use crate::render::RenderError;
use ash::vk;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use gpu_allocator::{AllocationError, MemoryLocation};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Where a buffer lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On the device; bound to kernels.
    Device,
    /// Written by the host, copied from.
    Upload,
    /// Copied to, read by the host.
    Readback,
}

/// A buffer; a cheap handle to share. It lives until the last descriptor set that names it is gone.
#[derive(Clone)]
pub struct Buffer(Arc<Inner>);

struct Inner {
    raw: vk::Buffer,
    size: u64,
    name: String,
    allocation: Mutex<Option<Allocation>>,
    view: OnceLock<vk::BufferView>,
    device: Arc<Device>,
}

impl Buffer {
    /// A buffer of `size` bytes (rounded up to whole 16-byte words, at least one); its contents are undefined.
    /// `name` is what errors call it.
    pub(super) fn new(device: &Arc<Device>, name: &str, size: u64, place: Place) -> Result<Buffer, RenderError> {
        let size = size.max(1).next_multiple_of(16);
        let told = |why: &dyn std::fmt::Display| format!("cannot allocate {name} ({size} bytes): {why}");
        if size > device.info().limits.allocation {
            let limit = device.info().limits.allocation;
            return Err(RenderError::TooLarge(told(&format!("the device allocates at most {limit} bytes at once"))));
        }
        let (location, usage) = match place {
            Place::Device => (
                MemoryLocation::GpuOnly,
                vk::BufferUsageFlags::STORAGE_BUFFER
                    | vk::BufferUsageFlags::UNIFORM_BUFFER
                    | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER
                    | vk::BufferUsageFlags::INDIRECT_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_SRC
                    | vk::BufferUsageFlags::TRANSFER_DST,
            ),
            Place::Upload => (MemoryLocation::CpuToGpu, vk::BufferUsageFlags::TRANSFER_SRC),
            Place::Readback => (MemoryLocation::GpuToCpu, vk::BufferUsageFlags::TRANSFER_DST),
        };
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: the device is alive, as `Inner` holds it.
        let raw = unsafe { device.raw().create_buffer(&info, None) }
            .map_err(|error| call_failed(told(&"the driver refused"))(error))?;
        let inner = Inner {
            raw,
            size,
            name: name.to_owned(),
            allocation: Mutex::new(None),
            view: OnceLock::new(),
            device: device.clone(),
        };
        // SAFETY: `raw` was just made by this device.
        let requirements = unsafe { device.raw().get_buffer_memory_requirements(raw) };
        let allocation = device
            .allocator()
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location,
                linear: true,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|error| match error {
                AllocationError::OutOfMemory => RenderError::OutOfMemory(told(&error)),
                _ => RenderError::Failed(told(&error)),
            })?;
        // SAFETY: a fresh buffer bound once, to memory that was allocated for it and is freed after it.
        let bound = unsafe { device.raw().bind_buffer_memory(raw, allocation.memory(), allocation.offset()) };
        *inner.allocation.lock().unwrap_or_else(PoisonError::into_inner) = Some(allocation);
        bound.map_err(|error| call_failed(told(&"the driver refused"))(error))?;
        Ok(Buffer(Arc::new(inner)))
    }

    pub fn size(&self) -> u64 {
        self.0.size
    }

    pub fn name(&self) -> &str {
        &self.0.name
    }

    pub(super) fn raw(&self) -> vk::Buffer {
        self.0.raw
    }

    pub(super) fn is_of(&self, device: &Arc<Device>) -> bool {
        Arc::ptr_eq(&self.0.device, device)
    }

    /// The whole buffer as 16-byte texels.
    pub(super) fn view(&self) -> Result<vk::BufferView, RenderError> {
        if let Some(view) = self.0.view.get() {
            return Ok(*view);
        }
        let limit = self.0.device.info().limits.texel_elements;
        if self.size() / 16 > limit {
            return Err(RenderError::TooLarge(format!(
                "{} has {} words of 16 bytes; a texel buffer of this device holds {limit}",
                self.name(),
                self.size() / 16
            )));
        }
        let info = vk::BufferViewCreateInfo::default()
            .buffer(self.0.raw)
            .format(vk::Format::R32G32B32A32_UINT)
            .range(vk::WHOLE_SIZE);
        // SAFETY: the buffer is alive, was made for texel views and is within the limit.
        let view = unsafe { self.0.device.raw().create_buffer_view(&info, None) }
            .map_err(call_failed(format!("cannot view {} as texels", self.name())))?;
        if self.0.view.set(view).is_err() {
            // SAFETY: another thread was faster; this view is known to nobody.
            unsafe { self.0.device.raw().destroy_buffer_view(view, None) };
        }
        Ok(*self.0.view.get().expect("set above"))
    }

    /// Writes to an upload buffer. The bytes must fit.
    pub(super) fn write(&self, bytes: &[u8]) {
        let mut allocation = self.0.allocation.lock().unwrap_or_else(PoisonError::into_inner);
        let slice = allocation.as_mut().and_then(|allocation| allocation.mapped_slice_mut());
        slice.expect("an upload buffer is mapped")[..bytes.len()].copy_from_slice(bytes);
    }

    /// Reads the start of a readback buffer.
    pub(super) fn read(&self, into: &mut [u8]) {
        let allocation = self.0.allocation.lock().unwrap_or_else(PoisonError::into_inner);
        let slice = allocation.as_ref().and_then(|allocation| allocation.mapped_slice());
        into.copy_from_slice(&slice.expect("a readback buffer is mapped")[..into.len()]);
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        let allocation = self.allocation.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        if self.device.is_stuck() {
            std::mem::forget(allocation); // the device may still write to it
            return;
        }
        // SAFETY: every submission is waited for, so the device no longer uses them.
        unsafe {
            if let Some(view) = self.view.get() {
                self.device.raw().destroy_buffer_view(*view, None);
            }
            self.device.raw().destroy_buffer(self.raw, None);
        }
        if let Some(allocation) = allocation
            && let Err(error) = self.device.allocator().free(allocation)
        {
            log::error!("cannot free {}: {error}", self.name);
        }
    }
}
