//! Whether a device is exact, as commands that compute on it ask and tell.

use crate::render::RenderError;
use crate::render::vulkan::Context;
use crate::verify::probe::{Cache, Exactness, key, probe_families};
use crate::verify::twins::{FAMILIES, basic_families};
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// Proves the device exact or finds the kept answer: in every function where `required` or once that has been proved, else
/// in those that every picture needs. An inexact device is an error where `required`, else one warning a process; where the probe itself fails it is
/// the same.
pub fn check(context: &mut Context, required: bool) -> Result<(), RenderError> {
    /// Devices (by the probe's key) that were found exact, or warned of.
    static SETTLED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let cache = Cache::user();
    let whole = required || cache.has(context.info(), FAMILIES);
    let families = if whole { FAMILIES } else { basic_families() };
    let key = key(context.info(), families);
    let is_settled = |key: &String| SETTLED.lock().unwrap_or_else(PoisonError::into_inner).contains(key);
    if is_settled(&key) {
        return Ok(());
    }
    let problem = match probe_families(context, families, &cache) {
        Ok(probed) => match probed.exactness {
            Exactness::Exact => None,
            Exactness::Inexact(mismatch) => {
                Some(RenderError::NoDevice(format!("{} is not exact: {mismatch}", context.info())))
            }
        },
        Err(error) => Some(error),
    };
    match problem {
        Some(error) if required => return Err(error),
        Some(error @ RenderError::NoDevice(_)) => {
            log::warn!(
                "{error}; pictures may differ from those of other devices (--require-exact makes this an error)"
            );
        }
        Some(error) => log::warn!("cannot tell whether {} is exact: {error}", context.info()),
        None => {}
    }
    SETTLED.lock().unwrap_or_else(PoisonError::into_inner).insert(key);
    Ok(())
}
