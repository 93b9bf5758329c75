//! The strictness probe: does this device compute what every twin in Rust does?
//!
//! No one can test every driver, so the program tests the one it meets: all twins, 2^16 sets of arguments each, edges and
//! subnormals among them. That takes seconds, so the answer is kept in the user's cache folder, under a name that
//! changes with the device, its driver, this program and the kernels.

use super::twins::{FAMILIES, Family, Mismatch, compare};
use crate::render::RenderError;
use crate::render::vulkan::{Context, DeviceInfo, user_cache, write_whole};
use crate::shaders::{Fetch, kernel};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read;
use std::path::PathBuf;

/// Sets of arguments each twin is run with.
pub const COUNT: usize = 1 << 16;
/// Where their random numbers start. Not the seed of the tests, so that together they see more.
const SEED: u32 = 2;
/// No answer takes more bytes than this; a larger file is none of ours.
const ANSWER_LIMIT: u64 = 1 << 16;

/// Whether a device gives the bits that the twins in Rust give.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Exactness {
    Exact,
    /// The first operation that differs, on the first input on which it does.
    Inexact(Mismatch),
}

/// What the probe found, and whether it had to look.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Probed {
    pub exactness: Exactness,
    pub from_cache: bool,
}

/// Where answers are kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cache {
    /// `None`: nowhere.
    folder: Option<PathBuf>,
}

/// One kept answer. The key is that of the file's name: a copy under another name is not believed.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    key: String,
    exactness: Exactness,
}

impl Cache {
    /// `exact/` in the user's cache folder; keeps nothing where there is none.
    pub fn user() -> Self {
        Self { folder: user_cache().map(|folder| folder.join("exact")) }
    }

    /// Keeps answers in this folder, which is made when needed.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: Some(folder.into()) }
    }

    /// Keeps nothing.
    pub fn none() -> Self {
        Self::default()
    }

    fn path(&self, key: &str) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(format!("{key}.json")))
    }

    /// Whether the answer for these families on this device is kept.
    pub fn has(&self, info: &DeviceInfo, families: &[Family]) -> bool {
        self.load(&key(info, families), families).is_some()
    }

    /// The answer kept for `key`; `None` for anything else that may lie there.
    fn load(&self, key: &str, families: &[Family]) -> Option<Exactness> {
        let mut text = String::new();
        File::open(self.path(key)?).ok()?.take(ANSWER_LIMIT).read_to_string(&mut text).ok()?;
        let answer: Answer = serde_json::from_str(&text).ok()?;
        let is_ours = match &answer.exactness {
            Exactness::Exact => true,
            Exactness::Inexact(mismatch) => {
                families.iter().flat_map(|family| family.twins).any(|twin| twin.name == mismatch.twin)
            }
        };
        (answer.key == key && is_ours).then_some(answer.exactness)
    }

    /// Keeps an answer. What goes wrong costs time next time, and is no error.
    fn store(&self, key: &str, exactness: &Exactness) {
        let Some(path) = self.path(key) else { return };
        let answer = Answer { key: key.to_owned(), exactness: exactness.clone() };
        let written = serde_json::to_string(&answer)
            .map_err(std::io::Error::from)
            .and_then(|text| write_whole(&path, text.as_bytes()));
        if let Err(error) = written {
            log::debug!("cannot keep the strictness probe's answer in {}: {error}", path.display());
        }
    }
}

/// Runs every twin on the device of `context`, or finds the answer in `cache`.
pub fn probe(context: &mut Context, cache: &Cache) -> Result<Probed, RenderError> {
    probe_families(context, FAMILIES, cache)
}

/// The same for some families of twins.
pub fn probe_families(context: &mut Context, families: &[Family], cache: &Cache) -> Result<Probed, RenderError> {
    let key = key(context.info(), families);
    if let Some(exactness) = cache.load(&key, families) {
        return Ok(Probed { exactness, from_cache: true });
    }
    log::info!("proving {} exact, once", context.info());
    let exactness = run(context, families)?;
    cache.store(&key, &exactness);
    Ok(Probed { exactness, from_cache: false })
}

fn run(context: &mut Context, families: &[Family]) -> Result<Exactness, RenderError> {
    for family in families {
        for number in 0..family.twins.len() {
            if let (_, Some(mismatch)) = compare(context, family, number, COUNT, SEED)? {
                return Ok(Exactness::Inexact(mismatch));
            }
        }
    }
    Ok(Exactness::Exact)
}

/// BLAKE3, in hexadecimal, of everything the answer depends on.
pub fn key(info: &DeviceInfo, families: &[Family]) -> String {
    let mut hasher = blake3::Hasher::new();
    // Each part behind its length, so that no two lists of parts run together to the same bytes.
    let mut part = |bytes: &[u8]| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    for text in
        [&info.device_uuid, &info.driver_uuid, &info.name, &info.driver, &info.driver_version, &info.vulkan_version]
    {
        part(text.as_bytes());
    }
    let controls = info.float_controls;
    part(&[controls.rounding_rte, controls.signed_zero_inf_nan_preserve, controls.denorm_preserve].map(u8::from));
    part(env!("CARGO_PKG_VERSION").as_bytes());
    part(&(COUNT as u64).to_le_bytes());
    part(&SEED.to_le_bytes());
    for family in families {
        part(family.kernel.as_bytes());
        let words = kernel(family.kernel, Fetch::Storage).expect("every family names an embedded kernel");
        part(bytemuck::cast_slice(words));
        for twin in family.twins {
            part(twin.name.as_bytes());
        }
    }
    hasher.finalize().to_hex().to_string()
}
