//! Backends. They only *schedule* the pure steps of `transport`; what is computed is the same.

pub mod cpu;
pub mod team;
pub mod vulkan;

use crate::film::{Film, Rect};
use crate::layout::{Hit, PathState};
use std::ops::Range;
use std::sync::atomic::AtomicBool;

/// The parts of a picture a call covers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// Pixels of the full frame.
    pub crop: Rect,
    /// Sample indices, 0 to 2^24.
    pub samples: Range<u32>,
}

/// What a backend did, for `--stats`.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Counters {
    pub closest_rays: u64,
    pub shadow_rays: u64,
    /// Contributions that the scene's `clamp` has limited and that reached the film.
    pub limited: u64,
    /// Seconds on the device's own clock by stage (extend, shade, shadow, other); zero where it has none.
    pub extend_s: f64,
    pub shade_s: f64,
    pub shadow_s: f64,
    pub other_s: f64,
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        self.closest_rays += other.closest_rays;
        self.shadow_rays += other.shadow_rays;
        self.limited += other.limited;
        self.extend_s += other.extend_s;
        self.shade_s += other.shade_s;
        self.shadow_s += other.shadow_s;
        self.other_s += other.other_s;
    }
}

/// One step of one sample, for `--pixel` and for parity's report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounce {
    pub path: PathState,
    pub hit: Hit,
}

/// How a call reports and is asked to stop.
pub struct Watch<'a> {
    /// Set from outside: abandon the call.
    pub abort: &'a AtomicBool,
    /// Samples finished since the last call of this function (pixels times samples).
    pub advance: &'a (dyn Fn(u64) + Sync),
}

/// Errors of a backend.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// No such device, or it lacks a needed feature: exit code 69.
    #[error("{0}")]
    NoDevice(String),
    /// Device lost, out of memory, scene too large: exit code 75.
    #[error("{0}")]
    Device(String),
    /// `Watch::abort` was set.
    #[error("interrupted")]
    Aborted,
}

/// The one trait in the house: a way to compute samples.
pub trait Renderer {
    /// "cpu (8 threads)" or the device's name and driver.
    fn name(&self) -> String;

    /// Adds the job's samples to `film`, whose crop contains the job's. On an error the film is as it was.
    fn accumulate(&mut self, job: &Job, film: &mut Film, watch: &Watch) -> Result<Counters, RenderError>;

    /// Every step of one sample of one pixel, ordered by (depth, path id).
    fn inspect(&mut self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError>;
}
