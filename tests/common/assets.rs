//! Third-party files, where they are at hand.

use std::path::{Path, PathBuf};

/// A file or folder of the assets, as a path that holds wherever a command runs; None, with a line that says so, where it
/// is not installed.
pub fn asset(name: &str) -> Option<PathBuf> {
    let here = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/assets");
    let root = std::env::var_os("GONIO_ASSETS").map_or_else(here, PathBuf::from);
    let found = root.join(name).canonicalize().ok();
    if found.is_none() {
        println!("SKIPPED: no {name} in the assets");
    }
    found
}
