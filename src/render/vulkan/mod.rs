//! The Vulkan backend: the only folder with `unsafe`.
