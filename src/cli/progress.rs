//! The progress bar: samples done, rate and remaining time, on stderr when it is a terminal.

use crate::scene::{Geometry, Scene};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

/// Scenes with fewer triangles and objects are baked before anyone could read a word.
const LONG_BAKE: usize = 500_000;

/// A bar over `total` samples (pixels times samples a pixel); hidden unless `show` and stderr is a terminal.
pub fn bar(total: u64, show: bool) -> ProgressBar {
    let bar = ProgressBar::new(total);
    if !show || !std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    // The template is a constant that indicatif accepts.
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent:>3} %  {per_sec} samples  {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// How far a long bake is, in steps of `bake::Watch`; hidden with `--quiet` and where stderr is no terminal.
pub fn baking(scene: &Scene) -> ProgressBar {
    let mut used = vec![false; scene.meshes.len()];
    for object in &scene.objects {
        if let Geometry::Mesh(id) = object.geometry {
            used[id.0 as usize] = true;
        }
    }
    let meshes = scene.meshes.iter().zip(&used).filter(|(_, used)| **used);
    let size = meshes.map(|(mesh, _)| mesh.triangles.len()).sum::<usize>() + scene.objects.len();
    if size < LONG_BAKE || !log::log_enabled!(log::Level::Warn) || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(2 * size as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}  {elapsed}") {
        bar.set_style(style);
    }
    bar.set_message(format!("building the hierarchy of {:.1} million triangles and objects", size as f64 * 1e-6));
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
