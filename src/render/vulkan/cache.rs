//! Compiled pipelines, kept in the user's cache folder between runs: drivers that compile for seconds do it once.
//!
//! A file is believed only if it is whole (it begins with the BLAKE3 of the rest) and its header names this very device
//! and driver build; anything else is as good as none. It is written under a temporary name and renamed.

use super::device::DeviceInfo;
use super::error::call_failed;
use crate::render::RenderError;
use ash::vk;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// No cache of ours takes more bytes than this; a larger file is none of ours.
const FILE_LIMIT: u64 = 1 << 28;
/// Bytes of the BLAKE3 that comes first.
const SEAL: usize = blake3::OUT_LEN;
/// Bytes of `VkPipelineCacheHeaderVersionOne`; a cache of these alone is empty.
const HEADER: usize = 32;

/// The folder for what may be thrown away: `gonio/` in `$XDG_CACHE_HOME` or `~/.cache`; none where there is neither.
pub fn user_cache() -> Option<PathBuf> {
    // A relative path is invalid by the XDG Base Directory Specification, and to be ignored.
    let is_usable = |path: &PathBuf| path.is_absolute();
    let named = std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from).filter(is_usable);
    let base = named.or_else(|| std::env::home_dir().filter(is_usable).map(|home| home.join(".cache")));
    base.map(|base| base.join("gonio"))
}

/// Writes under a temporary name, then renames, so that no one ever reads half a file. Makes the folder when needed.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    static WRITES: AtomicU32 = AtomicU32::new(0);
    fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
    let number = WRITES.fetch_add(1, Ordering::Relaxed);
    let temporary = path.with_extension(format!("{}-{number}.tmp", std::process::id()));
    let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// Whose pipelines they are, as the header of a cache says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Owner {
    vendor: u32,
    device: u32,
    uuid: [u8; 16],
}

impl Owner {
    /// The pipelines of `file`, if it is whole and this device's.
    fn unseal<'a>(&self, file: &'a [u8]) -> Option<&'a [u8]> {
        let (seal, data) = file.split_at_checked(SEAL)?;
        let word = |at: usize| data.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let is_ours = word(0)? == HEADER as u32
            && word(4)? == vk::PipelineCacheHeaderVersion::ONE.as_raw() as u32
            && word(8)? == self.vendor
            && word(12)? == self.device
            && data.get(16..HEADER)? == self.uuid;
        (is_ours && blake3::hash(data) == *seal).then_some(data)
    }
}

fn seal(data: &[u8]) -> Vec<u8> {
    [blake3::hash(data).as_bytes(), data].concat()
}

/// The device's pipeline cache.
pub(super) struct PipelineCache {
    raw: vk::PipelineCache,
    /// Where it is kept; none: nowhere.
    path: Option<PathBuf>,
    /// BLAKE3 of what came from there.
    loaded: Option<blake3::Hash>,
}

impl PipelineCache {
    /// Makes the cache of `device` with what an earlier run left.
    pub fn load(
        device: &ash::Device,
        info: &DeviceInfo,
        properties: &vk::PhysicalDeviceProperties,
    ) -> Result<Self, RenderError> {
        let owner =
            Owner { vendor: properties.vendor_id, device: properties.device_id, uuid: properties.pipeline_cache_uuid };
        let path = user_cache().map(|folder| folder.join("pipelines").join(format!("{}.bin", key(info, &owner))));
        let mut file = Vec::new();
        if let Some(opened) = path.as_ref().and_then(|path| File::open(path).ok()) {
            // A file that cannot be read to its end fails its seal.
            let _ = opened.take(FILE_LIMIT).read_to_end(&mut file);
        }
        let data = owner.unseal(&file);
        let info = vk::PipelineCacheCreateInfo::default().initial_data(data.unwrap_or_default());
        // SAFETY: the device is alive; the data is whole and was made by this very driver for this very device.
        let raw = unsafe { device.create_pipeline_cache(&info, None) }
            .map_err(call_failed("cannot make a pipeline cache"))?;
        Ok(Self { raw, path, loaded: data.map(blake3::hash) })
    }

    pub fn raw(&self) -> vk::PipelineCache {
        self.raw
    }

    /// Keeps what is new in it. What goes wrong costs time next time, and is no error.
    pub fn store(&self, device: &ash::Device) {
        let Some(path) = &self.path else { return };
        // SAFETY: both are alive.
        let data = unsafe { device.get_pipeline_cache_data(self.raw) }.unwrap_or_default();
        if data.len() <= HEADER
            || data.len() as u64 > FILE_LIMIT - SEAL as u64
            || self.loaded == Some(blake3::hash(&data))
        {
            return;
        }
        if let Err(error) = write_whole(path, &seal(&data)) {
            log::debug!("cannot keep compiled pipelines in {}: {error}", path.display());
        }
    }
}

/// BLAKE3, in hexadecimal, of the device, the driver and this program.
fn key(info: &DeviceInfo, owner: &Owner) -> String {
    let mut hasher = blake3::Hasher::new();
    let texts = [&info.device_uuid, &info.driver_uuid, &info.name, &info.driver, &info.driver_version];
    for text in texts.into_iter().map(String::as_str).chain([env!("CARGO_PKG_VERSION")]) {
        hasher.update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
    }
    hasher.update(&owner.vendor.to_le_bytes()).update(&owner.device.to_le_bytes()).update(&owner.uuid);
    hasher.finalize().to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWNER: Owner = Owner { vendor: 0x1234, device: 0x5678, uuid: [7; 16] };

    /// A cache with some pipelines.
    fn data(owner: Owner) -> Vec<u8> {
        let words = [HEADER as u32, 1, owner.vendor, owner.device].map(u32::to_le_bytes);
        [words.as_flattened(), &owner.uuid, b"pipelines"].concat()
    }

    #[test]
    fn a_cache_comes_back_as_it_was_kept() {
        let data = data(OWNER);
        assert_eq!(OWNER.unseal(&seal(&data)), Some(&data[..]));
    }

    #[test]
    fn a_cache_that_was_cut_or_changed_is_ignored() {
        let whole = seal(&data(OWNER));
        for length in 0..whole.len() {
            assert_eq!(OWNER.unseal(&whole[..length]), None, "{length} bytes");
        }
        for at in 0..whole.len() {
            let mut changed = whole.clone();
            changed[at] ^= 1;
            assert_eq!(OWNER.unseal(&changed), None, "byte {at}");
        }
    }

    #[test]
    fn a_cache_of_another_device_or_driver_is_ignored() {
        for other in [Owner { vendor: 1, ..OWNER }, Owner { device: 1, ..OWNER }, Owner { uuid: [8; 16], ..OWNER }] {
            assert_eq!(OWNER.unseal(&seal(&data(other))), None, "{other:?}");
        }
    }
}
