//! Backends. They only *schedule* the pure steps of `transport`; what is computed is the same.

pub mod cpu;
mod scheduler;
pub mod session;
pub mod vulkan;

use crate::film::{Film, Rect};
use crate::layout::{AovPixel, FilmSum, Hit, PathState};
use crate::watch::Watch;
use std::ops::Range;
use std::sync::Arc;

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

/// The samples of a job: what they add to a film.
#[derive(Clone, Debug, Default)]
pub struct Pass {
    /// Of the job's pixels, rows of the crop from the top.
    pub sums: Vec<FilmSum>,
    /// Likewise, or empty where the scene keeps no auxiliary values.
    pub aovs: Vec<AovPixel>,
    /// Contributions that were not a number, and samples whose sum was clamped.
    pub nan_count: u64,
    pub clamped_count: u64,
    pub counters: Counters,
}

impl Pass {
    /// Adds the samples of `job` to a film whose crop contains the job's and that does not hold them yet.
    pub fn add_to(&self, job: &Job, film: &mut Film) {
        film.add_sums(job.crop, &self.sums);
        self.record_in(job, film);
    }

    /// The same of a film that others look at, which stays as it is. `job` is of its whole crop.
    pub fn add_to_shared(&self, job: &Job, film: &mut Arc<Film>) {
        match Arc::get_mut(film) {
            Some(film) => self.add_to(job, film),
            None => {
                let mut added = film.with_sums(&self.sums);
                self.record_in(job, &mut added);
                *film = Arc::new(added);
            }
        }
    }

    /// All but the sums.
    fn record_in(&self, job: &Job, film: &mut Film) {
        if !self.aovs.is_empty() {
            film.add_aovs(job.crop, &self.aovs, job.samples.contains(&0));
        }
        film.record(job.samples.clone(), self.nan_count, self.clamped_count);
        film.count_limited(self.counters.limited);
    }
}

/// Errors of a backend.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RenderError {
    /// No such device, or it lacks a needed feature: exit code 69.
    #[error("{0}")]
    NoDevice(String),
    /// The device or the host has not enough memory: exit code 75, like all that follow.
    #[error("{0}")]
    OutOfMemory(String),
    /// The device was lost, or never came back from its work.
    #[error("{0}")]
    Lost(String),
    /// The scene or the picture exceeds a limit of the device.
    #[error("{0}")]
    TooLarge(String),
    /// Anything else that a device or its driver could not do.
    #[error("{0}")]
    Failed(String),
    /// The watch was cancelled.
    #[error("interrupted")]
    Aborted,
}

/// The one trait in the house: a way to compute samples.
pub trait Renderer: Send {
    /// "cpu (8 threads)" or the device's name and driver.
    fn name(&self) -> String;

    /// Computes the job's samples; they take the place of what `pass` held, whose memory is used again. Steps of `watch` are
    /// pixels times samples; once it is cancelled the call gives up (`RenderError::Aborted`). On an error `pass` is of no use.
    fn render(&mut self, job: &Job, watch: &Watch, pass: &mut Pass) -> Result<(), RenderError>;

    /// Every step of one sample of one pixel, ordered by (depth, path id).
    fn inspect(&mut self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError>;
}
