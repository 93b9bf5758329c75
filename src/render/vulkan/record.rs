//! Recording of commands.

use super::context::Device;
use super::kernel::Bound;
use super::memory::Buffer;
use ash::vk;
use std::cell::Cell;
use std::marker::PhantomData;

/// Records one submission. What it names must live until the submission is waited for: that is `'r`.
pub struct Recorder<'r> {
    pub(super) device: &'r Device,
    pub(super) commands: vk::CommandBuffer,
    pub(super) queries: Option<vk::QueryPool>,
    pub(super) query_count: u32,
    pub(super) next_query: Cell<u32>,
    pub(super) lifetime: PhantomData<Cell<&'r ()>>,
}

impl<'r> Recorder<'r> {
    fn bind(&self, bound: &'r Bound, push: &[u8]) {
        let kernel = bound.kernel();
        assert_eq!(push.len(), kernel.push_bytes() as usize, "push constants of kernel {}", kernel.name());
        let raw = self.device.raw();
        // SAFETY: pipeline, layout and sets fit each other as `Bound` was made from this kernel; all outlive 'r.
        unsafe {
            raw.cmd_bind_pipeline(self.commands, vk::PipelineBindPoint::COMPUTE, kernel.pipeline());
            for (number, set) in bound.sets() {
                raw.cmd_bind_descriptor_sets(
                    self.commands,
                    vk::PipelineBindPoint::COMPUTE,
                    kernel.layout(),
                    *number,
                    &[*set],
                    &[],
                );
            }
            if !push.is_empty() {
                raw.cmd_push_constants(self.commands, kernel.layout(), vk::ShaderStageFlags::COMPUTE, 0, push);
            }
        }
    }

    /// Runs `groups` workgroups.
    pub fn dispatch(&self, bound: &'r Bound, push: &[u8], groups: u32) {
        let limit = self.device.info().limits.group_count;
        assert!(groups <= limit, "{groups} workgroups of kernel {}, limit {limit}", bound.kernel().name());
        self.bind(bound, push);
        // SAFETY: everything is bound and within the limit.
        unsafe { self.device.raw().cmd_dispatch(self.commands, groups, 1, 1) };
    }

    /// Runs as many workgroups as `arguments` says at byte `offset` (three u32, written by an earlier command).
    pub fn dispatch_indirect(&self, bound: &'r Bound, push: &[u8], arguments: &'r Buffer, offset: u64) {
        assert!(offset.is_multiple_of(4) && offset + 12 <= arguments.size(), "indirect arguments at {offset}");
        self.bind(bound, push);
        // SAFETY: the arguments lie inside the buffer, which was made for indirect use.
        unsafe { self.device.raw().cmd_dispatch_indirect(self.commands, arguments.raw(), offset) };
    }

    /// Everything recorded before is done and visible to everything after, on the device and to the host.
    pub fn barrier(&self) {
        let stages = vk::PipelineStageFlags::COMPUTE_SHADER
            | vk::PipelineStageFlags::TRANSFER
            | vk::PipelineStageFlags::DRAW_INDIRECT;
        let memory = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE | vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(
                vk::AccessFlags::SHADER_READ
                    | vk::AccessFlags::SHADER_WRITE
                    | vk::AccessFlags::INDIRECT_COMMAND_READ
                    | vk::AccessFlags::TRANSFER_READ
                    | vk::AccessFlags::TRANSFER_WRITE
                    | vk::AccessFlags::HOST_READ,
            )];
        // SAFETY: no handles involved.
        unsafe {
            self.device.raw().cmd_pipeline_barrier(
                self.commands,
                stages,
                stages | vk::PipelineStageFlags::HOST,
                vk::DependencyFlags::empty(),
                &memory,
                &[],
                &[],
            );
        }
    }

    /// Copies `bytes` bytes.
    pub fn copy(&self, from: &'r Buffer, from_offset: u64, to: &'r Buffer, to_offset: u64, bytes: u64) {
        assert!(from_offset + bytes <= from.size() && to_offset + bytes <= to.size(), "copy beyond a buffer");
        let region = vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size: bytes };
        if bytes > 0 {
            // SAFETY: both ranges lie inside their buffers, which differ.
            unsafe { self.device.raw().cmd_copy_buffer(self.commands, from.raw(), to.raw(), &[region]) };
        }
    }

    /// Sets the first `bytes` bytes (whole words) to zero.
    pub fn clear(&self, buffer: &'r Buffer, bytes: u64) {
        assert!(bytes.is_multiple_of(4) && bytes <= buffer.size(), "clearing {bytes} of {} bytes", buffer.size());
        if bytes > 0 {
            // SAFETY: inside the buffer, which is a transfer target.
            unsafe { self.device.raw().cmd_fill_buffer(self.commands, buffer.raw(), 0, bytes, 0) };
        }
    }

    /// Writes a few bytes (whole words, at most 65,536) that travel inside the command buffer.
    pub fn update(&self, buffer: &'r Buffer, offset: u64, bytes: &[u8]) {
        assert!(
            offset + bytes.len() as u64 <= buffer.size() && bytes.len() <= 65_536,
            "update of {} bytes",
            bytes.len()
        );
        // SAFETY: inside the buffer, which is a transfer target; the bytes are copied while recording.
        unsafe { self.device.raw().cmd_update_buffer(self.commands, buffer.raw(), offset, bytes) };
    }

    /// Notes the device's time once everything recorded before has run. Nothing happens where there is no clock.
    pub fn timestamp(&self) {
        let at = self.next_query.get();
        if let Some(pool) = self.queries
            && at < self.query_count
        {
            // SAFETY: the query was reset at the start of this command buffer and is used once.
            unsafe {
                self.device.raw().cmd_write_timestamp(self.commands, vk::PipelineStageFlags::BOTTOM_OF_PIPE, pool, at);
            }
            self.next_query.set(at + 1);
        }
    }
}
